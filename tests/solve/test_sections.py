"""Points of Poincare sections: where, in which direction, and that nothing else is changed."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.errors import ScenarioError
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.march import sections

from .. import small
from ..mechanisms import torsion_pendulum
from ..runs import built, run
from ..small import SLIDER_CRANK

HALF = np.pi / 20.0  # s: half a period of the torsion pendulum
METHODS = {
    "dop853": 1e-10,
    "radau": 1e-10,
    "rk4": 1e-10,
    "scipy:RK45": 1e-10,
    "scipy:Radau": 1e-8,
    "generalized_alpha": 2e-3,
}
STEP = ("solver.step=1e-4",)


def pendulum(sections, solver="end: 3, tolerance: 1e-11"):
    text, exact = torsion_pendulum(solver=solver)
    return f"{text}poincare: {{{sections}}}\n", exact


@pytest.mark.parametrize("method", METHODS)
def test_crossings_and_instants_of_an_oscillator(method):
    """theta = theta0 cos 20 t crosses zero at odd quarters of its period, its rate at halves."""
    text, exact = pendulum(
        "zero: {when: angle, crosses: both, plot: [angle, angle.rate]},"
        "turn: {when: angle.rate, plot: [angle, angle.rate]},"
        "beat: {every: 2*pi/20, after: 0.1, plot: [angle, angle.rate]}"
    )
    loose = {"generalized_alpha": 1e-5, "scipy:Radau": 1e-9}.get(method, 1e-11)
    sets = (f"solver.method={method}", *STEP, f"solver.tolerance={loose}")
    n = 2 if "scipy" in method else 10  # periods; these take a second for each
    sets = (*sets, f"solver.end={(2 * n - 0.9) * HALF!r}")
    r, allowed = run(text, *sets), METHODS[method]
    zero, turn, beat = (r.section(name) for name in ("zero", "turn", "beat"))
    assert (len(zero), len(turn), len(beat)) == (2 * n - 1, n, n)
    assert zero[:, 0] == pytest.approx((np.arange(2 * n - 1) + 0.5) * HALF, abs=allowed)
    assert zero[:, 1] == pytest.approx(0.0, abs=1e-13)
    assert turn[:, 0] == pytest.approx((2.0 * np.arange(n) + 1.0) * HALF, abs=allowed)
    assert turn[:, 1] == pytest.approx(-0.3, abs=allowed)
    assert turn[:, 2] == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_array_equal(beat[:, 0], 0.1 + 2.0 * np.pi / 20.0 * np.arange(n))
    assert beat[:, 1] == pytest.approx(exact(beat[:, 0]), abs=20.0 * allowed)


@pytest.mark.parametrize("crosses, first", [("up", 1.5), ("down", 0.5)])
def test_direction(crosses, first):
    text, _ = pendulum(f"zero: {{when: angle, crosses: {crosses}, plot: [angle, angle.rate]}}")
    points = run(text).section("zero")
    assert points[:, 0] == pytest.approx((first + 2.0 * np.arange(len(points))) * HALF, abs=1e-10)
    assert np.all(np.sign(points[:, 2]) == (1.0 if crosses == "up" else -1.0))


def test_nothing_before_its_time():
    text, _ = pendulum("zero: {when: angle, crosses: both, after: 1 s, plot: [angle, angle.rate]}")
    points = run(text).section("zero")
    expected = (np.arange(19) + 0.5) * HALF
    assert points[:, 0] == pytest.approx(expected[expected >= 1.0], abs=1e-10)


def test_the_rate_of_a_channel_at_the_end_of_a_step_however_late(monkeypatch):
    """Of y^2 with y' = 3 at y = 2, told by what is a little ahead: 12."""
    t = 1e5
    s = SimpleNamespace(section=np.zeros((1, 8), int), section_at=np.zeros((1, 8)), out=np.zeros(1))
    s.section[0, sections.KIND], s.section[0, sections.ALONE] = sections.CROSSING, -1
    r = SimpleNamespace(section=np.ones((1, 40)), work_projection=0.0, energy_0=0.0)
    b = SimpleNamespace(
        t=t, t1=t + 0.01, built=0, P=np.zeros((1, 1)), K=np.full((2, 1), 3.0), y1=np.full(1, 2.0),
        y2=np.zeros(1), out=np.full(1, 4.0),
    )  # fmt: skip

    def measure(s, t, y, *_):
        s.out[0] = y[0] ** 2

    monkeypatch.setattr(sections, "measure", measure)
    monkeypatch.setattr(sections, "evaluate_to_measure", lambda *_: None)
    monkeypatch.setattr(sections, "crosses_after", sections.crosses_after.python)
    monkeypatch.setattr(sections, "all_alone", sections.all_alone.python)
    monkeypatch.setattr(sections, "ahead_of", sections.ahead_of.python)
    sections.ends_known.python(s, r, b, 1, 0)
    assert r.section[0, sections.END_RATE] == pytest.approx(12.0, rel=1e-4)


