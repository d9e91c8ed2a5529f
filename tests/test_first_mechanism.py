"""docs/first_mechanism.md: its commands are typed, its files written, and its numbers are right."""

from math import acos, degrees, hypot
from pathlib import Path

import pytest

from benchmarks.gallery import tutorial
from benchmarks.gallery.tutorial import Ended, follow, pictures, steps
from tests import drawn, inside
from trsim.cli import main

DOCS = Path(__file__).parents[1] / "docs"
TEXT = (DOCS / "first_mechanism.md").read_text(encoding="utf-8")


def test_the_page_can_be_followed(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    drawn.blank(monkeypatch)
    inside.sweeps(monkeypatch)

    def typed(words):
        with pytest.raises(SystemExit) as ended:
            main(words)
        told = capsys.readouterr()
        return ended.value.code, told.out + told.err

    done = list(follow(TEXT, typed))
    assert [one for one in done if isinstance(one, str)] == []
    ended = [one for one in done if isinstance(one, Ended)]
    assert [one for one in ended if one.code != one.wanted] == []
    assert [one.line for one in ended if one.wanted == 0 and "warning" in one.said] == []
    assert len(ended) > 12
    for name in pictures(TEXT, "first_mechanism"):
        assert name == "wiper.png" or (tmp_path / "figures" / name).exists(), name
        assert (DOCS / "first_mechanism" / name).stat().st_size < 60_000
    assert (tmp_path / "figures" / "animation.html").exists()


def test_numbers_of_the_wiper():
    """The cosine rule in the triangle A C D, where crank and rod lie on one line."""
    rod, arm, base = hypot(0.3, 0.02), 0.065, 0.3
    far, near = rod + 0.045, rod - 0.045
    at = [degrees(acos((base**2 + arm**2 - x**2) / (2 * base * arm))) for x in (far, near)]
    assert f"{at[0] - at[1]:.2f} degrees" in TEXT
    for length in (rod, far, near):
        assert f"{1e3 * length:.2f} mm" in TEXT


def test_by_hand_is_only_the_installation():
    by_hand = [step for step in steps(TEXT) if "by-hand" in step.marks]
    assert len(by_hand) == 1 and "pip install" in by_hand[0].text


def test_what_was_not_said_is_found(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = "```sh\ntrsim run x\n```\n\n```text\n  one\n  two\n```\n"
    said = list(follow(page, lambda words: (0, "  one\n")))
    assert said == [Ended("trsim run x", 0, 0, "  one\n"), "  two"]
    with pytest.raises(ValueError, match="by hand"):
        list(follow("```sh\nrm x\n```\n", lambda words: (0, "")))
    assert tutorial.pictures("![a](b/c.png) ![d](e.png)", "b") == ["c.png"]
