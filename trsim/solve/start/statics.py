"""Static equilibrium: forces balance on the constraints, without friction, damping or inertia.

    Z^T (F(q) - J^T lam) = 0,    Phi(q) = 0          Z spans the motions the constraints allow

Pseudo-transient continuation [Kelley1998]: Newton steps on the reduced forces with a multiple of
the mass matrix added to the stiffness, which fades as the forces balance.  A journal released in
its bearing has no stiffness until it touches; the mass term carries it there, in steps well below
the clearance.  A motion that stays without stiffness is indifferent, and refused; so is a balance
that is none of its lowest: steps go downhill, but one that begins on the top stays there.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import least_squares, length, product, spaces, symmetric
from trsim.assemble.equations import constraints, forces, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import (
    along_rates,
    closest,
    displaced,
    in_solve_axes,
    jacobian,
    moves,
    spread_out,
)
from trsim.elements.contract import IMPACT_SPEED, PHASE, UNLOCATED, ContactNumbers
from trsim.elements.scene import Model, Scene, workspace
from trsim.errors import ModelError
from trsim.solve.start.angles import remember
from trsim.solve.start.passages import Passages

Array = NDArray[np.float64]

BALANCED = 1e-11  # of the largest force
ROUNDING = 1e-15  # of the mechanism's size: a shorter step cannot be told from none
STEPS = 200  # beside those that are cut short
FAR = 600  # cut short: a rod of the length of the mechanism goes round about twice
STALLED = 1e-3  # of the force: a smaller change, step after step, is none
PATIENCE = 30  # steps without a change, and those that cross the widest clearance
DEPENDENT = 1e-10  # relative size of a row that is not independent
INDIFFERENT = 1e-6  # of the largest eigenvalue scale: see `equilibrium`


def static_forces(model: Model, y: Array) -> Array:
    """Forces along the world-axes rates of the moving frames at rest, N and N*m, one vector."""
    w = workspace(model)
    return along_rates(w, wrenches_at_rest(w, y))


def wrenches_at_rest(w: Scene, y: Array) -> Array:
    """Forces and moments on the frames (n, 6), of the workspace, with all velocities zero."""
    w.mem[:, PHASE], w.mem[:, IMPACT_SPEED] = UNLOCATED, 1.0
    still = y.copy()
    still[w.n_q : w.n_q + w.n_v] = 0.0
    poses(w, still)
    forces(w, 0.0)
    return w.F


def mass_matrix(model: Model, y: Array) -> Array:
    """Diagonal of M against world-axes rates (inertias by their largest moment)."""
    blocks = []
    for f in range(1, model.n):
        I = model.inertia[f]
        blocks.append([model.mass[f]] * 3 + [max(I[0], I[4], I[8])] * 3)
    return np.array(blocks).ravel()


def free_motions(J: Array, free: NDArray[np.bool_], mass: Array) -> Array:
    """Columns: an M-orthonormal basis of the motions with J dx = 0."""
    root = np.sqrt(mass[free])
    if len(J) == 0:
        basis = np.eye(int(free.sum()))
    else:
        _, basis = spaces(J[:, free] / root, DEPENDENT)
        basis = basis.T
    Z = np.zeros((free.size, basis.shape[1]))
    Z[free] = basis / root[:, None]
    return Z


def stiffness(model: Model, y: Array, Z: Array, lam: Array, step: float) -> Array:
    """-Z^T d(F - J^T lam)/dq Z by central differences of the projected forces."""
    K, w = np.empty((Z.shape[1], Z.shape[1])), workspace(model)
    for k in range(Z.shape[1]):
        size = step / max(float(np.max(np.abs(Z[:, k]))), 1e-300)
        total = []
        for sign in (1.0, -1.0):
            held = static_forces(w, displaced(w, y, sign * size * Z[:, k]))
            constraints(w, 0.0)  # at the same place
            total.append(held - product(spread_out(w, w.m).T, lam))
        K[:, k] = -product(Z.T, total[0] - total[1]) / (2.0 * size)
    return np.asarray(0.5 * (K + K.T))


def clearances(model: Model) -> list[float]:
    """Of the journals in their bearings, m."""
    found = model.contact_par[:, ContactNumbers.columns["clearance"].at].tolist()
    return [c for c in found if np.isfinite(c)]


def probe(model: Model) -> float:
    """Step of the differences, m and rad: far below every clearance."""
    gaps = clearances(model)
    return min([1e-9 * model.size, *(1e-5 * c for c in gaps)])


def balance(
    model: Model, y: Array, free: NDArray[np.bool_], mass: Array
) -> tuple[Array, Array, Array]:
    """Forces F, Jacobian J of the constraints, and the motions Z they allow, at y."""
    F, J = static_forces(model, y), jacobian(model, 0.0, y)[2]
    return F, J, free_motions(J, free, mass)


def equilibrium(
    mechanism: Mechanism, y: Array, rigid: bool = True, judge: Callable[..., None] | None = None
) -> tuple[Array, float]:
    """The equilibrium reached from y, drives held at t = 0; and the force left, N.

    rigid: no body is a flexible bar made stiff, which may spin about itself; an equilibrium that
    is indifferent is refused.  One that is not stable is refused always.
    judge: what refuses them, `check_stable` unless given.
    """
    judge = judge or check_stable
    model = workspace(mechanism.model)
    y, _ = closest(model, 0.0, y)
    free, mass = moves(model, model.d == 3), mass_matrix(model, y)
    gaps = clearances(model)
    reach = min([0.2 * c for c in gaps], default=0.02 * model.size)
    patience = PATIENCE + 2.0 * max(gaps, default=0.0) / reach
    push, scale, load = 0.0, 1e-300, 1e-300
    changed, before = 0, 0.0  # the step at which the force last changed, and to what
    cut = 0  # steps that were cut short
    passages = Passages(mechanism, model)
    F, J, Z = balance(model, y, free, mass)
    for count in range(STEPS + FAR):
        if Z.shape[1] == 0:
            return y, 0.0
        lam: Array = np.zeros(0)
        if len(J):
            lam = least_squares(J.T[free], F[free], 1e-12)
        r = product(Z.T, F)
        K = stiffness(model, y, Z, lam, probe(model))
        values, vectors = symmetric(K)
        # bodies in balance have no net force left: the largest one met is the scale
        acting = max(float(np.max(np.abs(F))), float(np.max(np.abs(lam), initial=0.0)))
        scale = max(scale, acting)
        size = length(r)
        left = length(product(Z, r) * mass)
        if left <= BALANCED * scale or size == 0.0:
            judge(mechanism, values, Z @ vectors, max(load, acting), model, rigid)
            return y, left
        if count == 0:
            push, load = max(abs(values[0]), size / reach), acting
        if abs(size - before) > STALLED * before:
            changed, before = count, size
        if count - changed > patience or count - cut >= STEPS:
            break
        # Newton where the stiffness is positive, downhill where it is not
        curvature = np.maximum(np.abs(values), 1e-12 * np.abs(values).max()) + push
        dx = product(Z, product(vectors, product(vectors.T, r) / curvature))
        longest = float(np.max(np.abs(dx.reshape(-1, 6)[:, :3])))
        turned = float(np.max(np.abs(dx.reshape(-1, 6)[:, 3:]))) * 0.1 * model.size
        # a stiff contact turns the rounding of a position into a force: no step is left to take
        if max(longest, turned) < ROUNDING * model.size and left < 1e-6 * scale:
            judge(mechanism, values, Z @ vectors, max(load, acting), model, rigid)
            return y, left
        limit = min(1.0, reach / max(longest, turned, 1e-300))
        limit *= free_part(passages, y, limit * dx)
        cut += int(limit < 1.0)
        y_new, _ = closest(model, 0.0, displaced(model, y, limit * dx))
        # against the motions allowed there: the old ones would see the constraints' forces
        there = balance(model, y_new, free, mass)
        r_new = length(product(there[2].T, there[0]))
        # a journal crosses its clearance under a constant force, and on the way down from an
        # unstable place the force grows before it fades
        push *= 0.3 if r_new < 1.000001 * size or values[0] < 0.0 else 4.0
        push = max(push, 1e-14 * float(np.abs(values).max()))
        if r_new < 20.0 * size or limit < 1.0:
            y, (F, J, Z) = y_new, there
            remember(model, y)  # threads and springs may turn round on the way
    raise ModelError(
        f"no static equilibrium found: a force of {left:.3g} N stays unbalanced",
        "is there a load that nothing holds? drop `equilibrium` to start as drawn",
        ("initial", "equilibrium"),
    )


def free_part(passages: Passages, y: Array, dx: Array) -> float:
    """The part of a step dx, along the world-axes rates, in which nothing is passed through."""
    model = passages.work

    def place(part: float) -> Array:
        return closest(model, 0.0, displaced(model, y, part * dx))[0]

    return passages.free(place, lambda: in_solve_axes(model, dx))


def check_stable(
    mechanism: Mechanism, values: Array, motions: Array, load: float, model: Model,
    rigid: bool = True,
) -> None:  # fmt: skip
    """Refuse an equilibrium that is left at the smallest push, or in which some motion meets no
    stiffness at all.

    values, motions: of the reduced stiffness Z^T K Z.
    load: N, of the forces as drawn or in balance; on the way they may have been far larger.
    rigid: no body is a flexible bar made stiff, which may spin about itself.
    """
    for value, motion in zip(values, motions.T, strict=True):
        along = motion / np.max(np.abs(motion))
        restoring = value / np.max(np.abs(motion)) ** 2  # N/m or N*m/rad of that motion
        nothing = INDIFFERENT * load / model.size
        if restoring >= nothing or (restoring > -nothing and not rigid):
            continue
        body = int(np.argmax(np.abs(along))) // 6 + 1
        name = next(n for n, f in mechanism.frames.items() if f == body)
        if restoring <= -nothing:
            raise ModelError(
                f"in balance but not stable: at the smallest push '{name}' would leave the place "
                "it is in",
                "draw it on the side it shall come to rest on, hold it there by a drive or a value "
                "of `initial`, or drop `equilibrium` to start as drawn",
                ("initial", "equilibrium"),
            )
        raise ModelError(
            f"the equilibrium is indifferent: nothing holds '{name}' where it is",
            "add a spring or a stop, or drop `equilibrium` to start as drawn",
            ("initial", "equilibrium"),
        )
