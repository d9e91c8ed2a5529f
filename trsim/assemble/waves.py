"""Functions with waves or pulses, where a section or an event looks at what they move.

Whatever they move swings as they do: a force, an acceleration, a reaction.  Steps are followed
through it in as many parts as the fastest of their waves asks for (march/sampled.py).
"""

from typing import Any

import numpy as np

from trsim.elements.contract import SCENE, compiled
from trsim.kernels.calls import caller
from trsim.kernels.signatures import A1, f8, float64
from trsim.laws.functions import SLOTS
from trsim.laws.waves import pulses, swing

Found = list[tuple[int, list[float]]]  # offset, and numbers for `tab`
SWINGS = float64(SCENE, f8, f8, A1, A1, A1, A1)
call_swings = caller(SWINGS)


@compiled(SWINGS)
def swings(s, t, length, S0, rate0, S1, rate1):
    """The fastest wave, rad/s, from t on: what the sensors show, and its rate, at t and `length`
    later."""
    most = 0.0
    for k in range(s.wave.size):
        w = swing(s.tab, s.wave[k], (t, length), (S0, rate0), (S1, rate1), (1, s.wave_box))
        most = max(most, w)
    return most


@compiled(SWINGS)
def beats(s, t, length, S0, rate0, S1, rate1):
    """The same of pulses in loads and drives."""
    most = 0.0
    for k in range(s.pulse.size):
        w = swing(s.tab, s.pulse[k], (t, length), (S0, rate0), (S1, rate1), (0, s.pulse_box))
        most = max(most, w)
    return most


def followed(found: Found) -> dict[str, Any]:
    """Fields of a model, of functions whose waves are followed."""
    return {
        "wave": np.array([offset for offset, _ in found], np.int64),
        "wave_slots": most_slots(found),
        "swings_at": swings.address() if found else 0,
    }


def pulsed(found: Found) -> dict[str, Any]:
    """Fields of a model, of functions that move something and whose pulses no step passes over."""
    found = [(offset, code) for offset, code in found if pulses(code)]
    return {
        "pulse": np.array([offset for offset, _ in found], np.int64),
        "pulse_slots": most_slots(found),
        "beats_at": beats.address() if found else 0,
    }


def most_slots(found: Found) -> int:
    """Of the longest of them."""
    return max(((len(code) - int(code[SLOTS])) // 3 for _, code in found), default=0)
