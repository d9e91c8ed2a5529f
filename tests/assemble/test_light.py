"""Bodies without mass or inertia: the same motion and reactions as without them."""

import numpy as np
import pytest

from trsim.assemble.equations import kinetic
from trsim.assemble.tables import masses_and_arms
from trsim.elements.scene import workspace
from trsim.errors import TrsimError
from trsim.scenario.load import loads

from ..runs import built, run

METHODS = ["dop853", "radau", "generalized_alpha", "scipy:RK45", "scipy:Radau"]
ENGINE = """
bodies:
  crank: {{mass: 1.2 kg, inertia: 0.01, at: [0.05, 0.03], angular_velocity: [0, 0, 5]}}
  slider: {{mass: 2 kg, inertia: 0.1, at: [0.4, 0]}}
{0}
joints:
  a: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  d: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
{1}
forces:
  push: {{type: applied_load, body: slider, direction: [-1, 0], force: "20*cos(30*t)"}}
gravity: [0, -9.81]
solver: {{end: 0.6 s, tolerance: 1e-9, {2}}}
"""
ROD = "  rod: {mass: 0, inertia: 0, at: [0.25, 0.05]}"
PINS = """
  b: {type: revolute, bodies: [crank, rod], at: [0.1, 0.06]}
  c: {type: revolute, bodies: [rod, slider], at: [0.4, 0]}
"""
LINK = "  b: {type: link, bodies: [crank, slider], points: [[0.1, 0.06], [0.4, 0]]}"


@pytest.mark.parametrize("method", METHODS)
def test_a_rod_without_mass_is_a_link(method):
    loose = 1e-4 if method == "generalized_alpha" else 1e-7
    # at 1e-9 the one of order two makes millions of steps, scipy's Radau thousands in Python
    looser = {"generalized_alpha": "1e-7", "scipy:Radau": "1e-8"}.get(method, "1e-9")
    short = ("solver.end=0.2 s",) if method == "scipy:Radau" else ()
    sets = (f"solver.tolerance={looser}", *short)
    own = run(loads(ENGINE.format(ROD, PINS, f"method: {method}"), sets))
    link = run(loads(ENGINE.format("", LINK, "method: dop853"), short))
    assert own.mechanism.mobility == 1
    for name, size in (("crank.angular_velocity", 10), ("slider.velocity", 1)):
        np.testing.assert_allclose(own[name], link[name], atol=loose * size)
    pull = own["c.reaction"]
    np.testing.assert_allclose(pull, link["b.reaction"], atol=100 * loose)
    # it carries along itself alone
    along = own["c.reaction"] + own["b.reaction"] * -1.0
    np.testing.assert_allclose(along, 0.0, atol=1e-7)


@pytest.mark.parametrize("beta", [50, 500])
def test_what_is_measured_beside_baumgartes_feedback_is_that_of_no_mass(beta):
    """Outputs are solved for again without the feedback; a rod without mass carries alike at both
    ends then, too."""
    held = f"stabilisation: baumgarte, baumgarte: {{alpha: {beta}, beta: {beta}}}"
    own = run(loads(ENGINE.format(ROD, PINS, held)))
    link = run(loads(ENGINE.format("", LINK, "method: dop853")))
    size = np.abs(link["b.reaction"]).max()
    np.testing.assert_allclose(own["c.reaction"], own["b.reaction"], atol=1e-11 * size)
    np.testing.assert_allclose(own["c.reaction"], link["b.reaction"], atol=1e-5 * size)


BESIDE_EACH_OTHER = """
planar: {}
bodies:
  arm: {{mass: 2, inertia: [0.2, 0.1, 0.3], at: [0.5, 0, 0]}}
  bob: {{mass: 0.7, inertia: [0, 0, 0], at: [1, 0, 0]}}
  tip: {{mass: 0, inertia: [0.01, 0.02, 0.03], at: [2, 0, 0]}}
joints:
  first: {{type: fixed, bodies: [arm, bob], at: [1, 0, 0]}}
  second: {{type: fixed, bodies: [arm, tip], at: [2, 0, 0]}}
"""


