"""Ropes and belts: straight parts touch their wheels, and nothing of the length is lost."""

import re

import numpy as np
import pytest

from trsim.report.animation import belts, ropes
from trsim.report.animation.strands import parts, wraps

from .filmed import closed, made, of, seen, staged, validation

DRUM = """
gravity: [0, -9.81, 0]
bodies:
  drum: {mass: 3 kg, inertia: 0.02, at: [0, 0]}
  load: {mass: 2 kg, inertia: 0.01, at: [0.8, -1]}
joints:
  shaft: {type: revolute, bodies: [ground, drum], at: [0, 0]}
  rail: {type: prismatic, bodies: [ground, load], axis: [0, 1]}
  line:
    type: rope
    through:
      - {body: drum, at: [0, 0], radius: 10 cm, turn: SIDE}
      - {body: ground, at: [0.3, 0.4]}
      - {body: ground, at: [0.7, 0.3], radius: 10 cm, turn: right}
      - {body: load, at: [0.8, -1]}
solver: {end: 0.5 s}
"""
# wheels of both sides on bodies that move
SWING = """
gravity: [0, -9.81, 0]
bodies:
  arm: {mass: 2, inertia: 0.1, at: [0.5, 0.3]}
  load: {mass: 1, inertia: 0.01, at: [1.4, -1]}
joints:
  pivot: {type: revolute, bodies: [ground, arm], at: [0, 0.3]}
  rail: {type: prismatic, bodies: [ground, load], axis: [0, 1]}
  line:
    type: rope
    through:
      - {body: ground, at: [-0.5, 0]}
      - {body: arm, at: [0.5, 0.1], radius: 8 cm, turn: right}
      - {body: ground, at: [0.9, -0.5], radius: 6 cm, turn: left}
      - {body: ground, at: [1.3, 0.5], radius: 10 cm, turn: right}
      - {body: load, at: [1.4, -1]}
drives: {m: {joint: pivot, position: "0.25*sin(6*t)"}}
solver: {end: 1 s}
"""
# the rope lies along next to nothing of the wheel on the arm
FLAT = SWING.replace("[-0.5, 0]", "[-0.5, 0.05]").replace("0.25*sin(6*t)", "0.1*sin(6*t)")
FLAT = FLAT.replace("{body: ground, at: [0.9, -0.5], radius: 6 cm, turn: left}", "MID")
FLAT = FLAT.replace("      - MID\n", "").replace("[1.3, 0.5]", "[1.3, 0.05]")
SPACE = """
planar: false
gravity: [0, 0, -9.81]
bodies:
  ball: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [0.3, 0.2, -1], velocity: [0, 0.5, 0]}
  other: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [-0.4, 0.1, -1], velocity: [0.1, 0, 0]}
joints:
  line: {type: rope, through: [{body: ball, at: [0.3, 0.2, -1]}, {body: ground, at: [0.1, 0, 0]},
         {body: other, at: [-0.4, 0.1, -1]}]}
solver: {end: 0.4 s}
"""
BELT = """
bodies:
  arm: {mass: 1, inertia: 0.1, at: [0.2, 0]}
  motor: {mass: 1 kg, inertia: 0.002 kg*m^2, at: [0, 0]}
  fan: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0.4, 0.1]}
joints:
  base: {type: revolute, bodies: [ground, arm], at: [0.1, -0.3]}
  shaft: {type: revolute, bodies: [arm, motor], at: [0, 0], axis: AXIS}
  axle: {type: revolute, bodies: [fan, arm], at: [0.4, 0.1]}
  drive: {type: belt, joints: [shaft, axle], radii: [5 cm, 12 cm], crossed: CROSSED}
drives: {turn: {joint: shaft, velocity: 12}, swing: {joint: base, velocity: 3}}
solver: {end: 0.8 s}
"""


def mirrored(text):
    """The same with x the other way round: left is right."""
    text = re.sub(r"at: \[(-?)([\d.]+),", lambda m: f"at: [{'' if m[1] else '-'}{m[2]},", text)
    text = text.replace("0.1*sin", "-0.1*sin").replace("turn: right", "turn: LEFT")
    return text.replace("turn: left", "turn: right").replace("turn: LEFT", "turn: left")


