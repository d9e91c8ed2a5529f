"""A mechanism as drawn: where its bodies, bars, joints and lines are before anything moves."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim import elements
from trsim.assemble.members import members
from trsim.assemble.orientation import quaternion
from trsim.elements.joint import perpendicular
from trsim.fields import direction
from trsim.scenario.load import loads
from trsim.store.read import Run

Array = NDArray[np.float64]

GROUND = "ground"
# what elements are drawn as; other joints, drives and forces are not
IDEAL_POINTS = ("pin", "ball", "cross", "weld")  # joints that hold two points together
SLIDES = ("slide", "sleeve", "bead")  # joints along whose axis a body slides
SPATIAL = ("ball", "cross")  # joints that let a body leave a plane
STIFF = ("slide", "weld")  # joints that let no body turn against the other
LOOSE = (*SPATIAL, "bead")  # joints that keep no axis
JOINTS = (*IDEAL_POINTS, *SLIDES, "journal")
LINES = ("cylinder", "coil", "block", "rod")  # forces, drives and links that have a place


class Joint(NamedTuple):
    """A joint between bodies i and j; a and w of a universal one are its first and second axis."""

    name: str
    picture: str
    i: str
    j: str
    at: Array  # (3) m, as drawn
    axes: Array  # (3, 3) rows u, w, a; a is the axis of the hinge, the slide, the weld
    clearance: float  # m
    bearing: float  # m, radius of the bearing; 0 where there is none
    comes_apart: bool  # an event may release it

    @property
    def axis(self) -> Array:
        return self.axes[2]


class Line(NamedTuple):
    """What acts between a point of body i and a point of body j."""

    name: str
    picture: str
    i: str
    j: str
    ends: tuple[Array, Array]  # (3) m, as drawn; a bushing has both in one place
    axes: Array  # (3, 3) rows: directions of its stiffnesses, of a bushing
    slide: int | None  # the one along which a bushing has none: that of a rail


class Drawing(NamedTuple):
    """Bodies, bars, joints and lines of a run, SI units, world axes."""

    scenario: Any
    bodies: dict[str, Array]  # rigid ones -> centre of mass (3)
    axes: dict[str, Array]  # their axes, quaternions (4) with the scalar last
    bars: dict[str, Array]  # flexible ones -> nodes (k, 3)
    thickness: dict[str, float]  # m, of the bars
    joints: tuple[Joint, ...]
    lines: tuple[Line, ...]
    planar: bool
    lost: tuple[str, ...]  # bodies whose place was not recorded

    def has(self, body: str) -> bool:
        return body == GROUND or body in self.bodies or body in self.bars

    @property
    def size(self) -> float:
        """Diagonal of the box around all joints, lines and centres of mass, m; never zero."""
        places = [*self.bodies.values(), *(joint.at for joint in self.joints)]
        places += [end for line in self.lines for end in line.ends]
        places += [node for nodes in self.bars.values() for node in nodes]
        return float(np.linalg.norm(np.ptp(np.array(places), axis=0))) or 1.0


def drawing(run: Run) -> Drawing:
    """What a run was made of; bodies without a recorded place are left out and named."""
    scenario = loads(run.text("scenario/resolved"))
    bodies, axes, bars, thickness, lost = {}, {}, {}, {}, []
    for name, spec in members(scenario).items():
        nodes = spec.elements + 1 if spec.flexible else 0
        channels = [f"{name}.node{k}.position" for k in range(nodes)] or [f"{name}.position"]
        if any(channel not in run.units for channel in channels):
            lost.append(name)
        elif spec.flexible:
            part = np.linspace(0.0, 1.0, nodes)[:, None]
            bars[name] = (1.0 - part) * np.array(spec.start) + part * np.array(spec.end)
            thickness[name] = spec.thickness
        else:
            bodies[name], axes[name] = np.array(spec.at), np.roll(quaternion(spec), -1)
    planar = bool(run.group("mechanism").get("planar", False))
    found = Drawing(scenario, bodies, axes, bars, thickness, (), (), planar, tuple(lost))
    return found._replace(joints=joints(found), lines=lines(found))


def joints(drawn: Drawing) -> tuple[Joint, ...]:
    """The joints between bodies that are drawn."""
    scenario = drawn.scenario
    released = {name for event in scenario.events.values() for name in event.do.release}
    found = []
    for name, spec in scenario.joints.items():
        made, clearance = elements.load(spec.type), getattr(spec, "clearance", 0.0)
        # a clearance of 0 is an ideal joint, also where it was written down
        picture = elements.load(made.ideal if made.ideal and not clearance else made.key).picture
        if picture not in JOINTS or not all(drawn.has(body) for body in spec.bodies):
            continue
        i, j = spec.bodies
        at = getattr(spec, "at", None)
        if at is None:  # a slide: at the centre of the second body
            at = drawn.bodies[j] if j in drawn.bodies else middle(drawn, j)
        axes = np.array(perpendicular(getattr(spec, "axis", (0.0, 0.0, 1.0)), spec.drawn_in))
        if picture == "cross":
            axes[1] = direction(spec.second_axis)
            axes[0] = np.cross(axes[1], axes[2])
        radius = 0.0
        if picture == "journal":
            law = spec.contact or next(iter(scenario.contact_laws))
            radius = scenario.contact_laws[law].bearing_radius or 0.0
        found.append(Joint(name, picture, i, j, np.array(at), axes, clearance, radius,
                           name in released))  # fmt: skip
    return tuple(found)


def lines(drawn: Drawing) -> tuple[Line, ...]:
    """Actuators, springs, bushings and links between bodies that are drawn."""
    found, of = [], drawn.scenario
    for name, spec in {**of.joints, **of.drives, **of.forces}.items():
        picture = elements.load(spec.type).picture
        if picture not in LINES or not all(drawn.has(body) for body in spec.bodies):
            continue
        axes, slide = np.eye(3), None
        if picture == "block":
            axes, free = np.array(spec.axes), np.flatnonzero(np.equal(spec.stiffness, 0.0))
            slide = int(free[0]) if len(free) == 1 else None
        first, second = (spec.at, spec.at) if picture == "block" else spec.points
        ends = np.array(first), np.array(second)
        i, j = spec.bodies
        found.append(Line(name, picture, i, j, ends, axes, slide))
    return tuple(found)


def middle(drawn: Drawing, body: str) -> Array:
    """Halfway along a bar; the origin of the ground."""
    return drawn.bars[body].mean(axis=0) if body in drawn.bars else np.zeros(3)
