"""A mechanism as drawn: where everything is before anything moves.  reading.py finds it."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.elements.curve import Sampled

Array = NDArray[np.float64]

GROUND = "ground"
# what elements are drawn as; other joints, drives and forces are not
IDEAL_POINTS = ("pin", "ball", "cross", "weld")  # joints that hold two points together
SLIDES = ("slide", "sleeve", "bead", "thread")  # joints along whose axis a body slides
SPATIAL = ("ball", "cross")  # joints that let a body leave a plane
STIFF = ("slide", "weld")  # joints that let no body turn against the other
LOOSE = (*SPATIAL, "bead")  # joints that keep no axis
JOINTS = (*IDEAL_POINTS, *SLIDES, "journal")
LINES = ("cylinder", "coil", "block", "rod")  # forces, drives and links that have a place
GUIDES = ("slot", "lobe")  # joints on a curve


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
    pitch: float = 0.0  # m, advance of a thread in a turn, negative of a left hand

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


class Guide(NamedTuple):
    """A curve of body i, and what of body j stays on it: a pin, a roller, or a flat face."""

    name: str
    picture: str
    i: str
    j: str
    at: Array  # (3) m, of the pin, the roller's centre, or the face, as drawn
    origin: Array  # (3) m, of the curve, as drawn
    axes: Array  # (3, 3) rows: x and y of the curve, and the normal of its plane
    curve: Sampled
    radius: float  # m, of the roller; 0 of a pin and of a face
    face: Array | None  # (3) normal of a face, from the curve to the follower
    comes_apart: bool  # an event may release it

    def seen(self, at: Array) -> Array:
        """Places as drawn, (..., 3), in the coordinates of the curve."""
        return (at - self.origin) @ self.axes.T

    def placed(self, flat: Array) -> Array:
        """Places [x, y] of the curve, (..., 2), as drawn."""
        return self.origin + flat @ self.axes[:2]


class Touch(NamedTuple):
    """A guide over the frames, in the coordinates of its curve."""

    at: Array  # (n, 2) m, of the pin, the roller's centre, or the face
    place: Array  # (n, 2) m, of the curve where they touch
    off: Array  # (n) m, by which they do not


class Wheel(NamedTuple):
    """A gear wheel or a pulley: a disc, a ring that is one inside, or a bevel wheel."""

    joint: str
    body: str
    carrier: str
    at: Array  # (3) m, middle of the pitch circle, as drawn
    axis: Array  # (3)
    radius: float  # m, of the pitch circle
    hollow: bool  # its teeth are inside
    apex: Array | None  # (3) m, of the cone of a bevel wheel
    train: int = 0  # number of those it meshes with, one by one
    teeth: int = 0  # 0: as a smooth one
    phase: float = 0.0  # rad, of a tooth, from the first direction across the axis


class Mesh(NamedTuple):
    """Where two wheels meet, or a wheel and a rack."""

    name: str
    carrier: str
    first: int  # numbers of wheels
    second: int  # -1: the rack of the same name
    at: Array  # (3) m, the pitch point, as drawn


class Rack(NamedTuple):
    """A bar with teeth on the pitch line of a wheel."""

    name: str
    joint: str
    body: str
    carrier: str
    wheel: int
    at: Array  # (3) m, where they touch, as drawn
    axis: Array  # (3) along its slide
    out: Array  # (3) from the wheel to it


class Worm(NamedTuple):
    """A thread that drives a wheel."""

    name: str
    body: str
    carrier: str
    wheel: int
    at: Array  # (3) m, the middle of the thread, as drawn
    axis: Array  # (3)
    radius: float  # m
    lead: float  # m for a turn, negative of a left hand


class Belt(NamedTuple):
    """A belt over two pulleys."""

    name: str
    carrier: str
    first: int  # numbers of wheels
    second: int
    crossed: bool


class Place(NamedTuple):
    """A place of a rope."""

    body: str
    at: Array  # (3) m, as drawn
    bend: float  # m, radius of a wheel, positive where the rope goes round it to the left


class Rope(NamedTuple):
    name: str
    places: tuple[Place, ...]


Spot = tuple[str, Array]  # a point of a body, (3) m, as drawn


class Transmissions(NamedTuple):
    """What passes on motion from joint to joint."""

    wheels: tuple[Wheel, ...] = ()
    meshes: tuple[Mesh, ...] = ()
    racks: tuple[Rack, ...] = ()
    worms: tuple[Worm, ...] = ()
    belts: tuple[Belt, ...] = ()


class Drawing(NamedTuple):
    """Bodies, bars, joints and what else there is of a run, SI units, world axes."""

    scenario: Any
    bodies: dict[str, Array]  # rigid ones -> centre of mass (3)
    axes: dict[str, Array]  # their axes, quaternions (4) with the scalar last
    bars: dict[str, Array]  # flexible ones -> nodes (k, 3)
    thickness: dict[str, float]  # m, of the bars
    planar: bool
    lost: tuple[str, ...]  # bodies whose place was not recorded
    joints: tuple[Joint, ...] = ()
    lines: tuple[Line, ...] = ()
    guides: tuple[Guide, ...] = ()
    moving: Transmissions = Transmissions()
    ropes: tuple[Rope, ...] = ()
    held: tuple[Spot, ...] = ()  # where other things than joints and lines are fast to a body
    corners: tuple[Spot, ...] = ()  # what else must be in the picture
    skipped: tuple[str, ...] = ()  # what is not drawn, in words

    def has(self, body: str) -> bool:
        return body == GROUND or body in self.bodies or body in self.bars

    def shape(self, body: str) -> tuple[Any, ...]:
        """The solids a rigid body is made of, where they are known."""
        spec = self.scenario.bodies.get(body)
        return (spec.shape or ()) if spec is not None and body in self.bodies else ()

    @property
    def size(self) -> float:
        """Diagonal of the box around all that is drawn, m; never zero."""
        places = [*self.bodies.values(), *(joint.at for joint in self.joints)]
        places += [end for line in self.lines for end in line.ends]
        places += [node for nodes in self.bars.values() for node in nodes]
        places += [at for _, at in (*self.held, *self.corners)]
        return float(np.linalg.norm(np.ptp(np.array(places), axis=0))) or 1.0
