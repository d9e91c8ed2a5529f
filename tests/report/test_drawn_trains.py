"""Wheels, racks and worms: pitch circles that touch, and teeth that mesh, in every frame."""

import numpy as np
import pytest

from trsim.report.animation import film, threads, turns, wheels
from trsim.report.animation.solids import frame

from .filmed import closed, made, of, seen, validation, volume

# on an arm that swings: teeth by radii, a ratio whose wheels are turned round, and a rack
ARM = """
bodies:
  arm: {mass: 1, inertia: 0.1, at: [0.1, 0]}
  pinion: {mass: 1, inertia: 0.002, at: [0, 0]}
  wheel: {mass: 3, inertia: 0.02, at: [0.15, 0]}
  last: {mass: 3, inertia: 0.02, at: [0.15, 0.13]}
  rack: {mass: 1, inertia: 0.01, at: [-0.05, 0.2]}
joints:
  base: {type: revolute, bodies: [ground, arm], at: [0, -0.2]}
  first: {type: revolute, bodies: [arm, pinion], at: [0, 0]}
  second: {type: revolute, bodies: [arm, wheel], at: [0.15, 0]}
  third: {type: revolute, bodies: [last, arm], at: [0.15, 0.13]}
  guide: {type: prismatic, bodies: [arm, rack], at: [SIDE, 0.1], axis: [0, 1]}
  pair: {type: gear, joints: [second, third], ratio: 1.6}
  bar: {type: rack_and_pinion, joints: [first, guide], RACK}
  teeth: {type: gear, joints: [first, second], radii: [50 mm, 100 mm]}
drives: {m: {joint: first, velocity: 5}, n: {joint: base, velocity: 3}}
solver: {end: 0.5 s}
output: {every: 5 ms, channels: ["*", "*.rotation"]}
"""
# the cone of the smaller wheel is turned against its axis
BEVEL = """
planar: false
bodies:
  small: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [0.2, 0, 0]}
  large: {mass: 1, inertia: [0.01, 0.02, 0.01], at: [0, 0.1, 0]}
joints:
  one: {type: revolute, bodies: [ground, small], at: [0.2, 0, 0], axis: [-1, 0, 0]}
  two: {type: revolute, bodies: [ground, large], at: [0, 0.1, 0], axis: [0, 1, 0]}
  pair: {type: gear, joints: [one, two], teeth: [15, 30]}
drives: {m: {joint: one, velocity: 20}}
solver: {end: 0.4 s}
output: {every: 4 ms, channels: ["*", "*.rotation"]}
"""
WORM = """
planar: false
bodies:
  screw: {mass: 1, inertia: [1e-4, 1e-4, 1e-4], at: [0, 0, 0]}
  wheel: {mass: 2, inertia: [0.01, 0.01, 0.02], at: [0.03, YY, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, screw], at: [0, 0, 0], axis: [1, 0, 0]}
  shaft: {type: revolute, bodies: [ground, wheel], at: [0.03, YY, 0.01], axis: [0, 0, 1]}
  teeth: {type: worm, joints: [bearing, shaft], HOW}
drives: {motor: {joint: bearing, velocity: 30}}
solver: {end: 0.5 s}
output: {every: 2 ms, channels: ["*", "*.rotation"]}
"""
TEXTS = {
    "arm": ARM.replace("SIDE", "-0.05").replace("RACK", "radius: 50 mm"),
    "bevel": BEVEL,
}


def run_of(folder, name, *sets):
    if name in TEXTS:
        return of(folder, *sets, text=TEXTS[name])
    return validation(folder, name, 'output.channels=["*.position", "*.rotation"]', *sets)


TRAINS = ["planetary_gear", "differential", "arm", "bevel"]


def placed(moved, wheel):
    """Middle and axis of a wheel over the frames, by its own body."""
    return moved.point(wheel.body, wheel.at), turns.turned(moved.turn(wheel.body), wheel.axis)


@pytest.mark.parametrize("name", TRAINS)
def test_pitch_circles_touch(name, tmp_path):
    """Both go through the pitch point, which the carrier takes along, in all frames."""
    moved, _, _ = made(run_of(tmp_path, name), wheels.wheels)
    moving = moved.drawn.moving
    assert moving.meshes
    for mesh in moving.meshes:
        p = moved.point(mesh.carrier, mesh.at)
        for k in (mesh.first, mesh.second):
            if k < 0:
                continue
            wheel = moving.wheels[k]
            c, axis = placed(moved, wheel)
            assert np.linalg.norm(p - c, axis=1) == pytest.approx(wheel.radius, rel=1e-9)
            assert np.abs(np.sum((p - c) * axis, axis=1)).max() < 1e-6 * wheel.radius


