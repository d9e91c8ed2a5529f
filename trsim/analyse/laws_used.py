"""The laws of a run as it used them: functions of one variable, contacts, friction, curves.

Functions are evaluated by the code that runs use, beyond the ends of their tables too.  The range a
run visited is that of the motion where its extremes are kept; where only the stretch of a spring
is recorded, the range of its rate is that of differences of rows, which it covers at least.

    contact     F(d) at rest, and the loop of an impact: d' = v0 sqrt(1 - E(d)/E(d_max)) on the way
                in, -e times that on the way out, E being the stored energy
    friction    |F| / F_n over the sliding speed; of bristles the steady state
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from trsim import expressions
from trsim.analyse.extremes import LARGEST, SMALLEST, extreme
from trsim.analyse.window import scalar_channel, window
from trsim.arrays import Array
from trsim.elements.curve import Curve, sampled
from trsim.elements.friction_law import Friction
from trsim.elements.prescribed import rates_along
from trsim.elements.sprung import RATE, X
from trsim.errors import UsageError
from trsim.fields import Spec
from trsim.laws import functions
from trsim.laws.contact import Pair, delivered_restitution, elastic, stored
from trsim.laws.tables import smoothstep
from trsim.scenario.load import loads, unit_of
from trsim.store.read import Run
from trsim.varying import FunctionSpec

POINTS = 2001  # of a curve
SECTIONS = ("joints", "drives", "sensors", "forces", "events")
OUTSIDE = {"hold": "held", "extrapolate": "extended", "refuse": "an error"}


class Law(NamedTuple):
    """A law with its curves; numbers are SI.

    name     forces.seal.elastic
    said     what it is, in words
    x, y     what it is a law of, and what it gives, with their units
    curves   by their names
    data     the points it was given by, if it was
    met      what the run did, of contacts: at its steps in touch
    visited  range of x; None where it is not known, with the reason in `why`
    path     a line in a plane: y over x is what it looks like, and its visited part a curve
    """

    name: str
    said: str
    x: str
    y: str
    x_unit: str
    y_unit: str
    curves: dict[str, tuple[Array, Array]]
    data: tuple[Array, Array] | None = None
    met: tuple[Array, Array] | None = None
    visited: tuple[float, float] | None = None
    why: str = ""
    path: bool = False


class Range(NamedTuple):
    """What a run visited of a variable; nan where it is not known."""

    low: float
    high: float
    unit: str
    why: str = ""


def laws(run: Run) -> tuple[list[Law], list[str]]:
    """All laws of a run, and why some have no curve."""
    scenario = loads(run.text("scenario/resolved"))
    found, lost = [], []
    for section in SECTIONS:
        for name, spec in getattr(scenario, section).items():
            for path, value in inner(spec):
                full = ".".join((section, name, *path))
                try:
                    found += of_value(run, name, spec, full, path, value)
                except UsageError as error:
                    lost.append(f"{full}: {error.what}")
    for name in run.contacts:
        own = list(of_contact(run, scenario, name))
        found += own
        lost += [] if own else [f"contact.{name}: its force is no curve over a depth"]
    return found, lost


def inner(spec: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Functions, friction and curves of a spec, by their keys."""
    if isinstance(spec, FunctionSpec | Friction | Curve):
        yield path, spec
    elif isinstance(spec, Spec):
        for key in type(spec).model_fields:
            yield from inner(getattr(spec, key), (*path, key))
    elif isinstance(spec, tuple | list | dict):
        for k, one in spec.items() if isinstance(spec, dict) else enumerate(spec):
            yield from inner(one, (*path, str(k)))


def of_value(
    run: Run, name: str, spec: Spec, full: str, path: tuple[str, ...], value: Any
) -> list[Law]:
    """The law that stands at a key, if there is one."""
    if isinstance(value, Curve):
        return [of_curve(run, name, full, value)]
    if isinstance(value, Friction):
        return [of_friction(run, name, full, value)] if value.law != "none" else []
    if value.kind == "constant":
        return []
    return [of_function(run, name, spec, full, path[0], value)]


# --- functions -------------------------------------------------------------------------------


