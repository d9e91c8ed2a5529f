"""Seal: a line load on a plane, against closed forms and against many springs."""

from itertools import pairwise
from math import cos, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from trsim.assemble.equations import gaps
from trsim.errors import ScenarioError
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, ONSET, SEPARATION

from ..mechanisms import sealed_door
from ..runs import built, energy_error, run
from .bench import TWO_BODIES, bench, check_action_is_reaction, check_gradient, check_power

SEAL = """
forces:
  seal: {{type: seal, line: {{body: right, start: [0.6, 0.1, 0.2], end: [0.9, 0.4, -0.5]}},
         against: {{body: left, at: [0.1, 0.2, 0.1], normal: [0.2, 1, -0.3]}}, height: 0.01,
         load: 400, at: 0.01, exponent: {n}{more}}}
"""


def pressed(n=1.2, more="", seed=0, deep=0.3):
    """The right body put where its line is partly, or all of it, pressed."""
    rng = np.random.default_rng(seed)
    b = bench(SEAL.format(n=n, more=more), rng)
    for _ in range(3):
        w = b.scene()
        gaps(w, b.t)
        e = [i.name for i in b.mechanism.instances].index("seal")
        own = b.mechanism.instances[e].row
        normal = w.X[1, 3:].reshape(3, 3) @ np.array(own.par[6:9])
        b.r[2] += (w.gap[e, 0] - deep) * normal
    return b


@pytest.mark.parametrize("more", ["", ", springs: 7"])
@pytest.mark.parametrize("n", [1, 1.2, 2.5])
@pytest.mark.parametrize("deep", [0.3, 2.0])
def test_the_elastic_force_is_minus_the_gradient_of_its_energy(n, more, deep):
    """Pressed in part, and all along."""
    for seed in range(3):
        check_gradient(pressed(n, more, seed, deep), rel=2e-6)


@pytest.mark.parametrize("more", ["", ", springs: 7"])
def test_action_is_reaction_and_the_book_is_right(more):
    more += ", damping: 0.5, friction: 0.4, full_from: 0.1"
    for seed in range(4):
        b = pressed(1.2, more, seed)
        b.V *= 0.3
        check_action_is_reaction(b)
        check_power(b, rel=1e-6)


def test_many_springs_are_the_integral():
    """The error of n springs falls with n; three and seven are told in docs/scenarios.md."""
    whole = pressed(deep=0.5).wrenches()
    off = [
        np.abs(pressed(more=f", springs: {n}", deep=0.5).wrenches() - whole).max()
        for n in (3, 7, 30, 300)
    ]
    size = np.abs(whole).max()
    assert off[3] < 1e-4 * size
    assert off[2] < 1e-2 * size
    assert off[3] < off[2] < off[0]


def test_a_door_springs_back_from_its_seal():
    """It meets the seal after 6 mm, and with n = 1 stays for half a period."""
    text, half = sealed_door()
    got = run(text)
    k = 130 / 0.004 * 1.8
    times = [got.events[got.events[:, EVENT_KIND] == kind][:, EVENT_TIME]
             for kind in (ONSET, SEPARATION)]  # fmt: skip
    assert times[0] == pytest.approx([0.006 / 0.5], abs=1e-9)
    assert times[1] == pytest.approx([0.006 / 0.5 + half], abs=1e-6)
    assert got.largest("edge.normal_force")[0] == pytest.approx(0.5 * sqrt(20 * k), rel=1e-6)
    assert energy_error(got) < 1e-8


