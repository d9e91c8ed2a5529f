"""Gravity: a uniform field.

F = m g at the centre of mass,     E = -m g . r
"""

from trsim.elements.contract import GRAVITY, Element, Reach, Row, kernel
from trsim.fields import Spec


class Gravity(Spec):
    """Made from the key `gravity` of a scenario, one instance per body with mass.

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


def pack(name, spec, at):
    i = at.body(spec.body)
    return Row((i,), tuple(at.mass(i) * c for c in spec.field))


@kernel
def force(t, scene, a, b):
    con, par, F = scene.con, scene.par, scene.F
    for e in range(a, b):
        i = con[e, 0]
        F[i, 0] += par[e, 0]
        F[i, 1] += par[e, 1]
        F[i, 2] += par[e, 2]


@kernel
def energy(t, scene, a, b):
    X, con, par, E = scene.X, scene.con, scene.par, scene.E
    for e in range(a, b):
        i = con[e, 0]
        E[GRAVITY] -= par[e, 0] * X[i, 0] + par[e, 1] * X[i, 1] + par[e, 2] * X[i, 2]


def reach(row):
    return Reach(forces=((0, row.par),))


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
