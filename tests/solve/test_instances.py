"""Instances move as what they were made of, wherever they stand."""

import json

import numpy as np
import pytest
import yaml

from tests.runs import built, run
from tests.small import SLIDER_CRANK
from trsim.errors import ModelError

ALL = {"channels": ["*", "*.rotation"]}
RK4 = {
    "solver": {"method": "rk4", "step": 1e-3, "end": 0.2},
    "output": {"every": 0.01, **ALL},
}
FRAME = {"at": [0.3, -0.2, 0.5], "x_axis": [2.0, 1.0, -1.0], "y_axis": [0.5, 1.0, 2.0]}
PENDULUM = {
    "bodies": {
        "rod": {"mass": 2, "inertia": [0.02, 0.05, 0.06], "at": [0.4, 0], "angle": 0.2},
        "bob": {
            "mass": 1,
            "inertia": [0.01, 0.03, 0.02, 1e-3, 2e-3, -1e-3],
            "at": [0.8, 0.3, 0.1],
            "angular_velocity": [0.2, 0.3, 4],
            "velocity": [0, 1, 0.3],
        },
    },
    "joints": {
        "pin": {"type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0], "axis": [0, 0.1, 1]},
        "ball": {"type": "spherical", "bodies": ["rod", "bob"], "at": [0.8, 0]},
    },
    "sensors": {"q": {"joint": "pin"}},
    "forces": {
        "wind": {
            "type": "applied_load",
            "body": "bob",
            "direction": [1, 2, 3],
            "force": "3*cos(9*t)",
        },
        "jet": {
            "type": "applied_load",
            "body": "bob",
            "frame": "bob",
            "at": [0.9, 0.3, 0],
            "direction": [0, 1, 0.5],
            "force": "2 + q",
        },
        "coil": {"type": "torsion_spring", "joint": "pin", "stiffness": 3, "preload": 1},
        "rope": {
            "type": "spring_damper",
            "bodies": ["ground", "bob"],
            "points": [[0.5, 1, 0], [0.8, 0.4, 0]],
            "stiffness": 40,
            "damping": 2,
        },
        "wall": {
            "type": "limit_stop",
            "point": {"body": "bob", "at": [0.9, 0.3, 0]},
            "wall": {"body": "ground", "at": [0, 0.2, 0], "normal": [0, 1, 0]},
            "stiffness": 1e3,
        },
    },
}


def text(more, gravity=(0, 0, 0), planar=False):
    return json.dumps({"planar": planar, "gravity": list(gravity), **more}) + "\n"


def instance(template, frame=None, **more):
    given = {"template": "part", **({"frame": frame} if frame else {}), **more}
    return {"templates": {"part": template}, "instances": {"a": given}}


def rotation(frame):
    x = np.array(frame.get("x_axis", [1, 0, 0])) / np.linalg.norm(frame.get("x_axis", [1, 0, 0]))
    y = np.array(frame.get("y_axis", [0, 1, 0]))
    y = y - (x @ y) * x
    y = y / np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)], axis=1)


def largest(r, unit):
    """The largest value of a channel with that unit, 1 at least."""
    return max(1.0, *(np.abs(r[c.name]).max() for c in r.mechanism.columns if c.unit == unit))


def same(flat, ours, frame, tolerance, before="", after="a_"):
    """Whether all channels of an instance are those of the flat scenario, seen from its frame."""
    R, at = rotation(frame), np.append(frame.get("at", [0, 0, 0]), 0.0)[:3]
    compared = [c for c in flat.mechanism.columns if c.name.startswith((before, "energy"))]
    for c in compared:
        theirs, energy = flat[c.name], c.name.startswith("energy")
        mine = ours[c.name if energy else after + c.name.removeprefix(before)]
        size = largest(flat, c.unit)
        if energy:  # the height of a weight is from another origin
            theirs, mine = theirs - theirs[0], mine - mine[0]
        elif c.size == 9:
            theirs = (R @ theirs.reshape(-1, 3, 3)).reshape(-1, 9)
        elif c.size == 3:
            place = c.name.endswith((".position", ".tip", ".middle"))
            theirs = theirs @ R.T + (at if place else 0.0)
        assert np.abs(mine - theirs).max() <= tolerance * size, c.name
    assert len(compared) > 20


