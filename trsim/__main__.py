"""python -m trsim, with no module of the folder it is begun in.

Python itself puts that folder in front of the path before anything of ours runs.  Nothing but trsim
is imported from it, if that is where it is.  The command `trsim` and `python -P -m trsim` do not
have it there.
"""

import os
import sys


def leave_out_the_current_folder() -> None:
    """Take what -m has put in front of the path out of it; last, if trsim itself is found there."""
    if sys.flags.safe_path:
        return
    began_in = sys.path.pop(0)
    if os.path.realpath(began_in) == os.path.dirname(os.path.dirname(os.path.realpath(__file__))):
        sys.path.append(began_in)


if __name__ == "__main__":
    leave_out_the_current_folder()
    from trsim.cli import main

    main()
