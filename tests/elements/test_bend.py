"""The bend of a joint: sensors show it, stops limit it, events see it."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trsim.errors import TrsimError

from ..runs import built, energy_error, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power, now, put_right

JOINTS = {
    "spherical": "axis: [0.48, 0.6, 0.64], second_axis: [0.8, -0.1, 0.3]",
    "constant_velocity": "axis: [0.48, 0.6, 0.64], second_axis: [0.8, -0.1, 0.3]",
    "universal": "axis: [0, 0.8, -0.6], second_axis: [1, 0, 0], shafts: [[0.48, 0.6, 0.64], "
    "[0.8, -0.1, 0.3]]",
}
A, B = np.array([0.48, 0.6, 0.64]), np.array([0.8, -0.1, 0.3]) / np.sqrt(0.74)
PLACE = np.array([0.2, 0.1, 0.0])
DRAWN = np.arccos(A @ B)


def thrown(kind, forces, seed, turn=None):
    rng = np.random.default_rng(seed)
    joint = f"{{type: {kind}, bodies: [left, right], at: [0.2, 0.1, 0], {JOINTS[kind]}}}"
    b = bench(f"joints: {{joint: {joint}}}\n{forces}\nsensors: {{bend: {{joint: joint.bend}}}}\n",
              rng)  # fmt: skip
    if turn is not None:
        put_right(b, PLACE, np.array(turn), np.zeros(3))
    return b


STOP = "forces: {stop: {type: limit_stop, joint: joint.bend, upper: 0.05, lower: 0.01, %s}}"
LAW = "stiffness: 1e4, damping: 200, ramp: 0.01"


@pytest.mark.parametrize("kind", JOINTS)
@pytest.mark.parametrize("seed", range(3))
def test_a_stop_is_minus_the_gradient_and_the_book_closes(kind, seed):
    b = thrown(kind, STOP % LAW, seed)
    check_gradient(b, rel=3e-7)
    b.V *= 0.01
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[3] < 0.0


@pytest.mark.parametrize("kind", JOINTS)
def test_a_stop_turns_back_about_what_is_across_both_axes(kind):
    b = thrown(kind, STOP % LAW, 2, (0, 0, 0))
    b.V[:] = 0.0
    n = np.cross(A, B) / np.sin(DRAWN)
    wanted = -1e4 * (DRAWN - 0.05) * now(b, n)
    assert b.wrenches()[2, 3:] == pytest.approx(wanted, rel=1e-12)
    assert b.wrenches()[2, :3] == pytest.approx(0, abs=1e-12)


def test_below_its_lower_limit_it_opens():
    b = thrown("spherical", STOP.replace("0.05", "2").replace("0.01", "1.5") % LAW, 2, (0, 0, 0))
    b.V[:] = 0.0
    n = np.cross(A, B) / np.sin(DRAWN)
    assert b.wrenches()[2, 3:] == pytest.approx(1e4 * (1.5 - DRAWN) * now(b, n), rel=1e-12)


# --- in motion -------------------------------------------------------------------------------

AT = np.array([40.0, -20.0, 70.0])


def spun(kind, more, omega, bodies="ground, top", end=1.0, tolerance=1e-10):
    """A round body on a joint about its centre, far from the origin, its axis as drawn [1, 2, 2]/3;
    it turns evenly about a fixed axis."""
    axes = {
        "spherical": "axis: [1, 2, 2]",
        "constant_velocity": "axis: [1, 2, 2]",
        "universal": "axis: [2, 1, -2], second_axis: [2, -2, 1]",
    }[kind]
    return f"""
planar: false
bodies: {{top: {{mass: 3, inertia: [0.05, 0.05, 0.05], at: {AT.tolist()}, angle: 0.4,
               angular_velocity: {np.array(omega).tolist()}}}}}
