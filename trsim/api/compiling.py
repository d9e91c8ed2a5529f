"""What is said where machine code has to be made first, and the second process that helps."""

from typing import Any

from trsim.api.hearing import Listener
from trsim.errors import FileError
from trsim.scenario.methods import GGL, INDEX_1, METHODS


def compiling(hears: Listener, method: str = "") -> None:
    """Say so where nothing was compiled on this machine yet.

    method: of a run; its solver is then compiled meanwhile, in a second process.
    """
    from trsim.assemble.equations import derivative

    needed, later = derivative, []
    if method and METHODS[method].rests:
        from trsim.solve.path.balance import system as needed
    elif method:
        # what every run needs, the dearest first; the first process is at the rest meanwhile
        files = METHODS[method].files.get(INDEX_1, ("scipy_ivp",))
        march = ("land", "peaks", "complete", "dense_output", "loop")
        later = [*(f"methods.{name}" for name in reversed(files)), *(f"march.{n}" for n in march)]
        from trsim.solve.march.complete import complete as needed
    warn_of_shared_code(hears)
    if needed.known:
        return
    warn_of_code_not_kept(hears)
    hears.say(
        "compiling (once per installation: 20 s to a minute, longer where processors are busy)"
    )
    if later:
        from trsim.kernels import ahead

        ahead.begin(*(f"trsim.solve.{name}" for name in later))


def compiling_sparse(hears: Listener, scenario: Any, mechanism: Any) -> None:
    """Say so where many bodies need a solver that was not compiled yet."""
    from trsim.solve.simulate import files

    used = files(scenario, mechanism)
    if used != METHODS[scenario.solver.method].files.get(GGL):
        return
    from trsim.solve.methods import radau_ggl

    if radau_ggl.step.known:
        return
    hears.say("compiling Radau for many bodies (once per installation, about 15 s)")
    if len(used) > 1:  # meanwhile the explicit method makes steps
        from trsim.kernels import ahead

        ahead.begin("trsim.solve.methods.radau_ggl")


def warn_of_shared_code(hears: Listener) -> None:
    """Say so where machine code would come from a folder that others may write in."""
    from trsim.kernels.kept import refused

    why = refused()
    if why:
        hears.warn(
            "machine code", f"nothing is loaded from the cache: {why}; this command compiles in a "
            "folder of its own.  Let the cache folder be yours alone (mode 700), or name another "
            "one by XDG_CACHE_HOME"
        )  # fmt: skip


def warn_of_code_not_kept(hears: Listener) -> None:
    """Say so where what is compiled cannot be kept for the next run."""
    from trsim.kernels.kept import folder, make
    from trsim.store.target import check_writable, file_errors

    try:
        with file_errors(folder()):
            make(folder())
        check_writable(folder())
    except FileError as error:
        hears.say(
            f"warning: machine code cannot be kept, so every run compiles anew: {error.what}; "
            "the variable XDG_CACHE_HOME names another folder for it"
        )
