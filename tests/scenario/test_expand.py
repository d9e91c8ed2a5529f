"""extends, CSV tables, --set and parameters; nothing outside the project is read."""

import math
import os
from hashlib import sha256

import pytest

from trsim.errors import FileError, ScenarioError, TrsimError, UsageError
from trsim.numbers import Measured
from trsim.scenario.cases import cases
from trsim.scenario.expand import (
    DEEPEST,
    MOST,
    expand,
    expand_text,
    numbers,
    parameters,
    rows,
)
from trsim.scenario.load import load
from trsim.scenario.text import read
from trsim.sweeps.plan import plan

from ..watching import Watch, apart


def files(folder, **texts):
    for name, text in texts.items():
        (folder / f"{name}.yaml").write_text(text)


def data(name, sets=()):
    return expand(name, sets)[0].data


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


# --- merging ---------------------------------------------------------------------------------


def test_merge(here):
    files(
        here,
        base="a: {x: 1, y: [1, 2], z: {p: 1, q: 2}}\nb: 1\nc: {type: one, k: 1}\nd: {k: 1}\ne: 1",
        top="extends: base.yaml\na: {y: [3], z: {q: 5, r: null}, w: 7}\nc: {type: two, m: 2}\n"
        "d: {type: three}\ne: {k: 1}\nf: 1",
    )
    assert data("top.yaml") == {
        "a": {"x": 1, "y": [3], "z": {"p": 1, "q": 5, "r": None}, "w": 7},
        "b": 1,
        "c": {"type": "two", "m": 2},
        "d": {"k": 1, "type": "three"},
        "e": {"k": 1},
        "f": 1,
    }


def test_null_removes(here):
    files(here, base="a: {x: 1, y: 2}\nb: {c: 1}", top="extends: base.yaml\na: {x: null}\nb: ~")
    tree, _ = expand("top.yaml")
    assert tree.data == {"a": {"y": 2}}
    assert ("b", "c") not in tree.marks
    assert ("a", "x") not in tree.keys


def test_a_later_file_overrides_an_earlier_one(here):
    files(here, one="a: 1\nb: 1\nc: 1", two="b: 2\nc: 2", top="extends: [one.yaml, two.yaml]\nc: 3")
    assert data("top.yaml") == {"a": 1, "b": 2, "c": 3}


def test_marks_keep_their_file(here):
    (here / "sub").mkdir()
    files(here / "sub", base="a:\n  x: 1\n  y: 2")
    files(here, top="extends: sub/base.yaml\na: {y: 3}")
    tree, text = expand("top.yaml")
    assert tree.place(("a", "x")).show() == "sub/base.yaml:2:6"
    assert tree.place(("a", "y")).show() == "top.yaml:2:8"
    assert tree.place(("a",)).show() == "top.yaml:2:1"
    assert text == "extends: sub/base.yaml\na: {y: 3}"
    assert tree.files == {
        name: sha256((here / name).read_bytes()).hexdigest()
        for name in ("top.yaml", "sub/base.yaml")
    }


def test_a_diamond_is_no_loop(here):
    files(
        here,
        base="a: 1",
        left="extends: base.yaml",
        right="extends: base.yaml",
        top="extends: [left.yaml, right.yaml]",
    )
    assert data("top.yaml") == {"a": 1}


# --- the boundary ----------------------------------------------------------------------------


def refusal(name, sets=()):
    with pytest.raises(ScenarioError) as caught:
        expand(name, sets)
    return caught.value


@pytest.fixture
def secret(tmp_path, monkeypatch):
    """A project folder with a file beside it that must not be read."""
    (tmp_path / "secret.yaml").write_text("title: secret")
    (tmp_path / "secret.csv").write_text("0, 1\n1, 2\n")
    folder = tmp_path / "project"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