def of_function(run: Run, name: str, spec: Any, full: str, key: str, f: FunctionSpec) -> Law:
    """A function of one variable.  Raises UsageError where it has several, or no range."""
    variables = {f.of} if f.kind == "table" else expressions.names(f.node) - {"pi"}
    if len(variables) != 1:
        what = (
            f"depends on {' and '.join(sorted(variables)) or 'nothing'}: no curve of one variable"
        )
        raise UsageError(what)
    [x] = variables
    met = visited(run, name, spec, x)
    value = evaluated(f, x)
    low, high = (f.x[0], f.x[-1]) if f.kind == "table" else (met.low, met.high)
    if not np.isfinite(low + high):
        raise UsageError(f"its variable {x} is not recorded, so there is no range to draw it over")
    ends = [low, high, *([met.low, met.high] if np.isfinite(met.low) else [])]
    pulls = getattr(spec, "tension_only", False) and key == "elastic"
    slack = (0.0,) if pulls and min(ends) < 0.0 < max(ends) else ()
    grid = spread(min(ends), max(ends), (*f.x, *slack))
    y = value(grid)
    if pulls:
        y = np.where(grid > 0.0, np.maximum(y, 0.0), 0.0)
    given = (np.array(f.x), np.array(f.y)) if f.kind == "table" else None
    told = in_words(f, met)
    known = (met.low, met.high) if np.isfinite(met.low) else None
    unit = unit_there(run, name, spec, key)
    return Law(full, told, x, key, met.unit, unit, {"law": (grid, y)}, given, None, known, met.why)


def evaluated(f: FunctionSpec, x: str) -> Callable[[Array], Array]:
    """The function as runs evaluate it, of its one variable."""
    if f.kind == "table":
        numbers = functions.table(f.x, f.y, -1, f.ends, f.interpolation)
    else:
        numbers = functions.expression(expressions.renamed(f.node, {x: "t"}), {})
    tab = np.array(numbers)
    return lambda at: rates_along(tab, 0, at)[:, 0]


def in_words(f: FunctionSpec, met: Range) -> str:
    if f.kind == "expression":
        return expressions.written(f.node)
    told = f"table of {len(f.x)} rows, {f.interpolation}; outside {OUTSIDE[f.ends]}"
    if met.low < f.x[0] or met.high > f.x[-1]:
        told += "; the run leaves it"
    return told


def spread(low: float, high: float, data: tuple[float, ...]) -> Array:
    """Places to draw a curve at, the points it was given by among them."""
    if not high > low:
        low, high = low - 0.05 * max(abs(low), 1e-9), high + 0.05 * max(abs(high), 1e-9)
    return np.unique(np.concatenate([np.linspace(low, high, POINTS), data]))


def visited(run: Run, name: str, spec: Any, x: str) -> Range:
    """What a run visited of the variable of a function."""
    if x == "t":
        told = run.parts.get(name)
        if told is None:
            return Range(np.nan, np.nan, "s", "an event begins its time anew")
        since = "unless an event ended it" if told.section == "drives" and any(run.fired) else ""
        return Range(float(run.time[0]) if run.rows else 0.0, run.reached, "s", since)
    if x in (X, RATE):
        return stretched(run, name, spec, x)
    if not run.stores(x):
        return Range(np.nan, np.nan, "-", f"{x} is not recorded")
    return of_channel(run, x)


def of_channel(run: Run, channel: str, shift: float = 0.0) -> Range:
    whole = window(run)
    low, high = (extreme(run, word, channel, whole, part=False).value - shift
                 for word in (SMALLEST, LARGEST))  # fmt: skip
    return Range(low, high, run.unit(channel))


def stretched(run: Run, name: str, spec: Any, x: str) -> Range:
    """The stretch of a spring, or its rate."""
    channel, shift = f"{name}.stretch", 0.0
    if not run.stores(channel):
        channel = f"{name}.length"
        if not run.stores(channel):
            unit = "m" if x == X else "m/s"
            return Range(np.nan, np.nan, unit, f"the stretch of {name} is not recorded")
        p, q = np.array(spec.points)
        shift = float(np.linalg.norm(q - p)) if spec.free_length is None else spec.free_length
    if x == X:
        return of_channel(run, channel, shift)
    unit = f"{run.unit(channel)}/s"
    step = np.diff(run.time)
    rate = np.diff(scalar_channel(run, channel))[step > 0.0] / step[step > 0.0]
    if not rate.size:
        return Range(np.nan, np.nan, unit, "there are no two rows")
    return Range(float(rate.min()), float(rate.max()), unit, "from differences of rows, at least")


