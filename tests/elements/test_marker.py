"""Markers: where a point of a body is and how it moves, and who may name it."""

import json

import numpy as np
import pytest

from trsim.analyse.pair import MOTION
from trsim.assemble.assemble import assemble
from trsim.errors import TrsimError
from trsim.scenario.explain import explained
from trsim.scenario.lint import lint
from trsim.scenario.load import loads, valid
from trsim.scenario.memory import Memory
from trsim.sweeps.plan import plan

from ..runs import built, run

ALL = 'output: {channels: ["*", "*.rotation"]}\n'
SPUN = """
points:
  tip: {body: BODY, at: [1000.9, 2000.4, 0.3]}
  post: {body: ground, at: [1, 2, 3], x_axis: [0, 2, 0], y_axis: [-1, 5, 0]}
bodies:
  flywheel: {mass: 2, inertia: [0.3, 0.3, 0.5], at: [1000.4, 2000.1, 0.3], angle: 0.7}
  other: {mass: 1, inertia: [1, 1, 1], at: [5, 5, 5], velocity: [0, 0, 1]}
joints:
  pin: {type: revolute, bodies: [PAIR], at: [1000, 2000, 0], axis: [AXIS]}
drives: {motor: {joint: pin, velocity: "SIGN*(5 + 60*t)"}}
solver: {end: 1, tolerance: 1e-10}
"""


def turned(axis, angle):
    """Rotation matrices about a unit axis, (n, 3, 3)."""
    K = np.cross(np.array(axis), np.eye(3)).T
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + s * K + (1.0 - c) * K @ K


@pytest.mark.parametrize("pair, sign", [("ground, flywheel", 1), ("flywheel, ground", -1)])
@pytest.mark.parametrize("axis, planar", [("0, 0, 1", True), ("2, -1, 2", False)])
def test_a_point_of_a_spinning_body(pair, sign, axis, planar):
    """a = alpha x p + omega x (omega x p), over five turns, about any axis, first body or not."""
    text = SPUN.replace("BODY", "flywheel").replace("PAIR", pair).replace("AXIS", axis)
    text = text.replace("SIGN", str(sign))
    if planar:
        text = text.replace(", velocity: [0, 0, 1]", "").replace("2000, 0]", "2000, 0.3]")
    r = run(text + ALL)
    assert r.mechanism.planar == planar
    n = np.array([float(c) for c in axis.split(",")])
    n /= np.linalg.norm(n)
    phi, omega, alpha = 5 * r.t + 30 * r.t**2, 5 + 60 * r.t, 60.0
    R = turned(n, phi)
    p, pin = R @ np.array([0.9, 0.4, 0.3]), np.array([1000.0, 2000.0, 0.0])
    v = omega[:, None] * np.cross(n, p)
    a = alpha * np.cross(n, p) + omega[:, None] * np.cross(n, v)
    assert r["tip.position"] == pytest.approx(p + pin, abs=1e-7)
    assert r["tip.velocity"] == pytest.approx(v, abs=1e-5)
    assert r["tip.acceleration"] == pytest.approx(a, abs=1e-3)
    assert r["tip.rotation"].reshape(-1, 3, 3) == pytest.approx(R, abs=1e-7)


def test_a_point_of_the_ground_stays_and_has_the_axes_it_was_given():
    text = SPUN.replace("BODY", "flywheel").replace("PAIR", "ground, flywheel")
    r = run(text.replace("AXIS", "0, 0, 1").replace("SIGN", "1") + ALL, "solver.end=0.01")
    assert np.array_equal(r["post.position"][-1], [1.0, 2.0, 3.0])
    assert not r["post.velocity"].any() and not r["post.acceleration"].any()
    axes = r["post.rotation"][-1].reshape(3, 3)
    expected = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1.0]])  # x, y, z
    assert pytest.approx(expected, abs=1e-15) == axes.T


