"""Static paths judged by the forces of engine.py: at rest, with the place of every joint sought.

An open chain is where its joints say.  With no speeds, and the driven joint where its motion has
it, equilibrium is where no free joint begins to move: Newton's method on those accelerations, by
differences, from one row to the next in small steps.  Friction is full against the way that has
just been gone; where a way turns round, or may stick, nothing is judged from there on.  A path is
followed as long as it is stable; where one is told to end it must not go on here.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from . import engine as e
from .grips import LAWS
from .judge import CRASH, REFUSED, RIGHT, UNJUDGED, WRONG, Ran, Verdict
from .reference import Builder, Channel, Unfit, moved, scales, size, start_state, told
from .scene import Fn, Grip, Scene
from .vectors import crossed

BOUND, RUBBED = 1e-6, 3e-5  # of the scales; where what rubs slides in directions that turn
PARTS = 5  # steps from row to row
FAR = 0.2  # rad or a length: what is further away is another equilibrium
SMALL = 1e-6  # of differences
LIMIT = "limit"  # how a path ends that has no way on
NOTHING = 1e-9  # of what scenes are drawn with: where nothing acts, rounding is left
CREEP = 1e-6  # speed of the way, which no inertia feels


class Balance:
    """The forces of a scene at rest."""

    def __init__(self, s: Scene) -> None:
        self.s = s
        # friction is full at any speed
        laws = [
            replace(x, v0=0.0, v1=1e-12, friction=x.friction and FULL[x.friction])
            if isinstance(x, Grip)
            else x
            for x in s.laws
        ]
        self.still = replace(
            s,
            drives=[replace(d, fn=Fn("constant", (0.0,)), by_rate=False) for d in s.drives],
            laws=laws,
        )
        self.b = Builder(self.still)
        self.m = self.b.arrays
        self.rubs = any(isinstance(x, Grip) and LAWS[x.friction] for x in laws)
        self.driven = [d.joint for d in s.drives]
        self.free = [name for name in self.b.coordinate if name not in self.driven]
        self.motion = Builder(replace(s, forces=[], joints=s.joints, events=[], sections=[]))

    def place_of(self, t: float) -> dict[str, float]:
        """Driven joints at t."""
        found = {}
        for d in self.s.drives:
            g = self.motion.function(d.fn)
            m = self.motion.packed()
            value = float(e.evaluated(m, g, t, np.ones(len(m.watch)))[0])
            found[d.joint] = value
        return found

    def state(self, q: dict[str, float], way: dict[str, float] | None = None) -> np.ndarray:
        """The bodies where joints are, with speeds along a way."""
        y = start_state(self.b)
        y.reshape(-1)[: 13 * len(self.s.bodies)].reshape(-1, 13)[:, 7:] = 0.0
        for joint in self.s.joints:
            moved(self.b, y, joint.name, q[joint.name])
        for name, k in self.b.coordinate.items():
            if self.m.coordinate[k, 0] == e.TURN:
                y[13 * len(self.s.bodies) + k] = q[name]
        if way is not None:
            h = 1e-5
            one, other = (self.state({n: q[n] + f * h * way[n] for n in q}) for f in (1, -1))
            for b in range(len(self.s.bodies)):
                c = 13 * b
                y[c + 7 : c + 10] = CREEP * (one[c : c + 3] - other[c : c + 3]) / (2 * h)
                p, d = y[c + 3 : c + 7], (one[c + 3 : c + 7] - other[c + 3 : c + 7]) / (2 * h)
                y[c + 10 : c + 13] = (
                    2 * CREEP * (p[0] * d[1:] - d[0] * p[1:] + crossed(p[1:], d[1:])) * [1, 1, 1]
                )
        return y

    def forces(self, t: float, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """y', multipliers, forces; contacts are in where they touch."""
        m, g = self.m, np.zeros(len(self.m.watch))
        e.watched(m, t, y, g)
        side = np.where(g > 0.0, 1.0, -1.0)
        yd, lam, forces = np.zeros(len(y)), np.zeros(len(m.row)), np.zeros((len(m.force), 4))
        e.derivative(m, t, y, side, np.ones(len(m.force)), yd, lam, forces)
        return yd, lam, forces

    def begins(self, t: float, q: dict[str, float], way: Any) -> np.ndarray:
        """Accelerations of the free joints."""
        y = self.state(q, way)
        yd, _, _ = self.forces(t, y)
        n = len(self.s.bodies)
        R = e.rotations(y, n + 1)
        r, v, w = e.places(y, n + 1)
        # rates of coordinates by accelerations instead of speeds; speeds are next to nothing
        for b in range(1, n + 1):
            c = 13 * (b - 1)
            v[b], w[b] = yd[c + 7 : c + 10], yd[c + 10 : c + 13]
        _, gain = e.coordinates(self.m, y, r, v, w, R)
        return np.array([gain[self.b.coordinate[name]] for name in self.free])

    def slope(self, t: float, q: dict[str, float], way: Any) -> np.ndarray:
        n = len(self.free)
        J = np.empty((n, n))
        for k, name in enumerate(self.free):
            one, other = (self.begins(t, q | {name: q[name] + x}, way) for x in (SMALL, -SMALL))
            J[:, k] = (one - other) / (2 * SMALL)
        return J

    def balanced(self, t: float, q: dict[str, float], way: Any) -> tuple[dict[str, float], float]:
        """The equilibrium next to it, and the largest real part of the slopes: stable below 0."""
        begun = q
        for _ in range(40):
            f = self.begins(t, q, way)
            J = self.slope(t, q, way)
            step = np.linalg.solve(J, -f)
            most = float(np.abs(step).max(initial=0.0))
            step *= min(1.0, 0.2 / max(most, 1e-300))
            q = q | {name: q[name] + float(x) for name, x in zip(self.free, step, strict=True)}
            if max(abs(q[name] - begun[name]) for name in self.free) > FAR:
                raise Unfit(f"another equilibrium at {t:g}")
            if most < 1e-12:
                break
        else:
            raise Unfit(f"no equilibrium found at {t:g}")
        return q, float(np.linalg.eigvals(self.slope(t, q, way)).real.max(initial=-np.inf))


