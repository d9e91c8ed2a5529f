from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from tests import small
from trsim.errors import ScenarioError
from trsim.solve.simulate import simulate
from trsim.store import points
from trsim.store.hdf5 import write
from trsim.store.read import read


def test_default_phase_portraits(result):
    assert set(result.phase) == {"stroke", "crank_angle", "B"}
    portrait = result.phase["B"]
    assert portrait.definition == {"x": "B.eccentricity_x", "y": "B.eccentricity_x_rate"}
    np.testing.assert_array_equal(portrait.x, result.channel("B.eccentricity_x"))
    assert (portrait.x_unit, portrait.y_unit) == ("m", "m/s")


def test_declared_phase_portrait_of_components(tmp_path):
    text = small.SLIDER_CRANK + "phase_portraits:\n  path: {x: rod.position.x, y: rod.velocity.y}\n"
    small.run(tmp_path / "run.h5", text=text)
    result = read(tmp_path / "run.h5")
    assert list(result.phase) == ["path"]
    np.testing.assert_array_equal(result.phase["path"].x, result.channel("rod.position")[:, 0])
    np.testing.assert_array_equal(result.phase["path"].y, result.channel("rod.velocity")[:, 1])


def test_poincare_section(result):
    section = result.poincare["journal"]
    assert section.definition["method"] == points.LOCATED
    assert section.definition["when"] == "B.eccentricity_x_rate"
    assert (section.x_unit, section.y_unit) == ("m", "m")
    assert points.surface(section.definition) == "B.eccentricity_x_rate crosses zero upwards"
    rate = result.channel("B.eccentricity_x_rate")
    assert abs(rate[0]) < 1e-15  # at rest: where it starts it does not cross
    rising = 1 + np.flatnonzero((rate[1:-1] < 0.0) & (rate[2:] >= 0.0))
    assert len(section.time) == len(rising) > 2
    for time, x, k in zip(section.time, section.x, rising, strict=True):
        assert result.time[k] <= time <= result.time[k + 1]
        assert x == pytest.approx(result.channel("B.eccentricity_x")[k], abs=2e-5)


def test_dispersion(result):
    section = result.poincare["journal"]
    x, y = section.x - section.x.mean(), section.y - section.y.mean()
    told = section.dispersion
    assert told.points == len(x)
    assert (told.x, told.y) == pytest.approx((np.sqrt(np.mean(x**2)), np.sqrt(np.mean(y**2))))
    assert told.radius == pytest.approx(np.sqrt(np.mean(x**2 + y**2)), rel=1e-12)
    stored = {name: section.definition[f"dispersion_{name}"] for name in told._fields}
    assert stored == told._asdict()
    assert points.dispersion(np.zeros(0), np.zeros(0), True).points == 0
    assert np.isnan(points.dispersion(x, y, False).radius)


def test_kinds_of_sections(tmp_path):
    """Each says what it is; none of them needs the rows of what it shows."""
    text = (
        small.SLIDER_CRANK.split("poincare:")[0]
        + """poincare:
  beat: {every: 0.5 ms, after: 1 ms, plot: [stroke, rod.velocity.y]}
  touch: {at_onset: B, plot: [B.eccentricity_x, B.eccentricity_y]}
  never: {when: slider.position.y, after: 2 s, plot: [stroke, stroke]}
"""
    )
    small.run(tmp_path / "run.h5", "output.channels=[crank_angle]", text=text)
    result = read(tmp_path / "run.h5")
    assert {name.split(".")[0] for name in result.names} == {"crank_angle"}
    beat, touch, never = (result.poincare[name] for name in ("beat", "touch", "never"))
    np.testing.assert_array_equal(beat.time, 1e-3 + 0.5e-3 * np.arange(5))
    assert (beat.x_unit, beat.y_unit) == ("m", "m/s") and np.isnan(beat.dispersion.radius)
    assert "dispersion_radius" not in beat.definition
    told = [points.surface(section.definition) for section in (beat, touch, never)]
    assert told == [
        "every 0.0005 s",
        "at each touch of B",
        "slider.position.y crosses zero upwards",
    ]
    assert len(never.time) == never.definition["dispersion_points"] == 0
    np.testing.assert_array_equal(touch.time, result.impacts("B").time)
    names = {peak.channel.split(".")[0] for peak in result.peaks}
    assert "stroke" not in names and "B" in names


def test_impact_map_and_orbit(result):
    """Touches as they stand among the events; the orbit is where its numbers are stored."""
    events = result.events
    onset = events.kind == "onset"
    with h5py.File(result.path) as file:
        for axis in ("time", "angle", "speed"):
            np.testing.assert_array_equal(file["impact/B"][axis], getattr(events, axis)[onset])
            np.testing.assert_array_equal(
                getattr(result.impacts("B"), axis), file["impact/B"][axis]
            )
        assert file["impact/B/speed"].attrs["units"] == "m/s"
        assert file["orbit/B/rows/x"] == file["B.eccentricity_x"]
        assert file["orbit/B/steps/y"] == file["steps/B/eccentricity_y"]


def test_unknown_channels_are_refused_before_any_file(scenario, mechanism, tmp_path):
    wrong = SimpleNamespace(x="B.eccentricity", y="stroke")
    changed = scenario.model_copy(update={"phase_portraits": {"p": wrong}})
    with pytest.raises(ScenarioError, match=r"no channel named 'B\.eccentricity'") as caught:
        write(tmp_path / "run.h5", changed, mechanism, simulate(scenario, mechanism))
    assert caught.value.path == ("phase_portraits", "p", "x")
    wrong = SimpleNamespace(x="B.force", y="stroke")
    changed = scenario.model_copy(update={"phase_portraits": {"p": wrong}})
    with pytest.raises(ScenarioError, match="3 components"):
        write(tmp_path / "run.h5", changed, mechanism, simulate(scenario, mechanism))
    assert not list(tmp_path.iterdir())
