"""Friction passes its corners at located points, and nowhere else."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trsim.laws.contact import ramped_damping
from trsim.laws.friction import beyond, branch_of, modified_coulomb, neighbour, on_branch
from trsim.scenario.load import load
from trsim.solve.march import sensed

from ..linkages import REVERSER
from ..mechanisms import p1_slider_crank
from ..runs import run

V0, V1, MU = 1e-4, 1e-3, 0.3


@pytest.mark.parametrize("v", [-2e-3, -V1, -5e-4, -V0, -5e-5, 0.0, 5e-5, V0, 5e-4, V1, 2e-3])
def test_branches_are_the_law(v):
    branch = branch_of(v, V0, V1)
    assert on_branch(branch, 7.0, v, MU, V0, V1) == pytest.approx(
        modified_coulomb(7.0, v, MU, V0, V1), abs=1e-15
    )
    assert beyond(branch, v, V0, V1) <= 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("corner, below, above", [(V0, 0.0, 1.0), (V1, 1.0, 2.0)])
def test_a_corner_leads_to_the_neighbour(corner, below, above, sign):
    v = sign * corner
    assert beyond(sign * below, v, V0, V1) == pytest.approx(0.0, abs=1e-18)
    assert beyond(sign * above, v, V0, V1) == pytest.approx(0.0, abs=1e-18)
    assert neighbour(sign * below, v, V0, V1) == sign * above
    assert neighbour(sign * above, v, V0, V1) == sign * below
    # the two branches meet there, so nothing jumps
    assert on_branch(sign * below, 7.0, v, MU, V0, V1) == pytest.approx(
        on_branch(sign * above, 7.0, v, MU, V0, V1), abs=1e-12
    )


def test_methods_meet_the_same_corners():
    """Two methods of different kind and order pass the same corners and agree."""
    runs = [
        run(p1_slider_crank(friction=True, tolerance=1e-8), f"solver.method={method}")
        for method in ("dop853", "radau")
    ]
    corners = [r.outcome.statistics["corners"] for r in runs]
    assert corners[0] == corners[1] > 0
    v = [r["slider.velocity"][:, 0] for r in runs]
    assert np.abs(v[0] - v[1]).max() < 1e-5 * np.abs(v[0]).max()


LOADED = """
planar: true
bodies: {journal: {mass: 0.5, inertia: 1e-3, at: [0, 0]}}
joints: {pin: {type: revolute, bodies: [ground, journal], at: [0, 0], clearance: 0.1 mm,
               contact: steel}}
contact_laws:
  steel: {normal: lankarani_nikravesh, stiffness: 1e10, bearing_radius: 10 mm, restitution: 0.9,
          friction: {law: modified_coulomb, coefficient: 0.3, v0: 1e-4, v1: 1e-3}}
forces:
  load: {type: applied_load, body: journal, at: [0, 0], direction: [0, -1],
         force: "500*smoothstep(t/0.02)"}
  turn: {type: applied_load, body: journal, direction: [0, 0, 1],
         torque: "0.5*smoothstep((t - 0.05)/0.05)"}
