"""Every block of code of README and docs does what it says, or is marked as what is only shown.

benchmarks/gallery/tutorial.py says what the marks of a block mean.
"""

import re
import shutil

import pytest

from benchmarks.docs.marks import ROOT, pages
from benchmarks.gallery.tutorial import SCENES, Ended, follow
from tests import drawn, inside
from trsim.cli import main

PAGES = {page.name: page for page in pages()}
FENCE = re.compile(r"^ *```(.*)$", re.MULTILINE)
# pages whose blocks have tests of their own
OWN = {
    "extending.md": "tests/test_extending.py",
    "first_mechanism.md": "tests/test_first_mechanism.py",
    "gallery.md": "tests/test_gallery.py",
    "python.md": "tests/api/test_python_page.py",
}
KINDS = {
    "sh": {"", "by-hand", "fails", "end", "says"},
    "yaml": {"file", "fragment", "before", "scene", "extends", "run", "end", "cases", "shown"},
    "csv": {"file"},
    "text": {"", "shown"},
    "json": {"shown"},
    "python": {""},
}
# what was there before a page is read: commands
BEFORE = {
    "commands.md": ("run slider_crank.yaml",),
    "studies.md": (
        "run slider_crank.yaml -o a.h5",
        "run slider_crank.yaml --set solver.tolerance=1e-6 -o b.h5",
        "sweep tight.yaml -o runs/study",
    ),
}  # fmt: skip


def blocks(text: str) -> list[str]:
    """What stands behind the fences that begin blocks."""
    return FENCE.findall(text)[::2]


def typer(capsys):
    """What types the words of a command line, and gives its exit code and what it said."""

    def typed(words: list[str]) -> tuple[int, str]:
        with pytest.raises(SystemExit) as ended:
            main(words)
        told = capsys.readouterr()
        return int(ended.value.code or 0), told.out + told.err

    return typed


@pytest.mark.parametrize("name", sorted({*PAGES} - {*OWN}))
def test_every_block_has_a_kind(name):
    for head in blocks(PAGES[name].read_text(encoding="utf-8")):
        kind, *marks = head.split() or [""]
        assert kind in KINDS, f"{name}: ```{head}"
        words = {mark.partition("=")[0] for mark in marks} or {""}
        assert words <= KINDS[kind], f"{name}: ```{head}"


@pytest.mark.parametrize("name", sorted({*PAGES} - {*OWN}))
def test_a_page_can_be_followed(name, tmp_path, monkeypatch, capsys):
    text = PAGES[name].read_text(encoding="utf-8")
    if not any("shown" not in head for head in blocks(text)):
        return
    shutil.copytree(SCENES, tmp_path, dirs_exist_ok=True)
    (tmp_path / "scenarios").symlink_to(ROOT / "scenarios")
    monkeypatch.chdir(tmp_path)
    drawn.few(monkeypatch)
    drawn.blank(monkeypatch)
    inside.sweeps(monkeypatch)
    # a bench measures each setting from one first step, in place of three
    monkeypatch.setattr("trsim.analyse.precision.FIRST_STEPS", (1.0,))
    typed = typer(capsys)
    for line in BEFORE.get(name, ()):
        assert typed(line.split())[0] == 0, line
    done = list(follow(text, typed))
    assert [one for one in done if isinstance(one, str)] == [], "what was not said"
    wrong = [one for one in done if isinstance(one, Ended) and one.code != one.wanted]
    assert wrong == [], "\n\n".join(f"{one.line}\n{one.code}: {one.said}" for one in wrong)


def test_every_scene_is_used():
    texts = [path.read_text(encoding="utf-8") for path in (*PAGES.values(), *SCENES.iterdir())]
    every = "".join([*texts, str(BEFORE)])
    assert [scene.name for scene in SCENES.iterdir() if scene.name not in every] == []


@pytest.mark.parametrize("name", OWN)
def test_pages_with_tests_of_their_own(name):
    assert (PAGES[name].parents[1] / OWN[name]).exists()