THROWN = """
planar: true
bodies: {{ball: {{mass: 1, inertia: 1, at: [0, {y0}], velocity: [0, {v0}]}}}}
forces: {{push: {{type: applied_load, body: ball, direction: [0, 1], force: "{force}"}}}}
solver: {{method: dop853, end: 1, first_step: 1, max_step: 1, tolerance: 1e-6}}
output: {{every: 1}}
poincare:
  zero: {{when: ball.position.y, crosses: {crosses}, plot: [ball.velocity.y, ball.position.y]}}
"""


def thrown(y0, v0, force, crosses="both", first=1.0):
    """The points of a body whose height is a polynomial, which long steps integrate exactly."""
    text = THROWN.format(y0=y0, v0=v0, force=force, crosses=crosses)
    r = run(text, f"solver.first_step={first}")
    assert r.outcome.statistics["steps"] == (1 if first == 1.0 else 2)
    return r.section("zero")


@pytest.mark.parametrize("crosses, at", [("both", [0.2, 0.7]), ("up", [0.2]), ("down", [0.7])])
def test_there_and_back_in_one_step(crosses, at):
    """y = -(t - 0.2)(t - 0.7)"""
    points = thrown(-0.14, 0.9, -2.0, crosses)
    assert points[:, 0] == pytest.approx(at, abs=1e-12)
    assert points[:, 1] == pytest.approx(0.9 - 2.0 * np.array(at), abs=1e-12)


def test_there_and_back_in_a_later_step():
    """y = -(t - 0.3)(t - 0.8), of which the step from 0.2 to 1 shows no change of sign."""
    points = thrown(-0.24, 1.1, -2.0, first=0.2)
    assert points[:, 0] == pytest.approx([0.3, 0.8], abs=1e-12)


@pytest.mark.parametrize("first", [0.15, 1.0])
def test_there_back_and_there_again_in_one_step(first):
    """y = (t - 0.2)(t - 0.5)(t - 0.8)"""
    points = thrown(-0.08, 0.66, "6*t - 3", first=first)
    assert points[:, 0] == pytest.approx([0.2, 0.5, 0.8], abs=1e-12)


def test_a_turn_short_of_zero_is_no_crossing():
    """y = -(t - 0.5)^2 - 1e-6"""
    assert len(thrown(-0.250001, 1.0, -2.0)) == 0


@pytest.mark.parametrize("rounding", [0.0, 1e-17, -1e-17])
def test_a_start_at_zero_is_no_crossing(rounding):
    """y = t (t - 0.5), as drawn or with what rounding leaves of a start at zero."""
    assert thrown(rounding, -0.5, 2.0)[:, 0] == pytest.approx([0.5], abs=1e-12)


def test_a_start_close_to_zero_is_followed_by_a_crossing():
    """y = -1e-4 + t / 2 + t^2"""
    assert thrown(-1e-4, 0.5, 2.0)[:, 0] == pytest.approx([2e-4], rel=1e-3)


