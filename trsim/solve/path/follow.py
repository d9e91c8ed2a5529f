"""A static path followed: steps, what changes on the way, and where it ends.

A step goes along the tangent and is brought into balance by Newton's method.  It is made again,
half as long, where that fails, and where the place found is further from the tangent than the step
is long, unless that is next to nothing: another branch is as far however short the step.  Steps end
at output rows, at corners of functions of time, and where something changes (changes.py), found by
halving.  Where steps shrink to nothing there is no balance ahead: fold.py looks how it ends.
"""

import time
from collections.abc import Generator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.switches import TIME
from trsim.errors import ModelError
from trsim.solve.march import record as rec
from trsim.solve.march.features import next_time
from trsim.solve.outcome import Block, Outcome, settings
from trsim.solve.path.begin import begin, check
from trsim.solve.path.between import Between
from trsim.solve.path.changes import RUB, SAME, WATCH, Change, Looks, bottoms, side_of, stability
from trsim.solve.path.fold import fold
from trsim.solve.path.headings import (
    CLOSE_AHEAD,
    anchored,
    bend,
    brief_step,
    by_rates,
    came_by,
    directed,
    kinked,
    second_order,
)
from trsim.solve.path.let_go import Held, kept, why
from trsim.solve.path.log import Log
from trsim.solve.path.place import Equations, Place
from trsim.solve.path.results import APART, Results, slope
from trsim.solve.path.told import outcome

Array = NDArray[np.float64]

FAR = 0.05  # rad, or of the mechanism's size: what anything moves in a step at most
ASTRAY = 0.5  # of what a step moves: how far from its tangent a place is found
BENT = 1e-4  # of the largest force, of the size: what a smooth step may be off its rates by
BENT_TURNING = 3e-4  # the same where friction turns, whose direction is that of the step
PARTED, STILL = 3, 0.9  # steps halved for that to no effect, of what the first one was off by
BESIDE = 1e-6  # of the mechanism's size: the same, however long the step is
SHORTEST = 1e-12  # of the path: a step
STEADY = 0.2  # of the time between rows: places that are nearer do not tell what inertia would do
FULL = 1.0 - 1e-6  # of the largest friction there can be: less is no full sliding
SEEN = 0.01  # of the path: in that time what slides goes further than full sliding takes
PARTS = 8  # parts of a step in which channels that events watch are looked at
AGAIN = 50  # changes at one place: it is none
BLOCK = 500  # rows


def simulate(scenario: Any, mechanism: Mechanism) -> Generator[Block, None, Outcome]:
    """As solve/simulate.py's: the path from t = 0 to the end, or to where it ends."""
    check(scenario, mechanism)
    clock = time.process_time()
    path = Path(scenario, mechanism, begin(scenario, mechanism))
    yield from path.run()
    return outcome(path, time.process_time() - clock)


