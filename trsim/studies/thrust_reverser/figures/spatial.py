"""Figures 23 to 26: five doors and three actuators, at one speed and each at another in turn."""

from collections.abc import Sequence
from functools import partial
from typing import Any

from trsim.report.display import Shown
from trsim.report.style import COLOURS, colour, panels, thinned
from trsim.studies.claim import Cases
from trsim.studies.drawing import Drawn, lettered, with_legend
from trsim.studies.thrust_reverser.figures.drawing import timed

ACTUATORS = (1, 2, 3)
SPEEDS = (418, 419, 420, 421, 422)  # mm/s
SHADES = [COLOURS[k] for k in (0, 5, 6, 4, 1)]  # of the speeds: from slow, blue, to fast, red
VARIANTS = (("ideal joints", "spatial_420"), ("play of 0.3 mm at every B", "spatial_play"),
            ("flexible rods", "spatial_flexible"))  # fmt: skip
SHAFTS = (("without", "spatial_shaft_without"), ("0.176 N\u00b7m/rad", "spatial_shaft_softer"),
          ("0.53 N\u00b7m/rad", "spatial_shaft"),
          ("1.76 N\u00b7m/rad", "spatial_shaft_stiffer"))  # fmt: skip
FORCE = "hold-back force"


def case(odd: int, speed: int) -> str:
    """The run with one actuator at a speed of its own, mm/s, the others at 420."""
    return "spatial_420" if speed == 420 else f"spatial_{odd}_{speed}"


def speeds(odd: int) -> Cases:
    """The cases with one actuator at each speed."""
    return tuple((f"{speed} mm/s", case(odd, speed)) for speed in SPEEDS)


def figure_23(shown: list[Shown]) -> Any:
    """All three actuators at one speed: along X, across in Y and Z."""
    [one] = shown
    figure, axes = panels(3, height=1.8, width=6.3, sharex=True)
    for a, letter, axis in zip(axes[:, 0], "abc", "XYZ", strict=True):
        for k in ACTUATORS:
            channel = f"actuator_{k}.reaction"  # on the fairing; that on the actuator is drawn
            values = -one.values(channel)[:, "XYZ".index(axis)]
            a.plot(*thinned(one.time, values), color=colour(k - 1), ls=("-", "-", "--")[k - 1],
                   lw=1.1, label=f"actuator {k}")  # fmt: skip
        a.set_ylabel(f"reaction force\n({one.unit(channel)})")
        a.margins(x=0.01)
        lettered(a, letter, f"{axis} direction")
    timed(axes[-1])
    figure.align_ylabels()
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def of_each(
    shown: list[Shown], shades: Sequence[str] = COLOURS, dashes: str = "-----"
) -> Any:  # fmt: skip
    """A panel for each actuator with its hold-back forces, all on one scale."""
    figure, axes = panels(3, height=1.9, width=6.3, sharex=True, sharey=True)
    for a, letter, k in zip(axes[:, 0], "abc", ACTUATORS, strict=True):
        for one, shade, dash in zip(shown, shades, dashes, strict=False):
            force = one.values(f"actuator_{k}.force")
            a.plot(*thinned(one.time, force), dash, color=shade, lw=1.0, label=one.label)
        a.axhline(0.0, color="0.6", lw=0.6)
        a.set_ylabel(f"{FORCE}\n(N)")
        a.margins(x=0.01)
        lettered(a, letter, f"actuator {k}")
    timed(axes[-1])
    return with_legend(figure, axes[0, 0], shown, 5)


FIGURES = (
    Drawn("23", "abc", "Forces of the fairing on the actuators at one speed of 420 mm/s. X is "
          "aft, so that positive is where an actuator holds the fairing back, as in figures 24 to "
          "26.", (("", "spatial_420"),), figure_23),
    *(Drawn(str(23 + odd), "abc", f"Forces of the actuators along X where actuator {odd} has a "
            "speed of its own, the others 420 mm/s; positive holds the fairing back.", speeds(odd),
            partial(of_each, shades=SHADES)) for odd in ACTUATORS),
    Drawn("23 with play and with flexible rods", "abc", "As figure 23, with play at the hinges of "
          "all doors and with flexible rods (ours).", VARIANTS,
          partial(of_each, dashes="--:")),
    Drawn("25 with a shaft", "abc", "Actuator 2 at 418 mm/s, pistons that give way behind their "
          "supply, and a synchronising shaft, by its stiffness (ours).",
          SHAFTS, of_each),
)  # fmt: skip
