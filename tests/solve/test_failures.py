"""A law that leaves the finite numbers ends the run with a reason; no row is ever NaN."""

import numpy as np
import pytest

from trsim.errors import ModelError
from trsim.solve.diagnose.locked import locked

from ..overconstrained import TILTED
from ..runs import run
from .test_branches import flat, turning

PUSHED = """
gravity: [0, -9.81]
bodies: {{rod: {{mass: 2, inertia: 0.05, at: [0.4, 0]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
{}
solver: {{end: 0.2, {}}}
"""
FORCE = 'forces: {{f: {{type: applied_load, body: rod, direction: [0, 1], force: "{}"}}}}'
LAWS = {
    "log": FORCE.format("log(0.1 - t)"),
    "overflow": FORCE.format("1e300*exp(1000*t)"),
    "pole": FORCE.format("1/(0.1 - t)**2"),
    "table": FORCE.replace('"{}"', "{}").format(
        "{table: [[0, 0], [0.05, 1], [0.1, 2]], ends: refuse}"),
    "drive": 'drives: {d: {joint: hinge, velocity: "sqrt(0.1 - t)"}}',
}  # fmt: skip
METHODS = {"dop853": "method: dop853", "rk4": "method: rk4, step: 1e-4"}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.filterwarnings("ignore:overflow:RuntimeWarning")
def test_ends_failed_with_a_reason_and_without_nan(law, method):
    r = run(PUSHED.format(LAWS[law], METHODS[method]), fails=True)
    assert r.outcome.status == "failed" and r.outcome.reason
    assert np.isfinite(r.rows).all()
    assert np.all(np.diff(r.t) > 0.0)
    if law in ("log", "pole", "table", "drive"):
        assert r.outcome.time == pytest.approx(0.1, abs=2e-4)


def test_a_force_that_is_no_number_at_the_start_is_refused():
    with pytest.raises(ModelError, match=r"forces\.f") as caught:
        run(PUSHED.format(FORCE.format("log(-1 - t)"), METHODS["dop853"]))
    assert caught.value.exit_code == 4


@pytest.mark.parametrize("method", [*METHODS.values(), "method: radau", "method: 'scipy:RK45'"])
@pytest.mark.parametrize(
    ("law", "name", "what"),
    [
        ("log", "forces.f.force", "at t = 0.1 s log is taken of 0.1 - t, which becomes negative"),
        ("table", "forces.f", "is not a finite number beyond t"),
        ("drive", "drives.d.velocity", "at t = 0.1 s sqrt is taken of 0.1 - t"),
    ],
)
def test_reason_names_what_is_not_finite(law, name, what, method):
    r = run(PUSHED.format(LAWS[law], method), fails=True)
    assert r.outcome.reason.startswith(f"{name} (<text>:5:") and what in r.outcome.reason


@pytest.mark.parametrize("motion", ["velocity: log(t)", "velocity: sqrt(-1 - t)", "position: 1/t",
                                    "velocity: sqrt(t)", "position: log(t)"])  # fmt: skip
@pytest.mark.parametrize("more", ["", ", compliance: {stiffness: 1e3}"])
def test_a_drive_that_is_no_number_at_the_start_is_refused(motion, more):
    if motion == "velocity: sqrt(t)" and more:
        return  # a compliant drive does not ask for the acceleration
    with pytest.raises(ModelError, match=r"drives\.d: its motion or acceleration is not a finite"):
        run(PUSHED.format(f"drives: {{d: {{joint: hinge, {motion}{more}}}}}", METHODS["dop853"]))


@pytest.mark.parametrize("law", ["1/(0.1 - t)**2", "10*exp(1e4*t)"])
@pytest.mark.parametrize("method", [*METHODS.values(), "method: radau", "method: 'scipy:RK45'"])
@pytest.mark.filterwarnings("ignore:overflow:RuntimeWarning")
def test_what_runs_away_is_not_followed(law, method):
    free = PUSHED.replace("hinge: {{type: revolute, bodies", "guide: {{type: prismatic, bodies")
    text = free.replace("at: [0, 0]}}", "at: [0, 0], axis: [0, 1]}}").format(
        FORCE.format(law), method
    )
    r = run(text, fails=True)
    assert r.outcome.time < 0.1001
    assert r.outcome.statistics["evaluations"] < 4e6  # near the pole the rounding of t is felt
    told = (
        "'rod' is faster",
        "without bound",
        "fixed step is too large",
        "divides by (0.1 - t)**2",
    )
    assert any(words in r.outcome.reason for words in told)


def test_step_limit():
    r = run(PUSHED.format("", "max_steps: 3, max_step: 1e-6"), fails=True)
    assert "3 steps" in r.outcome.reason


UNEQUAL = """
gravity: [0, -9.81]
bodies: {{bob: {{mass: 1, inertia: {}, at: [1, 0]}}}}
joints: {{pivot: {{type: revolute, bodies: [ground, bob], at: [0, 0]}}}}
solver: {{end: 2, tolerance: 1e-7}}
"""


