"""Whether a run changed from one branch of the motion to another where branches nearly meet.

Cranks of lengths that differ by 1e-8 turn over at the flat places of their parallelogram, within
1e-4 rad: the branches there are those of x y = 1e-8.  A long step goes straight on, as is right
where they meet (x y = 0), and no estimate of its error sees that.

What tells is the sign of each singular value of J.  With O = (J J^T)^(-1/2) J, the rows of J made
orthonormal, which follow a motion smoothly, O_1 O_0^T is close to I for two near places on one
branch; it has an eigenvalue close to -1 for every singular value that went through zero between
them.  So the way between the ends of a step that passes.py noted is halved, each place brought to
the constraints from a cubic through the last ones, until

    as many singular values are zero there:   the branches meet, and the step went on along its own
    the way becomes no shorter:               they do not, and the run changed its branch
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import close_positions, move_all, project_velocities
from trsim.assemble.rank import of_length_one
from trsim.assemble.reduce import all_rows, weights
from trsim.elements.scene import Scene, scene
from trsim.solve.diagnose.locked import dependent
from trsim.solve.march.meetings import MEET, REACHED, known
from trsim.solve.march.openings import CLOSED, NEWTON
from trsim.solve.march.record import Record

Array = NDArray[np.float64]

NARROWER, PATIENT = 0.25, 9  # a way that becomes no shorter than that in so many looks stays wide
OVERLAP = 0.95  # smallest singular value of O_1 O_0^T of places near to each other
ELSEWHERE = (0.4, 0.65, 0.2, 0.85, 0.05, 0.97)  # where rows are singular there is no way back
LOOKS = 200  # places looked at between two states, at most
NUDGE = 1e-6  # rad, or of the mechanism's size: for derivatives of coordinates


class Place(NamedTuple):
    """A state on the constraints."""

    t: float
    y: Array
    slope: Array  # (n_y) dy/dt of coordinates; 0 of what else there is
    sigma: Array  # (m) singular values of all rows at length one but those of redundant ones, which
    # are zero everywhere; the least first
    rows: Array  # (m + n_d, ...) the rows made orthonormal, as far as their rank goes


class Found(NamedTuple):
    """Where branches meet, or nearly do."""

    meet: bool
    place: Place


def examine(work: Scene, r: Record, other_rows: bool) -> None:
    """Find out what became of the branch on the ways noted so far, and forget these.

    other_rows: are solved from here on, so the last way must be judged now, and sigma begins anew.
    """
    n, many = r.y.size, int(r.n_passed)
    if other_rows:
        r.kept = 0
    if not many:
        return
    ways = [
        (*line[:2].tolist(), line[2 : 2 + n], line[2 + n : 2 + 2 * n], line[2 + 2 * n :])
        for line in r.passed[:many]
    ]
    r.n_passed = 0
    scratch = scene(work)
    scratch.mem[:] = work.mem
    for t0, t1, y0, y1, branch in ways:
        if not known(work, r, y0, y1):
            scratch.branch[:] = branch
            for found in between(scratch, t0, y0, t1, y1):
                keep(r, found)


def keep(r: Record, found: Found) -> None:
    """A place in the record."""
    if found.meet:
        r.meeting[r.n_meetings % len(r.meeting)] = found.place.y
        r.n_meetings += 1
        return
    if not r.crossings:
        r.crossed_t = found.place.t
        r.crossed[:] = found.place.y
    r.crossings += 1


def between(w: Scene, t0: float, y0: Array, t1: float, y1: Array) -> Iterator[Found]:
    """The places between two states where singular values change their sign."""
    first, last = place(w, t0, y0.copy()), place(w, t1, y1.copy())
    if first is None or last is None:
        return
    ways, looks = [(first, last, np.inf, 0)], 0
    while ways and looks < LOOKS:
        a, b, wide, waited = ways.pop()
        near, flips = compared(a, b)
        if near and not flips:
            continue
        of = max(flips, 1) - 1
        least, width = min((a, b), key=lambda p: p.sigma[of]), distance(w, a, b)
        waited = 0 if width < NARROWER * wide else waited + 1
        wide = width if not waited else wide
        meet = bool(least.sigma[of] <= MEET)
        if (near and meet) or waited >= PATIENT:  # places at one time may be far from each other
            yield Found(meet, least)
            continue
        # the zero of a straight line is found at once; halving gets near to any
        at = a.sigma[of] / (a.sigma[of] + b.sigma[of]) if near and looks % 3 else 0.5
        tries = (middle(w, a, b, min(max(x, 1e-3), 1.0 - 1e-3)) for x in (at, *ELSEWHERE))
        m = next((found for found in tries if found), None)
        if m:
            ways += [(m, b, wide, waited), (a, m, wide, waited)]
        looks += 1


def compared(a: Place, b: Place) -> tuple[bool, int]:
    """Whether two places are near to each other, and how many singular values changed sign."""
    product = b.rows @ a.rows.T
    if np.linalg.svd(product, compute_uv=False)[a.sigma.size - 1] < OVERLAP:
        return False, 0
    return True, int(np.sum(np.linalg.eigvals(product).real < -0.5))


def distance(w: Scene, a: Place, b: Place) -> float:
    """About how much the directions of rows change between two places."""
    moved = np.abs(b.y - a.y)[: w.n_q]
    return float(np.max(moved / coordinate_units(w), initial=0.0))


def coordinate_units(w: Scene) -> Array:
    """The mechanism's size of lengths, 1 of angles and of quaternions."""
    body = [w.size] * 2 + [1.0] if w.d == 3 else [w.size] * 3 + [1.0] * 4
    rigid = np.tile(body, w.n_r - 1)
    return np.concatenate([rigid, np.full(w.n_q - rigid.size, w.size)])


