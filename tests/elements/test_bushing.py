"""Bushing: loads are the gradient of the energy for any slide and turn, momentum is kept."""

import numpy as np
import pytest

from trsim.elements import rotations
from trsim.errors import TrsimError

from ..runs import built, energy_error, run
from .bench import (
    bench,
    check_action_is_reaction,
    check_gradient,
    check_power,
    matrix,
    now,
    put_right,
    quaternion,
)

PLACE = np.array([0.2, 0.1, 0.0])
X = np.array([0.48, 0.6, 0.64])
Y = np.cross([0.0, 0.0, 1.0], X) / np.linalg.norm(X[:2])
AXES = np.array([X, Y, np.cross(X, Y)])
WORDS = """
forces:
  mount: {{type: bushing, bodies: [left, right], at: [0.2, 0.1, 0], x_axis: [0.48, 0.6, 0.64],
          y_axis: [{}, {}, {}], stiffness: [300, 0, 500], damping: [20, 5, 0],
          rotational_stiffness: [7, 3, 11], rotational_damping: [0.2, 0.3, 0]}}
"""
MOUNT = WORDS.format(*(Y + 0.3 * X))  # made perpendicular
SEEDS = range(6)


@pytest.mark.parametrize("seed", SEEDS)
def test_loads_are_minus_the_gradient_of_the_energy(seed):
    check_gradient(bench(MOUNT, np.random.default_rng(seed)), rel=1e-8)


@pytest.mark.parametrize("angle", [1e-9, 1e-3, 0.0999, 0.1001, 1.0, 2.0, 3.0, np.pi - 1e-4])
def test_and_so_they_are_at_small_turns_and_up_to_half_a_turn(angle):
    rng = np.random.default_rng(3)
    b = bench(MOUNT, rng)
    axis = rng.normal(size=3)
    put_right(b, PLACE, angle * axis / np.linalg.norm(axis), np.array([0.01, -0.3, 0.2]))
    check_gradient(b, rel=1e-8)


@pytest.mark.parametrize("seed", SEEDS)
def test_action_is_reaction_and_the_book_closes(seed):
    b = bench(MOUNT, np.random.default_rng(seed))
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[2] < 0.0  # dampers only take


@pytest.mark.parametrize("angle", [0.0, 1e-12, 0.3, 2.5, 3.1])
@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-0.48, 0.6, -0.64)])
def test_force_and_moment_in_its_own_axes(angle, axis):
    b = bench(MOUNT, np.random.default_rng(1))
    theta, d = angle * np.array(axis, float), np.array([0.02, -0.3, 0.05])
    put_right(b, PLACE, AXES.T @ theta, AXES.T @ d)
    b.V[:] = 0.0
    F = b.wrenches()
    force = AXES.T @ (np.array([-300, 0, -500]) * d)
    assert F[2, :3] == pytest.approx(now(b, force), rel=1e-12, abs=1e-10)
    # H^T leaves the part along theta as it is
    place = b.r[1] + now(b, PLACE + AXES.T @ d - [0.1, -0.2, 0.3])
    moment = F[2, 3:] - np.cross(place - b.r[2], F[2, :3])
    along = now(b, AXES.T @ theta)
    assert moment @ along == pytest.approx(-theta @ (np.array([7, 3, 11]) * theta), abs=1e-11)


@pytest.mark.parametrize("seed", range(3))
def test_rotation_vector_of_any_turn(seed):
    """From identity to half a turn, through every branch of the quaternion."""

    def rows(R):
        return tuple(tuple(map(float, column)) for column in R.T)

    rng = np.random.default_rng(seed)
    base = matrix(quaternion(rng.normal(size=3)))
    for angle in (0.0, 1e-200, 1e-8, 0.5, 1.7, 3.0, np.pi - 1e-9):
        for axis in (*np.eye(3), *-np.eye(3), rng.normal(size=3)):
            theta = angle * axis / np.linalg.norm(axis)
            turned = base @ matrix(quaternion(theta))
            found = rotations.rotation_vector(rows(base), rows(turned))
            assert np.array(found) == pytest.approx(theta, abs=3e-15 if angle < 3 else 1e-14)


@pytest.mark.parametrize("angle", [1e-5, 0.02, 0.0999, 0.1001, 0.5, 3.0, np.pi])
def test_moment_that_does_the_work_along_theta(angle):
    """Against the closed form, which is exact enough as it is multiplied by theta twice."""
    axis, g = np.array([0.48, 0.6, 0.64]), np.array([1.0, -2.0, 0.5])
    h = (1 - angle / 2 / np.tan(angle / 2)) / angle**2
    once = np.cross(angle * axis, g)
    wanted = g + once / 2 + h * np.cross(angle * axis, once)
    found = rotations.gradient(tuple(angle * axis), tuple(g))
    assert np.array(found) == pytest.approx(wanted, abs=2e-15)