TUMBLING = """
planar: false
points: {tip: {body: rod, at: [0.4, 0.5, -0.6], x_axis: [1, 1, 0], y_axis: [0, 0, 1]}}
bodies:
  rod: {mass: 2, inertia: [0.02, 0.03, 0.04, 0.001, 0.002, -0.003], at: [0.1, 0.2, 0.3], angle: 0.7,
        velocity: [1, 0, 2], angular_velocity: [3, 1, -2]}
gravity: [0, 0, -9.81]
solver: {end: 0.5, tolerance: 1e-11}
output: {every: 1e-3, channels: ["*", "*.rotation"]}
"""


def test_velocity_and_acceleration_are_rates_of_a_tumbling_body():
    """By differences of what the body itself records, and of the rows before."""
    r = run(TUMBLING)
    R = r["rod.rotation"].reshape(-1, 3, 3)
    s = R[0].T @ np.array([0.3, 0.3, -0.9])
    assert r["tip.position"] == pytest.approx(r["rod.position"] + R @ s, abs=1e-12)
    for one, rate in (("position", "velocity"), ("velocity", "acceleration")):
        slope = (r[f"tip.{one}"][2:] - r[f"tip.{one}"][:-2]) / 2e-3
        size = np.abs(r[f"tip.{rate}"]).max()
        assert slope == pytest.approx(r[f"tip.{rate}"][1:-1], abs=2e-5 * size)
    axes = R @ R[0].T @ np.array([[0.5**0.5, 0, 0.5**0.5], [0.5**0.5, 0, -(0.5**0.5)], [0, 1, 0]])
    assert r["tip.rotation"].reshape(-1, 3, 3) == pytest.approx(axes, abs=1e-12)


def test_a_point_of_a_flexible_bar_is_at_a_node():
    bar = """
points: {tip: {body: bar, at: [1, 0, 0]}, off: {body: ground, at: [0, 0]}}
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {diameter: 20 mm},
        youngs_modulus: 10 MPa, density: 1000 kg/m^3}
joints: {hinge: {type: spherical, bodies: [ground, bar], at: [0, 0]}}
gravity: [0, GRAVITY]
solver: {end: 0.05, tolerance: 1e-6}
output: {every: 1 ms}
"""
    for gravity in ("-9.81, 0", "-9.81, 1"):
        r = run(bar.replace("GRAVITY", gravity))
        assert np.array_equal(r["tip.position"], r["bar.node4.position"])
        assert np.abs(r["tip.velocity"][-1]).max() > 0.1
        assert "tip.rotation" not in r.place
    with pytest.raises(TrsimError, match="node"):
        built(bar.replace("GRAVITY", "-9.81").replace("at: [1, 0, 0]", "at: [0.9, 0]"))


@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_node_of_a_falling_bar_accelerates_as_all_of_it(planar):
    r = run(f"""
planar: {planar}
points: {{tip: {{body: bar, at: [1, 0, 0]}}}}
bodies:
  bar: {{type: ancf_cable, start: [0, 0], end: [1, 0], elements: 2, section: {{diameter: 20 mm}},
        youngs_modulus: 10 MPa, density: 1000 kg/m^3}}
gravity: [3, -9.81, {0 if planar == "true" else 2}]
solver: {{end: 2 ms, tolerance: 1e-6}}
output: {{every: 1 ms}}
""")
    falls = [3.0, -9.81, 0.0 if planar == "true" else 2.0]
    assert r["tip.acceleration"] == pytest.approx(np.tile(falls, (len(r.t), 1)), abs=1e-6)


# --- who names it ----------------------------------------------------------------------------

