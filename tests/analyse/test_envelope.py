"""Extremes over cases against the closed form of a pendulum that falls from the side.

    w^2 = 2 g sin a / l k,   N = m g sin a + m l w^2 along the rod,   k = 1 + I / m l^2

a is the angle below the horizontal; across the rod T = m g cos a (1 - 1/k).
"""

from dataclasses import replace

import numpy as np
import pytest

from tests import small
from tests.analyse.studies import Case, Study
from trsim.analyse.envelope import Quantity, Rows, envelope, lost
from trsim.errors import UsageError
from trsim.store.read import read

G, K = 9.81, 1.005
PENDULUM = """\
gravity: [0, -9.81, 0]
bodies: {bob: {mass: 2, inertia: 0.01, at: [1, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, bob], at: [0, 0]}}
sensors: {angle: {joint: hinge}}
solver: {end: 1.2 s, tolerance: 1e-10}
output: {every: 1 ms}
"""
DOWN = G * (1.0 + 2.0 / K)  # per kg, when it hangs


def case(folder, name, mass, *sets, status="done", text=PENDULUM):
    path = folder / f"{name}.h5"
    small.run(path, f"bodies.bob.mass={mass}", f"bodies.bob.inertia={0.005 * mass}", *sets,
              text=text)  # fmt: skip
    return Case(name, {"bodies.bob.mass": float(mass)}, path, status)


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    """Three loads, names with dots, the heaviest one failed; a case without the sensor."""
    folder = tmp_path_factory.mktemp("envelope")
    bare = PENDULUM.replace("sensors: {angle: {joint: hinge}}\n", "").replace("hinge", "pivot")
    found = (
        case(folder, "load.1", 1),
        case(folder, "load.2", 2),
        case(folder, "same.as.2", 2),
        case(folder, "heavy", 50, status="failed"),
        case(folder, "bare", 1, text=bare),
        Case("lost", {}, folder / "none.h5", "missing"),
    )
    return Study(found, ("bodies.bob.mass",), {"bodies.bob.mass": "kg"}, written={})


def named(found):
    return {(each.name, each.extreme): each for each in found}


def test_where_extremes_are_met_and_what_acts_with_them(cases):
    found = named(envelope(cases, ["hinge.reaction*"], "angle", ["bob.velocity.x"]))
    size = found["hinge.reaction", "magnitude"]
    met = size.cases[size.worst]
    assert (size.worst, size.unit, met.of) == ("load.2", "N", "motion")
    assert met.value == pytest.approx(2.0 * DOWN, rel=1e-7)
    assert met.at == pytest.approx(-np.pi / 2, abs=1e-4)  # time of a flat top: to its root
    assert met.acting["x"] == pytest.approx(0.0, abs=2e-3)
    assert met.acting["y"] == pytest.approx(2.0 * DOWN, rel=1e-5)
    assert met.acting["bob.velocity.x"] == pytest.approx(-np.sqrt(2.0 * G / K), rel=1e-5)
    assert met.trusted
    # N cos a + T sin a is extreme at 45 deg: the whole reaction there, by components
    side = found["hinge.reaction.x", "largest"].cases["load.1"]
    assert side.value == pytest.approx(0.5 * (G * (1.0 + 2.0 / K) - G * (1.0 - 1.0 / K)), rel=1e-7)
    assert abs(side.at) == pytest.approx(0.75 * np.pi, abs=1e-4)
    y = 0.5 * G * (1.0 + 2.0 / K) + 0.5 * G * (1.0 - 1.0 / K)
    assert side.acting["y"] == pytest.approx(y, rel=1e-4)
    assert side.acting["x"] == pytest.approx(side.value, rel=1e-5)


