"""Impacts with a known answer: contact time, peak force, delivered restitution, bouncing."""

import csv

import numpy as np
import pytest

from trsim.laws.contact import hertz_contact_time, hertz_peak
from trsim.solve.march.record import EVENT_KIND, EVENT_SPEED, EVENT_TIME, ONSET, SEPARATION

from ..linkages import slider_crank
from ..mechanisms import DATA, SPEED, bouncing_ball, central_impact, p1_slider_crank, table
from ..runs import energy_error, run
from ..sizes import size


def first_impact(r):
    """Time, approach speed, duration, separation speed of the first impact."""
    onset, separation = r.events[:2]
    assert (onset[EVENT_KIND], separation[EVENT_KIND]) == (ONSET, SEPARATION)
    return (onset[EVENT_TIME], onset[EVENT_SPEED], separation[EVENT_TIME] - onset[EVENT_TIME],
            -separation[EVENT_SPEED])  # fmt: skip


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("exponent", [1.5, 1.2, 2.0])
def test_hertz_contact_time_and_peak_force(exponent, planar):
    K, m = 1e9, 0.7
    r = run(central_impact(K=K, mass=m, exponent=exponent, planar=planar))
    _, speed, duration, rebound = first_impact(r)
    assert speed == pytest.approx(SPEED, rel=1e-8)
    assert rebound == pytest.approx(SPEED, rel=1e-6)
    assert duration == pytest.approx(hertz_contact_time(m, K, exponent, SPEED), rel=1e-6)
    depth, force = hertz_peak(m, K, exponent, SPEED)
    assert r.largest("pin.normal_force")[0] == pytest.approx(force, rel=1e-6)
    assert r.largest("pin.penetration")[0] == pytest.approx(depth, rel=1e-6)
    assert energy_error(r) < 1e-6


def restitutions():
    rows = (DATA / "effective_restitution.csv").read_text().splitlines()
    for row in csv.DictReader(line for line in rows if line[0] != "#"):
        e = float(row.pop("nominal"))
        if e in (0.9, 0.5, 0.2):
            yield from ((law, e, float(delivered)) for law, delivered in row.items())
            yield "identified", e, e


@pytest.mark.parametrize("law, nominal, delivered", list(restitutions()))
def test_delivered_restitution(law, nominal, delivered):
    r = run(central_impact(law=law, restitution=nominal))
    _, speed, _, rebound = first_impact(r)
    assert rebound / speed == pytest.approx(delivered, abs=1e-4)
    lost = 0.5 * speed**2 * (1 - delivered**2)
    assert r["energy.work.impacts"][-1] == pytest.approx(-lost, rel=1e-3)
    assert energy_error(r) < 1e-4


TWO_IMPACTS = """
bodies: {{ball: {{mass: 1, inertia: 1e-3, at: [0, 0], velocity: [0.1, 0.03]}}}}
joints:
  pin: {{type: revolute, bodies: [ground, ball], at: [0, 0], clearance: 0.3 mm, contact: steel}}
contact_laws:
  steel: {{normal: lankarani_nikravesh, stiffness: internal, bearing_radius: 10 mm,
    youngs_modulus: 207 GPa, poisson: 0.3, restitution: 1}}
solver: {{method: dop853, end: 10 ms, tolerance: {tolerance!r}}}
output: {{every: 10 ms}}
"""


def test_the_first_step_after_a_touch():
    """What a force d^1.5 makes the first step off by, a method of high order may not see.

    At one of these eighty tolerances the ball had lost 48 tolerances of its speed, without loss.
    """
    for tolerance in 10.0 ** -np.arange(3, 11, 0.1):
        r = run(TWO_IMPACTS.format(tolerance=float(tolerance)))
        assert len(r.events) == 4
        assert r["ball.velocity"][-1, :2] == pytest.approx([0.1, 0.03], abs=tolerance)


ONE_IMPACT = """
gravity: [2.2e-4, 0]
bodies:
  bob:
    mass: 5.3
    inertia: 2e-3
    at: [0, 0]
    velocity: [-3e-5, 0]
    angular_velocity: [0, 0, -1.3e-3]
joints:
  pin: {{type: revolute, bodies: [ground, bob], at: [-7e-3, 25e-3],
    clearance: 0.29 mm, contact: soft}}
contact_laws:
  soft: {{normal: lankarani_nikravesh, stiffness: 2e4, bearing_radius: 6 mm, restitution: 0.93,
    slowest_impact: 2e-6}}
solver: {{method: dop853, end: 3, tolerance: {tolerance!r}}}
output: {{every: 3}}
"""


