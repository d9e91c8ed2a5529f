"""What the mesh of a flexible bar makes wrong: the estimate against meshes that are much finer."""

import numpy as np
import pytest

from trsim.laws.cable import EXACT, GERSTMAYR, PAPER, add_force
from trsim.laws.cable_stretch import ASSUMED, ENGINEERING, GREEN
from trsim.laws.cable_tangent import add_stiffness
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.diagnose.mesh_error import AIM, TOLD, mesh_errors
from trsim.solve.start.bars import places
from trsim.solve.start.cable_systems import Law, assumed, system
from trsim.solve.start.consistent import start

from ..bars import Bar
from ..runs import assemble, loads, run
from ..sizes import size

FINE = size(16, 32)
BAR = """
planar: true
parameters: {load: 1, EA: 1.2e5}
bodies:
  beam:
    type: ancf_cable
    start: [0, 0]
    end: [1, 0]
    elements: 4
    area: 1
    second_moment: 1/EA
    youngs_modulus: EA
    density: 1
"""
CLAMP = "joints: {clamp: {type: fixed, bodies: [ground, beam], at: [0, 0]}}\n"
PINS = """joints:
  a: {type: revolute, bodies: [ground, beam], at: [0, 0]}
  b: {type: revolute, bodies: [ground, beam], at: [1, 0]}
"""
SLIDER = """  car: {type: rigid_body, mass: 1, inertia: 1, at: [1, 0]}
joints:
  a: {type: revolute, bodies: [ground, beam], at: [0, 0]}
  b: {type: revolute, bodies: [car, beam], at: [1, 0]}
  rail: {type: prismatic, bodies: [ground, car], at: [1, 0], axis: [1, 0]}
"""
AT_TIP = "{type: applied_load, body: beam, at: [1, 0], direction: %s: load}\n"
ACROSS = (
    "forces: {f: {type: distributed_load, body: beam, direction: [0, 1], force_per_length: load}}\n"
)
SETTLED = "initial: {equilibrium: all}\nsolver: {end: 10 ms}\n"
SCENES = {
    "tip force": CLAMP + "forces: {f: " + AT_TIP.strip() % "[0, 1], force" + "}\n",
    "tip moment": CLAMP + "forces: {f: " + AT_TIP.strip() % "[0, 0, 1], torque" + "}\n",
    "distributed": CLAMP + ACROSS,
    "pinned at both ends": PINS + ACROSS,
    "pinned, one end slides": SLIDER + ACROSS,
}


def settled(scene, n, *sets):
    """The scenario and mechanism of a scene with n elements, and its equilibrium."""
    read = loads(BAR + SCENES[scene] + SETTLED, [f"bodies.beam.elements={n}", *sets])
    mechanism = assemble(read)
    return read, mechanism, start(read, mechanism, located=True).y


def nodes(mechanism, y):
    return places(mechanism, mechanism.beams["beam"], y)[0]


CASES = [(s, p) for s in SCENES for p in ((1.0, 4.0) if s == "tip moment" else (1.0, 10.0))]


