"""Screw joint: a nut that falls along its thread, a jack, many turns, and what a pitch may be.

A nut of mass m and moment of inertia I about the axis, h = pitch/(2 pi), its weight along the axis:

    stroke'' = g/(1 + I/(m h^2)),   stroke = h (angle - drawn)
    along the axis the thread pushes with F = m (stroke'' - g) and turns with M = -h F
"""

import numpy as np
import pytest

from trsim.assemble.assemble import pack
from trsim.assemble.build import Parts, as_drawn
from trsim.assemble.reduce import jacobian
from trsim.assemble.rows import all_rows
from trsim.elements.screw import Own
from trsim.errors import TrsimError

from ..runs import built, energy_error, run, scenario

A = np.array([2.0, 1.0, 2.0]) / 3.0
M, I, PITCH, DRAWN = 2.0, 0.002, 0.05, 0.9
H = PITCH / (2 * np.pi)
FALL = 9.81 / (1 + I / (M * H**2))


def nut(more="", axis=A, pitch="50 mm", at=(0.0, 0.0, 0.0), solver="tolerance: 1e-10"):
    """A nut on a fixed screw, its weight along the axis."""
    return f"""
planar: false
bodies:
  nut: {{mass: {M}, inertia: [{I}, {I}, {I}], at: {list(at)}, angle: {DRAWN}}}
joints:
  thread: {{type: screw, bodies: [ground, nut], at: {list(at)}, axis: {(3 * axis).tolist()},
           pitch: {pitch}}}
sensors: {{angle: {{joint: thread.angle}}, stroke: {{joint: thread.stroke}}}}
gravity: {(9.81 * axis).tolist()}
solver: {{end: 3, {solver}}}
output: {{every: 0.01, channels: ["*"]}}
{more}
"""


METHODS = {
    "dop853": ("tolerance: 1e-10", 1e-8),
    "radau": ("method: radau, tolerance: 1e-9", 1e-6),
    "ggl": ("method: radau, formulation: ggl, tolerance: 1e-9", 1e-6),
    "rk4": ("method: rk4, step: 5e-4", 1e-7),
    "generalized_alpha": ("method: generalized_alpha, tolerance: 1e-5", 1e-3),
}


@pytest.mark.parametrize("method", METHODS)
def test_a_nut_falls_along_its_thread(method):
    solver, error = METHODS[method]
    r = run(nut(solver=solver))
    stroke = FALL * r.t**2 / 2
    assert stroke[-1] > 50 * PITCH
    assert r["stroke"] == pytest.approx(stroke, abs=error)
    assert r["angle"] == pytest.approx(stroke / H, abs=error / H)
    assert r["angle.rate"] == pytest.approx(FALL * r.t / H, abs=10 * error / H)
    assert r["nut.position"] == pytest.approx(stroke[:, None] * A, abs=error)
    F = M * (FALL - 9.81)
    assert r["thread.reaction"] == pytest.approx(F * A + 0 * r["nut.position"], abs=1e3 * error)
    assert r["thread.reaction_moment"] @ A == pytest.approx(-H * F, abs=10 * error)
    assert energy_error(r) < 1e2 * error


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("axis", [A, np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.0])])
def test_right_and_left_handed(sign, axis):
    """Far from the origin, about any axis; the other body may be the nut."""
    r = run(nut(axis=axis, pitch=f"{50 * sign} mm", at=(4e3, -2e3, 1e3)))
    assert r["stroke"] == pytest.approx(FALL * r.t**2 / 2, abs=1e-7)
    assert r["angle"] - r["angle"][0] == pytest.approx(sign * r["stroke"] / H, abs=1e-5)
    swapped = nut(axis=axis, pitch=f"{50 * sign} mm").replace("[ground, nut]", "[nut, ground]")
    r = run(swapped)
    # the ground goes back along an axis of the nut, and turns back
    assert r["stroke"] == pytest.approx(-FALL * r.t**2 / 2, abs=1e-7)
    assert r["angle"] - r["angle"][0] == pytest.approx(sign * r["stroke"] / H, abs=1e-5)


@pytest.mark.parametrize("text", ["0.05", "50 mm", "5 cm", "50 mm/turn", "p", "q/2", "n", "h", "m",
                                  f"{1e3 * H!r} mm/rad", f"{PITCH / 360!r} m/deg"])  # fmt: skip
def test_a_pitch_is_per_turn(text):
    parameters = f"p: 50 mm, q: 0.1, n: 50 mm/turn, h: {1e3 * H!r} mm/rad, m: h"
    found = built(nut(f"parameters: {{{parameters}}}", pitch=text))
    [thread] = [i for i in found.instances if i.name == "thread"]
    assert Own.of(thread.row).advance == pytest.approx(H, rel=1e-14)


