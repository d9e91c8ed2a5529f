"""Which bodies there are: rigid ones, and flexible bars as beams or, for a start, as rigid ones."""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.errors import ScenarioError

Array = NDArray[np.float64]

SLENDER = 1e-6  # of its inertia across: what a bar without width has about its own line
ON_LINE = 1e-3  # of its length: how far the centre of mass of a bar may be from its middle


class Beam(NamedTuple):
    """The nodes of a flexible bar as drawn."""

    first: int  # frame of its first node
    nodes: int
    element: int  # its first one among the elements of all beams
    whole: float  # m, of the bar
    tangent: tuple[float, float, float]
    axes: Array  # (3, 3) of its nodes, the tangent first
    places: Array  # (nodes, 3)
    per_length: float  # kg/m
    stiffness: float  # EA, N

    @property
    def length(self) -> float:
        """Of one element, m."""
        return self.whole / (self.nodes - 1)


def members(scenario: Any, stiff: bool = False) -> dict[str, Any]:
    """The bodies by name: RigidBody or AncfCable; with `stiff` all of them rigid."""
    found = {}
    for name, spec in scenario.bodies.items():
        bar = spec
        if spec.type == "rigid_body" and spec.flexible is not None:
            try:
                bar = cable(name, spec, scenario)
            except ScenarioError as error:
                raise error.at("bodies", name) from None
        found[name] = stiffened(bar) if stiff and bar.type == "ancf_cable" else bar
    return found


def cable(name: str, spec: Any, scenario: Any) -> Any:
    """The rigid bar `spec` as a flexible one, between its joints."""
    from trsim.elements.ancf_cable import AncfCable

    ends = [j.at for j in scenario.joints.values() if name in j.bodies and j.at is not None]
    pairs = [(a, b) for a in ends for b in ends]
    start, end = max(pairs, key=lambda pair: distance(*pair), default=((), ()))
    if not start or start == end:
        raise ScenarioError(
            "a flexible bar lies between two of its joints, and this one has fewer",
            "give it joints at both ends, or make it an ancf_cable with `start` and `end`",
            ("flexible",),
        )
    middle = tuple(0.5 * (a + b) for a, b in zip(start, end, strict=True))
    away = distance(middle, spec.at)
    if away > ON_LINE * distance(start, end):
        raise ScenarioError(
            f"its centre of mass is {away:.3g} m away from the middle between its joints",
            "a flexible bar is straight and alike all along; make it an ancf_cable with `start` "
            "and `end`, or fix rigid bodies to it",
            ("flexible",),
        )
    words = {key: value for key, value in spec.flexible if value is not None}
    if spec.flexible.density is None and spec.flexible.mass is None:
        words["mass"] = spec.mass
    return AncfCable.model_construct(
        **{**dict(spec.flexible), **words},
        start=start,
        end=end,
        velocity=spec.velocity,
        angular_velocity=spec.angular_velocity,
    )


def stiffened(bar: Any) -> Any:
    """A flexible bar as a rigid one of the same mass, slender; its axes are the world's."""
    from trsim.elements.rigid_body import RigidBody

    t = tangent(bar)
    across = bar.per_length * bar.length**3 / 12.0
    I = across * ((1.0 + SLENDER) * np.eye(3) - np.outer(t, t))
    return RigidBody.model_construct(
        mass=bar.per_length * bar.length,
        inertia=(I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]),
        at=tuple(0.5 * (a + b) for a, b in zip(bar.start, bar.end, strict=True)),
        velocity=bar.velocity,
        angular_velocity=bar.angular_velocity,
    )


def beams(bodies: dict[str, Any], first: int) -> dict[str, Beam]:
    """The beams among the bodies; frame `first` is the first of their nodes."""
    found: dict[str, Beam] = {}
    element = 0
    for name, bar in bodies.items():
        if bar.type != "ancf_cable":
            continue
        nodes = bar.elements + 1
        part = np.linspace(0.0, 1.0, nodes)[:, None]
        places = (1.0 - part) * np.array(bar.start) + part * np.array(bar.end)
        t = tangent(bar)
        found[name] = Beam(
            first,
            nodes,
            element,
            bar.length,
            (t[0], t[1], t[2]),
            axes(t),
            places,
            bar.per_length,
            bar.youngs_modulus * bar.numbers[0],
        )
        first, element = first + nodes, element + bar.elements
    return found


def axes(t: Array) -> Array:
    """Axes of a node with the tangent t, columns: the same rule as in assemble/beams.py."""
    k = 1.0 / max(1.0 + t[0], 1e-12)
    if t[2] == 0.0:  # in the plane: turned about z
        return np.array([[t[0], -t[1], 0.0], [t[1], t[0], 0.0], [0.0, 0.0, 1.0]])
    return np.array([
        [t[0], -t[1], -t[2]],
        [t[1], 1.0 - k * t[1] * t[1], -k * t[1] * t[2]],
        [t[2], -k * t[1] * t[2], 1.0 - k * t[2] * t[2]],
    ])  # fmt: skip


def tangent(bar: Any) -> Array:
    """Unit vector from start to end."""
    return (np.array(bar.end) - np.array(bar.start)) / bar.length


def distance(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    return sqrt(sum((x - y) ** 2 for x, y in zip(a, b, strict=True)))
