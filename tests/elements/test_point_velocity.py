"""Point velocity: components along axes that turn, the speed, loads without corners, events."""

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, USER

from ..runs import built, run

TUMBLING = """
planar: false
bodies:
  left: {mass: 2, inertia: [0.02, 0.03, 0.04], velocity: [1, 0, 0], angular_velocity: [3, 1, -2]}
  right: {mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, -0.1], velocity: [1, 0.5, 0.7],
          angular_velocity: [5, 0, 2]}
points:
  tip: {body: right, at: [0.7, 0.3, 0.4]}
  eye: {body: left, at: [0, 0, 0], x_axis: [1, 2, 2], y_axis: [0, 1, 0]}
sensors:
  fixed: {type: point_velocity, body: right, at: tip, axis: [0, 3, 4]}
  turning: {type: point_velocity, body: right, at: tip, axis: eye.x, frame: eye}
  speed: {type: point_velocity, body: right, at: tip}
solver: {end: 1, tolerance: 1e-11}
output: {every: 1 ms, channels: ["*", "*.rotation"]}
"""


def test_values_and_rates():
    r = run(TUMBLING)
    v = r["tip.velocity"]
    x = r["eye.rotation"].reshape(-1, 3, 3)[:, :, 0]
    assert r["fixed"] == pytest.approx(v @ [0, 0.6, 0.8], abs=1e-12)
    assert r["turning"] == pytest.approx(np.einsum("nb,nb->n", x, v), abs=1e-12)
    assert r["speed"] == pytest.approx(np.linalg.norm(v, axis=1), abs=1e-12)
    for name in ("fixed", "turning", "speed"):
        slope = (r[name][2:] - r[name][:-2]) / 2e-3
        rate = r[f"{name}.rate"]
        assert slope == pytest.approx(rate[1:-1], abs=1e-4 * np.abs(rate).max())


DRAG = """
bodies: {ball: {mass: 2, inertia: 1, velocity: [8, 0]}}
sensors: {v: {type: point_velocity, body: ball, at: [0, 0], axis: [1, 0]},
          w: {type: point_velocity, body: ball, at: [0, 0]}}
forces: {drag: {type: applied_load, body: ball, direction: [1, 0], force: -0.5*v*w}}
events: {slow: {when: v, value: 4, crosses: down, do: {record: true}}}
solver: {end: 2, method: METHOD}
output: {every: 0.1}
"""


@pytest.mark.parametrize("method", ["dop853", "radau, tolerance: 1e-8", "rk4, step: 5e-3"])
def test_quadratic_drag(method):
    """m v' = -c v^2: v = v0 / (1 + c v0 t / m), at half the speed after m / (c v0)."""
    r = run(DRAG.replace("METHOD", method))
    assert r["v"] == pytest.approx(8 / (1 + 2 * r.t), abs=1e-5)
    times = r.events[r.events[:, EVENT_KIND] == USER][:, EVENT_TIME]
    assert times == pytest.approx([0.5], abs=1e-6)
    assert r["v.rate"] == pytest.approx(-0.25 * r["v"] ** 2, abs=1e-9)
    assert any("sampled, not bounded" in note for note in r.mechanism.notes)
    assert r.outcome.statistics["energy_residual_relative"] < 1e-5


def test_from_rest_the_rate_of_the_speed_is_the_acceleration():
    r = run(DRAG.replace("METHOD", "auto").replace("velocity: [8, 0]", "").replace(
        "-0.5*v*w", "3"))  # fmt: skip
    assert r["w.rate"] == pytest.approx(np.full(r.t.size, 1.5), abs=1e-9)


@pytest.mark.parametrize("force", ["abs(v)", "{table: [[0, 1], [1, 2]], of: v}", "(w > 3)*2"])
def test_a_corner_that_it_meets_is_refused(force):
    text = DRAG.replace("METHOD", "auto").replace("-0.5*v*w", f"{force}")
    with pytest.raises(TrsimError, match="corner") as caught:
        built(text)
    [error] = caught.value.problems
    assert error.path[:3] == ("forces", "drag", "force")


@pytest.mark.parametrize("force", ["-3*v.rate", "{table: [[0, 1], [1, 2]], of: v.rate}"])
def test_its_rate_is_an_acceleration_and_in_no_load(force):
    with pytest.raises(TrsimError, match="once the accelerations are") as caught:
        built(DRAG.replace("METHOD", "auto").replace("-0.5*v*w", force))
    [error] = caught.value.problems
    assert error.path[:3] == ("forces", "drag", "force")


def test_refused():
    with pytest.raises(TrsimError, match="must not be zero"):
        built(DRAG.replace("METHOD", "auto").replace("axis: [1, 0]", "axis: [0, 0]"))
    with pytest.raises(TrsimError, match="wrong unit: 'mm'; 'v' is in m/s"):
        built(DRAG.replace("METHOD", "auto").replace("value: 4", "value: 4 mm"))
