"""docs/why_did_my_run_fail.md names whatever a run may end with, and nothing else."""

import ast
import re
from collections.abc import Iterator
from functools import cache

import pytest

from tests.test_circles import ROOT
from trsim import errors
from trsim.solve.simulate import REASONS
from trsim.statuses import STATUSES

TEXT = (ROOT / "docs/why_did_my_run_fail.md").read_text(encoding="utf-8")
SOLVE = ROOT / "trsim/solve"
FILES = [SOLVE / name for name in ("simulate.py", "outcome.py", "methods/scipy_ivp.py",
                                   "march/act.py", "march/openings.py")]  # fmt: skip
FOUND = {*SOLVE.glob("diagnose/*.py"), *SOLVE.glob("path/*.py")}
FILES += sorted(FOUND - {SOLVE / "diagnose/skipped.py"})  # what `check` leaves out
LONG = 35  # letters: of a sentence, not of a name
# hints, remedies and clauses that stand behind a sentence which is named
BEHIND = """
`step: {} s`, or `method: auto`; `force: true` tries it all the same
leave `formulation` out
`every` is the time between two rows
make `output: {every: ...}` longer
and by more over many
make it {} s or longer, the run shorter, or check the unit
make the period longer, or the time between two output rows shorter
leave out `method`, or give `locate_events: true`
a coordinate that joints, locks or other drives fix
It was left out of the solve
what was drawn cannot move like this
use `stabilisation: projection`, or larger rates
log or sqrt of something negative
is an expression outside its range
the forces give joints clearance or compliance
Else `tolerance` or the step is too coarse
and what follows is off by as much
Or do branches of the motion nearly meet
is a stiffness, a mass or a damping out of all proportion
take care that nothing is divided by zero
or leave out `method: kinematic`
or let the motion be computed
make it rigid
add a spring, a stop, a drive or friction
does something hold every load, and every body?  `trsim statics` tells more
""".strip().splitlines()


def sentences(tree: ast.AST) -> Iterator[str]:
    """The long texts of a module but its docstrings, with {} for what is put in."""
    docs, parts = set(), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            docs.add(id(node.value))
        elif isinstance(node, ast.JoinedStr):
            parts |= {id(one) for one in node.values}
    for node in ast.walk(tree):
        text = ""
        if isinstance(node, ast.JoinedStr):
            ones = node.values
            text = "".join(str(x.value) if isinstance(x, ast.Constant) else "{}" for x in ones)
        elif isinstance(node, ast.Constant) and id(node) not in docs | parts:
            text = node.value if isinstance(node.value, str) else ""
        if len(text) >= LONG and " " in text:
            yield text


@cache
def said() -> list[str]:
    """Six thousand lines are parsed for it, once."""
    found = [text for path in FILES for text in sentences(ast.parse(path.read_text("utf-8")))]
    return [*found, *REASONS.values()]


def rows(section: str) -> list[list[str]]:
    """The cells of a table below a heading, without its head."""
    lines = TEXT.split(f"\n## {section}\n")[1].split("\n## ")[0].splitlines()
    rows = [line.strip("|").split("|") for line in lines if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows[2:]]


@cache
def phrases() -> list[str]:
    """What the page says that a run says."""
    where = ("Reasons of a failed run", "Ends of a static path", "Warnings of a finished run")
    return [word for section in where for row in rows(section)
            for word in re.findall(r"`([^`]+)`", row[0])]  # fmt: skip


def told(phrase: str, text: str) -> bool:
    words = re.sub(r"\bN\b", "{}", phrase)
    return words in text


@pytest.mark.parametrize("text", sorted({*said()}), ids=lambda text: text[:60])
def test_every_reason_is_on_the_page(text):
    assert any(told(p, text) for p in phrases()) or any(text.find(b) >= 0 for b in BEHIND)


@pytest.mark.parametrize("phrase", phrases())
def test_every_reason_of_the_page_is_said(phrase):
    assert any(told(phrase, text) for text in said())


@pytest.mark.parametrize("clause", BEHIND)
def test_every_clause_is_there(clause):
    assert any(clause in text for text in said())


def test_every_status_and_exit_code():
    assert [row[0].strip("`") for row in rows("The status")] != []
    assert {row[0].strip("`") for row in rows("The status")} == set(STATUSES)
    codes = {one.exit_code for one in vars(errors).values()
             if isinstance(one, type) and issubclass(one, errors.TrsimError)}  # fmt: skip
    page = {int(code) for row in rows("The exit code") for code in row[0].split(", ")}
    assert page == codes | {0, 130, 143}


def test_a_new_reason_would_be_missed():
    source = 'f"{x}: a wheel {y} of the mechanism fell off"'
    source = f'def f():\n    "What f does, told in a long sentence."\n    return {source}'
    (found,) = sentences(ast.parse(source))
    assert found == "{}: a wheel {} of the mechanism fell off"
    assert not any(told(p, found) for p in phrases())
