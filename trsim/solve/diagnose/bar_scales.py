"""What a flexible bar adds to a mechanism: compliance, its slowest and its fastest motion.

    L/(EA)            axial compliance
    L^3/(48 EI)       in the middle, across, held at both ends by hinges
    L^3/(3 EI)        at the end, as a cantilever
    pi/2 sqrt(EI/(rho A L^4))      its lowest bending frequency between hinges, Hz
    L sqrt(rho A/EA)               time of an axial wave from end to end

The fastest motion is one of the mesh: the largest eigenvalue of its stiffness against its mass,
free at both ends, along and across.  No joint and no body that is added makes it faster; a load
does.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.laws.cable_section import mass
from trsim.solve.diagnose.contact_scales import ContactScale
from trsim.solve.methods.rk4 import IMAGINARY

Array = NDArray[np.float64]

# a cubic element of length 1: mass, stretching (of N' N'), bending (of N'' N'')
MASS = np.array(mass.python(1.0, 1.0))
ALONG = np.array([[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]]) / 30
ACROSS = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
ENOUGH = 16  # elements: more do not change the largest eigenvalue of their row by 0.1 %


@dataclass(frozen=True)
class BarScale:
    """What a flexible bar gives way, and its slowest and fastest motion.

    name            of the body
    elements        how many
    length          m
    mass            kg
    axial           compliance along it, L/EA, m/N
    bending         across, in the middle between hinges at its ends, L^3/(48 EI), m/N
    cantilever      across, at the end of a cantilever, L^3/(3 EI), m/N
    lowest          bending frequency between hinges, Hz
    wave            time an axial wave takes from end to end, s
    highest         largest frequency of its mesh, Hz
    explicit_step   largest step of rk4 that is stable for it, s
    contact_shares  joint with clearance -> its compliance at the load of the start, as a part of
                    that of contact and bar in line
    """

    name: str
    elements: int
    length: float
    mass: float
    axial: float
    bending: float
    cantilever: float
    lowest: float
    wave: float
    highest: float
    explicit_step: float
    contact_shares: dict[str, float]


def bar_scales(
    scenario: Any, mechanism: Mechanism, contacts: Iterable[ContactScale]
) -> tuple[BarScale, ...]:
    """Every flexible bar, with the contacts at the loads of the start."""
    found = []
    stiffness = {contact.name: contact.stiffness for contact in contacts}
    for name, beam in mechanism.beams.items():
        EI, L, per_length = beam.bending, beam.whole, beam.per_length
        axial = L / beam.stiffness
        highest = largest(beam.stiffness, EI, per_length, beam.length, beam.nodes - 1)
        shares = {
            joint: (1.0 / stiffness[joint]) / (1.0 / stiffness[joint] + axial)
            for joint, spec in scenario.joints.items()
            if joint in stiffness and name in spec.bodies
        }
        found.append(
            BarScale(
                name=name,
                elements=beam.nodes - 1,
                length=L,
                mass=per_length * L,
                axial=axial,
                bending=L**3 / (48.0 * EI),
                cantilever=L**3 / (3.0 * EI),
                lowest=0.5 * pi * sqrt(EI / per_length) / L**2,
                wave=L * sqrt(per_length / beam.stiffness),
                highest=highest / (2.0 * pi),
                explicit_step=IMAGINARY / highest,
                contact_shares=shares,
            )
        )
    return tuple(found)


def largest(EA: float, EI: float, per_length: float, l: float, elements: int) -> float:
    """Largest frequency of so many elements of length l, free at both ends, rad/s."""
    n = min(elements, ENOUGH)
    along = EA / (per_length * l**2) * fastest(ALONG, n)
    across = EI / (per_length * l**4) * fastest(ACROSS, n)
    return sqrt(max(along, across))


def fastest(stiffness: Array, n: int) -> float:
    """Largest eigenvalue of n elements of length and stiffness 1."""
    back = np.linalg.inv(np.linalg.cholesky(row(MASS, n)))
    return float(np.linalg.eigvalsh(back @ row(stiffness, n) @ back.T)[-1])


def row(element: Array, n: int) -> Array:
    """n elements put together, (2 n + 2, 2 n + 2)."""
    whole = np.zeros((2 * n + 2, 2 * n + 2))
    for k in range(n):
        whole[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += element
    return whole
