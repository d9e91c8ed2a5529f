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
from trsim.laws.waves import swing

SWINGS = float64(SCENE, f8, f8, A1, A1, A1, A1)
call_swings = caller(SWINGS)


@compiled(SWINGS)
def swings(s, t, length, S0, rate0, S1, rate1):
    """The fastest wave, rad/s, from t on: what the sensors show, and its rate, at t and `length`
    later."""
    most = 0.0
    for k in range(s.wave.size):
        w = swing(s.tab, s.wave[k], (t, length), (S0, rate0), (S1, rate1), s.wave_box)
        most = max(most, w)
    return most


def followed(found: list[tuple[int, list[float]]]) -> dict[str, Any]:
    """Fields of a model, of functions that are followed: offset, and numbers for `tab`."""
    slots = [(len(code) - int(code[SLOTS])) // 3 for _, code in found]
    return {
        "wave": np.array([offset for offset, _ in found], np.int64),
        "wave_slots": max(slots, default=0),
        "swings_at": swings.address() if found else 0,
    }
