"""The elements: one line each.  The word in a scenario file is the name of the module."""

from importlib import import_module
from sys import modules
from typing import TYPE_CHECKING

from trsim.errors import ScenarioError, known

if TYPE_CHECKING:
    from trsim.elements.contract import Element

# word -> section of the scenario it may stand in
ELEMENTS = {
    "rigid_body": "bodies",
    "ancf_cable": "bodies",  # also a rigid_body with the key `flexible`
    "revolute": "joints",
    "shaft": "joints",
    "spherical": "joints",
    "universal": "joints",
    "prismatic": "joints",
    "cylindrical": "joints",
    "inline": "joints",
    "inplane": "joints",
    "planar": "joints",
    "parallel": "joints",
    "screw": "joints",
    "constant_velocity": "joints",
    "link": "joints",
    "point_on_curve": "joints",
    "cam": "joints",
    "fixed": "joints",
    "clearance_joint": "joints",  # a revolute with the key `clearance`
    "gear": "joints",
    "rack_and_pinion": "joints",
    "worm": "joints",
    "coupler": "joints",
    "belt": "joints",
    "rope": "joints",
    "drive": "drives",
    "actuator": "drives",
    "sensor": "sensors",
    "displacement": "sensors",
    "relative_angle": "sensors",
    "distance": "sensors",
    "point": "sensors",
    "point_velocity": "sensors",
    "marker": "points",
    "gravity": "",  # the key `gravity` of the scenario
    "parked": "",  # the key `park` of events and phases
    "applied_load": "forces",
    "wrench": "forces",
    "distributed_load": "forces",
    "spring_damper": "forces",
    "spring": "forces",
    "bushing": "forces",
    "torsion_spring": "forces",
    "joint_spring": "forces",
    "ball_spring": "forces",
    "gear_mesh": "forces",
    "limit_stop": "forces",
    "surface_contact": "forces",
    "seal": "forces",
    "joint_friction": "forces",
    "sync_shaft": "forces",
    "reaction": "sensors",
    "energy": "sensors",
    "section": "sensors",  # behind all that may act on a body
    "formula": "sensors",  # behind all that it may read
}

# word -> the key that makes it another element, and which
BECOMES = {"revolute": ("clearance", "clearance_joint")}
# section -> what an entry is that names no type
DEFAULT = {"bodies": "rigid_body", "drives": "drive", "sensors": "sensor", "points": "marker"}

PARKED = "parked"  # what holds a body that an event parks


def load(word: str) -> "Element":
    """Import one element.  Raises ScenarioError for a word that is none."""
    if word not in ELEMENTS:
        raise ScenarioError(f"unknown type '{word}'", known(word, [w for w in ELEMENTS if w]))
    module = modules.get(name := f"trsim.elements.{word}")  # a lookup: this is asked all the time
    return getattr(module, "ELEMENT", None) or import_module(name).ELEMENT
