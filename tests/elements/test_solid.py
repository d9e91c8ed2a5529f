"""Solids: shapes of bodies as written, and the motion that follows from them."""

from math import pi, sqrt

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.scenario.load import loads

from ..runs import run

FREE = "planar: false\nsolver: {end: 1 s}\n"


def body(text, **more):
    """A body written as one line."""
    return loads(f"{FREE}bodies:\n  part: {{{text}}}\n", **more).bodies["part"]


def refused(text):
    with pytest.raises(TrsimError) as error:
        body(text)
    return error.value.show() if hasattr(error.value, "show") else str(error.value)


def test_plate_of_a_density():
    plate = body("density: 2700 kg/m^3, shape: [{box: [0.8, 0.6, 5 mm], at: [0.4, 0.3, 0]}]")
    m = 2700 * 0.8 * 0.6 * 0.005
    assert plate.mass == pytest.approx(m, rel=1e-14)
    assert plate.at == pytest.approx((0.4, 0.3, 0.0))
    wanted = [
        m / 12 * (0.6**2 + 0.005**2),
        m / 12 * (0.8**2 + 0.005**2),
        m / 12 * (0.8**2 + 0.6**2),
    ]
    assert plate.inertia[:3] == pytest.approx(wanted, rel=1e-13)
    assert plate.inertia[3:] == (0.0, 0.0, 0.0)
    assert plate.origin == "of 1 solid"


def test_solids_with_densities_and_masses_of_their_own():
    made = body(
        "density: 1000, shape: [{sphere: 0.2, at: [1, 0]}, {sphere: 0.2, at: [0, 0], density: 500},"
        " {box: [0.1, 0.1, 0.1], mass: 2 kg, at: [0, 1]}]"
    )
    ball = 1000 * pi / 6 * 0.008
    assert made.mass == pytest.approx(1.5 * ball + 2.0)
    assert made.at == pytest.approx((ball / made.mass, 2.0 / made.mass, 0.0))


def test_a_mass_scales_the_solids_and_needs_no_density():
    for density in ("", "density: 1000, "):
        made = body(f"{density}mass: 6 kg, shape: [{{cylinder: 0.2, length: 0.5}}]")
        assert made.mass == 6.0
        assert made.inertia[2] == pytest.approx(0.5 * 6.0 * 0.01, rel=1e-14)
        assert made.origin == "of 1 solid scaled to its mass"


def test_what_is_given_beside_a_shape_holds():
    made = body(
        "density: 1000, inertia: [1, 1, 1], at: [3, 0, 0], shape: [{box: [1, 1, 1], at: [2, 0]}]"
    )
    assert (made.at, made.inertia, made.mass) == ((3.0, 0.0, 0.0), (1.0, 1.0, 1.0), 1000.0)
    assert made.origin == "of 1 solid; centre and inertia given"


def test_axis_of_a_cylinder_and_axes_of_a_box():
    tilted = body("density: 1000, shape: [{cylinder: 0.1, length: 2, axis: [1, 1, 0]}]")
    m = 1000 * pi / 4 * 0.01 * 2
    along, across = m * 0.0025 / 2, m * (3 * 0.0025 + 4) / 12
    tensor = np.reshape(tilted.tensor[0], (3, 3))
    n = np.array((1, 1, 0)) / sqrt(2)
    np.testing.assert_allclose(tensor, across * np.eye(3) + (along - across) * np.outer(n, n),
                               atol=1e-12)  # fmt: skip
    turned = body("density: 1, shape: [{box: [1, 2, 3], x_axis: [0, 1, 0]}]")
    straight = body("density: 1, shape: [{box: [2, 1, 3]}]")
    assert turned.inertia == pytest.approx(straight.inertia, rel=1e-14)


def test_inertia_is_along_the_axes_of_the_body():
    turned = body(
        "angle: 30 deg, density: 1, shape: [{box: [3, 1, 1], x_axis: [3**0.5/2, 0.5, 0]}]"
    )
    straight = body("density: 1, shape: [{box: [3, 1, 1]}]")
    assert turned.inertia == pytest.approx(straight.inertia, abs=1e-14)


