"""A scene is planar only where nothing reaches out of the plane; turning a scene changes nothing.

Every scene runs as drawn and turned as a whole in space, where it cannot be planar.
"""

from math import cos, sin

import numpy as np
import pytest
import yaml

from trsim.errors import ModelError

from ..runs import built, run

ROD = "rod: {mass: 2, inertia: [0.02, 0.3, 0.4], at: [0.5, 0, 0]}"
BLOCK = "block: {mass: 2, inertia: [0.2, 0.3, 0.4], at: [0, 0, 0]}"
FREE = "bodies: {rod: {mass: 2, inertia: [0.1, 0.3, 0.35], at: [0.5, 0, 0]%s}}\n"
HINGED = f"""
bodies: {{{ROD}}}
joints: {{hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0, 0]}}}}
"""
Y_HINGE = HINGED.replace("at: [0, 0, 0]", "at: [0, 0, 0], axis: [0, 1, 0]")
Z_SLIDE = f"""
bodies: {{{BLOCK}}}
joints: {{lift: {{type: prismatic, bodies: [ground, block], axis: [0, 0, 1]}}}}
"""
ARM = f"""
bodies: {{{BLOCK}, {ROD}}}
joints:
  base: {{type: revolute, bodies: [ground, block], at: [0, 0, 0]}}
  shoulder: {{type: revolute, bodies: [block, rod], at: [0.2, 0, 0], axis: [0, 1, 0]}}
"""
DOWN = "gravity: [0, -9.81, 0]\n"
OUT = {
    "a rigid drive about y": Y_HINGE + "drives: {m: {joint: hinge, position: 3*t**2}}",
    "a rate about y": Y_HINGE + "drives: {m: {joint: hinge, velocity: 2 + t}}" + "\n" + DOWN,
    "a soft drive about y": Y_HINGE
    + "drives: {m: {joint: hinge, position: t, compliance: {stiffness: 200, damping: 3}}}",
    "a rigid drive along z": Z_SLIDE + "drives: {m: {joint: lift, position: 10*t**3}}",
    "a soft drive along z": Z_SLIDE
    + "drives: {m: {joint: lift, velocity: 1, compliance: {stiffness: 200}}}",
    "an arm with a shoulder": ARM
    + "drives: {m: {joint: base, velocity: 2}, n: {joint: shoulder, velocity: 1}}\n" + DOWN,
    "a shoulder that is pushed later": ARM + DOWN
    + "forces: {f: {type: applied_load, body: rod, frame: rod, direction: [0, 1, 0], "
    "torque: 3*(t > 0.3)}}",
    "a product of inertia, free": FREE.replace("0.35]", "0.35, 0, 0.05, 0]")
    % ", angular_velocity: [0, 0, 3]",
    "a product of inertia, held": HINGED.replace("0.4]", "0.4, 0, 0.03, 0.01]") + DOWN,
    "a velocity along z": FREE % ", velocity: [1, 0, 0.5]" + DOWN,
    "a turn about x": FREE % ", angular_velocity: [0.1, 0, 3]",
    "a load along z, later": FREE % ""
    + "forces: {f: {type: applied_load, body: rod, direction: [1, 0, 1], force: 5*(t > 0.2)}}",
    "a load on a held body, along z, later": HINGED
    + "forces: {f: {type: applied_load, body: rod, direction: [1, 0, 1], force: 5*(t > 0.2)}}",
    "a load beside the plane, later": HINGED
    + "forces: {f: {type: applied_load, body: rod, at: [1, 0, 0.1], direction: [0, 1, 0], "
    "force: 5*(t > 0.2)}}",
    "a spring from above": FREE % ""
    + "forces: {s: {type: spring_damper, bodies: [ground, rod], points: [[0, 0, 1], [1, 0, 0]], "
    "stiffness: 30}}",
    "a spring beside the plane": HINGED
    + "forces: {s: {type: spring_damper, bodies: [ground, rod], points: [[1, 1, 0.1], [1, 0, 0.1]],"
    " stiffness: 30, preload: 10}}",
    "a hinge that lets go of a body pushed beside the plane": HINGED.replace("hinge:", "axle:")
    + "forces: {f: {type: applied_load, body: rod, at: [1, 0, 0.1], direction: [0, 1, 0], force: 5}"
    "}\nevents: {off: {when: t, value: 0.2, do: {release: [axle]}}}",
    "a wall above": FREE % ", velocity: [1, 0, 0]"
    + "forces: {w: {type: limit_stop, point: {body: rod, at: [0.5, 0, 0]}, wall: {body: ground, "
    "at: [0.7, 0, 0], normal: [-1, 0, 0.3]}, stiffness: 2000}}",
    "a stop beside the plane": FREE % ", velocity: [1, 0, 0]"
    + "forces: {w: {type: limit_stop, point: {body: rod, at: [1, 0, 0.1]}, wall: {body: ground, "
    "at: [1.1, 0, 0], normal: [-1, 0, 0]}, stiffness: 2000}}",
    "a mount askew": FREE % "" + DOWN
    + "forces: {b: {type: bushing, bodies: [ground, rod], at: [0.5, 0, 0], x_axis: [1, 1, 0.5], "
    "stiffness: [300, 100, 50], rotational_stiffness: [30, 20, 10]}}",
    "a mount that turns askew": HINGED + DOWN
    + "forces: {b: {type: bushing, bodies: [ground, rod], at: [0, 0, 0], x_axis: [1, 1, 0.5], "
    "stiffness: [0, 0, 0], rotational_stiffness: [30, 20, 10]}}",
    "a jack from below": Y_HINGE
    + "drives: {j: {type: actuator, bodies: [ground, rod], points: [[1, 0, -1], [1, 0, 0]], "
    "position: 0.2*t**2}}",
    "a jack from below in a plane joint": HINGED
    + "drives: {j: {type: actuator, bodies: [ground, rod], points: [[1, -1, -1], [1, 0, 0]], "
    "velocity: 0.2, stiffness: 3000, damping: 30}}",
    "weight along z": HINGED + "gravity: [0, -5, -5]",
    "a cross": HINGED.replace("revolute", "universal").replace(
        "at: [0, 0, 0]}}", "at: [0, 0, 0], axis: [0, 0, 1], second_axis: [0, 1, 0]}}"
    ) + DOWN,
    "a lock along z": Z_SLIDE + DOWN
    + "events: {shut: {when: t, value: 0.2, do: {lock: [lift]}}}",
    "what is told along z": HINGED + DOWN
    + "sensors: {s: {type: displacement, bodies: [ground, rod], at: [1, 0, 0], axis: [0, 1, 1]}}",
}  # fmt: skip
IN = {
    "a pendulum": HINGED + DOWN,
    "free": FREE % ", velocity: [1, 2, 0], angular_velocity: [0, 0, 3]" + DOWN,
    "at different heights": FREE % "" + DOWN
    + "forces: {b: {type: bushing, bodies: [ground, rod], at: [0.6, 0, 0], x_axis: [1, 1, 0], "
    "stiffness: [300, 100, 50], damping: [1, 2, 3], rotational_stiffness: [30, 20, 10]}}",
    "Ixy": HINGED.replace("0.4]", "0.4, 0.03, 0, 0]") + DOWN,
    "loads and stops": HINGED + DOWN + """
sensors: {angle: {joint: hinge}}
forces:
  s: {type: spring_damper, bodies: [ground, rod], points: [[1, 1, 0], [1, 0, 0]], stiffness: 30}
  c: {type: torsion_spring, joint: hinge, stiffness: 4, damping: 0.1, preload: 1}
  f: {type: applied_load, body: rod, frame: rod, direction: [1, 1, 0], force: 3*angle}
  w: {type: limit_stop, point: {body: rod, at: [1, 0, 0]}, stiffness: 5000, damping: 3, ramp: 1e-4,
      wall: {body: ground, at: [1, -0.2, 0], normal: [0, 1, 0]}}
""",
    "springs above and below": HINGED + DOWN + """
forces:
  a: {type: spring_damper, bodies: [ground, rod], points: [[1, 1, 1], [1, 0, 0]], stiffness: 30}
  b: {type: spring_damper, bodies: [ground, rod], points: [[1, 1, -1], [1, 0, 0]], stiffness: 30}
""",
    "a drive": HINGED + "drives: {m: {joint: hinge, position: 3*t**2}}\n" + DOWN,
}  # fmt: skip
END = "\nsolver: {end: 0.5, tolerance: 1e-10}\noutput: {every: 0.05}\n"
CHECKED = (
    "position", "velocity", "angular_velocity", "angular_acceleration", "reaction",
    "reaction_moment", "load",
)  # fmt: skip


