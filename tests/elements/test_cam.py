"""Cam: followers against closed forms of their curves and against linkages, and what is refused.

With the normal n of the curve at an angle b and the support function p(b) = n . c(b) of a convex
curve, a flat face of normal n stands at p(b), and a roller rolls on the curve p(b) + r.
"""

import numpy as np
import pytest
from scipy.special import ellipe

from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import doubts

from ..runs import built, energy_error, run

A, B, R = 0.04, 0.03, 0.012
ELLIPSE = f"x: {A}*cos(s), y: {B}*sin(s), range: [0, 2*pi], closed: true"
ROUND = f"x: {A}*cos(s) + 0.015, y: {A}*sin(s), range: [0, 2*pi], closed: true"
METHODS = {
    "dop853": ("tolerance: 1e-10", 1e-10),
    "radau": ("method: radau, tolerance: 1e-8", 1e-9),
    "ggl": ("method: radau, formulation: ggl, tolerance: 1e-8", 1e-9),
    "rk4": ("method: rk4, step: 1e-3", 1e-10),
    "generalized_alpha": ("method: generalized_alpha, tolerance: 1e-5", 1e-9),
    "scipy:RK45": ("method: 'scipy:RK45', tolerance: 1e-8", 1e-9),
}


def tappet(follower, curve, at, solver="tolerance: 1e-10", more="", **keys):
    """A tappet that a cam lifts along y, 0.1 m above the drawn place of its contact."""
    given = {"bodies": "[wheel, tappet]", "speed": "9", "end": 2, "planar": "true"} | keys
    return f"""
planar: {given["planar"]}
bodies:
  wheel: {{mass: 2, inertia: [0.01, 0.01, 0.01], at: [0, 0], angle: 0.6}}
  tappet: {{mass: 0.5, inertia: [0.01, 0.01, 0.001], at: [0, 0.15], angle: -0.2}}
joints:
  shaft: {{type: revolute, bodies: [ground, wheel], at: [0, 0]}}
  guide: {{type: prismatic, bodies: [ground, tappet], axis: [0, 1]}}
  lobe: {{type: cam, bodies: {given["bodies"]}, at: {at}, {follower}, curve: {{{curve}}}}}
drives: {{motor: {{joint: shaft, velocity: {given["speed"]}}}}}
sensors: {{turn: {{joint: shaft}}, lift: {{joint: guide}}, way: {{joint: lobe}}}}
gravity: [0, -9.81, 0]
solver: {{end: {given["end"]}, {solver}}}
output: {{every: 0.01, channels: ["*"]}}
{more}
"""


@pytest.mark.parametrize("method", METHODS)
def test_a_flat_face_rises_as_the_support_function(method):
    """p = sqrt(a^2 sin^2 + b^2 cos^2); the touch is p' beside the axis of the cam."""
    solver, error = METHODS[method]
    r = run(tappet("face: [0, 2]", ELLIPSE, [0.003, B], solver))
    t = r["turn"]
    p = np.sqrt((A * np.sin(t)) ** 2 + (B * np.cos(t)) ** 2)
    slope = (A**2 - B**2) * np.sin(t) * np.cos(t) / p
    bend = ((A**2 - B**2) * np.cos(2 * t) - slope**2) / p
    assert t[-1] > 2.5 * 2 * np.pi
    assert r["lift"] == pytest.approx(p - B, abs=error)
    assert r["lift.rate"] == pytest.approx(9 * slope, abs=1e3 * error)
    assert r["lobe.place"][:, 0] == pytest.approx(slope, abs=1e3 * error)
    assert r["lobe.place"][:, 1] == pytest.approx(p, abs=error)
    F = 0.5 * (9.81 + 81 * bend)
    assert r["lobe.normal_force"] == pytest.approx(F, abs=1e-3)
    assert r["motor.force"] == pytest.approx(F * slope, abs=1e-4)
    assert r["lobe.curvature"] == pytest.approx(1 / (p + bend), rel=1e-6)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("bodies", ["[wheel, tappet]"])
def test_a_roller_on_an_eccentric_circle_is_a_crank_with_a_rod(method, bodies):
    """Of length a + r from the centre of the circle, e from the axis, to the roller."""
    solver, error = METHODS[method]
    e, rod = 0.015, A + R
    high = np.sqrt(rod**2 - e**2)
    r = run(tappet(f"radius: {R}", ROUND, [0, float(high)], solver, bodies=bodies))
    t = r["turn"]
    lift = e * np.sin(t) + np.sqrt(rod**2 - (e * np.cos(t)) ** 2) - high
    assert r["lift"] == pytest.approx(lift, abs=error)
    gap = np.hypot(r["lobe.place"][:, 0], r["lobe.place"][:, 1] - lift - high)
    assert gap == pytest.approx(R, abs=error)
    assert r["lobe.curvature"] == pytest.approx(1 / A)
    # the circle is gone round the other way, less the swing of the rod
    swing = np.arcsin(e * np.cos(t) / rod) - np.arcsin(e / rod)
    assert r["way"] == pytest.approx(A * (swing - t), abs=1e3 * error)


