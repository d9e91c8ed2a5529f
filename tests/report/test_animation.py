"""Animations: poses from the result file, solids, forces, the .glb, and the page in a browser."""

import numpy as np
import pytest

from tests import small
from trsim.errors import UsageError
from trsim.report.animation import film, forces, solids, turns
from trsim.report.animation.bodies import rails, skeleton
from trsim.report.animation.fittings import pins
from trsim.report.animation.lines import lines
from trsim.report.animation.motion import FRAMES, even_frames, frames, motion
from trsim.report.animation.page import arrow_scale
from trsim.report.animation.things import colours, look

from .filmed import HATCH, arrays, of, validation

SPINNING = """
planar: false
bodies:
  top: {mass: 1, inertia: [0.01, 0.02, 0.03], at: [0, 0, 0.1], angle: 20 deg,
        angular_velocity: [6, 1, 9]}
joints:
  tip: {type: spherical, bodies: [ground, top], at: [0, 0, 0]}
gravity: [0, 0, -9.81]
solver: {end: 0.5 s, tolerance: 1e-9}
output: {every: 2 ms, channels: ["*", "*.rotation"]}
"""
FOUR_BAR = """
bodies:
  crank:   {mass: 0.2 kg, inertia: 2e-4, at: [0, 0.05]}
  coupler: {mass: 0.6 kg, inertia: 5e-3, at: [0.130753114, 0.173509341], angle: 30 deg}
  rocker:  {mass: 0.5 kg, inertia: 3e-3, at: [0.280753114, 0.123509341]}
joints:
  a: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  b: {type: revolute, bodies: [crank, coupler], at: [0, 0.1]}
  c: {type: revolute, bodies: [coupler, rocker], at: [0.261506227, 0.247018682]}
  d: {type: revolute, bodies: [ground, rocker], at: [0.3, 0]}
drives:
  motor: {joint: a, velocity: 20 rad/s}
initial: {a: 100 deg}
solver: {end: 0.1 s, tolerance: 1e-9}
output: {every: 0.1 ms, channels: ["*", "*.rotation"]}
"""
CARDAN = """
planar: false
bodies:
  driver: {mass: 1, inertia: [0.02, 0.01, 0.01], at: [-0.3, 0.05, 0], angular_velocity: [20, 0, 0]}
  driven: {mass: 1, inertia: [0.04, 0.04, 0.04], at: [0.24, 0.18, 0]}
joints:
  one: {type: revolute, bodies: [ground, driver], at: [-0.5, 0, 0], axis: [1, 0, 0]}
  two: {type: revolute, bodies: [ground, driven], at: [0.4, 0.3, 0], axis: [4, 3, 0]}
  cross: {type: universal, bodies: [driver, driven], at: [0, 0, 0], axis: [0, 0, 1],
          second_axis: [-3, 4, 0]}
initial: {one: 50 deg}
solver: {end: 0.1 s, tolerance: 1e-9}
output: {every: 0.1 ms, channels: ["*", "*.rotation"]}
"""
# a ring on a shaft with a bead on a wire of its own
SLIDES = """
planar: false
bodies:
  ring: {mass: 2, inertia: [0.02, 0.02, 0.02], at: [0.1, 0, 0], angular_velocity: [0, 0, 20],
         velocity: [0, 2, 0]}
  bead: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [0.3, 0.1, 0], angular_velocity: [5, 9, 0]}
joints:
  shaft: {type: cylindrical, bodies: [ground, ring], at: [0, 0, 0], axis: [0, 0, 1]}
  wire: {type: inline, bodies: [ring, bead], at: [0.3, 0, 0], axis: [1, 0, 1]}
gravity: [0, 0, -9.81]
solver: {end: 0.1 s, tolerance: 1e-9}
output: {every: 0.1 ms, channels: ["*", "*.rotation"]}
"""
SLEEVE = """
bodies:
  rocker: {mass: 1, inertia: 0.01, at: [0.3, 0]}
  rod: {mass: 1, inertia: 0.01, at: [0.5, 0.1]}
joints:
  pin: {type: revolute, bodies: [ground, rocker], at: [0, 0]}
  end: {type: revolute, bodies: [rocker, rod], at: [0.3, 0]}
  sleeve: {type: inline, bodies: [rocker, rod], at: [AT, 0], axis: [1, 0, 0]}
solver: {end: 1 ms}
"""


