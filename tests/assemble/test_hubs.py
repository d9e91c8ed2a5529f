"""Hubs: which bodies they are, and the same motion with them as without."""

from functools import cache

import numpy as np
import pytest

from benchmarks.problems import VALIDATION, hung_chains
from trsim.assemble import hubs as choosing
from trsim.assemble.coupling import nodes
from trsim.assemble.equations import derivative
from trsim.assemble.linear import POOR, SINGULAR, SOUND
from trsim.assemble.pattern import Hubs, pattern
from trsim.assemble.projection import project_positions, project_velocities
from trsim.elements.scene import scene
from trsim.scenario.load import load, loads
from trsim.solve.methods.ggl_tables import tables

from ..linkages import REVERSER, flat_parallelogram, four_bar
from ..runs import assemble, energy_error, run
from .test_linear import WINDOWS, ready
from .test_linear import put as uprights_put
from .test_schur import dense

GRAVITY = "gravity: [3, -9.81, 1]"


@pytest.fixture
def forced(monkeypatch):
    """Says how many bodies, those with most rows first, are made hubs whether it pays or not."""

    def force(bodies):
        monkeypatch.setattr(choosing, "TRIED", bodies)
        monkeypatch.setattr(choosing, "MANY", 0)
        monkeypatch.setattr(choosing, "WORTH", -np.inf)

    return force


def hubs_of(mechanism):
    """Frames whose motion is an unknown of the solve."""
    return np.flatnonzero(mechanism.model.hub >= 0).tolist()


# --- which bodies ----------------------------------------------------------------------------


@pytest.mark.parametrize("n, hubs", [(1, []), (2, []), (5, [1]), (20, [1])])
def test_a_body_with_many_rows_is_a_hub(n, hubs):
    mechanism = assemble(loads(hung_chains(n)))
    assert hubs_of(mechanism) == hubs
    assert mechanism.model.m == 5 + 17 * n


# carriers of gears: rows of pins and of teeth all name them
CARRIERS = {"planetary_gear": [1], "differential": [1]}


@pytest.mark.parametrize("path", [REVERSER / "ideal.yaml", *sorted(VALIDATION.glob("*.yaml"))],
                         ids=lambda path: path.stem)  # fmt: skip
def test_small_mechanisms_have_none(path):
    """But a carrier of gears may be one."""
    assert hubs_of(assemble(load(path))) == CARRIERS.get(path.stem, [])


def test_rows_of_chains_come_before_the_hub_and_those_of_the_guide_after():
    model = assemble(loads(hung_chains(20))).model
    rank = np.argsort(model.row[model.column_start[:-1]])
    guide = np.flatnonzero(np.all(np.isin(model.line_frame.reshape(-1, 2), [0, 1]), axis=1))
    assert len(guide) == 5
    assert rank[guide].min() > rank[model.m :].max() > rank[: model.m].argmax()
    assert sorted(rank[model.m :]) == list(range(rank[model.m], rank[model.m] + 6))


def test_chains_on_a_hub_cost_in_proportion_to_their_number():
    """As many updates and places for each further chain, by count."""

    def counts(n):  # each chain: ground - rod - link - door - hub, as hung_chains
        frames = [(0, 1)] * 5
        for f in range(2, 2 + 3 * n, 3):
            frames += [(0, f)] * 4 + [(f, f + 1)] * 3 + [(f + 1, f + 2)] * 5 + [(1, f + 2)] * 5
        made = pattern(frames, 2 + 3 * n, None, Hubs(6, (1,), frozenset(range(5))))
        return np.array([len(made[name]) for name in ("row", "target", "entry")])

    each = counts(11) - counts(10)
    assert counts(40) - counts(10) == pytest.approx(30 * each)
    assert each[1] < 500


def test_so_do_the_sparse_systems_of_radau():
    """Constraints on the hub that need not wait for it do not meet each other."""
    entries = {}
    for n in (6, 12, 24):
        scenario = loads(hung_chains(n))
        mechanism = assemble(scenario)
        made = tables(nodes(mechanism), mechanism, mechanism.model)
        entries[n] = len(made["lower"])
    print(f"entries below the diagonal: {entries}")
    assert entries[24] - entries[12] == pytest.approx(2 * (entries[12] - entries[6]), rel=0.01)