def test_a_hinged_lid_presses_a_part_of_its_seal():
    """At rest: the moment of the pressed part carries the lid's weight, in closed form."""
    q, at, n, m, g, L, c = 130.0, 0.004, 1.2, 3.0, 9.81, 0.8, 0.004
    text = f"""
bodies:
  lid: {{mass: {m}, inertia: 0.2, at: [0.4, {c}]}}
joints:
  hinge: {{type: revolute, bodies: [ground, lid], at: [0, {c}]}}
forces:
  rim: {{type: seal, line: {{body: lid, start: [0, {c}], end: [{L}, {c}]}},
        against: {{body: ground, at: [0, 0], normal: [0, 1]}}, height: {c},
        load: {q}, at: {at}, exponent: {n}, damping: 5}}
gravity: [0, -{g}]
initial: {{equilibrium: all}}
solver: {{end: 0.1}}
"""
    got = run(text)
    # x = L u sin(-turn) along it: moment q L^2 (x_1 / at)^n / (n + 2) = m g L / 2
    x = at * (m * g * 0.5 * (n + 2) / (q * L)) ** (1 / n)
    assert got["rim.compression"] == pytest.approx(x, rel=1e-4)
    assert got["rim.normal_force"] == pytest.approx(q * L * (x / at) ** n / (n + 1), rel=1e-3)
    assert got["rim.contact_length"] == pytest.approx(L, rel=1e-3)


def test_friction_of_a_seal():
    """A strip that slides is slowed by mu N."""
    mu, m, N = 0.5, 2.0, 2.0 * 9.81
    text = f"""
bodies: {{strip: {{mass: {m}, inertia: 0.1, at: [0, 0], velocity: [1, 0]}}}}
joints: {{flat: {{type: prismatic, bodies: [ground, strip], at: [0, 0], axis: [1, 0, 0]}}}}
forces:
  under: {{type: seal, line: {{body: strip, start: [-0.5, 0], end: [0.5, 0]}},
          against: {{body: ground, at: [0, 0], normal: [0, 1]}}, height: 0.004,
          load: {N}, at: 0.004, exponent: 1.2, friction: {mu}}}
solver: {{end: 0.15, tolerance: 1e-8}}
"""
    got = run(text)
    assert got["under.normal_force"] == pytest.approx(N, rel=1e-9)
    assert got["strip.velocity"][:, 0] == pytest.approx(1 - mu * 9.81 * got.t, abs=1e-6)
    assert got["under.friction_force"][:-1] == pytest.approx(mu * N, rel=1e-9)


@pytest.mark.parametrize("pivot", [0.0, 0.13, 0.5, 0.77])
@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_a_strip_that_turns_about_one_of_its_points(pivot, method):
    """Each side of length a rubs with a moment mu q (a^2/2 - w^2/6), w = v_1/omega, and slower than
    v_1 all along with mu q a^3/(3 w).  It is slowed from 3 rad/s, where w is 1/90 of the strip."""
    mu, q, full, length, inertia = 0.4, 30.0, 0.02, 0.6, 0.2
    text = f"""
planar: false
bodies: {{strip: {{mass: 1, inertia: [1, 1, {inertia}], at: [0, 0, 0],
                 angular_velocity: [0, 0, 3]}}}}
joints: {{pin: {{type: revolute, bodies: [ground, strip], at: [0, 0, 0]}}}}
forces:
  under: {{type: seal, line: {{body: strip, start: [{-pivot * length}, 0, 0],
                             end: [{(1 - pivot) * length}, 0, 0]}},
          against: {{body: ground, at: [0, 0, 0], normal: [0, 0, 1]}}, height: 0.004,
          load: {q}, at: 0.004, friction: {mu}, full_from: {full}}}
solver: {{method: {method}, end: 1, tolerance: 1e-8}}
"""
    got = run(text)
    omega = got["strip.angular_velocity"][:, 2]
    w = full / np.maximum(omega, 1e-100)
    moment = sum(
        np.where(w < a, a**2 / 2 - w**2 / 6, a**3 / (3 * w))
        for a in (pivot * length, (1 - pivot) * length)
    )
    assert got["strip.angular_acceleration"][:, 2] * inertia == pytest.approx(
        -mu * q * moment, abs=1e-6 * mu * q * length**2
    )
    assert omega[-1] < 0.03 < omega[0]


