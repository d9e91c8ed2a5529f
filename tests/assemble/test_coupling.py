"""Which unknowns act on which: nothing that has an influence is left out."""

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.assemble.coupling import nodes
from trsim.assemble.equations import constraints, forces, poses
from trsim.elements.contract import BRANCH, N_BOOK, PHASE, UNLOCATED, WHOLE
from trsim.elements.scene import scene
from trsim.scenario.load import loads
from trsim.solve.methods.ggl_tables import colours

from ..runs import built

EVERYTHING = """
planar: {planar}
gravity: [0, -9.81, 0]
bodies:
  crank: {{mass: 1, inertia: [0.01, 0.02, 0.03], at: [0.1, 0]}}
  rod: {{mass: 1, inertia: [0.01, 0.02, 0.03], at: [0.4, 0]}}
  slider: {{mass: 1, inertia: [0.01, 0.02, 0.03], at: [0.6, 0]}}
  far: {{mass: 1, inertia: [0.01, 0.02, 0.03], at: [1, 1]}}
  free: {{mass: 1, inertia: [0.01, 0.02, 0.03], at: [2, 1]}}
joints:
  O: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  A: {{type: revolute, bodies: [crank, rod], at: [0.2, 0]}}
  B: {{type: revolute, bodies: [rod, slider], at: [0.6, 0], clearance: 0.1 mm, contact: pin}}
  guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
  hinge: {{type: revolute, bodies: [ground, far], at: [1, 0.9]}}
drives:
  motor: {{joint: O, velocity: 5, compliance: {{stiffness: 10, damping: 1}}}}
sensors:
  stroke: {{joint: guide}}
  turn: {{joint: hinge}}
forces:
  spring: {{type: spring_damper, bodies: [far, free], points: [[1, 1], [1.9, 1.1]],
           stiffness: 50, damping: 2}}
  twist: {{type: torsion_spring, joint: hinge, stiffness: 3, damping: 0.1}}
  push: {{type: applied_load, body: crank, direction: [1, 1, 0], force: "3*turn + stroke"}}
  follow: {{type: applied_load, body: free, frame: rod, direction: [0, 1, 0], force: 2}}
  table: {{type: applied_load, body: far, direction: [0, 1, 0],
          force: {{table: [[-10, -5], [0, 0], [10, 6], [20, 5]], of: stroke}}}}
  wall: {{type: limit_stop, joint: guide, upper: -0.1, stiffness: 1e5}}
contact_laws:
  pin: {{normal: lankarani_nikravesh, stiffness: internal, bearing_radius: 10 mm,
        youngs_modulus: 207 GPa, poisson: 0.3, restitution: 0.9,
        friction: {{law: sticking, coefficient: 0.3, stribeck_speed: 0.01,
                   bristle_stiffness: 1e5}}}}
solver: {{end: 1}}
"""


def acting(s, y):
    """What the equations are made of: loads, rates of states, constraint rows."""
    poses(s, y)
    forces(s, 0.3)
    constraints(s, 0.3)
    return np.concatenate([s.F[1:].ravel(), s.zd[N_BOOK:]])


@pytest.mark.parametrize("planar", ["true", "false"])
def test_every_influence_is_counted(planar):
    scenario = loads(EVERYTHING.format(planar=planar))
    mechanism = assemble(scenario)
    s, found = scene(mechanism.model), nodes(mechanism)
    assert found.bodies == 5
    assert found.states == len(mechanism.follows) == s.n_z - N_BOOK
    s.mem[:, PHASE], s.mem[:, BRANCH] = UNLOCATED, WHOLE
    rng = np.random.default_rng(0)
    y = mechanism.y0 + 1e-3 * rng.normal(size=len(mechanism.y0))  # the journal is in its bearing
    y[s.n_q + s.n_v :] = 1e-5
    near, seen = found.neighbours(), [set() for _ in range(found.bodies + found.states)]
    before = acting(s, y)
    per_q = 3 if s.d == 3 else 7
    for k in range(len(y)):
        if s.n_q + s.n_v <= k < s.n_q + s.n_v + N_BOOK:
            continue
        moved = y.copy()
        moved[k] += 1e-6
        changed = np.flatnonzero(np.abs(acting(s, moved) - before) > 1e-12)
        body = k // per_q if k < s.n_q else (k - s.n_q) // s.d
        node = body if k < s.n_q + s.n_v else found.bodies + k - s.n_q - s.n_v - N_BOOK
        for row in changed:
            other = row // 6 if row < 6 * found.bodies else row - 5 * found.bodies
            seen[node] |= {int(other)} - {node}
    for node, others in enumerate(seen):
        assert others <= near[node], f"node {node} acts on {others}, counted {near[node]}"
    # and the test sees what it should: contact, springs, sensors, states
    assert sum(map(len, seen)) >= 13


def test_columns_of_one_colour_act_on_different_nodes():
    scenario = loads(EVERYTHING.format(planar="true"))
    found = nodes(assemble(scenario))
    near, sets = found.neighbours(), colours(found)
    assert sorted(node for one in sets for node in one) == list(range(found.bodies + found.states))
    for one in sets:
        rows = [row for node in one for row in near[node] | {node}]
        assert len(rows) == len(set(rows))


def test_of_a_bar_nodes_are_alone_on_which_only_its_own_forces_act():
    """Or a pin right at the node, along the axes of the world; not those of a clamp."""
    mechanism = built("""
bodies:
  bar: {type: ancf_cable, start: [0, 0, 0], end: [1, 0, 0], section: {diameter: 20 mm},
        elements: 3, youngs_modulus: 2e11, density: 7800}
joints:
  clamp: {type: fixed, bodies: [ground, bar], at: [0, 0, 0]}
  pin: {type: revolute, bodies: [ground, bar], at: [1, 0, 0]}
solver: {end: 1}
""")
    assert nodes(mechanism).alone == {1, 2, 3}
