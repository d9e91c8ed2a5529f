"""Extremes of channels are those of the motion: against closed forms, never below a row, the same
with rows far apart and close together."""

from functools import cache
from math import cos, hypot, pi, sin, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator

from trsim.analyse.trajectory import changed, marched
from trsim.assemble.assemble import assemble
from trsim.scenario.load import loads
from trsim.solve.march import peaks

from ..runs import run
from ..truth.trial import made

METHODS = {
    "dop853": ("method: dop853", 1.0),
    "radau": ("method: radau", 1.0),
    "auto": ("method: auto", 1.0),
    "rk4": ("method: rk4, step: 5 ms", 10.0),
    "generalized_alpha": ("method: generalized_alpha", 100.0),
    "scipy:RK45": ("method: scipy:RK45", 20.0),
}


def extremes(r, name, component=0):
    """Largest value and its time, smallest value and its time."""
    return r.outcome.peaks[r.place[name][0] + component]


def magnitude(r, name):
    """Largest magnitude of a vector and its time."""
    vectors = r.mechanism.model.vector.tolist()
    return r.outcome.peaks[r.mechanism.model.n_out + vectors.index(r.place[name][0]), :2]


def check_rows(r):
    """No row lies outside of the extremes."""
    n = r.mechanism.model.n_out
    rows, peaks = r.rows[:, 1:], r.outcome.peaks[:n]
    assert np.all(rows.max(axis=0) <= peaks[:, 0])
    assert np.all(rows.min(axis=0) >= peaks[:, 2])


PENDULUM = """
gravity: [0, -9.81, 0]
bodies: {{rod: {{mass: 2, inertia: 0.05, at: [0.5, 0]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
sensors: {{angle: {{joint: hinge}}}}
solver: {{end: 7.3, {solver}, tolerance: {tolerance}}}
output: {{every: {every}}}
"""
W2 = 2 * 2 * 9.81 * 0.5 / (0.05 + 2 * 0.25)  # square of the rate at the bottom
PULL = 2 * 9.81 + 2 * 0.5 * W2  # reaction there


@pytest.mark.parametrize("every", [10, 0.1, 0.01, 0.003])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-10])
def test_pendulum(tolerance, every):
    r = run(PENDULUM.format(solver="method: dop853", tolerance=tolerance, every=every))
    allowed = max(tolerance, 1e-9)
    value, time = extremes(r, "hinge.reaction", 1)[:2]
    assert value == pytest.approx(PULL, rel=allowed)
    (n,) = np.round((time / quarter() - 1.0) / 2.0)[None]
    assert time == pytest.approx((1 + 2 * n) * quarter(), rel=10 * sqrt(allowed))
    assert magnitude(r, "hinge.reaction")[0] == pytest.approx(PULL, rel=allowed)
    assert extremes(r, "angle")[2] == pytest.approx(-pi, rel=allowed)
    assert extremes(r, "angle.rate")[[0, 2]] == pytest.approx([sqrt(W2), -sqrt(W2)], rel=allowed)
    check_rows(r)


def quarter():
    """A quarter of the period of the pendulum let go at 90 deg, s."""
    from scipy.special import ellipk

    return ellipk(0.5) / sqrt(2 * 9.81 * 0.5 / (0.05 + 2 * 0.25))


@pytest.mark.parametrize("method", METHODS)
def test_pendulum_by_every_method(method):
    solver, rough = METHODS[method]
    for every in (10, 0.01):
        text = PENDULUM.format(solver=solver, tolerance=1e-6, every=every)
        r = run(text, "solver.end=2.3")  # more than a period
        assert extremes(r, "hinge.reaction", 1)[0] == pytest.approx(PULL, rel=rough * 1e-6)
        check_rows(r)


CRANK = """
gravity: [0, -9.81, 0]
bodies:
  crank: {{mass: 1, inertia: 0.02, at: [0.1, 0]}}
  rod: {{mass: 2, inertia: 0.1, at: [0.5, 0.0]}}
  slider: {{mass: 3, inertia: 1, at: [0.8, 0]}}
joints:
  bearing: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  pin: {{type: revolute, bodies: [crank, rod], at: [0.2, 0]}}
  end: {{type: revolute, bodies: [rod, slider], at: [0.8, 0]}}
  guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0], at: [0.8, 0]}}
drives: {{motor: {{joint: bearing, velocity: {speed}}}}}
sensors: {{x: {{joint: guide}}}}
solver: {{end: {end}, tolerance: {tolerance}, method: {method}}}
output: {{every: {every}}}
"""


