"""Impacts that take no time: what they deliver, hand on and lose, and what joints take of them."""

from itertools import pairwise
from math import cos, sin, sqrt

import numpy as np
import pytest

from trsim.errors import ModelError, ScenarioError
from trsim.laws.impact import impact
from trsim.solve.march.record import IMPACT, ONSET, SEPARATION

from ..runs import built, run

G = 9.81
TIME, KIND, SPEED, WORK, IMPULSE = 0, 1, 3, 5, 6
BALL = """
bodies:
  ball: {mass: 0.1, inertia: 1.6e-5, at: [0, 0.52]}
forces:
  floor: {type: surface_contact, surface: {body: ground, shape: plane},
          ball: {body: ball, at: [0, 0.52], radius: 0.02}}
contact_laws:
  hard: {normal: newton, stiffness: 1e9, restitution: 0.8, slowest_impact: 1e-4}
gravity: [0, -9.81, 0]
solver: {end: 1}
"""


def of(r, kind):
    """The lines of events of a kind."""
    return r.events[r.events[:, KIND] == kind]


def lost(r):
    """How far energies are from what is booked, of the largest."""
    return r.outcome.statistics["energy_residual_relative"]


@pytest.mark.parametrize("rule", ["newton", "poisson"])
@pytest.mark.parametrize("e", [0.1, 0.6, 1.0])
def test_a_ball_bounces_by_its_restitution(rule, e):
    r = run(BALL, f"contact_laws.hard.normal={rule}", f"contact_laws.hard.restitution={e}")
    hits = of(r, IMPACT)
    v_0 = sqrt(2.0 * G * 0.5)
    assert hits[0, TIME] == pytest.approx(v_0 / G, rel=1e-8)
    assert hits[0, SPEED] == pytest.approx(v_0, rel=1e-7)
    assert hits[0, IMPULSE] == pytest.approx(0.1 * v_0 * (1 + e), rel=1e-7)
    assert hits[0, WORK] == pytest.approx(-0.05 * v_0**2 * (1 - e * e), abs=1e-7)
    assert of(r, SEPARATION)[0, SPEED] == pytest.approx(-e * v_0, rel=1e-7)
    assert lost(r) < 1e-7


def test_bounces_that_accumulate_end_in_contact():
    e, v_0 = 0.8, sqrt(2.0 * G * 0.5)
    r = run(BALL, "solver.end=4")
    ends = v_0 / G + 2.0 * e * v_0 / G / (1.0 - e)
    assert of(r, ONSET)[-1, TIME] == pytest.approx(ends, rel=1e-3)
    assert len(of(r, SEPARATION)) == len(of(r, IMPACT)) - 1, "the last touch rests"
    speeds = of(r, IMPACT)[:, SPEED]
    assert speeds[1:] == pytest.approx(e * speeds[:-1], rel=1e-4)
    assert r["floor.normal_force"][-1] == pytest.approx(0.1 * G, rel=1e-6)
    assert r["floor.penetration"][-1] == pytest.approx((0.1 * G / 1e9) ** (2 / 3), rel=1e-5)
    assert r["energy.work.impacts"][-1] == pytest.approx(-0.1 * G * 0.5, rel=1e-3)
    assert lost(r) < 1e-6


def test_a_ball_from_rest_on_the_floor_rests():
    r = run(BALL.replace("0.52", "0.02"), "solver.end=0.5")
    assert not len(of(r, SEPARATION))
    deep = (0.1 * G / 1e9) ** (2 / 3)
    assert r["ball.position"][-1, 1] == pytest.approx(0.02 - deep, abs=1e-9)


