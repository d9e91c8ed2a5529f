"""Flexible bars whose numbers read well but are probably not meant.

moduli, densities   those of no solid
slenderness         L/h below 8: shear, left out, adds 3 (h/L)^2 to the deflection
elements            one; shorter than thick; more than anybody needs; longer than twice the length
                    (EI/(rho A g))^(1/3) over which a bar bends under its own weight
locking             `stretching: full` and EA l^2/EI of an element above 100: it resists bending
"""

from collections.abc import Iterator
from contextlib import suppress
from math import ceil, dist, hypot, pi, sqrt
from typing import Any, NamedTuple

from trsim.elements.cable import MOST_ELEMENTS
from trsim.elements.joint import place_on
from trsim.errors import ScenarioError
from trsim.scenario import plausible

SOFTEST = 1e4  # Pa: foam, gel
STUBBY = 8.0  # length over thickness
SHEAR = 3.12  # 12 E I/(5/6 G A L^2) is this times (h/L)^2 at E/G = 2.6
MANY = 100  # elements
LOCKS = 100.0  # EA l^2/EI of an element with all of its stretch: elastica are twice as wrong
LIMP = 2.0  # length of an element over that of bending under its own weight
DIFFERENT = 0.1  # mass or inertia of a bar against what its rigid body says


class Bar(NamedTuple):
    """A flexible bar: where its words stand, and as it is solved."""

    name: str
    where: str
    spec: Any

    @property
    def length(self) -> float:
        return float(self.spec.length)


