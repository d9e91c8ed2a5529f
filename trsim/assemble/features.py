"""Functions with corners: where they are, when the time alone meets them, and what holds them.

    feature   0 offset in tab, 1 row of the drive whose time counts, or -1, 2 first of its instants,
              3 behind the last, 4 first of its entries of `held`, 5 behind the last,
              6 whether sensors meet corners,
              7 whether it reads sensors at all,
              8 state of z with the rate of a piston against the motion of its supply, or -1
    instant   0, then the instants of a function in rising order, then the end of the run
    jump      by how much the place and the rate of a motion jump there        jumps.py
    held      places in tab of what each corner is held on (laws/functions.py)
    sensed    of the sensors that meet corners: entry of S, kind of quantity, instance (travel.py)

A function that is held on the pieces it is on is smooth: a step never sees a corner, and ends
where one is met (solve/march/features.py).  Unless a run holds them, functions are evaluated as
written.
"""

from typing import Any

import numpy as np

from trsim.assemble.jumps import NOBODY, driven
from trsim.assemble.travel import ANGLES, RATE_OF, of_instance, of_rate
from trsim.elements.contract import SCENE, Pair, compiled
from trsim.elements.prescribed import began
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import f8, i8, void
from trsim.laws.corners import corner, ends_of, located, neighbour, piece_at, sensed
from trsim.laws.functions import BY_SENSORS, FREE, hold

OFFSET, DRIVE, FIRST, BEHIND, HELD_FROM, HELD_TO, SENSED, READS, PISTON, N_FEATURE = range(10)
PLACE_JUMP, RATE_JUMP = range(2)  # columns of `jump`
ENTRY, KIND, INSTANCE = range(3)  # of `sensed`
SAME = 0.5e-12  # of the run: an instant so near has been reached


def features(at: Any, instances: list[Any]) -> dict[str, Any]:
    """The tables of a model; empty where no function has corners."""
    own = driven(at, instances) if at.functions else {}
    rows: list[tuple[int, ...]] = []
    times: list[float] = []
    jumps: list[Any] = [np.zeros((0, 2))]
    held: list[int] = []
    for f in at.functions:
        first = len(times)
        times += [0.0, *f.instants, f.end]
        behind, last = len(times), len(held) + len(f.held)
        drive = own.get(f.offset, NOBODY)
        jumps.append(at.jumped.get(f.offset, np.zeros((len(times) - first, 2))))
        by_sensors, reads = int(bool(f.sensed)), int(f.reads)
        own_rows = (f.offset, drive.e, first, behind, len(held), last, by_sensors, reads)
        rows.append((*own_rows, drive.slip))
        held += f.held
    entries = sorted({k for f in at.functions for k in f.sensed})
    # sensors, and springs whose stretch is an entry of their own
    own_entries = [
        (i.row, e)
        for e, i in enumerate(instances)
        if i.section in ("sensors", "forces") and "coordinate" in i.element.kernels
    ]
    owner = {Pair.of(row).coordinate: e for row, e in own_entries}
    owner |= {row.speed: e for row, e in own_entries if row.speed >= 0}
    rates = {k: owner[source] for source, k in at.rates.items()}
    sensed = [
        (k, *(of_rate(instances, rates[k]) if k in rates else of_instance(instances, owner[k])[:2]))
        for k in entries
    ]
    return {
        "sensed": np.array(sensed, np.int64).reshape(-1, 3),
        "slots": max((f.slots for f in at.functions if f.sensed), default=0),
        "feature": np.array(rows, np.int64).reshape(-1, N_FEATURE),
        "instant": np.array(times, float),
        "jump": np.vstack(jumps),
        "held": np.array(held, np.int64),
        "on_features": np.array([hold_all.address()] if rows else [0], np.int64),
    }


HOLD = void(SCENE, f8, i8)
call_hold = caller(HOLD)


@internal
def passed(s, n, t):
    """How many instants of feature n lie at or before t; 0 where it is not in force.

    The end of the run is none of them: what follows a corner there is not run.
    """
    first, since = s.feature[n, FIRST], began(s, s.feature[n, DRIVE], s.feature[n, OFFSET])
    low, high = first, s.feature[n, BEHIND] - 1
    if since < 0.0:
        return 0
    reached = t - since + SAME * s.instant[high]
    while low < high:
        middle = (low + high) // 2
        if s.instant[middle] <= reached:
            low = middle + 1
        else:
            high = middle
    return low - first