def test_what_does_not_bounce_rests_with_the_damping_of_the_slowest_impact():
    r = run(BALL, "contact_laws.hard.restitution=0", "solver.end=0.5")
    assert len(of(r, IMPACT)) == len(of(r, ONSET)) == 1
    late = r.t > sqrt(2.0 * 0.5 / G) + 0.1
    assert np.ptp(r["floor.normal_force"][late]) < 1e-3 * 0.1 * G
    assert r["energy.work.impacts"][-1] == pytest.approx(-0.1 * G * 0.5, rel=1e-4)


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha", "rk4"])
def test_every_method_that_locates_touches_has_them(method):
    sets = [f"solver.method={method}", "solver.end=0.5"]
    if method == "rk4":
        sets += ["solver.step=0.002", "solver.locate_events=true", "solver.force=true"]
    if method == "generalized_alpha":
        sets += ["solver.tolerance=1e-4"]  # at 1e-7 five million steps
    r = run(BALL, *sets)
    (hit,) = of(r, IMPACT)
    v_0 = sqrt(2.0 * G * 0.5)
    assert hit[SPEED] == pytest.approx(v_0, rel=1e-4)
    late = 0.5 - v_0 / G
    assert r["ball.position"][-1, 1] == pytest.approx(
        0.02 + 0.8 * v_0 * late - 0.5 * G * late**2, abs=1e-4
    )


@pytest.mark.parametrize("setting", ["solver.method=scipy:RK45", "solver.locate_events=false"])
def test_methods_that_locate_no_touch_are_refused(setting):
    with pytest.raises(ScenarioError, match="touches that take no time"):
        run(BALL, setting)


ROW = """
bodies:
{bodies}
joints:
{joints}
forces:
{forces}
contact_laws: {{hard: {{normal: {law}, stiffness: 1e9, restitution: {e}, slowest_impact: 1e-6}}}}
solver: {{end: 0.1}}
"""


def row_of_balls(law, e, gap=0.0, order="abc", turned=False, x=0.0):
    """Velocities of three equal balls in a row, the first at 1 m/s, after all has come to pass."""
    places = {name: x + k * (0.02 + gap) for k, name in enumerate("abc")}
    places["a"] -= 0.01
    bodies = "\n".join(
        f"  {n}: {{mass: 1, inertia: 1e-4, at: [{places[n]}, 0], "
        f"velocity: [{float(n == 'a')}, 0]}}" for n in order)  # fmt: skip
    joints = "\n".join(
        f"  of_{n}: {{type: prismatic, bodies: [ground, {n}], at: [{places[n]}, 0], "
        "axis: [1, 0, 0]}" for n in order)  # fmt: skip
    forces = "\n".join(
        f"  {i}{j}: {{type: surface_contact, surface: {{body: {i}, shape: sphere, radius: 0.01, "
        f"at: [{places[i]}, 0]}}, ball: {{body: {j}, radius: 0.01, at: [{places[j]}, 0]}}}}"
        for i, j in (("bc", "ab") if turned else ("ab", "bc"))
    )
    r = run(ROW.format(bodies=bodies, joints=joints, forces=forces, law=law, e=e))
    return [float(r[f"{n}.velocity"][-1, 0]) for n in "abc"]


@pytest.mark.parametrize("law", ["newton", "poisson"])
@pytest.mark.parametrize("turned, order, x", [(False, "abc", 0.0), (True, "cba", 0.0),
                                              (False, "bca", -70.0)])  # fmt: skip
def test_three_equal_balls_hand_on_their_speed(law, turned, order, x):
    v = row_of_balls(law, 1.0, order=order, turned=turned, x=x)
    assert v == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)


def test_three_balls_with_a_loss_hit_again():
    # one after the other, by hand: a on b, b on c, and again while one is faster than the next
    v, e = [1.0, 0.0, 0.0], 0.5
    for _ in range(200):
        most, k = max((v[k] - v[k + 1], -k) for k in range(2))
        if most <= 1e-6:
            break
        k, mean = -k, 0.5 * (v[-k] + v[1 - k])
        v[k], v[k + 1] = mean - 0.5 * e * most, mean + 0.5 * e * most
    apart = row_of_balls("newton", e)
    assert apart == pytest.approx(v, abs=1e-6)
    assert sum(apart) == pytest.approx(1.0, abs=1e-9)


def test_balls_that_are_apart_do_as_those_that_touch():
    assert row_of_balls("newton", 1.0, gap=1e-3) == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)


