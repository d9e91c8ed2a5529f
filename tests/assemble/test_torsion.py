"""Flexible bars in space have no torsion: what needs it is refused, and nothing else is."""

import numpy as np
import pytest

from trsim.errors import ModelError

from ..runs import built, run

BAR = "{type: ancf_cable, start: %s, end: %s, section: {diameter: 20 mm}, elements: 2, %s}"
STEEL = "youngs_modulus: 2e11, density: 7800"
ROD = "rod: " + BAR % ("[0, 0, 0]", "[1, 0, 0]", STEEL)
SECOND = "more: " + BAR % ("[1, 0, 0]", "[2, 0, 0]", STEEL)
DISC = "disc: {mass: 1, inertia: [0.02, 0.01, 0.01], at: [%s]%s}"
ARM = "arm: {mass: 1, inertia: [0.01, 0.02, 0.02], at: [1, 0, 0.3]}"
CLAMP = "clamp: {type: fixed, bodies: [ground, rod], at: [0, 0, 0]}"
BALL = "ball: {type: spherical, bodies: [ground, rod], at: [0, 0, 0]}"
WELD = "weld: {type: fixed, bodies: [rod, %s], at: [1, 0, 0]}"
END = "gravity: [0, -9.81, 0]\nsolver: {end: 5 ms, tolerance: 1e-6}\n"


def scene(bodies, joints, more=""):
    return (
        f"planar: false\nbodies:\n  {bodies}\njoints:\n  {joints}\n{more}\n".replace(" | ", "\n  ")
        + END
    )


def disc(at="1, 0, 0", more=""):
    return DISC % (at, more)


