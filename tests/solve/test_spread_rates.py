"""Bounds of how rates of sensors go inside a step, against motions that are followed closely."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp
from scipy.special import comb

from tests.runs import short_run
from trsim.assemble.equations import poses
from trsim.assemble.travel import ANGLE, DISTANCE, RATE_OF, STROKE, SWING
from trsim.elements.scene import scene
from trsim.kernels import plain
from trsim.solve.march.record import fresh_buffers
from trsim.solve.march.spread_rates import spread_of_rate, turned

from ..elements.bench import product

TEXT = """
planar: {planar}
bodies:
  left: {{mass: 2, inertia: [0.02, 0.03, 0.04], at: [0.1, -0.2, 0], angle: 0.7}}
  right: {{mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, 0], angle: -0.4}}
joints: {{free: {{type: revolute, bodies: [left, right], at: [0.3, 0.1, 0]}}}}
sensors:
  turn: {{joint: free}}
  way: {{type: displacement, bodies: [left, right], at: [0.6, 0.4, 0], axis: [1, 2, 0]}}
forces:
  one: {{type: applied_load, body: left, direction: [0, 0, 1], torque: "max(turn.rate, 9e3)"}}
  two: {{type: applied_load, body: left, direction: [0, 0, 1], torque: "max(way.rate, 9e3)"}}
  rope: {{type: spring, bodies: [left, right], points: [[0.2, 0.3, 0], [0.9, 0.1, 0]],
         damper: "max(rate, 0)", elastic: "max(stretch, 0)"}}
solver: {{end: 1 ms}}
output: {{every: 1 ms}}
"""
BALL = """
planar: {planar}
bodies:
  left: {{mass: 2, inertia: [0.02, 0.03, 0.04], at: [0.1, -0.2, 0], angle: 0.7}}
  right: {{mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, 0], angle: -0.4}}
joints: {{free: {{type: spherical, bodies: [left, right], at: [0.3, 0.1, 0]}}}}
forces: {{mount: {{type: ball_spring, joint: free, damper: "max(rate - 9, 0)"}}}}
solver: {{end: 1 ms}}
output: {{every: 1 ms}}
"""
KINDS = {TEXT: {ANGLE, STROKE, DISTANCE}, BALL: {SWING}}
DEGREE = 7
H = 0.3  # s


class Motion:
    """Velocities that are polynomials of time, and the places they lead to."""

    def __init__(self, r, rng):
        self.model, self.record = r.mechanism.model, r.outcome.record
        m = self.model
        self.v = [Polynomial(rng.normal(size=5) * 3) for _ in range(m.n_v)]
        self.y = self.record.y.copy()
        q = solve_ivp(
            self.rates, (0, H), self.y[: m.n_q], rtol=1e-12, atol=1e-12, dense_output=True
        )
        self.q = q.sol

    def rates(self, t, q):
        v, d = np.array([p(t) for p in self.v]), self.model.d
        if d == 3:
            return v
        out = []
        for f in range(self.model.n_r - 1):
            e, w = q[7 * f + 3 : 7 * f + 7], v[6 * f + 3 : 6 * f + 6]
            out += [*v[6 * f : 6 * f + 3], *(0.5 * product(e, np.array([0.0, *w])))]
        return np.array(out)

    def state(self, t):
        y, m = self.y.copy(), self.model
        y[: m.n_q] = self.q(t)
        y[m.n_q : m.n_q + m.n_v] = [p(t) for p in self.v]
        return y

    def control_points(self):
        """Of the velocities over [0, H] in Bernstein's basis, less what they are at first."""
        net = np.zeros((9, self.model.n_q + self.model.n_v))
        for c, p in enumerate(self.v):
            a = p.coef * H ** np.arange(len(p.coef))
            for k in range(DEGREE + 1):
                net[k, self.model.n_q + c] = sum(
                    comb(k, j) / comb(DEGREE, j) * a[j] for j in range(1, min(k, len(a) - 1) + 1)
                )
        return net


@pytest.mark.parametrize("text", KINDS, ids=["hinge", "ball"])
@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("seed", range(6))
def test_nothing_goes_beyond_its_bounds(text, planar, seed):
    r = short_run(text.format(planar=planar), fails=None)
    model, at = r.mechanism.model, Motion(r, np.random.default_rng(seed))
    at.record.y[:] = at.state(0.0)
    at.record.degree = DEGREE
    s = scene(model)
    b = fresh_buffers(model, at.y.size, 13, 8)
    b.h, b.net[...] = H, at.control_points()
    found = set()
    for entry, kind, e in model.sensed:
        if kind <= RATE_OF:
            continue
        found.add(kind - RATE_OF)
        for low, high in ((0.0, 1.0), (0.25, 0.5), (0.5, 0.53)):
            times = np.linspace(low * H, high * H, 201)
            shown = []
            for t in times:
                poses(s, at.state(t))
                shown.append(s.S[entry, 0])
            poses(s, at.state(high * H))
            most, L, M = plain.plain(spread_of_rate.python)(
                s, at.record, b, (int(kind), int(e)), (low, high)
            )
            step = times[1] - times[0]
            once = np.abs(np.diff(shown) / step).max()
            twice = np.abs(np.diff(shown, 2) / step**2).max()
            slack = 1 + 1e-6
            assert np.abs(shown).max() <= most * slack
            assert once <= L * slack
            assert twice <= M * slack + 1e-4 * L / H
            if high - low < 0.1 and kind - RATE_OF != DISTANCE and np.inf > M:
                assert 1e3 * once + 1e3 > L  # a bound that says something
    assert found == KINDS[text]


@pytest.mark.parametrize("length", [0.2, 1.0, 4.0])
def test_a_slope_turns_the_faster_the_shorter_it_may_be(length):
    """A node's slope of length 1 at the end, whose ends move apart at 0.2 1/s: it may have been
    shorter by that times the time, and 0.2 over its length is what it turns by at most."""
    s = SimpleNamespace(
        d=6, n_r=1, n_q=0, v_node=0, d_node=6, G=np.array([[0.0] * 3, [0.6, 0, 0.8]])
    )
    r = SimpleNamespace(degree=3, y=np.array([0, 0, 0, 0.0, 0.2, 0.0]))
    b = SimpleNamespace(curve=np.zeros((9, 14)))
    most, second, third = plain.plain(turned.python)(s, r, b, 1, 0, length)
    w = 0.2 / (1 - 0.2 * length)
    assert most == pytest.approx(w)
    assert second == pytest.approx(5 * w**2) and third == pytest.approx(21 * w**3 + 5 * w**3)
    r.y *= 5 / length  # it may have had no length at all
    assert plain.plain(turned.python)(s, r, b, 1, 0, length) == (np.inf,) * 3
