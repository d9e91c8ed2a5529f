"""A start on a jump of a load counts as just behind it, however the places of bodies are rounded.

A stroke or an angle that is zero as drawn is a difference of places: of a turned drawing it is
some 1e-17 off, on either side, and the load of the first row was that of the wrong side.
"""

import numpy as np
import pytest

from ..runs import run

SLIDE = """
planar: false
frame: {{about: {about}, angle: {angle} deg}}
bodies: {{yoke: {{mass: 4, inertia: [0.05, 0.02, 0.06], at: [0.25, 0.03, 0.02]}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, yoke], axis: [1, 0, 0], at: [0.5, 0, 0]}}}}
sensors: {{s: {{joint: guide}}}}
forces: {{press: {{type: applied_load, body: yoke, direction: [-1, 0, 0], force: {force}}}}}
initial: {{guide.rate: {rate}}}
solver: {{end: 1 ms}}
output: {{every: 1 ms}}
"""
TURNED = [("[1, 0, 0.3]", 40), ("[0.2, 1, 0.3]", 77), ("[1, 1, 1]", -13), ("[0, 0, 1]", 0)]


def first_load(text):
    return run(text)["press.load"][0]


@pytest.mark.parametrize("rate, wanted", [(0.5, 60.0), (-0.5, -30.0)])
def test_the_first_load_is_that_behind_the_jump(rate, wanted):
    """floor(s / 20 mm) and s < 0 change at s = 0, in three turned drawings and in a plain one."""
    force = '"60*(s.rate > 0) + 30*floor(s/0.02)*(s < 0)"'
    for about, angle in TURNED:
        r = run(SLIDE.format(about=about, angle=angle, force=force, rate=rate))
        assert abs(r["s"][0]) < 1e-15
        way = r["yoke.velocity"][0] / np.linalg.norm(r["yoke.velocity"][0]) * np.sign(rate)
        assert r["press.load"][0] @ -way == pytest.approx(wanted, rel=1e-12)


HINGED = """
planar: false
frame: {{about: {about}, angle: {angle} deg}}
bodies: {{arm: {{mass: 4, inertia: [0.05, 0.02, 0.06], at: [0.25, 0.03, 0.02], angle: 0.3}}}}
joints: {{pin: {{type: revolute, bodies: [ground, arm], axis: [0.1, 0.2, 1], at: [0.5, 0, 0]}}}}
sensors: {{a: {{joint: pin}}}}
forces: {{press: {{type: applied_load, body: arm, direction: [0, 0, 1],
         torque: "2*(a < 0) + 7*(a >= 0)"}}}}
initial: {{pin.rate: {rate}}}
solver: {{end: 1 ms}}
output: {{every: 1 ms}}
"""


@pytest.mark.parametrize("rate, wanted", [(0.5, 7.0), (-0.5, 2.0)])
def test_the_same_of_an_angle(rate, wanted):
    for about, angle in TURNED:
        r = run(HINGED.format(about=about, angle=angle, rate=rate))
        assert abs(r["a"][0]) < 1e-15
        assert np.linalg.norm(r["press.load"][0]) == pytest.approx(wanted, rel=1e-12)


def test_what_rests_beside_a_jump_stays_on_its_side():
    """Without a rate nothing leads across: the load is what is written, and the run is smooth."""
    for about, angle in TURNED:
        r = run(SLIDE.format(about=about, angle=angle, force='"(s > 1e-9) + 0*s"', rate=0))
        assert not r["press.load"].any()
        assert r.outcome.statistics["steps"] < 20
