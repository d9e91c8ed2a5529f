"""Measured tables stand between markers, and a change of what made them is seen."""

import re

import pytest

from benchmarks import __main__ as measured
from benchmarks.docs import __main__ as maker
from benchmarks.docs import marks
from benchmarks.docs.made import LISTS, MADE, Made

PAGES = {page.name: page for page in marks.pages()}
LONG = Made("python -m somewhere", ("src",), "tables")


@pytest.mark.parametrize("name", PAGES)
def test_every_table_of_numbers_is_marked_or_listed(name):
    found = marks.unmarked(PAGES[name], LISTS.get(name, ()))
    assert found == [], "put it between markers (benchmarks/docs), or in LISTS if not measured"


@pytest.mark.parametrize("name", LISTS)
def test_every_head_of_the_list_is_on_its_page(name):
    lines = [line.strip() for line in PAGES[name].read_text(encoding="utf-8").splitlines()]
    assert [head for head in LISTS[name] if head not in lines] == []


def test_markers_and_entries_know_each_other():
    every = [one for page in PAGES.values() for one in marks.marked(page)]
    assert {one.name for one in every} == set(MADE)
    assert [one for one in every if one.command != MADE[one.name].command] == []


def test_entries_name_sources_that_are_there():
    for name, entry in MADE.items():
        assert [one for one in entry.of if not (marks.ROOT / one).exists()] == [], name


def test_commands_are_there():
    """Of benchmarks: each can be typed; none is a test, whose output is no table."""
    known = {*measured.NAMES, *measured.LONG}
    for name, entry in MADE.items():
        python, _, words = entry.command.partition(" -m benchmarks ")
        assert python != "python" or set(words.split()) <= known, name
        assert "pytest" not in entry.command, name


@pytest.fixture
def page(tmp_path, monkeypatch):
    """A page with a table that is made from two sources."""
    source = tmp_path / "src"
    source.mkdir()
    (source / "a.py").write_text("x = 1\n", encoding="utf-8", newline="\n")
    (source / "b.yaml").write_text("y: 2\n", encoding="utf-8", newline="\n")
    monkeypatch.setitem(MADE, "made_up", LONG)
    monkeypatch.setattr(marks, "ROOT", tmp_path)
    digest = marks.digest
    monkeypatch.setattr(marks, "digest", lambda of, _, words: digest(of, tmp_path, words))
    page = tmp_path / "page.md"
    head = marks.opening("made_up:2", marks.digest_of(LONG), "abc1234")
    text = f"# Page\n\n{head}\n\n| a |\n|---|\n| 1 |\n\n{marks.END}\n\nEnd.\n"
    page.write_text(text, encoding="utf-8", newline="\n")
    monkeypatch.setattr(marks, "pages", lambda: [page])
    monkeypatch.setattr(maker, "ROOT", tmp_path)
    return page


def test_what_is_stale_is_named(page, capsys):
    """A change of a source, of the command, or of a name; comments change nothing."""
    source = page.parent / "src" / "a.py"
    assert maker.check() == 0
    source.write_text("# why\n\nx = 1\n", encoding="utf-8", newline="\n")
    assert maker.check() == 0
    source.write_text("x = 2\n", encoding="utf-8", newline="\n")
    assert maker.check() == 1
    told = capsys.readouterr().out
    assert "page.md:3: made_up:2: its sources have changed since abc1234" in told
    assert "make docs NAMES=made_up " in told
    source.write_text("x = 1\n", encoding="utf-8", newline="\n")
    text = page.read_text(encoding="utf-8")
    for old, new, why in [("somewhere", "elsewhere", "is made by"), ("made_up", "no", "not know")]:
        page.write_text(text.replace(old, new), encoding="utf-8", newline="\n")
        assert maker.check() == 1
        assert why in capsys.readouterr().out
    (page.parent / "src" / "c.csv").write_text("1\n", encoding="utf-8", newline="\n")
    page.write_text(text, encoding="utf-8", newline="\n")
    assert maker.check() == 1


