"""Works of the energy book are right to the tolerance where motion is prescribed, whatever the
residual of the book says: it is closed by drives and loads that are wrong by the same amount."""

from itertools import pairwise
from math import exp, pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad

from trsim.assemble.equations import derivative
from trsim.elements.contract import N_BOOK
from trsim.elements.scene import scene
from trsim.laws.tables import akima, cubics
from trsim.solve.diagnose.doubts import of_books
from trsim.solve.methods import scipy_ivp
from trsim.solve.methods.scipy_ivp import books

from ..runs import built, run

STROKE = """
bodies: {{block: {{mass: 2, inertia: [0.01, 0.01, 0.01]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: {axis}}}}}
drives: {{pull: {{joint: slide, {drive}}}}}
sensors: {{x: {{joint: slide}}}}
forces:
  load: {{type: applied_load, body: block, direction: {axis}, force: {force}}}
solver: {{end: {end}, {solver}}}
output: {{every: {every}}}
"""
KNOTS = ((0, 0), (0.1, -500), (0.3, -1000), (0.4, -900), (0.45, -300), (0.6, -250), (1, 0))
TABLE = np.array(cubics(*np.array(KNOTS, float).T, "hold"))

# along a stroke of 1 m: the load, and its work
LOADS = {
    "triangle": ('"-max(0, 1000*(1 - abs(x - 0.5)/0.05))"', -50.0),
    "bump": ('"-1000*exp(-((x - 0.37)/0.02)**2)"', -20.0 * sqrt(pi)),
    "periods": ('"-1000*sin(2*pi*25*x)**2"', -500.0),
    "table": (
        f"{{table: {[list(k) for k in KNOTS]}, of: x}}",
        sum(
            quad(lambda u: akima(TABLE, 0, len(KNOTS), u)[0], a[0], b[0], epsabs=1e-11)[0]
            for a, b in pairwise(KNOTS)
        ),
    ),
}
METHODS = ("dop853", "radau", "auto", "generalized_alpha", "scipy:RK45", "scipy:Radau")
ROUGH = {"generalized_alpha": 10.0, "scipy:RK45": 20.0, "scipy:Radau": 20.0, "scipy:BDF": 100.0}


def stroke(load, method, tolerance, end=1.0, drive=None, axis="[1, 0, 0]", every=0.05):
    force, work = LOADS[load]
    r = run(
        STROKE.format(
            axis=axis,
            drive=drive or f"velocity: {1 / end!r}",
            force=force,
            end=end,
            solver=f"method: {method}, tolerance: {tolerance}",
            every=every,
        )
    )
    return r, work


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("load", LOADS)
def test_work_of_a_load_along_a_driven_stroke(load, method):
    tolerance = {"generalized_alpha": 1e-4, "scipy:Radau": 1e-5}.get(method, 1e-6)
    r, work = stroke(load, method, tolerance)
    allowed = ROUGH.get(method, 3.0) * tolerance * abs(work)
    assert r["energy.work.loads"][-1] == pytest.approx(work, abs=allowed)
    assert r["energy.work.drives"][-1] == pytest.approx(-work, abs=allowed)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-8, 1e-10])
@pytest.mark.parametrize("load", LOADS)
def test_work_follows_the_tolerance(load, tolerance):
    r, work = stroke(load, "dop853", tolerance)
    assert r["energy.work.loads"][-1] == pytest.approx(work, rel=3.0 * tolerance)


@pytest.mark.parametrize("end", [1e-3, 1e3])
def test_work_at_other_speeds(end):
    for load in LOADS:
        r, work = stroke(load, "dop853", 1e-6, end, axis="[1, 2, 2]", every=end / 20)
        assert r["energy.work.loads"][-1] == pytest.approx(work, rel=3e-6)


def test_rows_inside_steps():
    """The work up to every output row, which are much closer than steps."""
    r, _ = stroke("bump", "dop853", 1e-6, every=0.001)
    exact = [-1000 * quad(lambda u: exp(-(((u - 0.37) / 0.02) ** 2)), 0, x, points=(0.37,))[0]
             for x in r.t]  # fmt: skip
    np.testing.assert_allclose(r["energy.work.loads"], exact, atol=1e-5 * 35.4)


TURNING = """
gravity: [0, 0, -9.81]
bodies:
  arm: {mass: 3, inertia: [0.1, 0.2, 0.3], at: [0.4, 0.1, 0]}
  block: {mass: 1, inertia: [0.1, 0.2, 0.3], at: [1, 0, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: [1, 2, 2]}
  slide: {type: prismatic, bodies: [ground, block], axis: [0, 0, 1]}
drives:
  motor: {joint: hinge, velocity: SPEED}
  lift: {joint: slide, velocity: 0.5}
sensors: {angle: {joint: hinge}}
forces:
  brake: {type: applied_load, body: arm, frame: arm, direction: [1, 2, 2],
          torque: "-20*(1 + sin(7*angle))"}
  drag: {type: applied_load, body: block, direction: [0, 0, 1],
         force: "-100*exp(-((angle - 3)/0.1)**2)"}
solver: {end: END, tolerance: 1e-7}
output: {every: EVERY}
"""


