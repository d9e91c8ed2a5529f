"""Surface contact with several touches of one pair, and what a contact reports, by hand."""

from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trsim.assemble.equations import gaps
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.march.record import EVENT_KIND, EVENT_ROW, EVENT_TIME, ONSET, SEPARATION

from ..runs import energy_error, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power

G = 9.81
GROOVE = """
bodies: {{roller: {{mass: {m}, inertia: 1e-4, at: [{x}, {y}], velocity: {v}}}}}
forces:
  groove:
    type: surface_contact
    surface: {{body: ground, shape: profile, points: {points}{more}}}
    ball: {{body: roller, at: [{x}, {y}], radius: {r}}}
  push: {{type: applied_load, body: roller, at: [{x}, {y}], force: {push}, direction: [1, 0, 0]}}
contact_laws: {{l: {{normal: impact, exponent: {n}, stiffness: {k}, damping: {c}, ramp: {ramp}}}}}
gravity: [0, -9.81]
solver: {{end: {end}, tolerance: 1e-8}}
output: {{every: {every}}}
"""


def groove(half=30.0, push="0", v=(0.0, 0.0), end=0.2, lift=0.0, aside=0.0, **keys):
    """A roller in a groove of that half angle, deg, drawn where it rests on both, or above."""
    a, m, r, k = radians(half), 0.3, 0.01, keys.get("k", 1e6)
    deep = m * G / (2 * sin(a)) / k
    y = (r - deep) / sin(a) + lift
    points = [[-0.1 * sin(a), 0.1 * cos(a)], [0, 0], [0.1 * sin(a), 0.1 * cos(a)]]
    given = {"m": m, "x": aside, "y": y, "v": list(v), "points": points, "r": r, "push": push}
    given |= {"n": 1, "k": k, "c": 100, "ramp": 1e-9, "end": end, "every": 1e-3, "more": ""}
    return run(GROOVE.format(**{**given, **keys}))


def names(got, kind):
    """(element, time) of events of a kind, in their order."""
    rows = got.events[got.events[:, EVENT_KIND] == kind]
    return [(got.mechanism.instances[int(e[EVENT_ROW])].name, e[EVENT_TIME]) for e in rows]


@pytest.mark.parametrize("half", [15.0, 30.0, 60.0])
@pytest.mark.parametrize("more", ["", ", corner_radius: 1 mm"])
def test_a_roller_rests_in_a_groove(half, more):
    got = groove(half, more=more)
    want = 0.3 * G / (2 * sin(radians(half)))
    for k in (1, 2):
        assert got[f"groove.{k}.normal_force"][1:] == pytest.approx(want, rel=1e-9)
    assert got["groove.contact_force"][1:] == pytest.approx(0.3 * G, rel=1e-9)
    assert got["groove.force"][-1] == pytest.approx([0.0, 0.3 * G, 0.0], abs=1e-9)
    assert got["groove.touching"][1:] == pytest.approx(2.0)
    assert got["groove.penetration"][-1] == pytest.approx(want / 1e6, rel=1e-9)
    assert np.ptp(got["roller.position"], axis=0) == pytest.approx([0, 0, 0], abs=1e-12)


def test_equilibrium_counts_each_touch_once():
    """Drawn too deep and aside, and brought to where it rests."""
    a, k = radians(30), 1e6
    text = GROOVE.format(m=0.3, x=1e-6, y=0.01 / sin(a) - 6e-6, v=[0, 0], r=0.01, push=0, n=1, k=k,
                         c=100, ramp=1e-9, end=0.01, every=1e-3, more="",
                         points=[[-0.05, 0.1 * cos(a)], [0, 0], [0.05, 0.1 * cos(a)]])  # fmt: skip
    hold = ("forces:\n  hold: {type: bushing, bodies: [ground, roller], at: [0, 0], stiffness: "
            "[0, 0, 0], rotational_stiffness: [0, 0, 1]}")  # fmt: skip
    got = run(text.replace("forces:", hold) + "initial: {equilibrium: all}\n")
    want = 0.3 * G / (2 * sin(a))
    for n in (1, 2):
        assert got[f"groove.{n}.penetration"] == pytest.approx(want / k, rel=1e-6)
        assert got[f"groove.{n}.normal_force"][1:] == pytest.approx(want, rel=1e-6)


