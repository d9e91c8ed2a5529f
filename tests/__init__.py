"""Tests of trsim, alone in their processes or two at a time."""

import os

# before numpy comes, and as the command line does it: threads that wait for work take the time of
# the tests beside
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