PLACES = """
bodies:
  arm: {mass: 2, inertia: [0.1, 0.1, 0.1], at: [0.5, 0.1]}
  rod: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [1.0, 0.7]}
joints:
  pin: {type: revolute, bodies: [ground, arm], at: %ORIGIN%, axis: %Z%}
  elbow: {type: revolute, bodies: [arm, rod], at: %TIP%, axis: %Z%}
sensors:
  way: {type: displacement, bodies: [ground, rod], at: %TIP%, axis: %X%}
forces:
  push: {type: applied_load, body: arm, at: %TIP%, frame: arm, direction: %X%, force: 3}
  spring: {type: spring_damper, bodies: [ground, arm], points: [%ORIGIN%, %TIP%], stiffness: 50}
  soft: {type: bushing, bodies: [ground, rod], at: %TIP%, x_axis: %X%, stiffness: [9, 0, 0]}
  stop: {type: limit_stop, point: {body: arm, at: %TIP%}, stiffness: 1000,
         wall: {body: ground, at: %ORIGIN%, normal: %X%}}
gravity: [0, -9.81]
solver: {end: 0.3}
"""
POINTS = """
points:
  origin: {body: ground, at: [0.2, 0.1]}
  tip: {body: arm, at: [1, 0.2], x_axis: [3, 4, 0], y_axis: [0, 1, 0]}
"""
NUMBERS = {"ORIGIN": "[0.2, 0.1, 0]", "TIP": "[1, 0.2]", "X": "[0.6, 0.8]", "Z": "[0, 0, 1]"}
NAMES = {"ORIGIN": "origin", "TIP": "tip", "X": "tip.x", "Z": "tip.z"}


def put(text, words):
    for word, meant in words.items():
        text = text.replace(f"%{word}%", meant)
    return text


def test_what_names_a_point_means_its_numbers():
    """The same motion to the last bit; and a point that is only looked at changes nothing."""
    named, given = run(POINTS + put(PLACES, NAMES)), run(put(PLACES, NUMBERS))
    assert named.mechanism.model.size == given.mechanism.model.size
    assert len(named.t) == len(given.t) and named.place.keys() > given.place.keys()
    for name in given.place:
        assert np.array_equal(named[name], given[name]), name
    there = named["tip.position"] - named["arm.position"]
    assert np.linalg.norm(there, axis=1) == pytest.approx(np.hypot(0.5, 0.1), rel=1e-12)


def test_a_point_far_away_changes_no_step():
    far = "points: {star: {body: ground, at: [1e6, 0]}, aside: {body: arm, at: [1e4, 0]}}\n"
    one, two = run(far + put(PLACES, NUMBERS)), run(put(PLACES, NUMBERS))
    assert np.array_equal(one["rod.position"], two["rod.position"])
    assert one.outcome.statistics["steps"] == two.outcome.statistics["steps"]


def test_only_what_is_asked_for_is_measured():
    def measured(*channels):
        text = POINTS + put(PLACES, NAMES)
        made = built(text, f"output.channels={json.dumps(channels)}")
        wanted = made.model.wanted >= 0
        return {i.name for i, one in zip(made.instances, wanted, strict=True) if one}

    assert measured("way") & {"tip", "origin"} == set()
    assert measured("tip.velocity") & {"tip", "origin"} == {"tip"}


def test_a_body_may_be_where_a_point_is():
    text = "points: {c: {body: b, at: [1, 2, 3]}}\nbodies: {b: {mass: 1, inertia: 1, at: c}}\n"
    assert loads(text).bodies["b"].at == (1.0, 2.0, 3.0)


SEEN = """
planar: false
points: {{seat: {{body: ground, at: [1, 2, 3], x_axis: [0, 1, 0], y_axis: [0, 0, 1]}}}}
bodies:
  arm: {{mass: 1, inertia: [0.1, 0.2, 0.3], at: {0}, velocity: {1}}}
joints:
  pivot: {{type: revolute, bodies: [ground, arm], at: {2}, axis: {3}}}
forces:
  push: {{type: applied_load, body: arm, at: {4}, direction: {5}, force: 3}}
solver: {{end: 0.1 s}}
"""


