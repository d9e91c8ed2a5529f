"""trsim: batch simulation of rigid-flexible mechanisms with joint clearance.

    trsim.load(scenario)    a scenario, read and checked
    trsim.check(scenario)   what it describes, and what a run of it will meet
    trsim.run(scenario)     a run of it: a Result
    trsim.sweep(scenario)   many runs of it, side by side: a Sweep
    trsim.merge(folders)    shards of a sweep made into one: a Sweep
    trsim.Result(file)      a result file
    trsim.Sweep(folder)     the folder of a sweep

A scenario is the name of a file, or a dict.  Importing the package starts nothing and imports
nothing heavy: `trsim --help` stays quick.
"""

import os

from trsim.version import __version__

TYPE_CHECKING = False  # of `typing`, which takes longer to import than all else here
if TYPE_CHECKING:
    from trsim.api.check import Checked as Checked
    from trsim.api.check import check as check
    from trsim.api.merge import merge as merge
    from trsim.api.result import Result as Result
    from trsim.api.run import run as run
    from trsim.api.source import load as load
    from trsim.api.study import Sweep as Sweep
    from trsim.api.sweep import sweep as sweep
    from trsim.errors import CasesFailed as CasesFailed
    from trsim.errors import FileError as FileError
    from trsim.errors import ModelError as ModelError
    from trsim.errors import Problems as Problems
    from trsim.errors import ScenarioError as ScenarioError
    from trsim.errors import SolverError as SolverError
    from trsim.errors import TrsimError as TrsimError
    from trsim.errors import TrsimWarning as TrsimWarning
    from trsim.errors import UsageError as UsageError

FROM = {
    "check": ("check", "Checked"),
    "merge": ("merge",),
    "result": ("Result",),
    "run": ("run",),
    "source": ("load",),
    "study": ("Sweep",),
    "sweep": ("sweep",),
}
ERRORS = ("TrsimError", "UsageError", "ScenarioError", "ModelError", "SolverError", "CasesFailed",
          "FileError", "Problems", "TrsimWarning")  # fmt: skip
WHERE = {name: f"trsim.api.{module}" for module, names in FROM.items() for name in names}
WHERE |= dict.fromkeys(ERRORS, "trsim.errors")

__all__ = ["__version__", *WHERE]

# pydantic would look for plugins of its own in every package installed
os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")


def __getattr__(name: str) -> object:
    """What is asked for, imported when it is."""
    from importlib import import_module

    if name not in WHERE:
        raise AttributeError(f"module 'trsim' has no attribute '{name}'")
    return getattr(import_module(WHERE[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *WHERE})
