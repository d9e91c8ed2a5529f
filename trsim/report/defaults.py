"""matplotlib with its own settings: the same run is drawn alike in every folder, by every user.

A file `matplotlibrc` of the working folder would be read while matplotlib is imported: its settings
change figures, and one that cannot be read ends the command, or never does if it is a FIFO.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["Figure", "FigureCanvasAgg", "matplotlib"]


@contextmanager
def _elsewhere() -> Iterator[None]:
    """In the root folder, and back by a handle: the folder may have lost its name meanwhile."""
    here: int | str = os.getcwd()
    if os.chdir in os.supports_fd:
        here = os.open(".", getattr(os, "O_PATH", os.O_RDONLY))
    try:
        os.chdir(os.sep)
        yield
    finally:
        os.chdir(here)
        if isinstance(here, int):
            os.close(here)


with _elsewhere():
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
matplotlib.rcdefaults()  # nor has a file of the user's a say
