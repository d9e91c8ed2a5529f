"""Springs, dampers and ropes by laws of their own, between two points."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from trsim.errors import ScenarioError

from ..runs import built, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power

SPRUNG = """
forces:
  spring: {{type: spring, bodies: [left, right], points: [[0.3, 0, 0.1], [0.6, 0.1, 0]], {}}}
"""
LAWS = {
    "cubic": 'elastic: "300*stretch + 50*stretch**3", free_length: 0.2',
    "table": "elastic: {table: [[-1, -20], [0, 3], [1, 40], [2, 50]], outside: extend}",
    "corner": 'elastic: "100*max(stretch - 0.3, 0)", damper: "5*rate*abs(rate)"',
    "one way": 'elastic: "100*stretch", damper: "7*rate", damper_acts: extension',
    "rope": 'elastic: "100*stretch", damper: "2*rate", tension_only: true, free_length: 0.1',
}
SEEDS = range(3)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("seed", SEEDS)
def test_action_is_reaction_and_the_book_closes(law, seed):
    b = bench(SPRUNG.format(LAWS[law]), np.random.default_rng(seed))
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[2] <= 0.0  # dampers only take


@pytest.mark.parametrize("law", ["cubic", "table", "corner", "rope"])
@pytest.mark.parametrize("seed", SEEDS)
def test_force_is_minus_the_gradient_of_the_energy(law, seed):
    check_gradient(bench(SPRUNG.format(LAWS[law]), np.random.default_rng(seed)))


def test_it_is_the_linear_one_where_its_laws_are_linear():
    laws = 'elastic: "5 + 300*stretch", damper: "20*rate", free_length: 0.2'
    own = bench(SPRUNG.format(laws), np.random.default_rng(4))
    linear = SPRUNG.format("stiffness: 300, damping: 20, preload: 5, free_length: 0.2")
    linear = linear.replace("type: spring", "type: spring_damper")
    other = bench(linear, np.random.default_rng(4))
    np.testing.assert_allclose(own.wrenches(), other.wrenches(), rtol=1e-13, atol=1e-12)
    assert own.energy() == pytest.approx(other.energy(), rel=1e-13)
    assert own.book[2] == pytest.approx(other.book[2], rel=1e-13)


LINE = """
bodies: {{block: {{mass: 2, inertia: 0.01, velocity: [{v}, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
forces:
  spring: {{type: spring, bodies: [ground, block], points: [[-3, 0], [0, 0]], {law}}}
solver: {{end: {end}, {method}}}
output: {{every: 0.05}}
"""
METHODS = ["method: dop853, tolerance: 1e-9", "method: radau, tolerance: 1e-9",
           "method: auto, tolerance: 1e-9", "method: 'scipy:RK45', tolerance: 1e-9",
           "method: rk4, step: 1 ms",
           "method: generalized_alpha, tolerance: 1e-6"]  # fmt: skip


def lined(law, v=0.0, end=2, method=METHODS[0]):
    r = run(LINE.format(law=law, v=v, end=end, method=method))
    scale = max(np.abs(r["energy.kinetic"]).max(), np.abs(r["energy.stored.springs"]).max())
    accuracy = 1e-4 if "alpha" in method else 1e-6 if "rk4" in method else 1e-7
    assert np.abs(r["energy.residual"]).max() < accuracy * scale
    return r


@pytest.mark.parametrize("method", METHODS)
def test_a_quadratic_damper(method):
    """v(t) = v0 / (1 + c v0 t / m)."""
    r = lined('damper: "3*rate*abs(rate)"', 4.0, 2, method)
    expected = 4 / (1 + 3 * 4 * r.t / 2)
    accuracy = 1e-5 if "alpha" in method else 1e-8
    np.testing.assert_allclose(r["block.velocity"][:, 0], expected, rtol=accuracy)
    taken = r["block.velocity"][-1, 0] ** 2 - 16  # m = 2
    assert r["energy.work.dampers"][-1] == pytest.approx(taken, rel=10 * accuracy)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("way", ["extension", "compression"])
def test_a_damper_of_one_way(method, way):
    """Half swings with c and without in turn, each from its closed form."""
    k, m, c = 200.0, 2.0, 8.0
    w, d = math.sqrt(k / m), c / (2 * m)
    damped = math.sqrt(w * w - d * d)
    v0 = 1.0
    law = f'elastic: "200*stretch", damper: "8*rate", damper_acts: {way}'
    r = lined(law, v0, 2, method)
    # outwards to the top of the first swing, with or without damping
    first = way == "extension"
    x, v, t, out = 0.0, v0, 0.0, True
    expected = np.zeros_like(r.t)
    while t < r.t[-1]:
        decay, wave = (d, damped) if out == first else (0.0, w)
        span = (math.atan2(wave, decay) if t == 0.0 else math.pi) / wave

        def position(tau, x=x, v=v, decay=decay, wave=wave):
            b = (v + decay * x) / wave
            return np.exp(-decay * tau) * (x * np.cos(wave * tau) + b * np.sin(wave * tau))

        inside = (r.t >= t) & (r.t <= t + span)
        expected[inside] = position(r.t[inside] - t)
        x, v, t, out = float(position(span)), 0.0, t + span, not out
    accuracy = 1e-4 if "alpha" in method else 1e-8
    np.testing.assert_allclose(r["block.position"][:, 0], expected, atol=accuracy)


@pytest.mark.parametrize("method", METHODS)
def test_a_table_against_its_integral(method):
    """The speed anywhere is that of the energy; corners of the table are met by steps."""
    from scipy.interpolate import Akima1DInterpolator

    x, y = [-0.5, -0.1, 0.0, 0.02, 0.2, 0.6], [-300, -20, 0, 30, 45, 200]
    rows = [list(p) for p in zip(x, y, strict=True)]
    r = lined(f"elastic: {{table: {rows}}}", 3.0, 1, method)
    f = Akima1DInterpolator(x, y).antiderivative()
    at = r["block.position"][:, 0]
    assert at.max() < 0.6 and at.min() > -0.5
    energy = np.array([f(a) - f(0.0) for a in at])
    np.testing.assert_allclose(r["energy.stored.springs"], energy, atol=1e-12)
    accuracy = 1e-3 if "alpha" in method else 1e-6
    np.testing.assert_allclose(r["block.velocity"][:, 0] ** 2 + energy, 9.0, rtol=accuracy)


BUNGEE = """
bodies: {{jumper: {{mass: 80, inertia: 5, at: [0, -1]}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, jumper], axis: [0, 1, 0]}}}}
sensors: {{height: {{joint: guide, at_start: -1}}}}
forces:
  rope: {{type: spring, bodies: [ground, jumper], points: [[0, 0], [0, -1]], free_length: 12,
         elastic: {}, tension_only: true{}}}
gravity: [0, -9.81, 0]
solver: {{end: {end}, {}}}
output: {{every: 0.02}}
"""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "elastic",
    ['"150*stretch + 2*stretch**3"', "{table: [[0, 0], [5, 1000], [10, 3500], [20, 9000]]}"],
)
def test_a_bungee_jump(method, elastic):
    """The deepest point is where the weight has given what the rope has taken; then up, and slack
    again."""
    r = run(BUNGEE.format(elastic, "", method, end=5))
    if "table" in elastic:
        from scipy.interpolate import Akima1DInterpolator

        stored = Akima1DInterpolator([0, 5, 10, 20], [0, 1000, 3500, 9000]).antiderivative()
    else:

        def stored(s):
            return 75 * s * s + 0.5 * s**4

    deepest = brentq(lambda s: stored(s) - stored(0) - 80 * 9.81 * (11 + s), 0.1, 19)
    accuracy = 1e-4 if "alpha" in method else 1e-8
    low = r.mechanism.columns
    lowest = r.outcome.peaks[next(c.start for c in low if c.name == "rope.length"), 0]
    assert lowest == pytest.approx(12 + deepest, rel=accuracy)
    assert r["rope.force"].min() == 0.0  # slack at first, and never pushes
    slack = r["rope.length"] < 12
    assert slack[0] and slack[-1] and not slack.all() and not r["rope.force"][slack].any()
    free = r.t < math.sqrt(2 * 11 / 9.81)
    fallen = -1 - 4.905 * r.t[free] ** 2
    np.testing.assert_allclose(
        r["height"][free], fallen, atol=1e-9 if "rk4" not in method else 1e-7
    )
    scale = 80 * 9.81 * 25
    assert np.abs(r["energy.residual"]).max() < (1e-3 if "alpha" in method else 1e-6) * scale


def test_a_rope_with_a_damper_never_pushes_and_takes_what_it_lets_go():
    """Strongly damped: while it recoils the damper would push, and the rope goes slack early."""
    r = run(BUNGEE.format('"500*stretch"', ', damper: "40*rate"', METHODS[0], end=12))

    def rate(t, y):
        s = -y[0] - 12
        T = max(0.0, 500 * s + 40 * -y[1]) if s > 0 else 0.0
        return [y[1], -9.81 + T / 80]

    exact = solve_ivp(rate, (0, 12), [-1, 0], "DOP853", r.t, rtol=1e-11, atol=1e-12, max_step=0.02)
    np.testing.assert_allclose(r["height"], exact.y[0], atol=1e-6)
    assert r["rope.force"].min() == 0.0
    assert (np.diff(r["energy.work.dampers"]) <= 1e-9).all()
    early = (r["rope.force"] == 0.0) & (r["rope.length"] > 12.0)
    assert early.any()
    assert np.abs(r["energy.residual"]).max() < 1e-6 * 80 * 9.81 * 25


def test_two_ropes_hold_a_body_and_one_is_slack():
    """In balance between a rope that pulls and one that is slack: 100 N on 2000 N/m."""
    r = run("""
bodies: {block: {mass: 10, inertia: 1, at: [0, -1]}}
joints: {guide: {type: prismatic, bodies: [ground, block], axis: [0, 1, 0]}}
forces:
  above: {type: spring, bodies: [ground, block], points: [[0, 0], [0, -1]], elastic: "2000*stretch",
          damper: "100*rate", tension_only: true}
  below: {type: spring, bodies: [ground, block], points: [[0, -3], [0, -1]], free_length: 2,
          elastic: "2000*stretch", damper: "100*rate", tension_only: true}
gravity: [0, -10, 0]
initial: {equilibrium: all}
solver: {end: 1}
""")
    np.testing.assert_allclose(r["above.force"], 100.0, rtol=1e-8)
    np.testing.assert_allclose(r["below.force"], 0.0, atol=1e-12)
    np.testing.assert_allclose(r["block.position"][:, 1], -1.05, rtol=1e-9)


@pytest.mark.parametrize(
    "law, what",
    [
        ("", "nothing acts"),
        ('elastic: "3*t"', "'t' cannot stand here: this is a function of `stretch` alone"),
        ('elastic: "3*rate"', "'rate' cannot stand here"),
        ('damper: "3*stretch"', "'stretch' cannot stand here"),
        ('damper: "3 + rate"', "a damper of 3 at rest"),
        ('damper: "rate**2"', "it drives, and does not damp"),
        ('damper: "-rate"', "it drives, and does not damp"),
        ("damper: {table: [[0, 0], [1, -3]]}", "it drives, and does not damp"),
        ("damper: {table: [[0.1, 0], [1, 3]]}", "must hold a rate of 0"),
        ("elastic: {table: [[0 N, 0], [1 N, 3]]}", "wrong unit"),
        ("elastic: {table: [[0 rad, 0], [1 rad, 3]]}", "'stretch' is in m"),
        ("elastic: {table: [[-1, -3], [1, -3]]}, tension_only: true", "it pushes with 3"),
        ("elastic: {table: [[-1, 0], [0, 0], [1, 3]]}, damper: rate, tension_only: true",
         "a damper beside a table may push"),
    ],
)  # fmt: skip
def test_what_is_refused(law, what):
    with pytest.raises(ScenarioError, match=what):
        built(LINE.format(law=law, v=0, end=1, method="").replace(", }", "}"))


def test_a_parameter_must_not_take_the_name_of_the_stretch():
    text = LINE.format(law='elastic: "3*stretch"', v=0, end=1, method="")
    with pytest.raises(ScenarioError, match="`stretch` means what this is a function of"):
        built("parameters: {stretch: 2}\n" + text)


def chain(n, method):
    """Rods side by side on springs with laws of their own, and a rope from their end to itself as
    drawn, a line without length that has no direction at the start."""
    lines = ["bodies:"]
    lines += [f"  b{k}: {{mass: 1, inertia: 0.02, at: [{k + 0.5}, 0]}}" for k in range(n)]
    lines += ["joints:"]
    before = ["ground", *(f"b{k}" for k in range(n))]
    lines += [
        f"  j{k}: {{type: revolute, bodies: [{before[k]}, b{k}], at: [{k}, 0]}}" for k in range(n)
    ]
    law = 'elastic: "5*stretch + 40*stretch**3", damper: "0.5*rate + 0.1*rate*abs(rate)"'
    lines += ["forces:"]
    lines += [
        f"  s{k}: {{type: joint_spring, joint: j{k}, {law}, damper_acts: extension}}"
        for k in range(n)
    ]
    lines += [
        f"  rope: {{type: spring, bodies: [ground, b{n - 1}], points: [[{n}, 0], [{n}, 0]],",
        '         free_length: 3, elastic: "200*stretch", damper: "3*rate", tension_only: true}',
        "  drag: {type: applied_load, body: b5, direction: [0, 0, 1],",
        '         torque: "-0.2*bend.rate*abs(bend.rate)"}',
        "sensors: {bend: {joint: j5}}",
        "gravity: [0, -9.81, 0]",
        f"solver: {{end: 2, tolerance: 1e-7, {method}}}",
        "output: {every: 0.1}",
    ]
    return "\n".join(lines)


def test_a_chain_with_many_laws_is_the_same_by_every_method():
    methods = ("method: dop853", "method: radau, formulation: ggl",
               "method: radau, formulation: index1")  # fmt: skip
    runs = [run(chain(12, method)) for method in methods]
    for r in runs:
        assert np.abs(r["energy.residual"]).max() < 1e-5 * 1000
        assert int(r.outcome.record.unproved) == 0
        np.testing.assert_allclose(r["b11.position"], runs[0]["b11.position"], atol=1e-4)
    assert runs[0]["rope.force"].max() > 10.0
    assert runs[0].outcome.record.steps < 1000


def test_on_a_flexible_bar():
    """The tip of a soft bar on a hardening rope, and a load that follows its middle."""
    text = """
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {diameter: 10 mm},
        youngs_modulus: 2 GPa, density: 2000}
joints: {clamp: {type: fixed, bodies: [ground, bar], at: [0, 0]}}
forces:
  tip: {type: spring, bodies: [ground, bar], points: [[1, 0.5], [1, 0]], free_length: 0.3,
        elastic: "30*stretch + 100*stretch**3", damper: "rate*abs(rate)", tension_only: true}
  push: {type: wrench, body: bar, at: [0.5, 0], frame: bar, force: [0, "-2*smoothstep(t/0.2)"],
         moment: [0, 0, 0.1]}
solver: {end: 0.1, tolerance: 1e-6, method: METHOD}
output: {every: 0.01}
"""
    one, other = (run(text.replace("METHOD", m)) for m in ("dop853", "radau"))
    np.testing.assert_allclose(one["bar.tip"], other["bar.tip"], atol=1e-6)
    for r in (one, other):
        assert np.abs(r["energy.residual"]).max() < 1e-6
    assert one["tip.force"][0] == pytest.approx(30 * 0.2 + 100 * 0.2**3, rel=1e-9)


HELD_AT_A_JUMP = """
bodies: {b: {mass: 1, inertia: 0.01, at: [0, -1]}}
joints: {g: {type: prismatic, bodies: [ground, b], axis: [0, 1, 0]}}
gravity: [0, -9.81]
forces:
  s: {type: spring, bodies: [ground, b], points: [[0, 0], [0, -1]],
      elastic: LAW, tension_only: true}
solver: {end: 1, METHOD}
"""


@pytest.mark.parametrize("method", ["radau", "dop853", "auto"])
@pytest.mark.parametrize(
    "law",
    ["50 + 100*stretch", "50", "50*(stretch > 0)", "{table: [[-1, 50], [0, 50], [1, 90]]}"],
)
def test_what_rests_where_a_rope_jumps_names_it(law, method):
    """50 N against a weight of 9.81 N, at once: it goes up and down about a stretch of 0."""
    quoted = law if law.startswith("{") else f'"{law}"'
    text = HELD_AT_A_JUMP.replace("LAW", quoted).replace("METHOD", f"method: {method}")
    r = run(text.replace("solver: {", "solver: {max_steps: 5000, "), fails=True)
    assert "forces.s (" in r.outcome.reason
    assert "its force jumps from 0 to 50 N" in r.outcome.reason
    assert "50*step(stretch, 0, 0, 0.001, 1)" in r.outcome.reason


@pytest.mark.parametrize(
    "law", ["50*step(stretch, 0, 0, 0.001, 1)", "9e3*stretch", "40*max(stretch, 0)**0.5"]
)
def test_a_rope_that_rises_holds(law):
    r = run(HELD_AT_A_JUMP.replace("LAW", f'"{law}"').replace("METHOD", "method: auto"))
    assert not next(i.row for i in r.mechanism.instances if i.name == "s").leaps


def test_a_constant_pull_that_is_taut_all_along():
    """A weight of 9.81 N on 5 N, from a stretch of 10 mm on."""
    text = HELD_AT_A_JUMP.replace("LAW", "5, free_length: 0.99").replace("METHOD", "method: auto")
    r = run(text)
    assert r["b.position"][-1, 1] == pytest.approx(-1 - 0.5 * (9.81 - 5), abs=1e-9)