def test_rows_that_depend_on_others_with_the_hub_held_come_later(forced):
    """A crank between the ground and a hub has four rows on three directions."""
    forced(1)
    mechanism = assemble(loads(tangle(0, True, False)))
    model = mechanism.model
    rank = np.argsort(model.row[model.column_start[:-1]])
    after = {name for name, k in zip(mechanism.rows, rank, strict=False) if k > rank[model.m]}
    assert len(after & {"j0_0.x", "j0_0.y", "end0.x", "end0.y"}) == 1


# --- the same motion --------------------------------------------------------------------------


def body(rng, planar, at):
    inertia = rng.uniform(0.05, 0.2, 3).round(3).tolist()
    inertia[0] += inertia[1]  # no moment is more than the other two
    inertia[1] += inertia[2]
    inertia = inertia[2] if planar else [*inertia[:2], sum(inertia), 0.01, -0.02, 0.015]
    return (f"mass: {rng.uniform(0.5, 5):.3f}, inertia: {inertia}, at: {at}, "
            f"angle: {rng.uniform(-1, 1):.3f}")  # fmt: skip


def tangle(seed, planar, guided):
    """A body with chains of one to three bodies at random, some of them closed to the ground."""
    rng = np.random.default_rng(seed)

    def place():
        x = rng.uniform(-1, 1, 3).round(3)
        return [*x[:2].tolist(), 0.0 if planar else float(x[2])]

    def axis():
        return [0, 0, 1] if planar else place()

    bodies, joints = [f"  hub: {{{body(rng, planar, place())}}}"], []
    if guided:
        joints.append("  guide: {type: prismatic, bodies: [ground, hub], axis: [1, 0.2, 0]}")
    for k in range(rng.integers(4, 8)):
        crank = k == 0 and not guided  # holds the hub: not all of its rows can come before that
        before, length = "hub", 1 if crank else rng.integers(1, 4)
        for i in range(length):
            name = f"b{k}_{i}"
            bodies.append(f"  {name}: {{{body(rng, planar, place())}}}")
            ball = not planar and rng.random() < 0.5
            kind = "spherical" if ball else f"revolute, axis: {axis()}"
            joints.append(f"  j{k}_{i}: {{type: {kind}, bodies: [{before}, {name}], "
                          f"at: {place()}}}")  # fmt: skip
            before = name
        if length == 3 or crank:
            kind = "revolute" if planar else "spherical"
            joints.append(f"  end{k}: {{type: {kind}, bodies: [{before}, ground], at: {place()}}}")
    drive = "drives: {push: {joint: guide, velocity: 0.3*cos(t)}}" if guided else ""
    return "\n".join([f"planar: {str(planar).lower()}", GRAVITY.replace("1]", "0]" if planar else
                      "1]"), "bodies:", *bodies, "joints:", *joints, drive])  # fmt: skip


def answers(mechanism, seed=0):
    """Accelerations at random velocities, then how positions and velocities are projected."""
    work, y, rng = scene(mechanism.model), mechanism.y0.copy(), np.random.default_rng(seed)
    v = slice(work.n_q, work.n_q + work.n_v)
    y[v] = rng.normal(size=work.n_v)
    yd = np.zeros_like(y)
    derivative(work, 0.1, y, yd)
    accelerations, multipliers, went = yd[v].copy(), work.lam.copy(), int(work.status[0])
    y[: work.n_q] += 1e-3 * rng.normal(size=work.n_q)
    project_positions(work, 0.1, y)
    project_velocities(work, y)
    return went, (accelerations, multipliers, y[: work.n_q], y[v])


def rounding(mechanism):
    """What a solve with S loses to rounding, relative: eps times its condition, equilibrated.

    Never less than a few hundred operations lose.
    """
    work, y = scene(mechanism.model), mechanism.y0.copy()
    S = dense(work, y)
    d = 1.0 / np.sqrt(np.diag(S))
    return 1e-13 + np.finfo(float).eps * float(np.linalg.cond(d[:, None] * S * d))


@cache
def without_hubs(text):
    """Answers, and what rounding takes of them; asked for with no hubs forced."""
    made = assemble(loads(text))
    assert hubs_of(made) == []
    return answers(made)[1], rounding(made)


def compare(text, forced, bodies, bound=None):
    """Answers with hubs against those without, relative to the largest."""
    forced(0)
    expected, lost = without_hubs(text)
    forced(bodies)
    mechanism = assemble(loads(text))
    assert len(hubs_of(mechanism)) == min(bodies, mechanism.model.n - 1)
    went, found = answers(mechanism)
    # the velocities that were projected were of size 1, whatever is left of them
    worst = max(np.max(np.abs(a - b)) / max(np.max(np.abs(b)), 1.0 if b is expected[3] else 0.0)
                for a, b in zip(found, expected, strict=True) if b.size)  # fmt: skip
    bound = bound or lost
    print(f"{mechanism.model.m} rows, {went}: {worst:.1e} of {bound:.1e}")
    assert worst < bound
    return went


