"""Rack and pinion: they do not slip where they touch, closed forms, and what is refused."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run
from ..trains import Train

X, Y, Z = np.eye(3)
KINDS = ("revolute", "prismatic")
R = 0.12
BELOW = (0.1 * Z, np.array([0.3, -R, 0.0]))  # the pinion about Z at X = Y = 0
TEETH = f"joints: [first, other], radius: {R}"
CASES = {
    "below": (Train(BELOW, (Z, X), KINDS), TEETH, -R * Y),
    "above": (Train((0 * Z, R * Y), (Z, X), KINDS), TEETH, R * Y),
    "pinion about the other way": (Train(BELOW, (-Z, X), KINDS), TEETH, -R * Y),
    "slide along the other way": (Train(BELOW, (Z, -X), KINDS), TEETH, -R * Y),
    "carrier second in the hinge": (
        Train(BELOW, (Z, X), KINDS, second=(True, False)), TEETH, -R * Y,
    ),
    "carrier second in the slide": (
        Train(BELOW, (Z, X), KINDS, second=(False, True)), TEETH, -R * Y,
    ),
    "carrier second in both": (Train(BELOW, (Z, X), KINDS, second=(True, True)), TEETH, -R * Y),
    "far away": (
        Train(BELOW, (Z, X), KINDS, place=np.array([300.0, -200.0, 80.0])), TEETH, -R * Y,
    ),
    "turned against the drawing": (
        Train(BELOW, (Z, X), KINDS, turned=np.eye(3), spin=Z, angles=(3.5, -2.9, 4.1)),
        TEETH, -R * Y,
    ),
    "by ratio": (
        Train(BELOW, (Z, X), KINDS), f"joints: [first, other], ratio: {R} m/rad", -R * Y,
    ),
    "by ratio, above": (
        Train((0 * Z, R * Y), (Z, X), KINDS), "joints: [first, other], ratio: -0.12", R * Y,
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_they_do_not_slip(case):
    train, mesh, at = CASES[case]
    r = run(train.text(f"type: rack_and_pinion, {mesh}"))
    assert r.mechanism.mobility == 0 and not r.mechanism.planar
    assert np.ptp(r["x"]) > 1.0
    far = np.abs(train.place).max()
    assert np.abs(train.slip(r, at, train.axis[1])).max() < 1e-10 * max(1.0, far)
    assert energy_error(r) < 1e-6


def falling(kind="prismatic", planar="true", more="", solver="tolerance: 1e-9", end=2):
    """A rack that falls along -Y beside its pinion."""
    joint, slide = ("guide.stroke", ", [0, 1, 0]") if kind == "cylindrical" else ("guide", "")
    assert slide == "" or planar == "false"
    return f"""
planar: {planar}
bodies:
  pinion: {{mass: 1, inertia: [0.1, 0.1, 0.002], at: [0, 0], angle: 4}}
  rack: {{mass: 2, inertia: [0.01, 0.01, 0.01], at: [0.1, 0.4]}}
joints:
  bearing: {{type: revolute, bodies: [ground, pinion], at: [0, 0], axis: [0, 0, 1]}}
  guide: {{type: {kind}, bodies: [ground, rack], at: [0.05, 0], axis: [0, 1]}}
  teeth: {{type: rack_and_pinion, joints: [bearing, {joint}], radius: 5 cm}}
sensors: {{a: {{joint: bearing}}, s: {{joint: {joint}}}}}
gravity: [0, -9.81, 0]
solver: {{end: {end}, {solver}}}
{more}
"""


@pytest.mark.parametrize("solver", ["tolerance: 1e-9", "method: radau", "method: rk4, step: 5e-4"])
@pytest.mark.parametrize(
    "kind, planar", [("prismatic", "true"), ("prismatic", "false"), ("cylindrical", "false")]
)
def test_a_rack_that_falls(kind, planar, solver):
    """m s'' = -m g + F,  I phi'' = -r F:  s'' = -g / (1 + I/(m r^2))."""
    error = 1e-7 if "1e-9" in solver else 1e-5
    r = run(falling(kind, planar, solver=solver))
    acceleration = -9.81 / (1 + 0.002 / (2 * 0.05**2))
    assert r["a"][-1] < -40 * np.pi
    assert r["s"] == pytest.approx(acceleration * r.t**2 / 2, rel=error, abs=error)
    assert r["s"] == pytest.approx(0.05 * r["a"], abs=1e-12 if planar == "true" else 1e-10)
    force = 2 * (9.81 + acceleration)
    assert r["teeth.force_2"] == pytest.approx(force, rel=1e-6)
    assert r["teeth.torque_1"] == pytest.approx(-0.05 * force, rel=1e-6)
    units = {c.name: c.unit for c in r.mechanism.columns if c.name.startswith("teeth")}
    assert units == {"teeth.torque_1": "N*m", "teeth.force_2": "N"}
    assert energy_error(r) < error


def test_the_rack_stops_the_pinion():
    """Locked by an event, and free again when the teeth are released."""
    more = """
