"""trsim init: every template is written, checks, and its commands are those one can type."""

import os
import re
import shlex
from importlib import import_module
from pathlib import Path

import pytest

from tests import drawn, inside
from tests.sizes import RELEASE
from trsim.scenario.load import load
from trsim.scenario.shipped import FOLDERS, TEMPLATES, template

ROOT = Path(__file__).parents[2]
ALONE = [name for name in TEMPLATES if name not in FOLDERS]  # those of the others run for long


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def written(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_is_written_and_checks(name, trsim, here):
    code, out, err = trsim("init", "--template", name)
    assert code == 0
    assert sorted(out.splitlines()) == written(here)
    first = out.splitlines()[0]
    text = Path(first).read_text()
    assert text.startswith("# ") and "\n# Try:  trsim " in text
    assert any(digit in text.splitlines()[0] for digit in "0123456789")
    assert "Try:\n  " in err
    assert load(first).title in err
    if name not in ALONE or f"trsim check {first}" not in commands(text):  # these are typed below
        assert trsim("check", first)[0] == 0


def test_files_are_those_of_the_project(trsim, here):
    """One source: what is written is what the tests of the scenarios run."""
    trsim("init", "reverser")
    folder = ROOT / "scenarios" / "thrust_reverser"
    assert written(here / "reverser") == written(folder)
    for file in folder.iterdir():
        assert (here / "reverser" / file.name).read_bytes() == file.read_bytes()


def commands(text):
    """What stands under `Try:`."""
    lines = text.split("# Try:")[1].splitlines()
    block = [lines[0]]
    for line in lines[1:]:
        if not line.startswith("#       "):
            break
        block.append(line[1:])
    return [line.strip() for line in block]


@pytest.mark.parametrize("name", TEMPLATES)
def test_commands_are_told_as_in_the_file(name, answer):
    _, told = answer("init", name)
    assert told["commands"] == commands(Path(told["files"][0]).read_text())
    for command in told["commands"]:
        program, verb, *words = shlex.split(command)
        assert program == "trsim"
        made = import_module(f"trsim.cli.{verb}").command.make_context(verb, words)
        assert made.params


def shorter(command):
    """A sweep with the first and the last of its cases; else as it is."""
    _, verb, *words = shlex.split(command)
    if verb == "sweep" and not RELEASE:
        words = [re.sub(r"(lin\(.*), \d+\)$", r"\1, 2)", word) for word in words]
    return [verb, *words]


def test_a_sweep_is_made_shorter():
    line = 'trsim sweep x.yaml --set "parameters.tilt=lin(10deg, 22deg, 5)" -o y'
    assert RELEASE or shorter(line)[3:] == ["parameters.tilt=lin(10deg, 22deg, 2)", "-o", "y"]


@pytest.mark.parametrize("name", ALONE)
def test_commands_can_be_typed(name, trsim, answer, monkeypatch):
    """One after the other, in the folder that was written."""
    drawn.few(monkeypatch)
    drawn.blank(monkeypatch)
    inside.sweeps(monkeypatch)
    for command in answer("init", name)[1]["commands"]:
        code, _, err = trsim(*shorter(command))
        assert code == 0, (command, err)
        assert "warning" not in err, (command, err)


def test_without_a_name_it_lists(trsim, answer, here):
    code, out, err = trsim("init")
    assert code == 0 and written(here) == []
    assert [line.split()[0] for line in out.splitlines()] == list(TEMPLATES)
    assert "trsim init pendulum" in err
    assert trsim("init", "--list")[1] == out
    _, told = answer("init", "--list")
    assert [one["name"] for one in told["templates"]] == list(TEMPLATES)
    assert told["files"] == [] and told["template"] is None
    assert all(one["about"] and one["title"] for one in told["templates"])


def test_a_folder_or_a_file_of_ones_own_name(trsim, answer, here):
    code, out, err = trsim("init", "mine", "--template", "four-bar")
    assert (code, out) == (0, "mine/four_bar.yaml\n")
    assert "cd mine" in err
    _, told = answer("init", "deep/er/crank.yaml", "--template", "slider-crank")
    assert told["files"] == ["deep/er/crank.yaml"]
    text = Path("deep/er/crank.yaml").read_text()
    assert "slider_crank" not in text
    assert "trsim report runs/crank.h5" in text and "trsim check crank.yaml" in told["commands"]
    assert trsim("check", "deep/er/crank.yaml")[0] == 0
    _, told = answer("init", "first")
    assert told["template"] == "pendulum" and told["files"] == ["first/pendulum.yaml"]
    _, told = answer("init", "first", "--template", "sweep", "--force")
    assert told["files"] == ["first/sweep.yaml", "first/pendulum.yaml"]


@pytest.mark.parametrize(
    "name, template, file",
    [
        ("crane.yaml", "crane", "crane.yaml"),
        ("sub/gear_pair.yml", "gear-pair", "sub/gear_pair.yml"),
        ("sub/crane", "crane", "sub/crane/crane.yaml"),
        ("./crane", "crane", "crane/crane.yaml"),
        ("first.yaml", "pendulum", "first.yaml"),
    ],
)
def test_a_path_that_ends_in_a_template(name, template, file, answer):
    _, told = answer("init", name)
    assert (told["template"], told["files"]) == (template, [file])
    assert f"trsim run {Path(file).name}" in told["commands"]


@pytest.mark.parametrize("word", ["four_bar", "Four Bar", "fourbar", "four-bar"])
def test_ways_to_write_a_name(word, answer):
    assert answer("init", "--template", word)[1]["template"] == "four-bar"
    assert template(word).name == "four-bar"


def test_nothing_is_written_over(trsim, here):
    trsim("init", "pendulum")
    Path("pendulum.yaml").write_text("mine")
    code, out, err = trsim("init", "sweep")
    assert (code, out) == (2, "")
    assert "pendulum.yaml" in err and "--force" in err
    assert written(here) == ["pendulum.yaml"] and Path("pendulum.yaml").read_text() == "mine"
    assert trsim("init", "sweep", "--force")[0] == 0
    assert Path("pendulum.yaml").read_text().startswith("# A rod")


def test_a_link_that_leads_nowhere_is_something(trsim, here):
    os.symlink("elsewhere", "pendulum.yaml")
    assert trsim("init", "pendulum")[0] == 2
    assert not Path("elsewhere").exists()


@pytest.mark.parametrize(
    "words, code, said",
    [
        (("--template", "fuor-bar"), 2, "Did you mean 'four-bar'?"),
        (("fuor-bar",), 2, "--template"),
        (("sub/fuor-bar",), 2, "--template"),
        (("pendullum.yaml",), 2, "--template"),
        (("mine.yaml", "--template", "reverser"), 2, "several files"),
        (("mine.yaml", "--template", "sweep"), 2, "several files"),
        (("pendulum", "--list"), 2, "--list"),
        (("",), 2, "empty"),
        (("x", "--template", ""), 2, "no template"),
        (("pendulum.yaml/x",), 7, "cannot be written"),
    ],
)
def test_refused(words, code, said, trsim, here):
    trsim("init", "pendulum")
    ended, out, err = trsim("init", *words)
    assert (ended, out) == (code, "")
    assert said in err
    assert written(here) == ["pendulum.yaml"]


def test_a_folder_in_the_way(trsim, here):
    (here / "pendulum.yaml").mkdir()
    assert trsim("init", "pendulum")[0] == 2
    code, _, err = trsim("init", "pendulum", "--force")
    assert code == 2 and "folder" in err


def test_an_installation_without_scenarios(trsim, monkeypatch, here):
    monkeypatch.setattr("trsim.scenario.shipped.files", lambda _: here / "nothing" / "trsim")
    code, _, err = trsim("init", "pendulum")
    assert code == 7 and "reinstall" in err
