"""ANCF cable: a bar that stretches and bends, in elements of cubic position r(x).

    M e'' = F - dU/de - damping,     U = 1/2 int EA eps^2 + EI kappa^2 dx        laws/cable.py

A gradient-deficient element of the absolute nodal coordinate formulation: the coordinates of a node
are its position r and its slope dr/dx.  M is constant, and rotations of any size need no angles
[BerzeriShabana2000].  In a planar scene the element has 8 coordinates instead of 12.  It has no
torsion, no shear and no rotary inertia.

Its nodes are frames (assemble/beams.py); joints, loads and contacts act on them.  The axes of the
body are those of its chord, from the first node to the last.
"""

from math import sqrt
from typing import ClassVar

from pydantic import model_validator

from trsim.elements.cable import Cable
from trsim.elements.contract import (
    DAMPERS,
    GRAVITY,
    SPRINGS,
    Channel,
    Element,
    Memory,
    Row,
    kernel,
    measured,
)
from trsim.elements.frames import cross, dot
from trsim.elements.rigid_body import RigidBody
from trsim.errors import ScenarioError
from trsim.fields import point, vector
from trsim.kernels.columns import V3, f8, i8
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear_table
from trsim.laws.cable import CURVATURES, add_force, energies
from trsim.laws.cable_section import position, stress, uniform_shares
from trsim.laws.cable_stretch import STRAINS, STRETCHINGS
from trsim.laws.cable_tangent import add_damping, add_stiffness

SLENDER = 1e-6  # of its inertia across: what a bar without width has about its own line


class AncfCable(Cable):
    """A flexible bar, straight as drawn.

    start             position of its first node, as drawn
    end               position of its last node, as drawn
    velocity          velocity of its centre at the start
    angular_velocity  angular velocity at the start, as of a rigid bar
    """

    type: ClassVar[str] = "ancf_cable"
    start: point("m")
    end: point("m")
    velocity: vector("m/s") = (0.0, 0.0, 0.0)
    angular_velocity: vector("rad/s") = (0.0, 0.0, 0.0)

    @model_validator(mode="after")
    def a_length(self):
        if self.start == self.end:
            raise ScenarioError("a bar has a length", "let start and end differ", ("end",))
        if self.density is None and self.mass is None:
            hint = "for example `density: 7850 kg/m^3`; `mass` is that of the whole bar"
            raise ScenarioError("give a `density` or a `mass`", hint)
        return self

    @property
    def length(self) -> float:
        return sqrt(sum((b - a) ** 2 for a, b in zip(self.start, self.end, strict=True)))

    @property
    def per_length(self) -> float:
        """rho A, kg/m."""
        if self.mass is not None:
            return self.mass / self.length
        assert self.density is not None  # noqa: S101
        return self.density * self.numbers[0]

    @property
    def flexible(self):
        return self

    @property
    def whole_mass(self):
        return self.per_length * self.length

    @property
    def tangent(self):
        """Unit vector from start to end."""
        return tuple((b - a) / self.length for a, b in zip(self.start, self.end, strict=True))

    @property
    def origin(self):
        """Where its mass, centre and inertia come from."""
        return "of its section"

    def bar(self, start, end):
        return self

    def as_rigid(self):
        """A rigid body of the same mass, slender; its axes are the world's."""
        t, across = self.tangent, self.per_length * self.length**3 / 12.0

        def of(a, b):
            """An entry of the tensor of inertia."""
            return across * ((1.0 + SLENDER) * (a == b) - t[a] * t[b])

        return RigidBody(
            mass=self.whole_mass,
            inertia=(of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2)),
            at=tuple(0.5 * (a + b) for a, b in zip(self.start, self.end, strict=True)),
            velocity=self.velocity,
            angular_velocity=self.angular_velocity,
        )


class Own(Memory):
    """Of one instance."""

    first: i8  # node
    nodes: i8
    strain: i8  # one of STRAINS, and so on
    curvature: i8
    stretching: i8
    element: i8  # its first, among those of all bars
    length: f8  # m, of an element
    EA: f8  # N
    EI: f8  # N*m^2
    beta: f8  # s, of its damping
    mass: f8  # kg/m
    field: V3  # m/s^2


