"""Amplitude spectral density of a channel: how much of it oscillates at which frequency.

    A(f) = sqrt(P(f)),     P = mean over segments of |FFT(w (x - trend))|^2 2 / (fs sum w^2)

x in N gives A in N/sqrt(Hz).  Segments overlap by half, each without its own straight line and
under a Hann window w [Welch1967].  The resolution is the width of that window, 1.5 fs / n, of
segments of n values.  P has nu = 36 K^2 / (19 K - 1) degrees of freedom for K segments, and by
their chi-square distribution an interval.

A line of amplitude a (a cos 2 pi f t) on a frequency of the FFT stands out as

    P = a^2 / (2 * 1.5 fs / n)

and one that is s bins away from it, |s| <= 1/2, as less; r being the ratio of A on the neighbour at
its side to A there,

    s = (2 r - 1) / (1 + r),     a = sqrt(2 P 1.5 fs / n) (1 - s^2) pi s / sin(pi s)

as follows from the transform of a Hann window.

Rows are samples.  What moves faster than half of their rate appears at frequencies where it does
not belong, and nothing in the rows tells; two signs of it are looked for.  Were P to fall like
1/f^2 above the Nyquist frequency f_N, P_N f_N of the variance would be folded back, P_N being the
level near f_N; and extremes the solver kept may lie beyond all rows.  A third one needs the rate x'
of the channel, where that is a channel too: a line at f has A' = 2 pi f A there, one that was
folded back from F has A' = 2 pi F A.  It is told where F is beyond f_N, and more than a tenth of A
may come from fs - f or beyond, where it has at least 2 pi (fs - f) times its part of A:

    part <= (F - f) / (fs - f)

What is slower than a segment goes with the straight lines, and little counts of the first and last
half of one.  How much of the rows is lost so, of their variance about one straight line, is told.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from trsim.analyse.interval import LEVEL
from trsim.analyse.window import Window, rows_in
from trsim.arrays import Array
from trsim.errors import UsageError
from trsim.store.points import split
from trsim.store.read import Run

WINDOW = "hann"
WIDTH = 1.5  # bins: equivalent noise bandwidth of that window
SEGMENTS = 8  # averaged, unless asked otherwise
SHORTEST = 16  # values in a segment
PROMINENT = 6.0  # dB a peak rises above its surroundings
PEAKS = 6  # told
TOP = 0.9  # of the Nyquist frequency: what lies above is near it
FOLDED = 0.01  # of the variance: more is told
STRANGE = 0.1  # of a line: what may come from beyond, more is told
LACKED = 0.1  # of the variance of the rows: more is told
STILL = 1e-9  # of the largest value: what moves less is rounding
MISSED = 0.1  # of the range: an extreme between the rows that is further out is told
# the last word of a channel -> that of its rate, where that is another word
RATES = {
    "position": "velocity",
    "velocity": "acceleration",
    "angular_velocity": "angular_acceleration",
    "rate": "acceleration",
}
UNEVEN = 1e-6  # of the interval: rows that differ by more are not evenly spaced


class Peak(NamedTuple):
    """A frequency that stands out."""

    frequency: float  # Hz
    amplitude: float  # of a sine there, in the unit of the channel
    prominence: float  # dB above its surroundings


class Spectrum(NamedTuple):
    """A spectral density and how it was made."""

    frequency: Array  # (n) Hz
    density: Array  # (n) unit / sqrt(Hz)
    segments: int
    resolution: float  # Hz
    nyquist: float  # Hz
    low: float  # factors of the density: its interval
    high: float
    rms: float  # of what the density holds, in the unit
    peaks: tuple[Peak, ...]  # largest amplitude first
    folded: float  # share of the variance that may have been folded back
    warnings: tuple[str, ...]
    length: float  # of a segment, s
    rows: float  # rms of the rows about their mean, in the unit
    bent: float  # about the straight line through them

    @property
    def lacks(self) -> float:
        """The share of the variance about that line that the density lacks, nothing if small."""
        share = 1.0 - (self.rms / self.bent) ** 2 if self.bent > 0.0 else 0.0
        return share if share > LACKED else 0.0

    @property
    def sloped(self) -> bool:
        """Whether that line, which no density holds, is much of the rows."""
        return self.bent**2 < (1.0 - LACKED) * self.rows**2


def spectrum(t: Array, x: Array, segments: int = SEGMENTS) -> Spectrum:
    """The spectral density of x (n) at evenly spaced times t (n) s.

    Raises UsageError for too few values or times that are not evenly spaced.
    """
    from scipy.signal import welch
    from scipy.stats import chi2

    rate = sampling(t)
    each = 2 * (len(x) // (segments + 1))
    if each < SHORTEST:
        what = f"{len(x)} rows are too few for {segments} segments"
        raise UsageError(what, "Take a longer window, or write rows more often.")
    f, p = welch(x, rate, WINDOW, each, each // 2, detrend="linear")
    count = (2 * len(x)) // each - 1
    freedom = 36.0 * count**2 / (19.0 * count - 1.0)
    low, high = np.sqrt(freedom / chi2.ppf([0.5 + LEVEL / 2, 0.5 - LEVEL / 2], freedom))
    variance = float(np.sum(p) * f[1])
    near = float(np.mean(p[f >= TOP * f[-1]]))
    folded = near * float(f[-1]) / variance if variance > 0.0 else 0.0
    warnings = []
    if folded > FOLDED:
        warnings.append(
            f"the density has not fallen off at the Nyquist frequency of {f[-1]:.4g} Hz: about "
            f"{min(folded, 1.0):.0%} of the variance may be folded back; write rows more often"
        )
    resolution = WIDTH * float(f[1])
    return Spectrum(f, np.sqrt(p), count, resolution, float(f[-1]), float(low),
                    float(high), float(np.sqrt(variance)), peaks(f, p, resolution), folded,
                    tuple(warnings), each / rate, *moved(t, x))  # fmt: skip


def moved(t: Array, x: Array) -> tuple[float, float]:
    """The rms of rows about their mean, and about the straight line through them."""
    s = t - np.mean(t)
    about = x - np.mean(x)
    bent = about - s * (s @ about) / (s @ s)
    still = STILL * float(np.max(np.abs(x)))
    sizes = (float(np.sqrt(np.mean(one**2))) for one in (about, bent))
    rows, rest = (size if size > still else 0.0 for size in sizes)
    return rows, rest


def sampling(t: Array) -> float:
    """The rate of evenly spaced times (Hz); raises UsageError where they are not."""
    if len(t) < 2 or t[-1] <= t[0]:
        raise UsageError("there are fewer than two rows", "Take a longer window.")
    every = float(t[-1] - t[0]) / (len(t) - 1)
    if np.max(np.abs(np.diff(t) - every)) > UNEVEN * every + 1e-12 * abs(float(t[-1])):
        raise UsageError("the rows are not evenly spaced in time", "Take another window.")
    return 1.0 / every


def peaks(f: Array, p: Array, resolution: float) -> tuple[Peak, ...]:
    """The largest maxima of a density p (n), as the sines they would be."""
    from scipy.signal import find_peaks

    if len(p) < 3 or p.max() <= 0.0:
        return ()
    level = 10.0 * np.log10(np.maximum(p, 1e-30 * p.max()))
    at, about = find_peaks(level, prominence=PROMINENT)
    found = []
    for k, prominence in zip(at.tolist(), about["prominences"].tolist(), strict=True):
        left, top, right = np.sqrt(p[k - 1 : k + 2])
        ratio = max(left, right) / top
        shift = float(np.clip((2.0 * ratio - 1.0) / (1.0 + ratio), 0.0, 0.5))
        amplitude = float(np.sqrt(2.0 * resolution) * top * (1.0 - shift**2) / np.sinc(shift))
        place = k + shift if right > left else k - shift
        found.append(Peak(float(place * f[1]), amplitude, prominence))
    return tuple(sorted(found, key=lambda peak: -peak.amplitude)[:PEAKS])


def of_channel(run: Run, channel: str, within: Window, segments: int = SEGMENTS) -> Spectrum:
    """The spectral density of a channel of a run in a window; raises UsageError."""
    if channel == "time":
        raise UsageError("time has no spectrum", "Name a channel that varies with it.")
    time, x = rows_in(run, channel, within)
    if len(time) > 2 and time[-1] - time[-2] < (1.0 - UNEVEN) * (time[1] - time[0]):
        time, x = time[:-1], x[:-1]  # the last row of a run may stand at an event
    try:
        found = spectrum(time, x, segments)
    except UsageError as error:
        raise UsageError(f"{run.path}: {channel}: {error.what}", error.hint) from None
    missed = beyond(run, channel, Window(float(time[0]), float(time[-1])), x)
    if missed > MISSED:
        text = (
            f"between the rows it goes further than in them by {missed:.0%} of its range: rows are "
            "too far apart for what happens there"
        )
        found = found._replace(warnings=(*found.warnings, text))
    if faster := rate(run, channel):
        moves = spectrum(time, rows_in(run, faster, within)[1][: len(x)], segments)
        told = tuple(strangers(found, moves, faster))
        found = found._replace(warnings=(*found.warnings, *told))
    return found


def rate(run: Run, channel: str) -> str:
    """The channel, or component, that is the derivative of one; empty where there is none."""
    stored, component = split(channel, run.sizes)
    tail = channel.removeprefix(stored) if component is not None else ""
    first, _, last = stored.rpartition(".")
    names = [f"{stored}.rate", f"{stored}_rate"]
    names += [f"{first}.{RATES[last]}"] if first and last in RATES else []
    units = (f"{run.unit(channel)}/s", run.unit(channel).removesuffix("/s") + "/s^2")
    there = (f"{name}{tail}" for name in names)
    return next((name for name in there if run.stores(name) and run.unit(name) in units), "")


def strangers(found: Spectrum, moves: Spectrum, of: str) -> Iterator[str]:
    """Which lines come from beyond the Nyquist frequency, by the spectrum of the rate."""
    for peak in found.peaks:
        k = round(peak.frequency / float(found.frequency[1]))
        f = float(found.frequency[k])
        beyond = 2.0 * found.nyquist - f
        speed = float(moves.density[k]) / (2.0 * np.pi * float(found.density[k]))
        if speed > found.nyquist and (speed - f) / beyond > STRANGE:
            yield (
                f"the line at {peak.frequency:.5g} Hz was folded back from beyond "
                f"{found.nyquist:.4g} Hz: {of} has there what goes with {speed:.4g} Hz; write rows "
                "more often"
            )


def beyond(run: Run, channel: str, within: Window, x: Array) -> float:
    """How far extremes at accepted steps lie outside of the rows, of the range of the rows."""
    size = float(np.ptp(x))
    kept = [p for p in run.peaks if p.channel == channel and within.has(p.time)]
    out = [max(p.value - x.max(), x.min() - p.value) for p in kept]
    return max(0.0, *out) / size if out and size > 0.0 else 0.0
