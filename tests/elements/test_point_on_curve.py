"""Point on curve: beads against closed forms and other joints, ends, and what is refused."""

import numpy as np
import pytest

from trsim.elements.limit_stop import LimitStop
from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import doubts

from ..comparing import approx
from ..runs import built, energy_error, run
from .bench import bench, check_gradient, check_power

G = 9.81
METHODS = {
    "dop853": ("tolerance: 1e-10", 1e-8),
    "radau": ("method: radau, tolerance: 1e-9", 1e-6),
    "ggl": ("method: radau, formulation: ggl, tolerance: 1e-9", 1e-6),
    "rk4": ("method: rk4, step: 1e-3", 1e-8),
    "generalized_alpha": ("method: generalized_alpha, tolerance: 1e-5", 1e-3),
}
SCIPY = {"scipy:RK45": ("method: 'scipy:RK45', tolerance: 1e-9", 1e-6)}
R = 0.4
CYCLOID = f"x: {R}*(s + sin(s)), y: {R}*(1 - cos(s)), range: [-2.7, 2.7]"
CIRCLE = f"x: {R}*sin(s), y: -{R}*cos(s), range: [0, 2*pi], closed: true"


def bead(curve, at, solver="tolerance: 1e-10", more="", end=3.0, **keys):
    """A bead of 2 kg on a wire of the ground."""
    given = {"planar": "true", "velocity": "[0, 0]", "where": ""} | keys
    return f"""
planar: {given["planar"]}
bodies:
  bead: {{mass: 2, inertia: [0.01, 0.02, 0.03], at: {at}, velocity: {given["velocity"]}}}
joints:
  wire: {{type: point_on_curve, bodies: [ground, bead], at: {at},
         curve: {{{given["where"]}{curve}}}}}
sensors: {{way: {{joint: wire}}}}
gravity: [0, -9.81, 0]
solver: {{end: {end}, {solver}}}
output: {{every: 0.01, channels: ["*"]}}
{more}
"""


def on_cycloid(s):
    return [float(R * (s + np.sin(s))), float(R * (1 - np.cos(s)))]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("s", [0.3, 2.4])
def test_a_cycloid_swings_alike_from_everywhere(method, s):
    """Its length from the bottom is 4 r sin(s/2), and swings like a spring: w^2 = g / (4 r)."""
    solver, error = METHODS[method]
    r = run(bead(CYCLOID, on_cycloid(s), solver))
    begin = 4 * R * np.sin(s / 2)
    way = begin * np.cos(np.sqrt(G / (4 * R)) * r.t)
    assert r["way"] + begin == approx(way, abs=error)
    assert r["wire.arc"] - 4 * R * np.sin(1.35) == approx(way, abs=error)
    assert r.outcome.status == "done" and energy_error(r) < 1e-5


@pytest.mark.parametrize("method", METHODS | SCIPY)
def test_round_a_circle_several_times(method):
    """Against a pendulum that turns over; the wire pushes as its pin does."""
    solver, error = (METHODS | SCIPY)[method]
    text = bead(CIRCLE, [0, -R], solver, velocity="[4.5, 0]")
    r = run(text)
    pin = text.replace("type: point_on_curve", "type: revolute").replace(
        f"at: [0, {-R}],\n         curve: {{{CIRCLE}}}", "at: [0, 0]"
    )
    # a body that does not turn on the wire turns with the rod
    pin = run(pin.replace("inertia: [0.01, 0.02, 0.03]", "inertia: 1e-9"))
    assert r["way"][-1] > 2.5 * 2 * np.pi * R
    assert r["way"] == approx(R * pin["way"], abs=20 * error)
    assert r["way.rate"] == approx(R * pin["way.rate"], abs=300 * error)
    assert r["bead.position"] == approx(pin["bead.position"], abs=20 * error)
    assert r["wire.reaction"] == approx(pin["wire.reaction"], abs=1e4 * error)
    assert not r["wire.reaction_moment"].any()


POINTS = [[-0.5, 0.3], [-0.2, 0.02], [0.1, 0.05], [0.3, -0.1], [0.6, 0.4]]