joints: {{ball: {{type: {kind}, bodies: [{bodies}], at: {AT.tolist()}, {axes}}}}}
sensors: {{bend: {{joint: ball.bend}}}}
{more}
solver: {{end: {end}, tolerance: {tolerance}}}
output: {{every: 0.01, channels: ["*"]}}
"""


@pytest.mark.parametrize("bodies", ["ground, top", "top, ground"])
def test_a_sensor_on_a_ball_that_turns_evenly(bodies):
    """cos x = cos^2 c + sin^2 c cos(w t): an axis that goes round a cone of half angle c."""
    e = np.array([2.0, -1.0, 2.0]) / 3
    r = run(spun("spherical", "", 4.0 * e, bodies))
    cos_c = e @ np.array([1, 2, 2]) / 3
    share = cos_c**2 + (1 - cos_c**2) * np.cos(4 * r.t)
    x = np.arccos(np.clip(share, -1, 1))
    assert r["bend"] == pytest.approx(x, abs=1e-7)
    inside = slice(1, None)
    rate = (1 - cos_c**2) * 4 * np.sin(4 * r.t[inside]) / np.sin(x[inside])
    assert r["bend.rate"][inside] == pytest.approx(rate, abs=1e-6)
    again = (1 - cos_c**2) * 16 * np.cos(4 * r.t[inside]) - np.cos(x[inside]) * rate**2
    assert r["bend.acceleration"][inside] == pytest.approx(again / np.sin(x[inside]), abs=1e-5)
    # straight at the start: just after it bends as fast as the axis moves
    assert r["bend.rate"][0] == pytest.approx(4 * np.sqrt(1 - cos_c**2), rel=1e-9)
    # and its tip goes on along its cone
    assert r["bend.acceleration"][0] == pytest.approx(0.0, abs=1e-9)


def test_of_a_cross_it_is_that_of_both_angles():
    text = spun("universal", "", (1.0, -2.0, 1.5))
    r = run(text.replace("sensors: {", "sensors: {one: {joint: ball.first_angle}, "
                         "two: {joint: ball.second_angle}, "))  # fmt: skip
    assert np.cos(r["bend"]) == pytest.approx(np.cos(r["one"]) * np.cos(r["two"]), abs=1e-9)
    assert r["bend"].max() > 1.0


def test_of_shafts_it_is_their_channel():
    omega = 1.5 * np.array([2.0, -2.0, 1.0]) / 3  # across the shaft
    r = run(spun("constant_velocity", "", omega))
    assert r["bend"] == pytest.approx(1.5 * r.t, abs=1e-8)
    assert r["bend"] == pytest.approx(r["ball.bend"], abs=1e-14)


DRAWN_BENT = """
planar: false
bodies: {top: {mass: 3, inertia: [0.05, 0.05, 0.05], at: [0, 0, 0], angular_velocity: [0, 0, 1]}}
joints: {ball: {type: spherical, bodies: [ground, top], at: [0, 0, 0], axis: [1, 0, 0],
                second_axis: [1, 1, 0]}}
sensors: {bend: {joint: ball.bend}, less: {joint: ball.bend, sign: -1},
          from_0: {joint: ball.bend, at_start: 0 deg}, other: {joint: ball.bend, at_start: 10 deg}}
solver: {end: 1}
"""


def test_it_is_counted_from_straight():
    r = run(DRAWN_BENT)
    assert r["bend"] == pytest.approx(np.pi / 4 + r.t, abs=1e-9)
    assert r["less"] == pytest.approx(-np.pi / 4 - r.t, abs=1e-9)
    assert r["less.rate"] == pytest.approx(np.full(len(r.t), -1.0), abs=1e-9)
    assert r["from_0"] == pytest.approx(r.t, abs=1e-9)
    assert r["other"] == pytest.approx(np.radians(10) + r.t, abs=1e-9)


@pytest.mark.parametrize("kind", ["spherical", "constant_velocity", "universal"])
@pytest.mark.parametrize("bodies", ["ground, top", "top, ground"])
@pytest.mark.parametrize("speed", [2.0, 20.0])
def test_a_stop_sends_it_back(kind, bodies, speed):
    """A turn across the axis meets the stop at 0.5 rad: half a swing on its spring, then back
    through straight to the other side."""
    k, I, upper = 5e3, 0.05, 0.5
    stop = f"forces: {{s: {{type: limit_stop, joint: ball.bend, upper: {upper}, stiffness: {k}}}}}"
    across = np.array([2.0, -2.0, 1.0]) / 3
    r = run(spun(kind, stop, speed * across, bodies, end=4 * upper / speed))
    f = np.sqrt(k / I)
    period = 4 * upper / speed + 2 * np.pi / f
    phase = (r.t + upper / speed) % (period / 2) - upper / speed
    lost = phase - upper / speed
    exact = np.where(lost <= 0, np.abs(speed * phase), upper + speed / f * np.sin(f * lost))
    assert r["bend"] == pytest.approx(exact, abs=1e-6)
    assert r["s.penetration"] == pytest.approx(exact - upper, abs=1e-6)
    assert r["s.normal_force"] == pytest.approx(k * np.maximum(exact - upper, 0), abs=k * 1e-6)
    assert energy_error(r) < 1e-8


@pytest.mark.parametrize("planar", ["true", "false"])
def test_in_a_plane(planar):
    """A rod on shafts that lie in the plane falls on the stop of its bend, to either side."""
    m, l, g, k, c, upper = 2.0, 0.5, 9.81, 4e3, 0.0, np.radians(30)
    text = f"""
