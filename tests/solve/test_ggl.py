"""Radau on stabilised index-2 equations: the same motion as on index 1, on its constraints,
at a cost that grows with the number of bodies."""

from math import cos, sin

import numpy as np
import pytest

from benchmarks.problems import VALIDATION, stiff_chain
from benchmarks.stress.cells import Case
from trsim.analyse.trajectory import changed
from trsim.assemble.assemble import assemble
from trsim.assemble.coupling import nodes
from trsim.assemble.equations import derivative
from trsim.assemble.reduce import jacobian
from trsim.elements.scene import scene
from trsim.errors import ScenarioError
from trsim.scenario.load import loads
from trsim.solve import simulate as module
from trsim.solve.march import record as rec
from trsim.solve.methods.ggl_tables import tables
from trsim.solve.simulate import files, simulate

from ..linkages import four_bar, slider_crank
from ..mechanisms import spherical_pendulum
from ..runs import energy_error, run
from ..small import SLIDER_CRANK
from .test_failures import LOCKING
from .test_order import LAST, REBOUND, order, rebound

GGL = ("solver.method=radau", "solver.formulation=ggl")
INDEX1 = ("solver.method=radau", "solver.formulation=index1")


# --- order -----------------------------------------------------------------------------------


def equal_steps(end, count, tolerance=1e-3):
    h = end / count
    return (*GGL, f"solver.first_step={h}", f"solver.max_step={h}", f"output.every={end}",
            f"solver.tolerance={tolerance}")  # fmt: skip


def test_order():
    """A ball that swings and turns on a ball joint: its constraints turn."""
    counts, end = (91, 128, 181, 256), 1.0
    text, position = spherical_pendulum(end=end)
    errors = []
    for count in counts:
        r = run(text, *equal_steps(end, count, 2e-5))
        assert r.outcome.statistics["steps"] == count
        errors.append(np.abs(r["ball.position"][-1] - position(end)).max())
    observed = order(counts, errors)
    print(f"order {observed:.2f}")
    assert observed == pytest.approx(5.0, abs=0.15), errors


def test_order_is_kept_through_located_events():
    counts = (64, 91, 128, 181, 256)
    errors = []
    for count in counts:
        r = run(REBOUND + f"solver: {{end: {LAST}}}", *equal_steps(LAST, count))
        assert len(r.events) == 2
        errors.append(abs(r["block.position"][-1, 0] - rebound(LAST)))
    observed = order(counts, errors)
    print(f"order {observed:.2f} through a touch and a separation")
    assert observed > 4.85, errors


# --- the same motion ---------------------------------------------------------------------------

SPATIAL = (
    "planar=false",
    *(f"bodies.{b}.inertia=[1e-4, 2e-4, 2e-4]" for b in ("crank", "rod", "slider")),
)
GRAVITY = "gravity=[5, -9.81, 0]"
SAME = {
    "four-bar": (four_bar("true", end=0.5), (GRAVITY,)),
    "four-bar in space, 3 rows redundant": (four_bar("false", end=0.5), (GRAVITY,)),
    "slider-crank": (slider_crank("true"), (GRAVITY,)),
    "driven slider-crank": (SLIDER_CRANK, ("joints.B.clearance=0",)),
    "driven slider-crank in space": (SLIDER_CRANK, ("joints.B.clearance=0", *SPATIAL)),
    # its unit of length is the penetration: 1e-10 of it is the rounding of the crank's radius
    "play": (SLIDER_CRANK, ("solver.end=1ms", "solver.tolerance=1e-9")),
}


@pytest.mark.parametrize("text, sets", SAME.values(), ids=SAME)
def test_same_motion_as_on_index_1(text, sets):
    sets = ("solver.tolerance=1e-11", *sets)
    a, b = run(text, *sets, *GGL), run(text, *sets, *INDEX1)
    assert len(a.events) == len(b.events)
    for name in a.place:
        if name.endswith((".position", ".rotation", ".velocity")):
            scale = max(1.0, np.abs(b[name]).max())
            assert np.abs(a[name] - b[name]).max() < 1e-9 * scale, name
    told = a.outcome.statistics
    print({k: told[k] for k in ("steps", "rejected_steps", "newton_iterations")})
    assert told["rejected_steps"] < 0.1 * told["steps"]
    assert told["energy_residual_relative"] < 1e-9


@pytest.mark.parametrize("kind", ["chain_10", "bending_chain_10"])
def test_same_chain_as_on_index_1(kind):
    text = (VALIDATION / f"{kind}.yaml").read_text()
    a, b = (run(text, "solver.tolerance=1e-11", *sets) for sets in (GGL, INDEX1))
    for name in ("rod9.position", "rod9.velocity"):
        assert np.abs(a[name] - b[name]).max() < 1e-9, name