def torque(theta, w):
    """Of the motor: the rate of energy at constant speed, by derivatives in the angle."""
    r, L = 0.2, 0.6
    s, c = np.sin(theta), np.cos(theta)
    phi = np.arcsin(r * s / L)
    p1 = r * c / (L * np.cos(phi))  # phi'
    p2 = (-r * s + L * np.sin(phi) * p1**2) / (L * np.cos(phi))
    x2, y2 = -r * s - 0.3 * np.sin(phi) * p1, r * c - 0.3 * np.cos(phi) * p1
    x22 = -r * c - 0.3 * (np.cos(phi) * p1**2 + np.sin(phi) * p2)
    y22 = -r * s - 0.3 * (-np.sin(phi) * p1**2 + np.cos(phi) * p2)
    x3 = -r * s - L * np.sin(phi) * p1
    x33 = -r * c - L * (np.cos(phi) * p1**2 + np.sin(phi) * p2)
    inertial = 0.1 * p1 * p2 + 2 * (x2 * x22 + y2 * y22) + 3 * x3 * x33
    return inertial * w**2 + 9.81 * (1 * 0.1 * c + 2 * y2)


@cache
def torques(speed):
    """The largest and the smallest, to 1e-9 of what lies between."""
    M = torque(np.linspace(0, 2 * pi, 100_001), speed)
    return M.max(), M.min()


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("speed", [3.0, 30.0, 300.0])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-7])
def test_torque_of_a_driven_crank(tolerance, speed, method):
    """At 1e-3 a step may be a quarter of a turn."""
    most, least = torques(speed)
    end = 6 * pi / speed
    for rows in (1.0, 1e-3):
        text = CRANK.format(speed=speed, end=end, tolerance=tolerance, method=method,
                            every=rows * end)  # fmt: skip
        r = run(text)
        high, _, low, _ = extremes(r, "motor.force")
        allowed = 3.0 * tolerance * (most - least)
        assert (high, low) == pytest.approx((most, least), abs=allowed)
        # the slider turns back where the crank lies on its line
        assert extremes(r, "x")[[0, 2]] == pytest.approx([0, -0.4], abs=3.0 * tolerance)
        check_rows(r)


ROTOR = """
bodies: {rotor: {mass: 5, inertia: [0.1, 0.2, 0.3], at: [0.3, 0, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rotor], at: [0, 0, 0], axis: [1, 2, 2]}}
drives: {motor: {joint: hinge, velocity: 20}}
solver: {end: 3, tolerance: TOLERANCE}
output: {every: 3}
"""


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9])
def test_reactions_of_a_rotor_in_space(tolerance):
    """m rho w^2 in a plane across the axis: sqrt(1 - a_k^2) of it along each of the axes."""
    r = run(ROTOR.replace("TOLERANCE", str(tolerance)))
    a = np.array([1, 2, 2]) / 3
    radius = np.linalg.norm(np.cross(a, [0.3, 0, 0]))
    force = 5 * radius * 400
    allowed = max(3 * tolerance, 1e-9)
    for k in range(3):
        part = sqrt(1 - a[k] ** 2) * force
        high, _, low, _ = extremes(r, "hinge.reaction", k)
        assert (high, -low) == pytest.approx((part, part), rel=allowed)
    assert magnitude(r, "hinge.reaction")[0] == pytest.approx(force, rel=allowed)


STOP = """
bodies: {{block: {{mass: 2, inertia: 1, velocity: [{speed}, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
forces:
  wall: {{type: limit_stop, joint: slide, upper: 0.1, stiffness: 4e5}}
  back: {{type: limit_stop, joint: slide, lower: -0.1, stiffness: 4e5}}
solver: {{end: 1, tolerance: {tolerance}, method: {method}}}
output: {{every: {every}}}
"""