def test_sizes_by_hand(tmp_path):
    """Radii of teeth, of a ratio, of cones, from the distance of the axes."""
    moving = made(run_of(tmp_path, "planetary_gear"))[0].drawn.moving
    radii = {wheel.body: (wheel.radius, wheel.hollow, wheel.teeth) for wheel in moving.wheels}
    assert len(moving.wheels) == 5
    assert radii["sun"] == (pytest.approx(0.048), False, 24)
    assert radii["ground"] == (pytest.approx(0.120), True, 60)
    assert radii["planet3"] == (pytest.approx(0.036), False, 18)
    moving = made(run_of(tmp_path, "arm"))[0].drawn.moving
    radii = {(wheel.body, round(wheel.radius, 6)) for wheel in moving.wheels}
    # third turns the arm against it: phi_2 = 1.6 phi_3 and opposite signs make both turn opposite
    small = round(0.13 / 2.6, 6)
    assert radii == {("pinion", 0.05), ("wheel", 0.1), ("wheel", small), ("last", 0.13 - small)}
    small, large = made(run_of(tmp_path, "bevel"))[0].drawn.moving.wheels
    assert small.radius / large.radius == pytest.approx(0.5)
    assert np.linalg.norm(small.at) == pytest.approx(large.radius)  # the cones are complementary
    assert small.at[0] > 0.0 and large.at[1] > 0.0


def tooth(moved, wheel, p):
    """Where between two teeth of a wheel a place is, over the frames: 0 and 1 at teeth."""
    x, y, _ = frame(wheel.axis)
    c, _ = placed(moved, wheel)
    own = turns.turned(turns.back(moved.turn(wheel.body)), p - c)
    angle = np.arctan2(own @ y, own @ x) - wheel.phase
    return np.mod(angle * wheel.teeth / (2.0 * np.pi), 1.0)


@pytest.mark.parametrize("name", TRAINS)
def test_teeth_mesh(name, tmp_path):
    """At the pitch point what is left to a tooth of the one is what is over a gap of the other."""
    moved, _, _ = made(run_of(tmp_path, name), wheels.wheels)
    moving, tried = moved.drawn.moving, 0
    # a train that is closed meshes all round where its numbers allow it: (60 + 24)/3 is whole
    for mesh in moving.meshes:
        if mesh.second < 0:
            continue
        one, other = moving.wheels[mesh.first], moving.wheels[mesh.second]
        assert one.teeth and other.teeth
        p = moved.point(mesh.carrier, mesh.at)
        a, b = tooth(moved, one, p), tooth(moved, other, p)
        inside = one.hollow or other.hollow
        # beside each other axes that are parallel turn opposite ways, one inside the other alike
        ways = np.cross(one.axis, mesh.at - one.at) @ np.cross(other.axis, mesh.at - other.at)
        over = a - np.sign(ways) * b + (0.0 if inside else 0.5)
        off = np.abs(over - np.round(over))
        assert off.max() < 1e-3, mesh.name
        assert np.ptp(np.unwrap(a, period=1.0)) > 1.0
        tried += 1
    assert tried


def test_drawn_teeth_stand_where_they_are_counted(tmp_path):
    """The outermost corners of the mesh are at the angles of teeth, in space and turned round."""
    for name in ("planetary_gear", "bevel"):
        moved, _, things = made(run_of(tmp_path, name), wheels.wheels)
        for k, wheel in enumerate(moved.drawn.moving.wheels):
            thing = things[f"{wheel.joint} wheel {k}"]
            (mesh, _), (dark, _) = thing.pieces
            closed(mesh)
            closed(dark)
            size = np.linalg.norm(mesh.points[:, :2], axis=1)
            if wheel.hollow:  # its teeth are inside, their gaps outside
                tips = (size > wheel.radius) & (size < 1.05 * wheel.radius)
            else:
                tips = size > 1.02 * wheel.radius
            if wheel.apex is not None:  # a cone is cut off on the side of its apex
                apex = moved.point(wheel.carrier, wheel.apex)
                away = np.linalg.norm(seen(thing, mesh.points) - apex[:, None], axis=2)
                length = np.linalg.norm(mesh_of(moved, k).at - wheel.apex)
                assert away.max() < 1.2 * length
                assert np.sort(size[away[0] < 0.8 * length])[-1] < wheel.radius
            there = seen(thing, mesh.points[tips][:3])
            for corner in range(3):
                at = tooth(moved, wheel, there[:, corner])
                assert np.abs(at - np.round(at)).max() < 1e-6
            # the pitch circle is half-way between tips and roots
            assert 0.5 * (size[tips].max() + roots(wheel, size)) == pytest.approx(
                wheel.radius, rel=0.02
            )


