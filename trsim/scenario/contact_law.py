"""Contact law: an entry of `contact_laws`, which joints and contacts refer to by its name.

stiffness: internal    Hertz, journal in bearing    K = 4/(3 (s_i + s_j)) sqrt(R_i R_j/(R_i - R_j))
           paper       the same with R_i + R_j
           cylinder    line contact over `width`
           a number    K in N/m^exponent            s = (1 - nu^2)/E
           table       points of `table`, with the damping of `normal`; for a ball on a surface

Laws of instantaneous impacts (laws/impact.py) use the same stiffness, with the damping that Hunt
and Crossley's law has for a restitution of 0 at the slowest impact.

pair: steel-rubber     moduli, friction and, if known, restitution of two materials.
                       Unless given, stiffness is then `hertz`, and friction modified_coulomb
                       with v0 = 0 and v1 = 1 mm/s
"""

from typing import Annotated, Any, ClassVar, Literal, NamedTuple

from annotated_types import Ge, Gt, Interval
from pydantic import ValidationInfo, model_validator

from trsim.elements.contract import Impact
from trsim.elements.friction_law import Friction
from trsim.errors import ScenarioError, within
from trsim.fields import Spec, Unit
from trsim.laws.contact import (
    RULES,
    ball_stiffness,
    cylinder_stiffness,
    damping_factor,
    hertz_stiffness,
)
from trsim.laws.force_tables import rising
from trsim.numbers import number
from trsim.scenario.pairs import PAIRS, listed, values, with_pair

__doc__ = f"{__doc__}\n{listed()}\n"  # what `explain` prints

Modulus = Annotated[float, Gt(0), Unit("Pa")]
Poisson = Annotated[float, Interval(gt=-1, le=0.5), Unit("-")]
Length = Annotated[float, Gt(0), Unit("m")]
Point = tuple[Annotated[float, Unit("m")], Annotated[float, Unit("N")]]
Speed = Annotated[float, Gt(0), Unit("m/s")]

# what a word cannot do without
STIFFNESS_NEEDS = {
    "internal": ("bearing_radius", "youngs_modulus", "poisson"),
    "paper": ("bearing_radius", "youngs_modulus", "poisson"),
    "cylinder": ("bearing_radius", "width", "youngs_modulus", "poisson"),
    "hertz": ("youngs_modulus", "poisson"),
    "table": ("table",),
}
# what a law of the normal force cannot do without, and what is of no use to it
NORMAL_NEEDS = {"impact": ("damping", "ramp")}
NOT_OF = {"impact": ("restitution",)}
RESTING = "hunt_crossley"  # of newton and poisson: how what no longer bounces comes to rest


class Normal(NamedTuple):
    """The numbers of a normal force."""

    stiffness: float  # N/m^exponent
    exponent: float
    chi: float  # of laws of restitution
    damping: float  # N*s/m, of `impact`
    ramp: float  # m; 0 of laws of restitution


def _in_own_unit(data: dict, parameters: Any) -> dict:
    """The same with the number of a stiffness that has a unit, N/m^exponent."""
    text = data.get("stiffness")
    if "exponent" not in data or not isinstance(text, str) or text in STIFFNESS_NEEDS:
        return data
    try:
        exponent = number(data["exponent"], ("-",), parameters)
    except ScenarioError:  # the field itself says so
        return data
    if text[:1].isalpha() and text not in (parameters or {}):
        return data  # a misspelt word, or an expression, which has no unit
    units = ("N/m" if exponent == 1.0 else f"N/m^{exponent:g}",)
    return {**data, "stiffness": within("stiffness", number, text, units, parameters)}


def _needs(spec: Any, what: str, keys: tuple[str, ...]) -> None:
    missing = [key for key in keys if getattr(spec, key) is None]
    if missing:
        raise ScenarioError(f"{what} needs {', '.join(missing)}")


