"""Radau's error estimate goes through the matrix of the step, and once more where it is large.

For v' = -c v / m it is (GAMMA/h + c/m)^-1 (f(v) + sum E_i Z_i / h), and with what that says f is
evaluated again: of a decay that no step sees, the first says as much as there was.
"""

import numpy as np
import pytest

from trsim.assemble.equations import derivative
from trsim.elements.scene import scene
from trsim.scenario.load import loads
from trsim.solve.march import record as rec
from trsim.solve.methods import ggl_tables, radau, radau_ggl
from trsim.solve.methods.radau_tableau import GAMMA, A, E
from trsim.solve.outcome import settings

from ..runs import run

DAMPED = """
bodies: {block: {mass: 2, inertia: 0.01, velocity: [1, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
forces:
  damper: {type: spring_damper, bodies: [ground, block], points: [[-9, 0], [0, 0]], stiffness: 0,
           damping: 2000}
solver: {end: 1e-9, method: radau, tolerance: 1e-4, first_step: 1e-9}
"""
RATE = -1000.0  # 1/s, of the decay
METHODS = {"index1": radau, "ggl": radau_ggl}


def tried(formulation, h, weight, again, text=DAMPED, place=None):
    """Error of the speed that a step of this length estimates, and the speed it begins with.

    weight: of the speed in the error norm, which sees nothing else; again: 1 after a rejection;
    place: of another entry of y than the speed.
    """
    method = METHODS[formulation]
    scenario = loads(text, [f"solver.formulation={formulation}"])
    ended = run(scenario)
    mechanism, r = ended.mechanism, ended.outcome.record
    s, setting = scene(mechanism.model), settings(scenario, mechanism)
    b = rec.fresh_buffers(s, r.y.size, method.STAGES, method.DENSE_ROWS)
    if method is radau_ggl:
        b = ggl_tables.buffers(b, mechanism, mechanism.model)
    b.weight[:] = 0.0
    place = s.n_q if place is None else place
    b.weight[place] = weight
    derivative(s, r.t, r.y, r.yd)
    r.jacobian, r.history = rec.NO_JACOBIAN, rec.NO_HISTORY
    r.after_rejection = again
    assert method.step(s, r, b, setting, r.t, h) != radau.HALVE
    return b.K[radau.F, place], r.y[place]


def estimates(h, v):
    """The estimate in closed form, and the second one."""
    Z = np.linalg.solve(np.eye(3) - h * RATE * A, h * RATE * v * A.sum(axis=1))
    once = (RATE * v + E @ Z / h) / (GAMMA / h - RATE)
    return once, (RATE * (v + once) + E @ Z / h) / (GAMMA / h - RATE)


@pytest.mark.parametrize("formulation", METHODS)
@pytest.mark.parametrize("again", [0, 1])
@pytest.mark.parametrize("h", [1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0])
def test_estimate_of_a_decay(h, again, formulation):
    small, v = tried(formulation, h, 1e-6, again)
    once, twice = estimates(h, v)
    assert small == pytest.approx(once, rel=1e-5)
    large, _ = tried(formulation, h, 2.0 / abs(once), again)
    assert large == pytest.approx(twice, rel=1e-4)
    if h >= 0.1:  # over hundreds of decays the first is all the speed there was
        assert abs(once) > 0.8 * v > 20.0 * abs(twice)


DRIVEN = (
    DAMPED.replace("velocity: [1, 0]", "velocity: [3, 0]")
    + """
drives: {push: {joint: slide, velocity: 3 + (200*t)**3, compliance: {stiffness: 10}}}
"""
)


@pytest.mark.parametrize("formulation", METHODS)
@pytest.mark.parametrize("h", [1e-3, 1e-2])
def test_estimate_of_a_state(h, formulation):
    """The last entry of y, a drive's way: z' = f(t) goes with h/GAMMA alone."""
    found, _ = tried(formulation, h, 1e-9, 1, DRIVEN, -1)
    speeds = 3 + (200 * h * A.sum(axis=1)) ** 3
    assert found == pytest.approx((3 + E @ A @ speeds) * h / GAMMA, rel=1e-6)
