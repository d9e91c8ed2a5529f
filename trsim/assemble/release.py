"""What to let go so that no row is redundant: a mechanism with k dependent rows too many loses k.

    N^T J = 0,   N (m, k)            the states of self-stress: reactions that need no load
    rows L can go, |L| = k   <=>   det N[L] != 0

What is left then has the rank of the whole: no freedom is gained, nothing is redundant, and every
reaction is unique.  Among all L those are preferred that an engineer would draw: moments go before
forces, joint types trsim has before others, few joints, pins between moving bodies before
bearings, then the order of the file.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations, product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim import elements
from trsim.assemble.addresses import Addresses
from trsim.assemble.assemble import pack
from trsim.assemble.build import Parts, as_drawn
from trsim.assemble.instances import Instance, RowName
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.rank import DEPENDENT, dependent_rows, unique_reactions
from trsim.assemble.reduce import jacobian, moves, weights
from trsim.assemble.redundant import nearby
from trsim.assemble.rows import all_rows, in_solve
from trsim.elements.rows import Axes

Array = NDArray[np.float64]

REGULAR = 1e-6  # smallest singular value of N[L]: below, it is not sure that L may go
ALONG = 1.0 - 1e-9  # cosine of an axis along a world axis
MOST_JOINTS = 3  # changed together in the search; beyond that, rows one by one


class Change(NamedTuple):
    """Rows of one joint that go together, and what the joint is without them."""

    joint: str
    rows: tuple[int, ...]
    becomes: str  # in words
    type: str | None  # the joint type of a scenario, where there is one


@dataclass(frozen=True)
class Release:
    """Changes that leave no row redundant and no reaction undetermined.

    rows          "joint.axis", as many as are redundant
    alternatives  other choices that are as good; the first in the file is given
    proven        whether nothing depends on anything without these rows, as drawn and nearby
    """

    changes: tuple[Change, ...]
    rows: tuple[str, ...]
    alternatives: int
    proven: bool


class Stress(NamedTuple):
    """The rows of a mechanism, and their null spaces N at some positions."""

    rows: list[RowName]  # all of them
    inside: list[int]  # those of the solve
    jacobians: list[Array]  # (len(inside), columns), scaled to rows of length one
    spaces: list[Array]  # (len(rows), k)


def release(scenario: Any, mechanism: Mechanism) -> Release | None:
    """The rows to let go where some are redundant, or None."""
    if not mechanism.redundant:
        return None
    at, instances = pack(scenario, frozenset(), None, ())
    stress = self_stress(scenario, mechanism, at, instances)
    k = len(mechanism.redundant)
    options = [
        sorted(
            changes(instances[n], stress, at), key=lambda change: forces(change.rows, stress.rows)
        )
        for n in sorted({stress.rows[r].instance for r in stress.inside})
        if instances[n].section == "joints"
    ]
    order = {instance.name: n for n, instance in enumerate(instances)}
    best: list[tuple[Change, ...]] = []
    lowest: tuple[int, ...] | None = None
    for chosen in choices(options, k):
        cost = price(chosen, stress.rows, instances)
        if lowest is not None and cost > lowest:
            continue
        if removable([row for change in chosen for row in change.rows], stress):
            best = [*best, chosen] if cost == lowest else [chosen]
            lowest = cost
    if not best:
        best = [by_rows(k, stress, instances)]
    best.sort(key=lambda chosen: [order[change.joint] for change in chosen])
    gone = [row for change in best[0] for row in change.rows]
    words = tuple(f"{stress.rows[r].element}.{stress.rows[r].axis}" for r in gone)
    return Release(best[0], words, len(best) - 1, proven(gone, stress))


def self_stress(
    scenario: Any, mechanism: Mechanism, at: Addresses, instances: list[Instance]
) -> Stress:
    """Null spaces of J^T as drawn (where that is not singular) and at perturbed positions."""
    rows = all_rows(instances)
    full, y6 = as_drawn(Parts.of(at, instances), rows)
    inside = np.flatnonzero(in_solve(full, jacobian(full, 0.0, y6)[2], mechanism.planar)).tolist()
    keep = moves(full, mechanism.planar)
    geometric = [r for r in inside if instances[rows[r].instance].section == "joints"]
    scale = weights(full)[keep]
    places = [] if mechanism.singular else [y6]
    jacobians, spaces = [], []
    for y in [*places, *nearby(full, y6, keep, geometric)]:
        J = jacobian(full, 0.0, y)[2][:, keep][inside] * scale
        J = J / np.linalg.norm(J, axis=1)[:, None]
        u, s, _ = np.linalg.svd(J, full_matrices=True)
        rank = int(np.sum(s > DEPENDENT * s.max(initial=1.0)))
        N = np.zeros((len(rows), len(inside) - rank))
        N[inside] = u[:, rank:]
        jacobians.append(J)
        spaces.append(N)
    return Stress(rows, inside, jacobians, spaces)


def changes(instance: Instance, stress: Stress, at: Addresses) -> Iterator[Change]:
    """What may go of a joint so that it becomes another; nothing of one whose angle or stroke
    somebody needs."""
    if instance.name in {x.joint for x in at.coordinates.values()}:
        return
    types, element = joint_types(), instance.element
    holds = dict(zip(element.rows, held(instance, at), strict=False))
    holds.pop(instance.row.unheld, None)
    own = {stress.rows[r].axis: r for r in stress.inside if stress.rows[r].element == instance.name}
    may = [axis for axis in own if holds.get(axis, "x") not in "xyz"]
    for number in range(len(own) - 1, 0, -1):
        for gone in combinations(may, number):
            # the contact of a joint with clearance goes on holding two displacements
            left = "".join(held for axis, held in holds.items() if axis not in gone)
            word = types.get(shape(left + "uw" if element.ideal else left))
            if word:
                rows = tuple(own[axis] for axis in gone)
                yield Change(instance.name, rows, word, None if element.ideal else word)


def held(instance: Instance, at: Addresses) -> tuple[str, ...]:
    """What the rows of a joint hold; of a hinge along x, y or z one of its point is along it."""
    element, row = instance.element, instance.row
    if "angle" in element.coordinates:
        axis = np.abs(at.rotation[row.con[0]] @ np.array(Axes.of(row).a_i))
        if axis.max() > ALONG:
            axial = "xyz"[int(axis.argmax())]
            return tuple("a" if one == axial else one for one in element.holds)
    return element.holds


def joint_types() -> dict[tuple[str, str], str]:
    """The joint types, by what their rows hold."""
    kinds = (elements.load(word) for word, of in elements.ELEMENTS.items() if of == "joints")
    return {shape("".join(kind.holds)): kind.key for kind in kinds if kind.holds and not kind.ideal}


def shape(holds: str) -> tuple[str, str]:
    """The displacements, turns, relations that are held; which one turn it is does not matter."""
    points = sum(one in "xyz" for one in holds)
    places = {*holds} & {*"uwa"} | {*"uwa"[:points]}
    turns = "".join(sorted({*holds} & {*"UWA"}))
    relations = "".join(sorted({*holds} - {*"xyzuwaUWA"}))
    return "".join(sorted(places)), (turns if len(turns) > 1 else "1" * len(turns)) + relations


def choices(options: list[list[Change]], k: int) -> Iterator[tuple[Change, ...]]:
    """Changes of one, two, ... joints that let k rows go together."""
    for number in range(1, MOST_JOINTS + 1):
        for joints in combinations(options, number):
            for chosen in product(*joints):
                if sum(len(change.rows) for change in chosen) == k:
                    yield chosen


def price(
    chosen: tuple[Change, ...], rows: list[RowName], instances: list[Instance]
) -> tuple[int, ...]:
    """Forces let go; joints of a type trsim lacks; joints changed; bearings opened."""
    gone = [row for change in chosen for row in change.rows]
    return (
        forces(gone, rows),
        sum(change.type is None for change in chosen),
        len(chosen),
        sum(elements.load(change.becomes).dear for change in chosen if change.becomes),
        sum(0 in rows[change.rows[0]].frames for change in chosen),
    )


def forces(gone: Iterable[int], rows: list[RowName]) -> int:
    """How many of the rows let go of are forces."""
    return sum(not rows[row].rotation for row in gone)


def removable(gone: list[int], stress: Stress) -> bool:
    """Whether N[L] is regular at every position."""
    return all(
        np.linalg.svd(N[gone], compute_uv=False).min(initial=np.inf) > REGULAR
        for N in stress.spaces
        if N.shape[1] == len(gone)
    )


def by_rows(k: int, stress: Stress, instances: list[Instance]) -> tuple[Change, ...]:
    """k rows found one by one: each cuts a self-stress that is left, moments first."""
    may = [r for r in stress.inside if instances[stress.rows[r].instance].section == "joints"]
    may.sort(key=lambda r: (not stress.rows[r].rotation, -r))
    N, gone = stress.spaces[-1].copy(), list[int]()
    for r in may:
        size = float(np.linalg.norm(N[r]))
        if size > REGULAR and len(gone) < k:
            # the stresses left are those without a part in this row
            direction = N[r] / size
            N -= np.outer(N @ direction, direction)
            gone.append(r)
    joints = list(dict.fromkeys(stress.rows[r].element for r in gone))
    return tuple(
        Change(name, tuple(r for r in gone if stress.rows[r].element == name), "", None)
        for name in joints
    )


def proven(gone: list[int], stress: Stress) -> bool:
    """Whether nothing depends on anything once these rows are gone, at every position."""
    left = [n for n, r in enumerate(stress.inside) if r not in gone]
    for J in stress.jacobians:
        ones = np.ones(J.shape[1])
        if dependent_rows(J[left], ones, list(range(len(left)))):
            return False
        if not unique_reactions(J[left], ones).all():
            return False
    return True