def mesh_of(moved, k):
    return next(mesh for mesh in moved.drawn.moving.meshes if k in (mesh.first, mesh.second))


def roots(wheel, size):
    near = size[(size > 0.8 * wheel.radius) & (size < 0.999 * wheel.radius)]
    return near.max() if wheel.apex is not None else near.min() if wheel.hollow else near.max()


@pytest.mark.parametrize(
    ("side", "how"),
    [("-0.05", "radius: 50 mm"), ("0.05", "radius: 50 mm"), ("-0.05", "ratio: -0.05"),
     ("-0.05", "ratio: 0.05")],
)  # fmt: skip
def test_a_rack_rolls_on_its_pinion(side, how, tmp_path):
    """A gap of the rack is at the pitch point when a tooth of the pinion is; on the right side."""
    text = ARM.replace("SIDE", side).replace("RACK", how)
    moved, _, things = made(of(tmp_path, text=text), wheels.wheels, wheels.racks)
    (rack,) = moved.drawn.moving.racks
    wheel = moved.drawn.moving.wheels[rack.wheel]
    left = side == "-0.05" and how != "ratio: 0.05"
    assert rack.out == pytest.approx([-1.0 if left else 1.0, 0, 0])
    ((mesh, _),) = things["bar rack"].pieces
    closed(mesh)
    p = moved.point("arm", rack.at)
    at = tooth(moved, wheel, p)
    own = moved.on("rack", p)
    corners = mesh.points + moved.drawn.bodies["rack"]
    # the teeth of the rack towards the wheel: their tips
    towards = -(corners - rack.at) @ rack.out
    tips = np.unique(corners[towards > 0.99 * towards.max(), 1].round(9))
    pitch = 2.0 * np.pi * 0.05 / wheel.teeth
    assert np.diff(tips) == pytest.approx(pitch, rel=1e-6)
    ahead = np.mod((own[:, 1] - tips[0]) / pitch, 1.0)
    way = np.sign(np.cross(wheel.axis, rack.out)[1])
    over = at - way * ahead + 0.5
    assert np.abs(over - np.round(over)).max() < 1e-4
    assert own[:, 1].min() > tips.min() and own[:, 1].max() < tips.max()


@pytest.mark.parametrize("y", ["0.06", "-0.06"])
@pytest.mark.parametrize(
    ("how", "right"),
    [("teeth: [2, 30], hand: right", True), ("teeth: [1, 40], hand: left", False),
     ("ratio: 25", None), ("ratio: -25", None)],
)  # fmt: skip
def test_a_worm_goes_through_its_wheel(y, how, right, tmp_path):
    """The thread is in a gap of the wheel, in all frames, whatever hand and side."""
    moved, _, things = made(of(tmp_path, text=WORM.replace("YY", y).replace("HOW", how)),
                            threads.worms, wheels.wheels)  # fmt: skip
    (worm,) = moved.drawn.moving.worms
    wheel = moved.drawn.moving.wheels[worm.wheel]
    ((mesh, _),) = things["teeth thread"].pieces
    closed(mesh)
    assert worm.at == pytest.approx([0.03, 0, 0])
    if right is not None:
        assert (worm.lead > 0.0) == right
    assert np.linalg.norm(wheel.at - worm.at) == pytest.approx(wheel.radius + worm.radius)
    # crests of the thread on the side of the wheel: the farthest points of a narrow sector
    out = (wheel.at - worm.at) / np.linalg.norm(wheel.at - worm.at)
    points = seen(things["teeth thread"], mesh.points)
    tries = range(0, len(moved.time), 40)
    onward = np.cross(wheel.axis, -out)
    for k in tries:
        d = points[k] - worm.at
        over, high = d @ np.cross([1.0, 0, 0], out), d @ out
        angle = np.arctan2(over, high)
        radius = np.hypot(over, high)
        crest = radius > 0.98 * radius.max()
        # each crest point goes back along its helix to the plane of the wheel
        x = d[crest, 0] - worm.lead * angle[crest] / (2.0 * np.pi)
        at = tooth(moved, wheel, moved.point("ground", worm.at))[k]
        pitch = 2.0 * np.pi * wheel.radius / wheel.teeth
        # teeth of the wheel near the pitch point, along x
        teeth = -at * pitch * np.sign(onward[0])
        over = (x - teeth) / pitch - 0.5
        assert np.abs(over - np.round(over)).max() < 0.05


