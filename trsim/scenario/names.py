"""Names of a scenario, checked across its sections."""

import keyword
import re
from collections.abc import Iterator
from typing import Any

from trsim.errors import ScenarioError, described, known
from trsim.expressions import ALSO_NAMES, FUNCTIONS
from trsim.scenario.merge import NAMED, keys_of, mapping
from trsim.scenario.vary import sweep

# what stands beside the channels in a result file; `component` begins the names of their scales
IN_FILES = {
    *("time", "component", "steps", "events", "recorded", "peaks", "summary", "solver", "phase"),
    *("impulses", "velocity_jumps"),
    *("poincare", "impact", "orbit", "scenario", "mechanism", "provenance", "certificate"),
}
RESERVED = {"ground", "world", "t", "pi", "energy", *IN_FILES, *keyword.kwlist}
RESERVED |= FUNCTIONS.keys() - ALSO_NAMES
NAME = r"[A-Za-z_][A-Za-z0-9_]*"
OF_POINTS = r"[A-Za-z0-9_][A-Za-z0-9_ +-]*"  # of portraits and sections, which have their own
LONGEST = 100  # letters of a name
NEW = {"parameters"}  # sections in which a name that is not there means nothing


def name_faults(data: dict) -> Iterator[ScenarioError]:
    """All names share one name space; each must be a word an expression can contain."""
    taken: dict[str, str] = {}
    for section in ("parameters", *NAMED):
        for name in mapping(data, section):
            path = (section, name)
            if not re.fullmatch(NAME, name):
                hint = "A name is letters, digits and _, a letter first."
                yield ScenarioError(f"not a name: {described(name)}", hint, path)
            elif len(name) > LONGEST:
                yield ScenarioError(f"a name of {len(name)} letters", f"At most {LONGEST}.", path)
            elif name in RESERVED:
                yield ScenarioError(f"the name '{name}' is reserved", "Choose another.", path)
            elif name in taken:
                what = f"the name '{name}' is taken by {taken[name]}.{name}"
                yield ScenarioError(what, "All names share one name space.", path)
            taken.setdefault(name, section)
    for section in ("phase_portraits", "poincare"):
        for name in mapping(data, section):
            if not re.fullmatch(OF_POINTS, name) or len(name) > LONGEST:
                hint = f"A name is letters, digits, _, + and -, at most {LONGEST}."
                what = f"not a name: {described(name)}"
                yield ScenarioError(what, hint, (section, name))


def sweep_faults(data: dict) -> Iterator[ScenarioError]:
    """What is wrong with a sweep: its words, or a key that says nothing in this scenario.

    The last word of a key may be one that the file leaves out; whether it can be set there is
    found when a case is made.  Keys are those of the cases, where there are any.
    """
    given = data.get("sweep")
    if not isinstance(given, dict):
        return
    try:
        axes = sweep(given).axes
    except ScenarioError as error:
        yield error.at("sweep")  # type: ignore[misc]
        return
    for axis in axes if not data.get("cases") else ():
        inner: Any = data
        keys = keys_of(axis.key)
        for k, key in enumerate(keys):
            entries = inner if isinstance(inner, dict) else {}
            if isinstance(inner, list):
                entries = {str(k): item for k, item in enumerate(inner)}
            if key not in entries:
                if isinstance(inner, dict) and k == len(keys) - 1 and k and keys[0] not in NEW:
                    break
                what = f"nothing to vary at {described(axis.key)}: no {described(key)}"
                yield ScenarioError(what, known(key, entries), ("sweep", axis.key))
                break
            inner = entries[key] if isinstance(entries, dict) else None
