"""A function as it is packed: whether it has corners, and when the time alone meets them."""

from typing import Any, NamedTuple

from trsim.instants import distinct, instants
from trsim.laws.functions import (
    BY_SENSORS,
    CONSTANT,
    HEAD,
    HELD,
    HELD_OF_TABLE,
    N_IN,
    N_OP,
    UNWATCHED,
    VARIABLE,
    WATCHED,
    WIDTH,
    slots_of,
)


class Cornered(NamedTuple):
    """A function with corners."""

    offset: int
    instants: list[float]  # in rising order, inside the run
    held: list[int]  # places in tab
    sensed: tuple[int, ...]  # entries of S that meet some of them
    end: float
    slots: int
    reads: bool  # whether it depends on sensors


def cornered(spec: Any, code: list[float], offset: int, end: float) -> list[Cornered]:
    """A function, if it has corners.  Raises ScenarioError where they cannot be told."""
    if code[0] == CONSTANT:  # as it is written, or once its constant parts are folded
        return []
    if spec.kind == "table":
        of_t, held = spec.of == "t", [offset + HELD_OF_TABLE]
        times = distinct(list(spec.x), end) if of_t else []
        by = () if of_t else (int(code[VARIABLE]),)
        return [Cornered(offset, times, held, by, end, 0, not of_t)]
    n_in = int(code[N_IN])
    places = range(HEAD + n_in, HEAD + n_in + WIDTH * int(code[N_OP]), WIDTH)
    watched = [p for p in places if code[p + WATCHED] != UNWATCHED]
    if not watched:
        return []
    inputs = code[HEAD : HEAD + n_in]
    by_sensors = any(code[p + WATCHED] == BY_SENSORS for p in watched)
    sensed = tuple(int(k) for k in inputs) if by_sensors else ()
    held = [offset + p + HELD for p in watched]
    slots = slots_of(code)
    return [Cornered(offset, instants(spec.node, end), held, sensed, end, slots, n_in > 0)]