def ends(scenario: Any, name: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """The two joints of a body that lie farthest apart; twice the same where there are no two."""
    places = [place_on(j, name) for j in scenario.joints.values() if name in j.bodies]
    known = [place for place in places if place is not None]
    pairs = [(a, b) for a in known for b in known]
    return max(pairs, key=lambda pair: dist(*pair), default=((), ()))


def bars(scenario: Any) -> Iterator[Bar]:
    """All flexible bars; what makes none is refused elsewhere."""
    for name, body in scenario.bodies.items():
        if body.flexible is None:
            continue
        with suppress(ScenarioError):
            bar = body.bar(*ends(scenario, name))
            yield Bar(name, f"bodies.{name}" + (".flexible" if bar is not body else ""), bar)


def slender(scenario: Any) -> Iterator[str]:
    """What looks wrong in flexible bars."""
    for bar in bars(scenario):
        yield from _material(bar)
        yield from _shape(bar)
        yield from _elements(bar, hypot(*scenario.gravity))
        yield from _clearances(scenario, bar)
        yield from _rigid_numbers(scenario, bar)


def _material(bar: Bar) -> Iterator[str]:
    E, area = bar.spec.youngs_modulus, bar.spec.numbers[0]
    if not SOFTEST <= E <= plausible.HARDEST:
        yield (
            f"{bar.where}.youngs_modulus: {E:.3g} Pa; solids have 10 kPa (foam) to 1 TPa "
            f"(diamond), steel 2.1e+11 Pa: {plausible.prefix(E)}"
        )
    density = bar.spec.per_length / area
    if not plausible.LIGHTEST <= density <= plausible.HEAVIEST:
        yield (
            f"{bar.where}: {density * area * bar.length:.3g} kg on {bar.length:.3g} m of "
            f"{1e6 * area:.3g} mm^2 are {density:.3g} kg/m^3; steel has 7850: check mass, density "
            "and section"
        )
    omega = pi**2 * sqrt(E * bar.spec.numbers[1] / bar.spec.per_length) / bar.length**2
    if bar.spec.damping * omega > 2.0:
        yield (
            f"{bar.where}.damping: {bar.spec.damping:.3g} s is {bar.spec.damping * omega / 2:.3g} "
            f"times critical for its slowest bending ({omega / (2 * pi):.3g} Hz); steel has 1e-7 "
            "to 1e-5 s"
        )


def _shape(bar: Bar) -> Iterator[str]:
    ratio = bar.length / bar.spec.thickness
    if ratio < 1.0:
        yield (
            f"{bar.where}: thicker ({1e3 * bar.spec.thickness:.3g} mm) than long "
            f"({1e3 * bar.length:.3g} mm); check the units of the section"
        )
    elif ratio < STUBBY:
        yield (
            f"{bar.where}: only {ratio:.2g} times as long as thick; shear, which is left out, "
            f"would add about {SHEAR / ratio**2:.0%} to its bending, so it is too stiff"
        )


def _elements(bar: Bar, gravity: float) -> Iterator[str]:
    n, where = bar.spec.elements, f"{bar.where}.elements"
    area, moment, _ = bar.spec.numbers
    ratio = bar.length / bar.spec.thickness
    bends = 0.0
    if gravity > 0.0:
        bends = (bar.spec.youngs_modulus * moment / (bar.spec.per_length * gravity)) ** (1.0 / 3.0)
    wanted = ceil(bar.length / bends) if bends > 0.0 else 1
    if n == 1:
        yield (
            f"{where}: one element bends as one cubic: held at both ends its middle sinks 20 % too "
            "little under its own weight and its lowest frequency is 11 % too high; take 2 or more"
        )
    if n > max(ratio, 1.0) and n > 1 and ratio >= 1.0:
        yield (
            f"{where}: {n} elements are shorter ({1e3 * bar.length / n:.3g} mm) than thick "
            f"({1e3 * bar.spec.thickness:.3g} mm), where no beam has a meaning; take "
            f"{max(int(ratio / 2.0), 1)}"
        )
    elif n > MANY:
        yield (
            f"{where}: {n}; errors fall with the fourth power, so that 8 to 32 are enough for most "
            "bars, while the fastest motion rises with it and makes explicit steps short"
        )
    if 0.0 < LIMP * bends < bar.length / n:
        yield (
            f"{where}: an element is {bar.length / n:.3g} m long, but under its own weight the bar "
            f"bends within {bends:.2g} m (EI/(rho A g))^(1/3): "
            + (f"take {wanted} or more" if wanted <= MOST_ELEMENTS else "check section and modulus")
        )
    elif bar.spec.stretching == "full" and area * (bar.length / n) ** 2 / moment > LOCKS:
        yield (
            f"{bar.where}.stretching: `full` locks: an element with EA l^2/EI = "
            f"{area * (bar.length / n) ** 2 / moment:.1e} cannot bend far without being stretched, "
            "and large deflections come out 1 % to 10 % too small with few elements; `assumed`, "
            "the default, does not"
        )


def _clearances(scenario: Any, bar: Bar) -> Iterator[str]:
    for name, joint in scenario.joints.items():
        c = getattr(joint, "clearance", 0.0)
        if bar.name in joint.bodies and c > bar.length:
            yield (
                f"joints.{name}: the clearance, {1e3 * c:.3g} mm, is larger than '{bar.name}' is "
                f"long ({1e3 * bar.length:.3g} mm): check the units (it is radial)"
            )


def _rigid_numbers(scenario: Any, bar: Bar) -> Iterator[str]:
    """The mass and inertia of a rigid body that its bar does not have."""
    body = scenario.bodies[bar.name]
    if body is bar.spec or body.mass == 0.0:
        return
    mass = bar.spec.whole_mass
    if abs(mass / body.mass - 1.0) > DIFFERENT:
        yield (
            f"{bar.where}: the bar has {mass:.3g} kg where `mass` says {body.mass:.3g} kg; the "
            "bar's counts: correct section or density, or fix a rigid body with the rest to it"
        )
        return
    even = mass * bar.length**2 / 12.0
    if not body.tensor[1] and abs(body.inertia / even - 1.0) > DIFFERENT:
        yield (
            f"{bar.where}: an even bar has an inertia of {even:.3g} kg*m^2 where `inertia` says "
            f"{body.inertia:.3g} kg*m^2; the bar's counts"
        )
