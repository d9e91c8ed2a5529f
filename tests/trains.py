"""Wheels on a carrier, anywhere in space, and whether they slip where they touch."""

from typing import NamedTuple

import numpy as np

from .overconstrained import rotation

# of the axes the gears of the tests are drawn about, away from the world's
TURNED = rotation((1, 2, 3), 0.7)
PLACE = np.array([0.3, -0.2, 0.1])


def numbers(v):
    """A vector as it is written in a scenario."""
    return [float(c) for c in v]


class Train(NamedTuple):
    """Two joints on a carrier that turns about an axis of the ground, in axes of its own.

    A wheel or a rack k has its joint at `at[k]`, with the axis `axis[k]`; `second[k]`: the carrier
    is the second body of the joint.
    """

    at: tuple
    axis: tuple
    kinds: tuple = ("revolute", "revolute")
    second: tuple = (False, False)
    spin: tuple = (0.2, -0.3, 1.0)  # axis of the carrier
    place: np.ndarray = PLACE
    turned: np.ndarray = TURNED
    angles: tuple = (0.0, 0.0, 0.0)  # of carrier and wheels against the drawing, about z

    def there(self, v):
        return self.place + self.turned @ v

    def text(self, mesh, more="", end=2.0, solver="tolerance: 1e-9"):
        bodies = [
            f"  {name}: {{mass: 1, inertia: [0.02, 0.03, 0.04, 0.001, 0.002, 0.003], "
            f"at: {numbers(self.there(at))}, angle: {angle}}}"
            for name, at, angle in zip(
                ("carrier", "one", "two"), (np.array([0.1, 0.05, 0.02]), *self.at), self.angles,
                strict=True,
            )
        ]  # fmt: skip
        joints = [
            f"  bearing: {{type: revolute, bodies: [ground, carrier], "
            f"at: {numbers(self.there(np.zeros(3)))}, axis: {numbers(self.turned @ self.spin)}}}"
        ]
        for k, (name, body) in enumerate((("first", "one"), ("other", "two"))):
            pair = f"{body}, carrier" if self.second[k] else f"carrier, {body}"
            joints.append(
                f"  {name}: {{type: {self.kinds[k]}, bodies: [{pair}], "
                f"at: {numbers(self.there(self.at[k]))}, "
                f"axis: {numbers(self.turned @ self.axis[k])}}}"
            )
        return "\n".join([
            "planar: false", "bodies:", *bodies, "joints:", *joints,
            f"  mesh: {{{mesh}}}",
            "drives:",
            '  turn: {joint: bearing, velocity: "0.7 + 0.5*cos(2*t)"}',
            '  motor: {joint: first, velocity: "4 - 3*t"}',
            "sensors: {x: {joint: first}, y: {joint: other}}",
            f"solver: {{end: {end}, {solver}}}",
            'output: {every: 0.05, channels: ["*.position", "*.velocity", "*.rotation", x, y, '
            '"*.angular_velocity", "mesh.*", "motor.*", "turn.*", "energy.*"]}',
            more,
        ])  # fmt: skip

    def slip(self, r, at, way=None):
        """How fast the two wheels move against each other at a point of the carrier (n, 3).

        way: a direction, of which the part is taken.
        """
        frames = r["carrier.rotation"].reshape(-1, 3, 3)
        own = r["carrier.rotation"][0].reshape(3, 3).T
        place = r["carrier.position"][0]
        touch = r["carrier.position"] + frames @ own @ (self.there(at) - place)
        found = velocity(r, "one", touch) - velocity(r, "two", touch)
        if way is None:
            return found
        return np.sum(found * (frames @ own @ (self.turned @ np.array(way, float))), axis=1)


def velocity(r, body, at):
    """Of the point of a body that is at these places."""
    arm = at - r[f"{body}.position"]
    return r[f"{body}.velocity"] + np.cross(r[f"{body}.angular_velocity"], arm)