def test_places_and_directions_seen_from_a_point():
    """x of the seat is y of the world, y is z, and so z is x."""
    seen = SEEN.format(
        "{in: seat, at: [0.1, 20 cm, 0.3]}", "{in: seat, at: [0, 0, 2]}", "{in: seat, at: [0, 0]}",
        "{in: seat, at: [0, 1, 0]}", "{in: seat, at: [1, 0, 0]}", "{in: seat, at: [2, 0, 1]}",
    )  # fmt: skip
    world = SEEN.format(
        "[1.3, 2.1, 3.2]", "[2, 0, 0]", "[1, 2, 3]", "[0, 0, 1]", "[1, 3, 3]", "[1, 2, 0]"
    )
    one, two = loads(seen), loads(world)
    for section, name in (("bodies", "arm"), ("joints", "pivot"), ("forces", "push")):
        for key, value in getattr(one, section)[name]:
            other = getattr(getattr(two, section)[name], key)
            if isinstance(value, tuple) and not isinstance(value[0], str):
                np.testing.assert_allclose(value, other, atol=1e-15)


def test_points_of_an_instance_are_those_that_its_entries_see():
    text = """
planar: false
templates:
  leg:
    points: {foot: {body: rod, at: [1, 0, 0], x_axis: [0, 0, 1], y_axis: [1, 0, 0]}}
    bodies: {rod: {mass: 1, inertia: [1, 1, 1], at: {in: foot, at: [0, -0.5, 0]}}}
instances:
  left: {template: leg, frame: {at: [0, 5, 0], x_axis: [0, 1, 0], y_axis: [-1, 0, 0]}}
"""
    assert loads(text).bodies["left_rod"].at == pytest.approx((0.0, 5.5, 0.0))


@pytest.mark.parametrize(
    ("at", "said"),
    [
        ("{in: seat}", "field required: at"),
        ("{at: [0, 0]}", "field required: in"),
        ("{in: set, at: [0, 0]}", "Did you mean 'seat'?"),
        ("{in: 3, at: [0, 0]}", "must be the name of a point"),
        ("{in: seat, at: [0]}", "must be [x, y]"),
        ("{in: seat, at: [0, 1 kg]}", "kg"),
        ("{in: seat, at: seat}", "must be [x, y]"),
        ("{in: seat, at: [0, 0], of: 3}", "unknown key"),
    ],
)
def test_what_is_not_seen_from_a_point(at, said):
    text = SEEN.format(at, "[0, 0, 0]", "[0, 0]", "[0, 0, 1]", "[0, 0]", "[1, 0]")
    with pytest.raises(TrsimError) as error:
        loads(text)
    assert said in error.value.problems[0].show()


def test_sections_and_portraits_of_a_point():
    text = """
points: {tip: {body: arm, at: [1, 0]}}
bodies: {arm: {mass: 1, inertia: 1, at: [0.5, 0]}}
joints: {pin: {type: revolute, bodies: [ground, arm], at: [0, 0]}}
drives: {motor: {joint: pin, velocity: 10}}
poincare: {up: {when: tip.position.y, crosses: up, plot: [tip.position.x, tip.velocity.y]}}
solver: {end: 2, tolerance: 1e-9}
"""
    points = run(text).section("up")
    assert points[:, 0] == pytest.approx(2 * np.pi * np.arange(1, 4) / 10, rel=1e-7)
    assert points[:, 1:] == pytest.approx(np.tile([1.0, 10.0], (3, 1)), rel=1e-7)
    assert {"position", "velocity"} <= {*MOTION}


# --- instances -------------------------------------------------------------------------------

