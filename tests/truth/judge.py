"""A scene run by trsim, and the verdict on what it says.

wrong: ended well, with a number off by more than

    bound = min(WHOLE, max(100 tolerance, 10 stated error)) growth

of its scale, at a row or in an extreme between rows (extremes.py); growth is by how much more than
EASY times a small change of the start has grown by then (1 at least), by the reference itself, in
places and speeds (before a scene is told to be wrong also changes of the speeds on the way, at
eight times); where a channel has grown by more at a row, as forces do in contacts, its growth there
is taken.  Nothing is judged where the bound is above
WHOLE by its growth: beyond the horizon of prediction; nor, before a scene is told to be wrong,
behind an instant at which a contact in clearance opens by less than a tolerance of the size in one
of both and not in the other: another impact begins where it opens, with other damping (clearance
1236640791: a change of a speed at the start by one tolerance opens it, and then there are 335 in
another).  Times of rows may be off by what their
places may.  Missed crossings are wrong where they are deeper than 10 tolerances.
"""

import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from trsim.assemble.assemble import assemble
from trsim.errors import TrsimError
from trsim.scenario.load import loads
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.march.record import EVENT_KIND, EVENT_ROW, EVENT_TIME, ONSET
from trsim.solve.simulate import simulate

from .extremes import beyond
from .reference import Channel, Crossing, Truth, size
from .scene import Event, Limit, Scene, Seal, Section, Touch, Wall

EASY, WHOLE = 20.0, 1.0
TIMES, STATED, DEPTH = 100.0, 10.0, 10.0
SURE = 3.0  # times how far the reference is sure, beside its bound
RIGHT, WRONG, REFUSED, TOLD = "right", "WRONG", "refused", "told"
UNJUDGED, CRASH = "unjudged", "CRASH"
BROKEN = "BROKEN"  # the generator itself
# of a contact that is pressed too deep, of a seal
MEANS_NOTHING = re.compile("for its law to mean anything|its line went through the plane")
LEAST = 1e-9  # bound of what is closed to rounding


@dataclass
class Verdict:
    family: str
    seed: int
    verdict: str
    method: str
    tolerance: float
    ratio: float = 0.0  # worst error over its bound
    what: str = ""  # where that is
    why: str = ""
    exit: int = 0
    warnings: list[str] = field(default_factory=list)
    grazing: int = 0
    truth: str = ""
    by: str = "engine"
    reach: float = 1.0  # share of the rows that could be judged
    cpu: tuple[float, float] = (0.0, 0.0)  # of the reference, of trsim

    def line(self) -> dict[str, Any]:
        return asdict(self)


@dataclass
class Ran:
    """What trsim gave: an exit code, and its results where there are any."""

    exit: int
    reason: str = ""
    t: np.ndarray = field(default_factory=lambda: np.zeros(0))
    rows: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    place: dict[str, slice] = field(default_factory=dict)
    events: np.ndarray = field(default_factory=lambda: np.zeros((0, 6)))
    points: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))
    statistics: dict[str, float] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    sections: list[str] = field(default_factory=list)
    user: dict[str, np.ndarray] = field(default_factory=dict)  # times of user events
    status: str = ""
    time: float = 0.0
    # (k, 4) of what is told between rows: largest, when, least, when; a magnitude's: the largest
    extremes: dict[str, np.ndarray] = field(default_factory=dict)
    magnitudes: dict[str, np.ndarray] = field(default_factory=dict)

    def __getitem__(self, name: str) -> np.ndarray:
        return self.rows[:, self.place[name]]


def ran(text: str) -> Ran:
    """The scene through the functions the command calls."""
    try:
        scenario = loads(text, ())
        mechanism = assemble(scenario)
        march = simulate(scenario, mechanism)
        blocks: list[tuple[np.ndarray, ...]] = []
        while True:
            try:
                block = next(march)
            except StopIteration as stop:
                outcome = stop.value
                break
            blocks.append(tuple(x.copy() for x in (block.rows, block.events, block.points)))
        said = [*mechanism.notes, *doubts(scenario, mechanism, outcome)]
    except TrsimError as error:
        first = error.problems[0] if error.problems else error
        return Ran(getattr(first, "exit_code", error.exit_code), first.what)
    except Exception as error:  # what no command may end with
        return Ran(1, f"{type(error).__name__}: {error}")
    rows, events, points = (np.vstack(x) for x in zip(*blocks, strict=True))
    place = {c.name: slice(1 + c.start, 1 + c.start + c.size) for c in mechanism.columns}
    return Ran(
        5 if outcome.status == "failed" else 0, outcome.reason, rows[:, 0], rows, place, events,
        points, outcome.statistics, said, [x.name for x in mechanism.sections],
        {
            event.name: events[events[:, EVENT_ROW] == len(mechanism.instances) + 1 + k, EVENT_TIME]
            for k, event in enumerate(mechanism.stages.switches.events)
        },
        str(outcome.status), outcome.time, *told_extremes(mechanism, outcome.peaks),
    )  # fmt: skip


