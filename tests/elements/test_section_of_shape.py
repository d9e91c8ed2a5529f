"""A section of a body with a shape: what lies beyond is cut from the shape, and the section is the
reaction of a `fixed` joint between two bodies whose shapes are the two pieces."""

import json
from math import pi

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, run

# whole body, piece that stays, piece beyond, station, normal; as drawn
STEEL = "density: 7850, "
PIECES = {
    "box": (
        "{box: [1, 0.1, 0.2], at: [0.5, 0, 0]}",
        "{box: [0.4, 0.1, 0.2], at: [0.2, 0, 0]}",
        "{box: [0.6, 0.1, 0.2], at: [0.7, 0, 0]}",
        [0.4, 0, 0], [1, 0, 0],
    ),
    "box backwards": (
        "{box: [1, 0.1, 0.2], at: [-0.5, 0, 0]}",
        "{box: [0.4, 0.1, 0.2], at: [-0.2, 0, 0]}",
        "{box: [0.6, 0.1, 0.2], at: [-0.7, 0, 0]}",
        [-0.4, 0.03, 0.02], [-2, 0, 0],
    ),
    "tube": (
        "{cylinder: 0.2, wall: 10 mm, length: 1, at: [0.5, 0, 0], axis: [1, 0, 0]}",
        "{cylinder: 0.2, wall: 10 mm, length: 0.3, at: [0.15, 0, 0], axis: [1, 0, 0]}",
        "{cylinder: 0.2, wall: 10 mm, length: 0.7, at: [0.65, 0, 0], axis: [-1, 0, 0]}",
        [0.3, 0, 0], [1, 0, 0],
    ),
    "inclined box": (
        "{box: [0.1, 0.2, 1], at: [0.3, 0.4, 0], axis: [3, 4, 0], x_axis: [0, 0, 1]}",
        "{box: [0.1, 0.2, 0.7], at: [0.21, 0.28, 0], axis: [3, 4, 0], x_axis: [0, 0, 1]}",
        "{box: [0.1, 0.2, 0.3], at: [0.51, 0.68, 0], axis: [3, 4, 0], x_axis: [0, 0, 1]}",
        [0.42, 0.56, 0], [3, 4, 0],
    ),
    "plate cut at an angle": (
        "{polygon: [[0, -0.1], [1, -0.1], [1, 0.1], [0, 0.1]], length: 0.05}",
        "{polygon: [[0, -0.1], [0.5, -0.1], [0.3, 0.1], [0, 0.1]], length: 0.05}",
        "{polygon: [[0.5, -0.1], [1, -0.1], [1, 0.1], [0.3, 0.1]], length: 0.05}",
        [0.4, 0, 0], [1, 1, 0],
    ),
    "plate with a hole": (
        "{polygon: [[0, -0.1], [1, -0.1], [1, 0.1], [0, 0.1]], length: 0.05}, "
        "{box: [0.2, 0.1, 0.05], at: [0.5, 0, 0], hole: true}",
        "{polygon: [[0, -0.1], [0.45, -0.1], [0.45, 0.1], [0, 0.1]], length: 0.05}, "
        "{box: [0.05, 0.1, 0.05], at: [0.425, 0, 0], hole: true}",
        "{polygon: [[0.45, -0.1], [1, -0.1], [1, 0.1], [0.45, 0.1]], length: 0.05}, "
        "{box: [0.15, 0.1, 0.05], at: [0.525, 0, 0], hole: true}",
        [0.45, 0, 0], [1, 0, 0],
    ),
    "bar with a ball": (
        "{box: [0.5, 0.05, 0.05], at: [0.25, 0, 0]}, {sphere: 0.2, at: [0.7, 0, 0], density: 3000}",
        "{box: [0.3, 0.05, 0.05], at: [0.15, 0, 0]}",
        "{box: [0.2, 0.05, 0.05], at: [0.4, 0, 0]}, {sphere: 0.2, at: [0.7, 0, 0], density: 3000}",
        [0.3, 0, 0], [1, 0, 0],
    ),
}  # fmt: skip


def ends(name):
    """Places on the piece that stays and on that beyond, well apart from the section."""
    *_, station, normal = PIECES[name]
    n = np.array(normal) / np.linalg.norm(normal)
    return (station - 0.2 * n).tolist(), (station + 0.2 * n).tolist()


