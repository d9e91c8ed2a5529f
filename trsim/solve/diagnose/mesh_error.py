"""How wrong the meshes of flexible bars make their shapes: an estimate from a state.

Every element is cut in two without a change of its shape.  The halves do not carry the loads of
the mesh with this shape: with f the forces of the elements on their nodes, and f', K' those of
the halves,

    K' d = P f - f'         P f: the loads of the mesh, at its nodes;  d: where the halves go

d is what the bar moves when its mesh is made twice as fine: 15/16 of its error, of order 4.  The
bar is held as its joints to the ground hold it, or its first joint; what is free then to move as
a rigid body keeps its mean place and direction (inertia relief).  Forces and inertia forces stay
as they are, moments turn with their node.  Nodes in between are eliminated.

Loads within elements are not seen, only what they do to nodes: errors below AIM may be several
times larger or smaller then.  It is an estimate of the shape at a time, not of what errors do to
a motion as they add up.
"""

from collections.abc import Iterator, Mapping
from math import ceil
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim import elements
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.members import Beam
from trsim.elements.joint import place_on
from trsim.laws.cable import CURVATURES
from trsim.laws.cable_matrices import slopes
from trsim.laws.cable_section import mass
from trsim.laws.cable_stretch import STRAINS
from trsim.solve.start.bars import places
from trsim.solve.start.cable_systems import Law, assumed, system

Array = NDArray[np.float64]
State = tuple[float, Array]  # time, y

ORDER = 4
OF_TWICE = 1.0 / (1.0 - 2.0**-ORDER)  # of a mesh twice as fine to an exact one
AIM = 1e-4  # of the length
TOLD = 3.0 * AIM  # more than the aim even where the estimate is 3 times too large
STRAIGHT = 1e-3  # rad, between the ends of an element: a bar that is bent less is not looked at
MOST = 100  # elements; more are not looked at
HALVES = [  # polynomials of n over an element as those over its halves
    [[1.0, 0.0, 0.0], [side * 0.25, 0.5, 0.0], [0.0625, side * 0.25, 0.25]] for side in (-1, 1)
]


class MeshError(NamedTuple):
    """What the mesh of a flexible bar makes wrong of its shape at the start: an estimate.

    name      of the body
    elements  how many
    error     of the node that is farthest off, m
    relative  of the length
    wanted    elements for a relative error of 1e-4
    """

    name: str
    elements: int
    error: float
    relative: float
    wanted: int


