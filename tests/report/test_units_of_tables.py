"""A table beside a figure has the units of the figure, where these were chosen."""

import csv

import numpy as np
import pytest

from tests import small
from tests.analyse.studies import Case, Study
from tests.report.test_plots import DOOR, columns, lines
from trsim.report import analysed, studies
from trsim.report.asked import Asked
from trsim.report.keys import Units
from trsim.report.looks import Looks, chosen
from trsim.store.read import read

DEGREES = np.degrees(1.0)
OPTION = ("angle: deg",)
SCENARIO = ("report.units.angle=deg",)
BOTH = pytest.mark.parametrize(("units", "sets"), [(OPTION, ()), ((), SCENARIO)])


@pytest.fixture(scope="module")
def doors(tmp_path_factory):
    """phi = 0.6 sin(2 pi t), by what is chosen in the scenario."""
    folder = tmp_path_factory.mktemp("units")
    for name, sets in (("", ()), ("report.units.angle=deg", SCENARIO)):
        small.run(folder / f"door{name}.h5", *sets, text=DOOR)
    small.run(folder / "wide.h5", "drives.handle.position=0.7*sin(2*pi*t)", text=DOOR)
    return folder


def door(folder, sets):
    return folder / f"door{''.join(sets)}.h5"


@BOTH
def test_rates_go_with_their_angle(units, sets, doors, tmp_path):
    """0.6 * 2 pi rad/s at the start; an option and the section `report` mean the same."""
    asked = Asked(plot=("door_angle, door_angle.rate, door_angle.acceleration",),
                  table=("peak:door_angle.rate",), spectrum=("door_angle.rate",))  # fmt: skip
    found = analysed([door(doors, sets)], tmp_path, asked, Looks(units))
    titles, values = columns(found.files[1])
    assert titles == ["time [s]", "door_angle [deg]", "door_angle.rate [deg/s]",
                      "door_angle.acceleration [deg/s^2]"]  # fmt: skip
    np.testing.assert_allclose(values[0, 2], 216.0, rtol=1e-9)
    [number] = lines(tmp_path / "numbers.csv")
    assert (float(number["value"]), number["unit"]) == (pytest.approx(216.0), "deg/s")
    assert "door_angle.rate [deg/s/sqrt(Hz)]" in lines(tmp_path / "spectrum_door_angle_rate.csv")[0]
    density = [line for line in found.lines if "Hann window" in line]
    assert all("deg/s, resolution" in line for line in density)


def test_an_angular_speed_of_its_own_is_kept(doors):
    """Whatever comes first: `angle` takes along those rates alone that nobody chose."""
    from trsim.report.display import compared, in_si

    given = in_si({"angular_speed": "rpm", "angle": "deg"})
    assert [given[si][1] for si in ("rad", "rad/s", "rad/s^2")] == ["deg", "rpm", "deg/s^2"]
    [one] = compared([read(door(doors, ()))], chosen(("angular_speed: rpm, angle: deg",)))
    assert one.told("rad/s")[1] == "rpm"
    assert one.told("m") == (1.0, "m")  # nobody chose: SI


@BOTH
def test_differences(units, sets, doors, tmp_path):
    """0.1 rad at the peaks are 5.7 degrees: beside another run, and beside a table."""
    first = door(doors, sets)
    with (tmp_path / "given.csv").open("w", newline="") as file:
        t = np.linspace(0.0, 0.5, 51)
        turn = 0.5 * np.sin(2.0 * np.pi * t)
        csv.writer(file).writerows([("time [s]", "door_angle [rad]"), *zip(t, turn, strict=True)])
    asked = Asked(plot=("door_angle",), overlay=(str(tmp_path / "given.csv"),))
    found = analysed([first], tmp_path / "plot", asked, Looks(units))
    [row] = lines(found.files[2])
    assert (float(row["largest difference"]), row["unit"]) == (pytest.approx(5.73, abs=0.01), "deg")
    assert "largest difference 5.7" in found.lines[0] and " deg at time" in found.lines[0]
    asked = Asked(compare=True, channels=("door_angle",))
    found = analysed([first, doors / "wide.h5"], tmp_path / "two", asked, Looks(units))
    [row] = lines(tmp_path / "two" / "compare.csv")
    assert (float(row["largest difference"]), row["unit"]) == (pytest.approx(5.73, abs=0.01), "deg")
    assert "off by 5.73 deg" in found.lines[0]
    assert found.values[0].unit == "deg"
    asked = Asked(overlay=(f"{tmp_path / 'given.csv'}:door_angle",))
    found = analysed([first], tmp_path / "over", asked, Looks(units))
    assert "off by 5.73 deg" in found.lines[0]


@BOTH
def test_what_was_swept(units, sets, doors, tmp_path):
    """Swept angles and numbers alike, in the table of every figure of a sweep, and on its axis."""
    key, path = "initial.hinge", door(doors, sets)
    cases = tuple(Case(f"c{k}", {key: 0.1 * k, "m": "a"}, path) for k in range(2))
    study = Study(cases, (key, "m"), {key: "rad", "m": "-"})
    word = "peak:door_angle"
    asked = Asked(map=(word,), bars=(word,), envelope="door_angle*")
    found = studies.draw(study, asked, [word], tmp_path, chosen(units) if units else None)
    for name in ("sweep.csv", "map_peak_door_angle.csv", "bars_peak_door_angle.csv"):
        row = lines(tmp_path / name)[1]
        assert float(row[f"{key} [deg]"]) == pytest.approx(0.1 * DEGREES), name
        assert float(row[f"{word} [deg]"]) == pytest.approx(0.6 * DEGREES), name
        assert row["m [-]"] == "a"
    assert {row["unit"] for row in lines(tmp_path / "envelope.csv")} == {"deg", "deg/s", "deg/s^2"}
    assert {one.unit for one in found.values} == {"deg", "deg/s", "deg/s^2"}
    one = studies.shown(study, chosen(units) if units else None)
    assert Units({key: "rad"}, {key: "rad"}).display(one, key)[1] == "deg"
