"""Pairs of materials: what a contact law takes of them, what stands above, and what is told."""

import pytest

from trsim.errors import ScenarioError
from trsim.laws.contact import ball_stiffness
from trsim.scenario.explain import explained
from trsim.scenario.load import loads
from trsim.scenario.pairs import MATERIALS, ORIGINS, PAIRS, values

from .runs import built, run

BALL = """
bodies:
  ball: {{mass: 0.1, inertia: 1.6e-5, at: [0, 0.03], velocity: [{v}, 0]}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground, shape: plane}},
          ball: {{body: ball, at: [0, 0.03], radius: 0.02}}}}
contact_laws: {{pad: {{{law}}}}}
gravity: [0, -9.81, 0]
solver: {{end: 0.1}}
"""


def law(text):
    return loads(BALL.format(law=text, v=0)).contact_laws["pad"]


@pytest.mark.parametrize("pair", PAIRS)
def test_every_pair_loads_and_every_value_has_an_origin(pair):
    found = law(f"pair: {pair}, normal: identified, restitution: 0.5")
    for value in values(PAIRS[pair]).values():
        assert ORIGINS[value.origin]
        assert value.from_where.startswith(ORIGINS[value.origin])
    assert PAIRS[pair].kinetic.number <= PAIRS[pair].static.number
    one, other = MATERIALS[PAIRS[pair].first], MATERIALS[PAIRS[pair].second]
    assert found.materials == tuple(tuple(v.number for v in m) for m in (one, other))
    for key in ("youngs_modulus", "journal_poisson", "friction.coefficient"):
        assert f"{key} {values(PAIRS[pair])[key].number:g} (" in found.taken


def test_the_table_by_hand():
    found = law("pair: steel-aluminium, normal: newton, restitution: 0.7")
    assert found.materials == ((200e9, 0.29), (68.9e9, 0.33))
    assert (found.friction.law, found.friction.coefficient) == ("modified_coulomb", 0.47)
    assert found.on_surface(0.02, 0.0).stiffness == pytest.approx(
        ball_stiffness(0.02, 0.0, (200e9, 0.29), (68.9e9, 0.33))
    )
    assert law("pair: steel-steel, normal: identified").restitution == 0.56


def test_what_is_given_stands_above_the_table():
    found = law("pair: steel-steel, normal: newton, restitution: 0.9, youngs_modulus: 210 GPa, "
                "friction: {law: sticking, coefficient: 0.2, stribeck_speed: 1 mm/s, "
                "bristle_stiffness: 1e5}")  # fmt: skip
    assert (found.restitution, found.youngs_modulus) == (0.9, 210e9)
    assert found.materials[1] == (200e9, 0.29)
    assert found.friction.coefficient == 0.2
    assert found.friction.static_coefficient is None, "not that of another coefficient"
    assert "restitution" not in found.taken
    assert " youngs_modulus" not in found.taken
    assert "journal_youngs_modulus 2e+11" in found.taken
    none = law("pair: steel-steel, normal: identified, friction: {law: none}")
    assert none.friction.law == "none"
    assert "friction" not in none.taken
    assert law("pair: steel-steel, normal: identified, stiffness: 1e8").stiffness == 1e8


def test_sticking_takes_both_coefficients():
    found = law(
        "pair: steel-steel, normal: identified, "
        "friction: {law: sticking, stribeck_speed: 1 mm/s, bristle_stiffness: 1e5}"
    )
    assert (found.friction.static_coefficient, found.friction.coefficient) == (0.74, 0.57)
    assert "friction.static_coefficient 0.74" in found.taken


def test_an_impact_law_takes_no_restitution():
    found = law("pair: steel-steel, normal: impact, damping: 10, ramp: 1e-5")
    assert found.restitution is None


def test_a_journal_takes_the_moduli():
    text = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  pin: {type: revolute, bodies: [ground, rod], at: [0, 0], clearance: 0.1 mm}
contact_laws:
  pad: {pair: steel-bronze, normal: identified, restitution: 0.5, bearing_radius: 10 mm}
solver: {end: 0.02 s}
"""
    made = loads(text).contact_laws["pad"]
    assert made.stiffness == "internal"
    assert made.materials == ((200e9, 0.29), (103e9, 0.34))
    built(text)


@pytest.mark.parametrize("given, said", [
    ("pair: steel-cheese, normal: newton", "steel-rubber"),
    ("pair: [steel], normal: newton", "steel-rubber"),
    ("pair: steel-steel, normal: newton, friction: {law: [coulomb]}", "coulomb"),
    ("pair: steel-rubber, normal: newton", "no origin is known for a restitution of steel-rubber"),
])  # fmt: skip
def test_what_is_not_in_the_table_is_said(given, said):
    with pytest.raises(ScenarioError) as caught:
        law(given)
    assert said in caught.value.show()


def test_explain_prints_the_table_with_its_origins():
    [page] = explained("contact_laws")["sections"]
    told = " ".join(page["law"].split())
    for name, pair in PAIRS.items():
        assert name in told
        assert pair.kinetic.from_where in told
    for E, nu in MATERIALS.values():
        assert E.from_where in told
        assert nu.from_where in told


def test_a_ball_rubs_by_its_pair():
    r = run(BALL.format(law="pair: steel-ptfe, normal: newton, restitution: 0.3", v=1.0))
    # its first impact, where it slides: mu p / m less along the floor
    v_0 = (2.0 * 9.81 * 0.01) ** 0.5
    first = r["ball.velocity"][r.t > v_0 / 9.81 + 1e-6][0, 0]
    assert first == pytest.approx(1.0 - 0.04 * 1.3 * v_0, rel=1e-4)