BAR, AT_NODE = 18, 5  # columns of a bar, and of each of its nodes
E_NOW, E_RATE, E_FORCE, ROOM = 0, 1, 2, 3  # rows of scene.element


def pack(name, spec, at):
    beam = at.beams[name]
    area, moment, _ = spec.numbers
    E = spec.youngs_modulus
    own = Own.packed(
        beam, strain=STRAINS[spec.strain], curvature=CURVATURES[spec.curvature],
        stretching=STRETCHINGS[spec.stretching], EA=E * area, EI=E * moment, beta=spec.damping,
        mass=spec.per_length, field=at.scenario.gravity,
    )  # fmt: skip
    return Row(*own, channels=channels(beam.nodes))


def own_nodes(row):
    """The frames of its nodes."""
    own = Own.of(row)
    return frozenset(range(own.first, own.first + own.nodes))


def channels(nodes):
    """What a beam of so many nodes records."""
    return (
        Channel("position", "m", "centre of mass, world axes", 3),
        Channel("velocity", "m/s", "of the centre of mass, world axes", 3),
        Channel("angular_velocity", "rad/s", "of the chord between its ends, world axes", 3),
        Channel("tip", "m", "position of the last node, world axes", 3),
        Channel("middle", "m", "position halfway along the bar, world axes", 3),
        Channel("deflection", "m", "largest distance of a node from the chord between the ends"),
        Channel("strain_energy", "J", "energy stored in stretching and bending"),
        Channel("stretching_energy", "J", "the part stored in stretching"),
        *(channel for k in range(nodes) for channel in at_node(k)),
    )


def at_node(k):
    """What is recorded at every node; forces where two elements meet are their mean."""
    return (
        Channel(f"node{k}.position", "m", "position of the node, world axes", 3),
        Channel(f"node{k}.axial_force", "N", "axial force; tension is positive"),
        Channel(f"node{k}.bending_moment", "N*m", "magnitude"),
    )


@internal
def gathered(scene, i):
    """Coordinates and rates of the element between nodes i and i + 1, into scene.element."""
    X, V, G, element = scene.X, scene.V, scene.G, scene.element
    for n in range(2):
        for c in range(3):
            element[E_NOW, 6 * n + c] = X[i + n, c]
            element[E_NOW, 6 * n + 3 + c] = G[i + n, c]
            element[E_RATE, 6 * n + c] = V[i + n, c]
            element[E_RATE, 6 * n + 3 + c] = G[i + n, 3 + c]
            element[E_FORCE, 6 * n + c] = 0.0
            element[E_FORCE, 6 * n + 3 + c] = 0.0


@kernel
def force(t, scene, e):
    F, Q, element = scene.F, scene.Q, scene.element
    own = Own(scene, e)
    for i in range(own.first, own.first + own.nodes - 1):
        gathered(scene, i)
        add_force(element[E_NOW], element[E_RATE], own, own.beta, element[E_FORCE])
        s1, s2, s3, s4 = uniform_shares(own.length)
        for c in range(3):
            weight = own.mass * own.field[c]
            F[i, c] += element[E_FORCE, c] + s1 * weight
            Q[i, c] += element[E_FORCE, 3 + c] + s2 * weight
            F[i + 1, c] += element[E_FORCE, 6 + c] + s3 * weight
            Q[i + 1, c] += element[E_FORCE, 9 + c] + s4 * weight
        if own.beta > 0.0:
            scene.zd[DAMPERS] += damping_power(element, own)


@internal
def damping_power(element, own):
    """Power of the damping forces of the element last gathered, W; never positive."""
    power = 0.0
    for k in range(12):
        power += element[E_FORCE, k] * element[E_RATE, k]
        element[E_FORCE, k] = 0.0
    add_force(element[E_NOW], element[E_RATE], own, 0.0, element[E_FORCE])
    for k in range(12):
        power -= element[E_FORCE, k] * element[E_RATE, k]
    return power


@kernel
def stiffness(t, scene, e):
    element = scene.element
    own = Own(scene, e)
    for k in range(own.nodes - 1):
        gathered(scene, own.first + k)
        row = 12 * (own.element + k)
        K, C = scene.tangent[row : row + 12], scene.viscous[row : row + 12]
        clear_table(K)
        add_stiffness(element[E_NOW], own, element[ROOM:], K)
        if own.beta > 0.0:
            clear_table(C)
            add_damping(element[E_NOW], own, element[ROOM:], C)