def test_traversal(secret):
    (secret / "link.yaml").symlink_to("../secret.yaml")
    (secret / "sub").symlink_to("..")
    (secret / "zero.yaml").symlink_to("/dev/zero")
    os.mkfifo(secret / "pipe.yaml")
    (secret / "folder.yaml").mkdir()
    (secret / "round.yaml").symlink_to("round.yaml")
    files(secret, mechanism="title: x")
    refused = {
        "../secret.yaml": "lies outside project/",
        "sub/secret.yaml": "lies outside project/",
        "../project/../secret.yaml": "lies outside project/",
        str(secret.parent / "secret.yaml"): "is not relative to this file",
        "..\\\\secret.yaml": "is not relative to this file",
        "file:///etc/passwd": "is not relative to this file",
        "link.yaml": "lies outside project/",
        "zero.yaml": "lies outside project/",
        "/dev/zero": "is not relative to this file",
        "pipe.yaml": "is not a regular file",
        "folder.yaml": "is not a regular file",
        "round.yaml": "",
        "secret.txt": "does not end in .yaml or .yml",
        "MECHANISM.yaml": "there is no file 'MECHANISM.yaml'",
        "mechanism.yaml/x.yaml": "there is no file",
    }

    def read():
        told = []
        for name in refused:
            files(secret, top=f'extends: "{name}"')
            with Watch(("open",)) as opened:
                error = refusal("top.yaml")
            told.append((list(opened), error.what, error.show()))
        return told

    for what, (opened, told, shown) in zip(refused.values(), apart(read), strict=True):
        assert len(opened) == 1 and "top.yaml" in opened[0]
        assert what in told
        assert shown.startswith("top.yaml:1:10: extends: ")
    files(secret, top="extends: mechanisn.yaml")
    assert refusal("top.yaml").hint.startswith("Did you mean 'mechanism.yaml'?")


@pytest.mark.parametrize("value", ["5", "{a: b}", "[[a]]", "[5]", "true", '""'])
def test_extends_of_nonsense(here, value):
    files(here, top=f"extends: {value}")
    assert "must be the name of a file" in refusal("top.yaml").what


@pytest.mark.parametrize("mark", ["scenarios", "trsim-root"])
def test_a_project_is_wider_than_a_folder(tmp_path, monkeypatch, mark):
    root = tmp_path / ("scenarios" if mark == "scenarios" else "other")
    deep = root / "one" / "two"
    deep.mkdir(parents=True)
    files(root, base="title: base")
    files(deep, top="extends: ../../base.yaml", out="extends: ../../../base.yaml")
    files(tmp_path, base="title: outside")
    monkeypatch.chdir(deep)
    if mark == "trsim-root":
        assert "lies outside two/" in refusal("top.yaml").what
        (root / mark).touch()
    assert data("top.yaml") == {"title": "base"}
    assert f"lies outside {root.name}/" in refusal("out.yaml").what


def test_loops_and_depth(here):
    files(here, a="extends: b.yaml", b="extends: a.yaml", me="extends: me.yaml")
    (here / "alias.yaml").symlink_to("me.yaml")
    assert "extends itself" in refusal("a.yaml").what
    assert "extends itself" in refusal("me.yaml").what
    assert refusal("a.yaml").show().startswith("b.yaml:1:10: extends: 'a.yaml' extends itself")
    for k in range(DEEPEST + 1):
        files(here, **{f"f{k}": f"extends: f{k + 1}.yaml" if k < DEEPEST else "a: 1"})
    assert "more than 8 levels" in refusal("f0.yaml").what
    assert data("f1.yaml") == {"a": 1}


def test_fan_out(here):
    files(here, a="x: 1", b="extends: [a.yaml, a.yaml, a.yaml, a.yaml, a.yaml, a.yaml, a.yaml]")
    files(here, c="extends: [b.yaml, b.yaml, b.yaml, b.yaml, b.yaml, b.yaml, b.yaml]")
    assert refusal("c.yaml").what == f"more than {MOST} files"


def test_how_many_files_cases_may_extend(here):
    """1000, with the one they stand in."""
    for more in (999, 1000):
        files(here, a="x: 1", top=f"cases: {{one: {{extends: [{', '.join(['a.yaml'] * more)}]}}}}")
        if more < 1000:
            assert data("top.yaml")["cases"]["one"] == {"x": 1}
    assert refusal("top.yaml").what == "more than 1000 files"