def test_a_roller_inside_a_ring():
    e, rod = 0.015, A - R
    high = e * 0 + np.sqrt(rod**2 - e**2)
    r = run(tappet(f"radius: {R}", ROUND, [0, float(high)]))
    t = r["turn"]
    lift = e * np.sin(t) + np.sqrt(rod**2 - (e * np.cos(t)) ** 2) - high
    assert r["lift"] == pytest.approx(lift, abs=1e-10)
    assert energy_error(r) < 1e-8


def test_a_roller_on_an_ellipse():
    """On its offset curve c + r n, where that stands above the axis."""
    r = run(tappet(f"radius: {R}", ELLIPSE, [0, B + R]))
    s = np.linspace(-np.pi, np.pi, 200001)
    c = np.array([A * np.cos(s), B * np.sin(s)])
    n = np.array([B * np.cos(s), A * np.sin(s)])
    c = c + R * n / np.hypot(*n)
    angle, high = np.unwrap(np.arctan2(c[1], c[0])), np.hypot(*c)
    wanted = np.interp((np.pi / 2 - r["turn"] + np.pi) % (2 * np.pi) - np.pi, angle, high)
    assert r["lift"] + B + R == pytest.approx(wanted, abs=1e-9)


def test_either_body_first():
    """A cam that is drawn on the tappet moves with it: a circle on a circle, both ways."""
    e, rod = 0.015, A + R
    high = float(np.sqrt(rod**2 - e**2))
    disc = f"at: [0, {high}], x: {R}*cos(s), y: {R}*sin(s), range: [0, 2*pi], closed: true"
    r = run(tappet(f"radius: {A}", ROUND, [0, high], end=0.5).replace(
        f"bodies: [wheel, tappet], at: [0, {high}]", f"bodies: [tappet, wheel], at: [{e}, 0]"
    ).replace(ROUND, disc))  # fmt: skip
    t = r["turn"]
    lift = e * np.sin(t) + np.sqrt(rod**2 - (e * np.cos(t)) ** 2) - high
    assert r["lift"] == pytest.approx(lift, abs=1e-10)


def test_a_face_that_turns():
    """A flat face on an arm that swings: normal and contact turn with it."""
    text = f"""
planar: true
bodies:
  wheel: {{mass: 2, inertia: 0.01, at: [0, 0]}}
  arm: {{mass: 0.5, inertia: 0.004, at: [0.05, 0.03], angle: 1}}
joints:
  shaft: {{type: revolute, bodies: [ground, wheel], at: [0, 0]}}
  pin: {{type: revolute, bodies: [ground, arm], at: [0.15, 0.03]}}
  lobe: {{type: cam, bodies: [wheel, arm], at: [0, 0.03], face: [0, 1], curve: {{{ELLIPSE}}}}}
drives: {{motor: {{joint: shaft, velocity: 9}}}}
sensors: {{turn: {{joint: shaft}}, swing: {{joint: pin}}}}
gravity: [0, -9.81, 0]
solver: {{end: 2, tolerance: 1e-11}}
output: {{every: 0.01, channels: ["*"]}}
"""
    r = run(text)
    t, s = r["turn"], r["swing"]
    n = np.array([-np.sin(s), np.cos(s)])
    b = np.pi / 2 + s - t
    p = np.hypot(A * np.cos(b), B * np.sin(b))
    assert np.ptp(s) > 0.05
    assert n[0] * 0.15 + n[1] * 0.03 == pytest.approx(p, abs=1e-10)
    assert energy_error(r) < 1e-8


def test_tilted_in_space():
    """The same numbers wherever the plane of the cam is, and far from the origin."""
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    flat = run(tappet(f"radius: {R}", ELLIPSE, [0, B + R], planar="false"))
    place = np.array([200.0, -100.0, 50.0])

    def world(*p):
        return (turn @ np.array(p) + place).tolist()

    def free(*v):
        return (turn @ np.array(v)).tolist()

    text = f"""
planar: false
bodies:
  wheel: {{mass: 2, inertia: [0.01, 0.01, 0.01], at: {world(0, 0, 0)}}}
  tappet: {{mass: 0.5, inertia: [0.01, 0.01, 0.01], at: {world(0, 0.15, 0)}}}
joints:
  shaft: {{type: revolute, bodies: [ground, wheel], at: {world(0, 0, 0)}, axis: {free(0, 0, 1)}}}
  guide: {{type: prismatic, bodies: [ground, tappet], axis: {free(0, 1, 0)}}}
  lobe: {{type: cam, bodies: [wheel, tappet], at: {world(0, B + R, 0)}, radius: {R},
         curve: {{at: {world(0, 0, 0)}, x_axis: {free(1, 0, 0)}, y_axis: {free(0, 1, 0)},
                 {ELLIPSE}}}}}
drives: {{motor: {{joint: shaft, velocity: 9}}}}
sensors: {{lift: {{joint: guide}}}}
gravity: {free(0, -9.81, 0)}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01, channels: ["*"]}}
"""
    r = run(text)
    assert not r.mechanism.planar
    assert r["lift"] == pytest.approx(flat["lift"], abs=1e-9)
    assert r["lobe.normal_force"] == pytest.approx(flat["lobe.normal_force"], abs=1e-4)


