"""Friction in joints: blocks, journals, threads and jams against closed forms, with every method.

A balanced wheel loses its speed evenly, r mu m g / I; a thread turns with tan(l + phi); a guide
jams from mu = l/(2 a) on; and a rod that slides along a rough line has no motion, or two, where its
friction outweighs what moves it [Painleve1895].
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import doubts

from ..comparing import approx
from ..runs import built, energy_error, run

G = 9.81
SLIDING = "{law: modified_coulomb, coefficient: MU, v0: 0, v1: 1e-3}"
STICKS = """{law: sticking, coefficient: MU, stribeck_speed: 1 mm/s, bristle_stiffness: 1e5,
             bristle_damping: 300}"""

METHODS = {
    "dop853": ("tolerance: 1e-10", 1e-8),
    "radau": ("method: radau, formulation: index1, tolerance: 1e-9", 1e-6),
    "ggl": ("method: radau, formulation: ggl, tolerance: 1e-9", 1e-6),
    "rk4": ("method: rk4, step: 1e-4, force: true", 1e-7),
    "generalized_alpha": ("method: generalized_alpha, tolerance: 1e-5", 2e-3),
    "scipy:RK45": ("method: scipy:RK45, tolerance: 1e-9", 1e-6),
    "scipy:Radau": ("method: scipy:Radau, tolerance: 1e-9", 1e-6),
}


def law(text, mu):
    return text.replace("MU", repr(mu))


def rubs(joint, mu=0.2, more="", text=SLIDING):
    """A friction called `rub`."""
    return f"rub: {{type: joint_friction, joint: {joint}, friction: {law(text, mu)}{more}}}"


# --- a block on an incline ------------------------------------------------------------------------

SLOPE = 0.5


def block(speed, mu=0.2, more="", text=SLIDING, solver="tolerance: 1e-10", end=0.3):
    """A block thrown up an incline, drawn turned and away from the origin."""
    c, s = np.cos(SLOPE), np.sin(SLOPE)
    return f"""
bodies:
  block: {{mass: 2 kg, inertia: 0.01, at: [3, -4], angle: 0.3,
          velocity: [{speed * c}, {speed * s}]}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: [{2 * c}, {2 * s}, 0]}}}}
forces:
  {rubs("slide", mu, more, text)}
sensors: {{s: {{joint: slide}}}}
gravity: [0, -{G}]
solver: {{end: {end}, {solver}}}
output: {{channels: ["*"]}}
"""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("speed", [3.0, -1.0])
def test_a_block_slides_on_an_incline(method, speed):
    """Up at -g (sin + mu cos), down at -g (sin - mu cos)."""
    solver, error = METHODS[method]
    r = run(block(speed, solver=solver))
    N = 2 * G * np.cos(SLOPE)
    a = -G * np.sin(SLOPE) - np.sign(speed) * 0.2 * N / 2
    assert r["s"] == approx(speed * r.t + a * r.t**2 / 2, abs=error)
    assert r["rub.normal_force"] == approx(N, rel=1e-9)
    assert r["rub.force"] == approx(-np.sign(speed) * 0.2 * N, rel=1e-9)
    assert r["energy.work.friction"][-1] == approx(-0.2 * N * abs(r["s"][-1]), rel=1e-5)
    assert energy_error(r) < max(error, 1e-9)


def test_a_block_sticks_on_an_incline():
    """mu = 0.6 holds it at tan 0.5 = 0.546; it sits in its bristles and loses no energy."""
    r = run(block(0.0, 0.6, text=STICKS, end=3.0, solver="tolerance: 1e-8"))
    hold = 2 * G * np.sin(SLOPE)
    assert np.abs(r["s"]).max() < 6 * np.tan(SLOPE) / 1e5
    assert r["rub.force"][-1] == approx(hold, rel=1e-6)
    assert np.abs(r["s.rate"][-1]) < 1e-8
    r = run(block(0.0, 0.5, text=STICKS, end=1.0, solver="tolerance: 1e-8"))
    a = -G * (np.sin(SLOPE) - 0.5 * np.cos(SLOPE))
    assert r["s"][-1] == approx(a / 2, rel=0.03)  # full when the bristles are bent
    assert np.polyfit(r.t[500:], r["s.rate"][500:], 1)[0] == approx(a, rel=1e-6)


def test_a_constant_friction():
    """A seal of 3 N, alone and beside the friction of the weight."""
    for mu in (0.0, 0.2):
        r = run(block(3.0, mu, ", constant: 3 N"))
        a = -G * np.sin(SLOPE) - mu * G * np.cos(SLOPE) - 3 / 2
        assert r["s"] == approx(3 * r.t + a * r.t**2 / 2, abs=1e-8)
    for mu in (0.0, 0.2):
        r = run(wheel(mu, ", constant: 0.05 N*m"))
        slower = (0.012 * mu * 3 * G + 0.05) / 0.02
        assert r["turn.rate"] == approx(20 - slower * r.t, abs=1e-7)


# --- hinges ---------------------------------------------------------------------------------------


def wheel(
    mu=0.2, more="", axis="[0, 0, 1]", bodies="ground, wheel", spin=20, solver="tolerance: 1e-10"
):
    """A balanced wheel on a journal of 12 mm."""
    return f"""
bodies:
  wheel: {{mass: 3, inertia: [0.02, 0.02, 0.02], at: [2, 1], angle: 1,
          angular_velocity: [0, 0, {spin}]}}
joints: {{bearing: {{type: revolute, bodies: [{bodies}], at: [2, 1], axis: {axis}}}}}
forces:
  {rubs("bearing", mu, ", radius: 12 mm" + more)}
