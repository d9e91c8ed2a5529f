"""Starts: static equilibrium, places away from the drawing, consistent velocities."""

import numpy as np
import pytest

from trsim.errors import ModelError
from trsim.scenario.load import load
from trsim.solve.start import statics
from trsim.solve.start.consistent import start
from trsim.solve.start.statics import static_forces

from ..linkages import REVERSER, four_bar, slider_crank
from ..overconstrained import ORDINARY, TILTED, numbers
from ..runs import assemble, run

HANGING = """
planar: {}
gravity: [0, -9.81, 0]
bodies: {{rod: {{mass: 2, inertia: [0.1, 0.1, 0.05], at: [0.4, 0.1]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
{}
initial: {{equilibrium: [hinge]}}
solver: {{end: 0.1}}
"""


def begun(name, *sets):
    scenario = load(REVERSER / f"{name}.yaml", sets)
    mechanism = assemble(scenario)
    return mechanism, start(scenario, mechanism, located=True)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_pendulum_finds_its_way_down(planar):
    r = run(HANGING.format(planar, ""))
    down = [0, -np.hypot(0.4, 0.1), 0]
    assert r["rod.position"] == pytest.approx(np.tile(down, (len(r.t), 1)), abs=1e-9)
    assert r["hinge.reaction"][0] == pytest.approx([0, 2 * 9.81, 0], abs=1e-9)


def test_sagging_spring():
    """k x = m g R on a drum: the angle of the equilibrium is exact."""
    spring = "forces: {coil: {type: torsion_spring, joint: hinge, stiffness: 40}}"
    r = run(HANGING.format("true", spring) + "sensors: {sag: {joint: hinge}}\n")
    angle = r["sag"][0]
    moment = 2 * 9.81 * (0.4 * np.cos(angle) - 0.1 * np.sin(angle))
    assert -40 * angle == pytest.approx(moment, rel=1e-9)
    assert r["sag"][-1] == pytest.approx(angle, abs=1e-9)


@pytest.mark.parametrize("name", ["ideal", "clearance_b_0.3mm"])
def test_door_rests_on_its_seat(name):
    r = run(load(REVERSER / f"{name}.yaml", ["solver.end=1 ms"]))
    assert r["seat.penetration"][0] == pytest.approx(2.56e-5, rel=5e-3)
    # preload over the arm of the seat
    assert r["seat.normal_force"][0] == pytest.approx(5 / 0.195, rel=2e-3)


def test_stow_starts_open():
    r = run(load(REVERSER / "stow.yaml", ["solver.end=1 ms"]))
    assert r.outcome.statistics["start_force_residual"] < 1e-6
    assert np.degrees(r["door_angle"][0]) == pytest.approx(92.8, abs=0.1)
    assert r["stroke"][0] == pytest.approx(0.5, abs=1e-12)
    assert r["stroke.rate"][0] == pytest.approx(-0.5, abs=1e-12)
    # 775 N hold the gas back at 0.5 m of stroke; slowly moving it is nearly static
    assert r["actuator.force"][0] == pytest.approx(775, rel=0.05)


def test_forces_balance_on_the_joints():
    """The static wrenches of the start do no work on any motion the joints allow."""
    from trsim.assemble.reduce import jacobian

    mechanism, s = begun("ideal")
    J = jacobian(mechanism.model, 0.0, s.y)[2]
    F = static_forces(mechanism.model, s.y)
    inside = np.tile([True, True, False, False, False, True], mechanism.model.n - 1)
    lam = np.linalg.lstsq(J.T[inside], F[inside], rcond=None)[0]
    assert np.abs(F[inside] - J.T[inside] @ lam).max() < 1e-9 * np.abs(F).max()
    assert np.abs(F).max() > 20


def test_indifferent_equilibrium_is_refused():
    text = HANGING.replace("gravity: [0, -9.81, 0]", "").format("true", "")
    with pytest.raises(ModelError) as caught:
        run(text)
    assert caught.value.exit_code == 4
    assert caught.value.path == ("initial", "equilibrium")
    assert "'rod'" in str(caught.value)