DAMPED = """
bodies:
  mass: {{mass: 2, inertia: [0.02, 0.02, 0.02], at: [0.3, 0.1, {z}]{moving}}}
forces:
  mount: {{type: bushing, bodies: [ground, mass], at: [0.3, 0.1, {z}], stiffness: [800, 200, 450],
          damping: [8, 4, 6], rotational_stiffness: [1, 2, 3],
          rotational_damping: [0.01, 0.02, 0.03]}}
solver: {{end: 1, tolerance: 1e-11}}
output: {{every: 0.02}}
"""


def swinging(m, k, c, v, t):
    """x of m x'' + c x' + k x = 0, x(0) = 0, x'(0) = v."""
    decay = c / (2 * m)
    omega = np.sqrt(k / m - decay**2)
    return v / omega * np.exp(-decay * t) * np.sin(omega * t)


@pytest.mark.parametrize("direction", range(3))
def test_mass_in_each_direction(direction):
    v = np.zeros(3)
    v[direction] = 1.5
    r = run(DAMPED.format(z=0.2, moving=f", velocity: {v.tolist()}"))
    k, c = (800, 200, 450)[direction], (8, 4, 6)[direction]
    x = swinging(2.0, k, c, 1.5, r.t)
    assert r["mount.displacement"][:, direction] == pytest.approx(x, abs=1e-10)
    assert r["mass.position"][:, direction] - (0.3, 0.1, 0.2)[direction] == pytest.approx(
        x, abs=1e-10
    )
    v = r["mass.velocity"][:, direction]
    assert r["mount.force"][:, direction] == pytest.approx(-k * x - c * v, abs=1e-9)
    assert energy_error(r) < 1e-9


@pytest.mark.parametrize("direction", range(3))
def test_turn_in_each_direction(direction):
    omega = np.zeros(3)
    omega[direction] = 2.0
    r = run(DAMPED.format(z=0, moving=f", angular_velocity: {omega.tolist()}"), "planar=false")
    k, c = (1, 2, 3)[direction], (0.01, 0.02, 0.03)[direction]
    theta = swinging(0.02, k, c, 2.0, r.t)
    assert r["mount.rotation_vector"][:, direction] == pytest.approx(theta, abs=1e-10)
    rate = r["mass.angular_velocity"][:, direction]
    assert r["mount.moment"][:, direction] == pytest.approx(-k * theta - c * rate, abs=1e-10)
    assert energy_error(r) < 1e-9


FREE = """
planar: false
bodies:
  a: {mass: 2, inertia: [0.02, 0.03, 0.04], velocity: [0.3, 0, 0.2], angular_velocity: [3, 1, -2]}
  b: {mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, -0.1], velocity: [-0.2, 0.4, 0]}
forces:
  mount: {type: bushing, bodies: [a, b], at: [0.2, 0.1, 0], stiffness: [300, 0, 500],
          damping: [2, 0.5, 0], rotational_stiffness: [7, 3, 11], rotational_damping: [0.02, 0, 0]}
solver: {end: 1, tolerance: 1e-13}
output: {every: 0.02, channels: ["*", "*.rotation"]}
"""


def test_free_bodies_keep_momentum_and_angular_momentum():
    r = run(FREE)
    linear, angular = 0.0, 0.0
    for name, m, inertia in (("a", 2, [0.02, 0.03, 0.04]), ("b", 3, [0.05, 0.04, 0.03])):
        R, omega = r[f"{name}.rotation"].reshape(-1, 3, 3), r[f"{name}.angular_velocity"]
        own = np.einsum("tij,j,tkj,tk->ti", R, inertia, R, omega)
        linear = linear + m * r[f"{name}.velocity"]
        angular = angular + own + m * np.cross(r[f"{name}.position"], r[f"{name}.velocity"])
    assert np.abs(r["mount.displacement"][:, 1]).max() > 0.09  # a long slide
    assert np.abs(r["mount.rotation_vector"]).max() > 0.1
    assert linear == pytest.approx(np.tile(linear[0], (len(r.t), 1)), abs=1e-12)
    assert angular == pytest.approx(np.tile(angular[0], (len(r.t), 1)), abs=1e-12)
    assert energy_error(r) < 1e-9


PLANE = """
planar: {}
bodies:
  hub: {{mass: 1, inertia: [1e-3, 1e-3, 2e-3], at: [0, 0.1], angular_velocity: [0, 0, 5]}}
  rim: {{mass: 2, inertia: [0.1, 0.1, 0.2], at: [0.4, 0], velocity: [0.5, -1]}}
forces:
  mount: {{type: bushing, bodies: [hub, rim], at: [0.1, 0], x_axis: [1, 1], stiffness: [300, 50, 9],
          damping: [2, 1, 3], rotational_stiffness: [8, 9, 4], rotational_damping: [2, 3, 0.02]}}
solver: {{end: 0.5, tolerance: 1e-12}}
output: {{every: 0.01}}
"""


