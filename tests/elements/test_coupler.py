"""Couplers: a screw made of one, closed forms, units, and what is refused.

Four joints without a common body, by every method: tests/assemble/test_coupled.py.
"""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run

A = np.array([2.0, 1.0, 2.0]) / 3.0
LEAD = 0.005 / (2 * np.pi)  # m/rad


def nut(coefficients="[5 mm/rev, -1]", more=""):
    """A nut that falls on a tilted spindle, and turns with it."""
    return f"""
planar: false
parameters: {{p: 5 mm/turn}}
bodies:
  nut: {{mass: 2, inertia: [1e-5, 1e-5, 1e-5], at: [0.1, 0.2, 0.3], angle: 2}}
joints:
  spindle: {{type: cylindrical, bodies: [ground, nut], at: [0.1, 0.2, 0.3], axis: {A.tolist()}}}
  thread: {{type: coupler, joints: [spindle.angle, spindle.stroke], coefficients: {coefficients}}}
sensors: {{angle: {{joint: spindle.angle}}, stroke: {{joint: spindle.stroke}}}}
gravity: {(-9.81 * A).tolist()}
solver: {{end: 1, tolerance: 1e-9}}
{more}
"""


@pytest.mark.parametrize("coefficients", ["[5 mm/rev, -1]", "[p, -1]", f"[-1, {1 / LEAD!r} rad/m]"])
def test_a_screw(coefficients):
    """(m + I/p^2) s'' = -m g, p the lead per radian; the thread pushes with m (s'' + g)."""
    r = run(nut(coefficients))
    acceleration = -2 * 9.81 / (2 + 1e-5 / LEAD**2)
    assert np.ptp(r["angle"]) > 100 * np.pi
    assert r["stroke"] == pytest.approx(acceleration * r.t**2 / 2, rel=1e-7, abs=1e-8)
    assert r["stroke"] == pytest.approx(LEAD * (r["angle"] - r["angle"][0]), rel=1e-11, abs=1e-12)
    force = 2 * (9.81 + acceleration)
    assert r["thread.force_2"] == pytest.approx(force, rel=1e-8)
    assert r["thread.torque_1"] == pytest.approx(-LEAD * force, rel=1e-8)
    assert energy_error(r) < 1e-9


TWO = """
parameters: {h: 2 mm/turn, p: 3 rad/m, l: 1 mm}
bodies:
  crank: {mass: 1, inertia: 0.5, at: [0, 0]}
  flap: {mass: 1, inertia: 0.2, at: [1, 0], angle: 3.5}
  slider: {mass: 3, inertia: 1, at: [2, 0]}
joints:
  a: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  b: {type: revolute, bodies: [ground, flap], at: [1, 0]}
  c: {type: prismatic, bodies: [ground, slider], axis: [1, 1]}
  d: {type: spherical, bodies: [ground, slider], at: [2, 0]}
  link: {type: coupler, joints: [a, b, c], coefficients: [2, -0.5, 0.8]}
forces:
  turn: {type: applied_load, body: crank, direction: [0, 0, 1], torque: 3}
  push: {type: applied_load, body: slider, direction: [1, 1], force: 7}
sensors: {x: {joint: a}, y: {joint: b}, z: {joint: c}}
solver: {end: 1, tolerance: 1e-10}
"""
FREE = TWO.replace("  d: {type: spherical, bodies: [ground, slider], at: [2, 0]}\n", "")


def test_three_coordinates():
    """M x'' = Q - lam c with c . x'' = 0; channels are -lam c_k."""
    r = run(FREE)
    M, Q, c = np.array([0.5, 0.2, 3.0]), np.array([3.0, 0.0, 7.0]), np.array([2.0, -0.5, 0.8])
    lam = (c @ (Q / M)) / (c @ (c / M))
    for x, acceleration in zip("xyz", (Q - lam * c) / M, strict=True):
        assert r[x] == pytest.approx(acceleration * r.t**2 / 2, abs=1e-9)
    found = [r["link.torque_1"], r["link.torque_2"], r["link.force_3"]]
    for one, force in zip(found, -lam * c, strict=True):
        assert one == pytest.approx(force, rel=1e-9)
    kept = 2 * r["x"] - 0.5 * r["y"] + 0.8 * r["z"]
    assert np.abs(kept).max() < 1e-12
    assert r.mechanism.mobility == 2 and r.mechanism.planar


def test_initial_values_move_the_others():
    r = run(FREE + "initial: {a: 1.5 rev, c: 0.2}\n", "solver.end=0.01")
    assert r["y"][0] == pytest.approx(2 * (2 * 3 * np.pi + 0.8 * 0.2), abs=1e-9)


REFUSED = {
    "one joint": ("[a, b, c], coefficients: [2, -0.5, 0.8]", "[a], coefficients: [1]",
                  ("joints",), "two or more"),
    "no joint": ("[a, b, c], coefficients: [2, -0.5, 0.8]", "[], coefficients: []",
                 ("joints",), "two or more"),
    "one too few": (", 0.8]", "]", ("coefficients",), "3 joints have 2 coefficients"),
    "zero": ("-0.5", "0", ("coefficients", 1), "must not be zero"),
    "not finite": ("-0.5", ".inf", ("coefficients", 1), ""),
    "twice": ("[a, b, c]", "[a, c, a]", ("joints", 2), "stands there twice"),
    "none": ("[a, b, c]", "[a, b, d]", ("joints", 2), "has no coordinate"),
    "itself": ("[a, b, c]", "[a, b, link]", ("joints", 2), "has no coordinate"),
    "unknown": ("[a, b, c]", "[a, b, e]", ("joints", 2), "no joint named"),
    "an angle in rad/m": ("[2, -", "[2 rad/m, -", ("coefficients", 0), "coefficient of an angle"),
    "a stroke in m/rad": ("0.8", "0.8 m/rad", ("coefficients", 2), "coefficient of a stroke"),
    "units that make no sum": ("[2, -0.5, 0.8]", "[2 m/rad, 1, 0.8 rad/m]",
                               ("coefficients",), "make no sum"),
    "a unit of strokes alone": ("[a, b, c], coefficients: [2, -0.5, 0.8]",
                                "[a, b], coefficients: [2 m/rad, 1]", ("coefficients", 0), "unit"),
    "a parameter in rad/m": ("[2, -", "[p, -", ("coefficients", 0), "coefficient of an angle"),
    "parameters that make no sum": ("[2, -0.5, 0.8]", "[h, 1, p]", ("coefficients",), "no sum"),
    "a parameter that is a length": ("0.8", "l", ("coefficients", 2), "wrong unit: 'mm'"),
    "a length": ("0.8", "0.8 m", ("coefficients", 2), "wrong unit"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    old, new, path, words = REFUSED[case]
    assert TWO.count(old) == 1
    with pytest.raises(TrsimError) as caught:
        built(TWO.replace(old, new))
    problem = caught.value.problems[0]
    assert problem.path == ("joints", "link", *path)
    assert words in problem.what


def test_has_no_reaction_of_two_bodies():
    names = {c.name for c in built(FREE).columns if c.name.startswith("link")}
    assert names == {"link.torque_1", "link.torque_2", "link.force_3"}
