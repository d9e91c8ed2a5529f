"""A run put back to a checkpoint goes on as if nothing had happened, to the last bit."""

import numpy as np
import pytest

from tests import small
from trsim.assemble.assemble import assemble
from trsim.elements.scene import scene
from trsim.scenario.load import loads
from trsim.solve import simulate as module
from trsim.solve.simulate import simulate

from ..sizes import size

SPATIAL = (
    "planar=false",
    *(f"bodies.{b}.inertia=[1e-4, 2e-4, 2e-4]" for b in ("crank", "rod", "slider")),
)
RK4 = ("solver.method=rk4", "solver.step=1us", "solver.end=0.6ms")
FRICTION = "contact_laws.pin.friction={law: modified_coulomb, coefficient: 0.1, v0: 1e-4, v1: 1e-3}"
EVENTS = (
    "events={turned: {when: crank_angle, value: 0.4, do: {set: {motor: {velocity: 600 - 1e5*t}}}}, "
    "caught: {when: stroke, value: -5 mm, crosses: down, do: {release: [motor], lock: [O]}}, "
    "again: {when: t, value: 1.1 ms, do: {unlock: [O], record: true}}}",
)
SECTIONS = (
    "poincare={crossing: {when: B.eccentricity_x_rate, crosses: both, after: 0.2 ms, "
    "plot: [B.eccentricity_x, rod.velocity.y]}, touch: {at_onset: B, plot: [stroke, crank_angle]}, "
    "beat: {every: 7 us, after: 3 us, plot: [stroke, stroke.rate]}}",
)
PHASES = (
    "forces={wire: {type: spring, bodies: [ground, slider], points: [[-0.3, 0], [0, 0]], "
    "elastic: 20*stretch, tension_only: true, free_length: 0.2}, "
    "push: {type: applied_load, body: slider, direction: [1, 0], force: 5}}",
    "phases=[{for: 0.3 ms, taut: [wire]}, "
    "{drive: {motor: {velocity: 600 - 1e5*t}}, apply: [push], until: {when: stroke, value: -5 mm, "
    "crosses: down}, for: 9 ms, stall: {energy: 1e-9, for: 0.4 ms}}, "
    "{release: [motor], park: [crank], remove: [wire], record: true, for: 0.3 ms}, "
    "{unpark: [crank], end: done, for: 9 ms, stall: {energy: 1e-9, for: 0.5 ms}}]",
)
HEARD = (
    "events={pressed: {when: B.contact_force, value: 20, crosses: both, do: {record: true}}, "
    "pulled: {when: O.reaction.x, crosses: both, do: {record: true}}}",
)
PULSES = (
    "forces={kick: {type: applied_load, body: slider, direction: [1, 0], "
    "force: 500*(sin(3e4*t) > 0.9)}}",
    "drives.motor.velocity=abs(600 - 1e6*t)",
)
RATES = (
    "forces={gate: {type: applied_load, body: slider, direction: [1, 0], "
    "force: '30*max(stroke.rate, -1) - 40*min(crank_angle.rate, 599.9)'}, "
    "coil: {type: spring, bodies: [ground, slider], points: [[-0.3, 0], [0, 0]], "
    "elastic: '1e5*max(stretch, 0)', damper: 20*rate, damper_acts: compression}}",
)
RUBS = (
    "forces={journal: {type: joint_friction, joint: O, radius: 10 mm, friction: {law: sticking, "
    "coefficient: 0.1, stribeck_speed: 1 mm/s, bristle_stiffness: 1e4, bristle_damping: 10}}, "
    "rail: {type: joint_friction, joint: guide, length: 30 mm, friction: "
    "{law: modified_coulomb, coefficient: 0.1, v0: 0, v1: 1 mm/s}}}",
)
KINDS = [
    (),
    SECTIONS,
    SPATIAL,
    RK4,
    (*RK4, *SPATIAL),
    (FRICTION,),
    EVENTS,
    (*RK4, *EVENTS, "solver.end=1.2ms"),
    (*EVENTS, *SECTIONS),
    HEARD,
    PHASES,
    (*PHASES, "solver.method=radau"),
    PULSES,
    RATES,
    RUBS,
]
IMPLICIT = (*EVENTS, "solver.method=radau")
GGL = (*RUBS, "solver.method=radau", "solver.formulation=ggl")
TABLES = ("rows", "steps", "events", "recorded", "points")
PARTS = size(3, 5)  # of a run, at whose beginnings it is put back
KEPT = {"mem", "branch", "status"}  # of a scene: the record's, and counters


def named(sets):
    return " ".join(one.split("=")[1][:9] for one in sets) or "planar"


def blocks(sets, checkpoint=None, text=small.SLIDER_CRANK):
    """Copies of all blocks from a checkpoint on, and the outcome."""
    scenario = loads(text, sets)
    running, found = simulate(scenario, assemble(scenario), checkpoint), []
    while True:
        try:
            block = next(running)
        except StopIteration as stop:
            return found, stop.value
        tables = {n: getattr(block, n).copy() for n in TABLES}
        found.append(block._replace(**tables))


def assert_same(found, outcome, expected, unbroken):
    """The tables, extremes and statistics of two runs, bit by bit; cpu times apart."""
    for name in TABLES:
        together = [np.concatenate([getattr(b, name) for b in run]) for run in (found, expected)]
        np.testing.assert_array_equal(*together)
    np.testing.assert_array_equal(outcome.peaks, unbroken.peaks)
    assert outcome.time == unbroken.time
    statistics = [{**o.statistics, "integration_cpu": 0.0} for o in (outcome, unbroken)]
    assert statistics[0] == statistics[1]


