"""Section: what a body carries at a station is what a `fixed` joint there would carry."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim import elements
from trsim.elements.section import Part, said
from trsim.errors import TrsimError

from ..runs import built, run
from .bench import matrix, quaternion

# two parts of one shaft: mass, centre, principal inertia in their own axes, turned by a vector
PARTS = {
    "rest": (3.0, [0.1, 0.2, -0.1], [0.05, 0.04, 0.03], [0.3, -0.2, 0.5]),
    "part": (2.0, [0.7, 0.3, 0.25], [0.02, 0.03, 0.045], [-0.4, 0.1, 0.9]),
}
STATION, NORMAL, ACROSS = [0.4, 0.25, 0.1], [2.0, 1.0, 2.0], [1.0, 0.0, 0.0]
ORIGIN = np.array([0.0, 0.0, 0.0])


def tensor(name):
    """Inertia about the part's own centre of mass, world axes as drawn."""
    _, _, I, turn = PARTS[name]
    R = matrix(quaternion(np.array(turn)))
    return R @ np.diag(I) @ R.T


def six(I):
    return [float(x) for x in (I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2])]


def moved(place, origin):
    return [float(x) for x in np.array(place) + origin]


def whole(origin):
    """Mass, centre and inertia of both parts together."""
    m = sum(part[0] for part in PARTS.values())
    c = sum(part[0] * np.array(part[1]) for part in PARTS.values()) / m
    I = np.zeros((3, 3))
    for name, (mass, centre, *_) in PARTS.items():
        d = np.array(centre) - c
        I += tensor(name) + mass * (d @ d * np.eye(3) - np.outer(d, d))
    return m, moved(c, origin), six(I)


def body(mass, at, inertia):
    return f"{{mass: {mass}, inertia: {inertia}, at: {at}}}"


def scene(split, origin=ORIGIN, more="", cut="", solver="tolerance: 1e-12", end=0.6):
    """A shaft that a motor turns about an inclined axis, with all kinds of loads on both ends."""

    def at(*p):
        return moved(p, origin)

    near, far = ("rest", "part") if split else ("shaft", "shaft")
    if split:
        bodies = "".join(f"\n  {n}: {body(p[0], moved(p[1], origin), six(tensor(n)))}"
                         for n, p in PARTS.items())  # fmt: skip
        cut = f"\n  cut: {{type: fixed, bodies: [rest, part], at: {at(*STATION)}}}"
        sensors = ""
    else:
        bodies = f"\n  shaft: {body(*whole(origin))}"
        m, c = PARTS["part"][0], moved(PARTS["part"][1], origin)
        sensors = (
            f"sensors:\n  cut: {{type: section, body: shaft, at: {at(*STATION)}, axis: {NORMAL}, "
            f"x_axis: {ACROSS}, mass: {m}, centre: {c}, inertia: {six(tensor('part'))}{cut}}}\n"
        )
        cut = ""
    return f"""
planar: false
bodies:{bodies}
  bob: {{mass: 1, inertia: [0.01, 0.02, 0.03], at: {at(1, 0.4, 0.1)}}}
joints:{cut}
  bearing: {{type: revolute, bodies: [ground, {near}], at: {at(0, 0, 0)}, axis: [1, 2, 2]}}
  ball: {{type: spherical, bodies: [{far}, bob], at: {at(0.9, 0.4, 0.35)}}}
drives:
  motor: {{joint: bearing, position: "20*t + 30*t**2"}}
forces:
  spring: {{type: spring_damper, bodies: [ground, {far}], points: [{at(1, 1, 1)},
           {at(0.8, 0.2, 0.3)}], stiffness: 300, damping: 5}}
  push: {{type: applied_load, body: {far}, at: {at(0.8, 0.5, 0.3)}, frame: {far},
         direction: [1, -1, 2], force: "30*sin(40*t)"}}
  twist: {{type: applied_load, body: {far}, at: {at(0.75, 0.5, 0.3)}, direction: [0, 1, 2],
          torque: 7}}
  rub: {{type: bushing, bodies: [ground, {near}], at: {at(0.05, 0, 0)}, stiffness: [90, 80, 70],
        damping: [9, 8, 7]}}
  soft: {{type: bushing, bodies: [{far}, bob], at: {at(0.95, 0.4, 0.3)},
         stiffness: [100, 200, 300], rotational_damping: [0.1, 0.2, 0.3]}}
gravity: [0, -9.81, 0]
{sensors}solver: {{end: {end}, {solver}}}
output: {{every: 0.02, channels: ["*", "*.rotation"]}}
{more}"""


