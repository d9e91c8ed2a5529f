"""Where functions of a run may have no value, or none that is bounded: what each step looks for.

    a/b, a**-n    b, a       POLE     not zero
    tan(a)        cos(a)     POLE
    log(a)        a          DOMAIN   not negative
    sqrt(a)       a          DOMAIN   also a**b with a b that is no whole number
    asin(a)       1 - |a|    DOMAIN   also acos(a)

Each u of these is a function of its own in `tab`, unless interval arithmetic proves for all times
of the run, and whatever sensors show, that it stays where it may be.  What becomes of those that
are left is seen step by step (solve/march/poles.py).
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from trsim.assemble.jumps import NOBODY, driven
from trsim.enclosures import Interval, enclosure
from trsim.expressions import Node, names, parts, rebuilt, written
from trsim.laws import functions
from trsim.laws.functions import slots_of

POLE, DOMAIN, RESTS = 0, 1, 2  # RESTS: of a force that does not act
AT, OF, KIND, DRIVE, N_POLE = range(5)  # offsets of u and of the function, kind, row of a drive
PIECES = 1024  # of a run, in each of which u is bounded
ONE, TWO = ("number", 1.0), ("number", 2.0)


class Doubt(NamedTuple):
    """Something in a function that may have no value."""

    kind: int
    u: Node
    text: str  # what becomes of it


class Guard(NamedTuple):
    """The same, packed."""

    at: int  # offset in tab of u
    of: int  # and of the function
    kind: int
    text: str
    slots: int


def doubts(node: Node) -> Iterator[Doubt]:
    """All in an expression that may have no value somewhere, the inner ones first."""
    for part in parts(node):
        yield from doubts(part)
    match node:
        case ("binary", "/", _, b) if names(b) - {"pi"}:
            yield Doubt(POLE, b, f"it divides by {written(b)}, which becomes zero")
        case ("call", "tan", (a,)):
            yield Doubt(POLE, ("call", "cos", (a,)), f"{written(node)} becomes infinite")
        case ("call", "log" | "sqrt" as word, (a,)):
            yield Doubt(DOMAIN, a, f"{word} is taken of {written(a)}, which becomes negative")
        case ("call", "asin" | "acos" as word, (a,)):
            u = ("binary", "-", ONE, ("call", "abs", (a,)))
            yield Doubt(DOMAIN, u, f"{word} is taken of {written(a)}, which goes beyond -1 or 1")
        case ("binary", "**", a, ("number", b)) if b == round(b):
            if b < 0.0:
                yield Doubt(POLE, a, f"it divides by a power of {written(a)}, which becomes zero")
        case ("binary", "**", a, b) if names(a) - {"pi"}:
            what = f"a power is taken of {written(a)}, which becomes negative"
            yield Doubt(DOMAIN, a, f"{what}, and {written(b)} is no whole number")


def certain(doubt: Doubt, end: float) -> bool:
    """Whether it has a value throughout a run, whatever the sensors show."""
    edges = np.linspace(0.0, end, PIECES + 1)
    with np.errstate(all="ignore"):
        u, _ = enclosure(squared(doubt.u), Interval(edges[:-1], edges[1:]))
    if doubt.kind == DOMAIN:
        return bool(np.all(u.low >= 0.0))
    return bool(np.all(u.low > 0.0) or np.all(u.high < 0.0))


def squared(node: Node) -> Node:
    """An expression with a**2 for a*a, which is never negative."""
    new = rebuilt(node, squared)
    return ("binary", "**", new[2], TWO) if new[:2] == ("binary", "*") and new[2] == new[3] else new


def guards(at: Any, node: Node, of: int, indices: dict[str, int]) -> list[Guard]:
    """What is to be looked for of the function at offset `of`; stores each u in tab.

    indices: the sensors it reads, with their entries of S.
    """
    found: dict[Node, Guard] = {}
    for doubt in doubts(node):
        if doubt.u in found or certain(doubt, at.end):
            continue
        code = functions.expression(doubt.u, indices)
        slots = slots_of(code)
        found[doubt.u] = Guard(len(at.tab), of, doubt.kind, doubt.text, slots)
        at.tab.extend(code)
    return list(found.values())


def poles(at: Any, instances: list[Any]) -> dict[str, Any]:
    """The tables of a model; empty where every function has a value throughout."""
    own, rest = driven(at, instances) if at.guards else {}, resting(at, instances)
    rows = [
        (g.at, g.of, RESTS if g.of in rest else g.kind, own.get(g.of, NOBODY).e) for g in at.guards
    ]
    return {
        "pole": np.array(rows, np.int64).reshape(-1, N_POLE),
        "pole_slots": max((g.slots for g in at.guards), default=0),
    }


def resting(at: Any, instances: list[Any]) -> set[int]:
    """The functions of forces that do not act, by their offsets in tab."""
    own = tuple(f"forces.{one.name}." for one in instances if not one.acts)
    return {f.offset for f in at.packed_functions if f.name.startswith(own)} if own else set()