@pytest.mark.parametrize("method", ["dop853", "radau", "auto"])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9])
def test_force_of_a_contact(tolerance, method):
    """v sqrt(k m), reached between two rows and between two steps."""
    for every in (1, 0.01):
        r = run(STOP.format(speed=1.7, tolerance=tolerance, method=method, every=every))
        value, _, low, _ = extremes(r, "wall.force")
        largest = max(abs(value), abs(low))
        assert largest == pytest.approx(1.7 * sqrt(4e5 * 2), rel=max(10 * tolerance, 1e-8))
        check_rows(r)


def test_both_sides_of_a_jump():
    text = """
bodies: {block: {mass: 2, inertia: [1, 1, 1]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
drives: {pull: {joint: slide, position: "0.1*t**2*(t < 0.5) + (0.1*t - 0.025)*(t >= 0.5)"}}
forces:
  load: {type: applied_load, body: block, direction: [1, 0, 0],
         force: "100*t*(t < 0.7) - 30*(t >= 0.7)"}
solver: {end: 1}
output: {every: 0.3}
"""
    r = run(text)
    high, when, low, then = extremes(r, "load.magnitude")
    assert (high, when, low, then) == pytest.approx((70, 0.7, -30, 0.7))
    # of the drive: 0.4 - 100 t, then -100 t, then 30
    high, when, low, then = extremes(r, "pull.force")
    assert (high, when, low, then) == pytest.approx((30, 0.7, -70, 0.7))


SPRING = """
bodies: {{block: {{mass: 2, inertia: [1, 1, 1], at: [1.3, 0, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: slide}}}}
forces:
  spring: {{type: spring_damper, bodies: [ground, block], points: [[0, 0, 0], [1.3, 0, 0]],
           stiffness: 5000, free_length: 1, damping: {damping}}}
solver: {{end: 3, tolerance: {tolerance}, method: {method}}}
output: {{every: {every}}}
"""


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("damping", [0.0, 3.0])
def test_rates_of_an_oscillator(damping, method):
    for every in (3, 0.01):
        r = run(SPRING.format(damping=damping, tolerance=1e-8, method=method, every=every))
        w0, d = sqrt(5000 / 2), damping / 4
        w = sqrt(w0**2 - d**2)
        # x = 0.3 e^-dt (cos wt + d/w sin wt) - 0.3,  x' = -0.3 w0^2/w e^-dt sin wt
        t1 = np.arctan2(w, d) / w
        rate = -0.3 * w0**2 / w * np.exp(-d * t1) * np.sin(w * t1)
        low, when = extremes(r, "x.rate")[[2, 3]]
        assert low == pytest.approx(rate, rel=1e-7)
        if damping:  # the first is the largest; flat there, so of the time half the digits
            assert when == pytest.approx(t1, abs=1e-4 / w)
        turn = -0.3 - 0.3 * np.exp(-d * pi / w)
        assert extremes(r, "x")[2] == pytest.approx(turn, rel=1e-7)
        check_rows(r)


def test_rows_at_the_ends_of_fixed_steps():
    """An output time that rounding puts beside the end of a step is the end of the step."""
    r = run(PENDULUM.format(solver="method: rk4, step: 10 ms", tolerance=1e-6, every=0.01))
    energy = r["energy.kinetic"] + r["energy.stored.gravity"]
    assert np.abs(energy - energy[0]).max() < 1e-5


@pytest.mark.parametrize("before", [0.05, 0.15, 0.3])
@pytest.mark.parametrize("tolerance", [1e-4, 1e-8])
def test_an_extreme_next_to_an_event(tolerance, before):
    """In the first step behind an event nothing is known but its two ends."""
    w, zeta = 10.0, 0.05
    damped = w * sqrt(1 - zeta * zeta)
    r = run(f"""
bodies: {{mass: {{mass: 1, inertia: 1, velocity: [1, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, mass], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: slide}}}}
forces: {{spring: {{type: spring_damper, bodies: [ground, mass], points: [[-1, 0], [0, 0]],
          stiffness: 100, damping: 1}}}}
events: {{mark: {{when: t, value: {(pi / 2 - before) / w!r}, do: {{record: true}}}}}}
solver: {{end: 3, tolerance: {tolerance}}}
output: {{every: 1.5}}
""")
    t = np.arctan2(damped, zeta * w) / damped
    most = np.exp(-zeta * w * t) * np.sin(damped * t) / damped
    assert extremes(r, "x")[0] == pytest.approx(most, rel=max(tolerance, 1e-7))


