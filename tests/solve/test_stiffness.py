"""What is stiff, or strongly damped, and carries little: two parts that move on together.

    M x'' + C x' + K x = 0,    C = c (1 -1; -1 1),    K = diag(k1, 0) + k2 (1 -1; -1 1)

from a state of its slowest motion alone: exact is that of the exponential of the matrix.  Nothing
of what is fast is ever seen, and steps of an explicit method could be as long as only the slow
motion allows; before they were held by what could vibrate or decay, velocities came out 1e5
tolerances off and accelerations 1e7.
"""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from ..runs import run
from ..sizes import size

SEEDS = size(20, 1500)
TILTED = np.array([[0.48, -0.8, 0.36], [0.6, 0.0, -0.8], [0.64, 0.6, 0.48]]).T
# all that is compared
MOTION = "output.channels=['*.position', '*.velocity', '*.acceleration']"
ALLOWED = 100.0  # tolerances of the largest of its kind

SCENE = """
planar: {planar}
bodies:
  a: {{mass: 1, inertia: {inertia}, at: {a}, velocity: {u[0]}}}
  b: {{mass: {m!r}, inertia: {inertia}, at: {b}, velocity: {u[1]}}}
joints:
  i: {{type: prismatic, bodies: [ground, a], at: {a}, axis: {axis}}}
  j: {{type: prismatic, bodies: [ground, b], at: {b}, axis: {axis}}}
gravity: [0, 0, 0]
forces:
  soft: {{type: spring_damper, bodies: [ground, a], points: [{anchor}, {a}], stiffness: {k1!r},
         free_length: 10}}
  hard: {{type: spring_damper, bodies: [a, b], points: [{a}, {b}], stiffness: {k2!r},
         damping: {c!r}, free_length: 3}}{more}
solver: {{end: {end!r}, tolerance: {tolerance!r}}}
output: {{every: {every!r}}}
"""
STOP = """
  stop: {{type: limit_stop, point: {{body: a, at: {at}}}, wall: {{body: ground, at: {wall},
         normal: {axis}}}, stiffness: 1e6, damping: 0}}"""


BAR = (
    """
  rod: {mass: 0.4, inertia: [1e-4, 0.03, 0.03], at: [0.5, 5, 0], velocity: SLOW,
    flexible: {elements: 2, section: {diameter: 0.1}, youngs_modulus: SOFT}}
  bob: {mass: 0.1, inertia: [0.01, 0.01, 0.01], at: [1, 5, 0], velocity: SLOW}""",
    """
  r: {type: spherical, bodies: [ground, rod], at: [0, 5, 0]}
  s: {type: spherical, bodies: [rod, bob], at: [1, 5, 0]}""",
)


def drawn(seed, damped, beside=""):
    """Text of a scene, M, C and K, the state at t = 0 and the direction of its ways."""
    rng = np.random.default_rng(seed)
    ratio, m, W = 10 ** rng.uniform(0.3, 1.7), 10 ** rng.uniform(-2, 1), 10 ** rng.uniform(-1, 1)
    k1, light = W**2, min(m, 1.0)
    k2 = W**2 * rng.uniform(0, 2) * light if damped else (ratio * W) ** 2 * light
    c = ratio * W * light if damped else 0.0
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    M, C, K = np.diag([1.0, m]), c * pair, np.diag([k1, 0.0]) + k2 * pair
    A = matrix(M, C, K)
    values, vectors = np.linalg.eig(A)
    slowest = np.argmin(np.abs(values) + 1e9 * (np.abs(values.imag) < 1e-12 * ratio * W))
    mode = vectors[:, slowest]
    start = (mode / mode[0] * -1j).real
    start /= np.abs(start[:2]).max() if np.abs(start[:2]).max() > 0.1 else 1.0
    R = TILTED if rng.random() < 0.5 else np.eye(3)
    spatial, axis = R is TILTED, R[:, 0]
    end = 2 * np.pi / abs(values[slowest]) * rng.uniform(0.5, 2)
    where = [axis * start[0], axis * (3.0 + start[1])]
    text = SCENE.format(
        planar=str(not spatial).lower(), inertia="[1, 1, 1]" if spatial else 1, axis=axis.tolist(),
        a=where[0].tolist(), b=where[1].tolist(), u=[(axis * v).tolist() for v in start[2:]],
        m=float(m), anchor=(-10 * axis).tolist(), k1=float(k1), k2=float(k2), c=float(c),
        end=float(end), tolerance=float(10 ** rng.uniform(-10, -4)),
        every=float(end / rng.integers(11, 201)),
        more=STOP.format(at=where[0].tolist(), wall=(-20 * axis).tolist(), axis=axis.tolist())
        if beside == "stop" else "",
    )  # fmt: skip
    if beside == "bar":
        bodies, joints = (x.replace("SOFT", repr(float(20 * W * W))) for x in BAR)
        bodies = bodies.replace("SLOW", repr([0.0, 0.05 * float(W), 0.0]))
        text = text.replace("\njoints:", bodies + "\njoints:").replace(
            "\ngravity", joints + "\ngravity"
        )
    return text, (M, C, K), start, axis