def scene(name, split, more=STEEL, scaled="", frame=None, totals=""):
    """A body on a ball joint, that spins, is pushed at its end and carries a bob there."""
    whole, rest, part, station, normal = PIECES[name]
    foot, tip = ends(name)
    near, far = ("rest", "part") if split else ("body", "body")
    masses = {"rest": more, "part": more, "body": more + scaled}
    bodies = {"rest": rest, "part": part} if split else {"body": whole}
    listed = "".join(f"\n  {n}: {{{masses[n]}shape: [{of}]}}" for n, of in bodies.items())
    cut = f"cut: {{type: fixed, bodies: [rest, part], at: {station}}}" if split else ""
    sensor = (
        f"sensors: {{cut: {{type: section, body: body, at: {station}, axis: {normal}, "
        "x_axis: [0, 0, 1]}}\n"
    )
    return f"""
planar: false
{f"frame: {json.dumps(frame)}" if frame else ""}
gravity: [0.5, -9.81, 1]
bodies:{listed}
  bob: {{mass: 2, inertia: [0.02, 0.03, 0.04], at: {[tip[0], tip[1] + 0.1, tip[2] + 0.2]},
        velocity: [0, 1, 0]}}
joints:
  root: {{type: spherical, bodies: [ground, {near}], at: {foot}}}
  ball: {{type: spherical, bodies: [{far}, bob], at: {tip}}}
  {cut}
forces:
  push: {{type: applied_load, body: {far}, at: {tip}, frame: {far}, direction: [1, 2, 3],
         force: "90*sin(9*t)"}}
  hold: {{type: bushing, bodies: [ground, {near}], at: {foot}, stiffness: [0, 0, 0],
         rotational_stiffness: [20, 30, 40]}}
{totals}
{"" if split else sensor}
solver: {{end: 0.4, tolerance: 1e-12}}
output: {{every: 0.02, channels: ["*", "*.rotation"]}}
"""


def axes(normal):
    z = np.array(normal) / np.linalg.norm(normal)
    x = np.array((0.0, 0.0, 1.0))
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(z, x), z])


def check(one, two, normal, within=1e-9):
    """The section against the reaction of the joint, seen in the axes of the section."""
    E = axes(normal)
    R = two["part.rotation"].reshape(-1, 3, 3)
    for mine, other in (("force", "reaction"), ("moment", "reaction_moment")):
        want = np.einsum("ab,ncb,nc->na", E, R, two[f"cut.{other}"])
        size = np.abs(want).max()
        assert size > 1.0
        assert one[f"cut.{mine}"] == pytest.approx(want, abs=within * size), mine


@pytest.mark.parametrize("name", PIECES)
def test_is_the_reaction_of_a_joint_between_the_pieces(name):
    one, two = run(scene(name, False)), run(scene(name, True))
    assert np.abs(one["body.angular_velocity"]).max() > 0.1
    check(one, two, PIECES[name][4])


def test_in_a_turned_frame():
    """Body axes are those of the frame, and so are shape, station and normal."""
    frame = {"at": [5, -3, 2], "x_axis": [1, 2, 2], "y_axis": [0, 1, -1]}
    name = "plate cut at an angle"
    check(run(scene(name, False, frame=frame)), run(scene(name, True, frame=frame)),
          PIECES[name][4])  # fmt: skip


def test_a_mass_scales_the_part():
    """The same with a density that gives this mass."""
    name = "plate with a hole"
    volume = (1 * 0.2 - 0.2 * 0.1) * 0.05
    one = run(scene(name, False, more="", scaled="mass: 20 kg, "))
    two = run(scene(name, True, more=f"density: {20 / volume!r}, "))
    check(one, two, PIECES[name][4])


def test_axes_of_the_body_that_are_turned():
    """The tensor of the part is put into the axes of the body, whatever their angle."""
    name = "plate cut at an angle"
    one = run(scene(name, False, scaled="angle: 40 deg, "))
    check(one, run(scene(name, True)), PIECES[name][4])


def own(text, name="cut"):
    """The packed row of a section by its columns."""
    from trsim.elements.section import Own

    (one,) = (i for i in built(text).instances if i.name == name)
    return Own.of(one.row), one.row


def test_a_total_scales_the_part():
    text = scene("box", False)
    before, _ = own(text)
    total = "totals: {all: {bodies: [body, bob], mass: 100 kg, remainder: body}}"
    after, row = own(scene("box", False, totals=total))
    weighed = 7850 * 0.02
    assert before.mass == pytest.approx(0.6 * weighed, rel=1e-13)
    assert after.mass == pytest.approx(0.6 * 98.0, rel=1e-13)
    scale = 98.0 / weighed
    assert after.inertia == pytest.approx([scale * x for x in before.inertia], rel=1e-12)
    assert after.centre == pytest.approx(before.centre, abs=1e-14)
    assert row.said.startswith("58.8 kg of body beyond it, centre at [0.7, 0, 0] m, from its shape")
    (note,) = (n for n in built(scene("box", False, totals=total)).notes if "shape" in n)
    assert "sensors.cut.body: inertia of 'body' are not those of its shape" in note


