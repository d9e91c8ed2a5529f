"""Surface contact: balls, rollers and points on surfaces, against closed forms."""

import json
from math import cos, sin, sqrt, tau
from pathlib import Path

import numpy as np
import pytest

from trsim.assemble.equations import gaps
from trsim.errors import ScenarioError
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, ONSET, SEPARATION

from ..runs import built, energy_error, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power

G = 9.81
DATA = Path(__file__).parents[1] / "data"
L = "points: [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], closed: true, corner_radius: 0.4"
FREE = "at: [0.2, 0.1, 0.3], x_axis: [1, 0.2, 0.1], y_axis: [0, 1, 0.4]"
SHAPES = {
    "plane": f"shape: plane, {FREE}",
    "sphere": f"shape: sphere, radius: 0.8, {FREE}",
    "bowl": f"shape: sphere, radius: 0.8, hollow: true, {FREE}",
    "cylinder": f"shape: cylinder, radius: 0.6, {FREE}",
    "hole": f"shape: cylinder, radius: 0.6, hollow: true, {FREE}",
    "profile": f"shape: profile, {L}, {FREE}",
    "slot": f"shape: profile, {L}, hollow: true, {FREE}",
    "plate": f"shape: profile, points: [[0, 0], [2, 0]], {FREE}",
}
SOFT = (
    "{normal: impact, stiffness: 1e5, exponent: 1.5, damping: 30, ramp: 0.05, friction: FRICTION}"
)
RAMP = "{law: modified_coulomb, coefficient: 0.3, v0: 0.01, v1: 0.5}"
BRISTLES = ("{law: sticking, coefficient: 0.3, static_coefficient: 0.4, stribeck_speed: 0.1, "
            "bristle_stiffness: 100, bristle_damping: 0.5}")  # fmt: skip


def pressed(shape, friction="{law: none}", more="", depth=0.02, seed=0, law=SOFT):
    """A ball of the right body pressed into a surface of the left one, both thrown about."""
    text = f"""
forces:
  touch: {{type: surface_contact, surface: {{body: left, {SHAPES[shape]}}},
          ball: {{body: right, at: [0.6, 0.5, 0.2], radius: 0.1}}{more}}}
contact_laws: {{soft: {law.replace("FRICTION", friction)}}}
"""
    b = bench(text, np.random.default_rng(seed))

    def penetration():
        w = b.scene()
        gaps(w, b.t)
        return w.gap[[i.name for i in b.mechanism.instances].index("touch"), 0]

    def gradient(h=1e-6):
        found = np.zeros(3)
        for c in range(3):
            for sign in (1, -1):
                b.r[2, c] += sign * h
                found[c] += sign * penetration() / (2 * h)
                b.r[2, c] -= sign * h
        return found

    for _ in range(6):  # along the normal the distance falls as one moves
        b.r[2] += (depth - penetration()) * gradient()
    assert penetration() == pytest.approx(depth, abs=1e-8)
    return b


@pytest.mark.parametrize("shape", SHAPES)
def test_the_elastic_force_is_minus_the_gradient_of_its_energy(shape):
    check_gradient(pressed(shape), rel=1e-6)


@pytest.mark.parametrize("shape, friction", [
    *((shape, RAMP) for shape in SHAPES),
    *((shape, BRISTLES) for shape in SHAPES if shape not in ("sphere", "bowl")),
])  # fmt: skip
def test_action_is_reaction_and_the_book_is_right(shape, friction):
    more = "" if friction == BRISTLES else ", rolling_resistance: 0.01, spinning_friction: 0.02"
    for seed in range(3):
        b = pressed(shape, friction, more, seed=seed)
        b.z[:] = 1e-3 * np.random.default_rng(seed).normal(size=b.z.size)
        check_action_is_reaction(b)
        check_power(b, rel=1e-6)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_rate_is_that_of_the_penetration(shape):
    """By differences of a motion with constant twists."""
    b = pressed(shape)
    e = [i.name for i in b.mechanism.instances].index("touch")
    found = []
    for h in (-1e-6, 0.0, 1e-6):
        w = b.later(h).scene()
        gaps(w, b.t)
        found.append(w.gap[e].copy())
    assert (found[2][0] - found[0][0]) / 2e-6 == pytest.approx(found[1][1], abs=1e-6)


