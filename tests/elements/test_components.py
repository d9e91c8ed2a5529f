"""A wrench from one table of seven columns is the wrench of six tables."""

import json
import os

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.errors import TrsimError
from trsim.scenario.load import load, loads, locate
from trsim.scenario.load_sets import told
from trsim.sweeps.plan import faults, plan

from ..runs import run

HEAD = "t [ms], Fx [N], Fy [kN], Fz [N], Mx [N*m], My [N*mm], Mz [N*m]"
ROWS = [
    [0, 0, 0.1, 3, 0.5, 100, -1],
    [20, 5, 0.2, 4, 0.7, -200, 0],
    [50, -3, 0.1, 5, -0.1, 400, 2],
    [90, 2, 0.05, 1, 0.3, 300, 1],
    [110, 1, 0.07, 2, 0.2, 0, -2],
]
SCENE = """
planar: false
points: {seat: {body: box, at: [0.1, 0.2, 0.3], x_axis: [0, 1, 0], y_axis: [0, 0, 1]}}
bodies: {box: {mass: 2, inertia: [0.1, 0.2, 0.25], angular_velocity: [1, 2, 3]}}
forces: {air: {type: wrench, body: box, frame: seat, WRENCH}}
solver: {method: rk4, step: 1e-3, end: 0.1}
output: {every: 0.02}
"""


def csv(head=HEAD, rows=ROWS):
    return (
        "\n".join([*([head] if head else []), *(", ".join(map(str, row)) for row in rows)]) + "\n"
    )


def six(**more):
    """The six tables by themselves."""
    units = ["N", "kN", "N", "N*m", "N*mm", "N*m"]
    found = [
        {"table": [[row[0], row[k + 1]] for row in ROWS], "units": ["ms", units[k]], **more}
        for k in range(6)
    ]
    return f"force: {json.dumps(found[:3])}, moment: {json.dumps(found[3:])}"


def scene(wrench):
    return SCENE.replace("WRENCH", wrench)


def write(tmp_path, text=None, wrench="components: {table: air.csv}", scene_text=None):
    (tmp_path / "air.csv").write_text(csv() if text is None else text)
    (tmp_path / "a.yaml").write_text(scene_text or scene(wrench))
    os.chdir(tmp_path)
    return "a.yaml"


@pytest.fixture(autouse=True)
def back(monkeypatch):
    """To the folder of before, when a test is done."""
    monkeypatch.chdir(".")


def refusal(path):
    scenario = None
    with pytest.raises(TrsimError) as caught:
        scenario = load(path)
        assemble(scenario)
    error = caught.value
    return (locate(error, scenario) if scenario else error).show()


@pytest.mark.parametrize("more", [{}, {"interpolation": "linear"}, {"outside": "extend"},
                                  {"interpolation": "spline"}])  # fmt: skip
def test_one_table_is_six(tmp_path, more):
    words = "".join(f", {key}: {word}" for key, word in more.items())
    ours = run(load(write(tmp_path, wrench=f"components: {{table: air.csv{words}}}")))
    theirs = run(scene(six(**more)))
    assert np.ptp(ours["air.moment"], axis=0).min() > 0.1
    assert ours.rows.tobytes() == theirs.rows.tobytes()


def test_rows_hold_at_their_times(tmp_path):
    r = run(
        load(write(tmp_path, wrench="components: {table: air.csv}"), ["forces.air.frame=world"])
    )
    np.testing.assert_allclose(r.at("air.force", 0.02), [5, 200, 4], rtol=1e-12)
    np.testing.assert_allclose(r.at("air.moment", 0.02), [0.7, -0.2, 0], rtol=1e-12, atol=1e-15)
    assert [f.name for f in r.mechanism.functions] == [
        f"forces.air.components.{name}" for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
    ]


def test_rows_may_stand_in_the_scenario_and_have_parameters():
    rows = json.dumps([["t [s]", *["Fx", "Fy", "Fz", "Mx", "My"], "Mz [kN*m]"],
                       [0, "2 N", "a", 0, 0, 0, 1], [1, "3 N", "2*a", 0, 0, 0, 2]])  # fmt: skip
    text = "parameters: {a: 7}\n" + scene(f"components: {{table: {rows}}}")
    spec = loads(text).forces["air"]
    assert (spec.force[0].y, spec.force[1].y) == ((2.0, 3.0), (7.0, 14.0))
    assert spec.moment[2].y == (1000.0, 2000.0)
    assert spec.force[2].kind == spec.moment[0].kind == "constant"


def test_a_table_of_a_sensor_in_an_instance():
    rows = [[0, 1, 2, 0, 0, 0, 3], [1, 2, 3, 0, 0, 0, 4]]
    text = f"""
templates:
  t:
    bodies: {{rod: {{mass: 1, inertia: 1}}}}
    joints: {{pin: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
    sensors: {{turn: {{joint: pin}}}}
    forces: {{air: {{type: wrench, body: rod, frame: rod,
                     components: {{table: {rows}, of: turn.rate, outside: error}}}}}}
instances: {{left: {{template: t}}}}
solver: {{end: 1}}
"""
    s = loads(text)
    assert s.forces["left_air"].force[0].of == "left_turn.rate"
    assert s.forces["left_air"].force[0].ends == "refuse"
    assert assemble(s).planar  # columns of zeros push nothing out of the plane
    bent = text.replace("[0, 1, 2, 0,", "[0, 1, 2, 1e-3,").replace(
        "inertia: 1}", "inertia: [1,1,1]}"
    )
    assert not assemble(loads(bent)).planar


