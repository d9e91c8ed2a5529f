"""Processes of our own: this Python, this package, and no module of the folder it is begun in.

    python -P child.py MODULE ARGUMENT...

runs a module of this package as `python -m MODULE` would.  With -m alone the current folder comes
first on the path: a file `random.py` of the user's there would be executed in place of Python's.
The package is loaded from where this file is, so both processes have the same code.
"""

import os
import sys


def command(module: str, *arguments: str) -> list[str]:
    """The command line that runs a module of this package."""
    return [sys.executable, "-P", os.path.abspath(__file__), module, *arguments]


def own() -> None:
    """Have this package loaded from here, whatever else is called trsim."""
    from importlib.util import module_from_spec, spec_from_file_location

    folder = os.path.dirname(os.path.abspath(__file__))
    start = os.path.join(folder, "__init__.py")
    spec = spec_from_file_location("trsim", start, submodule_search_locations=[folder])
    assert spec and spec.loader  # noqa: S101
    sys.modules["trsim"] = package = module_from_spec(spec)
    spec.loader.exec_module(package)


if __name__ == "__main__":
    from runpy import run_module

    own()
    del sys.argv[0]
    run_module(sys.argv[0], run_name="__main__", alter_sys=True)
