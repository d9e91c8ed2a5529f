"""`initial: {bearing.rate: 10 rad/s}`: what moves at the start, and with it all the rest."""

from math import asin, cos, pi, sin

import numpy as np
import pytest

from trsim.errors import ModelError, ScenarioError, TrsimError
from trsim.scenario.load import load, loads
from trsim.solve.start.consistent import start
from trsim.sweeps.plan import plan

from ..linkages import REVERSER, flat_parallelogram, four_bar, slider_crank
from ..runs import assemble, built, run

SENSED = "\nsensors: {a: {joint: A}, b: {joint: B}, c: {joint: C}}"


def first(text, *sets):
    """The channels of the first row."""
    r = run(text, "solver.end=1 ms", *sets)
    return lambda name: r[name][0]


@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_four_bar_begun_by_one_rate(planar):
    """From the loop |crank|, |coupler|, |rocker| = 1, 2, 2 by hand, as drawn: the crank is upright,
    the coupler level, the rocker upright: the coupler does not turn, crank and rocker tips move
    alike, so the rocker turns at half the rate of the crank."""
    at = first(four_bar(planar, "initial: {A.rate: 10 rad/s}" + SENSED))
    assert at("a.rate") == pytest.approx(10.0, rel=1e-12)
    assert at("crank.angular_velocity")[2] == pytest.approx(10.0, rel=1e-12)
    assert at("coupler.angular_velocity")[2] == pytest.approx(0.0, abs=1e-12)
    assert at("rocker.angular_velocity")[2] == pytest.approx(5.0, rel=1e-12)
    assert at("coupler.velocity") == pytest.approx([-10.0, 0.0, 0.0], abs=1e-12)
    assert at("rocker.velocity") == pytest.approx([-5.0, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_the_same_by_the_rate_of_another_joint(planar):
    """The rate at C, rocker against coupler, is that of the rocker: 5 rad/s."""
    at = first(four_bar(planar, "initial: {C.rate: 5}" + SENSED))
    assert at("a.rate") == pytest.approx(10.0, rel=1e-12)


def test_a_rate_where_initial_puts_the_joint():
    """A is brought to 800 deg and has its rate there, against the drawing's branch of the rest."""
    r = run(four_bar("true", "initial: {A: 800 deg, A.rate: -3}" + SENSED, end=0.02))
    assert r["a"][0] == pytest.approx(np.radians(800.0), rel=1e-12)
    assert r["a.rate"][0] == pytest.approx(-3.0, rel=1e-12)
    assert np.gradient(r["c"], r.t)[1] == pytest.approx(r["c.rate"][1], rel=1e-4)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_slider_crank_begun_by_its_slider(planar):
    """x = r cos a + sqrt(l^2 - r^2 sin^2 a) at a = 30 deg."""
    at = first(slider_crank(planar, "initial: {track.rate: -2 m/s}" + SENSED))
    a, b = pi / 6, asin(0.3 * sin(pi / 6))
    slope = -0.3 * sin(a) - 0.3 * cos(a) * sin(b) / cos(b)
    assert at("a.rate") == pytest.approx(-2.0 / slope, rel=1e-12)
    assert at("slider.velocity") == pytest.approx([-2.0, 0.0, 0.0], abs=1e-12)


CYLINDER = """
bodies:
  rod: {mass: 2, inertia: [0.1, 0.2, 0.3], at: [1000.4, 2000.1, 0.3]}
joints:
  shaft: {type: cylindrical, bodies: [BODIES], at: [1000, 2000, 0], axis: [3, 0, 4]}
initial: {shaft.angle.rate: 90 rpm, shaft.stroke.rate: 20 mm/s}
sensors: {turn: {joint: shaft.angle}, slide: {joint: shaft.stroke}}
solver: {end: 1 ms}
"""


@pytest.mark.parametrize("bodies, sign", [("ground, rod", 1.0), ("rod, ground", -1.0)])
def test_both_rates_of_a_cylindrical_joint(bodies, sign):
    at = first(CYLINDER.replace("BODIES", bodies))
    omega = sign * 3.0 * pi * np.array([0.6, 0.0, 0.8])
    assert at("turn.rate") == pytest.approx(3.0 * pi, rel=1e-12)
    assert at("slide.rate") == pytest.approx(0.02, rel=1e-9)
    assert at("rod.angular_velocity") == pytest.approx(omega, rel=1e-12)
    arm = np.array([0.4, 0.1, 0.3])
    v = np.cross(omega, arm) + sign * 0.02 * np.array([0.6, 0.0, 0.8])
    assert at("rod.velocity") == pytest.approx(v, rel=1e-9)


def test_what_a_rate_leaves_free_is_nearest_to_what_was_given():
    """Two discs side by side; that without a rate keeps the velocity it was given."""
    at = first("""
bodies:
  one: {mass: 1, inertia: 2}
  two: {mass: 1, inertia: 2, at: [1, 0], angular_velocity: [0, 0, 7]}
joints:
  A: {type: revolute, bodies: [ground, one], at: [0, 0]}
  B: {type: revolute, bodies: [ground, two], at: [1, 0]}
initial: {A.rate: 3}
solver: {end: 1 ms}
""")
    assert at("one.angular_velocity")[2] == pytest.approx(3.0, rel=1e-12)
    assert at("two.angular_velocity")[2] == pytest.approx(7.0, rel=1e-12)


def test_a_rate_comes_before_a_compliant_drive_and_an_equilibrium():
    text = """
gravity: [0, -9.81]
bodies: {rod: {mass: 2, inertia: 0.1, at: [0.4, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
initial: {equilibrium: [hinge], hinge.rate: 4}
solver: {end: 1 ms}
"""
    at = first(text)
    assert at("rod.position") == pytest.approx([0.0, -0.4, 0.0], abs=1e-9)
    assert at("rod.velocity") == pytest.approx([1.6, 0.0, 0.0], abs=1e-9)
    drive = ("drives: {motor: {joint: hinge, velocity: 1, compliance: {stiffness: 100, damping: "
             "1}}}\nsolver")  # fmt: skip
    at = first(text.replace("equilibrium: [hinge], ", "").replace("solver", drive))
    assert at("rod.angular_velocity")[2] == pytest.approx(4.0, rel=1e-12)


def test_with_clearance_and_with_a_flexible_bar():
    """A joint with play is an ideal one at the start; a bar moves like a rigid one."""
    laws = "contact_laws: {l: {normal: hunt_crossley, stiffness: 1e8, bearing_radius: 0.01, "
    laws += "restitution: 0.9}}\n"
    play = four_bar("true", laws + "initial: {A.rate: 10}" + SENSED)
    play = play.replace("at: [0, 1]}", "at: [0, 1], clearance: 1 mm}")
    at = first(play)
    assert at("rocker.angular_velocity")[2] == pytest.approx(5.0, rel=1e-12)
    at = first("""
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {diameter: 20 mm},
        youngs_modulus: 1 GPa, density: 1000 kg/m^3}
joints: {hinge: {type: revolute, bodies: [ground, bar], at: [0, 0]}}
initial: {hinge.rate: 2}
points: {tip: {body: bar, at: [1, 0]}}
sensors: {turn: {joint: hinge}}
solver: {end: 1 ms, tolerance: 1e-6}
""")
    assert at("turn.rate") == pytest.approx(2.0, rel=1e-9)
    assert at("tip.velocity") == pytest.approx([0.0, 2.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("kind", ["first", "last"])
def test_where_branches_meet(kind):
    """A flat parallelogram, which may go on as one or as an antiparallelogram, has the rate."""
    name = {"first": "A", "last": "D"}[kind]
    sensor = f"\nsensors: {{x: {{joint: {name}}}}}"
    # extremes of forces are chance at a flat place, and are sought for long
    told = "output.channels=['x*', '*.angular_velocity']"
    at = first(flat_parallelogram("true", f"initial: {{{name}.rate: 2}}{sensor}"), told)
    assert at("x.rate") == pytest.approx(2.0, rel=1e-9)
    omega = [at(f"{body}.angular_velocity")[2] for body in ("crank", "coupler", "rocker")]
    w = 2.0 if kind == "first" else -2.0
    assert omega[0 if kind == "first" else 2] == pytest.approx(w, rel=1e-9)
    assert omega[0] * 1.0 + omega[1] * 2.0 == pytest.approx(omega[2], rel=1e-9)  # loop, across


def test_a_bent_bar_in_a_loop_moves_like_a_rigid_one():
    """Springs and weight bend the coupler by 78 mm first; the crank has its rate all the same."""
    bar = ("coupler: {type: ancf_cable, start: [0, 1], end: [2, 1], elements: 4, section: "
           "{diameter: 20 mm}, youngs_modulus: 1 GPa, density: 1000 kg/m^3}")  # fmt: skip
    more = """
gravity: [0, -9.81]
forces:
  one: {type: torsion_spring, joint: A, stiffness: 500}
  two: {type: torsion_spring, joint: D, stiffness: 500}
initial: {equilibrium: all, A.rate: 10}"""
    lines = four_bar("true", more + SENSED).replace("1e-10", "1e-5").split("\n")
    text = "\n".join(f"  {bar}" if "coupler: {mass" in line else line for line in lines)
    r = run(text, "solver.end=1 ms")
    assert r["coupler.deflection"][0] > 0.05
    assert r["a.rate"][0] == pytest.approx(10.0, rel=1e-8)
    assert r["b.rate"][0] == pytest.approx(-10.0, rel=1e-2)


# --- refused ---------------------------------------------------------------------------------


def refused(text):
    scenario = loads(text)
    with pytest.raises(ModelError) as caught:
        start(scenario, assemble(scenario), located=True)
    return caught.value


def test_rates_that_fit_together_are_not_refused():
    at = first(four_bar("true", "initial: {A.rate: 10, D.rate: -5, B.rate: -10}" + SENSED))
    assert at("a.rate") == pytest.approx(10.0, rel=1e-9)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_contradictory_rates_are_named(planar):
    error = refused(four_bar(planar, "initial: {A.rate: 10, D.rate: 5}"))
    assert error.path == ("initial", "D.rate") and error.exit_code == 4
    assert error.what == "5 rad/s contradicts A.rate, joints and drives: they make it -5 rad/s"


def test_a_rate_against_a_drive_is_refused():
    drive = "drives: {motor: {joint: A, velocity: 10}}\n"
    error = refused(four_bar("true", drive + "initial: {A.rate: 10.1}"))
    assert error.what == "10.1 rad/s contradicts joints and drives: they make it 10 rad/s"
    at = first(four_bar("true", drive + "initial: {A.rate: 10}" + SENSED))
    assert at("a.rate") == pytest.approx(10.0, rel=1e-12)


def test_what_another_body_does_hides_no_contradiction():
    """The tolerance is that of the velocities the rate is made of."""
    fast = "bullet: {mass: 1, inertia: [1, 1, 1], velocity: [1e7, 0, 0]}\njoints:"
    drive = "drives: {motor: {joint: A, velocity: 1}}\n"
    text = four_bar("true", drive + "initial: {A.rate: 1.01}").replace("joints:", f"  {fast}")
    assert "1.01 rad/s contradicts joints and drives" in refused(text).what


def test_a_rate_of_zero_contradicts_no_rounding():
    """The door of the reverser, at rest against the fairing, which its drive moves: some 1e-16."""
    sets = ["initial.equilibrium=[]", "initial.B.rate=0", "solver.end=1 ms"]
    r = run(load(REVERSER / "ideal.yaml", sets))
    assert r["door_angle.rate"][0] == pytest.approx(0.0, abs=1e-12)
    assert r["stroke.rate"][0] == pytest.approx(0.5, rel=1e-12)


def test_a_dead_centre_has_no_rate_of_its_slider():
    text = """
bodies:
  crank: {mass: 1, inertia: 1, at: [0.5, 0]}
  rod: {mass: 1, inertia: 1, at: [2, 0]}
  block: {mass: 1, inertia: 1, at: [3, 0]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  B: {type: revolute, bodies: [crank, rod], at: [1, 0]}
  C: {type: revolute, bodies: [rod, block], at: [3, 0]}
  slider: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
initial: {slider.rate: 1 m/s}
solver: {end: 1 ms}
"""
    error = refused(text)
    assert error.path == ("initial", "slider.rate")
    assert "1 m/s contradicts joints and drives: they make it 0 m/s" in error.what


@pytest.mark.parametrize(
    "initial, what, hint",
    [
        ("A.rate: 10 m/s", "wrong unit", "rad/s"),
        ("A: 1, A.angle: 2", "the value of A is given twice", ""),
        ("track: 30 deg", "wrong unit: 'deg'", ""),
        ("A: 30 mm", "wrong unit: 'mm'", ""),
        ("track.rate: 3 rad/s", "wrong unit", "m/s"),
        ("A.stroke.rate: 3", "joint 'A' has no stroke", "A"),
        ("A.rat: 3", "joint 'A' has no rat", "Did you mean 'A.rate'?"),
        ("E.rate: 3", "unknown key 'E.rate'", "Known"),
        ("crank.rate: 3", "unknown key 'crank.rate'", "Known"),
        ("A.rate: [1]", "must be a number", ""),
        ("{A.rate: 1, A.angle.rate: 1}", "the rate of A is given twice", "Keep one"),
        ("A.rate: fast", "no parameter named 'fast'", ""),
    ],
)
def test_what_is_no_rate(initial, what, hint):
    given = initial if initial[0] == "{" else f"{{{initial}}}"
    with pytest.raises(ScenarioError) as caught:
        loads(slider_crank("true", f"initial: {given}"), name="a.yaml")
    shown = caught.value.show()
    assert what in shown and hint in shown and shown.startswith("a.yaml:11")


def test_a_ball_joint_has_no_rate():
    text = """
bodies: {ball: {mass: 1, inertia: [1, 1, 1]}}
joints: {socket: {type: spherical, bodies: [ground, ball], at: [1, 0, 0]}}
initial: {socket.rate: 1}
solver: {end: 1}
"""
    with pytest.raises(ScenarioError, match="has no coordinate"):
        loads(text)


# --- set, swept ------------------------------------------------------------------------------


def test_rates_are_set_and_swept(tmp_path):
    text = four_bar("true", "initial: {A.rate: 10}" + SENSED)
    assert loads(text, ["initial.A.rate=3"]).initial.rates == {"A": 3.0}
    assert loads(four_bar("true"), ["initial.A.rate=3"]).initial.rates == {"A": 3.0}
    assert loads(text, ["initial.A=3 deg"]).initial.values == {"A": pytest.approx(pi / 60)}
    path = tmp_path / "a.yaml"
    path.write_text(text + "\nsweep: {initial.A.rate: [1, 2 rad/s]}\n")
    found = plan(path)
    assert [dict(case.values) for case in found.cases] == [
        {"initial.A.rate": 1}, {"initial.A.rate": "2 rad/s"}
    ]  # fmt: skip
    rates = [found.scenario(case).initial.rates for case in found.cases]
    assert rates == [{"A": 1.0}, {"A": 2.0}]


def test_no_traceback():
    for initial in ("A.rate.rate: 1", ".rate: 1", "rate: 1", "A.rate: {x: 1}", "A.rate: null"):
        with pytest.raises(TrsimError):
            loads(four_bar("true", f"initial: {{{initial}}}"))


def test_a_rate_costs_nothing_when_it_is_not_asked_for():
    """A coordinate that only the start needs is none of the run."""
    assert built(four_bar("true", "initial: {A.rate: 1}")).coordinates == {}