@pytest.mark.parametrize("speed", [4.0, 40.0])
def test_two_loads_of_a_turning_arm_in_space(speed):
    end = 6.0 / speed
    words = {"SPEED": speed, "END": end, "EVERY": end / 10}
    text = TURNING
    for word, value in words.items():
        text = text.replace(word, repr(value))
    r = run(text)
    turning = -20.0 * (6.0 + (1.0 - np.cos(42.0)) / 7.0)
    sliding = -100.0 * 0.1 * sqrt(pi) * 0.5 / speed
    assert r["energy.work.loads"][-1] == pytest.approx(turning + sliding, abs=3e-5)
    book = r["energy.work.drives"][-1] + r["energy.work.loads"][-1]
    lifted = r["energy.stored.gravity"][-1] - r["energy.stored.gravity"][0]
    assert book == pytest.approx(lifted, abs=6e-5)


DAMPED = """
bodies: {block: {mass: 2, inertia: 0.01}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
drives: {pull: {joint: slide, velocity: 1}}
sensors: {x: {joint: slide}}
forces:
  damper: {type: spring_damper, bodies: [ground, block], points: [[0, 0.01], [-0.5, 0]],
           stiffness: 0, damping: 300}
solver: {end: 1, tolerance: 1e-8}
"""


def test_work_of_a_damper_that_turns_over():
    """A damper between the ground and a block that passes it at 10 mm: its rate turns within
    20 mm of the stroke."""

    def power(x):
        return -300.0 * (x - 0.5) ** 2 / ((x - 0.5) ** 2 + 1e-4)

    r = run(DAMPED)
    exact = quad(power, 0, 1, points=(0.5,), epsabs=1e-10)[0]
    assert r["energy.work.dampers"][-1] == pytest.approx(exact, rel=1e-8)


def test_fixed_steps_tell_the_error_of_their_works():
    for load in LOADS:
        force, work = LOADS[load]
        for step in (0.02, 0.005, 0.001):
            words = f"method: rk4, step: {step}, force: true"
            r = run(STROKE.format(axis="[1, 0, 0]", drive="velocity: 1", force=force, end=1,
                                  solver=words, every=0.05))  # fmt: skip
            error = abs(r["energy.work.loads"][-1] - work)
            told = r.outcome.statistics["work_error_relative"] * abs(work)
            assert error <= 1.5 * told + 1e-10
            said = [
                text for text in of_books(r.scenario, r.mechanism, r.outcome) if "works" in text
            ]
            assert bool(said) == (r.outcome.statistics["work_error_relative"] > 1e-3)


def test_nothing_is_asked_of_rounding():
    """A balanced rotor at constant speed exchanges nothing: its steps are not shortened."""
    text = """
bodies:
  rotor: {mass: 50, inertia: [33, 33, 50], at: [0.3, 0.2, 0.1], angular_velocity: [0, 0, 300]}
joints: {hinge: {type: revolute, bodies: [ground, rotor], at: [0.3, 0.2, 0.1], axis: [0, 0, 1]}}
drives: {motor: {joint: hinge, velocity: 300}}
solver: {end: 10, tolerance: 1e-12}
output: {every: 2.5}
"""
    r = run(text)
    assert r.outcome.statistics["steps"] < 100
    assert r.outcome.statistics["rejected_steps"] == 0


DRIVEN = """
bodies:
  crank: {mass: 1, inertia: 0.01, at: [0.08, 0.13]}
  coupler: {mass: 1, inertia: 0.1, at: [0.66, 0.27]}
  rocker: {mass: 1, inertia: 0.01, at: [1.08, 0.14]}
joints:
  O: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  A: {type: revolute, bodies: [crank, coupler], at: [0.16, 0.26]}
  B: {type: revolute, bodies: [coupler, rocker], at: [1.16, 0.28]}
  D: {type: revolute, bodies: [ground, rocker], at: [1, 0]}
drives: {motor: {joint: O, velocity: 5}}
solver: {end: 1.9, tolerance: 1e-4}
"""


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_steps_do_not_depend_on_what_is_recorded(method):
    """The unit of works comes from the ends of steps: peaks found in rows made it larger."""
    ends = [
        run(DRIVEN, f"solver.method={method}", f"output.every={every}", *less).outcome.record.y
        for every in (1.9, 0.19, 0.0019)
        for less in ((), ("output.channels=[]",))
    ]
    assert all(np.array_equal(y, ends[0]) for y in ends)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_where_scipy_finds_the_works(planar):
    """Behind the velocities, in front of the states: what a load gives is there alone."""
    mechanism = built(f"""
planar: {planar}
bodies: {{block: {{mass: 2, inertia: [1, 1, 1], at: [1, 0, 0], velocity: [3, 0, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
drives: {{push: {{joint: slide, velocity: 3, compliance: {{stiffness: 10}}}}}}
forces: {{pull: {{type: applied_load, body: block, direction: [1, 0, 0], force: 7}}}}
""")
    s, y = scene(mechanism.model), mechanism.y0.copy()
    y[s.n_q] = 3.0
    yd = np.zeros_like(y)
    derivative(s, 0.0, y, yd)
    works = np.arange(len(y))[books(s)]
    assert len(works) == N_BOOK and len(y) - works[-1] == 2  # the way of the drive is the last
    assert yd[works].tolist() == [0.0, 21.0, 0.0, 0.0, 0.0]


def test_scipy_begins_with_the_error_allowed(monkeypatch):
    """No factor of accelerations is known before the first step."""
    asked, restarted = [], scipy_ivp.restarted

    def noted(run, finer, *most):
        asked.append(finer)
        return restarted(run, finer, *most)

    monkeypatch.setattr(scipy_ivp, "restarted", noted)
    run(f"{FLYING}solver: {{end: 1 ms, method: 'scipy:RK45'}}")
    assert asked[0] == 1.0


FLYING = "bodies: {ball: {mass: 1, inertia: 1, velocity: [1, 2]}}\n"
