"""Flexible bars that are strained beyond what their law means.

    |r'| at some places of every element:  0 is squeezed to nothing, 2 twice as long

A bar that is pressed together turns inside out without a force against it (green strain), or its
force loses its direction; one that is twice as long is no bar any more.  Such a run is ended.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.solve.start.bars import places

Array = NDArray[np.float64]

PLACES = 9  # of an element that are looked at
NOTHING, TWICE = 0.05, 2.0  # of |r'|: ends a run
NEARLY, ALMOST = 0.2, 1.8  # of |r'|: explains one that could not go on
MUCH = 0.1  # strain beyond which metals flow and the law of the bar ends; told after a run


class Stretch(NamedTuple):
    """|r'| somewhere in an element of a bar, counted from 1."""

    name: str
    element: int
    value: float


def stretches(mechanism: Mechanism, y: Array) -> Iterator[Stretch]:
    """The least and the largest |r'| of each flexible bar."""
    for name, beam in mechanism.beams.items():
        r, g = places(mechanism, beam, y)
        s = np.linspace(0.0, 1.0, PLACES)[:, None, None]
        along = 6.0 * s * (1.0 - s) * np.diff(r, axis=0) / beam.length
        slope = along + (1.0 - s) * (1.0 - 3.0 * s) * g[:-1] + s * (3.0 * s - 2.0) * g[1:]
        found = np.linalg.norm(slope, axis=2)
        for k in (int(np.argmin(found.min(axis=0))), int(np.argmax(found.max(axis=0)))):
            part = found[:, k]
            value = part.max() if part.max() - 1.0 > 1.0 - part.min() else part.min()
            yield Stretch(name, k + 1, float(value))


def collapsed(
    scenario: Any, mechanism: Mechanism, t: float, y: Array, low: float = NOTHING,
    high: float = TWICE,
) -> str:  # fmt: skip
    """Which element of a bar has collapsed at a state, in words; empty where none has."""
    if not np.all(np.isfinite(y)):
        return ""
    for name, element, value in stretches(mechanism, y):
        if low < value < high:
            continue
        does = "squeezed" if value <= low else "stretched"
        entry = scenario.entry("bodies", name)
        return (
            f"{entry}: element {element} is {does} to {100.0 * value:.3g} % of its "
            f"length at t = {t:.6g} s, where the law of a flexible bar has no meaning: is it too "
            "soft for its loads, or driven too far? `strain: engineering` resists more of it"
        )
    return ""


def of_bars(scenario: Any, mechanism: Mechanism, peaks: Array) -> Iterator[str]:
    """Bars whose largest strain in a run is beyond that of their law."""
    column = {c.name: c.start for c in mechanism.columns}
    for name, beam in mechanism.beams.items():
        half = 0.5 * scenario.bodies[name].flexible.thickness
        kinds = (
            ("axial_force", 1.0 / beam.stiffness, "along"),
            ("bending_moment", half / beam.bending, "at its surface by bending"),
        )
        for channel, per_unit, words in kinds:
            names = [f"{name}.node{k}.{channel}" for k in range(beam.nodes)]
            if not all(n in column for n in names):
                continue  # not recorded
            most = peaks[[column[n] for n in names]]
            found = np.abs(most[:, [0, 2]]) * per_unit
            node, side = np.unravel_index(int(np.argmax(found)), found.shape)
            strain = float(found[node, side])
            if strain > MUCH:
                yield (
                    f"bodies.{name}: strained by {strain:.2g} {words}, at node {node} at "
                    f"{most[node, 2 * side + 1]:.4g} s; its law is linear, which metals and most "
                    f"plastics are not above {MUCH:g}: check section, modulus and loads"
                )
