"""Names of a scenario, checked across its sections."""

import keyword
import re
from collections.abc import Iterator
from typing import Any

from trsim.errors import ScenarioError, described, known
from trsim.expressions import FUNCTIONS
from trsim.spec.expand import NAMED

RESERVED = {
    *("ground", "world", "t", "pi", "time", "energy"),
    *("steps", "events", "peaks", "summary", "solver", "phase", "poincare", "scenario"),
    *("provenance", *FUNCTIONS, *keyword.kwlist),
}


def name_faults(data: dict) -> Iterator[ScenarioError]:
    """All names share one name space; each must be a word an expression can contain."""
    taken: dict[str, str] = {}
    for section in ("parameters", *NAMED):
        entries = data.get(section)
        for name in entries if isinstance(entries, dict) else ():
            path = (section, name)
            if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
                hint = "A name is letters, digits and _, a letter first."
                yield ScenarioError(f"not a name: {described(name)}", hint, path)
            elif name in RESERVED:
                yield ScenarioError(f"the name '{name}' is reserved", "Choose another.", path)
            elif name in taken:
                what = f"the name '{name}' is taken by {taken[name]}.{name}"
                yield ScenarioError(what, "All names share one name space.", path)
            taken.setdefault(name, section)


def sweep_faults(data: dict) -> Iterator[ScenarioError]:
    """A sweep varies what is there: its keys are dotted paths of the scenario."""
    sweep = data.get("sweep")
    for dotted in sweep if isinstance(sweep, dict) else ():
        inner: Any = data
        for key in dotted.split("."):
            entries = inner if isinstance(inner, dict) else {}
            if isinstance(inner, list):
                entries = {str(k): item for k, item in enumerate(inner)}
            if key not in entries:
                what = f"nothing to vary at {described(dotted)}: no {described(key)}"
                yield ScenarioError(what, known(key, entries), ("sweep", dotted))
                break
            inner = entries[key]
