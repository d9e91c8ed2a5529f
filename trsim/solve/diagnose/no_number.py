"""Sensors without a number: a formula that divides by zero, while the motion is all right."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.errors import ModelError

HINT = "take care that nothing is divided by zero, as in x/(1e-9 + abs(y))"


def no_number(mechanism: Mechanism, out: NDArray[np.float64]) -> str:
    """The first sensor whose channels are not finite in a row of them, where all others are."""
    if good(out):
        return ""
    sensors = [i.name for i in mechanism.instances if i.section == "sensors"]
    bad = [c.name for c in mechanism.columns if not good(out[c.start : c.start + c.size])]
    names = [next((n for n in sensors if c == n or c.startswith(n + ".")), "") for c in bad]
    return names[0] if names and all(names) else ""


def unshown(mechanism: Mechanism, out: NDArray[np.float64]) -> str:
    """Why a run ends where a sensor has no number; nothing where that is not why."""
    name = no_number(mechanism, out)
    return f"sensor '{name}' shows no finite number: {HINT}" if name else ""


def good(values: Any) -> bool:
    """Whether all of some numbers are finite."""
    return bool(np.isfinite(values).all())


def refuse_no_number(mechanism: Mechanism, out: NDArray[np.float64]) -> None:
    """Raises ModelError for a sensor that shows no number at the start."""
    if name := no_number(mechanism, out):
        raise ModelError("shows no finite number at the start", HINT, ("sensors", name))