FULL = {"none": "none", "modified_coulomb": "modified_coulomb", "sticking": "modified_coulomb"}


def slips(balance: Balance, q: dict[str, float], way: Any) -> list[float]:
    """Sliding of contacts per way."""
    from .touches import sliding

    y = balance.state(q, way)
    n = len(balance.s.bodies)
    R, (r, v, w) = e.rotations(y, n + 1), e.places(y, n + 1)
    found = []
    m = balance.m
    for k in range(len(m.force)):
        if m.force[k, 0] == e.TOUCH:
            i, j = int(m.force[k, 1]), int(m.force[k, 2])
            from .touches import meeting

            depth, _, normal, place = meeting(m.force_par, k, i, j, r, v, w, R, m.table)
            ez = R[i] @ m.force_par[k, 17:20]
            u, _ = sliding(normal, i, j, r, v, w, place)
            found.append(float(np.dot(u, np.cross(normal, ez))) / CREEP if depth > 0 else 0.0)
    return found


def judged(s: Scene, r: Ran, v: Verdict) -> Verdict:
    """The rows of a static path."""
    v.exit, v.warnings = r.exit, r.warnings
    if r.exit:
        v.verdict, v.why = (REFUSED if r.exit in (3, 4, 5) else CRASH), r.reason
        return v
    T = s.unit((0, 0, 1))
    times = r.t / T
    balance = Balance(s)
    first = {
        name: r[f"at_{name}"][0, 0] / s.unit(s.of_joint(name)) for name in balance.b.coordinate
    }
    q, kept = dict(first), []
    way: dict[str, float] | None = None
    until, why = times[-1], ""
    for k, t in enumerate(times):
        try:
            before = times[max(k - 1, 0)]
            for part in range(1, PARTS + 1):
                at = before + (t - before) * part / PARTS if k else 0.0
                last = q
                guess = q | balance.place_of(at)
                if way is not None:
                    ahead = (t - before) / PARTS
                    guess = {n: q[n] + way[n] * ahead for n in q} | balance.place_of(at)
                if (
                    balance.rubs
                    and k
                    and turned(balance, before + (t - before) * (part - 1) / PARTS, at)
                ):
                    raise Unfit("a drive turns round, and what rubs with it")
                if balance.rubs and way is None:
                    if k:
                        way = {n: 0.0 for n in q} | rates(balance, at)
                    else:
                        break
                q, top = balance.balanced(at, guess, way if balance.rubs else None)
                if k and t > before:
                    ahead = (t - before) / PARTS
                    before_slip = slips(balance, last, way) if balance.rubs and way else []
                    way = {n: (q[n] - last[n]) / ahead for n in q}
                    if balance.rubs:
                        for _ in range(3):
                            q, top = balance.balanced(at, q, way)
                            came = slips(balance, q, way)
                            way = {n: (q[n] - last[n]) / ahead for n in q}
                        after = slips(balance, q, way)
                        if any(a * b < 0 for a, b in zip(came, after, strict=True)):
                            raise Unfit("it sticks, or which way it rubs is not settled")
                        if before_slip and any(
                            a * b < 0 or (b != 0 and abs(b) < 1e-4 * size(s) / s.end)
                            for a, b in zip(before_slip, after, strict=True)
                        ):
                            raise Unfit("what rubs may turn round")
                if top > -1e-9:
                    raise Unfit(f"unstable at {at:g}")
                if k == 0:
                    break
        except (Unfit, np.linalg.LinAlgError) as error:
            until, why = times[max(k - 1, 0)], str(error)
            break
        if balance.rubs and k == 0:
            q = dict(first)
            continue
        kept.append((k, dict(q), way))
    if not kept:
        v.verdict, v.why = UNJUDGED, why
        return v
    Y, YD, LAM, F = [], [], [], []
    for k, place, along in kept:
        y = balance.state(place, along if balance.rubs else None)
        yd, lam, forces = balance.forces(times[k], y)
        for rows, one in zip((Y, YD, LAM, F), (y, yd, lam, forces), strict=True):
            rows.append(one)
    rows = tuple(np.array(x) for x in (Y, YD, LAM, F))
    n = len(balance.m.row)
    found = {
        name: Channel(values, dims, vector, kind)
        for name, values, dims, vector, kind in told(
            balance.still, balance.b, list(range(n)), np.arange(len(kept)), rows
        )
    }
    return compared(s, r, v, found, [k for k, _, _ in kept], (until, why))