TEMPLATE = """
points: {hook: {body: ground, at: [0, 0, 7]}}
templates:
  chain:
    parameters: {l: 0.5}
    points:
      tip: {body: rod, at: [l, 0, 0]}
    bodies:
      rod: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.2, 0]}
    joints:
      pin: {type: spherical, bodies: [ground, rod], at: [0, 0]}
    forces:
      push: {type: applied_load, body: rod, at: tip, direction: tip.y, force: 3}
      pull: {type: spring_damper, bodies: [ground, rod], points: [hook, tip], stiffness: 4}
instances:
  a: {template: chain}
  b: {template: chain, parameters: {l: 2}, points: {tip: {x_axis: [0, 0, 1]}},
      frame: {at: [0, 0, 1], x_axis: [0, 1, 0], y_axis: [-1, 0, 0]}}
gravity: [0, 0, -9.81]
solver: {end: 0.1}
"""


def test_points_of_templates():
    s = loads(TEMPLATE)
    assert list(s.points) == ["hook", "a_tip", "b_tip"]
    assert s.points["b_tip"].body == "b_rod"
    assert s.points["a_tip"].at == (0.5, 0.0, 0.0)
    assert s.points["b_tip"].at == pytest.approx((0.0, 2.0, 1.0))
    assert s.points["b_tip"].x_axis == pytest.approx((0.0, 0.0, 1.0))
    assert s.forces["a_push"].direction == (0.0, 1.0, 0.0)
    assert s.forces["b_push"].at == pytest.approx((0.0, 2.0, 1.0))  # not moved twice
    assert s.forces["b_push"].direction == pytest.approx((-1.0, 0.0, 0.0))
    assert s.forces["b_pull"].points[0] == (0.0, 0.0, 7.0)  # the scenario's stays where it is
    r = run(TEMPLATE)
    far = np.linalg.norm(r["b_tip.position"] - [0, 0, 1], axis=1)
    assert far == pytest.approx(2.0, abs=1e-7)


def test_cases_of_a_sweep_that_move_a_point(tmp_path):
    """What is remembered from case to case depends on the points its text names."""
    data = {
        "points": {"p": {"body": "ground", "at": [1, 0]}},
        "bodies": {"b": {"mass": 1, "inertia": 1}},
        "joints": {"j": {"type": "revolute", "bodies": ["ground", "b"], "at": "p"}},
    }
    memory = Memory()
    assert valid(data, memory)
    assert valid({**data, "points": {"p": {"body": "ground", "at": [2, 0]}}}, memory)
    places = {spec.at for key, spec in memory.made.items() if key[0] == "joints"}
    assert places == {(1.0, 0.0, 0.0), (2.0, 0.0, 0.0)}
    path = tmp_path / "a.yaml"
    path.write_text(TEMPLATE + "sweep: {points.hook.at: [[0, 0, 7], [0, 0, 8]]}\n")
    found = plan(path)
    assert [found.scenario(c).forces["a_pull"].points[0][2] for c in found.cases] == [7.0, 8.0]


# --- wrong -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "old, new, what, hint",
    [
        ("at: %TIP%, axis: %Z%", "at: tipp, axis: tip.z", "no point named 'tipp'",
         "Did you mean 'tip'?"),
        ("frame: arm, direction: %X%", "frame: arm, direction: tip",
         "an axis of a point, got 'tip'", "tip.x, tip.y and tip.z"),
        ("frame: arm, direction: %X%", "frame: arm, direction: tap.x", "no point named 'tap'",
         "Did you mean 'tip'?"),
        ("frame: arm, direction: %X%", "frame: arm, direction: tip.w", "got 'tip.w'", "tip.x"),
        ("body: arm, at: %TIP%, frame", "body: arm, at: tip.x, frame",
         "or the name of a point, got 'tip.x'", ""),
        ("body: arm, at: %TIP%, frame", "body: arm, at: 3 mm, frame", "got '3 mm'", ""),
    ],
)  # fmt: skip
def test_a_name_that_is_none(old, new, what, hint):
    text = put(PLACES.replace(old, new), NAMES)
    line = 1 + (POINTS + text).split("\n").index(
        next(row for row in text.split("\n") if new in row)
    )
    with pytest.raises(TrsimError) as caught:
        loads(POINTS + text, name="a.yaml")
    shown = caught.value.show()
    assert what in shown and hint in shown and f"a.yaml:{line}:" in shown