def test_a_screw_goes_through_its_nut(tmp_path):
    """The thread is on the spindle, turns with it, and is a right-handed one of that pitch."""
    run = validation(tmp_path, "screw_jack", 'output.channels=["*.position", "*.rotation"]')
    moved, _, things = made(run, threads.screws)
    ((mesh, _),) = things["thread screw"].pieces
    closed(mesh)
    points = seen(things["thread screw"], mesh.points)
    k, starts = len(moved.time) // 2, []
    for row in (0, k):
        d = points[row]
        radius = np.hypot(d[:, 0], d[:, 1])
        crest = radius > 0.98 * radius.max()
        angle = np.arctan2(d[crest, 1], d[crest, 0])
        start = d[crest, 2] / 0.006 - angle / (2.0 * np.pi)
        over = start - start[0]
        assert np.abs(over - np.round(over)).max() < 0.02
        starts.append(start[0])
    # a spindle that stays in its height carries its thread up or down by turning
    turn = moved.turn("spindle")
    turned = np.unwrap(2.0 * np.arctan2(turn[:, 2], turn[:, 3]))[k]
    moves = starts[1] - starts[0] + turned / (2.0 * np.pi)
    assert abs(moves - np.round(moves)) < 0.02
    assert abs(turned) > 1.0
    nut = things["thread nut"]
    assert nut.place[:, 2] == pytest.approx(0.4 + moved.places["table"][:, 2] - 0.5, abs=1e-9)


def test_what_has_no_pitch_circle_is_told(tmp_path):
    """A ratio between coaxial shafts is no pair of wheels; the animation says so and goes on."""
    text = ARM.replace("SIDE", "-0.05").replace("RACK", "radius: 50 mm")
    text = text.replace("at: [0.15, 0.13]}\n  guide", "at: [0.15, 0]}\n  guide")
    made_ = film(of(tmp_path, text=text))
    assert any("not drawn: pair: no pitch circles" in told for told in made_.warnings)


def test_teeth_of_a_start_elsewhere_are_told(tmp_path):
    run = validation(tmp_path, "planetary_gear", "initial={shaft: 40 deg}")
    assert any("teeth and marks" in told for told in film(run).warnings)
    run = validation(tmp_path, "planetary_gear", "initial={shaft: 40 deg}",
                     'output.channels=["*.position", "*.rotation"]')  # fmt: skip
    assert film(run).warnings == ()


def test_wheels_that_are_alike_share_a_mesh(tmp_path):
    _, _, things = made(run_of(tmp_path, "planetary_gear"), wheels.wheels)
    of_planets = {id(things[name].pieces[0][0]) for name in things if name.startswith("pin")}
    assert len(of_planets) == 1
    for thing in things.values():
        whole, _ = volume(thing.pieces[0][0])
        assert whole > 0.0


def test_wheels_of_a_train_are_in_one_layer(tmp_path):
    """Teeth that mesh stand in one plane; what a body has of a second train is in front."""
    moved, _, things = made(run_of(tmp_path, "arm"), wheels.wheels)
    height = {}
    for k, wheel in enumerate(moved.drawn.moving.wheels):
        z = things[f"{wheel.joint} wheel {k}"].place[:, 2]
        assert np.ptp(z) < 1e-12
        height.setdefault(wheel.train, set()).add(round(float(z[0]), 9))
    assert all(len(found) == 1 for found in height.values())
    assert len({next(iter(found)) for found in height.values()}) == len(height) == 2