planar: {planar}
bodies: {{rod: {{mass: {m}, inertia: [0.04, 0.04, 0.04], at: [0, {l}], velocity: [{0.5 * l}, 0],
        angular_velocity: [0, 0, -0.5]}}}}
joints: {{ball: {{type: constant_velocity, bodies: [ground, rod], at: [0, 0], axis: [0, 1, 0]}}}}
sensors: {{bend: {{joint: ball.bend}}}}
forces: {{s: {{type: limit_stop, joint: ball.bend, upper: 30 deg, stiffness: {k}, damping: {c}}}}}
gravity: [0, -{g}, 0]
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01}}
"""
    r = run(text)
    J = 0.04 + m * l**2

    def rates(_, y):
        beyond = np.sign(y[0]) * max(0.0, abs(y[0]) - upper)
        return y[1], (m * g * l * np.sin(y[0]) - k * beyond) / J

    y = solve_ivp(rates, (0, 2), (0, 0.5), t_eval=r.t, rtol=1e-12, atol=1e-12, max_step=1e-3).y
    assert r["bend"] == pytest.approx(np.abs(y[0]), abs=1e-5)
    assert np.abs(y[0]).max() > upper


def test_an_impact_that_takes_no_time():
    stop = ("forces: {s: {type: limit_stop, joint: ball.bend, upper: 0.5, stiffness: 1e5, "
            "damping: 10, restitution: 0.4}}")  # fmt: skip
    across = np.array([2.0, -2.0, 1.0]) / 3
    r = run(spun("universal", stop, 2.0 * across, end=1.2))
    after = np.abs(0.5 - 0.8 * (r.t - 0.25))
    exact = np.where(r.t < 0.25, 2 * r.t, after)
    assert r["bend"] == pytest.approx(exact, abs=1e-7)


def test_an_event_at_a_bend():
    """It stops the run where the axis has gone round its cone as far as 0.8 rad."""
    e = np.array([2.0, -1.0, 2.0]) / 3
    event = "events: {far: {when: bend, value: 0.8, do: {end: true}}}"
    r = run(spun("spherical", event, 4.0 * e))
    cos_c = e @ np.array([1, 2, 2]) / 3
    when = np.arccos((np.cos(0.8) - cos_c**2) / (1 - cos_c**2)) / 4
    assert r.outcome.time == pytest.approx(when, abs=1e-9)


def test_a_short_visit_beyond_a_stop_is_not_passed_over():
    """The axis goes round a cone and comes just beyond the stop, half a turn from straight: without
    forces before, nothing else ends the long step."""
    e = np.array([2.0, -1.0, 2.0]) / 3
    half = np.arccos(e @ np.array([1, 2, 2]) / 3)
    text = spun("spherical", "forces: {s: {type: limit_stop, joint: ball.bend, stiffness: 1e4, "
                f"upper: {2 * half - 1e-6}}}}}", 4.0 * e, tolerance=1e-6)  # fmt: skip
    if 2 * half > np.pi:
        pytest.fail("beyond half a turn the axis comes back")
    r = run(text)
    touched = r.events[:, 0]
    turn = np.pi / 4  # s, half a round
    assert len(touched) == 2 and np.abs(touched - turn).max() < 1e-2


# --- refused ---------------------------------------------------------------------------------


def refused(text, words, hint=""):
    with pytest.raises(TrsimError, match=words) as caught:
        built(text)
    assert hint in caught.value.hint
    return caught.value


def test_a_ball_needs_axes():
    bare = DRAWN_BENT.replace(", axis: [1, 0, 0],\n                second_axis: [1, 1, 0]", "")
    assert "axis" not in bare
    refused(bare, "'ball' has no axes", "give joints.ball an `axis`")
    one = DRAWN_BENT.replace("axis: [1, 0, 0],\n                ", "")
    refused(one, "`second_axis` is counted from `axis`")
    refused(DRAWN_BENT.replace("[1, 1, 0]", "[0, 0, 0]"), "must not be zero")


@pytest.mark.parametrize(
    "forces, words, hint",
    [
        ("{type: limit_stop, joint: ball.bend, upper: 0, stiffness: 1}", "between 0 and half", ""),
        ("{type: limit_stop, joint: ball.bend, lower: 180 deg, stiffness: 1}", "half a turn", ""),
        ("{type: limit_stop, joint: ball.bend, upper: 1 m, stiffness: 1}", "wrong unit", ""),
        ("{type: limit_stop, joint: ball.bend, upper: 1, stiffness: 1 N/m}", "wrong unit", ""),
        ("{type: limit_stop, joint: ball, upper: 1, stiffness: 1}", "has no coord", "ball.bend"),
        ("{type: torsion_spring, joint: ball.bend, stiffness: 1}", "has no coordinate", "bend"),
        ("{type: joint_spring, joint: ball.bend, damper: rate}", "has no coordinate", "bend"),
    ],
)  # fmt: skip
def test_refused(forces, words, hint):
    refused(DRAWN_BENT + f"forces: {{s: {forces}}}\n", words, hint)


@pytest.mark.parametrize(
    "more",
    [
        "drives: {d: {joint: cross.bend, position: t}}",
        "forces: {s: {type: torsion_spring, joint: cross.bend, stiffness: 1}}",
        "initial: {cross.bend: 1}",
    ],
)
def test_nothing_drives_or_sets_it(more):
    text = f"""