@pytest.mark.parametrize("text", ["2*n", "6.28*h", "twice", "-twice", "n + 0.01"])
def test_a_pitch_computed_of_advances_per_angle_is_refused(text):
    """Whether 2*n is that of a turn or of a radian, its number does not tell."""
    more = "parameters: {n: 50 mm/turn, h: 0.8 mm/rad, twice: 2*n}"
    with pytest.raises(TrsimError, match="does not tell whether it is the advance of a turn") as e:
        built(nut(more, pitch=text))
    assert e.value.problems[0].path == ("joints", "thread", "pitch")
    for more, pitch in (("n: -50 mm/turn", "-n"), ("n: -50 mm/turn, m: -n", "m")):
        found = built(nut(f"parameters: {{{more}}}", pitch=pitch))
        [thread] = [i for i in found.instances if i.name == "thread"]
        assert Own.of(thread.row).advance == pytest.approx(H, rel=1e-14)


JACK = """
planar: false
bodies:
  spindle: {mass: 3, inertia: [0.01, 0.01, 0.004], at: [0, 0, 0.2], angle: 0.4}
  table: {mass: 50, inertia: [1, 1, 1], at: [0, 0, 0.5]}
joints:
  foot: {type: revolute, bodies: [ground, spindle], at: [0, 0, 0], axis: [0, 0, 1]}
  thread: {type: screw, bodies: [spindle, table], at: [0, 0, 0.4], axis: [0, 0, 1], pitch: -6 mm}
  guide: {type: prismatic, bodies: [ground, table], axis: [0, 0, 1]}
drives: {crank: {joint: foot, velocity: "31.4*smoothstep(t/0.5)"}}
sensors: {turn: {joint: foot}, height: {joint: guide}, thread_turn: {joint: thread.angle}}
gravity: [0, 0, -9.81]
solver: {end: 3, tolerance: 1e-10}
output: {every: 0.01, channels: ["*"]}
"""


def test_a_jack():
    """A spindle of the ground lifts a table that cannot turn: force times pitch is the work of a
    turn, and the thread turns back against the table as far as the spindle turns."""
    r = run(JACK)
    assert r.mechanism.mobility == 0 and len(r.mechanism.redundant) == 4
    turns = r["turn"] / (2 * np.pi)
    assert turns[-1] > 12
    assert r["height"] == pytest.approx(6e-3 * turns, abs=1e-9)
    assert r["thread_turn"] == pytest.approx(-r["turn"], abs=1e-7)
    lift = 50 * (9.81 + r["table.acceleration"][:, 2])
    inertia = 0.004 * r["spindle.angular_acceleration"][:, 2]
    torque = r["crank.force"] - inertia
    assert torque * 2 * np.pi == pytest.approx(lift * 6e-3, abs=1e-6)
    assert r["thread.reaction"][:, 2] == pytest.approx(lift, abs=1e-5)
    assert energy_error(r) < 1e-9


@pytest.mark.parametrize("value", ["thread.stroke: 0.6", "thread.angle: 4320 deg + 0.9 rad",
                                   "thread.stroke: -0.6"])  # fmt: skip
def test_initial_values(value):
    """Twelve turns away, by either coordinate."""
    value = value.replace("4320 deg + 0.9 rad", repr(24 * np.pi + 0.9))
    text = nut(f"initial: {{{value}}}", axis=np.array([0.0, 0.0, 1.0]))
    r = run(text.replace("end: 3", "end: 0.1"))
    sign = -1 if "-" in value else 1
    assert r["stroke"][0] == pytest.approx(sign * 0.6, abs=1e-9)
    assert r["angle"][0] == pytest.approx(sign * 24 * np.pi, abs=1e-7)


def test_it_is_closed_on_the_turn_it_is_drawn_on():
    """More than half a turn, and several: nothing is looked at a pitch away."""
    for angle in ("200 deg", "-900 deg"):
        read = scenario(nut(axis=np.array([0.0, 0.0, 1.0])), f"bodies.nut.angle={angle}")
        at, instances = pack(read, frozenset(), None, ())
        full, y = as_drawn(Parts.of(at, instances), all_rows(instances))
        assert np.abs(jacobian(full, 0.0, y)[0]).max() < 1e-12
        r = run(read)
        assert r["stroke"] == pytest.approx(FALL * r.t**2 / 2, abs=1e-8)


def test_a_drive_that_begins_turned():
    """Held at two turns from the start on, the nut has gone up by two pitches."""
    more = f"drives: {{hold: {{joint: thread.angle, position: {4 * np.pi + DRAWN!r}}}}}"
    r = run(nut(more, axis=np.array([0.0, 0.0, 1.0])).replace("end: 3", "end: 0.1"))
    assert r["stroke"] == pytest.approx(2 * PITCH, abs=1e-9)
    assert r["hold.force"] == pytest.approx(-H * M * 9.81, abs=1e-7)


