"""Results of a static path: rows, peaks, works and what inertia would add.

Forces are those at rest, velocities and accelerations those of the path at the speed of t: every
place is measured twice, and a channel of force, moment, work or energy is taken from the first
time, any other from the second.  There is no kinetic energy.

What the inertia of the path's accelerations a would change, to first order:

    [ K  G ] [ dq   ]     [ M a + w x I w ]
    [ J  0 ] [ dlam ] = - [ 0             ]

The inertia ratio of a drive is the largest of its dlam over the largest of its lam.
"""

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import least_squares
from trsim.assemble.equations import constraints, poses
from trsim.assemble.reduce import along_rates, less_reactions, moves, spread_out
from trsim.elements.contract import DRIVES, N_BOOK
from trsim.elements.prescribed import AnyDrive
from trsim.solve.march import record as rec
from trsim.solve.path.extremes import take
from trsim.solve.path.measures import added, measured_with, works
from trsim.solve.path.place import Equations, Place

Array = NDArray[np.float64]

AT_REST = ("N", "J", "Pa")  # in the unit of what is told as at rest
DEPENDENT = 1e-10  # relative size of a row that is not independent
APART = 1e-7  # of the time between rows: places that are nearer tell no acceleration
INERTIA, DAMPERS, FORCE = range(3)  # of what is kept of drives
NO_LOAD = 1e-6  # of the largest force, at the size: a drive that gives less gives none


