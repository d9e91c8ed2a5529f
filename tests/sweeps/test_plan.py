"""Plans of sweeps: points, names, digests, units, and what is wrong with them."""

import json

import numpy as np
import pytest

from tests import small
from trsim.errors import ScenarioError, TrsimError, UsageError
from trsim.scenario.vary import FEW
from trsim.sweeps.plan import faults, plan


@pytest.fixture
def planned(tmp_path):
    """Plans a scenario text."""

    def of(*sets, more="", text=small.SLIDER_CRANK, engine="one", name="crank.yaml"):
        (tmp_path / name).write_text(text + more)
        return plan(str(tmp_path / name), sets, engine)

    return of


def rows(found, *keys):
    return [tuple(case.values.get(key) for key in keys) for case in found.cases]


B, MU = "joints.B.clearance", "contact_laws.pin.restitution"


def test_a_grid(planned):
    found = planned(more=f"sweep:\n  {B}: [0.1 mm, 0.3 mm]\n  {MU}: [0.8, 0.9]\n")
    assert rows(found, B, MU) == [
        ("0.1 mm", 0.8),
        ("0.1 mm", 0.9),
        ("0.3 mm", 0.8),
        ("0.3 mm", 0.9),
    ]
    assert found.keys == (B, MU)
    assert found.units == {B: "m", MU: "-"}
    assert [case.name for case in found.cases][:2] == [
        "clearance=0.1mm,restitution=0.8",
        "clearance=0.1mm,restitution=0.9",
    ]
    assert found.cases[1].data["joints"]["B"]["clearance"] == "0.1 mm"
    assert found.scenario(found.cases[1]).joints["B"].clearance == 1e-4
    assert "sweep" not in found.cases[0].data


@pytest.mark.parametrize(
    "asked, few, many", [("", "all", "summary"), ("keep: all, ", *["all"] * 2),
                         ("keep: summary, ", *["summary"] * 2)],
)  # fmt: skip
def test_result_files_of_few_cases_are_kept(planned, asked, few, many):
    for number, kept in ((FEW, few), (FEW + 1, many)):
        found = planned(more=f"sweep: {{{asked}{B}: 'lin(0.1 mm, 0.3 mm, {number})'}}\n")
        assert (found.keep, found.wished) == (kept, bool(asked))


def test_side_by_side(planned):
    found = planned(more=f"sweep: {{method: zip, {B}: [1 mm, 2 mm], {MU}: [0.8, 0.9]}}\n")
    assert rows(found, B, MU) == [("1 mm", 0.8), ("2 mm", 0.9)]


def test_same_as(planned):
    text = small.SLIDER_CRANK.replace("A: {type: revolute,", "A: {type: revolute, contact: pin,")
    text = text.replace("at: [0.05, 0]", "at: [0.05, 0], clearance: 1 mm")
    more = f"sweep: {{{B}: [0.1 mm, 0.3 mm], joints.A.clearance: same as {B}}}\n"
    found = planned(text=text, more=more)
    assert found.keys == (B,)
    assert [case.data["joints"]["A"]["clearance"] for case in found.cases] == ["0.1 mm", "0.3 mm"]


def test_spaced(planned):
    found = planned(f"{B}=lin(0.1 mm, 0.5mm, 9)")
    assert [case.values[B] for case in found.cases][:3] == ["0.1 mm", "0.15 mm", "0.2 mm"]
    assert [case.name for case in found.cases][-1] == "clearance=0.5mm"
    found = planned("solver.tolerance=log(1e-8, 1e-4, 3)")
    assert [case.values["solver.tolerance"] for case in found.cases] == [1e-8, 1e-6, 1e-4]
    found = planned(f"{B}=lin(0, 1 mm, 2)")
    assert [case.values[B] for case in found.cases] == ["0 mm", "1 mm"]
    found = planned(f"{B}=lin(100 um, 0.5 mm, 2)")
    assert [case.values[B] for case in found.cases] == ["0.1 mm", "0.5 mm"]


def test_the_command_line_replaces_the_file(planned):
    found = planned(f"{B}=[2 mm]", "solver.end=1 ms", more=f"sweep: {{{B}: [1 mm, 3 mm]}}\n")
    assert rows(found, B) == [("2 mm",)]
    assert found.cases[0].data["solver"]["end"] == "1 ms"


def test_samples(planned):
    draw = f"samples: 400, seed: 3, {B}: 'uniform(0.1 mm, 0.5 mm)', {MU}: 'normal(0.9, 0.01)'"
    for method in ("monte_carlo", "latin_hypercube"):
        found = planned(more=f"sweep: {{method: {method}, {draw}}}\n")
        again = planned(more=f"sweep: {{method: {method}, {draw}}}\n")
        assert [case.values for case in found.cases] == [case.values for case in again.cases]
        assert found.cases[7].name == "s0007"
        width = np.array([float(case.values[B].split()[0]) for case in found.cases])
        spread = np.array([case.values[MU] for case in found.cases])
        assert 0.1 < width.min() < 0.11 < 0.49 < width.max() < 0.5
        assert abs(spread.mean() - 0.9) < 0.002
        assert 0.009 < spread.std() < 0.011
        assert np.abs(spread - 0.9).max() <= 0.03
        if method == "latin_hypercube":  # one in each of 400 layers
            assert sorted((400 * (width - 0.1) / 0.4).astype(int).tolist()) == list(range(400))
    other = planned(more=f"sweep: {{method: monte_carlo, {draw.replace('seed: 3', 'seed: 4')}}}\n")
    assert other.cases[0].values != found.cases[0].values


