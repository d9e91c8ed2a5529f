"""`auto` takes the implicit method where steps are held by what is stiff, and gives it back."""

import numpy as np
import pytest

from trsim.solve.march import record as rec
from trsim.solve.methods.auto import EXPLICIT, IMPLICIT

from ..runs import run

# a block on a strong damper, m v' = F(t) - c v, which decays in 0.1 ms
DAMPED = """
bodies: {{block: {{mass: 2, inertia: 0.01}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
forces:
  damper: {{type: spring_damper, bodies: [ground, block], points: [[-9, 0], [0, 0]], stiffness: 0,
           damping: 20000}}
  load: {{type: applied_load, body: block, direction: [1, 0], force: "{force}"}}
solver: {{end: {end}, method: auto, tolerance: 1e-6}}
{more}
"""


def changes(r):
    """Times at which the implicit method was taken, and given back."""
    kind, time = r.events[:, rec.EVENT_KIND], r.events[:, rec.EVENT_TIME]
    return time[kind == rec.TO_IMPLICIT], time[kind == rec.TO_EXPLICIT]


def test_what_stays_stiff_stays_implicit():
    r = run(DAMPED.format(force="200*t", end=1, more=""))
    taken, given_back = changes(r)
    assert len(taken) == 1 and len(given_back) == 0
    assert r.outcome.record.method == IMPLICIT


def test_it_is_given_back_where_steps_are_short_anyway():
    """From 0.5 s on the load swings ten times as fast as the damper decays."""
    swings = "200*t + 2e5*max(0, t - 0.5)*sin(1e5*t)"
    r = run(DAMPED.format(force=swings, end=0.51, more=""))
    taken, given_back = changes(r)
    assert taken[0] < 0.5
    assert len(given_back) >= 1 and 0.5 < given_back[0] < 0.51
    assert r.outcome.record.method == EXPLICIT


@pytest.mark.parametrize("at", [0.4, 0.6])
def test_it_is_given_back_at_an_event(at):
    more = f"events: {{tick: {{when: t, value: {at}, do: {{record: true}}}}}}"
    r = run(DAMPED.format(force="200*t", end=1, more=more))
    taken, given_back = changes(r)
    assert given_back == pytest.approx([at], abs=1e-12)
    assert len(taken) == 2 and taken[0] < at < taken[1]
    assert np.all(r["block.velocity"][-1, :1] > 0.0)


# two masses slide along a hub that turns, on springs and dampers: what is seen of these is nothing
GOVERNOR = """
bodies:
  hub: {{mass: 1, inertia: 0.1}}
  left: {{mass: 1, inertia: 0.01, at: [0.1, 0]}}
  right: {{mass: 1, inertia: 0.01, at: [-0.1, 0]}}
joints:
  pin: {{type: revolute, bodies: [ground, hub], at: [0, 0]}}
  out: {{type: prismatic, bodies: [hub, left], axis: [1, 0, 0], at: [0.1, 0]}}
  back: {{type: prismatic, bodies: [hub, right], axis: [-1, 0, 0], at: [-0.1, 0]}}
drives: {{motor: {{joint: pin, velocity: "10 + 5*sin({turn}*t)"}}}}
forces:
  s1: {{type: joint_spring, joint: out, elastic: "2000*stretch", damper: "{damping}*rate"}}
  s2: {{type: joint_spring, joint: back, elastic: "2000*stretch", damper: "{damping}*rate"}}
solver: {{end: {end}, tolerance: {tolerance}, method: {method}}}
output: {{every: {end}}}
"""


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_a_decay_that_nothing_is_seen_of(tolerance):
    """It dies out in 0.1 ms; steps were held by it for seconds, the more the tighter."""
    of = {
        method: run(GOVERNOR.format(turn=2, damping=1e4, end=2, tolerance=tolerance, method=method))
        for method in ("auto", "radau")
    }
    taken, given_back = changes(of["auto"])
    assert len(taken) == 1 and len(given_back) == 0
    steps, needed = (of[method].outcome.statistics["evaluations"] for method in ("auto", "radau"))
    assert steps < 1.5 * needed
    a, b = (of[method]["left.position"][-1] for method in ("auto", "radau"))
    assert np.abs(a - b).max() < 20 * tolerance * 0.1


def test_patience_grows_where_the_implicit_method_is_no_better():
    """The motion asks for steps that are as short as the decay: it is tried ever more rarely."""
    text = GOVERNOR.format(turn=200, damping=3000, end=3, tolerance=1e-7, method="auto")
    r = run(text)
    taken, given_back = changes(r)
    assert 2 <= len(taken) <= 8 and len(given_back) >= len(taken) - 1
    alone = run(text.replace("method: auto", "method: dop853"))
    both = [x.outcome.statistics["evaluations"] for x in (r, alone)]
    assert both[0] < 1.3 * both[1]


LOCKED = """
gravity: [0, -9.81]
bodies:
  leg: {mass: 13.6, inertia: 0.9, at: [0.1, -0.5]}
  up: {mass: 2, inertia: 0.02, at: [0.35, -0.1]}
  lo: {mass: 2, inertia: 0.02, at: [0.3, -0.35]}
joints:
  trunnion: {type: revolute, bodies: [ground, leg], at: [0, 0]}
  a: {type: revolute, bodies: [ground, up], at: [0.6, 0]}
  b: {type: revolute, bodies: [up, lo], at: [0.4, -0.25]}
  c: {type: revolute, bodies: [leg, lo], at: [0.1, -0.45]}
sensors: {angle: {joint: trunnion}}
forces:
  spring: {type: spring_damper, bodies: [ground, lo], points: [[0.3, 0.1], [0.38, -0.26]],
           stiffness: 800, damping: 20, free_length: 0.2}
events: {stop: {when: angle, value: 5 deg, crosses: up, times: 1, do: {lock: [b]}}}
solver: {end: 10, tolerance: 1e-10}
"""


def test_what_is_locked_at_rest_is_not_stiff():
    """Quotients of two roundings were rates of 1e16 1/s there."""
    r = run(LOCKED)
    assert np.any(r.events[:, rec.EVENT_TIME] < 0.5)
    assert np.abs(r["leg.angular_velocity"][-1]).max() < 1e-9
    assert not len(changes(r)[0])
