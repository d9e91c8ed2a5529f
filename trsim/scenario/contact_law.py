"""A contact law as the user writes it: an entry of `contact_laws`, named by joints and contacts.

stiffness: internal    Hertz, journal in bearing    K = 4/(3 (s_i + s_j)) sqrt(R_i R_j/(R_i - R_j))
           paper       the same with R_i + R_j
           cylinder    line contact over `width`
           a number    K in N/m^1.5                 s = (1 - nu^2)/E
"""

from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Gt, Interval
from pydantic import model_validator

from trsim.elements.friction_law import Friction
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.laws.contact import cylinder_stiffness, damping_factor, hertz_stiffness

Modulus = Annotated[float, Gt(0), Unit("Pa")]
Poisson = Annotated[float, Interval(gt=-1, le=0.5), Unit("-")]
Length = Annotated[float, Gt(0), Unit("m")]
Speed = Annotated[float, Gt(0), Unit("m/s")]

# what a word cannot do without
STIFFNESS_NEEDS = {
    "internal": ("bearing_radius", "youngs_modulus", "poisson"),
    "paper": ("bearing_radius", "youngs_modulus", "poisson"),
    "cylinder": ("bearing_radius", "width", "youngs_modulus", "poisson"),
}


def _needs(spec: Any, what: str, keys: tuple[str, ...]) -> None:
    missing = [key for key in keys if getattr(spec, key) is None]
    if missing:
        raise ScenarioError(f"{what} needs {', '.join(missing)}")


class ContactLaw(Spec):
    """The law of a contact between two bodies of given material and size.

    normal                  how force depends on penetration and its rate
    stiffness               a word that computes it from size and material, or the number
    exponent                of the penetration
    bearing_radius          radius of the bearing, and lever of the friction
    width                   length of a line contact
    youngs_modulus          of the bearing, and of the journal unless given
    poisson                 Poisson's ratio of the bearing, and of the journal unless given
    journal_youngs_modulus  of the journal
    journal_poisson         Poisson's ratio of the journal
    restitution             speed after an impact over speed before
    slowest_impact          floor of the remembered impact speed
    friction                along the surfaces
    """

    type: ClassVar[str] = "contact_law"
    normal: Literal["lankarani_nikravesh", "hunt_crossley", "flores", "identified"]
    stiffness: Annotated[
        Literal["internal", "paper", "cylinder"] | Annotated[float, Gt(0)], Unit("N/m^1.5")
    ] = "internal"
    exponent: Annotated[float, Interval(ge=1, le=3), Unit("-")] = 1.5
    bearing_radius: Length | None = None
    width: Length | None = None
    youngs_modulus: Modulus | None = None
    poisson: Poisson | None = None
    journal_youngs_modulus: Modulus | None = None
    journal_poisson: Poisson | None = None
    restitution: Annotated[float, Interval(ge=0, le=1), Unit("-")]
    slowest_impact: Speed = 0.01
    friction: Friction = Friction()

    @model_validator(mode="after")
    def complete(self) -> "ContactLaw":
        _needs(self, f"stiffness {self.stiffness}", STIFFNESS_NEEDS.get(str(self.stiffness), ()))
        return self

    def normal_numbers(self, c: float) -> tuple[float, float, int, float, float]:
        """K, exponent, form, chi of the law; and the Hertz stiffness it has at a light touch.

        c: radial clearance, m.
        """
        E_i, nu_i = bearing = self.youngs_modulus, self.poisson
        nu_j = nu_i if self.journal_poisson is None else self.journal_poisson
        journal = self.journal_youngs_modulus or E_i, nu_j
        chi = damping_factor(self.normal, self.restitution)
        if isinstance(self.stiffness, float):
            return self.stiffness, self.exponent, 0, chi, self.stiffness
        if self.stiffness == "cylinder":
            K = cylinder_stiffness(self.width, bearing, journal)
            return K, 1.5, 1, chi, K / c**0.5
        R_i: Any = self.bearing_radius
        K = hertz_stiffness(R_i, R_i - c, bearing, journal, self.stiffness)
        return K, self.exponent, 0, chi, K
