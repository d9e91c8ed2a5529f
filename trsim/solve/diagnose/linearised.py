"""The motion close to a start, on the constraints: M xi'' + C xi' + K xi = 0.

    dx = Z xi,             J Z = 0,   Z^T M Z = 1       world-axes rates of all bodies
    dv = Z eta + ...,      J v + Phi_t = 0
    xi'  = eta + Z^T M (omega x) Z xi                   small rotations of a body that spins
    eta' = Z^T M v'(x, v, s),                           s: states of elements, such as bristles

    Z^T M v' = Z^T (F - gyroscopic - J^T lam)           lam: of the start, to first order

A is the Jacobian of the right-hand sides against (xi, eta, s), by central differences, and that of
the elastic forces of flexible bars from their tangent: the velocities of every probe are brought
back to the constraints by Newton steps with the pseudoinverse of the start, so that no constraint
is violated to first order.  Exact
for small motions about an equilibrium or a steady rotation; where the start moves otherwise it is
the Jacobian frozen there.  Time stands still: what drives prescribe, and their states, are held.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import constraints, derivative, forces, gaps, poses
from trsim.assemble.light import block
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import move_all
from trsim.assemble.reduce import (
    IN_PLANE,
    along_rates,
    in_solve_axes,
    jacobian,
    less_reactions,
    moves,
    world_rates,
)
from trsim.elements.contract import FLIGHT, N_BOOK, PHASE, ContactNumbers
from trsim.elements.scene import Model, Scene, scene
from trsim.errors import ModelError
from trsim.solve.methods.ggl_tables import node_masses
from trsim.solve.start.consistent import Start
from trsim.solve.start.elastic import acted_on, bars_alone, elastic_stiffness
from trsim.solve.start.velocities import with_velocities

Array = NDArray[np.float64]

REACH = 1e-5  # of the mechanism's size, and of its speed: how far a probe goes
FASTEST = 1e-2  # m/s: a run of next to no time makes its unit of speed as large as one likes
PRESSED = 1e-3  # of a penetration: a probe must not leave the contact
TOUCHING = 1e-12  # of the mechanism's size: contacts pressed in by less count as open
FREE = 1e-10  # relative singular value of J below which a motion is free
STILL = 1e-6  # of the natural rate: slower eigenvalues are zero to rounding
ROUNDING = 2e-6  # of the fastest: a double zero comes out as the root of what rounding leaves
CORRECTIONS = 3  # Newton steps of a probe; two reach rounding


@dataclass(frozen=True)
class Linearised:
    """Small motions about a start; f freedoms, n_s element states.

    M is the identity: the columns of Z are M-orthonormal.  Frequencies are the square roots of the
    eigenvalues of K where C vanishes; in general the eigenvalues of A are those of the motion, 1/s.
    Where bodies spin in space xi' is not eta, and A alone is complete.
    """

    M: Array  # (f, f)
    C: Array  # (f, f) 1/s
    K: Array  # (f, f) 1/s^2
    A: Array  # (2 f + n_s, 2 f + n_s) state matrix of (xi, xi', s)
    Z: Array  # (n_v, f) motions of the freedoms, axes of the solve
    twists: Array  # (6 (n - 1), f) the same as world-axes rates of the moving frames


def linearised(mechanism: Mechanism, begun: Start, order: int = 2) -> Linearised:
    """The linear equations of motion at a start; differences of order 2, or 4 for twice as many.

    With order 2 a motion that nothing resists but in third order, as a spring across its line, has
    a stiffness of REACH^2 of the largest: a frequency of 1e-5 of the fastest.
    """
    work = scene(smooth(mechanism))
    work.mem[:] = begun.mem
    work.branch[:] = begun.branch
    probe = Probe(mechanism, work, begun)
    f, r, own = *probe.ways.shape, probe.own
    n = 2 * f + len(own)
    A = np.zeros((n, n))
    A[:f, f : 2 * f] = np.eye(f)
    A[:f, :f] = probe.turning()
    columns = np.zeros((f + len(own), 2 * r + len(own)))
    for k in range(columns.shape[1]):
        kind, place = (0, k) if k < r else (1, k - r) if k < 2 * r else (2, k - 2 * r)
        columns[:, k] = probe.difference(kind, place)
        if order > 2:
            columns[:, k] += (columns[:, k] - probe.difference(kind, place, 2.0)) / 3.0
    A[f:, :f] = columns[:, :r] @ probe.ways.T
    A[f:, f : 2 * f] = columns[:, r : 2 * r] @ probe.ways.T
    A[f:, 2 * f :] = columns[:, 2 * r :]
    if mechanism.beams:
        A[f : 2 * f, :f] -= probe.twists.T @ elastic_stiffness(work, begun.y) @ probe.twists
    if not np.all(np.isfinite(A)):
        worst = int(np.argmin(np.isfinite(A).all(axis=0)))
        raise ModelError(
            "the start cannot be linearised: a derivative of its accelerations is not finite",
            "is a stiffness, a mass or a damping out of all proportion?",
            ("bodies", probe.body(worst)) if worst < 2 * f else (),
        )
    return Linearised(
        np.eye(f), -A[f : 2 * f, f : 2 * f], -A[f : 2 * f, :f], A, probe.Z, probe.twists
    )


def rounding(values: NDArray[Any], begun: Start) -> float:
    """Below this an eigenvalue of A is zero to rounding, 1/s."""
    fastest = float(np.max(np.abs(values), initial=0.0))
    return max(STILL * float(begun.speed / begun.length), ROUNDING * fastest)


def smooth(mechanism: Mechanism) -> Model:
    """The model without Coulomb's friction, whose jump at rest has no derivative."""
    par = mechanism.model.par.copy()
    for e, instance in enumerate(mechanism.instances):
        if instance.row.contact and instance.row.contact.jump >= 0:
            par[e, instance.row.contact.jump] = 0.0
    return mechanism.model.replaced(par=par)