@pytest.mark.parametrize("planar", [True, False])
def test_kinetic_energy_is_that_of_what_there_is(planar):
    """Each light body without what it is solved with, whatever the others lack."""
    mechanism = built(BESIDE_EACH_OTHER.format(str(planar).lower()))
    model, rng = mechanism.model, np.random.default_rng(2)
    assert len(model.light) == 2
    y = np.concatenate([mechanism.y0[: model.n_q], rng.normal(size=model.n_v + model.n_z)])
    v = y[model.n_q : model.n_q + model.n_v].reshape(3, -1)
    mass = np.diag([2.0, 2.0, 0.3] if planar else [2.0] * 3 + [0.2, 0.1, 0.3])
    bob = np.diag([0.7, 0.7, 0.0] if planar else [0.7] * 3 + [0.0] * 3)
    tip = np.diag([0.0, 0.0, 0.03] if planar else [0.0] * 3 + [0.01, 0.02, 0.03])
    order = [mechanism.frames[name] - 1 for name in ("arm", "bob", "tip")]
    wanted = sum(0.5 * v[f] @ M @ v[f] for f, M in zip(order, (mass, bob, tip), strict=True))
    assert kinetic(workspace(model), y) == pytest.approx(wanted, rel=1e-9)


def test_the_energy_book_has_no_mass_that_is_not_there():
    own = run(loads(ENGINE.format(ROD, PINS, "method: dop853")))
    link = run(loads(ENGINE.format("", LINK, "method: dop853")))
    np.testing.assert_allclose(own["energy.kinetic"], link["energy.kinetic"], atol=1e-8)
    assert own.outcome.statistics["energy_residual_relative"] < 1e-7


INLINE = """
planar: false
bodies:
  pin: {{mass: 2 kg, inertia: [0.01, 0.02, 0.015], at: [0.5, 0.02, 0.1], velocity: [0.4, 0, 0]}}
  frame: {{mass: 3 kg, inertia: [0.05, 0.04, 0.06], at: [0, 0, 0]}}
{0}
joints:
  hinge: {{type: revolute, bodies: [ground, frame], at: [0, 0, 0], axis: [0, 1, 0.3]}}
{1}
forces:
  push: {{type: applied_load, body: pin, at: [0.5, 0, 0.15], direction: [1, 2, 3],
          force: "3*sin(20*t)"}}
gravity: [1, -3, -9.81]
solver: {{end: 0.5 s, tolerance: 1e-9, method: {2}}}
"""


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_a_dummy_part_is_the_joint_it_stands_for(method):
    """A ball on a slide without mass: a point on a line, as `inline` holds it."""
    dummy = run(loads(INLINE.format(
        "  dummy: {mass: 0, inertia: [0, 0, 0], at: [0.5, 0, 0]}",
        "  slide: {type: cylindrical, bodies: [frame, dummy], at: [0.5, 0, 0], axis: [1, 0, 0]}\n"
        "  turn: {type: universal, bodies: [dummy, pin], at: [0.5, 0, 0], axis: [0, 1, 0],"
        " second_axis: [0, 0, 1]}", method)))  # fmt: skip
    joint = run(loads(INLINE.format(
        "", "  slide: {type: inline, bodies: [frame, pin], at: [0.5, 0, 0], axis: [1, 0, 0]}",
        method)))  # fmt: skip
    # the cross holds no turn of the pin, since the dummy turns freely about the slide
    for name in ("pin.position", "pin.velocity", "frame.angular_velocity"):
        np.testing.assert_allclose(dummy[name], joint[name], atol=1e-7)
    np.testing.assert_allclose(dummy["turn.reaction"], joint["slide.reaction"], atol=1e-5)


