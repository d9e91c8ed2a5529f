"""Rows of the solve that come to depend on each other as a mechanism moves, where others do not."""

import numpy as np
import pytest

from trsim.analyse.trajectory import changed, marched
from trsim.assemble.assemble import assemble
from trsim.assemble.better import weakest
from trsim.assemble.rank import of_length_one
from trsim.assemble.reduce import all_rows, weights
from trsim.elements.scene import scene
from trsim.scenario.load import loads
from trsim.solve.simulate import simulate

from ..overconstrained import TILTED, chain, rotation, text
from ..runs import run, scenario
from ..truth.trial import made

DRIVE = "drives: {motor: {joint: J0, velocity: 2}}\nsensors: {out: {joint: J3}}"
METHODS = ("dop853", "radau", "auto", "scipy:RK45")
TURNED = {"tilted": TILTED, "other": rotation((3, -1, 1), 2.0)}


def crank_rocker(more, R, **given):
    """A crank of 1, a coupler and a rocker of 2; the crank goes round."""
    return text(chain([(0, 0), (0, 1), (2, 1), (2, -1)]), more, R, **given)


def rocker(crank):
    """Angle of the rocker against where it is drawn, by that of the crank."""
    A = np.stack([-np.sin(crank), np.cos(crank)], axis=-1)
    D = np.array([2.0, -1.0])
    way = A - D
    d = np.linalg.norm(way, axis=-1)
    return np.unwrap(np.arctan2(way[..., 1], way[..., 0]) - np.arccos(d / 4.0)) - np.pi / 2


def strength(mechanism, r):
    """The least singular value of the rows of the solve at the end of a run."""
    choice = mechanism.stages.choice(r.stage, r.left_out)
    work = scene(choice.model)
    R = of_length_one(all_rows(work, r.y), weights(work))
    return weakest(R[: work.m]), np.linalg.svd(R, compute_uv=False)[work.m - 1]


@pytest.mark.parametrize("R", TURNED.values(), ids=TURNED)
@pytest.mark.parametrize("method", METHODS)
def test_a_crank_goes_round_with_rows_that_hold(R, method):
    tolerance = 1e-9
    read = crank_rocker(DRIVE, R, end=3.5, tolerance=tolerance)
    r = run(read, f"solver.method={method}", "output.every=0.01")
    out = rocker(2 * r.t)
    assert np.abs(r["out"] + out - out[0]).max() < 1e-7  # the ground is its second body
    across = [r[f"bar{k}.angular_acceleration"] @ R[:, :2] for k in (1, 2, 3)]
    turning = np.abs(r["bar2.angular_acceleration"]).max()
    assert np.abs(across).max() < 100 * tolerance * turning
    now, best = strength(r.mechanism, r.outcome.record)
    assert now > 0.05 * best


def test_the_same_free_under_its_weight():
    read = crank_rocker("gravity: [3, -9.81, 1]", TILTED, end=4.0, tolerance=1e-9)
    r = run(read)
    across = [r[f"bar{k}.angular_acceleration"] @ TILTED[:, :2] for k in (1, 2, 3)]
    assert np.abs(across).max() < 1e-7 * np.abs(r["bar1.angular_acceleration"]).max()
    assert r.outcome.statistics["energy_residual_relative"] < 1e-8


def test_a_run_that_was_broken_off_has_the_rows_it_had():
    read = scenario(crank_rocker(DRIVE, TURNED["other"], end=3.5), "solver.max_step=1e-3")
    mechanism = assemble(read)
    states, whole = [], None
    march = simulate(read, mechanism)
    while whole is None:
        try:
            states.append(next(march).state)
        except StopIteration as stop:
            whole = stop.value
    chosen = [s["record.left_out"] for s in states if s is not None]
    assert any(not np.array_equal(x, chosen[0]) for x in chosen)
    middle = next(s for s in states if s is not None and s["record.left_out"].tolist()
                  != mechanism.stages.left_out(whole.record.stage).tolist())  # fmt: skip
    again = simulate(read, assemble(read), {k: np.copy(v) for k, v in middle.items()})
    while True:
        try:
            next(again)
        except StopIteration as stop:
            assert np.array_equal(stop.value.record.y, whole.record.y)
            break


def test_a_scene_without_dependent_rows_has_no_tables_of_choices():
    mechanism = assemble(scenario(crank_rocker(DRIVE, np.eye(3), planar="true")))
    assert len(mechanism.stages.left_out(np.zeros(0, np.int64))) == 0


def test_reactions_inside_a_step_where_rows_of_the_solve_depend_on_each_other():
    """Five bars of a plane drawn in space: no moment turns a hinge out of it, and forces change
    smoothly, also at the instant at which the rows that were kept cannot tell how to share them."""
    at, every = 1.6868642, 1e-5
    drawn = loads(made("loop", 54).scene.text(), [])
    found = []
    for t in (at, at + 0.3 * every, at + every, at + 30 * every):
        one = changed(drawn, "output", every=t, channels=("j*.reaction", "j*.reaction_moment"))
        rows = np.array(marched(one, assemble(one))[0])
        assert rows[1, 0] == t
        found.append(rows[1, 1:])
    assert np.ptp(found[:3], axis=0).max() < 0.1
    mechanism = assemble(one)
    for column in mechanism.columns:
        if column.name.endswith("reaction_moment"):
            moments = np.array(found)[:, column.start : column.start + 3]
            assert abs(moments).max() < 1e-3, column.name
