"""What sensors share: the axis along which they show something, and what their examples are of."""

from trsim.elements.contract import Reach, Turning
from trsim.elements.frames import Along


def reach(row):
    """The axis, fixed in the first frame; none of what shows a size."""
    return Reach(shown=axes(row))


def turning(row):
    """Of a point of the second frame, along the axis."""
    own = Along.of(row)
    return Turning(points=((own.j, own.p_j),), axes=axes(row))


def axes(row):
    """The axis with its frame, if there is one."""
    own = Along.of(row)
    return ((own.i, own.axis),) if any(own.axis) else ()


def on_pendulum(*sensors):
    """An example: a pendulum with sensors."""
    return PENDULUM.replace("SENSORS", "\n  ".join(sensors))


PENDULUM = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
sensors:
  SENSORS
gravity: [0, -9.81, 0]
solver: {end: 1 s}
"""