def test_point_mass_on_a_string_of_no_weight():
    text = """
bodies:
  bob: {mass: 2 kg, inertia: 0, at: [1, 0]}
joints:
  pivot: {type: revolute, bodies: [ground, bob], at: [0, 0]}
gravity: [0, -9.81]
solver: {end: 2 s, tolerance: 1e-10}
"""
    r = run(loads(text))
    angle = np.arctan2(r["bob.position"][:, 1], r["bob.position"][:, 0])
    speed = np.linalg.norm(r["bob.velocity"], axis=1)
    np.testing.assert_allclose(0.5 * speed**2, -9.81 * np.sin(angle), atol=1e-8)
    tension = 2 * (speed**2 - 9.81 * np.sin(angle))
    pull = np.linalg.norm(r["pivot.reaction"], axis=1)
    np.testing.assert_allclose(pull, np.abs(tension), atol=1e-6)


def test_thin_rod_that_cannot_turn_about_itself():
    """A rod without inertia about its axis on a cross: as with a little, and as with none."""
    text = """
planar: false
bodies:
  rod: {{mass: 1 kg, inertia: [{0}, 0.1, 0.1], at: [0.5, 0, 0], angular_velocity: [0, 1, 2]}}
joints:
  cross: {{type: universal, bodies: [ground, rod], at: [0, 0, 0], axis: [0, 1, 0],
           second_axis: [0, 0, 1]}}
gravity: [0, 0, -9.81]
solver: {{end: 1 s, tolerance: 1e-9}}
"""
    none, little = run(loads(text.format(0))), run(loads(text.format(1e-9)))
    np.testing.assert_allclose(none["rod.position"], little["rod.position"], atol=1e-6)
    np.testing.assert_allclose(none["cross.reaction"], little["cross.reaction"], atol=1e-4)


def test_spinning_part_without_inertia_about_two_axes():
    """Its spin about the third axis has a momentum: what E adds must not swing it."""
    text = """
planar: false
bodies:
  arm: {{mass: 1 kg, inertia: [0.2, 0.3, 0.4], at: [0, 0, 0], angular_velocity: [0.5, 0.2, 3]}}
  disc: {{mass: 0.5 kg, inertia: [{0}, {0}, 0.02], at: [0, 0, 0.3]}}
joints:
  ball: {{type: spherical, bodies: [ground, arm], at: [0, 0, 0]}}
  axle: {{type: revolute, bodies: [arm, disc], at: [0, 0, 0.3], axis: [0, 0, 1]}}
drives:
  spin: {{joint: axle, velocity: 50}}
gravity: [0, 0, -9.81]
solver: {{end: 0.1 s, tolerance: 1e-9}}
"""
    none, little = run(loads(text.format(0))), run(loads(text.format(1e-10)))
    np.testing.assert_allclose(none["arm.angular_velocity"], little["arm.angular_velocity"],
                               atol=1e-6)  # fmt: skip
    np.testing.assert_allclose(none["axle.reaction_moment"], little["axle.reaction_moment"],
                               atol=1e-5)  # fmt: skip