def test_a_fault_in_an_extended_file_is_shown_there(here):
    files(here, base="a: 1\na: 2", top="extends: base.yaml")
    assert refusal("top.yaml").show().startswith("base.yaml:2:1: key 'a' stands here twice")


def test_unreadable_scenario(here):
    for name in ("none.yaml", ".", "x\0y", "none.yaml/x"):
        with pytest.raises(FileError) as caught:
            expand(name)
        assert caught.value.exit_code == 7


def test_a_text_extends_nothing_unless_it_has_a_folder(here):
    files(here, base="a: 1")
    with pytest.raises(ScenarioError, match="without a folder"):
        expand_text("extends: base.yaml")
    assert expand_text("extends: base.yaml", folder=here).data == {"a": 1}


# --- tables ----------------------------------------------------------------------------------


def test_table_beside_the_file_that_names_it(here):
    (here / "sub").mkdir()
    (here / "sub" / "air.csv").write_text("stroke, force\n0, 1\n\n# note\n0.5, 2e3\n")
    (here / "air.csv").write_text("0, 5\n1, 6\n")
    files(here / "sub", base="forces: {air: {force: {table: air.csv}}, b: {table: air.csv}}")
    files(here, top="extends: sub/base.yaml\nforces: {b: {table: air.csv}}\nreport: {table: x}")
    tree, _ = expand("top.yaml")
    assert tree.data["forces"] == {
        "air": {"force": {"table": [[0.0, 1.0], [0.5, 2000.0]]}},
        "b": {"table": [[0.0, 5.0], [1.0, 6.0]]},
    }
    assert tree.data["report"] == {"table": "x"}
    assert set(tree.files) == {"top.yaml", "sub/base.yaml", "sub/air.csv", "air.csv"}
    assert tree.place(("forces", "air", "force", "table", 1)).show() == "sub/base.yaml:1:31"
    assert data("top.yaml", ["forces.air.force.table=air.csv"])["forces"]["air"]["force"] == {
        "table": [[0.0, 5.0], [1.0, 6.0]]
    }


@pytest.mark.parametrize(
    "text, row, what",
    [
        ("0, 1\n1, x\n", 2, ": 'x' in column 2 is not a finite number"),
        ("0, 1\n1\n", 2, " is not two numbers, but 1 column"),
        ("0, 1\n1, 2, 3\n", 2, " is not two numbers, but 3 columns"),
        ("0; 1\n", 1, " is not two numbers, but 1 column"),
        ("0, nan\n", 1, ": 'nan' in column 2 is not a finite number"),
        ("0, 1\n1, inf\n", 2, ": 'inf' in column 2 is not a finite number"),
        ('0, 1\n"1, 2\n', 2, " is not two numbers"),
    ],
)
def test_csv_errors_name_the_row(text, row, what):
    with pytest.raises(ScenarioError) as caught:
        rows(text.encode(), "air.csv")
    assert caught.value.what == f"row {row} of air.csv{what}"
    assert caught.value.place.line == row


def test_csv_traversal(secret):
    (secret / "link.csv").symlink_to("../secret.csv")
    (secret / "bad.csv").write_bytes(b"\xff\xfe")
    for name, what in {
        "../secret.csv": "lies outside",
        "link.csv": "lies outside",
        "/dev/zero": "is not relative",
        "secret.txt": "does not end in .csv",
        "none.csv": "there is no file",
        "bad.csv": "not UTF-8",
    }.items():
        files(secret, top=f"forces: {{air: {{force: {{table: {name}}}}}}}")
        error = refusal("top.yaml")
        assert what in error.what
        assert error.path == ("forces", "air", "force", "table")


# --- --set -----------------------------------------------------------------------------------

SET = "joints: {B: {clearance: 0.1 mm, at: [1, 2]}}\nsolver: {end: 1}\ntitle: x"


