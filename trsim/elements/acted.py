"""What single joints, drives and forces put on a body, once the motion is known.

Of constraint rows it is -J^T lambda of the rows alone; of what else pushes, its kernel is called
alone.
"""

from typing import NamedTuple

from trsim.elements.contract import FIRST_ROW, Pair, call_kernel
from trsim.elements.frames import arm, cross, minus, plus, scaled
from trsim.elements.rows import Axes
from trsim.kernels.columns import f8, i8, run
from trsim.kernels.lazy import internal

PUSHES = {"force", "rub"}  # kernels that push; what rubs does so by forces found before


WHOLE, LOCATING, FLOATING = range(3)  # of what constraint rows do, on a shaft by its bearings


class Part(NamedTuple):
    """What the constraint rows of an instance do at a place."""

    share: int
    places: tuple  # (frame, point in its axes from its centre) on either body


class TwoBearings(Axes):
    """Of a joint on two bearings: the locating one at its place, the other one along its axis."""

    span: f8  # m, between them


def parts_of(instance):
    """What its rows do, by the places; of most elements all of it at once."""
    element, row = instance.element, instance.row
    if element.bearings:
        return element.bearings(row)
    return (Part(WHOLE, element.acts_at(row) if element.acts_at else ()),)


class Acted(Pair):
    """Of what tells a wrench on body i."""

    number: i8  # of what acts
    pushes: i8  # 1: some of that are no constraint rows
    members: run(i8)  # of each its instance, how many constraint rows it has, and which share


def acting(members):
    """These columns, of (number, instance, part of it)."""
    return {
        "number": len(members),
        "pushes": any(PUSHES & {*instance.element.kernels} for _, instance, _ in members),
        "members": [n for e, x, part in members for n in (e, len(x.element.rows), part.share)],
    }


def whole(e, instance):
    """All of an instance, part by part."""
    return [(e, instance, part) for part in parts_of(instance)]


@internal
def wrench(t, scene, e):
    """Force and moment about the centre of mass of body i, world axes."""
    own = Acted(scene, e)
    f, m = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for k in range(own.number):
        e_k, rows, share = own.members[3 * k], own.members[3 * k + 1], own.members[3 * k + 2]
        f_k, m_k = share_of(scene, own.i, e_k, rows, share)
        f, m = plus(f, f_k), plus(m, m_k)
    if own.pushes == 1:
        f_k, m_k = pushed(t, scene, e)
        f, m = plus(f, f_k), plus(m, m_k)
    return f, m


@internal
def share_of(scene, i, e, rows, share):
    """What the constraint rows of instance e put on a body; of two bearings what one of them does:
    neither carries a moment, so that of all rows at the locating one is l a x F of the other."""
    f, m = of_rows(scene, i, e, rows)
    if share == WHOLE:
        return f, m
    X, own = scene.X, TwoBearings(scene, e)
    p = arm(X, i, own.p_i) if i == own.i else arm(X, i, own.p_j)
    a = arm(X, own.i, own.a_i)
    floating = scaled(1.0 / own.span, cross(minus(m, cross(p, f)), a))
    if share == FLOATING:
        return floating, cross(plus(p, scaled(own.span, a)), floating)
    locating = minus(f, floating)
    return locating, cross(p, locating)


@internal
def of_rows(scene, i, e, rows):
    """What the constraint rows of instance e put on a body."""
    J, f, m = scene.J, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for r in range(FIRST_ROW, FIRST_ROW + rows):
        row = scene.con[e, r]
        if row >= 0:
            pull = -scene.lam[row]
            for l in range(scene.row_start[row], scene.row_start[row + 1]):
                if scene.line_frame[l] == i:
                    f = plus(f, (pull * J[l, 0], pull * J[l, 1], pull * J[l, 2]))
                    m = plus(m, (pull * J[l, 3], pull * J[l, 4], pull * J[l, 5]))
    return f, m


@internal
def call_one(t, scene, kernels, e):
    """Call the kernel of a table that instance e has, for e alone."""
    for n in range(kernels.shape[0]):
        if kernels[n, 1] <= e < kernels[n, 2]:
            call_kernel(kernels[n, 0], t, scene, e, e + 1)


@internal
def pushed(t, scene, e):
    """What the forces among the members put on the body.

    Forces and rates of the last evaluation are put back: other numbers of a row need them.
    """
    own = Acted(scene, e)
    i, F, kept, zd, rates = own.i, scene.F, scene.moved, scene.zd, scene.aside[1]
    for f in range(scene.n):
        for c in range(6):
            kept[f, c], F[f, c] = F[f, c], 0.0
    for k in range(scene.n_z):
        rates[k] = zd[k]
    for k in range(own.number):
        one = own.members[3 * k]
        call_one(t, scene, scene.force, one)
        call_one(t, scene, scene.rub, one)
    found = (F[i, 0], F[i, 1], F[i, 2]), (F[i, 3], F[i, 4], F[i, 5])
    for f in range(scene.n):
        for c in range(6):
            F[f, c] = kept[f, c]
    for k in range(scene.n_z):
        zd[k] = rates[k]
    return found
