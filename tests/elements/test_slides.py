"""What rubs says where its law of friction is: static paths take it as full from there."""

import inspect
from importlib import import_module

import numpy as np
import pytest

from trsim import elements

from ..runs import run

SURFACE = """surface_contact, surface: {body: ground},
         ball: {body: block, at: [0, 0.01], radius: 0.01}, contact: rough"""
SEAL = """seal, line: {body: block, start: [0, 0], end: [0, 0, 1]}, height: 1 mm, load: 1e4,
         at: 1 mm, against: {body: ground, at: [0, 0], normal: [0, 1, 0]}, friction: 0.3"""
# acts on pistons behind a supply alone, which static paths refuse
APART = {"sync_shaft"}


@pytest.mark.parametrize("word", [word for word in elements.ELEMENTS if word not in APART])
def test_friction_is_declared(word):
    """An element whose forces rub names its law, or its friction is made by a joint's reaction."""
    one = elements.load(word)
    if "zd[FRICTION]" in inspect.getsource(import_module(f"trsim.elements.{word}")):
        assert one.slides is not None or "rub" in one.kernels


@pytest.mark.parametrize("kind", [SURFACE, SEAL], ids=["surface_contact", "seal"])
def test_a_static_path_is_rubbed(kind):
    """A block that is pulled over a floor, there and back: the pull is mu times the load."""
    got = run(f"""
planar: false
bodies:
  cart: {{mass: 1, inertia: [0.01, 0.01, 0.01], at: [0, 0.01]}}
  block: {{mass: 1, inertia: [0.01, 0.01, 0.01], at: [0, 0.01]}}
joints:
  along: {{type: prismatic, bodies: [ground, cart], at: [0, 0.01], axis: [1, 0, 0]}}
  up: {{type: prismatic, bodies: [cart, block], at: [0, 0.01], axis: [0, 1, 0]}}
drives: {{pull: {{joint: along, position: "0.1*sin(2*pi*t)"}}}}
forces:
  weight: {{type: applied_load, body: block, at: [0, 0.01], force: 50, direction: [0, -1, 0]}}
  under: {{type: {kind}}}
contact_laws:
  rough: {{normal: impact, stiffness: 1e8, damping: 0, ramp: 1e-6,
          friction: {{law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1e-3}}}}
solver: {{end: 0.4, method: static_path}}
output: {{every: 0.04}}
""")
    away = abs(np.cos(2 * np.pi * got.t)) > 0.05  # from where it turns back
    want = 0.3 * 50 * np.sign(np.cos(2 * np.pi * got.t))
    assert got["pull.force"][away] == pytest.approx(want[away], rel=1e-6)