sensors: {{turn: {{joint: bearing}}}}
gravity: [0, -{G}]
solver: {{end: 0.5, {solver}}}
output: {{channels: ["*"]}}
"""


@pytest.mark.parametrize("method", METHODS)
def test_a_journal_slows_a_wheel(method):
    solver, error = METHODS[method]
    r = run(wheel(solver=solver))
    assert r["turn.rate"] == approx(20 - 0.012 * 0.2 * 3 * G / 0.02 * r.t, abs=20 * error)
    assert r["rub.force"] == approx(-0.012 * 0.2 * 3 * G, rel=1e-8)
    assert r["rub.sliding_speed"] == approx(0.012 * r["turn.rate"], rel=1e-9)


@pytest.mark.parametrize("axis", ["[0, 0, 1]", "[0, 0, -3]"])
@pytest.mark.parametrize("bodies", ["ground, wheel", "wheel, ground"])
@pytest.mark.parametrize("planar", ["", "planar: false"])
@pytest.mark.parametrize("spin", [20, -20])
def test_whichever_way_it_is_drawn(axis, bodies, planar, spin):
    r = run(planar + wheel(axis=axis, bodies=bodies, spin=spin))
    slower = 0.012 * 0.2 * 3 * G / 0.02
    assert r["wheel.angular_velocity"][-1, 2] == approx(np.sign(spin) * (20 - slower / 2))


def test_ends_of_a_shaft_and_its_collar():
    """An overhung wheel: two ends carry its moment, a collar its weight along the axis."""
    text = """
planar: false
bodies:
  disc: {mass: 3, inertia: [1e-9, 0.02, 0.02], at: [0.25, 0, 0], angular_velocity: [20, 0, 0]}
joints: {bearing: {type: revolute, bodies: [ground, disc], at: [0, 0, 0], axis: [1, 0, 0]}}
forces:
  RUB
sensors: {turn: {joint: bearing}}
gravity: [-3, -9.81, 0]
solver: {end: 0.01, tolerance: 1e-10}
output: {channels: ["*"]}
""".replace("1e-9", "0.02")
    # at the ends m g/2 -+ m g 0.25/0.1
    for more, N in (
        ("", 3 * G),
        (", length: 0.1", 2 * 3 * G * 2.5),
        (", length: 2", 3 * G),
        (", thrust_radius: 24 mm", 3 * G + 2 * 9),
    ):
        r = run(text.replace("RUB", rubs("bearing", 0.1, ", radius: 12 mm" + more)))
        assert r["rub.normal_force"] == approx(N, rel=1e-9), more
        assert r["turn.rate"][-1] == approx(20 - 0.1 * 0.012 * N / 0.02 * 0.01, abs=1e-7)


@pytest.mark.parametrize("method", ["dop853", "radau", "ggl", "generalized_alpha"])
def test_a_pendulum_on_a_journal(method):
    """The load of a swinging rod, |R| with all its accelerations and the friction's own part in
    these, is solved with it: an independent integration of the one equation."""
    m, l, r0, mu, I = 2.0, 0.5, 0.05, 0.3, 0.05
    solver, error = METHODS[method]
    r = run(f"""
bodies:
  rod: {{mass: {m}, inertia: {I}, at: [{l}, 0], angle: 0.7, velocity: [0, -1.5],
        angular_velocity: [0, 0, -3]}}
