"""Functions with waves or pulses, where a section or an event looks at what they move.

Whatever they move swings as they do: a force, an acceleration, a reaction.  Steps are followed
through it in as many parts as the fastest of their waves asks for (march/sampled.py).
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from trsim.assemble.jumps import NOBODY, driven
from trsim.elements.contract import SCENE, compiled
from trsim.elements.prescribed import began
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A2, f8, float64
from trsim.laws.functions import slots_of
from trsim.laws.waves import pulses, swing

AT, DRIVE = range(2)  # columns of wave and pulse


class Swinging(NamedTuple):
    """A function that may swing."""

    offset: int
    code: list[float]  # numbers for `tab`
    drive: int = -1  # the row of the drive it is a motion of


Found = Sequence[Swinging]
#                scene  t   s   shown
SWINGS = float64(SCENE, f8, f8, A2)
call_swings = caller(SWINGS)


@compiled(SWINGS)
def swings(s, t, length, shown):
    """The fastest wave, rad/s, in `length` s from t on.

    shown: (4, n_s), what the sensors show when that begins, and its rates, and the same at its end.
    """
    return fastest_of(s, s.wave, 1, (t, length), shown)


@compiled(SWINGS)
def beats(s, t, length, shown):
    """The same of pulses in loads and drives."""
    return fastest_of(s, s.pulse, 0, (t, length), shown)


@internal
def fastest_of(s, table, waves, stretch, shown):
    """The fastest of the functions in force; waves: 0 where pulses alone count."""
    most, before, behind = 0.0, (shown[0], shown[1]), (shown[2], shown[3])
    for k in range(table.shape[0]):
        since = began(s, table[k, DRIVE], table[k, AT])
        if since >= 0.0:
            own = (stretch[0] - since, stretch[1])
            w = swing(s.tab, table[k, AT], own, before, behind, (waves, s.swing_box))
            most = max(most, w)
    return most


def swinging(at: Any, instances: list[Any], found: Found) -> list[Swinging]:
    """Functions with the drives whose motions they are."""
    own = driven(at, instances) if found else {}
    return [one._replace(drive=own.get(one.offset, NOBODY).e) for one in found]


def followed(found: Found) -> dict[str, Any]:
    """Fields of a model, of functions whose waves are followed."""
    return {
        "wave": rows(found),
        "wave_slots": most_slots(found),
        "swings_at": swings.address() if found else 0,
    }


def pulsed(found: Found) -> dict[str, Any]:
    """Fields of a model, of functions that move something and whose pulses no step passes over."""
    found = [one for one in found if pulses(one.code)]
    return {
        "pulse": rows(found),
        "pulse_slots": most_slots(found),
        "beats_at": beats.address() if found else 0,
    }


def rows(found: Found) -> Any:
    """(n, 2) offset, and the row of the drive it is a motion of, or -1."""
    return np.array([(one.offset, one.drive) for one in found], np.int64).reshape(-1, 2)


def most_slots(found: Found) -> int:
    """Of the longest of them."""
    return max((slots_of(one.code) for one in found), default=0)
