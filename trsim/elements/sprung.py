"""What springs with laws of their own share: an elastic force, a damper, and when they act.

    T = g (f(x) + w d(x'))          positive where it pulls back towards smaller x
    E = integral of f from 0 to x   its stored energy
    g = 1, or x > 0 of what only pulls, where T is never negative:  T = max(0, f + w d)
    w = 1, or x' > 0 (extension), x' < 0 (compression)

x is how far the element is stretched: an entry of S of its own, so that corners of f and d are
met by steps like those of all functions of sensors.  What is not elastic of T is the damper's.
"""

from typing import Literal

from pydantic import model_validator

from trsim.elements.contract import SPRINGS
from trsim.elements.frames import Along
from trsim.errors import ScenarioError
from trsim.expressions import evaluate
from trsim.fields import Spec
from trsim.kernels.columns import i8
from trsim.kernels.lazy import internal
from trsim.laws.functions import value
from trsim.laws.quadrature import integral
from trsim.varying import FunctionSpec

X, RATE = "stretch", "rate"  # the words for x and x'
ZERO, ONE = FunctionSpec("constant", 0.0), FunctionSpec("constant", 1.0)
SPEEDS = tuple(sign * 10.0**k for k in range(-6, 4) for sign in (-1.0, 1.0))  # looked at
TAUT = (1e-12, 1e-6)  # m: a force that is half as large at the first as at the second jumps at 0
NOTHING = 1e-9  # of a force: rounding of one that is zero


class Sprung(Spec):
    """Keys of every such spring.

    damper_acts  when the damper acts: always (`both`), or only while the stretch grows
                 (`extension`) or decreases (`compression`)
    """

    damper_acts: Literal["both", "extension", "compression"] = "both"

    @model_validator(mode="after")
    def some_force(self):
        if self.elastic is None and self.damper is None:
            raise ScenarioError("nothing acts", "give `elastic`, `damper` or both")
        if self.damper is not None:
            check_damper(self.damper)
        return self


def check_damper(f, backward=True):
    """Refuse a damper that drives, or that acts at rest.

    backward: whether its rate may be below 0.
    """
    if f.kind == "table":
        found = list(zip(f.x, f.y, strict=True))
        if not f.x[0] <= 0.0 <= f.x[-1]:
            raise ScenarioError("the table must hold a rate of 0", "", ("damper", "table"))
        if 0.0 not in f.x:
            what = "without a row at a rate of 0 it may act at rest"
            raise ScenarioError(what, "add a row [0, 0]", ("damper", "table"))
    else:
        found = [(v, of_number(f, RATE, v)) for v in (0.0, *SPEEDS) if backward or v >= 0.0]
    largest = max(abs(y) for _, y in found)
    for x, y in found:
        if x == 0.0 and abs(y) > NOTHING * largest:
            what = f"a damper of {y:g} at rest"
            hint = "its force is 0 where its rate is; what acts at rest is elastic, or friction"
            raise ScenarioError(what, hint, ("damper",))
        if x * y < -NOTHING * abs(x) * largest:
            what = f"at a rate of {x:g} it is {y:g}: it drives, and does not damp"
            raise ScenarioError(what, "the damper has the sign of the rate", ("damper",))


def of_number(f, name, x):
    """The value of a constant or an expression of one name."""
    return f.value if f.kind == "constant" else evaluate(f.node, {name: x})


class Law(Along):
    """Columns of an instance; `coordinate` is its own entry of S."""

    elastic: i8  # f in tab
    damper: i8
    total: i8  # max(0, f + w d) of what only pulls; or -1
    gate: i8
    way: i8
    whole: i8  # f again, which no run holds on a piece: for the energy
    pulls: i8  # 1: it only pulls