def unit_there(run: Run, name: str, spec: Any, key: str) -> str:
    """The unit of what a key gives: of those it may have the one that a channel has."""
    given = unit_of(type(spec), key)
    units = given.units if given else ("-",)
    own = {run.units[c] for c in run.names if c.startswith(f"{name}.") or c == name}
    fitting = [unit for unit in units if unit in own]
    return fitting[0] if fitting else " or ".join(units)


# --- friction --------------------------------------------------------------------------------


def of_friction(run: Run, name: str, full: str, law: Friction) -> Law:
    """Coefficient of friction over the sliding speed."""
    channel = f"{name}.sliding_speed"
    met = of_channel(run, channel) if run.stores(channel) else Range(
        np.nan, np.nan, "m/s", "its sliding speed is not recorded")  # fmt: skip
    fastest = max(abs(met.low), abs(met.high)) if np.isfinite(met.low) else 0.0
    corner = law.v1 or 3.0 * (law.stribeck_speed or 0.0)
    speeds = spread(0.0, max(fastest, 2.0 * corner, 1e-6), (law.v0 or 0.0, law.v1 or 0.0))
    mu = np.array([coefficient(law, v) for v in speeds.tolist()])
    range_ = (0.0 if met.low <= 0.0 <= met.high else min(abs(met.low), abs(met.high)), fastest)
    known = range_ if np.isfinite(met.low) else None
    return Law(full, f"friction {law.law}", "sliding speed", "coefficient", "m/s", "-",
               {"law": (speeds, mu)}, visited=known, why=met.why)  # fmt: skip


def coefficient(law: Friction, v: float) -> float:
    """|F| / F_n at a steady sliding speed."""
    mu = law.coefficient or 0.0
    if law.law == "modified_coulomb":
        low, high = law.v0 or 0.0, law.v1 or 0.0
        return mu * float(np.clip((v - low) / (high - low), 0.0, 1.0))
    if law.law == "sticking":
        held = law.static_coefficient or mu
        return mu + (held - mu) * float(np.exp(-((v / (law.stribeck_speed or 1.0)) ** 2)))
    return mu


# --- contacts --------------------------------------------------------------------------------


def of_contact(run: Run, scenario: Any, name: str) -> Iterator[Law]:
    """Force over depth, and the friction of its law."""
    spec = scenario.joints.get(name) or scenario.forces.get(name.partition(".")[0])
    steps = run.steps(name)
    if spec is None or not {"penetration", "normal_force"} <= {*steps}:
        return
    met = steps["penetration"], steps["normal_force"]
    deepest = max(0.0, of_channel(run, f"{name}.penetration").high
                  if run.stores(f"{name}.penetration") else max(met[0], default=0.0))  # fmt: skip
    fastest = float(run.summary["contacts"][name]["fastest_impact"])
    depth = np.linspace(0.0, deepest or 1e-6, POINTS)
    unit = "rad" if run.contact_unit(name, "normal_force") == "N*m" else "m"
    if hasattr(spec, "clearance"):
        key = spec.contact or next(iter(scenario.contact_laws))
        law = scenario.contact_laws[key]
        curves, told = hertzian(law, spec.clearance, depth, fastest), f"{law.normal}, {key}"
        if law.friction.law != "none":
            yield of_friction(run, name, f"contact_laws.{key}.friction.{name}", law.friction)
    elif hasattr(spec, "surface"):
        key = spec.contact or next(iter(scenario.contact_laws))
        law = scenario.contact_laws[key]
        curves, told = on_surface(spec, law, depth, fastest), f"{law.normal}, {key}"
        if law.friction.law != "none":
            yield of_friction(run, name, f"contact_laws.{key}.friction.{name}", law.friction)
    elif hasattr(spec, "ramp"):
        curves, told = stopped(spec, depth, fastest), "stop"
    else:
        return
    yield Law(f"contact.{name}", told, "depth", "normal_force", unit,
              run.contact_unit(name, "normal_force"), curves, None, met, (0.0, deepest),
              deepest_at(steps) if len(met[0]) else "it never touched")  # fmt: skip


