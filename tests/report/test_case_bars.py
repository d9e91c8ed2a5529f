"""Bars of the load cases of a sweep."""

import csv
from dataclasses import replace

import pytest

from tests import small
from tests.analyse.studies import Case, Study
from tests.report.test_figures import drawn
from trsim.analyse.cases import numbers, shorter
from trsim.errors import UsageError
from trsim.report import case_bars, check_asked, studies
from trsim.report.asked import Asked
from trsim.report.style import look

PENDULUM = """\
gravity: [0, -9.81, 0]
bodies: {bob: {mass: 2, inertia: 0.01, at: [1, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, bob], at: [0, 0]}}
sensors: {angle: {joint: hinge}}
solver: {end: 1.2 s, tolerance: 1e-9}
output: {every: 50 ms}
"""
FALLEN = 2.0 * 9.81 * (1.0 + 2.0 / 1.005)  # m g + m v^2/l, 1/2 (I/m + l^2) phi'^2 = g l


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    """A pendulum that falls from the side, with one and two kg; one run is short, one not there."""
    folder = tmp_path_factory.mktemp("bars")
    key, found = "bodies.bob.mass", []
    for load, mass, end in (("limit", 2, 1.2), ("limit", 1, 1.2), ("jam", 2, 0.1)):
        name = f"{load}.mass={mass}"
        path = folder / f"{name}.h5"
        small.run(path, f"{key}={mass}", f"bodies.bob.inertia={0.005 * mass}",
                  f"solver.end={end} s", text=PENDULUM)  # fmt: skip
        found.append(Case(name, {"case": load, key: float(mass)}, path))
    found[2] = replace(found[2], status="jammed")
    found.append(Case("jam.mass=1", {"case": "jam", key: 1.0}, folder / "none.h5", "missing"))
    return Study(tuple(found), ("case", key), {"case": "-", key: "kg"}, written={})


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_bars_of_a_peak(cases, tmp_path):
    """The largest reaction is met below, between two rows, and is 3 m g for a point mass."""
    word = "peak:hinge.reaction"
    found = studies.draw(cases, Asked(bars=(word,)), [], tmp_path)
    assert [path.name for path in found.files] == ["bars_peak_hinge_reaction.png",
                                                   "bars_peak_hinge_reaction.csv"]  # fmt: skip
    assert 0.005 < drawn(found.files[0]) < 0.5
    table = rows(found.files[1])
    assert [row["case"] for row in table] == [case.name for case in cases.cases]
    assert float(table[0][f"{word} [N]"]) == pytest.approx(FALLEN, rel=1e-6)
    assert float(table[1][f"{word} [N]"]) == pytest.approx(FALLEN / 2.0, rel=1e-6)
    assert table[3][f"{word} [N]"] == "nan"
    assert table[3]["status"] == "missing"
    told = "\n".join(found.lines)
    assert "1 of 4 cases have no result and are left out: jam.mass=1" in told
    assert "jam.mass=2: jammed at 0.1 s, where others go on to 1.2 s" in told
    assert shorter(cases) == [line for line in found.lines if "others go on" in line]


def test_groups_and_series(cases):
    one = studies.shown(cases)
    of = numbers(cases, ["peak:hinge.reaction", "least:angle", "peak:angle"])
    bars = case_bars.bars(cases, one, [of["peak:hinge.reaction"]])
    assert [(bar.group, bar.series) for bar in bars] == [
        ("limit", "bob mass 2 kg"), ("limit", "bob mass 1 kg"),
        ("jam", "bob mass 2 kg"), ("jam", "bob mass 1 kg"),
    ]  # fmt: skip
    assert [bar.end for bar in bars] == ["", "", "jammed", "missing"]
    plain = replace(cases, keys=("bodies.bob.mass",))
    bars = case_bars.bars(plain, one, [of["least:angle"], of["peak:angle"]])
    assert [bar.group for bar in bars[:3]] == ["limit.mass=2", "limit.mass=2", "limit.mass=1"]
    assert bars[0].series == "least of angle"
    with look():
        made = case_bars.figure(cases, one, [*of.values()])
    left, right = made.axes  # each with its own places: three cases by one and by two numbers
    assert len(right.get_yticks()) == len(left.get_yticks()) == 2
    assert right.get_ylim()[0] > left.get_ylim()[0]
    assert left.get_xlabel() == "peak of hinge reaction (N)"
    assert right.get_xlabel() == "(deg)"
    assert [tick.get_text() for tick in left.get_yticklabels()] == ["limit", "jam"]
    assert max(bar.get_width() for bar in left.patches) == pytest.approx(FALLEN, rel=1e-6)
    assert "without a number" in [text.get_text() for text in left.get_legend().get_texts()]


def test_numbers_of_other_units_are_not_mixed(cases, tmp_path):
    """A drive of a slide is in N, that of a hinge in N*m: no bars beside each other."""
    text = PENDULUM.replace("sensors: {angle: {joint: hinge}}", "sensors: {angle: {joint: rail}}")
    hinge, rail = "hinge: {type: revolute, ", "rail: {type: prismatic, axis: [1, 0, 0], "
    text = text.replace(hinge, rail).replace("bob], at: [0, 0]", "bob]")
    small.run(tmp_path / "rail.h5", text=text)
    other = Case("rail", {"case": "rail"}, tmp_path / "rail.h5")
    both = replace(cases, cases=(cases.cases[0], other))
    found = numbers(both, ["peak:angle"])["peak:angle"]
    assert found.unit == "rad"
    assert found.values["rail"] != found.values["rail"]
    assert "is in m, not in rad" in found.why["rail"]


def test_what_bars_are_not_for(cases, tmp_path):
    with pytest.raises(UsageError, match="not for result files"):
        check_asked([cases.cases[0].file], Asked(bars=("peak:angle",)))
    with pytest.raises(UsageError, match="no number of a run"):
        studies.draw(cases, Asked(bars=("peek:angle",)), [], tmp_path)
    many = replace(cases, cases=cases.cases * 200)
    of = numbers(cases, ["peak:angle"])["peak:angle"]
    with pytest.raises(UsageError, match="800 bars"):
        case_bars.draw(many, studies.shown(cases), [of], tmp_path)
