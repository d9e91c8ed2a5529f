"""One output row: every channel of the model at a state whose derivative was just evaluated.

    [ channels of the elements | reaction, reaction_moment of the joints | energy book ]

The reaction of a joint (reaction.py) is what its rows put on body j.
"""

from trsim.assemble.equations import call_all, call_derivative, kinetic, stored_energy
from trsim.assemble.least_norm import call_least_norm
from trsim.assemble.reaction import reaction_of
from trsim.elements.contract import BOOK, N_BOOK, SCENE, STORED, compiled
from trsim.elements.scene import N_STORED
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A1, f8, void

HEAR = void(SCENE, f8, A1)
call_hear = caller(HEAR)


def energy_columns(jumps):
    """Names of the energy book; where there are user events, with a line of their work."""
    return (
        "kinetic",
        *(f"stored.{name}" for name in STORED),
        *(f"work.{name}" for name in BOOK),
        *(["work.events"] if jumps >= 0 else []),
        "work.projection",
        "residual",
    )


#                     scene  t   y   work of projections  energy at the start
MEASURED = void(SCENE, f8, A1, f8, f8)
call_measured = caller(MEASURED)


@internal
def measure(s, t, y, work_projection, energy_0):
    """Fill s.out; uses the last evaluation, which was at (t, y).  Called by its address."""
    call_measured(s.measured, s, t, y, work_projection, energy_0)


@compiled(MEASURED)
def measured(s, t, y, work_projection, energy_0):
    """`measure`, compiled once."""
    if s.plain != 0:
        call_derivative(s.plain, s, t, y, s.aside[0])
    if s.shared_out != 0:
        call_least_norm(s.shared_out, s)
    call_all(s, s.measure, t)
    for k in range(s.silent.size):
        s.out[s.silent[k]] = 0.0
    for k in range(s.joint_out.shape[0]):
        reaction(s, k)
    out, o = s.out, s.column_energy
    T = kinetic(s, y)
    total = T + stored_energy(s, t) - energy_0 - work_projection
    out[o] = T
    for c in range(N_STORED):
        out[o + 1 + c] = s.E[c]
    o += 1 + N_STORED
    for c in range(N_BOOK):
        out[o + c] = s.z[c]
        total -= s.z[c]
    o += N_BOOK
    if s.jumps >= 0:
        out[o] = s.z[s.jumps]
        total -= s.z[s.jumps]
        o += 1
    out[o] = work_projection
    out[o + 1] = total


@compiled(HEAR)
def hear(s, t, y):
    """`measure` for events that watch channels; what is counted from the start is not theirs."""
    measure(s, t, y, 0.0, 0.0)


@internal
def reaction(s, k):
    """Force and moment of one joint on its body j, at the joint."""
    e, first, number, o = s.joint_out[k, 0], s.joint_out[k, 1], s.joint_out[k, 2], s.joint_out[k, 3]
    reaction_of(s, (e, first, number), s.lam, s.out, o)
