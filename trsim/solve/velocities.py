"""Velocities a run starts with: what joints and drives demand, nearest to what was given."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.assemble import assemble
from trsim.assemble.equations import gaps, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import jacobian, weights
from trsim.elements.drive import K, rates_at
from trsim.elements.scene import Model, workspace
from trsim.errors import ModelError
from trsim.solve.angles import follow

Array = NDArray[np.float64]


def velocities(scenario: Any, mechanism: Mechanism, y: Array, named: tuple[str, ...]) -> Array:
    """v nearest to the given one (in the metric of M) that the mechanism allows.

    Clearance joints count as ideal, unless a body's velocity is given: then journals may fly.
    A compliant drive starts at its speed too, where nothing stiffer says otherwise.
    After an equilibrium closed stops stay closed, and where that leaves the named joints a choice
    their rates are zero.
    """
    given = any(any(s.velocity) or any(s.angular_velocity) for s in scenario.bodies.values())
    joints = scenario.joints.items() if not given else ()
    playing = frozenset(n for n, s in joints if s.type == "clearance_joint")
    ideal = assemble(scenario, playing, coordinates=named)
    model = workspace(ideal.model)
    y_ideal = np.zeros(model.n_q + model.n_v + model.n_z)
    n = model.n_q + model.n_v
    y_ideal[:n] = y[:n]
    y_ideal = follow(ideal, y_ideal)
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
    v = world_velocities(model, y_ideal)
    if len(J):
        v = v + scale * np.linalg.lstsq(J * scale, rate - J @ v, rcond=1e-10)[0]
    left = np.max(np.abs(J @ v - rate), initial=0.0)
    if left > 1e-6 * max(1.0, np.max(np.abs(rate), initial=0.0)):
        raise ModelError(
            f"no velocities at t = 0 satisfy the joints and drives (off by {left:.3g})",
            "two drives on one degree of freedom, or a start in a dead centre?",
        )
    return with_velocities(mechanism.model, y, v)


def compliant_drives(mechanism: Mechanism, y: Array) -> list[tuple[Array, float]]:
    """Gradient and prescribed rate of the joint coordinates that compliant drives move."""
    found = []
    for instance in mechanism.instances:
        if instance.element.key != "drive" or instance.row.par[K] == 0.0:
            continue
        _, _, entry, state, _, offset = instance.row.con
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


def world_velocities(model: Model, y: Array) -> Array:
    """World-axes twists of the moving frames, one vector."""
    w = workspace(model)
    poses(w, y)
    return w.V[1:].ravel().copy()


def with_velocities(model: Model, y: Array, v: Array) -> Array:
    """y with the given world-axes twists."""
    w = workspace(model)
    poses(w, y)
    y = y.copy()
    for f in range(1, model.n):
        twist = v[6 * (f - 1) : 6 * f]
        o = model.n_q + model.d * (f - 1)
        if model.d == 3:
            y[o : o + 3] = twist[[0, 1, 5]]
        else:
            y[o : o + 3] = twist[:3]
            y[o + 3 : o + 6] = w.X[f, 3:].reshape(3, 3).T @ twist[3:]
    return y


def coordinate_gradient(model: Model, y: Array, s: int) -> Array:
    """Rate of a joint coordinate per unit of every twist component."""
    w = workspace(model)

    def rate(moving: Array) -> float:
        poses(w, moving)
        return float(w.S[s, 1])

    return twist_gradient(model, y, rate)


def twist_gradient(model: Model, y: Array, rate: Callable[[Array], float]) -> Array:
    """A rate, linear in the velocities, per unit of every twist component."""
    gradient = np.zeros(6 * (model.n - 1))
    for k in range(gradient.size):
        unit = np.zeros_like(gradient)
        unit[k] = 1.0
        gradient[k] = rate(with_velocities(model, y, unit))
    return gradient