joints: {{pin: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
forces:
  {rubs("pin", mu, f", radius: {r0}")}
sensors: {{phi: {{joint: pin, at_start: 0}}}}
gravity: [0, -{G}]
solver: {{end: 0.4, {solver}}}
output: {{channels: ["*"]}}
""")

    def rate(_, y):
        phi, w = y.tolist()
        s, c = math.sin(phi), math.cos(phi)

        def left(alpha):  # torque about the pin less (I + m l^2) alpha, w < 0
            x, y = -l * w**2 * c - l * alpha * s, -l * w**2 * s + l * alpha * c + G
            return -m * G * l * c + mu * r0 * m * math.hypot(x, y) - (I + m * l**2) * alpha

        alpha = 0.0
        for _ in range(20):  # each is 36 times closer, (I + m l^2) / (mu r0 m l)
            alpha += left(alpha) / (I + m * l**2)
        return [w, alpha]

    found = solve_ivp(rate, (0, 0.4), [0, -3], t_eval=r.t, rtol=1e-11, atol=1e-12)
    assert np.all(found.y[1] < -0.1)
    assert r["phi"] == approx(found.y[0], abs=10 * error)
    loads = np.linalg.norm(r["pin.reaction"][:, :2], axis=1)
    assert r["rub.normal_force"] == approx(loads, rel=1e-9)
    assert r["rub.force"] == approx(mu * r0 * loads, rel=1e-9)
    assert energy_error(r) < 100 * error


# --- threads --------------------------------------------------------------------------------------

PITCH, MEAN = 0.01, 0.012
L = np.arctan(PITCH / (2 * np.pi * MEAN))
NUT = """
planar: false
bodies:
  nut: {mass: 2, inertia: [0.002, 0.002, 0.002], angular_velocity: [0, 0, SPIN],
        velocity: [0, 0, RISE]}
joints:
  thread: {type: screw, bodies: [ground, nut], at: [0, 0, 0], axis: [0, 0, 1], pitch: PITCH}
forces:
  RUB
sensors: {turn: {joint: thread.angle}}
gravity: [0, 0, -9.81]
solver: {end: END, tolerance: 1e-9}
output: {channels: ["*"]}
"""


def nut(mu, spin, of="angle", pitch=PITCH, text=SLIDING, end=0.05):
    values = {
        "RUB": rubs(f"thread.{of}", mu, f", radius: {MEAN}", text),
        "PITCH": repr(pitch),
        "SPIN": repr(spin),
        "RISE": repr(spin * pitch / 2 / np.pi),
        "END": repr(end),
    }
    told = NUT
    for word, value in values.items():
        told = told.replace(word, value)
    return told


@pytest.mark.parametrize("of", ["angle", "stroke"])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("spin", [30.0, -30.0])
def test_a_thread(of, sign, spin):
    """A nut with the spin w on a fixed screw: force F of the thread along the axis, and its moment
    F r tan(l +- phi), with m (a + g) = F and I alpha = -+ F r tan."""
    mu, m, I = 0.15, 2.0, 0.002
    r = run(nut(mu, sign * spin, of, sign * PITCH))
    up = np.sign(spin)  # it rises
    tan = np.tan(L + up * np.arctan(mu))
    h = PITCH / 2 / np.pi
    # alpha up the thread: I alpha = -F r tan, m (h alpha + g) = F
    alpha = -m * G * MEAN * tan / (I + m * h * MEAN * tan)
    assert r["turn.rate"] == approx(sign * (spin + alpha * r.t), abs=1e-6)
    F = m * (h * alpha + G)
    assert r["thread.reaction"][:, 2] + friction_along(r, m, F) == approx(F, rel=1e-8)
    assert r["rub.normal_force"] == approx(F / (np.cos(L) - up * mu * np.sin(L)), rel=1e-8)
    assert energy_error(r) < 1e-8


def friction_along(r, m, F):
    """What of the force along the axis is friction: all but the reaction."""
    return m * (r["nut.acceleration"][:, 2] + G) - r["thread.reaction"][:, 2]


@pytest.mark.parametrize("spin", [20.0, -20.0])
def test_efficiency_of_a_thread(spin):
    """Driven at an even speed: what lifts is tan l / tan(l + phi) of what the drive gives."""
    drive = f"drives: {{crank: {{joint: thread.angle, velocity: {spin}}}}}\nsensors"
    r = run(nut(0.1, spin).replace("sensors", drive))
    tan = np.tan(L + np.sign(spin) * np.arctan(0.1))
    assert r["crank.force"] == approx(2 * G * MEAN * tan, rel=1e-8)
    lifted = 2 * G * spin * PITCH / 2 / np.pi
    if spin > 0:
        assert lifted / r["crank.power"] == approx(np.tan(L) / tan, rel=1e-8)


@pytest.mark.parametrize("mu, locks", [(0.12, False), (0.15, True)])
def test_backdriving(mu, locks):
    """tan l = 0.1326: with a larger coefficient a nut stays on its thread under its weight."""
    r = run(nut(mu, 0.0, text=STICKS, end=1.0))
    if locks:
        assert abs(r["turn"][-1]) < 0.02 and abs(r["turn.rate"][-1]) < 1e-6
    else:
        tan, h = np.tan(L - np.arctan(mu)), PITCH / 2 / np.pi
        alpha = -2 * G * MEAN * tan / (0.002 + 2 * h * MEAN * tan)
        assert np.polyfit(r.t[500:], r["turn.rate"][500:], 1)[0] == approx(alpha, rel=1e-5)


# --- several ways to slide ------------------------------------------------------------------------

SPATIAL = ["dop853", "radau", "ggl", "generalized_alpha"]


def puck(more="", velocity="[3, 4, 0]", text=SLIDING, mu=0.2, gravity="[0, 0, -9.81]",
         solver="tolerance: 1e-10", spin=0.0):  # fmt: skip
    """A puck on a table."""
    return f"""
planar: false
bodies:
  puck: {{mass: 2, inertia: [0.01, 0.01, 0.02], at: [1, 2, 3], angle: 0.4, velocity: {velocity},
         angular_velocity: [0, 0, {spin}]}}
joints: {{table: {{type: planar, bodies: [ground, puck], at: [1, 2, 3], x_axis: [1, 2, 0]}}}}
forces:
  {rubs("table", mu, more, text)}
gravity: {gravity}
solver: {{end: 2, {solver}}}
output: {{channels: ["*"]}}
"""


@pytest.mark.parametrize("kind", ["planar", "inplane, axis: [0, 0, 3]"])
@pytest.mark.parametrize("method", SPATIAL)
def test_a_puck_slides_straight(method, kind):
    """Its friction is against its velocity, whatever the axes: it goes v^2/(2 mu g)."""
    solver, error = METHODS[method]
    r = run(puck(solver=solver).replace("type: planar", f"type: {kind}"))
    stops = 5 / (0.2 * G)
    t = np.minimum(r.t, stops)
    gone = 5 * t - 0.2 * G * t**2 / 2
    way = r["puck.position"] - [1, 2, 3]
    # below v1 it creeps by v1^2/(2 mu g) more
    assert way == approx(np.outer(gone, [0.6, 0.8, 0]), abs=10 * error + 1e-6)
    moving = r.t < stops - 0.01
    assert r["rub.force"][moving] == approx(-0.2 * 2 * G, rel=1e-8)
    speed = np.linalg.norm(r["puck.velocity"], axis=1)
    assert r["rub.sliding_speed"] == approx(speed, abs=1e-6)


def test_a_puck_sticks_in_every_direction():
    """On a table at 0.3 with mu = 0.35: it sits, and its friction is the weight along the table."""
    for direction in (0.0, 1.0, 2.5):
        g = G * np.array([np.sin(0.3) * np.cos(direction), np.sin(0.3) * np.sin(direction),
                          -np.cos(0.3)])  # fmt: skip
        text = puck(velocity="[0, 0, 0]", mu=0.35, text=STICKS, gravity=g.tolist(),
                    solver="tolerance: 1e-8")  # fmt: skip
        r = run(text)
        assert np.abs(r["puck.position"] - [1, 2, 3]).max() < 3e-5
        assert r["rub.force"][-1] == approx(-2 * G * np.sin(0.3), rel=1e-6)
        r = run(text.replace("0.35", "0.25"))
        a = G * (np.sin(0.3) - 0.25 * np.cos(0.3))
        late = r.t > 1
        slope = np.polyfit(r.t[late], r["puck.velocity"][late], 1)[0]
        assert slope == approx(a * np.array([np.cos(direction), np.sin(direction), 0]),
                                      abs=1e-5)  # fmt: skip


@pytest.mark.parametrize("text", [SLIDING, STICKS])
@pytest.mark.parametrize("kind", ["cylindrical", "planar"])
def test_what_turns_rubs_less_along(kind, text):
    """A shaft that spins in its sleeve, a puck that spins on a rim: the friction turns to where it
    slides, against an integration of the two equations."""
    m, I, r0, mu = 2.0, 0.02, 0.05, 0.2
    if kind == "planar":
        told = puck(f", radius: {r0}", "[1, 0, 0]", text, mu, spin=30.0, solver="tolerance: 1e-9")
        told, way = told.replace("end: 2", "end: 0.3"), 0
    else:
        told, way = f"""
planar: false
bodies:
  shaft: {{mass: {m}, inertia: [0.02, 0.01, 0.01], velocity: [1, 0, 0],
          angular_velocity: [30, 0, 0]}}
joints: {{sleeve: {{type: cylindrical, bodies: [ground, shaft], at: [0, 0, 0], axis: [1, 0, 0]}}}}
forces:
  {rubs("sleeve", mu, f", radius: {r0}", text)}
gravity: [0, 0, -{G}]
solver: {{end: 0.3, tolerance: 1e-9}}
output: {{channels: ["*"]}}
""", 0  # fmt: skip
    r = run(told)

    def rates(_, y):
        speed = np.hypot(y[0], r0 * y[1])
        F = mu * m * G / speed
        return [-F * y[0] / m, -F * r0 * r0 * y[1] / I]

    found = solve_ivp(rates, (0, 0.3), [1, 30], t_eval=r.t, rtol=1e-10, atol=1e-12).y
    name, spin = ("puck", 2) if kind == "planar" else ("shaft", 0)
    near = 1e-6 if text is SLIDING else 2e-3  # bristles bend first
    assert r[f"{name}.velocity"][:, way] == approx(found[0], abs=near)
    assert r[f"{name}.angular_velocity"][:, spin] == approx(found[1], abs=30 * near)
    assert r["rub.sliding_speed"][10:] == approx(
        np.hypot(found[0], r0 * found[1])[10:], abs=3 * near
    )
    assert found[0][-1] > 0.6  # alone it would be 0.41
    assert energy_error(r) < 1e-6


def test_a_plane_of_which_nothing_is_solved_is_refused():
    with pytest.raises(TrsimError, match="holds nothing in the x-y plane") as caught:
        built(puck(gravity="[0, -9.81, 0]").replace("planar: false", "planar: true"))
    assert caught.value.path == ("forces", "rub")


@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_bead_on_a_slope(planar):
    """An inplane joint in the plane of the scene: one of its coordinates is across that."""
    r = run(f"""
planar: {planar}
bodies: {{bead: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [3, 1], velocity: [1.6, -1.2]}}}}
joints: {{slope: {{type: inplane, bodies: [ground, bead], at: [3, 1], axis: [3, 4]}}}}
forces:
  {rubs("slope", 0.3)}
