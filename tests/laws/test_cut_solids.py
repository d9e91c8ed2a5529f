"""Parts of solids beyond a plane, against closed forms and other ways to integrate."""

from itertools import pairwise
from math import pi

import numpy as np
import pytest
from scipy.integrate import dblquad, quad

from trsim.laws import cut_solids as cut
from trsim.laws import solids
from trsim.laws.solids import together

X, Y, Z = np.eye(3)
EXACT = 1e-13
ELL = ((0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0))
STAR = (
    (0.0, 0.0),
    (2.0, 0.5),
    (4.0, 0.0),
    (3.0, 1.5),
    (4.5, 3.0),
    (2.5, 2.0),
    (0.5, 3.5),
    (1.2, 1.5),
)
SHAPES = {
    "box": (cut.box, solids.box, (0.7, 1.1, 0.4)),
    "ell": (cut.prism, solids.prism, (ELL, 0.3)),
    "ell clockwise": (cut.prism, solids.prism, (ELL[::-1], 0.3)),
    "star far away": (cut.prism, solids.prism, (tuple((x + 7, y - 9) for x, y in STAR), 2.0)),
    "ball": (cut.sphere, solids.sphere, (0.8, 0.0)),
    "hollow": (cut.sphere, solids.sphere, (0.8, 0.5)),
    "bar": (cut.cylinder, solids.cylinder, (0.3, 0.0, 2.0)),
    "disc": (cut.cylinder, solids.cylinder, (1.3, 0.0, 0.1)),
    "tube": (cut.cylinder, solids.cylinder, (0.5, 0.4, 1.2)),
}  # fmt: skip


def normals(k=8):
    rng = np.random.default_rng(4)
    some = [v / np.linalg.norm(v) for v in rng.normal(size=(k, 3))]
    near = [v / np.linalg.norm(v) for v in (Z + 1e-9 * X, X - 1e-9 * Z, Y + 1e-3 * Z)]
    return [X, Y, Z, -X, -Y, -Z, *some, *near]


def same(one, other, size=None, within=EXACT):
    m = max(abs(one.mass), abs(other.mass)) if size is None else size.mass
    I = np.abs((one if size is None else size).inertia).max()
    assert abs(one.mass - other.mass) <= within * m
    moment = np.abs(one.mass * one.centre - other.mass * other.centre).max()
    assert moment <= within * (m * (1 + np.abs(other.centre).max()))
    assert np.abs(one.inertia - other.inertia).max() <= 10 * within * I


@pytest.mark.parametrize("name", SHAPES)
def test_both_sides_are_the_whole(name):
    part, whole, sizes = SHAPES[name]
    all_of_it = whole(*sizes)
    for n in normals():
        middle = n @ all_of_it.centre
        for off in (0.0, 0.03, -0.2, 0.27, 0.5):
            one, other = part(*sizes, n, middle + off), part(*sizes, -n, -middle - off)
            same(together([one, other]), all_of_it, within=1e-12)
        same(part(*sizes, n, middle - 90.0), all_of_it, within=1e-12)
        assert part(*sizes, n, middle + 90.0).mass == 0.0


def test_boxes_cut_along_their_edges():
    a, b, c = 0.7, 1.1, 0.4
    for k, n in enumerate(np.eye(3)):
        for sense in (1.0, -1.0):
            edges = [a, b, c]
            edges[k] = 0.5 * edges[k] - 0.1
            part = cut.box(a, b, c, sense * n, 0.1)
            centre = sense * n * (0.1 + 0.5 * edges[k])
            same(part, solids.box(*edges)._replace(centre=centre))


