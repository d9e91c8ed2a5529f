"""Extremes on static paths, which no row shows: those of closed forms, whatever the rows are.

A rod of 2 kg held by a drive at its hinge passes through the level at which its weight has the
longest lever, and a spring from its tip to the ground the place where it is shortest.
"""

import numpy as np
import pytest

from ..runs import run

M, G, R, BEGIN, RATE, ANCHOR, K = 2.0, 9.81, 0.2, -0.7, 3.0, 0.5, 400.0
ENOUGH = 1e-6  # of the range: the tolerance, of which 0.3 may be missed

ROD = """
{plane}
bodies: {{rod: {{mass: 2 kg, inertia: [0.01, 0.02, 0.05], at: {at}}}}}
joints: {{hinge: {{type: revolute, bodies: [{bodies}], at: [0, 0], axis: [0, 0, 1]}}}}
drives: {{motor: {{joint: hinge, {motion}}}}}
sensors: {{turn: {{joint: hinge}}}}
gravity: [0, -9.81, 0]
solver: {{method: static_path, end: {end}}}
output: {{every: {every}}}
forces: {{{forces}}}
"""
SPRING = (
    "spring: {{type: spring_damper, bodies: [ground, rod], points: [[0.5, 0], {at}],"
    " stiffness: 400, free_length: 0.1}}"
)
RUBS = (
    "rub: {type: joint_friction, joint: hinge, radius: 10 mm,"
    " friction: {law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1 mm/s}}"
)


def path(forces="", every=0.1, bodies="ground, rod", motion='velocity: "{}"', plane="", end=0.5):
    at = [float(R * np.cos(BEGIN)), float(R * np.sin(BEGIN))]
    side = 1 if bodies.startswith("ground") else -1
    text = ROD.format(
        at=at, every=every, bodies=bodies, motion=motion.format(side * RATE), plane=plane, end=end,
        forces=forces.format(at=at) if forces.startswith("spring") else forces,
    )  # fmt: skip
    return run(text)


def peaks(r, name, k=0):
    """Largest, when, least, when."""
    return r.outcome.peaks[r.place[name][0] + k]


@pytest.mark.parametrize("every", [0.02, 0.1, 0.5])
@pytest.mark.parametrize("motion", ['velocity: "{}"', 'position: "{}*t"'])
@pytest.mark.parametrize("bodies", ["ground, rod", "rod, ground"])
@pytest.mark.parametrize("plane", ["", "planar: false"])
def test_the_longest_lever(every, motion, bodies, plane):
    r = path(every=every, motion=motion, bodies=bodies, plane=plane)
    high, when, low, last = peaks(r, "motor.force")
    sign, force = (1, high) if bodies.startswith("ground") else (-1, -low)
    assert force == pytest.approx(M * G * R, rel=ENOUGH)
    assert (when if sign > 0 else last) == pytest.approx(-BEGIN / RATE, abs=1e-3)


@pytest.mark.parametrize("every", [0.02, 0.1, 0.5])
def test_the_shortest_spring(every):
    r = path(SPRING, every=every)
    span = K * (np.sqrt(R**2 + ANCHOR**2 - 2 * R * ANCHOR * np.cos(0.8)) - (ANCHOR - R))
    force = peaks(r, "spring.force")
    least = K * (ANCHOR - R - 0.1)
    values = np.abs([force[0], force[2]])
    assert values.min() == pytest.approx(least, abs=ENOUGH * span)


@pytest.mark.parametrize("every", [0.02, 0.1, 0.5])
def test_with_friction_against_the_way(every):
    """A hinge that carries the weight rubs with 0.2 of it; a reaction that is the same."""
    r = path(RUBS, every=every)
    rub = 0.2 * M * G * 0.01
    assert peaks(r, "motor.force")[0] == pytest.approx(M * G * R + rub, rel=ENOUGH)
    assert peaks(r, "rub.force")[[0, 2]] == pytest.approx(-rub, rel=ENOUGH)


def test_there_and_back():
    """Friction turns round with the drive; the way back has an extreme of its own."""
    r = path(RUBS, every=0.5, motion='position: "1.6*sin(2*pi*t/0.5)*(0*{} + 1)"')
    rub = 0.2 * M * G * 0.01
    assert peaks(r, "motor.force")[0] == pytest.approx(M * G * R + rub, rel=ENOUGH)
    back = M * G * R * np.cos(BEGIN - 1.6)
    assert peaks(r, "motor.force")[2] == pytest.approx(back - rub, rel=1e-5)


