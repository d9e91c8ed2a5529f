"""Velocities a run starts with: what joints and drives demand, nearest to what was given."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.assemble import assemble
from trsim.assemble.equations import derivative, gaps, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import project_velocities
from trsim.assemble.reduce import in_solve_axes, jacobian, weights, world_rates
from trsim.elements.prescribed import rates_at
from trsim.elements.scene import Model, scene, workspace
from trsim.errors import ModelError
from trsim.solve.angles import follow
from trsim.solve.bars import as_rigid, moving_as_rigid

Array = NDArray[np.float64]


def velocities(scenario: Any, mechanism: Mechanism, y: Array, named: tuple[str, ...]) -> Array:
    """v nearest to the given one (in the metric of M) that the mechanism allows.

    Clearance joints count as ideal, unless a body's velocity is given: then journals may fly.
    A compliant drive starts at its speed too, where nothing stiffer says otherwise.
    After an equilibrium closed stops stay closed, and where that leaves the named joints a choice
    their rates are zero.
    """
    if not mechanism.beams:
        ideal = at_the_start(scenario, named)
        y_ideal = np.zeros(ideal.model.n_q + ideal.model.n_v + ideal.model.n_z)
        n = ideal.model.n_q + ideal.model.n_v
        y_ideal[:n] = y[:n]
        return with_velocities(mechanism.model, y, nearest(ideal, y_ideal, named))
    try:
        stiff = at_the_start(scenario, named)
        v = nearest(stiff, as_rigid(mechanism, stiff, y), named)
        moving = with_velocities(mechanism.model, y, moving_as_rigid(mechanism, stiff, y, v))
    except ModelError:  # it moves only because its bars give way
        moving = y
    return allowed(mechanism.model, moving)


def at_the_start(scenario: Any, named: tuple[str, ...]) -> Mechanism:
    """The mechanism whose velocities a run starts with: ideal joints, stiff bars."""
    given = any(any(s.velocity) or any(s.angular_velocity) for s in scenario.bodies.values())
    joints = scenario.joints.items() if not given else ()
    playing = frozenset(n for n, s in joints if s.type == "clearance_joint")
    return assemble(scenario, playing, coordinates=named, stiff=True)


def nearest(ideal: Mechanism, y: Array, named: tuple[str, ...]) -> Array:
    """World-axes rates nearest to those of y that joints, drives and closed stops allow."""
    model = workspace(ideal.model)
    y_ideal = follow(ideal, y)
    _, phi_t, J = jacobian(model, 0.0, y_ideal)
    rate = -phi_t
    wishes = compliant_drives(ideal, y_ideal)
    if named:
        wishes += [(gradient, 0.0) for gradient in closed_stops(model, y_ideal)]
        wishes += [(coordinate_gradient(model, y_ideal, ideal.coordinates[n].entry), 0.0)
                   for n in named if n in ideal.coordinates]  # fmt: skip
    scale = weights(model)
    for wish, wanted in wishes:  # a wish that contradicts what is fixed already is dropped
        more = np.vstack([J, wish])
        if np.linalg.matrix_rank(more * scale, 1e-8) > np.linalg.matrix_rank(J * scale, 1e-8):
            J, rate = more, np.append(rate, wanted)
    v = world_rates(model, y_ideal)
    if len(J):
        v = v + scale * np.linalg.lstsq(J * scale, rate - J @ v, rcond=1e-10)[0]
    left = np.max(np.abs(J @ v - rate), initial=0.0)
    if left > 1e-6 * max(1.0, np.max(np.abs(rate), initial=0.0)):
        raise ModelError(
            f"no velocities at t = 0 satisfy the joints and drives (off by {left:.3g})",
            "two drives on one degree of freedom, or a start in a dead centre?",
        )
    return np.asarray(v)


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
        _, _, entry, state, _, offset = instance.row.con[:6]
        prescribed = np.zeros(3)
        rates_at(mechanism.model.tab, offset, 0.0, prescribed)
        gradient = coordinate_gradient(mechanism.model, y, entry)
        found.append((gradient, float(prescribed[0 if state >= 0 else 1])))
    return found


def closed_stops(model: Model, y: Array) -> list[Array]:
    """Gradients of the gap rates of contacts that are closed at y."""
    w = workspace(model)
    poses(w, y)
    gaps(w, 0.0)
    closed = [e for e in model.contact.tolist() if w.gap[e, 0] > 0.0]

    def rate(moving: Array, e: int) -> float:
        poses(w, moving)
        gaps(w, 0.0)
        return float(w.gap[e, 1])

    return [twist_gradient(model, y, lambda moving, e=e: rate(moving, e)) for e in closed]


def with_velocities(model: Model, y: Array, v: Array) -> Array:
    """y with the given world-axes rates (6 (n-1)) of the moving frames."""
    w = workspace(model)
    poses(w, y)
    y = y.copy()
    y[model.n_q : model.n_q + model.n_v] = in_solve_axes(w, v)
    return y


def coordinate_gradient(model: Model, y: Array, s: int) -> Array:
    """Rate of a joint coordinate per unit of every world-axes rate."""
    w = workspace(model)

    def rate(moving: Array) -> float:
        poses(w, moving)
        return float(w.S[s, 1])

    return twist_gradient(model, y, rate)


def twist_gradient(model: Model, y: Array, rate: Callable[[Array], float]) -> Array:
    """A rate, linear in the velocities, per unit of every world-axes rate."""
    gradient = np.zeros(6 * (model.n - 1))
    for k in range(gradient.size):
        unit = np.zeros_like(gradient)
        unit[k] = 1.0
        gradient[k] = rate(with_velocities(model, y, unit))
    return gradient