events:
  stop: {when: t, value: 0.5, do: {lock: [bearing]}}
  off: {when: t, value: 1, do: {release: [teeth]}}
"""
    r = run(falling(more=more))
    before, held, after = r.t < 0.5, (r.t > 0.5) & (r.t < 1.0), r.t > 1.0
    acceleration = -9.81 / (1 + 0.002 / (2 * 0.05**2))
    assert r["s"][before] == pytest.approx(acceleration * r.t[before] ** 2 / 2, abs=1e-9)
    place = acceleration / 8
    assert r["s"][held] == pytest.approx(place, abs=1e-9)
    assert r["teeth.force_2"][held] == pytest.approx(2 * 9.81, rel=1e-9)
    assert r["s"][after] == pytest.approx(place - 9.81 * (r.t[after] - 1) ** 2 / 2, abs=1e-8)
    assert r["a"][after] == pytest.approx(r["a"][after][0], abs=1e-9)
    assert r["teeth.force_2"][after] == pytest.approx(0.0)


def test_a_pinion_that_climbs_a_fixed_rack():
    """The carrier slides on the ground, which is the rack: it is the second body of its slide."""
    r = run("""
bodies:
  cart: {mass: 2, inertia: 0.1, at: [0, 0]}
  pinion: {mass: 1, inertia: 0.004, at: [0, 0.1]}
joints:
  slide: {type: prismatic, bodies: [ground, cart], at: [0, 0], axis: [1, 0]}
  hub: {type: revolute, bodies: [cart, pinion], at: [0, 0.1]}
  teeth: {type: rack_and_pinion, joints: [hub, slide], radius: 0.1}
drives: {motor: {joint: hub, velocity: 2}}
sensors: {s: {joint: slide}}
solver: {end: 1}
""")
    # its lowest point rests on the ground: it rolls against x as it turns about z
    assert r["s"] == pytest.approx(-0.2 * r.t, abs=1e-12)
    low = r["pinion.velocity"] + np.cross(r["pinion.angular_velocity"], [0.0, -0.1, 0.0])
    assert low == pytest.approx(0.0, abs=1e-12)


def test_not_planar_where_it_leaves_the_plane():
    text = falling().replace("axis: [0, 1]", "axis: [0, 0, 1]").replace("radius: 5 cm", "ratio: 1")
    with pytest.raises(TrsimError, match="leave the x-y plane"):
        built(text)
    assert not built(text.replace("planar: true", "")).planar


REFUSED = {
    "another radius": ("radius: 5 cm", "radius: 6 cm", ("radius",), "at 0.05 m beside"),
    "at the centre of mass": ("at: [0.05, 0], ", "", ("radius",), "at 0.1 m beside"),
    "on the axis": ("at: [0.05, 0]", "at: [0, 1]", ("radius",), "at 0 m beside"),
    "not across": ("axis: [0, 1]", "axis: [0, 1, 1]", ("joints",), "is not across"),
    "slide first": ("[bearing, guide]", "[guide, bearing]", ("joints", 0), "has a stroke, not an"),
    "two hinges": ("[bearing, guide]", "[bearing, bearing]", ("joints", 1), "has an angle, not a"),
    "no radius": (", radius: 5 cm", "", (), "got none"),
    "zero": ("radius: 5 cm", "ratio: 0", ("ratio",), "must not be zero"),
    "zero radius": ("radius: 5 cm", "radius: 0", ("radius",), "must be > 0"),
    "a wrong unit": ("radius: 5 cm", "ratio: 5 cm", ("ratio",), "wrong unit"),
    "no carrier": ("[ground, rack]", "[other, rack]", ("joints",), "share no carrier"),
    "pinion is rack": ("[ground, rack]", "[ground, pinion]", ("joints",), "same two bodies"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    old, new, path, words = REFUSED[case]
    text = falling(planar="false").replace("  rack: {", "  other: {mass: 1, inertia: 1}\n  rack: {")
    with pytest.raises(TrsimError) as caught:
        built(text.replace(old, new))
    problem = caught.value.problems[0]
    assert problem.path == ("joints", "teeth", *path)
    assert words in problem.what
