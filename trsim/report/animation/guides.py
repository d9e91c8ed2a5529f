"""Curves of bodies and what stays on them: which there are, and where they touch in each frame."""

import numpy as np

from trsim import elements
from trsim.elements.curve import sampled
from trsim.elements.on_curve import settled
from trsim.fields import direction
from trsim.report.animation.drawing import GUIDES, Array, Drawing, Guide, Touch
from trsim.report.animation.plates import anticlockwise

END = 1e-3  # of u, which grows by 1 where a curve turns by BEND: beyond an end
BEHIND = 0.1  # of the way from a face to the centre of its body: what the body reaches to


def guides(drawn: Drawing) -> tuple[Guide, ...]:
    """The joints on curves between bodies that are drawn."""
    found = []
    released = {name for event in drawn.scenario.events.values() for name in event.do.release}
    for name, spec in drawn.scenario.joints.items():
        picture = elements.load(spec.type).picture
        if picture not in GUIDES or not all(drawn.has(body) for body in spec.bodies):
            continue
        plane = spec.curve.frame
        face = getattr(spec, "face", None)
        found.append(
            Guide(
                name,
                picture,
                spec.bodies[0],
                spec.bodies[1],
                np.array(spec.at),
                np.array(plane.at),
                np.array([plane.x, plane.y, plane.z]),
                sampled(spec.curve),
                getattr(spec, "radius", None) or 0.0,
                np.array(direction(face)) if face else None,
                name in released,
            )
        )
    return tuple(found)


def near(drawn: Drawing, guide: Guide) -> Array:
    """Where its body reaches to a curve, as drawn: the place nearest to its centre, of a closed one
    that farthest from the follower."""
    places = guide.placed(guide.curve.place)
    if guide.curve.closed:
        return np.asarray(places[int(np.linalg.norm(places - guide.at, axis=1).argmax())])
    centre = drawn.bodies.get(guide.i, guide.origin)
    return np.asarray(places[int(np.linalg.norm(places - centre, axis=1).argmin())])


def behind(drawn: Drawing, guide: Guide) -> Array:
    """The centre of a roller or a pin; of a face what is behind it, towards its body, as drawn."""
    if guide.face is None:
        return guide.at
    away = (drawn.bodies.get(guide.j, guide.at) - guide.at) @ guide.face
    return np.asarray(guide.at + BEHIND * max(float(away), 0.0) * guide.face)


def touch(guide: Guide, seen: Array, normals: Array | None) -> Touch:
    """Where curve and follower touch.

    seen: places of the follower in the coordinates of the curve (n, 3); normals: those of a face.
    """
    side = left(guide)
    found = [on_curve(guide, side, p, None if normals is None else normals[k, :2])
             for k, p in enumerate(seen[:, :2])]  # fmt: skip
    places, off = zip(*found, strict=True)
    return Touch(seen[:, :2], np.array(places), np.array(off))


def on_curve(guide: Guide, side: float, p: Array, m: Array | None) -> tuple[Array, float]:
    """Where a pin or a roller at p, or a face of normal m, is next to a curve, and how far off.

    An open curve ends at its ends, whatever a joint makes of what is beyond them.
    """
    curve = guide.curve
    far = np.sum((curve.place - p) ** 2, axis=1) if m is None else -(curve.place @ m)
    near = int(far.argmin())
    wanted, line = (p, 0) if m is None else (m, 1)
    u, _, c, t = settled(curve, float(curve.u[near]), wanted.tolist(), line)
    beyond = not curve.closed and not -END <= u <= curve.u[-1] + END
    place = curve.place[near] if beyond else np.array(c)
    if m is not None:
        return place, float(m @ (p - place))
    if beyond:
        return place, float(np.hypot(*(p - place))) - guide.radius
    tangent = np.array(t) / float(np.hypot(*t))
    d = p - place
    return place, side * float(tangent[0] * d[1] - tangent[1] * d[0]) - guide.radius


def left(guide: Guide) -> float:
    """1 where the follower is left of the curve as drawn, else -1."""
    curve, at = guide.curve, guide.seen(guide.at)[:2]
    if guide.face is not None:
        normal = (guide.axes @ guide.face)[:2]
        k = int((curve.place @ normal).argmax())
        at = curve.place[k] + normal
    k = int(np.sum((curve.place - at) ** 2, axis=1).argmin())
    t, d = curve.tangent[k], at - curve.place[k]
    return 1.0 if t[0] * d[1] - t[1] * d[0] >= 0.0 else -1.0


def plated(guide: Guide) -> bool:
    """Whether a curve is the edge of a plate: of a cam whose follower is outside of it."""
    if guide.picture != "lobe" or not guide.curve.closed:
        return False
    places = guide.curve.place[:-1]
    goes_left = anticlockwise(places) is places
    return (left(guide) < 0.0) == goes_left


def outline(guide: Guide, turn: float) -> Array:
    """The places of a curve, (n, 2), whose tangent turns by no more than some angle between two.

    Of a closed one the first is not there again at the end.
    """
    curve = guide.curve
    bend = np.abs(curve.bend)
    step = np.linalg.norm(np.diff(curve.place, axis=0), axis=1)
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (bend[1:] + bend[:-1]) * step)])
    count = max(int(np.ceil(angle[-1] / turn)), 1)
    wanted = np.linspace(0.0, angle[-1], count + 1)
    kept = np.unique([0, *np.searchsorted(angle, wanted[1:-1]), len(angle) - 1])
    return curve.place[kept[:-1] if curve.closed else kept]
