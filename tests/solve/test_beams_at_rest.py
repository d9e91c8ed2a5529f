"""Flexible bars that bend far and stay there, and how they vibrate: through the whole program.

Exact elastica of tests/data; roots of Euler's and Bernoulli's beam.
"""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.special import ellipk

from trsim.assemble.reduce import displaced, jacobian, moves
from trsim.elements.scene import workspace
from trsim.errors import ModelError, ScenarioError
from trsim.scenario.load import load
from trsim.solve.diagnose.modes import modes
from trsim.solve.start.bars import places
from trsim.solve.start.consistent import start
from trsim.solve.start.softening import Parts, tangent
from trsim.solve.start.statics import static_forces

from ..mechanisms import DATA
from ..runs import assemble, scenario
from ..test_scenarios import VALIDATION

LOADS = (1, 3, 5, 10)  # P L^2 / EI
# beta L: roots of cosh cos = -1, cosh cos = 1, sin = 0, to all digits
ROOTS = {
    "clamped": (1.8751040687119611, 4.694091132974174, 7.854757438237613, 10.995540734875467,
                14.13716839104647),
    "free": (4.730040744862704, 7.853204624095838, 10.995607838001671, 14.137165491257464,
             17.27875965739948),
    "pinned": tuple(n * pi for n in range(1, 6)),
}  # fmt: skip


def table(name):
    rows = [s for s in (DATA / name).read_text().splitlines() if s[0] in "-0123456789"]
    return np.array([[float(x) for x in row.split(",")] for row in rows])


def begun(read):
    mechanism = assemble(read)
    return mechanism, start(read, mechanism, located=True)


def tip(name, *sets):
    """Place of the tip in the equilibrium of a file."""
    mechanism, at = begun(load(VALIDATION / f"{name}.yaml", sets))
    assert at.residual < 1e-6
    return places(mechanism, mechanism.beams["beam"], at.y)[0][-1]


def under(P, *sets, name="cantilever_tip_force"):
    """Deflection w and shortening u of the cantilever under a tip force."""
    x, y, z = tip(name, f"parameters.load={P}", *sets)
    return np.array([z if name == "cantilever_in_space" else y, 1.0 - x])


def known(P):
    rows = table("elastica_tip_force.csv")
    return rows[rows[:, 0] == P][0, 1:3]


def stretching(EA, P):
    rows = table("elastica_extensible.csv")
    return rows[(rows[:, 0] == EA) & (rows[:, 1] == P)][0, 2:4]


@pytest.mark.parametrize("curvature", ["exact", "gerstmayr", "paper"])
@pytest.mark.parametrize("strain", ["green", "engineering"])
def test_tip_force(strain, curvature):
    forms = f"bodies.beam.strain={strain}", f"bodies.beam.curvature={curvature}"
    assert under(10, *forms, "parameters.EA=1.2e7") == pytest.approx(known(10), abs=1e-5)


@pytest.mark.parametrize("EA", [1200, 4800, 30000, 120000])
def test_tip_force_on_a_bar_that_stretches(EA):
    for P in LOADS:
        found = under(P, f"parameters.EA={EA}")
        assert found == pytest.approx(stretching(EA, P), abs=1e-4)


def test_the_exact_curvature_is_another_beam_where_much_is_stretched():
    exact = "bodies.beam.curvature=exact", "bodies.beam.strain=green"
    far = under(10, *exact, "parameters.EA=1200") - stretching(1200, 10)
    assert max(abs(far)) == pytest.approx(4.6e-3, rel=0.02)
    near = under(10, *exact, "parameters.EA=120000") - stretching(120000, 10)
    assert max(abs(near)) < 1e-4


def test_order_of_the_elements():
    """4 once they resolve the bend, against a bar that stretches as much."""
    stiff = stretching(1200, 10)
    error = [
        max(abs(under(10, "parameters.EA=1200", f"bodies.beam.elements={n}") - stiff))
        for n in (4, 8)
    ]
    assert np.log2(error[0] / error[1]) > 3.5


def test_tip_moment_up_to_a_circle():
    for part, x, y in table("elastica_tip_moment.csv")[:6]:
        found = tip("cantilever_tip_moment", f"parameters.load={2 * pi * part}")
        assert found[:2] == pytest.approx([1 + x, y], abs=1e-4 if part < 1 else 1.1e-4)


def test_in_space_it_bends_as_in_the_plane():
    for P in (1, 10):
        assert under(P, name="cantilever_in_space") == pytest.approx(under(P), abs=1e-10)


