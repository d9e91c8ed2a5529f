"""Distributed load: a force per undeformed length along a whole flexible bar.

    F_i = int S_i(x) dx  f(t, sensors) R_f n        S_i: shapes of an element, laws/cable_section.py

f is a number, an expression or an Akima table of t or a sensor.  Frame: world (a fixed direction)
or a body (a direction that turns with it).
"""

from typing import ClassVar

from pydantic import model_validator

from trsim.elements.contract import LOADS, Channel, Element, Reach, Row, Turning, kernel
from trsim.elements.frames import arm, helper
from trsim.errors import ScenarioError
from trsim.fields import Function, Spec, direction, vector
from trsim.laws.cable_section import uniform_shares
from trsim.laws.functions import value


class DistributedLoad(Spec):
    """A uniform force per length along a flexible bar.

    body              the flexible bar
    frame             `world`, or a body with which the direction turns
    direction         of the force, as drawn; of any length
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


FIRST, NODES, FRAME, FUNCTION = 0, 1, 2, 3  # con
LENGTH, DIRECTION = 0, 1  # par


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
    reads = spec.force_per_length.sensors
    if beam is None:  # stiff for a start: all of it at the centre
        return Row((i, 1, frame, f), (bar.length, *n), reads=reads)
    return Row((beam.first, beam.nodes, frame, f), (beam.length, *n), reads=reads)


def acts_on(row):
    """A load in a fixed direction is the same wherever the bar is."""
    first, nodes, frame, _ = row.con
    return frozenset({frame, *range(first, first + nodes)} if frame else ())


@helper
def load(t, scene, e):
    """Force per length, world axes."""
    par = scene.par
    f = value(scene.tab, scene.con[e, FUNCTION], t, scene.S)
    n = arm(scene.X, scene.con[e, FRAME], par[e, 1], par[e, 2], par[e, 3])
    return f, (f * n[0], f * n[1], f * n[2])


@kernel
def force(t, scene, a, b):
    V, G, F, Q, con = scene.V, scene.G, scene.F, scene.Q, scene.con
    for e in range(a, b):
        _, p = load(t, scene, e)
        if con[e, NODES] == 1:
            i, l = con[e, FIRST], scene.par[e, LENGTH]
            for c in range(3):
                F[i, c] += l * p[c]
                scene.zd[LOADS] += l * p[c] * V[i, c]
        s1, s2, s3, s4 = uniform_shares(scene.par[e, LENGTH])
        for i in range(con[e, FIRST], con[e, FIRST] + con[e, NODES] - 1):
            for c in range(3):
                F[i, c] += s1 * p[c]
                Q[i, c] += s2 * p[c]
                F[i + 1, c] += s3 * p[c]
                Q[i + 1, c] += s4 * p[c]
                scene.zd[LOADS] += p[c] * (
                    s1 * V[i, c] + s2 * G[i, 3 + c] + s3 * V[i + 1, c] + s4 * G[i + 1, 3 + c]
                )


@kernel
def measure(t, scene, a, b):
    out, wanted = scene.out, scene.wanted
    for e in range(a, b):
        if wanted[e] < 0:
            continue
        f, p = load(t, scene, e)
        whole = scene.par[e, LENGTH] * max(scene.con[e, NODES] - 1, 1)
        out[wanted[e]] = f
        for c in range(3):
            out[wanted[e] + 1 + c] = whole * p[c]


def reach(row):
    return Reach(forces=((row.con[FRAME], row.par[DIRECTION : DIRECTION + 3]),))


ELEMENT = Element(
    key="distributed_load",
    section="forces",
    spec=DistributedLoad,
    pack=pack,
    reach=reach,
    acts_on=acts_on,
    channels=(
        Channel("magnitude", "N/m", "force per length along its direction"),
        Channel("load", "N", "of the whole bar, world axes", 3),
    ),
    turning=lambda row: Turning(axes=((row.con[FRAME], row.par[DIRECTION : DIRECTION + 3]),)),
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