@pytest.mark.parametrize("guided", [True, False], ids=["driven", "free"])
@pytest.mark.parametrize("planar", [True, False], ids=["plane", "space"])
@pytest.mark.parametrize("bodies", [1, 2, 99])
@pytest.mark.parametrize("seed", range(5))
def test_the_same_answers_as_without(forced, planar, guided, bodies, seed):
    assert compare(tangle(seed, planar, guided), forced, bodies) != SINGULAR


# --- singular positions -----------------------------------------------------------------------

TOWARDS = (0.3, 2.2, 4.4)  # rad: directions of three chains from the hub


def toggles(bend, more=""):
    """A plate held by three chains of two rods of 0.5 m, whose knees are `bend` m off the line."""
    along, bodies, joints = np.sqrt(0.25 - bend * bend), [], []
    for k, angle in enumerate(TOWARDS):
        d = np.array([np.cos(angle), np.sin(angle)])
        aside = np.array([-d[1], d[0]])
        # on the plate; not on one point, or it could turn
        inner = 0.3 * d + 0.2 * aside
        knee, outer = inner + along * d + bend * aside, inner + 2 * along * d
        for name, a, b in (("in", inner, knee), ("out", knee, outer)):
            turn, middle = np.arctan2(*(b - a)[::-1]), (0.5 * (a + b)).tolist()
            bodies.append(f"  {name}{k}: {{mass: 0.7, inertia: 0.02, at: {middle}, "
                          f"angle: {turn}}}")  # fmt: skip
        for name, pair, at in (("H", f"hub, in{k}", inner), ("K", f"in{k}, out{k}", knee),
                               ("G", f"out{k}, ground", outer)):  # fmt: skip
            joints.append(f"  {name}{k}: {{type: revolute, bodies: [{pair}], at: {at.tolist()}}}")
    hub = "  hub: {mass: 3, inertia: 0.1, at: [0, 0]}"
    return "\n".join(["planar: true", GRAVITY.replace("1]", "0]"), "bodies:", hub, *bodies,
                      "joints:", *joints, more])  # fmt: skip


def put(mechanism, other):
    """Accelerations of a mechanism in the position of another as drawn, at rest."""
    work, y = scene(mechanism.model), other.y0.copy()
    yd = np.zeros_like(y)
    derivative(work, 0.0, y, yd)
    return int(work.status[0]), yd[work.n_q : work.n_q + work.n_v]


@pytest.mark.parametrize("bend", [1e-2, 1e-4, 1e-6, 1e-8, 0.0])
def test_chains_that_are_singular_only_with_the_hub_held(forced, bend):
    """Knees on their lines: rods could move with the plate still, S_0 has no inverse, S has: the
    factors tell nothing of S_0."""
    forced(1)
    made = assemble(loads(toggles(0.2)))
    assert len(hubs_of(made)) == 1
    forced(0)
    there = assemble(loads(toggles(bend)))
    (went, found), (regular, expected) = put(made, there), put(there, there)
    error = np.max(np.abs(found - expected)) / np.max(np.abs(expected))
    print(f"{bend:g} m: {went}, error {error:.1e}")
    assert regular == SOUND
    assert went == SOUND
    assert error < 1e-12


@pytest.mark.parametrize("bodies", [1, 99])
def test_rows_that_depend_on_each_other_here(forced, bodies):
    """A parallelogram lying flat: S has no inverse, and multipliers are those of least norm."""
    text = flat_parallelogram(more="gravity: [0, -9.81, 0]")
    forced(bodies)
    made = assemble(loads(text))
    assert hubs_of(made)
    forced(0)
    without = assemble(loads(text))
    (went, found), (singular, expected) = put(made, without), put(without, without)
    assert went == singular == SINGULAR
    assert found == pytest.approx(expected, abs=1e-11)