def test_which_side_is_beyond():
    one, row = own(scene("box", False))
    assert row.said.endswith("acted on by ball, push")
    other, back = own(scene("box", False).replace("axis: [1, 0, 0]", "axis: [-1, 0, 0]"))
    assert one.mass + other.mass == pytest.approx(7850 * 0.02, rel=1e-13)
    assert back.said.endswith("acted on by root, hold")
    assert "62.8 kg of body beyond it, centre at [0.2, 0, 0] m" in back.said


REST = """
planar: false
gravity: [0, 0, -10]
bodies: {part: {density: 1000, shape: [SHAPE]}}
joints: {wall: {type: fixed, bodies: [ground, part], at: [-1, 0, 0]}}
sensors: {cut: {type: section, body: part, at: [0, 0, 0], axis: [1, 0, 0], x_axis: [0, 0, 1]}}
solver: {end: 0.01}
"""


@pytest.mark.parametrize("shape, mass, centre", [
    ("{sphere: 0.6}", 1000 * 2 / 3 * pi * 0.027, 3 * 0.3 / 8),
    ("{cylinder: 0.6, length: 2}", 1000 * pi * 0.09, 4 * 0.3 / 3 / pi),  # cut along its axis
    ("{cylinder: 0.6, length: 2, axis: [1, 0, 0]}", 1000 * pi * 0.09, 0.5),
    ("{polygon: [[-1, 0], [1, 0], [1, 1], [-1, 1]], length: 0.1}", 100, 0.5),
    ("{box: [2, 0.1, 0.1], at: [-1.5, 0, 0]}", 0.0, None),
])  # fmt: skip
def test_weights_of_halves_at_rest(shape, mass, centre):
    """What lies beyond hangs on the section: its weight, and the moment of it."""
    r = run(REST.replace("SHAPE", shape))
    assert r["cut.force"][-1] == pytest.approx([10 * mass, 0, 0], abs=1e-9)
    if centre is not None:  # y of the section is z x x: [1, 0, 0] x [0, 0, 1] = -y of the world
        bending = r["cut.moment"][-1]
        assert bending[1] == pytest.approx(10 * mass * centre, rel=1e-12)


def test_in_the_plane():
    """A rod in the plane with one inertia from its shape: 6 numbers, of which z counts."""
    text = """
bodies: {rod: {density: 1000, shape: [{box: [1, 0.1, 0.1], at: [0.5, 0]}]}}
joints: {pin: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
sensors: {cut: {type: section, body: rod, at: [0.4, 0], axis: [1, 0, 0], x_axis: [0, 1, 0]}}
initial: {pin.rate: 10}
solver: {end: 0.1, tolerance: 1e-12}
"""
    r = run(text)
    assert r.mechanism.planar
    # 6 kg at 0.7 m are held on their circle
    assert r["cut.force"] == pytest.approx(
        np.tile([0, 0, -6 * 0.7 * 100.0], (len(r.t), 1)), abs=1e-8
    )


@pytest.mark.parametrize("old, new, message", [
    ("density: 1000, shape: [SHAPE]", "mass: 1, inertia: [1, 1, 1]",
     "sensors.cut: nothing tells what lies beyond the section"),
    ("axis: [1, 0, 0], x", "axis: [1, 0, 0], centre: [1, 0, 0], x",
     "sensors.cut: `centre` and `inertia` go with the `mass` of the part beyond"),
    ("SHAPE", "{box: [1, 1, 1], at: [-2, 0, 0]}, {box: [0.1, 0.1, 0.1], at: [1, 0, 0], hole: true}",
     "beyond the section its holes take away more than there is"),
    ("axis: [1, 0, 0], x", "axis: [1, 0, 0], mass: 1, x", "a part with mass needs its `centre`"),
])  # fmt: skip
def test_refused(old, new, message):
    text = REST.replace(old, new).replace("SHAPE", "{box: [2, 1, 1]}")
    with pytest.raises(TrsimError) as caught:
        built(text)
    found = caught.value.show()
    assert message in found.replace("\n", " "), found


def test_all_of_a_body_may_lie_beyond():
    text = REST.replace("SHAPE", "{box: [1, 1, 1], at: [3, 0, 0]}")
    r = run(text.replace("at: [-1, 0, 0]", "at: [-2, 0, 0]"))
    assert r["cut.force"][-1] == pytest.approx([1e4, 0, 0], rel=1e-12)


def test_a_centre_that_is_given_is_told():
    text = REST.replace("density: 1000,", "density: 1000, at: [0.1, 0, 0],")
    text = text.replace("SHAPE", "{box: [2, 1, 1]}")
    (note,) = built(text).notes
    assert "centre of 'part' are not those of its shape" in note