STACK = """
bodies:
  low: {mass: 0.2, inertia: 1e-5, at: [0, 0.01]}
  high: {mass: 0.2, inertia: 1e-5, at: [0, 0.0605], velocity: [0, -1]}
joints:
  l: {type: prismatic, bodies: [ground, low], at: [0, 0.01], axis: [0, 1, 0]}
  h: {type: prismatic, bodies: [ground, high], at: [0, 0.0605], axis: [0, 1, 0]}
forces:
  floor: {type: surface_contact, surface: {body: ground, shape: plane},
          ball: {body: low, at: [0, 0.01], radius: 0.01}}
  meet: {type: surface_contact, surface: {body: low, at: [0, 0.01], shape: sphere, radius: 0.01},
         ball: {body: high, at: [0, 0.0605], radius: 0.01}}
contact_laws: {hard: {normal: newton, stiffness: 1e8, restitution: 1, slowest_impact: 1e-3}}
gravity: [0, -9.81, 0]
solver: {end: 0.06}
"""


def test_a_ball_at_rest_on_the_floor_hands_a_blow_on_to_it():
    r = run(STACK)
    names = [r.mechanism.instances[int(k)].name for k in of(r, IMPACT)[:, 2]]
    after = names[names.index("meet") :]
    assert after == ["meet", "floor", "meet"]
    v = sqrt(1.0 + 2.0 * G * (0.0605 - 0.03))
    assert of(r, SEPARATION)[-1, SPEED] == pytest.approx(-v, rel=1e-4)
    assert abs(r["low.velocity"][-1, 1]) < 1e-3
    assert lost(r) < 1e-6


PENDULUM = """
planar: {planar}
bodies:
  rod: {{mass: 2, inertia: {inertia}, at: [{x}, 0.4, 0], velocity: [{along}, 0, 0],
        angular_velocity: [0, 0, {spin}]}}
joints:
  hinge: {{type: revolute, bodies: {pair}, at: [{x}, 0, 0]}}
forces:
  stop: {stop}
contact_laws: {{hard: {{normal: newton, stiffness: 1e7, restitution: 0.5, slowest_impact: 1e-4}}}}
solver: {{end: 0.2}}
"""
HIT, START = 0.6, 0.05  # m, where it is hit; rad, before it


def at_stop(way):
    """The stop of a pendulum that hangs upwards, which it meets after a turn by START."""
    u = np.array((-sin(START), cos(START)))  # where the rod points then
    n = np.array((cos(START), sin(START)))
    place = HIT * u
    if "angle" in way:
        end = f"upper: {START}" if way == "angle" else f"lower: {-START}"
        return (
            f"{{type: limit_stop, joint: hinge, {end}, stiffness: 1e6, damping: 1e3, "
            "restitution: 0.5, slowest_impact: 1e-4}"
        )
    if way == "wall":
        return (
            f"{{type: limit_stop, point: {{body: rod, at: [0, {HIT}]}}, stiffness: 1e6, "
            f"wall: {{body: ground, at: {place.tolist()}, normal: {n.tolist()}}}, damping: 1e3, "
            "restitution: 0.5, slowest_impact: 1e-4}"
        )
    side = [float(n[1]), float(-n[0])]
    return (
        f"{{type: surface_contact, ball: {{body: rod, at: [0, {HIT}]}}, "
        f"surface: {{body: ground, at: {place.tolist()}, x_axis: {side}, y_axis: {n.tolist()}}}}}"
    )


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("way, pair, x", [
    ("angle", "[ground, rod]", 0.0), ("turned angle", "[rod, ground]", 0.0),
    ("wall", "[ground, rod]", 0.0), ("wall", "[rod, ground]", 0.0),
    ("surface", "[ground, rod]", 0.0), ("surface", "[rod, ground]", 0.0),
])  # fmt: skip
def test_a_pendulum_hits_a_stop(way, planar, pair, x):
    spin, I_c, c = 3.0, 0.05, 0.4
    inertia = I_c if planar == "true" else [0.01, 0.02, I_c]
    text = PENDULUM.format(planar=planar, pair=pair, x=x, spin=spin, along=-0.4 * spin,
                           inertia=inertia,
                           stop=at_stop(way))  # fmt: skip
    r = run(text)
    I_o = I_c + 2.0 * c * c
    (hit,) = of(r, IMPACT)
    assert hit[TIME] == pytest.approx(START / spin, rel=1e-6)
    lever = 1.0 if "angle" in way else HIT
    p = I_o * 1.5 * spin / lever
    assert hit[IMPULSE] == pytest.approx(p, rel=1e-7)
    assert r["rod.angular_velocity"][-1, 2] == pytest.approx(-0.5 * spin, rel=1e-7)
    assert hit[WORK] == pytest.approx(-0.5 * I_o * spin**2 * 0.75, rel=1e-7)
    # of the hinge: what is left of the change of momentum, along the way of the centre of mass
    names = [*r.mechanism.stages.every]
    of_hinge = [line for line in r.impulses if line[2] < len(names) and line[3] == 1]
    force = np.sum([line[5:8] for line in of_hinge], axis=0)
    pushes = 0.0 if "angle" in way else p
    n = np.array((cos(START), sin(START), 0.0))
    assert force == pytest.approx((2.0 * c * 1.5 * spin - pushes) * n, abs=1e-6)
    assert lost(r) < 1e-7


