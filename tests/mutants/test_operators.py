"""What mutations are made of a text: the operators, each at its place, and nothing of words."""

import ast

import pytest

from tests.sizes import size

from .drawn import ROOMS, ROOT, drawn, lines, sources
from .equivalent import EQUIVALENT
from .nearest import stages
from .operators import mutations


def made(text):
    """Operator and the text it makes, of all mutations of a text."""
    data = text.encode()
    return {(one.operator, one.of(data).decode()) for one in mutations("x.py", data)}


@pytest.mark.parametrize(
    "text, operator, new",
    [
        ("a < b", "comparison", "a <= b"),
        ("a < b", "direction", "a > b"),
        ("a == b", "comparison", "a != b"),
        ("a not in b", "comparison", "a in b"),
        ("(a) + b", "arithmetic", "(a) - b"),
        ("a * (b)", "arithmetic", "a / (b)"),
        ("a**b", "arithmetic", "a*b"),
        ("a += b", "augmented", "a -= b"),
        ("a += b", "statement", "pass"),
        ("a and b", "logic", "a or b"),
        ("x = b if a else c", "logic", "x = b if (not (a)) else c"),
        ("if not a:\n    b", "logic", "if (a):\n    b"),
        ("x = 0.5", "number", "x = 1.0"),
        ("x = 3", "number", "x = 4"),
        ("x = True", "number", "x = False"),
        ("min(a, b)", "extreme", "max(a, b)"),
        ("x = abs(a - b)", "extreme", "x = (a - b)"),
        ("x = -a", "extreme", "x = a"),
        ("x = y[k]", "index", "x = y[k - 1]"),
        ("x = y[a, K]", "index", "x = y[a, K - 1]"),
        ("for k in range(a, n):\n    x", "index", "for k in range(a, (n) - 1):\n    x"),
        ("f(a)", "statement", "pass"),
        ("a[k] = b", "statement", "pass"),
        ("while a:\n    break", "flow", "while a:\n    continue"),
        ("def f(x):\n    g = x\n    x[0] = g", "flow", "def f(x):\n    g = x\n    return"),
    ],
)
def test_operators(text, operator, new):
    assert (operator, new) in made(text)


@pytest.mark.parametrize(
    "text",
    ['"""A docstring of 3 < 4."""', "x: list[1]", "def f(a: g(1)) -> h(2): ...", "x = f'{1}'",
     "if TYPE_CHECKING:\n    x = 1", "x = 'a' + b", "import a"],
)  # fmt: skip
def test_words_and_types_are_left_alone(text):
    assert made(text) == set()


def test_what_returns_something_gets_no_bare_return():
    assert not any(name == "flow" for name, _ in made("def f(x):\n    a = x\n    return a"))


def test_bytes_of_letters_of_more_than_one():
    assert ("arithmetic", "x = 'ä', a - b  # ö") in made("x = 'ä', a + b  # ö")


def test_drawn_from_all_rooms_and_the_same_again():
    some = drawn(300, "a seed")
    assert len({(one.file, one.line) for one in some}) == 300
    assert {one.file.split("/")[1] for one in some} == set(ROOMS)
    assert some == drawn(300, "a seed")
    assert some[:100] == drawn(100, "a seed")
    assert some != drawn(300, "another")
    for one in some:
        text = (ROOT / one.file).read_bytes()
        assert one.of(text) != text
    for one in some[: size(60, 300)]:
        ast.parse(one.of((ROOT / one.file).read_bytes()))


def test_a_change_of_one_line_leaves_the_others_drawn(tmp_path):
    """So that what is known of them stays known."""
    for room in ROOMS:
        (tmp_path / "trsim" / room).mkdir(parents=True)
    file = tmp_path / "trsim/laws/many.py"
    text = "".join(f"def f{k}(a, b):\n    return a + b * {k}\n" for k in range(200))
    file.write_text(text)
    before = {(one.operator, one.new, file.read_text().split("\n")[one.line - 1])
              for one in drawn(50, "s", tmp_path)}  # fmt: skip
    lines.cache_clear()
    file.write_text("import math\n" + text.replace("a + b * 77\n", "a - b * 77\n"))
    after = {(one.operator, one.new, file.read_text().split("\n")[one.line - 1])
             for one in drawn(50, "s", tmp_path)}  # fmt: skip
    assert len(before & after) >= 49


def test_every_source_file_has_all_tests_and_its_own_first():
    all_of_them = len(list((ROOT / "tests").rglob("test_*.py")))
    own = len(list((ROOT / "tests/mutants").rglob("test_*.py")))  # see mutations, not sources
    for file in sources()[::20]:
        tests = [test for stage in stages(ROOT, file) for test in stage]
        assert len(tests) == len(set(tests)) == all_of_them - own
    first = stages(ROOT, "trsim/elements/spring_damper.py")[0]
    assert first == ["tests/elements/test_spring_damper.py"]


def test_equivalent_mutations_are_still_there():
    """An entry whose line was changed says nothing any more."""
    for (file, text, new), why in EQUIVALENT.items():
        data = (ROOT / file).read_bytes()
        lines = [line.strip() for line in data.decode().splitlines()]
        assert any(lines[one.line - 1] == text and one.new == new for one in mutations(file, data))
        assert why
