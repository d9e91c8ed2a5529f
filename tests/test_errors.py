"""Errors say where, what and what to do; suggestions survive any single-edit misspelling."""

import pickle
import string

import pytest

from trsim.errors import (
    FileError,
    ModelError,
    Place,
    Problems,
    ScenarioError,
    SolverError,
    UsageError,
    closest,
    edits,
    known,
    printable,
    unreadable,
)

WORDS = [
    "bodies",
    "joints",
    "drives",
    "sensors",
    "forces",
    "contact_laws",
    "initial",
    "solver",
    "output",
    "parameters",
    "gravity",
    "stiffness",
    "preload",
    "damping",
    "clearance",
    "contact",
    "mass",
    "inertia",
    "at",
    "angle",
    "axis",
    "type",
    "tolerance",
    "end",
    "step",
]


def test_show():
    place = Place("a.yaml", 7, 16, "    stiffness: -3.0")
    error = ScenarioError("must be >= 0, got -3.0", "in N", ("stiffness",), place)
    assert error.at("forces", "spring").show() == (
        "a.yaml:7:16: forces.spring.stiffness: must be >= 0, got -3.0\n"
        "        stiffness: -3.0\n"
        "                   ^\n"
        "  in N"
    )


def test_show_without_a_place():
    assert ModelError("no mass", path=("bodies", 0)).show() == "bodies.0: no mass"


def test_caret_stays_under_its_character_in_a_long_line():
    line = "x" * 300 + "!" + "y" * 300
    excerpt, caret = Place("f", 1, 301, line).caret().splitlines()
    assert len(excerpt) < 120
    assert excerpt[caret.index("^")] == "!"


def test_no_escape_sequence_reaches_the_terminal():
    assert printable("a\x1b[31m\tb\n") == "a?[31m b?"
    assert "\x1b" not in Place("f", 1, 1, "\x1b[31m").caret()


def test_exit_codes():
    errors = (UsageError, ScenarioError, ModelError, SolverError, FileError)
    assert [error("x").exit_code for error in errors] == [2, 3, 4, 5, 7]
    assert Problems([ModelError("x"), ScenarioError("y")]).exit_code == 4


def test_problems():
    both = Problems([ScenarioError("x", path=("a",)), ScenarioError("y")], unlisted=2)
    assert both.at("top").show() == "top.a: x\ntop: y\n... and 2 more problems"
    assert [problem.what for problem in both.problems] == ["x", "y"]


def test_errors_travel_between_processes():
    one = ScenarioError("x", "h", ("a",), Place("f", 1, 2, "e"))
    for error in (one, Problems([one, one], 3)):
        copy = pickle.loads(pickle.dumps(error))  # noqa: S301
        assert (type(copy), copy.show()) == (type(error), error.show())


def misspellings(word):
    for k in range(len(word)):
        yield word[:k] + word[k + 1 :]
        yield word[:k] + "q" + word[k + 1 :]
        yield word[:k] + "z" + word[k:]
        if k:
            yield word[: k - 1] + word[k] + word[k - 1] + word[k + 1 :]


@pytest.mark.parametrize("word", WORDS)
def test_suggestion(word):
    wrong = [typo for typo in misspellings(word) if len(typo) > 1 and typo not in WORDS]
    assert [typo for typo in wrong if closest(typo, WORDS) != word] == []


@pytest.mark.parametrize("wrong, meant", [("Mass", "mass"), ("stifnes", "stiffness"), ("x", None)])
def test_closest(wrong, meant):
    assert closest(wrong, WORDS) == meant


def test_edits():
    assert [edits("abc", other) for other in ("abc", "acb", "ab", "xbcd", "zzz")] == [0, 1, 1, 2, 3]


def test_known():
    assert known("cranck", ["ground", "crank"]) == "Did you mean 'crank'?  Known: ground, crank."
    assert known("zzz", ["ground"]) == "Known: ground."
    assert known("x", list(string.ascii_letters)).endswith("... (38 more)")


def test_a_file_beside_it_was_meant(tmp_path):
    for name in ("four_bar.yaml", "four_bar.h5", "crane.yaml"):
        (tmp_path / name).touch()
    told = unreadable(tmp_path / "four-bar.yaml")
    assert told.what.endswith("no such file")
    assert told.hint == f"Did you mean {tmp_path / 'four_bar.yaml'}?"
    assert unreadable(tmp_path / "door.yaml").hint == ""
    assert unreadable(tmp_path / "crame.h5").hint == ""  # crane.yaml is of another kind
    assert unreadable(tmp_path / "none" / "four-bar.yaml").hint == ""
    assert unreadable(tmp_path / "four_bar.yaml") is None
