"""Chains and loops in the coordinates of their joints: products of exponentials of screws.

A body is displaced from the drawing by

    T = T_before exp(S_1 x_1) exp(S_2 x_2) ...        S = (w, p x w + h w), or (0, d) of a slide

where T_before is the displacement of the body it hangs on and x are the coordinates of the joint,
which so takes no constraint rows at all.  With the columns Ad S of all steps before a body and
their rates,

    M(x) x'' + h(x, x') = Q + A^T mu + G^T lambda,    A x = 0 of gears,  G x'' = gamma of loops

A constant, so x = N y.  Only what closes a loop (a link, or a joint between bodies that hang on
something already) has rows that are not linear.  Reactions are sums of what the bodies behind a
joint need.  Nothing is shared with engine.py but vectors.py, and nothing of trsim is used.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import null_space

from .reference import (
    ACCELERATION,
    APART,
    RATE,
    TURNING,
    Channel,
    Truth,
    Unfit,
    lightest,
    scales,
    size,
)
from .scene import FORCE, LENGTH, MOMENT, NONE, SPEED, Load, Scene, Spring, Torsion
from .scene import plus as dimensions
from .vectors import compiled, cross, crossed, dot, into, minus, out_of, plus, three, times

# what a joint holds where it closes a loop: displacements along, turns about axes of its triad
HELD = {
    "spherical": ("uwa", ""), "revolute": ("uwa", "uw"), "prismatic": ("uw", "uwa"),
    "cylindrical": ("uw", "uw"), "inline": ("uw", ""), "inplane": ("a", ""),
    "planar": ("a", "uw"), "parallel": ("", "uw"), "fixed": ("uwa", "uwa"),
}  # fmt: skip
NEXT_TO_BACK = float(np.cos(np.pi - 0.03))  # of a bend: more than trsim fails at
ACROSS = {"u": ("w", "a"), "w": ("u", "a"), "a": ("w", "u")}  # no turn about it: these stay so


def hat(w: Any) -> np.ndarray:
    x, y, z = w
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


@compiled
def moved(steps, c, q, R):
    """How far drawn points are shifted by a screw that goes by q; their rotation is put into R.

    steps (n, 9): twist and a point of each.
    """
    w, p = three(steps, c, 0), three(steps, c, 6)
    sine, less = np.sin(q), 1.0 - np.cos(q)
    square = dot(w, w)
    for i in range(3):
        for j in range(3):
            R[i, j] = less * w[i] * w[j]
        R[i, i] += 1.0 - less * square
    R[0, 1] -= sine * w[2]
    R[1, 0] += sine * w[2]
    R[0, 2] += sine * w[1]
    R[2, 0] -= sine * w[1]
    R[1, 2] -= sine * w[0]
    R[2, 1] += sine * w[0]
    along = three(steps, c, 3)
    if square == 0.0:
        return times(q, along)
    x = R[0, 0] * p[0] + R[0, 1] * p[1] + R[0, 2] * p[2]
    y = R[1, 0] * p[0] + R[1, 1] * p[1] + R[1, 2] * p[2]
    z = R[2, 0] * p[0] + R[2, 1] * p[1] + R[2, 2] * p[2]
    return plus(minus(p, (x, y, z)), times(q, minus(along, cross(p, w))))


@compiled
def add(A, b, w, u, f):
    """To row b of a table of twists, f of one."""
    for i in range(3):
        A[b, i] += f * w[i]
        A[b, 3 + i] += f * u[i]


@compiled
def displaced(numbers, x, v):
    """R, s, J, V, A of every body (State); numbers: see Tree.packed."""
    before, of_step, number, steps, offset = numbers
    n, m = len(before), len(x)
    R, s = np.zeros((n, 3, 3)), np.zeros((n, 3))
    J, V, A = np.zeros((n, 6, m)), np.zeros((n, 6)), np.zeros((n, 6))
    turn = np.zeros((3, 3))
    for i in range(3):
        R[0, i, i] = 1.0
    for b in range(1, n):
        o = before[b]
        for i in range(3):
            s[b, i] = s[o, i]
            for j in range(3):
                R[b, i, j] = R[o, i, j]
        for i in range(6):
            V[b, i], A[b, i] = V[o, i], A[o, i]
            for j in range(m):
                J[b, i, j] = J[o, i, j]
        for c in range(len(of_step)):
            if of_step[c] != b:
                continue
            w = out_of(R, b, three(steps, c, 0))
            u = plus(out_of(R, b, three(steps, c, 3)), cross(three(s, b, 0), w))
            q, k = offset[c], number[c]
            if k >= 0:
                # the rate of a twist as it is carried by that of the body, their Lie bracket
                spin, slide = three(V, b, 0), three(V, b, 3)
                add(A, b, cross(spin, w), plus(cross(spin, u), cross(slide, w)), v[k])
                add(V, b, w, u, v[k])
                for i in range(3):
                    J[b, i, k] += w[i]
                    J[b, 3 + i, k] += u[i]
                q += x[k]
            shift = out_of(R, b, moved(steps, c, q, turn))
            for i in range(3):
                s[b, i] += shift[i]
                row = R[b, i, 0], R[b, i, 1], R[b, i, 2]
                for j in range(3):
                    column = turn[0, j], turn[1, j], turn[2, j]
                    R[b, i, j] = dot(row, column)
    return R, s, J, V, A


@compiled
def needed(found, masses):
    """M and h of rigid bodies, all but the ground, that are displaced so."""
    R, s, J, V, A = found
    at, mass, inertia, gravity = masses
    n = J.shape[2]
    M, h = np.zeros((n, n)), np.zeros(n)
    turns, goes = np.zeros((n, 3)), np.zeros((n, 3))
    g = gravity[0], gravity[1], gravity[2]
    for b in range(1, len(J)):
        r = plus(out_of(R, b, three(at, b - 1, 0)), three(s, b, 0))
        w, e = three(V, b, 0), three(A, b, 0)
        u = plus(three(V, b, 3), cross(w, r))
        a = plus(plus(three(A, b, 3), cross(e, r)), cross(w, u))
        f = times(mass[b - 1], minus(a, g))
        spin = heavy(R, b, inertia, w)
        moment = plus(heavy(R, b, inertia, e), cross(w, spin))
        for k in range(n):
            d = J[b, 0, k], J[b, 1, k], J[b, 2, k]
            p = minus((J[b, 3, k], J[b, 4, k], J[b, 5, k]), cross(r, d))
            h[k] += dot(p, f) + dot(d, moment)
            d_heavy = heavy(R, b, inertia, d)
            for i in range(3):
                turns[k, i], goes[k, i] = d[i], p[i]
            for l in range(k + 1):
                part = mass[b - 1] * dot(p, three(goes, l, 0)) + dot(d_heavy, three(turns, l, 0))
                M[k, l] += part
                if l != k:
                    M[l, k] += part
    return M, h


@compiled
def heavy(R, b, inertia, w):
    """The moment of momentum of body b that turns with w: its inertia is in its own axes."""
    return out_of(R, b, out_of(inertia, b - 1, into(R, b, w)))


@dataclass
class Step:
    """One screw: about w through p with the advance h, or along d where w is zero."""

    k: int  # its coordinate; -1: it stays as it is
    w: np.ndarray
    p: np.ndarray
    d: np.ndarray  # of a slide, or h w
    offset: float = 0.0
    sign: float = 1.0

    @property
    def twist(self) -> np.ndarray:
        return self.sign * np.concatenate([self.w, crossed(self.p, self.w) + self.d])

    def moved(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rotation and shift of drawn points."""
        R, q = np.empty((3, 3)), self.offset + (x[self.k] if self.k >= 0 else 0.0)
        shift = moved(np.array([[*self.twist, *self.p]]), 0, q, R)
        return R, np.array(shift)


