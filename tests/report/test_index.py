"""index.html of a report: everything in one file, nothing from elsewhere."""

import base64
import re
from html.parser import HTMLParser
from itertools import islice

import h5py
import pytest

from tests import small
from tests.report.test_components import SPRUNG
from trsim.report import figures, report
from trsim.report.looks import Looks
from trsim.store.read import read


class Seen(HTMLParser):
    """What a page shows: pictures, headings, cells; and what it would fetch."""

    def __init__(self, text):
        super().__init__()
        self.images, self.anchors, self.links, self.texts, self.kinds = [], [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        of = dict(attrs)
        self.anchors += [of["id"]] if "id" in of else []
        self.links += [of["href"]] if tag == "a" else []
        self.images += [of["src"]] if tag == "img" else []
        self.kinds.append((tag, of.get("class") or ""))
        if tag in ("link", "iframe", "object") or (tag == "script" and "src" in of):
            raise AssertionError(f"the page would fetch {of}")

    def handle_data(self, data):
        self.texts.append(data)


@pytest.fixture
def without_pictures(monkeypatch):
    """Figures are drawn for nothing where a page is read for its texts."""
    monkeypatch.setattr("trsim.report.figures.draw", lambda *_: [])


@pytest.fixture
def few_pictures(monkeypatch):
    """The first figures are enough; test_figures compares all of them."""
    every = figures.everything
    monkeypatch.setattr(figures, "everything", lambda runs: islice(every(runs), 2))


def page(folder):
    text = (folder / "index.html").read_text(encoding="utf-8")
    return text, Seen(text)


def test_everything_of_a_run(tmp_path):
    small.copy(tmp_path / "x.h5", text=SPRUNG)
    written = report(tmp_path / "x.h5", tmp_path / "r")
    assert written[-1].name == "index.html"
    text, seen = page(tmp_path / "r")
    pictures = {path.read_bytes() for path in written
                if path.suffix == ".png" and path.stem != "peaks"}  # fmt: skip
    inside = {base64.b64decode(src.partition("base64,")[2]) for src in seen.images}
    assert inside == pictures and len(seen.images) == len(pictures) >= 5
    assert all(src.startswith("data:image/png;base64,") for src in seen.images)
    assert ("section", "animation") in seen.kinds
    run = read(tmp_path / "x.h5")
    assert f"{run.rows}" in seen.texts and "x.h5" in seen.texts
    assert str(run.group("solver")["steps"]) in seen.texts
    # F = k z of the strut is largest at 40 mm: 200 N/m * 0.04 m
    place = seen.texts.index("strut")
    assert any(re.fullmatch("\u2212?8 N", one) for one in seen.texts[place : place + 9])
    assert {link[1:] for link in seen.links} <= set(seen.anchors)
    assert not re.search(r"(src|href)=\"(http|//|[a-z_]+\.png)", text)


def test_the_same_to_the_byte_wherever_it_is_made(tmp_path, few_pictures):
    small.copy(tmp_path / "x.h5", *small.FEW)
    report(tmp_path / "x.h5", tmp_path / "a")
    report(tmp_path / "x.h5", tmp_path / "b/c")
    assert page(tmp_path / "a")[0] == page(tmp_path / "b/c")[0]


@pytest.mark.parametrize("form, kind", [("pdf", "png"), ("svg", "svg+xml")])
def test_other_kinds_of_figures_are_in_it_too(form, kind, tmp_path):
    text = SPRUNG.replace("every: 5 ms", "every: 5 ms, channels: [strut.force, block.position]")
    small.copy(tmp_path / "x.h5", text=text)
    written = report(tmp_path / "x.h5", tmp_path / "r", Looks(form=form))
    seen = page(tmp_path / "r")[1]
    assert len(seen.images) == len([path for path in written if path.suffix == f".{form}"]) - 1 > 1
    assert all(src.startswith(f"data:image/{kind};base64,") for src in seen.images)
    begin = {"png": b"\x89PNG", "svg+xml": b"<?xml"}[kind]
    for src in seen.images:
        assert base64.b64decode(src.partition("base64,")[2]).startswith(begin)


def test_several_runs(paths, tmp_path, few_pictures):
    report(paths, tmp_path)
    seen = page(tmp_path)[1]
    assert [kind for _, kind in seen.kinds].count("animation") == 2
    assert {"clearance at B 0.5mm", "clearance at B 0.1mm"} <= set(seen.texts)
    assert len(set(seen.anchors)) == len(seen.anchors)


def test_a_run_that_cannot_be_animated(tmp_path, without_pictures):
    """Without places of bodies, or with a scenario that is not understood any more."""
    text = SPRUNG.replace("every: 5 ms", "every: 5 ms, channels: [height, strut.force]")
    small.copy(tmp_path / "x.h5", text=text)
    report(tmp_path / "x.h5", tmp_path / "a")
    assert any("No animation: " in one for one in page(tmp_path / "a")[1].texts)
    small.copy(tmp_path / "y.h5", text=SPRUNG)
    with h5py.File(tmp_path / "y.h5", "r+") as file:
        del file["scenario/resolved"]
        file["scenario/resolved"] = '{"bodies": {"block": {"weight": 1}}}'
    report(tmp_path / "y.h5", tmp_path / "b")
    assert any("No animation: " in one for one in page(tmp_path / "b")[1].texts)


def test_names_are_text(tmp_path, without_pictures):
    """What is in a title is no markup."""
    text = SPRUNG.replace("Mass on springs", "'<script>alert(1)</script> & co'")
    small.copy(tmp_path / "x.h5", text=text)
    report(tmp_path / "x.h5", tmp_path)
    assert "<script>alert" not in page(tmp_path)[0]


def test_a_sweep(tmp_path, monkeypatch):
    from trsim.cli import main

    def command(*words):
        with pytest.raises(SystemExit) as ended:
            main([*words, "-q"])
        assert ended.value.code == 0

    monkeypatch.chdir(tmp_path)
    (tmp_path / "crank.yaml").write_text(small.SLIDER_CRANK)
    values = "joints.B.clearance=[0.1mm, 0.5mm]"
    command("sweep", "crank.yaml", "--set", values, "-o", "swept", "-j", "1")
    command("report", "swept")
    seen = page(tmp_path / "swept/figures")[1]
    pictures = [*(tmp_path / "swept/figures").glob("*.png")]
    assert len(seen.images) == len(pictures) >= 2
    for case in (tmp_path / "swept/cases").glob("*.h5"):
        found = [p.value for p in read(case).peaks if p.channel == "B.contact_force"]
        assert f"{max(found):.0f}" in seen.texts
    (tmp_path / "swept/figures/index.html").unlink()
    command("report", "swept", "--table", "summary:time")
    assert not (
        tmp_path / "swept/figures/index.html"
    ).exists()  # of what was asked for there is none