def test_an_identity_frame_moves_as_the_flat_scenario():
    flat = run(text({**PENDULUM, **RK4}, gravity=(0, -9.81, 1)))
    ours = run(text({**instance(PENDULUM, {"x_axis": [3, 0, 0]}), **RK4}, gravity=(0, -9.81, 1)))
    assert [c.name for c in ours.mechanism.columns if not c.name.startswith("energy")] == [
        f"a_{c.name}" for c in flat.mechanism.columns if not c.name.startswith("energy")
    ]
    assert ours.rows.tobytes() == flat.rows.tobytes()


def test_a_turned_instance_moves_as_the_flat_scenario_turned():
    g = np.array([0.0, -9.81, 1.0])
    flat = run(text({**PENDULUM, **RK4}, gravity=tuple(g)))
    turned = (rotation(FRAME) @ g).tolist()
    ours = run(text({**instance(PENDULUM, FRAME), **RK4}, gravity=tuple(turned)))
    assert np.ptp(flat["bob.position"], axis=0).max() > 0.05
    same(flat, ours, FRAME, 1e-12)


def crank(clearance=False):
    """The slider-crank of tests/small.py as a template and what is left of it."""
    whole = yaml.safe_load(SLIDER_CRANK)
    del whole["poincare"]
    keys = ("bodies", "joints", "drives", "sensors", "forces", "events")
    part = {key: whole.pop(key) for key in keys if key in whole}
    for body in part["bodies"].values():
        body["inertia"] = [0.01, 0.02, float(body["inertia"])]
    if not clearance:
        for joint in part["joints"].values():
            joint.pop("clearance", None), joint.pop("contact", None)
    return part, whole


def spokes(n):
    """Frames round the x axis."""
    angles = [2 * np.pi * k / n for k in range(n)]
    return {
        f"i{k}": {
            "template": "part",
            "frame": {"at": [0, np.cos(a), np.sin(a)], "y_axis": [0, np.cos(a), np.sin(a)]},
        }
        for k, a in enumerate(angles)
    }


def test_five_slider_cranks_are_alike():
    """Angles, strokes, and eccentricities in the bearings are those of one in the world."""
    part, whole = crank(clearance=True)
    whole["solver"] = {"method": "dop853", "end": 0.004, "tolerance": 1e-9}
    whole["output"] = {"every": 2e-4}
    one = run(text({**whole, **instance(part)}))
    five = run(text({**whole, "templates": {"part": part}, "instances": spokes(5)}))
    scalars = [c for c in one.mechanism.columns if c.size == 1 and c.name.startswith("a_")]
    assert "a_B.eccentricity_x" in [c.name for c in scalars]
    assert np.ptp(one["a_B.eccentricity_x"]) > 1e-4
    for c in scalars:
        size = largest(one, c.unit) if c.unit != "m" else np.abs(one[c.name]).max()
        for k in range(5):
            other = five[c.name.replace("a_", f"i{k}_", 1)]
            assert np.abs(other - one[c.name]).max() <= 1e-6 * size, (c.name, k)


def test_two_in_one_plane():
    """Frames turned about z stay planar, and the angles at the ground are those of the template."""
    part, whole = crank()
    whole["solver"] = {"method": "rk4", "step": 1e-4, "end": 0.02}
    whole["output"] = {"every": 1e-3, "channels": ["*", "*.rotation"]}
    instances = {
        "a": {"template": "part"},
        "b": {"template": "part", "frame": {"at": [2, 1], "x_axis": [0.6, 0.8], "y_axis": [-8, 6]}},
    }
    r = run(text({**whole, "templates": {"part": part}, "instances": instances}, planar=True))
    assert r.mechanism.planar
    same(r, r, {"at": [2, 1, 0], "x_axis": [0.6, 0.8, 0], "y_axis": [-8, 6, 0]}, 1e-10, "a_", "b_")
    with pytest.raises(ModelError, match="out of the x-y plane"):
        frame = {"y_axis": [0, 0, 1]}
        built(text({**whole, **instance(part, frame)}, planar=True))