def test_it_leaves_one_flank_while_it_is_on_the_other():
    """Pushed aside by F it is at W / 2 sin a -+ F / 2 cos a: off one flank where F = W / tan a."""
    a, W = radians(40), 0.3 * G
    rise = 50.0  # N/s
    got = groove(40, push=f'"{rise}*t"', end=0.1)
    off = names(got, SEPARATION)
    assert len(off) == 1
    name, t = off[0]
    assert t == pytest.approx(W / tan(a) / rise, rel=2e-3)
    left = got[f"{name}.normal_force"]
    other = got["groove.1.normal_force" if name.endswith("2") else "groove.2.normal_force"]
    before = (got.t > 0.01) & (got.t < t)
    assert left[before] == pytest.approx(W / (2 * sin(a)) - rise * got.t[before] / (2 * cos(a)),
                                         abs=0.02)  # fmt: skip
    assert other[before] == pytest.approx(W / (2 * sin(a)) + rise * got.t[before] / (2 * cos(a)),
                                          abs=0.02)  # fmt: skip
    assert left[got.t > t] == pytest.approx(0.0)
    assert got["groove.touching"][-1] == pytest.approx(1.0)


@pytest.mark.parametrize("aside, v", [(0.004, [0.0, 0.0]), (-0.002, [0.3, -1.0])])
def test_it_rattles_between_the_flanks(aside, v):
    """Against both flanks as lines, by another integrator."""
    a, m, r, k = radians(35), 0.3, 0.01, 1e6
    got = groove(35, v=v, lift=0.02, aside=aside, end=0.15, c=0, ramp=1e-6)

    def rates(_, state):
        x, y, u, w = state.tolist()
        right, left = (k * max(r - s * x * cos(a) - y * sin(a), 0.0) / m for s in (1, -1))
        return u, w, (right - left) * cos(a), (right + left) * sin(a) - G

    start = [aside, got["roller.position"][0, 1], *v]
    fine = solve_ivp(rates, (0, 0.15), start, method="DOP853", rtol=1e-11, atol=1e-13,
                     max_step=1e-4, t_eval=got.t)  # fmt: skip
    assert got["roller.position"][:, 0] == pytest.approx(fine.y[0], abs=2e-7)
    assert got["roller.position"][:, 1] == pytest.approx(fine.y[1], abs=2e-7)
    assert len({name for name, _ in names(got, ONSET)}) == 2
    assert energy_error(got) < 1e-6


def test_each_touch_remembers_its_own_approach():
    """It falls upon one flank, rolls into the other: what comes back is e of each approach."""
    law = "{normal: identified, stiffness: 1e9, restitution: 0.6}"
    a = radians(45)
    text = GROOVE.format(m=0.3, x=0.02, y=0.06, v=[-1.0, -1.0], r=0.01, push=0, n=1, k=1, c=1,
                         ramp=1, end=0.2, every=1e-4, more="",
                         points=[[-0.1, 0.1], [0, 0], [0.1, 0.1]])  # fmt: skip
    head, _ = text.split("contact_laws")
    got = run(head + f"contact_laws: {{l: {law}}}\ngravity: [0, 0]\nsolver: {{end: 0.2, "
              "tolerance: 1e-8}\noutput: {every: 1e-4}\n")  # fmt: skip
    # straight down along one flank's normal: -x-y is that of the right flank's mirror
    v = got["roller.velocity"]
    n = np.array([1.0, 1.0, 0.0]) / sqrt(2)  # of the left flank
    assert v[0] @ n == pytest.approx(-sqrt(2))
    assert v[-1] @ n == pytest.approx(0.6 * sqrt(2), rel=1e-3)
    assert cos(a) == pytest.approx(sin(a))