def packed_law(spec, at, entry, turns, pulls=False):
    """These columns of a spec, for a stretch that stands in an entry of S."""
    unit = "rad" if turns else "m"
    local = {X: (entry, unit), RATE: (at.rate_of(entry), f"{unit}/s")}
    wanted = "N*m" if turns else "N"
    elastic, damper = spec.elastic or ZERO, spec.damper or ZERO
    way, gate, total = ONE, ONE, None
    if spec.damper is not None and spec.damper_acts != "both":
        way = compared(RATE, ">" if spec.damper_acts == "extension" else "<")
    if pulls:
        gate = compared(X, ">")
        elastic, total = only_pulling(spec, elastic, damper, way)

    def store(f, *path, free=False):
        return at.function(f, *path, wanted=wanted, local=local, free=free)

    return {
        "coordinate": entry,
        "elastic": store(elastic, "elastic"),
        "whole": store(elastic, "elastic", free=True),
        "damper": store(damper, "damper"),
        "total": -1 if total is None else store(total, "damper"),
        "gate": store(gate, "tension_only"),
        "way": store(way, "damper_acts"),
        "pulls": pulls,
    }


def compared(name, sign):
    """1 where what has this name is above zero, or below."""
    return FunctionSpec("expression", node=("binary", sign, ("name", name), ("number", 0.0)))


def only_pulling(spec, elastic, damper, way):
    """The elastic force that never pushes, and max(0, f + w d) where a damper may take it away."""
    if elastic.kind == "table":
        low = min((y for x, y in zip(elastic.x, elastic.y, strict=True) if x >= 0.0), default=0.0)
        if low < 0.0:
            what = f"it pushes with {-low:g} where `tension_only` lets it pull only"
            raise ScenarioError(what, "", ("elastic", "table"))
        if spec.damper is not None and spec.damper_acts != "extension":
            what = "a damper beside a table may push while it is let back"
            hint = "`damper_acts: extension`, or write `elastic` as an expression"
            raise ScenarioError(what, hint, ("damper",))
        return elastic, None
    zero, f = ("number", 0.0), node_of(elastic)
    pulled = FunctionSpec("expression", node=("call", "max", (zero, f)))
    if spec.damper is None:
        return pulled, None
    if damper.kind == "table":
        if spec.damper_acts != "extension":
            what = "a damper by a table may push while it is let back"
            hint = "`damper_acts: extension`, or write it as an expression"
            raise ScenarioError(what, hint, ("damper",))
        return pulled, None
    d = ("binary", "*", node_of(way), node_of(damper))
    both = ("call", "max", (zero, ("binary", "+", f, d)))
    return pulled, FunctionSpec("expression", node=both)


def jump_at_zero(spec):
    """What a spring that only pulls does at once where it becomes taut, N; 0 where its force begins
    at zero, or cannot be told."""
    f = spec.elastic
    if f is None:
        return 0.0
    if f.kind == "table":
        there = f.x[0] <= 0.0 <= f.x[-1] or f.ends == "hold"
        import numpy as np  # checking text needs none

        return max(0.0, float(np.interp(0.0, f.x, f.y))) if there else 0.0
    try:
        at_once, soon = (of_number(f, X, x) for x in TAUT)
    except ScenarioError:
        return 0.0
    return at_once if at_once > 0.5 * max(soon, 0.0) else 0.0


def node_of(f):
    """A constant or an expression as the tree of one."""
    return ("number", f.value) if f.kind == "constant" else f.node


@internal
def tension(t, scene, e):
    """T, and what of it is elastic."""
    own, tab, S = Law(scene, e), scene.tab, scene.S
    gate = value(tab, own.gate, t, S)
    elastic = gate * value(tab, own.elastic, t, S)
    if own.total >= 0:
        return gate * value(tab, own.total, t, S), elastic
    damping = value(tab, own.way, t, S) * value(tab, own.damper, t, S)
    return elastic + gate * damping, elastic


@internal
def store(scene, e):
    """Add its energy to what springs have stored."""
    own = Law(scene, e)
    k = own.coordinate
    x = scene.S[k, 0]
    if own.pulls == 0 or x > 0.0:
        scene.E[SPRINGS] += integral(scene.tab, own.whole, scene.S, k, 0.0, x)