def without_rotation(run):
    """The run as it is by default."""
    units = {name: unit for name, unit in run.units.items() if not name.endswith(".rotation")}
    return type(run)(**{**vars(run), "units": units})


def angle(p, q):
    """Between two turns, rad."""
    return 2.0 * np.linalg.norm(turns.product(p, turns.back(q))[..., :3], axis=-1)


# --- poses -----------------------------------------------------------------------------------


TURNING = [(SPINNING, 1e-6), (FOUR_BAR, 1e-7), (CARDAN, 1e-7), (SLIDES, 1e-6)]


@pytest.mark.parametrize(("text", "exact"), TURNING)
def test_attitudes_are_those_recorded(text, exact, tmp_path):
    """The integral of the velocities, from a start that is not the drawing, is the rotation."""
    run = of(tmp_path, text=text)
    recorded, found = motion(run), motion(without_rotation(run))
    for body, turn in recorded.turns.items():
        assert angle(turn, turn[:1]).max() > 0.1  # the coupler turns least
        assert angle(turn, found.turns[body]).max() < exact, body
    assert found.warnings == ()


def test_recorded_attitudes_close_the_joints(tmp_path):
    assert motion(of(tmp_path, text=FOUR_BAR)).open < 1e-7


def test_what_slides_is_on_a_rail(tmp_path):
    moved, sizes, drawn = named(of(tmp_path, "output.every=1 ms", text=SLIDES))
    assert {"shaft rail", "wire rail"} <= set(drawn)
    assert list(pins(moved, sizes)) == []
    assert moved.open < 1e-6


def test_what_slides_makes_no_link_short(tmp_path):
    """A link is as wide as its length allows; where a sleeve was drawn says nothing of it."""
    drawn = [motion(of(tmp_path, text=SLEEVE.replace("AT", at))).drawn for at in ("0.301", "0.6")]
    near, far = (look(each).radius / each.size for each in drawn)
    assert near == pytest.approx(far, rel=1e-12) == pytest.approx(0.022)


def test_order_of_the_integral(tmp_path):
    """Fourth order in space: half the step, a sixteenth of the error."""
    run = of(tmp_path, "output.every=2 ms", text=SPINNING)
    exact = motion(run).turns["top"][-1]
    time, omega = run.time, run.channel("top.angular_velocity")
    alpha, errors = run.channel("top.angular_acceleration"), []
    for step in (10, 5):
        steps = turns.steps(time[::step], omega[::step], alpha[::step])
        start = motion(run).turns["top"][:1]
        errors.append(angle(turns.composed(np.concatenate([start, steps]))[-1], exact))
    assert 12.0 < errors[0] / errors[1] < 20.0


def test_joints_closed(crank):
    """By the integral alone, over two turns of the crank and its impacts."""
    assert motion(crank).open < 1e-4 * motion(crank).drawn.size


def test_journal_where_recorded(crank):
    """The play is the recorded eccentricity, and that of the poses to the closing error."""
    found = motion(crank)
    joint = next(joint for joint in found.drawn.joints if joint.name == "B")
    apart = found.point("slider", joint.at) - found.point("rod", joint.at)
    assert np.linalg.norm(apart - found.plays["B"], axis=1).max() < 1e-6
    recorded = np.hypot(crank.channel("B.eccentricity_x"), crank.channel("B.eccentricity_y"))
    assert np.linalg.norm(found.plays["B"], axis=1) == pytest.approx(recorded[found.rows])


def test_coarse_output_is_told(tmp_path):
    """Velocities recorded a few times per turn do not tell attitudes."""
    found = motion(of(tmp_path, "output.every=1 ms"))
    assert found.open > 0.01 * found.drawn.size
    assert any("joints come" in text for text in found.warnings)
    told = motion(of(tmp_path, "output.every=0.25 s", text=SPINNING)).warnings
    assert any("too fast for the frames to show: top" in text for text in told)


def test_what_was_not_recorded_is_told(tmp_path):
    run = of(tmp_path, 'output.channels=["crank.position", "rod.position", "rod.angular_velocity"]')
    told = " ".join(motion(run).warnings)
    assert "positions were not recorded: slider" in told
    assert "not recorded: crank" in told
    with pytest.raises(UsageError, match="position of no body"):
        film(of(tmp_path, 'output.channels=["B"]'))


def test_released_joints_may_open(tmp_path):
    text = FOUR_BAR + "events:\n  go: {when: t, value: 20 ms, do: {release: [c]}}\n"
    assert motion(of(tmp_path, text=text)).warnings == ()


