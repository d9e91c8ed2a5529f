"""Runs with a static phase and a motion: chains as in static_paths.py, judged in two parts.

The rows of the static phase are judged as static paths are (statics.py).  Where and how fast the
mechanism is as the motion begins is sought again, from the joints of the last row of the path; from
there the motion is that of the reference.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from .draw import between, pick
from .families import Drawn, family
from .judge import (
    LEAST,
    RIGHT,
    STATED,
    TIMES,
    UNJUDGED,
    WRONG,
    Ran,
    Verdict,
    judged,
    stated,
)
from .reference import LADDER, Stage, Unfit, truth_at
from .scene import Scene, Torsion
from .static_paths import FAMILIES as FAMILIES
from .static_paths import static_cam, static_path
from .statics import CREEP, Balance
from .statics import judged as judged_path

PHASED = "phased"
DAMPED = 0.05  # of the time of a swing: what springs of joints damp a motion with
STEP = 1e-4  # s, of differences
LONGER, SMOOTH = 10.0, 1e-6  # times the step; of the rates: by so much may two differences differ


@family
def phases(rng: Any) -> Drawn:
    """A chain brought into place from balance to balance, then let go or driven on."""
    drawn = pick(rng, static_path, static_path, static_cam)(rng)
    s = drawn.scene
    for law in s.laws:
        law.friction = "none"
    s.method, s.tolerance = pick(rng, "auto", "dop853", "radau"), 10.0 ** -between(rng, 5, 9)
    s.rows = 24
    first = s.end * between(rng, 0.2, 0.7)
    for f in s.forces:
        if isinstance(f, Torsion):
            f.c = DAMPED * f.k
    lets_go = bool(rng.random() < 0.6)
    T = s.unit((0, 0, 1))
    begin = {"name": "place", "static": True, "for": float(first * T)}
    move: dict[str, Any] = {"name": "move"}
    if lets_go:
        move["release"] = ["motor"]
    s.extra["phases"] = [begin, move]
    drawn.by, drawn.begins = PHASED, (first, lets_go)
    return drawn


def part(r: Ran, begin: float, end: float) -> Ran:
    """What a run gave behind a time, up to another one."""
    rows = (r.t > begin) & (r.t <= end)
    events = r.events[(r.events[:, 0] > begin) & (r.events[:, 0] <= end)]
    return replace(r, t=r.t[rows], rows=r.rows[rows], events=events)


def begun(s: Scene, r: Ran, t: float, lets_go: bool) -> tuple[float, np.ndarray, Stage]:
    """Where the motion begins: the balance at t, and how it moves with t."""
    balance = Balance(s)
    last = int(np.flatnonzero(r.t / s.unit((0, 0, 1)) <= t)[-1])
    q = {name: r[f"at_{name}"][last, 0] / s.unit(s.of_joint(name)) for name in balance.b.coordinate}
    there, top = balance.balanced(t, q | balance.place_of(t), None)
    if top > -1e-9:
        raise Unfit("the balance that the motion begins in is not stable")

    def way_by(h: float) -> dict[str, float]:
        """The rates of the balance, by differences of fourth order."""
        at = {k: balance.balanced(t + k * h, there | balance.place_of(t + k * h), None)[0]
              for k in (-2, -1, 1, 2)}  # fmt: skip
        return {n: (8 * (at[1][n] - at[-1][n]) - at[2][n] + at[-2][n]) / (12 * h) for n in there}

    way, longer = way_by(STEP), way_by(LONGER * STEP)
    if all(abs(longer[n] - way[n]) <= SMOOTH * max(map(abs, way.values())) for n in way):
        way = longer  # no corner is near, and rounding is felt less
    y = balance.state(there, way)
    for b in range(len(s.bodies)):
        y[13 * b + 7 : 13 * b + 13] /= CREEP
    return t, y, Stage(released={"motor"} if lets_go else set())


def judged_in_parts(drawn: Drawn, r: Ran, v: Verdict) -> Verdict:
    """The verdict on both parts: the worse one."""
    s, (first, lets_go) = drawn.scene, drawn.begins
    if r.exit:
        return judged_path(s, r, v)
    T = s.unit((0, 0, 1))
    times = r.t / T
    v = judged_path(s, part(r, -1.0, first * T), v)
    if v.verdict != RIGHT or times[-1] <= first or v.reach < 1.0:
        return v
    try:
        begin = begun(s, r, first, lets_go)
        bound = max(TIMES * v.tolerance, STATED * stated(r), LEAST)
        t = truth_at(s, min(0.1, bound), *LADDER[0], begin)
    except (Unfit, np.linalg.LinAlgError) as error:
        v.truth += f"; {error}"
        return v
    t.smooth = None  # extremes are those of both parts
    for name, c in t.channels.items():  # books are opened as the motion begins
        if name.startswith("energy.work") and name in r.place:
            row = int(np.flatnonzero(times > first)[0])
            c.values += r[name][row] / s.unit(c.dims) - c.values[0]  # type: ignore[arg-type]
    moving = Verdict(v.family, v.seed, RIGHT, v.method, v.tolerance, by=v.by)
    moving = judged(s, t, part(r, first * T, np.inf), moving)
    if moving.verdict == UNJUDGED or (moving.verdict == RIGHT and moving.ratio <= v.ratio):
        return v
    if moving.verdict == WRONG:
        moving.what = f"in motion: {moving.what}"
    return moving