UPRIGHT = """
planar: {planar}
gravity: [0, -9.81, 0]
bodies: {{rod: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, {at}, 0]}}{bodies}}}
joints: {{A: {{type: revolute, bodies: [ground, rod], at: [0, 0, 0]}}{joints}}}
initial: {{equilibrium: all}}
solver: {{end: 0.1}}
"""
BESIDE = ", two: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [3, %s, 0]}"
ON_TOP = ", two: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, %s, 0]}"
SECOND = ", B: {type: revolute, bodies: [%s, two], at: [%s, 0]}"
TOGGLE = SECOND % ("rod", "0, 1") + ", C: {type: revolute, bodies: [two, slide], at: [0, 2, 0]}"
TOGGLE += ", D: {type: prismatic, bodies: [ground, slide], axis: [0, 1, 0]}"
SLIDE = ", slide: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 2, 0]}"
SPRING = "forces: {{c: {{type: torsion_spring, joint: A, stiffness: {}}}}}\n"
BOTH = pytest.mark.parametrize("planar", ["true", "false"])


@BOTH
@pytest.mark.parametrize(
    ("at", "bodies", "joints", "more", "who"),
    [
        (0.5, "", "", "", "rod"),
        (-0.5, "", "", "", None),
        # k > m g l holds it
        (0.5, "", "", SPRING.format(4.90), "rod"),
        (0.5, "", "", SPRING.format(4.91), None),
        # both stand upright alike: either is a right answer
        (0.5, BESIDE % 0.5, SECOND % ("ground", "3, 0"), "", "rod two"),
        (-0.5, BESIDE % 0.5, SECOND % ("ground", "3, 0"), "", "two"),
        (-0.5, BESIDE % -0.5, SECOND % ("ground", "3, 0"), "", None),
        (0.5, ON_TOP % 1.5, SECOND % ("rod", "0, 1"), "", "rod two"),
        (0.5, ON_TOP % 0.5, SECOND % ("rod", "0, 1"), "", "rod"),
        (-0.5, ON_TOP % -1.5, SECOND % ("rod", "0, -1"), "", None),
        # two links in line under a weight: the knee goes aside
        (0.5, ON_TOP % 1.5 + SLIDE, TOGGLE, "", "rod two"),
        (0.5, ON_TOP % 1.5 + SLIDE, TOGGLE, SPRING.format(1000), None),
    ],
)
def test_in_balance_is_not_enough(planar, at, bodies, joints, more, who):
    text = UPRIGHT.format(planar=planar, at=at, bodies=bodies, joints=joints) + more
    if who is None:
        r = run(text)
        assert r["rod.position"][0] == pytest.approx([0, at, 0], abs=1e-9)
        return
    with pytest.raises(ModelError, match="in balance but not stable") as caught:
        run(text)
    assert caught.value.exit_code == 4 and caught.value.path == ("initial", "equilibrium")
    assert any(f"'{one}'" in caught.value.what for one in who.split())


def test_a_flexible_rod_on_its_tip_is_not_stable_either():
    text = """
bodies: {rod: {type: ancf_cable, start: [0, 0, 0], end: [0, 1, 0], section: {diameter: 20 mm},
               youngs_modulus: 2e11, density: 7800}}
joints: {A: {type: revolute, bodies: [ground, rod], at: [0, 0, 0]}}
gravity: [0, -9.81, 0]
initial: {equilibrium: all}
solver: {end: 1 ms}
"""
    with pytest.raises(ModelError, match="in balance but not stable"):
        run(text)
    r = run(text.replace("end: [0, 1, 0]", "end: [0, -1, 0]"))
    assert r["rod.tip"][0, :2] == pytest.approx([0, -1], abs=1e-5)


def test_a_hair_beside_the_top_falls():
    r = run(UPRIGHT.format(planar="true", at=0.5, bodies="", joints="").replace(
        "[0, 0.5, 0]", "[1e-6, 0.5, 0]"))  # fmt: skip
    assert r["rod.position"][0] == pytest.approx([0, -0.5, 0], abs=1e-6)


def test_a_search_that_does_not_move_is_given_up(monkeypatch):
    """A pivot at 10^9 m: the steps of a journal in its clearance are below the rounding there."""
    seen, balance = [], statics.balance
    monkeypatch.setattr(statics, "balance", lambda *given: seen.append(0) or balance(*given))
    with pytest.raises(ModelError, match="no static equilibrium") as caught:
        begun("clearance_ab_0.3mm", "joints.Q.at.1=1e9")
    assert caught.value.path == ("initial", "equilibrium")
    assert len(seen) < 60


