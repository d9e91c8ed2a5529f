"""Friction as the user writes it: a law of laws/friction.py by its word, with its numbers.

A contact law has one, and so has whatever else rubs.
"""

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt
from pydantic import model_validator

from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.laws.friction import CODES, N_PARAMETERS

Speed = Annotated[float, Gt(0), Unit("m/s")]
Coefficient = Annotated[float, Ge(0), Unit("-")]

# the parameters of a law, in the order it takes them (laws/friction.py)
STATIC = "static_coefficient"  # the coefficient unless given
FRICTION_KEYS = {
    "none": (),
    "coulomb": ("coefficient",),
    "modified_coulomb": ("coefficient", "v0", "v1"),
    "sticking": (STATIC, "coefficient", "stribeck_speed", "bristle_stiffness", "bristle_damping"),
}


class Friction(Spec):
    """Friction between two surfaces.

    law                 none; coulomb: constant; modified_coulomb: none below v0, full from v1 on;
                        sticking: bristles that hold at rest
    coefficient         coefficient of sliding friction
    v0                  sliding speed below which there is no friction
    v1                  sliding speed from which friction is full
    static_coefficient  coefficient of static friction, for sticking; equal to `coefficient` unless
                        given
    stribeck_speed      sliding speed at which sticking changes to sliding
    bristle_stiffness   stiffness of the bristles, per unit of normal force
    bristle_damping     damping of the bristles, per unit of normal force
    """

    type: ClassVar[str] = "friction"
    law: Literal["none", "coulomb", "modified_coulomb", "sticking"] = "none"
    coefficient: Coefficient | None = None
    v0: Annotated[float, Ge(0), Unit("m/s")] | None = None
    v1: Speed | None = None
    static_coefficient: Coefficient | None = None
    stribeck_speed: Speed | None = None
    bristle_stiffness: Annotated[float, Gt(0), Unit("1/m")] | None = None
    bristle_damping: Annotated[float, Ge(0), Unit("s/m")] = 0.0

    @model_validator(mode="after")
    def complete(self) -> "Friction":
        keys = tuple(key for key in FRICTION_KEYS[self.law] if key != STATIC)
        missing = [key for key in keys if getattr(self, key) is None]
        if missing:
            raise ScenarioError(f"friction law {self.law} needs {', '.join(missing)}")
        if self.law == "sticking" and self.coefficient == 0.0:
            raise ScenarioError("friction law sticking needs a coefficient > 0")
        if self.v0 is not None and self.v1 is not None and self.v0 >= self.v1:
            raise ScenarioError(f"v0 must be < v1, got {self.v0:g} and {self.v1:g} m/s")
        return self

    @property
    def slope(self) -> float:
        """s/m, of the coefficient over the speed, next to rest."""
        if self.law != "modified_coulomb":
            return 0.0
        mu, v0, v1, *_ = self.numbers[1]
        return mu / (v1 - v0)

    @property
    def ramp(self) -> float:
        """m/s, over which it comes in next to rest; 0 where it does otherwise."""
        return float(self.v1 - self.v0) if self.slope > 0.0 else 0.0  # type: ignore[operator]

    @property
    def jumps(self) -> bool:
        """Whether it jumps at rest."""
        return self.law == "coulomb"

    @property
    def coefficients(self) -> tuple[float, float]:
        """At rest and while sliding; 0 where there is none."""
        sliding = self.coefficient if self.law != "none" else 0.0
        held = self.static_coefficient if self.law == "sticking" else None
        return float(held or sliding or 0.0), float(sliding or 0.0)

    @property
    def numbers(self) -> tuple[int, tuple[float, ...]]:
        """Code of the law and its N_PARAMETERS numbers."""
        given = {**dict(self), STATIC: self.static_coefficient or self.coefficient}
        numbers = [float(given[key]) for key in FRICTION_KEYS[self.law]]
        return CODES[self.law], (*numbers, *[0.0] * (N_PARAMETERS - len(numbers)))
