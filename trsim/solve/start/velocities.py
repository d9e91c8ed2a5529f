"""Velocities a run starts with: what joints and drives demand, nearest to what was given."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim import elements
from trsim.assemble.assemble import assemble
from trsim.assemble.dense import length, product, spaces
from trsim.assemble.equations import derivative, gaps, poses
from trsim.assemble.instances import Instance
from trsim.assemble.light import given_back, nearest_in_mass
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.onward import Branches
from trsim.assemble.projection import project_velocities
from trsim.assemble.rank import of_length_one, plainly_independent
from trsim.assemble.reduce import (
    in_solve_axes,
    jacobian,
    moves,
    roots,
    shortest,
    weights,
    world_rates,
)
from trsim.elements.coordinates import of_joint, split
from trsim.elements.prescribed import AnyDrive, rates_at
from trsim.elements.rows import ARC
from trsim.elements.scene import Model, Scene, scene, workspace
from trsim.errors import ModelError
from trsim.solve.start.angles import as_of, follow, posed
from trsim.solve.start.bars import as_rigid, moving_as_rigid

Array = NDArray[np.float64]

SAME = 1e-6  # of its size: how far a rate may be from what the others make it
ROUNDING = 1e-12  # of the velocities of all bodies: what is none in a rate
INDEPENDENT = 1e-8  # of its own size: what must be left of a wish that is not fixed already


def velocities(scenario: Any, mechanism: Mechanism, y: Array, named: tuple[str, ...]) -> Array:
    """v nearest to the given one (in the metric of M) that the mechanism allows.

    Clearance joints count as ideal, unless a body's velocity is given: then journals may fly.
    A compliant drive starts at its speed too, where nothing stiffer says otherwise, and then what
    bushings hold is at rest, unless a body's velocity is given: they would spring back as soon as
    the motion begins.
    After an equilibrium closed stops stay closed, and where that leaves the named joints a choice
    their rates are zero.  Before all these wishes come the rates of joints that `initial` gives.
    """
    rates = scenario.initial.rates
    if not mechanism.beams:
        ideal = at_the_start(scenario, mechanism, named)
        y_ideal = as_of(ideal, y)
        v = nearest(ideal, y_ideal, named, not given(scenario), rates)
        return with_velocities(mechanism.model, y, v)
    try:
        stiff = at_the_start(scenario, mechanism, named)
        v = nearest(stiff, as_rigid(mechanism, stiff, y), named, not given(scenario), rates)
        moving = with_velocities(mechanism.model, y, moving_as_rigid(mechanism, stiff, y, v))
    except ModelError:
        if rates:
            raise
        moving = y  # it moves only because its bars give way
    return allowed(mechanism.model, moving)


def given(scenario: Any) -> bool:
    """Whether somebody wrote down how a body moves at the start."""
    return any(any(s.velocity) or any(s.angular_velocity) for s in scenario.bodies.values())


def at_the_start(scenario: Any, mechanism: Mechanism, named: tuple[str, ...]) -> Mechanism:
    """The mechanism whose velocities a run starts with: ideal joints, stiff bars."""
    joints = scenario.joints.items() if not given(scenario) else ()
    playing = frozenset(n for n, s in joints if elements.load(s.type).ideal)
    named += tuple(split(own, scenario.joints)[0] for own in scenario.initial.rates)
    named = tuple(n for n in named if ARC not in of_joint(n, scenario.joints).values())
    wanted = {own for n in named for own in of_joint(n, scenario.joints)}
    if not playing and not mechanism.beams and wanted <= {*mechanism.coordinates}:
        return mechanism
    return assemble(scenario, playing, coordinates=named, stiff=True, planar=mechanism.planar)


def nearest(
    ideal: Mechanism, y: Array, named: tuple[str, ...], held: bool, rates: Mapping[str, float]
) -> Array:
    """World-axes rates nearest to those of y that joints, drives and closed stops allow.

    held: whether what bushings hold is to be at rest; rates: those that joints must have.
    """
    model = workspace(ideal.model)
    ideal = replace(ideal, model=model)  # one workspace for all that follows
    y_ideal = follow(ideal, y)
    _, phi_t, J = jacobian(model, 0.0, y_ideal)
    rate = -phi_t
    turned = [(ideal.coordinates[name], value) for name, value in rates.items()]
    asked = [(rate_of_entry(model, y_ideal, x.entry, (x.i, x.j)), f) for x, f in turned]
    wishes = asked + compliant_drives(ideal, y_ideal)
    wishes += [(gradient, 0.0) for gradient in (of_springs(ideal, y_ideal) if held else ())]
    if named:
        wishes += [(gradient, 0.0) for gradient in closed_stops(ideal, y_ideal)]
        moving = [x for n in named for x in ideal.coordinates.values() if x.joint == n]
        wishes += [(rate_of_entry(model, y_ideal, x.entry, (x.i, x.j)), 0.0) for x in moving]
    scale = weights(model)
    kept = independent(J * scale, [gradient * scale for gradient, _ in wishes])
    bound = J  # by joints and drives
    J = np.vstack([J, *(wishes[k][0] for k in kept)])
    rate = np.append(rate, [wishes[k][1] for k in kept])
    v = world_rates(model, y_ideal)
    planar = model.d == 3
    C = roots(model, y_ideal, planar)
    if len(J):
        v = nearest_in_mass(
            len(model.light),
            v,
            lambda w: w + shortest(J, C, rate - product(J, w)),
            lambda w: given_back(model, C, w),
        )
    left = np.max(np.abs(J @ v - rate), initial=0.0)
    if left > 1e-6 * max(1.0, np.max(np.abs(rate), initial=0.0)):
        raise ModelError(
            f"no velocities at t = 0 satisfy the joints and drives (off by {left:.3g})",
            "two drives on one degree of freedom, or a start in a dead centre?",
        )
    check_rates(ideal, rates, [g * scale for g, _ in asked], bound * scale, v / scale)
    if ideal.beams or not len(J):
        return np.asarray(v)
    rows, there = list(range(model.m + len(model.redundant))), moves(model, planar)
    alone = of_length_one(bound[:, there], scale[there])
    if not len(model.redundant) and plainly_independent(alone):
        return np.asarray(v)  # without self-stresses every velocity goes on
    branches = Branches(model, y_ideal, rows, J[model.m :], there, C)
    return branches.onward(np.asarray(v))


def check_rates(
    mechanism: Mechanism, rates: Mapping[str, float], gradients: list[Array], J: Array, v: Array
) -> None:
    """Refuse a rate that joints, drives and the rates before it do not allow.

    gradients: of the rates; J: rows of joints and drives; v: the velocities they left possible.
    """
    before: list[str] = []
    for (name, value), gradient in zip(rates.items(), gradients, strict=True):
        found, size = float(np.sum(gradient * v)), float(np.sum(np.abs(gradient * v)))
        alone = not independent(J, [gradient])
        none = ROUNDING * length(gradient) * length(v)
        if abs(found - value) > SAME * max(size, abs(value)) + none:
            unit = {"angle": "rad/s", "stroke": "m/s"}[mechanism.coordinates[name].kind]
            others = "" if alone else "".join(f"{other}.rate, " for other in before)
            hint = "give no more rates than there are free motions, or those that fit together"
            raise ModelError(
                f"{value:g} {unit} contradicts {others}joints and drives: they make it "
                f"{found:.6g} {unit}",
                hint,
                ("initial", f"{name}.rate"),
            )
        if not alone:
            before.append(name)


def independent(J: Array, wishes: list[Array]) -> list[int]:
    """Which wishes, one after the other, are not fixed by the rows of J and the wishes before."""
    basis = np.zeros((0, J.shape[1]))
    if len(J):
        basis, _ = spaces(J, INDEPENDENT)
    kept = []
    for k, wish in enumerate(wishes):
        left = wish - product(basis.T, product(basis, wish))
        left -= product(basis.T, product(basis, left))
        size = length(left)
        if size > INDEPENDENT * length(wish):
            basis = np.vstack([basis, left / size])
            kept.append(k)
    return kept


def allowed(model: Model, y: Array) -> Array:
    """y with the nearest velocities that the constraints allow: a bent bar is no rigid one."""
    w, y = scene(model), y.copy()
    derivative(w, 0.0, y, np.zeros_like(y))
    project_velocities(w, y)
    return y


def compliant_drives(mechanism: Mechanism, y: Array) -> list[tuple[Array, float]]:
    """Gradient and prescribed rate of the joint coordinates that compliant drives move."""
    found = []
    for instance in mechanism.instances:
        if instance.section != "drives" or not instance.row.is_force:
            continue
        own = AnyDrive.of(instance.row)
        f, f_dot, _ = rates_at(mechanism.model.tab, own.motion, 0.0)
        gradient = rate_of_entry(mechanism.model, y, own.coordinate, (own.i, own.j))
        found.append((gradient, f if own.state >= 0 else f_dot))
    return found


def of_springs(mechanism: Mechanism, y: Array) -> list[Array]:
    """Gradients of the rates of what springs hold: along and about their stiff directions."""
    w = posed(mechanism.model, y)
    found = []
    for instance in mechanism.instances:
        if instance.element.springs is None or not instance.acts:
            continue
        i, j = instance.row.con[:2]
        axes, place, along, about = map(np.array, instance.element.springs(instance.row))
        R_i, R_j = (w.X[f, 3:].reshape(3, 3) for f in (i, j))
        place = w.X[j, :3] + product(R_j, place)
        for k, a in enumerate(product(axes, R_i.T)):
            if along[k] > 0.0:
                found.append(twist_row(w.n, (i, j), a, [place - w.X[f, :3] for f in (i, j)]))
            if about[k] > 0.0:
                found.append(twist_row(w.n, (i, j), a))
    return found


def twist_row(
    n: int, frames: tuple[int, int], axis: Array, arms: list[Array] | None = None
) -> Array:
    """Rate of frame j against frame i along an axis at a place, or about it without arms."""
    row = np.zeros((n, 6))
    for k, (f, sign) in enumerate(zip(frames, (-1.0, 1.0), strict=True)):
        if arms is None:
            row[f, 3:] += sign * axis
        else:
            row[f] += sign * np.concatenate([axis, np.cross(arms[k], axis)])
    return row[1:].ravel()


def closed_stops(mechanism: Mechanism, y: Array) -> list[Array]:
    """Gradients of the gap rates of contacts that are closed at y."""
    model = mechanism.model
    w = posed(model, y)
    gaps(w, 0.0)
    closed = [e for e in model.contact.tolist() if w.gap[e, 0] > 0.0]
    return [gap_gradient(w, y, mechanism.instances[e], e) for e in closed]


def gap_gradient(w: Scene, y: Array, instance: Instance, e: int) -> Array:
    """The rate of the gap of an instance per unit of world-axes rates."""

    def rate(moving: Array) -> float:
        poses(w, moving)
        gaps(w, 0.0)
        return float(w.gap[e, 1])

    return twist_gradient(w, y, rate, instance.element.acts_on(instance.row))


def with_velocities(model: Model, y: Array, v: Array) -> Array:
    """y with the given world-axes rates (6 (n-1)) of the moving frames."""
    w = posed(model, y)
    y = y.copy()
    y[model.n_q : model.n_q + model.n_v] = in_solve_axes(w, v)
    return y


def rate_of_entry(model: Model, y: Array, s: int, frames: Iterable[int]) -> Array:
    """Rate of an entry of S, a coordinate between some frames, per unit of world-axes rates."""
    w = workspace(model)

    def rate(moving: Array) -> float:
        poses(w, moving)
        return float(w.S[s, 1])

    return twist_gradient(model, y, rate, frames)


def twist_gradient(
    model: Model, y: Array, rate: Callable[[Array], float], frames: Iterable[int]
) -> Array:
    """A rate, linear in the velocities of some frames, per unit of every world-axes rate."""
    gradient = np.zeros(6 * (model.n - 1))
    for k in (6 * (f - 1) + c for f in frames if f > 0 for c in range(6)):
        unit = np.zeros_like(gradient)
        unit[k] = 1.0
        gradient[k] = rate(with_velocities(model, y, unit))
    return gradient
