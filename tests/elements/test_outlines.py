"""Outlines that touch surfaces: flat faces, levers and boxes, against closed forms."""

from math import cos, pi, radians, sin

import numpy as np
import pytest

from trsim.assemble.equations import gaps
from trsim.errors import ScenarioError
from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, ONSET

from ..runs import built, energy_error, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power

G = 9.81
U = np.arange(40) * 2 * pi / 40
EGG = np.column_stack([0.8 * np.cos(U), 0.6 * np.sin(U)]).round(6).tolist()
SHAPES = {
    "cylinder": "shape: cylinder, radius: 0.6",
    "profile": f"shape: profile, closed: true, smooth: true, points: {EGG}",
}
OUTLINES = {
    "face": "[[-0.3, 0], [0.4, 0]]",
    "box": "[[-0.3, 0], [0.4, 0], [0.4, 0.5], [-0.3, 0.5]]",
    "triangle": "[[0, 0], [0.5, 0.2], [0.1, 0.6]]",
}
RAMP = "{law: modified_coulomb, coefficient: 0.3, v0: 0.01, v1: 0.5}"


def pressed(shape, outline, friction="{law: none}", depth=0.02, seed=0):
    """An outline of the right body pressed into a surface of the left one, both thrown about."""
    text = f"""
forces:
  touch: {{type: surface_contact, surface: {{body: left, at: [0.2, 0.1, 0], {SHAPES[shape]}}},
          ball: {{body: right, at: [0.3, 1.0, 0], radius: 0.1, corners: {OUTLINES[outline]}}}}}
contact_laws: {{soft: {{normal: impact, stiffness: 1e5, exponent: 1.5, damping: 30, ramp: 0.05,
               friction: {friction}}}}}
"""
    b = bench(text, np.random.default_rng(seed))
    e = [i.name for i in b.mechanism.instances].index("touch")

    def penetration():
        w = b.scene()
        gaps(w, b.t)
        return w.gap[e, 0]

    for _ in range(12):
        left = depth - penetration()
        if abs(left) < 1e-12:
            break
        found = np.zeros(3)
        for c in range(3):
            for sign in (1, -1):
                b.r[2, c] += sign * 1e-6
                found[c] += sign * penetration() / 2e-6
                b.r[2, c] -= sign * 1e-6
        step = left * found / (found @ found)
        b.r[2] += step * min(1.0, 0.2 / np.linalg.norm(step))
    assert penetration() == pytest.approx(depth, abs=1e-8)
    return b


CASES = [(s, o) for s in SHAPES for o in OUTLINES]


@pytest.mark.parametrize("shape, outline", CASES)
def test_the_elastic_force_is_minus_the_gradient_of_its_energy(shape, outline):
    for seed in range(3):
        check_gradient(pressed(shape, outline, seed=seed), rel=1e-5)


@pytest.mark.parametrize("shape, outline", CASES)
def test_action_is_reaction_and_the_book_is_right(shape, outline):
    for seed in range(3):
        b = pressed(shape, outline, RAMP, seed=seed)
        check_action_is_reaction(b)
        check_power(b, rel=1e-6)


@pytest.mark.parametrize("shape, outline", CASES)
def test_the_rate_is_that_of_the_penetration(shape, outline):
    for seed in range(3):
        b = pressed(shape, outline, seed=seed)
        e = [i.name for i in b.mechanism.instances].index("touch")
        found = []
        for h in (-1e-6, 0.0, 1e-6):
            w = b.later(h).scene()
            gaps(w, b.t)
            found.append(w.gap[e].copy())
        assert (found[2][0] - found[0][0]) / 2e-6 == pytest.approx(found[1][1], abs=1e-5)


# --- what they do ----------------------------------------------------------------------------


