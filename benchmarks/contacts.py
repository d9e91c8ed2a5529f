"""Contacts: what one costs an evaluation, in touch and far, beside a clearance joint.

PAIRS bodies in the plane, each with a contact on the ground and without; the difference of the
equations of motion by themselves, divided by PAIRS.  Every body goes round what it touches, in
PLACES places with HELD evaluations at each.  In touch all contacts are shut, far all are open: then
an evaluation does not ask for forces, and gaps are what a step asks for at its end.
"""

import time
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from trsim.assemble.equations import evaluate, gaps, poses
from trsim.elements.contract import SCENE, compiled
from trsim.kernels.signatures import A2, i8, void

PAIRS, PLACES, ROUNDS, TIMES = 18, 360, 21, 8_000
HELD = 12  # evaluations at a place: those of a step
SPLINES = (10, 50, 200)  # points
BALL, PLAY, DEEP, OFF = 10e-3, 0.2e-3, 1e-6, 20e-3  # m
REPEATED = void(SCENE, A2, A2, i8)
LAW = """
contact_laws:
  steel: {normal: lankarani_nikravesh, stiffness: 1e9, exponent: 1.5, restitution: 0.9,
          friction: {law: modified_coulomb, coefficient: 0.1, v0: 1e-4 m/s, v1: 1e-3 m/s}BEARING}
solver: {end: 1 s}
"""