def test_a_plastic_impact_knows_nothing_of_what_has_no_mass():
    event = "\nevents:\n  stop: {when: t, value: 0.2 s, do: {lock: [d]}}\nsensors: {x: {joint: d}}"
    free = ("dop853", "\nevents:\n  stop: {when: t, value: 0.2 s, do: {lock: [a]}}")
    own = run(loads(ENGINE.format(ROD, PINS, "method: dop853") + free[1]))
    link = run(loads(ENGINE.format("", LINK, "method: dop853") + free[1]))
    np.testing.assert_allclose(own["energy.work.events"], link["energy.work.events"], rtol=1e-8)
    assert own["energy.work.events"][-1] < -0.01
    assert event


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("bodies: {a: {mass: 1, inertia: 0}}", "without inertia is free to turn"),
        ("bodies: {a: {mass: 0, inertia: 1}}", "without mass is free to move"),
        (
            "planar: false\nbodies: {a: {mass: 1, inertia: [0, 1, 1], at: [1, 0, 0]}}\n"
            "joints: {p: {type: spherical, bodies: [ground, a], at: [0, 0, 0]}}",
            "without inertia is free to turn",
        ),
        (
            "bodies: {a: {mass: 1, inertia: 1}, b: {mass: 0, inertia: 0, at: [1, 0]}}\n"
            "joints: {p: {type: revolute, bodies: [a, b], at: [1, 0]}}",
            "without inertia is free to turn",
        ),
        ("bodies: {a: {mass: 1, inertia: -1}}", ">= 0"),
        (
            "bodies: {a: {mass: 0, inertia: 0}}\n"
            "joints: {p: {type: revolute, bodies: [ground, a], at: [1, 0]}}\n"
            "forces: {s: {type: limit_stop, joint: p, upper: 1, stiffness: 10}}",
            "a contact or a stop acts on a body without mass",
        ),
    ],
)
def test_what_nothing_determines_is_refused_by_name(text, said):
    with pytest.raises(TrsimError) as error:
        run(loads(f"{text}\nsolver: {{end: 0.1}}"))
    assert said in str(error.value)


def test_a_driven_mechanism_without_any_mass_runs():
    text = """
bodies:
  crank: {mass: 0, inertia: 0, at: [0.1, 0]}
joints:
  a: {type: revolute, bodies: [ground, crank], at: [0, 0]}
drives:
  motor: {joint: a, velocity: 2}
forces:
  pull: {type: applied_load, body: crank, at: [0.2, 0], direction: [0, -1], force: 5 N}
solver: {end: 1 s}
"""
    r = run(loads(text))
    np.testing.assert_allclose(r["motor.force"], 5 * 0.2 * np.cos(2 * r.t), atol=1e-9)
    assert np.abs(r["energy.kinetic"]).max() < 1e-20


TORN_OFF = """
bodies:
  crank: {mass: 1, inertia: 0.01, at: [0.05, 0]}
  rod: {mass: 0, inertia: 0, at: [0.2, 0.1]}
  slider: {mass: 2, inertia: 0.1, at: [0.4, 0.1]}
joints:
  a: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  b: {type: revolute, bodies: [crank, rod], at: [0.1, 0]}
  c: {type: revolute, bodies: [rod, slider], at: [0.4, 0.1]}
  d: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}
gravity: [0, -9.81, 0]
events: {off: {when: t, value: 0.1, do: {release: [%s]}}}
solver: {end: 0.2}
"""


@pytest.mark.parametrize("joints", ["c", "b, c"])
def test_an_event_that_leaves_a_light_body_open_ends_the_run(joints):
    r = run(loads(TORN_OFF % joints), fails=True)
    assert r.outcome.status == "failed"
    assert r.t[-1] == pytest.approx(0.1)
    assert r.outcome.reason.startswith("event 'off' (release ")
    assert "): 'rod', a body without " in r.outcome.reason
    assert "its motion is not determined" in r.outcome.reason


def test_an_event_may_leave_a_light_body_on_what_moves_it():
    r = run(loads(TORN_OFF.replace("release: [%s]", "release: [c], lock: [b]")))
    assert r.outcome.status == "done"


@pytest.mark.parametrize("rod", [ROD, "  rod: {mass: 0.1, inertia: 0.001, at: [0.25, 0.05]}"])
def test_what_stands_for_a_mass_is_asked_for_by_light_bodies_only(rod, monkeypatch):
    asked = []
    monkeypatch.setattr(
        "trsim.assemble.tables.masses_and_arms",
        lambda at, sizes: asked.append(at) or masses_and_arms(at, sizes),
    )
    built(ENGINE.format(rod, PINS, "method: dop853"))
    assert bool(asked) == (rod == ROD)