def test_initial_value_moves_the_linkage_on_its_branch():
    r = run(four_bar("true", "initial: {A: 100 deg}\nsensors: {turn: {joint: A}}"))
    assert r["turn"][0] == pytest.approx(np.radians(100), abs=1e-9)
    pin = [-np.sin(np.radians(100)), np.cos(np.radians(100)), 0]
    assert r["crank.position"][0] == pytest.approx(np.multiply(pin, 0.5), abs=1e-9)
    assert r["rocker.position"][0, 1] > -1  # not the other assembly of the loop


def test_more_than_a_turn():
    r = run(HANGING.replace("initial: {{equilibrium: [hinge]}}", "initial: {{hinge: 400 deg}}")
            .format("true", "sensors: {turn: {joint: hinge}}"))  # fmt: skip
    assert r["turn"][0] == pytest.approx(np.radians(400), abs=1e-9)


def test_velocities_are_those_of_the_ideal_mechanism():
    """The journals of a slider-crank move with their bearings at the start."""
    more = """drives: {motor: {joint: A, velocity: 5}}
contact_laws: {law: {normal: flores, stiffness: 1e9, bearing_radius: 0.1, restitution: 0.9}}"""
    playing = run(
        slider_crank("true", more, end=1e-4), "joints.B.clearance=1mm", "joints.C.clearance=1mm"
    )
    ideal = run(slider_crank("true", more, end=1e-4))
    for name in ("rod.velocity", "slider.velocity", "rod.angular_velocity"):
        assert playing[name][0] == pytest.approx(ideal[name][0], abs=1e-9)


def test_journal_falls_to_the_bottom_of_its_bearing():
    """K depth^1.5 = m g: across a clearance in which nothing holds it."""
    text = """
gravity: [9.81, 0]
bodies: {slider: {mass: 2, inertia: 1}}
joints:
  slide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}
  pin: {type: revolute, bodies: [ground, slider], at: [0, 0], clearance: 1 mm, contact: law}
contact_laws:
  law: {normal: hunt_crossley, stiffness: 1e9, bearing_radius: 0.1, restitution: 0.5}
initial: {equilibrium: [pin]}
solver: {end: 0.01}
"""
    r = run(text)
    assert r["pin.penetration"][0] == pytest.approx((2 * 9.81 / 1e9) ** (2 / 3), rel=1e-9)
    assert len(r.events) == 0
    assert np.ptp(r["slider.position"][:, 0]) < 1e-12


def test_a_compliant_drive_starts_at_its_speed():
    """No jerk at the start: the slide moves at the drive's speed and the spring is at rest."""
    r = run("""
bodies: {slide: {mass: 50, inertia: 1}}
joints: {guide: {type: prismatic, bodies: [ground, slide], axis: [1, 0]}}
drives:
  cylinder: {joint: guide, velocity: 0.5, compliance: {stiffness: 1e7, damping_ratio: 0.1}}
solver: {end: 0.1, tolerance: 1e-9}
""")
    assert r["slide.velocity"][:, 0] == pytest.approx(0.5, abs=1e-9)
    assert r["cylinder.force"] == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize("more", [(), ("joints.B.clearance=0.01mm",),
                                  ("contact_laws.pin.youngs_modulus=2e14",)])  # fmt: skip
def test_a_stroke_is_reached_with_clearance(more, monkeypatch):
    """Far from the drawing, in balance, in a few hundred looks: it goes there by ideal joints."""
    seen, balance = [], statics.balance
    monkeypatch.setattr(statics, "balance", lambda *given: seen.append(0) or balance(*given))
    mechanism, s = begun("clearance_b_0.3mm", "initial.guide=0.1", *more)
    assert s.residual < 1e-3  # N: what the rounding of a position is to the stiffest contact
    assert len(seen) < 600
    x = mechanism.coordinates["guide"]
    assert mechanism.model.n > 0 and s.branch[x.entry] == pytest.approx(0.1, abs=1e-9)


@pytest.mark.parametrize(
    "drive",
    [
        "{joint: guide, velocity: 0.5, compliance: {stiffness: 1e6, damping: 2e3}}",
        "{type: actuator, bodies: [ground, slider], points: [[-1, 0], [0.11, 0]], velocity: 0.5, "
        "stiffness: 1e6, damping: 2e3}",
        "{type: actuator, bodies: [ground, slider], points: [[-1, 0], [0.11, 0]], velocity: 0.5, "
        "stiffness: 1e6, damping: 2e3, supply: {stiffness: 1e6, damping: 2e3, mass: 1}}",
    ],
)
def test_dampers_of_drives_do_not_push_an_equilibrium(drive):
    """2 kN s/m at 0.5 m/s would move it by a millimetre."""
    text = f"""
bodies: {{slider: {{mass: 1, inertia: 0.01, at: [0.11, 0]}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
drives: {{motor: {drive}}}
initial: {{equilibrium: [guide]}}
solver: {{end: 1 ms}}
"""
    there = run(text)
    assert there["slider.position"][0] == pytest.approx([0.11, 0.0, 0.0], abs=1e-12)
    assert there["slider.velocity"][0, 0] == pytest.approx(0.5)


