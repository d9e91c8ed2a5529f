"""Static phases of a run: a path that is followed from the record of the run, and comes back to it.

A static phase begins in the balance next to where the run is, and goes on to the event that ends
it, or to any other: what an event does is for the run to do (march/act.py).  What moves as it
begins is stopped there, and what moves along the path goes on at its speed behind it; kinetic
energy that is left out, or comes in, counts as the work of events.
"""

import json
from collections.abc import Generator, Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import kinetic, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.switches import CHANNEL, TIME
from trsim.assemble.tables import BAND_AT, VALUE_AT
from trsim.elements.contract import (
    CONTACT,
    FLIGHT,
    IMPACT_SPEED,
    N_BOOK,
    PHASE,
    UNLOCATED,
    ContactNumbers,
)
from trsim.elements.scene import Scene
from trsim.errors import FileError, ModelError
from trsim.solve.march import record as rec
from trsim.solve.march.act import total_energy
from trsim.solve.march.checkpoint import ANEW, UNFIT, State
from trsim.solve.march.load_steps import phase_of
from trsim.solve.march.record import Buffers, Record
from trsim.solve.outcome import Block, first_step
from trsim.solve.path.begin import check
from trsim.solve.path.changes import WATCH, Change
from trsim.solve.path.follow import BESIDE, Path
from trsim.solve.path.place import Place
from trsim.solve.path.relax import relaxed
from trsim.solve.path.told import numbers
from trsim.solve.rest import without_rates
from trsim.statuses import Ended

Array = NDArray[np.float64]


KEPT = "walks"  # of a checkpoint
Way = tuple[int, tuple[Ended, str] | None]


class Walks:
    """The static phases of a run: what is told of them."""

    def __init__(self, scenario: Any, mechanism: Mechanism, located: bool) -> None:
        """located: whether the motion finds where contacts close and open."""
        check(scenario, mechanism)
        self.scenario, self.mechanism, self.located = scenario, mechanism, located
        self.said: tuple[str, ...] = ()
        self.numbers: dict[str, float] = {}
        self.moving = False  # whether the run moved since the last one

    def kept(self) -> State:
        """All this as an array, a part of a checkpoint."""
        told = json.dumps([self.said, self.numbers, self.moving])
        return {KEPT: np.frombuffer(told.encode(), np.uint8)}

    def put_back(self, checkpoint: State) -> None:
        """Go on as a checkpoint says.  Raises FileError where it has nothing of static phases."""
        try:
            said, self.numbers, self.moving = json.loads(checkpoint[KEPT].tobytes())
        except (KeyError, ValueError):
            raise FileError(f"{UNFIT}: {KEPT}", ANEW) from None
        self.said = tuple(said)

    def on_path(self, r: Record) -> bool:
        """Whether the phase in force is a static path."""
        static = self.mechanism.stages.switches.static[phase_of(self.mechanism, r)]
        self.moving = self.moving or not static
        return static

    def walk(self, work: Scene, r: Record, b: Buffers) -> Generator[Block, None, Way]:
        """Follow the path of the phase in force from the record, and bring the record to its end.

        Returns why it ended, ACT or DONE; and status and reason where the run ends there.
        """
        path = PhasePath(self.scenario, self.mechanism, work, r)
        try:
            yield from path.run()
        except ModelError as error:
            return rec.DONE, ("failed", error.what)
        hand_back(path, work, r, b)
        touches(path, work, r, self.located)
        r.h = first_step(self.scenario, r)
        self.said += (*path.of_begin(self.moving), *path.log.said())
        self.numbers = stricter(self.numbers, numbers(path))
        self.moving = False
        ended = (path.log.status, path.log.reason) if path.log.reason else None
        return rec.ACT if path.log.due else rec.DONE, ended


def stricter(one: dict[str, float], other: dict[str, float]) -> dict[str, float]:
    """The lowest eigenvalue, and the largest ratio of inertia, of both."""
    if other.get("lowest_eigenvalue", np.inf) > one.get("lowest_eigenvalue", np.inf):
        other = {k: v for k, v in other.items() if not k.startswith("lowest")}
    if other.get("inertia_ratio", 0.0) < one.get("inertia_ratio", 0.0):
        other = {k: v for k, v in other.items() if not k.startswith("inertia")}
    return one | other