@compiled(REPEATED)
def whole(s, y, yd, times):
    """The equations of motion, again and again."""
    for k in range(times):
        evaluate(s, 0.0, y[k // HELD % y.shape[0]], yd[0])


@compiled(REPEATED)
def distances(s, y, yd, times):
    """Poses of the bodies and gaps of the contacts."""
    for k in range(times):
        poses(s, y[k // HELD % y.shape[0]])
        gaps(s, 0.0)


class Met(NamedTuple):
    """A kind of contact: its text without body and place, and where a body touches."""

    name: str
    text: str
    at: Any  # (PLACES, 2) m, of a body that is in touch
    far: Any  # and of one that is far


class Costs(NamedTuple):
    """CPU times of a contact, us: of an evaluation in touch and far, and of its gap."""

    touch: float
    far: float
    gap: float


def cam(u: Any) -> Any:
    """A closed line around the origin with hollow flanks, m."""
    R = 30e-3 + 4e-3 * np.cos(3 * u)
    return np.column_stack([R * np.cos(u), R * np.sin(u)])


def spline(points: int) -> Any:
    """The cubic spline through points of it, as the profile of a surface takes it."""
    from scipy.interpolate import CubicSpline

    line = cam(-2 * np.pi * np.arange(points + 1) / points)
    line[-1] = line[0]
    chords = np.linalg.norm(np.diff(line, axis=0), axis=1)
    return CubicSpline(np.append(0.0, np.cumsum(chords)), line, bc_type="periodic")


def beside(line: Any, off: float) -> Any:
    """Places at that distance from a spline."""
    u = line.x[-1] * (np.arange(PLACES) + 0.37) / PLACES
    along = line(u, 1) / np.linalg.norm(line(u, 1), axis=1)[:, None]
    return line(u) + off * np.column_stack([-along[:, 1], along[:, 0]])


def kinds() -> list[Met]:
    """The contacts that are compared; the first is the measure of the others."""
    u = 2 * np.pi * np.arange(PLACES) / PLACES
    ray = np.column_stack([np.cos(u), np.sin(u)])
    ball = f"ball: {{body: BODY, radius: {BALL}, at: AT}}, contact: steel"
    level, up = np.column_stack([u, np.zeros(PLACES)]), np.array([0.0, 1.0])

    def touching(shape: str) -> str:
        return f"{{type: surface_contact, surface: {{body: ground, {shape}}}, {ball}}}"

    found = [
        Met("clearance joint", f"{{type: revolute, bodies: [ground, BODY], at: [0, 0], "
            f"clearance: {PLAY}, contact: steel}}", (PLAY + DEEP) * ray, 0.5 * PLAY * ray),
        Met("plane", touching("shape: plane"),
            level + up * (BALL - DEEP), level + up * (BALL + OFF)),
        Met("cylinder", touching("shape: cylinder, radius: 30 mm"),
            (30e-3 + BALL - DEEP) * ray, (30e-3 + BALL + OFF) * ray),
    ]  # fmt: skip
    for points in SPLINES:
        line, each = spline(points), cam(2 * np.pi * np.arange(points) / points).tolist()
        shape = f"shape: profile, closed: true, smooth: true, points: {each}"
        found.append(Met(f"spline of {points} points", touching(shape),
                         beside(line, BALL - DEEP), beside(line, BALL + OFF)))  # fmt: skip
    return found


def text(met: Met | None) -> str:
    """A scenario with PAIRS bodies, and as many contacts if any."""
    bodies, contacts = [], []
    for k in range(PAIRS):
        at = f"[0, {0.1 if met and met.name != 'clearance joint' else 0}]"
        bodies.append(f"  b{k}: {{mass: 1 kg, inertia: 1e-3 kg*m^2, at: {at}}}")
        if met:
            contacts.append(f"  c{k}: {met.text.replace('BODY', f'b{k}').replace('AT', at)}")
    section = "joints" if met and met.name == "clearance joint" else "forces"
    bearing = ", bearing_radius: 10 mm" if section == "joints" else ""
    return "\n".join(["title: contacts", "bodies:", *bodies,
                      *([f"{section}:", *contacts, LAW.replace("BEARING", bearing)] if met
                        else ["solver: {end: 1 s}"])])  # fmt: skip


def states(model: Any, at: Any) -> Any:
    """(PLACES, n) states with bodies at these places, each body at its own part of the way."""
    y = np.zeros((PLACES, model.n_q + model.n_v))
    for k in range(PAIRS):
        y[:, 3 * k : 3 * k + 2] = np.roll(at, -(k * PLACES) // PAIRS, axis=0)
        y[:, model.n_q + 3 * k] = 0.1  # m/s
    return y


def each(repeated: Any, work: Any, y: Any) -> float:
    """CPU time of one of the functions above, us a time."""
    yd = np.zeros_like(y)
    start = time.process_time()
    repeated(work, y, yd, TIMES)
    return 1e6 * (time.process_time() - start) / TIMES


def measured(met: Met | None) -> Any:
    """A scenario made ready; what it calls for takes one round of measurements, us."""
    from trsim.assemble.assemble import assemble
    from trsim.elements.scene import scene
    from trsim.scenario.load import loads
    from trsim.solve.start.consistent import phases

    mechanism = assemble(loads(text(met)))
    model = mechanism.model
    work = scene(model)

    def once() -> Costs:
        if met is None:
            y = states(model, np.zeros((PLACES, 2)))
            return Costs(*(each(f, work, y) for f in (whole, whole, distances)))
        found = []
        for at in (met.at, met.far):
            y = states(model, at)
            work.mem[:] = phases(model, y[0], True)
            found.append(each(whole, work, y))
        return Costs(*found, each(distances, work, states(model, met.at)))

    return once


def main() -> None:
    """Print the medians of ROUNDS rounds in which the kinds take turns."""
    several = kinds()
    ready = [measured(met) for met in (None, *several)]
    rounds = [[once() for once in ready] for _ in range(1 + ROUNDS)][1:]
    found = []
    for k in range(1, len(ready)):
        found.append(Costs(*(
            median((r[k][c] - r[0][c]) / PAIRS for r in rounds) for c in range(len(Costs._fields))
        )))  # fmt: skip
    print("| contact | in touch, us | clearance joints | far, us | clearance joints | gap, us |")
    print("|---|---|---|---|---|---|")
    for met, c in zip(several, found, strict=True):
        print(f"| {met.name} | {c.touch:.3f} | {c.touch / found[0].touch:.1f} "
              f"| {c.far:.4f} | {c.far / found[0].touch:.2f} | {c.gap:.3f} |")  # fmt: skip


if __name__ == "__main__":
    main()