# --- what balls do -------------------------------------------------------------------------

FIRM = "{normal: impact, stiffness: 1e7, damping: 300, ramp: 1e-6, friction: FRICTION}"


def thrown(mu=0.3, v0=1.0, end=0.2, tilt=0.0, space=False, more=""):
    """A ball of 20 mm on a plane on which it rests, at v0 along it, without spin."""
    r, m = 0.02, 0.1
    I = 0.4 * m * r * r
    depth = (m * G * cos(tilt) / 1e7) ** (2 / 3)
    n, t = np.array([-sin(tilt), cos(tilt), 0.0]), np.array([cos(tilt), sin(tilt), 0.0])
    z = np.array([0.0, 0.0, 1.0])
    if space:  # the same, seen from elsewhere
        turn = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3.0
        n, t, z = turn @ n, turn @ t, turn @ z
        down = turn @ np.array([0.0, -G, 0.0])
    else:
        down = np.array([0.0, -G, 0.0])
    say = lambda v: [float(c) for c in v]  # noqa: E731
    text = f"""
planar: {str(not space).lower()}
bodies: {{ball: {{mass: {m}, inertia: [{I}, {I}, {I}], at: {say((r - depth) * n)},
         velocity: {say(v0 * t)}}}}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground, x_axis: {say(t)}, y_axis: {say(n)}}},
          ball: {{body: ball, at: {say((r - depth) * n)}, radius: {r}}}{more}}}
contact_laws:
  firm: {FIRM.replace("FRICTION", f"{{law: modified_coulomb, coefficient: {mu}, v0: 0, v1: 1e-4}}")}
gravity: {say(down)}
solver: {{end: {end}, tolerance: 1e-7}}
"""
    return run(text), t, z


@pytest.mark.parametrize("space", [False, True])
def test_a_ball_slides_and_then_rolls(space):
    """It slides for 2 v0 / 7 mu g, rolls on at 5/7 v0, and has lost 2/7 of its energy."""
    v0, mu = 1.0, 0.3
    r, t, z = thrown(mu, v0, space=space)
    end = 2 * v0 / (7 * mu * G)
    speed, spin = r["ball.velocity"] @ t, r["ball.angular_velocity"] @ z
    slides = r.t < 0.98 * end
    assert speed[slides] == pytest.approx(v0 - mu * G * r.t[slides], abs=1e-3)
    rolls = r.t > 1.02 * end
    assert speed[rolls] == pytest.approx(5 / 7 * v0, rel=1e-3)
    assert spin[rolls] == pytest.approx(-5 / 7 * v0 / 0.02, rel=1e-3)
    kinetic = r["energy.kinetic"]
    assert kinetic[-1] == pytest.approx(5 / 7 * kinetic[0], rel=1e-3)
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("space", [False, True])
@pytest.mark.parametrize("mu", [0.3, 0.1])
def test_a_ball_rolls_down_an_incline(space, mu):
    """At 5/7 g sin(tilt) while mu >= 2/7 tan(tilt), else at g (sin - mu cos)."""
    tilt = 0.5
    r, t, _ = thrown(mu, 0.0, 0.5, tilt, space)
    rolls = mu >= 2 / 7 * np.tan(tilt)
    a = 5 / 7 * G * sin(tilt) if rolls else G * (sin(tilt) - mu * cos(tilt))
    late = r.t > 0.1
    assert -(r["ball.velocity"] @ t)[late] == pytest.approx(a * r.t[late], rel=1e-3)


@pytest.mark.parametrize("space", [False, True])
def test_rolling_resistance_slows_a_ball(space):
    """A wheel with the lever b is slowed by 5/7 g b / r."""
    b, v0 = 2e-4, 0.5
    r, t, _ = thrown(0.3, v0, 0.5, space=space, more=f", rolling_resistance: {b}")
    late = r.t > 0.2
    speed = r["ball.velocity"] @ t
    slope = np.polyfit(r.t[late], speed[late], 1)[0]
    assert slope == pytest.approx(-5 / 7 * G * b / 0.02, rel=5e-3)


