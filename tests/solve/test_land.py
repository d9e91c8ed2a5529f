"""What bringing a state back to the constraints gives to the mechanism: kinetic energy, and height
or whatever else its forces do work along."""

import numpy as np
import pytest

from trsim.assemble.equations import derivative, evaluate, kinetic, stored_energy
from trsim.assemble.projection import project_velocities
from trsim.assemble.reduce import jacobian
from trsim.elements.contract import SCENE, compiled
from trsim.elements.scene import scene
from trsim.kernels.packed import A1, f8
from trsim.kernels.signatures import void
from trsim.kernels.vectors import copy_to
from trsim.solve.march import record as rec
from trsim.solve.march.land import land

from ..runs import run

PENDULUM = """
planar: {planar}
gravity: [0, -9.81, 0]
bodies:
  arm: {{mass: 3, inertia: [0.1, 0.2, 0.3], at: [0.4, -0.3, 0], angle: 0.2}}
joints:
  hinge: {{type: {joint}, bodies: [ground, arm], at: [0, 0, 0]}}
forces:
  spring: {{type: spring_damper, bodies: [ground, arm], points: [[1, 0.5, {z}], [0.8, -0.5, 0]],
           stiffness: 200}}
solver: {{end: 0.2, tolerance: 1e-8, method: dop853}}
output: {{every: 0.2}}
"""


@compiled(void(SCENE, rec.RECORD, rec.BUFFERS, f8, A1, A1, A1))
def landed(s, r, b, t, y, yd, out):
    """The energy of a state, what `land` says it gave, and the energy behind it."""
    copy_to(b.y1, y)
    evaluate(s, t, y, yd)
    out[0] = kinetic(s, y) + stored_energy(s, t)
    out[1] = land(s, r, b, t, yd, 0)
    copy_to(y, b.y1)
    out[2] = kinetic(s, y) + stored_energy(s, t)


@pytest.mark.parametrize("planar, joint, z", [("true", "revolute", 0), ("false", "spherical", 0.3)])
def test_what_projection_gives_is_the_change_of_energy(planar, joint, z):
    """A pendulum on a spring, torn out of its hinge in any direction and turned."""
    ended = run(PENDULUM.format(planar=planar, joint=joint, z=z))
    model, r = ended.mechanism.model, ended.outcome.record
    s, rng = scene(model), np.random.default_rng(1)
    s.mem[:], s.branch[:] = r.mem, r.branch
    b = rec.fresh_buffers(model, r.y.size, 16, 16)
    changes = []
    for _ in range(20):
        y, yd, out = r.y.copy(), np.empty(r.y.size), np.empty(3)
        torn = rng.normal(size=model.n_q)
        y[: model.n_q] += 1e-6 * torn / np.linalg.norm(torn)
        landed(s, r, b, r.t, y, yd, out)
        before, given, after = out
        changes.append(after - before)
        # its forces, some 30 N, work along a micrometre; what is left out is of second order
        assert given == pytest.approx(after - before, abs=1e-9)
    assert np.abs(changes).max() > 1e-5


@pytest.mark.parametrize("torn", [1e-5, 1e-7, 1e-9])
@pytest.mark.parametrize("planar, joint, z", [("true", "revolute", 0), ("false", "spherical", 0.3)])
def test_places_and_velocities_keep_to_the_rows(planar, joint, z, torn):
    """Whether the last Newton step was a large one, or so small that it is not factorised again:
    its square is left of places, and the velocities are those of the rows there."""
    ended = run(PENDULUM.format(planar=planar, joint=joint, z=z))
    model, r = ended.mechanism.model, ended.outcome.record
    s, rng = scene(model), np.random.default_rng(2)
    s.mem[:], s.branch[:] = r.mem, r.branch
    b = rec.fresh_buffers(model, r.y.size, 16, 16)
    for _ in range(5):
        y, yd, out = r.y.copy(), np.empty(r.y.size), np.empty(3)
        y[: model.n_q] += torn * rng.normal(size=model.n_q)
        landed(s, r, b, r.t, y, yd, out)
        derivative(s, r.t, y, yd)
        assert np.abs(s.V).max() > 0.5
        assert project_velocities(s, y.copy()) < 1e-13 * np.abs(s.V).max()
        assert np.abs(jacobian(model, r.t, y)[0]).max() < 1e-12 * model.size
