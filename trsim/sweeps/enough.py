"""How many samples are enough: `until` of monte_carlo and of sobol.

Means over cases.  Half the 95 % interval of the mean of n independent cases is

    half = t(n - 1) s / sqrt(n)

t is the quantile of Student's distribution, s the standard deviation of the cases, whatever their
distribution where n is not small.  A sequence that stops as soon as half is small stops where s
happens to be small [ChowRobbins1965], so that the interval holds the mean less often than it says.
Therefore no fewer than FEWEST cases count, where t is 9 % above the quantile of a normal
distribution and s is known to 18 %, and half has to be small after two batches, one after the
other.  The batches are few: each goes to where the width will be reached, judged by the last one,
between MORE of the cases so far and as many again.

Indices.  A batch doubles the rows of Saltelli's blocks, whose first 2^k rows are such a design too.
There are enough of them when half of each interval is small (analyse/sobol.py), and no index moved
by more than the width since half the rows.
"""

import math
from typing import NamedTuple

import numpy as np

from trsim.analyse.interval import LEVEL
from trsim.analyse.sobol import Indices, blocks, indices
from trsim.errors import UsageError
from trsim.scenario.adaptive import SHARE, Width
from trsim.sweeps.choosing import Choosing, Part, Results, how_many

FEWEST = 16  # cases that tell a standard deviation
MORE, LEAST = 8, 8  # a batch is at least a MOREth of the cases so far, and so many
ROWS = 32  # of the first design
MANY = 6  # digits before or behind the point


class Mean(NamedTuple):
    """The mean of a number over cases."""

    having: int  # cases that have it
    mean: float
    half: float  # of its interval; inf of fewer than two
    width: float  # asked for

    @property
    def sure(self) -> bool:
        return self.having >= FEWEST and self.half <= self.width


def mean(values: list[float], width: Width) -> Mean:
    """The mean of a number over cases; nan for one that has none."""
    from scipy.special import stdtrit

    known = np.array([value for value in values if not math.isnan(value)])
    n = len(known)
    if n < 2:
        return Mean(n, math.nan, math.inf, 0.0)
    centre, deviation = float(np.mean(known)), float(np.std(known, ddof=1))
    half = float(stdtrit(n - 1, 0.5 + 0.5 * LEVEL)) * deviation / math.sqrt(n)
    return Mean(n, centre, half, width.of(centre))


def of_means(part: Part, results: Results) -> Choosing:
    """Samples until the means of all numbers are sure."""
    n, size, before = 0, min(FEWEST, len(part.cases)), False
    while True:
        yield list(range(n, size))
        n = size
        found = [
            _mean_of(part, results, word, width, n) for word, width in part.sweep.until
        ]  # fmt: skip
        sure = all(one.sure for one in found)
        if (sure and before) or n == len(part.cases):
            return _means_told(part, results, found, n, sure)
        before = sure
        size = min(ahead(n, found), len(part.cases))