@pytest.mark.parametrize(
    "text, path, value",
    [
        ("joints.B.clearance=0.3mm", ("joints", "B", "clearance"), "0.3mm"),
        ("joints.B.at.1=5", ("joints", "B", "at"), [1, 5]),
        ("joints.B.at=[3, 4]", ("joints", "B", "at"), [3, 4]),
        ("solver.end=1e-3", ("solver", "end"), 1e-3),
        ("solver.baumgarte.alpha=5", ("solver", "baumgarte"), {"alpha": 5}),
        ("output.every=1 ms", ("output",), {"every": "1 ms"}),
        ("title=a=b", ("title",), "a=b"),
        ("title=", ("title",), None),
        ("planar=true", ("planar",), True),
    ],
)
def test_set(text, path, value):
    tree = expand_text(SET, [text])
    found = tree.data
    for key in path:
        found = found[key]
    assert found == value
    assert tree.place(tuple(text.split("=")[0].split("."))).file in ("--set", "<text>")
    assert expand_text(SET, [text, text]).data == tree.data


def test_place_of_a_set_value():
    tree = expand_text(SET, ["joints.B.clearance=0.3mm"])
    assert tree.place(("joints", "B", "clearance")).caret() == (
        "    joints.B.clearance=0.3mm\n                       ^"
    )
    assert tree.key_place(("joints", "B", "clearance")).show() == "--set"


CASES = """
bodies: {door: {mass: 1}}
cases:
  ultimate: {extends: limit, parameters: {factor: 1.5}}
  limit: {extends: [closed, soft.yaml], parameters: {gust: 3}, sweep: {parameters.gust: [1, 2]}}
  closed: {initial: {hinge: 0}, forces: {seal: null}}
"""


def test_cases_extend_cases_in_any_order(here):
    files(here, soft="parameters: {gust: 1, k: 7}\ntitle: soft", top=CASES)
    cases = data("top.yaml")["cases"]
    closed = {"initial": {"hinge": 0}, "forces": {"seal": None}}
    limit = {**closed, "parameters": {"gust": 3, "k": 7}, "title": "soft"}
    assert cases["closed"] == closed
    assert cases["limit"] == {**limit, "sweep": {"parameters.gust": [1, 2]}}
    assert cases["ultimate"] == {**limit, "parameters": {"gust": 3, "k": 7, "factor": 1.5}}
    assert cases["ultimate"]["initial"] is not cases["closed"]["initial"]  # --set changes one


def test_a_case_knows_where_the_keys_of_its_file_are():
    text = "gravity: [0, 0]\nbodies:\n  door: {mass: 1}\ncases:\n  one: {title: first}\n"
    found = cases(read(text, "top.yaml"))["one"]
    for path, line, column in (
        (("gravity",), 1, 1), (("bodies", "door"), 3, 3), (("bodies", "door", "mass"), 3, 10),
        (("title",), 5, 9),
    ):  # fmt: skip
        place = found.key_place(path)
        assert (place.file, place.line, place.column) == ("top.yaml", line, column), path
    assert all(path[0] != "cases" for path in (*found.keys, *found.marks) if path)


def test_a_case_that_extends_itself_is_refused_where_it_says_so(here):
    files(here, top="cases:\n  a: {extends: b}\n  b: {extends: c}\n  c: {extends: a}")
    with pytest.raises(ScenarioError) as caught:
        data("top.yaml")
    assert caught.value.what == "case 'a' extends itself"
    assert caught.value.place.line in (2, 3, 4)
    files(here, top="cases:\n  a: {extends: b}\n  c: {}")
    with pytest.raises(ScenarioError) as caught:
        data("top.yaml")
    assert caught.value.place.line == 2


@pytest.mark.parametrize("text", ["joints.B.clearance", "=1", "a..b=1", ".=1", ""])
def test_set_that_is_no_assignment(text):
    with pytest.raises(UsageError):
        expand_text(SET, [text])