def test_load_sets_scale_all_six(tmp_path):
    more = "load_sets: {gust: {loads: [air], limit: 2}}\nloads: {gust: limit}\n"
    once = load(write(tmp_path)).forces["air"]
    twice = load(write(tmp_path, scene_text=scene("components: {table: air.csv}") + more))
    assert told(twice)
    for key in ("force", "moment"):
        for one, two in zip(getattr(once, key), getattr(twice.forces["air"], key), strict=True):
            assert two.y == tuple(2 * y for y in one.y)
    assert run(twice).at("air.force", 0.0) == pytest.approx(
        2 * run(load(write(tmp_path))).at("air.force", 0.0)
    )


# --- which columns -----------------------------------------------------------------------------

WIDE = [[k, *row[:3], 9 * k, *row[3:]] for k, row in enumerate(ROWS)]
MIXED = [[row[6], row[0], row[2], row[1], row[3], row[5], row[4]] for row in ROWS]
NAMED = "Mz [N*m], t [ms], Fy [kN], fx [N], Fz [N], My [N*mm], mx [N*m]"
RAW = "n, time [ms], X [N], Y [kN], note, Z [N], L [N*m], M [N*mm], N [N*m]"


@pytest.mark.parametrize("head, rows, columns", [
    (NAMED, MIXED, None),
    (RAW, WIDE, [2, 3, 4, 6, 7, 8, 9]),
    (RAW, WIDE, ["time", "X", "Y", "Z", "L", "M", "N"]),
    (RAW, WIDE, ["time", 3, "Y", 6, "L", "M", 9]),
])  # fmt: skip
def test_columns_are_chosen_by_titles_or_numbers(tmp_path, head, rows, columns):
    chosen = "" if columns is None else f", columns: {json.dumps(columns)}"
    path = write(tmp_path, csv(head, rows), f"components: {{table: air.csv{chosen}}}")
    assert load(path).forces["air"].force == load(write(tmp_path)).forces["air"].force
    path = write(tmp_path, csv(head, rows), f"components: {{table: air.csv{chosen}}}")
    assert load(path).forces["air"].moment == load(write(tmp_path)).forces["air"].moment


def test_without_titles_all_is_si_and_said_so(tmp_path):
    s = load(write(tmp_path, csv("")))
    assert s.forces["air"].force[1].y == (0.1, 0.2, 0.1, 0.05, 0.07)
    assert s.forces["air"].force[1].x[1] == 20.0
    (note,) = s.bare
    assert "columns 1 (x), 2 (Fx), 3 (Fy), 4 (Fz), 5 (Mx), 6 (My), 7 (Mz) of air.csv" in note
    (note,) = load(write(tmp_path, csv(HEAD.replace(" [kN]", "")))).bare
    assert "components.table: column 3 (Fy) of air.csv without a unit" in note


# --- what is wrong -----------------------------------------------------------------------------


def changed(row, column, value):
    rows = [list(one) for one in ROWS]
    rows[row][column] = value
    return csv(rows=rows)


@pytest.mark.parametrize("text, place, message", [
    (changed(2, 3, "x"), "air.csv:4:14", "row 4 of air.csv: 'x' in column 4 (Fz) is not a finite"),
    (changed(2, 3, ""), "air.csv:4:", "row 4 of air.csv: '' in column 4 (Fz) is not a finite"),
    (changed(2, 3, "nan"), "air.csv:4:", "'nan' in column 4 (Fz) is not a finite number"),
    (changed(3, 0, 50), "air.csv:5:1", "row 5 of air.csv: t must rise, got 50 after 50"),
    (changed(3, 0, 1), "air.csv:5:1", "row 5 of air.csv: t must rise, got 1 after 50"),
    (csv(rows=[*ROWS[:2], ROWS[2][:6], *ROWS[3:]]), "air.csv:4:1",
     "row 4 of air.csv has 6 columns, not 7"),
    (csv(rows=[*ROWS[:2], [*ROWS[2], 1], *ROWS[3:]]), "air.csv:4:1",
     "row 4 of air.csv has 8 columns, not 7"),
    (csv(rows=ROWS[:1]), "air.csv:2:1", "air.csv has one row of numbers, and a table needs two"),
    (csv(rows=[]), "air.csv:1:1", "air.csv has no rows of numbers"),
    ("", "air.csv:1:1", "air.csv has no rows of numbers"),
    (csv(HEAD.replace(", Mz [N*m]", ""), [row[:6] for row in ROWS]), "air.csv:1:1",
     "air.csv has no column 'Mz', but 'Fx'"),
    (csv(HEAD + ", more", [[*row, 1] for row in ROWS]), "air.csv:1:1",
     "air.csv has 2 columns beside Fx, Fy, Fz, Mx, My, Mz: which is x?"),
    (csv("", [row[:6] for row in ROWS]), "air.csv:1:1",
     "air.csv has 6 columns, not seven: x, Fx, Fy, Fz, Mx, My, Mz"),
    (csv(HEAD.replace("Fz", "Fx")), "air.csv:1:1", "no column 'Fz'"),
    (csv(HEAD.replace("Fx [N]", "Fx [N*m]")), "air.csv:1:9",
     "column 2 (Fx), read as Fx: wrong unit: 'N*m'"),
    (csv(HEAD.replace("Mx [N*m]", "Mx [N]")), "air.csv:1:", "column 5 (Mx), read as Mx: wrong"),
    (csv(HEAD.replace("t [ms]", "t [kg]")), "air.csv:1:1", "column 1 (t), read as x: wrong unit"),
    (csv(HEAD.replace("Fx [N]", "Fx [nn]")), "air.csv:1:9", "air.csv, column 2: unknown unit"),
    (csv("a,b,c,d,e,f,g\nh,i,j,k,l,m,n"), "air.csv:2:1", "'h' in column 1 (x) is not a finite"),
])  # fmt: skip
def test_faults_of_a_file(tmp_path, text, place, message):
    found = refusal(write(tmp_path, text))
    assert message in found
    assert place in found