@pytest.mark.parametrize(("frequency", "tolerance"), [(90, 1e-4), (110, 1e-4), (400, 1e-4),
                                                      (200, 1e-3), (300, 1e-3)])  # fmt: skip
def test_no_extreme_is_beyond_what_there_is(frequency, tolerance):
    """Sampled a few times in a period, the last term of a polynomial passes zero by chance."""
    r = run(f"""
bodies: {{mass: {{mass: 1, inertia: 1}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, mass], axis: [1, 0, 0]}}}}
forces:
  spring: {{type: spring_damper, bodies: [ground, mass], points: [[-1, 0], [0, 0]], stiffness: 100}}
  shaker: {{type: applied_load, body: mass, direction: [1, 0],
           force: "0.5*sin(2*pi*{frequency}*t + 0.3)"}}
solver: {{end: 1, tolerance: {tolerance}}}
output: {{every: 10 ms}}
""")
    most, _, least, _ = extremes(r, "shaker.magnitude")
    assert max(most, -least) <= 0.5 * (1 + 10 * tolerance)


def four_bar(rocker, tolerance, every):
    """A driven crank of 0.3 m, a coupler and a ground link of 1 m, and a rocker."""
    a, b, d, start = 0.3, 1.0, 1.0, 1.0
    x, y = a * cos(start), a * sin(start)
    far = hypot(d - x, y)
    # where the circles of coupler and rocker meet, above the line between their centres
    along = (far**2 + b**2 - rocker**2) / (2 * far)
    across = sqrt(b**2 - along**2)
    u, w = (d - x) / far, -y / far
    bx, by = x + along * u - across * w, y + along * w + across * u
    return f"""
bodies:
  crank: {{mass: 1, inertia: 0.01, at: [{x / 2!r}, {y / 2!r}]}}
  coupler: {{mass: 1, inertia: 0.1, at: [{(x + bx) / 2!r}, {(y + by) / 2!r}]}}
  rocker: {{mass: 1, inertia: 0.01, at: [{(d + bx) / 2!r}, {by / 2!r}]}}
joints:
  O: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  A: {{type: revolute, bodies: [crank, coupler], at: [{x!r}, {y!r}]}}
  B: {{type: revolute, bodies: [coupler, rocker], at: [{bx!r}, {by!r}]}}
  D: {{type: revolute, bodies: [ground, rocker], at: [{d}, 0]}}
drives: {{m: {{joint: O, velocity: 5}}}}
solver: {{end: 1.885, tolerance: {tolerance}}}
output: {{every: {every}}}
"""


# many channels turn in few long steps; one is met where another was looked for
DRAWN = [("chain_planar", 0), ("chain_planar", 2), ("loop", 0), ("loop", 9), ("loop", 13),
         ("chain_spatial", 0), ("starts", 11), ("events", 0), ("clearance", 2),
         ("stops", 4),
         # met by polynomials through samples before and behind them alone
         ("chain_planar", 10), ("spinning", 24), ("loop", 14), ("spinning", 46)]  # fmt: skip


@pytest.mark.parametrize(("family", "seed"), DRAWN)
def test_as_of_forty_times_as_many_rows(family, seed):
    """Steps are the same whatever the rows; the extremes of what lies between them are too."""
    assert_the_same_extremes(loads(made(family, seed).scene.text(), []))


def test_as_of_as_many_rows_in_steps_of_a_quarter_of_a_turn():
    """With the first step of the program's choice one extreme of an acceleration is missed, by
    0.17 % of its range."""
    text = made("chain_spatial", 39).scene.text()
    assert_the_same_extremes(loads(text, ["solver.first_step=1e-4"]))


@pytest.mark.parametrize("first", [3.8777448066272844e-4, 2.339214190570292e-3])
def test_places_looked_at_for_other_channels_may_say_little(first):
    """Two of them are so close together that the polynomial through them is largest right beside a
    third one, though the extreme is elsewhere."""
    text = made("loop", 13).scene.text()
    assert_the_same_extremes(loads(text, [f"solver.first_step={first!r}"]))