def turned(r, name, v):
    """World components of a channel in the axes of the section, which turn with the body."""
    z = np.array(NORMAL) / np.linalg.norm(NORMAL)
    x = np.array(ACROSS) - (ACROSS @ z) * z
    x /= np.linalg.norm(x)
    axes = np.array([x, np.cross(z, x), z])
    R = r[f"{name}.rotation"].reshape(-1, 3, 3)
    return np.einsum("ab,ncb,nc->na", axes, R, v)


def check_same(whole_run, split_run, within=1e-9):
    for one, other in (("force", "reaction"), ("moment", "reaction_moment")):
        want = turned(split_run, "part", split_run[f"cut.{other}"])
        size = np.abs(want).max()
        assert size > 1.0
        assert whole_run[f"cut.{one}"] == pytest.approx(want, abs=within * size), one
        across = {"force": "shear", "moment": "bending"}[one]
        assert whole_run[f"cut.{across}"] == pytest.approx(
            np.hypot(want[:, 0], want[:, 1]), abs=within * size
        )


@pytest.mark.parametrize("origin", [(0, 0, 0), (20, -30, 10)])
def test_is_the_reaction_of_a_joint_there(origin):
    """Spinning up to nine revolutions a second, with springs, loads, a bob and a motor."""
    origin = np.array(origin, float)
    one, two = run(scene(False, origin)), run(scene(True, origin))
    assert one["motor.position"][-1] > 3 * 2 * np.pi
    check_same(one, two, 1e-9 if not origin.any() else 1e-8)


@pytest.mark.parametrize(
    "solver",
    ["method: radau, tolerance: 1e-11", "method: radau, formulation: ggl, tolerance: 1e-10",
     "tolerance: 1e-11, stabilisation: baumgarte, baumgarte: {alpha: 30, beta: 30}"],
)  # fmt: skip
def test_by_every_method(solver):
    one = run(scene(False, solver=solver, end=0.1))
    two = run(scene(True, solver="tolerance: 1e-12", end=0.1))
    check_same(one, two, 1e-6)


# what may stand at the end of a body, and pushes it: joints, and forces
ENDS = {
    "wrench": ("", "{type: wrench, body: FAR, at: [0.8, 0.1, 0.1], frame: FAR, "
               "force: [3, '4*t', 5], moment: [1, 2, '-t']}"),
    "moment": ("", "{type: wrench, body: FAR, at: [0.8, 0, 0], moment: [1, 2, 3]}"),
    "spring": ("", "{type: spring, bodies: [ground, FAR], points: [[1, 1, 0.2], [0.9, 0, 0]], "
               "free_length: 0.99, elastic: 300*stretch, damper: 3*rate, tension_only: true}"),
    "of an angle": ("{type: revolute, bodies: [bob, FAR], at: [0.9, 0, 0], axis: [1, 0, 0.3]}",
                    "{type: joint_spring, joint: end, elastic: 4*stretch, free: 0.4}"),
    "of a stroke": ("{type: cylindrical, bodies: [FAR, bob], at: [0.9, 0, 0], axis: [1, 2, 0.3]}",
                    "{type: joint_spring, joint: end.stroke, elastic: 400*stretch, free: 10 mm}"),
    "bearing": ("{type: revolute, bodies: [FAR, bob], at: [0.9, 0, 0], axis: [1, 0, 0.3]}",
                "{type: joint_friction, joint: end, radius: 20 mm, friction: RUBS}"),
    "guide": ("{type: prismatic, bodies: [bob, FAR], at: [0.9, 0, 0], axis: [1, 1, 0.3]}",
              "{type: joint_friction, joint: end, length: 80 mm, friction: RUBS}"),
    "sleeve": ("{type: cylindrical, bodies: [bob, FAR], at: [0.9, 0, 0], axis: [1, 2, 0.3]}",
               "{type: joint_friction, joint: end, radius: 20 mm, friction: RUBS}"),
}  # fmt: skip
RUBS = "{law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1 mm/s}"