VEE = "points: [[-1, 1.2], [0, 0], [1, 1]]"


@pytest.mark.parametrize("planar", [True, False])
@pytest.mark.parametrize("friction", [
    "{law: none}", "{law: modified_coulomb, coefficient: 0.3, v0: 0.01, v1: 0.5}",
    "{law: sticking, coefficient: 0.3, static_coefficient: 0.4, stribeck_speed: 0.1, "
    "bristle_stiffness: 100, bristle_damping: 0.5}",
])  # fmt: skip
def test_forces_of_all_touches_are_in_the_book(planar, friction):
    text = f"""
forces:
  touch: {{type: surface_contact, surface: {{body: left, shape: profile, {VEE}, at: [0.2, 0.1],
          x_axis: [1, 0.2]}}, ball: {{body: right, at: [0.1, 0.8], radius: 0.5}}}}
contact_laws: {{soft: {{normal: impact, stiffness: 1e5, exponent: 1.5, damping: 30, ramp: 0.05,
               friction: {friction}}}}}
"""
    b = bench(text, np.random.default_rng(3))
    w = b.scene()
    gaps(w, b.t)
    e = [k for k, i in enumerate(b.mechanism.instances) if i.name.startswith("touch.")]
    depths = w.gap[e, 0]
    assert len(depths) == 2

    # both pressed in: a step along each normal by differences
    def moved(h):
        b.r[2] += h
        w = b.scene()
        gaps(w, b.t)
        b.r[2] -= h
        return w.gap[e, 0]

    for _ in range(8):
        J = np.array([(moved(1e-6 * u) - moved(-1e-6 * u)) / 2e-6 for u in np.eye(3)]).T
        b.r[2] += np.linalg.lstsq(J, 0.02 - moved(np.zeros(3)), rcond=None)[0]
    assert moved(np.zeros(3)) == pytest.approx([0.02, 0.02], abs=1e-8)
    b.z[:] = 1e-3 * np.random.default_rng(4).normal(size=b.z.size)
    check_action_is_reaction(b)
    check_power(b, rel=1e-6)
    if friction == "{law: none}":
        check_gradient(b, rel=1e-6)


def test_a_pin_in_the_corner_of_a_square_slot():
    """It is pulled into a corner and then along the end: one flank, both, the other one alone."""
    text = """
bodies: {pin: {mass: 0.1, inertia: 1e-5, at: [0, 0]}}
forces:
  slot:
    type: surface_contact
    surface: {body: ground, shape: profile, closed: true, hollow: true,
              points: [[-50 mm, -10 mm], [50 mm, -10 mm], [50 mm, 10 mm], [-50 mm, 10 mm]]}
    ball: {body: pin, at: [0, 0], radius: 8 mm}
  pull: {type: wrench, body: pin, at: [0, 0], force: ["20*smoothstep((t-0.1)/0.2)",
         "-10*smoothstep(t/0.1)*(1-2*smoothstep((t-0.5)/0.1))"], frame: world}
  brake: {type: spring_damper, bodies: [ground, pin], points: [[0, 1], [0, 0]], stiffness: 0,
          damping: 5}
contact_laws: {l: {normal: impact, exponent: 1, stiffness: 1e6, damping: 200, ramp: 1e-9}}
solver: {end: 1, tolerance: 1e-7}
output: {every: 1e-3}
"""
    got = run(text)
    x, y, _ = got["pin.position"].T
    touching = got["slot.touching"]
    (corner,) = np.nonzero((got.t > 0.45) & (got.t < 0.49))
    assert touching[corner] == pytest.approx(2.0)
    assert x[corner] == pytest.approx(0.042 + 20 / 1e6, abs=2e-7)
    assert y[corner] == pytest.approx(-0.002 - 10 / 1e6, abs=2e-7)
    assert x[-1] == pytest.approx(0.042 + 20 / 1e6, abs=2e-7)  # now in the other corner
    assert y[-1] == pytest.approx(0.002 + 10 / 1e6, abs=2e-7)
    assert touching.min() == 0.0
    assert 1.0 in touching[(got.t > 0.5) & (got.t < 0.65)]