def test_a_bar_alone_that_begins_bent(tmp_path):
    """There is no attitude to be found."""
    run = validation(tmp_path, "cantilever_tip_force", "solver.end=0.1 ms")
    assert motion(run).turns == {}
    assert film(run).warnings == ()


@pytest.mark.parametrize("rows", [1, 2, FRAMES, FRAMES + 1, 10001])
def test_frames(rows):
    """At most FRAMES, with the first and the last, evenly in time."""
    time = np.linspace(0.0, 1.0, rows)
    found = frames(time)
    assert len(found) == min(rows, FRAMES)
    assert (found[0], found[-1]) == (0, rows - 1)
    if rows > FRAMES:
        assert np.abs(time[found] - np.linspace(0.0, 1.0, FRAMES)).max() <= 0.5 / (rows - 1) + 1e-12


@pytest.mark.parametrize(("rows", "found"), [(600, 600), (601, 301), (801, 401), (1800, 451),
                                             (10_000, 590)])  # fmt: skip
def test_even_frames(rows, found):
    """Every k-th row, and the last one whatever is left; rows at events are passed over."""
    time = np.linspace(0.0, 8.0, rows)
    kept = even_frames(time)
    assert len(kept) == found
    assert (kept[0], kept[-1]) == (0, rows - 1)
    assert len({*np.diff(kept)[:-1]}) == 1
    if rows > FRAMES:
        events = np.sort(np.concatenate([time, [1.0, 1.0, 2.34567, 5.0001]]))
        again = events[even_frames(events)]
        np.testing.assert_allclose(again, time[kept], rtol=0.0, atol=1e-9)


def test_frames_of_rows_that_are_not_even():
    """As even as the rows are: bursts of rows do not take the frames of the rest."""
    burst = 4.0 + 1e-6 * np.arange(5000)
    time = np.sort(np.concatenate([np.linspace(0.0, 8.0, 2000), burst]))
    kept = time[even_frames(time)]
    assert len(kept) <= FRAMES
    assert np.diff(kept).max() < 0.02
    assert len(even_frames(np.r_[np.zeros(700), 1.0])) == 2


def test_turns():
    """Matrices to quaternions at all four largest entries, and vectors turned by both."""
    d = np.array([[0.1, 0, 0], [3.1, 0, 0], [0, 3.1, 0], [0, 0, 3.1], [1.0, 2.0, -0.5]])
    q = turns.of_vector(d)
    R = np.stack([turns.turned(q, np.eye(3)[k]) for k in range(3)], axis=2)
    assert np.abs(np.sum(turns.of_matrices(R) * q, axis=1)) == pytest.approx(np.ones(5))
    a, b = (
        np.array([[1.0, 2, 3], [1, 0, 0], [0, 0, 2]]),
        np.array([[-3.0, 1, 1], [-2, 0, 0], [0, 0, -1]]),
    )
    found = turns.turned(turns.shortest(a, b), a / np.linalg.norm(a, axis=1, keepdims=True))
    assert found == pytest.approx(b / np.linalg.norm(b, axis=1, keepdims=True))


# --- solids and forces -----------------------------------------------------------------------