def test_at_the_centre_of_percussion_the_hinge_feels_nothing():
    q = (0.05 + 2.0 * 0.4**2) / (2.0 * 0.4)
    stop = at_stop("wall").replace(f"[0, {HIT}]", f"[0, {q}]")
    here = (HIT * np.array((-sin(START), cos(START)))).tolist()
    there = (q * np.array((-sin(START), cos(START)))).tolist()
    stop = stop.replace(str(here), str(there))
    text = PENDULUM.format(planar="true", pair="[ground, rod]", x=0.0, spin=3.0, along=-1.2,
                           inertia=0.05, stop=stop)  # fmt: skip
    r = run(text)
    (hit,) = of(r, IMPACT)
    of_hinge = [line for line in r.impulses if line[2] < len(r.mechanism.stages.every)]
    assert max(np.abs(line[5:8]).max() for line in of_hinge) < 1e-8 * hit[IMPULSE]


def test_impulses_are_the_change_of_momentum_of_every_body():
    r = run(PENDULUM.format(planar="false", pair="[ground, rod]", x=0.0, spin=3.0, along=-1.2,
                            inertia=[0.01, 0.02, 0.05], stop=at_stop("surface")))  # fmt: skip
    (jump,) = r.jumps
    on_rod = np.sum([line[5:11] for line in r.impulses if line[3] == 1], axis=0)
    assert 2.0 * (jump[6:9] - jump[3:6]) == pytest.approx(on_rod[:3], abs=1e-10)
    turn = np.diag((0.01, 0.02, 0.05)) @ (jump[12:15] - jump[9:12])
    assert turn == pytest.approx(on_rod[3:], abs=1e-10)


CARRIER = """
bodies:
  wall: {mass: 5, inertia: 1, at: [0, 0]}
  ball: {mass: 0.3, inertia: 1e-4, at: [0.06, 0], velocity: [-2, 0]}
joints:
  rail: {type: prismatic, bodies: [ground, wall], at: [0, 0], axis: [1, 0, 0]}
drives:
  push: {joint: rail, velocity: 0.5}
forces:
  meet: {type: surface_contact, surface: {body: wall, x_axis: [0, 1, 0], y_axis: [1, 0, 0]},
         ball: {body: ball, at: [0.06, 0], radius: 0.01}}
contact_laws: {hard: {normal: poisson, stiffness: 1e7, restitution: 0.7}}
solver: {end: 0.1}
"""


def test_a_wall_that_is_driven_goes_on_and_its_work_is_booked():
    r = run(CARRIER)
    v = 0.5 + 0.7 * 2.5
    assert r["ball.velocity"][-1, 0] == pytest.approx(v, rel=1e-9)
    assert r["wall.velocity"][-1, 0] == pytest.approx(0.5, rel=1e-9)
    p = 0.3 * 2.5 * 1.7
    assert r["energy.work.drives"][-1] == pytest.approx(0.5 * p, rel=1e-9)
    assert r["energy.work.impacts"][-1] == pytest.approx(-0.5 * 0.3 * 2.5**2 * 0.51, rel=1e-9)
    assert lost(r) < 1e-8


