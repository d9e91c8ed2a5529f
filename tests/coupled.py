"""Two elements of the tests whose rows name more than two frames.

    gear      r_1 (phi_1 - phi_1,0) + r_2 (phi_2 - phi_2,0) = 0     angles against one carrier
    coupler   sum_k c_k (x_k - x_k,0) = 0                           angles or strokes of any joints

Both are one linear relation of joint coordinates, so a gear between a carrier and two wheels names
three frames, a coupler of four joints up to eight.
"""

import sys
from types import SimpleNamespace
from typing import Annotated, ClassVar

import pytest

from trsim import elements
from trsim.elements.contract import Element, Reach, Row, kernel
from trsim.elements.frames import (
    TwoPoints,
    arm,
    centripetal,
    cross,
    dot,
    separation,
    spin,
    velocity,
)
from trsim.fields import Spec, Unit
from trsim.kernels.columns import constraint_row, f8, i8, run
from trsim.kernels.lazy import internal

TERM = 10  # numbers of a term: coefficient, points on i and j, axis


class Own(TwoPoints):
    """Of one instance; the points of a joint it does not have."""

    turn: constraint_row
    number: i8  # of terms
    where: run(i8)  # of each frames i and j, coordinate, whether it turns
    constant: f8
    terms: run(f8)


class Coupler(Spec):
    """A linear relation of joint coordinates."""

    type: ClassVar[str] = "coupler"
    bodies: ClassVar[tuple] = ()
    at: ClassVar[None] = None
    joints: tuple[str, ...]
    coefficients: Annotated[tuple[float, ...], Unit("-")]


class Gear(Spec):
    """Two wheels on one carrier, against each other; radii of unlike sign: one inside the other."""

    type: ClassVar[str] = "gear"
    bodies: ClassVar[tuple] = ()
    at: ClassVar[None] = None
    joints: tuple[str, str]
    radii: Annotated[tuple[float, float], Unit("m")]


def relation(joints, coefficients, at):
    """The row sum_k c_k (x_k - x_k,0) = 0."""
    terms = [at.coordinate(joint) for joint in joints]
    con, par, constant = [], [], 0.0
    for x, c in zip(terms, coefficients, strict=True):
        con += [x.i, x.j, x.entry, int(x.kind == "angle")]
        par += [c, *x.s_i, *x.s_j, *x.axis_i]
        constant += c * x.drawn
    named = tuple(dict.fromkeys(f for x in terms for f in (x.i, x.j)))
    nowhere = (0.0, 0.0, 0.0)
    own = Own.packed(
        i=terms[0].i, j=terms[0].j, coordinate=-1, p_i=nowhere, p_j=nowhere, number=len(terms),
        where=con, constant=constant, terms=par,
    )  # fmt: skip
    return Row(*own, named=(named,))


def pack_coupler(name, spec, at):
    return relation(spec.joints, spec.coefficients, at)


def pack_gear(name, spec, at):
    row = relation(spec.joints, spec.radii, at)
    assert len(row.named[0]) == 3, "two wheels on one carrier"
    return row


@internal
def line_of(scene, k, f):
    """The line of J in which row k has the frame f."""
    line = scene.row_start[k]
    while scene.line_frame[line] != f:
        line += 1
    return line


@internal
def add(J, line, c, f, m):
    """A line of J += the force c f and the moment c m."""
    for a in range(3):
        J[line, a] += c * f[a]
        J[line, 3 + a] += c * m[a]


@internal
def term(scene, e, k, q):
    """What the q-th coordinate of instance e adds to row k."""
    X, V, J, gamma = scene.X, scene.V, scene.J, scene.gamma
    own, n, o = Own(scene, e), 4 * q, TERM * q
    where, p = own.where, own.terms
    i, j, c = where[n], where[n + 1], p[o]
    l_i, l_j = line_of(scene, k, i), line_of(scene, k, j)
    axis = arm(X, i, (p[o + 7], p[o + 8], p[o + 9]))
    turning, none = cross(spin(V, i), axis), (0.0, 0.0, 0.0)
    scene.phi[k] += c * scene.S[where[n + 2], 0]
    if where[n + 3] == 1:
        add(J, l_i, -c, none, axis)
        add(J, l_j, c, none, axis)
        o_i, o_j = spin(V, i), spin(V, j)
        gamma[k] -= c * dot(turning, (o_j[0] - o_i[0], o_j[1] - o_i[1], o_j[2] - o_i[2]))
        return
    p_i = arm(X, i, (p[o + 1], p[o + 2], p[o + 3]))
    p_j = arm(X, j, (p[o + 4], p[o + 5], p[o + 6]))
    d = separation(X, i, p_i, j, p_j)
    add(J, l_i, -c, axis, cross((p_i[0] + d[0], p_i[1] + d[1], p_i[2] + d[2]), axis))
    add(J, l_j, c, axis, cross(p_j, axis))
    v_i, v_j = velocity(V, i, p_i), velocity(V, j, p_j)
    c_i, c_j = centripetal(V, i, p_i), centripetal(V, j, p_j)
    gamma[k] -= c * (
        dot(axis, c_j) - dot(axis, c_i) + dot(centripetal(V, i, axis), d)
        + 2.0 * dot(turning, (v_j[0] - v_i[0], v_j[1] - v_i[1], v_j[2] - v_i[2]))
    )  # fmt: skip


@kernel
def constraint(t, scene, e):
    J = scene.J
    own = Own(scene, e)
    k = own.turn
    if k < 0:
        return
    scene.phi[k], scene.phi_t[k], scene.gamma[k] = -own.constant, 0.0, 0.0
    for line in range(scene.row_start[k], scene.row_start[k + 1]):
        for c in range(6):
            J[line, c] = 0.0
    for q in range(own.number):
        term(scene, e, k, q)


def reach(row):
    """Its torques are about the axes of hinges, its forces along those of slides."""
    own, hinges, slides = Own.of(row), [], []
    for q in range(own.number):
        i, _, _, turns = own.where[4 * q : 4 * q + 4]
        axis = own.terms[TERM * q + 7 : TERM * (q + 1)]
        (hinges if turns else slides).append((i, axis))
    return Reach(hinges=tuple(hinges), slides=tuple(slides))


def element(key, spec, pack):
    return Element(
        key=key, section="joints", spec=spec, pack=pack, reach=reach, rows=("turn",),
        kernels={"constraint": constraint},
    )  # fmt: skip


@pytest.fixture
def coupled(monkeypatch):
    """Lets scenarios have gears and couplers among their joints."""
    for made in (element("gear", Gear, pack_gear), element("coupler", Coupler, pack_coupler)):
        monkeypatch.setitem(elements.ELEMENTS, made.key, made.section)
        module = SimpleNamespace(ELEMENT=made)
        monkeypatch.setitem(sys.modules, f"trsim.elements.{made.key}", module)