Z, X = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
SOLIDS = {
    "cylinder": (solids.cylinder(1.0, 2.0, X), 2.0 * np.pi),
    "box": (solids.box(np.array([1.0, 2.0, 3.0]), solids.frame(np.array([1.0, 2.0, 3.0]))), 6.0),
    "bar": (solids.bar(np.zeros(3), np.array([0.0, 3.0, 0.0]), 1.0, 0.5, Z), 3.0 + 0.5 * np.pi),
    "ring": (solids.ring(1.0, 2.0, 1.0, Z), 3.0 * np.pi),
    "rod": (solids.rod(np.zeros(3), 3.0 * X, 1.0), 3.0 * np.pi + 4.0 / 3.0 * np.pi),
    "coil": (solids.coil(6.0, 1.0, 0.2, 3), 1.5 * 3.0**0.5 * 0.04 * np.hypot(6.0, 6.0 * np.pi)),
    "arrow": (solids.arrow(0.3, 0.4), np.pi * (0.16 * 0.7 + 0.1)),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_solids_are_closed_and_face_outwards(name):
    mesh, volume = SOLIDS[name]
    corners = mesh.points[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.sum(corners[:, 0] * normal) / 6.0 == pytest.approx(volume, rel=0.08)
    assert np.abs(normal.sum(axis=0)).max() < 1e-12
    outward = mesh.normals[mesh.triangles].mean(axis=1)
    assert np.sum(normal * outward, axis=1).min() >= -1e-12
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(np.ones(len(mesh.points)))


def test_arrows_are_proportional(crank):
    """As long as the largest force since the frame before, along it; none without contact."""
    moved = motion(crank)
    (arrow,), scale = forces.arrows(crank, moved, look(moved.drawn), 1.0)
    force = crank.channel("B.force")
    assert np.array_equal(moved.rows, np.arange(len(force)))
    size = np.linalg.norm(force, axis=1)
    assert arrow.scale[:, 0] == pytest.approx(scale * size)
    assert (size == 0.0).any() and (size > 0.0).any()
    assert (arrow.scale[size == 0.0] == 0.0).all()
    along = turns.turned(arrow.turn[size > 0.0], X)
    assert along == pytest.approx((force / np.maximum(size, 1e-9)[:, None])[size > 0.0], abs=1e-9)


def test_no_impact_between_frames_is_lost():
    vectors = np.zeros((10, 3))
    vectors[4], vectors[5] = [0.0, -7.0, 0.0], [1.0, 0.0, 0.0]
    found = forces.largest(vectors, np.array([0, 3, 6, 9]))
    assert found.tolist() == [[0, 0, 0], [0, 0, 0], [0, -7, 0], [0, 0, 0]]


def test_scale_in_words():
    assert arrow_scale(1e-4) == "1 kN is 100 mm"
    assert arrow_scale(0.5) == "1 N is 500 mm"


# --- what acts between points of bodies --------------------------------------------------------


def named(run):
    moved = motion(run)
    sizes = look(moved.drawn)
    things = (*lines(moved, sizes), *rails(moved, sizes))
    return moved, sizes, {thing.name: thing for thing in things}


def reach(thing):
    """Where the end of a mesh from 0 to 1 along x is over the frames."""
    return thing.place + turns.turned(thing.turn, thing.scale[:, :1] * X)


def test_actuator(hatch):
    """Its rod ends on both bodies; its cylinder keeps its length and is never longer than that."""
    moved, sizes, things = named(hatch)
    head = moved.point("hatch", np.array([-0.3, 0.0, 0.4]))
    assert np.ptp(head[:, 0]) > 0.1
    assert things["jack"].place == pytest.approx(np.tile([-0.8, 0.1, 0.4], (len(head), 1)))
    assert reach(things["jack rod"]) == pytest.approx(head)
    assert things["jack head"].place == pytest.approx(head)
    (cylinder, _), _ = things["jack"].pieces
    assert things["jack"].scale is None
    length = np.linalg.norm(head - [-0.8, 0.1, 0.4], axis=1)
    assert 0.5 * length.min() < cylinder.points[:, 0].max() < length.min() - sizes.radius


def test_spring(hatch):
    """The coil is stretched from the one body to the other."""
    moved, _, things = named(hatch)
    coil = things["high_hold"]
    ((mesh, _),) = coil.pieces
    x = mesh.points[:, 0]
    size = x.min() + x.max()  # of the line in the middle of the wire
    ends = [moved.point(body, np.array([0.2, y, 0.8])) for body, y in
            (("hatch", 0.1), ("high_leaf", 0.4))]  # fmt: skip
    assert coil.place == pytest.approx(ends[0])
    found = coil.place + turns.turned(coil.turn, size * coil.scale[:, :1] * X)
    assert found == pytest.approx(ends[1])
    assert np.ptp(np.linalg.norm(ends[1] - ends[0], axis=1)) > 1e-2


def test_link(tmp_path):
    """A rod from ball to ball, wherever they go."""
    text = """
bodies: {bob: {mass: 2, inertia: 0.01, at: [0.5, 0]}}
joints: {rope: {type: link, bodies: [ground, bob], points: [[0, 0.1], [0.5, 0]]}}
gravity: [0, -9.81, 0]
solver: {end: 0.5 s}
"""
    moved, _, things = named(of(tmp_path, "output.every=5 ms", text=text))
    rod, head = things["rope rod"], things["rope head"]
    length = np.hypot(0.5, 0.1)
    assert rod.scale[:, 0] == pytest.approx(length, abs=1e-6)
    end = rod.place + turns.turned(rod.turn, length * X + np.zeros((len(rod.turn), 3)))
    assert end == pytest.approx(head.place, abs=1e-6)
    assert head.place[:, :2] == pytest.approx(moved.places["bob"][:, :2], abs=1e-9)
    assert np.ptp(head.place[:, 0]) > 0.1


def test_spring_without_length(tmp_path):
    """Two points that are always one have no direction: nothing is drawn between them."""
    text = (
        small.SLIDER_CRANK
        + """
forces: {none: {type: spring_damper, bodies: [ground, crank], points: [[0, 0], [0, 0]],
                stiffness: 1}}
"""
    )
    _, _, things = named(of(tmp_path, text=text))
    assert "none" not in things


def test_bushing(hatch):
    """A block on the second body; where it slides it is longer and runs on a rail of the first."""
    moved, sizes, things = named(hatch)
    assert things["mount"].place == pytest.approx(moved.point("high_leaf", np.array([0, 0.4, 0.8])))
    assert things["mount"].turn is moved.turn("high_leaf")
    for name, ratio in (("mount", 1.0), ("rail", 2.0)):
        sides = np.ptp(things[name].pieces[0][0].points, axis=0)
        assert sides == pytest.approx(sides[1] * np.array([ratio, 1.0, 1.0]))
    assert [name for name in things if name.endswith(" rail")] == ["rail rail"]
    ((rail, _),) = things["rail rail"].pieces
    x = moved.places["hatch"][:, 0]
    assert rail.points[:, 0].min() < x.min() - sizes.radius
    assert rail.points[:, 0].max() > x.max() + sizes.radius


def test_lines_of_a_flat_mechanism(tmp_path):
    """They stand in front of their bodies; stiffness out of the plane makes no rail."""
    text = (
        small.SLIDER_CRANK
        + """
forces:
  pad: {type: bushing, bodies: [ground, slider], at: [0.17, 0], stiffness: [10, 10, 0]}
  spring: {type: spring_damper, bodies: [crank, rod], points: [[0, 0], [0.11, 0]], stiffness: 1}
"""
    )
    moved, sizes, things = named(of(tmp_path, text=text))
    assert sizes.normal.tolist() == [0.0, 0.0, 1.0]
    height = things["spring"].place[:, 2]
    assert height == pytest.approx(np.full(len(moved.time), sizes.front("crank", "rod")))
    assert "pad rail" not in things


def test_many_points_are_one_body(hatch):
    """Where lines act counts; links go from neighbour to neighbour and reach every point."""
    drawn = motion(hatch).drawn
    found = [(tuple(a), tuple(b)) for a, b in skeleton(drawn, look(drawn), "hatch")]
    points = {(-0.3, 0.0, 0.4), (0.0, 0.0, 0.4)}
    points |= {(x, y, z) for x, y in ((0.0, 0.2), (0.2, 0.1)) for z in (0.0, 0.8)}
    points.add((0.0, 0.4, 0.8))  # of the mount
    assert {point for pair in found for point in pair} == points
    assert len(found) == len(points) - 1
    # the shortest way to hold them: by hand
    total = sum(np.linalg.norm(np.subtract(a, b)) for a, b in found)
    assert total == pytest.approx(0.3 + 2 * 0.2**0.5 + 2 * 0.05**0.5 + 0.2)


def test_equal_bodies_have_one_colour(hatch):
    found = colours(motion(hatch).drawn)
    assert found["low_leaf"] == found["high_leaf"] != found["hatch"]
    assert list(film(hatch).colours) == ["hatch", "flap_leaf"]


@pytest.mark.parametrize("gravity", [[0, 0, 0], [0, -9.81, 0], [0, 0, -9.81], [9.81, 0, 0]])
def test_first_view_in_space_is_oblique(gravity, tmp_path):
    """Upright against gravity; the axes have three directions and lengths that are seen."""
    run = of(tmp_path, f"gravity={gravity}", text=HATCH)
    gltf, _ = arrays(film(run).glb)
    extras = gltf.scenes[0].extras
    up, back = np.array(extras["up"]), np.array(extras["back"])
    assert up == pytest.approx(-np.sign(gravity) if any(gravity) else Z)
    assert 0.3 < up @ back < 0.7
    # two axes fall together on the screen where the line of sight has nothing of the third
    assert np.abs(back).min() > 0.3
    assert "normal" not in extras


def test_first_view_of_the_plane(crank):
    gltf, _ = arrays(film(crank).glb)
    extras = gltf.scenes[0].extras
    assert extras["normal"] == [0.0, 0.0, 1.0]
    assert not {"up", "back"} & set(extras)