def test_it_stays_on_the_spline():
    from scipy.interpolate import CubicSpline

    text = bead(f"points: {POINTS}", POINTS[0], end=1.5, solver="tolerance: 1e-11",
                velocity="[0.5, -0.4667]").replace(str(POINTS[0]), "[-0.35, 0.144]", 2)  # fmt: skip
    r = run(text)
    p = np.array(POINTS)
    chords = np.append(0, np.cumsum(np.hypot(*np.diff(p, axis=0).T)))
    spline = CubicSpline(chords, p, bc_type="natural")
    fine = spline(np.linspace(0, chords[-1], 20001))
    for place in r["bead.position"][:, :2]:
        k = np.argmin(np.hypot(*(fine - place).T))
        s = np.linspace(0, chords[-1], 20001)[k]
        for _ in range(5):
            off, c1, c2 = place - spline(s), spline(s, 1), spline(s, 2)
            s += c1 @ off / (c1 @ c1 - c2 @ off)
        assert np.hypot(*(place - spline(s))) < 1e-10
    assert np.ptp(r["way"]) > 0.4 and energy_error(r) < 1e-9


SLOT = """
planar: {planar}
bodies:
  arm: {{mass: 3, inertia: [0.4, 0.3, 0.2], at: {middle}, angle: 0.8,
        angular_velocity: {spin}}}
  block: {{mass: 1, inertia: [0.01, 0.02, 0.03], at: {at}, angle: -0.5, velocity: {velocity}}}
joints:
  pin: {{type: revolute, bodies: [ground, arm], at: {pivot}, axis: {axis}}}
  slot: {{{slot}}}
sensors: {{turn: {{joint: pin}}, way: {{joint: slot}}}}
gravity: {gravity}
solver: {{end: 1.2, tolerance: 1e-11}}
output: {{every: 0.01, channels: ["*"]}}
"""
TILT = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])


@pytest.mark.parametrize("far", [0.0, 300.0])
@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("turn", [np.eye(3), TILT])
def test_a_straight_slot_is_an_inline_joint(turn, swapped, far):
    """On an arm that turns; in the plane and in space, either body first, far away."""
    place = far * np.array([0.6, -0.5, 0.3]) * np.array([1, 1, float(turn is TILT)])

    def world(*p):
        return (turn @ np.array(p) + place).tolist()

    def free(*v):
        return (turn @ np.array(v)).tolist()

    names = "[block, arm]" if swapped else "[arm, block]"
    line = free(0.8, 0.6, 0.0)
    given = {
        "planar": "false" if turn is TILT else "true", "middle": world(0.1, 0.05, 0),
        "at": world(0.4, 0.3, 0), "pivot": world(0, 0, 0), "axis": free(0, 0, 1),
        "spin": free(0, 0, 3), "velocity": (free(-0.9, 1.2, 0)), "gravity": free(2, -9, 0),
    }  # fmt: skip
    at = f"bodies: {names}, at: {given['at']}"
    curve = (
        f"curve: {{at: {world(-4, -3, 0)}, x_axis: {line}, y_axis: {free(-0.6, 0.8, 0.0)}, "
        "points: [[0, 0], [1.5, 0], [12, 0]]}"
    )
    r = run(SLOT.format(**given, slot=f"type: point_on_curve, {at}, {curve}"))
    i = run(SLOT.format(**given, slot=f"type: inline, {at}, axis: {line}"))
    assert r.mechanism.planar == i.mechanism.planar == (turn is not TILT)
    assert np.ptp(i["way"]) > 0.3 and np.ptp(i["turn"]) > 0.5
    error = 1e-8 * max(1.0, 0.1 * far)
    for name in ("way", "way.rate", "way.acceleration", "turn", "block.position", "slot.reaction"):
        assert r[name] == approx(i[name], abs=error * (100 if "reac" in name else 10)), name