@dataclass
class Held:
    """How a body hangs on another."""

    before: str
    steps: list[Step]
    joint: Any = None
    forward: bool = True  # the body is the second of its joint


@dataclass
class State:
    """Of one body: displacement, its columns, twist, and what acceleration has without x''."""

    R: np.ndarray
    s: np.ndarray
    J: np.ndarray
    V: np.ndarray
    A: np.ndarray


@dataclass
class Row:
    """What closes a loop: a value to keep, of two bodies."""

    name: str
    kind: str  # distance, along, across
    i: str
    j: str
    p: np.ndarray
    q: np.ndarray
    a: np.ndarray = field(default_factory=lambda: np.zeros(3))
    b: np.ndarray = field(default_factory=lambda: np.zeros(3))


class Solved(NamedTuple):
    """The motion at one instant."""

    a: np.ndarray  # x''
    lam: np.ndarray  # multipliers of loops
    related: np.ndarray  # what relations put on the coordinates
    of: dict[str, State]
    pushes: list[tuple[str, np.ndarray, np.ndarray, np.ndarray]]  # see Tree.forces


def triad(joint: Any) -> dict[str, np.ndarray]:
    """Axes of a joint as drawn; which ones across its axis does not matter but where told."""
    a = np.asarray(joint.axis if joint.axis is not None else (0, 0, 1), float)
    a = a / np.linalg.norm(a)
    x = joint.x_axis
    u = np.eye(3)[np.argmin(np.abs(a))] if x is None else np.asarray(x, float)
    u = u - (u @ a) * a
    u = u / np.linalg.norm(u)
    return {"u": u, "w": crossed(a, u), "a": a}