REFUSED = {
    "a disc that spins": scene(
        f"{ROD} | {disc(more=', angular_velocity: [3, 0, 0]')}", f"{CLAMP} | {WELD % 'disc'}"
    ),
    "a crossarm": scene(f"{ROD} | {ARM}", f"{CLAMP} | {WELD % 'arm'}"),
    "a crossarm, the weld the other way": scene(
        f"{ROD} | {ARM}", f"{CLAMP} | weld: {{type: fixed, bodies: [arm, rod], at: [1, 0, 0]}}"
    ),
    "a crossarm behind a disc": scene(
        f"{ROD} | {disc()} | {ARM}",
        f"{CLAMP} | {WELD % 'disc'} | hold: {{type: fixed, bodies: [disc, arm], at: [1, 0, 0.1]}}",
    ),
    "a crossarm hinged to a disc": scene(
        f"{ROD} | {disc()} | {ARM}",
        f"{CLAMP} | {WELD % 'disc'} | hold: {{type: revolute, bodies: [disc, arm], "
        "at: [1, 0, 0.1], axis: [0, 1, 0]}",
    ),
    "a crossarm on a universal joint": scene(
        f"{ROD} | {disc()} | {ARM}",
        f"{CLAMP} | {WELD % 'disc'} | cross: {{type: universal, bodies: [disc, arm], "
        "at: [1, 0, 0], axis: [0, 1, 0], second_axis: [0, 0, 1]}",
    ),
    "a crossarm on springs": scene(
        f"{ROD} | {ARM}", f"{CLAMP} | {WELD % 'arm'}",
        "forces: {s: {type: spring_damper, bodies: [ground, arm], points: [[1, 1, 0.3], "
        "[1, 0, 0.3]], stiffness: 1000}}",
    ),
    "a disc in a soft mount": scene(
        f"{ROD} | {disc()}", f"{CLAMP} | {WELD % 'disc'}",
        "forces: {b: {type: bushing, bodies: [ground, disc], at: [1, 0, 0], stiffness: [0, 0, 0], "
        "rotational_stiffness: [10, 0, 0]}}",
    ).replace("-9.81, 0", "-9.81, 1"),
    "a torsion bar": scene(
        f"{ROD} | {disc()}", f"{CLAMP} | {WELD % 'disc'} | bearing: {{type: revolute, "
        "bodies: [ground, disc], at: [1, 0, 0], axis: [1, 0, 0]}",
    ),
    "a torsion bar that is driven": scene(
        f"{ROD} | {disc()}", f"{CLAMP} | {WELD % 'disc'} | bearing: {{type: revolute, "
        "bodies: [ground, disc], at: [1, 0, 0], axis: [1, 0, 0]}",
        "drives: {m: {joint: bearing, position: 0.1*t}}",
    ),
    "an oblique bearing": scene(
        f"{ROD} | {disc()}", f"{CLAMP} | {WELD % 'disc'} | bearing: {{type: revolute, "
        "bodies: [ground, disc], at: [1, 0, 0], axis: [1, 2, 0]}",
    ),
    "a torque on a disc": scene(
        f"{ROD} | {disc()}", f"{CLAMP} | {WELD % 'disc'}",
        "forces: {f: {type: applied_load, body: disc, direction: [1, 1, 0], torque: 1}}",
    ),
    "a load beside the bar": scene(
        f"{ROD} | {disc()}", f"{CLAMP} | {WELD % 'disc'}",
        "forces: {f: {type: applied_load, body: disc, at: [1, 0.1, 0], direction: [0, 0, 1], "
        "force: 1}}",
    ),
    "two bars in a line": scene(
        f"{ROD} | {SECOND} | {ARM.replace('[1, 0', '[2, 0')}",
        f"{CLAMP} | join: {{type: fixed, bodies: [rod, more], at: [1, 0, 0]}} | "
        "weld: {type: fixed, bodies: [more, arm], at: [2, 0, 0]}",
    ),
    "two bars and a body between": scene(
        f"{ROD} | {SECOND} | {disc()} | {ARM.replace('[1, 0', '[2, 0')}",
        f"{BALL} | {WELD % 'disc'} | join: {{type: fixed, bodies: [disc, more], at: [1, 0, 0]}} | "
        "last: {type: fixed, bodies: [more, arm], at: [2, 0, 0]} | "
        "pin: {type: revolute, bodies: [ground, disc], at: [1, 0, 0]}",
    ),
    "a bearing that is let go": scene(
        f"{ROD} | {ARM}", f"{CLAMP} | {WELD % 'arm'} | pin: {{type: revolute, "
        "bodies: [ground, arm], at: [1, 0, 0.3], axis: [0, 0, 1]}",
        "events: {off: {when: t, value: 2 ms, do: {release: [pin]}}}",
    ),
    "a portal pushed sideways": scene(
        f"{ROD} | other: {BAR % ('[0, 1, 0]', '[1, 1, 0]', STEEL)} | "
        "beam: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, 0.5, 0]}",
        f"{CLAMP} | {WELD % 'beam'} | two: {{type: fixed, bodies: [ground, other], at: [0, 1, 0]}}"
        " | four: {type: fixed, bodies: [other, beam], at: [1, 1, 0]}",
        "forces: {f: {type: applied_load, body: beam, at: [1, 1, 0], direction: [0, 0, 1], "
        "force: 10}}",
    ),
}  # fmt: skip
ALLOWED = {
    "a round tip mass": scene(
        f"{ROD} | {disc('1.1, 0, 0')}", f"{CLAMP} | {WELD % 'disc'}",
        "forces: {f: {type: applied_load, body: disc, at: [1.2, 0, 0], direction: [0, 1, 3], "
        "force: 10}}",
    ),
    "an arm on a rod that may spin": scene(f"{ROD} | {ARM}", f"{BALL} | {WELD % 'arm'}"),
    "an arm in a bearing": scene(
        f"{ROD} | {ARM}", f"{CLAMP} | {WELD % 'arm'} | pin: {{type: revolute, "
        "bodies: [ground, arm], at: [1, 0, 0.3], axis: [0, 0, 1]}",
    ),
    "an arm on a slide": scene(
        f"{ROD} | {ARM}", f"{CLAMP} | {WELD % 'arm'} | rail: {{type: prismatic, "
        "bodies: [ground, arm], axis: [1, 0, 0]}",
    ),
    "all in one plane": scene(
        f"{ROD} | {ARM.replace('[1, 0, 0.3]', '[1, 0.3, 0]')}", f"{CLAMP} | {WELD % 'arm'}"
    ),
    "a portal in its plane": REFUSED["a portal pushed sideways"].replace("[0, 0, 1]", "[0, 1, 0]"),
    "an arm on a ball": scene(
        f"{ROD} | {ARM}", f"{CLAMP} | tip: {{type: spherical, bodies: [rod, arm], at: [1, 0, 0]}}"
    ),
    "two bars on a ball": scene(
        f"{ROD} | {SECOND} | {ARM.replace('[1, 0', '[2, 0')}",
        f"{BALL} | join: {{type: fixed, bodies: [rod, more], at: [1, 0, 0]}} | "
        "weld: {type: fixed, bodies: [more, arm], at: [2, 0, 0]}",
    ),
}  # fmt: skip