def with_end(split, joint, force):
    """A bar on a universal joint, whole or of two welded parts, with something at its end."""
    I = [0.005, 0.167, 0.169]
    bodies, weld, sensor = f"far: {{mass: 2, inertia: {I}, at: [0.5, 0, 0]}}", "", ""
    if split:
        bodies = (
            "near: {mass: 0.8, inertia: [0.002, 0.011, 0.012], at: [0.2, 0, 0]}, "
            "far: {mass: 1.2, inertia: [0.003, 0.036, 0.037], at: [0.7, 0, 0]}"
        )
        weld = ", cut: {type: fixed, bodies: [near, far], at: [0.4, 0, 0]}"
    else:
        sensor = (
            "sensors: {cut: {type: section, body: far, at: [0.4, 0, 0], axis: [1, 0, 0], mass: 1.2,"
            " x_axis: [0, 1, 0], centre: [0.7, 0, 0], inertia: [0.003, 0.036, 0.037]}}"
        )
    bob = ", bob: {mass: 0.3, inertia: [0.01, 0.02, 0.015], at: [1, 0.2, 0]}" if joint else ""
    near = "near" if split else "far"
    return f"""
bodies: {{{bodies}{bob}}}
joints: {{root: {{type: universal, bodies: [ground, {near}], at: [0, 0, 0], axis: [0, 1, 0],
          second_axis: [0, 0, 1]}}{weld}{f", end: {joint}" if joint else ""}}}
forces: {{acts: {force}}}
gravity: [0, -9.81, 1]
{sensor}
solver: {{end: 0.2, tolerance: 1e-11}}
output: {{every: 0.02, channels: ["*", "*.rotation"]}}
""".replace("FAR", "far").replace("RUBS", RUBS)


@pytest.mark.parametrize("joint, force", ENDS.values(), ids=ENDS)
def test_all_that_pushes_counts(joint, force):
    one, two = (run(with_end(split, joint, force)) for split in (False, True))
    R = two["far.rotation"].reshape(-1, 3, 3)
    for mine, other in (("force", "reaction"), ("moment", "reaction_moment")):
        want = np.einsum("nba,nb->na", R, two[f"cut.{other}"])[:, [1, 2, 0]]
        assert one[f"cut.{mine}"] == pytest.approx(want, abs=1e-8 * np.abs(want).max())


@pytest.mark.parametrize(
    "force",
    ["{type: applied_load, body: far, direction: [1, 0, 0], torque: 3}",
     "{type: wrench, body: far, moment: [1, 2, 3]}"],
)  # fmt: skip
def test_a_torque_without_a_place_must_be_listed(force):
    text = with_end(False, "", force)
    with pytest.raises(TrsimError, match="which side of the section 'acts' acts cannot be told"):
        built(text)
    bare, full = (
        run(text.replace("at: [0.4, 0, 0],", f"at: [0.4, 0, 0], beyond: {names},"))
        for names in ("[]", "[acts]")
    )
    M = full["acts.load" if "applied" in force else "acts.moment"]
    M = np.einsum("nba,nb->na", full["far.rotation"].reshape(-1, 3, 3), M)[:, [1, 2, 0]]
    assert bare["cut.moment"] - full["cut.moment"] == pytest.approx(M, abs=1e-9)


def test_every_element_that_pushes_says_where():
    """Or it would be missing in sections without a word."""
    every = [elements.load(word) for word in elements.ELEMENTS]
    pushing = [e for e in every if {"force", "rub"} & {*e.kernels} and e.section]
    silent = {e.key for e in pushing if e.acts_at is None}
    # bars are no rigid bodies, and pistons no bodies
    assert silent == {"ancf_cable", "distributed_load", "sync_shaft"}


def test_what_acts_beyond_may_be_listed():
    listed = ", beyond: [ball, spring, push, twist, soft]"
    one, two = run(scene(False, end=0.1)), run(scene(False, end=0.1, cut=listed))
    assert np.array_equal(one["cut.force"], two["cut.force"])
    fewer = run(scene(False, end=0.1, cut=", beyond: [ball, spring, push, soft]"))
    gap = turned(one, "shaft", np.tile([0, 7 / 5**0.5, 14 / 5**0.5], (len(one.t), 1)))
    assert fewer["cut.moment"] - one["cut.moment"] == pytest.approx(gap, abs=1e-10)


def test_changes_no_step():
    text = scene(False)
    bare = "\n".join(
        line for line in text.splitlines() if "cut" not in line and "sensors" not in line
    )
    one, two = run(text), run(bare)
    assert np.array_equal(one["shaft.position"], two["shaft.position"])
    assert np.array_equal(one["energy.residual"], two["energy.residual"])
    assert one.outcome.statistics["steps"] == two.outcome.statistics["steps"]