def rope_of(moved):
    (rope,) = moved.drawn.ropes
    count = len(moved.time)
    centres = [np.broadcast_to(moved.point(p.body, p.at), (count, 3)) for p in rope.places]
    bends = [p.bend for p in rope.places]
    return bends, centres, parts(bends, centres)


CASES = {
    "hoist": None,
    "drum": DRUM.replace("SIDE", "left"),
    "mirrored": """
gravity: [0, -9.81, 0]
bodies:
  load: {mass: 3 kg, inertia: 0.01, at: [0, -2]}
  weight: {mass: 2 kg, inertia: 0.01, at: [-1, -1]}
joints:
  rail: {type: prismatic, bodies: [ground, load], axis: [0, 1]}
  other: {type: prismatic, bodies: [ground, weight], axis: [0, 1]}
  line:
    type: rope
    through:
      - {body: ground, at: [0.1, 0]}
      - {body: load, at: [0, -2], radius: 10 cm, turn: right}
      - {body: ground, at: [-0.55, 0], radius: 45 cm, turn: left}
      - {body: weight, at: [-1, -1]}
solver: {end: 1 s}
""",
    "right drum": DRUM.replace("SIDE", "right"),
    "swing": SWING,
    "flat": FLAT,
    "flat mirrored": mirrored(FLAT),
    "space": SPACE,
}


def run_of(folder, name):
    return of(folder, text=CASES[name]) if CASES[name] else validation(folder, "rope_hoist")


@pytest.mark.parametrize("name", CASES)
def test_straight_parts_are_tangent(name, tmp_path):
    """They begin and end on the rims, across the radius there, on the side the rope goes round."""
    moved, _, things = made(run_of(tmp_path, name), ropes.ropes)
    bends, centres, found = rope_of(moved)
    for k, part in enumerate(found):
        thing = things[f"line part {k}"]
        lift = thing.place[0, 2] - part.begin[0, 2]
        ends = seen(thing, np.array([[0.0, 0, 0], [1.0, 0, 0]]))
        ends[..., 2] -= lift
        along = (ends[:, 1] - ends[:, 0]) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[:, None]
        for side, place in ((0, k), (1, k + 1)):
            out = ends[:, side] - centres[place]
            assert np.linalg.norm(out, axis=1) == pytest.approx(abs(bends[place]), abs=1e-9)
            assert np.abs(np.sum(out * along, axis=1)).max() < 1e-9
            # a rope that goes round to the left has the centre on its left
            left = along[:, 0] * -out[:, 1] + along[:, 1] * out[:, 0]
            assert left == pytest.approx(bends[place], abs=1e-9)


@pytest.mark.parametrize("name", CASES)
def test_the_rope_is_as_long_as_ever(name, tmp_path):
    """Straight parts, arcs, and what is wound off the drum together; in one piece at each wheel."""
    moved, _ = staged(run_of(tmp_path, name))
    bends, _, found = rope_of(moved)
    whole = sum(np.linalg.norm(part.end - part.begin, axis=1) for part in found)
    for k, wrap in enumerate(wraps(bends, found), start=1):
        whole = whole + abs(bends[k]) * wrap
    rope = moved.drawn.ropes[0]
    if bends[0]:  # the drum turns about z; what it winds on is r times its angle, as left or right
        q = moved.turn(rope.places[0].body)
        turned = np.unwrap(2.0 * np.arctan2(q[:, 2], q[:, 3]))
        assert np.ptp(turned) > 0.5
        # where it leaves the drum goes round, too
        whole = whole - bends[0] * (turned - (found[0].angle - found[0].angle[0]))
    assert np.ptp(whole) < 1e-6
    for wrap in wraps(bends, found):  # less than a turn, and not the other way round
        assert wrap.min() > -1e-9 and wrap.max() < 2.0 * np.pi