class PhasePath(Path):
    """A path from the state of a record, to the next event."""

    def __init__(self, scenario: Any, mechanism: Mechanism, work: Scene, r: Record) -> None:
        there = mechanism.in_stage(r.stage, r.left_out)
        y, first = without_rates(mechanism, r.y), work.n_q
        begun = SimpleNamespace(y=y, mem=r.mem.copy(), branch=r.branch.copy())
        super().__init__(scenario, there, begun, float(r.t))
        self.name = mechanism.stages.switches.phases[phase_of(mechanism, r)]
        self.begun_at, self.begun_with = begun.y, total_energy(work, float(r.t), r.y)
        self.next_row = int(r.next_row)
        self.band = work.watch_at[:, BAND_AT].copy()
        self.jumps = int(work.jumps)
        looks, results = self.looks, self.results
        for k, event in enumerate(looks.events):
            if event.lasts:
                looks.value[k] = float(r.watch[k, rec.DUE] or work.watch_at[k, VALUE_AT])
            counts = event.phase in (-1, phase_of(mechanism, r)) and event.role != "stall"
            looks.left[k] = event.most - r.watch[k, rec.TIMES] if counts else 0.0
        self.log.hands_over = True
        first_gap = len(work.contact)
        self.seen = r.gap[first_gap : first_gap + len(looks.events), 0].copy()
        results.works[:] = y[first + work.n_v : first + work.n_v + N_BOOK]
        results.begun, results.zero = True, float(r.energy_0 + r.work_projection)
        self.zero, self.way_of_begin = results.zero, 0.0

    def first(self) -> Place:
        """The balance next to the state of the record, and the sides of what is watched."""
        try:
            place = super().first()
            unlike = self.way(self.begun_at, place.y) > BESIDE
        except ModelError:
            unlike = True
        if unlike:  # Newton's method may have found any balance
            self.begun.y = relaxed(self.eq, self.t0, self.begun_at)
            self.log.falls.clear()
            place = super().first()
        self.way_of_begin = self.way(self.begun_at, place.y)
        rests = without_rates(self.mechanism, place.y)
        self.add(place.y, total_energy(self.eq.work, place.t, rests) - self.begun_with)
        self.take_sides(place)
        self.begun_in = place
        if self.way_of_begin > BESIDE:
            self.jumped_over(place)
        return place

    def jumped_over(self, place: Place) -> None:
        """Let events happen whose values lie on the way to the balance it begins in."""
        for k, (event, seen) in enumerate(zip(self.looks.events, self.seen, strict=True)):
            side = self.looks.side[k]
            if self.looks.left[k] > 0 and event.entry != TIME and side * seen < 0.0:
                self.log.note(place, Change(WATCH, k, side))

    def last(self) -> Place:
        """The place it came to."""
        return self.results.last or self.begun_in

    def add(self, y: Array, energy: float) -> None:
        """Count an energy as the work of events, J."""
        y[self.eq.work.n_q + self.eq.work.n_v + self.jumps] += energy

    def nowhere(self) -> ModelError:
        return ModelError(
            f"phase '{self.name}' is static, and no equilibrium is near where it begins, at "
            f"t = {self.t0:.9g} s: does something hold every load, and every body?",
            "",
            ("phases",),
        )

    def take_sides(self, place: Place) -> None:
        """The sides of what rests on its value, once it leaves it."""
        out = self.results.out(place, place.v * 0.0) if self.hears else None
        for k, (x, rate) in enumerate(self.looks.values(place, out)):
            event, band = self.looks.events[k], float(self.band[k])
            if event.kind == CHANNEL:
                band = self.scenario.solver.tolerance * max(abs(event.value), abs(x + event.value))
            if abs(x) <= band:
                leaves = np.isfinite(rate) and rate != 0.0
                self.looks.side[k] = float(np.sign(rate)) if leaves else 0.0
            elif self.looks.side[k] == 0.0:
                self.looks.side[k] = float(np.sign(x))

    def accept(self, place: Place, trial: Place, smooth: bool) -> None:
        super().accept(place, trial, smooth)
        if smooth and not all(self.looks.side.values()):
            self.take_sides(trial)

    def of_begin(self, moved: bool) -> Iterator[str]:
        """What is left out where a motion is put into balance."""
        far = self.way_of_begin > BESIDE
        if moved or far:
            way = f"the mechanism moves by {self.way_of_begin:.3g} of its size, and " if far else ""
            yield (
                f"phases.{self.name}: at t = {self.t0:.9g} s it begins in balance: {way}its motion "
                "is left out"
            )


def hand_back(path: PhasePath, work: Scene, r: Record, b: Buffers) -> None:
    """Bring the record to the end of a path: its place, and the speed it has there."""
    place, results, first = path.last(), path.results, work.n_q
    r.t, r.y[:] = place.t, place.y
    r.y[first : first + work.n_v] = place.v
    r.y[first + work.n_v : first + work.n_v + N_BOOK] = results.works
    r.branch[:] = path.eq.work.branch
    poses(work, r.y)
    path.add(r.y, results.zero - path.zero + float(kinetic(work, r.y)))
    happened(path, work, r)
    r.next_row = path.next_row
    r.steps, r.rejected = r.steps + path.steps, r.rejected + path.rejected
    r.events += path.log.count
    work.status[1] += path.eq.work.status[1]
    r.largest_energy = max(r.largest_energy, results.largest_energy)
    r.largest_residual = max(r.largest_residual, results.largest_residual)
    for k, x in ((rec.PEAK_MAX, 1.0), (rec.PEAK_MIN, -1.0)):
        further = x * results.peak[k] > x * r.peak[k]
        r.peak[k : k + 2, further] = results.peak[k : k + 2, further]
    b.out[: work.n_out] = results.now


def touches(path: PhasePath, work: Scene, r: Record, located: bool) -> None:
    """Contacts as the path has left them; one that is in was touched at the slowest speed."""
    for c, e in enumerate(work.contact.tolist()):
        inside = path.looks.closed[e]
        r.mem[e, PHASE] = (CONTACT if inside else FLIGHT) if located else UNLOCATED
        slowest = max(float(ContactNumbers(work, c).slowest_impact), 0.0)
        r.mem[e, IMPACT_SPEED] = slowest if inside else 0.0


def happened(path: PhasePath, work: Scene, r: Record) -> None:
    """What user events watch, and those that happen at the end of the path."""
    place, looks = path.last(), path.looks
    out = path.results.now if path.hears else None
    for k, (x, rate) in enumerate(looks.values(place, out)):
        r.gap[len(work.contact) + k] = x, rate if np.isfinite(rate) else 0.0
        r.watch[k, rec.SIDE] = looks.side[k]
    for k, rate in path.log.due:
        r.watch[k, rec.SIDE] = 0.0
        r.watch[k, rec.TIMES] += 1.0
        r.watch[k, rec.JUST_NOW] = 1.0
        r.watch[k, rec.SLOPE] = rate if np.isfinite(rate) else 0.0