@pytest.mark.parametrize("force, at", [("(t > 0.5)*2 - 1", []), ("sin(8*t - 4)", [0.5])])
def test_a_jump_over_zero_is_no_crossing(force, at):
    text = THROWN.format(y0=0, v0=0, force=force, crosses="up").replace(
        "when: ball.position.y", "when: ball.acceleration.y"
    )
    found = run(text, "solver.first_step=0.01", "solver.max_step=0.03").section("zero")
    assert found[:, 0] == pytest.approx(at, abs=1e-9)


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha", "rk4, step: 1e-3"])
@pytest.mark.parametrize("load", ["-50*x*(x > 0) - 3*x.rate*abs(x.rate)", "-x*abs(x)"])
def test_a_corner_of_a_load_where_the_channel_is_zero(method, load):
    """A step ends there, and rounding says on which side."""
    tolerance = ", tolerance: 1e-6" if "alpha" in method else ""
    r = run(f"""
bodies: {{a: {{mass: 1, inertia: 1, velocity: [1, 0]}}}}
sensors: {{x: {{type: point, body: a, at: [0, 0], axis: [1, 0, 0]}}}}
forces:
  spring: {{type: spring, bodies: [ground, a], points: [[-1, 0], [0, 0]], elastic: 100*stretch}}
  load: {{type: applied_load, body: a, direction: [1, 0], force: "{load}"}}
poincare:
  turn: {{when: x.rate, crosses: both, plot: [x, x.rate]}}
  middle: {{when: x, crosses: both, plot: [x, x.rate]}}
solver: {{end: 5, method: {method}{tolerance}}}
""")
    for name, channel in (("turn", "x.rate"), ("middle", "x")):
        found = r.section(name)[:, 0]
        k = np.flatnonzero(np.diff(np.sign(r[channel][1:]))) + 1
        assert len(found) == len(k), name
        assert np.all((r.t[k] <= found) & (found <= r.t[k + 1])), name


@pytest.mark.parametrize("before, after, at", [
    (-1, "1", []), (-1, "4*t - 1", [0.75]), (1, "-1", []), (1, "50*t - 1", [0.52]),
])  # fmt: skip
def test_what_an_event_turns_round_does_not_cross(before, after, at):
    """A drive is put to another speed at 0.5 s, past zero; what crosses it later counts."""
    text = """
bodies: {disc: {mass: 2, inertia: 1}}
joints: {pin: {type: revolute, bodies: [ground, disc], at: [0, 0]}}
drives: {motor: {joint: pin, velocity: BEFORE}}
sensors: {angle: {joint: pin}}
events: {turn: {when: t, value: 0.5, do: {set: {motor: {velocity: "AFTER"}}}}}
solver: {method: dop853, end: 1, first_step: 0.5, max_step: 0.5, tolerance: 1e-10}
poincare: {turn: {when: angle.rate, plot: [angle, angle.rate]}}
"""
    found = run(text.replace("BEFORE", str(before)).replace("AFTER", after)).section("turn")
    assert found[:, 0] == pytest.approx(at, abs=1e-9)


# --- in a mechanism with clearance -----------------------------------------------------------