def test_a_spinning_ball_is_slowed_by_its_lever():
    r, m, b, w0 = 0.02, 0.1, 1e-3, 50.0
    I = 0.4 * m * r * r
    depth = (m * G / 1e7) ** (2 / 3)
    text = f"""
planar: false
bodies: {{top: {{mass: {m}, inertia: [{I}, {I}, {I}], at: [0, {r - depth}, 0],
         angular_velocity: [0, {w0}, 0]}}}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground}}, spinning_friction: {b},
          ball: {{body: top, at: [0, {r - depth}, 0], radius: {r}}}}}
contact_laws:
  firm: {FIRM.replace("FRICTION", "{law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1e-4}")}
gravity: [0, {-G}, 0]
solver: {{end: 0.5, tolerance: 1e-7}}
"""
    got = run(text)
    want = np.maximum(w0 - m * G * b / I * got.t, 0.0)
    assert got["top.angular_velocity"][:, 1] == pytest.approx(want, abs=0.02)


@pytest.mark.parametrize("space", [False, True])
def test_a_ball_leaves_a_smooth_sphere(space):
    """Where it has come down by a third: cos = 2/3.

    It comes off with the third power of time: what it is pressed in by is felt as its third root.
    """
    R, r, m = 0.5, 0.05, 0.2
    start, K = 0.1, 1e9
    far = R + r - m * G / K
    place = [far * sin(start), far * cos(start), 0.0]
    shape = "sphere" if space else "cylinder"
    text = f"""
planar: {str(not space).lower()}
bodies: {{ball: {{mass: {m}, inertia: [2e-4, 2e-4, 2e-4], at: {place}}}}}
forces:
  hill: {{type: surface_contact, surface: {{body: ground, shape: {shape}, radius: {R}}},
         ball: {{body: ball, at: {place}, radius: {r}}}}}
contact_laws:
  smooth: {{normal: impact, exponent: 1, stiffness: {K}, damping: 5000, ramp: 1e-10}}
gravity: [0, {-G}, 0]
solver: {{end: 0.8, tolerance: 1e-8}}
output: {{every: 1 ms}}
"""
    got = run(text)
    left = got.events[got.events[:, EVENT_KIND] == SEPARATION][-1, EVENT_TIME]
    k = int(np.searchsorted(got.t, left))
    x, y, _ = got["ball.position"][k]
    assert y / np.hypot(x, y) == pytest.approx(2 / 3 * cos(start), abs=2e-3)


def test_a_ball_swings_in_a_bowl():
    """Without friction as a pendulum of the length R - r."""
    R, r, a, K = 0.5, 0.05, 0.05, 1e9
    far = R - r + (0.2 * G / K) ** (2 / 3)
    place = [far * sin(a), -far * cos(a), 0.0]
    text = f"""
bodies: {{ball: {{mass: 0.2, inertia: 2e-4, at: {place}}}}}
forces:
  bowl: {{type: surface_contact,
         surface: {{body: ground, shape: sphere, radius: {R}, hollow: true}},
         ball: {{body: ball, at: {place}, radius: {r}}}}}
contact_laws: {{smooth: {{normal: impact, stiffness: {K}, damping: 1000, ramp: 1e-7}}}}
gravity: [0, {-G}, 0]
solver: {{end: 3, tolerance: 1e-7}}
output: {{every: 1 ms}}
"""
    got = run(text)
    x = got["ball.position"][:, 0]
    (down,) = np.nonzero((x[:-1] > 0) & (x[1:] <= 0))
    crossed = got.t[down] + 1e-3 * x[down] / (x[down] - x[down + 1])
    want = tau * sqrt((R - r) / G) * (1 + a * a / 16)
    assert np.diff(crossed) == pytest.approx(want, rel=2e-4)