ROD = """
planar: {planar}
bodies:
  rod: {{mass: 0.5, inertia: {inertia}, at: {at}, velocity: {velocity}}}
forces:
  tip: {{type: surface_contact, ball: {{body: rod, at: {tip}}},
        surface: {{body: ground, at: [0, 0, 0], x_axis: {along}, y_axis: {up}}}}}
contact_laws:
  hard: {{normal: {rule}, stiffness: 1e7, restitution: {e}, slowest_impact: 1e-3,
         friction: {{law: coulomb, coefficient: {mu}}}}}
solver: {{end: 0.02}}
"""
LENGTH = 1.2


def falling_rod(rule, e, mu, angle, v, planar="true", up=(0, 1, 0), along=(1, 0, 0)):
    """A slender rod whose lower end is about to touch, at a velocity without spin, and its run."""
    up, along = np.array(up, float), np.array(along, float)
    c, s = 0.5 * LENGTH * cos(angle), 0.5 * LENGTH * sin(angle)
    at = c * along + (s + 1e-3) * up
    I = 0.5 * LENGTH**2 / 12.0
    inertia = I if planar == "true" else [I, I, I]
    return run(ROD.format(
        planar=planar, inertia=inertia, at=at.tolist(), tip=(1e-3 * up).tolist(), rule=rule, e=e,
        mu=mu, velocity=(v[0] * along + v[1] * up).tolist(), along=along.tolist(),
        up=up.tolist()))  # fmt: skip


@pytest.mark.parametrize("rule", ["newton", "poisson"])
@pytest.mark.parametrize("angle, mu, e", [(0.3, 0.2, 0.5), (0.9, 0.6, 1.0), (1.2, 1.0, 0.8),
                                          (0.7, 2.0, 1.0)])  # fmt: skip
@pytest.mark.parametrize("v_t", [-1.0, 0.4])
def test_a_slanted_rod_that_falls_gains_no_energy(rule, angle, mu, e, v_t):
    r = falling_rod(rule, e, mu, angle, (v_t, -1.0))
    energy = r["energy.kinetic"]
    assert np.all(np.diff(energy) <= 1e-9 * energy[0])
    assert len(of(r, IMPACT))
    assert lost(r) < 1e-8


@pytest.mark.parametrize("planar, up, along", [
    ("true", (0, 1, 0), (1, 0, 0)), ("false", (0, 1, 0), (1, 0, 0)),
    ("false", (0, 0, 1), (0, -1, 0)), ("false", (0.6, 0, 0.8), (0.8, 0, -0.6)),
])  # fmt: skip
def test_a_slanted_rod_in_any_attitude(planar, up, along):
    angle, mu, e = 0.9, 0.3, 0.6
    r = falling_rod("poisson", e, mu, angle, (0.5, -1.0), planar, up, along)
    I, m = 0.5 * LENGTH**2 / 12.0, 0.5
    x, y = -0.5 * LENGTH * cos(angle), -0.5 * LENGTH * sin(angle)
    here = np.zeros((3, 3))
    here[0, 0], here[1, 1] = 1 / m + x * x / I, 1 / m + y * y / I
    here[0, 1] = here[1, 0] = -x * y / I
    blow = impact(np.array((-1.0, 0.5, 0.0)), here, (mu, mu), e, "poisson")
    hit = of(r, IMPACT)[0]
    assert hit[IMPULSE] == pytest.approx(blow.impulse[0], rel=1e-7)
    up, along = np.array(up, float), np.array(along, float)
    gained = (blow.impulse[0] * up + blow.impulse[1] * along) / m
    v = r["rod.velocity"][-1] - (0.5 * along - up)
    assert v == pytest.approx(gained, abs=1e-7)


