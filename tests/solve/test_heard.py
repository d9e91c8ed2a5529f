"""Events that watch forces, reactions, energies and rates: sampled on the dense output."""

import numpy as np
import pytest
from scipy.integrate import quad

from trsim.errors import TrsimError
from trsim.solve.march.record import EVENT_KIND, EVENT_SPEED, EVENT_TIME, USER

from ..runs import built, run

METHODS = ("dop853", "radau", "generalized_alpha, step: 2e-3", "rk4, step: 2e-3", "auto")


def times(r):
    return r.events[r.events[:, EVENT_KIND] == USER][:, EVENT_TIME]


PENDULUM = """
planar: PLANAR
bodies: {bob: {mass: 2, inertia: [0.01, 0.01, 0.01], at: [0.5, 0, 0]}}
joints: {rod: {type: JOINT}}
gravity: [0, -10, 0]
events: {pull: {when: WHEN, value: 30 N, crosses: both, do: {record: true}}}
solver: {end: 0.7, method: METHOD}
output: {every: 0.7}
"""
LINK = "link, bodies: [ground, bob], points: [[0, 0, 0], [0.5, 0, 0]]"


def swing(phi):
    """When a bob that was let go level is phi below the level: phi'^2 = 2 g sin(phi) / l."""
    # by u^2 = sin(phi), which leaves no singularity at the start
    top = np.sqrt(np.sin(phi))
    return quad(lambda u: 2.0 / np.sqrt(2 * 10 / 0.5) / np.sqrt(1 - u**4), 0, top)[0]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("planar", ["true", "false"])
def test_tension_of_a_pendulum(method, planar):
    """3 m g sin(phi) = 30 N at 30 deg, on the way down and on the way up, within long steps."""
    text = PENDULUM.replace("PLANAR", planar).replace("METHOD", method)
    r = run(text.replace("JOINT", LINK).replace("WHEN", "rod.force"))
    down, bottom = swing(np.pi / 6), swing(np.pi / 2)
    found = 2e-6 if "step" in method else 2e-7
    assert times(r) == pytest.approx([down, 2 * bottom - down], abs=20 * found)
    phi_rate = np.sqrt(2 * 10 * 0.5 / 0.5)
    slope = 3 * 2 * 10 * np.cos(np.pi / 6) * phi_rate
    speeds = r.events[r.events[:, EVENT_KIND] == USER][:, EVENT_SPEED]
    assert speeds == pytest.approx([slope, -slope], rel=1e-3)
    assert r.outcome.fired == {"pull": 2}


def test_reaction_of_a_hinge_in_world_axes():
    """The vertical one: 3 m g sin^2(phi) + ... of a bob without inertia of its own."""
    text = PENDULUM.replace("PLANAR", "true").replace("METHOD", "auto")
    text = text.replace("JOINT", "spherical, bodies: [ground, bob], at: [0, 0, 0]")
    text = text.replace("inertia: [0.01, 0.01, 0.01]", "inertia: 1e-9")
    r = run(text.replace("WHEN", "rod.reaction.y"))
    phi = np.arcsin(np.sqrt(0.5))  # 3 m g sin^2 = 30 N
    assert times(r)[0] == pytest.approx(swing(phi), abs=1e-6)


def test_a_pin_that_breaks():
    """A block on a spring is let go when the spring pulls 100 N."""
    text = """
bodies: {block: {mass: 2, inertia: 1}}
joints: {rail: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
drives: {pull: {joint: rail, velocity: 0.5}}
forces: {spring: {type: spring_damper, bodies: [ground, block], points: [[-1, 0], [0, 0]],
         stiffness: 1000}}
sensors: {x: {joint: rail}}
events: {tear: {when: spring.force, value: 100 N, do: {release: [pull]}}}
solver: {end: 1, tolerance: 1e-9}
output: {every: 0.01}
"""
    r = run(text)
    assert times(r)[0] == pytest.approx(0.2, abs=1e-9)
    late = r.t > 0.2
    # from 0.1 m at 0.5 m/s it swings with sqrt(500) rad/s
    w = np.sqrt(500)
    x = 0.1 * np.cos(w * (r.t - 0.2)) + 0.5 / w * np.sin(w * (r.t - 0.2))
    assert r["x"][late] == pytest.approx(x[late], abs=1e-7)


STEPPED = """
bodies: {block: {mass: 2, inertia: 1}}
joints: {weld: {type: fixed, bodies: [ground, block], at: [0, 0]}}
forces: {push: {type: applied_load, body: block, direction: [1, 0], force: FORCE}}
events: {over: {when: weld.reaction.x, value: -40, crosses: down, do: {ACTION}}}
solver: {end: 1}
output: {every: 0.05}
"""


@pytest.mark.parametrize("force, at", [("100*(t > 0.3)", 0.3), ("200*t*t", np.sqrt(0.2))])
def test_what_jumps_over_the_value_crosses_it(force, at):
    r = run(STEPPED.replace("FORCE", force).replace("ACTION", "release: [weld]"))
    assert times(r) == pytest.approx([at], abs=1e-7)
    r = run(STEPPED.replace("FORCE", force).replace("ACTION", "end: true"))
    assert r.outcome.time == pytest.approx(at, abs=1e-7)
    assert "event 'over' ended the run" in r.outcome.reason