def test_a_bead_on_a_hoop_that_turns():
    """About the vertical diameter at w it rests where cos(angle) = g / (w^2 r), and swings about
    that at w sin(angle)."""
    w, small = 8.0, 1e-4
    rest = np.arccos(G / (w**2 * R))
    at = [float(R * np.sin(rest + small)), float(-R * np.cos(rest + small)), 0]
    text = f"""
planar: false
bodies:
  hoop: {{mass: 3, inertia: [0.4, 0.3, 0.2], at: [0, 0, 0], angle: 0.3}}
  bead: {{mass: 2, inertia: [0.01, 0.01, 0.01], at: {at}}}
joints:
  shaft: {{type: revolute, bodies: [ground, hoop], at: [0, 0, 0], axis: [0, 1, 0]}}
  wire: {{type: point_on_curve, bodies: [hoop, bead], at: {at}, curve: {{{CIRCLE}}}}}
drives: {{motor: {{joint: shaft, velocity: {w}}}}}
sensors: {{way: {{joint: wire}}, turn: {{joint: shaft}}}}
gravity: [0, -9.81, 0]
solver: {{end: 3, tolerance: 1e-11}}
output: {{every: 0.01, channels: ["*"]}}
"""
    r = run(text)
    swing = small * np.cos(w * np.sin(rest) * r.t)
    assert r["way"] / R + small == approx(swing, abs=small * 1e-2)
    assert r["turn"][-1] == approx(24, abs=1e-9)
    place = r["bead.position"]
    assert np.hypot(place[:, 0], place[:, 2]) == approx(
        R * np.sin(r["way"] / R + rest + small), abs=1e-9
    )


@pytest.mark.parametrize("method", METHODS)
def test_it_ends_where_its_curve_does(method):
    solver, error = METHODS[method]
    text = bead("points: [[0, 0], [1, -0.5], [2, -1]]", "[0.02, -0.01]", solver)
    r = run(text)
    assert r.outcome.status == "jammed"
    assert "wire" in r.outcome.reason and "end of its curve" in r.outcome.reason
    left = np.sqrt(5) - np.hypot(0.02, 0.01)
    assert r.outcome.time == approx(np.sqrt(2 * left / (G / np.sqrt(5))), abs=10 * error)


@pytest.mark.parametrize("solver", ["tolerance: 1e-3", "method: radau, tolerance: 1e-2"])
def test_long_steps_stay_on_their_piece(solver):
    """Without a force the bead goes round a figure of eight at one speed, through its crossing."""
    eight = "x: 0.5*sin(s), y: 0.2*sin(2*s), range: [0, 2*pi], closed: true"
    at = [float(0.5 * np.sin(0.7)), float(0.2 * np.sin(1.4))]
    speed = np.array([0.5 * np.cos(0.7), 0.4 * np.cos(1.4)])
    text = bead(eight, at, solver, end=20, velocity=(3 * speed / np.hypot(*speed)).tolist())
    r = run(text.replace("gravity: [0, -9.81, 0]", ""))
    assert r["way"] == approx(3 * r.t, rel=1e-2, abs=1e-2)
    assert r["way"][-1] > 20 * 2.5


def test_steps_are_bounded_by_what_the_tangent_turns():
    """As by angles that are known up to full turns."""
    m = built(bead(CIRCLE, [0, -R]))
    entries = [x.entry for x in m.coordinates.values() if x.joint == "wire"]
    assert len(m.model.wound) == 1 and {*m.model.wound} < {*entries}


def test_both_ends_end_it():
    r = run(bead(CYCLOID, on_cycloid(0.2), velocity="[-9, 0]"))
    assert r.outcome.status == "jammed" and r["bead.position"][-1, 0] < -1


def test_scipy_knows_no_ends():
    with pytest.raises(TrsimError, match="knows no events"):
        built(bead(CYCLOID, on_cycloid(0.2), "method: 'scipy:RK45'"))


STOP = "forces: {stop: {type: limit_stop, joint: wire, %s, stiffness: 1e5}}"