def test_what_bushings_hold_starts_at_rest():
    """A sled on a rail that gives way: its links alone would have it start across the rail."""
    text = """
bodies:
  sled: {mass: 5, inertia: 0.1, at: [0, 0]}
  link: {mass: 2, inertia: 0.02, at: [0.1, 0.1]}
  crank: {mass: 2, inertia: 0.02, at: [0.2, 0.1]}
joints:
  pin: {type: revolute, bodies: [sled, link], at: [0, 0]}
  knee: {type: revolute, bodies: [link, crank], at: [0.2, 0.2]}
  end: {type: revolute, bodies: [ground, crank], at: [0.2, 0]}
drives:
  jack: {type: actuator, bodies: [ground, sled], points: [[-1, 0], [0, 0]], velocity: 0.5,
         stiffness: 1e6}
forces:
  rail: {type: bushing, bodies: [ground, sled], at: [0, 0], stiffness: [0, RAIL, 0],
         rotational_stiffness: [0, 0, 1e4]}
solver: {end: 1 ms}
"""
    free, held = (run(text.replace("RAIL", k))["sled.velocity"][0] for k in ("0", "1e6"))
    assert held == pytest.approx([0.5, 0.0, 0.0], abs=1e-12)
    assert free[0] == pytest.approx(0.5)
    assert abs(free[1]) > 0.01


@pytest.mark.parametrize("place", [-5.0, 3.2, 8.0])
@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_drive_holds_a_joint_on_any_turn(planar, place):
    r = run(f"""
planar: {planar}
bodies: {{arm: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.2, 0]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, arm], at: [0, 0]}}}}
drives: {{motor: {{joint: hinge, position: "{place} + 3*t"}}}}
sensors: {{angle: {{joint: hinge}}}}
solver: {{end: 4}}
""")
    turned = place + 3 * r.t
    assert r["angle"] == pytest.approx(turned, abs=1e-7)
    way = 0.2 * np.column_stack([np.cos(turned), np.sin(turned)])
    assert r["arm.position"][:, :2] == pytest.approx(way, abs=1e-7)


COPIES = [(ORDINARY, "true"), (ORDINARY, "false"), (TILTED, "false")]
IN_ALL_COPIES = pytest.mark.parametrize(("R", "planar"), COPIES, ids=["plane", "space", "tilted"])


def two_rods(R, planar, more="", out=0.5):
    """A double pendulum of unequal rods, its bodies given velocities that its hinges forbid.

    out: moments of inertia of the rods about other axes than that of the hinges.
    """

    def rod(name, mass, inertia, at, v, omega):
        I = R @ np.diag([out, 2.0 * out, inertia]) @ R.T
        I = numbers([*np.diag(I), I[0, 1], I[0, 2], I[1, 2]])
        at, v, omega = (numbers(R @ np.array(x, float)) for x in (at, v, (0, 0, omega)))
        return (
            f"  {name}: {{mass: {mass}, inertia: {I if planar == 'false' else inertia}, at: {at}, "
            f"velocity: {v}, angular_velocity: {omega}}}\n"
        )

    axis, knee = (numbers(R @ np.array(x, float)) for x in ((0, 0, 1), (1, 0, 0)))
    return (
        f"planar: {planar}\nbodies:\n"
        + rod("upper", 3.0, 0.02, (0.5, 0, 0), (0.3, -0.4, 0), 5.0)
        + rod("lower", 0.2, 0.7, (1, 0.5, 0), (0, 1, 0), -2.0)
        + "joints:\n"
        f"  top: {{type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: {axis}}}\n"
        f"  knee: {{type: revolute, bodies: [upper, lower], at: {knee}, axis: {axis}}}\n"
        f"sensors: {{a: {{joint: top}}, b: {{joint: knee}}}}\n{more}\nsolver: {{end: 0.01}}\n"
    )