def test_a_ball_that_passes_a_seam_is_told():
    block = "[[-50 mm, -20 mm], [50 mm, -20 mm], [50 mm, 20 mm], [10 mm, 20 mm], [0, 10 mm], " \
            "[-10 mm, 20 mm], [-50 mm, 20 mm]]"  # fmt: skip
    text = f"""
bodies: {{ball: {{mass: 0.1, inertia: 1e-5, at: [-20 mm, -25 mm], velocity: [1, 0]}}}}
forces:
  block:
    type: surface_contact
    surface: {{body: ground, shape: profile, closed: true, points: {block}}}
    ball: {{body: ball, at: [-20 mm, -25 mm], radius: 5 mm}}
contact_laws: {{l: {{normal: impact, exponent: 1, stiffness: 1e6, damping: 20, ramp: 1e-9}}}}
gravity: [0, 9.81]
solver: {{end: 0.04}}
"""
    got = run(text)
    words = doubts(got.scenario, got.mechanism, got.outcome)
    assert any("where two touches" in one for one in words)
    still = run(text.replace("velocity: [1, 0]", "velocity: [0.1, 0]"))
    assert not any("where two touches" in w
                   for w in doubts(still.scenario, still.mechanism, still.outcome))  # fmt: skip


# --- what a contact reports ------------------------------------------------------------------

DROP = """
planar: {planar}
bodies: {{ball: {{mass: 0.1, inertia: [1.6e-5, 1.6e-5, 1.6e-5], at: [0, 0.03, 0],
         velocity: [1, 0, 0]}}}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground}}, rolling_resistance: {lever},
          ball: {{body: ball, at: [0, 0.03, 0], radius: 0.02}}}}
  wall: {{type: surface_contact, surface: {{body: ground, at: [0.3, 0, 0], x_axis: [0, 1, 0],
          y_axis: [-1, 0, 0]}}, ball: {{body: ball, at: [0, 0.03, 0], radius: 0.02}}}}
contact_laws:
  l: {{normal: impact, stiffness: 1e7, damping: 30, ramp: 1e-5,
      friction: {{law: {law}, coefficient: 0.3, {friction}}}}}
gravity: [0, -9.81, 0]
solver: {{end: 0.6, tolerance: 1e-7, method: {method}}}
output: {{every: 1e-2, channels: {channels}}}
"""
CREEP = "v0: 0.001, v1: 0.01"


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_losses_of_all_contacts_are_the_book(planar, method):
    got = run(DROP.format(planar=planar, lever=1e-4, law="modified_coulomb", friction=CREEP,
                          method=method, channels="['floor.*', 'wall.*', 'energy.*']"))  # fmt: skip
    for loss, book in (("damping_loss", "impacts"), ("friction_loss", "friction")):
        floor, wall = got[f"floor.{loss}"], got[f"wall.{loss}"]
        total = -got[f"energy.work.{book}"]
        assert floor[-1] > 1e-4
        assert wall[-1] > 1e-5
        tolerance = 1e-13 if method == "dop853" else 1e-7
        assert floor + wall == pytest.approx(total, abs=tolerance)


def test_losses_cost_nothing_unless_asked_for():
    keys = {"planar": "true", "lever": 0.0, "law": "modified_coulomb", "friction": CREEP,
            "method": "dop853"}  # fmt: skip
    plain = run(DROP.format(**keys, channels="['*']"))
    assert "floor.damping_loss" not in plain.place
    asked = run(DROP.format(**keys, channels="['*', '*.damping_loss']"))
    assert asked.mechanism.model.n_z == plain.mechanism.model.n_z + 4
    assert asked["ball.position"] == pytest.approx(plain["ball.position"], abs=0.0)