SPINNING = """
planar: {planar}
bodies:
  ball: {{mass: 0.2, inertia: {inertia}, at: [0, 0.03, 0], velocity: {velocity},
         angular_velocity: {spin}}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground, shape: plane}},
          ball: {{body: ball, at: [0, 0.03, 0], radius: 0.02}}}}
contact_laws:
  hard: {{normal: newton, stiffness: 1e6, restitution: 0.6,
         friction: {{law: modified_coulomb, coefficient: {mu}, v0: 1e-4, v1: 1e-3}}}}
solver: {{end: 0.02}}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("mu", [0.1, 1.5])
def test_a_ball_with_spin(planar, mu):
    """Sliding or sticking at the end of the impact: 2/7 of what it slides by is left of nothing."""
    I = 0.4 * 0.2 * 0.02**2
    flat = planar == "true"
    velocity = [1.0, -1.0, 0.0 if flat else 0.7]
    spin = [0.0, 0.0, 20.0] if flat else [10.0, 5.0, 20.0]
    r = run(SPINNING.format(planar=planar, inertia=I if flat else [I, I, I], velocity=velocity,
                            spin=spin, mu=mu))  # fmt: skip
    w, down = np.array(spin), np.array((0.0, -0.02, 0.0))
    slides = np.array(velocity) + np.cross(w, down)
    slides[1] = 0.0
    p = 0.2 * 1.6
    rub = min(mu * p, 0.2 * np.linalg.norm(slides) * 2 / 7)
    f = -rub * slides / np.linalg.norm(slides)
    assert r["ball.velocity"][-1] == pytest.approx(
        np.array((velocity[0], 0.6, velocity[2])) + f / 0.2, abs=1e-9
    )
    assert r["ball.angular_velocity"][-1] == pytest.approx(w + np.cross(down, f) / I, abs=1e-6)
    assert lost(r) < 1e-8


BLOCK = """
bodies:
  block: {mass: 1, inertia: 0.01, at: [0, 0.06], velocity: [0.3, 0]}
forces:
  left: {type: surface_contact, surface: {body: ground}, ball: {body: block, at: [-0.1, 0.03]}}
  right: {type: surface_contact, surface: {body: ground}, ball: {body: block, at: [0.1, 0.03]}}
contact_laws:
  hard: {normal: poisson, stiffness: 1e7, restitution: 0.5, slowest_impact: 1e-3,
         friction: {law: modified_coulomb, coefficient: 0.3, v0: 1e-4, v1: 1e-3}}
gravity: [0, -9.81, 0]
solver: {end: 0.6}
"""


def test_a_block_that_falls_flat_comes_to_rest_on_both_its_points():
    r = run(BLOCK)
    assert r["left.normal_force"][-1] + r["right.normal_force"][-1] == pytest.approx(G, rel=1e-3)
    deep = (0.5 * G / 1e7) ** (2 / 3)
    assert r["block.position"][-1, 1] == pytest.approx(0.03 - deep, abs=1e-6)
    energy = r["energy.kinetic"] + r["energy.stored.gravity"] + r["energy.stored.contacts"]
    assert np.all(np.diff(energy) <= 1e-6)
    assert lost(r) < 1e-6


def test_what_nothing_gives_way_to_fails_and_says_so():
    text = CARRIER.replace("  push:", "  own: {joint: other, velocity: -2}\n  push:").replace(
        "drives:", "  other: {type: prismatic, bodies: [ground, ball], at: [0.06, 0], "
        "axis: [1, 0, 0]}\n  turn: {type: parallel, bodies: [ground, ball], axis: [1, 0, 0]}\n"
        "drives:").replace("  turn: {type: parallel, bodies: [ground, ball], axis: [1, 0, 0]}\n",
                           "")  # fmt: skip
    r = run(text, fails=True)
    assert "forces.meet" in r.outcome.reason
    assert "gives way" in r.outcome.reason


def test_a_lock_that_stops_what_rests_on_the_floor_is_no_impact_and_one_that_throws_it_is():
    text = STACK.replace("high: {mass: 0.2, inertia: 1e-5, at: [0, 0.0605], velocity: [0, -1]}",
                         "high: {mass: 0.2, inertia: 1e-5, at: [0, 0.0605]}")  # fmt: skip
    r = run(text + "events: {now: {when: t, value: 0.02, do: {lock: [h]}}}\n")
    assert [r.mechanism.instances[int(k)].name for k in of(r, IMPACT)[:, 2]] == ["floor"] * len(
        of(r, IMPACT)
    )


JOURNAL = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  pin: {type: revolute, bodies: [ground, rod], at: [0, 0], clearance: 0.1 mm}
contact_laws:
  steel: {normal: newton, bearing_radius: 10 mm, youngs_modulus: 207 GPa, poisson: 0.3,
          restitution: 0.9}
solver: {end: 0.02 s}
"""


def test_no_journal_has_them():
    with pytest.raises(ScenarioError, match="of the touches of a journal"):
        built(JOURNAL)


