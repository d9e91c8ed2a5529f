"""Inplane joint: a point on a plane that stands or turns, in the plane and in space."""

import numpy as np
import pytest

from trsim.assemble.release import release
from trsim.errors import TrsimError
from trsim.scenario.load import loads

from ..runs import built, energy_error, run

SPACES = ["true", "false"]
SLOPE = """
planar: {planar}
bodies:
  disc: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [{x}, 0], angle: 2, angular_velocity: [0, 0, 3]}}
joints:
  slope: {{type: inplane, bodies: [ground, disc], at: [{x}, 0], axis: [3, 4]}}
gravity: [0, -9.81, 0]
solver: {{end: 1, tolerance: 1e-10{solver}}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", SPACES)
@pytest.mark.parametrize("x", [0.0, 1e4])
@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_down_a_slope(planar, x, method):
    """g sin(slope) along the plane, m g cos(slope) across it, and the disc turns on."""
    r = run(SLOPE.format(planar=planar, x=x, solver=f", method: {method}"))
    assert r.mechanism.planar == (planar == "true")
    away = r["disc.position"] - [x, 0.0, 0.0]
    down = np.array([0.8, -0.6, 0.0])
    assert away == pytest.approx(9.81 * 0.6 * r.t[:, None] ** 2 / 2 * down, abs=1e-7)
    normal = 2 * 9.81 * 0.8 * np.array([0.6, 0.8, 0.0])
    assert r["slope.reaction"] == pytest.approx(normal + 0 * r.t[:, None], abs=1e-5)
    assert r["disc.angular_velocity"][:, 2] == pytest.approx(3.0, abs=1e-9)
    assert energy_error(r) < 1e-9


TURNTABLE = """
planar: {planar}
bodies:
  table: {{mass: 1, inertia: [1, 1, 1], angle: 0.4}}
  bead: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [0.1, 0], angle: -1}}
joints:
  hinge: {{type: revolute, bodies: [ground, table], at: [0, 0]}}
  rail: {{type: inplane, bodies: [table, bead], at: [0.1, 0], axis: [1, 0, 0]}}
drives: {{turn: {{joint: hinge, velocity: 3}}}}
solver: {{end: 1, tolerance: 1e-10}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", SPACES)
def test_a_plane_that_turns(planar):
    """A bead at rest as the plane comes: y'' = omega^2 y along it and y' = -omega r at the start,
    so y = -r sinh(omega t), and m (2 omega^2 r cosh(omega t) - omega^2 r) across it."""
    r = run(TURNTABLE.format(planar=planar))
    assert r.mechanism.planar == (planar == "true")
    turn, radius = 3 * r.t, 0.1
    across = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    along = np.stack([-np.sin(turn), np.cos(turn), 0 * turn], axis=1)
    place = radius * across - radius * np.sinh(turn)[:, None] * along
    assert r["bead.position"] == pytest.approx(place, abs=1e-8)
    force = 2 * 9 * radius * (2 * np.cosh(turn) - 1)
    assert r["rail.reaction"] == pytest.approx(force[:, None] * across, abs=1e-6)
    # the plane pushes at the bead: its hinge carries the lever of that
    assert r["turn.force"] == pytest.approx(force * radius * np.sinh(turn), abs=1e-6)
    assert energy_error(r) < 1e-9


def table(legs):
    """A plate on balls under its corners."""
    joints = "\n".join(
        f"  leg_{k}: {{type: inplane, bodies: [ground, plate], at: [{x}, {y}, 0], axis: [0, 0, 1]}}"
        for k, (x, y) in enumerate(legs)
    )
    return f"""
planar: false
bodies: {{plate: {{mass: 12, inertia: [1, 1, 2], at: [0.1, 0.2, 0.5]}}}}
joints:
{joints}
gravity: [0, 0, -9.81]
solver: {{end: 0.1}}
"""


CORNERS = [(-1, -1), (1, -1), (1, 1), (-1, 1)]


def test_three_legs_share_the_weight():
    """By moments about the legs; the plate is a planar joint made of points."""
    r = run(table(CORNERS[:3]))
    assert (r.mechanism.mobility, r.mechanism.redundant) == (3, ())
    x, y = 0.1, 0.2
    share = np.array([(1 - x) / 2, (x - y) / 2, (1 + y) / 2]) * 12 * 9.81
    found = [r[f"leg_{k}.reaction"][0, 2] for k in range(3)]
    assert found == pytest.approx(share, abs=1e-8)


def test_a_fourth_leg_is_one_too_many():
    text = table(CORNERS)
    m = built(text)
    assert (m.mobility, m.mobility_by_count, m.redundant) == (3, 2, ("leg_3.across",))
    assert not set(m.unique) & {f"leg_{k}.across" for k in range(4)}
    assert len(release(loads(text), m).rows) == 1


def test_a_plane_at_an_angle_is_not_planar():
    text = SLOPE.format(planar="true", x=0, solver="").replace("[3, 4]", "[3, 4, 1]")
    with pytest.raises(TrsimError, match="holds bodies at an angle to the plane"):
        built(text)


def test_refused():
    with pytest.raises(TrsimError, match="must not be zero") as caught:
        built(SLOPE.format(planar="true", x=0, solver="").replace("[3, 4]", "[0, 0]"))
    assert caught.value.path == ("joints", "slope", "axis")


@pytest.mark.parametrize("planar", SPACES)
def test_the_end_of_a_flexible_bar_on_a_table(planar):
    """It holds a point of the bar, and no turn about it: so also in space."""
    r = run(f"""
planar: {planar}
bodies:
  bar: {{type: ancf_cable, start: [0, 0], end: [1, 0], elements: 2, section: {{diameter: 20 mm}},
        youngs_modulus: 2 GPa, density: 1000}}
joints:
  root: {{type: fixed, bodies: [ground, bar], at: [0, 0]}}
  table: {{type: inplane, bodies: [ground, bar], at: [1, 0], axis: [0, 1]}}
gravity: [0, -9.81]
solver: {{end: 0.05}}
""")
    assert r["bar.tip"][:, 1] == pytest.approx(0.0, abs=1e-8)
    assert np.abs(r["bar.middle"][:, 1]).max() > 1e-4