def ended(text, *sets):
    """The mechanism and the outcome of a run."""
    r = run(text, *sets)
    return r.mechanism, r.outcome


@pytest.mark.parametrize("text, sets", SAME.values(), ids=SAME)
def test_the_ends_of_steps_are_on_the_constraints(text, sets):
    mechanism, outcome = ended(text, *sets, *GGL, "solver.tolerance=1e-9")
    s, y = scene(mechanism.model), outcome.record.y
    t, yd = float(outcome.record.t), np.zeros(len(outcome.record.y))
    derivative(s, t, y, yd)
    assert np.abs(s.phi).max() < 1e-14 * max(1.0, s.size)
    rates = jacobian(s, t, y)
    v = s.V[1:].ravel()
    assert np.abs(rates[2] @ v + rates[1]).max() < 1e-13 * max(1.0, np.abs(v).max())
    told = outcome.statistics  # of the method itself: before the projection
    print({k: told[k] for k in ("position_residual", "velocity_residual")})
    assert told["position_residual"] < 1e-9 * s.size
    assert told["work_of_projection_relative"] < 1e-9


# of the stress table: clearance, restitution, friction, speed, stiffness
HARD = Case("transfer rod P+Q", 1e-4, 0.5, 0.0, 2.0, 1e-3, ())


def test_loaded_contacts_of_a_driven_mechanism():
    """Newton's method meets stiff dampers right after every touch, at a coarse tolerance."""
    drawn = HARD.scenario()
    told = {}
    for formulation in ("ggl", "index1"):
        solver = {"method": "radau", "tolerance": 1e-5, "formulation": formulation}
        r = run(changed(drawn, "solver", **solver))
        told[formulation] = r.outcome.statistics["rejected_steps"]
        assert energy_error(r) < 1e-6
    print(f"rejected: {told}")
    assert told["ggl"] < 2 * told["index1"] + 10


# --- stiff springs -------------------------------------------------------------------------------


SPUN = """
bodies:
  carrier:
    mass: 0.04
    inertia: [5.0e-8, 1.7e-7, 1.8e-7, 4.0e-8, -1.5e-8, 4.0e-9]
    at: [3.0e-3, -1.0e-3, 1.0e-3]
    velocity: [0.113, 0.339, 0]
    angular_velocity: [0, 0, 113]
  load:
    mass: 0.03
    inertia: [2.1e-7, 2.3e-7, 1.7e-7, 5.5e-8, 8.0e-8, -7.0e-8]
    at: [9.0e-3, -4.0e-3, -3.0e-3]
    velocity: [0.452, 1.017, 0]
    angular_velocity: [0, 0, 113]
joints:
  hinge: {type: revolute, bodies: [ground, carrier], at: [0, 0, 0], axis: [0, 0, 1]}
  knee: {type: revolute, bodies: [carrier, load], at: [6.0e-3, -2.0e-3, 1.0e-3], axis: AXIS}
forces:
  spring: {type: torsion_spring, joint: knee, stiffness: 60, damping: 2.6e-3}
solver: {end: 0.06}
output: {every: 2.5e-3}
"""


@pytest.mark.parametrize(
    ("axis", "tolerance"),
    [([2, -1, 1], 3e-6), ([-1, 1, 2], 3e-6), ([-1, 1, 2], 1e-7), ([1, 0, 0.2], 3e-6),
     ([1, 0, 0.2], 3e-5)],
)  # fmt: skip
def test_what_holds_positions_is_not_felt_by_a_stiff_spring(axis, tolerance):
    """Once its vibration has died out both bodies turn evenly about a fixed axis: no angular
    acceleration.  Four of these were off by 106 to 453 tolerances of the largest."""
    r = run(SPUN.replace("AXIS", str(axis)), *GGL, f"solver.tolerance={tolerance}")
    late = r.t > 0.02
    turning = [np.abs(r[f"{name}.angular_acceleration"]) for name in ("carrier", "load")]
    places = [np.abs(r[f"{name}.acceleration"]).max() for name in ("carrier", "load")]
    largest = max(np.max(turning), max(places) / 0.01)
    assert max(x[late].max() for x in turning) < 100 * tolerance * largest


# --- singular positions ------------------------------------------------------------------------


def test_singular_positions_are_passed():
    """Two windows turn over and over; every half turn their rows lose rank."""
    sets = ("solver.end=3", "solver.tolerance=1e-9")
    text = (VALIDATION / "windows_2.yaml").read_text()
    a, b = run(text, *sets, *GGL), run(text, *sets, "solver.method=dop853")
    assert np.abs(a["theta"] - b["theta"]).max() < 1e-5
    assert np.ptp(a["theta"]) > np.pi  # it did pass one
    assert energy_error(a) < 1e-8
    told = a.outcome.statistics
    print({k: told[k] for k in ("steps", "rejected_steps", "newton_iterations")})
    assert told["steps"] + told["rejected_steps"] < 20_000


