"""What a run says against itself: a changed start, a contact beyond its law, an open book."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from tests.small import SLIDER_CRANK
from trsim.assemble.assemble import assemble
from trsim.elements.contract import STORED
from trsim.scenario.expand import expand
from trsim.scenario.load import loads, of_tree
from trsim.solve.diagnose.doubts import doubts, of_start, of_waves
from trsim.solve.start.consistent import start
from trsim.solve.start.projected import projected
from trsim.sweeps.plan import plan

from ..runs import run
from ..test_scenarios import FILES, FOLDER

NOT_RUN = sorted(path for path in FOLDER.rglob("*.yaml") if path not in FILES)

FIXED = """
bodies: {{b: {{mass: 1, inertia: 1, {}}}}}
joints: {}
solver: {{end: 0.01}}
"""
PIN = "{p: {type: revolute, bodies: [ground, b], at: [0, 0]}}"
GUIDES = """{g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]},
 h: {type: prismatic, bodies: [ground, b], axis: [1, 1e-3, 0]}}"""


def told(text):
    r = run(text)
    return doubts(r.scenario, r.mechanism, r.outcome)


@pytest.mark.parametrize(
    "given, joints, start, numbers",
    [
        (
            "at: [1, 0], velocity: [1, 1]",
            PIN,
            "bodies.b.velocity",
            "[1, 1, 0], starts with [0, 0.5",
        ),
        ("velocity: [1, 0]", GUIDES, "bodies.b.velocity", "[1, 0, 0], starts with [0, 0, 0] m/s"),
        (
            "at: [1, 0], angular_velocity: [0, 0, 2]",
            PIN,
            "bodies.b.angular",
            "starts with [0, 0, 1]",
        ),
    ],
)
def test_a_velocity_that_was_not_kept_is_told(given, joints, start, numbers):
    (found,) = told(FIXED.format(given, joints))
    assert found.startswith(start) and numbers in found


@pytest.mark.parametrize(
    "given", ["at: [1, 0]", "at: [1, 0], velocity: [0, 1], angular_velocity: [0, 0, 1]"]
)
def test_velocities_that_fit_are_not_mentioned(given):
    assert told(FIXED.format(given, PIN)) == ()


def test_a_rod_whose_velocity_the_drive_decides():
    text = SLIDER_CRANK.replace("at: [0.11, 0]", "at: [0.11, 0], velocity: [0, 5]")
    (found,) = told(text.replace("clearance: 0.5 mm, contact: pin", "clearance: 0"))
    # the middle of A and B: half of 5000 rpm times 50 mm
    assert found.startswith("bodies.rod.velocity: given as [0, 5, 0], starts with [0, 13.09, 0]")


def test_a_position_that_was_not_kept_is_told():
    text = SLIDER_CRANK.replace("0.5 mm, contact: pin", "0")
    (found,) = told(text.replace("velocity: 5000 rpm", "position: 0.1 + t"))
    assert found.startswith("bodies.") and "from where it is drawn" in found


def test_check_tells_the_change_of_two_guides():
    scenario = loads(FIXED.format("velocity: [1, 0]", GUIDES))
    m = assemble(scenario)
    p = projected(m, start(scenario, m, True))
    assert p.slip == pytest.approx(1.0) and p.slip_body == "b"


@pytest.mark.parametrize("path", NOT_RUN, ids=lambda p: p.stem)
def test_the_scenarios_start_as_given(path):
    """Those that tests/test_scenarios.py runs are asked there."""
    tree, text = expand(path)  # once: a study of other scenarios extends many files
    if tree.data.get("cases") and not tree.data.get("bodies"):
        planned = plan(str(path), read=lambda _: (tree, text))
        scenario = planned.scenario(planned.cases[0])
    else:
        scenario = of_tree(tree, text)
    m = assemble(scenario)
    assert list(of_start(scenario, m, start(scenario, m, True))) == []


SOFT = SLIDER_CRANK.replace("end: 3 ms", "end: 1.5 ms")


def test_a_journal_beyond_its_law_is_told():
    (found,) = told(SOFT.replace("207 GPa", "2 MPa"))
    assert found.startswith("joints.B: the journal is pressed in by")
    assert "of the clearance (0.5 mm)" in found and "of the radius (10 mm)" in found


def test_a_stiff_journal_is_not():
    assert told(SOFT) == ()


def test_an_open_energy_book_is_told():
    r = run(SOFT)
    open_ = {**r.outcome.statistics, "energy_residual_relative": 0.02}
    (found,) = doubts(r.scenario, r.mechanism, r.outcome._replace(statistics=open_))
    assert "does not close, by 2 %" in found


def test_sections_that_a_run_does_not_read_are_told():
    (found,) = told(SOFT + "sweep: {bodies.rod.mass: [1, 2]}")
    assert found.startswith("`sweep`: one run takes the scenario as it stands")


MOUNTED = """
planar: {planar}
bodies: {{b: {{mass: 1, inertia: [0.1, 0.1, 0.1], angular_velocity: [0, 0, {speed}]}}}}
forces:
  mount: {{type: bushing, bodies: [ground, b], at: [0, 0, 0], stiffness: [1, 1, 1],
          rotational_stiffness: [{k}, {k}, {k}]}}