def test_three_balls_in_a_row():
    """Equal Hertz balls that touch, without loss: the first comes back (published figures)."""
    balls = {"a": -0.02, "b": 0.0, "c": 0.02}
    bodies = "\n".join(
        f"  {n}: {{mass: 0.03, inertia: 1e-6, at: [{x}, 0], velocity: [{float(n == 'a')}, 0]}}"
        for n, x in balls.items()
    )
    joints = "\n".join(
        f"  of_{n}: {{type: prismatic, bodies: [ground, {n}], at: [{x}, 0], axis: [1, 0, 0]}}"
        for n, x in balls.items()
    )
    forces = "\n".join(
        f"  {i}{j}: {{type: surface_contact, surface: {{body: {i}, shape: sphere, radius: 0.01, "
        f"at: [{balls[i]}, 0]}}, ball: {{body: {j}, radius: 0.01, at: [{balls[j]}, 0]}}}}"
        for i, j in ("ab", "bc")
    )
    text = f"""
bodies:
{bodies}
joints:
{joints}
forces:
{forces}
contact_laws:
  steel: {{normal: hunt_crossley, stiffness: hertz, youngs_modulus: 207 GPa, poisson: 0.29,
          restitution: 1, slowest_impact: 1e-6 m/s}}
solver: {{end: 1e-3, tolerance: 1e-9}}
output: {{every: 1e-3}}
"""
    got = run(text)
    v = [got[f"{n}.velocity"][-1, 0] for n in "abc"]
    assert v == pytest.approx([-0.0710, 0.0764, 0.9945], abs=2e-4)


@pytest.mark.parametrize("law, e", [("hunt_crossley", 1.0), ("identified", 0.6)])
@pytest.mark.parametrize("tilted", [False, True])
def test_two_spheres_rebound(law, e, tilted):
    """What is delivered is what is written, whichever body has the surface, wherever they meet."""
    way = np.array([0.36, 0.48, 0.8]) if tilted else np.array([1.0, 0.0, 0.0])
    far = (0.03 * way).tolist()
    for surface, ball in (("a", "b"), ("b", "a")):
        at = {"a": [0.0, 0.0, 0.0], "b": far}
        text = f"""
planar: false
bodies:
  a: {{mass: 0.3, inertia: [1e-4, 1e-4, 1e-4], velocity: {(0.5 * way).tolist()}}}
  b: {{mass: 0.1, inertia: [1e-5, 1e-5, 1e-5], at: {far}, velocity: {(-0.4 * way).tolist()}}}
forces:
  meet: {{type: surface_contact,
         surface: {{body: {surface}, shape: sphere, radius: 0.012, at: {at[surface]}}},
         ball: {{body: {ball}, radius: 0.008, at: {at[ball]}}}}}
contact_laws: {{one: {{normal: {law}, stiffness: 1e9, restitution: {e}}}}}
solver: {{end: 0.03, tolerance: 1e-8}}
output: {{every: 0.03}}
"""
        got = run(text)
        v = [got[f"{n}.velocity"][-1] @ way for n in "ab"]
        assert v[1] - v[0] == pytest.approx(0.9 * e, rel=1e-4)
        assert 0.3 * v[0] + 0.1 * v[1] == pytest.approx(0.3 * 0.5 - 0.1 * 0.4, rel=1e-9)
        assert abs(got["a.angular_velocity"]).max() < 1e-9


# --- profiles ------------------------------------------------------------------------------