@pytest.mark.parametrize(("family", "seed"), [("loop", 4), ("redundant", 11), ("stops", 7)])
def test_an_extreme_just_before_what_no_sample_follows(family, seed):
    """Where other rows are solved from, or a contact opens."""
    scenario = loads(made(family, seed).scene.text(), ())
    assert_the_same_extremes(scenario, scenario.solver.end)


def assert_the_same_extremes(scenario, few=None):
    every, found = scenario.output.every, []
    for rows in (few or min(4 * every, scenario.solver.end), every / 40):
        same = changed(scenario, "output", every=rows, channels=("*",))
        mechanism = assemble(same)
        found.append(marched(same, mechanism)[1])
    few, many = found
    assert few.statistics["steps"] == many.statistics["steps"]
    allowed, kin = 10 * scenario.solver.tolerance, np.full(len(few.peaks), -1)
    lever = np.ones(len(few.peaks))
    kin[mechanism.model.sought] = mechanism.model.kin
    lever[mechanism.model.sought] = mechanism.model.lever
    low, high = many.peaks[:, 2], many.peaks[:, 0]
    sizes = np.maximum(abs(high), abs(low)) * lever
    for group in set(kin[kin >= 0].tolist()):
        largest = sizes[kin == group].max()
        if largest < 1e-9 * sizes.max():
            continue  # moments where there are none
        for c in np.flatnonzero(kin == group).tolist():
            scale = max(high[c] - low[c], 1e-3 * largest / lever[c])
            assert few.peaks[c, 0] >= high[c] - allowed * scale, c
            if c < mechanism.model.n_out:
                assert few.peaks[c, 2] <= low[c] + allowed * scale, c


TABLE = """
bodies: {{rotor: {{mass: 1, inertia: 5, at: [0, 0], angular_velocity: [0, 0, 6]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, rotor], at: [0, 0]}}}}
sensors: {{angle: {{joint: hinge}}}}
forces:
  load: {{type: applied_load, body: rotor, direction: [0, 0, 1],
    torque: {{table: {points}, of: angle, ends: hold}}}}
solver: {{end: 4, tolerance: {tolerance}}}
output: {{every: 4}}
"""


@pytest.mark.parametrize("tolerance", [1e-4, 1e-7])
def test_extremes_just_behind_the_points_of_a_table(tolerance):
    """Steps end there, and the first one behind a point may pass an extreme: the torque is a curve
    of the angle, whose extremes are known whatever the motion."""
    behind = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        angles = np.sort(rng.uniform(1, 20, 8))
        torques = rng.normal(0, 0.3, 8)
        akima = Akima1DInterpolator(angles, torques)
        curve = akima(np.concatenate((angles, akima.derivative().roots(extrapolate=False))))
        between = akima(np.linspace(angles[:-1], angles[1:], 33))
        beyond = np.abs(between - 0.5 * (torques[1:] + torques[:-1])) - np.abs(np.diff(torques)) / 2
        if beyond.max() > 0.4 * np.ptp(torques):
            continue  # a curve so far from its data is refused
        points = np.column_stack((angles, torques)).tolist()
        r = run(TABLE.format(points=points, tolerance=tolerance))
        assert np.ptp(r["angle"]) > angles[-1]
        behind += curve.max() > torques.max()
        found = extremes(r, "load.magnitude")
        near = 3 * tolerance * np.ptp(curve)
        assert found[0] == pytest.approx(curve.max(), abs=near), seed
        assert found[2] == pytest.approx(curve.min(), abs=near), seed
    assert behind > 20


@pytest.mark.parametrize(("rocker", "tolerance"), [(0.4, 1e-6), (0.301, 1e-4)])
def test_force_of_a_drive_near_dead_centres(rocker, tolerance):
    """A peak much narrower than a step: the same with rows that lie close."""
    found = []
    for every in (0.3, 0.0005):
        r = run(four_bar(rocker, tolerance, every))
        found.append(extremes(r, "m.force"))
    (high, _, low, _), (most, _, least, _) = found
    assert (high, low) == pytest.approx((most, least), abs=10 * tolerance * (most - least))