@kernel
def energy(t, scene, e):
    E, x = scene.E, scene.element[E_NOW]
    own = Own(scene, e)
    for i in range(own.first, own.first + own.nodes - 1):
        gathered(scene, i)
        stretching, bending = energies(x, own)
        E[SPRINGS] += stretching + bending
        for c in range(3):
            E[GRAVITY] -= own.mass * own.field[c] * moment(x, own.length, c)


@internal
def moment(x, l, c):
    """int x_c dx over an element: its length times the place of its centre."""
    s1, s2, s3, s4 = uniform_shares(l)
    return s1 * x[c] + s2 * x[3 + c] + s3 * x[6 + c] + s4 * x[9 + c]


@measured
def measure(t, scene, e, o):
    X, V, out, element = scene.X, scene.V, scene.out, scene.element
    own = Own(scene, e)
    first, nodes, l = own.first, own.nodes, own.length
    last = first + nodes - 1
    whole = l * (nodes - 1)
    for k in range(BAR + AT_NODE * nodes):
        out[o + k] = 0.0
    for i in range(first, last):
        gathered(scene, i)
        x, v = element[E_NOW], element[E_RATE]
        for c in range(3):
            out[o + c] += moment(x, l, c) / whole
            out[o + 3 + c] += moment(v, l, c) / whole
        stretching, bending = energies(x, own)
        out[o + 16] += stretching + bending
        out[o + 17] += stretching
        for n in range(2):
            N, M = stress(x, own, float(n))
            # a node between two elements has the mean of both
            share = 1.0 if i + n == first or i + n == last else 0.5
            place = o + BAR + AT_NODE * (i + n - first)
            out[place + 3] += share * N
            out[place + 4] += share * M
        if 2 * (i - first) in (nodes - 1, nodes - 2):
            middle = position(x, l, 0.5 * (nodes - 1) - (i - first))
            for c in range(3):
                out[o + 12 + c] = middle[c]
    chord_spin(X, V, first, last, out, o + 6)
    for c in range(3):
        out[o + 9 + c] = X[last, c]
    out[o + 15] = deflection(X, first, last)
    for k in range(nodes):
        for c in range(3):
            out[o + BAR + AT_NODE * k + c] = X[first + k, c]


@internal
def chord_spin(X, V, first, last, out, o):
    """Angular velocity of the line from one frame to another, without spin about it."""
    d = (X[last, 0] - X[first, 0], X[last, 1] - X[first, 1], X[last, 2] - X[first, 2])
    w = (V[last, 0] - V[first, 0], V[last, 1] - V[first, 1], V[last, 2] - V[first, 2])
    n, square = cross(d, w), dot(d, d)
    for c in range(3):
        out[o + c] = n[c] / square if square > 0.0 else 0.0


@internal
def deflection(X, first, last):
    """Largest distance of a frame between two from the line through them, m."""
    d = (X[last, 0] - X[first, 0], X[last, 1] - X[first, 1], X[last, 2] - X[first, 2])
    square, most = dot(d, d), 0.0
    for i in range(first + 1, last):
        n = cross(d, (X[i, 0] - X[first, 0], X[i, 1] - X[first, 1], X[i, 2] - X[first, 2]))
        most = max(most, dot(n, n) / square if square > 0.0 else 0.0)
    return sqrt(most)


ELEMENT = Element(
    key="ancf_cable",
    section="bodies",
    spec=AncfCable,
    pack=pack,
    channels=channels(5),
    acts_on=own_nodes,
    elastic=tuple(Own.columns[name].at for name in ("EA", "EI")),
    viscous=(Own.columns["beta"].at,),
    kernels={"force": force, "stiffness": stiffness, "energy": energy, "measure": measure},
    example="""
bodies:
  rope:
    type: ancf_cable
    start: [0, 0]
    end: [1 m, 0]
    section: {diameter: 5 mm}
    youngs_modulus: 1.6 MPa
    density: 320 kg/m^3
joints:
  pin: {type: revolute, bodies: [ground, rope], at: [0, 0]}
gravity: [0, -9.81, 0]
solver: {end: 0.1 s, tolerance: 1e-4}
""",
)