def follower(half, end=0.7):
    """A face of that half width on an eccentric disc, e = 15 mm, R = 50 mm, at 10 rad/s."""
    r, R, e = 0.002, 0.05, 0.015
    got = run(f"""
bodies:
  cam: {{mass: 1, inertia: 1e-3}}
  tappet: {{mass: 0.3, inertia: 1e-4, at: [0, {e + R + r}]}}
joints:
  shaft: {{type: revolute, bodies: [ground, cam], at: [0, 0]}}
  guide: {{type: prismatic, bodies: [ground, tappet], at: [0, {e + R + r}], axis: [0, 1, 0]}}
drives: {{motor: {{joint: shaft, position: "10*t"}}}}
forces:
  load: {{type: applied_load, body: tappet, at: [0, 0.07], force: 20, direction: [0, -1, 0]}}
  face:
    type: surface_contact
    surface: {{body: cam, shape: cylinder, radius: {R}, at: [0, {e}]}}
    ball: {{body: tappet, at: [0, {e + R + r}], corners: [[{-half}, 0], [{half}, 0]], radius: {r}}}
contact_laws: {{steel: {{normal: impact, exponent: 1, stiffness: 1e9, damping: 5e3, ramp: 1e-9}}}}
solver: {{end: {end}, tolerance: 1e-7}}
output: {{every: 1e-3}}
""")
    turn = 10 * got.t
    x, y = -e * np.sin(turn), e * np.cos(turn)  # the disc's centre
    beyond = np.maximum(np.abs(x) - half, 0.0)
    return got, y + np.sqrt((R + r) ** 2 - beyond**2), beyond


@pytest.mark.parametrize("half", [0.02, 0.008])
def test_a_flat_follower_and_its_corner(half):
    """On its face it stands R above the disc's centre; past its end its corner goes round it."""
    got, want, beyond = follower(half)
    late = got.t > 0.02
    assert got["tappet.position"][late, 1] == pytest.approx(want[late], abs=1e-7)
    turn, on_face = 10 * got.t, late & (beyond == 0.0)
    want = 0.05 * np.column_stack([np.sin(turn), np.cos(turn)])  # straight up, seen from the cam
    assert got["face.place"][on_face, :2] == pytest.approx(want[on_face], abs=1e-6)
    assert (beyond.max() > 0.0) == (half < 0.015)
    assert energy_error(got) < 1e-6


def test_it_falls_past_the_end_of_its_face():
    """A disc that leaves the face beside its end is not felt any more."""
    got = run("""
bodies:
  disc: {mass: 1, inertia: 1e-3, at: [0, 0]}
  shoe: {mass: 0.2, inertia: 1e-4, at: [0, 0.0519]}
joints:
  rail: {type: prismatic, bodies: [ground, disc], at: [0, 0], axis: [1, 0, 0]}
  guide: {type: prismatic, bodies: [ground, shoe], at: [0, 0.052], axis: [0, 1, 0]}
drives: {pull: {joint: rail, velocity: 0.5}}
forces:
  face: {type: surface_contact, surface: {body: disc, shape: cylinder, radius: 0.05},
         ball: {body: shoe, at: [0, 0.0519], corners: [[-0.03, 0], [0.03, 0]], radius: 0.002}}
contact_laws: {l: {normal: impact, exponent: 1, stiffness: 1e6, damping: 100, ramp: 1e-9}}
gravity: [0, -9.81]
solver: {end: 0.4}
output: {every: 1e-3}
""")
    gone = got.t > (0.03 + 0.052 + 0.01) / 0.5
    assert got["face.normal_force"][gone] == pytest.approx(0.0)
    falls = got["shoe.velocity"][gone, 1]
    assert np.diff(falls) == pytest.approx(-G * 1e-3, rel=1e-6)


@pytest.mark.parametrize("tilt", [0.0, 20.0])
def test_a_box_stands_on_two_corners(tilt):
    """Its centre of mass is off its middle: the corners bear by the lever, without friction too; on
    a plane that leans with the weight as well."""
    b, m, off, K, r = 0.1, 2.0, 0.02, 1e8, 1e-3
    a = radians(tilt)
    x = [float(cos(a)), float(sin(a)), 0.0]
    y = [-float(sin(a)), float(cos(a)), 0.0]
    at = [float(off * x[k] + 0.05 * y[k]) for k in range(3)]
    down = [float(-G * y[k]) for k in range(3)]
    low = [float(r * y[k]) for k in range(3)]
    got = run(f"""
bodies: {{box: {{mass: {m}, inertia: 5e-3, at: {at}}}}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground, x_axis: {x}, y_axis: {y}}},
          ball: {{body: box, at: {low}, radius: {r},
                 corners: [[{-b}, 0], [{b}, 0], [{b}, 0.1], [{-b}, 0.1]]}}}}
contact_laws: {{l: {{normal: impact, exponent: 1, stiffness: {K}, damping: 5e3, ramp: 1e-9}}}}
gravity: {down}
solver: {{end: 0.3}}
output: {{every: 0.01}}
""")
    left, right = m * G * (b - off) / (2 * b), m * G * (b + off) / (2 * b)
    assert got["floor.1.normal_force"][-1] == pytest.approx(left, rel=1e-6)
    assert got["floor.2.normal_force"][-1] == pytest.approx(right, rel=1e-6)
    assert got["floor.touching"][-1] == pytest.approx(2.0)
    assert got["floor.3.penetration"][-1] == pytest.approx(-0.1, abs=1e-6)