planar: false
bodies: {{top: {{mass: 3, inertia: [0.05, 0.05, 0.05], at: [0, 0, 0]}}}}
joints: {{cross: {{type: universal, bodies: [ground, top], at: [0, 0, 0], axis: [1, 0, 0],
                 second_axis: [0, 1, 0]}}}}
{more}
solver: {{end: 1}}
"""
    refused(text, "bend")


def test_through_half_a_turn():
    """The axis of a ball turns across itself: its bend grows, and falls again."""
    across = 4.0 * np.array([2.0, -2.0, 1.0]) / 3
    r = run(spun("spherical", "", across, end=1.2))
    turn = 4 * r.t
    assert r["bend"] == pytest.approx(np.pi - np.abs(np.pi - turn), abs=1e-8)
    away = np.abs(turn - np.pi) > 1e-6
    rate = np.where(turn < np.pi, 4.0, -4.0)
    assert r["bend.rate"][away] == pytest.approx(rate[away], abs=1e-8)


@pytest.mark.parametrize("turn, rate", [(0.0, 3.0), (np.pi, -3.0)])
def test_where_it_turns_back_its_rate_is_that_just_after(turn, rate):
    n = np.cross(A, [0.6, 0.0, -0.8])
    n /= np.linalg.norm(n)
    text = "joints: {joint: {type: spherical, bodies: [left, right], at: [0.2, 0.1, 0], "
    b = bench(text + "axis: [0.48, 0.6, 0.64]}}\nsensors: {bend: {joint: joint.bend}}\n",
              np.random.default_rng(3))  # fmt: skip
    put_right(b, PLACE, turn * n, np.zeros(3))
    b.V[2, 3:] = b.V[1, 3:] + 3.0 * now(b, n)
    w = b.scene()
    assert w.S[:, 0] == pytest.approx([turn], abs=1e-12)
    assert w.S[:, 1] == pytest.approx([rate], rel=1e-12)


def test_its_acceleration_where_it_is_straight():
    """A load of 0.2 N m about what it turns about: 4 rad/s^2, from the first row on."""
    load = "forces: {m: {type: applied_load, body: top, direction: [2, -2, 1], torque: 0.2}}"
    r = run(spun("spherical", load, 2.0 * np.array([2.0, -2.0, 1.0]) / 3, end=0.5))
    assert r["bend"] == pytest.approx(2 * r.t + 2 * r.t**2, abs=1e-8)
    assert r["bend.acceleration"] == pytest.approx(np.full(len(r.t), 4.0), abs=1e-6)


BAR = """
planar: false
bodies:
  bar: {mass: 2, inertia: [1e-4, 0.17, 0.17], at: [0.5, 0, 0],
        flexible: {youngs_modulus: 70 GPa, area: 1e-4, second_moment: 1e-9, elements: 2}}
joints:
  ball: {type: spherical, bodies: [ground, bar], at: [0, 0, 0], axis: AXIS}
  far: {type: inline, bodies: [ground, bar], at: [1, 0, 0], axis: [1, 0, 0]}
WHAT
"""


@pytest.mark.parametrize(
    "what",
    [
        "sensors: {b: {joint: ball.bend}}",
        "forces: {stop: {type: limit_stop, joint: ball.bend, upper: 0.5, stiffness: 1e3}}",
    ],
)
def test_of_a_flexible_bar_in_space(what):
    """Nobody knows how it turns about itself, and so where an axis across it points."""
    assert built(BAR.replace("AXIS", "[1, 0, 0]").replace("WHAT", what)).model.n > 2
    for axis in ("[0, 1, 0]", "[1, 1, 0]"):
        refused(BAR.replace("AXIS", axis).replace("WHAT", what), "about itself")