def test_hanging_on_a_spring():
    """A balance several turns away from the drawing: m g = k stroke."""
    more = """
initial: {equilibrium: [thread]}
forces: {hanger: {type: spring_damper, bodies: [ground, nut], points: [[0, 0, 1], [0, 0, 0]],
         stiffness: 100}}
"""
    down = nut(more, axis=np.array([0.0, 0.0, -1.0])).replace("end: 3", "end: 0.1")
    r = run(down)
    assert r["stroke"][0] == pytest.approx(M * 9.81 / 100, abs=1e-6)
    assert r["angle"][0] == pytest.approx(r["stroke"][0] / H, abs=1e-4)
    assert np.abs(r["stroke"] - r["stroke"][0]).max() < 1e-6


def test_a_differential_screw():
    """Threads of 6 and 5 mm on one spindle: the slider goes 1 mm in each turn, and the crank lifts
    the slider with the difference and the spindle with the whole."""
    r = run("""
planar: false
bodies:
  spindle: {mass: 3, inertia: [0.01, 0.01, 0.004], at: [0, 0, 0.2], angle: 350 deg}
  slider: {mass: 5, inertia: [1, 1, 1], at: [0, 0, 0.5]}
joints:
  coarse: {type: screw, bodies: [ground, spindle], at: [0, 0, 0], axis: [0, 0, 1], pitch: 6 mm}
  fine: {type: screw, bodies: [slider, spindle], at: [0, 0, 0.4], axis: [0, 0, 1], pitch: 5 mm}
  guide: {type: prismatic, bodies: [ground, slider], axis: [0, 0, 1]}
drives: {crank: {joint: coarse.angle, velocity: 50}}
sensors: {height: {joint: guide}, turn: {joint: coarse.angle}}
gravity: [0, 0, -9.81]
solver: {end: 2, tolerance: 1e-10}
output: {every: 0.01}
""")
    assert r["turn"] == pytest.approx(50 * r.t, abs=1e-7)
    assert r["height"] == pytest.approx(1e-3 * r["turn"] / (2 * np.pi), abs=1e-10)
    work = 9.81 * (5 * 1e-3 + 3 * 6e-3)  # of one turn
    assert 2 * np.pi * r["crank.force"] == pytest.approx(work, abs=1e-8)


def test_a_lock_of_one_coordinate_holds_both():
    """The nut stops on its thread, and falls on from rest."""
    more = """
events:
  hold: {when: angle, value: 30, do: {lock: [thread.stroke, thread.angle]}}
  free: {when: t, value: 2.5, do: {unlock: [thread.stroke, thread.angle]}}
"""
    r = run(nut(more))
    arrives = np.sqrt(2 * 30 * H / FALL)
    held, free = (r.t > arrives) & (r.t < 2.5), r.t > 2.5
    assert r["angle"][held] == pytest.approx(30, abs=1e-8)
    again = 30 * H + FALL * (r.t[free] - 2.5) ** 2 / 2
    assert r["stroke"][free] == pytest.approx(again, abs=1e-8)


@pytest.mark.parametrize(
    "more, path, words",
    [
        ("drives: {x: {joint: thread.angle, velocity: 1}, y: {joint: thread.stroke, velocity: 1}}",
         ("drives", "y"), "already fix"),
        ("initial: {thread.angle: 1, thread.stroke: 2}", ("initial", "thread.stroke"), "fixes"),
    ],
)  # fmt: skip
def test_its_two_coordinates_are_one_freedom(more, path, words):
    with pytest.raises(TrsimError) as caught:
        run(nut(more))
    assert caught.value.path == path and words in caught.value.what


def test_released_it_falls_and_turns_on():
    r = run(nut("events: {off: {when: t, value: 2, do: {release: [thread]}}}"))
    free = r.t > 2
    assert r["nut.acceleration"][free] == pytest.approx(9.81 * A + 0 * r["nut.position"][free])
    assert r["nut.angular_velocity"][free] @ A == pytest.approx(2 * FALL / H, abs=1e-6)


@pytest.mark.parametrize("axis", [np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])])
def test_is_never_planar(axis):
    text = nut(axis=axis).replace("planar: false", "")
    assert not built(text).planar
    with pytest.raises(TrsimError, match="leave the x-y plane"):
        built("planar: true" + text)


@pytest.mark.parametrize(
    "pitch, words, hint",
    [
        ("0", "must not be zero", "`revolute`"),
        ("5 N", "wrong unit", ""),
        ("5 deg", "wrong unit", ""),
        ("[1, 2]", "number", ""),
        ("speed", "no parameter", ""),
    ],
)
def test_refused(pitch, words, hint):
    with pytest.raises(TrsimError) as caught:
        built(nut(pitch=pitch))
    assert caught.value.path == ("joints", "thread", "pitch")
    assert words in caught.value.what and hint in caught.value.hint


def test_an_axis_is_needed():
    with pytest.raises(TrsimError, match="must not be zero") as caught:
        built(nut(axis=np.zeros(3)))
    assert caught.value.path == ("joints", "thread", "axis")
