"""Inline joint: a point on a line that stands, turns or is driven, in the plane and in space."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run

SPACES = ["true", "false"]
SLOPE = """
planar: {planar}
bodies:
  disc: {{mass: 2, inertia: [0.1, 0.1, 0.1], angular_velocity: [0, 0, 3]}}
joints:
  slot: {{type: inline, bodies: [ground, disc], at: [0, 0], axis: [4, -3]}}
sensors: {{stroke: {{joint: slot}}}}
gravity: [0, -9.81, 0]
solver: {{end: 1, tolerance: 1e-10{solver}}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", SPACES)
@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_down_a_slope(planar, method):
    """g sin(slope) along the line, m g cos(slope) across it, and the disc turns on as it likes."""
    r = run(SLOPE.format(planar=planar, solver=f", method: {method}"))
    assert r.mechanism.planar == (planar == "true")
    assert r["stroke"] == pytest.approx(9.81 * 0.6 * r.t**2 / 2, abs=1e-8)
    normal = 2 * 9.81 * 0.8 * np.array([0.6, 0.8, 0.0])
    assert r["slot.reaction"] == pytest.approx(normal + 0 * r.t[:, None], abs=1e-6)
    assert r["disc.angular_velocity"][:, 2] == pytest.approx(3.0, abs=1e-9)
    assert energy_error(r) < 1e-9


TURNTABLE = """
planar: {planar}
bodies:
  table: {{mass: 1, inertia: [1, 1, 1]}}
  bead: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [0.1, 0]}}
joints:
  hinge: {{type: revolute, bodies: [ground, table], at: [0, 0]}}
  wire: {{type: inline, bodies: [table, bead], at: [0.1, 0], axis: [1, 0, 0]}}
drives: {{turn: {{joint: hinge, velocity: 3}}}}
initial: {{wire: {start}}}
sensors: {{stroke: {{joint: wire}}}}
solver: {{end: 1, tolerance: 1e-10}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", SPACES)
def test_a_bead_on_a_turning_wire(planar):
    """r'' = omega^2 r from rest on the wire: r = r_0 cosh(omega t); 2 m omega r' across it."""
    r = run(TURNTABLE.format(planar=planar, start=0.05))
    radius = 0.15 * np.cosh(3 * r.t)
    assert r["stroke"] == pytest.approx(radius - 0.1, abs=1e-8)
    across = np.stack([-np.sin(3 * r.t), np.cos(3 * r.t)], axis=1)
    coriolis = 2 * 2 * 3 * 0.15 * 3 * np.sinh(3 * r.t)
    assert r["wire.reaction"][:, :2] == pytest.approx(coriolis[:, None] * across, abs=1e-6)
    assert r["turn.force"] == pytest.approx(coriolis * radius, abs=1e-6)
    # nothing turns the bead
    assert r["bead.angular_velocity"] == pytest.approx(0.0 * r["bead.velocity"], abs=1e-9)


YOKE = """
planar: {planar}
bodies:
  crank: {{mass: 1, inertia: [0.1, 0.1, 0.1]}}
  yoke: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [0.5, 0]}}
joints:
  bearing: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  pin: {{type: inline, bodies: [yoke, crank], at: [0.2, 0], axis: [0, 1, 0]}}
  guide: {{type: prismatic, bodies: [ground, yoke], axis: [1, 0, 0]}}
drives: {{motor: {{joint: bearing, velocity: 5}}}}
sensors: {{in_the_slot: {{joint: pin}}}}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", SPACES)
def test_a_scotch_yoke(planar):
    """The yoke moves as cos(omega t), its pin as sin(omega t)."""
    r = run(YOKE.format(planar=planar))
    x = 0.2 * np.cos(5 * r.t)
    assert r["yoke.position"][:, 0] == pytest.approx(0.3 + x, abs=1e-8)
    assert r["in_the_slot"] == pytest.approx(0.2 * np.sin(5 * r.t), abs=1e-8)
    assert r["pin.reaction"][:, 0] == pytest.approx(2 * 25 * x, abs=1e-6)
    assert energy_error(r) < 1e-9


def test_a_drive_on_the_stroke():
    r = run(
        TURNTABLE.format(planar="false", start=0.0)
        .replace("initial: {wire: 0.0}\n", "")
        .replace("drives: {turn: ", "drives: {push: {joint: wire, velocity: 0.5}, turn: ")
        + "events: {apart: {when: t, value: 0.8, do: {release: [push, wire]}}}"
    )
    held = r.t < 0.8
    radius = 0.1 + 0.5 * r.t[held]
    assert r["stroke"][held] == pytest.approx(0.5 * r.t[held], abs=1e-9)
    assert r["push.force"][held] == pytest.approx(-2 * 9 * radius, abs=1e-6)
    v = r["bead.velocity"][~held]
    assert v == pytest.approx(v[-1] + 0 * v, abs=1e-9)  # it flies straight on


def test_a_stop_at_the_end_of_the_line():
    stop = "forces: {stop: {type: limit_stop, joint: slot, upper: 1, stiffness: 1e6}}"
    r = run(SLOPE.format(planar="true", solver="") + stop)
    assert r["stroke"].max() == pytest.approx(1.0, abs=0.01)
    assert r["stroke"][-1] < 0.9 and energy_error(r) < 1e-8


def test_a_door_on_a_ball_and_a_line():
    """What a second hinge would hold too often: nothing is redundant."""
    m = built("""
planar: false
bodies: {door: {mass: 20, inertia: [4, 5, 1], at: [0.4, 0, 1]}}
joints:
  bottom: {type: spherical, bodies: [ground, door], at: [0, 0, 0.2]}
  top: {type: inline, bodies: [ground, door], at: [0, 0, 1.8], axis: [0, 0, 1]}
gravity: [0, 0, -9.81]
""")
    assert (m.mobility, m.mobility_by_count, m.redundant) == (1, 1, ())


def test_a_line_out_of_the_plane_is_not_planar():
    text = SLOPE.format(planar="true", solver="").replace("axis: [4, -3]", "axis: [4, -3, 1]")
    with pytest.raises(TrsimError, match="slides out of the x-y plane"):
        built(text)


BAR = """
planar: {planar}
bodies:
  bar: {{type: ancf_cable, start: [0, 0], end: [1, 0], elements: 2, section: {{diameter: 20 mm}},
        youngs_modulus: 2 GPa, density: 1000}}
joints:
  root: {{type: fixed, bodies: [ground, bar], at: [0, 0]}}
  slot: {{type: inline, bodies: [ground, bar], at: [1, 0], axis: [1, 0]}}
gravity: [0, -9.81]
solver: {{end: 0.05}}
"""


@pytest.mark.parametrize("planar", SPACES)
def test_the_end_of_a_flexible_bar_in_a_slot(planar):
    """It holds a point of the bar, and no turn about it: so also in space."""
    r = run(BAR.format(planar=planar))
    assert r["bar.tip"][:, 1] == pytest.approx(0.0, abs=1e-8)
    assert np.abs(r["bar.middle"][:, 1]).max() > 1e-4
