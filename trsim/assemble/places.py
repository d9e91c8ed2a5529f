"""The scenario as drawn: where bodies, points and joint coordinates are."""

from dataclasses import dataclass, field
from math import atan2
from typing import Any, NamedTuple

import numpy as np

from trsim.assemble.asked import is_asked, points_of
from trsim.assemble.dense import product, turned_back
from trsim.assemble.members import AT_A_NODE, Beam, beams, off_the_nodes
from trsim.assemble.orientation import orientations
from trsim.elements.contract import N_BOOK
from trsim.elements.coordinates import BEND, bend_of, named
from trsim.elements.joint import triad
from trsim.elements.rows import ARC, COORDINATES
from trsim.errors import ScenarioError, known
from trsim.frame import Frame
from trsim.scenario.slender import ends


class JointCoordinate(NamedTuple):
    """An angle or a stroke of a joint, ready for those who act along it."""

    name: str  # what it is called
    joint: str
    entry: int  # in S
    kind: str  # angle, stroke, ARC, BEND, or WOUND: what else is known up to full turns
    i: int
    j: int
    s_i: tuple[float, ...]  # the joint's point in both bodies
    s_j: tuple[float, ...]
    axis_i: tuple[float, ...]  # its axis in body i
    axis: tuple[float, ...]  # and in world axes as drawn
    drawn: float  # value as drawn
    place: tuple[float, ...]  # the joint's point in world axes as drawn
    curve: tuple[int, ...] = ()  # of an arc: offset in tab, entry of u, 1: of a point on it
    # and the y axis of its plane, where axis_i is the x axis; of a bend the axis of body j, in it
    other_i: tuple[float, ...] = ()
    # the axis is one of the joint's second body: that is i, and j the first one
    turned: bool = False
    from_drawing: bool = False  # an angle that is 0 as drawn


WOUND = "wound"