@pytest.mark.parametrize("wrench, message", [
    ("components: {table: air.csv, columns: [t, Fx]}", "columns must be seven titles or numbers"),
    ("components: {table: air.csv, columns: 3}", "columns must be seven titles or numbers"),
    ("components: {table: air.csv, columns: [1, 2, 3, 4, 5, 6, 8]}",
     "air.csv has columns 1 to 7, and no column 8"),
    ("components: {table: air.csv, columns: [0, 2, 3, 4, 5, 6, 7]}", "and no column 0"),
    ("components: {table: air.csv, columns: [1, 2, 3, 4, 5, 6, 6]}", "names column 6 twice"),
    ("components: {table: air.csv, columns: [t, Fx, Fy, Fz, Mx, My, M]}",
     "air.csv has no column 'M'"),
    ("components: {table: air.csv, columns: [1, 2, 3, 4, 5, 6, 1.5]}",
     "a column is a title or a number, got 1.5"),
    ("components: {table: air.csv, of: turn}", "forces.air.components"),
    ("components: {table: none.csv}", "there is no file 'none.csv'"),
    ("components: {table: air.csv}, force: [1, 2, 3]", "give `components`, or `force` and"),
    ("components: {tabel: air.csv}", "unknown key 'tabel'"),
    ("components: {table: [[0, 1], [1, 2]]}", "a row is [x, Fx, Fy, Fz, Mx, My, Mz]"),
    ("components: {table: [[1,0,0,0,0,0,1], [0,0,0,0,0,0,1]]}", "x must rise, got 0 after 1"),
    ("components: {table: [[0,0,0,0,0,0,0], [1,0,0,0,0,0,0]]}", "all six components are zero"),
    ("components: {table: [[0,0,1 m,0,0,0,0], [1,0,0,0,0,0,0]]}", "table.0.2: wrong unit: 'm'"),
    ("components: {table: [[0,0,[],0,0,0,0], [1,0,0,0,0,0,0]]}", "table.0.2: must be a number"),
    ("components: {table: [[0,0,0,0,0,0,1], [1,0,0,0,0,0,0]], columns: [1, 2, 3, 4, 5, 6, 7]}",
     "columns are those of a file, and here are rows"),
    ("components: {table: 3}", "must be rows [x, Fx, Fy, Fz, Mx, My, Mz] or a CSV file, got 3"),
])  # fmt: skip
def test_faults_of_a_scenario(tmp_path, wrench, message):
    found = refusal(write(tmp_path, wrench=wrench))
    assert message in found
    assert "a.yaml:5:" in found


def test_a_case_names_the_file_with_its_columns(tmp_path):
    """A file is read before cases are made, so columns alone would change nothing."""
    more = "cases: {b: {forces: {air: {components: {columns: [1, 3, 2, 4, 5, 6, 7]}}}}}\n"
    path = write(tmp_path, scene_text=scene("components: {table: air.csv}") + more)
    ((_, fault),) = faults(plan(path))
    assert "columns are those of a file" in fault.what
    whole = more.replace("{columns", "{table: air.csv, columns")
    path = write(tmp_path, csv(""), scene_text=scene("components: {table: air.csv}") + whole)
    found = plan(path)
    assert list(faults(found)) == []
    assert found.scenario(found.cases[0]).forces["air"].force[0].y[0] == 0.1


def test_units_of_x_are_those_of_its_sensor(tmp_path):
    text = scene("components: {table: air.csv, of: turn}").replace("forces:", """
sensors: {turn: {type: relative_angle, bodies: [ground, box], axis: [0, 0, 1]}}
forces:""")  # fmt: skip
    found = refusal(write(tmp_path, scene_text=text))
    assert "components" in found
    assert "wrong unit: 'ms'; 'turn' is in rad" in found