@pytest.mark.parametrize("EA", [1.2e3, 1.2e7])
@pytest.mark.parametrize(("scene", "load"), CASES, ids=str)
def test_the_estimate_is_right_to_a_factor_of_three(scene, load, EA):
    sets = f"parameters.load={load}", f"parameters.EA={EA}"
    fine = nodes(*settled(scene, FINE, *sets)[1:])
    for n in (2, 4, 8):
        read, mechanism, y = settled(scene, n, *sets)
        (found,) = mesh_errors(read, mechanism, y)
        true = np.linalg.norm(nodes(mechanism, y) - fine[:: FINE // n], axis=1).max()
        print(f"{n} elements: {found.error:.1e}, truly {true:.1e} ({found.error / true:.2f})")
        if true > 0.1:
            assert found.error > 0.1  # nothing but useless
        elif "tip" in scene:
            assert true / 3.0 < found.error < 3.0 * true
            assert found.wanted == np.ceil(n * (found.relative / AIM) ** 0.25)
        else:  # loads inside of elements are not seen: little errors may be far off
            assert found.error > true / 3.0 or true < 0.2 * AIM
            assert found.error < 3.0 * true or found.error < TOLD


@pytest.mark.parametrize("strain", [GREEN, ENGINEERING])
@pytest.mark.parametrize("curvature", [EXACT, GERSTMAYR, PAPER])
def test_many_elements_at_once_are_the_law(strain, curvature):
    """Also in the plane."""
    rng, l, law = np.random.default_rng(7), 0.1, Law(40.0, 0.1, strain, curvature)
    e = np.array([0, 0, 0, 1, 0, 0, l, 0, 0, 1, 0, 0.0]) + rng.normal(size=(3, 12)) * 0.01
    elements = e.reshape(3, 4, 3)
    dU, stiff = system(elements, l, law, assumed(elements, l, law))
    bar = Bar(l, 40.0, 0.1, 0.0, strain, curvature, ASSUMED)
    for k in range(3):
        F, K = np.zeros(12), np.zeros((12, 12))
        add_force(e[k], e[k], bar, 0.0, F)
        add_stiffness(e[k], bar, np.zeros((4, 12)), K)
        assert dU[k] == pytest.approx(-F, abs=1e-12 * abs(F).max())
        assert stiff[k] == pytest.approx(K, abs=1e-12 * abs(K).max())
    flat = elements.copy()
    flat[..., 2] = 0.0
    plane = np.array([k for k in range(12) if k % 3 != 2])
    dU, stiff = system(flat, l, law, assumed(flat, l, law))
    dV, stuff = system(flat[..., :2], l, law, assumed(flat[..., :2], l, law))
    assert dV == pytest.approx(dU[:, plane], abs=1e-13)
    assert stuff == pytest.approx(stiff[:, plane[:, None], plane], abs=1e-12 * abs(stiff).max())


def test_the_estimate_in_space_is_that_of_the_plane():
    sets = "parameters.load=5", "bodies.beam.elements=4"
    found = []
    for planar in ("true", "false"):
        read = loads(BAR + SCENES["tip force"] + SETTLED, [*sets, f"planar={planar}"])
        mechanism = assemble(read)
        y = start(read, mechanism, located=True).y
        found += [bar.error for bar in mesh_errors(read, mechanism, y)]
    assert found[1] == pytest.approx(found[0], rel=1e-6)


def test_a_straight_bar_has_no_error_and_a_locking_one_no_estimate():
    read, mechanism, y = settled("tip force", 4, "parameters.load=0")
    (found,) = mesh_errors(read, mechanism, y)
    assert found.error < 1e-12 and found.wanted == 1
    assert not list(mesh_errors(*settled("tip force", 4, "bodies.beam.stretching=full")))


def test_a_bar_that_nothing_holds():
    """It flies, as it is bent or as it is straight."""
    free = """
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1 m, 0], section: {diameter: 10 mm},
        youngs_modulus: 207 GPa, density: 7850 kg/m^3}
forces: {wind: {type: distributed_load, body: bar, direction: [0, -1, 0], force_per_length: 20}}
solver: {end: 10 ms, tolerance: 1e-4}
"""
    read = loads(free)
    mechanism = assemble(read)
    for found in mesh_errors(read, mechanism, start(read, mechanism, True).y):
        assert found.error < 1e-2


def test_a_bar_that_two_joints_hold_at_one_place():
    """The estimate is that of one clamp."""
    again = CLAMP.replace("}}", "}, again: {type: revolute, bodies: [ground, beam], at: [0, 0]}}")
    once, two = (loads(BAR + joints + ACROSS + SETTLED) for joints in (CLAMP, again))
    assert len(two.joints) == len(once.joints) + 1
    errors = []
    for read in (once, two):
        mechanism = assemble(read)
        (found,) = mesh_errors(read, mechanism, start(read, mechanism, True).y)
        errors.append(found.error)
    assert errors[0] == pytest.approx(errors[1], rel=1e-6, abs=1e-12)


TURNED = """
  hub: {type: rigid_body, mass: 1, inertia: 1, at: [0, 0]}
joints:
  axle: {type: revolute, bodies: [ground, hub], at: [0, 0]}
  clamp: {type: fixed, bodies: [hub, beam], at: [0, 0]}
drives: {turn: {joint: axle, position: 3*t*t}}
sensors: {angle: {joint: axle}}
solver: {end: 1 s, tolerance: 1e-6}
output: {every: 10 ms}
"""


@pytest.mark.parametrize("method", ["auto", "scipy:RK45"])
def test_a_run_tells_the_error_of_a_mesh_that_is_bent_far(method):
    """A bar that lags behind its hub, against 8 elements at the same time; a method of scipy looks
    at the end of its steps as well."""
    sets = ("parameters.EA=1e3", f"solver.method={method}")
    sets += ("solver.tolerance=1e-3",) if "scipy" in method else ()
    told, tips = {}, {}
    for n in (2,) if "scipy" in method else (2, 8):
        r = run(BAR + TURNED, f"bodies.beam.elements={n}", *sets)
        told[n] = [s for s in doubts(r.scenario, r.mechanism, r.outcome) if "elements make" in s]
        tips[n] = r["beam.tip"][-1]
        (found,) = mesh_errors(r.scenario, r.mechanism, r.outcome.record.y)
        print(n, r["beam.deflection"].max(), found.relative, abs(tips[n] - tips[2]).max())
    assert told[2][0].startswith("bodies.beam: 2 elements make its shape wrong by about ")
    assert "elements would make it 0.0001" in told[2][0] and not told.get(8)