def test_a_stop_on_a_curve():
    """Without damping the bead comes back to where it was let go."""
    u = 2.0
    begin = 4 * R * (np.sin(u / 2) + np.sin(1.35))
    # the length counts from the left end, s = -2.7; the stop stands right of the bottom
    upper = 4 * R * (np.sin(1.35) + np.sin(0.4))
    text = bead(CYCLOID, on_cycloid(-u), more=STOP % f"upper: {upper}", end=4)
    r = run(text)
    assert energy_error(r) < 1e-8
    assert r["way"].max() == approx(upper - 4 * R * (np.sin(1.35) - np.sin(u / 2)), abs=0.02)
    w = np.sqrt(G / (4 * R))
    pressed = r.largest("stop.penetration")[0]
    assert 0 < pressed < 0.02
    # until the touch, and the touch itself by its energy: k d^2 / 2 = m (v^2 + w^2 ...) / 2
    x, amplitude = 4 * R * np.sin(0.4), 4 * R * np.sin(u / 2)
    speed = w * np.sqrt(amplitude**2 - x**2)
    assert pressed == approx(np.sqrt(2 / 1e5) * speed, rel=0.02)
    assert begin > upper
    force = r["stop.force"]
    assert np.hypot(force[:, 0], force[:, 1]) == approx(r["stop.normal_force"], abs=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_the_force_of_a_stop_is_the_gradient_of_its_energy(seed):
    """Also of a roller, and of a point that is off its curve."""
    from .test_constraints import CURVED

    for case in ("point_on_curve", "point_on_curve, by a formula", "cam", "cam, inside"):
        text = f"""
joints: {{joint: {{bodies: [left, right], type: {case.split(",")[0]}, {CURVED[case]}}}}}
forces: {{stop: {{type: limit_stop, joint: joint, upper: -9, stiffness: 3, damping: 0.2}}}}
"""
        b = bench(text, np.random.default_rng(seed))
        check_gradient(b)
        check_power(b)


def test_a_sensor_tells_place_and_rate():
    r = run(bead(CYCLOID, on_cycloid(0.3), more="""
poincare: {bottom: {when: way.rate, crosses: up, plot: [way, way.rate]}}
events: {half: {when: way, value: -0.1, do: {record: true}, crosses: down}}
"""))  # fmt: skip
    assert len(r.section("bottom")) == 1
    w2 = G / (4 * R)
    way = r["way"] + 4 * R * np.sin(0.15)
    assert r["way.acceleration"] == approx(-w2 * way, abs=1e-7)
    assert len(r.events)


REFUSED = {
    "driven": ("drives: {d: {joint: wire, velocity: 1}}", "length along it"),
    "locked": ("events: {e: {when: t, value: 1, do: {lock: [wire]}}}", "length along it"),
    "set": ("initial: {wire: 0.3}", "length along it"),
    "its rate set": ("initial: {wire.rate: 0.3}", "length along it"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_a_place_on_a_curve_is_not(what):
    more, said = REFUSED[what]
    with pytest.raises(TrsimError, match=said):
        built(bead(CYCLOID, on_cycloid(0.3), more=more))


DRAWN = {
    "far away": (CYCLOID, "[0.3, 1.2]", "the nearest such place is"),
    "between two pieces": (CIRCLE, "[0.0, 0.0001]", "away from where|as near"),
    "before it": ("points: [[0, 0], [1, 0]]", "[-0.05, 0]", "before the run begins"),
}


@pytest.mark.parametrize("what", DRAWN)
def test_how_it_must_be_drawn(what):
    curve, at, said = DRAWN[what]
    with pytest.raises(TrsimError, match=said):
        run(bead(curve, at))


def test_the_start_moves_it_onto_the_curve():
    """To the nearest place, where nothing else holds it."""
    r = run(bead(CIRCLE, "[0.33, -0.31]", end=0.01))
    assert np.hypot(*r["bead.position"][0, :2]) == approx(R, abs=1e-12)


FLEXIBLE = """
bodies:
  rod: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {diameter: 12 mm},
        youngs_modulus: 207 GPa, density: 7800}
  ball: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [1, -0.3]}
joints:
  clamp: {type: fixed, bodies: [ground, rod], at: [0, 0]}
  tie: %s
planar: %s
gravity: [1, -9.81, 0]
solver: {end: 0.05, tolerance: 1e-7}
output: {channels: ["*"], every: 0.01}
"""
ARC = "curve: {at: [1, 0], x: 0.3*sin(s), y: -0.3*cos(s), range: [-2, 2]}"
ON_BAR = f"{{type: point_on_curve, bodies: [rod, ball], at: [1, -0.3], {ARC}}}"


def test_on_a_flexible_bar():
    """A circle about its tip is a link, and its tip on a line an inline joint; in space a curve
    would turn with the bar about itself."""
    on_arc = run(FLEXIBLE % (ON_BAR, "true"))
    link = "{type: link, bodies: [rod, ball], points: [[1, 0], [1, -0.3]]}"
    assert on_arc["ball.position"] == approx(
        run(FLEXIBLE % (link, "true"))["ball.position"], abs=1e-8
    )
    line = "curve: {points: [[1.1, -1], [1, 0], [0.9, 1]]}"
    for planar in ("true", "false"):
        tip = f"{{type: point_on_curve, bodies: [ground, rod], at: [1, 0], {line}}}"
        rail = "{type: inline, bodies: [ground, rod], at: [1, 0], axis: [-0.1, 1]}"
        one, other = (run(FLEXIBLE % (joint, planar)) for joint in (tip, rail))
        assert one["rod.tip"] == approx(other["rod.tip"], abs=1e-9)
    with pytest.raises(TrsimError, match="nobody knows how it turns about itself"):
        built(FLEXIBLE % (ON_BAR, "false"))


def test_twice_the_same():
    """The second one holds nothing more, and is left out."""
    at = on_cycloid(0.3)
    same = f"same: {{type: point_on_curve, bodies: [ground, bead], at: {at}, curve: {{{CYCLOID}}}}}"
    once = bead(CYCLOID, at)
    twice = run(once.replace("joints:\n", f"joints:\n  {same}\n"))
    assert len(twice.mechanism.redundant) == 1
    assert twice["bead.position"] == approx(run(once)["bead.position"], abs=1e-9)


def test_a_rod_on_two_wires_comes_to_rest():
    """In equilibrium, on a parabola."""
    wire = "{type: point_on_curve, bodies: [ground, rod], at: %s, curve: {%s}}"
    parabola = "x: s, y: s**2, range: [-2, 2]"
    text = f"""
bodies: {{rod: {{mass: 2, inertia: 0.1, at: [0.1, 0.35]}}}}
joints:
  left: {wire % ("[-0.4, 0.16]", parabola)}
  right: {wire % ("[0.6, 0.36]", parabola)}
initial: {{equilibrium: all}}
gravity: [0, -9.81, 0]
solver: {{end: 0.1}}
"""
    r = run(text)
    assert r["rod.position"][0, 0] == approx(r["rod.position"][-1, 0], abs=1e-6)
    assert abs(r["rod.velocity"][-1]).max() < 1e-6


def test_released():
    r = run(bead(CYCLOID, on_cycloid(0.3), end=1, more="""
events: {off: {when: t, value: 0.1, do: {release: [wire]}}}
"""))  # fmt: skip
    assert r["bead.acceleration"][-1] == approx([0, -G, 0])
    assert r.outcome.status == "done"


def test_what_a_stop_holds_along_its_curve_is_not_released():
    more = """
forces: {end: {type: limit_stop, joint: wire, lower: 0.1, stiffness: 1e4}}
events: {off: {when: t, value: 0.1, do: {release: [wire]}}}
"""
    with pytest.raises(TrsimError) as error:
        run(bead(CYCLOID, on_cycloid(0.3), end=1, more=more))
    assert "'end' stops 'wire' along its curve" in str(error.value)


def test_a_stop_knows_its_kinds():
    assert LimitStop.type == "limit_stop"
    r = run(bead(CYCLOID, on_cycloid(0.3), end=0.1))
    assert doubts(r.scenario, r.mechanism, r.outcome) == ()