@pytest.mark.parametrize("rows", [2610, 3239, 3387])
def test_rows_stay_on_their_branch_where_branches_meet(rows):
    """Nearer to the flat place of cranks than interpolation is exact, the nearest place on the rows
    is on the other branch, where the coupler stands still."""
    scenario = loads(made("drifting", 0).scene.text(), ())
    every = scenario.solver.end / rows
    scenario = changed(scenario, "output", every=every, channels=("*",))
    mechanism = assemble(scenario)
    told, outcome = marched(scenario, mechanism)
    (rate,) = [1 + c.start for c in mechanism.columns if c.name == "angle.rate"]
    assert told[:, rate].max() < -7.5
    assert outcome.peaks[rate - 1, 0] < -7.5


# channels that are no magnitudes
AS_THEY_ARE = dict.fromkeys(("constant", "squared", "nearest"), lambda *_: 0)
AS_THEY_ARE |= dict.fromkeys(("kept_as", "value_of"), lambda s, r, c, value: value)


@pytest.mark.parametrize("doubt, looks", [(1e-9, 0), (0.5, 1)])
def test_what_is_not_sure_is_looked_at(monkeypatch, doubt, looks):
    """A polynomial is taken at its word where what it may lack is little of what may be missed."""
    b = SimpleNamespace(node=np.eye(1, 2), n_found=0, found=np.zeros(9), firm=np.ones(2), astray=0)
    r, seen = SimpleNamespace(peak=np.zeros((5, 1)), driven=0), []

    def look(s, r, b, setting, method, where):
        seen.append(where[1])
        b.astray = 1  # no more than one

    def extreme(r, o, place, value, firm):
        r.peak[:2, o] = value, place

    for name, stand_in in {
        "through": lambda *_: peaks.POINTS, "top": lambda *_: (0.4, 2.0 + doubt), "look": look,
        "known_place": lambda *_: False, "settled": lambda *_: True, "extreme": extreme,
        "polynomial": lambda *_: 2.0, **AS_THEY_ARE,
    }.items():  # fmt: skip
        monkeypatch.setattr(peaks, name, stand_in)
    peaks.search.python(SimpleNamespace(sought=[0]), r, b, None, None, (0, 0, 1.0, 1e-3))
    assert seen == [0.4] * looks
    assert r.peak[:2, 0].tolist() == ([0.0, 0.0] if looks else [2.0, 0.4])


@pytest.mark.parametrize("samples", [2, 9])
@pytest.mark.parametrize("shows", [False, True])
def test_a_dense_output_is_built_where_a_guess_of_the_middle_asks_for_it(
    monkeypatch, samples, shows
):
    """Guesses are no extremes themselves: where they show one what is there is looked at."""
    s = SimpleNamespace(sought=[0], kin=[0], lever=[1.0], least=[-np.inf])
    r = SimpleNamespace(
        sample=np.zeros((2, 1)), sampled=np.array([1.0, 0.5]), newest=0, n_samples=samples, steps=1,
        peak=np.zeros((5, 1)), largest=[1.0], faint=[0.0],
    )  # fmt: skip
    b = SimpleNamespace(
        n_found=0, astray=0, bound=np.array([[0.0], [1.0]]), inside=np.zeros((9, 1)), t=1.0, laid=0
    )
    done = []

    def guess(s, r, b, method, ahead, inner):
        b.n_found, b.inside[0, 0] = 1, 2.0 * shows

    def look_within(s, r, b, setting, method, where):
        done.append(("built", b.n_found))
        b.astray = 1

    for name, stand_in in {
        "older": lambda r, k: k, "ready": lambda *_: False, "length": lambda *_: 1.0,
        "bounds": lambda *_: None, "reached": lambda *_: (True, True), "guess": guess,
        "guessed": lambda s, r, b, *_: (b.n_found > 0 and b.inside[0, 0] > 0, False),
        "look_within": look_within, "search": lambda *_: None, **AS_THEY_ARE,
    }.items():  # fmt: skip
        monkeypatch.setattr(peaks, name, stand_in)
    setting = SimpleNamespace(missed=0.01, t_end=2.0)
    peaks.between.python(s, r, b, setting, None, 0)
    assert done == [("built", 0)] * shows
