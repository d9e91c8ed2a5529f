"""Energy sensor: kinetic or stored energy of the whole mechanism, or their sum.

    kinetic    sum of m v^2 / 2 + omega . I omega / 2
    stored     in springs, contacts and gravity; its zero is that of `energy.stored`     contract.py

The energy balance has the same numbers (`energy.kinetic`, `energy.stored.springs` and so on); as a
sensor they have a name that formulas can use.
"""

from typing import ClassVar, Literal

from trsim.elements.contract import (
    CONTACTS,
    GRAVITY,
    SPRINGS,
    Channel,
    Element,
    Pair,
    Row,
    call_kernel,
    measured,
)
from trsim.elements.frames import dot, inside, spin, times
from trsim.elements.shown import on_pendulum
from trsim.errors import ScenarioError
from trsim.fields import Spec
from trsim.kernels.columns import f8
from trsim.kernels.lazy import internal


class Energy(Spec):
    """An energy of the mechanism.

    of  `total`, `kinetic` or `stored`
    """

    type: ClassVar[str] = "energy"
    of: Literal["total", "kinetic", "stored"] = "total"


class Own(Pair):
    """Of one instance."""

    moves: f8  # 1: kinetic energy counts
    stores: f8  # 1: stored energy counts


def pack(name, spec, at):
    if spec.of != "stored" and at.beams:
        raise ScenarioError(
            f"the {spec.of} energy of flexible bars is told by the energy book alone",
            "record or watch `energy.kinetic` and `energy.stored.springs`",
            ("of",),
        )
    counts = {"moves": spec.of != "stored", "stores": spec.of != "kinetic"}
    return Row(*Own.packed(i=0, j=0, coordinate=at.sensor(name), **counts))


@internal
def kinetic(scene):
    """Of all rigid bodies, J."""
    T = 0.0
    for f in range(1, scene.n_r):
        T += moving(scene, f, scene.mass[f], scene.inertia[f])
    for q in range(scene.light.shape[0]):  # these are solved with more than they have
        E = scene.lacking[q]
        T -= moving(scene, scene.light[q], E[0], E[1:])
    return T


@internal
def moving(scene, f, mass, I):
    """Kinetic energy of a mass and an inertia (9) that move with a frame, J."""
    V = scene.V
    v = (V[f, 0], V[f, 1], V[f, 2])
    T = 0.5 * mass * dot(v, v)
    if scene.d == 3:
        return T + 0.5 * I[8] * V[f, 5] * V[f, 5]
    o = inside(scene.X, f, spin(V, f))
    return T + 0.5 * dot(o, times(I, o))


@internal
def stored(t, scene):
    """In all elements, J; the energy book makes E anew."""
    E = scene.E
    E[SPRINGS], E[CONTACTS], E[GRAVITY] = 0.0, 0.0, 0.0
    for n in range(scene.energy.shape[0]):
        call_kernel(scene.energy[n, 0], t, scene, scene.energy[n, 1], scene.energy[n, 2])
    return E[SPRINGS] + E[CONTACTS] + E[GRAVITY]


@measured
def measure(t, scene, e, o):
    own, energy = Own(scene, e), 0.0
    if own.moves == 1.0:
        energy += kinetic(scene)
    if own.stores == 1.0:
        energy += stored(t, scene)
    scene.out[o] = scene.S[own.coordinate, 0] = energy  # in S for formulas


ELEMENT = Element(
    key="energy",
    section="sensors",
    spec=Energy,
    pack=pack,
    acts_on=lambda _: frozenset(),
    channels=(Channel("", "J", "energy of the mechanism"),),
    kernels={"measure": measure},
    example=on_pendulum("whole: {type: energy}"),
)