def test_a_crank_that_cannot_turn_through_is_told():
    r = run(LOCKING.format("method: radau, formulation: ggl, tolerance: 1e-4"), fails=True)
    assert "locks" in r.outcome.reason
    assert np.all(np.isfinite(r.rows))


# --- events, stages, checkpoints ---------------------------------------------------------------

EVENTS = (
    "events={turned: {when: crank_angle, value: 0.4, do: {set: {motor: {velocity: 600 - 1e5*t}}}}, "
    "caught: {when: stroke, value: -5 mm, crosses: down, do: {release: [motor], lock: [O]}}, "
    "again: {when: t, value: 1.1 ms, do: {unlock: [O], record: true}}}",
)


def blocks(sets, checkpoint=None):
    scenario = loads(SLIDER_CRANK, [*sets, *GGL])
    running, found = simulate(scenario, assemble(scenario), checkpoint), []
    while True:
        try:
            block = next(running)
        except StopIteration as stop:
            return found, stop.value
        found.append(block._replace(rows=block.rows.copy(), events=block.events.copy()))


@pytest.mark.parametrize("sets", [EVENTS, (*EVENTS, *SPATIAL)], ids=["planar", "spatial"])
def test_events_that_change_the_equations(sets):
    a, b = (run(SLIDER_CRANK, *sets, *f, "solver.tolerance=1e-9") for f in (GGL, INDEX1))
    assert a.outcome.fired == b.outcome.fired
    assert set(a.outcome.fired) == {"turned", "caught", "again"} and all(a.outcome.fired.values())
    early = a.t < 1.5e-3  # it is chaotic later
    assert np.abs(a["stroke"] - b["stroke"])[early].max() < 1e-8