class ContactLaw(Spec):
    """The law of a contact between two bodies of given material and size.

    pair                    two materials, the first that of the surface; they supply the values
                            that are not given
    normal                  how the normal force depends on penetration and its rate
    stiffness               a word, to compute it from size and material, or the value of K,
                            N/m^exponent
    exponent                exponent of the penetration
    table                   rows [penetration, force], both rising from [0, 0], for `stiffness:
                            table`
    bearing_radius          radius of the bearing, which is also the lever arm of the friction
    width                   length of a line contact
    youngs_modulus          Young's modulus of the bearing, and of the journal unless that is given
    poisson                 Poisson's ratio of the bearing, and of the journal unless that is given
    journal_youngs_modulus  Young's modulus of the journal
    journal_poisson         Poisson's ratio of the journal
    restitution             speed after an impact divided by speed before; for all laws except
                            impact
    damping                 damping of the law `impact`, once its ramp is over
    ramp                    penetration over which the damping of the law `impact` fades in
    slowest_impact          smallest impact speed that the law uses; for newton and poisson, the
                            approach speed below which nothing bounces
    friction                friction along the surfaces
    """

    type: ClassVar[str] = "contact_law"
    pair: Literal[*PAIRS] | None = None
    normal: Literal[
        *("lankarani_nikravesh", "hunt_crossley", "flores", "identified", "impact"),
        *("newton", "poisson"),
    ]
    stiffness: Annotated[
        Literal[*STIFFNESS_NEEDS] | Annotated[float, Gt(0)],
        Unit("N/m^1.5"),
    ] = "internal"
    exponent: Annotated[float, Interval(ge=1, le=3), Unit("-")] = 1.5
    table: tuple[Point, ...] | None = None
    bearing_radius: Length | None = None
    width: Length | None = None
    youngs_modulus: Modulus | None = None
    poisson: Poisson | None = None
    journal_youngs_modulus: Modulus | None = None
    journal_poisson: Poisson | None = None
    restitution: Annotated[float, Interval(ge=0, le=1), Unit("-")] | None = None
    damping: Annotated[float, Ge(0), Unit("N*s/m")] | None = None
    ramp: Annotated[float, Gt(0), Unit("m")] | None = None
    slowest_impact: Speed = 0.01
    friction: Friction = Friction()

    @model_validator(mode="before")
    @classmethod
    def of_pair(cls, data: Any, info: ValidationInfo) -> Any:
        """What is not given is that of the pair; a stiffness has the unit of its exponent."""
        if not isinstance(data, dict):
            return data
        data = with_pair(data) if data.get("pair") in [*PAIRS] else data
        return _in_own_unit(data, (info.context or {}).get("parameters"))

    @model_validator(mode="after")
    def complete(self) -> "ContactLaw":
        _needs(self, f"stiffness {self.stiffness}", STIFFNESS_NEEDS.get(str(self.stiffness), ()))
        needed = NORMAL_NEEDS.get(self.normal, ("restitution",))
        if self.pair and "restitution" in needed and self.restitution is None:
            what = f"no origin is known for a restitution of {self.pair}"
            raise ScenarioError(what, "give `restitution`, or take normal impact", ("pair",))
        _needs(self, f"normal {self.normal}", needed)
        for key in NOT_OF.get(self.normal, ("damping", "ramp")):
            if getattr(self, key) is not None:
                raise ScenarioError(f"{key} is no number of normal {self.normal}", "", (key,))
        if self.table is not None:
            self.check_table()
        return self

    def check_table(self) -> None:
        """Refuse a table that does not rise from nothing, or that is not what is asked for."""
        if self.stiffness != "table":
            what = "a table is given, and another stiffness"
            raise ScenarioError(what, "stiffness: table", ("stiffness",))
        try:
            rising(*self.columns)
        except ValueError as error:
            hint = "in m and N unless units are given"
            raise ScenarioError(str(error), hint, ("table",)) from None

    @property
    def columns(self) -> tuple[list[float], list[float]]:
        """Penetrations and forces of the table."""
        rows = self.table or ()
        return [d for d, _ in rows], [F for _, F in rows]

    @property
    def materials(self) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        """Young's modulus and Poisson's ratio of the bearing, or surface, and of the journal."""
        E_i, nu_i = self.youngs_modulus, self.poisson
        nu_j = nu_i if self.journal_poisson is None else self.journal_poisson
        return (E_i, nu_i), (self.journal_youngs_modulus or E_i, nu_j)

    @property
    def taken(self) -> str:
        """What is as the table of pairs has it, with origins; empty without a pair."""
        if self.pair is None:
            return ""
        told = []
        for key, value in values(PAIRS[self.pair]).items():
            of, name = (self.friction, key[9:]) if "." in key else (self, key)
            unused = key == "friction.static_coefficient" and self.friction.law != "sticking"
            if getattr(of, name) == value.number and not unused:
                told.append(f"{key} {value.number:g} ({value.from_where})")
        return f"{self.pair}: {'; '.join(told) or 'nothing'}"

    @property
    def impact(self) -> Impact | None:
        """What a touch is that takes no time; None of laws of a force."""
        if self.normal not in RULES or self.restitution is None:
            return None
        return Impact(self.normal, self.restitution, *self.friction.coefficients)

    @property
    def chi(self) -> float:
        """The damping factor of a law with a restitution."""
        law, e = (RESTING, 0.0) if self.normal in RULES else (self.normal, self.restitution)
        return damping_factor(law, e)

    def on_surface(self, radius: float, curvature: float | None) -> Normal:
        """The numbers of a ball on a surface; curvature: as of `ball_stiffness`, None where it is
        not the same in all directions."""
        if isinstance(self.stiffness, float):
            K, exponent = self.stiffness, self.exponent
        elif self.table is not None:
            K, exponent = rising(*self.columns)[1], 1.0
        elif self.stiffness != "hertz":
            what = f"stiffness {self.stiffness} is that of a journal in its bearing"
            raise ScenarioError(what, "give a number, or `hertz` of a ball", ("contact",))
        elif curvature is None or radius == 0.0:
            what = "stiffness hertz is that of a ball on a plane or on another ball"
            raise ScenarioError(what, "give a number, in N/m^1.5", ("contact",))
        else:
            K, exponent = ball_stiffness(radius, curvature, *self.materials), 1.5
        if self.normal == "impact":
            return Normal(K, exponent, 0.0, float(self.damping or 0.0), float(self.ramp or 0.0))
        return Normal(K, exponent, self.chi, 0.0, 0.0)

    def normal_numbers(self, c: float) -> tuple[float, float, int, float, float]:
        """K, exponent, form, chi of the law; and the Hertz stiffness it has at a light touch.

        c: radial clearance, m.
        """
        if self.normal == "impact":
            what = "normal impact is no law of a clearance joint"
            raise ScenarioError(what, "take one with a restitution", ("contact",))
        if self.impact:
            what = f"normal {self.normal} makes impacts, and no forces, of the touches of a journal"
            hint = "its forces are what play is about: take one of them, as `identified`"
            raise ScenarioError(what, hint, ("contact",))
        bearing, journal = self.materials
        chi = self.chi
        if self.stiffness in ("hertz", "table"):
            what = f"stiffness {self.stiffness} is that of a ball on a surface"
            raise ScenarioError(what, "of a journal in its bearing take `internal`", ("contact",))
        if isinstance(self.stiffness, float):
            return self.stiffness, self.exponent, 0, chi, self.stiffness
        if self.stiffness == "cylinder":
            K = cylinder_stiffness(self.width, bearing, journal)
            return K, 1.5, 1, chi, K / c**0.5
        R_i: Any = self.bearing_radius
        K = hertz_stiffness(R_i, R_i - c, bearing, journal, self.stiffness)
        return K, self.exponent, 0, chi, K