def test_a_roller_follows_a_profile_over_its_corners():
    """A roller that is pulled along a box with rounded corners: its centre is a radius away, less
    what it is pressed in by."""
    text = """
bodies:
  cart: {mass: 0.2, inertia: 1e-4, at: [-0.2, 0.06]}
  roller: {mass: 0.2, inertia: 1e-4, at: [-0.2, 0.06]}
joints:
  along: {type: prismatic, bodies: [ground, cart], at: [-0.2, 0.06], axis: [1, 0, 0]}
  up: {type: prismatic, bodies: [cart, roller], at: [-0.2, 0.06], axis: [0, 1, 0]}
drives: {pull: {joint: along, position: "0.4*smoothstep(t/4)"}}
forces:
  weight: {type: applied_load, body: roller, at: [-0.2, 0.06], force: 20, direction: [0, -1, 0]}
  box: {type: surface_contact, ball: {body: roller, at: [-0.2, 0.06], radius: 0.03},
        surface: {body: ground, shape: profile, closed: true, corner_radius: 0.02,
                  points: [[-0.25, -0.1], [0.1, -0.1], [0.1, 0.03], [-0.25, 0.03]]}}
contact_laws: {firm: {normal: impact, stiffness: 1e9, damping: 2000, ramp: 1e-6}}
solver: {end: 4, tolerance: 1e-7}
output: {every: 0.01}
"""
    got = run(text)
    x, y, _ = got["roller.position"].T
    flat = x < 0.08
    assert y[flat] == pytest.approx(0.06, abs=1e-5)
    round_ = (x > 0.0801) & (x < 0.12)
    assert y[round_] == pytest.approx(0.01 + np.sqrt(0.05**2 - (x[round_] - 0.08) ** 2), abs=2e-5)
    assert x[-1] > 0.12  # it went over the corner


def test_a_roller_on_a_cam():
    """An eccentric disc given by 60 points lifts a roller by
    e cos + sqrt((R + r)^2 - e^2 sin^2)."""
    R, r, e, w = 0.05, 0.01, 0.015, 10.0
    u = np.arange(60) * tau / 60
    points = np.column_stack([e + R * np.cos(u), R * np.sin(u)]).tolist()
    text = f"""
bodies:
  cam: {{mass: 1, inertia: 1e-3}}
  rod: {{mass: 0.3, inertia: 1e-4, at: [0, {e + R + r}]}}
joints:
  shaft: {{type: revolute, bodies: [ground, cam], at: [0, 0]}}
  guide: {{type: prismatic, bodies: [ground, rod], at: [0, {e + R + r}], axis: [0, 1, 0]}}
drives: {{motor: {{joint: shaft, position: "{w}*t"}}}}
forces:
  follows: {{type: surface_contact, ball: {{body: rod, at: [0, {e + R + r}], radius: {r}}},
            surface: {{body: cam, shape: profile, closed: true, smooth: true,
                      x_axis: [0, 1, 0], y_axis: [-1, 0, 0], points: {points}}}}}
contact_laws: {{steel: {{normal: impact, stiffness: 1e10, damping: 3000, ramp: 1e-7}}}}
gravity: [0, {-G}]
solver: {{end: 1, tolerance: 1e-7}}
output: {{every: 5 ms}}
"""
    got = run(text)
    turn = w * got.t
    want = e * np.cos(turn) + np.sqrt((R + r) ** 2 - (e * np.sin(turn)) ** 2)
    late = got.t > 0.05
    assert got["rod.position"][late, 1] == pytest.approx(want[late], abs=2e-6)
    assert got["follows.normal_force"][late].min() > 0.0  # e w^2 < g


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("space", [False, True])
def test_no_touch_is_passed_over(seed, space):
    """A wheel with a profile turns beside a ball too soft to be felt: touches as counted along its
    closed form, by places some micrometres apart."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 6))
    turns = np.sort(rng.uniform(0, 1, n) + np.arange(n)) * tau / n
    axes = rng.uniform(0.06, 0.1, 2)  # of an ellipse, so that it is convex
    corners = (axes * np.column_stack([np.cos(turns), np.sin(turns)])).round(6)
    radii = np.linalg.norm(corners, axis=1)
    spin, end, r = float(rng.uniform(20, 200)), 0.5, 0.01
    far = float(max(radii) + r - 10 ** rng.uniform(-4, -2.3))
    u, w, a = np.eye(3)
    if space:
        a = np.array([1.0, 2.0, 2.0]) / 3.0
        u = np.array([2.0, 1.0, -2.0]) / 3.0
        w = np.cross(a, u)
    say = lambda v: [float(c) for c in v]  # noqa: E731
    text = f"""
planar: {str(not space).lower()}
bodies:
  wheel: {{mass: 2, inertia: [0.05, 0.05, 0.05], angular_velocity: {say(spin * a)}}}