@pytest.mark.parametrize("out", [1e-3, 0.5, 40.0])
@IN_ALL_COPIES
def test_velocities_are_the_nearest_in_the_metric_of_the_masses(R, planar, out):
    """What no joint allows is a plastic impact: the motions allowed keep their momentum."""
    r = run(two_rods(R, planar, out=out))
    M = np.diag([3.0, 3.0, 0.02, 0.2, 0.2, 0.7])
    given = np.array([0.3, -0.4, 5.0, 0.0, 1.0, -2.0])
    # x', y', turn of upper, then of lower, per unit of the rates of top and of knee
    ways = np.array([[0, 0.5, 1, -0.5, 1, 1], [0, 0, 0, -0.5, 0, 1]], float)
    rates = np.linalg.solve(ways @ M @ ways.T, ways @ M @ given)
    assert (r["a.rate"][0], r["b.rate"][0]) == pytest.approx(tuple(rates), rel=1e-12)


@IN_ALL_COPIES
def test_bodies_that_initial_leaves_free_move_least(R, planar):
    """A joint put elsewhere: the same places in the plane, in space and tilted."""
    r = run(two_rods(R, planar, more="initial: {top: 0.3}"))
    plane = run(two_rods(ORDINARY, "true", more="initial: {top: 0.3}"))
    assert r["a"][0] == pytest.approx(0.3, abs=1e-12)
    assert r["b"][0] == pytest.approx(plane["b"][0], abs=1e-10)


