"""Largest Lyapunov exponents of series: of known ones, and of some that have none."""

from collections.abc import Callable

import numpy as np

from benchmarks.tables import head, row
from tests.analyse.series import henon, logistic, lorenz, roessler
from trsim.analyse.lyapunov import exponent

N = 5000
TIME = 0.01 * np.arange(N)
Series = tuple[np.ndarray, np.ndarray]


def first(series: tuple[np.ndarray, np.ndarray]) -> Series:
    """The first channel of several."""
    time, x = series
    return time, x[0]


def waves(*parts: tuple[float, float]) -> Series:
    """A sum of sines, by size and frequency."""
    return TIME, sum(size * np.sin(2 * np.pi * rate * TIME) for size, rate in parts)


SYSTEMS: tuple[tuple[str, Callable[[], Series], str], ...] = (
    ("logistic map, r = 4", lambda: logistic(N), "0.693"),
    ("logistic map, r = 3.7", lambda: logistic(N, 3.7), "0.354"),
    ("Henon map", lambda: henon(N), "0.419"),
    ("Lorenz system", lambda: first(lorenz(20_000)), "0.906 1/s"),
    ("Lorenz system", lambda: first(lorenz(10_000)), "0.906 1/s"),
    ("Roessler system", lambda: roessler(20_000), "0.0714 1/s"),
    ("sine", lambda: waves((1.0, 1.03)), "0"),
    ("two sines", lambda: waves((1.0, 1.03), (0.5, 1.03 * np.sqrt(2.0))), "0"),
    ("logistic map, period 2", lambda: logistic(N, 3.2), "0"),
    ("logistic map, period 3", lambda: logistic(N, 3.83), "0"),
    ("white noise", lambda: (TIME, np.random.default_rng(1).standard_normal(N)), "-"),
)


def main() -> None:
    """Print the table."""
    head("system", "rows", "known", "found")
    for name, series, known in SYSTEMS:
        time, x = series()
        found, unit = exponent(time, x), " 1/s" if known.endswith("1/s") else ""
        words = {
            "grows": f"{found.value:.3g} +- {found.half:.2g}{unit}",
            "none": "no growth",
        }
        row(name, len(time), known, words.get(found.verdict, found.verdict))


if __name__ == "__main__":
    main()
