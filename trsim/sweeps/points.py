"""The points of a sweep: which value every key has in every case.

A grid runs through the last axis fastest.  Samples are shares of distributions, the same for every
named case: Latin hypercube [McKay1979], independent draws, or Saltelli's blocks A, B and AB_i
[Saltelli2010] on a scrambled Sobol sequence.
"""

from functools import partial
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from trsim.errors import ScenarioError
from trsim.scenario.vary import SAMPLED, Axis, Sweep, drawn

MOST = 1_000_000  # cases


class Point(NamedTuple):
    """One combination."""

    name: str  # of a sample; "" where the values are its name
    values: dict[str, Any]  # key -> value as it would be written


def points(sweep: Sweep) -> list[Point]:
    """All combinations, in order.  Raises ScenarioError where there are too many."""
    own = [axis for axis in sweep.axes if not axis.same_as]
    if sweep.method in SAMPLED:
        found = _samples(sweep, own)
    else:
        count = np.prod([float(len(axis.values)) for axis in own])
        if sweep.method == "grid" and count > MOST:
            raise ScenarioError(f"a grid of {count:.3g} cases", f"At most {MOST}; draw samples.")
        joined = product if sweep.method == "grid" else partial(zip, strict=True)
        keys = [axis.key for axis in own]
        rows = joined(*(axis.values for axis in own))
        found = [Point("", dict(zip(keys, row, strict=True))) for row in rows]
    for axis in sweep.axes:
        for point in found if axis.same_as else ():
            point.values[axis.key] = point.values[axis.same_as]
    return found


def _samples(sweep: Sweep, own: list[Axis]) -> list[Point]:
    d, n, found = len(own), sweep.samples, []
    if sweep.method != "sobol":
        blocks = [("s", _shares(sweep, d, n))]
    else:
        if n & (n - 1):
            near = 1 << n.bit_length()
            what = f"sobol needs a power of two of samples, not {n}"
            raise ScenarioError(what, f"Write {near // 2} or {near}.", ("samples",))
        both = _shares(sweep, 2 * d, n)
        a, b = both[:, :d], both[:, d:]
        blocks = [("A", a), ("B", b)]
        for k in range(d):
            mixed = a.copy()
            mixed[:, k] = b[:, k]
            blocks.append((f"AB{k + 1}_", mixed))
    for name, shares in blocks:
        for k, row in enumerate(shares.tolist()):
            values = {
                axis.key: drawn(axis.drawn, share) if axis.drawn else None
                for axis, share in zip(own, row, strict=True)
            }
            found.append(Point(f"{name}{k:04d}", values))
    return found


def _shares(sweep: Sweep, d: int, n: int) -> Any:
    """Points (n, d) of the unit cube."""
    generator = np.random.default_rng(sweep.seed)
    if sweep.method == "monte_carlo":
        return generator.random((n, d))
    from scipy.stats import qmc

    kind = qmc.LatinHypercube if sweep.method == "latin_hypercube" else qmc.Sobol
    return kind(d, seed=generator).random(n)
