"""What a scenario may ask to be drawn in a plane: phase portraits, Poincare sections."""

from typing import Annotated, ClassVar

from annotated_types import Ge, Gt
from pydantic import model_validator

from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.scenario.event import Crosses

SURFACES = ("when", "every", "at_onset")


class PhasePortrait(Spec):
    """One channel against another.

    x  channel on the horizontal axis
    y  channel on the vertical axis
    """

    type: ClassVar[str] = "phase_portrait"
    x: str
    y: str


class PoincareSection(Spec):
    """Two channels where the motion passes a surface, located inside the steps of the solver.

    The surface is one of three: a channel that crosses zero, `when`; instants a period apart,
    `every`; or the touches of a contact, `at_onset`.

    when      channel that crosses zero; a jump across zero gives no point
    crosses   the direction that counts
    every     period of a stroboscopic section: points at the times after + k every, k = 0, 1, 2 ...
    at_onset  clearance joint or stop: a point each time it touches, with the values just before the
              touch
    after     time before which no points are taken, to leave out transients
    plot      channels on the horizontal and the vertical axis
    """

    type: ClassVar[str] = "poincare_section"
    when: str | None = None
    crosses: Crosses = "up"
    every: Annotated[float, Gt(0), Unit("s")] | None = None
    at_onset: str | None = None
    after: Annotated[float, Ge(0), Unit("s")] = 0.0
    plot: tuple[str, str]

    @model_validator(mode="after")
    def one_surface(self):
        given = [key for key in SURFACES if getattr(self, key) is not None]
        if len(given) != 1:
            what = "no surface" if not given else f"both `{given[0]}` and `{given[1]}`"
            hint = "Give one of `when: CHANNEL`, `every: PERIOD`, `at_onset: JOINT`."
            raise ScenarioError(what, hint)
        if self.when is None and "crosses" in self.model_fields_set:
            hint = f"`{given[0]}` has no direction: leave it out."
            raise ScenarioError("crosses belongs to `when`", hint, ("crosses",))
        return self
