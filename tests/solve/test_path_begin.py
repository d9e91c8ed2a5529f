"""Where a static path begins, and what is told of it."""

import pytest

from ..runs import run

# a bar on a hinge that hangs down
BAR = """
bodies: {bar: {mass: 2, inertia: 0.1, at: [0, -0.5]}}
joints: {hinge: {type: revolute, bodies: [ground, bar], at: [0, 0]}}
gravity: [0, -9.81]
sensors: {angle: {joint: hinge}}
initial: {hinge: PLACE}
solver: {end: 1, method: static_path}
"""
SLIDE = """
bodies: {block: {mass: 2, inertia: 0.1, at: [0, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, block], axis: [1, 0]}}
forces: {spring: {type: joint_spring, joint: guide, elastic: 100*stretch}}
initial: {guide: PLACE}
solver: {end: 1, method: static_path}
"""


@pytest.mark.parametrize(
    ("text", "place", "told"),
    [(BAR, 0.2, False), (BAR, -1.0, True), (BAR, 6.2, False), (SLIDE, 0.001, False),
     (SLIDE, 2.0, True)],
)  # fmt: skip
def test_a_balance_far_from_where_the_joint_was_put_is_told(text, place, told):
    r = run(text.replace("PLACE", str(place)), "output.every=0.5")
    name = "bar.position" if text is BAR else "block.position"
    assert r[name][-1][0] == pytest.approx(0.0, abs=1e-9)
    found = [w for w in r.outcome.said if "under `initial`" in w]
    assert bool(found) == told
    if told:
        assert f"is {abs(place):.3g} " in found[0]