@dataclass
class Places:
    """The scenario as drawn, and the numbers of what is computed of it."""

    scenario: Any
    elements: dict[tuple[str, str], Any]  # (section, name) -> Element
    members: dict[str, Any]  # the bodies: rigid, or flexible bars
    states: list[tuple[str | float, int]] = field(default_factory=list)  # scale, coordinate
    coordinates: dict[str, JointCoordinate] = field(default_factory=dict)
    n_s: int = 0
    notes: list[str] = field(default_factory=list)
    of_start: bool = False  # bars are stiff, joints ideal or drives others than in the run

    def __post_init__(self) -> None:
        rigid = {n: spec for n, spec in self.members.items() if spec.flexible is None}
        self.frames = {"ground": 0} | {name: f for f, name in enumerate(rigid, start=1)}
        self.n_rigid = len(self.frames)
        self.beams: dict[str, Beam] = beams(self.members, self.n_rigid)
        self.owners = ["ground", *rigid]  # of every frame
        for name, beam in self.beams.items():
            self.frames |= {f"{name}[{k}]": beam.first + k for k in range(beam.nodes)}
            self.owners += [name] * beam.nodes
        nodes = [place for beam in self.beams.values() for place in beam.places]
        self.at_start = np.array([(0.0, 0.0, 0.0), *(s.at for s in rigid.values()), *nodes], float)
        self.angle, self.about_z, self.rotation = orientations(rigid, self.beams)
        # the same as floats, for what is asked of each point: numpy is slow with three numbers
        self.centres = [(x, y, z) for x, y, z in self.at_start.tolist()]
        self.turns = self.rotation.tolist()
        self.flat = all(spec.drawn_in is None or spec.drawn_in.flat for spec in rigid.values())
        self.points: list[tuple[int, tuple[float, ...]]] = []  # for arms and the size

    def body(self, name: str, *path: str | int, near: Any = None, off: float = AT_A_NODE) -> int:
        """Frame of a body; ground is 0.  Of a flexible bar the node at the place `near`.

        near: its middle unless given; off: how far from a node that may be, in lengths of the bar.
        """
        if name in self.beams:
            return self._node(name, path, near, off)
        if name not in self.frames:
            known_names = ["ground", *self.members]
            raise ScenarioError(f"no body named '{name}'", known(name, known_names), path)
        return self.frames[name]

    def _node(self, name: str, path: tuple[str | int, ...], near: Any, off: float) -> int:
        beam = self.beams[name]
        place = 0.5 * (beam.places[0] + beam.places[-1]) if near is None else np.array(near)
        away = np.linalg.norm(beam.places - place, axis=1)
        k = int(np.argmin(away))
        if away[k] > off * beam.whole:
            what, hint = off_the_nodes(self.scenario, name, beam, place)
            if near is None:
                what = f"without `at` this is at the middle of '{name}', and that {what}"
            raise ScenarioError(what, hint, path)
        return beam.first + k

    def frame(self, name: str, near: Any = None) -> int:
        """What axes turn with: the world, a body, or the body of a named point."""
        points = self.scenario.points
        owner = "ground" if name == "world" else points[name].body if name in points else name
        if owner != "ground" and owner not in self.members:
            there = ["world", *self.members, *points]
            raise ScenarioError(f"no body or point named '{name}'", known(name, there), ("frame",))
        return self.body(owner, "frame", near=near, off=1.0)

    def bodies(self, pair: tuple[str, str], at: Any, other: Any = None) -> tuple[int, int]:
        """Frames of two different bodies, at a place; or each at its own."""
        if pair[0] == pair[1]:
            raise ScenarioError(
                f"joins '{pair[0]}' to itself", "name two different bodies", ("bodies",)
            )
        i = self.body(pair[0], "bodies", 0, near=at)
        return i, self.body(pair[1], "bodies", 1, near=at if other is None else other)

    def bar(self, name: str) -> Any:
        """The spec of a flexible bar, also where it is stiff for a start; None of others."""
        spec = self.scenario.bodies.get(name)
        if spec is None or spec.flexible is None:
            return None
        return spec.bar(*ends(self.scenario, name))

    def is_node(self, i: int) -> bool:
        """Whether a frame is a node of a flexible bar."""
        return i >= self.n_rigid

    def tangent(self, i: int) -> tuple[float, ...]:
        """The tangent of a node of a flexible bar as drawn; empty for other frames."""
        return tuple(self.rotation[i][:, 0].tolist()) if self.is_node(i) else ()

    def centre(self, i: int) -> tuple[float, ...]:
        """Centre of mass as drawn."""
        return self.centres[i]

    def local(self, i: int, place: tuple[float, ...]) -> tuple[float, ...]:
        """A world point as drawn, in the axes of a body from its centre of mass."""
        (x, y, z), (a, b, c) = place, self.centres[i]
        s = turned_back(self.turns[i], (x - a, y - b, z - c))
        self.points.append((i, s))
        return s

    def looked_at(self, i: int, place: tuple[float, ...]) -> tuple[float, ...]:
        """The same of what is only looked at: it does not belong to the size of a mechanism."""
        return self.axes(i, tuple(p - c for p, c in zip(place, self.centre(i), strict=True)))

    def axes(self, i: int, direction: tuple[float, ...]) -> tuple[float, ...]:
        """A world direction as drawn, in the axes of a body."""
        return turned_back(self.turns[i], direction)

    def drawn_angle(
        self, i: int, j: int, axis: tuple[float, ...], frame: Frame | None = None
    ) -> float:
        """Angle of body j's axes against body i's about a world axis, as drawn.

        frame: what the joint was drawn in; its angle is that of the same drawing in the world.
        """
        along = (frame.inside((axis[0], axis[1], axis[2])) if frame else axis)[2]
        if abs(along) <= 0.999:
            return 0.0
        return float((self.own_angle(j, frame) - self.own_angle(i, frame)) * along)

    def own_angle(self, i: int, frame: Frame | None) -> float:
        """Angle of a body's axes about the z axis of a frame, or of the world, as drawn."""
        if frame is None:
            return float(self.about_z[i])
        if not self.is_node(i):
            return float(self.angle[i])
        x, y, _ = frame.inside(self.beams[self.owners[i]].tangent)
        return atan2(y, x)

    def mass(self, i: int) -> float:
        if i == 0:
            return float("inf")
        spec = self.members[self.owners[i]]
        return float(spec.whole_mass if self.is_node(i) else spec.mass)

    def inertia_about(self, i: int, axis: tuple[float, ...], through: tuple[float, ...]) -> float:
        """Moment of inertia of one body about an axis (world, as drawn): a . I a + m d^2.

        through: a point of the axis, in the axes of frame i from its origin; d is the distance of
        the body's centre of mass from the axis.
        """
        a, body = np.array(axis), self.members[self.owners[i]]
        place = self.at_start[i] + product(self.rotation[i], np.array(through))
        if self.is_node(i):  # a slender bar
            across = np.linalg.norm(np.cross(self.rotation[i][:, 0], a))
            own = body.per_length * body.length**3 / 12.0 * across**2
            ends = self.beams[self.owners[i]].places
            centre = 0.5 * (ends[0] + ends[-1])
        else:
            inside, centre = np.array(self.axes(i, axis)), self.at_start[i]
            own = inside @ np.array(body.tensor[0]).reshape(3, 3) @ inside
        away = np.cross(place - centre, a)
        return float(own + self.mass(i) * (away @ away))

    def coordinate(
        self, reference: str, kind: str = "", path: tuple[str | int, ...] = ("joint",)
    ) -> JointCoordinate:
        """A coordinate of a joint; entering it in S is what makes it computed.

        kind: what it must be; path: where it is named.
        """
        name, joint, own = named(reference, self.scenario.joints, kind, path)
        if name not in self.coordinates:
            kind, letter, of, counts = COORDINATES[own]
            spec, turned, zero = self.scenario.joints[joint], of == "j", counts == "drawing"
            i, j = self.bodies(spec.bodies, spec.at)
            place = self.centre(j) if spec.at is None else spec.at
            axis = triad(spec)["uwa".index(letter)]
            if turned:  # seen from its second body the first one turns the other way
                i, j, axis = j, i, tuple(-c for c in axis)
            angle = kind == "angle" and not zero
            drawn = self.drawn_angle(i, j, axis, spec.drawn_in) if angle else 0.0
            points, s = (self.local(i, place), self.local(j, place)), self.entry()
            self.coordinates[name] = JointCoordinate(
                name, joint, s, kind, i, j, *points, self.axes(i, axis), axis, drawn, tuple(place),
                turned=turned, from_drawing=zero,
            )  # fmt: skip
        return self.coordinates[name]

    def bend(self, reference: str) -> JointCoordinate | None:
        """The bend of a joint, where that is what a reference names: no entry of S."""
        joint, axes = bend_of(reference, self.scenario.joints)
        if axes is None:
            return None
        spec, (a, b) = self.scenario.joints[joint], axes
        i, j = self.bodies(spec.bodies, spec.at)
        s_i, s_j = self.local(i, spec.at), self.local(j, spec.at)
        drawn = atan2(float(np.linalg.norm(np.cross(a, b))), float(np.dot(a, b)))
        return JointCoordinate(
            f"{joint}.{BEND}", joint, -1, BEND, i, j, s_i, s_j, self.axes(i, a), a, drawn,
            tuple(spec.at), other_i=self.axes(j, b),
        )  # fmt: skip

    def turn(
        self, name: str, i: int, j: int, axis: tuple[float, ...], frame: Frame | None
    ) -> JointCoordinate:
        """An angle of body j against body i about a world axis that no joint has: it is counted
        over turns like those of joints, under the name of what tells it."""
        points = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        drawn = self.drawn_angle(i, j, axis, frame)
        self.coordinates[name] = JointCoordinate(
            name, "", self.entry(), "angle", i, j, *points, self.axes(i, axis), axis, drawn,
            self.centre(j),
        )  # fmt: skip
        return self.coordinates[name]

    def on_curve(
        self, name: str, own: Any, drawn: tuple[float, float], point: str
    ) -> tuple[int, int]:
        """Entries of S with the place of a joint on its curve: its length, and u (laws/curves.py).

        own: packed columns of the joint that say where; drawn: both as drawn; point: where the
        point is that goes along the curve: "on" it, "beside" it, or "" where there is none.
        """
        spec, s, u = self.scenario.joints[name], self.entry(), self.wound(f"{name} u", drawn[1])
        where = (own.i, own.j, own.p_i, own.p_j, own.u_i, (0.0, 0.0, 0.0))
        curve = (own.curve, u, int(point == "on")) if point else ()
        self.coordinates[name] = JointCoordinate(
            name, name, s, ARC, *where, drawn[0], tuple(spec.at), curve, own.w_i
        )
        return s, u

    def wound(self, name: str, drawn: float) -> int:
        """A new entry of S that is known up to full turns, as an angle is, and its value as drawn.

        name: that of its element and something behind a blank: no name a user can write.
        """
        none, entry = (0.0, 0.0, 0.0), self.entry()
        where = (0, 0, none, none, none, none)
        self.coordinates[name] = JointCoordinate(
            name, name.split()[0], entry, WOUND, *where, drawn, none
        )
        return entry

    def entry(self) -> int:
        """Index of a new entry of S."""
        self.n_s += 1
        return self.n_s - 1

    def size_of(self, i: int) -> float:
        """The largest arm of a body as drawn so far, or a metre, m."""
        arms = [float(np.linalg.norm(s)) for f, s in self.points if f == i]
        return max(arms, default=0.0) or 1.0

    def asks(self, channel: str) -> bool:
        """Whether a channel is recorded, or shown by a section, a portrait or an event."""
        patterns = tuple(self.scenario.output.channels)
        return is_asked(channel, patterns) or channel in points_of(self.scenario)

    def state(self, scale: str | float, follows: int = -1) -> int:
        """A state of an element's own in z: scale for the error norm ('angle', 'stroke', 'speed',
        0: none or a magnitude), and the coordinate it starts at.  Returns its index in z."""
        self.states.append((scale, follows))
        return N_BOOK + len(self.states) - 1