@pytest.mark.parametrize("bodies", [1, 3, 99])
@pytest.mark.parametrize("away", [1e-3, 1e-4, 2e-5])
def test_near_a_singular_position(forced, bodies, away):
    """As exact as without hubs (test_linear.py): small pivots of rows after the hubs are seen."""
    forced(bodies)
    work, y = ready(load(WINDOWS))
    assert np.sum(work.hub >= 0) == min(bodies, 5)
    exact, yd = uprights_put(work, y, np.pi / 2 + away), np.zeros_like(y)
    derivative(work, 0.0, y, yd)
    error = np.max(np.abs(yd[work.n_q : work.n_q + work.n_v] - exact))
    print(f"{away:g} rad away: {error:.1e}")
    assert error < 5e-15 / away + 1e-12


LIGHT = """
planar: true
bodies:
  plate: {mass: 1e-8, inertia: 1e-8, at: [2, 0]}
  left: {mass: 1, inertia: 0.2, at: [0, 0.3]}
  right: {mass: 2, inertia: 0.3, at: [0.5, -1]}
joints:
  one: {type: revolute, bodies: [plate, left], at: [1, 0]}
  other: {type: revolute, bodies: [plate, right], at: [1, 0]}
"""


def test_a_light_hub_on_heavy_bodies(forced):
    """About their pin it has only its own inertia, 1e-8 of what it carries: a small pivot."""
    assert compare(LIGHT, forced, 1, 1e-7) == POOR


@pytest.mark.parametrize("bodies", [1, 99])
def test_redundant_rows(forced, bodies):
    """Three rows of a planar four-bar in space are dropped, hubs or not."""
    text = four_bar("false", more=GRAVITY.replace("1]", "0]"))
    compare(text, forced, bodies)
    assert len(assemble(loads(text)).redundant) == 3


# --- runs -------------------------------------------------------------------------------------

# with the ramp the stop's force is never cut at 0, a corner that steps pass by chance
STOPPED = """
  buffer: {type: limit_stop, point: {body: fairing, at: [0.5, 0, 0.7]}, stiffness: 1e6,
           wall: {body: ground, at: [0.51, 0, 0.7], normal: [-1, 0, 0]}, damping: 800, ramp: 5 mm}
  air: {type: applied_load, body: door2, frame: door2, direction: [0, 0, 1], force: 300*sin(60*t)}
"""
RUNS = {
    "dop853": (),
    # not meant for touches at tolerances as tight as those of the others
    "ggl": ("solver.method=radau", "solver.formulation=ggl", "solver.tolerance=1e-8"),
    "index 1": ("solver.method=radau", "solver.formulation=index1"),
    "scipy": ("solver.method=scipy:RK45",),
    "baumgarte": ("solver.stabilisation=baumgarte", "solver.baumgarte={alpha: 20, beta: 20}"),
}


def last(r):
    """Where all bodies are at the end, and how they move."""
    model = r.mechanism.model
    return r.outcome.record.y[: model.n_q + model.n_v]


@pytest.mark.parametrize("sets", RUNS.values(), ids=RUNS)
def test_runs_are_the_same_as_without(forced, sets):
    """Three chains on one body with a stop that is touched, by every formulation."""
    text = hung_chains(3).replace("solver:", STOPPED.strip("\n") + "\nsolver:")
    sets = ("solver.end=0.08", "solver.tolerance=1e-10", *sets)
    forced(0)
    without = run(text, *sets)
    forced(1)
    r = run(text, *sets)
    assert len(hubs_of(r.mechanism)) == 1
    assert not hubs_of(without.mechanism)
    assert len(r.events) == len(without.events) == 2
    model = r.mechanism.model
    # velocities are held to the same part of what the stop turns a length into
    stop = np.sqrt(model.contact_par[0, 0] / model.contact_par[0, 2])
    unit = np.repeat([1.0, max(stop, 1.0)], [model.n_q, model.n_v])
    error = np.max(np.abs(last(r) - last(without)) / unit)
    print(f"{len(r.events)} events, {r.outcome.statistics['steps']} steps: {error:.1e}")
    assert error < 10 * r.scenario.solver.tolerance
    assert energy_error(r) < max(1e-6, 2 * energy_error(without))


def test_equal_chains_move_alike():
    """To turn the chains round the axis changes nothing but the fairing, which is guided."""
    r = run(hung_chains(5), "output.every=0.05", 'output.channels=["door*.*", "energy.*"]')
    assert len(hubs_of(r.mechanism)) == 1
    turns = [np.linalg.norm(r[f"door{i}.angular_velocity"], axis=1) for i in range(5)]
    assert turns[0].min() > 0.1
    for other in turns[1:]:
        assert other == pytest.approx(turns[0], rel=1e-12)
    assert energy_error(r) < 1e-12
