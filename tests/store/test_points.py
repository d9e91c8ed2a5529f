from types import SimpleNamespace

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
    assert section.definition["method"] == "interpolated from output rows"
    assert section.definition["when"] == "B.eccentricity_x_rate"
    rate = result.channel("B.eccentricity_x_rate")
    rising = np.flatnonzero((rate[:-1] < 0.0) & (rate[1:] >= 0.0))
    assert len(section.time) == len(rising) > 2
    for time, x, k in zip(section.time, section.x, rising, strict=True):
        assert result.time[k] <= time <= result.time[k + 1]
        assert x == pytest.approx(result.channel("B.eccentricity_x")[k], abs=2e-5)


@pytest.mark.parametrize("crosses, phase", [("up", 0.0), ("down", 0.5), ("both", None)])
def test_crossings_are_located_by_cubics(crosses, phase):
    """sin crosses zero at known times; the error of a cubic falls with the fourth power."""
    errors = []
    for n in (400, 800):
        time = np.linspace(0.02, 10.02, n)
        w = np.sin(2 * np.pi * time)
        part = {"time": time, "when": w, "x": np.cos(2 * np.pi * time), "y": w}
        found = points.crossings({**part, "first": True, "last": True}, crosses)
        exact = np.arange(1, 11) if phase == 0.0 else np.arange(0, 10) + 0.5
        if phase is None:
            exact = np.arange(1, 21) / 2
        errors.append(np.abs(found["time"] - exact).max())
        np.testing.assert_allclose(found["x"], np.cos(2 * np.pi * exact), atol=3e-5)
        np.testing.assert_allclose(found["y"], 0.0, atol=1e-12)
    assert errors[1] < errors[0] / 12.0


@pytest.mark.parametrize("rows", [1, 2, 7])
def test_crossings_do_not_depend_on_stretches(rows, tmp_path, monkeypatch):
    small.run(tmp_path / "one.h5")
    monkeypatch.setattr(points, "ROWS", rows)
    small.run(tmp_path / "many.h5")
    assert read(tmp_path / "one.h5").attributes == read(tmp_path / "many.h5").attributes


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