def test_rows_the_arithmetic_cannot_tell_apart_are_not_passed():
    """At 1e-12 kg*m^2 and 1 m of arm the pivot's two rows differ by 1e-12 of themselves."""
    r = run(UNEQUAL.format(1e-12), fails=True)
    assert "unequal" in r.outcome.reason
    assert r.outcome.statistics["energy_residual"] < 1e-6
    assert run(UNEQUAL.format(1e-6)).outcome.statistics["energy_residual"] < 1e-5


LOCKING = """
bodies:
  crank: {{mass: 1, inertia: 0.01, at: [0.1, 0.0]}}
  coupler: {{mass: 2, inertia: 0.05, at: [0.25, 0.1]}}
  rocker: {{mass: 2, inertia: 0.05, at: [0.4, 0.1]}}
joints:
  A: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  B: {{type: revolute, bodies: [crank, coupler], at: [0.2, 0]}}
  C: {{type: revolute, bodies: [coupler, rocker], at: [0.4, 0.2]}}
  D: {{type: revolute, bodies: [ground, rocker], at: [0.4, 0]}}
drives: {{motor: {{joint: A, velocity: 1 rad/s}}}}
solver: {{end: 10 s, {}}}
"""


@pytest.mark.parametrize(
    "method",  # implicit ones meet it as exactly at any tolerance, in a tenth of the steps
    ["auto", "radau, tolerance: 1e-5", "rk4, step: 1e-3", "generalized_alpha, tolerance: 1e-3"],
)
def test_a_crank_that_cannot_turn_through(method):
    """It locks where coupler (0.2828 m) and rocker (0.2 m) lie stretched between crank and D."""
    r = run(LOCKING.format(f"method: {method}"), fails=True)
    stretched = 0.2 + np.hypot(0.2, 0.2)
    angle = np.arccos((0.2**2 + 0.4**2 - stretched**2) / (2 * 0.2 * 0.4))
    assert r.outcome.time == pytest.approx(angle, abs=2e-3 if "rk4" in method else 1e-5)
    assert r.outcome.statistics["position_residual"] < 1e-2
    if "rk4" not in method:
        assert "the mechanism locks here: " in r.outcome.reason
        assert "motor" in r.outcome.reason and "D" in r.outcome.reason
    else:
        assert "jams" in r.outcome.reason or "locks" in r.outcome.reason


NEARLY_EQUAL = """
bodies:
  crank: {{mass: 1, inertia: 0.01, at: {}}}
  coupler: {{mass: 1, inertia: 0.1, at: {}}}
  rocker: {{mass: 1, inertia: 0.01, at: {}}}
joints:
  O: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  A: {{type: revolute, bodies: [crank, coupler], at: {}}}
  B: {{type: revolute, bodies: [coupler, rocker], at: {}}}
  D: {{type: revolute, bodies: [ground, rocker], at: [1, 0]}}
drives: {{motor: {{joint: O, velocity: 5 rad/s}}}}
solver: {{end: {}, tolerance: 1e-6}}
"""


def test_a_place_where_branches_nearly_meet_is_not_said_to_lock():
    """Cranks of 0.3 and 0.3000003 m: at 2 pi the second turns back within a thousandth rad."""
    short, long, gap = 0.3, 0.3 * (1 + 1e-6), 1.4e-3
    A = short * np.array([np.cos(1.0), np.sin(1.0)])
    D = np.array([1.0, 0.0])
    B = meet(A, 1.0, D, long)
    at = [x.tolist() for x in (A / 2, (A + B) / 2, (B + D) / 2, A, B)]
    r = run(NEARLY_EQUAL.format(*at, (2 * np.pi - 1.0 - gap) / 5.0))
    said = locked(r.mechanism, r.outcome.time, r.outcome.record.y)
    assert "nearly meet" in said and "the motion goes on" in said and "locks" not in said


def meet(P, r, Q, s):
    """Where circles about P and Q meet, to the left of the way from Q to P."""
    way = Q - P
    d = np.hypot(*way)
    x = (d * d + r * r - s * s) / (2 * d)
    return P + (x * way + np.sqrt(r * r - x * x) * np.array([-way[1], way[0]])) / d


@pytest.mark.parametrize("method", ["auto", "generalized_alpha"])
def test_one_that_locks_where_all_its_joints_lie_in_line(method):
    """Three cranks, a lock of one while they are flat: nothing moves but to first order.

    Whichever rows are chosen, they depend on each other a step later; it went on for ever.
    """
    lock = "do: {lock: [T1]}"
    event = f"events: {{a: {{when: q, value: -2e-8, crosses: both, times: 1, {lock}}}}}"
    made = flat(3, f"sensors: {{q: {{joint: F0}}}}\n{event}", TILTED, end=0.9)
    # extremes of forces, which are without bound here, are sought for long
    ways = (f"solver.method={method}", "solver.tolerance=3e-6", "output.channels=[]")
    r = run(made, *turning(3, -4.0, np.asarray(TILTED)), *ways, fails=True)
    assert "the mechanism locks here: " in r.outcome.reason
    # at 4 rad/s, until joints would be open by the tolerance: theta^2 / 2
    assert r.outcome.time < np.sqrt(2.0 * 3e-6) / 4.0