def ahead(n: int, found: list[Mean]) -> int:
    """How many cases the next batch goes to."""
    least = n + max(LEAST, -(-n // MORE))
    wanted = max(wanted_cases(one, n) for one in found)
    return int(min(max(least, wanted), 2 * n))


def wanted_cases(one: Mean, n: int) -> float:
    """How many cases make a mean sure, judged by n."""
    if one.half <= one.width:
        return n if one.having >= FEWEST else 2.0 * n
    return math.ceil(n * (one.half / one.width) ** 2) if one.width > 0.0 else math.inf


def _mean_of(part: Part, results: Results, word: str, width: Width, n: int) -> Mean:
    results.check(part.cases[:n], word, width)
    return mean([results.number(case, word) for case in part.cases[:n]], width)


def _means_told(part: Part, results: Results, found: list[Mean], n: int, sure: bool) -> str:
    """What is known of the means at the end."""
    told = []
    for (word, width), one in zip(part.sweep.until, found, strict=True):
        text = f"{word} is {about(one.mean, one.half)}{results.unit(word)}"
        text += f", asked for {width.text}"
        if one.having < n:
            text += f" ({n - one.having:,} without it)"
        if not one.sure:
            wanted = wanted_cases(one, n)
            text += ": not reached, more `samples` are needed"
            text += f", about {_rounded(wanted):,}" if math.isfinite(wanted) else ""
        told.append(text)
    return f"{how_many(n, len(part.cases))}: {'; '.join(told)}"


def _rounded(n: float) -> int:
    """A number of cases to two digits, upwards."""
    digit = 10 ** max(len(str(int(n))) - 2, 0)
    return int(-(-n // digit) * digit)


def about(value: float, half: float) -> str:
    """A value and half its interval, to two digits of that."""
    if not math.isfinite(half):
        return "not known"
    digits = 1 - math.floor(math.log10(half)) if half > 0.0 else MANY + 1
    if abs(digits) > MANY:
        return f"{value:.6g} +- {half:.2g}"
    return (
        f"{round(value, digits):,.{max(digits, 0)}f} +- {round(half, digits):,.{max(digits, 0)}f}"
    )


# --- indices of variance ---------------------------------------------------------------------


class Shares(NamedTuple):
    """How sure the indices of a number are; inf where there are none yet."""

    half: float  # of the widest interval
    moved: float  # the most that one did since half the rows
    why: str  # there are none


def of_indices(part: Part, results: Results) -> Choosing:
    """Rows of Saltelli's blocks until the indices of all numbers are sure."""
    samples = part.sweep.samples
    columns = np.arange(len(part.cases)).reshape(-1, samples)  # d + 2 blocks
    n, rows = 0, min(ROWS, samples)
    while True:
        yield sorted(columns[:, n:rows].ravel().tolist())
        n, found = rows, []
        for word, width in part.sweep.until:
            taken = tuple(part.cases[k] for k in columns[:, :n].ravel())
            results.check(taken, word, width._replace(unit=SHARE))  # of an index, not of the number
            found.append(_shares_of(part, results, word, columns[:, :n]))
        widths = [width for _, width in part.sweep.until]
        sure = [_sure(one, width) for one, width in zip(found, widths, strict=True)]
        if all(sure) or n == samples:
            return _shares_told(part, found, n * len(columns), sure)
        rows = 2 * n


def _sure(one: Shares, width: Width) -> bool:
    return max(one.half, one.moved) <= width.value


def _shares_of(part: Part, results: Results, word: str, columns: np.ndarray) -> Shares:
    keys = [axis.key for axis in part.sweep.axes if not axis.same_as]
    try:
        values, _ = blocks(columns, lambda k: results.number(part.cases[k], word))
        found = indices(keys, values, word)
    except UsageError as error:
        return Shares(math.inf, math.inf, error.what)
    ends = [(i.first_high - i.first_low, i.total_high - i.total_low) for i in found.indices]
    return Shares(0.5 * float(np.max(ends)), _moved(found), "")


def _moved(found: Indices) -> float:
    """The most that an index moved with the second half of the rows; inf of too few rows."""
    if found.rows < ROWS:
        return math.inf
    (_, *before), (_, *now) = found.convergence[-2:]
    return float(np.max(np.abs(np.array(now) - np.array(before))))


def _shares_told(part: Part, found: list[Shares], n: int, sure: list[bool]) -> str:
    """What is known of the indices at the end."""
    told = []
    for (word, width), one, is_sure in zip(part.sweep.until, found, sure, strict=True):
        if one.why:
            told.append(f"no Sobol indices of {word}: {one.why}")
            continue
        text = f"Sobol indices of {word} are within +- {one.half:.2g}, asked for {width.text}"
        if not is_sure and one.half <= width.value:
            text += f", but moved by {one.moved:.2g} with the last rows"
        told.append(text if is_sure else f"{text}: not reached, more `samples` are needed")
    return f"{how_many(n, len(part.cases))}: {'; '.join(told)}"