@pytest.mark.parametrize("exponent", [1.0, 1.2, 3.0])
@pytest.mark.parametrize("method", ["static_path", "dop853", "radau"])
def test_a_strip_that_is_pressed_in_part_and_turns_about_its_end(exponent, method):
    """The torque of its friction, against adaptive quadrature: what slides slower than 10 um/s does
    so in proportion, along a static path nothing does."""
    length, rate, full = 0.6, 0.8, 1e-5
    text = f"""
planar: false
bodies: {{strip: {{mass: 1, inertia: [1, 1, 0.2], at: [0, 0, 0]}}}}
joints: {{pin: {{type: revolute, bodies: [ground, strip], at: [0, 0, 0]}}}}
drives: {{motor: {{joint: pin, position: "{rate}*t"}}}}
forces:
  under: {{type: seal, line: {{body: strip, start: [0, 0, 0], end: [{length}, 0, 0.004]}},
          against: {{body: ground, at: [0, 0, 0], normal: [0, 0, 1]}}, height: 0.003,
          load: 130, at: 0.004, exponent: {exponent}, friction: 0.5, full_from: {full}}}
solver: {{method: {method}, end: 1}}
output: {{every: 0.25}}
"""
    got, w = run(text), rate / (full if method != "static_path" else 1e-12)

    def torque(r):
        x = max(0.003 - 0.004 * r / length, 0.0) / 0.004
        return 130 * x**exponent * 0.5 * r * min(1.0, w * r)

    want = quad(torque, 0, 1 / w)[0] + quad(torque, 1 / w, 0.75 * length, epsabs=1e-12)[0]
    want *= sqrt(1 + (0.004 / length) ** 2)  # along the strip, which is tilted
    assert got["motor.force"][1:] == pytest.approx(want, rel=1e-6)


@pytest.mark.parametrize("spin", [1.5, -0.5, -1.5])
def test_a_seal_that_is_let_go_of_does_not_pull(spin):
    """A flap about one end of its seal: load q0 (1 + max(c x', -1)), x = h - r phi, x' = -r omega,
    integrated by hand from the hinge to where it is not pressed any more."""
    length, q, c, high, inertia = 0.6, 100 / 0.004, 20.0, 0.0055, 0.05
    text = f"""
planar: false
bodies: {{flap: {{mass: 2, inertia: [{inertia}, {inertia}, {inertia}], at: [0, 0, 0],
                angular_velocity: [0, {spin}, 0]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, flap], at: [0, 0, 0], axis: [0, 1, 0]}}}}
forces:
  rim: {{type: seal, line: {{body: flap, start: [0, 0, 0], end: [{length}, 0, 0]}},
        against: {{body: ground, at: [0, 0, -0.0005], normal: [0, 0, 1]}}, height: 0.006,
        load: 100, at: 0.004, damping: {c}}}
solver: {{end: 20 ms, tolerance: 1e-9}}
output: {{every: 1 ms}}
"""
    got = run(text)

    def loads(turned, omega):
        """Force and moment about the hinge; turned downwards: pressed in more."""
        ends = [0.0, length]
        if turned < 0.0:
            ends[1] = min(length, high / -sin(turned))
        ends += [x for x in [1.0 / (c * -omega) if omega < 0.0 else -1.0] if 0.0 < x < ends[1]]
        total = np.zeros(2)
        for a, b in pairwise(sorted(ends)):
            x, weight = np.polynomial.legendre.leggauss(8)
            r = a + 0.5 * (b - a) * (x + 1.0)
            load = q * (high + r * sin(turned)) * (1 + np.maximum(c * r * omega * cos(turned), -1))
            total += 0.5 * (b - a) * np.array([weight @ load, weight @ (load * r)])
        return total

    def motion(_, y):
        return y[1], -loads(*y)[1] * cos(y[0]) / inertia

    want = solve_ivp(motion, (0, 0.02), (0.0, spin), rtol=1e-11, atol=1e-13, t_eval=got.t)
    assert got["flap.angular_velocity"][:, 1] == pytest.approx(want.y[1], abs=2e-6)
    force = [loads(*y)[0] for y in want.y.T]
    assert got["rim.normal_force"] == pytest.approx(force, rel=2e-5, abs=1e-3)