solver: {end: 0.2 s, tolerance: 1e-6}
output: {every: 1 ms}
"""


def test_a_loaded_journal_creeps_at_the_balance_of_friction():
    """The slow slip at which friction balances the load: a stiff rest, for `auto` to find.

    The journal settles where tangential force and torque are in balance: the friction force is
    torque / radius, and its speed lies on the ramp.
    """
    r = run(LOADED)
    numbers = r.outcome.statistics
    assert numbers["method_switches"] >= 1, "an explicit method would need a million steps"
    assert numbers["steps"] < 3000
    radius = 0.01 - 1e-4  # the journal's
    F = abs(r["pin.friction_force"][-1])
    assert abs(F * radius - 0.5) < 5e-4
    N = r["pin.normal_force"][-1]
    assert np.hypot(N, F) == pytest.approx(500.0, rel=1e-3)
    speed = abs(r["pin.sliding_speed"][-1])
    assert speed == pytest.approx(V0 + (V1 - V0) * F / (MU * N), rel=1e-2)


@pytest.mark.parametrize("sets", [["solver.tolerance=0.03"], ["solver.tolerance=0.1"],
                                  ["solver.tolerance=1e-4", "output.every=2e-6"]])  # fmt: skip
def test_corners_do_not_hold_a_run(sets):
    """Both branches sending the motion back to the other, in steps too long for what they meet.

    Four loaded pins stick and slip: these runs stood still for ever at a corner, 0.3 .. 0.5 s.
    """
    ways = ("solver.end=0.51", "solver.max_steps=60000", "output.channels=[]")
    scenario = load(REVERSER / "clearance_abpq_0.1mm.yaml", [*ways, *sets])
    r = run(scenario)
    assert r.outcome.status == "done"
    assert r.outcome.statistics["corners"] > 1000


BUMPER = """
bodies: {block: {mass: 2, inertia: 0.01, velocity: [0.5, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
forces:
  bumper: {type: limit_stop, joint: slide, upper: 20 mm, stiffness: 1e5, damping: DAMPING,
           ramp: 0.5 mm}
solver: {end: 0.15 s, tolerance: 1e-8, method: METHOD}
output: {every: 0.15 s}
"""


@cache
def rebound(damping, k=1e5, mass=2.0, ramp=5e-4, speed=0.5):
    """Speed after the stop, of one equation: the law as it is written, in steps of 1/100 of the
    ramp or less; those of 1/1000 give the same to 4e-11."""

    def rates(_, y):
        return [y[1], -ramped_damping(y[0], y[1], k, damping, ramp) / mass]

    def out(_, y):
        return y[0]

    out.terminal, out.direction = True, -1.0
    return solve_ivp(
        rates, (0.0, 1.0), [0.0, speed], "DOP853", rtol=1e-12, atol=1e-14, events=out,
        max_step=1e-2 * ramp / speed,
    ).y[1, -1]  # fmt: skip


@pytest.mark.parametrize("method", ["dop853", "radau", "scipy:RK45"])
@pytest.mark.parametrize(("damping", "corners"), [(20, 2), (200, 3), (1200, 3)])
def test_stops_pass_the_end_of_their_ramp_and_where_they_would_pull(damping, corners, method):
    r = run(BUMPER.replace("DAMPING", str(damping)).replace("METHOD", method))
    assert r["block.velocity"][-1, 0] == pytest.approx(rebound(damping), rel=1e-7)
    assert r.outcome.statistics["corners"] == corners


def test_a_stop_that_stops_pulling_pushes_again_before_it_is_left():
    """Below its ramp the spring is stronger than the damper: three corners on its way out."""
    r = run(BUMPER.replace("DAMPING", "150").replace("METHOD", "dop853"))
    assert r["block.velocity"][-1, 0] == pytest.approx(rebound(150), rel=1e-7)
    assert r.outcome.statistics["corners"] == 4


@pytest.mark.parametrize("jump", [0.0, 1.0, 2.0, 1e4])
def test_a_step_onto_another_piece_is_cut_to_what_that_does(monkeypatch, jump):
    """By four until `jump` times it is a twentieth of the speed; what functions are held on stays
    as it is, and so do the pieces before."""
    s = SimpleNamespace(n_q=1, n_v=1, tab=np.array([9.0, 5.0]), held=np.array([1]))
    r = SimpleNamespace(h=1.0, y=np.array([0.3, 2.0]), yd=np.array([2.0, 0.0]))
    b = SimpleNamespace(
        weight=np.ones(2), y2=np.zeros(2), K=np.zeros((3, 2)), before=np.array([4.0])
    )

    def evaluate(s, t, y, yd):  # the piece of before pushes by `jump` more
        yd[1] = jump * (s.tab[1] == 4.0)

    monkeypatch.setattr(sensed, "evaluate", evaluate)
    monkeypatch.setattr(sensed, "swap", sensed.swap.python)
    assert sensed.ease.python(s, r, b, 0.0) == (jump > 0.0)
    least = 1.0
    while jump * least > 0.05 * 2.0:
        least *= 0.25
    assert r.h == least
    assert (s.tab.tolist(), b.before.tolist()) == ([9.0, 5.0], [4.0])


@pytest.mark.parametrize("fixed, told", [(0.0, sensed.UNCERTAIN), (1.0, sensed.NONE)])
def test_a_search_that_gives_up_asks_for_a_shorter_step_where_there_is_one(
    monkeypatch, fixed, told
):
    s = SimpleNamespace(sensed=np.zeros((1, 3), int), S=np.zeros((1, 2)))
    b = SimpleNamespace(t=0.0, h=1.0, shown=np.zeros((1, 2)), seen=np.zeros((1, 4)))
    r = SimpleNamespace(unproved=0)
    looks = []
    for name, stand_in in {
        "LOOKS": 3, "spread": lambda *_: (0.0, 0.0), "hidden_depth": lambda *_: 0.0,
        "see": lambda *_: None, "limit": lambda *_: None,
        "show": lambda s, r, b, high: looks.append(high), "verdict": lambda *_: sensed.UNSURE,
    }.items():  # fmt: skip
        monkeypatch.setattr(sensed, name, stand_in)
    setting = SimpleNamespace(fixed_step=fixed, t_end=1.0)
    assert sensed.first_corner.python(s, r, b, setting) == told
    assert r.unproved == 1 and looks == [1.0, 0.5, 0.25]