PLANAR = """
bodies: {bodies}
joints:
  hinge: {{type: revolute, bodies: [ground, {near}], at: [0, 0]}}{joint}
  tip: {{type: revolute, bodies: [{far}, bob], at: [1, 0]}}
drives: {{wag: {{joint: tip, position: "0.5*sin(9*t)"}}}}
forces: {{coil: {{type: torsion_spring, joint: hinge, stiffness: 4}}}}
gravity: [0, -9.81]
{sensors}
solver: {{end: 1, tolerance: 1e-12}}
output: {{channels: ["*", "*.rotation"], every: 0.01}}
{more}
"""
BOB = "bob: {mass: 0.5, inertia: 0.01, at: [1.2, 0.1], "
BOB += "velocity: [-1.35, 11.7], angular_velocity: [0, 0, 13.5]}}"


def rod(name, mass, x, inertia):
    """A part of a rod that turns at 9 rad/s about the origin."""
    return (
        f"{name}: {{mass: {mass}, inertia: {inertia!r}, at: [{x}, 0], velocity: [0, {9 * x}], "
        "angular_velocity: [0, 0, 9]}, "
    )


def planar(split, more=""):
    """A rod of 2 kg/m and 1 m, which turns round, cut at 0.4 m."""
    if split:
        bodies = "{" + rod("rest", 0.8, 0.2, 0.128 / 12) + rod("part", 1.2, 0.7, 0.036) + BOB
        joint = "\n  cut: {type: fixed, bodies: [rest, part], at: [0.4, 0]}"
        return PLANAR.format(bodies=bodies, near="rest", far="part", joint=joint, sensors="",
                             more=more)  # fmt: skip
    bodies = "{" + rod("rod", 2, 0.5, 2 / 12) + BOB
    sensors = "sensors: {cut: {type: section, body: rod, at: [0.4, 0], axis: [1, 0, 0], "
    sensors += "x_axis: [0, 1, 0], mass: 1.2, centre: [0.7, 0], inertia: 0.036}}"
    return PLANAR.format(bodies=bodies, near="rod", far="rod", joint="", sensors=sensors, more=more)


def test_in_the_plane():
    """A drive acts along a joint beyond; hinges tell no moment."""
    one, two = run(planar(False)), run(planar(True))
    assert one.mechanism.planar and two.mechanism.planar
    R = two["part.rotation"].reshape(-1, 3, 3)
    F = np.einsum("nba,nb->na", R, two["cut.reaction"])
    size = np.abs(F).max()
    assert one["cut.force"] == pytest.approx(F[:, [1, 2, 0]], abs=1e-8 * size)
    assert one["cut.moment"][:, 1] == pytest.approx(
        two["cut.reaction_moment"][:, 2], abs=1e-8 * size
    )
    assert not one["cut.moment"][:, [0, 2]].any()


def test_events_lock_and_release():
    """A lock of the joint beyond acts beyond; what was let go acts no longer."""
    more = "events: {%s}"
    lock = "shut: {when: t, value: 0.3, do: {release: [wag], lock: [tip]}}, "
    lock += "off: {when: t, value: 0.6, do: {unlock: [tip], release: [tip]}}"
    one, two = run(planar(False, more % lock)), run(planar(True, more % lock))
    R = two["part.rotation"].reshape(-1, 3, 3)
    F = np.einsum("nba,nb->na", R, two["cut.reaction"])
    M = two["cut.reaction_moment"][:, 2]
    for first, last in ((0, 30), (31, 60), (61, 100)):
        rows = slice(first, last)
        assert one["cut.force"][rows] == pytest.approx(F[rows][:, [1, 2, 0]], abs=1e-6)
        assert one["cut.moment"][rows, 1] == pytest.approx(M[rows], abs=1e-6)
    assert one["tip.lock.force"][35] != 0.0


def test_a_hanging_rod_at_rest():
    """Weight and moment of a cantilever, in closed form."""
    text = """
bodies: {rod: {mass: 3, inertia: [0.1, 1, 1], at: [0.5, 0, 0]}}
joints: {wall: {type: fixed, bodies: [ground, rod], at: [0, 0, 0]}}
sensors: {root: {type: section, body: rod, at: [0.25, 0, 0], axis: [1, 0, 0], x_axis: [0, 1, 0],
         mass: 2, centre: [0.6, 0, 0.1], inertia: [0.01, 0.1, 0.1]}}
planar: false
gravity: [0, -10, 0]
solver: {end: 0.1}
"""
    r = run(text)
    # on the part beyond: 20 N up; about the station (c - p) x (0, 20, 0) = (-2, 0, 7) in x, y, z
    assert r["root.force"][-1] == pytest.approx([20, 0, 0], abs=1e-12)
    assert r["root.moment"][-1] == pytest.approx([0, 7, -2], abs=1e-12)
    assert r["root.shear"][-1] == pytest.approx(20) and r["root.bending"][-1] == pytest.approx(7)