joints: {{hinge: {{type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: {say(a)}}}}}
forces:
  brush: {{type: surface_contact, ball: {{body: ground, at: {say(far * u)}, radius: {r}}},
          surface: {{body: wheel, shape: profile, closed: true, x_axis: {say(u)}, y_axis: {say(w)},
                    points: {corners.tolist()}}}}}
contact_laws: {{soft: {{normal: impact, stiffness: 1e-3, damping: 0, ramp: 1e-3}}}}
solver: {{end: {end}, tolerance: 1e-6}}
output: {{every: 0.1}}
"""
    got = run(text, fails=None)
    # the ball seen from the wheel goes round; distance from the polygon, from outside

    def pressed(turn):
        p = far * np.column_stack([np.cos(turn), -np.sin(turn)])
        least = np.full(len(turn), np.inf)
        for k in range(n):
            c, d = corners[k], corners[(k + 1) % n] - corners[k]
            along = np.clip(((p - c) @ d) / (d @ d), 0, 1)
            least = np.minimum(least, np.linalg.norm(p - c - along[:, None] * d, axis=1))
        return least < r

    turn = np.linspace(0, tau, 200_001)  # once round, then each crossing by bisection
    inside = pressed(turn)
    (k,) = np.nonzero(~inside[:-1] & inside[1:])
    before, after = turn[k], turn[k + 1]
    for _ in range(40):
        middle = 0.5 * (before + after)
        within = pressed(middle)
        before, after = np.where(within, before, middle), np.where(within, middle, after)
    rounds = np.arange(int(spin * end / tau) + 1)
    touches = np.sort((after + tau * rounds[:, None]).ravel() / spin)
    touches = touches[touches < end]
    found = got.events[got.events[:, EVENT_KIND] == ONSET][:, EVENT_TIME]
    assert len(touches) > 5
    assert found == pytest.approx(touches, abs=1e-6 + 1e-5 / spin)


def test_a_block_stays_on_an_incline():
    """tan(tilt) = 0.95 mu: it does not move between 1 s and 100 s with the sticking law.

    It is let go softly: what is let go at once swings on its bristles to twice the load.
    """
    mu, K = 0.4, 1e7
    tilt = float(np.arctan(0.95 * mu))
    depth = (0.5 * G * cos(tilt) / K) ** (2 / 3)
    text = f"""
bodies: {{block: {{mass: 1, inertia: 2e-3, at: [0, {0.03 - depth}]}}}}
forces:
  hand: {{type: applied_load, body: block, at: [0, {0.03 - depth}],
         force: "{G * sin(tilt)}*(1 - smoothstep(t/0.5))", direction: [1, 0, 0]}}
  left: {{type: surface_contact, surface: {{body: ground}},
         ball: {{body: block, at: [-0.1, {0.01 - depth}], radius: 0.01}}}}
  right: {{type: surface_contact, surface: {{body: ground}},
          ball: {{body: block, at: [0.1, {0.01 - depth}], radius: 0.01}}}}
contact_laws:
  dry: {{normal: impact, stiffness: {K}, damping: 2000, ramp: 1e-6,
        friction: {{law: sticking, coefficient: 0.3, static_coefficient: {mu}, stribeck_speed: 1e-3,
                   bristle_stiffness: 1e5, bristle_damping: 300}}}}
gravity: [{-G * sin(tilt)}, {-G * cos(tilt)}]
solver: {{end: 100, tolerance: 1e-8}}
output: {{every: 1}}
"""
    got = run(text)
    x, y, _ = got["block.position"][1:].T
    assert np.ptp(x) < 1e-6
    assert np.ptp(y) < 1e-6
    assert abs(x[-1]) < 1e-4


# --- what is refused -----------------------------------------------------------------------

BALL = """
bodies: {{ball: {{mass: 1, inertia: 1e-3, at: [0, 1]}}}}
forces:
  c: {{type: surface_contact, surface: {{body: ground, {0}}},
      ball: {{body: ball, at: [0, 1], {1}}}}}