@pytest.mark.parametrize("hollow", [False, True])
@pytest.mark.parametrize("shape", ["cylinder", "sphere", "profile"])
def test_rolling_speed_on_what_is_round(shape, hollow):
    """A ball that is led round at w and turns at q: its touch goes along a round surface at w R
    and along the ball at r (w - q); seen from a body that turns too all of it is less that."""
    R, r, w, q, p = 0.1, 0.02, 3.0, 7.0, -2.0
    sign = -1.0 if hollow else 1.0
    far = R + sign * r - sign * 1e-6
    u = np.arange(200) * 2 * pi / 200
    points = np.column_stack([R * np.cos(u), R * np.sin(u)]).tolist()
    more = f"points: {points}, closed: true, smooth: true" if shape == "profile" else f"radius: {R}"
    text = f"""
bodies:
  drum: {{mass: 1, inertia: 1e-2}}
  arm: {{mass: 1, inertia: 1e-2}}
  ball: {{mass: 0.1, inertia: 1e-5, at: [{far}, 0]}}
joints:
  drum_pin: {{type: revolute, bodies: [ground, drum], at: [0, 0]}}
  pin: {{type: revolute, bodies: [ground, arm], at: [0, 0]}}
  axle: {{type: revolute, bodies: [arm, ball], at: [{far}, 0]}}
drives:
  turn: {{joint: drum_pin, velocity: {p}}}
  lead: {{joint: pin, velocity: {w}}}
  spin: {{joint: axle, velocity: {q - w}}}
forces:
  c: {{type: surface_contact, surface: {{body: drum, shape: {shape}, {more},
      hollow: {str(hollow).lower()}}}, ball: {{body: ball, at: [{far}, 0], radius: {r}}}}}
contact_laws: {{l: {{normal: impact, stiffness: 1e5, damping: 1, ramp: 1e-6}}}}
solver: {{end: 0.1}}
output: {{every: 0.02}}
"""
    got = run(text)
    # along the surface (w - p) R; against the ball's own material, whose place of touch is at
    # -sign r of its centre
    along = (w - p) * R
    ball = w * R - (w * far - sign * q * r)
    want = 0.5 * abs(along + ball)
    tolerance = 1e-4 if shape == "profile" else 2e-5
    assert got["c.rolling_speed"][1:] == pytest.approx(want, rel=tolerance)
    slides = abs((w * far - sign * q * r) - p * R)
    assert got["c.sliding_speed"][1:] == pytest.approx(slides, rel=1e-4)


def test_the_patch_of_a_hertzian_ball():
    """a = (3 F R / 4 E*)^(1/3), of a ball on a plane and on a ball."""
    E, nu = 2.1e11, 0.3
    stiff = E / (2 * (1 - nu * nu))
    for surface, R in (("shape: plane", 0.02), ("shape: sphere, radius: 0.03, at: [0, -0.03]",
                                                 1 / (1 / 0.02 + 1 / 0.03))):  # fmt: skip
        got = run(f"""
bodies: {{ball: {{mass: 10, inertia: 1e-3, at: [0, 0.02]}}}}
joints: {{up: {{type: prismatic, bodies: [ground, ball], at: [0, 0.02], axis: [0, 1, 0]}}}}
forces:
  c: {{type: surface_contact, surface: {{body: ground, {surface}}},
      ball: {{body: ball, at: [0, 0.02], radius: 0.02}}}}
contact_laws: {{steel: {{normal: hunt_crossley, stiffness: hertz, youngs_modulus: {E},
               poisson: {nu}, restitution: 0.5}}}}
gravity: [0, -9.81]
solver: {{end: 0.01}}
output: {{every: 1e-4}}
""")
        F = got["c.normal_force"]
        slow = abs(got["c.penetration_rate"]) < 1e-7
        rest = slow & (F > 10)
        a = (3 * F * R / (4 * stiff)) ** (1 / 3)
        deep = got["c.penetration"] > 0
        assert got["c.patch_radius"][deep] == pytest.approx(np.sqrt(R * got["c.penetration"][deep]))
        assert got["c.patch_radius"][rest] == pytest.approx(a[rest], rel=1e-3)
        loop = deep & (F > 100)
        assert got["c.patch_radius"][loop] == pytest.approx(a[loop], rel=0.15)


