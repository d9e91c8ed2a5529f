"""Wrench: six functions at a point, in the axes of the world, of a body and of a named point."""

import math

import numpy as np
import pytest

from trsim.errors import ScenarioError

from ..runs import built, run
from .bench import bench, check_power, drawn, matrix, product

PLACED = """
joints: {{hinge: {{type: revolute, bodies: [left, right], at: [0.2, 0.1, 0], axis: [1, 2, 2]}}}}
sensors: {{turn: {{joint: hinge, at_start: 0.3}}}}
points:
  seat: {{body: left, at: [0.3, -0.1, 0.2], x_axis: [1, 2, 0], y_axis: [-2, 1, 1]}}
forces:
  load: {{type: wrench, body: right, {}}}
"""
SIX = 'force: ["3*t", "2*turn", "-turn.rate"], moment: ["turn**2", 5, "sin(t)"]'


def six(b):
    """The six numbers of SIX at the state of a bench."""
    x, v = b.scene().S[b.scene().rated[0, 1]]
    return np.array([3 * b.t, 2 * x, -v]), np.array([x * x, 5, math.sin(b.t)])


def since_drawn(b, name, frame):
    return matrix(product(b.p[frame], drawn(b, name)[1] * [1, -1, -1, -1]))


def at_point(b, place):
    """Arm of a point of the right body, drawn at a place, from its centre of mass now."""
    return since_drawn(b, "right", 2) @ (np.array(place) - drawn(b, "right")[0])


@pytest.mark.parametrize("frame", ["world", "left", "right", "seat"])
def test_components_are_along_the_axes_of_its_frame(frame):
    b = bench(PLACED.format(f"at: [0.7, 0.3, 0.2], frame: {frame}, {SIX}"),
              np.random.default_rng(1))  # fmt: skip
    f, m = six(b)
    x, y = np.array([1, 2, 0]) / math.sqrt(5), np.array([-2, 1, 1])
    y = y - (y @ x) * x
    y /= np.linalg.norm(y)
    axes = {
        "world": np.eye(3),
        "left": matrix(b.p[1]),
        "right": matrix(b.p[2]),
        "seat": since_drawn(b, "left", 1) @ np.array([x, y, np.cross(x, y)]).T,
    }[frame]
    F = b.wrenches()
    arm = at_point(b, [0.7, 0.3, 0.2])
    np.testing.assert_allclose(F[2, :3], axes @ f, rtol=1e-12)
    np.testing.assert_allclose(F[2, 3:], axes @ m + np.cross(arm, axes @ f), rtol=1e-12)
    assert not F[:2].any()
    check_power(b)
    assert b.book[1] == pytest.approx(b.book.sum())  # loads, nothing else


def test_the_same_wrench_about_another_line():
    """M_q = M + (p - q) x F: every body feels the same."""
    p, q = np.array([0.7, 0.3, 0.2]), np.array([-0.4, 1.1, 0.5])
    f, m = np.array([3.0, -4.0, 5.0]), np.array([0.5, 2.0, -1.0])
    moved = m + np.cross(p - q, f)
    b, other = (
        bench(PLACED.format(f"at: {list(map(float, at))}, frame: world, "
                            f"force: {f.tolist()}, moment: {list(map(float, moment))}"),
              np.random.default_rng(2))
        for at, moment in ((p, m), (q, moved))
    )  # fmt: skip
    for x in (b, other):  # as drawn, where both are given
        x.r[1:], x.p[1:] = zip(drawn(x, "left"), drawn(x, "right"), strict=True)
    np.testing.assert_allclose(b.wrenches(), other.wrenches(), atol=1e-12, rtol=0)
    assert b.book[1] == pytest.approx(other.book[1], rel=1e-12)


TURNED = """
planar: false
bodies: {arm: {mass: 2, inertia: [0.1, 0.2, 0.3], at: [0.5, 0, 0]}}
points: {tip: {body: arm, at: [1, 0, 0], x_axis: [0, 1], y_axis: [-1, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0]}}
drives: {motor: {joint: hinge, position: "1.5707963267948966*smoothstep(t)"}}
forces:
  follows: {type: wrench, body: arm, frame: tip, force: [7, 0, 3], moment: [0, 2, 0]}
  stays: {type: wrench, body: arm, at: [1, 0, 0], force: [7, 0, 3], moment: [0, 2, 0]}
solver: {end: 1 s}
output: {every: 1 s}
"""


