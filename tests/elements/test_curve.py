"""Curve: what a user may write, files with units, and what is refused with its place."""

import numpy as np
import pytest

from trsim.cli import main
from trsim.errors import TrsimError
from trsim.scenario.load import load

from ..runs import built, run

TEXT = """
bodies:
  bead: {mass: 2, inertia: 0.01, at: [0.2, 0.1], velocity: [0.3, 0]}
joints:
  wire: {type: point_on_curve, bodies: [ground, bead], at: [0.2, 0.1], curve: {%s}}
solver: {end: 0.2}
"""
REFUSED = {
    "nothing": ("closed: false", "one of points, a table, or expressions"),
    "two kinds": ("points: [[0, 0], [1, 1]], x: s", "got points and x"),
    "no y": ("x: s, range: [0, 1]", "y is missing"),
    "no range": ("x: s, y: s", "range is missing"),
    "range without": ("points: [[0, 0], [1, 1]], range: [0, 1]", "goes with an expression"),
    "range falls": ("x: s, y: s, range: [1, 0]", "less than the last"),
    "one point": ("points: [[0, 0]]", "needs 2 points"),
    "two of a closed one": ("points: [[0, 0], [1, 1]], closed: true", "needs 3 points"),
    "two alike": ("points: [[0, 0], [0.2, 0.1], [0.2, 0.1], [1, 1]]", r"points.1: .*one place"),
    "three numbers": ("points: [[0, 0, 0], [1, 1, 1]]", r"a row is \[x, y\]"),
    "a word": ("points: [[0, zero], [1, 1]]", "zero"),
    "wrong unit": ("points: [[0 kg, 0], [1, 1]]", "kg"),
    "tangents of a closed one": (
        "points: [[0, 0], [1, 1], [1, 0]], closed: true, tangents: [[1, 0], [1, 0]]", "open curve",
    ),
    "a tangent that is zero": ("points: [[0, 0], [1, 1]], tangents: [[0, 0], [1, 0]]", "zero"),
    "a corner": ("x: s, y: abs(s), range: [-1, 1]", "'abs' has a corner"),
    "a comparison": ("x: s, y: (s > 0)*s, range: [-1, 1]", "has a corner"),
    "a hidden corner": ("x: s, y: sqrt(s**2), range: [-1, 1.01]", "has a corner at s = |finite"),
    "a jump": ("x: s, y: 'atan2(s, -1)', range: [-1, 1]", "has a corner at s = "),
    "a tip": ("x: s**2, y: s**3, range: [-1, 1]", "stands still"),
    "not closed": ("x: s, y: s**2, range: [0, 1], closed: true", "other places"),
    "closed with a corner": (
        "x: cos(s), y: sin(s)*(1 + 0.1*s*(s - 2*pi)), range: [0, 2*pi], closed: true",
        "other curvatures",
    ),
    "another name": ("x: s, y: 0.1*t, range: [0, 1]", "depends on s alone, not on 't'"),
    "no value": ("x: s, y: log(s), range: [-1, 1]", "no finite value at s = -1"),
    "parallel axes": ("x_axis: [1, 0], y_axis: [2, 0], points: [[0, 0], [1, 1]]", "parallel"),
    "all but a corner": (
        "x: s, y: sqrt(s**2 + 1e-13), range: [-1, 1]", "changes its way too fast",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refused(what):
    given, said = REFUSED[what]
    with pytest.raises(TrsimError, match=said) as caught:
        built(TEXT % given)
    assert "wire" in str(caught.value)


ALIKE = {
    "units": "points: [[0 mm, 0], [200 mm, 10 cm], [0.5, 0.1]]",
    "parameters": "points: [[0, 0], [a, a/2], [0.5, a/2]]",
    "titles": 'table: [["x [mm]", "y [cm]"], [0, 0], [200, 10], [500, 10]]',
    "axes": "at: [0.5, 0.1], x_axis: [-1, 0], y_axis: [0, -2], "
    "points: [[0.5, 0.1], [0.3, 0], [0, 0]]",
    "a named point": "at: seat, x_axis: seat.x, y_axis: seat.y, "
    "points: [[0, 0], [0.2, 0.1], [0.5, 0.1]]",
}


@pytest.mark.parametrize("how", ALIKE)
def test_one_curve_in_several_ways(how):
    more = "\nparameters: {a: 20 cm}\npoints: {seat: {body: ground, at: [0, 0]}}\n"
    plain = run(TEXT % "points: [[0, 0], [0.2, 0.1], [0.5, 0.1]]" + more)
    r = run(TEXT % ALIKE[how] + more)
    assert r["bead.position"] == pytest.approx(plain["bead.position"], abs=1e-9)


MAKER = """
points: {tip: {body: arm, at: [0.2, 0.1]}}
bodies: {arm: {mass: 1, inertia: 0.1, at: [0, 0]}}
joints: {pin: {type: revolute, bodies: [ground, arm], at: [0, 0]}}
drives: {motor: {joint: pin, velocity: 2*pi}}
solver: {end: 0.95, tolerance: 1e-10}
output: {every: 0.05, channels: ["tip.position"]}
"""


def test_a_recorded_path(tmp_path):
    """What `export` writes of a point of another run: a circle."""
    (tmp_path / "maker.yaml").write_text(MAKER)
    made, wrote = tmp_path / "m.h5", ["export", "--csv", str(tmp_path / "m.h5")]
    for command in (["run", str(tmp_path / "maker.yaml"), "-o", str(made)], wrote):
        with pytest.raises(SystemExit) as ended:
            main(command)
        assert ended.value.code == 0
    columns = "columns: [tip.position.x, tip.position.y]"
    (tmp_path / "bead.yaml").write_text(TEXT % f"table: m.csv, {columns}, closed: true")
    r = run(load(tmp_path / "bead.yaml"))
    radius = np.hypot(r["bead.position"][:, 0], r["bead.position"][:, 1])
    assert radius == pytest.approx(np.sqrt(0.05), abs=1e-5)
    for given, said in (
        ("table: m.csv, closed: true", "4 columns|4 titles"),
        ("table: m.csv, columns: [tip.x, tip.position.y]", "no column 'tip.x'"),
        ("table: m.csv, columns: tip", "two titles"),
        ("points: [[0, 0], [1, 0]], columns: [a, b]", "columns are those of a table"),
    ):
        (tmp_path / "bead.yaml").write_text(TEXT % given)
        with pytest.raises(TrsimError, match=said):
            load(tmp_path / "bead.yaml")


def test_a_file_of_two_columns(tmp_path):
    rows = "\n".join(
        f"{200 * np.cos(a):.12g},{100 * np.sin(a):.12g}" for a in np.arange(0, 6.2, 0.1)
    )
    (tmp_path / "path.csv").write_text(f"# of tip\nx [mm], y [mm]\n{rows}\n")
    (tmp_path / "bead.yaml").write_text(
        TEXT.replace("[0.2, 0.1]", "[0.2, 0]") % "table: path.csv, closed: true"
    )
    r = run(load(tmp_path / "bead.yaml"))
    x, y = r["bead.position"][:, 0] / 0.2, r["bead.position"][:, 1] / 0.1
    assert x**2 + y**2 == pytest.approx(1.0, abs=1e-4)


def test_lies_on_its_points():
    """The last point of a closed curve may repeat the first."""
    open_, shut = "[[0, 0], [0.2, 0.1], [0.5, 0.1]]", "[[0, 0], [0.2, 0.1], [0.5, 0.1], [0, 0]]"
    one, other = (
        run(TEXT % f"points: {points}, closed: true")["bead.position"] for points in (open_, shut)
    )
    assert (one == other).all()