@pytest.mark.parametrize("given, said", [
    ("restitution: 0.5", "damping"), ("slowest_impact: 1e-3", "restitution"),
])  # fmt: skip
def test_a_stop_says_what_goes_with_a_restitution(given, said):
    text = PENDULUM.format(
        planar="true", pair="[ground, rod]", x=0.0, spin=1.0, along=-0.4, inertia=0.05,
        stop=f"{{type: limit_stop, joint: hinge, upper: 0.1, stiffness: 1e6, {given}}}",
    )  # fmt: skip
    with pytest.raises(ScenarioError, match=said):
        built(text)


def test_lines_of_an_instant_stand_in_their_order():
    r = run(BALL, "solver.end=1.5")
    kinds = r.events[np.isin(r.events[:, KIND], (ONSET, IMPACT, SEPARATION)), KIND].tolist()
    assert kinds[:6] == [ONSET, IMPACT, SEPARATION] * 2
    assert all(a <= b for a, b in pairwise(r.events[:, TIME]))


MEET = """
planar: false
bodies:
  a: {{mass: 0.3, inertia: [2e-4, 3e-4, 4e-4], at: {a}, velocity: {v_a}, angular_velocity: {w_a}}}
  b: {{mass: 0.1, inertia: [3e-5, 2e-5, 4e-5], at: {b}, velocity: {v_b}, angular_velocity: {w_b}}}
forces:
  meet: {{type: surface_contact, surface: {{body: a, shape: sphere, radius: 0.012, at: {s}}},
         ball: {{body: b, radius: 0.008, at: {c}}}}}
contact_laws:
  hard: {{normal: {rule}, stiffness: 1e9, restitution: 0.6, slowest_impact: 1e-3,
         friction: {{law: coulomb, coefficient: {mu}}}}}
output: {{channels: ["*", "*.rotation"]}}
solver: {{end: 0.03, tolerance: 1e-9}}
"""


@pytest.mark.parametrize("rule", ["newton", "poisson"])
@pytest.mark.parametrize("mu", [0.0, 0.2, 2.0])
@pytest.mark.parametrize("seed", range(3))
def test_two_bodies_in_space_keep_their_momenta(rule, mu, seed):
    """Off their centres of mass, any way round, far from the origin; what slides is turned."""
    rng = np.random.default_rng(seed)
    n, far = rng.normal(size=3), 30.0 * rng.normal(size=3)
    n /= np.linalg.norm(n)
    s, c = far, far + 0.022 * n
    a, b = s + 0.01 * rng.normal(size=3), c + 0.006 * rng.normal(size=3)
    v_a, v_b = n + 0.4 * rng.normal(size=3), -n + 0.4 * rng.normal(size=3)
    w_a, w_b = 5.0 * rng.normal(size=3), 5.0 * rng.normal(size=3)
    given = {"a": a, "b": b, "s": s, "c": c, "v_a": v_a, "v_b": v_b, "w_a": w_a, "w_b": w_b}
    r = run(MEET.format(rule=rule, mu=mu, **{k: v.tolist() for k, v in given.items()}))
    assert len(of(r, IMPACT)) == 1
    jump = {int(line[2]): line for line in r.jumps}
    lost_momentum, lost_turn, size = np.zeros(3), np.zeros(3), 0.0
    for f, name, m, I in ((1, "a", 0.3, (2e-4, 3e-4, 4e-4)), (2, "b", 0.1, (3e-5, 2e-5, 4e-5))):
        before, line = np.argmax(r.t > jump[f][0]) - 1, jump[f]
        R = r[f"{name}.rotation"][before].reshape(3, 3)
        x = r[f"{name}.position"][before] + (line[0] - r.t[before]) * line[3:6] - far
        p = m * (line[6:9] - line[3:6])
        lost_momentum += p
        w = line[12:15] - line[9:12]
        lost_turn += np.cross(x, p) + R @ np.diag(I) @ R.T @ w
        size = max(size, np.linalg.norm(p))
    assert lost_momentum == pytest.approx(np.zeros(3), abs=1e-12 * 30.0)
    assert lost_turn == pytest.approx(np.zeros(3), abs=1e-5 * size)
    hit = of(r, IMPACT)[0]
    if mu == 0.0:
        assert of(r, SEPARATION)[0, SPEED] == pytest.approx(-0.6 * hit[SPEED], rel=1e-9)
    assert r["energy.kinetic"][-1] < r["energy.kinetic"][0]
    assert r["energy.kinetic"][-1] - r["energy.kinetic"][0] == pytest.approx(hit[WORK], rel=1e-6)
    assert lost(r) < 1e-8