def test_a_follower_turns_by_ninety_degrees_with_its_body():
    r = run(TURNED)
    np.testing.assert_allclose(r["follows.force"], [[0, 7, 3], [-7, 0, 3]], atol=1e-9)
    np.testing.assert_allclose(r["follows.moment"], [[-2, 0, 0], [0, -2, 0]], atol=1e-9)
    np.testing.assert_allclose(r["stays.force"], [[7, 0, 3], [7, 0, 3]], atol=1e-12)
    # at the point that frame names: 7 N m about the hinge all the way; the other pushes inwards
    assert r["energy.work.loads"][-1] == pytest.approx(7 * math.pi / 2 - 7, rel=1e-8)


def test_six_tables_against_an_angle():
    """A door opened by a drive: the work of six tables is the integral of those that do some."""
    tables = ", ".join(
        f"{{table: [[0, {a}], [0.4, {2 * a}], [0.8, {-a}], [1.6, {a}]], of: opening}}"
        for a in range(1, 7)
    ).split("}, ")
    six = [part if part.endswith("}") else part + "}" for part in tables]
    text = (
        TURNED.split("forces:")[0]
        + f"""
sensors: {{opening: {{joint: hinge}}}}
forces:
  air: {{type: wrench, body: arm, at: [0.6, 0, 0.3], frame: arm, force: [{", ".join(six[:3])}],
        moment: [{", ".join(six[3:])}]}}
solver: {{end: 1 s, tolerance: 1e-9}}
output: {{every: 0.125 s}}
"""
    )
    r = run(text)
    from scipy.interpolate import Akima1DInterpolator

    x = [0, 0.4, 0.8, 1.6]
    one = Akima1DInterpolator(x, [1, 2, -1, 1])
    integral = one.antiderivative()
    # f_y at 0.6 m and m_z about the axis
    work = (0.6 * 2 + 6) * np.array([integral(a) - integral(0) for a in r["opening"]])
    np.testing.assert_allclose(r["energy.work.loads"], work, atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(r["air.moment"], axis=1),
                               np.abs(one(r["opening"])) * math.sqrt(77), rtol=1e-9)  # fmt: skip


FLAT = """
bodies: {{plate: {{mass: 2, inertia: 0.1}}}}
forces: {{load: {{type: wrench, body: plate, {}}}}}
solver: {{end: 2 s}}
"""


def test_it_stays_in_the_plane_where_its_components_do():
    for keys, planar in (
        ("force: [1, 2]", True), ("force: [1, 2, 0], moment: [0, 0, 3]", True),
        ("force: [0, 0, t]", False), ("moment: [t, 0, 0]", False),
    ):  # fmt: skip
        text = FLAT.replace("inertia: 0.1", "inertia: [0.1, 0.1, 0.1]").format(keys)
        assert built(text).planar == planar
    r = run(FLAT.format("force: [4, 0], moment: [0, 0, 3]"))
    np.testing.assert_allclose(r["plate.position"][-1, 0], 4.0, rtol=1e-9)


def test_in_an_instance_the_world_is_that_of_its_frame():
    text = """
templates:
  part:
    frame: {at: [1, 0, 0], x_axis: [0, 1, 0], y_axis: [-1, 0, 0]}
    points: {hook: {body: block, at: [0.1, 0], x_axis: [1, 1], y_axis: [-1, 1]}}
    bodies: {block: {mass: 2, inertia: 0.1}}
    forces:
      plain: {type: wrench, body: block, force: [6, 0]}
      body: {type: wrench, body: block, frame: block, force: [5, 0]}
      named: {type: wrench, body: block, frame: hook, force: [1, 0]}
instances: {one: {template: part}}
solver: {end: 1 ms}
"""
    r = run(text)
    np.testing.assert_allclose(r["one_plain.force"][0], [0, 6, 0], atol=1e-12)
    np.testing.assert_allclose(r["one_body.force"][0], [0, 5, 0], atol=1e-12)
    h = math.sqrt(0.5)
    np.testing.assert_allclose(r["one_named.force"][0], [-h, h, 0], atol=1e-12)


@pytest.mark.parametrize(
    "keys, what",
    [
        ("", "all six components are zero"),
        ("force: [0, 0, 0]", "all six components are zero"),
        ("force: [1, 2], frame: nowhere", "no body named 'nowhere'"),
        ("force: [1]", "force"),
        ("force: [1, 2, x]", "no parameter or sensor named 'x'"),
        ("force: [1 N*m, 0]", "wrong unit"),
        ("moment: [1, 2, {table: [[0, 1], [1, 2]], of: angle}]", "no parameter or sensor"),
    ],
)
def test_what_is_refused(keys, what):
    with pytest.raises(ScenarioError, match=what):
        built(FLAT.format(keys).replace("{type: wrench, body: plate, }",
                                        "{type: wrench, body: plate}"))  # fmt: skip