ROD = """
bodies:
  rod: {mass: 2, inertia: [0.1, 0.2, 0.2], at: [0.5, 0, 0]}
  bar: {type: ancf_cable, start: [0, 1, 0], end: [1, 1, 0], section: {diameter: 20 mm}, elements: 2,
        youngs_modulus: 207 GPa, density: 7850}
joints:
  pin: {type: spherical, bodies: [ground, rod], at: [0.4, 0.1, 0]}
  other: {type: spherical, bodies: [ground, bar], at: [0, 1, 0]}
forces: {turn: {type: applied_load, body: rod, direction: [1, 0, 0], torque: 3}}
sensors: {s: {type: section, body: rod, at: [0.4, 0, 0], axis: [1, 0, 0], mass: 1,
              centre: [0.7, 0, 0], inertia: [0.01, 0.01, 0.01], beyond: []}}
planar: false
"""


@pytest.mark.parametrize(
    "old, new, path, what",
    [
        ("body: rod, at: [0.4", "body: ground, at: [0.4", ("body",), "the ground"),
        ("body: rod, at: [0.4", "body: bar, at: [0.4", ("body",), "is flexible"),
        ("body: rod, at: [0.4", "body: rud, at: [0.4", ("body",), "no body"),
        ("mass: 1,", "mass: 3,", ("mass",), "has 3 kg"),
        ("[0.01, 0.01, 0.01]", "[0.01, 0.5, 0.01]", ("inertia",), "negative|moment of inertia of"),
        ("[0.01, 0.01, 0.01]", "0.01", ("inertia",), "in the plane only"),
        (", inertia: [0.01, 0.01, 0.01]", "", (), "needs its"),
        (", beyond: []", "", (), "'pin' acts cannot be told"),
        ("beyond: []", "beyond: [pin, bend]", ("beyond", 1), "named 'bend'"),
        ("beyond: []", "beyond: [other]", ("beyond", 0), "named 'other'"),
        ("axis: [1, 0, 0], mass", "axis: [0, 0, 0], mass", ("axis",), "must not be zero"),
        ("torque: 3", "torque: 3*s", None, "known only once"),
        (
            "planar: false",
            "events: {e: {when: s, do: {end: true}}}",
            None,
            "no sensor named",
        ),
    ],
)
def test_refused(old, new, path, what):
    built(ROD)
    assert old in ROD
    with pytest.raises(TrsimError, match=what) as caught:
        built(ROD.replace(old, new))
    [error] = caught.value.problems
    assert path is None or error.path == ("sensors", "s", *path)


def test_in_a_template():
    """An instance whose frame is turned: its names, its places and its axes are its own."""
    text = """
planar: false
templates:
  arm:
    frame: {at: [1, 2, 3], x_axis: [0, 1, 0], y_axis: [0, 0, 1]}
    bodies: {rod: {mass: 3, inertia: [0.1, 1, 1.2, 0.01, 0, 0], at: [0.5, 0, 0]}}
    joints: {wall: {type: fixed, bodies: [ground, rod], at: [0, 0, 0]}}
    forces: {push: {type: applied_load, body: rod, at: [0.1, 0], frame: rod, direction: [0, 1],
             force: 9}}
    sensors: {root: {type: section, body: rod, at: [0.25, 0, 0], axis: [1, 0, 0], mass: 2,
              x_axis: [0, 1, 0], centre: [0.6, 0, 0.1], inertia: [0.01, 0.1, 0.1], beyond: [push]}}
instances: {one: {template: arm}}
gravity: [0, 0, -10]
solver: {end: 0.1}
"""
    r = run(text)  # world z is y of the instance: the closed form above, less the push of 9 N
    assert r["one_root.force"][-1] == pytest.approx([20 - 9, 0, 0], abs=1e-12)
    assert r["one_root.moment"][-1] == pytest.approx([0, 7 + 9 * 0.15, -2], abs=1e-12)


def test_the_centre_of_what_is_cut_is_told_with_its_signs():
    """What is next to nothing beside the others is rounding, on whichever side it lies."""
    part = Part(2.0, (-0.25, 1e-20, -1e-20), (), True, "given")
    told = said(SimpleNamespace(body="rod"), part, [])
    assert "centre at [-0.25, 0, 0] m, given" in told and "acted on by nothing" in told
