"""Events beside phases: what they do is their own, and phases go on as without them."""

import numpy as np
import pytest

from ..runs import run

TEXT = """
bodies: {slider: {mass: 3, inertia: 1}}
joints: {slide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
drives: {push: {joint: slide, velocity: 0}}
sensors: {x: {joint: slide}}
solver: {end: 1, tolerance: 1e-8}
output: {every: 10 ms}
phases:
  - {drive: {push: {velocity: 1}}, for: 0.2}
  - {drive: {push: {velocity: -0.5}}, for: 0.2}
  - {drive: {push: {velocity: 2}}, for: 0.1}
"""


def test_an_event_that_only_looks_begins_no_phase():
    """It happens in each of them: at 0.15 on the way there, back, and there again."""
    r = run(TEXT + "events: {seen: {when: x, value: 0.15, crosses: both, do: {record: true}}}\n")
    assert dict(r.outcome.fired)["seen"] == 3
    t = r.t
    expected = np.where(t <= 0.2, t, np.where(t <= 0.4, 0.3 - 0.5 * t, 2 * t - 0.7))
    assert r["x"] == pytest.approx(expected, abs=1e-8)
    assert r.outcome.time == pytest.approx(0.5)
