"""P2: a soft bar on a ball joint, whirling in space, against independent results of its mesh."""

from pathlib import Path

import numpy as np
import pytest

from trsim.assemble.band import scalar_mass
from trsim.scenario.load import load
from trsim.solve.start.bars import places

from ..runs import run

ROOT = Path(__file__).parents[2]
SCENARIO = ROOT / "scenarios" / "validation" / "flexible_pendulum.yaml"


def reference(n):
    """Tip and middle every 10 ms, (201, 6)."""
    lines = (ROOT / f"tests/data/p2_pendulum_{n}_elements.csv").read_text().splitlines()
    return np.array([[float(x) for x in s.split(",")[1:]] for s in lines if s[0] in "0123456789"])


def pendulum(*sets):
    return run(load(SCENARIO, list(sets)))


def error(r, n):
    return np.abs(np.hstack([r["rod.tip"], r["rod.middle"]]) - reference(n)).max()


def about_the_vertical(r, y):
    """Angular momentum about y of a state: int rho A (r x r')_y dx = r^T M r' of z and x."""
    m, beam = r.mechanism, r.mechanism.beams["rod"]
    (p, slope), M = places(m, beam, y), scalar_mass(beam)
    v = y[m.model.n_q : m.model.n_q + m.model.n_v]
    v = v.reshape(beam.nodes, 2, 3)
    q = np.stack([p, slope], axis=1)
    x, z = (part.reshape(-1, 3)[:, (0, 2)].T for part in (q, v))
    return x[1] @ M @ z[0] - x[0] @ M @ z[1]


@pytest.mark.parametrize(
    ("n", "method", "tolerance", "bound"),
    [
        (8, "dop853", 1e-8, 1e-8),
        (8, "radau", 1e-7, 1e-8),
        (16, "dop853", 1e-7, 1e-8),
        (16, "radau", 2e-4, 1.2e-5),
    ],
)
def test_same_mesh(n, method, tolerance, bound):
    r = pendulum(
        f"bodies.rod.elements={n}", f"solver.method={method}", f"solver.tolerance={tolerance}"
    )
    print(f"{n} elements, {method} {tolerance:g}: {error(r, n):.1e} m")
    assert error(r, n) < bound


def test_formulations_agree():
    """Tangents of elements stand right in the sparse Jacobian: steps as many, and as good."""
    sets = ("solver.method=radau", "solver.tolerance=1e-4", "solver.end=1")
    one, two = (pendulum(*sets, f"solver.formulation={f}") for f in ("index1", "ggl"))
    steps = [
        r.outcome.statistics["steps"] + r.outcome.statistics["rejected_steps"] for r in (one, two)
    ]
    assert steps[1] < 1.1 * steps[0]
    assert np.abs(one["rod.tip"] - two["rod.tip"]).max() < 1e-5


def test_conserved():
    r = pendulum("solver.method=dop853", "solver.tolerance=1e-9")
    assert r.outcome.statistics["energy_residual_relative"] < 1e-8
    before, after = (about_the_vertical(r, y) for y in (r.mechanism.y0, r.outcome.record.y))
    print(f"angular momentum {before:.12g} -> {after:.12g}")
    bar = r.scenario.bodies["rod"]
    assert before == pytest.approx(4.0 * bar.per_length * bar.length**3 / 3.0, rel=1e-12)
    assert after == pytest.approx(before, rel=1e-9)


def test_damping_is_booked():
    """A bar that resists its deformation loses what it resists, and nothing else."""
    sets = ("solver.method=dop853", "solver.tolerance=1e-8", "solver.end=0.5")
    r = pendulum(*sets, "bodies.rod.damping=1e-3", "bodies.rod.curvature=exact")
    lost = r["energy.work.dampers"]
    assert lost[-1] < 0.0
    assert np.all(np.diff(lost) <= 1e-12)
    assert r.outcome.statistics["energy_residual_relative"] < 1e-8