gravity: [0, -{G}]
solver: {{end: 1, tolerance: 1e-10}}
output: {{channels: ["*"]}}
""")
    away = r["bead.position"] - [3, 1, 0]
    gone = 2 * r.t + G * (0.6 - 0.3 * 0.8) * r.t**2 / 2
    assert away == approx(np.outer(gone, [0.8, -0.6, 0]), abs=1e-7)
    assert r["rub.normal_force"] == approx(2 * G * 0.8)


def test_in_a_template():
    """Names of an instance: two wheels, each on its own journal."""
    one = wheel()
    parts = one[: one.index("gravity:")]
    text = f"""
templates:
  part:{parts.replace(chr(10), chr(10) + "    ")}
instances: {{a: {{template: part}}, b: {{template: part, forces: {{rub: {{radius: 24 mm}}}}}}}}
{one[one.index("gravity:") :]}"""
    r = run(text)
    for name, radius in (("a", 0.012), ("b", 0.024)):
        slower = radius * 0.2 * 3 * G / 0.02
        assert r[f"{name}_turn.rate"] == approx(20 - slower * r.t, abs=1e-7)


# --- guides that jam ------------------------------------------------------------------------------

GUIDE = """
bodies:
  carriage: {mass: 4, inertia: 0.1, at: [0, 0]}
joints: {rail: {type: prismatic, bodies: [ground, carriage], axis: [1, 0, 0]}}
forces:
  push: {type: applied_load, body: carriage, at: [0, ARM], frame: carriage, direction: [1, 0],
         force: 40 N}
  RUB
sensors: {s: {joint: rail}}
solver: {end: 0.5, tolerance: 1e-8}
output: {channels: ["*"]}
"""


@pytest.mark.parametrize("mu, jams", [(0.24, False), (0.26, True), (1.0, True)])
def test_an_eccentric_push_jams_a_guide(mu, jams):
    """Pushed at a distance a from a guide of length l: N = 2 F a/l, so mu > l/(2a) holds any F."""
    told = GUIDE.replace("ARM", "0.4").replace("RUB", rubs("rail", mu, ", length: 0.2", STICKS))
    r = run(told)
    assert r["rub.normal_force"] == approx(2 * 40 * 0.4 / 0.2, rel=1e-6)
    if jams:
        assert np.abs(r["s"]).max() < 1e-4
    else:
        gained = np.polyfit(r.t[500:], r["s.rate"][500:], 1)[0]
        assert gained == approx((40 - mu * 160) / 4, rel=1e-6)


@pytest.mark.parametrize("mu, locks", [(0.0, False), (0.2, False), (0.35, True)])
def test_a_wedge(mu, locks):
    """A weight m on a wedge of the mass M and the angle b, rough on its face alone: it drives the
    wedge out by N (sin - mu cos)/M, N = m g/(cos + mu sin + m/M tan (sin - mu cos)), or rests on it
    where mu > tan b."""
    m, M, b = 3.0, 5.0, 0.3
    c, s = np.cos(b), np.sin(b)
    r = run(f"""