@pytest.mark.parametrize("seed", range(3))
def test_no_touch_of_either_end_is_passed_over(seed):
    """A spinning bar with a seal along it, beside a plane: each end touches once a turn."""
    rng = np.random.default_rng(seed)
    spin, far = float(rng.uniform(20, 200)), 0.1 * float(1 - 10 ** rng.uniform(-4, -1))
    text = f"""
bodies: {{bar: {{mass: 2, inertia: 0.05, angular_velocity: [0, 0, {spin}]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, bar], at: [0, 0]}}}}
forces:
  rim: {{type: seal, line: {{body: bar, start: [-0.1, 0], end: [0.1, 0]}},
        against: {{body: ground, at: [0, {-far}], normal: [0, 1]}}, load: 1e-4, at: 1e-3}}
solver: {{end: 0.5}}
output: {{every: 0.1}}
"""
    got = run(text)
    first = np.arcsin(far / 0.1)
    want = (first + np.pi * np.arange(200)) / spin
    found = got.events[got.events[:, EVENT_KIND] == ONSET][:, EVENT_TIME]
    assert found == pytest.approx(want[want < 0.5], abs=1e-4 / spin)


@pytest.mark.parametrize("turned", [False, True])
def test_no_touch_of_the_end_that_moves_is_passed_over(turned):
    """A bar that turns about one end of its seal: only the other one touches, once a turn."""
    spin, far = 150.0, 0.0999
    ends = "start: [0.1, 0], end: [0, 0]" if turned else "start: [0, 0], end: [0.1, 0]"
    text = f"""
bodies: {{bar: {{mass: 2, inertia: 0.05, angular_velocity: [0, 0, {spin}]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, bar], at: [0, 0]}}}}
forces:
  rim: {{type: seal, line: {{body: bar, {ends}}},
        against: {{body: ground, at: [0, {-far}], normal: [0, 1]}}, load: 1e-4, at: 1e-3}}
solver: {{end: 0.5}}
output: {{every: 0.1}}
"""
    got = run(text)
    want = (np.pi + np.arcsin(far / 0.1) + 2 * np.pi * np.arange(100)) / spin
    found = got.events[got.events[:, EVENT_KIND] == ONSET][:, EVENT_TIME]
    assert found == pytest.approx(want[want < 0.5], abs=1e-4 / spin)


@pytest.mark.parametrize("wrong, what", [
    ("line: {body: left, start: [0, 0, 0], end: [1, 0, 0]}", "both on 'left'"),
    ("line: {body: right, start: [0, 0, 0], end: [0, 0, 0]}", "no length"),
])  # fmt: skip
def test_what_is_refused(wrong, what):
    text = SEAL.format(n=1, more="")
    text = text.replace("line: {body: right, start: [0.6, 0.1, 0.2], end: [0.9, 0.4, -0.5]}", wrong)
    with pytest.raises(ScenarioError, match=what):
        built(TWO_BODIES + text)


def test_a_seal_pressed_through_its_plane_is_told():
    got = run(sealed_door(speed=5.0)[0])
    words = doubts(got.scenario, got.mechanism, got.outcome)
    assert any("went through the plane" in one for one in words)


# --- along static paths ------------------------------------------------------------------------