def told_extremes(mechanism: Any, peaks: np.ndarray) -> tuple[dict[str, np.ndarray], ...]:
    """Extremes of the channels that are looked at between rows, and of magnitudes."""
    m = mechanism.model
    sought, columns = set(m.sought.tolist()), mechanism.columns
    of = {c.start: c.name for c in columns}
    single = {c.name: peaks[c.start : c.start + c.size] for c in columns if c.start in sought}
    return single, {of[at]: peaks[m.n_out + k] for k, at in enumerate(m.vector.tolist())}


def stated(r: Ran) -> float:
    """The relative error a run says it has."""
    told = [r.statistics.get("energy_residual_relative", 0.0)]
    for text in r.warnings:
        if "energy book does not close" in text:
            told += [float(x) / 100 for x in re.findall(r"by ([0-9.e+-]+) %", text)]
        told += [float(x) for x in re.findall(r"joints were open by up to ([0-9.e+-]+)", text)]
        told += [float(x) / 100 for x in re.findall(r"joints and drives did ([0-9.e+-]+) %", text)]
        told += [float(x) for x in re.findall(r"makes RK4 err by about ([0-9.e+-]+)", text)]
    return max(told)


def stated_of_accelerations(r: Ran) -> float:
    """The error of accelerations that a run reports: of joints open without projection, and of what
    no step is held to."""
    said = r"change accelerations by ([0-9.e+-]+) of|off by ([0-9.e+-]+) of the largest in a single"
    told = [filter(None, sum(re.findall(said, text), ())) for text in r.warnings]
    return max((float(x) for found in told for x in found), default=0.0)


def judged(scene: Scene, t: Truth, r: Ran, v: Verdict) -> Verdict:
    """The verdict, written into v."""
    v.exit, v.warnings = r.exit, r.warnings
    if r.exit in (3, 4, 5):
        drifts = scene.rates is not None or scene.settings.get("stabilisation") == "none"
        chance = drifts and re.search("branches of the motion (nearly )?meet", r.reason)
        folded = t.folded and "is bent by half a turn" in r.reason
        v.verdict, v.why = TOLD if chance or folded else REFUSED, r.reason
        return v
    if r.exit:
        v.verdict, v.why = CRASH, r.reason
        return v
    tolerance = v.tolerance
    least = max(TIMES * tolerance, STATED * stated(r), LEAST)
    if STATED * stated(r) >= WHOLE:
        v.verdict, v.why = UNJUDGED, f"says of itself that it is off by {stated(r):.1g}"
        return v
    easy = np.maximum(1.0, t.growth / EASY)
    bound = np.minimum(WHOLE, least) * easy + SURE * t.sure
    use = (bound <= WHOLE) | (easy == 1.0) & (t.sure < 0.01)
    use &= t.times < t.until
    use[:1] = True
    use = np.logical_and.accumulate(use)
    v.reach = float(np.mean(use))
    v.truth = f"{t.steps} steps, sure to {t.sure[use][-1]:.1e}, growth {t.growth[use][-1]:.3g}"
    worst: list[tuple[float, str]] = [(0.0, "")]
    top = t.top
    if t.ended is not None and use.all():
        off = abs(r.time / scene.unit((0, 0, 1)) - t.ended)
        allowed = float(bound[-1]) * t.size / top["speed"] + 1e-9 * scene.end
        worst.append((off / allowed, f"ended at {r.time:.6g}, {off:.3g} from {t.ended:.6g}"))
    share = min(WHOLE, least) / EASY  # of what a small change has grown to
    k = np.arange(len(t.times))[use]
    missing = [i for i in k if not len(near(r, t.times[i] * scene.unit((0, 0, 1))))]
    if missing:
        worst.append((np.inf, f"no row at {t.times[missing[0]]:.6g} (ended at {r.time:.6g})"))
    k = np.array([i for i in k if i not in missing], int)
    at = np.array([near(r, t.times[i] * scene.unit((0, 0, 1)))[0] for i in k], int)
    for name, c in t.channels.items():
        if name in r.place and len(k):
            worst.append(compared(scene, t, r, name, c, top, bound, k, at, share))
    crossings(scene, t, r, tolerance, bound, use, top, worst)
    if use.all():
        worst += beyond(scene, t, r, float(bound.max()), top, share)
    v.ratio, v.what = max(worst, key=lambda x: x[0] if x[0] == x[0] else np.inf)
    v.grazing = len(t.grazing) + int(t.until < np.inf)
    if not v.ratio <= 1.0 and any(MEANS_NOTHING.search(text) for text in r.warnings):
        v.verdict, v.why = TOLD, MEANS_NOTHING.pattern
    elif not v.ratio <= 1.0:
        v.verdict = WRONG
    elif v.reach < 0.1:
        v.verdict = UNJUDGED
    return v