def rotation():
    """About an axis of no particular direction."""
    a = np.array([0.3, -0.5, 0.7]) / np.linalg.norm([0.3, -0.5, 0.7])
    K = np.cross(np.eye(3), a)
    return np.eye(3) + sin(1.1) * K + (1.0 - cos(1.1)) * K @ K


VECTORS = {
    "at", "velocity", "angular_velocity", "axis", "second_axis", "direction", "normal", "x_axis",
    "y_axis", "gravity", "points",
}  # fmt: skip


def turned(data, R, key=""):
    """The scene turned as a whole: every vector, and the inertias, which are in world axes."""
    if key == "bodies" and isinstance(data, dict):
        return {name: turned(body, R) for name, body in data.items()}
    if isinstance(data, dict):
        found = {k: turned(v, R, k) for k, v in data.items()}
        if data.get("type") == "bushing":  # with the axes it has by default
            x, y = data.get("x_axis", [1, 0, 0]), data.get("y_axis", [0, 1, 0])
            found |= {"x_axis": (R @ x).tolist(), "y_axis": (R @ y).tolist()}
        if data.get("type") == "revolute":
            found["axis"] = (R @ data.get("axis", [0, 0, 1])).tolist()
        return found
    if key == "inertia":
        xx, yy, zz, xy, xz, yz = (*data, 0, 0, 0)[:6]
        I = R @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ R.T
        return [float(I[r, c]) for r, c in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    if key == "points" and isinstance(data, list) and isinstance(data[0], list):
        return [(R @ p).tolist() for p in data]
    if key in VECTORS and isinstance(data, list):
        return (R @ data).tolist()
    return data


def compared(text):
    """The runs of a scene as drawn and turned, the latter's vectors turned back."""
    drawn, R = run(text + END), rotation()
    space = run(yaml.safe_dump(turned(yaml.safe_load(text + END), R)))
    assert not space.mechanism.planar
    for name, (_, size) in drawn.place.items():
        if name.startswith("energy") or (size == 3 and name.split(".")[-1] not in CHECKED):
            continue
        a, b = drawn[name], space[name]
        if size == 3:
            b = b @ R
        elif size > 1:
            continue
        # what is judged: every number, by the largest of its kind
        scale = max(1.0, float(np.abs(b).max()))
        assert a == pytest.approx(b, abs=1e-6 * scale), name
    return drawn


@pytest.mark.parametrize("name", OUT)
def test_what_reaches_out_of_the_plane_runs_in_space(name):
    m = built(OUT[name] + END)
    assert not m.planar and m.spatial_because
    compared(OUT[name])


@pytest.mark.parametrize("name", IN)
def test_what_stays_in_the_plane_is_planar(name):
    assert compared(IN[name]).mechanism.planar


def test_a_plane_at_a_height_is_one():
    """Nothing turns the ground: what pulls on it beside its origin counts for nothing."""
    high = (
        HINGED.replace("0, 0]", "0, 0.4]")
        + DOWN
        + (
            "forces: {s: {type: spring_damper, bodies: [ground, rod], stiffness: 30, "
            "points: [[1, 1, 0.4], [1, 0, 0.4]]}}"
        )
    )
    m = built(high + END)
    assert m.planar and not m.spatial_because


def test_a_rod_swung_out_of_the_plane_by_hand():
    """I a = T about y, Ixx and Izz spin along: torque (Iyy + m r^2) a, pull m r w^2."""
    r = run(OUT["a rigid drive about y"] + END)
    turn, rate = 3 * r.t**2, 6 * r.t
    assert r["m.force"] == pytest.approx(np.full(len(r.t), (0.3 + 2 * 0.25) * 6), rel=1e-9)
    x, z = 0.5 * np.cos(turn), -0.5 * np.sin(turn)
    assert r["rod.position"] == pytest.approx(np.stack([x, 0 * x, z], axis=1), abs=1e-9)
    pull = np.hypot(r["hinge.reaction"][:, 0], r["hinge.reaction"][:, 2])
    assert pull == pytest.approx(2 * 0.5 * np.hypot(rate**2, 6.0), rel=1e-8)


def test_a_product_of_inertia_by_hand():
    """Euler's equations integrated by rk4 with a tiny step: I w' + w x I w = 0, R' = R [w]x."""
    I = np.array([[0.1, 0, 0.05], [0, 0.3, 0], [0.05, 0, 0.35]])
    w, back = np.array([0.0, 0.0, 3.0]), np.linalg.inv(I)

    def rate(w):
        return -back @ np.cross(w, I @ w)

    R, h = np.eye(3), 0.5 / 1000
    for _ in range(1000):
        a = rate(w)
        b = rate(w + h / 2 * a)
        c = rate(w + h / 2 * b)
        d = rate(w + h * c)
        K = np.cross(np.eye(3), w + h / 2 * a)  # midpoint: an error of h^2
        R = R @ np.linalg.solve(np.eye(3) - h / 2 * K, np.eye(3) + h / 2 * K)
        w = w + h / 6 * (a + 2 * b + 2 * c + d)
    r = run(OUT["a product of inertia, free"] + END)
    assert np.linalg.norm(w - [0, 0, 3]) > 0.3  # it does leave the axis
    assert r["rod.angular_velocity"][-1] == pytest.approx(R @ w, abs=1e-6)


def test_the_bearing_of_an_unbalanced_rotor_by_hand():
    """Steady spin: the bearing turns Ixz w^2 and Iyz w^2 about y and -x."""
    text = f"""
bodies: {{{BLOCK.replace("0.4]", "0.4, 0, 0.03, 0.01]")}}}
joints: {{axle: {{type: revolute, bodies: [ground, block], at: [0, 0, 0]}}}}
drives: {{m: {{joint: axle, velocity: 4}}}}
"""
    r = run(text + END)
    x, y = np.cos(4 * r.t), np.sin(4 * r.t)
    xz, yz = 0.03 * x - 0.01 * y, 0.03 * y + 0.01 * x
    expected = 16 * np.stack([-yz, xz, 0 * x], axis=1)
    assert r["axle.reaction_moment"] == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize(
    "name", ["a rigid drive about y", "a load along z, later", "a product of inertia, free"]
)
def test_asking_for_the_plane_is_refused(name):
    with pytest.raises(ModelError, match="leave the x-y plane") as caught:
        built("planar: true\n" + OUT[name] + END)
    assert caught.value.path == ("planar",) and built(OUT[name] + END).spatial_because[0] in str(
        caught.value
    )


def test_held_bodies_of_which_little_is_known_stay_in_the_plane():
    """One moment of inertia: there is nothing to run in space, and the reader is told."""
    text = OUT["a load beside the plane, later"].replace("[0.02, 0.3, 0.4]", "0.4")
    m = built(text + END)
    assert m.planar and "beside the plane" in m.notes[0]
    with pytest.raises(ModelError, match="turns about another axis") as caught:
        built(OUT["a rigid drive about y"].replace("[0.02, 0.3, 0.4]", "0.4") + END)
    assert caught.value.path == ("bodies", "rod", "inertia")


def test_a_bar_across_the_plane():
    """It hangs along z and is pushed along x: in the plane it would have no length at all."""
    m = built(
        """
bodies: {bar: {type: ancf_cable, start: [0, 0, 0], end: [0, 0, 1], section: {diameter: 0.02},
               youngs_modulus: 2e11, density: 7800}}
joints: {clamp: {type: spherical, bodies: [ground, bar], at: [0, 0, 0]}}
gravity: [1, 0, 0]
"""
        + END
    )
    assert not m.planar and "rises out of the plane" in m.spatial_because[0]