contact_laws: {{law: {2}}}
"""
HARD = "{normal: impact, stiffness: 1e7, damping: 1, ramp: 1e-3}"
BENT = "shape: profile, points: [[-1, 0], [0, 0], [1, 1]]"


@pytest.mark.parametrize("surface, ball, law, what", [
    ("shape: sphere", "radius: 0.1", HARD, "needs `radius`"),
    (BENT + ", smooth: true, corner_radius: 0.1", "radius: 0.1", HARD, "has no corners"),
    ("shape: plane, radius: 1", "radius: 0.1", HARD, "radius is no number of a plane"),
    ("shape: sphere, radius: 0.1, hollow: true", "radius: 0.2", HARD, "does not fit"),
    ("shape: profile, points: [[0, 0], [1, 0]], hollow: true", "radius: 1", HARD, "has an inside"),
    (BENT, "radius: 0", HARD, "turns inwards"),
    (BENT + ", corner_radius: 0.09", "radius: 0.1", HARD, "nearly one"),
    ("shape: profile, points: [[-1, 0.02], [0, 0], [1, 0.02]]", "radius: 0.1", HARD, "nearly one"),
    ("shape: profile, hollow: true, closed: true, points: [[-1, 0], [1, 0], [1, 1], [-1, 1]]",
     "radius: 0.7", HARD, "fits nowhere"),
    ("shape: profile, points: [[-1, 0], [1, 0]]", "radius: 0", HARD, "no direction"),
    ("shape: profile, points: [[-1, 1], [1, 1]]", "radius: 1", HARD, "on which side"),
    ("shape: plane", "radius: 0", "{normal: flores, stiffness: hertz, youngs_modulus: 1e9, "
     "poisson: 0.3, restitution: 0.5}", "hertz is that of a ball"),
    ("shape: plane", "radius: 1", "{normal: flores, restitution: 0.5, bearing_radius: 1, "
     "youngs_modulus: 1e9, poisson: 0.3}", "journal in its bearing"),
    ("shape: plane", "radius: 1", "{normal: impact, stiffness: 1e7}", "needs damping, ramp"),
    ("shape: plane", "radius: 1", "{normal: impact, stiffness: 1e7, damping: 1, ramp: 1, "
     "restitution: 1}", "restitution is no number"),
    ("shape: plane", "radius: 1", "{normal: flores, stiffness: 1e7}", "needs restitution"),
    ("shape: profile, smooth: true, points: [[0, 0], [1, 0], [0.5, 0]]", "radius: 0.1", HARD,
     "turns back"),
    ("shape: profile, smooth: true, closed: true, points: [[0, 0], [1, 0], [0.5, 0]]",
     "radius: 0.1", HARD, "turns"),
    ("shape: sphere, radius: 1", "radius: 1", HARD[:-1] + f", friction: {BRISTLES}}}", "sphere"),
])  # fmt: skip
def test_what_is_refused(surface, ball, law, what):
    with pytest.raises(ScenarioError) as caught:
        built(BALL.format(surface, ball, law))
    assert what in str(caught.value)


def test_a_contact_too_soft_for_its_ball_is_told():
    got = run(BALL.format("shape: plane", "radius: 0.1", HARD.replace("1e7", "1e4"))
              + "gravity: [0, -9.81]\nsolver: {end: 1}\n")  # fmt: skip
    told = doubts(got.scenario, got.mechanism, got.outcome)
    assert any("too deep" in text for text in told)


@pytest.mark.parametrize("radius, law", [
    (0.0, RAMP), (0.1, "{law: coulomb, coefficient: 0.3}"), (0.1, "{law: none}"),
    (0.1, RAMP.replace("0.3", "0")),
])  # fmt: skip
@pytest.mark.parametrize("lever", ["rolling_resistance", "spinning_friction"])
def test_levers_that_mean_nothing_are_refused(radius, law, lever):
    text = BALL.format("shape: plane", f"radius: {radius}", HARD[:-1] + f", friction: {law}}}")
    with pytest.raises(ScenarioError):
        built(text.replace("ball: {body", f"{lever}: 0.01, ball: {{body"))


VALLEY = """
bodies: {{ball: {{mass: 0.1, inertia: 1e-4, at: [{x}, {y}], velocity: [0.5, 0]}}}}
forces:
  v: {{type: surface_contact, surface: {{body: ground, shape: profile, {points}}},
      ball: {{body: ball, at: [{x}, {y}], radius: {r}}}}}
