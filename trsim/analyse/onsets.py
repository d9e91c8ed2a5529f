"""The contacts of two runs: how often they close, when first, and how much of the time."""

from itertools import zip_longest

import h5py
import numpy as np
from numpy.typing import NDArray

from trsim.arrays import Array
from trsim.store.certificate import Onset, Onsets
from trsim.store.read import table

FIRST = 5  # onsets that are told one by one


def changes(file: h5py.File, contact: str) -> tuple[Array, NDArray[np.bool_]]:
    """Times (s) at which a contact opens or closes, and whether it closes.

    Of a contact that is closed throughout, the beginning.
    """
    touched = len(file["steps"][contact]["time"]) > 0
    return changed(*happened(file, contact), file["time"][:touched])


def changed(
    times: Array, kind: NDArray[np.str_], throughout: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """The same of its events; throughout: the beginning of a contact that is closed without any."""
    mine = np.isin(kind, ("onset", "separation"))
    if not mine.any() and len(throughout):
        return throughout, np.array([True])
    return times[mine], kind[mine] == "onset"


def closings(file: h5py.File, contact: str) -> Array:
    """Times (s) of the onsets of a contact."""
    times, kind = happened(file, contact)
    return np.asarray(times[kind == "onset"])


def happened(file: h5py.File, contact: str) -> tuple[Array, NDArray[np.str_]]:
    """Times (s) and kinds of the events of a contact."""
    events = table(file["events"])
    mine = events["element"].astype(str) == contact
    return events["time"][mine], events["kind"][mine].astype(str)


def numbers(run: h5py.File, twin: h5py.File, before: float) -> list[Onsets]:
    """How often each contact closed, and how often before a time (s); nan is never."""
    found = []
    for name in run["steps"]:
        mine, other = closings(run, name), closings(twin, name)
        early = [int(np.count_nonzero(~(times >= before))) for times in (mine, other)]
        found.append(Onsets(name, len(mine), len(other), *early))
    return found


def first_onsets(run: h5py.File, twin: h5py.File, until: float) -> list[Onset]:
    """The first onsets of each contact, up to the time (s) both runs reached."""
    found = []
    for name in run["steps"]:
        both = [closings(file, name) for file in (run, twin)]
        lists = [times[times <= until][:FIRST].tolist() for times in both]
        for k, (mine, other) in enumerate(zip_longest(*lists, fillvalue=np.nan), 1):
            found.append(Onset(name, k, mine, other))
    return found


def closed(times: Array, closes: NDArray[np.bool_], edges: Array) -> Array:
    """The share of time in contact between neighbouring edges (s)."""
    if not len(times):
        return np.zeros(len(edges) - 1)
    # what opens first was closed before
    lengths = np.diff(times) * closes[:-1]
    before = (times[0] - min(edges[0], times[0])) * (not closes[0])
    after = (max(edges[-1], times[-1]) - times[-1]) * closes[-1]
    at = [min(edges[0], times[0]), *times, max(edges[-1], times[-1])]
    total = np.cumsum([0.0, before, *lengths, after])
    return np.diff(np.interp(edges, at, total)) / np.diff(edges)