def matrix(M, C, K):
    """Of the first-order system (x, x')."""
    inverse = np.diag(1.0 / np.diag(M))
    return np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ K, -inverse @ C]])


def along(A, start, t):
    """The solution of x' = A x at times from 0 on: from each to the next one, with one exponential
    for all steps of a length."""
    found, step, way = [start], 0.0, np.eye(len(start))
    for h in np.diff(t):
        if abs(h - step) > 1e-9 * h:
            step, way = h, expm(A * h)
        found.append(way @ found[-1])
    return np.array(found)


def off(r, MCK, start, axis):
    """By how many tolerances places, velocities and accelerations are off, of the largest."""
    A = matrix(*MCK)
    exact = along(A, start, r.t)
    true = (exact[:, :2], exact[:, 2:], (exact @ A.T)[:, 2:])
    found = []
    for kind, rows in zip(("position", "velocity", "acceleration"), true, strict=True):
        got = [r[f"{name}.{kind}"] for name in "ab"]
        got = np.column_stack([x @ axis[: x.shape[1]] for x in got])
        if kind == "position":
            got -= [0.0, 3.0]
        found.append(np.abs(got - rows).max() / np.abs(rows).max())
    return np.array(found) / r.scenario.solver.tolerance


@pytest.mark.parametrize("beside", ["", "stop", "bar"])
@pytest.mark.parametrize("damped", [False, True], ids=["spring", "damper"])
@pytest.mark.parametrize("method", ["dop853", "auto"])
def test_what_moves_on_together(method, damped, beside):
    worst = {}
    for seed in range(SEEDS // 2 if beside else SEEDS):
        text, *true = drawn(seed, damped, beside)
        worst[seed] = off(run(text, f"solver.method={method}", MOTION), *true)
    wrong = {seed: x for seed, x in worst.items() if not x.max() < ALLOWED}
    assert not wrong


@pytest.mark.parametrize("method", ["dop853", "auto"])
def test_what_lies_inside_steps_is_held_where_rounding_limits_them(method):
    """What rounding makes of the ends of short steps hid the errors inside long ones, of 5.5 rad:
    rows there were 180 (dop853) and 134 tolerances off, ends of steps 12."""
    text, *true = drawn(690, False, "stop")
    r = run(text, f"solver.method={method}", MOTION)
    assert r.outcome.statistics["rounding_of_tolerance"] > 100.0
    assert off(r, *true).max() < ALLOWED


@pytest.mark.parametrize("damped", [False, True], ids=["spring", "damper"])
@pytest.mark.parametrize("seed", range(6))
def test_the_fastest_is_found(seed, damped):
    """w^2 and c are about the largest eigenvalues of M^-1 K and M^-1 C: never less by much."""
    text, (M, C, K), *_ = drawn(seed, damped)
    r = run(text, "solver.method=dop853").outcome.record
    inverse = np.diag(1.0 / np.diag(M))
    ww, c = (np.linalg.eigvals(inverse @ X).real.max() for X in (K, C))
    assert r.vibration == pytest.approx(ww, rel=0.1)
    assert r.decay == pytest.approx(c, rel=0.1, abs=1e-5 * np.sqrt(ww))  # by rounding


PAIR = """
gravity: [6.6, 3.3]
bodies:
  one: {mass: 0.74, inertia: 0.16, at: [0.15, -0.06], velocity: [0.06, 0.15],
    angular_velocity: [0, 0, 1]}
  two: {mass: 0.63, inertia: 0.043, at: [0.55, -0.23], velocity: [0.23, 0.55],
    angular_velocity: [0, 0, 1]}
joints:
  A: {type: revolute, bodies: [ground, one], at: [0, 0]}
  B: {type: revolute, bodies: [one, two], at: [0.42, -0.16]}
forces: {spring: {type: torsion_spring, joint: B, stiffness: STIFFNESS, damping: 0.01}}
solver: {end: 2, tolerance: 1e-6}
output: {every: 0.01}
"""


@pytest.mark.parametrize(
    ("stiffness", "tolerance"), [(100, "1e-5"), (300, "1e-5"), (300, "1e-7"), (300, "1e-8")]
)
def test_accelerations_inside_a_step_are_held_too(stiffness, tolerance):
    """Ten rows a step: its end is right, and what is interpolated was off by 161 tolerances; errors
    of vibrations add up along the run, to 175."""
    text = PAIR.replace("STIFFNESS", str(stiffness))
    r = run(text, "solver.method=dop853", f"solver.tolerance={tolerance}")
    exact = run(text, "solver.method=radau", "solver.tolerance=1e-11")
    for name in ("one", "two"):
        got, true = (x[f"{name}.angular_acceleration"] for x in (r, exact))
        assert np.abs(got - true).max() < ALLOWED * float(tolerance) * np.abs(true).max()


NEARLY_FLAT = """
gravity: [0, 0]
bodies:
  crank:   {mass: 1, inertia: 0.08, at: [0.5, 0], angular_velocity: [0, 0, 1]}
  coupler: {mass: 1, inertia: 0.3, at: [2, 0]}
  other:   {mass: 1, inertia: 0.08, at: [2.5, 0]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  B: {type: revolute, bodies: [crank, coupler], at: [1, 0]}
  C: {type: revolute, bodies: [coupler, other], at: [3, 0]}
  D: {type: revolute, bodies: [ground, other], at: [2, 0]}
initial: {A: 0.1 rad, D: 0.1 rad}
solver: {end: 1e-3, tolerance: 1e-6, method: dop853}
"""


def test_rows_that_nearly_depend_on_each_other_are_not_stiff():
    """A parallelogram near its flat position turns steadily: nothing on it decays.

    What changes velocities off the rows is no damping; rounding is 1e-16 over a nudge of 1e-7.
    """
    assert run(NEARLY_FLAT).outcome.record.decay < 1e-6


AT_A_STOP = """
bodies:
  a: {mass: 2 kg, inertia: 0.01, at: [0.5, 0]}
  b: {mass: 1 kg, inertia: 0.002, at: [1.2, 0]}
joints:
  O: {type: revolute, bodies: [ground, a], at: [0, 0]}
  A: {type: revolute, bodies: [a, b], at: [1, 0]}
forces:
  d: {type: torsion_spring, joint: A, stiffness: 2e5, damping: 30}
  s: {type: limit_stop, joint: O, lower: -0.5, upper: 1, stiffness: 2e3, damping: 40, ramp: 0.01}
gravity: [0, -9.81]
solver: {end: 1}
output: {every: 0.02}
"""


@pytest.mark.parametrize("method", ["auto", "dop853"])
@pytest.mark.parametrize("tolerance", ["1e-3", "1e-4"])
def test_what_is_stiff_is_known_in_touch_too(method, tolerance):
    """By every method at 1e-8 there are 105 rad/s^2 at most; steps beyond the limit of stability
    made 4,700 to 9,200 of it while the stop was in touch."""
    r = run(AT_A_STOP, f"solver.method={method}", f"solver.tolerance={tolerance}")
    largest = np.abs(r.outcome.peaks[r.place["b.angular_acceleration"][0] + 2, [0, 2]]).max()
    assert 104.5 < largest < 106.0


ON_A_STOP = """
bodies:
  a: {mass: 2 kg, inertia: 0.01, at: [0.5, 0]}
  b: {mass: 1 kg, inertia: 0.002, at: [1.2, 0]}
  c: {mass: 3 kg, inertia: 0.02, at: [1.4, -0.4]}
joints:
  O: {type: revolute, bodies: [ground, a], at: [0, 0]}
  A: {type: revolute, bodies: [a, b], at: [1, 0]}
  B: {type: revolute, bodies: [b, c], at: [1.4, 0]}
forces:
  d: {type: torsion_spring, joint: A, stiffness: 1e6, damping: 30}
  e: {type: torsion_spring, joint: B, stiffness: 2e4, damping: 1}
  s: {type: limit_stop, joint: O, lower: -0.5, upper: 1, stiffness: 2e3, damping: 40, ramp: 0.05}
gravity: [0, -9.81]
solver: {end: 1.5}
output: {every: 0.02}
"""


def test_accelerations_are_held_in_touch_too():
    """A stop kicks springs that are faster than it.  Accelerations were held only in scenes without
    any contact: 640 (dop853) to 863 tolerances (radau) off."""
    true, wrong = run(ON_A_STOP, "solver.method=dop853", "solver.tolerance=1e-9"), {}
    for method in ("auto", "dop853", "radau"):
        r = run(ON_A_STOP, f"solver.method={method}", "solver.tolerance=1e-5")
        for name in ("a", "b", "c"):
            want = true[f"{name}.angular_acceleration"]
            off = np.abs(r[f"{name}.angular_acceleration"] - want).max() / np.abs(want).max()
            if not off < 1e-5 * ALLOWED:
                wrong[method, name] = off
    assert not wrong


DRIVEN = """
bodies:
  a: {mass: 0.5 kg, inertia: 0.003, at: [AT, 0]}
joints:
  j: {type: prismatic, bodies: [ground, a], axis: [1, 0, 0]}
drives:
  d: {joint: j, velocity: "0.36*sin(3.6*t)", compliance: {stiffness: 6.6e5, damping_ratio: 0.01}}
forces:
  s: {type: limit_stop, joint: j, lower: -1, upper: 0.02, stiffness: 2.3e4, damping: 0}
solver: {end: 0.8}
output: {every: 0.02}
"""


def driven_onto_a_stop(t):
    """The acceleration of it, from two linear motions; it touches once and stays."""
    rates, free, held = driven()
    return np.array([rates(x, (free if x < free.t[-1] else held).sol(x))[1] for x in t])


@cache
def driven():
    """The rates of (x, x'), and the solutions before and in touch."""
    k, m, K, far = 6.6e5, 0.5, 2.3e4, 0.02
    c = 2.0 * 0.01 * np.sqrt(k * m)

    def rates(t, y):
        drive = k * (0.1 * (1.0 - np.cos(3.6 * t)) - y[0]) + c * (0.36 * np.sin(3.6 * t) - y[1])
        return [y[1], (drive - K * max(y[0] - far, 0.0)) / m]

    def touches(t, y):
        return y[0] - far

    touches.terminal = True
    how = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-15, "dense_output": True}
    free = solve_ivp(rates, (0.0, 0.8), [0.0, 0.0], events=touches, **how)
    held = solve_ivp(rates, (free.t[-1], 0.8), free.y[:, -1], **how)
    return rates, free, held


