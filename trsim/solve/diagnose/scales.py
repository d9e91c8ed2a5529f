"""Stiffness and time scales of a start: what an explicit method will meet, before it meets it.

    motion    eigenvalues of the linearised motion, contacts as they are at the start
    contact   k = n K d^(n-1),  1/m = g Z Z^T g^T,  half a period pi sqrt(m / k)
    impact    time from touch to separation at the slowest impact        laws/contact.py
    friction  ramp of modified Coulomb friction: mu F / (v1 - v0) / m_t, 1/s
              in joints: rub_scales.py

g is the gradient of the gap against the twists, Z the free motions: m is the mass a contact really
moves, with all joints and drives in force.  d is the penetration expected at the forces of the
start, or at the slowest impact where that is more.  An explicit step h is stable where h lambda
lies in the method's region; that of rk4 ends at 2.785 on the real axis and at 2.828 on the
imaginary one.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from trsim.assemble.mechanism import Mechanism
from trsim.solve.diagnose.bar_scales import bar_scales
from trsim.solve.diagnose.contact_scales import ContactScale, contact_scales
from trsim.solve.diagnose.linearised import linearised, rounding
from trsim.solve.diagnose.rub_scales import rub_scales
from trsim.solve.methods.rk4 import IMAGINARY, REAL
from trsim.solve.start.consistent import Start

LARGEST = 600  # velocities of a mechanism with flexible bars that is linearised: some seconds


@dataclass(frozen=True)
class Scales:
    """Stiffness and time scales at the start.

    eigenvalues    of the linearised motion, [real, imaginary] in 1/s, largest first, without zeros
    zeros          how many of them are zero
    decay          largest rate at which a motion fades, 1/s; 0 for none
    growth         largest rate at which one grows, 1/s; 0 for none
    frequency      largest, rad/s; 0 for none
    natural_time   slowest period, or the time a motion through the mechanism's size takes, s
    contacts       each contact
    fastest        rate that limits explicit steps, 1/s
    fastest_is     what it is the rate of, in words; "" for nothing
    explicit_step  largest stable step of rk4, s; none where nothing limits it
    """

    eigenvalues: tuple[complex, ...]
    zeros: int
    decay: float
    growth: float
    frequency: float
    natural_time: float
    contacts: tuple[ContactScale, ...]
    fastest: float
    fastest_is: str
    explicit_step: float


def scales(scenario: Any, mechanism: Mechanism, begun: Start) -> Scales:
    """Time scales of a mechanism at its start."""
    if mechanism.beams and mechanism.model.n_v > LARGEST:
        return of_meshes(scenario, mechanism, begun)
    linear = linearised(mechanism, begun)
    natural = float(begun.speed / begun.length)
    every = np.linalg.eigvals(linear.A) if linear.A.size else np.zeros(0)
    least = rounding(every, begun)
    some = sorted((x for x in every.tolist() if abs(x) > least), key=rank)
    contacts = tuple(contact_scales(mechanism, begun, linear))
    swings = [abs(x.imag) for x in some if abs(x.imag) > least]
    limits = list(bounds(some, contacts))
    for value, name in rub_scales(mechanism, begun, linear):
        limits += list(bounds([value], (), f"friction of {name}"))
    step, fastest, words = min(limits, default=(np.inf, 0.0, ""))
    return Scales(
        eigenvalues=tuple(complex(x) for x in some),
        zeros=len(every) - len(some),
        decay=max((-x.real for x in some if -x.real > least), default=0.0),
        growth=max((x.real for x in some if x.real > least), default=0.0),
        frequency=max(swings, default=0.0),
        natural_time=2.0 * pi / min(swings) if swings else 1.0 / natural,
        contacts=contacts,
        fastest=fastest,
        fastest_is=words,
        explicit_step=step,
    )


def of_meshes(scenario: Any, mechanism: Mechanism, begun: Start) -> Scales:
    """What is known without a linearisation, which so many nodes would make slow."""
    step, name = min((bar.explicit_step, bar.name) for bar in bar_scales(scenario, mechanism, ()))
    return Scales(
        eigenvalues=(),
        zeros=0,
        decay=0.0,
        growth=0.0,
        frequency=IMAGINARY / step,
        natural_time=float(begun.length / begun.speed),
        contacts=(),
        fastest=IMAGINARY / step,
        fastest_is=f"the mesh of '{name}'",
        explicit_step=step,
    )


def rank(x: complex) -> tuple[float, float]:
    """Largest first; of a pair the one above the real axis."""
    return -abs(x), -x.imag


def bounds(
    some: list[complex],
    contacts: tuple[ContactScale, ...],
    words: str = "the linearised motion at the start",
) -> Iterator[tuple[float, float, str]]:
    """Stable step, rate and name of everything that limits an explicit method."""
    for x in some:
        if x.real <= abs(x.imag):  # what only grows limits the error, not the stability
            end = REAL if -x.real > abs(x.imag) else IMAGINARY
            yield end / abs(x), abs(x), words
    for contact in contacts:
        omega = pi / contact.half_period
        if omega > 0.0:
            yield IMAGINARY / omega, omega, f"{contact.name} in contact"
        if contact.friction_rate > 0.0:
            rate = contact.friction_rate
            yield REAL / rate, rate, f"friction of {contact.name}"