@pytest.mark.parametrize("space", [False, True])
@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_no_touch_of_a_toothed_wheel_is_passed_over(seed, space):
    """A fast wheel whose teeth brush a ball, often two at once: every touch of every tooth is
    found, against the distances from the teeth at many instants."""
    rng = np.random.default_rng(seed)
    teeth, r = int(rng.integers(14, 18)), float(rng.uniform(0.05, 0.06))
    u = np.arange(2 * teeth) * pi / teeth
    R = np.where(np.arange(2 * teeth) % 2, 0.1, 0.088)
    R[::2] += rng.uniform(-0.002, 0.002, teeth)
    corners = (R * np.array([np.cos(u), np.sin(u)])).T.round(6)
    spin, end = float(rng.uniform(20, 200)), 0.3

    def gap(k, far, t):
        """Between the ball and tooth k, from valley to valley; k and t have one shape."""
        p_x, p_y = far * np.cos(-spin * t), far * np.sin(-spin * t)
        least = np.inf
        for m in (2 * k, 2 * k + 1):
            c_x, c_y = corners[m].T
            d_x, d_y = (corners[(m + 1) % (2 * teeth)] - corners[m]).T
            x, y = p_x - c_x, p_y - c_y
            part = np.clip((x * d_x + y * d_y) / (d_x**2 + d_y**2), 0, 1)
            least = np.minimum(least, np.hypot(x - part * d_x, y - part * d_y))
        return least - r

    def gaps_of(far, t):
        """Of all teeth, (teeth, n)."""
        return np.array([gap(k, far, t) for k in range(teeth)])

    turn = np.linspace(0, 2 * pi / spin, 2000)
    low, high = 0.09, 0.2  # as far in as that it is pressed by a tenth of its radius
    for _ in range(50):
        far = 0.5 * (low + high)
        low, high = (low, far) if gaps_of(far, turn).min() > -r / 10 else (far, high)
    far = high
    axes = np.eye(3)
    if space:
        a = np.array([1.0, 2.0, 2.0]) / 3.0
        x = np.array([2.0, 1.0, -2.0]) / 3.0
        axes = np.array([x, np.cross(a, x), a])
    x, y, a = axes.tolist()
    got = run(f"""
planar: {str(not space).lower()}
bodies:
  wheel: {{mass: 2, inertia: [0.05, 0.05, 0.05], angular_velocity: {(spin * axes[2]).tolist()}}}
joints: {{hinge: {{type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: {a}}}}}
forces:
  brush: {{type: surface_contact,
          ball: {{body: ground, at: {(far * axes[0]).tolist()}, radius: {r}}},
          surface: {{body: wheel, shape: profile, closed: true, x_axis: {x}, y_axis: {y},
                    points: {corners.tolist()}}}}}
contact_laws: {{soft: {{normal: impact, stiffness: 1e-3, damping: 0, ramp: 1e-3}}}}
solver: {{end: {end}, tolerance: 1e-6}}
output: {{every: 0.1}}
""", fails=None)  # fmt: skip
    # at many instants, then each crossing by bisection
    t = np.linspace(0, end, 20_001)
    pressed = gaps_of(far, t) < 0.0
    tooth, k = np.nonzero(~pressed[:, :-1] & pressed[:, 1:])
    touches, after = t[k], t[k + 1]
    for _ in range(40):
        mid = 0.5 * (touches + after)
        apart = gap(tooth, far, mid) > 0
        touches, after = np.where(apart, mid, touches), np.where(apart, after, mid)
    found = got.events[got.events[:, EVENT_KIND] == ONSET][:, EVENT_TIME]
    assert pressed.sum(axis=0).max() == 2
    assert np.sort(found) == pytest.approx(np.sort(touches), abs=1e-6 + 1e-5 / spin)
