"""Known problems of multibody dynamics: P3, P4, P5, and A01, A03 of the IFToMM library.

References with their origin are in tests/data; the chain also has equations of its own in
tests/directors.py.
"""

import json

import numpy as np
import pytest

from benchmarks.problems import (
    LENGTH,
    VALIDATION,
    bending_chain,
    chain,
    windows,
    zigzag_rods,
)
from trsim.scenario.load import load

from ..directors import tip as tip_of_directors
from ..mechanisms import DATA
from ..runs import run

ANGLES = ("Beta", "Theta", "Gamma", "Phi", "Delta", "Omega", "Epsilon")


def reference(name):
    return json.loads((DATA / name).read_text())


def energy(r):
    """Kinetic and stored energy beyond that of the start, J."""
    total = sum(r[f"energy.{kind}"] for kind in ("kinetic", "stored.springs", "stored.gravity"))
    return total - total[0]


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("windows_2", windows(2)),
        ("chain_10", chain(10)),
        ("bending_chain_10", bending_chain(10)),
    ],
)
def test_the_files_are_what_the_generator_writes(file, text):
    assert (VALIDATION / f"{file}.yaml").read_text() == text


# --- Andrews' squeezing mechanism --------------------------------------------------------------


@pytest.mark.parametrize(("tolerance", "bound"), [(1e-8, 1e-6), (1e-11, 1e-11)])
def test_andrews(tolerance, bound):
    """P3.  The published angles are 1.4e-9 rad away from four computations that agree to 1e-12."""
    r = run(load(VALIDATION / "andrews.yaml", [f"solver.tolerance={tolerance}"]))
    known = reference("p3_andrews.json")
    angles = [r[name][-1] for name in ANGLES]
    assert angles == pytest.approx(known["recomputed_angles"], abs=bound)
    assert angles == pytest.approx(known["angles"], abs=max(bound, 2e-9))
    rates = [r[f"{name}.rate"][-1] for name in ANGLES]
    assert rates == pytest.approx(known["rates"], abs=max(1e3 * bound, 2e-6))


def test_andrews_from_the_round_angle():
    """A03: the pin F, and the energy gained against the work of the motor."""
    r = run(load(VALIDATION / "andrews_iftomm.yaml", ["solver.tolerance=1e-11"]))
    known = reference("a03_andrews_iftomm.json")
    beta = r["Beta"]
    F = known["crank"] * np.array([np.cos(beta[-1]), np.sin(beta[-1])])
    assert pytest.approx(known["F"], abs=1e-7) == F
    assert beta[-1] == pytest.approx(known["beta"], abs=1e-6)
    assert np.abs(energy(r) - known["motor"] * (beta - beta[0])).max() < 1e-9


# --- pendulum ----------------------------------------------------------------------------------


def test_pendulum():
    """A01: energy, place after 10 s, speed and height of the lowest point."""
    r = run(load(VALIDATION / "pendulum_a01.yaml"))
    known = reference("a01_pendulum.json")
    assert np.abs(energy(r)).max() < 5e-5
    assert r["ball.position"][-1, :2] == pytest.approx(known["position"], abs=1e-5)
    assert np.linalg.norm(r["ball.velocity"], axis=1).max() <= known["largest_speed"] + 1e-5
    assert r["ball.position"][:, 1].min() == pytest.approx(-1.0, abs=1e-3)


# --- windows -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("n", "tolerance"),
    [
        *((2, tolerance) for tolerance in (1e-5, 1e-6, 1e-7, 1e-8)),
        *((10, tolerance) for tolerance in (1e-5, 1e-6, 1e-7, 1e-8)),
    ],
)
def test_windows(n, tolerance):
    """P4: through ten singular positions on the right branch."""
    r = run(windows(n), f"solver.tolerance={tolerance}")
    known = reference("p4_windows.json")
    theta = np.interp(known["t"], r.t, r["theta"])
    assert theta == pytest.approx(known[str(n)]["theta"], abs=1e-3)  # the branch
    assert np.abs(energy(r)).max() < 1e-3
    at = known[str(n)]["theta"][-1]
    place = 2.0 * r["upright0.position"][-1, :2]
    assert place == pytest.approx([np.sin(at), np.cos(at)], abs=max(1e-5, 2 * tolerance))


def test_rows_inside_steps_past_singular_positions():
    """P4: every row has the acceleration of its angle, and the rate of its energy."""
    k, tolerance = 11.445, 1e-7
    r = run(windows(2), f"solver.tolerance={tolerance}")
    theta, rate = r["theta"], r["theta.rate"]
    off = r["theta.acceleration"] - k * np.sin(theta)
    assert np.abs(off).max() < 30 * tolerance * k
    lost = 0.5 * rate**2 + k * np.cos(theta) - 0.5 - k
    assert np.abs(lost).max() < tolerance * 2 * k


# --- chains ------------------------------------------------------------------------------------


def tip(r, n):
    """End of the last rod at the end of the run, m."""
    rotation = r[f"rod{n - 1}.rotation"][-1].reshape(3, 3)
    return r[f"rod{n - 1}.position"][-1] + rotation @ [0.5 * LENGTH, 0.0, 0.0]


def run_chain(text, n, tolerance):
    last = f"rod{n - 1}"
    channels = f'output.channels=["{last}.*", "{last}.rotation", "energy.*"]'
    return run(text, f"solver.tolerance={tolerance}", channels)


@pytest.mark.parametrize("n", [10, 40])
def test_chain(n):
    """P5."""
    r = run_chain(chain(n), n, 1e-8)
    assert tip(r, n) == pytest.approx(reference("p5_chains.json")["straight"][str(n)], abs=1e-8)


@pytest.mark.parametrize(("n", "bound"), [(10, 1e-10), (40, 1e-9)])
def test_bending_chain(n, bound):
    r = run_chain(bending_chain(n), n, 1e-12)
    assert tip(r, n) == pytest.approx(reference("p5_chains.json")["bending"][str(n)], abs=bound)
    assert np.abs(energy(r)).max() < 1e-9 * n


def test_reference_of_the_bending_chain():
    """The numbers in the data file are those of the directors' equations."""
    known = reference("p5_chains.json")["bending"]["10"]
    assert tip_of_directors(zigzag_rods(10), tolerance=1e-12) == pytest.approx(known, abs=1e-11)
