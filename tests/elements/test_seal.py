"""Seal: a line load on a plane, against closed forms and against many springs."""

from math import sqrt

import numpy as np
import pytest

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