@pytest.mark.parametrize("name", ["hoist", "mirrored", "drum", "swing", "flat", "flat mirrored"])
def test_arcs_join_the_straight_parts(name, tmp_path):
    """Every arc begins where one part ends, ends where the next begins, and stays on its rim."""
    moved, sizes, things = made(run_of(tmp_path, name), ropes.ropes)
    bends, centres, found = rope_of(moved)
    thick = ropes.THICK * sizes.radius
    for k in range(1, len(bends) - 1):
        pieces = [thing for one, thing in things.items() if one.startswith(f"line arc {k} ")]
        if not bends[k]:  # an eye
            assert not pieces
            continue
        reached = [[], []]
        for thing in pieces:
            ((mesh, _),) = thing.pieces
            closed(mesh)
            there = seen(thing, mesh.points)
            out = np.linalg.norm((there - centres[k][:, None])[..., :2], axis=2)
            assert out.max() < abs(bends[k]) + 1.5 * thick
            assert out.min() > abs(bends[k]) * np.cos(0.2) - 1.5 * thick
            for side, end in enumerate((found[k - 1].end, found[k].begin)):
                away = np.linalg.norm((there - end[:, None])[..., :2], axis=2).min(axis=1)
                reached[side].append(away)
        for away in map(np.array, reached):
            assert away.min(axis=0).max() < 1.2 * thick


def test_a_wheel_touched_by_little_has_an_arc(tmp_path):
    """Its arc all but vanishes: pieces grow and shrink with it."""
    moved, _, things = made(run_of(tmp_path, "flat"), ropes.ropes)
    bends, _, found = rope_of(moved)
    least = min(wrap.min() for wrap, bend in zip(wraps(bends, found), bends[1:-1], strict=True)
                if bend)  # fmt: skip
    assert 0.0 < least < ropes.SHORT
    grown = [thing for name, thing in things.items()
             if name.startswith("line arc") and thing.scale is not None]  # fmt: skip
    assert grown


@pytest.mark.parametrize("crossed", ["false", "true"])
@pytest.mark.parametrize("axis", ["[0, 0, 1]", "[0, 0, -1]"])
def test_belts(axis, crossed, tmp_path):
    """Its band is tangent to both pulleys; its marks go as fast as their rims, and stay on it."""
    text = BELT.replace("AXIS", axis).replace("CROSSED", crossed)
    moved, _, things = made(of(tmp_path, text=text), belts.belts)
    (belt,) = moved.drawn.moving.belts
    first, second = belts.pulleys(moved, belt)
    path = belts.course(belt, first, second)
    own = belts.frame(first.axis)[:2, :2]
    pulleys = [(own @ [0.0, 0.0], 0.05), (own @ [0.4, 0.1], 0.12)]
    steps = np.linalg.norm(np.roll(path.place, -1, axis=0) - path.place, axis=1)
    straight = np.argsort(steps)[-2:]
    for k in straight:
        a, b = path.place[k], path.place[(k + 1) % len(path.place)]
        touched = []
        for end in (a, b):
            off = [abs(np.linalg.norm(end - middle) - radius) for middle, radius in pulleys]
            which = int(np.argmin(off))
            touched.append(which)
            assert off[which] < 1e-9
            assert abs((end - pulleys[which][0]) @ (b - a)) < 1e-9
        assert sorted(touched) == [0, 1]
    ((band, _),) = things["drive belt"].pieces
    closed(band)
    # straight length by hand
    d, (r, R) = np.hypot(0.4, 0.1), (0.05, 0.12)
    rho = R + r if crossed == "true" else R - r
    length, lean = np.sqrt(d**2 - rho**2), np.arcsin(rho / d)
    arcs = (R + r) * (np.pi + 2 * lean) if crossed == "true" else (
        R * (np.pi + 2 * lean) + r * (np.pi - 2 * lean))  # fmt: skip
    assert path.length == pytest.approx(2 * length + arcs, rel=1e-9)
    # in the axes of the arm a mark on a straight part goes 0.05*12 m/s
    mark = things["drive mark 0"]
    own = moved.on("arm", mark.place)
    speed = np.linalg.norm(np.diff(own, axis=0), axis=1) / np.diff(moved.time)
    assert speed.max() == pytest.approx(0.6, rel=1e-6)
    assert (np.abs(speed - 0.6) < 1e-6).sum() > 10
    # and the way the rim of the first pulley goes: from the place nearest to it
    rim = np.cross(12.0 * np.array(first.axis), own - first.at)
    near = np.abs(np.linalg.norm((own - first.at)[:, :2], axis=1) - 0.05) < 1e-4
    velocity = np.gradient(own, moved.time, axis=0)
    assert near.sum() > 5
    assert np.sum(rim * velocity, axis=1)[near].min() > 0.0
