"""A scenario as other engines want it: bodies, joints as a tree and what closes its loops."""

import json
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from benchmarks.slider_crank import DATA, reference


class Link(NamedTuple):
    """A joint of the tree: `body` hangs on `parent`."""

    parent: str
    body: str
    at: tuple[float, float, float]
    type: str


def tree(scenario: Any) -> tuple[list[Link], list[Any]]:
    """Links from the ground outwards, and the joints that close loops."""
    links, closing, reached = [], [], {"ground"}
    left = list(scenario.joints.values())
    while left:
        joint = next(j for j in left if reached & set(j.bodies))
        left.remove(joint)
        i, j = joint.bodies
        if {i, j} <= reached:
            closing.append(joint)
            continue
        parent, body = (i, j) if i in reached else (j, i)
        links.append(Link(parent, body, joint.at, joint.type))
        reached.add(body)
    return links, closing


def angles(scenario: Any, turn: dict[str, float]) -> np.ndarray:
    """The scenario's sensors of hinges, from the angles the bodies have turned by, rad."""
    turn = {"ground": 0.0, **turn}
    found = []
    for sensor in scenario.sensors.values():
        i, j = scenario.joints[sensor.joint].bodies
        found.append(sensor.sign * (turn[j] - turn[i]) + sensor.at_start)
    return np.array(found)


def andrews_error(scenario: Any, turn: dict[str, float]) -> float:
    known = json.loads((DATA / "p3_andrews.json").read_text())["angles"]
    return float(np.max(np.abs(angles(scenario, turn) - known)))


def tip_error(tip: np.ndarray, n: int, kind: str = "straight") -> float:
    known = json.loads((DATA / "p5_chains.json").read_text())[kind][str(n)]
    return float(np.linalg.norm(tip - known))


def slider_reference() -> tuple[np.ndarray, np.ndarray]:
    """P1 without friction to 3 ms: times, s, and velocity of the slider, m/s."""
    table = reference("frictionless")
    return table["t"], table["slider_v"]


def planar_bodies(scenario: Any) -> Iterator[tuple[str, Any, float]]:
    """Name, body and its inertia about z."""
    for name, body in scenario.bodies.items():
        inertia = body.inertia
        yield name, body, inertia if isinstance(inertia, float) else inertia[2]
