"""Where something stands: an origin and axes, as drawn."""

from math import sqrt
from typing import Any, ClassVar

from pydantic import model_validator

from trsim.errors import ScenarioError
from trsim.fields import Spec, direction, point, vector
from trsim.frame import Frame, across

PARALLEL = 1e-6  # sine of an angle


class Placed(Spec):
    """A place with axes.

    at      its origin, as drawn
    x_axis  direction of its x axis, as drawn; of any length
    y_axis  direction of its y axis, made perpendicular to x; z = x cross y
    """

    type: ClassVar[str] = "placed"
    at: point("m", named=False) = (0.0, 0.0, 0.0)  # type: ignore[valid-type]
    x_axis: vector("-", named=False) = (1.0, 0.0, 0.0)  # type: ignore[valid-type]
    y_axis: vector("-", named=False) = (0.0, 1.0, 0.0)  # type: ignore[valid-type]

    @model_validator(mode="after")
    def axes(self) -> "Placed":
        for key in ("x_axis", "y_axis"):
            if not any(getattr(self, key)):
                raise ScenarioError("an axis must not be zero", "for example [1, 0, 0]", (key,))
        if _across(direction(self.x_axis), direction(self.y_axis))[1] < PARALLEL:
            what = "y_axis is parallel to x_axis"
            hint = "z = x cross y needs two directions"
            if "y_axis" not in self.model_fields_set:
                hint = "give `y_axis` too: it is [0, 1, 0] unless given"
            raise ScenarioError(what, hint, ("y_axis",))
        return self

    @property
    def frame(self) -> Frame:
        """The place with its orthonormal axes, in world axes."""
        x = direction(self.x_axis)
        y = direction(_across(x, direction(self.y_axis))[0])
        return Frame(self.at, (x[0], x[1], x[2]), (y[0], y[1], y[2]), across(x, y))

    def outermost(self, places: Any) -> list[tuple[float, ...]]:
        """Of places (n, 2) in its x-y plane those farthest out in eight directions, as drawn."""
        import numpy as np

        around = np.arange(8) * (0.25 * np.pi)
        found = np.argmax(np.asarray(places) @ np.stack([np.cos(around), np.sin(around)]), axis=0)
        own = self.frame
        kept = (places[k] for k in dict.fromkeys(found.tolist()))
        return [own.moved((float(x), float(y), 0.0)) for x, y in kept]


def _across(x: Any, y: Any) -> tuple[tuple[float, ...], float]:
    """The part of y across a unit vector x, and its length."""
    along = sum(p * q for p, q in zip(x, y, strict=True))
    part = tuple(q - along * p for p, q in zip(x, y, strict=True))
    return part, sqrt(sum(c * c for c in part))
