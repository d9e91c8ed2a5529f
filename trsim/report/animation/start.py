"""Attitudes at the start of a run, from the places of the bodies and what their joints demand.

Places are recorded, attitudes may not be, and a run need not start as drawn.  First guess: from
body to body, the smallest turn that brings its joint's point to where it must be.  Then
Gauss-Newton on

    x_i + Q_i (s_i + e) - x_j - Q_j s_j = 0         points, e the recorded eccentricity
    Q_i a - Q_j a = 0                               axes of hinges and sleeves; all of slides, welds
    Q_i a . Q_j w = 0                               axes of universal joints
    n . (p - c) - r = 0                             followers of curves, see guides.py
    angle of Q_j against Q_i about a = phi          hinges whose angle is known

with Q the turn of a body since it was drawn; what the joints leave free stays as drawn.
"""

from collections.abc import Mapping

import numpy as np

from trsim.report.animation.drawing import (
    GROUND,
    LOOSE,
    SLIDES,
    STIFF,
    Array,
    Drawing,
    Guide,
    Joint,
)
from trsim.report.animation.guides import touch
from trsim.report.animation.turns import STILL, back, of_vector, product, shortest, turned

CLOSED = 1e-9  # residual, of the size of the mechanism
QUARTERS = (0.5 * np.pi, np.pi, -0.5 * np.pi)  # rad: of other guesses
MOST = 30  # steps
SMALL = 1e-5  # rad: of differences
FREE = 1e-8  # singular values, of the largest: directions the joints leave free


def attitudes(
    drawn: Drawing,
    places: Mapping[str, Array],
    plays: Mapping[str, Array],
    nodes: Mapping[str, Array],
    angles: Mapping[str, float],
) -> tuple[dict[str, Array], float]:
    """The turn of every rigid body since it was drawn, (4), and the residual left, m.

    places: centres of mass (3); plays: eccentricity of clearance joints, world axes as drawn (3);
    nodes: those of bars (k, 3); angles: of hinges since they were drawn, where they are known.
    """
    if not drawn.bodies:
        return {}, 0.0
    fixed = {GROUND: STILL}
    for name, line in nodes.items():
        chord = drawn.bars[name][-1] - drawn.bars[name][0]
        fixed[name] = shortest(chord, line[-1] - line[0])
    problem = Problem(drawn, places, plays, nodes, angles)
    still = {name: STILL for name in drawn.bodies}
    if np.max(np.abs(problem.residual(fixed | still)), initial=0.0) < CLOSED:
        return still, 0.0
    guess = problem.passed_on(fixed)
    found, left = problem.solved(fixed, guess)
    for angle in QUARTERS if drawn.guides else ():
        if left < CLOSED:
            break
        # a follower may be on the other side of what has its curve
        other = problem.solved(fixed, problem.turned_round(guess, angle))
        found, left = min((found, left), other, key=lambda one: one[1])
    return found, left * drawn.size