def test_saltellis_blocks(planned):
    draw = f"method: sobol, samples: 8, {B}: 'uniform(0.1 mm, 0.5 mm)', {MU}: 'uniform(0.8, 0.9)'"
    found = {case.name: case.values for case in planned(more=f"sweep: {{{draw}}}\n").cases}
    assert len(found) == 8 * 4
    for k in range(8):
        a, b = found[f"A{k:04d}"], found[f"B{k:04d}"]
        assert found[f"AB1_{k:04d}"] == {B: b[B], MU: a[MU]}
        assert found[f"AB2_{k:04d}"] == {B: a[B], MU: b[MU]}


CASES = """
cases:
  still: {}
  fast: {drives: {motor: {velocity: 6000 rpm}}}
  other: {extends: other.yaml, sweep: {solver.tolerance: [1e-5]}}
"""


def test_named_cases(planned, tmp_path):
    (tmp_path / "other.yaml").write_text("solver: {end: 2 ms}\nsweep: {solver.end: [1 ms]}\n")
    found = planned(more=f"{CASES}sweep: {{{B}: [1 mm, 2 mm]}}\n")
    names = [case.name for case in found.cases]
    assert names == [
        *("still,clearance=1mm", "still,clearance=2mm", "fast,clearance=1mm"),
        *("fast,clearance=2mm", "other,tolerance=1e-05"),
    ]
    assert found.keys == ("case", B, "solver.tolerance")
    data = {case.name: case.data for case in found.cases}
    assert data["fast,clearance=1mm"]["drives"]["motor"]["velocity"] == "6000 rpm"
    other = data["other,tolerance=1e-05"]
    assert (other["solver"]["end"], other["joints"]["B"]["clearance"]) == ("2 ms", "0.5 mm")
    assert list(faults(found)) == []
    alone = planned(more=CASES.replace("  other", "  # other"))
    assert [case.name for case in alone.cases] == ["still", "fast"]


def test_a_case_of_files_alone(planned, tmp_path):
    (tmp_path / "base.yaml").write_text(small.SLIDER_CRANK)
    found = planned("solver.end=1 ms", text="cases: {a: {extends: base.yaml, title: A}}\n")
    assert found.scenario(found.cases[0]).title == "A"
    assert found.scenario(found.cases[0]).solver.end == 1e-3


def test_digests(planned):
    """What is computed counts, how it is written down does not."""
    before = planned(f"{B}=[1 mm, 2 mm]")
    lines = small.SLIDER_CRANK.splitlines()
    spaced = "\n".join(f"{line}   # a comment" for line in lines) + "\n"
    turned = spaced.replace("{mass: 0.3, inertia: 1e-4,", "{inertia: 1e-4,   mass: 0.3,")
    assert turned != spaced
    same = planned(f"{B}=[1 mm, 2 mm]", text=turned)
    assert [case.digest for case in same.cases] == [case.digest for case in before.cases]
    one = planned(f"{B}=[1 mm, 3 mm]")
    assert [a.digest == b.digest for a, b in zip(one.cases, before.cases, strict=True)] == [
        True,
        False,
    ]
    other = planned(f"{B}=[1 mm, 2 mm]", engine="two")
    assert not {case.digest for case in other.cases} & {case.digest for case in before.cases}
    title = planned(f"{B}=[1 mm, 2 mm]", text=small.SLIDER_CRANK.replace("with play", "loose"))
    assert not {case.digest for case in title.cases} & {case.digest for case in before.cases}


def test_names_differ(planned):
    found = planned(f"{B}=[1 mm, 1mm, 0.1000001 mm, 0.1000002 mm]")
    names = [case.name for case in found.cases]
    assert len(set(names)) == 4
    assert names[:2] == ["clearance=1mm", "clearance=1mm~2"]
    found = planned(f"{B}=[{', '.join(f'{k}.123456 mm' for k in range(1, 4))}]", f"{MU}=[0.8]")
    assert all(len(case.name) < 100 for case in found.cases)