SECTIONS = """
  crossing: {when: B.eccentricity_x_rate, crosses: both, plot: [B.eccentricity_x, B.eccentricity_y]}
  push: {when: rod.acceleration.y, plot: [rod.velocity.y, stroke]}
  touch: {at_onset: B, plot: [B.eccentricity_x, B.penetration_rate]}
  beat: {every: 0.0213 ms, plot: [stroke, crank_angle]}
"""
CRANK = small.SLIDER_CRANK.split("poincare:")[0]
WITH_FRICTION = (
    "contact_laws.pin.friction={law: modified_coulomb, coefficient: 0.1, v0: 1e-4, v1: 1e-3}"
)
SPATIAL = (
    "planar=false",
    *(f"bodies.{b}.inertia=[1e-4, 2e-4, 2e-4]" for b in ("crank", "rod", "slider")),
)
KINDS = {
    "dop853": (),
    "friction": (WITH_FRICTION,),
    "auto": (WITH_FRICTION, "solver.method=auto"),
    "radau": ("solver.method=radau", "solver.tolerance=1e-4"),
    "generalized_alpha": ("solver.method=generalized_alpha", "solver.tolerance=1e-3"),
    "rk4": ("solver.method=rk4", "solver.step=1us", "solver.locate_events=true"),
    "scipy:RK45": ("solver.method=scipy:RK45",),
    "spatial": SPATIAL,
    "ggl": ("solver.method=radau", "solver.formulation=ggl", "solver.tolerance=1e-4"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_is_the_same_with_sections_and_without(kind):
    """Rows, steps, events, extremes and statistics, to the last bit."""
    bare = run(CRANK, *KINDS[kind])
    full = run(CRANK + "poincare:" + SECTIONS, *KINDS[kind])
    assert len(bare.points) == 0 and len(full.section("crossing")) > 2
    for name in ("rows", "steps", "events"):
        np.testing.assert_array_equal(getattr(bare, name), getattr(full, name))
    np.testing.assert_array_equal(bare.outcome.peaks, full.outcome.peaks)
    told = [{**r.outcome.statistics, "integration_cpu": 0.0} for r in (bare, full)]
    assert told[0] == told[1]


def test_touches_are_those_of_the_events():
    """One point each, at the instant of the event, with the speed it met."""
    r = run(CRANK + "poincare:" + SECTIONS)
    touch, onset = r.section("touch"), r.events[r.events[:, 1] == 1.0]
    np.testing.assert_array_equal(touch[:, 0], onset[:, 0])
    assert len(touch) > 5
    assert touch[:, 2] == pytest.approx(onset[:, 3], rel=1e-9)
    assert touch[:, 1] == pytest.approx(0.5e-3 * np.cos(onset[:, 4]), abs=1e-12)


def test_instants_are_rows():
    """A stroboscopic section with the period of the rows shows what stands in them."""
    r = run(CRANK + "poincare: {beat: {every: 0.01 ms, plot: [stroke, stroke.rate]}}\n")
    beat = r.section("beat")
    assert len(beat) == len(r.t)
    np.testing.assert_array_equal(beat[:, 1], r["stroke"])
    np.testing.assert_array_equal(beat[:, 2], r["stroke.rate"])


def test_methods_find_the_same_points():
    """Until motions part: the first half millisecond, some impacts."""
    text, sets = CRANK + "poincare:" + SECTIONS, ("solver.end=1ms", "solver.tolerance=1e-10")
    expected = run(text, *sets)
    for method in ("radau", "scipy:RK45"):
        other = run(text, *sets, f"solver.method={method}")
        for name in ("crossing", "push", "touch"):
            a, b = expected.section(name), other.section(name)
            assert len(a) == len(b) > 0
            np.testing.assert_allclose(b[:, 0], a[:, 0], rtol=0.0, atol=1e-9)


def test_many_points_in_one_step():
    """More than the usual buffer holds."""
    text = THROWN.split("poincare")[0].format(y0=0, v0=1, force="0*t")
    r = run(text + "poincare: {beat: {every: 2e-5, plot: [ball.position.y, ball.velocity.y]}}\n")
    assert r.outcome.statistics["steps"] == 1
    beat = r.section("beat")
    assert len(beat) == 50_001
    assert beat[:, 1] == pytest.approx(beat[:, 0], abs=1e-12)
    with pytest.raises(ScenarioError, match="points may fall into one step"):
        run(text + "poincare: {beat: {every: 1e-7, plot: [ball.position.y, ball.velocity.y]}}\n")


def test_channels_that_are_not_recorded():
    """They are measured, and stay out of rows and peaks."""
    sets = ("output.channels=[stroke]",)
    r = run(CRANK + "poincare:" + SECTIONS, *sets)
    every = run(CRANK + "poincare:" + SECTIONS)
    np.testing.assert_array_equal(r.points, every.points)
    (column,) = (c for c in r.mechanism.columns if c.name == "rod.acceleration")
    assert not column.wanted and column.for_points


@pytest.mark.parametrize(
    "section, path, what",
    [
        ("{plot: [stroke, stroke.rate]}", (), "no surface"),
        ("{when: stroke, every: 1, plot: [stroke, stroke]}", (), "both `when` and `every`"),
        ("{every: 1, crosses: up, plot: [stroke, stroke]}", ("crosses",), "crosses belongs to"),
        ("{every: 0, plot: [stroke, stroke]}", ("every",), "must be > 0"),
        ("{every: 3 mm, plot: [stroke, stroke]}", ("every",), "wrong unit"),
        ("{when: strok, plot: [stroke, stroke]}", ("when",), "no channel named 'strok'"),
        ("{when: stroke.x, plot: [stroke, stroke]}", ("when",), "no channel named 'stroke.x'"),
        ("{when: B.force, plot: [stroke, stroke]}", ("when",), "'B.force' has 3 components"),
        ("{at_onset: A, plot: [stroke, stroke]}", ("at_onset",), "no contact named 'A'"),
        ("{at_onset: B, plot: [stroke, x]}", ("plot", 1), "no channel named 'x'"),
    ],
)
def test_refused(section, path, what):
    with pytest.raises(ScenarioError) as caught:
        built(CRANK + f"poincare: {{p: {section}}}\n")
    (problem,) = caught.value.problems
    assert what in problem.what
    assert problem.path == ("poincare", "p", *path)


def test_touches_need_located_events():
    text = CRANK + "poincare: {p: {at_onset: B, plot: [stroke, stroke]}}\n"
    with pytest.raises(ScenarioError, match="not located"):
        built(text, "solver.method=rk4", "solver.step=1us")


def test_a_bearing_without_play_has_no_section():
    """A sweep over the clearance may begin with an ideal joint."""
    from trsim.solve.diagnose.skipped import skipped

    done = run(SLIDER_CRANK, "joints.B.clearance=0", "solver.end=0.1 ms")
    assert done.mechanism.sections == ()
    told = skipped(done.scenario, done.mechanism)
    assert "section 'journal': the clearance of B is 0" in told


# --- channels that swing faster than bodies turn ------------------------------------------------

SPINNING = """
planar: {planar}
bodies:
  disc: {{mass: 1, inertia: [0.5, 0.5, 0.5], velocity: [2, 0], angular_velocity: [0, 0, 3]}}
sensors: {{x: {{type: displacement, bodies: [ground, disc], at: [0, 0], axis: [1, 0, 0]}}}}
forces:
  hum: {{type: applied_load, body: disc, direction: [0, 0, 1], torque: "1e-9*({torque})"}}
solver: {{end: 1.1, tolerance: 1e-6}}
output: {{every: 1.1}}
poincare: {{zero: {{when: {when}, crosses: both, plot: [x, x.rate]}}}}
"""


@pytest.mark.parametrize("when", ["hum.magnitude", "disc.angular_acceleration.z"])
@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("method", ["auto", "radau", "scipy:RK45"])
@pytest.mark.parametrize(
    "torque", ["sin(200*x + 1)", "sin(6*sin(60*x))", "sin(90*x)*cos(70*x)", "0.3 + cos(80*x)**5"]
)
def test_waves_of_a_load_are_not_passed_over(torque, method, planar, when):
    """A body that flies along x = 2 t: its steps are as long as the run, and it turns little."""
    text = SPINNING.format(planar=planar, torque=torque, when=when)
    points = run(text, f"solver.method={method}").section("zero")
    t = np.linspace(0.0, 1.1, 400_001)
    wave = eval(torque, {"x": 2.0 * t, "sin": np.sin, "cos": np.cos})  # noqa: S307
    passed = np.flatnonzero(wave[:-1] * wave[1:] < 0.0)
    assert len(points) == len(passed)
    assert points[:, 0] == pytest.approx(t[passed], abs=1e-5)


CHIRPED = """
bodies: {{block: {{mass: {mass}, inertia: 1, velocity: [10, 0]}}}}
joints: {{rail: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: rail}}}}
forces: {{push: {{type: applied_load, body: block, direction: [1, 0], force: "sin({phase})"}}}}
poincare: {{zero: {{when: push.magnitude, crosses: both, plot: [x, push.magnitude]}}}}
solver: {{end: 10, tolerance: 1e-3}}
"""
ENDS = np.array([[-1], [1]])  # before and behind
CHIRPS = {  # phase, and when it is a number of half turns
    "40*(t - 5)**3": lambda f: 5 + np.cbrt(f / 40),
    "t*t - 10*t + 26": lambda f: 5 + np.sqrt(f - 1) * ENDS,
    "200*atan2(t - 5.05, 0.01)": lambda f: 5.05 + 0.01 * np.tan(f[abs(f) < 100 * np.pi] / 200),
    "100*exp(-((t - 5.3)/0.1)**2)": lambda f: 5.3 + 0.1 * np.sqrt(np.log(100 / f)) * ENDS,
    "200/(1 + ((t - 5.3)/0.02)**2)": lambda f: 5.3 + 0.02 * np.sqrt(200 / f - 1) * ENDS,
    "200*sqrt(1e-4 + (t - 5.3)**2)": lambda f: 5.3 + np.sqrt((f[f > 0] / 200) ** 2 - 1e-4) * ENDS,
    "20*havsin(t, 3, 0, 3.2, 7)": lambda f: 3 + 0.4 / np.pi * np.arcsin(np.sqrt(f[f > 0] / 140)),
}


@pytest.mark.parametrize("mass", [1, 1e9])
@pytest.mark.parametrize("phase", CHIRPS)
def test_waves_that_are_fast_for_a_while_only(phase, mass):
    """Steps that hardly see the load are long, and it may be at rest at both of their ends."""
    points = run(CHIRPED.format(phase=phase, mass=mass)).section("zero")[:, 0]
    with np.errstate(invalid="ignore", divide="ignore"):
        t = CHIRPS[phase](np.pi * np.arange(-2000, 2001)).ravel()
    t = np.sort(t[(t > 0) & (t < 10)])
    assert len(points) == len(t) > 8
    assert points == pytest.approx(t, abs=1e-9)


@pytest.mark.parametrize(("step", "fast", "misses"), [(1e-3, 40, 0), (0.1, 40, 0), (1.0, 400, 1)])
def test_a_fixed_step_in_which_too_much_happens_says_so(step, fast, misses):
    text = CHIRPED.format(phase=f"{fast}*(t - 5)**3", mass=1)
    r = run(text, "solver.method=rk4", f"solver.step={step}")
    missing = 2 * int(125 * fast / np.pi) + 1 - len(r.section("zero"))
    said = [x for x in doubts(r.scenario, r.mechanism, r.outcome) if "can follow" in x]
    assert (missing > 0, len(said)) == (misses, misses)


def test_a_step_that_crosses_and_ends_on_zero():
    """The next crossing is seen from the side it ended on, not from that where the step began."""
    for end in (0.5, 1.0, 2.0):
        text = CHIRPED.format(phase="50*atan2(t - 0.4, 0.01)", mass=1)
        points = run(text, f"solver.end={end}").section("zero")[:, 0]
        t = 0.4 + 0.01 * np.tan(np.pi * np.arange(-24, 25) / 50)
        assert points == pytest.approx(t[(t > 0) & (t < end)], abs=1e-9)


@pytest.mark.parametrize("method", ["auto", "radau"])
def test_what_is_spun_up_within_a_step(method):
    """From rest to 8,000 turns, by a first step as long as that."""
    r = run(f"""
planar: true
bodies: {{wheel: {{mass: 1, inertia: 1}}}}
joints: {{pin: {{type: revolute, bodies: [ground, wheel], at: [0, 0]}}}}
forces: {{motor: {{type: applied_load, body: wheel, direction: [0, 0, 1], torque: 1e5}}}}
sensors: {{rim: {{type: point, body: wheel, at: [1, 0], axis: [1, 0, 0]}}, angle: {{joint: pin}}}}
poincare: {{top: {{when: rim, crosses: both, plot: [angle, rim]}}}}
solver: {{end: 1, first_step: 0.999, tolerance: 1e-3, method: {method}}}
output: {{every: 0.1}}
""")
    t = np.sqrt(2e-5 * np.pi * (np.arange(15915) + 0.5))
    assert r.section("top")[:, 0] == pytest.approx(t, abs=1e-6)


def test_waves_of_a_prescribed_motion_are_not_passed_over():
    r = run("""
bodies: {disc: {mass: 2, inertia: 1}}
joints: {pin: {type: revolute, bodies: [ground, disc], at: [0, 0]}}
drives: {motor: {joint: pin, velocity: "1 + 1e-9*sin(3000*t)"}}
sensors: {angle: {joint: pin}}
solver: {end: 1, tolerance: 1e-4}
poincare: {beat: {when: motor.force, plot: [angle, angle.rate]}}
""")
    t = (np.arange(477) + 0.75) * 2 * np.pi / 3000  # the torque is in proportion to cos(3000 t)
    assert r.section("beat")[:, 0] == pytest.approx(t, abs=1e-9)


@pytest.mark.parametrize("when", ["x", "x.rate", "disc.position.y", "disc.angular_velocity.z"])
def test_what_steps_follow_costs_nothing_more(when):
    assert not built(
        SPINNING.format(planar="false", torque="sin(200*x)", when=when)
    ).model.wave.size


@pytest.mark.parametrize(("formula", "crossings"), [
    ("sin(500*x + 1)", 318), ("sin(300*t)", 95), ("1/(1 + ((x - 1.003)/1e-4)**2) - 0.3", 2),
])  # fmt: skip
def test_formulas_swing_themselves(formula, crossings):
    """Of the place of a block that flies two metres in three steps."""
    r = run(f"""
bodies: {{block: {{mass: 1, inertia: 1, velocity: [2, 0]}}}}
joints: {{rail: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: rail}}, f: {{type: formula, value: "{formula}"}}}}
poincare: {{zero: {{when: f, crosses: both, plot: [x, f]}}}}
solver: {{end: 1, tolerance: 1e-6}}
output: {{every: 0.1}}
""")
    assert len(r.section("zero")) == crossings
    assert np.abs(r.section("zero")[:, 2]).max() < 1e-7


def test_waves_of_a_motion_that_an_event_sets():
    """Its clock begins at the event; before it, what it would do then says nothing."""
    r = run("""
planar: true
bodies: {wheel: {mass: 1, inertia: 1e6}}
joints: {pin: {type: revolute, bodies: [ground, wheel], at: [0, 0]}}
drives: {motor: {joint: pin, velocity: "0*t"}}
sensors: {angle: {joint: pin}}
events:
  go:
    {when: t, value: 0.31,
     do: {set: {motor: {velocity: "1e-9*sin(100*atan2(t - 0.2022, 1e-4))"}}}}
poincare: {zero: {when: motor.velocity, crosses: both, plot: [angle, angle.rate]}}
solver: {end: 1, tolerance: 1e-3, method: dop853}
output: {every: 0.1}
""")
    t = 0.5122 + 1e-4 * np.tan(np.pi * np.arange(-49, 50) / 100)
    assert r.section("zero")[:, 0] == pytest.approx(t[(t > 0.31) & (t < 1)], abs=1e-9)