bodies:
  wedge: {{mass: {M}, inertia: 0.1}}
  weight: {{mass: {m}, inertia: 0.1, at: [0.1, 0.2]}}
joints:
  floor: {{type: prismatic, bodies: [ground, wedge], axis: [1, 0, 0]}}
  shaft: {{type: prismatic, bodies: [ground, weight], axis: [0, 1, 0]}}
  face: {{type: inline, bodies: [wedge, weight], at: [0.1, 0.2], axis: [{c}, {s}, 0]}}
forces:
  {rubs("face", mu, ", constant: 1e-9 N", STICKS if mu else SLIDING)}
sensors: {{out: {{joint: floor}}}}
gravity: [0, -{G}]
solver: {{end: 1, tolerance: 1e-9}}
output: {{channels: ["*"]}}
""")
    if locks:
        assert abs(r["out"][-1]) < 1e-4
        assert r["rub.normal_force"][-1] == approx(m * G * c, rel=1e-6)
        return
    N = m * G / (c + mu * s + m / M * np.tan(b) * (s - mu * c))
    late = r.t > 0.5
    assert r["rub.normal_force"][late] == approx(N, rel=1e-6)
    assert r["wedge.acceleration"][late, 0] == approx(N * (s - mu * c) / M, rel=1e-5)


# --- Painleve -------------------------------------------------------------------------------------


def rod(mu, angle=1.0, speed=1.0, spin=0.0, solver="tolerance: 1e-9", end=0.05):
    """A uniform rod of 2 m, one end on a rough line along which it slides at a speed."""
    c, s = np.cos(angle), np.sin(angle)
    # the end slides; the centre is at (c, s) from it
    return f"""
bodies:
  rod: {{mass: 1, inertia: {1 / 3!r}, at: [{c}, {s}], velocity: [{speed - spin * s}, {spin * c}],
        angular_velocity: [0, 0, {spin}]}}
joints: {{line: {{type: inline, bodies: [ground, rod], at: [0, 0], axis: [1, 0, 0]}}}}
forces:
  {rubs("line", mu)}
sensors: {{s: {{joint: line}}}}
gravity: [0, -{G}]
solver: {{end: {end}, {solver}}}
output: {{channels: ["*"]}}
"""


def dangerous(mu, angle):
    """Where the line pushes the rod by F = N n and the end moves up the less the larger N is:
    1 + 3 cos (cos -+ mu sin) < 0."""
    return abs(mu * 3 * np.cos(angle) * np.sin(angle)) > 1 + 3 * np.cos(angle) ** 2


@pytest.mark.parametrize("mu", [1.3, 1.4, 2.5])
@pytest.mark.parametrize("angle", np.deg2rad([40.0, 63.43, 70.0]))
@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_a_rod_on_a_rough_line(mu, angle, speed):
    """Painleve: none below mu = 4/3; above it between two angles, whichever way it slides, for the
    line holds the rod from both sides."""
    if dangerous(mu, angle):
        with pytest.raises(TrsimError, match="Painleve") as caught:
            run(rod(mu, angle, speed))
        assert caught.value.path == ("forces", "rub")
        return
    r = run(rod(mu, angle, speed, end=1e-3))
    c, s, sign = np.cos(angle), np.sin(angle), np.sign(speed)
    # N (1 + 3 c^2) + sign mu |N| 3 c s = g: both signs of N are tried
    N = next(
        N for side in (1, -1)
        if np.sign(N := G / (1 + 3 * c * c + sign * side * mu * 3 * c * s)) == side
    )  # fmt: skip
    assert r["rub.normal_force"][0] == approx(abs(N), rel=1e-9)
    assert r["line.reaction"][0, 1] == approx(N, rel=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_rod_that_comes_to_where_there_is_no_answer(method):
    """It turns into the range, and the run ends there with the word."""
    mu = 2.0
    solver, _ = METHODS[method]
    r = run(rod(mu, np.deg2rad(85), 8.0, -2.0, solver, end=2.0), fails=None)
    assert r.outcome.status == "painleve"
    assert "forces.rub" in r.outcome.reason and "Painleve" in r.outcome.reason
    assert 0.0 < r.outcome.time < 2.0
    assert np.isfinite(r.rows).all()
    # where 1 + 3 c^2 = 3 mu c s on the way from 85 deg down
    first = np.arctan((3 * mu + np.sqrt(9 * mu**2 - 16)) / 2)
    turned = np.deg2rad(85) + np.arcsin(r["rod.rotation"][:, 3])
    late = r.outcome.time - r.t[-1]
    at = turned[-1] + late * r["rod.angular_velocity"][-1, 2]
    assert at == approx(first, abs=1e-3 if "alpha" in method else 1e-4)


# --- explicit steps -------------------------------------------------------------------------------


@pytest.mark.parametrize("speed, mu", [(0.0, 0.6), (2.0, 0.2)])
def test_a_fixed_step_that_is_too_long_is_refused(speed, mu):
    """Of a ramp 2.785 (v1 - v0)/(mu g cos), of bristles 2.828/sqrt(sigma0 g cos), sliding
    2.785 mu/(sigma0 v)."""
    N = G * np.cos(SLOPE)
    ramp = 2.785 * 1e-3 / (mu * N)
    soft = "{law: sticking, coefficient: MU, stribeck_speed: 1 mm/s, bristle_stiffness: 1e5}"
    bristles = min(2.828 / np.sqrt(1e5 * N), 2.785 * mu / (1e5 * speed) if speed else 1.0)
    for text, longest in ((SLIDING, ramp), (soft, bristles)):
        for part, well in ((0.7, True), (1.02, False)):
            step = f"method: rk4, step: {float(part * longest)!r}"
            told = block(speed, mu, text=text, solver=step, end=20 * float(longest))
            if well:
                run(told, "output.every=1e-4")
                continue
            with pytest.raises(TrsimError, match="is not stable") as caught:
                run(told)
            assert "friction of rub" in caught.value.what


# --- several, loops, and what is refused ----------------------------------------------------------

CRANK = """
bodies:
  crank: {mass: 1, inertia: 0.01, at: [0.05, 0], angle: 0.4}
  rod: {mass: 2, inertia: 0.02, at: [0.2, 0]}
  piston: {mass: 3, inertia: 0.02, at: [0.3, 0], angle: -0.2}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  B: {type: revolute, bodies: [crank, rod], at: [0.1, 0]}
  C: {type: revolute, bodies: [rod, piston], at: [0.3, 0]}
  D: {type: prismatic, bodies: [ground, piston], axis: [1, 0, 0]}
