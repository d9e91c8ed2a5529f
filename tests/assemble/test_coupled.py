"""Rows that name more than two frames: gears and couplers, against closed forms.

A carrier on the ground, a sun and planets on it, a torque T cos(w t) on the sun.  With I_c the
inertia of the carrier and of the planets' masses about its axis, and r the ratio of radii,

    planets turn at   phi_p' = phi_c' + r (phi_c' - phi_s')
    2 T = I_c phi_c'^2 + I_s phi_s'^2 + n I_p phi_p'^2

so M (phi_c'', phi_s'') = (0, T cos(w t)) with M constant: angles are T (1 - cos(w t))/w^2 times
numbers, in the plane as in space, where all inertias are alike.
"""

import numpy as np
import pytest

from trsim.assemble import hubs as choosing
from trsim.assemble.assemble import pack
from trsim.assemble.build import Parts, as_drawn
from trsim.assemble.coupling import nodes
from trsim.assemble.reduce import jacobian
from trsim.assemble.release import release
from trsim.assemble.rows import all_rows
from trsim.scenario.load import loads
from trsim.solve.methods.ggl_tables import tables

from ..runs import built, energy_error, run
from .test_schur import dense, evaluated, filled

M, D = 0.5, 0.3  # kg of a planet, m
I_C, I_S, I_P = 0.08, 0.02, 0.01
R_S, R_P = 0.2, 0.1
TORQUE, OMEGA, END = 3.0, 2.0, 1.5
SPACES = {"plane": ("true", [0.0, 0.0, 1.0]), "space": ("false", [2.0 / 3, 1.0 / 3, 2.0 / 3])}
METHODS = {
    "dop853": ("method: dop853, tolerance: 1e-9", 1e-8),
    "radau": ("method: radau, tolerance: 1e-8", 1e-6),
    "ggl": ("method: radau, formulation: ggl, tolerance: 1e-8", 1e-6),
    "rk4": ("method: rk4, step: 1e-3", 1e-9),
    "generalized_alpha": ("method: generalized_alpha, tolerance: 1e-5", 1e-3),
}


def inertia(planar, I):
    return f"{I}" if planar == "true" else f"[{I}, {I}, {I}]"


def epicyclic(space="plane", method="dop853", planets=1, more=""):
    """Carrier, sun and planets; the axis through the origin."""
    planar, axis = SPACES[space]
    a = np.array(axis)
    u = np.cross(a, [0.3, -0.5, 0.8] if planar == "false" else [0.0, 1.0, 0.0])
    u /= np.linalg.norm(u)
    w = np.cross(a, u)
    bodies = [f"carrier: {{mass: 2, inertia: {inertia(planar, I_C)}}}",
              f"sun: {{mass: 1, inertia: {inertia(planar, I_S)}}}"]  # fmt: skip
    joints = [
        f"{name}: {{type: revolute, bodies: [{pair}], at: [0, 0], axis: {axis}}}"
        for name, pair in (("bearing", "ground, carrier"), ("middle", "carrier, sun"))
    ]
    for k in range(planets):
        turn = 2.0 * np.pi * k / planets
        at = (D * (np.cos(turn) * u + np.sin(turn) * w)).tolist()
        bodies.append(f"planet{k}: {{mass: {M}, inertia: {inertia(planar, I_P)}, at: {at}}}")
        joints += [
            f"pin{k}: {{type: revolute, bodies: [carrier, planet{k}], at: {at}, axis: {axis}}}",
            f"teeth{k}: {{type: gear, joints: [middle, pin{k}], radii: [{R_S}, {R_P}]}}",
        ]
    return "\n".join([
        f"planar: {planar}", "bodies:", *(f"  {line}" for line in bodies),
        "joints:", *(f"  {line}" for line in joints), more,
        "sensors: {phi_c: {joint: bearing}, phi_s: {joint: middle}, phi_p: {joint: pin0}}",
        "forces:",
        f"  push: {{type: applied_load, body: sun, direction: {axis}, "
        f'torque: "{TORQUE}*cos({OMEGA}*t)"}}',
        f"solver: {{end: {END}, {METHODS[method][0]}}}",
    ])  # fmt: skip


