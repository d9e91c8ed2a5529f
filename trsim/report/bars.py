"""Flexible bars: deflection and section forces over time, and the shapes they take."""

from typing import Any

import numpy as np

from trsim.arrays import Array
from trsim.report.display import Shown
from trsim.report.marks import heading
from trsim.report.style import DASHES, apart, colour, finished, panels, thinned, titled

SHAPES = 9  # of one run
SIDES = ((0, 1), (0, 2), (1, 2))  # the planes a shape may be seen in
FORCES = (("axial_force", "axial force"), ("bending_moment", "bending moment"))


def nodes(shown: Shown, bar: str) -> int:
    """How many nodes of a bar were recorded."""
    count = 0
    while shown.has(f"{bar}.node{count}.position"):
        count += 1
    return count


def forces(runs: list[Shown], bar: str) -> Any:
    """Deflection, and of axial force and bending moment the largest and least along the bar."""
    there = [shown for shown in runs if nodes(shown, bar)]
    figure, axes = panels(3, height=1.7, sharex=True)
    for k, shown in enumerate(there):
        axes[0, 0].plot(*thinned(shown.time, shown.values(f"{bar}.deflection")), color=colour(k),
                        label=shown.label)  # fmt: skip
        for row, (channel, _) in enumerate(FORCES, 1):
            along = np.array([shown.values(f"{bar}.node{n}.{channel}")
                              for n in range(nodes(shown, bar))])  # fmt: skip
            for dash, values in ((0, along.max(axis=0)), (1, along.min(axis=0))):
                axes[row, 0].plot(*thinned(shown.time, values), color=colour(k), ls=DASHES[dash],
                                  lw=1.0 - 0.4 * dash)  # fmt: skip
    one = there[0]
    axes[0, 0].set_ylabel(f"deflection\n({one.unit(f'{bar}.deflection')})")
    for row, (channel, words) in enumerate(FORCES, 1):
        axes[row, 0].set_ylabel(f"{words}\n({one.unit(f'{bar}.node0.{channel}')})")
    for a in axes[:, 0]:
        a.margins(x=0.01)
        apart(a)
    axes[-1, 0].set_xlabel(one.time_label)
    text = f"{heading(bar)}: largest and (dashed) least along the bar"
    return finished(figure, axes[0, 0], there, text)


def shapes(runs: list[Shown], bar: str) -> Any:
    """The line of the bar at some times, light to dark, in the plane it moves in most."""
    there = [shown for shown in runs if nodes(shown, bar)]
    figure, axes = panels(1, len(there), height=3.6)
    places = [line(shown, bar) for shown in there]
    spread = [np.ptp(places[0][:, :, c]) for c in range(3)]
    x, y = max(SIDES, key=lambda side: (spread[side[0]] + spread[side[1]], min(side) == 0))
    for a, shown, place in zip(axes[0], there, places, strict=True):
        rows = np.unique(np.linspace(0, len(place) - 1, SHAPES).astype(int))
        for k, row in enumerate(rows):
            shade = str(0.8 * (1.0 - k / max(len(rows) - 1, 1)))
            a.plot(place[row, :, x], place[row, :, y], "-o", color=shade, lw=1.0, ms=2.0)
        a.set_xlabel(f"{'xyz'[x]} ({shown.display('m')[1]})")
        a.set_aspect("equal", adjustable="datalim")
        if shown.label:
            a.set_title(shown.label, fontsize=8)
    axes[0, 0].set_ylabel(f"{'xyz'[y]} ({there[0].display('m')[1]})")
    titled(figure, there, f"{heading(bar)} at {SHAPES} times, the last one black")
    return figure


def line(shown: Shown, bar: str) -> Array:
    """Places of the nodes at the output times, (n, nodes, 3)."""
    found = [shown.values(f"{bar}.node{k}.position") for k in range(nodes(shown, bar))]
    return np.stack(found, axis=1)