contact_laws: {{l: {{normal: impact, stiffness: {k}, damping: 5, ramp: 1e-3}}}}
gravity: [0, -9.81]
solver: {{end: 1}}
"""


def told(**keys):
    got = run(VALLEY.format(**keys), fails=None)
    return doubts(got.scenario, got.mechanism, got.outcome)


def test_a_ball_on_the_other_side_is_told():
    """It is drawn below a valley, beside it, and is thrown over its edge into it."""
    valley = "points: [[-0.5, 0.1], [0, 0], [0.5, 0.1]]"
    text = VALLEY.format(x=-0.6, y=0.0, r=0.05, k=1e6, points=valley)
    text = text.replace("velocity: [0.5, 0]", "velocity: [1, 3]").replace("end: 1", "end: 1.6")
    got = run(text)
    assert got["v.force_behind"].max() > 0.0
    words = doubts(got.scenario, got.mechanism, got.outcome)
    assert any("not drawn" in one for one in words)
    # a flat plate suits from both sides, and what was drawn above is not behind
    flat = told(x=0, y=0.06, r=0.05, k=1e7, points="points: [[1, 0], [-1, 0]]")
    assert flat == ()


def test_a_point_through_a_thin_plate_is_told():
    plate = ("points: [[-1, -0.002], [1, -0.002], [1, 0], [-1, 0]], closed: true, "
             "corner_radius: 0.0009")  # fmt: skip
    words = told(x=0, y=1, r=0, k=1e4, points=plate)
    assert any("too deep" in one for one in words)


BOUNCING = """
planar: false
bodies:
  ball: {{mass: 0.1, inertia: [1.6e-5, 1.6e-5, 1.6e-5], at: [0, 0.03, 0], velocity: {v}}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground, shape: plane}},
          ball: {{body: ball, at: [0, 0.03, 0], radius: 0.02}}}}
contact_laws:
  pad: {{normal: {normal}, restitution: 0.8, stiffness: 1e7,
        friction: {{law: sticking, coefficient: 0.3, stribeck_speed: 1e-3,
                   bristle_stiffness: 1e4, bristle_damping: 1}}}}
gravity: [0, -9.81, 0]
solver: {{end: 0.3}}
"""


@pytest.mark.parametrize("normal", ["identified", "newton"])
def test_bristles_begin_every_touch_unbent_in_both_directions(normal):
    along, across = (run(BOUNCING.format(v=v, normal=normal)) for v in ([2, 0, 0], [0, 0, 2]))
    assert across["ball.velocity"][:, 2] == pytest.approx(along["ball.velocity"][:, 0], abs=1e-6)


def test_a_ball_dropped_on_a_floor_of_impact():
    """By an independent integration of m y'' = IMPACT - m g, see tests/data."""
    told = json.loads((DATA / "impact_and_bistop.json").read_text())["impact_ball"]
    high = 0.05 + told["h0"]
    r = run(f"""
bodies: {{ball: {{mass: {told["m"]}, inertia: 1e-3, at: [0, {high}]}}}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground}},
          ball: {{body: ball, at: [0, {high}], radius: 0.05}}}}
contact_laws:
  law: {{normal: impact, exponent: {told["e"]}, stiffness: {told["k"]}, damping: {told["cmax"]},
        ramp: {told["d"]}, friction: {{law: none}}}}
gravity: [0, -{told["g"]}, 0]
solver: {{end: 0.3, tolerance: 1e-9}}
""")
    depth, _ = r.largest("floor.penetration")
    assert depth == pytest.approx(told["max_penetration"], rel=1e-6)
    (left,) = r.events[r.events[:, EVENT_KIND] == SEPARATION]
    # its v_out is that of a step after the separation, lower by 2e-6 than what its apex needs
    assert -left[3] == pytest.approx(sqrt(2.0 * told["g"] * told["apex"]), rel=1e-7)