def test_a_lever_on_a_roller():
    """A bar hinged at one end lies on a fixed cylinder: N far = W l, both from the hinge."""
    R, r, far, m, l = 0.03, 0.002, 0.3, 1.5, 0.25
    # tangent through the hinge at the origin, r above the touch: bar along x, cylinder below it
    got = run(f"""
bodies: {{bar: {{mass: {m}, inertia: 1e-2, at: [{l}, 0]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, bar], at: [0, 0]}}}}
forces:
  lies: {{type: surface_contact,
         surface: {{body: ground, shape: cylinder, radius: {R}, at: [{far}, {-R - r}]}},
         ball: {{body: bar, at: [0, 0], corners: [[0, 0], [0.5, 0]], radius: {r}}}}}
contact_laws: {{l: {{normal: impact, exponent: 1, stiffness: 1e8, damping: 2e3, ramp: 1e-9}}}}
gravity: [0, -9.81]
solver: {{end: 0.2}}
output: {{every: 0.01, channels: ['*']}}
""")
    assert got["lies.normal_force"][-1] == pytest.approx(m * G * l / far, rel=1e-6)


@pytest.mark.parametrize("swap", [False, True])
@pytest.mark.parametrize("space", [False, True])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_no_touch_is_passed_over(seed, space, swap):
    """A fast oval wheel that brushes a fixed outline, or an outline that turns beside a fixed oval:
    against distances of many places at many instants."""
    rng = np.random.default_rng(seed)
    a, b, r = 0.1, float(rng.uniform(0.05, 0.08)), 0.01
    spin, end = float(rng.uniform(20, 200)), 0.2
    u = np.arange(60) * 2 * pi / 60
    oval = np.column_stack([a * np.cos(u), b * np.sin(u)]).round(7)
    n = int(rng.integers(2, 5))
    turns = np.sort(rng.uniform(0, 0.7, n) + np.arange(n)) * 2 * pi / n
    corners = (rng.uniform(0.02, 0.05) * np.column_stack([np.cos(turns), np.sin(turns)])).round(6)
    v = np.arange(4000) * 2 * pi / 4000
    fine = np.array([a * np.cos(v), b * np.sin(v)])
    coarse = fine[:, ::20]  # within 2e-5 of the oval

    def gap(far, turn, line):
        """Of the outline at `far` in x from the oval, one of them turned; turn (n)."""
        turn = turn[:, None] if swap else -turn[:, None]
        c, s = np.cos(turn), np.sin(turn)
        x, y = corners[:, 0] * c - corners[:, 1] * s, corners[:, 0] * s + corners[:, 1] * c
        # with swap the outline turns about its own point
        x, y = (x + far, y) if swap else (x + far * c, y + far * s)
        least = np.full(len(turn), np.inf)
        for k in range(n):
            p_x, p_y = line[0] - x[:, k - 1, None], line[1] - y[:, k - 1, None]
            d_x, d_y = (x[:, k] - x[:, k - 1])[:, None], (y[:, k] - y[:, k - 1])[:, None]
            part = np.clip((p_x * d_x + p_y * d_y) / np.maximum(d_x**2 + d_y**2, 1e-30), 0, 1)
            apart = (p_x - part * d_x) ** 2 + (p_y - part * d_y) ** 2
            least = np.minimum(least, apart.min(axis=1))
        return np.sqrt(least) - r

    round_ = np.linspace(0, 2 * pi, 181)
    low, high = 0.08, 0.4
    for _ in range(30):
        far = 0.5 * (low + high)
        low, high = (low, far) if gap(far, round_, coarse).min() > -0.001 else (far, high)
    far = high
    axes = np.eye(3)
    if space:
        z = np.array([1.0, 2.0, 2.0]) / 3.0
        x = np.array([2.0, 1.0, -2.0]) / 3.0
        axes = np.array([x, np.cross(z, x), z])
    x, y, z = axes.tolist()
    wheel = ("wheel", "ground") if not swap else ("ground", "wheel")
    hinge = [0.0, 0.0, 0.0] if not swap else (far * axes[0]).tolist()
    got = run(f"""
planar: {str(not space).lower()}
bodies:
  wheel: {{mass: 2, inertia: [0.05, 0.05, 0.05], at: {hinge},
          angular_velocity: {(spin * axes[2]).tolist()}}}
joints: {{hinge: {{type: revolute, bodies: [ground, wheel], at: {hinge}, axis: {z}}}}}
forces:
  brush:
    type: surface_contact
    surface: {{body: {wheel[0]}, shape: profile, closed: true, smooth: true, x_axis: {x},
              y_axis: {y}, points: {oval.tolist()}}}
    ball: {{body: {wheel[1]}, at: {(far * axes[0]).tolist()}, radius: {r},
           corners: {corners.tolist()}}}
contact_laws: {{soft: {{normal: impact, stiffness: 1e-3, damping: 0, ramp: 1e-3}}}}
solver: {{end: {end}, tolerance: 1e-6}}
output: {{every: 0.1}}
""", fails=None)  # fmt: skip
    # one turn at many instants, then each crossing by bisection
    turn = np.linspace(0, 2 * pi, 1441)
    depths = gap(far, turn, coarse)
    near = abs(depths) < 1e-4
    depths[near] = gap(far, turn[near], fine)
    (k,) = np.nonzero((depths[:-1] > 0) & (depths[1:] <= 0))
    starts, after = turn[k], turn[k + 1]
    for _ in range(40):
        mid = 0.5 * (starts + after)
        apart = gap(far, mid, fine) > 0
        starts, after = np.where(apart, mid, starts), np.where(apart, after, mid)
    many = int(spin * end / (2 * pi)) + 1
    want = np.sort([(s + 2 * pi * k) / spin for s in starts for k in range(many)])
    want = want[want < end]
    found = got.events[got.events[:, EVENT_KIND] == ONSET][:, EVENT_TIME]
    if depths[0] <= 0:
        found = found[found > 0]
    assert len(want) >= 1
    assert found == pytest.approx(want, abs=2e-4 / spin)