initial: {A: 0.7, A.rate: 12}
forces:
  a: {type: joint_friction, joint: A, radius: 20 mm, friction: FRICTION}
  b: {type: joint_friction, joint: B, radius: 15 mm, friction: FRICTION}
  c: {type: joint_friction, joint: C, radius: 10 mm, friction: FRICTION}
  d: {type: joint_friction, joint: D, length: 60 mm, friction: FRICTION}
sensors: {turn: {joint: A}}
gravity: [0, -9.81]
solver: {end: 0.5, SOLVER}
output: {channels: ["*"]}
"""


def crank(solver="tolerance: 1e-9", mu=0.1, more=""):
    return more + CRANK.replace("FRICTION", law(SLIDING, mu)).replace("SOLVER", solver)


@pytest.fixture(scope="module")
def exact_crank():
    return run(crank("tolerance: 1e-11"))


@pytest.mark.parametrize("method", [m for m in METHODS if m != "rk4"])
def test_a_slider_crank_that_rubs_everywhere(method, exact_crank):
    """Each friction with the loads of the others: with the reactions told, to rounding."""
    solver, error = METHODS[method]
    r = run(crank(solver.replace("1e-9", "1e-7") if method == "scipy:Radau" else solver))
    radii = {"a": 0.02, "b": 0.015, "c": 0.01, "d": 1.0}
    for name, radius in radii.items():
        F = r[f"{name.upper()}.reaction"]
        load = np.linalg.norm(F, axis=1)
        if name == "d":
            load = load_of_slide(r)
        assert r[f"{name}.normal_force"] == approx(load, rel=1e-9, abs=1e-9)
        check_law(r, name, 0.1 * radius, radius)
    assert r["turn"] == approx(exact_crank["turn"], abs=max(30 * error, 1e-6))
    assert energy_error(r) < max(100 * error, 1e-7)


def check_law(r, name, part, radius):
    """Friction is full where it slides fast, and never gives."""
    speed, force = r[f"{name}.sliding_speed"], r[f"{name}.force"]
    full = np.abs(speed) > 1.1e-3
    assert full.sum() > 0.5 * len(full)
    wanted = -part * np.sign(speed) * r[f"{name}.normal_force"]
    assert force[full] == approx(wanted[full], rel=1e-9, abs=1e-12)
    assert (force * speed / radius).max() <= 1e-12


@pytest.mark.parametrize("method", ["dop853", "radau", "ggl", "generalized_alpha"])
def test_a_slider_crank_in_space(method):
    """Its weight across the plane: collars, ends and flanks, with the reactions told."""
    solver, error = METHODS[method]
    text = """
planar: false
bodies:
  crank: {mass: 1, inertia: [0.01, 0.02, 0.02], at: [0.05, 0, 0.02], angle: 0.4}
  rod: {mass: 2, inertia: [0.02, 0.03, 0.03], at: [0.2, 0, 0]}
  piston: {mass: 3, inertia: [0.02, 0.02, 0.02], at: [0.3, 0, 0], angle: -0.2}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0, 0]}
  B: {type: spherical, bodies: [crank, rod], at: [0.1, 0, 0]}
  C: {type: universal, bodies: [piston, rod], at: [0.3, 0, 0], axis: [0, 0, 1],
      second_axis: [0, 1, 0]}
  D: {type: prismatic, bodies: [ground, piston], axis: [1, 0, 0]}
initial: {A: 0.7, A.rate: 12}
forces:
  a: {type: joint_friction, joint: A, radius: 20 mm, thrust_radius: 30 mm, length: 50 mm,
      friction: FRICTION}
  d: {type: joint_friction, joint: D, length: 60 mm, width: 80 mm, friction: FRICTION}
  twist: {type: applied_load, body: piston, frame: world, direction: [1, 0, 0], torque: 3 N*m}
