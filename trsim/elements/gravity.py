"""Gravity: a uniform field.

F = m g at the centre of mass,     E = -m g . r
"""

from trsim.elements.contract import GRAVITY, Element, Memory, Reach, Row, kernel
from trsim.elements.frames import dot
from trsim.fields import Spec
from trsim.kernels.columns import V3, i8


class Gravity(Spec):
    """Created from the key `gravity` of a scenario, one instance for each body with mass.

    body   the body
    field  acceleration of a free fall
    """

    body: str
    field: tuple[float, float, float]


def of_scenario(scenario, bodies):
    """One for each body with mass where there is gravity; flexible bars have their own."""
    if any(scenario.gravity):
        for name, spec in bodies.items():
            if spec.flexible is None and spec.mass > 0.0:
                yield name, Gravity(body=name, field=scenario.gravity)


class Own(Memory):
    """Of one instance."""

    body: i8
    weight: V3  # N


def pack(name, spec, at):
    i = at.body(spec.body)
    return Row(*Own.packed(body=i, weight=[at.mass(i) * c for c in spec.field]))


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    for c in range(3):
        scene.F[own.body, c] += own.weight[c]


@kernel
def energy(t, scene, e):
    X, E = scene.X, scene.E
    own = Own(scene, e)
    E[GRAVITY] -= dot(own.weight, (X[own.body, 0], X[own.body, 1], X[own.body, 2]))


def reach(row):
    return Reach(forces=((0, Own.of(row).weight),))


ELEMENT = Element(
    key="gravity",
    section="",
    spec=Gravity,
    pack=pack,
    of_scenario=of_scenario,
    reach=reach,
    kernels={"force": force, "energy": energy},
    example="""
bodies:
  ball: {mass: 2 kg, inertia: 8e-4 kg*m^2}
gravity: [0, -9.81, 0]
solver: {end: 0.4 s}
""",
)