class Path:
    """A path as far as it was followed."""

    def __init__(self, scenario: Any, mechanism: Mechanism, begun: Any, t0: float = 0.0) -> None:
        """begun: y, mem and branch at t0, see Start."""
        self.scenario, self.mechanism, self.t0 = scenario, mechanism, t0
        self.setting = settings(scenario, mechanism)
        self.end, self.every = float(self.setting.t_end), float(self.setting.every)
        self.begun = begun
        self.eq = Equations(mechanism, begun)
        self.eq.small = 1e-6 * min(self.every, self.end)
        self.held = Held(mechanism)
        self.looks = Looks(self.eq, self.end)
        self.results = Results(self.eq, self.every)
        self.log = Log(self.looks, self.results)
        self.between = Between(self.results, self.setting.missed)
        self.between.solve = self.inside
        self.hears = any(event.kind == "channel" for event in self.looks.events)
        self.before: Place | None = None  # behind the place that is known last, on a smooth piece
        self.next_row, self.steps, self.rejected = 1, 0, 0
        self.lowest = (np.inf, 0.0)
        self.behind = False  # whether something that rubs has a corner here
        self.longest = float(scenario.solver.max_step or self.end)

    # --- the way -------------------------------------------------------------------------------

    def run(self) -> Generator[Block, None, None]:
        """Follow the path; its rows."""
        place = self.first()
        h, again, last = self.every, 0, -1.0
        while not self.log.due and place.t < self.end * (1.0 - SAME):
            found = self.step(place, h)
            if found is None:
                self.stop(place)
                break
            trial, changes, h, brief = found
            if changes and trial.t - place.t > SAME * self.end:
                trial, changes = self.narrowed(place, trial, changes)
            if self.looks.waiting and (inside := self.looked_inside(place, trial)):
                trial, changes = self.narrowed(place, *inside)
            self.steps += 1
            long = trial.t - place.t
            corner = self.at_corner(place.t, trial.t)
            self.accept(place, trial, smooth=not (changes or corner or brief))
            place = trial
            if brief and not (changes or corner):
                self.goes_on(place)
            if changes or corner:
                again = again + 1 if place.t - last <= SAME * self.end else 0
                last = place.t
                place = self.beyond(place, changes)
                self.behind = self.eq.rubs
                if self.log.due:
                    break
                if place is None or again > AGAIN or self.log.reason:
                    self.stop(trial, changes)
                    break
            h = min(max(h, 2.0 * long), self.longest) if not changes else max(h, self.every)
            yield from self.block(BLOCK)
        else:
            self.kept(place, None)
            self.between.end()
        yield from self.block(0)

    def step(self, place: Place, h: float) -> tuple[Place, list[Change], float, bool] | None:
        """The end of the next step, of h or shorter, and what changes there; h as it became, and
        whether it is a brief one behind a corner.  None where steps shrink to nothing."""
        brief = brief_step(self.eq, place, self.every) if self.behind else 0.0
        self.behind = False
        bent: list[tuple[float, Place, list[Change], float]] = []
        while True:
            to = self.until(place.t, brief or h)
            trial = self.reached(place, to)
            if trial is not None and not self.looks.passed_over(place, trial):
                changes = self.changed(trial)
                off = bend(self.eq, place, trial) if not (brief or changes) else 0.0
                if off <= (BENT_TURNING if self.eq.turning else BENT):
                    return trial, changes, h, brief > 0.0
                bent.append((off, trial, changes, h))
                if len(bent) > PARTED and off > STILL * bent[0][0]:
                    break  # forces jump where it begins
                if self.eq.turning and by_rates([one[0] for one in bent]):
                    break
            elif bent:
                break
            self.rejected += 1
            h = h if brief else 0.5 * (to - place.t)
            brief = 0.0
            if h < SHORTEST * self.end:
                return None
        _, trial, changes, h = bent[0]  # no shorter step tells more
        return trial, changes, h, False

    def first(self) -> Place:
        """The place where it begins, with the directions in which it goes on."""
        eq, y = self.eq, self.begun.y
        poses(eq.work, y)
        self.looks.closed = {e: False for e in self.looks.closed}
        none = np.zeros((0, 0))
        start = Place(self.t0, y, np.zeros(eq.m), none, none, np.zeros(eq.n), np.zeros(eq.m))
        self.looks.take(start, None)
        found = eq.solved(self.t0, y, eq.multipliers(self.t0, y), None)
        place = eq.place(self.t0, *found) if found is not None else None
        if place is None:
            raise self.nowhere()
        place = directed(self.eq, place, self.every)
        self.looks.hold_all(place)
        if not eq.rubs:  # on the pieces ahead
            place = eq.place(self.t0, place.y, place.lam) or place
        self.looks.directions(place)
        out = self.results.out(place, place.v * 0.0) if self.hears else None
        self.looks.sides(place, out)
        self.judge(place)
        self.log.astray(place, self.scenario.initial.values)
        if self.looks.sense == -1.0:
            told = f"the equilibrium is unstable{self.log.where(place)}"
            self.log.falls.append((self.t0, told))
        return place

    def nowhere(self) -> ModelError:
        """That there is no balance to begin with."""
        return ModelError(
            "no equilibrium at the start that a path could begin at",
            "does something hold every load, and every body?  `trsim statics` tells more",
            ("solver", "method"),
        )

    def until(self, t: float, h: float) -> float:
        """Where a step of h ends, at the latest."""
        row = (np.floor(t / self.every * (1.0 + SAME) + SAME) + 1.0) * self.every
        ends = min(self.end, float(row))
        work = self.eq.work
        if len(work.feature):
            ends = min(ends, float(next_time(work, t, self.end)))
        for event, value in zip(self.looks.events, self.looks.value, strict=True):
            if event.entry == TIME and event.kind == "time" and value > t:
                ends = min(ends, value)
        return ends if t + 1.001 * h >= ends else t + h

    def reached(self, place: Place, t: float, within: float = 0.0) -> Place | None:
        """The place at t, on the same branch; None where it is not found.

        within: a way that is known to be long enough; then nothing else is asked."""
        eq, h = self.eq, t - place.t
        y = eq.at_time(eq.moved(place.y, h * place.v), place.t, t)
        lam = place.lam + h * place.lam_rate
        found = None
        turns = eq.turning and place.came is not None and self.slides(place)
        if turns:
            eq.anchor, eq.close = second_order(eq, place, h), None
        if eq.close is not None and self.way(place.y, y) < CLOSE_AHEAD:
            far, eq.anchor, eq.close = eq.anchor, eq.close, None
            found = eq.solved(t, y, lam, place.inverse)
            eq.anchor = eq.anchor if found is not None else far
        if found is None:
            found = eq.solved(t, y, lam, place.inverse)
        found = found or eq.solved_sticking(t, y, lam, place, self.looks.slow)
        if found is None:
            return None
        far, off = self.way(place.y, found[0]), self.way(y, found[0])
        if far > within if within else far > FAR or off > max(ASTRAY * far, BESIDE):
            return None
        there = eq.place(t, *found)
        if there is None or (not within and self.looks.hidden(place, there)):
            return None
        if eq.turning and not turns and self.slides(there):
            for _ in range(2 if eq.surfaces or len(eq.lines) else 1):
                there = eq.along_itself(there, SEEN * self.end)
        there.came = came_by(eq, place, there)
        return there

    def inside(self, first: Place, last: Place, t: float) -> Place | None:
        """The place at t between two that are known, with directions from where they were taken; of
        how the path goes on there nothing is found, unless friction that turns needs it."""
        eq, h = self.eq, t - first.t
        anchor = eq.anchor
        eq.anchor = anchor if last.anchor is None else last.anchor
        try:
            if eq.turning and self.slides(first):
                return self.reached(first, t)
            y = eq.at_time(eq.moved(first.y, h * first.v), first.t, t)
            found = eq.solved(t, y, first.lam + h * first.lam_rate, first.inverse)
        finally:
            eq.anchor = anchor
        if found is None or self.way(y, found[0]) > max(ASTRAY * self.way(first.y, y), BESIDE):
            return None
        return replace(first, t=t, y=found[0], lam=found[1])

    def slides(self, place: Place) -> bool:
        """Whether all that rubs slides, in full."""
        return self.looks.all_slide(place) and self.is_full(place)

    def is_full(self, place: Place) -> bool:
        """Whether friction on all surfaces and seals is that of full sliding.

        On a line that turns directions differ, and their sum is less than that.
        """
        if not self.eq.lines_slide(place.y):
            return False
        if not self.eq.surfaces:
            return True
        out = self.results.out(place, 0.0 * place.v)
        return all(out[rub] >= FULL * mu * out[load] for mu, load, rub in self.eq.surfaces)

    def way(self, y: Array, y1: Array) -> float:
        """The furthest way of a body, rad or of the mechanism's size."""
        return self.eq.ways(y, y1)[1]

    def changed(self, place: Place) -> list[Change]:
        out = self.results.out(place, 0.0 * place.v) if self.hears else None
        return self.looks.changes(place, out, side_of(*stability(self.eq, place)))

    def looked_inside(self, place: Place, trial: Place) -> tuple[Place, list[Change]] | None:
        """The first place inside a step at which a channel has passed what an event watches it
        for, and what changes there."""
        within = 2.0 * self.way(place.y, trial.y) + BESIDE
        times, values = [place.t], [self.heard(place)]
        for k in range(1, PARTS + 1):
            at = place.t + k / PARTS * (trial.t - place.t)
            there = self.reached(place, at, within) if k < PARTS else trial
            if there is None:
                continue
            times, values = [*times[-2:], there.t], [*values[-2:], self.heard(there)]
            dips = bottoms(times, values, self.looks.side) if len(times) == 3 else []
            bottom = (self.reached(place, t, within) for t in dips)
            inside = (p for p in (*bottom, there) if p is not None and p.t < trial.t)
            for one in sorted(inside, key=lambda p: p.t):
                if found := self.changed(one):
                    return one, found
        return None

    def heard(self, place: Place) -> dict[int, float]:
        """What events watch of channels, less its value, where they wait for it."""
        values = self.looks.values(place, self.results.out(place, 0.0 * place.v))
        return {k: values[k][0] for k in self.looks.waiting}

    def narrowed(
        self, place: Place, trial: Place, changes: list[Change]
    ) -> tuple[Place, list[Change]]:
        """The first place at which something has changed, and what."""
        low = place
        while trial.t - low.t > SAME * self.end:
            # where friction turns, directions are those of one step all the way
            start = place if self.eq.turning else low
            within = 2.0 * self.way(start.y, trial.y) + BESIDE
            middle = self.reached(start, 0.5 * (low.t + trial.t), within)
            if middle is None:
                break
            found = self.changed(middle)
            if found:
                trial, changes = middle, found
            else:
                low = middle
        return trial, changes

    def at_corner(self, t0: float, t1: float) -> bool:
        """Whether the time met a corner of a function at the end of a step."""
        work = self.eq.work
        if not len(work.feature):
            return False
        return float(next_time(work, t0, 2.0 * self.end)) <= t1 * (1.0 + SAME)

    def beyond(self, place: Place, changes: list[Change]) -> Any:
        """The same place as it goes on behind what changes there; None where it does not."""
        eq, looks = self.eq, self.looks
        for change in changes:
            self.log.note(place, change)
        if self.log.reason or self.log.due:
            return place
        eq.set_phases(looks.closed)
        if self.log.letting_go:
            return self.let_go(place)
        if all(change.kind == RUB for change in changes) and changes:
            anchored(self.eq, place, self.every, least=0.0)
            self.results.turned = True
            return place
        if all(change.kind == WATCH for change in changes) and changes:
            self.goes_on(place)  # smoothly
            return place
        looks.hold_all(place)
        found = eq.solved(place.t, place.y, place.lam, None)
        if found is None:
            return None
        jump = self.way(place.y, found[0])
        if jump > BESIDE:
            text = f"the path jumps by {jump:.3g} of the mechanism's size"
            self.log.falls.append((place.t, text))
            self.results.jumped = True
        there = eq.place(place.t, *found)
        if there is not None:
            self.judge(there)
            anchored(self.eq, there, self.every)
        return there

    def let_go(self, place: Place) -> Place:
        """The place as it goes on without drives that let go there, unless the path ends."""
        before, log = self.eq, self.log
        mechanism, gone = self.held.without(log.letting_go)
        log.letting_go = []
        if not gone:
            return place
        eq = Equations(mechanism, SimpleNamespace(y=place.y, mem=before.work.mem,
                                                  branch=before.work.branch))  # fmt: skip
        eq.small, eq.anchor, eq.load = before.small, before.anchor, before.load
        self.change_to(eq)
        self.looks.hold_all(place)
        found = eq.solved(place.t, place.y, kept(before, eq, place.lam), None)
        there = eq.place(place.t, *found) if found is not None else None
        jump = self.way(place.y, there.y) if there is not None else 0.0
        ends = self.ends_without(there, jump)
        if there is None or ends:
            self.change_to(before)
            at = f"t = {place.t:.9g} s{log.where(place)}"
            log.status, log.reason = "released", why(gone, at, ends)
            return place
        if jump > BESIDE:
            what = f"{', '.join(gone)} let go, and the path jumps by {jump:.3g} of"
            log.falls.append((place.t, f"{what} the mechanism's size"))
            self.results.jumped = True
        self.results.go_on_with(eq, there)
        anchored(self.eq, there, self.every)
        return there

    def ends_without(self, there: Place | None, jump: float) -> str:
        """Why a path does not go on where drives let go; empty where it does."""
        if there is None:
            return "nothing holds it there, and no equilibrium is near"
        self.judge(there)
        if self.looks.sense < 0.0:
            return "the equilibrium is unstable without, and the mechanism goes on by itself"
        if not self.held.still:
            return ""
        left = "nothing is left that follows t, and the mechanism rests"
        return f"{left} {jump:.3g} of its size away" if jump > BESIDE else f"{left} there"

    def change_to(self, eq: Equations) -> None:
        """Follow the path by other equations."""
        self.eq = self.looks.eq = self.log.eq = eq
        self.looks.work = eq.work

    # --- what is kept --------------------------------------------------------------------------

    def accept(self, place: Place, trial: Place, smooth: bool) -> None:
        """Keep the place that was known last, with accelerations by those next to it."""
        self.kept(place, trial, smooth)
        work = self.eq.work
        poses(work, trial.y)
        work.branch[:] = work.S[:, 0]
        self.log.go_on(trial)
        self.before = place
        if not smooth:
            self.kept(trial, None)
            self.between.end()
            self.before = None
        else:
            self.goes_on(trial, not kinked(self.eq, place, trial))

    def goes_on(self, place: Place, smooth: bool = False) -> None:
        """Judge a place, and take directions from it."""
        self.judge(place)
        anchored(self.eq, place, self.every, smooth)

    def kept(self, place: Place, after: Place | None, smooth: bool = False) -> None:
        """Keep a place; smooth: the way from there to the place after has no corner."""
        a = slope(self.before, place, after, APART * self.every)
        row = round(place.t / self.every)
        at_row = row >= self.next_row and abs(place.t - row * self.every) <= SAME * self.end
        out = self.results.keep(place, a, at_row)
        self.between.add(place)
        if at_row:  # between rows a path may have a corner, or an end at which it has no speed
            steady = slope(self.before, place, after, STEADY * self.every)
            self.results.inertia(place, steady)
        elif smooth and self.before is not None and after and not kinked(self.eq, place, after):
            self.results.inertia(place, slope(None, place, after, APART * self.every))
        self.results.touching(place, out, self.looks.closed)
        if at_row:
            self.next_row = row + 1

    def judge(self, place: Place) -> None:
        """Take the lowest eigenvalue."""
        sign, value = stability(self.eq, place)
        self.looks.sense = side_of(sign, value)
        if np.isfinite(value) and value < self.lowest[0]:
            self.lowest = value, place.t

    def stop(self, place: Place, changes: Any = None) -> None:
        """The path ends before its time: at a place that is not kept yet, or behind changes."""
        if changes is None:
            found = None if self.log.reason else fold(self.eq, place, self.end)
            self.kept(place, found)
            if found is not None:
                self.before = place
                self.kept(found, None)
            place = found or place
            self.log.ended(place, found is not None, ())
        else:
            self.log.ended(place, False, changes)
        self.last_row(place)

    def last_row(self, place: Place) -> None:
        """A row where the path ends between two of them."""
        rows = self.results.rows
        if rows and rows[-1][0] < place.t * (1.0 - SAME):
            self.results.rows.append(
                np.concatenate([[place.t], self.results.out(place, np.zeros(self.eq.n))])
            )
            self.results.rows[-1][-1] -= self.results.zero

    def block(self, least: int) -> Generator[Block, None, None]:
        """What was kept since the last one, where that is enough."""
        kept = self.results
        if least and len(kept.rows) < least:
            return
        work = self.eq.work
        wide = 2 + int(np.max(work.contact_width, initial=0))
        yield Block(
            np.array(kept.rows).reshape(-1, 1 + work.n_out),
            np.array(kept.steps).reshape(-1, wide),
            np.array(self.log.events).reshape(-1, rec.N_EVENT),
            kept.last.t if kept.last else 0.0, 0.0, len(self.log.events),
            np.array(kept.recorded).reshape(-1, 2 + work.n_out), np.zeros((0, rec.N_POINT)),
        )  # fmt: skip
        kept.rows, kept.steps, kept.recorded = [], [], []
        self.log.events = []