def test_a_corner_and_half_of_a_box():
    # x + y + z > 3 - h of a cube of 2 about its middle: a tetrahedron with right angles, edges h
    h = 0.6
    n = np.ones(3) / 3**0.5
    part = cut.box(2, 2, 2, n, (3 - h) / 3**0.5)
    assert part.mass == pytest.approx(h**3 / 6, rel=EXACT)
    assert part.centre == pytest.approx(3 * [1 - h / 4], rel=EXACT)
    # int x^2 dm about the corner is m h^2/10, int x y dm m h^2/20
    second = part.mass * h * h * (np.eye(3) / 20 + 1 / 20) - part.mass * (h / 4) ** 2
    assert part.inertia == pytest.approx(np.trace(second) * np.eye(3) - second, abs=EXACT)


def test_plates_cut_into_plates():
    part = cut.prism(ELL, 0.3, X, 2.0)
    same(part, solids.prism(((2, 0), (3, 0), (3, 1), (2, 1)), 0.3))
    n = np.array([1.0, 1.0, 0.0]) / 2**0.5  # x + y > 2 cuts the inner corner, and leaves a piece
    one = solids.prism(((2, 0), (3, 0), (3, 1), (1, 1)), 0.3)
    other = solids.prism(((1, 1), (1, 2), (0, 2)), 0.3)
    same(cut.prism(ELL, 0.3, n, 2**0.5), together([one, other]))
    same(cut.prism(ELL, 0.3, Z, 0.05), solids.prism(ELL, 0.1)._replace(
        centre=solids.prism(ELL, 0.1).centre + 0.1 * Z))  # fmt: skip


def test_a_plate_cut_at_an_angle():
    """Over each point of a rectangle the height above the plane, by quadrature over the area."""
    n, d, half = np.array([0.5, 0.3, 0.8]), 0.05, 0.4
    n = n / np.linalg.norm(n)
    corners = ((0, 0), (1, 0), (1, 0.6), (0, 0.6))

    def of(f):
        def over(y, x):
            low = min(max((d - n[0] * x - n[1] * y) / n[2], -half), half)
            return f(x, y, low)

        kinks = sorted({0.0, 1.0, *(k for k in KINKS if 0 < k < 1)})
        return sum(dblquad(over, a, b, 0, 0.6, epsabs=1e-10, epsrel=1e-9)[0]
                   for a, b in pairwise(kinks))  # fmt: skip

    KINKS = [(d - z * n[2] - y * n[1]) / n[0] for z in (-half, half) for y in (0, 0.6)]
    part = cut.prism(corners, 2 * half, n, d)
    assert part.mass == pytest.approx(of(lambda x, y, z: half - z), abs=1e-9)
    first = [of(lambda x, y, z: x * (half - z)), of(lambda x, y, z: y * (half - z)),
             of(lambda x, y, z: (half**2 - z**2) / 2)]  # fmt: skip
    assert part.mass * part.centre == pytest.approx(first, abs=1e-9)
    xz = of(lambda x, y, z: x * (half**2 - z**2) / 2) - part.mass * part.centre[0] * part.centre[2]
    assert part.inertia[0, 2] == pytest.approx(-xz, abs=1e-9)


def test_caps_of_balls():
    R, d = 0.8, 0.3
    h = R - d
    part = cut.sphere(R, 0.0, Y, d)
    assert part.mass == pytest.approx(pi * h * h * (3 * R - h) / 3, rel=EXACT)
    assert part.centre[1] == pytest.approx(3 * (2 * R - h) ** 2 / (4 * (3 * R - h)), rel=EXACT)
    half = cut.sphere(R, 0.0, Z, 0.0)
    m = 2 / 3 * pi * R**3
    assert half.centre[2] == pytest.approx(3 * R / 8, rel=EXACT)
    about = np.diag([83 / 320, 83 / 320, 2 / 5]) * m * R * R
    assert half.inertia == pytest.approx(about, abs=EXACT)
    tiny = cut.sphere(1.0, 0.0, X, 1 - 1e-6)
    assert tiny.mass == pytest.approx(pi * 1e-12 * (1 - 1e-6 / 3), rel=1e-9)
    shell, inner = cut.sphere(1.0, 0.6, Z, 0.2), cut.sphere(0.6, 0.0, Z, 0.2)
    same(together([shell, inner]), cut.sphere(1.0, 0.0, Z, 0.2))


