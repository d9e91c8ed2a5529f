"""Pairs of materials by name: what contact laws take of public tables, with the origin of each.

They are of clean surfaces unless greasy.  Friction varies by half of itself with finish, load and
air; measure it where it matters.  What no source here gives is not in the table.
"""

from textwrap import wrap
from typing import Any, NamedTuple

ORIGINS = {
    "ecourses": "ecoursesbook.com, Multimedia Engineering Mechanics, appendix Material Properties",
    "triton": "academics.triton.edu/faculty/fheitzman/strengthofmaterials.html, Material Constants",
    "finemech": "finemech.com/ft005.html, Mechanical Properties of Fluoroplastic Materials",
    "springer": "Springer Handbook of Condensed Matter and Materials Data, table 3.3-12",
    "laboratory": "engineerlaboratory.com, Friction Coefficients of Common Materials",
    "ontario": "ecampusontario.pressbooks.pub/physicsfundamentals, appendix A, table A.1",
    "hill": "S. A. Hill, howwhy.nfshost.com, Coefficients of Friction (2022)",
    "newton": "I. Newton, Principia (1687), scholium to the laws of motion",
}


class Value(NamedTuple):
    """A number with its origin, and what of it is meant."""

    number: float
    origin: str  # of ORIGINS
    of: str = ""

    @property
    def from_where(self) -> str:
        return f"{ORIGINS[self.origin]}{': ' if self.of else ''}{self.of}"


class Pair(NamedTuple):
    """Two materials, and what there is between them."""

    first: str  # of MATERIALS, the surface
    second: str  # the ball
    static: Value
    kinetic: Value
    restitution: Value | None = None


# Young's modulus, Pa, and Poisson's ratio
MATERIALS = {
    "steel": (Value(200e9, "ecourses", "A36"), Value(0.29, "ecourses", "A36")),
    "aluminium": (Value(68.9e9, "ecourses", "6061-T6"), Value(0.33, "ecourses", "6061-T6")),
    "bronze": (Value(103e9, "ecourses", "manganese bronze"),
               Value(0.34, "ecourses", "manganese bronze")),
    "brass": (Value(103e9, "ecourses", "red brass"), Value(0.34, "ecourses", "red brass")),
    "rubber": (Value(2.76e6, "triton", "average"), Value(0.48, "triton", "average")),
    "oak": (Value(12.4e9, "triton", "red oak along the grain; much less across it"),
            Value(0.3, "triton", "red oak")),
    "ptfe": (Value(0.6e9, "finemech", "the middle of 0.4 to 0.8 GPa"),
             Value(0.32, "springer", "from sound speeds of 1410 and 730 m/s")),
}  # fmt: skip


def _between(first: str, second: str, numbers: tuple[float, float], origin: str, of: str = "",
             restitution: Value | None = None) -> Pair:  # fmt: skip
    static, kinetic = (Value(number, origin, of) for number in numbers)
    return Pair(first, second, static, kinetic, restitution)


BALLS = Value(0.56, "newton", "balls of steel part at about 5/9 of their approach")
PAIRS = {
    "steel-steel": _between("steel", "steel", (0.74, 0.57), "laboratory", "clean, dry", BALLS),
    "steel-steel-greasy": _between("steel", "steel", (0.05, 0.03), "hill", "oiled"),
    "steel-aluminium": _between("steel", "aluminium", (0.61, 0.47), "ontario", "clean, dry"),
    "steel-bronze": _between("steel", "bronze", (0.42, 0.35), "laboratory"),
    "steel-brass": _between("steel", "brass", (0.51, 0.44), "ontario", "clean, dry"),
    "steel-rubber": _between("steel", "rubber", (0.85, 0.7), "laboratory"),
    "steel-ptfe": _between("steel", "ptfe", (0.04, 0.04), "hill"),
    "steel-oak": _between("steel", "oak", (0.5, 0.3), "hill", "metal on wood"),
    "oak-oak": _between("oak", "oak", (0.5, 0.3), "hill", "wood on wood"),
}
SMOOTHED = {"law": "modified_coulomb", "v0": 0.0, "v1": 1e-3}  # friction unless it is given


def values(pair: Pair) -> dict[str, Value]:
    """What a contact law takes of a pair, by its keys."""
    (E_i, nu_i), (E_j, nu_j) = MATERIALS[pair.first], MATERIALS[pair.second]
    found = {
        "youngs_modulus": E_i, "poisson": nu_i,
        "journal_youngs_modulus": E_j, "journal_poisson": nu_j,
        "friction.static_coefficient": pair.static, "friction.coefficient": pair.kinetic,
    }  # fmt: skip
    return found if pair.restitution is None else {**found, "restitution": pair.restitution}


def with_pair(given: dict[str, Any]) -> dict[str, Any]:
    """A contact law as it is written, with what it leaves to its pair; what is given stands."""
    pair = PAIRS[given["pair"]]
    known = values(pair)
    filled: dict[str, Any] = {key: value.number for key, value in known.items() if "." not in key}
    if given.get("normal") == "impact":
        filled.pop("restitution", None)
    if "table" in given:
        filled["stiffness"] = "table"
    elif "bearing_radius" not in given:
        filled["stiffness"] = "hertz"
    friction = given.get("friction", SMOOTHED)
    if isinstance(friction, dict) and friction.get("law", "none") != "none":
        own = {"coefficient": pair.kinetic.number}
        if friction["law"] == "sticking" and "coefficient" not in friction:
            own["static_coefficient"] = pair.static.number
        filled["friction"] = {**own, **friction}
    return {**filled, **given, **({"friction": filled["friction"]} if "friction" in filled else {})}


def wrapped(value: Value) -> list[str]:
    """The origin of a value in lines that fit."""
    return wrap(value.from_where, 100, initial_indent=8 * " ", subsequent_indent=10 * " ")


def listed() -> str:
    """The table in words, for `explain`."""
    lines = ["Pairs of materials (`pair`), with static and sliding friction:", ""]
    for name, pair in PAIRS.items():
        e = "" if pair.restitution is None else f", restitution {pair.restitution.number:g}"
        lines.append(f"    {name:19} {pair.static.number:g} {pair.kinetic.number:g}{e}")
        lines += wrapped(pair.kinetic)
        if pair.restitution is not None:
            lines += wrapped(pair.restitution)
    lines += ["", "Materials, with Young's modulus and Poisson's ratio:", ""]
    for name, (E, nu) in MATERIALS.items():
        lines.append(f"    {name:19} {E.number / 1e9:g} GPa, {nu.number:g}")
        lines += dict.fromkeys((*wrapped(E), *wrapped(nu)))
    return "\n".join(lines)