sensors: {turn: {joint: A}}
gravity: [0, -5, -9.81]
solver: {end: 0.3, SOLVER}
output: {channels: ["*"]}
"""
    r = run(text.replace("FRICTION", law(SLIDING, 0.1)).replace("SOLVER", solver))
    for name, axis, span, radius in (("a", 2, 0.05, 0.02), ("d", 0, 0.06, 1.0)):
        R, M = r[f"{name.upper()}.reaction"], r[f"{name.upper()}.reaction_moment"]
        a = np.eye(3)[axis]
        half = (R - np.outer(R[:, axis], a)) / 2
        tilt = np.cross(M, a) / span
        load = np.linalg.norm(half + tilt, axis=1) + np.linalg.norm(half - tilt, axis=1)
        load += np.abs(R[:, 2]) * 1.5 if name == "a" else np.abs(M[:, 0]) * 2 / 0.08
        assert r[f"{name}.normal_force"] == approx(load, rel=1e-9, abs=1e-9)
        assert np.abs(M[:, 0 if name == "d" else 1]).max() > 0.1
        check_law(r, name, 0.1 * radius, radius)
    assert energy_error(r) < max(100 * error, 1e-7)


@pytest.mark.parametrize("how", ["baumgarte, baumgarte: {alpha: 50, beta: 50}", "none"])
def test_with_other_stabilisations(how):
    """What feedback brings back to the constraints presses nothing."""
    exact = run(crank(mu=0.3))
    r = run(crank(f"tolerance: 1e-9, stabilisation: {how}", 0.3))
    assert r["turn"] == approx(exact["turn"], abs=1e-8)
    load = np.linalg.norm(r["A.reaction"], axis=1)
    assert r["a.normal_force"] == approx(load, rel=1e-12)


def test_with_masses_far_apart():
    """A rod of a milligram: loads as exact as the reactions of the others."""
    text = crank("tolerance: 1e-8", 0.2).replace(
        "mass: 2, inertia: 0.02", "mass: 1e-6, inertia: 1e-8"
    )
    r = run(text.replace("end: 0.5", "end: 0.2"))
    load = np.linalg.norm(r["C.reaction"], axis=1)
    assert r["c.normal_force"] == approx(load, rel=1e-7, abs=1e-9)
    assert r["d.normal_force"] == approx(load_of_slide(r), rel=1e-7, abs=1e-9)
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("planar", [True, False])
@pytest.mark.parametrize("method", ["dop853", "radau", "ggl"])
def test_on_a_hub(method, planar):
    """Ten pendulums on one wheel, whose motion is an unknown of the solve, rub in eleven hinges."""
    angles = np.linspace(0, 2 * np.pi, 10, endpoint=False)
    places = [(float(0.8 * np.cos(a)), float(0.8 * np.sin(a))) for a in angles]

    def turning(x):
        return f"{x}" if planar else f"[{x}, {x}, {x}]"

    hinges = {"c": ("ground, hub", (0.0, 0.0))}
    bodies = f"  hub: {{mass: 50, inertia: {turning(5)}, angular_velocity: [0, 0, 2]}}\n"
    for k, (x, y) in enumerate(places):
        hinges[f"j{k}"] = (f"hub, b{k}", (x, y))
        bodies += f"  b{k}: {{mass: 1, inertia: {turning(0.02)}, at: [{x + 0.3}, {y}]}}\n"
    joints = "".join(
        f"  {name}: {{type: revolute, bodies: [{pair}], at: [{x}, {y}]}}\n"
        for name, (pair, (x, y)) in hinges.items()
    )
    frictions = "".join(
        f"  f{name}: {{type: joint_friction, joint: {name}, radius: 20 mm,\n"
        f"       friction: {law(SLIDING, 0.2)}}}\n"
        for name in hinges
    )
    solver, _ = METHODS[method]
    r = run(f"""
planar: {str(planar).lower()}
bodies:
{bodies}joints:
{joints}forces:
{frictions}gravity: [0, -9.81, 0]
solver: {{end: 0.3, {solver}}}
output: {{channels: ["*"]}}
""")
    assert np.sum(r.mechanism.model.hub >= 0) == 1
    for name in ("c", "j3"):
        load = np.linalg.norm(r[f"{name}.reaction"], axis=1)
        assert r[f"f{name}.normal_force"] == approx(load, rel=1e-12)
    assert r["hub.angular_velocity"][-1, 2] == approx(0.434650767, abs=1e-7)
    assert energy_error(r) < 1e-8


def test_newton_feels_how_friction_goes_with_multipliers():
    """The stabilised equations take as many iterations with much friction as with next to none."""
    solver = "method: radau, formulation: ggl, tolerance: 1e-6"
    many = [run(crank(solver, mu)).outcome.statistics["newton_iterations"] for mu in (1e-4, 0.5)]
    assert many[1] < 1.1 * many[0]


@pytest.mark.parametrize("unlocked", ["", "unlock: [slide], "])
def test_a_lock_and_a_release(unlocked):
    """What a lock holds rubs no more, and a joint that is apart has neither load nor seal; nor has
    it anything to lock."""
    hold = """
events:
  hold: {when: t, value: 0.1, do: {lock: [slide]}}
  free: {when: t, value: 0.2, do: {UNLOCKED release: [slide]}}
""".replace("UNLOCKED ", unlocked)
    r = run(block(3.0, 0.2, ", constant: 3 N", end=0.4) + hold)
    held, free = (r.t > 0.1) & (r.t < 0.2), r.t > 0.2
    assert r["rub.force"][held] == approx(0, abs=1e-9)
    assert r["rub.normal_force"][held] == approx(2 * G * np.cos(SLOPE))
    assert r["rub.force"][free] == approx(0, abs=0)
    assert r["block.acceleration"][free] == approx(
        np.array([0.0, -G, 0.0]) + 0 * r["block.velocity"][free]
    )
    assert energy_error(r) < 1e-9


def test_a_lock_that_makes_a_reaction_ambiguous_ends_the_run():
    """Both ends of a four-bar locked: nobody knows which pin carries what."""
    more = "events: {hold: {when: t, value: 0.05, do: {lock: [A, D]}}}\n"
    r = run(crank(more=more), fails=True)
    assert "not unique" in r.outcome.reason and "event 'hold'" in r.outcome.reason
    assert r.outcome.time == approx(0.05)


def test_on_a_flexible_bar():
    """The pin of a pendulum that bends rubs like that of a rigid one while it hardly bends."""
    bar = """
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1 m, 0], elements: 3, section: {diameter: 40 mm},
        youngs_modulus: 207 GPa, density: 2000, damping: 1e-4, angular_velocity: [0, 0, -2],
        velocity: [0, -1]}