def near(r: Ran, time: float) -> np.ndarray:
    return np.flatnonzero(np.abs(r.t - time) <= 1e-9 * max(time, r.time, 1e-300))


def compared(
    scene: Scene, t: Truth, r: Ran, name: str, c: Channel, top: dict[str, float],
    bound: np.ndarray, k: np.ndarray, at: np.ndarray, share: float,
) -> tuple[float, str]:  # fmt: skip
    """The worst of a channel over its bound, and where."""
    unit = scene.unit(c.dims)  # type: ignore[arg-type]
    got = r[name][at] / unit
    Q = scene.turned
    if c.vector:
        got = got @ Q  # Q^T of each
        if c.dims == (1, 0, 0) and name.endswith(".position"):
            got = got - scene.moved
    elif c.kind == "matrix":
        got = np.einsum("ji,njk,kl->nil", Q, got.reshape(-1, 3, 3), Q).reshape(-1, 9)
    want = c.values[k]
    soft = np.zeros_like(want)
    for one in t.about:
        soft = np.fmax(soft, np.abs(one[name].values[k] - want))
    share_of_it = bound[k, None]
    if name.endswith("acceleration") or c.kind in ("force", "moment"):
        share_of_it = np.fmax(share_of_it, STATED * stated_of_accelerations(r))
    allowed = share_of_it * top[c.kind] + soft
    if name in t.felt:
        allowed = np.fmax(allowed, share * t.felt[name][k])
    error = np.abs(got - want)
    ratio = np.where(np.isfinite(got), error / np.maximum(allowed, 1e-300), np.inf)
    ratio = np.where(np.isfinite(want), ratio, 0.0)
    i, j = np.unravel_index(np.argmax(ratio), ratio.shape)
    where = f"{name}[{j}] at {t.times[k[i]]:.6g}: {got[i, j]:.8g} for {want[i, j]:.8g}"
    return float(ratio[i, j]), where


def crossings(
    scene: Scene, t: Truth, r: Ran, tolerance: float, bound: np.ndarray, use: np.ndarray,
    top: dict[str, float], worst: list[tuple[float, str]],
) -> None:  # fmt: skip
    """Events, points of sections and touches: as many, and when."""
    until = t.times[use][-1] if not use.all() else scene.end
    if t.ended is not None and use.all():
        until = t.ended * (1 + 1e-9)
    T = scene.unit((0, 0, 1))
    for what in (*scene.events, *scene.sections):
        if isinstance(what, Section) and what.when is None:
            continue
        sense = {"up": 1, "down": -1, "both": 0}[what.crosses]
        want = [c for c in t.crossings if c.name == what.name and sense in (0, c.sense)]
        earlier = [c for c in want if c.time < getattr(what, "after", 0.0)]
        want = want[len(earlier) :]
        if isinstance(what, Event):
            if what.times is not None:
                want = want[: what.times]
            got = r.user[what.name] / T
        else:
            rows = r.points[r.points[:, 1] == r.sections.index(what.name)]
            got = rows[:, 0] / T
        scale = (
            1.0 if what.when == "t" or scene.of_sensor(what.when or "t") == (0, 0, 0) else t.size
        )
        if isinstance(what, Section) and what.rate:
            scale = top["spin"] if scale == 1.0 else top["speed"]
        matched(what.name, want, got, until, tolerance, bound, t, scale, worst, earlier)
    if names := touching(scene):
        want = [c for c in t.crossings if c.name in names and c.sense > 0]
        got = r.events[r.events[:, EVENT_KIND] == ONSET, EVENT_TIME] / T
        if not scene.method.startswith("scipy") and scene.method != "rk4":
            matched("touch", want, got, until, tolerance, bound, t, t.size, worst)


def parted(scene: Scene, t: Truth, r: Ran, tolerance: float) -> float:
    """The first instant at which a contact in clearance opens, or stays closed, by less than the
    tolerance of the size, and which the run has another number of touches behind; inf if none."""
    want = np.array([c.time for c in t.crossings if c.name in touching(scene) and c.sense > 0])
    got = r.events[r.events[:, EVENT_KIND] == ONSET, EVENT_TIME] / scene.unit((0, 0, 1))
    for at, by in sorted(t.openings):
        behind = at + 0.02 * t.end
        if by <= tolerance * t.size and np.sum(want <= behind) != np.sum(got <= behind):
            return at
    return np.inf