def rates(balance: Balance, t: float) -> dict[str, float]:
    """Of the driven joints."""
    h = 1e-6
    one, other = balance.place_of(t + h), balance.place_of(t - h)
    return {name: (one[name] - other[name]) / (2 * h) for name in one}


def turned(balance: Balance, before: float, after: float) -> bool:
    """Whether a drive turns round between two times: no way from one to the other tells where."""
    first, last = rates(balance, before), rates(balance, after)
    return any(first[name] * last[name] < 0.0 for name in first)


LEFT_OUT = ("velocity", "acceleration", ".rate", "energy", "penetration_rate")


def compared(
    s: Scene, r: Ran, v: Verdict, found: dict[str, Channel], at: list[int], end: tuple[float, str]
) -> Verdict:
    """The worst of all channels over its bound."""
    from .reference import Truth

    top = scales(
        Truth(
            r.t[at],
            found,
            [],
            [],
            size=size(s),
            mass=1e-3,
            gravity=float(np.linalg.norm(s.gravity)),
        )
    )
    if r.status == LIMIT and at and at[-1] == len(r.t) - 1:  # there places change with the root
        at, found = at[:-1], {n: replace(c, values=c.values[:-1]) for n, c in found.items()}
    turning = not s.flat and any(isinstance(x, Grip) and x.friction != "none" for x in s.laws)
    bound = RUBBED if turning else BOUND
    for name, c in found.items():
        if name not in r.place or any(word in name for word in LEFT_OUT):
            continue
        got = r[name][at] / s.unit(c.dims)  # type: ignore[arg-type]
        if c.vector:
            got = got @ s.turned
            got = got - s.moved if name.endswith(".position") else got
        elif c.kind == "matrix":
            Q = s.turned
            got = np.einsum("ji,njk,kl->nil", Q, got.reshape(-1, 3, 3), Q).reshape(-1, 9)
        off = np.abs(got - c.values)
        ratio = np.where(np.isfinite(got), off, np.inf) / (bound * max(top[c.kind], NOTHING))
        i, j = np.unravel_index(np.argmax(ratio), ratio.shape)
        if ratio[i, j] > v.ratio:
            v.ratio = float(ratio[i, j])
            when = r.t[at[i]] / s.unit((0, 0, 1))
            v.what = f"{name}[{j}] at {when:.6g}: {got[i, j]:.8g} for {c.values[i, j]:.8g}"
    v.reach = len(at) / len(r.t)
    v.truth = f"followed to {end[0]:.4g} of {s.end:.4g}; {end[1]}; {r.status}"
    v.verdict = RIGHT if v.ratio <= 1.0 else WRONG
    return v