def deepest_at(steps: dict[str, Array]) -> str:
    """Where a surface was pressed in most, of all steps in touch."""
    if "place" not in steps:
        return ""
    k = int(np.argmax(steps["penetration"]))
    x, y, z = (float(c) for c in steps["place"][k])
    place = f"[{x:.5g}, {y:.5g}]" if z == 0.0 else f"[{x:.5g}, {y:.5g}, {z:.5g}]"
    return f"deepest at {place} m of the surface, at {float(steps['time'][k]):.6g} s"


def on_surface(spec: Any, law: Any, depth: Array, fastest: float) -> dict[str, Any]:
    """The same of a ball on a surface; a damper that fades in has no loop of its own."""
    surface = spec.surface
    bend = {"plane": 0.0, "sphere": (-1.0 if surface.hollow else 1.0) / (surface.radius or 1.0)}
    normal = law.on_surface(spec.ball.radius, bend.get(surface.shape))
    looped = fastest if law.normal != "impact" else 0.0
    return impacted(Pair(normal.stiffness, normal.exponent, 0.0, 0, normal.chi), depth, looped)


def hertzian(law: Any, clearance: float, depth: Array, fastest: float) -> dict[str, Any]:
    """The force of a joint with clearance at rest, and the loop of an impact."""
    K, n, form, chi, _ = law.normal_numbers(clearance)
    return impacted(Pair(K, n, clearance, form, chi), depth, fastest)


def impacted(pair: Pair, depth: Array, fastest: float) -> dict[str, Any]:
    """The force at rest, and the loop of an impact."""
    chi = pair.chi
    rest = np.array([elastic.python(d, pair) for d in depth.tolist()])
    energy = np.array([stored.python(d, pair) for d in depth.tolist()])
    share = np.sqrt(np.maximum(0.0, 1.0 - energy / energy[-1]))
    into = np.maximum(0.0, rest * (1.0 + chi * share))
    out = np.maximum(0.0, rest * (1.0 - chi * float(delivered_restitution(chi)) * share))
    loop = np.concatenate([depth, depth[::-1]]), np.concatenate([into, out[::-1]])
    return (
        {"at rest": (depth, rest), "impact": loop} if fastest > 0.0 else {"at rest": (depth, rest)}
    )


def stopped(spec: Any, depth: Array, fastest: float) -> dict[str, Any]:
    """The same of a stop: a spring with a damper that fades in."""
    rest = spec.stiffness * depth
    share = np.sqrt(np.maximum(0.0, 1.0 - (depth / depth[-1]) ** 2))
    ramp = np.array([smoothstep.python(min(d / spec.ramp, 1.0)) for d in depth.tolist()])
    damped = spec.damping * ramp * fastest * share
    loop = (np.concatenate([depth, depth[::-1]]),
            np.concatenate([rest + damped, np.maximum(0.0, rest - damped)[::-1]]))  # fmt: skip
    return (
        {"at rest": (depth, rest), "impact": loop} if fastest > 0.0 else {"at rest": (depth, rest)}
    )


# --- curves ----------------------------------------------------------------------------------


def of_curve(run: Run, name: str, full: str, spec: Curve) -> Law:
    """A curve in its own coordinates, and the part of it that was visited."""
    curve = sampled(spec)
    x, y = curve.place.T
    curves = {"law": (x, y)}
    channel, why, range_ = f"{name}.arc", "", None
    if run.stores(channel):
        met = of_channel(run, channel)
        range_ = met.low, met.high
        curves["visited"] = part(curve, *range_)
    else:
        why = "the place along it is not recorded"
    points = spec.points if spec.points is not None else spec.table
    given = None if points is None else tuple(np.array(points).T)
    kind = "expressions" if given is None else f"spline through {len(given[0])} points"
    told = f"{kind}, {'closed' if curve.closed else 'open'}, {curve.length:.6g} m long"
    return Law(full, told, "x", "y", "m", "m", curves, given, None, range_, why, path=True)


def part(curve: Any, low: float, high: float) -> tuple[Array, Array]:
    """The places of a curve between two lengths along it."""
    along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(curve.place, axis=0), axis=1)))
    along *= curve.length / along[-1]
    if curve.closed and high - low >= curve.length:
        low, high = 0.0, curve.length
    at = np.linspace(low, high, POINTS)
    at = np.mod(at, curve.length) if curve.closed and high - low < curve.length else at
    return np.interp(at, along, curve.place[:, 0]), np.interp(at, along, curve.place[:, 1])