@pytest.mark.parametrize(
    "sets", [*KINDS, IMPLICIT, (*RATES, "solver.method=radau"), GGL], ids=named
)
def test_every_state_leads_to_the_same_end(sets, monkeypatch):
    unbroken, outcome = blocks(sets)
    monkeypatch.setattr(module, "VISIT", 5)
    cut, again = blocks(sets)
    assert_same(cut, again, unbroken, outcome)  # where a run pauses does not matter
    assert len(cut) > 5
    for k in range(0, len(cut) - 1, max(1, len(cut) // PARTS)):
        rest, end = blocks(sets, cut[k].state)
        assert_same([*cut[: k + 1], *rest], end, unbroken, outcome)


CURVES = """
bodies:
  wheel: {mass: 2, inertia: [0.1, 0.1, 0.1], at: [0, 0], angular_velocity: [0, 0, 5]}
  bead: {mass: 0.3, inertia: [0.1, 0.1, 0.1], at: [0.2, 0], velocity: [0, 4]}
  stone: {mass: 0.2, inertia: [0.1, 0.1, 0.1], at: [0.6, -0.05]}
joints:
  shaft: {type: revolute, bodies: [ground, wheel], at: [0, 0]}
  ring: {type: point_on_curve, bodies: [wheel, bead], at: [0.2, 0], curve:
         {x: 0.2*cos(s), y: 0.1*sin(s), range: [0, 2*pi], closed: true}}
  line: {type: rope, through: [{body: wheel, at: [0, 0]}, {body: stone, at: [0.6, -0.05]}]}
sensors: {way: {joint: ring}}
poincare: {round: {when: way.rate, crosses: both, plot: [way, way.rate]}}
events: {far: {when: way, value: -1, crosses: down, do: {record: true}}}
gravity: [0, -9.81, 0]
solver: {end: 1}
"""
DRUM = CURVES.replace(
    "{body: wheel, at: [0, 0]}", "{body: wheel, at: [0, 0], radius: 5 cm, turn: right}"
)
BOUNCES = """
bodies:
  ball: {mass: 0.1, inertia: [1.6e-5, 1.6e-5, 1.6e-5], at: [0, 0.1, 0], velocity: [1, 0, 0]}
forces:
  floor: {type: surface_contact, surface: {body: ground, shape: plane},
          ball: {body: ball, at: [0, 0.1, 0], radius: 0.02}}
contact_laws:
  hard: {normal: poisson, stiffness: table, table: [[0, 0], [1e-6, 1], [2e-6, 4]],
         restitution: 0.6, slowest_impact: 1e-2,
         friction: {law: modified_coulomb, coefficient: 0.3, v0: 1e-4, v1: 1e-3}}
gravity: [0, -9.81, 0]
solver: {end: 0.7}
"""
SPACE, RADAU = ("planar=false",), ("solver.method=radau",)


@pytest.mark.parametrize(
    "text, sets",
    [(CURVES, ()), (CURVES, SPACE), (CURVES, RADAU), (DRUM, ()), (DRUM, RADAU), (BOUNCES, ()),
     (BOUNCES, SPACE), (BOUNCES, RADAU)],
    ids=["planar", "space", "radau", "drum", "drum, radau", "bounces", "in space", "and radau"],
)  # fmt: skip
def test_places_on_curves_turns_of_drums_and_impacts(text, sets, monkeypatch):
    unbroken, outcome = blocks(sets, text=text)
    assert outcome.status != "failed"
    monkeypatch.setattr(module, "VISIT", 5)
    cut, again = blocks(sets, text=text)
    assert len(cut) > 5
    assert_same(cut, again, unbroken, outcome)
    for k in range(0, len(cut) - 1, max(1, len(cut) // PARTS)):
        rest, end = blocks(sets, cut[k].state, text=text)
        assert_same([*cut[: k + 1], *rest], end, unbroken, outcome)


@pytest.mark.parametrize("sets", [*KINDS[:4], EVENTS, RATES, RUBS], ids=named)
def test_nothing_but_the_record_lasts(sets, monkeypatch):
    """Workspace as new and buffers full of NaN at every step: they carry nothing along."""
    unbroken, outcome = blocks(sets)

    def forgetful(s, r, b, *rest):
        if r.t > 0.0:
            for name, array in scene(s).arrays().items():
                if name not in KEPT:
                    getattr(s, name)[...] = array
            for array in b.arrays().values():
                array[...] = 7 if array.dtype == int else np.nan
            r.kept = 0  # as of a run put back: what passes.py knows is in the scene
        return march(s, r, b, *rest)

    march = module.march
    monkeypatch.setattr(module, "VISIT", 1)
    monkeypatch.setattr(module, "march", forgetful)
    assert_same(*blocks(sets), unbroken, outcome)


def test_a_checkpoint_stays_as_it_is():
    """It is a copy: the run it was taken of has gone on since."""
    scenario = loads(small.SLIDER_CRANK, ["solver.end=30ms"])
    running = simulate(scenario, assemble(scenario))
    state = next(running).state
    before = {name: array.copy() for name, array in state.items()}
    next(running)
    for name, array in state.items():
        np.testing.assert_array_equal(array, before[name])