def mass_matrix(work: Scene) -> Array:
    """M (n_v, n_v) in the axes of the solve, as it is solved with (assemble/light.py)."""
    M = np.zeros((work.n_v, work.n_v))
    for place, value in node_masses(work).items():
        M[place] = value
    for f in range(1, work.n_r):
        own = slice(work.d * (f - 1), work.d * f)
        M[own, own] = block(work, work.mass[f], work.inertia[f])
    return M


def lacking_matrix(work: Scene) -> Array:
    """What of M (n_v, n_v) light bodies do not have."""
    E = np.zeros((work.n_v, work.n_v))
    for f, more in zip(work.light, work.lacking, strict=True):
        own = slice(work.d * (f - 1), work.d * f)
        E[own, own] = block(work, more[0], more[1:])
    return E


class Probe:
    """The start, and states a little away from it that satisfy the constraints."""

    def __init__(self, mechanism: Mechanism, work: Scene, begun: Start) -> None:
        self.work, self.y = work, begun.y
        self.n_q, self.n_v = work.n_q, work.n_v
        self.names = [name for name, f in mechanism.frames.items() if f > 0]
        moving = {instance.row.piston for instance in mechanism.instances}
        self.states = [
            N_BOOK + k
            for k, s in enumerate(mechanism.follows)
            if s < 0 or N_BOOK + k in moving  # all others are places that drives prescribe
        ]
        self.own = [self.n_q + self.n_v + k for k in self.states]
        self.bars = bars_alone(mechanism, work) if mechanism.beams else None
        self.basis()
        self.ways = self.directions(mechanism)
        self.scales(begun)
        derivative(work, 0.0, self.y, np.zeros_like(self.y))
        self.lam = work.lam[: work.m].copy()

    def basis(self) -> None:
        """Z, M Z and the M-weighted pseudoinverse of J; in world axes and those of the solve."""
        work = self.work
        J = jacobian(work, 0.0, self.y)[2]
        self.given = world_rates(work, self.y)
        # columns: what a unit of every velocity of the solve does to the world-axes rates
        T = np.zeros((6 * (work.n - 1), self.n_v))
        of_nodes = moves(work, work.d == 3)[6 * (work.n_r - 1) :]
        T[6 * (work.n_r - 1) :, work.v_node :] = np.eye(of_nodes.size)[:, of_nodes]
        for f, R in enumerate(work.X[1 : work.n_r, 3:].reshape(-1, 3, 3)):
            if work.d == 3:
                T[[6 * f + c for c in IN_PLANE], range(3 * f, 3 * f + 3)] = 1.0
            else:
                T[6 * f : 6 * f + 3, 6 * f : 6 * f + 3] = np.eye(3)
                T[6 * f + 3 : 6 * f + 6, 6 * f + 3 : 6 * f + 6] = R
        M = mass_matrix(work)  # with what light bodies lack: it has an inverse
        back = np.linalg.inv(np.linalg.cholesky(M)).T  # M = L L^T, back = L^-T
        self.pseudo, self.Z = np.zeros((self.n_v, 0)), back
        if work.m:
            u, s, vt = np.linalg.svd(J @ T @ back, full_matrices=True)
            rank = int(np.sum(s > FREE * s.max(initial=0.0)))
            self.pseudo = back @ vt[:rank].T @ (u[:, :rank] / s[:rank]).T
            self.Z = back @ vt[rank:].T
        if len(work.light):
            M = M - lacking_matrix(work)
            share, ways = np.linalg.eigh(self.Z.T @ M @ self.Z)
            self.Z = self.Z @ ways / np.sqrt(share)
        self.twists, self.momenta = T @ self.Z, M @ self.Z

    def directions(self, mechanism: Mechanism) -> Array:
        """Orthonormal combinations of the freedoms to probe along, columns: in all others nothing
        moves but nodes of bars on which only their elastic forces act."""
        f = self.Z.shape[1]
        if not mechanism.beams:
            return np.eye(f)
        _, s, vt = np.linalg.svd(self.twists[acted_on(mechanism)], full_matrices=False)
        return np.asarray(vt[s > FREE * s.max(initial=0.0)].T).reshape(f, -1)

    def scales(self, begun: Start) -> None:
        """How far probes go: m and m/s of the point that moves most."""
        work = self.work
        gaps(work, 0.0)
        pressed = work.gap[work.contact, 0] > TOUCHING * work.size
        work.mem[work.contact[~pressed], PHASE] = FLIGHT
        depths = work.gap[work.contact[pressed], 0].tolist()
        self.length = min([REACH * work.size, *(PRESSED * d for d in depths)])
        at = ContactNumbers.columns["slowest_impact"].at
        slowest = [v for v in work.contact_par[:, at].tolist() if v > 0.0]
        self.speed = min([REACH * begun.speed, FASTEST, *(PRESSED * v for v in slowest)])
        parts = np.abs(self.twists @ self.ways).reshape(work.n - 1, 6, self.ways.shape[1])
        points = np.maximum(parts[:, :3].max(axis=1), work.size * parts[:, 3:].max(axis=1))
        self.most = points.max(axis=0, initial=1e-300)

    def body(self, k: int) -> str:
        """The body that moves most in the freedom of a column of A."""
        twist = np.abs(self.twists[:, k % self.Z.shape[1]])
        return self.names[int(np.argmax(twist)) // 6]

    def steps(self, kind: int, place: int) -> float:
        """Step along a way (0), its rate (1), a state of an element (2)."""
        if kind == 2:
            return float(REACH * self.work.scale[self.own[place]])
        return (self.length, self.speed)[kind] / float(self.most[place])

    def difference(self, kind: int, place: int, times: float = 1.0) -> Array:
        """The central difference of the rates, with so many steps to either side."""
        ahead = [np.zeros(len(self.ways)), np.zeros(len(self.ways)), np.zeros(len(self.own))]
        step = times * self.steps(kind, place)
        ahead[kind] += step * (np.eye(len(self.own)) if kind == 2 else self.ways)[:, place]
        back = [-part for part in ahead]
        return np.asarray((self.rates(*ahead) - self.rates(*back)) / (2.0 * step))

    def rates(self, xi: Array, eta: Array, states: Array) -> Array:
        """(eta', s') at a state a little away, its velocities brought to the constraints."""
        work, y, n = self.work, self.y.copy(), self.n_q
        move_all(work, y, self.Z @ xi)  # leaves the joints by xi^2, alike on both sides
        y = with_velocities(work, y, self.given + self.twists @ eta)
        for _ in range(CORRECTIONS):
            poses(work, y)
            constraints(work, 0.0)
            y[n : n + self.n_v] -= self.pseudo @ self.drift()
        y[self.own] += states
        return np.concatenate([self.Z.T @ self.loads(y), work.zd[self.states]])

    def loads(self, y: Array) -> Array:
        """F - gyroscopic - J^T lam in the axes of the solve, but for the elastic forces of bars."""
        work = self.work
        poses(work, y)
        constraints(work, 0.0)
        forces(work, 0.0)
        wrenches = work.F.copy()
        less_reactions(work, wrenches, self.lam)
        F = along_rates(work, wrenches)
        if self.bars:
            poses(self.bars, y)
            forces(self.bars, 0.0)
            F = F - along_rates(self.bars, self.bars.F)
        found = in_solve_axes(work, F)
        if work.d == 6:
            inertia = np.array(work.inertia[: work.n_r])
            inertia[work.light] -= work.lacking[:, 1:]
            for f in range(1, work.n_r):
                o = 6 * (f - 1) + 3
                omega = y[self.n_q + o : self.n_q + o + 3]
                found[o : o + 3] -= np.cross(omega, inertia[f].reshape(3, 3) @ omega)
        return found

    def drift(self) -> Array:
        """Phi' = J V + Phi_t at the poses and rows of the last evaluation."""
        work = self.work
        start, lines = work.row_start[: work.m], work.row_start[work.m]
        parts = (work.J * work.V[work.line_frame])[:lines]
        return np.asarray(np.sum(np.add.reduceat(parts, start), axis=1) + work.phi_t[: work.m])

    def turning(self) -> Array:
        """Z^T M (omega x) Z: a body that spins carries its small rotations along."""
        work, freedoms = self.work, self.twists.shape[1]
        turned = self.twists.reshape(work.n - 1, 6, freedoms).copy()
        spin = self.given.reshape(-1, 6)[:, 3:].copy()
        spin[work.n_r - 1 :] = 0.0  # nodes of beams have no axes of their own
        turned[:, 3:] = np.cross(spin[:, :, None], turned[:, 3:], axis=1)
        turned[:, :3] = 0.0
        columns = turned.reshape(self.twists.shape).T
        own = [in_solve_axes(work, column) for column in columns]
        return np.asarray(self.momenta.T @ np.array(own).reshape(freedoms, self.n_v).T)
