"""Sections asked for after a run: what they say of their errors, against located points."""

from pathlib import Path

import numpy as np
import pytest

from tests import small
from trsim.analyse.section import asked, crossings, faint, passed_over, section
from trsim.assemble.assemble import assemble
from trsim.errors import UsageError
from trsim.scenario.load import load, loads
from trsim.solve.simulate import simulate
from trsim.store.hdf5 import write
from trsim.store.read import read

SCENARIOS = Path(__file__).parents[2] / "scenarios"

NO_EVENTS = np.zeros(0)


@pytest.mark.parametrize("crosses, exact", [
    ("up", np.arange(1, 11)), ("down", np.arange(0, 10) + 0.5), ("both", np.arange(1, 21) / 2),
])  # fmt: skip
def test_crossings_by_cubics(crosses, exact):
    """sin crosses zero at known times; errors fall with the fourth power, the stated ones too."""
    worst, stated = [], []
    for n in (400, 800):
        time = np.linspace(0.02, 10.02, n)
        w, x = np.sin(2 * np.pi * time), np.cos(2 * np.pi * time)
        t, at_x, at_y, *errors = crossings(time, w, x, w, crosses, NO_EVENTS)
        assert len(t) == len(exact)
        for found, true, error in zip(
            (t, at_x), (exact, np.cos(2 * np.pi * exact)), errors, strict=False
        ):
            assert np.all(np.abs(found - true) <= error)
        worst.append(np.abs(t - exact).max())
        stated.append(errors[0].max())
        np.testing.assert_allclose(at_y, 0.0, atol=1e-12)
    assert worst[1] < worst[0] / 12.0 and stated[1] < stated[0] / 12.0
    assert stated[1] < 100.0 * worst[1]  # an error so large that it says nothing would cover all


@pytest.mark.parametrize("left", [0.0, -1e-20, 1e-20])
def test_a_start_on_zero_is_no_crossing(left):
    """Whatever rounding leaves of it."""
    time = np.linspace(0.0, 2.2, 111)
    w = np.sin(2 * np.pi * time) * (-1.0 if left > 0.0 else 1.0)
    w[0] = left
    assert crossings(time, w, w, w, "both", NO_EVENTS)[0] == pytest.approx([0.5, 1.0, 1.5, 2.0])


@pytest.mark.parametrize("shares", [(0.0, 1.0), (1.0, 0.0), (1.0, 1.0)], ids=str)
def test_stated_errors_cover_the_scatter_of_rows(shares):
    """Rows tremble about a slow motion, and so does the motion where it crosses."""
    rng, size = np.random.default_rng(3), 1e-4
    time = np.arange(0.0, 500.0, 0.02)
    w = np.sin(2 * np.pi * time) + size * shares[0] * rng.normal(size=len(time))
    y = np.cos(1.7 * time) + size * shares[1] * rng.normal(size=len(time))
    t, at_x, at_y, *errors = crossings(time, w, time, y, "both", NO_EVENTS)
    assert len(t) == 999
    true_t = np.round(2.0 * t) / 2.0 + size * shares[0] * rng.normal(size=len(t)) / (2 * np.pi)
    true_y = np.cos(1.7 * true_t) + size * shares[1] * rng.normal(size=len(t))
    for found, true, error in zip((t, at_x, at_y), (true_t, true_t, true_y), errors, strict=True):
        off = np.abs(found - true)
        assert np.mean(off <= error + 1e-9) > 0.95
        assert np.median(error) < 6.0 * np.sqrt(np.mean(off**2)) + 1e-5  # it says something


def test_a_kink_between_the_rows_is_told():
    """|t - 0.5| - 0.3 with a kink at 0.5: the straight line counts where an event says so."""
    time = np.linspace(0.0, 1.0, 101)
    w = time - 0.5 + 0.003 * np.sign(time - 0.502)  # a jump that rows around it cannot show
    smooth = crossings(time, w, w, w, "up", NO_EVENTS)
    kinked = crossings(time, w, w, w, "up", np.array([0.502]))
    assert kinked[3][0] >= smooth[3][0]