def test_which_case_counts(cases):
    """The far end of each side; of equal cases the first, also where rounding tells them apart."""
    found = named(envelope(cases, ["hinge.reaction.x"], "", []))
    assert found["hinge.reaction.x", "largest"].worst == "load.2"
    assert found["hinge.reaction.x", "smallest"].worst == "load.2"
    met = found["hinge.reaction.x", "largest"].cases["load.2"]
    for word, sign in (("largest", 1.0), ("smallest", -1.0)):
        near = {"a": met._replace(value=sign), "b": met._replace(value=sign * (1.0 + 1e-12)),
                "c": met._replace(value=-2.0 * sign)}  # fmt: skip
        assert Quantity("F", word, "N", near, {}).worst == "a"


def test_failed_and_missing_cases_do_not_count_and_what_lacks_is_told(cases):
    found = named(envelope(cases, ["forces"], "angle", []))
    size = found["hinge.reaction", "magnitude"]
    assert [*size.cases] == ["load.1", "load.2", "same.as.2"]
    assert size.why == {"bare": "no hinge.reaction"}
    assert [*found["pivot.reaction", "magnitude"].cases] == ["bare"]
    assert found["hinge.reaction_moment", "magnitude"].zero
    assert not size.zero
    assert {unit.unit for unit in found.values()} == {"N", "N*m"}
    assert np.isnan(found["pivot.reaction", "magnitude"].cases["bare"].at)
    assert lost(cases, ["angle"]) == ["bare: no channel named 'angle'"]


def test_units_are_not_mixed(cases, tmp_path):
    text = PENDULUM.replace("type: revolute, ", "type: prismatic, axis: [0, 1, 0], ")
    text = text.replace("bob], at: [0, 0]}", "bob]}")
    both = replace(cases, cases=(cases.cases[0], case(tmp_path, "slide", 1, text=text)))
    found = named(envelope(both, ["angle"], "", []))["angle", "smallest"]
    assert found.unit == "rad"
    assert found.why == {"slide": "angle is in m, not in rad as that of other cases"}


def test_rows_that_know_nothing_of_an_extreme(cases, tmp_path):
    coarse = case(tmp_path, "coarse", 1, "output.every=0.4 s")
    found = named(envelope(replace(cases, cases=(coarse,)), ["hinge.*"], "angle", []))
    met = found["hinge.reaction", "magnitude"].cases["coarse"]
    assert met.value == pytest.approx(DOWN, rel=1e-7)
    assert met.rows < 0.9 * DOWN
    assert not met.trusted


def test_the_abscissa_is_interpolated_by_its_rate(cases, tmp_path):
    """A cubic through values and rates is 30 times nearer than a line between rows."""
    fine = read(cases.cases[0].file)
    coarse = read(case(tmp_path, "coarse", 1, "output.every=20 ms").file)
    rows, t = Rows(coarse), fine.time[::5]
    exact = fine.channel("angle")[::5]
    cubic = [rows.place("angle", time) for time in t.tolist()]
    line = np.interp(t, coarse.time, coarse.channel("angle"))
    assert np.abs(cubic - exact).max() < np.abs(line - exact).max() / 30.0
    assert np.abs(cubic - exact).max() < 1e-5


def test_a_contact_is_known_at_its_steps(tmp_path):
    """Between two rows the steps in touch say what acted: the force itself is met."""
    small.run(tmp_path / "run.h5", "output.every=0.2 ms")
    one = Case("one", {}, tmp_path / "run.h5")
    found = named(envelope(Study((one,)), ["B.contact_force"], "", ["B.normal_force"]))
    met = found["B.contact_force", "largest"].cases["one"]
    assert met.rows == pytest.approx(met.value, rel=0.05)
    assert met.acting["B.normal_force"] == pytest.approx(met.rows, rel=1e-9)
    rows = np.interp(met.time, one.run().time, one.run().channel("B.contact_force"))
    assert rows < 0.9 * met.value


def test_patterns_that_fit_nothing(cases):
    with pytest.raises(UsageError, match=r"no quantity of any case fits 'hinge\.force'"):
        envelope(cases, ["hinge.force"], "", [])
    free = Study((replace(cases.cases[3], status="failed"),))
    with pytest.raises(UsageError, match="no case of the study has a result"):
        envelope(free, ["forces"], "", [])