class Tree:
    """A scene in coordinates of its joints."""

    def __init__(self, s: Scene) -> None:
        self.s, self.n, self.folded = s, 0, False
        self.shafts = [j for j in s.joints if j.type == "constant_velocity"]
        self.held: dict[str, Held] = {}
        self.coordinate: dict[str, int] = {}  # `joint` or `joint.angle` -> its number
        self.rows: list[Row] = []
        self.linear: list[tuple[str, dict[int, float]]] = []  # relations by name
        open_, there = [j for j in s.joints if j.type != "link"], {"ground"}
        while len(there) <= len(s.bodies):
            found = next((j for j in open_ if (j.i in there) != (j.j in there)), None)
            if found is None:
                name = next(b.name for b in s.bodies if b.name not in there)
                self.held[name] = Held("ground", self.level(self.loose(s.body(name).at)))
                there.add(name)
                continue
            open_.remove(found)
            forward = found.i in there
            name, before = (found.j, found.i) if forward else (found.i, found.j)
            steps = self.level(self.steps(found))
            if not forward:
                for step in steps:
                    step.sign = -1.0
                steps = steps[::-1]
            self.held[name] = Held(before, steps, found, forward)
            there.add(name)
        for j in s.joints:
            if j.type == "link":
                p, q = j.points
                self.rows.append(Row(j.name, "distance", j.i, j.j, p, q))
            elif j in open_:
                self.close(j)
        for g in s.gears:
            terms: dict[int, float] = {}
            for name, c in self.terms(g):
                terms[self.coordinate[name]] = c
            self.linear.append((g.name, terms))
        A = np.zeros((len(self.linear), self.n))
        for k, (_, terms) in enumerate(self.linear):
            for c, value in terms.items():
                A[k, c] = value
        self.numbers, self.names = self.packed(), ("ground", *self.held)
        own = [s.body(name) for name in self.held]
        self.masses = (
            np.array([b.at for b in own]), np.array([b.mass for b in own]),
            np.array([b.inertia for b in own]), np.asarray(s.gravity, float),
        )  # fmt: skip
        self.A, self.N = A, null_space(A) if len(A) else np.eye(self.n)
        self.free = [self.value(row, self.states(np.zeros(self.n), np.zeros(self.n)))[0]
                     for row in self.rows]  # fmt: skip

    # --- what the scene says -----------------------------------------------------------------

    def new(self, name: str = "") -> int:
        self.n += 1
        if name:
            self.coordinate[name] = self.n - 1
        return self.n - 1

    def level(self, steps: list[Step]) -> list[Step]:
        """Of a flat scene those that stay in the plane; the coordinates of others stay zero."""
        if not self.s.flat:
            return steps
        kept = [k for k in steps if abs(k.w[2]) > 0.5 or (not k.w.any() and abs(k.d[2]) < 0.5)]
        for step in steps:
            if not any(step is one for one in kept):
                self.linear.append(("flat", {step.k: 1.0}))
        return kept

    def loose(self, p: np.ndarray) -> list[Step]:
        """A body that nothing holds: three slides, three turns about its centre of mass."""
        zero, axes = np.zeros(3), np.eye(3)
        slides = [Step(self.new(), zero, zero, e) for e in axes]
        return slides + [Step(self.new(), e, p, zero) for e in axes]

    def steps(self, joint: Any) -> list[Step]:
        """What a joint lets the second body do, seen from the first."""
        zero, p, name, kind = np.zeros(3), np.asarray(joint.at, float), joint.name, joint.type
        u, w, a = triad(joint).values()

        def about(axis: np.ndarray, key: str = "") -> Step:
            return Step(self.new(key), axis, p, zero)

        def along(axis: np.ndarray, key: str = "") -> Step:
            return Step(self.new(key), zero, p, axis)

        ball = (u, w, a)
        if kind == "fixed":
            return []
        if kind == "revolute":
            return [about(a, name)]
        if kind == "prismatic":
            return [along(a, name)]
        if kind == "cylindrical":
            return [along(a, f"{name}.stroke"), about(a, f"{name}.angle")]
        if kind == "screw":
            step = Step(self.new(f"{name}.angle"), a, p, joint.pitch / (2 * np.pi) * a)
            return [step]
        if kind == "planar":
            return [along(u, f"{name}.x"), along(w, f"{name}.y"), about(a, f"{name}.angle")]
        if kind == "parallel":
            return [*(along(e) for e in ball), about(a)]
        if kind == "spherical":
            return [about(e) for e in ball]
        if kind == "inplane":
            return [along(u), along(w), *(about(e) for e in ball)]
        if kind == "inline":
            return [along(a), *(about(e) for e in ball)]
        if kind == "universal":
            b = np.asarray(joint.second_axis, float)
            return [about(a), about(b / np.linalg.norm(b))]
        assert kind == "constant_velocity", kind
        # the bend b, about an axis n that goes round: turn n by psi, bend, and turn it back
        b = np.asarray(joint.second_axis, float)
        n = crossed(a, b / np.linalg.norm(b))
        bend = float(np.arctan2(np.linalg.norm(n), a @ b / np.linalg.norm(b)))
        n = n / np.linalg.norm(n)
        first, second, third = about(a), about(n), about(a)
        second.offset = bend
        self.linear.append((f"{name} round", {first.k: 1.0, third.k: 1.0}))
        return [first, second, third, Step(-1, n, p, zero, -bend)]

    def close(self, j: Any) -> None:
        axes, p = triad(j), np.asarray(j.at, float)
        along, turns = HELD[j.type]
        for x in along:
            self.rows.append(Row(j.name, "along", j.i, j.j, p, p, axes[x]))
        for x in turns:
            of_i, of_j = ACROSS[x]
            self.rows.append(Row(j.name, "across", j.i, j.j, p, p, axes[of_i], axes[of_j]))

    def terms(self, g: Any) -> list[tuple[str, float]]:
        """Coefficients of the coordinates that a gear relates, from how its parts touch."""
        if g.coefficients is not None:
            return list(zip(g.joints, g.coefficients, strict=True))
        x, y = g.joints
        if g.ratio is not None:
            first, second = (1.0, -g.ratio) if g.type != "rack_and_pinion" else (-g.ratio, 1.0)
            return [(x, first), (y, second)]
        one, two = (self.s.joint(name.split(".")[0]) for name in (x, y))
        (carrier,) = {one.i, one.j} & {two.i, two.j}
        ways = [1.0 if k.i == carrier else -1.0 for k in (one, two)]
        a, b = triad(one)["a"], triad(two)["a"]
        if g.type == "worm":  # a thread of so many starts across the wheel, which sees it advance
            right = -1.0 if g.hand == "left" else 1.0
            rim = crossed(b, g.touch - two.at) @ a
            lead = float(np.linalg.norm(g.touch - two.at)) * g.teeth[0] / g.teeth[1]
            return [(x, right * ways[0] * lead), (y, ways[1] * rim)]
        touch = g.touch  # where both have one speed against the carrier, along g.way
        speed = [ways[0] * crossed(a, touch - one.at) @ g.way]
        slides = two.type == "prismatic"
        speed.append(ways[1] * (b @ g.way if slides else crossed(b, touch - two.at) @ g.way))
        return [(x, speed[0]), (y, -speed[1])]

    # --- motion ------------------------------------------------------------------------------

    def states(self, x: np.ndarray, v: np.ndarray) -> dict[str, State]:
        """Of every body."""
        R, s, J, V, A = displaced(self.numbers, x, v)
        return {name: State(R[k], s[k], J[k], V[k], A[k]) for k, name in enumerate(self.names)}

    def packed(self) -> Any:
        """The bodies in the order they hang, as numbers."""
        names = ["ground", *self.held]
        steps = [(k + 1, one) for k, h in enumerate(self.held.values()) for one in h.steps]
        before = [-1, *(names.index(h.before) for h in self.held.values())]
        return (
            np.array(before), np.array([k for k, _ in steps], int),
            np.array([one.k for _, one in steps], int),
            np.array([[*one.twist, *one.p] for _, one in steps]).reshape(-1, 9),
            np.array([one.offset for _, one in steps]),
        )  # fmt: skip

    @staticmethod
    def met(state: State, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Place and velocity of a drawn point."""
        r = state.R @ p + state.s
        return r, state.V[3:] + crossed(state.V[:3], r)

    def at(self, state: State, p: np.ndarray) -> tuple[np.ndarray, ...]:
        """A drawn point: its place, columns of its velocity, velocity, acceleration without x''."""
        r, v = self.met(state, p)
        J = state.J[3:] - hat(r) @ state.J[:3]
        a = state.A[3:] + crossed(state.A[:3], r) + crossed(state.V[:3], v)
        return r, J, v, a

    def value(self, row: Row, of: dict[str, State]) -> tuple[float, np.ndarray, float]:
        """Value of a row, its columns, and its second rate without x''."""
        i, j = of[row.i], of[row.j]
        if row.kind == "across":
            a, b = i.R @ row.a, j.R @ row.b
            a1, b1 = crossed(i.V[:3], a), crossed(j.V[:3], b)
            a2 = crossed(i.A[:3], a) + crossed(i.V[:3], a1)
            b2 = crossed(j.A[:3], b) + crossed(j.V[:3], b1)
            G = crossed(a, b) @ i.J[:3] + crossed(b, a) @ j.J[:3]
            return a @ b, G, a2 @ b + 2 * a1 @ b1 + a @ b2
        p, Jp, vp, ap = self.at(i, row.p)
        q, Jq, vq, aq = self.at(j, row.q)
        d, d1, d2 = q - p, vq - vp, aq - ap
        if row.kind == "distance":
            l = np.linalg.norm(d)
            u = d / l
            return l, u @ (Jq - Jp), u @ d2 + (d1 @ d1 - (u @ d1) ** 2) / l
        a = i.R @ row.a
        a1 = crossed(i.V[:3], a)
        a2 = crossed(i.A[:3], a) + crossed(i.V[:3], a1)
        return a @ d, a @ (Jq - Jp) + crossed(a, d) @ i.J[:3], a2 @ d + 2 * a1 @ d1 + a @ d2

    def forces(self, t: float, x: Any, v: Any, of: dict[str, State]) -> Any:
        """Forces on bodies, (body, place, force, moment), and on coordinates."""
        pushes, Q = [], np.zeros(self.n)
        for f in self.s.forces:
            if isinstance(f, Load):
                at = of[f.body]
                d = np.asarray(f.direction, float) / np.linalg.norm(f.direction)
                if f.frame != "world":
                    d = of[f.frame].R @ d
                size = f.fn.p[0] + (f.fn.p[1] * np.sin(f.fn.p[2] * t + f.fn.p[3])
                                    if f.fn.kind == "sine" else 0.0)  # fmt: skip
                point = f.at if f.at is not None else self.s.body(f.body).at
                r = at.R @ point + at.s
                none = np.zeros(3)
                pushes.append((f.body, r, none if f.torque else size * d,
                               size * d if f.torque else none))  # fmt: skip
            elif isinstance(f, Spring):
                (p, vp), (q, vq) = self.met(of[f.i], f.p_i), self.met(of[f.j], f.p_j)
                l = np.linalg.norm(q - p)
                u = (q - p) / l
                free = np.linalg.norm(f.p_j - f.p_i) if f.free is None else f.free
                F = -f.k * (l - free) - f.c * u @ (vq - vp) - f.preload
                pushes += [(f.j, q, F * u, np.zeros(3)), (f.i, p, -F * u, np.zeros(3))]
            else:
                assert isinstance(f, Torsion)
                k = self.coordinate[f.joint]
                Q[k] += f.preload - f.k * x[k] - f.c * v[k]
        return pushes, Q

    def solved(self, t: float, x: np.ndarray, v: np.ndarray) -> Solved:
        """The accelerations, and what they need."""
        found = displaced(self.numbers, x, v)
        of = {name: State(*(one[k] for one in found)) for k, name in enumerate(self.names)}
        R = found[0]
        M, h = needed(found, self.masses)
        pushes, Q = self.forces(t, x, v, of)
        for name, r, f, m in pushes:
            if name != "ground":
                Q += np.concatenate([m + crossed(r, f), f]) @ of[name].J
        N = self.N
        rows = [self.value(row, of) for row in self.rows]
        G = np.array([one[1] for one in rows]).reshape(-1, self.n)
        gamma = np.array([one[2] for one in rows])
        n, m = N.shape[1], len(G)
        K = np.zeros((n + m, n + m))
        K[:n, :n], K[:n, n:], K[n:, :n] = N.T @ M @ N, N.T @ G.T, G @ N
        side = np.concatenate([N.T @ (Q - h), -gamma])
        if m == 0:
            full = np.linalg.solve(K, side)
        else:
            full = np.linalg.lstsq(K, side, rcond=1e-12)[0]
        for j in self.shafts:
            i, k = self.names.index(j.i), self.names.index(j.j)
            cosine = (R[i] @ triad(j)["a"]) @ (
                R[k] @ (j.second_axis / np.linalg.norm(j.second_axis))
            )
            self.folded = self.folded or bool(cosine < NEXT_TO_BACK)
        a, lam = N @ full[:n], -full[n:]
        return Solved(a, lam, M @ a + h - Q - G.T @ lam, of, pushes)

    def rate(self, t: float, y: np.ndarray) -> np.ndarray:
        x, v = y[: self.n], y[self.n :]
        return np.concatenate([v, self.solved(t, x, v).a])

    def run(self, y: np.ndarray, times: np.ndarray, rtol: float) -> np.ndarray:
        made = solve_ivp(
            self.rate, (0, times[-1]), y, "DOP853", times, rtol=rtol, atol=rtol, max_step=0.2
        )
        found = np.ascontiguousarray(made.y.T)  # the layout that is compiled for
        if self.folded:  # of what comes behind nothing is said
            found = np.vstack([found, np.repeat(found[-1:], len(times) - len(found), axis=0)])
        if len(found) != len(times):
            raise Unfit(f"the reference stopped: {made.message}")
        return found

    def start(self, v: np.ndarray) -> np.ndarray:
        """Rates next to some that gears and loops allow, as drawn."""
        of = self.states(np.zeros(self.n), np.zeros(self.n))
        G = np.array([self.value(row, of)[1] for row in self.rows]).reshape(-1, self.n)
        G = np.vstack([G, self.A])
        if len(G):
            v = v - np.linalg.pinv(G, rcond=1e-10) @ (G @ v)
        return np.concatenate([np.zeros(self.n), v])

    def speeds(self, y: np.ndarray) -> None:
        """Write the velocities at the start into the bodies of the scene."""
        of = self.states(np.zeros(self.n), y[self.n :])
        for b in self.s.bodies:
            b.velocity = self.at(of[b.name], b.at)[2]
            b.spin = of[b.name].V[:3].copy()

    # --- what is told ------------------------------------------------------------------------

    def told(self, times: np.ndarray, Y: np.ndarray, forces: bool) -> dict[str, Channel]:
        """Channels of a run."""
        s, n = self.s, len(times)
        found: dict[str, Channel] = {}

        def put(name: str, k: int, value: Any, dims: Any, vector: bool, kind: str) -> None:
            value = np.atleast_1d(value)
            if name not in found:
                found[name] = Channel(np.zeros((n, len(value))), dims, vector, kind)
            found[name].values[k] = value

        for k, (t, y) in enumerate(zip(times, Y, strict=True)):
            x, v = y[: self.n], y[self.n :]
            now = self.solved(t, x, v)
            a, of = now.a, now.of
            for b in s.bodies:
                at = of[b.name]
                r, J, u, gain = self.at(at, b.at)
                twist = at.J[:3] @ a + at.A[:3]
                put(f"{b.name}.position", k, r, LENGTH, True, "place")
                put(f"{b.name}.velocity", k, u, SPEED, True, "speed")
                put(f"{b.name}.angular_velocity", k, at.V[:3], RATE, True, "spin")
                put(f"{b.name}.acceleration", k, J @ a + gain, ACCELERATION, True, "gain")
                put(f"{b.name}.angular_acceleration", k, twist, TURNING, True, "twist")
                put(f"{b.name}.rotation", k, at.R.reshape(9), NONE, False, "matrix")
            for sensor in s.sensors:
                name, dims = sensor.joint, s.of_joint(sensor.joint)
                slides = dims == LENGTH
                c, h = self.coordinate.get(name), 1.0
                if c is None:  # of a screw, which advances as it turns
                    c = self.coordinate[name.replace(".stroke", ".angle")]
                    h = s.joint(name.split(".")[0]).pitch / (2 * np.pi)
                value = sensor.sign * h * x[c] + sensor.at_start
                put(sensor.name, k, value, dims, False, "place" if slides else "angle")
                rate, kind = sensor.sign * h * v[c], "speed" if slides else "spin"
                put(f"{sensor.name}.rate", k, rate, dimensions(dims, RATE), False, kind)
            if forces:
                self.told_forces(put, k, now, x, v)
        return found

    def told_forces(self, put: Any, k: int, now: Solved, x: Any, v: Any) -> None:
        """Reactions, forces of links and of gears at row k."""
        a, lam, related, of, pushes = now
        s = self.s
        mu = np.linalg.lstsq(self.A.T, related, rcond=None)[0] if len(self.A) else np.zeros(0)
        names = {g.name for g in s.gears}
        own = np.array([name in names for name, _ in self.linear], bool)
        geared = self.A[own].T @ mu[own]  # what holds a joint in itself is its reaction
        need = {}  # force, and moment about the origin, that a body needs from its joints
        for b in s.bodies:
            at = of[b.name]
            r, J, _, gain = self.at(at, b.at)
            w, I = at.V[:3], at.R @ b.inertia @ at.R.T
            force = b.mass * (J @ a + gain - s.gravity)
            moment = I @ (at.J[:3] @ a + at.A[:3]) + crossed(w, I @ w) + crossed(r, force)
            need[b.name] = [force, moment]
        need["ground"] = [np.zeros(3), np.zeros(3)]
        for name, r, f, m in pushes:
            need[name][0] = need[name][0] - f
            need[name][1] = need[name][1] - crossed(r, f) - m
        told: dict[str, list[np.ndarray]] = {}
        for row, l in zip(self.rows, lam, strict=True):
            i, j = of[row.i], of[row.j]
            p, q = i.R @ row.p + i.s, j.R @ row.q + j.s
            if row.kind == "across":
                f, m = np.zeros(3), l * crossed(j.R @ row.b, i.R @ row.a)
            else:
                d = q - p
                f = l * (d / np.linalg.norm(d) if row.kind == "distance" else i.R @ row.a)
                m = np.zeros(3)
            # on j at its point; the opposite, with the same line of action, on i
            need[row.j][0] = need[row.j][0] - f
            need[row.j][1] = need[row.j][1] - crossed(q, f) - m
            need[row.i][0] = need[row.i][0] + f
            need[row.i][1] = need[row.i][1] + crossed(q, f) + m
            one = told.setdefault(row.name, [np.zeros(3), np.zeros(3)])
            one[0], one[1] = one[0] + f, one[1] + m
            if row.kind == "distance":
                put(f"{row.name}.force", k, -l, FORCE, False, "force")
        behind = list(self.held)
        for name in behind[::-1]:
            held = self.held[name]
            f, m = need[name]
            need[held.before][0] = need[held.before][0] + f
            need[held.before][1] = need[held.before][1] + m
            j = held.joint
            if j is None:
                continue
            at, base = of[name], of[held.before]
            second = at if held.forward else base
            way = 1.0 if held.forward else -1.0
            p = second.R @ np.asarray(j.at, float) + second.s
            # what gears and springs put on it about and along its axes is not the joint's
            Q = geared + self.forces(0.0, x, v, of)[1]
            R, shift = base.R, base.s
            rest_f, rest_m = f.copy(), m.copy()
            for step in held.steps:
                w = R @ step.twist[:3]
                C = np.concatenate([w, R @ step.twist[3:] + crossed(shift, w)])
                if step.k >= 0 and Q[step.k]:
                    if w.any():
                        rest_m = rest_m - Q[step.k] * C[:3]
                    else:
                        rest_f = rest_f - Q[step.k] * C[3:]
                        rest_m = rest_m - crossed(p, Q[step.k] * C[3:])
                one, part = step.moved(x)
                R, shift = R @ one, R @ part + shift
            told[j.name] = [way * rest_f, way * (rest_m - crossed(p, rest_f))]
        for j in s.joints:
            if j.name in told:
                put(f"{j.name}.reaction", k, told[j.name][0], FORCE, True, "force")
                if j.type not in ("spherical", "link", "inplane", "inline"):
                    put(f"{j.name}.reaction_moment", k, told[j.name][1], MOMENT, True, "moment")
        for (name, terms), l in zip(self.linear, mu, strict=True):
            gear = next((g for g in s.gears if g.name == name), None)
            if gear is None:
                continue
            for q, joint in enumerate(gear.joints):
                value = l * terms[self.coordinate[joint]]
                slides = s.of_joint(joint) == LENGTH
                word, dims = ("force", FORCE) if slides else ("torque", MOMENT)
                kind = "force" if slides else "moment"
                put(f"{name}.{word}_{q + 1}", k, value, dims, False, kind)

    def truth(self, y: np.ndarray, forces: bool) -> Truth:
        """Of the scene from a start on."""
        s = self.s
        times = np.arange(s.rows + 1) * s.end / s.rows
        made = self.told(times, self.run(y, times, 1e-11), forces)
        t = Truth(times, made, [], [], size=size(s), mass=lightest(s), end=s.end)
        t.gravity = max(float(np.linalg.norm(s.gravity)), 1e-9)
        top = t.top = scales(t)
        away, sure = np.zeros(len(times)), np.zeros(len(times))
        other = y.copy()
        other[self.n :] *= 1 + APART
        for start, rtol, out, by in ((other, 1e-11, away, APART), (y, 1e-9, sure, 1.0)):
            again = self.told(times, self.run(start, times, rtol), False)
            for name, c in again.items():
                if c.kind in ("place", "speed", "spin", "angle"):
                    d = np.abs(c.values - made[name].values).max(axis=1) / top[c.kind] / by
                    np.maximum(out, d, out=out)
        # what is off at 1e-9 is off by some hundredth of that here
        t.folded = self.folded
        t.growth, t.sure = np.maximum.accumulate(away), np.maximum.accumulate(sure) * 0.1
        return t
