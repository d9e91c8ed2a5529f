"""Whether a scene stays in the x-y plane, and if not, what reaches out of it.

In the plane three unknowns of a body are solved instead of six.  That is right where, from a state
in the plane, no acceleration, no reaction and no number that is read points out of it, whatever the
time and whatever events do.  Elements say what could (`Element.reach`), so a load that begins late
or a contact that is open is seen as well; the rows of joints are judged by their derivatives at
positions moved in the plane: each must be either in the plane or across it.  What reaches out

    moves      the bodies: the scene is spatial, and `planar: true` is refused
    turns      bodies, which move by it unless joints hold them; held, the motion is right, but the
               moments in the joints across the plane would be missing
    tells      of what may happen out of the plane, where nothing else reaches out of it

The last two make a scene spatial where it can be: where all inertias are known.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.addresses import Addresses
from trsim.assemble.equations import forces, poses
from trsim.assemble.instances import Instance, RowName
from trsim.assemble.reduce import Drawn, displaced, jacobian, moves
from trsim.elements.scene import Scene
from trsim.errors import ModelError, some

Array = NDArray[np.float64]

NOTHING = 1e-9  # of a direction, of the mechanism's size, of the largest force
HELD = 1e-8  # a singular value of rows that hold
NEARBY = 2  # states that are looked at
SHOWN = 3  # reasons in a message
MOVES, TURNS, TELLS = "moves", "turns", "tells"


class Out(NamedTuple):
    """Something that reaches out of the x-y plane."""

    whose: str  # joints.shoulder
    what: str  # turns about another axis than z
    kind: str  # what it does: MOVES, TURNS, TELLS

    def __str__(self) -> str:
        return f"{self.whose} {self.what}"


class Planarity(NamedTuple):
    """The verdict, and what speaks against it."""

    planar: bool
    assumed: bool = False  # nothing holds the bodies in their plane
    reasons: tuple[Out, ...] = ()  # of a spatial scene; of a planar one what is not told

    def because(self) -> tuple[str, ...]:
        """Why the scene is spatial; nothing where the scenario says so."""
        return () if self.planar else tuple(dict.fromkeys(map(str, self.reasons)))

    def notes(self) -> tuple[str, ...]:
        """What the user of a planar scene should know before the run."""
        said = []
        if self.assumed:
            said.append(
                "planar motion assumed: nothing holds the bodies in their plane; "
                "set `planar: false` for a spatial run"
            )
        if self.planar and self.reasons:
            said.append(
                f"{listed(self.reasons)}: the motion stays in the plane, but moments and numbers "
                "out of it are told as zero; `planar: false` with all moments of inertia has them"
            )
        return tuple(said)


def listed(reasons: Iterable[Out]) -> str:
    """A few reasons, and how many more."""
    return some(reasons, SHOWN, ", and {} more", "; ")


def planarity(scenario: Any, drawn: Drawn, at: Addresses, instances: list[Instance]) -> Planarity:
    """drawn: with the rows of the joints and drives.

    Raises ModelError for `planar: true` of a scene whose bodies leave the plane.
    """
    if scenario.planar is False or drawn.scene.n == 1:
        return Planarity(False)
    near = in_plane_states(drawn)
    reasons = reaching_out(drawn, near, at, instances)
    # what must hold is looked at around the drawing as well
    held = is_held(drawn, near if reasons else (), lasting(instances, at, drawn.rows))
    kinds = {out.kind for out in reasons}
    if MOVES in kinds or (TURNS in kinds and not held):
        if scenario.planar:
            raise ModelError(
                "`planar: true`, but joints, loads or velocities leave the x-y plane: "
                + listed(reasons),
                "draw the mechanism in the x-y plane or set `planar: false`",
                ("planar",),
            )
        return Planarity(False, reasons=tuple(reasons))
    if reasons and scenario.planar is None and all_known(at):
        return Planarity(False, reasons=tuple(reasons))
    return Planarity(True, not held and scenario.planar is None, tuple(reasons))


def reaching_out(
    drawn: Drawn, near: Sequence[Array], at: Addresses, instances: list[Instance]
) -> list[Out]:
    """All that reaches out of the x-y plane.  near: `in_plane_states`."""
    pushed = list(of_loads(drawn.scene, near))
    reasons = [*of_bodies(at), *of_beams(at)]
    reasons += of_elements(at, instances, drawn.scene.size, bool(pushed))
    reasons += of_rows(drawn, near)
    return reasons or pushed  # of what no element has told


def all_known(at: Addresses) -> bool:
    """Whether the scene could be solved in space: the inertias of its bodies are known."""
    return all(spec.tensor[1] for spec in at.members.values() if spec.flexible is None)


def level(v: Any) -> bool:
    """Whether a direction lies in the plane."""
    return abs(v[2]) <= NOTHING * float(np.linalg.norm(v))


def upright(v: Any) -> bool:
    """Whether a direction is that of z, either way."""
    return float(np.hypot(v[0], v[1])) <= NOTHING * float(np.linalg.norm(v))


# --- what is drawn -----------------------------------------------------------------------------


def of_bodies(at: Addresses) -> Iterator[Out]:
    """Velocities out of the plane, axes turned out of it, products of inertia across it."""
    for name, spec in at.members.items():
        if spec.velocity[2] != 0.0:
            yield Out(f"bodies.{name}", "starts with a velocity along z", MOVES)
        if any(spec.angular_velocity[:2]):
            yield Out(f"bodies.{name}", "starts turning about another axis than z", MOVES)
        if spec.flexible is not None:
            continue
        if spec.drawn_in is not None and not spec.drawn_in.flat:
            yield Out(f"bodies.{name}", "is turned out of the x-y plane by its frame", MOVES)
        I, known = spec.tensor
        if known and max(abs(I[2]), abs(I[5])) > NOTHING * I[8]:
            yield Out(f"bodies.{name}", "has products of inertia Ixz or Iyz", TURNS)


def of_beams(at: Addresses) -> Iterator[Out]:
    """Bars that do not lie in the plane."""
    for name, beam in at.beams.items():
        if not level(beam.tangent):
            yield Out(f"bodies.{name}", "is a bar that rises out of the plane", MOVES)


def of_elements(
    at: Addresses, instances: list[Instance], size: float, pushed: bool
) -> Iterator[Out]:
    """What the elements say they could do.

    pushed: whether their forces together leave the plane; springs above and below may balance.
    """
    for instance in instances:
        if instance.element.reach is None:
            continue
        reach = instance.element.reach(instance.row)
        if reach.always and not pushed:
            continue
        whose = f"{instance.section}.{instance.name}" if instance.section else instance.element.key
        yield from dict.fromkeys(Out(whose, *found) for found in reaching(at, reach, size))


def reaching(at: Addresses, reach: Any, size: float) -> Iterator[tuple[str, str]]:
    """What of a `Reach` leaves the plane as drawn, and what it does."""

    def world(frame: int, v: Any) -> Array:
        return np.asarray(at.rotation[frame] @ np.array(v))

    def height(frame: int, s: Any) -> float:
        return float(at.at_start[frame][2] + world(frame, s)[2])

    if any(not upright(world(*axis)) for axis in reach.hinges):
        yield "turns about another axis than z", MOVES
    if any(not level(world(*axis)) for axis in reach.slides):
        yield "slides out of the x-y plane", MOVES
    if any(not level(world(*way)) for way in reach.forces):
        yield "pushes out of the x-y plane", MOVES
    for i, s_i, j, s_j in reach.lines:
        if abs(height(i, s_i) - height(j, s_j)) > NOTHING * size:
            yield "acts along a line out of the x-y plane", MOVES
    if any(not upright(world(*way)) for way in reach.torques):
        yield "turns bodies about another axis than z", TURNS
    for frame, s, bodies in reach.places:
        heights = [at.at_start[body][2] for body in bodies if body]
        if any(abs(height(frame, s) - z) > NOTHING * size for z in heights):
            yield "acts beside the plane of a centre of mass", TURNS
    for frame, axes, diagonal, turning in reach.tensors:
        A = at.rotation[frame] @ np.array(axes).reshape(3, 3).T
        K = A @ np.diag(diagonal) @ A.T
        if np.abs(K[2, :2]).max() > NOTHING * np.abs(K).max():
            kind = TURNS if turning else MOVES
            yield "has an axis of stiffness or damping at an angle to the plane", kind
    if any(not level(world(*way)) for way in reach.shown):
        yield "tells what happens out of the x-y plane", TELLS
    if any(not upright(world(*axis)) for axis in reach.about):
        yield "tells of turns about another axis than z", TELLS
    if reach.tilts:
        yield "lets bodies turn out of the x-y plane", TELLS


# --- what the numbers say ----------------------------------------------------------------------


def in_plane_states(drawn: Drawn) -> list[Array]:
    """States nearby, moved and moving in the plane only; always the same ones."""
    full, found = drawn.scene, list[Array]()
    inside, n_v = moves(full, True), slice(full.n_q, full.n_q + full.n_v)
    rigid = np.arange(6 * (full.n - 1)) < 6 * (full.n_r - 1)
    for k in range(NEARBY):
        dx, rates = scattered(k, inside.size)
        # beams stay straight: their elastic forces would hide all others
        near = displaced(full, drawn.y, np.where(inside & rigid, 0.05 * dx, 0.0))
        # in the plane the axes of the solve are the world's
        near[n_v][inside] = rates[inside]
        found.append(near)
    return found


def scattered(k: int, n: int) -> Array:
    """The k-th two times n numbers of mean 0 and variance 1 that have to do with nothing (2, n).

    The fractions of i^2 sqrt(2) are spread evenly and follow no line, as those of i sqrt(2) would
    (H. Weyl 1916); numpy's random numbers take longer to import than all that is done with these.
    """
    i = np.arange(2 * n * k, 2 * n * (k + 1)) + 1.0
    return math.sqrt(12.0) * (np.mod(i * i * math.sqrt(2.0), 1.0) - 0.5).reshape(2, n)


def of_rows(drawn: Drawn, near: Sequence[Array]) -> list[Out]:
    """Rows that are neither in the plane nor across it, and those that drive across it."""
    full, rows = drawn.scene, drawn.rows
    inside = moves(full, True)
    found: dict[Out, None] = {}
    for y in near:
        _, phi_t, J = jacobian(full, 0.0, y)
        within = np.abs(J[:, inside]).max(axis=1, initial=0.0) > NOTHING
        outside = np.abs(J[:, ~inside]).max(axis=1, initial=0.0) > NOTHING * max(1.0, full.size)
        for k in np.flatnonzero(within & outside).tolist():
            whose = f"joints.{rows[k].element}"
            found[Out(whose, "holds bodies at an angle to the plane", MOVES)] = None
        for k in np.flatnonzero(outside & ~within & (phi_t != 0.0)).tolist():
            found[Out(f"drives.{rows[k].element}", "moves out of the x-y plane", MOVES)] = None
    return list(found)


def of_loads(w: Scene, near: Sequence[Array]) -> Iterator[Out]:
    """Forces and moments out of the plane, of all elements together."""
    rigid = slice(1, w.n_r)
    for y in near:
        poses(w, y)
        forces(w, 0.0)
        least = NOTHING * max(1.0, float(np.abs(w.F).max(initial=0.0)))
        if np.abs(w.F[1:, 2]).max(initial=0.0) > least:
            yield Out("forces", "push out of the x-y plane", MOVES)
            return
        if np.abs(w.F[rigid, 3:5]).max(initial=0.0) > least:
            yield Out("forces", "turn bodies about another axis than z", TURNS)
            return


def lasting(instances: list[Instance], at: Addresses, rows: list[RowName]) -> list[int]:
    """Rows of joints and drives that hold from beginning to end, whatever events do."""
    switched = set(at.switches.names)
    keys = [(instances[r.instance].section, instances[r.instance].name) for r in rows]
    return [k for k, key in enumerate(keys) if key not in switched]


def is_held(drawn: Drawn, near: Sequence[Array], rows: list[int]) -> bool:
    """Whether the given rows keep every rigid body in its plane as drawn and at all of the states
    near it."""
    full = drawn.scene
    rigid = np.arange(6 * (full.n - 1)) < 6 * (full.n_r - 1)
    across = ~moves(full, True) & rigid
    number = int(across.sum())
    if not rows:
        return number == 0
    places = (drawn.J, *(jacobian(full, 0.0, y)[2] for y in near))
    return all(
        np.sum(np.linalg.svd(J[rows][:, across], compute_uv=False) > HELD) == number for J in places
    )
