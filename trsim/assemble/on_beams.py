"""What the equations of motion ask of beams, called by address: a scene without any compiles none.

All have one signature, (scene, x, out, k); what each takes for them stands in its docstring.
"""

from trsim.assemble.beams import (
    ON_BEAMS,
    divide_by_mass,
    gathered,
    node_accelerations,
    node_kinetic,
    node_plain_rows,
    node_poses,
    node_products,
    node_rates,
    node_right_hand_side,
    node_rows,
    node_stress,
    pull_nodes,
    slope_force,
)
from trsim.elements.contract import compiled
from trsim.kernels.calls import caller

call_beams = caller(ON_BEAMS)


@compiled(ON_BEAMS)
def rows(s, x, out, pair):
    """B of their slots, and what these add to S from `pair` on."""
    node_rows(s)
    node_products(s, s.B, pair)


@compiled(ON_BEAMS)
def residual(s, x, r, k):
    """r -= J M^-1 J^T x."""
    u = s.moved
    gathered(s, u, x)
    divide_by_mass(s, u)
    for f in range(s.n_r, s.n):
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for a in range(s.d_node):
                r[s.slot_row[p]] -= s.B[p, a] * u[f, a]


@compiled(ON_BEAMS)
def work(s, before, after, k):
    """s.moved[0, 0] = the work of all forces on the way from one q to another, J."""
    width, total = s.d_node // 2, 0.0
    for q in range(s.q_node, s.n_q):
        f, c = s.n_r + (q - s.q_node) // s.d_node, (q - s.q_node) % s.d_node
        along = s.F[f, c] if c < width else slope_force(s, f, c - width)
        total += along * (after[q] - before[q])
    s.moved[0, 0] = total


ALL = (
    *(node_poses, node_accelerations, rows, node_plain_rows, node_right_hand_side, pull_nodes),
    *(node_rates, node_kinetic, residual, work, node_stress),
)
POSES, FREE, ROWS, PLAIN, RIGHT, PULL, RATES, KINETIC, RESIDUAL, WORK, STRESS = range(len(ALL))


def addresses(beams):
    """Addresses of all of them, zeros where there are no beams."""
    return [one.address() if beams else 0 for one in ALL]