CRANKED = """
planar: {planar}
bodies:
  crank: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.1, 0]}}
  rod: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.6, 0]}}
  piston: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, 0]}}
joints:
  pin: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  knee: {{type: revolute, bodies: [crank, rod], at: [0.2, 0]}}
  wrist: {{type: revolute, bodies: [rod, piston], at: [1, 0]}}
  guide: {{type: prismatic, bodies: [ground, piston], axis: [1, 0, 0]}}
sensors: {{angle: {{joint: pin}}}}
{more}
solver: {{end: 0.1}}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize(
    "more",
    ["initial: {{pin: {}}}", 'drives: {{motor: {{joint: pin, position: "{} + 0*t"}}}}'],
    ids=["initial", "drive"],
)
@pytest.mark.parametrize("place", [3.3, 20.0, -100.0, 45.0])
def test_a_start_on_any_turn(place, more, planar):
    """Angles of joints count turns; alone, and in a linkage that goes round."""
    r = run(CRANKED.format(planar=planar, more=more.format(place)))
    assert r["angle"][0] == pytest.approx(place, abs=1e-9)
    at = 0.2 * np.cos(place) + np.sqrt(0.64 - (0.2 * np.sin(place)) ** 2)
    assert r["piston.position"][0, 0] == pytest.approx(at, abs=1e-9)
    assert r["crank.position"][0, :2] == pytest.approx(
        [0.1 * np.cos(place), 0.1 * np.sin(place)], abs=1e-9
    )


@IN_ALL_COPIES
@pytest.mark.parametrize("more", ["initial: {top: 30}", "drives: {m: {joint: top, position: 30}}"])
def test_starts_many_turns_away_are_alike(R, planar, more):
    r = run(two_rods(R, planar, more=more))
    plane = run(two_rods(ORDINARY, "true", more=more))
    assert r["a"][0] == pytest.approx(30.0, abs=1e-9)
    assert r["b"][0] == pytest.approx(plane["b"][0], abs=1e-8)


CRANK = """
planar: true
bodies:
  crank: {mass: 1, inertia: 0.01, at: [0.04, 0.03]}
  rod: {mass: 1, inertia: 0.02, at: [0.16, 0.03]}
  slider: {mass: 2, inertia: 0.01, at: [END, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  pin: {type: revolute, bodies: [crank, rod], at: [0.08, 0.06]}
  wrist: {type: revolute, bodies: [rod, slider], at: [END, 0]}
  guide: {type: prismatic, bodies: [ground, slider], axis: [1, 0], at: [END, 0]}
  spare: {type: revolute, bodies: [ground, wheel], at: [1, 0]}
drives: {other: {joint: spare, velocity: 1}, motor: {joint: bearing, MOTION}}
sensors: {turn: {joint: bearing}, stroke: {joint: guide}, second: {joint: spare}}
initial: {guide: -40 mm}
solver: {end: 0.1, tolerance: 1e-9}
""".replace("joints:", "  wheel: {mass: 1, inertia: 0.01, at: [1, 0]}\njoints:").replace(
    "END", str(0.08 + 0.0364**0.5)
)


def test_a_drive_with_a_velocity_begins_where_another_joint_puts_its_own():
    """The slider 40 mm inward, by the law of cosines: l^2 = a^2 + x^2 - 2 a x cos f."""
    r = run(CRANK.replace("MOTION", "velocity: 5"))
    a, l, x = 0.1, 0.2, 0.08 + 0.0364**0.5 - 0.04
    begin = np.arccos((x * x + a * a - l * l) / (2 * a * x))
    assert r["turn"][0] + np.arctan2(0.06, 0.08) == pytest.approx(begin, abs=1e-9)
    assert r["stroke"][0] == pytest.approx(-0.04, abs=1e-10)
    assert r["turn"] == pytest.approx(r["turn"][0] + 5 * r.t, abs=1e-9)
    assert r["motor.position"] == pytest.approx(r["turn"], abs=1e-9)
    assert r["second"] == pytest.approx(r.t, abs=1e-9)  # the other drive begins as drawn
    with pytest.raises(ModelError, match="fixes this joint already") as caught:
        run(CRANK.replace("MOTION", "position: 5*t"))
    assert caught.value.path == ("initial", "guide")


SUM = """
bodies:
  a: {mass: 1, inertia: 0.01, at: [0, 0]}
  b: {mass: 1, inertia: 0.01, at: [1, 0]}
  c: {mass: 1, inertia: 0.01, at: [2, 0]}
joints:
  one: {type: revolute, bodies: [ground, a], at: [0, 0]}
  two: {type: revolute, bodies: [ground, b], at: [1, 0]}
  mean: {type: revolute, bodies: [ground, c], at: [2, 0]}
  sum: {type: coupler, joints: [mean, one, two], coefficients: [2, -1, -1]}
drives: {DRIVES}
sensors: {x: {joint: one}, y: {joint: two}}
initial: {VALUES}
solver: {end: 1}
"""
ONE, TWO = "first: {joint: one, velocity: 1}", "second: {joint: two, MOTION}"


@pytest.mark.parametrize("drives", [(ONE, TWO), (TWO, ONE)])
def test_of_two_drives_that_could_give_way_the_file_says_which(drives):
    """2 z = x + y: where z alone is given, neither x nor y follows."""
    text = SUM.replace("DRIVES", ", ".join(drives))
    both = text.replace("MOTION", "velocity: 2")
    with pytest.raises(ModelError, match="nothing tells which") as caught:
        run(both.replace("VALUES", "mean: 0.5"))
    assert caught.value.path == ("initial", "mean")
    r = run(both.replace("VALUES", "mean: 0.5, two: 0.2"))
    assert (r["x"][0], r["y"][0]) == pytest.approx((0.8, 0.2), abs=1e-12)
    assert (r["x"][-1], r["y"][-1]) == pytest.approx((1.8, 2.2), abs=1e-12)
    # a place that is prescribed stays
    r = run(text.replace("MOTION", "position: 0.3 + t").replace("VALUES", "mean: 0.5"))
    assert (r["x"][0], r["y"][0]) == pytest.approx((0.7, 0.3), abs=1e-12)


def test_an_actuator_with_a_velocity_begins_where_a_value_puts_its_ends():
    """The crank at the angle f: the slider is where the law of cosines has it."""
    ram = "ram: {type: actuator, bodies: [ground, slider], points: [[1, 0], [END, 0]], MORE}"
    text = CRANK.replace("motor: {joint: bearing, MOTION}", ram).replace(
        "END", str(0.08 + 0.0364**0.5)
    )
    text = text.replace("guide: -40 mm", "bearing: 0.4")
    r = run(text.replace("MORE", "velocity: -0.1"))
    f, end = 0.4 + np.arctan2(0.06, 0.08), 0.08 + 0.0364**0.5
    begin = 0.1 * np.cos(f) + np.sqrt(0.04 - (0.1 * np.sin(f)) ** 2) - end
    assert r["turn"][0] == pytest.approx(0.4, abs=1e-10)
    assert r["stroke"] == pytest.approx(begin + 0.1 * r.t, abs=1e-9)
    assert r["ram.position"] == pytest.approx(-begin - 0.1 * r.t, abs=1e-9)
    with pytest.raises(ModelError, match="a value of `initial`") as caught:
        run(text.replace("MORE", "position: -0.1*t"))
    assert caught.value.path == ("drives", "ram")
