"""What `pack` may ask: where a body, a point, a joint coordinate or a function lives."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import atan2
from typing import Any, NamedTuple

import numpy as np

from trsim.assemble.cornered import Cornered, cornered
from trsim.assemble.dense import product
from trsim.assemble.instances import Named
from trsim.assemble.members import AT_A_NODE, Beam, beams, off_the_nodes
from trsim.assemble.orientation import orientations
from trsim.assemble.overshoot import overshoot
from trsim.assemble.poles import Guard, guards
from trsim.assemble.waves import Swinging
from trsim.elements.coordinates import ANY, named, split
from trsim.elements.joint import triad
from trsim.elements.rows import ARC, COORDINATES
from trsim.errors import ScenarioError, known
from trsim.expressions import LOW, degree, names, rebuilt
from trsim.frame import Frame
from trsim.laws import functions
from trsim.laws.waves import waves
from trsim.scenario.load import unit_of
from trsim.scenario.slender import ends
from trsim.units import fits
from trsim.varying import RATE


class JointCoordinate(NamedTuple):
    """An angle or a stroke of a joint, ready for those who act along it."""

    name: str  # what it is called
    joint: str
    entry: int  # in S
    kind: str  # angle, stroke, ARC, or WOUND: what else is known up to full turns
    i: int
    j: int
    s_i: tuple[float, ...]  # the joint's point in both bodies
    s_j: tuple[float, ...]
    axis_i: tuple[float, ...]  # its axis in body i
    axis: tuple[float, ...]  # and in world axes as drawn
    drawn: float  # value as drawn
    place: tuple[float, ...]  # the joint's point in world axes as drawn
    curve: tuple[int, ...] = ()  # of an arc: offset in tab, entry of u, 1: of a point on it
    other_i: tuple[float, ...] = ()  # and the y axis of its plane, where axis_i is the x axis
    # the axis is one of the joint's second body: that is i, and j the first one
    turned: bool = False
    from_drawing: bool = False  # an angle that is 0 as drawn


NO_NAMES: Mapping[str, tuple[int, str]] = {}
WOUND = "wound"
UNITS = {"angle": "rad", "stroke": "m", "arc": "m", "time": "s", "speed": "m/s"}


@dataclass
class Addresses:
    """The scenario as drawn, and the tables that grow while elements are packed."""

    scenario: Any
    elements: dict[tuple[str, str], Any]  # (section, name) -> Element
    members: dict[str, Any]  # the bodies: rigid, or flexible bars
    tab: list[float] = field(default_factory=lambda: [0.0])
    states: list[tuple[str | float, int]] = field(default_factory=list)  # scale, coordinate
    coordinates: dict[str, JointCoordinate] = field(default_factory=dict)
    sensors: dict[str, int] = field(default_factory=dict)
    rates: dict[int, int] = field(default_factory=dict)  # entry of S -> that of its rate
    n_s: int = 0
    timed: bool = False  # something depends on t explicitly
    sensed: bool = False  # or on a sensor, and may be short between two corners
    notes: list[str] = field(default_factory=list)
    instances: dict[tuple[str, str], Any] = field(default_factory=dict)  # packed so far
    switches: Any = None  # of user events, once all elements are packed
    of_start: bool = False  # bars are stiff, joints ideal or drives others than in the run
    end: float | None = None  # s, of the run, where its functions are wanted with their corners
    functions: list[Cornered] = field(default_factory=list)  # those that have some
    packed_functions: list[Named] = field(default_factory=list)
    waves: list[Swinging] = field(default_factory=list)
    shown: list[Swinging] = field(default_factory=list)  # formulas
    guards: list[Guard] = field(default_factory=list)  # of functions that may have no value
    jumped: dict[int, Any] = field(default_factory=dict)  # of drives: offset -> jumps at each

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
        return tuple(self.at_start[i])

    def local(self, i: int, place: tuple[float, ...]) -> tuple[float, ...]:
        """A world point as drawn, in the axes of a body from its centre of mass."""
        s = tuple(product(self.rotation[i].T, np.array(place) - self.at_start[i]))
        self.points.append((i, s))
        return s

    def looked_at(self, i: int, place: tuple[float, ...]) -> tuple[float, ...]:
        """The same of what is only looked at: it does not belong to the size of a mechanism."""
        return self.axes(i, tuple(p - c for p, c in zip(place, self.centre(i), strict=True)))

    def axes(self, i: int, direction: tuple[float, ...]) -> tuple[float, ...]:
        """A world direction as drawn, in the axes of a body."""
        return tuple(product(self.rotation[i].T, np.array(direction)))

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

    def sensor(self, name: str) -> int:
        """Index of a sensor in S."""
        if name not in self.sensors:
            self.sensors[name] = self.entry()
        return self.sensors[name]

    def rate_of(self, entry: int) -> int:
        """Index of the rate of an entry of S in S, as functions read it."""
        if entry not in self.rates:
            self.rates[entry] = self.entry()
        return self.rates[entry]

    def entry(self) -> int:
        """Index of a new entry of S."""
        self.n_s += 1
        return self.n_s - 1

    def size_of(self, i: int) -> float:
        """The largest arm of a body as drawn so far, or a metre, m."""
        arms = [float(np.linalg.norm(s)) for f, s in self.points if f == i]
        return max(arms, default=0.0) or 1.0

    def acting_on(self, body: int) -> list[tuple[int, Any]]:
        """The joints, drives, forces and locks packed so far that push or hold a body, by their
        numbers."""
        found = []
        for e, instance in enumerate(self.instances.values()):
            places = instance.element.acts_at
            acted = (f for f, _ in places(instance.row)) if places else instance.named_by_rows
            if instance.section not in ("", "bodies", "points", "sensors") and body in (*acted,):
                found.append((e, instance))
        return found

    def numbered(self, section: str, name: str) -> tuple[int, Any]:
        """An instance that is packed before the one that asks, with its number."""
        return [*self.instances].index((section, name)), self.instances[section, name]

    def joint_of(self, instance: Any) -> str:
        """The joint along whose coordinate a drive, a force or a lock acts; of others none."""
        name, joints = instance.name, self.scenario.joints
        spec = getattr(self.scenario, instance.section, {}).get(name)
        if instance.section == "events":  # a lock, by the coordinate it holds
            return split(name.rpartition(".")[0], joints)[0]
        return split(getattr(spec, "joint", None) or "", joints)[0]

    def packed(self, section: str, name: str, path: tuple[str | int, ...]) -> Any:
        """The instance of an element that is packed before the one that asks."""
        if (section, name) not in self.instances:
            there = [n for s, n in self.instances if s == section]
            raise ScenarioError(f"nothing named '{name}' in {section}", known(name, there), path)
        return self.instances[section, name]

    def sensor_kind(self, name: str) -> str:
        """What a sensor shows: an angle or a stroke, its own or that of its joint."""
        own = self.elements["sensors", name].coordinates
        return own[0] if own else self.coordinate(self.scenario.sensors[name].joint, ANY).kind

    def state(self, scale: str | float, follows: int = -1) -> int:
        """A state of an element's own in z: scale for the error norm ('angle', 'stroke', 'speed',
        0: none or a magnitude), and the coordinate it starts at.  Returns its index in z."""
        from trsim.elements.contract import N_BOOK

        self.states.append((scale, follows))
        return N_BOOK + len(self.states) - 1

    def contact_law(self, name: str | None) -> Any:
        laws = self.scenario.contact_laws
        if name is None and len(laws) == 1:
            return next(iter(laws.values()))
        if name is None or name not in laws:
            what = f"no contact law named '{name}'" if name else "no contact law is named"
            raise ScenarioError(what, known(str(name), laws) if laws else "add it under "
                                "contact_laws", ("contact",) if name else ())  # fmt: skip
        return laws[name]

    def function(
        self, spec: Any, *path: str | int, time_only: bool = False, wanted: str = "",
        local: Mapping[str, tuple[int, str]] = NO_NAMES, free: bool = False,
    ) -> int:  # fmt: skip
        """Store a function of t or of sensors in tab; its offset.

        wanted: the unit of its values where the field allows several; local: names of its own,
        their entries of S and units; free: no run holds it on a piece.
        """
        offset = len(self.tab)

        def known(name: str) -> int:
            return local[name][0] if name in local else self.known_sensor(name, time_only, path)

        if spec.kind == "expression" and not local:
            spec = replace(spec, node=self.inlined(spec.node, path))
        if spec.kind == "constant":
            code = functions.constant(spec.value)
        elif spec.kind == "table":
            variable = -1 if spec.of == "t" else known(spec.of)
            unit = local[spec.of][1] if spec.of in local else ""
            self.check_table(spec, unit or self.unit_of_variable(spec.of), wanted, *path)
            self.timed = self.timed or variable < 0
            self.sensed = self.sensed or variable >= 0
            self.notes += [] if free else overshoot(spec, path)
            code = functions.table(spec.x, spec.y, variable, spec.ends, spec.interpolation)
        else:
            self.timed = self.timed or "t" in names(spec.node)
            used = spec.inputs
            # what is a polynomial between its corners has nothing short there
            self.sensed = self.sensed or (bool(used) and degree(spec.node) > LOW)
            indices = {name: known(name) for name in used}
            code = functions.expression(spec.node, indices)
        if self.end is not None and not free:
            try:
                found = cornered(spec, code, offset, self.end)
                self.check_corners(found)
                self.functions += found
            except ScenarioError as error:
                raise error.at(*path) from None
        if waves(code) and not free:
            self.waves.append(Swinging(offset, code))
        self.tab.extend(code)
        if spec.kind == "expression" and self.end is not None and not free:
            self.guards += guards(self, spec.node, offset, indices)
        if not free:
            self.packed_functions.append(Named(".".join(map(str, path)), offset, spec))
        return offset

    def inlined(self, node: Any, path: tuple[str | int, ...], within: tuple[str, ...] = ()) -> Any:
        """An expression with those of formulas in the place of their names."""
        if node[0] != "name" or node[1] not in self.scenario.sensors:
            return rebuilt(node, lambda part: self.inlined(part, path, within))
        name = node[1]
        stands_for = self.elements["sensors", name].stands_for
        if stands_for is None:
            return node
        if name in within:
            what = f"'{name}' refers to itself: {' -> '.join((*within, name))}"
            raise ScenarioError(what, "a formula names sensors that stand before it", path)
        return self.inlined(stands_for(self.scenario.sensors[name]), path, (*within, name))

    def read_by_formula(self, name: str, path: tuple[str, ...]) -> Any:
        """The packed row of a sensor that a formula names, which stands before it."""
        sensors = self.scenario.sensors
        if name not in sensors:
            what = f"no parameter or sensor named '{name}'"
            raise ScenarioError(what, known(name, [*sensors, *self.scenario.parameters, "t"]), path)
        if ("sensors", name) not in self.instances:
            what = f"'{name}' stands behind it in the file, or is the formula itself"
            raise ScenarioError(what, "a formula names sensors that stand before it", path)
        instance = self.instances["sensors", name]
        if instance.channels[0].name:
            what = f"'{name}' ({instance.element.key}) shows several numbers"
            raise ScenarioError(what, "name a sensor of one number, such as a `reaction`", path)
        return instance.row

    def frames_of_sensor(self, name: str) -> frozenset[int]:
        """The frames that a packed sensor depends on."""
        instance = self.instances["sensors", name]
        found: frozenset[int] = instance.element.acts_on(instance.row)
        return found

    def stored(self, node: Any, inputs: Iterable[str], path: tuple[str, ...]) -> int:
        """Store an expression of packed sensors and their rates that nothing of the motion depends
        on; its offset."""
        offset, indices = len(self.tab), dict[str, int]()
        for name in sorted(inputs):
            own = name.removesuffix(RATE)
            indices[name] = self.sensor(name) if own == name else self.rate_of_sensor(own, path)
        try:
            code = functions.expression(node, indices)
        except ScenarioError as error:
            raise error.at(*path) from None
        if waves(code):
            self.shown.append(Swinging(offset, code))
        self.tab += code
        return offset

    def check_corners(self, found: list[Cornered]) -> None:
        """Refuse corners that are met by a sensor without bounds: one could be passed over."""
        met = {k for one in found for k in one.sensed}
        for name, k in self.sensors.items():
            packed = self.instances.get(("sensors", name))
            if k in met and packed and not packed.row.travel:
                raise ScenarioError(
                    f"'{name}' ({packed.element.key}) meets a corner of this function, and has no "
                    "bounds by which it could be found",
                    "write a smooth function: v*sqrt(v**2 + 1e-12) for v*abs(v)",
                )

    def check_table(self, spec: Any, found: str, wanted: str, *path: str | int) -> None:
        """Refuse units of a table's columns that are not those of its variable and its values."""
        x, y = spec.units
        if x and not fits(x, found):
            what = f"wrong unit: '{x}'; '{spec.of}' is in {found}"
            raise ScenarioError(what, "", (*path, "table"))
        if wanted and not fits(y, wanted):
            what = f"wrong unit: '{y}'; this number is in {wanted}"
            raise ScenarioError(what, "", (*path, "table"))

    def unit_of_variable(self, name: str) -> str:
        """The unit of t, of a sensor or of its rate."""
        if name == "t":
            return UNITS["time"]
        own = UNITS[self.sensor_kind(name.removesuffix(RATE))]
        return f"{own}/s" if name.endswith(RATE) else own

    def check_unit(self, kind: str, angle: str, stroke: str, *path: str) -> None:
        """Refuse a written unit that does not fit a joint that turns, or one that slides."""
        written = self.scenario.quantity(*path)
        wanted = angle if kind == "angle" else stroke
        if written is None or fits(written[1], wanted):
            return
        does = {"angle": "the joint turns", "stroke": "the joint slides"}
        raise ScenarioError(
            f"wrong unit: '{written[1]}'; {does.get(kind, 'a point meets a wall')}",
            f"this number is in {wanted}",
            path[2:],
        )

    def check_units(self, kind: str, spec: type, keys: Sequence[str], *path: str) -> None:
        """The same of some keys of a spec, fields with a unit for strokes and one for angles."""
        for key in keys:
            of: Any = unit_of(spec, key)
            stroke, angle = of.units
            self.check_unit(kind, angle, stroke, *path, key)

    def known_sensor(self, name: str, time_only: bool, path: tuple[str | int, ...]) -> int:
        """Entry of S of a sensor, or of the rate of one."""
        own = name.removesuffix(RATE)
        if time_only and own not in self.scenario.sensors:
            raise ScenarioError(
                f"no parameter named '{name}'", known(name, [*self.scenario.parameters, "t"]), path
            )
        if time_only:
            raise ScenarioError(
                f"'{name}' cannot stand here: a drive depends on t only",
                "a load may depend on sensors",
                path,
            )
        first, _, rest = own.partition(".")
        if rest and first in self.scenario.sensors:
            raise ScenarioError(
                f"'{name}' cannot stand in a function",
                f"of a sensor there are `{first}` and `{first}{RATE}`; what depends on an "
                "acceleration is a mass, not a load",
                path,
            )
        if own not in self.scenario.sensors:
            raise ScenarioError(
                f"no parameter or sensor named '{name}'",
                known(name, [*self.scenario.sensors, *self.scenario.parameters, "t"]),
                path,
            )
        self.check_early(own, path)
        return self.sensor(name) if own == name else self.rate_of_sensor(own, path)

    def rate_of_sensor(self, name: str, path: tuple[str | int, ...]) -> int:
        """Index in S of the rate of a packed sensor.  Refuses one of which that is no velocity."""
        packed = self.instances["sensors", name]
        if not packed.row.travel:
            raise ScenarioError(
                f"'{name}' ({packed.element.key}) is no place and no angle: its rate is known "
                "only once the accelerations are",
                "take the rate of a sensor of places; what depends on an acceleration is a mass",
                path,
            )
        return self.rate_of(self.sensor(name))

    def is_early(self, name: str) -> bool:
        """Whether a sensor shows a number of places and velocities alone, an entry of S."""
        return "coordinate" in self.elements["sensors", name].kernels

    def check_early(self, name: str, path: tuple[str | int, ...]) -> None:
        """Refuse a sensor that shows no number of places and velocities."""
        if self.elements["sensors", name].stands_for:
            what = f"'{name}' is a formula: neither a table nor a rate of it can stand here"
            hint = "a table of the sensor itself, or an expression with the rates of its sensors"
            raise ScenarioError(what, hint, path)
        if not self.is_early(name):
            key = self.elements["sensors", name].key
            raise ScenarioError(
                f"'{name}' ({key}) is known only once the accelerations are",
                "take a sensor of places or velocities",
                path,
            )