@pytest.mark.parametrize("sets", [
    (), ("output.every=2us",), ("output.every=50us",), ("output.every=20us", "solver.end=20ms"),
], ids=str)  # fmt: skip
def test_stated_errors_cover_the_true_ones(sets, tmp_path):
    """Every point against the located one of the same run."""
    small.run(tmp_path / "run.h5", *sets)
    run = read(tmp_path / "run.h5")
    located = run.poincare["journal"]
    found = section(run, "B.eccentricity_x_rate", "B.eccentricity_x", "B.eccentricity_y")
    assert 2 < len(found.time) <= len(located.time)
    nearest = np.abs(located.time[:, None] - found.time).argmin(axis=0)
    for axis in ("time", "x", "y"):
        true = np.abs(getattr(found, axis) - getattr(located, axis)[nearest])
        error = getattr(found, f"{axis}_error")
        assert np.all(true <= error + 1e-15), axis
    assert found.worst[0] == found.time_error.max()
    assert found.unresolved == 0


def test_stated_errors_of_the_thrust_reverser(tmp_path):
    """Rows ten times as coarse as its own, so that there is an error to state, of three runs: of
    the twenty points of one a single one would be more than the 5 % that may be beyond it."""
    covered: dict[str, list[bool]] = {"time": [], "x": [], "y": []}
    for k in range(3):
        file = SCENARIOS / "thrust_reverser/clearance_b_0.3mm.yaml"
        other = f"joints.B.clearance={3e-4 * (1 + 1e-3 * k)!r}"
        scenario = load(file, ["solver.end=0.45", "output.every=0.5 ms", other])
        mechanism = assemble(scenario)
        write(tmp_path / f"{k}.h5", scenario, mechanism, simulate(scenario, mechanism))
        run = read(tmp_path / f"{k}.h5")
        located = run.poincare["B_orbit"]
        found = section(run, "B.eccentricity_x_rate", "B.eccentricity_x", "B.eccentricity_y")
        assert 10 < len(found.time) <= len(located.time)
        nearest = np.abs(located.time[:, None] - found.time).argmin(axis=0)
        for axis, seen in covered.items():
            true = np.abs(getattr(found, axis) - getattr(located, axis)[nearest])
            seen.extend(true <= getattr(found, f"{axis}_error") + 1e-15)
    for axis, seen in covered.items():
        assert np.mean(seen) > 0.95, axis


def test_swings_that_are_not_resolved_are_counted(tmp_path):
    """Across its guide a body trembles by rounding, or rests; along it its motion is real."""
    text = """
bodies: {b: {mass: 1, inertia: 1, at: [0.1, 0], velocity: [1, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
forces: {s: {type: spring_damper, bodies: [ground, b], points: [[-1, 0.5], [0.1, 0]],
         stiffness: 100}}
solver: {end: 5}
output: {every: 0.01, channels: ["*"]}
"""
    scenario = loads(text)
    mechanism = assemble(scenario)
    write(tmp_path / "r.h5", scenario, mechanism, simulate(scenario, mechanism))
    run = read(tmp_path / "r.h5")
    across = section(run, "b.position.y", "b.position.x", "b.velocity.x", "both")
    assert across.faint >= len(across.time) - 1
    assert section(run, "b.velocity.x", "b.position.x", "b.velocity.x", "both").faint == 0
    trembling = np.array([1.0, -1e-12, 1e-12, -1e-12, 1.0, -1.0])
    assert faint(run, "b.position.y", trembling) == 3
    assert faint(run, "b.position.y", trembling[:2]) == 0


def test_touches_between_two_rows():
    time = np.arange(5.0)
    onset, separation = np.array([0.2, 1.5, 3.1]), np.array([0.8, 2.5])
    assert passed_over(time, (onset, separation)) == 1


def test_asked():
    told = asked("when=B.x,plot=a:b.rate")
    assert told == {"when": "B.x", "crosses": "up", "x": "a", "y": "b.rate"}
    for text in ("plot=a:b", "when=a", "when=a,plot=b", "when=a,plot=b:c:d", "wen=a,plot=b:c", ""):
        with pytest.raises(UsageError, match=r"--section|plot="):
            asked(text)


def test_refused(tmp_path):
    small.run(tmp_path / "run.h5")
    run = read(tmp_path / "run.h5")
    for arguments, what in (
        (("stroke", "stroke", "nope"), "no channel named 'nope'"),
        (("B.force", "stroke", "stroke"), "'B.force' has 3 components"),
        (("stroke", "stroke", "stroke", "upp"), "crosses must be one of"),
    ):
        with pytest.raises(UsageError, match=what):
            section(run, *arguments)


def test_a_key_that_is_there_twice_is_refused():
    with pytest.raises(UsageError, match="has when= twice"):
        asked("when=stroke,when=B.x,plot=a:b")
