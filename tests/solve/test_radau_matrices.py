"""What Radau carries over a corner or to a shorter step: columns of its matrix, its first guess."""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

from trsim.assemble.equations import derivative
from trsim.elements.contract import BRANCH, CONTACT, PHASE, SCENE, WHOLE, compiled
from trsim.elements.scene import scene
from trsim.kernels.signatures import void
from trsim.scenario.load import load
from trsim.solve.march import record as rec
from trsim.solve.march.norm import weights
from trsim.solve.march.record import SETTINGS
from trsim.solve.methods import radau
from trsim.solve.outcome import settings

from ..linkages import REVERSER
from ..runs import run

SETS = ["solver.method=radau", "solver.tolerance=1e-3", "output.every=1", "output.channels=[]"]
LATER = 650  # steps: pins are loaded and slip
AT = 1e-6  # m/s: so near to a corner, whose speeds are 1e-4 and 1e-3
SHORT = 1e-9  # s: a step that Newton's method cannot fail


@compiled(void(SCENE, rec.RECORD, rec.BUFFERS, SETTINGS))
def weighed(s, r, b, setting):
    """The weights of the error norm at the state of the record."""
    weights(s, r, b, setting, r.h)


class Stopped(NamedTuple):
    """A run stopped between two steps, and what a further step needs."""

    scene: Any
    record: Any
    buffers: Any
    setting: Any

    @property
    def t(self):
        return self.record.t

    def step(self, h):
        """Try a step; returns its error."""
        return radau.step(*self, self.t, h)

    def by_rate(self, state):
        """by_rate as a step makes it that finds the Jacobian in this state."""
        self.record.jacobian = state
        assert self.step(SHORT) < radau.HALVE
        return self.record.by_rate.copy()


def stopped(steps):
    scenario = load(REVERSER / "clearance_abpq_0.1mm.yaml", [*SETS, f"solver.max_steps={steps}"])
    ended = run(scenario, fails=True)
    r, s = ended.outcome.record, scene(ended.mechanism.model)
    s.mem[:], s.branch[:] = r.mem, r.branch
    setting = settings(scenario, ended.mechanism)
    b = rec.fresh_buffers(s, r.y.size, radau.STAGES, radau.DENSE_ROWS)
    weighed(s, r, b, setting)
    derivative(s, r.t, r.y, r.yd)
    return Stopped(s, r, b, setting)


@cache
def to_corner():
    """Steps to a corner of friction, while Radau is at work."""
    for steps in range(LATER, LATER + 100):
        if stopped(steps).record.jacobian == rec.NO_RATES:
            return steps
    raise AssertionError("no corner in a hundred steps of sticking and slipping")


@pytest.fixture
def at_corner():
    """A run that just met a corner of friction."""
    return stopped(to_corner())


def test_a_corner_makes_the_bodies_that_rub_there_stale(at_corner):
    s, r = at_corner.scene, at_corner.record
    met = [s.contact[c] for c in range(s.contact.size) if abs(r.corner[c]) < AT]
    assert met
    stale = {int(f) for f in np.flatnonzero(r.stale)}
    assert stale == {int(f) for e in met for f in s.con[e, :2]}
    assert len(stale) < s.n


def test_columns_of_those_bodies_are_all_that_a_branch_changes(at_corner):
    """Half of the columns are made anew, and the whole is what differences of all give."""
    s, r = at_corner.scene, at_corner.record
    e = next(e for e in s.contact if s.mem[e, PHASE] == CONTACT and s.mem[e, BRANCH] != WHOLE)
    r.stale[:] = 0
    before = at_corner.by_rate(rec.NO_JACOBIAN)
    s.mem[e, BRANCH] = 1.0 if s.mem[e, BRANCH] == 0.0 else 0.0
    derivative(s, at_corner.t, r.y, r.yd)
    r.stale[s.con[e, :2]] = 1
    after = at_corner.by_rate(rec.NO_RATES)
    assert r.jacobian == rec.OLD
    assert not r.stale.any()
    whole = at_corner.by_rate(rec.NO_JACOBIAN)
    assert np.abs(whole - before).max() > 0.01 * np.abs(whole).max()
    assert after == pytest.approx(whole, rel=1e-6, abs=1e-6 * np.abs(whole).max())


def test_a_shorter_step_begins_on_the_longer_one(at_corner):
    """One or two iterations instead of more, to the same end."""
    r, b = at_corner.record, at_corner.buffers
    r.jacobian, r.history = rec.NO_JACOBIAN, rec.NO_HISTORY
    h = 3e-6
    assert at_corner.step(h) <= 1.0
    assert r.history == rec.AHEAD
    assert r.past_h == h
    found = []
    for history in (rec.AHEAD, rec.NO_HISTORY):
        r.history, r.contraction = history, 1.0
        kept, before = r.past.copy(), r.iterations
        at_corner.step(0.6 * h)
        found.append((r.iterations - before, b.y1.copy()))
        r.past[:], r.past_h = kept, h
    (few, end), (many, other) = found
    print(f"{few} iterations, {many} from nothing")
    assert few < many
    apart = (end - other) * b.weight
    assert np.sqrt(np.mean(apart**2)) < 2 * radau.KAPPA
