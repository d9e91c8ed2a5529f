"""Periods of sections, and the diagram of a study."""

import numpy as np
import pytest

from tests import small
from tests.analyse.series import logistic
from tests.analyse.studies import Case, Study
from trsim.analyse.bifurcation import (
    NARROW,
    diagram,
    narrow,
    period,
    period_in_words,
    spread,
    swept,
)
from trsim.errors import UsageError

PERIODIC = """
bodies:
  wheel: {mass: 1.0, inertia: 1.0e-3, at: [0, 0]}
  mass:  {mass: 1.0, inertia: 1.0e-3, at: [0.1, 0], velocity: [1.0, 0]}
joints:
  axle:  {type: revolute, bodies: [ground, wheel], at: [0, 0]}
  guide: {type: prismatic, bodies: [ground, mass], axis: [1, 0, 0]}
forces:
  spring: {type: spring_damper, bodies: [ground, mass], points: [[-0.9, 0], [0.1, 0]],
           stiffness: 100.0}
sensors:
  x: {joint: guide}
gravity: [0, 0, 0]
solver: {end: 8.0, tolerance: 1e-9}
output: {every: 0.01}
poincare:
  turn:  {every: 2*pi/10, plot: [x, x.rate]}
  still: {when: x, crosses: up, plot: [wheel.position.x, mass.position.z]}
  twice: {when: x, crosses: both, plot: [x, x.rate]}
"""


@pytest.mark.parametrize(
    "r, expected", [(2.8, 1), (3.2, 2), (3.5, 4), (3.55, 8), (3.83, 3), (4.0, 0)]
)
def test_periods_of_the_logistic_map(r, expected):
    x = logistic(60, r)[1]
    assert period(x, x**2, 1.0, 1.0) == expected


def test_period_needs_both_axes_and_enough_points():
    x, y = np.tile([0.0, 1.0], 12), np.tile([0.0, 1.0, 2.0], 8)
    assert period(x, np.zeros(24), 1.0, 1.0) == 2
    assert period(x, y, 1.0, 2.0) == 6
    assert period(x[:5], y[:5], 1.0, 1.0) == -1
    assert period(np.linspace(0, 1, 30), np.zeros(30), 1.0, 1.0) == 0
    assert [period_in_words(n) for n in (-1, 0, 3)] == ["too few points", "scattered", "period 3"]


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bifurcation")
    cases = []
    for name, clearance in (("wide", 0.5e-3), ("tight", 0.1e-3)):
        small.run(folder / f"{name}.h5", f"joints.B.clearance={clearance}")
        values = {"joints.B.clearance": clearance}
        cases.append(Case(name, values, folder / f"{name}.h5"))
    failed = Case("failed", {"joints.B.clearance": 0.2e-3}, folder / "none.h5", "failed")
    return Study((*cases, failed))


def test_diagram_of_a_study(study):
    found = diagram(study, "journal:y")
    assert (found.axis, found.channel, found.unit) == ("y", "B.eccentricity_y", "m")
    assert (found.over, dict(found.why)) == ("joints.B.clearance", {})
    assert found.places["failed"] == 0.2e-3
    for case, one in zip(study.cases, found.cases, strict=False):
        points = case.run().poincare["journal"]
        np.testing.assert_array_equal(one.y, points.y)
        assert one.over == case.values["joints.B.clearance"]
    late = diagram(study, "journal@1ms..")
    assert 0 < len(late.cases[0].x) < len(found.cases[0].x)
    assert spread([np.array([1.0, 3.0]), np.array([-1.0])]) == 4.0


def test_what_makes_no_sense_is_refused(study):
    with pytest.raises(UsageError, match="no section 'jornal'"):
        diagram(study, "jornal")
    with pytest.raises(UsageError, match="no axis 'z'"):
        diagram(study, "journal:z")
    with pytest.raises(UsageError, match="does not sweep"):
        swept(study, "a.b")
    with pytest.raises(UsageError, match="sweeps nothing"):
        swept(Study((), ()), None)
    with pytest.raises(UsageError, match="no case"):
        diagram(Study(study.cases[2:]), "journal")


def test_the_first_key_that_is_a_number_is_drawn_over(study):
    values = {"case": "rigid", "joints.B.clearance": 1e-4}
    two = Study((Case("a", values, study.cases[0].file),), ("case", "joints.B.clearance"))
    assert swept(two, None) == "joints.B.clearance"
    assert swept(two, "case") == "case"
    [one] = diagram(two, "journal").cases
    assert one.series == (("case", "rigid"),)


def test_a_case_without_the_key_the_section_or_its_file_is_left_out(study, tmp_path):
    good, other = study.cases[:2]
    text = small.SLIDER_CRANK.partition("poincare:")[0]
    small.run(tmp_path / "plain.h5", text=text)
    (tmp_path / "cut.h5").write_bytes(good.file.read_bytes()[:3000])
    plain, cut = (
        Case(n, {"joints.B.clearance": 1e-3}, tmp_path / f"{n}.h5") for n in ("plain", "cut")
    )
    rigid = Case("rigid", {}, other.file)
    found = diagram(Study((rigid, plain, cut, good)), "journal")
    assert [one.case for one in found.cases] == ["wide"]
    assert list(found.places) == ["plain", "cut", "wide"]
    assert found.why["plain"] == "no section 'journal'"
    assert found.why["cut"].startswith("is truncated")
    with pytest.raises(UsageError, match="no section 'journal'"):
        diagram(Study((cut, plain)), "journal")
    with pytest.raises(UsageError, match="no case that varies joints"):
        diagram(Study((rigid, plain)), "journal:x")
    over = Study((rigid, good), ("case", "joints.B.clearance"))
    with pytest.raises(UsageError, match="nothing lies in"):
        diagram(over, "journal@1 s..")


@pytest.mark.parametrize("cases", [1, 2])
def test_a_periodic_motion_is_so_where_no_other_point_gives_a_size(cases, tmp_path):
    """x' = a cos a t from x = 0, once a period: its points differ by the errors of the solver."""
    path = tmp_path / "run.h5"
    small.run(path, text=PERIODIC)
    key = "joints.B.clearance"
    study = Study(tuple(Case(f"c{k}", {key: 0.1 * k}, path) for k in range(cases)))
    for word in ("turn", "still"):
        found = diagram(study, word)
        points = found.cases[0]
        assert len(points.x) >= 9
        assert spread([points.x]) + spread([points.y]) < 1e-7
        assert [one.period for one in found.cases] == [1] * cases
    assert spread([diagram(study, "turn").cases[0].x]) > 0.0
    swings = diagram(study, "twice").cases[0]
    assert swings.period == 2


def test_points_are_held_against_the_motion_of_their_channel(study):
    run = study.cases[0].run()
    x = run.channel("stroke")
    peaks = [p.value for p in run.peaks if p.channel == "stroke"]
    size = max(x.max(), *peaks) - min(x.min(), *peaks)
    assert narrow(run, "stroke") == pytest.approx(NARROW * size, rel=1e-12)
    assert narrow(run, "not.stored") == 0.0
    y = run.channel("crank.position.y")  # of which there are no extremes but those of the rows
    assert not [peak for peak in run.peaks if peak.channel == "crank.position.y"]
    assert narrow(run, "crank.position.y") == pytest.approx(NARROW * np.ptp(y), rel=1e-12)
