"""Distance sensor: its value, rate and acceleration in closed form, also through zero; events."""

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, USER

from ..runs import built, run
from .bench import bench

SENSED = """
sensors:
  x: {type: distance, bodies: [left, right], points: [[0.3, 0.1, -0.2], [0.7, 0.3, 0.4]]}
"""


def test_value_and_rate():
    b, h = bench(SENSED, np.random.default_rng(2)), 1e-6
    [(_, rate)] = b.scene().S
    [(ahead, _)], [(behind, _)] = b.later(h).scene().S, b.later(-h).scene().S
    assert rate == pytest.approx((ahead - behind) / (2 * h), rel=1e-8)


PASSING = """
planar: PLANAR
bodies: {block: {mass: 2, inertia: [1, 1, 1], at: [5, 0, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, block], at: [5, 0, 0], axis: [1, 0, 0]}}
drives: {push: {joint: rail, position: "2*t + 3*t**2"}}
sensors: {s: {type: distance, bodies: BODIES, points: POINTS}}
solver: {end: 1, method: METHOD}
output: {every: 0.05}
"""
METHODS = ("dop853", "radau", "generalized_alpha, step: 0.01", "rk4, step: 0.01", "scipy:RK45")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("swapped", [False, True])
def test_of_a_block_that_passes_a_post(method, planar, swapped):
    """A post beside the way, out of the plane of the drawing too."""
    pair, points = ["ground", "block"], [[7, 0.3, 0.4], [5, 0, 0]]
    if swapped:
        pair, points = pair[::-1], points[::-1]
    text = PASSING.replace("PLANAR", planar).replace("METHOD", method)
    r = run(text.replace("BODIES", str(pair)).replace("POINTS", str(points)))
    x, v, a = 2 * r.t + 3 * r.t**2 - 2, 2 + 6 * r.t, 6.0
    s = np.hypot(x, 0.5)
    assert r["s"] == pytest.approx(s, abs=1e-9)
    assert r["s.rate"] == pytest.approx(x * v / s, abs=1e-8)
    assert r["s.acceleration"] == pytest.approx((v * v + x * a - (x * v / s) ** 2) / s, abs=1e-6)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_that_goes_through_zero(planar):
    """It starts at zero: what it shows there is what comes just after."""
    text = PASSING.replace("PLANAR", planar).replace("METHOD", "auto")
    r = run(text.replace("BODIES", "[ground, block]").replace("POINTS", "[[5, 0, 0], [5, 0, 0]]"))
    assert r["s"] == pytest.approx(2 * r.t + 3 * r.t**2, abs=1e-12)
    assert r["s.rate"] == pytest.approx(2 + 6 * r.t, abs=1e-9)
    assert r["s.acceleration"] == pytest.approx(np.full(r.t.size, 6.0), abs=1e-6)


@pytest.mark.parametrize("method", ["auto", "radau", "rk4, step: 0.25"])
def test_events_on_both_sides_of_the_nearest_place(method):
    """0.5 m + 1 mm from the post twice, within one step."""
    text = PASSING.replace("PLANAR", "false").replace("METHOD", method).replace(
        "2*t + 3*t**2", "4*t")  # fmt: skip
    text = text.replace("BODIES", "[ground, block]").replace("POINTS", "[[7, 0.3, 0.4], [5, 0, 0]]")
    for crosses, number in (("down", 1), ("up", 1), ("both", 2)):
        more = f"events: {{near: {{when: s, value: 501 mm, crosses: {crosses}, "
        r = run(text + more + "do: {record: true}}}\n")
        times = r.events[r.events[:, EVENT_KIND] == USER][:, EVENT_TIME]
        aside = np.sqrt(0.501**2 - 0.25) / 4
        both = np.array([0.5 - aside, 0.5 + aside])
        want = {"down": both[:1], "up": both[1:], "both": both}[crosses]
        assert len(times) == number and times == pytest.approx(want, abs=1e-9)
        assert r.outcome.statistics["unproved_searches"] == 0


def test_a_magnet_that_pulls_with_a_corner():
    """A load of a distance with a corner: work is what the block gains."""
    text = """
bodies: {ball: {mass: 2, inertia: [1, 1, 1], at: [-1, 0.1, 0.2], velocity: [3, 0, 0]}}
sensors: {s: {type: distance, bodies: [ground, ball], points: [[0, 0, 0], [-1, 0.1, 0.2]]}}
forces:
  pull: {type: applied_load, body: ball, direction: [1, 0, 0], force: "100*max(0, 0.3 - s)"}
solver: {end: 0.7, tolerance: 1e-10}
output: {every: 0.01}
"""
    r = run(text)
    expected = 100 * np.maximum(0, 0.3 - np.linalg.norm(r["ball.position"], axis=1))
    assert r["pull.magnitude"] == pytest.approx(expected, abs=1e-11)
    assert r["pull.magnitude"].max() > 5
    assert r.outcome.statistics["energy_residual_relative"] < 1e-8
    assert r.outcome.statistics["unproved_searches"] == 0


def test_changes_no_step():
    """A sensor that is only looked at, a million metres off."""
    text = PASSING.replace("PLANAR", "false").replace("METHOD", "auto")
    text = text.replace("BODIES", "[ground, block]").replace("POINTS", "[[1e6, 0, 0], [5, 0, 0]]")
    bare = "\n".join(line for line in text.splitlines() if "sensors" not in line)
    one, two = run(text), run(bare)
    assert np.array_equal(one["block.position"], two["block.position"])
    assert one.outcome.statistics["steps"] == two.outcome.statistics["steps"]


def test_refused():
    text = PASSING.replace("PLANAR", "false").replace("METHOD", "auto")
    with pytest.raises(TrsimError, match="itself"):
        built(text.replace("BODIES", "[block, block]").replace("POINTS", "[[0, 0], [1, 0]]"))


@pytest.mark.parametrize("seed", range(12))
def test_points_drawn_at_one_place_meet(seed):
    """However the body is turned, and far from the origin, where rounding keeps them apart."""
    rng = np.random.default_rng(seed)
    p = rng.normal(size=3) * rng.choice([1, 30, 1000])
    c, v, w = p + rng.normal(size=3), rng.normal(size=3), 3 * rng.normal(size=3)
    r = run(f"""
planar: false
bodies: {{top: {{mass: 3, inertia: [0.05, 0.05, 0.05], at: {c.tolist()},
               angle: {rng.uniform(-3, 3)}, velocity: {v.tolist()},
               angular_velocity: {w.tolist()}}}}}
sensors: {{d: {{type: distance, bodies: [ground, top], points: [{p.tolist()}, {p.tolist()}]}}}}
solver: {{end: 0.02}}
output: {{every: 0.01, channels: ["*"]}}
""")
    of_point, again = v + np.cross(w, p - c), np.cross(w, np.cross(w, p - c))
    speed = np.linalg.norm(of_point)
    assert r["d.rate"][0] == pytest.approx(speed, rel=1e-9)
    assert r["d.acceleration"][0] == pytest.approx(of_point @ again / speed, rel=1e-9)
    assert np.abs(r["d.acceleration"]).max() < 1e3
