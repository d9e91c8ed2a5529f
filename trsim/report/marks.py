"""Marks of user events in figures over time."""

from typing import Any

from trsim.report.display import Shown
from trsim.report.style import colour

NAMED = 12  # user events of a run that are written into a figure


def happened(axes: Any, runs: list[Shown]) -> None:
    """A line at every user event; with its name where there are few, of one run."""
    for k, shown in enumerate(runs):
        events = shown.run.events
        user = events.kind == "user"
        times = shown.scaled(events.time[user], "s").tolist()
        for time, name in zip(times, events.element[user].tolist(), strict=True):
            axes.axvline(time, color="0.5" if len(runs) == 1 else colour(k), lw=0.6, ls=":")
            if len(runs) == 1 and len(times) <= NAMED:
                axes.annotate(spaced(name), (time, 1.0), xycoords=("data", "axes fraction"),
                              xytext=(2, -2), textcoords="offset points", rotation=90,
                              ha="left", va="top", fontsize=6, color="0.4")  # fmt: skip


def spaced(name: str) -> str:
    """A channel as the words of one quantity: door_angle.rate -> door angle rate."""
    return name.replace(".", " ").replace("_", " ")


def heading(name: str) -> str:
    """The same at the begin of a title; names inside keep their letters: crank_B -> Crank B."""
    text = spaced(name)
    return text[:1].upper() + text[1:]