@pytest.mark.parametrize(
    "text, message",
    [
        ("joints.b.clearance=1", "--set: joints: nothing named 'b' in joints"),
        ("parameters.sped=1", "--set: parameters: nothing named 'sped' in parameters"),
        ("solver.end.x=1", "--set: solver.end: has no entry 'x': it is 1"),
        ("joints.B.at.7=1", "--set: joints.B.at: has no entry '7': it is a list of 2"),
        ("joints.B.at.x=1", "--set: joints.B.at: has no entry 'x': it is a list of 2"),
        ("title={a: 1", "--set: title: not YAML"),
        ("title=*x", "--set: title: anchors and aliases"),
        ("title=.nan", "--set: title: not a finite number"),
    ],
)
def test_refused_set(text, message):
    with pytest.raises(TrsimError) as caught:
        expand_text(SET, [text])
    assert caught.value.show().startswith(message)


def test_set_suggests_a_name():
    with pytest.raises(ScenarioError) as caught:
        expand_text("joints: {wrist: {}}", ["joints.wirst.clearance=1"])
    assert caught.value.hint.startswith("Did you mean 'wrist'?")


# --- parameters ------------------------------------------------------------------------------


def test_parameters():
    tree = expand_text("parameters: {v: 500 mm/s, T: 2, s: v*T + 1, angle: 90 deg, 'n': '3'}")
    values, problems = parameters(tree)
    assert problems == []
    assert values == {"v": 0.5, "T": 2.0, "s": 2.0, "angle": pytest.approx(1.5707963), "n": 3.0}


def test_faulty_parameters():
    text = "parameters: {a: b, b: 1, c: [1], d: 5 mn, e: 1/0, f: true, g: null, h: 1e999 m, i: t}"
    values, problems = parameters(expand_text(text))
    assert [(problem.path[1], problem.what) for problem in problems] == [
        ("a", "no parameter named 'b'"),
        ("c", "must be a number, got a list of 1"),
        ("d", "unknown unit 'mn'"),
        ("e", "1 / 0 has no finite value"),
        ("f", "must be a number, got true"),
        ("g", "must be a number, got nothing"),
        ("h", "must be a finite number"),
        ("i", "this number cannot depend on t"),
    ]
    assert problems[0].hint == "b is defined after a."
    assert values["b"] == 1.0
    assert parameters(expand_text("parameters: 5"))[1][0].path == ("parameters",)
    assert parameters(expand_text("title: x")) == ({}, [])


PRESSED = """
parameters: {push: 0 N, share: 0.5}
bodies: {block: {mass: 1, inertia: 1}}
joints: {hinge: {type: revolute, bodies: [ground, block], at: [0, 0]}}
solver: {end: 1}
"""


@pytest.mark.parametrize("how", ["set", "extends", "case", "sweep"])
def test_a_parameter_keeps_its_dimension(tmp_path, how):
    """An expression would take 2500 Pa for 2500 N."""
    (tmp_path / "base.yaml").write_text(PRESSED)
    texts = {
        "set": "extends: base.yaml",
        "extends": "extends: base.yaml\nparameters: {push: 2500 Pa}",
        "case": "extends: base.yaml\ncases: {one: {parameters: {push: 2500 Pa}}}",
        "sweep": "extends: base.yaml\nsweep: {parameters.push: [2500 Pa]}",
    }
    path = tmp_path / "over.yaml"
    path.write_text(texts[how])
    with pytest.raises(ScenarioError, match="of another dimension than '0 N'") as caught:
        if how == "set":
            load(path, ["parameters.push=2500 Pa"])
        elif how == "extends":
            load(path)
        else:
            plan(str(path), (), "one")
    assert caught.value.path == ("parameters", "push")
    assert caught.value.place is not None
    for push in ("2.5 kN", "2500", "-3 N"):
        assert load(path if how == "set" else tmp_path / "base.yaml", [f"parameters.push={push}"])
    assert load(tmp_path / "base.yaml", ["parameters.share=0.25"])


def test_a_parameter_made_of_angles_is_an_angle_itself():
    """No unit is written beside it: what is made of 30 deg goes into an angle as it is."""
    values, problems = numbers({"a": "30 deg", "b": "2*a", "c": "2*3", "d": 4}, {}, ())
    assert not problems
    assert isinstance(values["b"], Measured) and values["b"] == pytest.approx(math.pi / 3)
    assert not isinstance(values["c"], Measured) and not isinstance(values["d"], Measured)
