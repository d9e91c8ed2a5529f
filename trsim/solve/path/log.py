"""What is told of a static path: its events, where it loses stability, how it ends."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import poses
from trsim.assemble.switches import CHANNEL, TIME, UserEvent
from trsim.laws.functions import HELD_OF_TABLE
from trsim.solve.march import record as rec
from trsim.solve.path.changes import CONTACT, PIECE, RIM, RUB, SAME, SENSE, WATCH, Change, Looks
from trsim.solve.path.place import Place
from trsim.solve.path.results import DAMPERS, INERTIA, Results
from trsim.statuses import Ended

Array = NDArray[np.float64]

TOLD = 0.05  # of the largest force of a drive: what inertia may add untold
SHOWN = 4  # coordinates of joints in a sentence
FAR = {"angle": 0.5, "stroke": 0.1}  # rad, and of the mechanism's size: no longer where it was put
NEXT_TO = 100.0  # of the time in which functions are differentiated: for rates of channels
SOON = 1e-3  # of the time between rows: what turned round may not slide in full so soon
BOTH = 1.5  # signs beyond it are those of places where nothing is free


class Log:
    """Events of a path, and its end."""

    def __init__(self, looks: Looks, results: Results) -> None:
        self.looks, self.results, self.eq = looks, results, looks.eq
        self.mechanism = self.eq.mechanism
        self.events: list[Array] = []
        self.count = 0
        self.status: Ended = "done"
        self.reason = ""
        self.falls: list[tuple[float, str]] = []
        self.turning: list[tuple[float, Change, Any]] = []  # what turns round, see `go_on`
        self.letting_go: list[UserEvent] = []  # events that let drives go at this place
        self.hands_over = False  # what user events do, see phase.py
        self.due: list[tuple[int, float]] = []  # those that happen here, with the rate then
        self.fired = {event.name: 0 for event in looks.events if event.kind != "limit"}

    def note(self, place: Place, change: Change) -> None:
        """A line of the table of events, and what follows from it."""
        looks, kind, row = self.looks, 0.0, -1
        if change.kind == CONTACT:
            looks.closed[change.which] = change.to > 0.0
            kind, row = rec.ONSET if change.to > 0.0 else rec.SEPARATION, change.which
        elif change.kind == PIECE:
            kind, row = rec.CORNER, looks.whose(int(looks.places[change.which]))
        elif change.kind == RIM:
            kind, row = rec.CORNER, looks.whose(looks.rims[change.which] + HELD_OF_TABLE)
        elif change.kind == RUB:
            self.turning.append((place.t, change, looks.came[change.which]))
        elif change.kind == SENSE:
            self.unstable(place, change)
        elif change.kind == WATCH:
            change = self.with_rate(place, change)
            kind, row = self.happened(place, change)
        if row >= 0 and not (change.kind == CONTACT and self.undone(place.t, kind, row)):
            self.line(place.t, kind, row, change.rate)

    def undone(self, t: float, kind: float, row: int) -> bool:
        """Whether a contact closes and opens at one place, in either order: its last line goes.

        Where two close at once, rounding may close one, find the balance of both open, and close
        both.
        """
        last = [k for k, line in enumerate(self.events)
                if line[2] == row and line[1] in (rec.ONSET, rec.SEPARATION)][-1:]  # fmt: skip
        if not last or self.events[last[0]][1] == kind:
            return False
        if abs(t - self.events[last[0]][0]) > SAME * abs(t):
            return False
        del self.events[last[0]]
        self.count -= 1
        return True

    def line(self, t: float, kind: float, row: int, rate: float) -> None:
        """A line of the table, once."""
        if [t, kind, row] not in [line[:3].tolist() for line in self.events]:
            self.count += 1
            self.events.append(np.array([t, kind, row, rate, np.nan, 0.0, 0.0]))

    def go_on(self, place: Place) -> None:
        """Take directions of sliding at the next place.  What turned round before has a line if it
        slides there; what sticks goes on later, or back.  A place next to it does not tell."""
        waiting = []
        for t, change, before in self.turning:
            if self.looks.slides(place, change.which):
                self.line(t, rec.TURNS, change.which, change.rate)
            elif place.t - t > SOON * self.results.every:
                self.looks.put_back(change.which, before)
            else:
                waiting.append((t, change, before))
        self.turning = waiting
        self.looks.directions(place)

    def with_rate(self, place: Place, change: Change) -> Change:
        """The same with the rate of what is watched; where it has none of its own, as a channel,
        that between the places a little ahead and behind along the path."""
        event = self.looks.events[change.which]
        if np.isfinite(change.rate):
            return change
        if event.entry == TIME and event.kind != CHANNEL:
            return replace(change, rate=1.0)
        h, eq, seen = NEXT_TO * self.eq.small, self.eq, []
        for dt in (h, -h):
            y = eq.at_time(eq.moved(place.y, dt * place.v), place.t, place.t + dt)
            near = replace(place, t=place.t + dt, y=y, lam=place.lam + dt * place.lam_rate)
            out = self.results.out(near, np.zeros(eq.n))
            seen.append(self.looks.values(near, out)[change.which][0])
        return replace(change, rate=(seen[0] - seen[1]) / (2.0 * h))

    def happened(self, place: Place, change: Change) -> tuple[float, int]:
        """A user event, or a limit of an element."""
        looks, k = self.looks, change.which
        event = looks.events[k]
        looks.side[k] = change.to
        if event.direction not in (0, change.to):
            return 0.0, -1
        looks.left[k] -= 1
        if self.hands_over:
            self.due.append((k, change.rate))
            return 0.0, -1
        if event.name in self.fired:
            self.fired[event.name] += 1
        if event.turned:
            self.letting_go.append(event)
        if event.record:
            out = self.results.out(place, np.zeros(self.eq.n))
            self.results.recorded.append(np.array([place.t, k, *out]))
        if event.end and not self.reason:
            self.status = event.status
            self.reason = f"event '{event.name}' ended the run"
            if event.kind == "limit":
                limit = f"{event.value:g} {event.unit}"
                self.reason = f"{event.when} {event.said} ({limit}) at t = {place.t:.6g} s"
        return rec.USER, len(self.mechanism.instances) + 1 + k

    def unstable(self, place: Place, change: Change) -> None:
        """Tell where the balance loses its stability, or finds it."""
        if abs(change.to) > BOTH:
            self.status = "limit" if self.eq.rubs else "failed"
            self.reason = (
                f"at t = {place.t:.9g} s{self.where(place)} rows of joints and drives depend on "
                "each other, or friction locks them: behind it the path is not the only one"
            )
            return
        word = "unstable" if change.to < 0.0 else "stable again"
        self.falls.append((place.t, f"the equilibrium is {word}{self.where(place)}"))

    def astray(self, place: Place, values: dict[str, float]) -> None:
        """Tell where the start is far from values of `initial`, which do not hold in a balance."""
        poses(self.eq.work, place.y)
        for name, x in self.mechanism.coordinates.items():
            if name not in values or x.kind not in FAR:
                continue
            off = abs(float(self.eq.work.S[x.entry, 0]) - values[name])
            off = abs((off + np.pi) % (2.0 * np.pi) - np.pi) if x.kind == "angle" else off
            if off > FAR[x.kind] * (self.eq.work.size if x.kind == "stroke" else 1.0):
                text = (
                    f"is {off:.3g} {'rad' if x.kind == 'angle' else 'm'} from the value of '{name}'"
                )
                text = (
                    f"the balance{self.where(place)} {text} under `initial`: is it the one meant?"
                )
                self.falls.append((place.t, text))

    def where(self, place: Place) -> str:
        """The coordinates of joints at a place, in words."""
        poses(self.eq.work, place.y)
        S, units = self.eq.work.S, {"angle": "rad", "stroke": "m"}
        told = [
            f"{name} = {float(S[x.entry, 0]):.6g} {units[x.kind]}"
            for name, x in self.mechanism.coordinates.items()
            if x.joint and x.entry >= 0 and x.kind in units
        ]
        return f" ({', '.join(told[:SHOWN])})" if told else ""

    def ended(self, place: Place, turns: bool, changes: Any) -> None:
        """The path ends here, unless an event has ended it."""
        if self.reason:
            return
        self.status, self.reason = "limit", self.told(place, turns, changes)
        if not turns and not self.finite(place):
            self.status = "failed"
            self.reason = f"a force is not finite behind t = {place.t:.9g} s"

    def finite(self, place: Place) -> bool:
        """Whether forces are numbers just behind a place."""
        ahead = self.eq.at_time(place.y, place.t, place.t + self.eq.small)
        return bool(np.isfinite(self.eq.left(place.t + self.eq.small, ahead, place.lam)).all())

    def told(self, place: Place, turns: bool, changes: Any) -> str:
        """Why a path ends."""
        at = f"t = {place.t:.9g} s{self.where(place)}"
        names = [self.mechanism.instances[c.which].name for c in changes if c.kind == CONTACT]
        if names:
            return f"no equilibrium next to it behind {at}, where '{names[0]}' opens or closes"
        if turns and self.eq.n > self.eq.m:
            return (
                f"limit point at {at}: the path turns back there, and no equilibrium is near "
                "ahead; the mechanism snaps through"
            )
        if turns:
            return f"dead end at {at}: the drives ask for places that joints do not reach"
        locks = ": does friction lock it?" if self.eq.rubs else ""
        return f"no equilibrium next to it behind {at}{locks}"

    def said(self) -> Iterator[str]:
        """What is worth knowing of the path."""
        for t, text in self.falls:
            yield f"solver.method: at t = {t:.9g} s {text}"
        for of, what in ((INERTIA, "inertia"), (DAMPERS, "dampers and functions of rates")):
            for name, ratio, when in self.results.ratios(of):
                if ratio > TOLD:
                    yield (
                        f"{name}: at this speed {what} would change its force by up to "
                        f"{100 * ratio:.2g} % of the largest it has (at t = {when:.6g} s): the "
                        "path is no picture of the motion there; go slower, or let the motion be "
                        "computed"
                    )
