"""`merge`: folders of the same sweep made into one, as if one machine had run all of it."""

import os
import time
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from trsim.api.hearing import Listener
from trsim.api.stop import listening
from trsim.errors import UsageError, described
from trsim.sweeps.ledger import counts
from trsim.sweeps.merge import Lost
from trsim.sweeps.merge import merge as going_on
from trsim.sweeps.study import study

if TYPE_CHECKING:
    from trsim.api.study import Sweep


class Merged(NamedTuple):
    """What was made."""

    cases: int
    taken: int
    counts: dict[str, int]  # status -> cases
    lost: tuple[Lost, ...]
    told: str  # in a line


def merge(folders: Iterable[Any], output: Any, *, link: bool = False) -> "Sweep":
    """Make one folder of those of shards of a sweep; what came of the sweep.

    folders  of the shards: the same scenario, the same `set`, the same trsim
    output   folder that is made, or that was made before and gets more
    link     result files become second names of those that are there, and are not copied

    Nothing in the folders is changed.  A call that was broken off goes on when it is made again.
    Raises UsageError, FileError.
    """
    from trsim.api.study import Sweep

    if isinstance(folders, str | os.PathLike):
        what = f"`merge` takes a list of folders, not {described(folders)}"
        raise UsageError(what, '`trsim.merge(["a", "b"], "whole")`')
    with listening():
        merged(Listener(), folders, Path(output), link)
    return Sweep(output)


def merged(hears: Listener, folders: Iterable[Any], output: Path, link: bool) -> Merged:
    """Make one folder, and tell how that went."""
    given = list(map(Path, folders))
    if not given:
        raise UsageError("no folders to merge")
    began, show, taken = time.monotonic(), None, 0
    lost: list[Lost] = []
    going = going_on(given, output, link)
    try:
        for one in going:
            if isinstance(one, int):
                show = hears.cases(str(output), one)
            elif isinstance(one, Lost):
                lost.append(one)
                hears.warn(str(one.folder), f"case {one.case} is left out: {one.why}")
            else:
                taken += 1
                if show is not None:
                    show.ended(one)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"the same command goes on with {output}") from None
    finally:
        going.close()
        if show is not None:
            show.close()
    found = counts(case.status for case in study(output).cases)
    said = ", ".join(f"{n} {status}" for status, n in found.items())
    cases, wall = sum(found.values()), time.monotonic() - began
    told = f"{output}: {cases} cases, {taken} taken in {wall:.1f} s: {said or 'none'}"
    return Merged(cases, taken, found, tuple(lost), told)