def test_a_template_turned_about_z():
    """Its curve stands in the frame of the instance."""
    text = f"""
templates:
  lifter:
    bodies:
      wheel: {{mass: 2, inertia: 0.01, at: [0, 0]}}
      tappet: {{mass: 0.5, inertia: 0.001, at: [0, 0.15]}}
    joints:
      shaft: {{type: revolute, bodies: [ground, wheel], at: [0, 0]}}
      guide: {{type: prismatic, bodies: [ground, tappet], axis: [0, 1]}}
      lobe: {{type: cam, bodies: [wheel, tappet], at: [0, {B}], face: [0, 1], curve: {{{ELLIPSE}}}}}
    drives: {{motor: {{joint: shaft, velocity: 9}}}}
    sensors: {{lift: {{joint: guide}}, turn: {{joint: shaft}}}}
instances:
  one: {{template: lifter}}
  two: {{template: lifter, frame: {{at: [3, 1], x_axis: [3, 4], y_axis: [-4, 3]}}}}
solver: {{end: 1, tolerance: 1e-10}}
"""
    r = run(text)
    p = np.sqrt((A * np.sin(9 * r.t)) ** 2 + (B * np.cos(9 * r.t)) ** 2)
    assert r["one_lift"] == pytest.approx(p - B, abs=1e-9)
    assert r["two_lift"] == pytest.approx(p - B, abs=1e-9)


def told(r):
    return [said for said in doubts(r.scenario, r.mechanism, r.outcome) if "lobe" in said]


def test_lifting_off_is_said():
    calm = run(tappet("face: [0, 1]", ELLIPSE, [0, B]), "output.channels=['lift']")
    assert told(calm) == []
    fast = run(tappet("face: [0, 1]", ELLIPSE, [0, B], speed="40"), "output.channels=['lift']")
    [said] = told(fast)
    assert "pulled by" in said and "lift off" in said


def test_no_turn_is_lost_in_a_long_step():
    """A disc about its axis."""
    disc = f"x: {A}*cos(s), y: {A}*sin(s), range: [0, 2*pi], closed: true"
    text = tappet(f"radius: {R}", disc, [0, A + R], "tolerance: 1e-3", end=40)
    r = run(text.replace("every: 0.01", "every: 20"))
    assert r["way"] == pytest.approx(-A * 9 * r.t, abs=1e-6)


@pytest.mark.parametrize("turn", [2.0, 20.0])
def test_it_starts_where_its_shaft_is_put(turn):
    """Also turns away from the drawing, which the way round the cam counts."""
    r = run(tappet("face: [0, 1]", ELLIPSE, [0, B], more=f"initial: {{shaft: {turn}}}", end=0.1))
    t = r["turn"]
    assert t[0] == pytest.approx(turn - 0.6, abs=1e-9)
    p = np.sqrt((A * np.sin(t)) ** 2 + (B * np.cos(t)) ** 2)
    assert r["lift"] == pytest.approx(p - B, abs=1e-9)
    around = 4 * A * ellipe(1 - (B / A) ** 2)
    assert r["way"][0] / around == pytest.approx(-t[0] / (2 * np.pi), abs=0.2)


def test_an_open_cam_ends_the_run():
    r = run(tappet("face: [0, 1]", f"x: {A}*cos(s), y: {B}*sin(s), range: [0.5, 2.5]", [0, B]))
    assert r.outcome.status == "jammed" and "lobe" in r.outcome.reason
    # as far as the normal of the end is turned: tan b = a tan s / b
    assert r["turn"][-1] == pytest.approx(np.pi / 2 - np.arctan2(A * np.sin(0.5), B * np.cos(0.5)),
                                          abs=0.1)  # fmt: skip


