"""The modes of `trsim check --modes`, for a reader."""

from collections.abc import Iterator
from typing import Any

SHOWN = 4  # bodies of a shape
LISTED = 20  # modes; flexible bars have hundreds


def mode_lines(modes: list[dict[str, Any]]) -> Iterator[str]:
    """A line for each mode: how fast, how damped, and which bodies move most."""
    if not modes:
        yield "  modes       none: the mechanism has no freedom left"
    for k, mode in enumerate(modes[:LISTED], 1):
        label = "modes" if k == 1 else ""
        yield f"  {label:11s} {k:3d}  {speed(mode):34s} {shape(mode['shape'])}"
    if len(modes) > LISTED:
        yield f"              and {len(modes) - LISTED} faster ones, see --json"


def speed(mode: dict[str, Any]) -> str:
    """Frequency and damping, or how fast it fades or grows."""
    if mode["kind"] == "oscillates":
        return f"{mode['frequency']:.6g} Hz, damping ratio {mode['damping_ratio']:.3g}"
    if mode["kind"] == "free":
        return "free: no stiffness"
    return f"{mode['kind']} in {1.0 / abs(mode['rate']):.4g} s"


def shape(moved: list[dict[str, Any]]) -> str:
    """The bodies that move most, the largest motion 1; of a flexible bar the node that does."""

    def size(one: dict[str, Any]) -> float:
        turns = () if "[" in one["body"] else one["rotation"]  # a bar is told by where it goes
        return max(map(abs, (*one["translation"], *turns)))

    most: dict[str, dict[str, Any]] = {}
    for one in sorted(moved, key=size, reverse=True):
        most.setdefault(one["body"].partition("[")[0], one)
    told = []
    for one in list(most.values())[:SHOWN]:
        named = zip("xyzXYZ", (*one["translation"], *one["rotation"]), strict=True)
        parts = [f"{axis if axis.islower() else 'turn ' + axis.lower()} {value:+.2f}"
                 for axis, value in named if abs(value) > 0.005]  # fmt: skip
        if parts:
            told.append(f"{one['body']} {', '.join(parts)}")
    return "; ".join(told)