class Problem:
    """The equations of one mechanism; lengths in units of its size."""

    def __init__(self, drawn: Drawing, places: Mapping[str, Array], plays: Mapping[str, Array],
                 nodes: Mapping[str, Array], angles: Mapping[str, float]) -> None:  # fmt: skip
        self.drawn, self.places, self.plays, self.nodes = drawn, places, plays, nodes
        self.names = list(drawn.bodies)
        self.hinges = [(joint, angles[joint.name]) for joint in drawn.joints
                       if joint.name in angles]  # fmt: skip

    def arm(self, body: str, at: Array) -> Array:
        """From the centre of mass to a point as drawn; none on bars and the ground."""
        return at - self.drawn.bodies[body] if body in self.drawn.bodies else np.zeros(3)

    def base(self, body: str, at: Array) -> Array:
        """Where that arm begins at the start."""
        if body in self.drawn.bodies:
            return self.places[body]
        if body in self.drawn.bars:
            away = np.linalg.norm(self.drawn.bars[body] - at, axis=1)
            return self.nodes[body][int(away.argmin())]
        return at

    def equations(self, joint: Joint) -> list[tuple[Array, Array, Array]]:
        """Vectors c, a, b of c + Q_i a - Q_j b = 0."""
        found = []
        if joint.picture not in SLIDES:
            play = self.plays.get(joint.name, np.zeros(3))
            gap = self.base(joint.i, joint.at) - self.base(joint.j, joint.at)
            one = gap, self.arm(joint.i, joint.at) + play, self.arm(joint.j, joint.at)
            found.append(tuple(v / self.drawn.size for v in one))
        if joint.picture in STIFF:
            found += [(np.zeros(3), axis, axis) for axis in joint.axes]
        elif joint.picture not in LOOSE:
            found.append((np.zeros(3), joint.axis, joint.axis))
        return found  # type: ignore[return-value]

    def residual(self, turn: Mapping[str, Array]) -> Array:
        parts = [c + turned(turn[joint.i], a) - turned(turn[joint.j], b)
                 for joint in self.drawn.joints for c, a, b in self.equations(joint)]  # fmt: skip
        parts += [np.array([a @ b]) for _, a, b in self.crosses(turn)]
        parts += [np.array([self.beside(guide, turn)]) for guide in self.drawn.guides]
        parts += [np.array([self.ahead(joint, angle, turn)]) for joint, angle in self.hinges]
        return np.concatenate(parts) if parts else np.zeros(0)

    def jacobian(self, turn: Mapping[str, Array]) -> Array:
        """Derivatives against small turns of the bodies, (equations, 3 bodies)."""
        parts = [(joint, -skew(turned(turn[joint.i], a)), skew(turned(turn[joint.j], b)))
                 for joint in self.drawn.joints for _, a, b in self.equations(joint)]  # fmt: skip
        parts += [(joint, np.cross(a, b)[None], -np.cross(a, b)[None])
                  for joint, a, b in self.crosses(turn)]  # fmt: skip
        parts += [(guide, *self.along(guide, turn)) for guide in self.drawn.guides]
        for joint, _ in self.hinges:
            axis = turned(turn[joint.i], joint.axis)[None]
            parts.append((joint, -axis, axis))
        rows = []
        for one, of_i, of_j in parts:
            row = np.zeros((len(of_i), 3 * len(self.names)))
            for body, part in ((one.i, of_i), (one.j, of_j)):
                if body in self.drawn.bodies:
                    k = 3 * self.names.index(body)
                    row[:, k : k + 3] = part
            rows.append(row)
        return np.concatenate(rows)

    def crosses(self, turn: Mapping[str, Array]) -> list[tuple[Joint, Array, Array]]:
        """The universal joints, with their axes on the first and on the second body."""
        return [
            (joint, turned(turn[joint.i], joint.axis), turned(turn[joint.j], joint.axes[1]))
            for joint in self.drawn.joints
            if joint.picture == "cross"
        ]

    def beside(self, guide: Guide, turn: Mapping[str, Array]) -> float:
        """How far a follower is from its curve."""
        i, j = guide.i, guide.j
        there = self.base(j, guide.at) + turned(turn[j], self.arm(j, guide.at))
        there = there - self.base(i, guide.origin) - turned(turn[i], self.arm(i, guide.origin))
        seen = guide.axes @ turned(back(turn[i]), there)
        face = None
        if guide.face is not None:
            face = (guide.axes @ turned(back(turn[i]), turned(turn[j], guide.face)))[None]
        return float(touch(guide, seen[None], face).off[0]) / self.drawn.size

    def ahead(self, joint: Joint, angle: float, turn: Mapping[str, Array]) -> float:
        """By how much a hinge has turned more than it is known to have, rad."""
        q = product(back(turn[joint.i]), turn[joint.j])
        over = 2.0 * np.arctan2(q[:3] @ joint.axis, q[3]) - angle
        return float((over + np.pi) % (2.0 * np.pi) - np.pi)

    def along(self, guide: Guide, turn: Mapping[str, Array]) -> tuple[Array, Array]:
        """Derivatives of that against small turns of both bodies, by differences."""
        found = []
        for body in (guide.i, guide.j):
            both = []
            for sign in (1.0, -1.0):
                turns = [product(of_vector(sign * SMALL * axis), turn[body]) for axis in np.eye(3)]
                both.append(np.array([self.beside(guide, {**turn, body: q}) for q in turns]))
            found.append((both[0] - both[1])[None] / (2.0 * SMALL))
        return found[0], found[1]

    def passed_on(self, fixed: Mapping[str, Array]) -> dict[str, Array]:
        """First guesses, from bodies that are known to those they are joined to."""
        known = dict(fixed)
        while True:
            reached = [(joint, a, b) for joint in self.drawn.joints
                       for a, b in ((joint.i, joint.j), (joint.j, joint.i))
                       if a in known and b not in known]  # fmt: skip
            if not reached:
                return {name: known.get(name, STILL) for name in self.names}
            # slides and welds tell the most, and of points the one farthest from the centre
            joint, a, b = max(reached, key=lambda one: (one[0].picture in STIFF, self.reach(*one)))
            if joint.picture in STIFF or self.reach(joint, a, b) < CLOSED:
                known[b] = known[a]
                continue
            arm = self.arm(b, joint.at)
            there = self.base(a, joint.at) + turned(known[a], self.arm(a, joint.at))
            known[b] = shortest(arm, there - self.places[b])

    def turned_round(self, guess: Mapping[str, Array], angle: float) -> dict[str, Array]:
        """A guess with all bodies that have curves turned by an angle about their normals."""
        made = dict(guess)
        for guide in self.drawn.guides:
            if guide.i in made:
                axis = turned(guess[guide.i], guide.axes[2])
                made[guide.i] = product(of_vector(angle * axis), guess[guide.i])
        return made

    def reach(self, joint: Joint, _: str, body: str) -> float:
        return float(np.linalg.norm(self.arm(body, joint.at))) / self.drawn.size

    def solved(self, fixed: Mapping[str, Array], turn: dict[str, Array]
               ) -> tuple[dict[str, Array], float]:  # fmt: skip
        """The turns after Gauss-Newton, and the largest residual."""
        for _ in range(MOST):
            phi = self.residual({**fixed, **turn})
            if np.max(np.abs(phi)) < CLOSED:
                break
            J = self.jacobian({**fixed, **turn})
            d = np.linalg.lstsq(J, -phi, rcond=FREE)[0].reshape(-1, 3)
            turn = {name: product(of_vector(d[k]), turn[name])
                    for k, name in enumerate(self.names)}  # fmt: skip
            if np.abs(d).max() < 1e-14:
                break
        return turn, float(np.abs(self.residual({**fixed, **turn})).max())


def skew(v: Array) -> Array:
    """The matrix of v x."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