class Bends:
    """The state of a run in which each flexible bar is bent most, of those shown to it."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism = mechanism
        self.most = dict.fromkeys(mechanism.beams, STRAIGHT**5)
        self.states: dict[str, State] = {}

    def look(self, t: float, y: Array) -> None:
        """Keep the state for the bars that were never bent as much.

        Errors of elements go with the fifth power of the angle between their ends.
        """
        for name, beam in self.mechanism.beams.items():
            g = places(self.mechanism, beam, y)[1]
            along = g / np.linalg.norm(g, axis=1)[:, None]
            bend = float(np.sum(np.sum(np.square(np.diff(along, axis=0)), axis=1) ** 2.5))
            if bend > self.most[name]:
                self.most[name], self.states[name] = bend, (t, y.copy())


def of_meshes(scenario: Any, mechanism: Mechanism, states: Mapping[str, State]) -> Iterator[str]:
    """Bars whose mesh was too coarse for how they were bent."""
    for name, (t, y) in states.items():
        for found in mesh_errors(scenario, mechanism, y):
            if found.name == name and found.relative > TOLD:
                yield (
                    f"bodies.{name}: {found.elements} elements make its shape wrong by about "
                    f"{found.relative:.1e} of its length ({found.error:.1e} m) at t = {t:.4g} s, "
                    "where it is bent most of the states looked at (estimated there by halving "
                    "the elements, right to a factor of 3; what that does to the motion adds up): "
                    f"{found.wanted} elements would make it {AIM:g}"
                )


def mesh_errors(scenario: Any, mechanism: Mechanism, y: Array) -> Iterator[MeshError]:
    """An estimate for each flexible bar in a state.

    There is none for bars with very many elements, nor for those that lock (`stretching: full`).
    """
    for name, beam in mechanism.beams.items():
        n = beam.nodes - 1
        spec = scenario.bodies[name].flexible
        if n > MOST or spec.stretching == "full" or not np.all(np.isfinite(y)):
            continue
        strain, curvature = STRAINS[spec.strain], CURVATURES[spec.curvature]
        law = Law(beam.stiffness, beam.bending, strain, curvature)
        width = mechanism.model.d_node // 2
        r, g = (part[:, :width] for part in places(mechanism, beam, y))
        try:
            moved = refined(r, g, beam, law, supports(scenario, name, beam))
        except np.linalg.LinAlgError:  # where it buckles the halves have no one place to go to
            continue
        error = OF_TWICE * float(np.linalg.norm(moved[:, 0], axis=1).max())
        relative = error / beam.whole
        wanted = ceil(n * max(relative / AIM, 1e-12) ** (1.0 / ORDER))
        yield MeshError(name, n, error, relative, max(wanted, 1))


def supports(scenario: Any, name: str, beam: Beam) -> list[tuple[int, bool]]:
    """Nodes that joints hold, and whether their direction is held too."""
    there = (j for j in scenario.joints.values() if name in j.bodies)
    joints = [j for j in there if place_on(j, name) is not None]
    grounded = [j for j in joints if "ground" in j.bodies] or joints[:1]
    found: dict[int, bool] = {}
    for joint in grounded:
        node = int(np.argmin(np.linalg.norm(beam.places - np.array(place_on(joint, name)), axis=1)))
        found[node] = found.get(node, False) or elements.load(joint.type).welds
    return [*found.items()]


def refined(r: Array, g: Array, beam: Beam, law: Law, held: list[tuple[int, bool]]) -> Array:
    """How far place and slope of the nodes move with elements half as long, (nodes, 2, width)."""
    nodes, width = r.shape
    size, l = 2 * width, beam.length  # numbers of a node
    e = np.stack([r[:-1], g[:-1], r[1:], g[1:]], axis=1)
    strain = assumed(e, l, law)
    f, _ = system(e, l, law, strain)
    load, stiff = condensed(f, *halved(e, l, law, strain), size)
    whole, total = np.zeros((nodes * size, nodes * size)), np.zeros((nodes, 2, width))
    loads, flat = np.zeros((nodes, 2, width)), total.reshape(-1)
    for k in range(nodes - 1):
        at = slice(k * size, (k + 2) * size)
        whole[at, at] += stiff[k]
        flat[at] += load[k]
        loads[k : k + 2] += f[k].reshape(2, 2, width)
    for k in range(nodes):
        at = slice(k * size + width, (k + 1) * size)
        whole[at, at] -= turning(g[k], loads[k, 1])
    rows = holding(r, g, beam, held)
    bordered = np.block([[whole, rows.T], [rows, np.zeros((len(rows), len(rows)))]])
    moved = np.linalg.solve(bordered, np.append(flat, np.zeros(len(rows))))
    return moved[: flat.size].reshape(nodes, 2, width)


def halved(e: Array, l: float, law: Law, strain: Array) -> tuple[Array, Array]:
    """dU/de and stiffness of elements made of two halves, of their three nodes."""
    size = 2 * e.shape[2]
    middle = np.einsum("k,nkd->nd", (0.5, l / 8.0, 0.5, -l / 8.0), e)
    slope = np.einsum("k,nkd->nd", slopes.python(0.0, 1.0 / l), e)
    between = np.stack([middle, slope], axis=1)
    F, K = np.zeros((len(e), 3 * size)), np.zeros((len(e), 3 * size, 3 * size))
    halves = np.concatenate([e[:, :2], between], 1), np.concatenate([between, e[:, 2:]], 1)
    for side, half in enumerate(halves):
        at = slice(side * size, (side + 2) * size)
        force, stiff = system(half, 0.5 * l, law, strain @ np.array(HALVES[side]))
        F[:, at] += force
        K[:, at, at] += stiff
    return F, K


def condensed(f: Array, F: Array, K: Array, size: int) -> tuple[Array, Array]:
    """P f - f' and K' of the ends, where the node in between, which has no load, may move."""
    ends = np.r_[0:size, 2 * size : 3 * size]
    inside = np.arange(size, 2 * size)
    across = K[:, ends[:, None], inside]
    given = np.concatenate([K[:, inside[:, None], ends], -F[:, inside, None]], axis=2)
    back = across @ np.linalg.solve(K[:, inside[:, None], inside], given)
    return f - F[:, ends] - back[:, :, -1], K[:, ends[:, None], ends] - back[:, :, :-1]


def turning(g: Array, h: Array) -> Array:
    """dh/dg of a moment, h = m x g / |g|^2 on the slope g: it turns with g."""
    square = g @ g
    h = h - (h @ g) / square * g
    # m = g x h;  m x dg = (g . dg) h - (h . dg) g
    return (np.outer(h, g) - np.outer(g, h) - 2.0 * np.outer(h, g)) / square


def holding(r: Array, g: Array, beam: Beam, held: list[tuple[int, bool]]) -> Array:
    """Rows that hold a bar: those of its supports, and of the mean of what they leave free."""
    nodes, width = r.shape
    one = unit_rows(nodes, width)
    rows: list[Array] = []
    for node, clamped in held:
        rows.extend(one[node, 0])
        if clamped:
            across = np.linalg.svd(g[node][None])[2][1:]
            rows.extend(across @ one[node, 1])
    supported = np.reshape(rows, (len(rows), 2 * nodes * width))
    motions = rigid(r, g)
    left = motions
    if len(rows):
        _, s, vt = np.linalg.svd(supported @ motions)
        left = motions @ vt[int(np.sum(s > 1e-9 * s[0])) :].T
    M = np.zeros((nodes * 2, nodes * 2))
    element = np.array(mass.python(beam.length, 1.0))
    for k in range(nodes - 1):
        M[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += element
    return np.concatenate([supported, left.T @ np.kron(M, np.eye(width))])


def unit_rows(nodes: int, width: int) -> Array:
    """Of every number of a node the row that holds it alone, (nodes, 2, width, coordinates)."""
    return np.eye(2 * nodes * width).reshape(nodes, 2, width, -1)


def rigid(r: Array, g: Array) -> Array:
    """Orthonormal rigid motions of the nodes, (coordinates, 3 or up to 6)."""
    nodes, width = r.shape
    centred = r - r.mean(axis=0)
    motions = [*unit_rows(nodes, width)[:, 0].sum(axis=0)]
    for a in range(width):
        for b in range(a):
            motion = np.zeros((nodes, 2, width))
            for part, x in ((0, centred), (1, g)):
                motion[:, part, a], motion[:, part, b] = x[:, b], -x[:, a]
            motions.append(motion.ravel())
    u, s, _ = np.linalg.svd(np.array(motions).T, full_matrices=False)
    return u[:, s > 1e-6 * s[0]]  # a straight bar does not spin