@pytest.mark.parametrize("method", METHODS)
def test_every_wave_of_a_load(method):
    """A load that swings 16 times: each time it is above 30 N once."""
    text = STEPPED.replace("FORCE", '"45*sin(100*t)"').replace("ACTION", "record: true")
    r = run(text.replace("end: 1}", f"end: 1, method: {method}}}"))
    want = (np.arcsin(40 / 45) + 2 * np.pi * np.arange(16)) / 100
    assert times(r) == pytest.approx(want[want < 1], abs=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_every_wave_of_a_load_that_is_fast_for_a_while(method):
    """Nothing moves; the phase turns by 500 rad within 1 ms."""
    law = '"45*sin(200*atan2(t - 0.503, 1e-4))"'
    text = STEPPED.replace("FORCE", law).replace("ACTION", "record: true")
    r = run(text.replace("end: 1}", f"end: 1, method: {method}}}"))
    phase = np.arcsin(40 / 45) + 2 * np.pi * np.arange(-50, 50)
    want = 0.503 + 1e-4 * np.tan(phase / 200)
    assert times(r) == pytest.approx(want[(want > 0) & (want < 1)], abs=1e-6)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("pulse, half", [
    ("1/(1 + ((t - 0.503)/1e-5)**2)", 1e-5 * np.sqrt(1 / 0.8 - 1)),
    ("(1 + ((t - 0.503)/1e-5)**2)**-1.5", 1e-5 * np.sqrt(0.8 ** (-2 / 3) - 1)),
    ("(1 - (t - 0.503)**2)**1000000", np.sqrt(1 - 0.8**1e-6)),
    ("exp(-((t - 0.503)/1e-5)**2)", 1e-5 * np.sqrt(-np.log(0.8))),
])  # fmt: skip
def test_a_pulse_within_a_step(pulse, half, method):
    """50 N for some hundred-thousandths of a second, while nothing moves."""
    text = STEPPED.replace("FORCE", f'"50*{pulse}"').replace("crosses: down", "crosses: both")
    text = text.replace("ACTION", "record: true")
    r = run(text.replace("end: 1}", f"end: 1, method: {method}}}"))
    assert times(r) == pytest.approx([0.503 - half, 0.503 + half], abs=1e-9)


def test_a_dip_between_two_places_that_are_looked_at():
    """Within 2 ms about its lowest place the bob pulls more than 59.999 N of its 60 N."""
    text = PENDULUM.replace("PLANAR", "true").replace("METHOD", "auto").replace("JOINT", LINK)
    r = run(text.replace("WHEN", "rod.force").replace("value: 30 N", "value: 59.999 N"))
    aside = swing(np.pi / 2) - swing(np.arcsin(59.999 / 60))
    assert aside < 1e-3
    assert times(r) == pytest.approx(swing(np.pi / 2) + np.array([-aside, aside]), abs=1e-5)


def test_energies_and_rates():
    text = """
bodies: {ball: {mass: 2, inertia: 1, velocity: [0, 3]}}
sensors: {h: {type: point, body: ball, at: [0, 0], axis: [0, 1]}}
gravity: [0, -10]
events:
  calm: {when: energy.kinetic, value: 1 J, crosses: down, do: {record: true}}
  top: {when: h.rate, crosses: down, do: {record: true}}
  turn: {when: ball.velocity.y, value: -1, crosses: down, times: 1, do: {record: true}}
solver: {end: 1}
output: {channels: [h]}
"""
    r = run(text)
    assert times(r) == pytest.approx([0.2, 0.3, 0.4], abs=1e-9)
    assert r.outcome.fired == {"calm": 1, "top": 1, "turn": 1}
    assert not any(c.name == "ball.velocity" and c.wanted for c in r.mechanism.columns)
    told = [note for note in r.mechanism.notes if "sampled, not bounded" in note]
    assert len(told) == 3 and "8 parts" in told[0]


def test_a_channel_that_rests_on_the_value():
    """A reaction that is zero all along, and its rounding: nothing happens."""
    text = STEPPED.replace("FORCE", "10*sin(t)").replace("ACTION", "record: true")
    text = text.replace("weld.reaction.x, value: -40", "weld.reaction.y, value: 0")
    assert run(text.replace("crosses: down", "crosses: both")).outcome.fired == {"over": 0}


@pytest.mark.parametrize(
    "old, new, path, what",
    [
        ("weld.reaction.x", "weld.reaction", ("when",), "has 3 components"),
        ("weld.reaction.x", "weld.raction.x", ("when",), "no sensor named"),
        ("weld.reaction.x", "push.magnitude.x", ("when",), "no sensor named"),
        ("weld.reaction.x", "energy.residual", ("when",), "judged by"),
        ("-40,", "-40 mm,", ("value",), "wrong unit: 'mm'; 'weld.reaction.x' is in N"),
        ("end: 1}", "end: 1, method: scipy:RK45}", None, "knows no events"),
    ],
)
def test_refused(old, new, path, what):
    text = STEPPED.replace("FORCE", "1").replace("ACTION", "end: true")
    assert old in text
    with pytest.raises(TrsimError, match=what) as caught:
        built(text.replace(old, new))
    [error] = caught.value.problems
    assert path is None or error.path == ("events", "over", *path)
