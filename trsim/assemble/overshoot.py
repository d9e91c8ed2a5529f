"""Curves that leave the data they are drawn through."""

from typing import Any

import numpy as np

from trsim.errors import ScenarioError
from trsim.laws.tables import COEFFICIENTS


def overshoot(spec: Any, path: tuple[str | int, ...]) -> list[str]:
    """Refuse a curve that leaves its data far behind; a note on one that leaves it."""
    x, y = np.array(spec.x), np.array(spec.y)
    span = float(np.ptp(y))
    if span == 0.0:
        return []
    a, b, c, d = np.array(COEFFICIENTS[spec.interpolation](x, y)).T
    s = np.linspace(0.0, 1.0, 33)[:, None] * np.diff(x)
    curve = a + s * (b + s * (c + s * d))
    over = np.maximum(curve - np.maximum(y[:-1], y[1:]), np.minimum(y[:-1], y[1:]) - curve)
    row = int(np.argmax(over.max(axis=0)))
    worst = float(over[:, row].max()) / span
    reached = float(curve[np.argmax(over[:, row]), row])
    word = "Akima curve" if spec.interpolation == "akima" else spec.interpolation
    what = f"the {word} reaches {reached:g} between rows {row + 1} and {row + 2}"
    if worst > 0.5:
        raise ScenarioError(
            f"{what}, far from the data",
            "add a point on each side of a corner: ... [0.499, 0], [0.5, 0], [0.501, 1000] ..., or "
            "take `interpolation: linear`",
            (*path, "table"),
        )
    if worst > 0.05:
        return [f"{'.'.join(map(str, path))}: {what}; more points at the corner keep it in"]
    return []
