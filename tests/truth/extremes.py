"""Extremes as trsim stores them against those of the reference at the ends of its own steps.

Those are many (a fiftieth of a turn, all crossings from both sides), and hold on one side: no
stored extreme is nearer than the largest of them.  On the other side it is not further than the
polynomial through the ends around it goes, what one of lower order says otherwise, and 1e-5 of the
range, which is what these know.  What goes further is compared with the reference at that very
time: a force may have a spike between two ends.  Allowed is
what is allowed at the rows, and what a small change of the start makes of the extreme itself.
Forces that the run calls chance are not judged.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from .reference import APART, Smooth, Truth
from .scene import Scene, Seal, Touch

FEWEST = 5  # ends of steps in a stretch whose polynomials say anything
AROUND, APART_BY = 20, 0.3  # ends; of their mean distance: nearer ones say nothing more
PLACES = 33
UNSURE = 3.0  # times the difference of both polynomials
PLAIN = 0.1  # of what is allowed: so much beyond an end of a step needs no polynomial
KNOWN = 1e-5  # of the range: how well polynomials know what no end of a step shows
CLOSE = 0.3  # of the range: between ends a fiftieth of a turn apart no top is higher by more
CHANCE = "are chance"


def beyond(
    scene: Scene, t: Truth, r: Any, bound: float, top: dict[str, float], share: float
) -> Iterator[tuple[float, str]]:
    """How far each extreme is off over what is allowed, and where."""
    if not t.smooth:
        return
    loose = any(CHANCE in text for text in r.warnings)
    beside: list[Smooth] | None = None
    # distances have corners where another place of a surface is the nearest one
    cornered = {
        f"{f.name}.{word}"
        for f in scene.forces
        if isinstance(f, Touch) and f.shape in ("polygon", "line", "ellipse")
        for word in ("penetration", "penetration_rate")
    } | {f"{f.name}.compression" for f in scene.forces if isinstance(f, Seal)}
    for name, c in t.channels.items():
        if name not in r.extremes or (loose and c.kind in ("force", "moment")):
            continue
        if name in cornered:
            continue
        unit = scene.unit(c.dims)  # type: ignore[arg-type]
        soft = max((np.nanmax(np.abs(a[name].values - c.values)) for a in t.about), default=0.0)
        soft += share * float(np.max(t.felt[name], initial=0.0)) if name in t.felt else 0.0
        Q = scene.turned if c.vector else np.eye(c.values.shape[1])
        parts = series(t.smooth, name, Q)
        largest = max(float(np.abs(x).max(initial=0.0)) for _, x in parts)
        allowed = bound * max(top[c.kind], largest) + soft
        for what, got, when, of in stored(name, r, unit):
            ratio, want = off(got, [(x, of(v)) for x, v in parts], allowed)
            if ratio > 1.0:  # a small change of the start may make more of it
                beside = (t.beside() or []) if beside is None else beside
                two = [of(v).max() for _, v in series(beside, name, Q)]
                ends = max(of(v).max() for _, v in parts)
                more = share * abs(max(two) - ends) / APART if two else 0.0
                ratio, want = off(got, [(x, of(v)) for x, v in parts], allowed + more)
                if ratio > 1.0 and got > want:  # a spike between two ends
                    at = t.there(when / scene.unit((0, 0, 1))).get(name)
                    if at is not None and len(at):
                        want = max(want, float(of(at @ Q.T).max()))
                        ratio = min(ratio, max(got - want, 0.0) / (allowed + more))
            yield ratio, f"{what}, {got:.8g} at {when:.6g} for {want:.8g}"


def stored(name: str, r: Any, unit: float) -> Iterator[tuple[str, float, float, Any]]:
    """Extremes of a channel: which, its value (of a least one with the other sign), its time, and
    what of the channel it is the largest of."""
    for k, (high, t_high, low, t_low) in enumerate(r.extremes[name]):
        yield f"largest {name}[{k}]", high / unit, t_high, lambda v, k=k: v[:, k]
        yield f"least {name}[{k}] (-)", -low / unit, t_low, lambda v, k=k: -v[:, k]
    if name in r.magnitudes:
        high, t_high = r.magnitudes[name][:2]
        yield f"largest |{name}|", high / unit, t_high, lambda v: np.linalg.norm(v, axis=1)


def series(smooth: list[Smooth], name: str, Q: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """A channel, in the axes trsim reads, on every stretch that has it."""
    return [(p.times, p.values[name] @ Q.T) for p in smooth if name in p.values]


def off(got: float, parts: Any, allowed: float) -> tuple[float, float]:
    """How far a largest value is off over what is allowed; what it should be."""
    ends = max(float(v.max()) for _, v in parts)
    allowed = max(allowed, 1e-300)
    if not np.isfinite(got):
        return np.inf, ends
    if got <= ends + PLAIN * allowed:
        return abs(got - ends) / allowed, ends
    most, unsure = between(parts, ends)
    scale = max(float(np.ptp(np.concatenate([v for _, v in parts]))), abs(ends))
    return max(got - most, 0.0) / (allowed + UNSURE * unsure + KNOWN * scale), most


def between(parts: Any, ends: float) -> tuple[float, float]:
    """The largest value of polynomials around the highest ends, and how unsure it is."""
    most, unsure = ends, 0.0
    low = min(float(v.min()) for _, v in parts)
    for t, v in parts:
        if v.max() < ends - CLOSE * (ends - low):
            continue
        if len(t) < FEWEST:
            return ends, np.inf
        near = np.append(v, -np.inf) >= ends - CLOSE * (ends - low)
        tops = np.flatnonzero(near[:-1] & (v >= np.append(v[1:], -np.inf))
                              & (v >= np.append(-np.inf, v[:-1])))  # fmt: skip
        for i in tops:
            x = np.linspace(t[max(i - 1, 0)], t[min(i + 1, len(t) - 1)], PLACES)
            fine, rough = (through(t, v, i, n, x) for n in (7, 5))
            k = int(np.argmax(fine))
            # places are apart, and between them it is higher
            x = np.linspace(x[max(k - 1, 0)], x[min(k + 1, PLACES - 1)], PLACES)
            most = max(most, float(through(t, v, i, 7, x).max()))
            unsure = max(unsure, float(np.abs(fine - rough).max()))
    return most, unsure


def through(t: np.ndarray, v: np.ndarray, i: int, n: int, x: np.ndarray) -> np.ndarray:
    """The polynomial through n ends around the i-th, those apart from each other, at x."""
    first, last = max(i - AROUND, 0), min(i + AROUND, len(t) - 1)
    apart = APART_BY * (t[last] - t[first]) / (last - first)
    sides: list[list[int]] = [[], []]
    for side, places in zip(
        sides, (range(i - 1, first - 1, -1), range(i + 1, last + 1)), strict=True
    ):
        for k in places:
            if abs(t[k] - t[(side or [i])[-1]]) > apart:
                side.append(k)
    fewer = min(len(side) for side in sides)
    half = max(n // 2, n - 1 - fewer)  # where one side has not enough the other has more
    chosen = [i, *(k for side in sides for k in side[:half])][:n]
    nodes = t[chosen]
    weight = np.array([1.0 / np.prod(a - np.delete(nodes, j)) for j, a in enumerate(nodes)])
    d = x[:, None] - nodes
    at = np.abs(d) < 1e-300
    d[at] = 1.0
    terms = weight / d
    out = terms @ v[chosen] / terms.sum(axis=1)
    exact = at.any(axis=1)
    out[exact] = v[chosen][np.argmax(at[exact], axis=1)]
    return np.asarray(out)