@pytest.mark.parametrize("sets", [(), EVENTS, (*EVENTS, *SPATIAL)], ids=["", "events", "spatial"])
def test_every_state_leads_to_the_same_end(sets, monkeypatch):
    sets = (*sets, "solver.end=1.5ms")
    unbroken, outcome = blocks(sets)
    monkeypatch.setattr(module, "VISIT", 50)
    cut, again = blocks(sets)

    def same(found, told):
        for name in ("rows", "events"):
            np.testing.assert_array_equal(
                np.concatenate([getattr(b, name) for b in found]),
                np.concatenate([getattr(b, name) for b in unbroken]),
            )
        quiet = {"integration_cpu": 0.0}
        assert {**told.statistics, **quiet} == {**outcome.statistics, **quiet}

    same(cut, again)
    for k in range(0, len(cut) - 1, max(1, len(cut) // 4)):
        rest, end = blocks(sets, cut[k].state)
        same([*cut[: k + 1], *rest], end)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_bar_falls_as_a_whole_beside_a_weight_on_a_pivot(planar):
    r = run(
        f"""
planar: {planar}
bodies:
  weight: {{mass: 2, inertia: [1, 1, 1], at: [0.5, 0]}}
  bar: {{type: ancf_cable, start: [0, 0], end: [1, 0], elements: 2, section: {{diameter: 20 mm}},
        youngs_modulus: 10 MPa, density: 1000 kg/m^3}}
joints: {{pivot: {{type: revolute, bodies: [ground, weight], at: [0, 0]}}}}
drives: {{turn: {{joint: pivot, position: 100*t}}}}
gravity: [3, -9.81, 0]
solver: {{end: 10 ms, tolerance: 1e-6, max_steps: 200}}
output: {{every: 10 ms}}
""",
        *GGL,
    )
    for node, x in enumerate((0.0, 0.5, 1.0)):
        place = [x + 3 * 5e-5, -9.81 * 5e-5, 0.0]
        assert r[f"bar.node{node}.position"][-1] == pytest.approx(place, abs=1e-9)
    assert r["weight.position"][-1] == pytest.approx([0.5 * cos(1), 0.5 * sin(1), 0], abs=1e-9)
    pull = np.array([-1e4 * cos(1) - 2 * 3, -1e4 * sin(1) + 2 * 9.81, 0.0])
    assert r["pivot.reaction"][-1] == pytest.approx(pull, abs=1e-5)


def test_multipliers_are_found_with_the_stages():
    """A swing takes some 200 steps, thousands where Newton's method does not find lam and mu."""
    r = run(
        """
planar: true
bodies: {bob: {mass: 2, inertia: 0.01, at: [0.5, 0]}}
joints: {pivot: {type: revolute, bodies: [ground, bob], at: [0, 0]}}
gravity: [0, -9.81]
solver: {end: 0.5, tolerance: 1e-8, max_steps: 1000}
output: {every: 0.1}
""",
        *GGL,
    )
    kinetic = 0.5 * (2 * 0.5**2 + 0.01) * r["bob.angular_velocity"][:, 2] ** 2
    assert kinetic == pytest.approx(-2 * 9.81 * r["bob.position"][:, 1], abs=1e-6)


# --- large models --------------------------------------------------------------------------------


def test_a_step_of_a_long_stiff_chain_costs_what_its_bodies_cost():
    """Work is counted, not timed: entries of the factors, evaluations of a Jacobian, steps."""
    told = {}
    for n in (20, 40, 80):
        text = stiff_chain(n)
        scenario = loads(text)
        mechanism = assemble(scenario)
        found = nodes(mechanism)
        table = tables(found, mechanism, mechanism.model)
        r = run(text, *GGL)
        told[n] = {
            "entries": len(table["lower"]) / n,
            "groups": len(table["group_start"]) - 1,
            "steps": r.outcome.statistics["steps"],
            "jacobians": r.outcome.statistics["jacobians"],
        }
    print(told)
    assert told[80]["entries"] < 1.05 * told[20]["entries"]
    assert told[80]["groups"] == told[20]["groups"] == 9
    assert told[80]["steps"] < 1.5 * told[20]["steps"]


def test_a_stiff_chain_moves_as_on_index_1():
    a, b = (run(stiff_chain(8), *f, "solver.tolerance=1e-9") for f in (GGL, INDEX1))
    tip = "rod7.position"
    assert np.abs(a[tip] - b[tip]).max() < 1e-10
    steps = [r.outcome.statistics["steps"] for r in (a, b)]
    print(f"steps {steps}")
    assert steps[0] <= steps[1]


def test_the_formulation_is_found_out():
    def chosen(n, *sets):
        scenario = loads(stiff_chain(n), sets)
        return files(scenario, assemble(scenario))

    assert chosen(9) == ("radau",)
    assert chosen(10) == ("radau_ggl",)
    assert chosen(10, "solver.method=auto") == ("dop853", "radau_ggl")
    assert chosen(10, "solver.formulation=index1") == ("radau",)
    assert chosen(2, "solver.formulation=ggl") == ("radau_ggl",)
    held = ("solver.stabilisation=baumgarte", "solver.baumgarte={alpha: 5, beta: 5}")
    assert chosen(10, *held) == ("radau",)
    with pytest.raises(ScenarioError, match="ggl needs no baumgarte"):
        chosen(10, *held, "solver.formulation=ggl")


def test_auto_hands_over_to_it():
    text = stiff_chain(10)
    r = run(text, "solver.method=auto", "solver.tolerance=1e-5")
    kinds = r.events[:, rec.EVENT_KIND]
    assert rec.TO_IMPLICIT in kinds
    b = run(text, *INDEX1, "solver.tolerance=1e-8")
    assert np.abs(r["rod9.position"] - b["rod9.position"]).max() < 1e-5


HARD_STOP = """
gravity: [0, -9.81, 0]
planar: false
solver: {{end: 0.02, method: {method}}}
bodies:
{bodies}
joints:
{joints}
forces:
{springs}
  stop: {{type: limit_stop, point: {{body: b5, at: [0.3, 0]}}, stiffness: 1e9, damping: 10,
         wall: {{body: ground, at: [0, 0], normal: [0, 1, 0]}}}}
"""


@pytest.mark.parametrize("method", ["auto", "radau"])
def test_a_hard_stop_at_the_end_of_a_stiff_chain(method):
    """The touch begins with the run; sparse Newton systems took its rounding for error."""
    inertia = "mass: 0.1, inertia: [1e-5, 3e-5, 3e-5]"
    bodies = [f"  b{k}: {{{inertia}, at: [{0.025 + 0.05 * k}, 0]}}" for k in range(6)]
    joints = [
        f"  j{k}: {{type: revolute, bodies: [{f'b{k - 1}' if k else 'ground'}, b{k}], "
        f"at: [{0.05 * k}, 0], axis: {[0, k % 2, 1 - k % 2]}}}"
        for k in range(6)
    ]
    springs = [
        f"  t{k}: {{type: torsion_spring, joint: j{k}, stiffness: 5e4, damping: 50}}"
        for k in range(6)
    ]
    words = {"bodies": bodies, "joints": joints, "springs": springs}
    text = HARD_STOP.format(method=method, **{k: "\n".join(v) for k, v in words.items()})
    r = run(text)
    assert r.outcome.status == "done"
    assert r.outcome.statistics["energy_residual_relative"] < 1e-6
    exact = run(text, "solver.method=dop853", "solver.tolerance=1e-10")
    assert r["b5.position"][-1] == pytest.approx(exact["b5.position"][-1], abs=1e-8)