@pytest.mark.parametrize("rows", [(0.02, 0.5), (0.03, 0.1)])
def test_the_same_whatever_the_rows(rows):
    first, second = (path(SPRING, every=every) for every in rows)
    for name in ("spring.force", "motor.force", "hinge.reaction"):
        for k in range(first.place[name][1]):
            one, other = peaks(first, name, k)[[0, 2]], peaks(second, name, k)[[0, 2]]
            assert one == pytest.approx(other, abs=2 * ENOUGH * np.ptp(one) + 1e-9)


@pytest.mark.parametrize("word", ["position", "velocity"])
@pytest.mark.parametrize("every", [0.1, 0.2])
def test_a_drive_that_is_back_at_every_row(word, every):
    """It rests at every row, as if it had never moved, and goes 1 rad and back in between."""
    motion = {"position": "{}*(1 - cos(20*pi*t))/6", "velocity": "{}*20*pi*sin(20*pi*t)/6"}[word]
    r = path(every=every, motion=f'{word}: "{motion}"', end=every)
    assert peaks(r, "motor.force")[0] == pytest.approx(M * G * R, rel=ENOUGH)
    assert peaks(r, "motor.force")[2] == pytest.approx(M * G * R * np.cos(BEGIN), rel=ENOUGH)
    assert peaks(r, "turn")[0] == pytest.approx(1.0, rel=ENOUGH)


def test_a_load_that_is_back_at_every_row():
    load = "type: applied_load, body: rod, direction: [0, 0, 1]"
    push = f"push: {{{load}, torque: '3*(1 - cos(20*pi*t))'}}"
    r = path(push, motion='position: "0*{}*t"')
    still = M * G * R * np.cos(BEGIN)
    assert peaks(r, "motor.force")[[0, 2]] == pytest.approx([still, still - 6], rel=ENOUGH)


@pytest.mark.parametrize("word", ["position", "velocity"])
def test_friction_turns_where_a_drive_goes_back_between_rows(word):
    """At every row it goes on at its mean speed; between rows it goes back too."""
    motion = {
        "position": "{}*(t - cos(400*pi*t)/600)",
        "velocity": "{}*(1 + 2*pi/3*sin(400*pi*t))",
    }
    r = path(RUBS, every=0.01, motion=f'{word}: "{motion[word]}"', end=0.01)
    rub = 0.2 * M * G * 0.01
    assert peaks(r, "rub.force")[[0, 2]] == pytest.approx([rub, -rub], rel=ENOUGH)


@pytest.mark.parametrize("every", [0.01, 0.1])
def test_extremes_between_the_looks_at_a_polynomial(every):
    """A force that rises and falls again and again, 20 sin(60 x) exp(-x), at places of 10 mm."""
    from scipy.optimize import minimize_scalar

    r = run(f"""
bodies: {{box: {{mass: 2, inertia: 1}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, box], axis: [1, 0, 0]}}}}
drives: {{jack: {{joint: slide, velocity: 0.1}}}}
forces: {{wave: {{type: joint_spring, joint: slide, elastic: "20*sin(60*stretch)*exp(-stretch)"}}}}
solver: {{method: static_path, end: 1.1}}
output: {{every: {every}}}
""")
    force = lambda x: 20 * np.sin(60 * x) * np.exp(-x)  # noqa: E731
    top, bottom = (
        side * minimize_scalar(lambda x, side=side: side * force(x), bounds=within,
                               method="bounded", options={"xatol": 1e-10}).fun
        for side, within in ((-1.0, (0.01, 0.04)), (1.0, (0.06, 0.1)))
    )  # fmt: skip
    high, _, low, _ = peaks(r, "jack.force")
    assert high == pytest.approx(top, abs=ENOUGH * (top - bottom))
    assert low == pytest.approx(bottom, abs=ENOUGH * (top - bottom))


def test_what_inertia_would_add_between_rows():
    """Both rows have one speed; between them the rod is faster and slower."""
    motion = 'position: "3*t + 0.05*sin(4*pi*t)"'
    few, many = (path(every=every, motion=motion).outcome.statistics for every in (0.5, 0.01))
    add = (0.05 + M * R**2) * 0.05 * (4 * np.pi) ** 2
    assert many["inertia_ratio"] == pytest.approx(add / (M * G * R), rel=0.01)
    assert few["inertia_ratio"] == pytest.approx(many["inertia_ratio"], rel=0.3)