@pytest.mark.parametrize(
    "more, what",
    [
        ("sweep: {joints.C.clearance: [1 mm]}", "nothing named 'C' in joints"),
        ("sweep: {joints.B.clearance: []}", "an empty list"),
        ("sweep: {joints.B.clearance: 3}", "no values to vary: 3"),
        ("sweep: {vary: {joints.B.clearance: [1 mm]}}", "no values to vary: a mapping"),
        ("sweep: {joints.B.clearance: 'lin(1 mm, 2 mm)'}", "lin(a, b, n) has 3 entries, got 2"),
        ("sweep: {joints.B.clearance: 'lin(1 mm, 2 kg, 3)'}", "are not of one kind"),
        ("sweep: {joints.B.clearance: 'lin(1, 2 mm, 3)'}", "need the same unit"),
        ("sweep: {joints.B.clearance: 'line(1, 2, 3)'}", "unknown word 'line'"),
        ("sweep: {joints.B.clearance: 'uniform(1 mm, 2 mm)'}", "a distribution cannot be part"),
        ("sweep: {joints.B.clearance: same as solver.end}", "does not vary by itself"),
        ("sweep: {method: gird, joints.B.clearance: [1 mm]}", "unknown method 'gird'"),
        ("sweep: {method: zip, joints.B.at: [1], solver.end: [1, 2]}", "zip needs as many"),
        ("sweep: {method: sobol, samples: 9, solver.end: 'uniform(1, 2)'}", "a power of two"),
        ("sweep: {method: monte_carlo, solver.end: 'uniform(1, 2)'}", "field required: samples"),
        ("sweep: {samples: 3, joints.B.clearance: [1 mm]}", "samples belongs to"),
        ("sweep: 3", "must be a mapping of keys, got 3"),
        ("cases: {a/b: {}}", "not a name of a case: 'a/b'"),
        ("cases: {a: 3}", "must be a mapping of overrides, got 3"),
        ("cases: [1]", "must be a mapping of names to overrides"),
        ("cases: {a: {extends: nowhere.yaml}}", "there is no file 'nowhere.yaml'"),
        ("cases: {a: {extends: crank.yaml}}", "extends itself"),
    ],
)  # fmt: skip
def test_refused(planned, more, what):
    with pytest.raises(TrsimError) as error:
        found = planned(more=f"{more}\n")
        for _, fault in faults(found):
            raise fault
    told = error.value.show()
    assert what in told
    assert told.startswith("/") and "crank.yaml:" in told.splitlines()[0], told


def test_values_of_one_key_have_one_kind_of_unit(planned):
    """Else the table would have both in one column: 5 mm/turn is 0.8 mm/rad, and 5 mm is 5 mm."""
    more = "parameters: {p: 1}\n"
    [(_, fault)] = faults(planned("parameters.p=[1 mm, 2, 5 mm/turn]", more=more))
    assert "values of parameters.p are in mm and in mm/turn" in fault.what
    assert not list(faults(planned("parameters.p=[1 mm, 2, 5 um]", more=more)))


def test_values_that_differ_in_their_unit_alone(planned):
    """2 and 2 m are one number, and not one mass: what was read with one is not taken for both."""
    more = "parameters: {p: 1}\n"
    found = planned("parameters.p=[2, 2 kg, 2 m]", "bodies.crank.mass=p", more=more)
    told = [(case.name, fault.what) for case, fault in faults(found)]
    assert [name for name, _ in told] == ["p=2m"] and "'m' is a length" in told[0][1]


def test_nothing_to_vary(planned):
    with pytest.raises(UsageError, match="says nothing to vary"):
        planned("solver.end=1 ms")


def test_wrong_cases_are_named(planned):
    found = planned(f"{B}=[1 mm, -1 mm, 2 kg]", f"{MU}=[0.9, 1.2]")
    told = [(case.name, error.show()) for case, error in faults(found)]
    assert len(told) == 5
    assert all("--set" in text for _, text in told)
    assert isinstance(found.cases[0].data, dict)
    json.dumps([case.data for case in found.cases])


def test_a_wrong_key_of_a_named_case(planned):
    with pytest.raises(ScenarioError, match="nothing named 'C'"):
        planned("joints.C.clearance=[1 mm]", more="cases: {a: {}}\n")


def test_a_fixed_number_does_not_vary(planned):
    more = f"sweep: {{{B}: [1 mm, 2 mm], {MU}: [0.8, 0.9]}}\n"
    found = planned(f"{B}=3 mm", more=more)
    assert rows(found, MU) == [(0.8,), (0.9,)]
    assert {case.data["joints"]["B"]["clearance"] for case in found.cases} == {"3 mm"}
    whole = planned("joints.B={type: revolute, bodies: [rod, slider], at: [0.17, 0]}", more=more)
    assert whole.keys == (MU,)
    with pytest.raises(UsageError, match="says nothing to vary"):
        planned(f"{B}=3 mm", f"{MU}=0.8", more=more)


def test_a_list_for_a_key_that_is_one(planned):
    with pytest.raises(ScenarioError, match="which is a list itself"):
        planned("bodies.rod.at=[0.11, 0]")
    found = planned("bodies.rod.at=[[0.11, 0], [0.12, 0]]")
    assert [case.values["bodies.rod.at"] for case in found.cases] == [[0.11, 0], [0.12, 0]]


def test_misspelt_settings(planned):
    with pytest.raises(ScenarioError, match="unknown key 'methd'") as error:
        planned(more="sweep: {methd: grid, solver.end: [1 ms]}\n")
    assert "Did you mean 'method'?" in error.value.hint