output: {{every: 2, channels: ["{recorded}"]}}
solver: {{end: 2, tolerance: 1e-5{more}}}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("recorded", ["*", "b.velocity"])
@pytest.mark.parametrize(
    "speed, stiffness, beyond",
    # the largest turn is speed sqrt(I/k)
    [(20, 1.0, True), (5, 1e-9, True), (400, 1e-3, True), (9.95, 1.0, True), (9.0, 1.0, False)],
)
def test_bushings_turned_over_are_told(speed, stiffness, beyond, recorded, planar):
    found = told(
        MOUNTED.format(planar=planar, speed=speed, k=stiffness, recorded=recorded, more="")
    )
    assert any("forces.mount: turned by" in text for text in found) == beyond


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("first", [0.0014, 0.0527566, 0.38, 2.0])
def test_turns_of_bushings_are_not_passed_over(first, planar):
    """Steps that nothing else bounds; the first two of them ended where they had turned back."""
    more = f", first_step: {first}"
    found = told(MOUNTED.format(planar=planar, speed=5, k=1e-9, recorded="b.velocity", more=more))
    assert any("forces.mount: turned by" in text for text in found)


@pytest.mark.parametrize("place", ["0.4660195429836131, 0.18117887723833682", "0.3, 0.4"])
def test_a_balance_that_stores_nothing_is_no_open_book(place):
    """An arm that its spring holds at the length at which it is free: energies are rounding."""
    assert not told(f"""
initial: {{equilibrium: all}}
bodies: {{arm: {{mass: 1, inertia: 0.01, at: [{place}]}}}}
joints: {{p: {{type: revolute, bodies: [ground, arm], at: [0, 0]}}}}
forces:
  k: {{type: spring_damper, bodies: [ground, arm], points: [[0, 0.7], [{place}]],
      stiffness: 100, free_length: 0.5}}
solver: {{end: 0.1}}
output: {{every: 0.05}}
""")


SPUN = """
bodies: {{b: {{mass: 1, inertia: [0.02, 0.03, 0.04], angular_velocity: [0.1, 20, 0.1]}}}}
solver: {{end: 1, {method}}}
"""


@pytest.mark.parametrize("step, says", [(0.02, 3e-4), (0.005, None)])
def test_a_fixed_step_that_a_body_turns_far_in_is_told(step, says):
    """RK4 errs by x^4/120 of a turn by x: the work of no force shows that."""
    r = run(SPUN.format(method=f"method: rk4, step: {step}"))
    found = [x for x in doubts(r.scenario, r.mechanism, r.outcome) if "RK4" in x]
    exact = run(SPUN.format(method="method: dop853, tolerance: 1e-12"))
    off = np.abs(r["b.angular_velocity"][-1] - exact["b.angular_velocity"][-1]).max() / 20.0
    if says is None:
        assert not found
        assert off < 1e-5
    else:
        (one,) = found
        assert float(re.findall(r"about (\S+) of it", one)[0]) == says
        assert 1e-4 < off < 10 * says * 20.0


def test_a_method_that_chooses_its_steps_has_no_such_doubt():
    assert told(SPUN.format(method="method: dop853, tolerance: 1e-2")) == ()


RESTS = """
planar: PLANAR
bodies:
  a: {mass: 2, inertia: [0.01, 0.02, 0.03], at: [0.31, 0.2]}
  b: {mass: 3, inertia: [0.01, 0.02, 0.03], at: [0.7, 0.2]}
joints:
  h: {type: prismatic, bodies: [ground, a], axis: [1, 0.3, 0]}
  k: {type: revolute, bodies: [a, b], at: [0.45, 0.2]}
gravity: [0, 0]
forces:
  p: {type: applied_load, body: a, direction: [0.3, -1, 0], force: 1e3}
  q: {type: applied_load, body: b, at: [0.77, 0.13], direction: [0.13, -0.27, 0], force: 1e3}
  r: {type: applied_load, body: b, at: [0.77, 0.13], direction: [-0.13, 0.27, 0], force: FORCE}
events: {e: {when: t, value: 0.3, do: {DO}}}
solver: {end: 1 s}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("does", ["record: true", "lock: [h]"])
def test_what_rests_on_forces_that_balance_has_no_open_book(planar, does):
    text = RESTS.replace("PLANAR", planar).replace("DO", does)
    balanced = run(text.replace("FORCE", "1e3"))
    assert np.abs(balanced["b.velocity"]).max() < 1e-9  # rounding of the forces
    assert not doubts(balanced.scenario, balanced.mechanism, balanced.outcome)
    numbers = balanced.outcome.statistics
    assert numbers["energy_residual"] < 1e-12 * 1e3  # N m
    moved = run(text.replace("FORCE", "999.9"))  # what moves is held to what it exchanges
    assert moved.outcome.statistics["energy_residual_relative"] < 1e-6
    assert np.abs(moved["b.velocity"]).max() > 1e-6


@pytest.mark.parametrize("stored", range(len(STORED)))
def test_waves_of_what_is_at_rest_are_none(stored):
    """Kinetic energy is compared with what is stored of any kind: it is rounding, or motion."""
    beam = SimpleNamespace(length=1.0, nodes=3, stiffness=1e4, bending=1.0, per_length=1.0)
    mechanism = SimpleNamespace(model=SimpleNamespace(column_energy=2), beams={"bar": beam})
    told = {}
    for kinetic in (1e-10, 1e-8):
        peaks = np.zeros((3 + len(STORED) + 2, 5))
        peaks[2, 0], peaks[3 + stored, 0], peaks[[0, -1], 0] = kinetic, 1.0, 1e6
        ended = SimpleNamespace(peaks=peaks, statistics={"steps": 2}, record=SimpleNamespace(t=1.0))
        told[kinetic] = [*of_waves(mechanism, ended)]
    assert told[1e-10] == [] and "passed over its fastest waves" in told[1e-8][0]