@pytest.mark.parametrize("move, off", [("0.2*t + 0.3*t**2", 3e-5), ("0.2*sin(2*t)", 2.5e-3)])
def test_a_line_that_slides_and_turns(move, off):
    """Friction at every point is against its own velocity, which turns along the path: of second
    order in the time between rows, as that of a ball is (of 7.2 N, 3e-4)."""
    text = f"""
planar: false
bodies: {{strip: {{mass: 1e-4, inertia: [1e-4, 1e-4, 1e-4], at: [0, 0, 0]}}}}
joints: {{table: {{type: planar, bodies: [ground, strip], at: [0, 0, 0], axis: [0, 0, 1],
                 x_axis: [1, 0, 0]}}}}
drives:
  dx: {{joint: table.x, position: "{move}"}}
  dy: {{joint: table.y, position: "0.1*t"}}
  da: {{joint: table.angle, position: "0.7*t"}}
forces:
  under: {{type: seal, line: {{body: strip, start: [-0.2, 0.1, 0], end: [0.4, 0.1, 0]}},
          against: {{body: ground, at: [0, 0, 0], normal: [0, 0, 1]}}, height: 4 mm, load: 30,
          at: 4 mm, friction: 0.4}}
solver: {{method: static_path, end: 1}}
output: {{every: 0.05}}
"""
    got = run(text)
    for k, t in enumerate(got.t):
        speed = 0.2 + 0.6 * t if "t**2" in move else 0.4 * cos(2 * t)
        c, s = cos(0.7 * t), sin(0.7 * t)

        def density(u, of, speed=speed, c=c, s=s):
            x, y = c * (-0.2 + 0.6 * u) - s * 0.1, s * (-0.2 + 0.6 * u) + c * 0.1
            v = np.array([speed - 0.7 * y, 0.1 + 0.7 * x])
            v *= 30 * 0.6 * 0.4 / np.linalg.norm(v)
            return (*v, x * v[1] - y * v[0])[of]

        want = [quad(density, 0, 1, args=(of,), points=[0.2, 0.5, 0.8])[0] for of in range(3)]
        force = [got[f"{name}.force"][k] for name in ("dx", "dy", "da")]
        assert force == pytest.approx(want, abs=off), t


@pytest.mark.parametrize("rows", [10, 50, 250])
def test_a_rod_that_is_pulled_by_its_end(rows):
    """Nothing but its friction holds it: at first it turns about the point at which that has no
    moment about the pulled end, 1/sqrt 2 of its length from there, and the pull is
    mu q L (sqrt 2 - 1)."""
    text = f"""
planar: false
bodies:
  hand: {{mass: 0.01, inertia: [1e-5, 1e-5, 1e-5], at: [0, 0, 0]}}
  rod: {{mass: 0.01, inertia: [1e-5, 1e-3, 1e-3], at: [0.5, 0, 0]}}
joints:
  slide: {{type: prismatic, bodies: [ground, hand], axis: [0, 1, 0]}}
  pin: {{type: revolute, bodies: [hand, rod], at: [0, 0, 0]}}
drives: {{pull: {{joint: slide, position: "0.8*t"}}}}
sensors: {{angle: {{joint: pin}}}}
forces:
  under: {{type: seal, line: {{body: rod, start: [0, 0, 0], end: [1, 0, 0]}},
          against: {{body: ground, at: [0, 0, 0], normal: [0, 0, 1]}}, height: 4 mm, load: 30,
          at: 4 mm, friction: 0.4}}
solver: {{method: static_path, end: 1}}
output: {{every: {1 / rows}}}
"""
    got = run(text)
    assert got["pull.force"][0] == pytest.approx(0.4 * 30 * (sqrt(2) - 1), rel=1e-6)

    def turning(_, y):
        """phi' where friction has no moment about the pulled end: v(s) = v + s phi' across."""
        phi = y[0]

        def moment(rate):
            x, w = np.polynomial.legendre.leggauss(60)
            total = 0.0
            at = np.clip(-0.8 * cos(phi) / rate, 0.0, 1.0) if rate else 0.0  # nearest to rest
            for a, b in ((0.0, at), (at, 1.0)):
                s = a + 0.5 * (b - a) * (x + 1.0)
                across = 0.8 * cos(phi) + s * rate
                total += 0.5 * (b - a) * w @ (s * across / np.hypot(across, 0.8 * sin(phi)))
            return total

        return [brentq(moment, -0.8 * cos(phi) * 1.7, -0.8 * cos(phi) * 0.9, xtol=1e-13)]

    want = solve_ivp(turning, (0, 1), [0.0], rtol=1e-9, atol=1e-11).y[0, -1]
    assert got["angle"][-1] == pytest.approx(want, abs=3e-4 if rows == 10 else 3e-5)
