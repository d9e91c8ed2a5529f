"""What all tests share."""

from hypothesis import settings

# the first example of a law compiles it: a time says nothing about the law
settings.register_profile("trsim", deadline=None)
settings.load_profile("trsim")