def test_a_heavy_bar_hangs_on_its_ends():
    """A rope of next to no stiffness, pulled by its weight times a: half of it is a sinh(1)."""
    text = """
gravity: [0, -9.81]
bodies: {rope: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 16, area: 1e-4,
                second_moment: 1e-12, youngs_modulus: 1e8, density: 1000}}
joints:
  left: {type: revolute, bodies: [ground, rope], at: [0, 0]}
  right: {type: revolute, bodies: [shoe, rope], at: [1, 0]}
  rail: {type: prismatic, bodies: [ground, shoe], axis: [1, 0, 0]}
forces: {pull: {type: applied_load, body: shoe, direction: [1, 0, 0], force: PULL}}
"""
    a = float(0.5 / np.sinh(1.0))  # span 2 a asinh(1/2a), with its pull w a
    span, weight = 2 * a, 0.1 * 9.81
    text = text.replace("bodies: {rope", "bodies: {shoe: {mass: 1, inertia: 1, at: [1, 0]}, rope")
    text = text.replace("PULL", repr(weight * a)) + "initial: {equilibrium: all}\n"
    mechanism, at = begun(scenario(text, "solver.end=1"))
    r = places(mechanism, mechanism.beams["rope"], at.y)[0]
    assert r[-1, 0] == pytest.approx(span, abs=1e-3)
    assert r[8, 1] == pytest.approx(a - a * np.cosh(1.0), abs=1e-3)


COLUMN = """
planar: true
bodies:
  column: {type: ancf_cable, start: [0, 0], end: [0, 1], elements: 16, area: 1,
           second_moment: 1e-6, youngs_modulus: 1e6, density: 1}
joints: {clamp: {type: fixed, bodies: [ground, column], at: [0, 0]}}
forces:
  weight: {type: applied_load, body: column, at: [0, 1], direction: [0, -1, 0], force: WEIGHT}
  aside: {type: applied_load, body: column, at: [0, 1], direction: [1, 0, 0], force: ASIDE}
initial: {equilibrium: all}
"""


def column(weight, aside):
    read = scenario(COLUMN.replace("WEIGHT", repr(weight)).replace("ASIDE", repr(aside)),
                    "solver.end=1")  # fmt: skip
    mechanism, at = begun(read)
    return places(mechanism, mechanism.beams["column"], at.y)[0][-1]


def test_a_column_bends_over_when_its_load_is_more_than_eulers():
    """P / P_cr = (2 K(k) / pi)^2, sideways 2 k / K, k = sin(a / 2), a the slope of the tip."""
    k = np.sin(pi / 3)
    K = ellipk(k * k)
    x, _, _ = column(float(K * K), 1e-3)
    assert x == pytest.approx(2 * k / K, abs=1e-3)


def test_a_column_that_may_bend_to_both_sides_is_refused_above_eulers_load():
    assert column(0.99 * pi**2 / 4, 0.0)[0] == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(ModelError, match="beyond 50 % of the loads") as caught:
        column(2.0 * pi**2 / 4, 0.0)
    assert "buckle" in caught.value.hint


def test_all_is_what_names_all_joints():
    read = load(VALIDATION / "cantilever_tip_force.yaml")
    named = load(VALIDATION / "cantilever_tip_force.yaml", ["initial.equilibrium=[clamp]"])
    assert (read.initial.equilibrium, read.initial.settles) == (("clamp",), True)
    assert begun(read)[1].y == pytest.approx(begun(named)[1].y, abs=0)


def test_a_body_has_no_equilibrium_of_its_own():
    with pytest.raises(ScenarioError, match="no joint named 'beam'") as caught:
        load(VALIDATION / "cantilever_tip_force.yaml", ["initial.equilibrium=[beam]"])
    assert "equilibrium: all" in caught.value.hint


def test_an_indifferent_bar_is_refused():
    """Its weight bends it, and nothing holds it along its rail."""
    text = """
gravity: [0, -9.81]
bodies:
  shoe: {mass: 1, inertia: 1}
  bar: {type: ancf_cable, start: [0, 0], end: [1, 0], section: {width: 10 mm},
        youngs_modulus: 1e9, density: 1000}
joints:
  rail: {type: prismatic, bodies: [ground, shoe], axis: [1, 0, 0]}
  weld: {type: fixed, bodies: [shoe, bar], at: [0, 0]}
initial: {equilibrium: all}
"""
    with pytest.raises(ModelError, match="indifferent: nothing holds '") as caught:
        begun(scenario(text, "solver.end=1"))
    assert caught.value.path == ("initial", "equilibrium")


def test_a_load_that_nothing_holds():
    text = (VALIDATION / "beam_free.yaml").read_text() + "initial: {equilibrium: all}\n"
    text += "forces: {push: {type: applied_load, body: beam, direction: [1, 0, 0], force: 1}}\n"
    with pytest.raises(ModelError, match="no static equilibrium"):
        begun(scenario(text))


# --- frequencies -------------------------------------------------------------------------------


def vibrations(read):
    """Hz, of what oscillates, slowest first; how many motions are free."""
    mechanism, at = begun(read)
    found = modes(mechanism, at)
    free = [mode for mode in found if mode.kind == "free"]
    return mechanism, [mode for mode in found if mode.kind == "oscillates"], len(free)


@pytest.mark.parametrize("held", ROOTS)
def test_frequencies(held):
    _, found, free = vibrations(load(VALIDATION / f"beam_{held}.yaml"))
    exact = np.square(ROOTS[held]) / (2 * pi)
    assert [mode.frequency for mode in found[:5]] == pytest.approx(exact, rel=1e-4)
    assert free >= 3 if held == "free" else free == 0
    assert found[0].damping_ratio == 0.0


