"""Pieces of what finds a start, each by itself."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.errors import ModelError
from trsim.scenario.load import loads
from trsim.solve.start import angles, bars, consistent
from trsim.solve.start.consistent import start

from ..runs import assemble


class Row:
    """A row of a joint, of which the first two columns are frames: walked over by what ends."""

    def __init__(self, pair):
        self.pair, self.con = pair, self

    def __getitem__(self, columns):
        return Walked(self.pair[columns])


class Walked(tuple):
    walks = 0

    def __iter__(self):
        Walked.walks += 1
        assert Walked.walks < 1000, "a search that does not end"
        return super().__iter__()


@pytest.mark.parametrize(
    "pairs, i, j, found, way",
    [
        ([(0, 1), (1, 2), (2, 3), (3, 4)], 1, 2, {2, 3, 4}, 1),
        ([(2, 3), (1, 2), (0, 1)], 2, 1, {2, 3}, -1),
        ([(0, 1), (1, 2), (2, 0)], 1, 2, {2}, 1),
        ([(1, 0), (1, 2), (2, 0)], 1, 0, {1}, -1),
    ],
)
def test_what_turns_behind_a_joint(monkeypatch, pairs, i, j, found, way):
    """A chain beyond it, to its end; of a loop one body only."""
    monkeypatch.setattr(Walked, "walks", 0)
    joints = [SimpleNamespace(section="joints", row=Row(pair)) for pair in pairs]
    assert angles.behind(SimpleNamespace(instances=joints), i, j) == (frozenset(found), way)


def test_a_drive_that_gives_way_is_ahead_of_its_coordinate(monkeypatch):
    """By what its state is more than the coordinate is in the equilibrium."""
    monkeypatch.setattr(angles, "AnyDrive", SimpleNamespace(of=lambda row: row))
    monkeypatch.setattr(angles, "posed", lambda *_: SimpleNamespace(S=np.array([[0.2, 0.0]])))
    driven = SimpleNamespace(is_force=True, state=5, piston=-1, stiffness=2.0)
    resting = SimpleNamespace(state=1, coordinate=0, stiffness=3.0)
    other = SimpleNamespace(section="forces", name="motor", row=None)
    mechanism = SimpleNamespace(
        instances=[SimpleNamespace(section="drives", name="motor", row=driven), other]
    )
    held = SimpleNamespace(
        model=SimpleNamespace(n_q=1, n_v=1),
        instances=[SimpleNamespace(section="drives", name="motor", row=resting), other],
    )
    y = np.array([0.0, 0.0, 9.0, 0.7])
    assert angles.strained(mechanism, held, y) == {5: pytest.approx(0.5)}


def test_a_rigid_bar_turns_as_fast_as_the_chord_of_the_flexible_one(monkeypatch):
    omega, whole, v = 3.0, 0.4, np.array([0.5, -1.0, 0.0])
    along = np.array([0.6, 0.8, 0.0])
    r = np.array([-0.5, 0.0, 0.5])[:, None] * whole * along + [1.0, 2.0, 0.0]
    rates = np.zeros((3, 6))
    rates[:, :3] = v + np.cross([0.0, 0.0, omega], r - r[1])
    beam = SimpleNamespace(first=1, nodes=3, whole=whole, tangent=(1.0, 0.0, 0.0))
    monkeypatch.setattr(bars, "world_rates", lambda *_: rates)
    monkeypatch.setattr(bars, "places", lambda *_: (r, None))
    flexible = SimpleNamespace(model=None, beams={"bar": beam}, frames={"bar": 1})
    stiff = SimpleNamespace(
        y0=np.zeros(7), frames={"ground": 0, "bar": 1}, model=SimpleNamespace(d=3, n_q=3, n_v=3)
    )
    out = bars.as_rigid(flexible, stiff, np.zeros(1))
    assert out[:3] == pytest.approx([1.0, 2.0, np.arctan2(0.8, 0.6)])
    assert out[3:6] == pytest.approx([0.5, -1.0, omega])


def test_what_a_contact_expects_is_of_the_force_it_holds_at_the_start(monkeypatch):
    """Its memory tells whether it is closed: without it there would be none."""
    w = SimpleNamespace(mem=np.zeros((1, 2)), F=np.zeros((2, 6)))

    def derivative(w, t, y, yd):
        w.F[1, 1] = 300.0 * w.mem[0, 0]

    stand_ins = {"workspace": lambda _: w, "derivative": derivative,
                 "largest_reaction": lambda _: 0.0, "fastest_of": lambda *_: 0.0}  # fmt: skip
    for name, stand_in in stand_ins.items():
        monkeypatch.setattr(consistent, name, stand_in)
    K, n = 1e6, 1.5
    model = SimpleNamespace(reach=1.0, contact_par=[(K, n, 1.0, 1.0, 0.0, 1.0)])
    scenario = SimpleNamespace(solver=SimpleNamespace(end=1.0))
    depth = {}
    for closed in (0.0, 1.0):
        mem = np.array([[closed, 0.0]])
        depth[closed] = consistent.units(model, np.zeros(2), mem, scenario)[3][0]
    assert depth[1.0] == pytest.approx((300.0 / K) ** (1.0 / n))
    assert depth[0.0] < 0.1 * depth[1.0]


def test_drives_of_which_either_could_give_way_are_named(monkeypatch):
    """A third one has nothing to do with it."""

    def tried(scenario, initial, ideal, planar, free):
        return "hold elbow" if not free & {"left", "right"} else SimpleNamespace()

    monkeypatch.setattr(consistent, "tried", tried)
    drives = {name: SimpleNamespace(velocity=1.0) for name in ("left", "third", "right")}
    with pytest.raises(ModelError) as caught:
        consistent.held_still(SimpleNamespace(drives=drives), None, frozenset(), True)
    assert caught.value.what.startswith("'left' and 'right' could begin elsewhere")


def test_angles_of_flexible_bars_are_those_of_the_place_found(monkeypatch):
    """Wherever the search for their equilibrium looked last."""
    model = SimpleNamespace(S=np.array([[9.0]]), branch=np.zeros(1), n_q=1)
    coordinate = SimpleNamespace(entry=0)
    held = SimpleNamespace(model=model, coordinates={"hinge": coordinate})

    def poses(model, y):
        model.S[0, 0] = y[0]

    def bent(stiff, held, y, settle):
        poses(held.model, [8.0])
        return np.array([0.3]), 0.0

    stand_ins = {
        "held_still": lambda *_: held, "with_scene": lambda x: x, "bent": bent,
        "carried": lambda *_: None, "follow": lambda held, y: y, "strained": lambda *_: {},
        "equilibrium": lambda *_: (np.array([0.2]), 0.0),
    }  # fmt: skip
    for name, stand_in in stand_ins.items():
        monkeypatch.setattr(consistent, name, stand_in)
    monkeypatch.setattr(angles, "poses", poses)
    mechanism = SimpleNamespace(
        y0=np.zeros(1), planar=True, beams={"bar": None}, model=SimpleNamespace(n_q=1)
    )
    initial = SimpleNamespace(settles=True, values={}, equilibrium=["hinge"])
    found = consistent.positions(SimpleNamespace(joints={}), mechanism, initial)
    assert found[2] == {"hinge": 0.3}


WOUND = """
planar: false
gravity: [0, 0, 0]
bodies: {rod: {mass: 2, inertia: [0.1, 0.1, 0.05], at: [0.4, 0.1, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0, 0]}}
forces: {coil: {type: torsion_spring, joint: hinge, stiffness: 40, preload: 160}}
initial: {equilibrium: [hinge]}
solver: {end: 0.1}
"""


def test_an_angle_is_followed_round_on_the_way_to_an_equilibrium():
    """A spring that is free more than half a turn ahead, in space."""
    scenario = loads(WOUND)
    mechanism = assemble(scenario)
    begun = start(scenario, mechanism, located=True)
    angle = begun.branch[mechanism.coordinates["hinge"].entry]
    assert abs(angle) == pytest.approx(4.0, abs=1e-6)


PUSHED = """
bodies: {b: {mass: 1, inertia: 0.01}}
joints: {g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
sensors: {x: {joint: g}}
forces: {p: {type: applied_load, body: b, direction: [1, 0], force: "log(2 - x.rate)"}}
gravity: [0, 0, 0]
initial: {g.rate: RATE}
solver: {end: 2}
"""


def test_a_load_without_a_value_at_the_rate_of_the_start_is_named():
    """Though it has one at rest, as drawn."""
    scenario = loads(PUSHED.replace("RATE", "1 m/s"))
    assert start(scenario, assemble(scenario), located=True).y[3] == pytest.approx(1.0)
    scenario = loads(PUSHED.replace("RATE", "3 m/s"))
    with pytest.raises(ModelError, match=r"forces\.p: its force is not a finite number at t = 0"):
        start(scenario, assemble(scenario), located=True)