HOLLOW = f"x: {A}*(1 + 0.3*cos(3*s))*cos(s), y: {A}*(1 + 0.3*cos(3*s))*sin(s)"
REFUSED = {
    "undercutting": (
        f"radius: {R}", f"x: {A}*cos(s), y: 0.01*sin(s)", [0, 0.01 - R],
        "radius of 0.0025 m at .*undercutting",
    ),
    "two places at once": (
        "radius: 0.019", "x: 0.1*cos(s), y: 0.06*sin(s)*(0.3 + cos(s)**2)", [0.081, 0],
        "meets it again at .*undercutting",
    ),
    "no side": (f"radius: {R}", ELLIPSE, [0, B], "on which side"),
    "hollow": ("face: [0, 1]", HOLLOW, [0, 0.04], "straight or hollow at"),
    "out of the plane": ("face: [0, 1, 1]", ELLIPSE, [0, B], "out of the plane"),
    "far away": ("face: [0, 1]", ELLIPSE, [0, 0.06], "it must go through"),
    "no normal": ("face: [0, 0]", ELLIPSE, [0, B], "must not be zero"),
    "both": (f"face: [0, 1], radius: {R}", ELLIPSE, [0, B], "one of them"),
    "neither": ("points: [0]", ELLIPSE, [0, B], "one of them|points"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refused(what):
    follower, curve, at, said = REFUSED[what]
    if "range" not in curve:
        curve += ", range: [0, 2*pi], closed: true"
    with pytest.raises(TrsimError, match=said):
        built(tappet(follower, curve, at))


def yoke(curve, half):
    """A tappet with two faces, above its cam and below."""
    under = (
        f"under: {{type: cam, bodies: [wheel, tappet], at: [0, {-half}], face: [0, -1], "
        f"curve: {{{curve}}}}}"
    )
    return tappet("face: [0, 1]", curve, [0, half]).replace("drives:", f"  {under}\ndrives:")


def test_a_cam_between_two_faces():
    """Of a circle one of them is more than enough; an ellipse would not turn."""
    r = run(yoke(ROUND, A))
    assert r.mechanism.redundant == ("under.contact",) and len(r.mechanism.not_unique) == 2
    assert r["lift"] == pytest.approx(0.015 * np.sin(r["turn"]), abs=1e-12)
    with pytest.raises(TrsimError, match="lobe, under allow 1 motions"):
        run(yoke(ELLIPSE, B))


def test_locked_and_let_go():
    more = """
events:
  stop: {when: t, value: 0.5, do: {release: [motor], lock: [shaft]}}
  go: {when: t, value: 0.8, do: {unlock: [shaft]}}
"""
    r = run(tappet("face: [0, 1]", ELLIPSE, [0, B], more=more))
    t = r["turn"]
    p = np.sqrt((A * np.sin(t)) ** 2 + (B * np.cos(t)) ** 2)
    assert r["lift"] == pytest.approx(p - B, abs=1e-9)
    assert t[60] == pytest.approx(4.5) and t[79] == pytest.approx(4.5)
    assert abs(t[-1] - 4.5) > 1 and "way.acceleration" not in r.place


def test_nothing_stops_it_by_the_place_of_a_face():
    more = "forces: {stop: {type: limit_stop, joint: lobe, upper: 0.1, stiffness: 1e5}}"
    with pytest.raises(TrsimError, match="no point that stays"):
        built(tappet("face: [0, 1]", ELLIPSE, [0, B], more=more))


FALLS = """
planar: PLANAR
bodies:
  disc: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [0, 0]}
  tappet: {mass: 0.5, inertia: [0.01, 0.01, 0.01], at: [0, 0.12]}
joints:
  shaft: {type: revolute, bodies: [ground, disc], at: [0, 0]}
  guide: {type: prismatic, bodies: [ground, tappet], axis: [0, 1, 0]}
  lobe: {JOINT, bodies: [disc, tappet],
         curve: {x: "0.1*cos(s)", y: "0.1*sin(s)", range: [0, 2*pi], closed: true}}
gravity: [0, -9.81, 0]
events: {off: {when: t, value: 0.1, do: {release: [lobe]}}}
solver: {end: 0.5, method: METHOD}
"""
FOLLOWERS = (
    "type: cam, radius: 20 mm, at: [0, 0.12]",
    "type: cam, face: [0, 1, 0], at: [0, 0.1]",
    "type: point_on_curve, at: [0, 0.1]",
)


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("method", ["auto", "radau"])
@pytest.mark.parametrize("joint", FOLLOWERS)
def test_what_was_released_falls_through_the_centre(joint, method, planar):
    """It falls freely from 0.1 s on, past the centre of the disc, and the place stays told."""
    r = run(FALLS.replace("PLANAR", planar).replace("METHOD", method).replace("JOINT", joint))
    fallen = 0.5 * 9.81 * np.maximum(r.t - 0.1, 0) ** 2
    assert r["tappet.position"][:, 1] == pytest.approx(0.12 - fallen, abs=1e-7)
    assert r["lobe.arc"] == pytest.approx(np.full(len(r.t), 0.05 * np.pi), abs=1e-7)