def test_frequencies_do_not_feel_the_axial_stiffness():
    """EA L^2 / EI = 1e7: differences of the forces would leave nothing of the slowest."""
    read = load(VALIDATION / "beam_clamped.yaml", ["parameters.EA=1e7"])
    exact = np.square(ROOTS["clamped"]) / (2 * pi)
    found = vibrations(read)[1][:2]
    assert [mode.frequency for mode in found] == pytest.approx(exact[:2], rel=1e-5)


def test_frequencies_in_space_come_in_pairs():
    read = load(VALIDATION / "beam_clamped.yaml", ["planar=false", "bodies.beam.elements=16"])
    found = [mode.frequency for mode in vibrations(read)[1][:4]]
    exact = np.repeat(np.square(ROOTS["clamped"][:2]) / (2 * pi), 2)
    assert found == pytest.approx(exact, rel=1e-4)


def test_shape_of_a_pinned_bar():
    """A half sine, told node by node; its ends turn."""
    mechanism, found, _ = vibrations(load(VALIDATION / "beam_pinned.yaml"))
    moved = {one.body: one for one in found[0].shape}
    x = np.arange(1, 32) / 32
    y = np.array([moved[f"beam[{k}]"].translation[1] for k in range(1, 32)])
    assert y / y[15] == pytest.approx(np.sin(pi * x), abs=1e-6)
    turn = moved["beam[0]"].rotation[2] / mechanism.model.size
    assert turn / y[15] == pytest.approx(pi, rel=1e-4)


def test_damping_of_the_material():
    """Kelvin and Voigt: zeta = beta omega / 2."""
    beta = 1e-3
    read = load(VALIDATION / "beam_clamped.yaml", [f"bodies.beam.damping={beta}"])
    for mode in vibrations(read)[1][:3]:
        undamped = mode.frequency / sqrt(1.0 - mode.damping_ratio**2)
        assert mode.damping_ratio == pytest.approx(pi * beta * undamped, rel=1e-6)


def test_a_taut_string():
    """Under a tension N far above E I / L^2: n / 2 sqrt(N / m l), l its length under N."""
    text = """
bodies:
  string: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 16, area: 1e-4,
           second_moment: 1e-13, youngs_modulus: 1e9, mass: 1}
  shoe: {mass: 1, inertia: 1, at: [1, 0]}
joints:
  left: {type: revolute, bodies: [ground, string], at: [0, 0]}
  right: {type: revolute, bodies: [shoe, string], at: [1, 0]}
  rail: {type: prismatic, bodies: [ground, shoe], axis: [1, 0, 0]}
forces: {pull: {type: applied_load, body: shoe, direction: [1, 0, 0], force: 100}}
initial: {equilibrium: all}
"""
    found = [mode.frequency for mode in vibrations(scenario(text, "solver.end=1"))[1][:3]]
    exact = np.arange(1, 4) / 2 * np.sqrt(100.0 / 1.001)
    assert found == pytest.approx(exact, rel=5e-4)


HELD_AND_LOADED = """
planar: PLANAR
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {diameter: 10 mm},
        youngs_modulus: 2 MPa, density: 7850 kg/m^3, damping: 1 ms}
  car: {type: rigid_body, mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, -0.2]}
gravity: [0, -9.81, 0]
joints:
  a: {type: spherical, bodies: [ground, bar], at: [0, 0]}
  b: {type: fixed, bodies: [bar, car], at: [1, 0]}
forces:
  up: {type: spring_damper, bodies: [ground, car], points: [[1, 1], [1.1, 0.1]], stiffness: 300,
       free_length: 0.5, damping: 10}
  twist: {type: applied_load, body: bar, at: [0.5, 0], direction: [0, 0, 1], torque: 3}
solver: {end: 1 s}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
def test_the_tangent_is_that_of_all_forces(planar):
    """Against differences in which the elastic forces take part, far from equilibrium."""
    mechanism = assemble(scenario(HELD_AND_LOADED.replace("PLANAR", planar)))
    work = workspace(mechanism.model)
    there = np.flatnonzero(moves(work, planar == "true"))
    dice = np.random.default_rng(5)
    dx, size = np.zeros(6 * (work.n - 1)), 1e-6
    dx[there] = 0.02 * dice.normal(size=there.size)
    y, lam = displaced(work, mechanism.y0, dx), dice.normal(size=work.m)
    parts = Parts(mechanism, work, 0.5)
    K = tangent(parts, y, lam)
    for k in there:
        ends = []
        for sign in (1.0, -1.0):
            near = displaced(work, y, sign * size * np.eye(dx.size)[k])
            J = jacobian(work, 0.0, near)[2]
            ends.append(static_forces(parts.work, near) - J.T @ lam)
        wanted = (ends[1] - ends[0]) / (2.0 * size)
        assert K[there, k] == pytest.approx(wanted[there], abs=1e-7 * np.abs(K).max())