BARS = {
    "bodies": {
        "rope": {
            "type": "ancf_cable",
            "start": [0, 0],
            "end": [1, 0],
            "elements": 4,
            "section": {"diameter": 0.02},
            "youngs_modulus": 1e7,
            "density": 1000,
        },
        "rod": {
            "mass": 0.4,
            "inertia": [1e-4, 0.03, 0.03],
            "at": [1.25, 0.2],
            "angle": 0.1,
            "flexible": {"elements": 2, "section": {"diameter": 0.02}, "youngs_modulus": 1e8},
        },
        "bob": {"mass": 1, "inertia": [0.01, 0.01, 0.01], "at": [1.5, 0.4], "angle": 0.3},
    },
    "joints": {
        "A": {"type": "revolute", "bodies": ["ground", "rope"], "at": [0, 0]},
        "B": {"type": "revolute", "bodies": ["rope", "rod"], "at": [1, 0]},
        "C": {"type": "revolute", "bodies": ["rod", "bob"], "at": [1.5, 0.4]},
    },
    "sensors": {"qA": {"joint": "A"}, "qB": {"joint": "B"}, "qC": {"joint": "C"}},
    "forces": {
        "push": {"type": "applied_load", "body": "rope", "at": [1, 0], "direction": [0, 1],
                 "force": "5*sin(30*t)"},
        "wind": {"type": "distributed_load", "body": "rope", "direction": [0, 1],
                 "force_per_length": 3},
    },
}  # fmt: skip


@pytest.mark.parametrize("planar", [True, False])
def test_flexible_bars(planar):
    part = json.loads(json.dumps(BARS))
    frame = {"at": [1, 2, 0], "x_axis": [0.6, 0.8, 0], "y_axis": [-8, 6, 0]}
    if not planar:
        frame = FRAME
        for joint in part["joints"].values():
            joint["type"] = "spherical"
        del part["sensors"]
    more = {
        "solver": {"method": "rk4", "step": 2e-5, "end": 0.004},
        "output": {"every": 1e-3, **ALL},
    }
    flat = run(text({**more, **part}, planar=planar))
    ours = run(text({**more, **instance(part, frame)}, planar=planar))
    same(flat, ours, frame, 1e-7)


@pytest.mark.parametrize("frame", [FRAME, {"x_axis": [0.6, 0.8], "y_axis": [-8, 6]}])
def test_the_angle_as_drawn_is_that_of_the_template(frame):
    """Against the ground, whose axes stay the world's, and against a body that is turned itself."""
    part = {
        "bodies": {name: {"mass": 1, "inertia": [1, 1, 1], "angle": a} for name, a in ROD_ANGLES},
        "joints": {
            "A": {"type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0]},
            "B": {"type": "revolute", "bodies": ["bob", "rod"], "at": [1, 0], "axis": [0, 0, -1]},
        },
        "sensors": {"qA": {"joint": "A"}, "qB": {"joint": "B"}},
    }
    drawn = {n[-1]: x.drawn for n, x in built(text(instance(part, frame))).coordinates.items()}
    assert drawn == pytest.approx({"A": 0.3, "B": -0.5}, abs=1e-15)


ROD_ANGLES = (("rod", 0.3), ("bob", -0.2))


def test_a_body_whose_axes_leave_the_plane_is_solved_in_space():
    """A disc in the x-y plane of the world, about the y axis of its frame: theta0 cos(omega t)."""
    part = {
        "bodies": {"disc": {"mass": 1, "inertia": [1, 2, 4]}},
        "joints": {
            "pin": {"type": "revolute", "bodies": ["ground", "disc"], "at": [0, 0], "axis": [0, 1]}
        },
        "sensors": {"q": {"joint": "pin", "at_start": 0.3}},
        "forces": {
            "coil": {"type": "torsion_spring", "joint": "pin", "stiffness": 50, "preload": -15}
        },
        "solver": {"end": 1, "tolerance": 1e-10},
    }
    solver = {"solver": part.pop("solver")}
    r = run(text({**solver, **instance(part, {"y_axis": [0, 0, 1]})}, planar=None))
    assert not r.mechanism.planar
    assert np.abs(r["a_q"] - 0.3 * np.cos(5.0 * r.t)).max() < 1e-8