@pytest.mark.parametrize(
    "points, what",
    [
        ("tip: {body: arm}", "points.tip: field required: at (m)"),
        ("tip: {at: [1, 0]}", "points.tip: field required: body"),
        ("tip: {body: arm, at: [1]}", "points.tip.at: must be [x, y] or [x, y, z]"),
        ("tip: {body: arm, at: [1, 0], x_axis: [0, 0]}", "points.tip.x_axis: an axis must not be"),
        ("tip: {body: arm, at: [1, 0], x_axis: [0, 3]}", "points.tip.y_axis: y_axis is parallel"),
        ("tip: {body: arm, at: [1, 0], axis: [0, 3]}", "points.tip: unknown key 'axis'"),
        ("tip: {body: arm, at: origin}, origin: {body: ground, at: [0, 0]}", "got 'origin'"),
        (
            "tip: {body: arm, at: [1, 0]}, arm: {body: arm, at: [1, 0]}",
            "the name 'arm' is taken by points.arm",
        ),
        ("tip: {type: sensor, body: arm, at: [1, 0]}", "points.tip.type: unknown type 'sensor'"),
    ],
)
def test_points_that_are_none(points, what):
    """Each is told once: what names such a point is not wrong as well."""
    named = put(PLACES, NAMES | {"ORIGIN": "[0, 0]"})
    with pytest.raises(TrsimError) as caught:
        loads(f"points: {{{points}}}\n{named}", name="a.yaml")
    assert what in caught.value.show() and len(caught.value.problems) == 1


def test_a_point_of_nobody():
    scenario = loads("points: {tip: {body: arm, at: [1, 0]}}\nbodies: {ram: {mass: 1, inertia: 1}}")
    with pytest.raises(TrsimError) as caught:
        assemble(scenario)
    assert caught.value.path == ("points", "tip", "body")
    assert "no body named 'arm'" in caught.value.what and "'ram'" in caught.value.hint


def test_a_point_of_another_body_is_told():
    text = POINTS + put(PLACES, NAMES)
    assert not [note for note in lint(loads(text)) if "a point of" in note]
    of_rod = lint(loads(text.replace("tip: {body: arm", "tip: {body: rod")))
    found = [note.split(":")[0] for note in of_rod if "a point of 'rod'" in note]
    assert found == ["forces.push.at", "forces.spring.points", "forces.stop.point.at"]
    of_rod = lint(loads(TEMPLATE.replace("body: rod, at: tip", "body: rod, at: hook")))
    assert not [note for note in of_rod if "a point of" in note]


def test_explain_knows_points():
    [page] = explained("points")["sections"]
    assert page["elements"] == ["marker"]
    [page] = explained("marker")["elements"]
    assert [c["name"] for c in page["channels"]][:2] == ["NAME.position", "NAME.velocity"]
    [key] = explained("applied_load.at")["keys"]
    assert key["type"] == "[x, y] or [x, y, z] or name of a point or these relative to a point"
    [key] = explained("revolute.axis")["keys"]
    assert key["type"] == "[x, y] or [x, y, z] or axis of a point or these relative to a point"
    json.dumps(explained("points"))


def test_an_x_axis_along_y_needs_a_y_axis():
    """The other axis is that of the world unless given: the hint says so."""
    text = """
points: {tip: {body: arm, at: [0, 0], x_axis: [0, 1]}}
bodies: {arm: {mass: 1, inertia: 1}}
solver: {end: 1}
"""
    with pytest.raises(TrsimError, match="y_axis is parallel to x_axis") as caught:
        loads(text)
    assert "give `y_axis` too" in caught.value.problems[0].hint
    loads(text.replace("[0, 1]}", "[0, 1], y_axis: [-1, 0]}"))