# --- what is refused -----------------------------------------------------------------------------

TEXT = """
bodies: {{ball: {{mass: 1, inertia: 1e-3, at: [0, 1]}}}}
forces:
  c: {{type: surface_contact{3}, surface: {{body: ground, {0}}},
      ball: {{body: ball, at: [0, 1], corners: {1}, radius: {2}}}}}
contact_laws: {{law: {{normal: impact, stiffness: 1e7, damping: 1, ramp: 1e-3}}}}
"""
ROUND, TWO = "shape: cylinder, radius: 0.5", "[[-0.1, 0], [0.1, 0]]"


@pytest.mark.parametrize("surface, corners, radius, more, what", [
    (ROUND, TWO, 0, "", "edge of an outline is round"),
    (ROUND, "[[0, 0]]", 0.1, "", "of 1 corners"),
    (ROUND, "[[0, 0], [0, 0]]", 0.1, "", "one place"),
    (ROUND, "[[0, 0], [1, 0], [0.2, 0.1], [0, 1]]", 0.1, "", "not convex"),
    (ROUND, "[[0, 1], [0.6, -0.8], [-0.95, 0.3], [0.95, 0.3], [-0.6, -0.8]]", 0.1, "",
     "not convex"),
    (ROUND, "[[0, 0], [1, 0], [2, 0]]", 0.1, "", "not convex"),
    (ROUND, TWO, 0.1, ", rolling_resistance: 0.1", "no resistance"),
    ("shape: cylinder, radius: 2, hollow: true", TWO, 0.1, "", "round outside"),
    ("shape: profile, points: [[-1, 0], [1, 0]]", TWO, 0.1, "", "round outside"),
    ("shape: sphere, radius: 1", TWO, 0.1, "", "meets a plane"),
    ("shape: profile, closed: true, points: [[-1, -1], [1, -1], [0, 0]]", TWO, 0.1, "",
     "straight sides"),
    ("shape: profile, closed: true, smooth: true, points: [[-1, -1], [1, -1], [1, 0], [0, -0.6], "
     "[-1, 0]]", TWO, 0.1, "", "turns inwards"),
])  # fmt: skip
def test_what_is_refused(surface, corners, radius, more, what):
    with pytest.raises(ScenarioError) as caught:
        built(TEXT.format(surface, corners, radius, more))
    assert what in str(caught.value)