@pytest.mark.parametrize("method", ["auto", "dop853"])
def test_a_light_vibration_on_a_stop_is_held(method):
    """Steps of 1 to 2 rad of it are no steps of the touch: 331 tolerances at 1e-5, 1,634 to 2,135
    at 1e-6 and below."""
    for tolerance in (1e-4, 1e-5, 1e-6) if method == "dop853" else (1e-4, 1e-5):
        r = run(
            DRIVEN.replace("AT", "0"), f"solver.method={method}", f"solver.tolerance={tolerance}"
        )
        true = driven_onto_a_stop(r.t)
        off = np.abs(r["a.acceleration"][:, 0] - true).max() / np.abs(true).max()
        assert off < ALLOWED * tolerance


def test_rounding_far_from_the_origin_is_not_held():
    """3 km away the last bit of a place makes more of the spring's force than the tolerance is of
    the largest: held to it, the run would take 25 minutes."""
    r = run(DRIVEN.replace("AT", "3000"), "solver.tolerance=1e-6", "solver.max_steps=20000")
    assert r.outcome.statistics["steps"] < 5000
    true = driven_onto_a_stop(r.t)
    rounding = 1.3e6 * 4.5e-13 / np.abs(true).max()
    off = np.abs(r["a.acceleration"][:, 0] - true).max() / np.abs(true).max()
    assert off < ALLOWED * max(1e-6, rounding)