class Results:
    """What is kept of the places of a path."""

    def __init__(self, equations: Equations, every: float) -> None:
        self.eq, self.w, self.every = equations, equations.work, every
        w, mechanism = self.w, equations.mechanism
        self.told = np.zeros(w.n_out, bool)
        for c in mechanism.columns:
            alone = any(unit in c.unit.split("/")[0] for unit in AT_REST)
            self.told[c.start : c.start + c.size] = alone
        squares = len(w.vector)
        # at a corner, which lies between two rows, a path has two speeds, and none of them counts
        rates = np.zeros(w.n_out, bool)
        for c in mechanism.columns:
            rates[c.start : c.start + c.size] = "/s" in c.unit
        self.rates = np.concatenate([rates, rates[w.vector]])
        self.energies = np.zeros(len(self.rates), bool)
        for c in mechanism.columns:
            self.energies[c.start : c.start + c.size] = c.unit == "J"
        # by whether there is a row, and whether works are known: what has no extremes there
        self.untold = {
            (row, known): ((self.rates & (not row)) | (self.energies & (not known))).astype(
                np.int64
            )
            for row in (False, True)
            for known in (False, True)
        }
        self.full = np.zeros(w.n_out + squares)  # what was taken last, with magnitudes
        self.peak = np.zeros((rec.N_PEAK, w.n_out + squares))
        self.peak[rec.PEAK_MAX], self.peak[rec.PEAK_MIN] = -1e300, 1e300
        self.rows: list[Array] = []
        self.now = np.zeros(w.n_out)  # the channels of the place that was kept last
        self.steps: list[Array] = []
        self.recorded: list[Array] = []
        self.last: Place | None = None
        self.works = np.zeros(N_BOOK)
        self.turned = self.jumped = False
        self.residual = 0.0
        self.zero = 0.0  # J, the energy at the start
        self.begun = False  # whether it is known
        self.drives = [one for one in self.rigid_drives() if one[1] >= 0]
        # of every drive: what inertia adds, what dampers do, its force; each with its time
        self.most = np.zeros((len(self.drives), 3, 2))
        self.largest_energy = self.largest_residual = 0.0

    def rigid_drives(self) -> list[tuple[str, int, float]]:
        """Drives: name, row, -1 of what has none, and the lever of their force."""
        w = self.w
        return [
            (f"drives.{i.name}", int(AnyDrive(w, e).row), w.size if AnyDrive(w, e).rotates else 1.0)
            for e, i in enumerate(self.eq.mechanism.instances)
            if i.section == "drives"
        ]

    def go_on_with(self, equations: Equations, place: Place) -> None:
        """Take places of other equations from now on, of which this is the first."""
        self.eq, self.w, self.last = equations, equations.work, place
        rows = {name: row for name, row, _ in self.rigid_drives()}
        self.drives = [(name, rows[name], lever) for name, _, lever in self.drives]

    def out(self, place: Place, a: Array) -> Array:
        """All channels at a place with its accelerations."""
        w, y = self.w, place.y.copy()
        lam = self.all_rows(place)
        first = w.n_q + w.n_v
        y[first : first + N_BOOK] = self.works
        measured_with(w, place.t, y, lam, np.zeros(w.n_v))
        still = w.out[: w.n_out].copy()
        still[w.column_energy] = 0.0
        y[w.n_q : first] = place.v
        measured_with(w, place.t, y, lam, a)
        found = np.where(self.told, still, w.out[: w.n_out])
        return np.asarray(found)

    def all_rows(self, place: Place) -> Array:
        """Multipliers of all rows: of least norm where some are redundant."""
        w = self.w
        lam = np.zeros(len(w.lam))
        lam[: w.m] = place.lam
        if not len(w.redundant):
            return lam
        poses(w, place.y)
        constraints(w, place.t)
        there = moves(w, w.d == 3)
        held = np.zeros((w.n, 6))
        less_reactions(w, held, -place.lam)
        J = spread_out(w, len(lam))[:, there].T
        unit = w.size / np.asarray(w.row_unit)
        return np.asarray(unit * least_squares(J * unit, along_rates(w, held)[there], DEPENDENT))

    def work(self, place: Place, way: Array, dt: float) -> Array:
        """Of the energy book, on a way through a place: with the forces there."""
        b, book = self.eq.record, np.zeros(N_BOOK)
        b.y[:], b.lam[:] = place.y, place.lam
        done = works(self.w, b, place.t, way, place.A, book)
        book[DRIVES] = book[DRIVES] * dt + done
        return book

    def worked(self, place: Place) -> None:
        """Add the works since the place before, by the forces at both."""
        if self.last is not None:
            # multipliers of a place at which friction turns round are those of the way to it
            first = place if self.turned else None
            self.works += self.works_between(self.last, place, first)
            self.turned = self.turned and place.t == self.last.t
        self.last = place

    def works_between(self, before: Place, place: Place, with_forces: Place | None = None) -> Array:
        """The works from a place to another, by the forces at both, or at the first by others."""
        way, dt = self.eq.ways(before.y, place.y)[0], place.t - before.t
        first = self.work(with_forces or before, way, dt)
        return np.asarray(0.5 * (first + self.work(place, way, dt)))

    def keep(self, place: Place, a: Array, row: bool) -> Array:
        """Take a place that is known with its accelerations: works, peaks, steps, inertia."""
        self.worked(place)
        row = row or not self.begun
        out = self.out(place, a)
        energies = out[self.w.column_energy :]
        if not self.begun:
            self.zero, self.begun = energies[-1], True
        if self.jumped:  # what a jump loses is no error of the book
            self.zero += energies[-1] - self.zero - self.residual
        energies[-1] -= self.zero
        self.jumped, self.residual = False, float(energies[-1])
        self.largest_energy = max(self.largest_energy, float(np.abs(energies[:-1]).max()))
        self.largest_residual = max(self.largest_residual, abs(float(energies[-1])))
        self.take(place.t, out, row)
        self.now = out
        if row:
            self.rows.append(np.concatenate([[place.t], out]))
        return out

    def relative(self, out: Array) -> Array:
        """Channels with the error of the energy book from the start on."""
        out[-1] -= self.zero
        return out

    def take(self, t: float, out: Array, row: bool, known: bool = True) -> None:
        """Take the channels of one time into their extremes: rates at rows, works where known."""
        take(self.w, t, out, self.untold[row, known], self.full, self.peak)

    def touching(self, place: Place, out: Array, closed: dict[int, bool]) -> None:
        """A line for each contact that is in."""
        w = self.w
        width = 2 + int(np.max(w.contact_width, initial=0))
        for c, e in enumerate(w.contact.tolist()):
            if closed[e] and w.wanted[e] >= 0:
                line = np.zeros(width)
                line[:2] = place.t, e
                many = int(w.contact_width[c])
                line[2 : 2 + many] = out[w.wanted[e] : w.wanted[e] + many]
                self.steps.append(line)

    def inertia(self, place: Place, a: Array) -> None:
        """What inertia would add to the forces of rigid drives."""
        if all(row < 0 for _, row, _ in self.drives):
            return
        b = self.eq.record
        b.y[:], b.lam[:], b.inverse[:] = place.y, place.lam, place.inverse
        b.x[: self.eq.n], b.g[: self.eq.n] = place.v, a
        found = np.zeros((len(self.drives), 2))
        added(self.w, b, place.t, np.array([max(row, 0) for _, row, _ in self.drives]), found)
        for most, (_, row, _), more in zip(self.most, self.drives, found.tolist(), strict=True):
            if row < 0:
                continue
            for at, x in enumerate((*more, place.lam[row])):
                if abs(x) > most[at, 0]:
                    most[at] = abs(x), place.t

    def ratios(self, of: int = INERTIA) -> list[tuple[str, float, float]]:
        """Of every rigid drive: its name, what inertia, or dampers, would add at most, of the
        largest force it has, and when."""
        return [
            (name, float(most[of, 0] / most[FORCE, 0]), float(most[of, 1]))
            for (name, _, lever), most in zip(self.drives, self.most, strict=True)
            if most[FORCE, 0] > NO_LOAD * lever * self.eq.load
        ]


def slope(before: Place | None, place: Place, after: Place | None, least: float) -> Array:
    """Accelerations at a place by the velocities there and next to it."""
    near = [p for p in (before, after) if p is not None and abs(p.t - place.t) > least]
    if not near:
        return np.zeros_like(place.v)
    rates = [(p.v - place.v) / (p.t - place.t) for p in near]
    if len(near) == 1:
        return np.asarray(rates[0])
    h, k = abs(near[0].t - place.t), abs(near[1].t - place.t)
    return np.asarray((k * rates[0] + h * rates[1]) / (h + k))
