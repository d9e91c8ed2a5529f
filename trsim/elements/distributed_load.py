"""Distributed load: a force per undeformed length along a whole flexible bar.

    F_i = int S_i(x) dx  f(t, sensors) R_f n        S_i: shape functions, laws/cable_section.py

f is a number, an expression or an Akima table of t or a sensor.  Frame: world (a fixed direction)
or a body (a direction that turns with it).
"""

from typing import ClassVar

from pydantic import model_validator

from trsim.elements.applied_load import Directed, magnitude_and_load
from trsim.elements.contract import (
    LOADS,
    Channel,
    Element,
    Reach,
    Row,
    Turning,
    kernel,
    measured,
)
from trsim.elements.loads import Load
from trsim.errors import ScenarioError
from trsim.fields import direction, vector
from trsim.kernels.columns import f8, i8
from trsim.laws.cable_section import uniform_shares
from trsim.varying import Function


class DistributedLoad(Load):
    """A uniform force per length along a flexible bar.

    body              the flexible bar
    frame             `world`, or a body: the direction turns with it
    direction         direction of the force, as drawn; of any length
    force_per_length  magnitude along the direction
    """

    type: ClassVar[str] = "distributed_load"
    body: str
    frame: str = "world"
    direction: vector("-")
    force_per_length: Function("N/m")

    @model_validator(mode="after")
    def a_direction(self):
        if not any(self.direction):
            raise ValueError("`direction` must not be zero")
        return self


class Own(Directed):
    """Of one instance; its body is that of a bar which is rigid for a start, or the first node."""

    nodes: i8
    length: f8  # m, of an element


def pack(name, spec, at):
    i = at.body(spec.body, "body")
    bar = at.bar(spec.body)
    if bar is None:
        raise ScenarioError(
            f"'{spec.body}' is not flexible",
            "use an applied_load, or make it a flexible bar",
            ("body",),
        )
    beam = at.beams.get(spec.body)
    frame = 0 if spec.frame == "world" else at.body(spec.frame, "frame")
    n = at.axes(frame, direction(spec.direction))
    f = at.function(spec.force_per_length, "force_per_length")
    # stiff for a start: all of it at the centre
    where = {"nodes": 1, "length": bar.length} if beam is None else {}
    body = i if beam is None else beam.first
    own = Own.packed(beam, **where, body=body, frame=frame, function=f, direction=n)
    return Row(*own, reads=spec.force_per_length.sensors)


def acts_on(row):
    """A load in a fixed direction is the same wherever the bar is."""
    own = Own.of(row)
    return frozenset({own.frame, *range(own.body, own.body + own.nodes)} if own.frame else ())


@kernel
def force(t, scene, e):
    V, G, F, Q = scene.V, scene.G, scene.F, scene.Q
    own = Own(scene, e)
    _, p = magnitude_and_load(t, scene, e)  # per length
    if own.nodes == 1:
        i, l = own.body, own.length
        for c in range(3):
            F[i, c] += l * p[c]
            scene.zd[LOADS] += l * p[c] * V[i, c]
    s1, s2, s3, s4 = uniform_shares(own.length)
    for i in range(own.body, own.body + own.nodes - 1):
        for c in range(3):
            F[i, c] += s1 * p[c]
            Q[i, c] += s2 * p[c]
            F[i + 1, c] += s3 * p[c]
            Q[i + 1, c] += s4 * p[c]
            scene.zd[LOADS] += p[c] * (
                s1 * V[i, c] + s2 * G[i, 3 + c] + s3 * V[i + 1, c] + s4 * G[i + 1, 3 + c]
            )


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    f, p = magnitude_and_load(t, scene, e)
    whole = own.length * max(own.nodes - 1, 1)
    scene.out[o] = f
    for c in range(3):
        scene.out[o + 1 + c] = whole * p[c]


def reach(row):
    own = Own.of(row)
    return Reach(forces=((own.frame, own.direction),))


def turning(row):
    return Turning(axes=reach(row).forces)


ELEMENT = Element(
    key="distributed_load",
    section="forces",
    spec=DistributedLoad,
    pack=pack,
    reach=reach,
    acts_on=acts_on,
    channels=(
        Channel("magnitude", "N/m", "force per length along its direction"),
        Channel("load", "N", "total force on the bar, world axes", 3),
    ),
    turning=turning,
    loads={"magnitude": "load"},
    kernels={"force": force, "measure": measure},
    example="""
bodies:
  bar:
    type: ancf_cable
    start: [0, 0]
    end: [1 m, 0]
    section: {diameter: 10 mm}
    youngs_modulus: 207 GPa
    density: 7850 kg/m^3
joints:
  clamp: {type: fixed, bodies: [ground, bar], at: [0, 0]}
forces:
  wind: {type: distributed_load, body: bar, direction: [0, -1, 0], force_per_length: 20}
solver: {end: 10 ms, tolerance: 1e-4}
""",
)
