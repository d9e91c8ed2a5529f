"""A hub's rods in line with it held: no singular place of the mechanism, and none is met."""

from math import asin, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest

from trsim.assemble.linear import SOUND, smallest_pivot
from trsim.assemble.projection import project_positions
from trsim.elements.scene import scene
from trsim.solve.diagnose.doubts import doubts

from ..assemble.test_schur import dense
from ..runs import run

# a crank of 50 mm, which carries the ram through a rod, or swings a rocker; three arms on it make
# either a hub, and all that carries them is crank and rod.  The crank is in line with the rod at
# t = (pi - atan2(3, 4)) / 10, the ram then at its inner dead centre
DRIVEN = """
bodies:
  crank: {{mass: 2, inertia: 0.004, at: [0.02, 0]}}
  rod: {{mass: 1, inertia: 0.01, at: [0.15, 0.02]}}
  ram: {{mass: 6, inertia: 0.02, at: [0.35, 0.06]}}
  e0: {{mass: 1, inertia: 0.01, at: [0.5, 0.3]}}
  e1: {{mass: 1, inertia: 0.01, at: [0.6, 0.3]}}
joints:
  b: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  c: {{type: revolute, bodies: [crank, rod], at: [0.04, 0.03]}}
  p: {{type: revolute, bodies: [rod, ram], at: [0.3, 0]}}
  g: {{type: {guide}}}
  j0: {{type: revolute, bodies: [ram, e0], at: [0.5, 0.25]}}
  j1: {{type: revolute, bodies: [ram, e1], at: [0.6, 0.25]}}
drives:
  m: {{joint: b, position: 10*t}}
  d0: {{joint: j0, position: 0}}
  d1: {{joint: j1, position: 0}}
solver: {{method: {method}, end: 0.7, tolerance: 1e-9}}
output: {{every: 0.02}}
"""
GUIDES = {
    "ram": "prismatic, bodies: [ground, ram], axis: [1, 0], at: [0.4, 0]",
    "rocker": "revolute, bodies: [ground, ram], at: [0.3, -0.2]",
}
CRANK, ROD, START = 0.05, hypot(0.26, 0.03), asin(0.6)


def told(r):
    return [text for text in doubts(r.scenario, r.mechanism, r.outcome) if "are chance" in text]


@pytest.mark.parametrize("guide", GUIDES)
@pytest.mark.parametrize("method", ["kinematic", "auto"])
def test_a_driven_crank_passes(method, guide):
    r = run(DRIVEN.format(guide=GUIDES[guide], method=method))
    assert np.any(r.mechanism.model.hub >= 0)
    assert r.outcome.status == "done"
    assert not r.outcome.record.n_meetings
    assert not told(r)


def test_the_ram_goes_as_by_hand():
    """And work is what bodies get of energy: by a rule of order 6 on steps of 0.2 rad."""
    r = run(DRIVEN.format(guide=GUIDES["ram"], method="kinematic"))
    angle = START + 10.0 * r.t
    x = CRANK * np.cos(angle) + np.sqrt(ROD**2 - (CRANK * np.sin(angle)) ** 2)
    assert r["ram.position"][:, 0] - 0.35 == pytest.approx(x - x[0], abs=1e-12)
    assert np.abs(r["energy.residual"]).max() < 0.2**6 * r["energy.kinetic"].max()


def at_crank(mechanism, y0, off):
    """The state with the crank `off` rad past the place where it is in line with the rod."""
    y, angle = y0.copy(), pi + off
    elbow = np.array([CRANK * cos(angle), CRANK * sin(angle)])
    x = elbow[0] + sqrt(ROD**2 - elbow[1] ** 2)
    lean = asin(-elbow[1] / ROD)
    put = {"crank": (0.0, 0.0, angle - START, (0.02, 0.0)),
           "rod": (*elbow, lean - asin(-0.03 / ROD), (0.15 - 0.04, 0.02 - 0.03))}  # fmt: skip
    for name, (px, py, turned, arm) in put.items():
        f = mechanism.frames[name]
        c, s = cos(turned), sin(turned)
        y[3 * f - 3 : 3 * f] = px + c * arm[0] - s * arm[1], py + s * arm[0] + c * arm[1], turned
    for name in ("ram", "e0", "e1"):
        y[3 * mechanism.frames[name] - 3] += x - 0.3
    return y


@pytest.mark.parametrize("off", [0.0, 1e-6, 1e-3, 0.05])
def test_pivots_next_to_it_are_those_of_all_rows(off):
    """The least pivot is none of the rows with the hub held, and no more than what S tells."""
    r = run(DRIVEN.format(guide=GUIDES["ram"], method="kinematic").replace("end: 0.7", "end: 0.02"))
    work = scene(r.mechanism.model)
    y = at_crank(r.mechanism, r.outcome.start.y, off)
    t = (pi + off - START) / 10.0
    assert project_positions(work, t, y) < 1e-12
    assert work.status[0] == SOUND
    S = dense(work, y)
    least = np.min(1.0 / (np.diag(np.linalg.inv(S)) * np.diag(S)))
    assert work.delayed[0] == 1
    assert smallest_pivot.python(work) > 0.999 * least
    (k,) = work.row[work.column_start[work.delayed[1:2]]]
    assert work.delayed_pivot[0] == pytest.approx(1.0 / (np.linalg.inv(S)[k, k] * S[k, k]))
