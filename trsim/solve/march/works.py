"""The works of the energy book under error control: each right to the tolerance times what the
mechanism has exchanged.

Works feed nothing back, so the error norm of the motion says nothing of them; where a motion is
prescribed, it follows its constraint however long the steps, and loads, drives and dampers may vary
in them as they like.  Each method therefore tells the error of its works from the stages it has
made, and a step is as good as the worse of the two.

    unit of a work = tolerance times the largest energy exchanged so far, this step included
    exchanged      = the largest of |works| and of the ranges of kinetic and stored energies

Energies are those at the ends of steps: their peaks inside depend on the rows asked for, and steps
must not.  Nothing is asked for below the rounding of the energies themselves, nor of steps so short
that the works in them are none: a load that jumps does so at one point of time.
"""

from trsim.elements.contract import N_BOOK
from trsim.elements.scene import N_STORED
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_to

# of what a step is held to, which is a fifth to a twentieth of the tolerance asked for: see
# `settings` in outcome.py
WIDER = 3.0
ROUNDING = 1e-13  # of the largest energy in the book
SHORTEST = 1e-9  # of a run: no shorter step is asked for on behalf of a work
KINK = 3.0  # times its error that a sum of steps twice as long is off, where a load has a kink
SAME_TIME = 1e-6  # of a step: what rounding makes of its beginning
# columns of `worked`: when a step began, its length, the powers then, its works
BEGAN, LONG, POWERS, DONE, N_WORKED = 0, 1, 2, 2 + N_BOOK, 2 + 2 * N_BOOK
LEAST = 1e-6  # of the energy the unit of velocities stands for: no less is an exchange


@internal
def works(r, setting, h, worst, size):
    """The error of the works in units of what is allowed; kept for the sum over the run.

    worst: the largest error of a work in the step, J; size: the largest energy it moves, J.
    """
    r.work_trial = worst
    if abs(h) <= SHORTEST * setting.t_end:
        return 0.0
    allowed = WIDER * setting.step_error * max(r.exchanged, size)
    return worst / max(allowed, ROUNDING * r.largest_energy, 1e-300)


@internal
def first_work(s):
    """The entry of y with the first of the works."""
    return s.n_q + s.n_v


@internal
def exchanged(s, r, b):
    """Take an accepted step into what has been exchanged, and its error into the sum."""
    r.work_error += r.work_trial
    first, most = s.column_energy, r.exchanged
    for k in range(r.book.shape[0]):
        energy = b.out[first + k]
        r.book[k, 0], r.book[k, 1] = min(r.book[k, 0], energy), max(r.book[k, 1], energy)
        most = max(most, r.book[k, 1] - r.book[k, 0])
    for c in range(first + 1 + N_STORED, s.n_out - 1):
        most = max(most, abs(b.out[c]))
    r.exchanged = most


@internal
def note_error(s, r, b, t, h, middle):
    """Estimate the error of the works of a fixed step; kept for the sum over the run.

    Two steps of the same length and their Simpson sums S are one of twice the length: of smooth
    works it errs 16 times as much, of those with a kink 4 times.  The larger part is taken.
    middle: the row of K at the middle of the step, whose work is in b.y1.
    """
    now, before = r.worked[0], r.worked[1]
    if now[BEGAN] != t:  # not the same step again
        copy_to(before, now)
    now[BEGAN], now[LONG] = t, h
    pair = h == before[LONG] and abs(before[BEGAN] + h - t) <= SAME_TIME * h
    r.work_trial = 0.0
    for k in range(N_BOOK):
        c = first_work(s) + k
        now[POWERS + k], now[DONE + k] = b.K[0, c], b.y1[c] - r.y[c]
        if pair:
            ends = before[POWERS + k] + b.K[middle + 1, c]
            twice = h / 3.0 * (ends + 4.0 * b.K[0, c])
            off = abs(before[DONE + k] + now[DONE + k] - twice) / (2.0 * KINK)
            r.work_trial = max(r.work_trial, off)