def test_plane_and_space_agree():
    plane, space = run(PLANE.format("true")), run(PLANE.format("false"))
    assert plane.mechanism.planar and not space.mechanism.planar
    for c in ("force", "moment", "displacement", "rotation_vector"):
        assert plane[f"mount.{c}"] == pytest.approx(space[f"mount.{c}"], abs=1e-9)
    assert plane["rim.position"] == pytest.approx(space["rim.position"], abs=1e-10)
    assert energy_error(plane) < 1e-9


def test_planarity_is_seen():
    assert built(PLANE.format("null")).planar
    out = PLANE.format("null").replace("x_axis: [1, 1]", "x_axis: [1, 1, 0.5]")
    assert not built(out).planar


def test_a_mount_beside_the_plane_is_named():
    beside = PLANE.format("null").replace("at: [0.1, 0]", "at: [0.1, 0, 0.02]")
    (why,) = built(beside).spatial_because
    assert why == "forces.mount acts beside the plane of a centre of mass"


def test_a_rail_lets_slide():
    """Along the rail nothing acts, across it the weight hangs on the spring."""
    r = run("""
planar: false
bodies: {slider: {mass: 2, inertia: [0.1, 0.1, 0.1], velocity: [3, 0, 0]}}
forces: {rail: {type: bushing, bodies: [ground, slider], at: [0, 0, 0], stiffness: [0, 1e4, 1e4],
                rotational_stiffness: [100, 100, 100]}}
gravity: [0, -9.81, 0]
solver: {end: 1, tolerance: 1e-11}
output: {every: 0.05}
""")
    assert r["rail.displacement"][:, 0] == pytest.approx(3 * r.t, abs=1e-10)
    sag = 2 * 9.81 / 1e4
    swing = sag * (np.cos(np.sqrt(1e4 / 2) * r.t) - 1)
    assert r["rail.displacement"][:, 1] == pytest.approx(swing, abs=1e-9)
    assert np.abs(r["rail.force"][:, 0]).max() == 0.0


BAD = """
planar: false
bodies:
  block: {mass: 2, inertia: [0.1, 0.1, 0.1]}
forces:
  mount: {type: bushing, bodies: [ground, block], at: [0, 0, 0], stiffness: [1, 1, 1]}
solver: {end: 1}
"""


@pytest.mark.parametrize(
    "old, new, path, what",
    [
        ("[1, 1, 1]", "[1, -1, 1]", ("stiffness", 1), ">= 0"),
        ("[1, 1, 1]", "[1, 1]", ("stiffness",), ""),
        ("[1, 1, 1]", "[1, 1, 1 N*m/rad]", ("stiffness", 2), "wrong unit"),
        ("[0, 0, 0]", "[0, 0, 0], x_axis: [0, 0, 0]", ("x_axis",), "zero"),
        ("[0, 0, 0]", "[0, 0, 0], x_axis: [0, -2, 0]", ("y_axis",), "direction of `x_axis`"),
        ("[ground, block]", "[block, block]", ("bodies",), "to itself"),
    ],
)
def test_refused(old, new, path, what):
    with pytest.raises(TrsimError) as caught:
        built(BAD.replace(old, new))
    [error] = caught.value.problems
    assert error.path[:2] == ("forces", "mount") and error.path[2:][: len(path)] == path
    assert what in error.what


BAR = """
planar: {}
bodies:
  rod: {{type: ancf_cable, start: [0, 0, 0], end: [1, 0, 0], section: {{diameter: 20 mm}},
        elements: 4, youngs_modulus: 207 GPa, density: 7850}}
  block: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [1, 0.2, 0]}}
forces:
  hold: {{type: bushing, bodies: [ground, rod], at: [0, 0, 0], stiffness: [1e5, 1e5, 1e5]}}
  mount: {{type: bushing, bodies: {}, at: [1, 0, 0], stiffness: [1e4, 2e4, 1e4]{}}}
gravity: [0, -9.81, 0]
solver: {{end: 10 ms, tolerance: 1e-9}}
"""
TURNING = ", rotational_stiffness: [0, 0, 10], rotational_damping: [0, 0, 0.1]"


@pytest.mark.parametrize(
    "planar, pair, turning",
    [
        ("true", "[rod, block]", TURNING),
        ("true", "[block, rod]", TURNING),
        ("false", "[block, rod]", ""),
    ],
)
def test_flexible_bars(planar, pair, turning):
    r = run(BAR.format(planar, pair, turning))
    assert np.abs(r["mount.force"]).max() > 1.0
    assert energy_error(r) < 1e-7


@pytest.mark.parametrize(
    "pair, turning, what",
    [
        ("[rod, block]", "", "turns with 'rod'"),
        ("[block, rod]", TURNING, "holds the turning of 'rod'"),
        ("[block, rod]", ", x_axis: [0, 0, 1]", None),
    ],
)
def test_flexible_bars_have_no_torsion_in_space(pair, turning, what):
    text = BAR.format("false", pair, turning)
    if what is None:
        built(text)
        return
    with pytest.raises(TrsimError) as caught:
        built(text)
    assert what in caught.value.what and caught.value.path == ("forces", "mount")