def test_cylinders_cut_across_and_along():
    same(cut.cylinder(0.3, 0.1, 2.0, -Z, 0.25),
         solids.cylinder(0.3, 0.1, 0.75)._replace(centre=-0.625 * Z))  # fmt: skip
    R, L = 0.3, 2.0
    half = cut.cylinder(R, 0.0, L, Y, 0.0)
    m, e = pi * R * R * L / 2, 4 * R / (3 * pi)
    assert (half.mass, half.centre[1]) == pytest.approx((m, e), rel=EXACT)
    across = m * (R * R / 4 + L * L / 12)
    about = np.diag([across - m * e * e, across, m * R * R / 2 - m * e * e])
    assert half.inertia == pytest.approx(about, abs=EXACT)


def test_a_hoof():
    """A cylinder from its middle on, cut by a plane through a diameter of its foot."""
    R, h = 0.5, 0.8
    n = np.array([h, 0.0, -R]) / np.hypot(h, R)
    # the foot is at z = -h, and so is the diameter: h x - R (z + h) > 0
    below = cut.cylinder(R, 0.0, 2 * h, n, R * h / np.hypot(h, R))
    assert below.mass == pytest.approx(2 / 3 * R * R * h, rel=1e-12)
    centre = [3 * pi * R / 16, 0, 3 * pi * h / 32 - h]
    assert below.centre == pytest.approx(centre, abs=1e-13)


@pytest.mark.parametrize("n", [(1, 2, 3), (3, -1, 0.2), (-0.1, 0.2, -1), (1, 0, -1e-7)])
@pytest.mark.parametrize("d", [0.0, 0.21, -0.4])
def test_cylinders_cut_at_an_angle(n, d):
    """By slices across the axis: each a segment of a circle."""
    R, H = 0.6, 0.5
    n = np.array(n) / np.linalg.norm(n)
    s, c = np.hypot(n[0], n[1]), n[2]
    e = np.array([n[0], n[1], 0]) / s

    def of(f):
        def at(z):
            return f(z, float(np.clip((d - c * z) / s, -R, R)))

        kinks = [(d - s * x) / c for x in (-R, R)]
        kinks = sorted({-H, H, *(k for k in kinks if -H < k < H)})
        return sum(quad(at, a, b, epsabs=1e-11, epsrel=1e-11, limit=400)[0]
                   for a, b in pairwise(kinks))  # fmt: skip

    def area(z, x):
        return R * R * np.arccos(x / R) - x * np.sqrt(R * R - x * x)

    def first(z, x):
        return 2 / 3 * (R * R - x * x) ** 1.5

    part = cut.cylinder(R, 0.0, 2 * H, n, d)
    m = of(area)
    near = 1e-9 * max(m, 1e-3)
    assert part.mass == pytest.approx(m, abs=near)
    along, up = of(first), of(lambda z, x: z * area(z, x))
    assert part.mass * part.centre == pytest.approx(along * e + [0, 0, up], abs=near)
    xz = of(lambda z, x: z * first(z, x)) - m * (along / m) * (up / m)
    assert -e @ part.inertia @ Z == pytest.approx(xz, abs=near)
    zz = of(lambda z, x: z * z * area(z, x)) - up * up / m
    total = np.trace(part.inertia) / 2
    assert total - part.inertia[2, 2] == pytest.approx(zz, abs=near)


def test_turned_about_its_axis_a_cylinder_is_the_same():
    n = np.array([0.6, 0.0, 0.8])
    one = cut.cylinder(0.5, 0.2, 1.0, n, 0.1)
    R = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    other = cut.cylinder(0.5, 0.2, 1.0, R @ n, 0.1)
    assert other.centre == pytest.approx(R @ one.centre, abs=EXACT)
    assert other.inertia == pytest.approx(R @ one.inertia @ R.T, abs=EXACT)