LOOP = """
planar: {planar}
bodies:
  crank: {{mass: 2, inertia: {I}, at: [0.05, 0.1, 0]}}
  rod: {{mass: 3, inertia: {I}, at: [0.3, 0.2, 0]}}
  arm: {{mass: 4, inertia: {I}, at: [0.55, 0.1, 0]}}
joints:
  O: {{type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: [0, 0, 1]}}
  A: {{type: revolute, bodies: [crank, rod], at: [0.1, 0.2, 0], axis: [0, 0, 1]}}
  B: {{type: revolute, bodies: [rod, arm], at: [0.5, 0.2, 0], axis: [0, 0, 1]}}
  C: {{type: revolute, bodies: [ground, arm], at: [0.6, 0, 0], axis: [0, 0, 1]}}
forces:
  stop: {{type: limit_stop, joint: O, upper: 0.1, stiffness: 1e6, damping: 1e3, restitution: 0.4,
         slowest_impact: 1e-3}}
initial: {{O.rate: 5 rad/s}}
solver: {{end: 0.05, tolerance: 1e-9}}
"""


@pytest.mark.parametrize("planar, I", [("true", 0.03), ("false", [0.01, 0.02, 0.03])])
def test_a_loop_at_a_stop_turns_back_as_one(planar, I):
    """All rates of a loop with one motion turn round by e, whatever rows were left out."""
    r = run(LOOP.format(planar=planar, I=I))
    (hit,) = of(r, IMPACT)
    for line in r.jumps:
        assert line[6:9] == pytest.approx(-0.4 * line[3:6], abs=1e-9)
        assert line[12:15] == pytest.approx(-0.4 * line[9:12], abs=1e-9)
        m = {1: 2.0, 2: 3.0, 3: 4.0}[int(line[2])]
        on = np.sum([one[5:8] for one in r.impulses if one[3] == line[2]], axis=0)
        assert m * (line[6:9] - line[3:6]) == pytest.approx(on, abs=1e-9)
    energy = r["energy.kinetic"]
    assert hit[WORK] == pytest.approx(-(1 - 0.16) * energy[0], rel=1e-6)
    assert energy[-1] == pytest.approx(0.16 * energy[0], rel=1e-6)


def test_no_node_of_a_flexible_bar_is_struck():
    text = """
bodies:
  bar: {type: ancf_cable, start: [0, 0.5], end: [1, 0.5], section: {diameter: 20 mm},
        density: 7800, youngs_modulus: 2e9, elements: 4}
forces:
  floor: {type: surface_contact, surface: {body: ground, shape: plane},
          ball: {body: bar, at: [1, 0.5]}}
contact_laws: {hard: {normal: newton, stiffness: 1e6, restitution: 0.5}}
gravity: [0, -9.81, 0]
solver: {end: 0.1}
"""
    with pytest.raises(ModelError, match="one node of a flexible bar"):
        built(text)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_losses_of_a_contact_are_those_of_its_impacts_too(planar):
    """A ball thrown along the floor: its contact has taken what the books say, row by row."""
    text = BALL.replace(
        "inertia: 1.6e-5", "inertia: [1.6e-5, 1.6e-5, 1.6e-5], velocity: [0.5, 0, 0]"
    )
    text = text.replace(
        "slowest_impact: 1e-4",
        "slowest_impact: 1e-4, "
        "friction: {law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1e-3}",
    )
    r = run(f"planar: {planar}\n{text}output: {{channels: ['*', 'floor.*']}}\n")
    for loss, book in (("damping_loss", "impacts"), ("friction_loss", "friction")):
        taken, booked = r[f"floor.{loss}"], -r[f"energy.work.{book}"]
        assert booked[-1] > 1e-3
        assert taken == pytest.approx(booked, abs=1e-12)
