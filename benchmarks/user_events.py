"""User events beside closed forms: when they happen, and the motion after what they do.

Scenes of tests/solve/test_user_events.py.
"""

from math import cos, pi, sin

import numpy as np

from benchmarks.tables import head, power, row
from tests.runs import run
from tests.solve.test_user_events import ANGLE, PENDULUM, RATE, SWING, G, L, fall_time, user
from trsim.solve.march.record import EVENT_TIME, EVENT_WORK

METHODS = {
    "dop853": "method: dop853",
    "radau": "method: radau",
    "auto": "method: auto",
    "rk4": "method: rk4, step: 1 ms, locate_events: true",
    "generalized_alpha": "method: generalized_alpha",
}
HALF = "  half: {when: x, value: 50 mm, do: {record: true}}"
HELD = """
  hold: {when: x, value: 50 mm, times: 1, do: {lock: [slide]}}
  go: {when: t, value: 0.3, do: {unlock: [slide]}}
"""
LET_GO = f"  low: {{when: angle, value: -{ANGLE}, crosses: down, do: {{release: [hinge]}}}}"


def swung(method: str) -> tuple[float, float, float]:
    """Errors of the crossings of 3 s, of the work of the lock, and of the swing after it."""
    crossed = user(run(SWING.replace("end: 1,", f"end: 3, {method},") + HALF))[:, EVENT_TIME]
    r = run(SWING.replace("end: 1,", f"end: 0.5, {method},") + HELD)
    free = r.t > 0.3
    after = r["x"][free] - 0.05 * np.cos(10 * (r.t[free] - 0.3))
    return (
        np.abs(crossed - (pi / 6 + 2 * pi * np.arange(5)) / 10).max(),
        np.abs(user(r)[:, EVENT_WORK] - [-0.75, 0.0]).max(),
        np.abs(after).max(),
    )


def fallen(method: str) -> tuple[float, float]:
    """Errors of the time at which the rod is let go, and of its parabola."""
    r = run(PENDULUM.replace("end: 1,", f"end: 1, {method},") + LET_GO)
    at = fall_time()
    free = r.t > at
    t, u = r.t[free] - at, RATE * L
    x = L * cos(ANGLE) - u * sin(ANGLE) * t
    y = -L * sin(ANGLE) - u * cos(ANGLE) * t - 0.5 * G * t * t
    off = r["rod.position"][free][:, :2] - np.column_stack([x, y])
    return abs(user(r)[0, EVENT_TIME] - at), np.abs(off).max()


def main() -> None:
    """Print the table."""
    head("method", "crossings s", "work of the lock J", "swing after it m", "time of release s",
         "parabola m")  # fmt: skip
    for name, method in METHODS.items():
        row(name, *(power(float(x), 0) for x in (*swung(method), *fallen(method))))


if __name__ == "__main__":
    main()
