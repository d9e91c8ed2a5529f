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
    arm,
    centripetal,
    cross,
    dot,
    helper,
    separation,
    spin,
    velocity,
)
from trsim.fields import Spec, Unit

CONSTANT, FIRST = 6, 7  # par: in front the point of a joint, which these do not have
TERM = 10  # numbers of a term: coefficient, points on i and j, axis
NUMBER = 4  # con: how many terms, then of each frames i and j, coordinate, whether it turns


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
    head = (terms[0].i, terms[0].j, -1, len(terms))
    return Row((*head, *con), (*[0.0] * CONSTANT, constant, *par), named=(named,))


def pack_coupler(name, spec, at):
    return relation(spec.joints, spec.coefficients, at)


def pack_gear(name, spec, at):
    row = relation(spec.joints, spec.radii, at)
    assert len(row.named[0]) == 3, "two wheels on one carrier"
    return row


@helper
def line_of(scene, k, f):
    """The line of J in which row k has the frame f."""
    line = scene.row_start[k]
    while scene.line_frame[line] != f:
        line += 1
    return line


@helper
def add(J, line, c, f, m):
    """A line of J += the force c f and the moment c m."""
    for a in range(3):
        J[line, a] += c * f[a]
        J[line, 3 + a] += c * m[a]


@helper
def term(scene, e, k, q):
    """What the q-th coordinate of instance e adds to row k."""
    X, V, con, par, J, gamma = scene.X, scene.V, scene.con, scene.par, scene.J, scene.gamma
    n, o = NUMBER + 1 + 4 * q, FIRST + TERM * q
    i, j, c = con[e, n], con[e, n + 1], par[e, o]
    l_i, l_j = line_of(scene, k, i), line_of(scene, k, j)
    axis = arm(X, i, par[e, o + 7], par[e, o + 8], par[e, o + 9])
    turning, none = cross(spin(V, i), axis), (0.0, 0.0, 0.0)
    scene.phi[k] += c * scene.S[con[e, n + 2], 0]
    if con[e, n + 3] == 1:
        add(J, l_i, -c, none, axis)
        add(J, l_j, c, none, axis)
        o_i, o_j = spin(V, i), spin(V, j)
        gamma[k] -= c * dot(turning, (o_j[0] - o_i[0], o_j[1] - o_i[1], o_j[2] - o_i[2]))
        return
    p_i = arm(X, i, par[e, o + 1], par[e, o + 2], par[e, o + 3])
    p_j = arm(X, j, par[e, o + 4], par[e, o + 5], par[e, o + 6])
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
def constraint(t, scene, a, b):
    con, par, J = scene.con, scene.par, scene.J
    for e in range(a, b):
        k = con[e, 3]
        if k < 0:
            continue
        scene.phi[k], scene.phi_t[k], scene.gamma[k] = -par[e, CONSTANT], 0.0, 0.0
        for line in range(scene.row_start[k], scene.row_start[k + 1]):
            for c in range(6):
                J[line, c] = 0.0
        for q in range(con[e, NUMBER]):
            term(scene, e, k, q)


def reach(row):
    """Its torques are about the axes of hinges, its forces along those of slides."""
    hinges, slides = [], []
    for q in range(row.con[NUMBER - 1]):
        i, _, _, turns = row.con[NUMBER + 4 * q : NUMBER + 4 * q + 4]
        axis = row.par[FIRST + TERM * q + 7 : FIRST + TERM * (q + 1)]
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