def exact(t, planets=1):
    """Angles of the carrier, and of the sun and the planets against it."""
    r = R_S / R_P
    planet = np.array([1.0 + r, -r])  # phi_p' of (phi_c', phi_s')
    mass = np.diag([I_C + planets * M * D**2, I_S]) + planets * I_P * np.outer(planet, planet)
    carrier, sun = (
        np.linalg.solve(mass, [0.0, TORQUE])[:, None] * (1 - np.cos(OMEGA * t)) / OMEGA**2
    )
    return carrier, sun - carrier, -r * (sun - carrier)


def check(found, planets=1, error=1e-8):
    """A run against the exact motion."""
    for name, angle in zip(("phi_c", "phi_s", "phi_p"), exact(found.t, planets), strict=True):
        assert found[f"{name}"] == pytest.approx(angle, abs=error * np.abs(angle).max())


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("method", METHODS)
def test_a_gear_between_three_bodies(space, method):
    found = run(epicyclic(space, method))
    model = found.mechanism.model
    assert found.mechanism.mobility == 2
    assert np.diff(model.row_start).max() == 3
    check(found, error=METHODS[method][1])
    assert energy_error(found) < 1e-4


@pytest.mark.parametrize("space", SPACES)
def test_equations_are_those_of_dense_matrices(space):
    for text in (epicyclic(space), four_pairs(space, False)):
        work, y = evaluated(text)
        filled(work)
        found = np.zeros((work.m, work.m))
        for start, end in zip(work.column_start, work.column_start[1:], strict=False):
            rows = work.row[start:end]
            found[rows, rows[0]] = found[rows[0], rows] = work.value[start:end]
        expected = dense(work, y)
        assert found == pytest.approx(expected, abs=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("method", ["dop853", "ggl"])
def test_gears_with_hubs(space, method, monkeypatch):
    """The carrier and the sun, on which all teeth act, as unknowns of the solve."""
    monkeypatch.setattr(choosing, "TRIED", 2)
    monkeypatch.setattr(choosing, "MANY", 0)
    monkeypatch.setattr(choosing, "WORTH", -1e9)
    found = run(epicyclic(space, method, planets=6))
    assert np.flatnonzero(found.mechanism.model.hub >= 0).tolist() == [1, 2]
    check(found, 6, METHODS[method][1])


def test_hubs_are_found_where_they_pay():
    assert np.flatnonzero(built(epicyclic(planets=30)).model.hub >= 0).tolist() == [1, 2]


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("method", METHODS)
def test_a_gear_that_repeats_another_is_redundant(space, method):
    again = "  again: {type: gear, joints: [middle, pin0], teeth: [2, 1]}"
    found = run(epicyclic(space, method, more=again))
    assert found.mechanism.redundant == ("again.relation",)
    check(found, error=METHODS[method][1])


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("method", ["dop853", "radau", "ggl", "rk4"])
def test_a_gear_that_is_released(space, method):
    """From then on nothing turns the carrier."""
    more = "events: {apart: {when: t, value: 0.7, do: {release: [teeth0]}}}"
    text = epicyclic(space, method)
    found = run(f"{more}\n{text}")
    until, after = found.t < 0.7, found.t > 0.7
    carrier = exact(found.t)[0]
    at, rate = exact(np.array([0.7]))[0][0], carrier[1] / (1 - np.cos(OMEGA * found.t[1]))
    rate *= OMEGA * np.sin(OMEGA * 0.7)
    error = METHODS[method][1]
    assert found["phi_c"][until] == pytest.approx(carrier[until], abs=error)
    assert found["phi_c"][after] == pytest.approx(at + rate * (found.t[after] - 0.7), abs=error)


def test_of_redundant_gears_one_is_released():
    again = "  again: {type: gear, joints: [middle, pin0], teeth: [2, 1]}"
    scenario = loads(epicyclic(more=again))
    found = release(scenario, built(epicyclic(more=again)))
    assert found.proven
    assert found.rows in (("again.relation",), ("teeth0.relation",))


def test_a_gear_couples_all_its_bodies_in_sparse_systems():
    text = epicyclic(planets=2)
    mechanism = built(text)
    groups = nodes(mechanism).groups
    assert frozenset({0, 1, 2}) in groups and frozenset({0, 1, 3}) in groups
    assert tables(nodes(mechanism), mechanism, mechanism.model)


def test_angles_are_looked_at_on_the_turns_of_the_drawing():
    """Drawn 9 rad from its carrier a wheel is no whole turn away from where its gear has it."""
    scenario = loads("""
planar: false
bodies:
  one: {mass: 1, inertia: [1, 1, 1], at: [0, 0], angle: 9}
  two: {mass: 1, inertia: [1, 1, 1], at: [0.3, 0]}
joints:
  first: {type: revolute, bodies: [ground, one], at: [0, 0]}
  other: {type: revolute, bodies: [ground, two], at: [0.3, 0]}
  teeth: {type: gear, joints: [first, other], radii: [0.1, 0.2]}
""")
    at, instances = pack(scenario, frozenset(), None, ())
    assert at.coordinates["first"].drawn == 9.0
    work, y = as_drawn(Parts.of(at, instances), all_rows(instances))
    assert np.abs(jacobian(work, 0.0, y)[0]).max() < 1e-15


# --- a coupler of four joints ----------------------------------------------------------------

COEFFICIENTS = (1.0, -0.5, 2.0, 0.7)
LOADS = ((1.0, 0.3), (-0.4, 0.8), (0.6, -0.2), (0.0, 0.5))  # N*m or N on the first and the second
FIRST, SECOND = (2.0, 1.0, 0.7, 1.3), (0.5, 0.8, 0.4, 0.9)  # their masses, and inertias in kg*m^2


def four_pairs(space, mixed, method="dop853"):
    """Pairs of bodies on one axis each, the first one on the ground; mixed: two of them slide."""
    planar, axis = SPACES[space]
    along = [1.0, 0.0, 0.0] if planar == "true" else [-1.0 / 3, -2.0 / 3, 2.0 / 3]
    bodies, joints, forces = [], [], []
    for k in range(4):
        slides = mixed and k % 2 == 1
        kind, way, at = (
            ("prismatic", along, "") if slides else ("revolute", axis, f", at: [{k}, 0]")
        )
        load = "force" if slides else "torque"
        for n, (body, on, J) in enumerate((("a", "ground", FIRST[k]), ("b", f"a{k}", SECOND[k]))):
            bodies.append(f"{body}{k}: {{mass: {J}, inertia: {inertia(planar, J)}, at: [{k}, 0]}}")
            joints.append(
                f"on_{body}{k}: {{type: {kind}, bodies: [{on}, {body}{k}], axis: {way}{at}}}"
            )
            forces.append(
                f"push_{body}{k}: {{type: applied_load, body: {body}{k}, "
                f'direction: {way}, {load}: "{LOADS[k][n]}*cos({OMEGA}*t)"}}'
            )
    names = [f"on_b{k}" for k in range(4)]
    joints.append(f"link: {{type: coupler, joints: [{', '.join(names)}], "
                  f"coefficients: {list(COEFFICIENTS)}}}")  # fmt: skip
    return "\n".join([
        f"planar: {planar}", "bodies:", *(f"  {line}" for line in bodies),
        "joints:", *(f"  {line}" for line in joints),
        "forces:", *(f"  {line}" for line in forces),
        "sensors:", *(f"  x{k}: {{joint: on_b{k}}}" for k in range(4)),
        f"solver: {{end: {END}, {METHODS[method][0]}}}",
    ])  # fmt: skip


def exact_pairs(t):
    """Coordinates of the four joints: x_k'' = f_b/m_b - f_a/m_a - lam c_k (1/m_a + 1/m_b)."""
    c, (f_a, f_b) = np.array(COEFFICIENTS), np.array(LOADS).T
    free = f_b / np.array(SECOND) - f_a / np.array(FIRST)
    gives = 1.0 / np.array(SECOND) + 1.0 / np.array(FIRST)
    lam = (c @ free) / (c @ (c * gives))
    return (free - lam * c * gives)[:, None] * (1 - np.cos(OMEGA * t)) / OMEGA**2


@pytest.mark.parametrize("mixed", [False, True], ids=["angles", "angles and strokes"])
@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("method", METHODS)
def test_a_coupler_of_four_joints(space, method, mixed):
    found = run(four_pairs(space, mixed, method))
    model = found.mechanism.model
    assert found.mechanism.mobility == 7
    assert np.diff(model.row_start).max() == 8
    error = METHODS[method][1]
    for k, x in enumerate(exact_pairs(found.t)):
        assert found[f"x{k}"] == pytest.approx(x, abs=error * np.abs(x).max())