def test_a_table_is_put_where_it_belongs(page):
    (page.parent / "src" / "a.py").write_text("x = 2\n", encoding="utf-8", newline="\n")
    maker.write("made_up", "told\n| no |\n|---|\n| 3 |\nmore\n| a |\n|---|\n| 4 |\n| 5 |\n")
    text = page.read_text(encoding="utf-8")
    assert maker.check() == 0
    assert "| 4 |\n| 5 |\n\n<!-- end -->\n\nEnd.\n" in text and "| 1 |" not in text
    assert "| 3 |" not in text and "abc1234" not in text
    again = text
    maker.write("made_up", "| no |\n\n| a |\n|---|\n| 4 |\n| 5 |\n")
    assert page.read_text(encoding="utf-8") == again


def test_what_a_command_wrote_itself_stays(page, monkeypatch):
    """Where a command writes the page, or numbers are copied, only the opening mark is renewed."""
    monkeypatch.setitem(MADE, "made_up", LONG._replace(way="page"))
    before = page.read_text(encoding="utf-8").splitlines()
    (page.parent / "src" / "a.py").write_text("x = 2\n", encoding="utf-8", newline="\n")
    maker.write("made_up", "")
    after = page.read_text(encoding="utf-8").splitlines()
    assert before[2] != after[2] and maker.check() == 0
    assert before[:2] + before[3:] == after[:2] + after[3:]


def test_what_is_not_marked_is_found(page):
    text = page.read_text(encoding="utf-8")
    more = "\n| b |\n|---|\n| 2 |\n\n| `c3` |\n|---|\n| x |\n\n![p](p.png)\n\n```sh\n| 7 |\n```\n"
    found = marks.unmarked(page, (), text + more)
    assert [re.sub(r"^\S+ ", "", one) for one in found] == ["| b |", "![p](p.png)"]
    assert marks.unmarked(page, ("| b |",), text + more) == found[1:]


@pytest.mark.parametrize(
    "change, fault",
    [
        (lambda text: text.replace(marks.END, ""), "has no end"),
        (lambda text: text + marks.END + "\n", "has not begun"),
        (lambda text: text.replace("; from", ", from"), "cannot be read"),
        (lambda text: text.replace("# Page", text.splitlines()[2]), "has no end before"),
    ],
)
def test_markers_that_do_not_fit(page, change, fault):
    with pytest.raises(ValueError, match=fault):
        marks.marked(page, change(page.read_text(encoding="utf-8")))


def test_what_only_people_read_makes_nothing_stale(tmp_path):
    source = tmp_path / "a.py"
    text = (
        '"""A page."""\n\n# why\ndef f(x):\n    """Twice x.\n\n    x m\n    """\n    return 2 * x'
    )
    source.write_text(text)
    before = marks.digest(("a.py",), tmp_path)
    source.write_text(text.replace("Twice", "Two times").replace("# why", "# why not\n"))
    assert marks.digest(("a.py",), tmp_path) == before
    source.write_text(text.replace("2 * x", '"""Twice x."""'))
    assert marks.digest(("a.py",), tmp_path) != before


@pytest.mark.parametrize(
    ("before", "after", "same"),
    [
        ('raise E("no such thing", x)', 'raise E(\n    f"there is no {x}",\n    x,\n)', True),
        ('raise E(f"of {x} there is none", x)', 'raise E(f"there is no {y}", x)', True),
        ('"""It says."""\nx = 1', '"""Says what it is."""\n\n\n# why\nx = 1  # m', True),
        ('x = "one"', 'x = "two"', False),
        ('x = f"{a}"', 'x = f"{b}"', False),
        ('x = f("a b", 1)', 'x = f("a c", 2)', False),
        ("if a:\n    x = 1\n    y = 2", "if a:\n    x = 1\ny = 2", False),
        ("x = (1, 2)", "x = (1, 2, 3)", False),
        ('class A(B):\n    """Is one."""', 'class A(B):\n    """Is another one."""', True),
    ],
)
def test_sentences_make_no_number(before, after, same, tmp_path):
    """Pages of words are another matter."""
    found = []
    for text in (before, after):
        (tmp_path / "a.py").write_text(text + "\n", encoding="utf-8")
        found.append([marks.digest(("a.py",), tmp_path, words) for words in (True, False)])
    (old, old_numbers), (new, new_numbers) = found
    assert old != new or '"""' in before
    assert (old_numbers == new_numbers) is same