def test_a_step_made_again_to_end_where_a_contact_opens_is_held_to_the_tolerance():
    """Its own error counts, not that of the step that went further: one of 150 was off by 20."""

    def behind(tolerance):
        r = run(ONE_IMPACT.format(tolerance=float(tolerance)))
        assert len(r.events) == 2
        return np.append(
            r["bob.velocity"][-1, :2] / 3.4e-4, r["bob.angular_velocity"][-1, 2] / 0.018
        )

    exact = behind(1e-12)
    for tolerance in np.geomspace(1e-5, 1e-7, 150):
        assert behind(tolerance) == pytest.approx(exact, abs=3 * tolerance)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_bouncing_ball(tolerance):
    """A ball on a spring without damping: it comes back to its height, again and again."""
    text, (touch, contact, period) = bouncing_ball(tolerance=tolerance)
    r = run(text)
    times = r.events[:, EVENT_TIME]
    expected = np.array([(touch + k * period, touch + contact + k * period) for k in range(5)])
    assert times == pytest.approx(expected.ravel(), abs=20 * tolerance)
    assert r["ball.position"][-1, 1] == pytest.approx(r["ball.position"][0, 1], abs=20 * tolerance)
    assert energy_error(r) < 1e-4


def test_damped_stop_comes_to_rest():
    text, _ = bouncing_ball(damping=2000.0)
    r = run(text)
    assert abs(r["ball.velocity"][-1, 1]) < 1e-6
    assert r["floor.normal_force"][-1] == pytest.approx(9.81, rel=1e-4)
    assert r["floor.normal_force"].min() >= 0.0
    assert energy_error(r) < 1e-4


LAW = """
drives: {motor: {joint: A, velocity: 5}}
gravity: [0, -9.81]
contact_laws:
  pin: {normal: hunt_crossley, stiffness: 1e10, bearing_radius: 0.01, restitution: 0.5}
"""


def test_small_clearance_tends_to_the_ideal_joint():
    ideal = run(slider_crank("true", LAW, end=0.2))
    worst = {}
    for c in (100e-6, 10e-6, 1e-6):
        r = run(slider_crank("true", LAW, end=0.2).replace("1e-10", "1e-6"),
                f"joints.C.clearance={c}")  # fmt: skip
        assert len(r.events) > 0
        worst[c] = np.abs(r["slider.position"] - ideal["slider.position"]).max()
        assert 0.1 * c < worst[c] < 3 * c


@pytest.mark.parametrize("friction", [False, True])
def test_slider_crank_with_clearance_against_the_reference(friction):
    reference = table(f"p1_{'friction' if friction else 'frictionless'}.csv")
    errors = []
    for tolerance in (1e-5, 1e-6, 1e-8):
        some = []
        for part in np.geomspace(
            0.4, 1.0, size(8, 16)
        ).tolist():  # one error is anything from 0.1 to 20
            r = run(p1_slider_crank(friction, part * tolerance))
            assert r.t == pytest.approx(reference[:, 0], abs=1e-12)
            some.append(np.abs(r["slider.velocity"][:, 0] - reference[:, 1]).max() / 30)
            assert energy_error(r) < 1e-4
        assert max(some) < 100 * tolerance
        errors.append(np.exp(np.mean(np.log(some))))
    assert errors[0] > 3 * errors[1] > 9 * errors[2]
    assert errors[2] < 1e-6
    force = np.abs(r["C.normal_force"] - reference[:, 2]).max()
    assert force < 1e-4 * reference[:, 2].max()


STICKING = """
bodies: {{ball: {{mass: 1, inertia: 1e-3, at: [0, 0], velocity: [0.1, 0.03],
         angular_velocity: [0, 0, 5]}}}}
joints:
  pin: {{type: revolute, bodies: [ground, ball], at: [0, 0], clearance: 0.3 mm, contact: steel}}
contact_laws:
  steel: {{normal: lankarani_nikravesh, stiffness: internal, bearing_radius: 10 mm,
    youngs_modulus: 207 GPa, poisson: 0.3, restitution: 0.9, friction: {{law: sticking,
    coefficient: 0.3, stribeck_speed: 0.01, bristle_stiffness: 1e4}}}}
solver: {{method: {method}, end: {end!r}, tolerance: 1e-6}}
output: {{every: 10 ms}}
"""


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_bristles_begin_undeflected_at_every_touch(method):
    """What the touch before left of them stays as it is in flight, and is gone at the next."""

    def deflection(end):
        r = run(STICKING.format(method=method, end=end))
        model = r.mechanism.model
        return r.outcome.record.y[model.n_q + model.n_v + model.contact_state[0]]

    r = run(STICKING.format(method=method, end=0.02))
    touches = r.events[r.events[:, EVENT_KIND] == ONSET][:, EVENT_TIME]
    assert len(touches) >= 2
    left = abs(deflection(float(touches[1]) - 1e-7))
    assert left > 1e-6
    # it grows with the sliding speed, which is below 1 m/s
    assert abs(deflection(float(touches[1]) + 1e-9)) < 1e-8
