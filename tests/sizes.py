"""How much is tried: in `make test`, or with TRSIM_SIZE=release in the environment."""

import os

RELEASE = os.environ.get("TRSIM_SIZE") == "release"


def size(usual: int, release: int) -> int:
    """The number of trials."""
    return release if RELEASE else usual
