"""docs/gallery.md: the files as they are, and pictures of them that can be made again."""

import re

import numpy as np
import pytest
from PIL import Image

from benchmarks.gallery import __main__ as maker
from benchmarks.gallery.page import PAGE, PICTURES, marker, page
from trsim.scenario.shipped import TEMPLATES, template

SMALL = 60_000  # bytes


def test_the_page_shows_the_files():
    text = PAGE.read_text(encoding="utf-8")
    assert text == page(marker()), "make it again: python -m benchmarks.gallery"
    shown = dict(re.findall(r"```yaml file=(\S+)\n(.*?)```", text, re.DOTALL))
    assert len(shown) == len(TEMPLATES)
    for name in TEMPLATES:
        one = template(name)
        assert shown[one.first].rstrip() == one.text.rstrip()
        assert f"](gallery/{name}.png)" in text


def test_pictures():
    assert {path.stem for path in PICTURES.iterdir()} == {*TEMPLATES}
    assert {*maker.SCENES} | {"sweep"} == {*TEMPLATES}
    for name in TEMPLATES:
        path = PICTURES / f"{name}.png"
        assert path.stat().st_size < SMALL
        assert Image.open(path).size[0] > 800


def test_a_picture_is_made_again(tmp_path, monkeypatch):
    """The rod is where the pendulum is: to the right at first, and pale to the left later."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(maker, "PICTURES", tmp_path)
    maker.make("pendulum")
    seen = np.asarray(Image.open(tmp_path / "pendulum.png").convert("RGB")).astype(float) / 255
    blue = seen[:, :410, 2] - seen[:, :410, 0]  # of the drawing
    dark = np.argwhere(blue > 0.4)
    middle = 0.5 * 420
    assert len(dark) > 500 and (dark[:, 1] > middle - 10).all()
    pale = np.argwhere((blue > 0.08) & (blue < 0.25))
    assert (pale[:, 1] < middle).sum() > 500
    assert np.ptp(dark[:, 0]) / np.ptp(dark[:, 1]) == pytest.approx(
        np.cos(np.pi / 3) / np.sin(np.pi / 3), rel=0.1
    )
