"""One scene: made from its family and seed alone, run, judged."""

import time
import zlib
from dataclasses import replace

import numpy as np

from . import statics
from .families import ENGINE, INVALID, ONE, RIGID, TIGHT_RUN, Drawn
from .judge import (
    BROKEN,
    CRASH,
    LEAST,
    RIGHT,
    STATED,
    TIMES,
    TOLD,
    UNJUDGED,
    WRONG,
    Verdict,
    against,
    judged,
    parted,
    ran,
    rigid,
    stated,
)
from .phased import FAMILIES, PHASED, judged_in_parts
from .reference import Truth, Unfit, growth_of_later, truth
from .scene import Scene
from .static_paths import STATIC


def made(family: str, seed: int) -> Drawn:
    """The scene of a seed."""
    rng = np.random.default_rng([zlib.crc32(family.encode()), seed])
    drawn = FAMILIES[family](rng)
    drawn.scene.note = f"{family} {seed}"
    return drawn


def true(drawn: Drawn, bound: float) -> Truth:
    """What is true of it, to be compared to a bound."""
    if drawn.truth is not None:
        t: Truth = drawn.truth(drawn.scene)
    else:
        t = truth(drawn.scene, min(0.1, bound))
    if not drawn.forces:
        names = {j.name for j in drawn.scene.joints}
        t.channels = {
            x: c for x, c in t.channels.items()
            if x.rsplit(".", 1)[0] not in names or "reaction" not in x
        }  # fmt: skip
    if not drawn.scene.flat:
        # of a hinge that came apart in space an angle is a convention: its rate is compared
        free = {name for event in drawn.scene.events for name in event.release}
        for sensor in drawn.scene.sensors:
            if sensor.joint in free:
                t.channels.pop(sensor.name, None)
    return t


def verdict(family: str, seed: int) -> Verdict:
    """Of one scene."""
    drawn = made(family, seed)
    s = drawn.scene
    v = Verdict(family, seed, RIGHT, s.method, s.tolerance, by=drawn.by)
    begun = time.process_time()
    r = ran(s.text())
    middle = time.process_time()
    t = None
    if drawn.by in (ENGINE, ONE):
        try:
            t = true(drawn, max(TIMES * v.tolerance, STATED * stated(r), LEAST))
        except Unfit as error:
            v.verdict, v.why = UNJUDGED, str(error)
    v.cpu = (time.process_time() - middle, middle - begun)
    if drawn.by == INVALID:
        v.exit, v.why = r.exit, r.reason
        v.verdict = TOLD if r.exit in (3, 4, 5) else WRONG if r.exit == 0 else CRASH
        v.what = "ended well, where no motion is true" if r.exit == 0 else ""
        v.ratio = 1e3 if r.exit == 0 else 0.0
        return v
    if drawn.by == TIGHT_RUN:
        tight = ran(tighter(s).text()) if r.exit == 0 else r
        v.cpu = (time.process_time() - middle, middle - begun)
        return against(s, r, tight, v)
    if drawn.by == PHASED:
        v = judged_in_parts(drawn, r, v)
        v.cpu = (time.process_time() - middle, middle - begun)
        return v
    if drawn.by == STATIC:
        v = statics.judged(s, r, v)
        v.cpu = (time.process_time() - middle, middle - begun)
        return v
    if drawn.by == RIGID:
        return rigid(s, r, v)
    if t is None:
        if r.exit not in (0, 3, 4, 5):
            v.verdict, v.why = CRASH, r.reason
        return v
    v = judged(s, t, r, v)
    if v.verdict == WRONG and drawn.truth is None:
        # the bound knows what changes of the start grow by; errors are made later too
        t.until = parted(s, t, r, v.tolerance)
        t.growth, v.verdict = growth_of_later(s, t), RIGHT
        v = judged(s, t, r, v)
    return v


def tighter(s: Scene) -> Scene:
    """The same scene by another method, with steps far below the fastest waves of its bars."""
    explicit = s.method in ("radau", "generalized_alpha", "scipy:RK45")
    tolerance = max(1e-10, min(1e-6, 1e-3 * s.tolerance))
    return replace(s, method="dop853" if explicit else "radau", tolerance=tolerance, step=None)


def cautious(family: str, seed: int) -> Verdict:
    """The same; a generator that fails is a crash too, of its own."""
    try:
        return verdict(family, seed)
    except Exception as error:
        what = f"{type(error).__name__}: {error}"
        return Verdict(family, seed, BROKEN, "", 0.0, why=what)