def middle(w: Scene, a: Place, b: Place, at: float) -> Place | None:
    """The place between two others, from the cubic through them and their velocities."""
    h = b.t - a.t
    t, y = a.t + at * h, (1.0 - at) * a.y + at * b.y
    here, there = h * a.slope - (b.y - a.y), h * b.slope - (b.y - a.y)
    y += at * (1.0 - at) * ((1.0 - at) * here - at * there) * (a.slope != 0.0)
    return place(w, t, y)


def place(w: Scene, t: float, y: Array) -> Place | None:
    """A state brought to the constraints; None where it does not get there."""
    if not close_positions(w, t, y, CLOSED * w.size, NEWTON) < REACHED * w.size:
        return None
    u, sigma, vt = np.linalg.svd(of_length_one(all_rows(w, y), weights(w)), full_matrices=False)
    project_velocities(w, y)
    return Place(t, y, slope(w, y), sigma[w.m - 1 :: -1], u[:, : w.m] @ vt[: w.m])


def slope(w: Scene, y: Array) -> Array:
    """dy/dt of the coordinates."""
    v = y[w.n_q : w.n_q + w.n_v]
    d = NUDGE / max(float(np.max(np.abs(v), initial=0.0)), 1e-300)
    ahead, behind = y.copy(), y.copy()
    move_all(w, ahead, d * v)
    move_all(w, behind, -d * v)
    found = (ahead - behind) / (2.0 * d)
    found[w.n_q :] = 0.0
    return found


def of_branches(mechanism: Mechanism, r: Record) -> Iterator[str]:
    """Tell that a run changed its branch where branches nearly meet."""
    if not r.crossings:
        return
    t, many = float(r.crossed_t), int(r.crossings)
    names, nearly = dependent(mechanism, t, r.crossed)
    again = f" ({many} times in all)" if many > 1 else ""
    yield (
        f"joints.{names[0]}: at t = {t:.6g} s{again} the run went on along another branch of the "
        f"motion than it was on, past a place where branches come close but do not meet (rows of "
        f"{', '.join(names)} depend on each other to {nearly:.1g}): what follows is another "
        "motion; draw lengths that are to be equal to more digits, or take a smaller `tolerance`"
    )