joints: {pin: {type: revolute, bodies: [ground, bar], at: [0, 0]}}
forces:
  RUB
sensors: {phi: {joint: pin}}
gravity: [0, -9.81]
solver: {end: 0.2, SOLVER}
output: {channels: ["*"]}
""".replace("RUB", rubs("pin", 0.3, ", radius: 40 mm"))
    m = 2000 * np.pi * 0.02**2
    rigid = f"""
bodies:
  bar: {{mass: {m!r}, inertia: {m / 12!r}, at: [0.5, 0], angular_velocity: [0, 0, -2],
        velocity: [0, -1]}}
""" + bar[bar.index("joints:") :]  # fmt: skip
    exact = run(rigid.replace("SOLVER", "tolerance: 1e-8"))
    for solver in ("method: radau, formulation: index1, tolerance: 1e-6",
                   "method: radau, formulation: ggl, tolerance: 1e-6"):  # fmt: skip
        r = run(bar.replace("SOLVER", solver))
        assert r["phi"] == approx(exact["phi"], abs=2e-4)
        late = r.t > 0.05
        load = np.linalg.norm(r["pin.reaction"], axis=1)
        assert r["rub.normal_force"] == approx(load, rel=1e-7)
        assert r["rub.force"][late] == approx(exact["rub.force"][late], rel=0.02)


def test_more_friction_than_can_be_proved():
    """Four frictions that feed each other: where all starts agree the run goes on, and says so."""
    for mu, rate in ((1.0, "12"), (1.5, "-12")):
        r = run(
            crank(mu=mu).replace("A.rate: 12", f"A.rate: {rate}").replace("end: 0.5", "end: 0.1")
        )
        told = [one for one in doubts(r.scenario, r.mechanism, r.outcome) if "not proved" in one]
        many = r.outcome.statistics.get("unproved_frictions", 0)
        assert (len(told), many > 0) == ((1, True) if mu == 1.5 else (0, False))
        assert r["d.normal_force"] == approx(load_of_slide(r), rel=1e-9, abs=1e-9)


def load_of_slide(r):
    """What the two ends of the slide carry."""
    half, tilt = r["D.reaction"][:, 1] / 2, r["D.reaction_moment"][:, 2] / 0.06
    return np.abs(half + tilt) + np.abs(half - tilt)


@pytest.mark.parametrize(
    "old, new, path, words",
    [
        (", radius: 12 mm", "", "radius", "needs `radius`"),
        (", radius: 12 mm", ", radius: 12 mm, width: 3", "width", "has no `width`"),
        ("law: modified_coulomb", "law: coulomb", "friction", "none of a joint"),
        ("coefficient: 0.2", "coefficient: 0", "friction", "nothing rubs"),
        ("joint: bearing,", "joint: bering,", "joint", "no joint named"),
        (", radius: 12 mm", ", radius: 12 mm, constant: 3 N", "constant", "wrong unit"),
        (", radius: 12 mm", ", radius: 0", "radius", "must be > 0"),
        ("friction: {law", "friction: {lw", "friction", "lw"),
        (
            "axis: [0, 0, 1]}",
            "axis: [0, 0, 1], clearance: 1 mm, contact: pin}",
            "joint",
            "clearance",
        ),
    ],
)
def test_refused(old, new, path, words):
    text = (
        wheel()
        + """
contact_laws: {pin: {normal: flores, stiffness: 1e6, restitution: 0.5, bearing_radius: 0.1}}
"""
    )
    assert old in text
    with pytest.raises(TrsimError) as caught:
        built(text.replace(old, new))
    assert caught.value.path[:2] == ("forces", "rub") and caught.value.path[2] == path
    assert words in str(caught.value.what)


def test_two_in_one_joint_are_refused():
    text = block(1.0).replace(
        "sensors:", "  " + rubs("slide").replace("rub:", "again:") + "\nsensors:"
    )
    with pytest.raises(TrsimError, match="already") as caught:
        built(text)
    assert caught.value.path == ("forces", "again", "joint")


def test_a_door_on_two_hinges_is_refused():
    """Of two hinges on one line nobody knows which carries what; one that holds less is unique."""
    door = """
planar: false
bodies: {door: {mass: 10, inertia: [1, 1, 1], at: [0.4, 0, 0.5]}}
joints:
  low: {type: revolute, bodies: [ground, door], at: [0, 0, 0]}
  high: {type: HIGH, bodies: [ground, door], at: [0, 0, 1]}
forces:
  RUB
gravity: [0, 0, -9.81]
solver: {end: 0.1}
"""
    door = door.replace("RUB", rubs("low", 0.1, ", radius: 5 mm"))
    with pytest.raises(TrsimError) as caught:
        built(door.replace("HIGH", "revolute"))
    assert caught.value.path == ("forces", "rub")
    assert "tilt 1" in caught.value.what and "high" in caught.value.what
    with pytest.raises(TrsimError, match="not unique"):
        built(door.replace("HIGH", "spherical"))
    with pytest.raises(TrsimError, match="may be shared with high"):
        built(door.replace("HIGH", "spherical"))
    fine = door.replace("type: revolute", "type: inline, axis: [0, 0, 1]").replace(
        "radius", "width"
    )
    built(fine.replace("HIGH", "spherical"))
