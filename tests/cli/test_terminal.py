"""What files hold never drives the terminal: no control character of theirs is printed."""

import json
import unicodedata
import warnings

import h5py
import pytest

from tests import drawn, inside, small
from trsim.cli import main

# title, screen, line, cursor, colour in one byte, direction, line of Unicode, delete
HOSTILE = "\x1b]0;owned\x07\x1b[2J\r\b\x9b31m\u202e\u2028\x7f\x0c"
FORGED = "x\nerror: forged"
DIRECTIONS = "\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"


def seen(text):
    """The characters of a text that a terminal obeys."""
    obeyed = [c for c in text if unicodedata.category(c) in ("Cc", "Cs", "Zl", "Zp")]
    return {c for c in obeyed if c not in "\n\t"} | (set(text) & set(DIRECTIONS))


@pytest.fixture
def said(trsim, monkeypatch):
    """Runs a command line, plain and with --json; all that is printed is looked at."""
    inside.recovering(monkeypatch)

    def command(*words, code=None):
        for more in ((), ("--json",)):
            ended, out, err = trsim(*words, *more)
            assert not seen(out + err), (more, seen(out + err))
            assert not [x for x in (out + err).splitlines() if x.startswith("error: forged")]
            assert code is None or ended == code, err
        json.loads(out)
        return ended

    return command


def quoted(text):
    """A text as YAML and JSON write it."""
    return json.dumps(text)


@pytest.mark.parametrize("old, new", [
    ("title: Slider-crank with play", "title: {}"),
    ("  crank: {{mass", "  {}: {{mass"),
    ("bodies: [ground, crank]", "bodies: [ground, {}]"),
    ("mass: 0.3", "mass: {}"),
    ("type: revolute", "type: {}"),
    ("joints:\n", "{}: 1\njoints:\n"),
    ("velocity: 5000 rpm", "velocity: {}"),
    ("velocity: 5000 rpm", "velocity: {{table: {}}}"),
    ("method: dop853", "method: {}"),
    ("solver:", "extends: {}\nsolver:"),
    ("  journal:", "  {}:"),
    ("plot: [B.eccentricity_x,", "plot: [{},"),
])  # fmt: skip
def test_texts_of_a_scenario(old, new, scenario, said):
    old, new = old.replace("{{", "{"), new.format(quoted(HOSTILE + FORGED + "\ud800"))
    text = small.SLIDER_CRANK
    assert old in text
    scenario.write_text(text.replace(old, new, 1), encoding="utf-8")
    if said("check", "crank.yaml") == 0:
        said("run", "crank.yaml", "-o", "x.h5")


def test_control_characters_as_they_are(scenario, said):
    for text in (HOSTILE, f"title: {HOSTILE}\n", f"a: '{HOSTILE}'", f"{HOSTILE}: 1"):
        scenario.write_text(text, encoding="utf-8")
        said("check", "crank.yaml")
        said("sweep", "crank.yaml", "--dry-run")


def test_names_of_files(scenario, said):
    name = "\x1b]0;owned\x07\r\x9b"
    (scenario.parent / f"{name}.yaml").write_text(small.SLIDER_CRANK)
    small.copy(scenario.parent / f"{name}.h5")
    said("check", f"{name}.yaml", code=0)
    said("check", f"{name}.yml", code=7)
    said("run", f"{name}.yaml", "--set", f"{name}=1")
    said("show", f"{name}.h5", code=0)
    said("export", f"{name}.h5", "--csv", "--channels", name)
    said("recover", f"{name}.h5", "-o", f"{name}.again.h5")
    said("explain", name)
    said("show", f"--{name}")
    said(name)


def attributes(file):
    for name in ("title", "status", "reason", "content_sha256"):
        file.attrs[name] = HOSTILE + FORGED


def texts(file):
    """Every text in the file: attributes, and datasets of texts."""
    hostile = HOSTILE.replace("\x07", "") + FORGED

    def change(_, item):
        for name, value in item.attrs.items():
            if isinstance(value, str) and name not in ("format", "NAME", "CLASS"):
                item.attrs[name] = hostile
        kind = h5py.check_string_dtype(item.dtype) if isinstance(item, h5py.Dataset) else None
        if kind is not None and kind.length is None and item.shape and item.size:
            item[...] = hostile

    file.visititems(change)


def channels(file):
    file[HOSTILE.replace("/", "")] = file["stroke"]
    file[FORGED] = file["stroke"]


@pytest.mark.parametrize("change", [attributes, texts, channels])
def test_texts_of_a_result_file(change, scenario, said):
    path = scenario.parent / "x.h5"
    small.copy(path, *small.FEW, "solver.end=1.5 ms", "output.every=0.1 ms")
    with h5py.File(path, "r+") as file:
        change(file)
    said("show", "x.h5")
    said("show", "x.h5", "--verify")
    said("export", "x.h5", "--csv")
    said("run", "x.h5")
    said("recover", "x.h5", "-o", "y.h5")


@pytest.mark.filterwarnings("ignore:Glyph")
def test_texts_in_figures(scenario, said, monkeypatch):
    drawn.few(monkeypatch)
    path = scenario.parent / "x.h5"
    small.copy(path, "output.channels=[stroke]")  # the title is in every figure
    with h5py.File(path, "r+") as file:
        file.attrs["title"] = HOSTILE
    said("report", "x.h5", "-o", "figures")


def test_texts_of_a_sweep(scenario, said):
    words = ("sweep", "crank.yaml", "--set", "joints.B.clearance=[0.4 mm, 0.5 mm]", "-o", "s")
    here = scenario.parent / "s"
    (here / "cases").mkdir(parents=True)
    hostile = HOSTILE + FORGED
    cases = [{"name": hostile, "digest": "1", "values": {"a": hostile}}]
    plan = {"format": "trsim sweep", "version": 1, "source": hostile, "engine": hostile,
            "keys": ["a"], "units": {"a": hostile}, "written": {}, "method": hostile,
            "samples": 1, "seed": 1, "cases": cases}  # fmt: skip
    entry = {"case": hostile, "digest": "1", "engine": hostile, "status": "failed",
             "reason": hostile, "attempts": 1, "content": "", "size": 0, "changed": 0, "at": 1.0,
             "wall": 1.0, "summary": {}}  # fmt: skip
    (here / "plan.json").write_text(json.dumps(plan))
    (here / "ledger.jsonl").write_text(json.dumps(entry) + "\n")
    said("status", "s")
    said("report", "s", "--table", hostile)
    (here / "cases" / f"{HOSTILE.replace('/', '')}.h5").write_text("")
    said(*words, "--dry-run")


def test_warnings_of_python_are_ours_too(scenario, capsys):
    with pytest.raises(SystemExit):
        main(["explain"])
    assert not seen(warnings.formatwarning(f"glyph {HOSTILE}", UserWarning, "x.py", 1, HOSTILE))
