"""Steps of static paths: what is refused, what is looked for, and where a path is at its end."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.path.begin import begin
from trsim.solve.path.follow import Path
from trsim.solve.path.log import Log
from trsim.solve.path.place import Equations

from ..runs import assemble, run, scenario

G = 9.81
ROD = """
planar: {planar}
bodies: {{rod: {{mass: 2, inertia: [0.01, 0.02, 0.05], at: [0.2, 0, 0]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0, 0]{axis}}}}}
drives: {{motor: {{joint: hinge, {motion}}}}}
sensors: {{turn: {{joint: hinge}}}}
forces: {{{forces}}}
gravity: [0, -9.81, 0]
solver: {{method: static_path, end: 1}}
output: {{every: {every}}}
"""
RUBS = (
    "rub: {type: joint_friction, joint: hinge, radius: 10 mm,"
    " friction: {law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1 mm/s}}"
)
STOP = "stop: {type: limit_stop, joint: hinge, upper: 0.5, stiffness: 1e4}"


def rod(motion='position: "t"', forces="", every=0.1, planar="true", axis=", axis: [0, 0, 1]"):
    return ROD.format(motion=motion, forces=forces, every=every, planar=planar, axis=axis)


def path_of(text):
    read = scenario(text)
    mechanism = assemble(read)
    return Path(read, mechanism, begin(read, mechanism))


def test_a_step_that_is_not_reached_is_made_again_half_as_long():
    path = path_of(rod())
    reach, asked = path.reached, []

    def reached(place, t, within=0.0):
        asked.append((place.t, t))
        assert len(asked) < 500
        return None if len(asked) == 6 else reach(place, t, within)

    path.reached = reached
    list(path.run())
    (begun, to), again = asked[5], asked[6]
    assert begun > 0.0
    assert again == (begun, pytest.approx(0.5 * (begun + to), rel=1e-12))


def test_a_step_is_at_most_twice_as_long_as_the_one_before():
    """Of a drive that would go too far in a step, whatever the rows are: few steps are refused."""
    path = path_of(rod('position: "2*t"', every=1.0))
    reach, asked = path.reached, []

    def reached(place, t, within=0.0):
        asked.append((place.t, t))
        return reach(place, t, within)

    path.reached = reached
    list(path.run())
    kept = {begun: to for begun, to in asked}  # the last one asked from a place was taken
    first = {}
    for begun, to in asked:
        first.setdefault(begun, to)
    steps = [(to - begun, first[to] - to) for begun, to in kept.items() if to in first]
    assert len(steps) > 20
    assert all(ahead <= 2.001 * long for long, ahead in steps)


@pytest.mark.parametrize("off, found", [(1.5, True), (3.0, False)])
def test_a_place_further_off_than_the_step_is_not_inside_it(off, found):
    """What channels do is looked at between two places: not on a branch three steps away."""
    place, trial = (SimpleNamespace(t=t, y=t) for t in (0.0, 1.0))
    path = SimpleNamespace(
        way=lambda y, y1: abs(y1 - y), heard=lambda one: {}, looks=SimpleNamespace(side={}),
        reached=lambda low, t, within: SimpleNamespace(t=t) if off <= within else None,
        changed=lambda one: ["there"],
    )  # fmt: skip
    inside = Path.looked_inside(path, place, trial)
    assert (inside is not None) == found
    if inside:
        assert 0.0 < inside[0].t < 1.0 and inside[1] == ["there"]


def test_the_direction_of_the_start_is_found_in_a_few_balances(monkeypatch):
    """Against which friction is: of a drive that begins slowly it is looked for further ahead."""
    solve, many = Equations.solved, []

    def solved(self, *given):
        many.append(0)
        assert len(many) < 1000
        return solve(self, *given)

    monkeypatch.setattr(Equations, "solved", solved)
    for motion in ('position: "t"', 'position: "1e-9*t"'):
        path_of(rod(motion, RUBS)).first()
    assert many


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("forces", ["", STOP])
def test_a_path_ends_with_a_row_of_its_end(planar, forces):
    """And where a contact closes on the way it goes on without a jump."""
    r = run(rod('position: "t", compliance: {stiffness: 100}', forces, planar=planar))
    assert r.t == pytest.approx(np.arange(11) / 10, abs=1e-12)
    assert not any("jumps" in text for text in r.outcome.said)


def test_angles_go_on_over_half_a_turn():
    r = run(rod('position: "7*t"', planar="false"))
    assert r["turn"] == pytest.approx(7.0 * r.t, abs=1e-9)
    assert r["motor.force"] == pytest.approx(2 * G * 0.2 * np.cos(7.0 * r.t), abs=1e-8)


def test_accelerations_in_space_point_to_the_axis():
    """About a slanted axis, at a constant rate: the square of it times the way to the axis."""
    r = run(rod('position: "2*t"', planar="false", axis=", axis: [1, 2, 2]", every=0.02))
    a = np.array([1.0, 2.0, 2.0]) / 3.0
    p = r["rod.position"]
    out = p - np.outer(p @ a, a)
    assert r["rod.acceleration"][1:-1] == pytest.approx(-4.0 * out[1:-1], abs=1e-3)


@pytest.mark.parametrize("turns, free, word", [
    (True, True, "snaps through"), (True, False, "dead end"),
    (False, True, "no equilibrium next to it"), (False, False, "no equilibrium next to it"),
])  # fmt: skip
def test_how_a_path_ends_in_words(turns, free, word):
    """It turns back where something is free, or where all is held; or nothing is near."""
    log = SimpleNamespace(
        where=lambda place: "", eq=SimpleNamespace(n=3, m=3 - free, rubs=False), mechanism=None
    )
    assert word in Log.told(log, SimpleNamespace(t=0.5), turns, ())
