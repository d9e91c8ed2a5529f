"""Linkages that several tests assemble: texts with {planar} and {more} to fill in."""

from math import sqrt
from pathlib import Path

REVERSER = Path(__file__).parents[1] / "scenarios" / "thrust_reverser"

INERTIA = "inertia: [0.01, 0.02, 0.03]"

# a crank of 0.1 that stands upright, and a rod of sqrt(0.1)
UPRIGHT_CRANK = """
bodies:
  crank: {mass: 1 kg, inertia: 0.01, at: [0, 0.05]}
  rod: {mass: 1 kg, inertia: 0.01, at: [0.15, 0.05]}
  slider: {mass: 1 kg, inertia: 0.01, at: [0.3, 0]}
joints:
  a: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  b: {type: revolute, bodies: [crank, rod], at: [0, 0.1]}
  c: {type: revolute, bodies: [rod, slider], at: [0.3, 0]}
  guide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}
"""


def text(bodies, joints, planar="false", more="", end=0.1):
    """A scenario of bodies {name: keys} and joints {name: keys}."""
    lines = [f"planar: {planar}", "bodies:"]
    lines += [f"  {name}: {{mass: 1, {INERTIA}, {keys}}}" for name, keys in bodies.items()]
    lines += ["joints:", *(f"  {name}: {{{keys}}}" for name, keys in joints.items())]
    return "\n".join([*lines, more, f"solver: {{end: {end}, tolerance: 1e-10}}", ""])


def hinge(i, j, x, y):
    return f"type: revolute, bodies: [{i}, {j}], at: [{x}, {y}]"


def four_bar(planar="false", more="", end=0.1):
    """Crank of 1, coupler of 2, rocker of 2, ground from (0, 0) to (2, -1)."""
    bodies = {"crank": "at: [0, 0.5]", "coupler": "at: [1, 1]", "rocker": "at: [2, 0]"}
    joints = {
        "A": hinge("ground", "crank", 0, 0),
        "B": hinge("crank", "coupler", 0, 1),
        "C": hinge("coupler", "rocker", 2, 1),
        "D": hinge("rocker", "ground", 2, -1),
    }
    return text(bodies, joints, planar, more, end)


def flat_parallelogram(planar="true", more="", end=1):
    """A parallelogram whose four pins lie on one line as drawn."""
    bodies = {"crank": "at: [0.5, 0]", "coupler": "at: [2, 0]", "rocker": "at: [2.5, 0]"}
    joints = {
        "A": hinge("ground", "crank", 0, 0),
        "B": hinge("crank", "coupler", 1, 0),
        "C": hinge("coupler", "rocker", 3, 0),
        "D": hinge("rocker", "ground", 2, 0),
    }
    return text(bodies, joints, planar, more, end)


def slider_crank(planar="false", more="", end=0.5):
    """Crank of 0.3 at 30 deg, rod of 1.0; four ideal joints."""
    pin, stroke = 0.3 * sqrt(0.75), 0.3 * sqrt(0.75) + sqrt(1 - 0.15**2)
    bodies = {
        "crank": f"at: [{pin / 2}, 0.075]",
        "rod": f"at: [{(pin + stroke) / 2}, 0.075]",
        "slider": f"at: [{stroke}, 0]",
    }
    joints = {
        "A": hinge("ground", "crank", 0, 0),
        "B": hinge("crank", "rod", pin, 0.15),
        "C": hinge("rod", "slider", stroke, 0),
        "track": "type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]",
    }
    return text(bodies, joints, planar, more, end)


DOOR = text(
    {"door": "at: [0.4, 0, 0]"},
    {
        "top": "type: revolute, bodies: [ground, door], at: [0, 0, 1]",
        "bottom": "type: revolute, bodies: [ground, door], at: [0, 0, -1]",
    },
    more="gravity: [0, 0, -10]",
)


def spatial(changes="", chains=(1, 2, 3, 4, 5), guided=False):
    """The thrust reverser in space with these chains; guided: on an ideal slide and no rails."""
    left_out = [f"chain_{c}: null" for c in range(1, 6) if c not in chains]
    lines = ["extends: spatial_mechanism.yaml", f"instances: {{{', '.join(left_out)}}}"]
    if guided:
        lines += ["joints: {guide: {type: prismatic, bodies: [ground, fairing], axis: [1, 0, 0]}}"]
        rails = [f"rail_{k}_{end}: null" for k in (1, 2) for end in ("front", "rear")]
        lines += [f"forces: {{{', '.join(rails)}}}"]
    return "\n".join([*lines, changes, ""])