def touching(scene: Scene) -> set[str]:
    """The names of what is touched."""
    names = {f.name for f in scene.forces if isinstance(f, (Wall, Limit, Touch, Seal))}
    return names | {j.name for j in scene.joints if j.clearance is not None}


def matched(
    name: str, want: list[Crossing], got: np.ndarray, until: float, tolerance: float,
    bound: np.ndarray, t: Truth, scale: float, worst: list[tuple[float, str]],
    earlier: Sequence[Crossing] = (),
) -> None:  # fmt: skip
    """Each crossing with the nearest one found; what is left over on either side.

    earlier: those before the time from which it is looked at; one may be found a little late.
    """
    free = list(np.sort(got))
    slack = until - 1e-12
    for c in want:
        b = float(np.interp(c.time, t.times, bound))
        if c.time > slack:
            break
        # a place wrong by the bound is a time wrong by that over the rate
        within = b * (scale / max(abs(c.rate), 1e-12)) + 1e-9 * t.times[-1]
        if c.time + within > slack:
            continue
        k = min(range(len(free)), key=lambda i: abs(free[i] - c.time), default=None)
        off = abs(free[k] - c.time) if k is not None else np.inf
        apart = min((abs(x.time - c.time) for x in want if x is not c), default=t.times[-1])
        if k is not None and off <= max(within, 0.3 * apart):
            free.pop(k)
            worst.append((off / within, f"{name}: at {c.time - off:.9g} for {c.time:.9g}"))
            continue
        limit = scale * max(DEPTH * tolerance, b / TIMES * DEPTH)
        worst.append(
            (
                c.depth / limit,
                f"{name}: crossing at {c.time:.6g} missed ({len(got)} found, {len(want)} are), "
                f"{c.depth:.3g} deep",
            )
        )
    for time in free:
        if time > slack:
            continue
        b = float(np.interp(time, t.times, bound))
        # what comes that late or early belongs to one that could not be judged
        around = [*want, *earlier]
        within = [max(0.02 * t.end, b * scale / max(abs(x.rate), 1e-12)) for x in around]
        near = any(abs(time - x.time) <= w for x, w in zip(around, within, strict=True))
        if not near and not t.grazing:
            worst.append((10.0, f"{name}: found at {time:.6g}, where there is none"))


def against(scene: Scene, r: Ran, tight: Ran, v: Verdict) -> Verdict:
    """Of a run beside a tight one: all channels but accelerations, each over the largest of it."""
    v.exit, v.warnings = r.exit, r.warnings
    if r.exit in (3, 4, 5):
        v.verdict, v.why = REFUSED, r.reason
        return v
    if r.exit:
        v.verdict, v.why = CRASH, r.reason
        return v
    if tight.exit or tight.rows.shape != r.rows.shape:
        v.verdict, v.why = UNJUDGED, f"the tight run: exit {tight.exit}, {tight.reason}"
        return v
    bound = min(WHOLE, max(TIMES * v.tolerance, STATED * stated(r), LEAST))
    L, T = size(scene) * scene.unit((1, 0, 0)), scene.unit((0, 0, 1))
    worst = (0.0, "")
    for name, place in r.place.items():
        last = name.rsplit(".", 1)[-1]
        least = {"position": L, "tip": L, "middle": L, "velocity": L / (T * scene.end)}.get(last)
        if least is None and name not in {x.name for x in scene.sensors}:
            continue
        want, got = tight.rows[:, place], r.rows[:, place]
        top = max(float(np.abs(want - want[0]).max()), least or 1.0)
        error = float(np.abs(got - want).max()) / top
        worst = max(worst, (error / bound, f"{name}: off by {error:.3g} of {top:.3g}"))
    v.ratio, v.what = worst
    if not v.ratio <= 1.0:
        v.verdict = WRONG
    return v


def rigid(scene: Scene, r: Ran, v: Verdict) -> Verdict:
    """Of a scene that cannot move: refused with reason, or at rest with its joints closed."""
    v.exit, v.warnings = r.exit, r.warnings
    if r.exit in (4, 5):
        v.verdict, v.why = TOLD, r.reason
        return v
    if r.exit:
        v.verdict, v.why = (REFUSED if r.exit == 3 else CRASH), r.reason
        return v
    L = scene.unit((1, 0, 0)) * size(scene)
    worst = (0.0, "")
    for body in scene.bodies:
        x = r[f"{body.name}.position"]
        off = float(np.abs(x - x[0]).max()) / L
        worst = max(
            worst, (off / max(1e-3, TIMES * v.tolerance), f"{body.name} moves by {off:.3g}")
        )
    v.ratio, v.what = worst
    if not v.ratio <= 1.0:
        v.verdict = WRONG
    return v
