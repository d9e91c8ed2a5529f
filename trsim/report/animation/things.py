"""What is shown: solids with a colour that move as one, and the sizes and layers they are drawn in.

A flat mechanism, whose hinges are all parallel, is drawn as one would build it: every link is a
plate in a layer of its own, so that links pass each other, and the ground is behind them all.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from trsim.report.animation.drawing import (
    GROUND,
    SLIDES,
    SPATIAL,
    Array,
    Drawing,
    Guide,
    Joint,
)
from trsim.report.animation.motion import Motion
from trsim.report.animation.shapes import boxed
from trsim.report.animation.solids import Mesh
from trsim.report.animation.turns import STILL

BODIES = ("#2f7fc1", "#e07b28", "#2a9d78", "#b9679b", "#d9a514", "#56b4e9", "#8c6bb1")
PIN, SUPPORT, STOP, JOURNAL, FORCE = "#3a3f47", "#a3a9b2", "#6b7079", "#d9a441", "#d1102f"
WIDE, SHORT, THIN = 0.022, 0.3, 0.006  # half widths of links: of the size, of the shortest link
DEEP = 0.15  # of the size: the farthest from layer to layer


class Thing(NamedTuple):
    """Meshes with their colours, and their pose over the frames: (n, .) or (1, .) where fixed."""

    name: str
    pieces: tuple[tuple[Mesh, str], ...]
    place: Array  # (n, 3) m
    turn: Array  # (n, 4)
    scale: Array | None = None  # (n, 3)
    label: str = ""


@dataclass(frozen=True)
class Look:
    """Sizes of everything, m."""

    radius: float  # half width of a link
    thick: float  # of a plate
    normal: Array | None  # of the plane of a flat mechanism
    up: Array  # against gravity; without it y of a plane, z of space
    pitch: float  # from layer to layer
    layers: dict[str, int]
    levels: dict[int, int]  # train of wheels -> layer

    def height(self, body: str) -> float:
        """The height of the layer of a body above the plane."""
        return self.layers.get(body, 0) * self.pitch

    def lift(self, body: str) -> Array:
        """From the plane of a flat mechanism to the layer of a body, (3); none in space."""
        return np.zeros(3) if self.normal is None else self.height(body) * self.normal

    def level(self, train: int) -> Array:
        """The same of a train of wheels."""
        if self.normal is None:
            return np.zeros(3)
        return self.levels.get(train, 0) * self.pitch * self.normal

    def front(self, one: str, other: str) -> float:
        """Height of what stands in front of two bodies."""
        return max(self.height(one), self.height(other)) + self.pitch


def look(drawn: Drawing) -> Look:
    """Sizes from the extent of the mechanism and from its links."""
    size, lengths = drawn.size, []
    for body in (*drawn.bodies, *drawn.bars):
        points = ends(drawn, body)
        lengths += [float(np.linalg.norm(p - q)) for p in points for q in points]
    shortest = min((length for length in lengths if length > 1e-3 * size), default=size)
    radius = max(min(WIDE * size, SHORT * shortest), THIN * size)
    normal, up, thick = plane(drawn), upward(drawn), 0.9 * radius
    if normal is None:
        return Look(radius, thick, normal, up, 1.2 * thick, {}, {})
    found = layers(drawn)
    deepest = min(max(thick, depth(drawn, normal)), DEEP * size)
    return Look(radius, thick, normal, up, 1.2 * deepest, found, levels(drawn, found))


def depth(drawn: Drawing, normal: Array) -> float:
    """Of the deepest body with a shape, along the normal, m; 0 where there is none."""
    found = [np.ptp([at @ normal for at in boxed(drawn.shape(body))])
             for body in drawn.bodies if drawn.shape(body)]  # fmt: skip
    return float(max(found, default=0.0))


def upward(drawn: Drawing) -> Array:
    """Against gravity; where there is none, y of a plane and z of space."""
    pull = np.array(drawn.scenario.gravity)
    return -pull / np.linalg.norm(pull) if pull.any() else np.eye(3)[1 if drawn.planar else 2]


def ends(drawn: Drawing, body: str) -> list[Array]:
    """Different points of a body that joints hold, as drawn."""
    return different(drawn, [joint.at for joint in drawn.joints if body in (joint.i, joint.j)
                             and joint.picture not in SLIDES])  # fmt: skip


def points(drawn: Drawing, body: str) -> list[Array]:
    """The places of `ends`, and where lines and other things act on the body."""
    pairs = [(line.i, line.ends[0]) for line in drawn.lines]
    pairs += [(line.j, line.ends[1]) for line in drawn.lines]
    pairs += drawn.held
    return different(drawn, [*ends(drawn, body), *(at for name, at in pairs if name == body)])


def different(drawn: Drawing, places: list[Array]) -> list[Array]:
    """The places without those that are there already."""
    found: list[Array] = []
    near = 1e-6 * drawn.size
    for place in places:
        if all(np.linalg.norm(p - place) >= near for p in found):
            found.append(place)
    return found


def plane(drawn: Drawing) -> Array | None:
    """The normal of a flat mechanism; None of one in space."""
    if any(joint.picture in SPATIAL for joint in drawn.joints):
        return None
    hinges = [joint.axis for joint in drawn.joints if joint.picture in ("pin", "journal")]
    normal = hinges[0] if hinges else np.array([0.0, 0.0, 1.0])
    if depth(drawn, normal) > DEEP * drawn.size:
        return None
    if not hinges and drawn.guides:
        normal = drawn.guides[0].axes[2]
    normal = normal * np.sign(normal[np.abs(normal).argmax()])  # towards who looks
    slides = [joint.axis for joint in drawn.joints if joint.picture in SLIDES]
    heights = [joint.at @ normal for joint in drawn.joints]
    heights += [end @ normal for line in drawn.lines for end in line.ends]
    heights += [at @ normal for guide in drawn.guides for at in (guide.at, guide.origin)]
    heights += [place.at @ normal for rope in drawn.ropes for place in rope.places]
    hinges += [guide.axes[2] for guide in drawn.guides]
    hinges += [wheel.axis for wheel in drawn.moving.wheels]
    level = np.ptp(heights) < 1e-6 * drawn.size if heights else True
    flat = all(abs(abs(axis @ normal) - 1.0) < 1e-9 for axis in hinges) and level
    flat = flat and all(abs(axis @ normal) < 1e-9 for axis in slides)
    return normal if flat and (hinges or drawn.planar) else None


def layers(drawn: Drawing) -> dict[str, int]:
    """A layer for each body: the lowest that no body hinged to it has."""
    found: dict[str, int] = {}
    joined: list[Joint | Guide] = [*drawn.joints, *drawn.guides]
    for body in (*drawn.bars, *drawn.bodies):
        pairs = [(one.i, one.j) for one in joined if body in (one.i, one.j)]
        taken = {found.get(name) for pair in pairs for name in pair}
        found[body] = next(k for k in range(len(found) + 1) if k not in taken)
    return found


def levels(drawn: Drawing, found: dict[str, int]) -> dict[int, int]:
    """A layer for each train of wheels: not behind their bodies, and in front of other trains that
    these carry."""
    made: dict[int, int] = {}
    of_train: dict[int, set[str]] = {}
    for wheel in drawn.moving.wheels:
        of_train.setdefault(wheel.train, set()).add(wheel.body)
    for train, bodies in of_train.items():
        before = [made[k] + 1 for k in made if of_train[k] & bodies - {GROUND}]
        made[train] = max([0, *(found.get(body, 0) for body in bodies), *before])
    return made


def colours(drawn: Drawing) -> dict[str, str]:
    """Body -> colour; equal bodies of a template have the same."""
    known, found = kinds(drawn), {GROUND: SUPPORT}
    order = list(dict.fromkeys(known.values()))
    return found | {name: BODIES[order.index(kind) % len(BODIES)]
                    for name, kind in known.items()}  # fmt: skip


def kinds(drawn: Drawing) -> dict[str, str]:
    """Body -> its name in the template it is an instance of, or its own."""
    names = {name: name for name in drawn.scenario.bodies if drawn.has(name)}
    for place, instance in drawn.scenario.instances.items():
        for own in drawn.scenario.templates[instance.template].bodies:
            if f"{place}_{own}" in names:
                names[f"{place}_{own}"] = f"{instance.template}_{own}"
    return names


def pose(moved: Motion, body: str) -> tuple[Array, Array]:
    """Place and turn of a body, for meshes about its centre of mass as drawn."""
    if body in moved.places:
        return moved.places[body], moved.turns[body]
    return np.zeros((1, 3)), STILL[None]


def origin(drawn: Drawing, body: str) -> Array:
    """What meshes of a body are about, as drawn."""
    return drawn.bodies.get(body, np.zeros(3))