def test_a_template_carries_shapes_with_it():
    text = f"""{FREE}templates:
  half:
    bodies: {{part: {{density: 1000, shape: [{{box: [1, 2, 3], at: [1, 0, 0]}},
                                             {{cylinder: 0.4, length: 1, at: [0, 3, 0]}}]}}}}
instances:
  here: {{template: half}}
  there: {{template: half, frame: {{at: [10, 0, 0], x_axis: [0, 1, 0], y_axis: [0, 0, 1]}}}}
"""
    bodies = loads(text).bodies
    here, there = bodies["here_part"], bodies["there_part"]
    assert there.mass == here.mass
    assert there.inertia == pytest.approx(here.inertia, rel=1e-12)  # along its own axes
    x, y, z = here.at
    assert there.at == pytest.approx((10 + z, x, y))


def test_period_of_a_pendulum_from_its_shape():
    """A rod with a disc: T^2 = (2 pi)^2 I/(m g d) of small swings."""
    text = """
bodies:
  pendulum:
    density: 7850 kg/m^3
    shape:
      - {cylinder: 10 mm, length: 0.8, at: [0, -0.4], axis: [0, 1, 0]}
      - {cylinder: 120 mm, length: 20 mm, at: [0, -0.8]}
joints:
  pivot: {type: revolute, bodies: [ground, pendulum], at: [0, 0]}
gravity: [0, -9.81]
initial: {pivot: 0.1 mrad}
solver: {end: 4 s, tolerance: 1e-10}
"""
    rod, disc = 7850 * pi / 4 * 1e-4 * 0.8, 7850 * pi / 4 * 0.0144 * 0.02
    about = rod * (0.8**2 / 12 + 0.005**2 / 4 + 0.4**2) + disc * (0.06**2 / 2 + 0.8**2)
    w = sqrt((rod * 0.4 + disc * 0.8) * 9.81 / about)
    r = run(loads(text))
    swing = r["pendulum.position"][:, 0] / r["pendulum.position"][0, 0]
    np.testing.assert_allclose(swing, np.cos(w * r.t), atol=1e-6)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("mass: 1", "field required: inertia"),
        ("inertia: 1", "field required: mass"),
        ("mass: 1, inertia: 1, density: 3", "a density needs a `shape`"),
        ("shape: [{box: [1, 1, 1]}]", "a solid without a density"),
        ("density: 1, shape: []", "shape"),
        ("density: 1, shape: [{}]", "give one of box, cylinder, sphere, polygon; got none"),
        ("density: 1, shape: [{box: [1, 1, 1], sphere: 1}]", "got box and sphere"),
        ("density: 1, shape: [{cylinder: 1}]", "a cylinder needs a `length`"),
        ("density: 1, shape: [{sphere: 1, length: 1}]", "a sphere has no length"),
        ("density: 1, shape: [{box: [1, 1, 1], wall: 0.1}]", "a box has no wall"),
        ("density: 1, shape: [{sphere: 1, wall: 0.6}]", "at most half of the diameter"),
        ("density: 1, shape: [{box: [1, 1, 1], mass: 1, density: 1}]", "either `density` or"),
        ("density: 1, shape: [{box: [1, 1, 1]}, {box: [2, 1, 1], hole: true}]", "take away more"),
        (
            "density: 1, shape: [{box: [1, 1, 1]}, {sphere: 0.9, hole: true, at: [5, 0]}]",
            "outside of what it is taken from",
        ),
        ("density: 1, shape: [{polygon: [[0, 0], [1, 1], [1, 0], [0, 1]], length: 1}]", "meet"),
        ("density: 1, shape: [{polygon: [[0, 0], [1, 1]], length: 1}]", "polygon"),
        ("density: 1, shape: [{polygon: [[0, 0], [1, 0], [2, 0]], length: 1}]", "meet"),
        ("density: 1, shape: [{box: [1 kg, 1, 1]}]", "kg"),
        ("density: 1, shape: [{cylinder: 1, length: 1, axis: [0, 0, 0]}]", "must not be zero"),
        ("density: 1, shape: [{hole: true, box: [1, 1, 1], mass: 1}]", "a hole has no mass"),
    ],
)
def test_what_is_no_shape_is_refused(text, said):
    assert said in refused(text)
