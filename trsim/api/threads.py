"""One thread of the BLAS that numpy uses: its matrices here are small.

Several threads wait for each other by turning: a path of the crew door took 29 s of CPU on two
processors instead of 9, and no less wall time.  A command asks for one before numpy is imported; a
program in Python has imported it, and gets its own number back afterwards.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager

ASKED = "OPENBLAS_NUM_THREADS"


@contextmanager
def one_thread() -> Iterator[None]:
    """Within it linear algebra has one thread."""
    if os.environ.get(ASKED) == "1":
        yield
        return
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        yield