@internal
def between(s, n, k):
    """A time of feature n between its k-th instant, counted from 1, and the next."""
    first = s.feature[n, FIRST]
    last = s.feature[n, BEHIND] - first
    if k <= 0:
        return s.instant[first]
    if k >= last:
        return s.instant[first + last - 1]
    return 0.5 * (s.instant[first + k - 1] + s.instant[first + k])


NEAR = 1e-12  # of what u is the difference of: so near to a corner rounding tells no side


@internal
def hold_sensed(s, n, t, anew):
    """Hold the corners of feature n that sensors meet, one after the other, just after t.

    What is on a corner goes on where its rate leads, and is left FREE where it has none.
    anew: not 0 where nothing was held; else only what is not on its piece is changed.
    """
    o, changed = s.feature[n, OFFSET], 0
    for k in range(s.feature[n, HELD_FROM], s.feature[n, HELD_TO]):
        place = s.held[k]
        before = s.tab[place]
        if not sensed(s.tab, o, place) or (anew == 0 and before == FREE):
            continue
        located(s.tab, o, t, s.S)
        u, rate, size = corner(s.tab, o, place, s.S)
        near = NEAR * size
        low, high = ends_of(s.tab, o, place)
        if anew != 0 or not (low - near <= u <= high + near):
            s.tab[place] = piece_at(s.tab, o, place, u)
            low, high = ends_of(s.tab, o, place)
        if u - low <= near or high - u <= near:
            above = high - u <= near
            if (rate > 0.0) if above else (rate < 0.0):
                s.tab[place] = neighbour(s.tab, o, place, above)
            elif rate == 0.0 and anew != 0:
                s.tab[place] = FREE
        elif anew != 0:
            wide, slow = rounding_of(s, o, place, t)
            if high - u <= wide and rate > slow:
                s.tab[place] = neighbour(s.tab, o, place, True)
            elif u - low <= wide and rate < -slow:
                s.tab[place] = neighbour(s.tab, o, place, False)
        changed += int(s.tab[place] != before)
    return changed


@internal
def rounding_of(s, o, place, t):
    """How near to a corner, and how slow, u may be by the rounding of what sensors show.

    A stroke that is zero as drawn is the difference of places as far as the mechanism is large;
    what `corner` says of its size is next to nothing.  How u goes with a sensor is told by its rate
    when that of the sensor is 1 more.  Rates of sensors are left out: how they change is not known.
    """
    v = w = 0.0
    for f in range(1, s.n):
        for c in range(3):
            v, w = max(v, abs(s.V[f, c])), max(w, abs(s.V[f, 3 + c]))
    v, near, slow = v + w * s.size, 0.0, 0.0
    located(s.tab, o, t, s.S)
    _, before, _ = corner(s.tab, o, place, s.S)
    for k in range(s.sensed.shape[0]):
        if s.sensed[k, KIND] >= RATE_OF:
            continue
        entry = s.sensed[k, ENTRY]
        own = s.S[entry, 1]
        s.S[entry, 1] = own + 1.0
        located(s.tab, o, t, s.S)
        _, rate, _ = corner(s.tab, o, place, s.S)
        s.S[entry, 1] = own
        scale = 1.0 if s.sensed[k, KIND] in ANGLES else s.size
        near += NEAR * abs(rate - before) * scale
        slow += NEAR * abs(rate - before) * v * scale / s.size
    return near, slow


@compiled(HOLD)
def hold_all(s, t, which):
    """Hold all functions on the pieces they are on just after t, at the poses of the scene.

    which: BY_TIME or BY_SENSORS, the corners to look at.
    """
    for n in range(s.feature.shape[0]):
        if which == BY_SENSORS:
            if s.feature[n, SENSED] > 0:
                hold_sensed(s, n, t, 1)
            continue
        hold(s.tab, s.feature[n, OFFSET], between(s, n, passed(s, n, t)), s.S, which)
