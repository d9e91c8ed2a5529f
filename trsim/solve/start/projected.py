"""What the start of a run changed in the drawing: residuals before and after, and how far."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import jacobian, world_rates
from trsim.elements.scene import Model, workspace
from trsim.solve.start.angles import follow, posed
from trsim.solve.start.bars import moving
from trsim.solve.start.consistent import Start

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Projected:
    """What the start changed in the drawing.

    position_before  largest residual of the constraints as drawn, m or rad
    position_after   and at the start
    position_row     whose was the largest, "joint.axis"; "" for none
    velocity_before  largest residual of their rates with the velocities given, m/s or rad/s
    velocity_after   and at the start
    velocity_row     whose was the largest
    shift            longest way of a centre of mass from where it is drawn, m
    shift_body       whose
    turn             largest turn of a body from how it is drawn, rad
    turn_body        whose
    slip             largest change of a velocity that was given, m/s
    slip_body        whose
    spin             largest change of an angular velocity that was given, rad/s
    spin_body        whose
    """

    position_before: float
    position_after: float
    position_row: str
    velocity_before: float
    velocity_after: float
    velocity_row: str
    shift: float
    shift_body: str
    turn: float
    turn_body: str
    slip: float
    slip_body: str
    spin: float
    spin_body: str


def projected(mechanism: Mechanism, begun: Start) -> Projected:
    """Compare a start with the drawing."""
    model = workspace(mechanism.model)
    mechanism = replace(mechanism, model=model)  # one workspace for all that follows
    as_drawn = follow(mechanism, mechanism.y0)
    before, after = (np.abs(jacobian(model, 0.0, y)[0]) for y in (as_drawn, begun.y))
    slip, left = rates(model, as_given(mechanism, begun)), rates(model, begun.y)
    X, X0 = placed(model, begun.y), placed(model, as_drawn)
    ways = np.linalg.norm(X[:, :3] - X0[:, :3], axis=1)
    turns = [angle(a[3:].reshape(3, 3), b[3:].reshape(3, 3)) for a, b in zip(X, X0, strict=True)]
    names = list(moving(mechanism))
    slips, spins = changes(mechanism, begun)
    return Projected(
        *(largest(before), largest(after), worst(before, mechanism.rows)),
        *(largest(slip), largest(left), worst(slip, mechanism.rows)),
        *(largest(ways), worst(ways, names)),
        *(largest(np.array(turns)), worst(np.array(turns), names)),
        *(largest(slips), worst(slips, names)),
        *(largest(spins), worst(spins, names)),
    )


def as_given(mechanism: Mechanism, begun: Start) -> Array:
    """y of the start with the velocities that were given."""
    given, y = slice(mechanism.model.n_q, mechanism.model.n_q + mechanism.model.n_v), begun.y.copy()
    y[given] = mechanism.y0[given]
    return y


def given_velocities(mechanism: Mechanism, begun: Start) -> Array:
    """World-axes rates of the bodies at their places of the start, as given, (n - 1, 6)."""
    return world_rates(mechanism.model, as_given(mechanism, begun)).reshape(-1, 6)


def changes(mechanism: Mechanism, begun: Start) -> tuple[Array, Array]:
    """|change| of every velocity (m/s) and angular velocity (rad/s) that is not given as zero."""
    was = given_velocities(mechanism, begun)
    now = world_rates(mechanism.model, begun.y).reshape(-1, 6)
    parts = (slice(3), slice(3, 6))
    slips, spins = (
        np.linalg.norm(now[:, k] - was[:, k], axis=1) * np.any(was[:, k], axis=1) for k in parts
    )
    return slips, spins


def rates(model: Model, y: Array) -> Array:
    """|J v + Phi_t| of every row."""
    _, phi_t, J = jacobian(model, 0.0, y)
    v = world_rates(model, y)
    return np.asarray(np.abs(J @ v + phi_t))


def placed(model: Model, y: Array) -> Array:
    """Positions and rotation matrices of the moving frames, (n - 1, 12)."""
    return posed(model, y).X[1:].copy()


def angle(R: Array, R0: Array) -> float:
    """The angle between two orientations; exact for small ones."""
    D = R0.T @ R
    sine = np.array([D[2, 1] - D[1, 2], D[0, 2] - D[2, 0], D[1, 0] - D[0, 1]])
    return float(np.arctan2(np.linalg.norm(sine), np.trace(D) - 1.0))


def largest(x: Array) -> float:
    return float(np.max(x, initial=0.0))


def worst(x: Array, names: list[str] | tuple[str, ...]) -> str:
    """The name of the largest; empty where all are zero."""
    return names[int(np.argmax(x))] if len(x) and np.max(x) > 0.0 else ""
