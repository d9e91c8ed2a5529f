"""Jumps of prescribed motions at the corners of their functions: seen before the run.

    position jumps      refused of a rigid drive, which would take the mechanism with it in no time
    velocity jumps      an impulse: told, and its work is booked             solve/march/features.py

A drive that gives way may jump in place: its force does, and the energy in its spring.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.sizes import Sizes
from trsim.elements.contract import compiled
from trsim.elements.prescribed import AnyDrive
from trsim.errors import ScenarioError, some
from trsim.kernels.signatures import A1, A2, i8, void
from trsim.laws.functions import BY_TIME, EXPRESSION, HEAD, N_IN, N_OP, WIDTH, hold, motion
from trsim.laws.operations import ATAN2, COS, DIV, EXP, LOG, POW, SIN, SQRT, TAN
from trsim.scenario.methods import METHODS

Array = NDArray[np.float64]

STEEP = frozenset({DIV, POW, ATAN2, SQRT, SIN, COS, TAN, EXP, LOG})
TORN = 1e-6  # of the mechanism's size, rad: more is a jump in place, less the rounding of numbers
SUDDEN = 1e-6  # of the largest rate of a motion: less is no jump of it
SHOWN = 3  # jumps of one motion in a note


class Driven(NamedTuple):
    """The drive whose motion a function is."""

    e: int
    by_velocity: bool
    switched: bool  # whether an event sets it, or may take it away
    slip: int  # state of z with the rate of a piston against the motion, or -1


NOBODY = Driven(-1, False, False, -1)


def driven(at: Any, instances: list[Any]) -> dict[int, Driven]:
    """Functions that drives follow, by their offset in tab."""
    found = {}
    for e, instance in enumerate(instances):
        if instance.section != "drives":
            continue
        own = AnyDrive.of(instance.row)
        switched = bool(at.switches) and ("drives", instance.name) in at.switches.names
        found[own.motion] = Driven(e, own.state >= 0, switched, instance.row.slip)
        for state, offset in at.switches.motions.get(instance.name, ()) if at.switches else ():
            found[offset] = Driven(e, state >= 0, True, instance.row.slip)
    return found


@compiled(void(A1, i8, A1, A2, A1))
def sides(tab, offset, times, sensors, out):
    """out = f, f' at the second of three times: on the piece of the first, on that of the last."""
    hold(tab, offset, times[0], sensors, BY_TIME)
    out[0], out[1], _ = motion(tab, offset, times[1])
    hold(tab, offset, times[2], sensors, BY_TIME)
    out[2], out[3], _ = motion(tab, offset, times[1])


def jumps_of(tab: Array, offset: int, instants: list[float], by_velocity: bool) -> Array:
    """Jumps of place and rate at the instants of a function, (n, 2); 0 where there is none.

    instants: with 0 in front and the end of the run behind.
    """
    jumps, out, none = np.zeros((len(instants), 2)), np.zeros(4), np.zeros((1, 2))
    middle = 0.5 * (np.array(instants[1:]) + np.array(instants[:-1]))
    rates = np.zeros(2 * len(instants) - 1)  # at the instants and between: a motion may rest at all
    mine = [0, 2] if by_velocity else [1, 3]
    for k, t in enumerate(middle):
        sides(tab, offset, np.array([t, t, t]), none, out)
        rates[len(instants) + k] = abs(out[mine[0]])
    for k in range(1, len(instants) - 1):
        times = np.array([middle[k - 1], instants[k], middle[k]])
        sides(tab, offset, times, none, out)
        if by_velocity:
            jumps[k, 1] = out[2] - out[0]
        else:
            jumps[k] = out[2:] - out[:2]
        rates[k] = np.abs(out[mine]).max()
    jumps[np.abs(jumps[:, 1]) <= SUDDEN * np.max(rates, initial=0.0), 1] = 0.0
    return jumps


def find_jumps(at: Any, instances: list[Any]) -> dict[int, Array]:
    """Jumps of the motions with corners, by their offset in tab.

    Raises ScenarioError where the place of a rigid drive jumps, whatever events may do before.
    """
    found: dict[int, Array] = {}
    of = driven(at, instances)
    mine = [f for f in at.functions if f.offset in of and f.instants]
    if not mine:
        return found
    tab, size = np.array(at.tab), Sizes.of(at).whole  # a copy: functions are held in it
    for f in mine:
        drive = of[f.offset]
        instance, times = instances[drive.e], [0.0, *f.instants, f.end]
        jumps = jumps_of(tab, f.offset, times, drive.by_velocity)
        jumps[np.abs(jumps[:, 0]) <= TORN * min(size, 1.0), 0] = 0.0
        if not jumps.any():
            continue
        found[f.offset] = jumps
        k = int(np.argmax(np.abs(jumps[:, 0]) > 0.0))
        unit = "rad" if instance.row.turns else "m"
        if jumps[k, 0] and not instance.row.is_force and not drive.switched:
            raise ScenarioError(
                f"the prescribed position jumps by {jumps[k, 0]:.6g} {unit} at t = {times[k]:.9g} "
                "s, which no mechanism can follow",
                "let it go there in a time of its own, as `step5(t, t0, x0, t1, x1)` does, or give "
                "the drive a compliance",
                ("drives", instance.name, "position"),
            )
        if not drive.switched:  # its time may be another
            at.notes += notes(at, instance, times, jumps, f"{unit}/s")
    return found


def steep(at: Any, instances: list[Any]) -> int:
    """How many smooth motions of rigid drives by position may go far in a short time: those of
    more than sums and products."""
    count = 0
    for offset, drive in driven(at, instances).items():
        if drive.by_velocity or instances[drive.e].row.is_force or at.tab[offset] != EXPRESSION:
            continue
        first = offset + HEAD + int(at.tab[offset + N_IN])
        codes = at.tab[first : first + WIDTH * int(at.tab[offset + N_OP]) : WIDTH]
        count += bool(STEEP & {int(code) for code in codes})
    return count


def notes(at: Any, instance: Any, times: list[float], jumps: Array, unit: str) -> Iterator[str]:
    """What is said of the velocity jumps of a motion."""
    when = np.flatnonzero(jumps[:, 1])
    still = METHODS[at.scenario.solver.method].rests  # which knows no impulse
    if len(when) == 0 or instance.row.is_force or still:
        return
    place = at.scenario.place(("drives", instance.name))
    line = f"{place.show()}: " if place else ""
    each = (f"by {jumps[k, 1]:.4g} {unit} at t = {times[k]:.6g} s" for k in when)
    said = some(each, SHOWN, ", and {} times more")
    yield (
        f"{line}drives.{instance.name}: its velocity jumps {said}: an impulse, whose work is "
        "in `energy.work.events`"
    )