# of a disc that nobody turns about the bar, what shows that turn and what does not
OBLIQUE = "-9.81, 1]"  # gravity that leaves no plane
SHOWN = {
    "points: {p: {body: disc, at: [PLACE]}}": ("1.1, 0.1, 0", "1.2, 0, 0"),
    "sensors: {s: {type: point, body: disc, at: [PLACE], axis: [0, 0, 1]}}":
        ("1.1, 0.1, 0", "1.2, 0, 0"),
    "sensors: {s: {type: point, body: ground, at: [2, 0, 0], frame: disc, origin: [1.1, 0, 0], "
    "axis: [PLACE]}}": ("0, 1, 0", None),
    "sensors: {s: {type: point_velocity, body: disc, at: [PLACE], axis: [0, 0, 1]}}":
        ("1.1, 0.1, 0", "1.2, 0, 0"),
    "sensors: {s: {type: distance, bodies: [disc, ground], points: [[PLACE], [0, 0, 1]]}}":
        ("1.1, 0.1, 0", "1.2, 0, 0"),
    "sensors: {s: {type: relative_angle, bodies: [ground, disc], axis: [PLACE]}}":
        ("1, 0, 0", None),
    "sensors: {s: {type: reaction, joint: weld, axis: [0, 1, 0]PLACE}}": (", frame: disc", ""),
    "forces: {f: {type: wrench, body: disc, at: [PLACE], force: [0, 0, 1]}}":
        ("1.1, 0.1, 0", "1.2, 0, 0"),
}  # fmt: skip


@pytest.mark.parametrize("text", SHOWN)
def test_what_shows_how_a_disc_turned_is_refused(text):
    beside, along = SHOWN[text]
    base = f"{ROD} | {disc('1.1, 0, 0')}", f"{CLAMP} | {WELD % 'disc'}"
    with pytest.raises(ModelError, match="torsion"):
        built(scene(*base, text.replace("PLACE", beside)).replace("-9.81, 0]", OBLIQUE))
    if along is not None:
        built(scene(*base, text.replace("PLACE", along)).replace("-9.81, 0]", OBLIQUE))


@pytest.mark.parametrize("name", REFUSED)
def test_what_needs_torsion_is_refused(name):
    with pytest.raises(ModelError, match="torsion") as caught:
        built(REFUSED[name])
    assert caught.value.exit_code == 4 and caught.value.path[0] == "joints"
    assert "spherical" in caught.value.hint


@pytest.mark.parametrize("name", ALLOWED)
def test_what_needs_none_runs(name):
    r = run(ALLOWED[name])
    assert r.outcome.status == "done"


def test_a_rod_that_may_spin_is_a_rigid_one():
    """On a ball a stiff bar with an arm is a rigid body: Newton and Euler by hand."""
    text = ALLOWED["an arm on a rod that may spin"].replace("end: 5 ms", "end: 0.5")
    r = run(text.replace("density: 7800", "density: 100"), "solver.method=radau",
            "solver.tolerance=1e-5")  # fmt: skip
    mu = 100 * np.pi / 4 * 0.02**2
    c = np.array([1, 0, 0.3])
    I = np.diag([0.01, 0.02, 0.02]) + c @ c * np.eye(3) - np.outer(c, c)
    I += mu / 3 * np.diag([0, 1, 1])
    weight = np.array([0, -9.81, 0])
    R, w, h = np.eye(3), np.zeros(3), 1e-3
    for _ in range(500):  # midpoint rule, twice

        def rate(R, w):
            down = R.T @ weight
            m = np.cross(c, down) + mu * 0.5 * np.cross([1, 0, 0], down)
            return np.linalg.solve(I, m - np.cross(w, I @ w))

        def by(v):
            K = np.cross(np.eye(3), v)
            return np.linalg.solve(np.eye(3) - K / 2, np.eye(3) + K / 2)

        half = w + h / 2 * rate(R, w)
        middle = R @ by(h / 2 * w)
        w, R = w + h * rate(middle, half), R @ by(h * half)
    sag = 9.81 / (3 * 2e11 * np.pi / 64 * 0.02**4)  # m g L^3 / 3 E I: how far the bar gives way
    assert r["arm.position"][-1] == pytest.approx(R @ c, abs=5 * sag)
    # about the bar it turned as far as by hand, and it did turn
    up = r["arm.position"][-1] - r["rod.tip"][-1]
    assert up == pytest.approx(0.3 * R[:, 2], abs=5 * sag) and abs(R[1, 2]) > 0.2


def test_torsion_is_told_as_left_out():
    from trsim.solve.diagnose.skipped import skipped

    from ..runs import scenario

    for text in (ALLOWED["a round tip mass"], ALLOWED["all in one plane"].replace("false", "true")):
        read = scenario(text)
        assert any(s.startswith("torsion and shear of rod") for s in skipped(read, built(text)))
