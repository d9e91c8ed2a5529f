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
