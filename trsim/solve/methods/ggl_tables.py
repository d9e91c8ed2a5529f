"""Tables of the sparse Newton systems of ggl_newton.py: their pattern, and room for their numbers.

The unknowns of such a system are those of w = (v, states of elements), then the multipliers of the
constraint rows.  Both records go where the march takes a Record and Buffers: their first fields are
the same.
"""

from typing import Any

import numpy as np

from trsim.assemble.coupling import Nodes, nodes
from trsim.assemble.elimination import Elimination, elimination
from trsim.assemble.mechanism import Mechanism
from trsim.elements.contract import N_BOOK
from trsim.elements.scene import Model
from trsim.kernels.packed import A1, A2, C1, F8, I1, I2, I8
from trsim.solve.march.record import Buffers, Record, of, zeros


class SparseRecord(Record):
    """What the Jacobian was when it was made; the dense tables of Record stay empty."""

    # derivatives of loads and rates, column by column: against displacements, and against w
    at_place: A1 = of("entries")
    at_rate: A1 = of("entries")
    at_rows: A2 = of("lines", 6)  # B
    at_push: A2 = of("lines", 6)  # minus the derivative of loads against lam: B, but for friction
    at_turn: A2 = of("lines", 6)  # derivative of B v + Phi_t against displacements
    at_state: A1 = of("instances")  # Phi against that state
    moved_off: A1 = of(1)  # error of the motion in the last step that kept to its bound


class SparseBuffers(Buffers):
    """The pattern, which stays as it is, and factors, made anew where they are not at hand."""

    # the Jacobian of loads and rates: n_w columns of w
    column_start: I1  # (n_w+1)
    row: I1  # (nnz)
    mass: A1  # (nnz) the mass matrix; 1 for the rate of a state
    group_start: I1  # (groups+1) columns whose rows have nothing in common
    group: I1  # (n_w)
    in_group: I1  # (n_w) the group of a column; -1: known without a difference
    entry_beam: I2  # (elements of beams, 144) entries of the Jacobian their tangents add to, or -1
    state_row: I2  # (rows with a state, 2) constraint row, its unknown of w
    # the constrained system: where its entries stand, row by row in the order of elimination
    entry_start: I1  # (N+1)
    entry_column: I1  # (entries)
    entry: I1  # (nnz) place of each entry of the Jacobian
    entry_row: I2  # (slots, 6) of B
    entry_across: I2  # (slots, 6) and of B^T
    entry_state: I1  # (rows with a state)
    rank: I1  # (N) assemble/elimination.py
    start: I1
    column: I1
    lower_start: I1
    lower: I1
    # numbers
    across: A2 = of("slot_row", 6)  # M^-1 B^T
    schur: A1 = of("row")  # factors of B M^-1 B^T
    value: C1 = of("entries")
    real_l: A1 = of("lower")
    real_u: A1 = of("lower")
    real_d: A1 = of("unknowns")
    complex_l: C1 = of("lower")
    complex_u: C1 = of("lower")
    complex_d: C1 = of("unknowns")
    # right-hand sides and solutions, in the order of elimination; `pair` as well
    side: A2 = of(2, "unknowns")
    pull: A1 = of("n_w")  # loads less B^T lambda, and rates of states
    pull0: A1 = of("n_w")
    rate0: A1 = of("m")  # Phi' at the place of the Jacobian
    slope: A2 = of(2, "n_v")
    move: A2 = of(2, "n_v")
    mu: A2 = of(2, "n_x")  # of rows, and of hubs
    made_for: F8  # s, the step size of the factors; 0: none
    made_of: I8  # number of the Jacobian they are made of
    resisted: I8  # 1: loads depend on rates
    turns: I8  # 1: rows of constraints depend on places


def record(dense: Record, mechanism: Mechanism, past_rows: int) -> SparseRecord:
    """A Record with room for a sparse Jacobian, for any stage of the mechanism."""
    starts, _ = columns(nodes(mechanism), mechanism.model)
    lines = sum(len(instance.row.frames(k)) for instance in mechanism.instances
                for k in range(len(instance.element.rows)))  # fmt: skip
    sizes = {"entries": int(starts[-1]), "lines": lines, "instances": len(mechanism.instances)}
    return SparseRecord(
        **{**dense.arrays(), "past": np.zeros((past_rows, dense.y.size))},
        **zeros(SparseRecord, mechanism.model, sizes),
    )


def buffers(dense: Buffers, mechanism: Mechanism, model: Model) -> SparseBuffers:
    """Buffers with the pattern of a stage of the mechanism, whose model is given."""
    own = {name: array for name, array in dense.arrays().items() if name not in dense.sizes}
    found = nodes(mechanism)
    return SparseBuffers(**{**own, **tables(found, mechanism, model)})


def sizes(found: Nodes, model: Model) -> list[int]:
    """Unknowns of every node: rigid bodies, nodes of beams, states."""
    bars = model.n - model.n_r
    return [model.d] * (found.bodies - bars) + [model.d_node] * bars + [1] * found.states


def columns(found: Nodes, model: Model) -> tuple[Any, Any]:
    """Column by column the rows of the Jacobian: blocks of coupled nodes."""
    size = sizes(found, model)
    first = np.concatenate([[0], np.cumsum(size)]).astype(np.int64)
    start, row = [0], []
    for node, others in enumerate(found.neighbours()):
        rows = [i for o in sorted(others | {node}) for i in range(first[o], first[o + 1])]
        for _ in range(size[node]):
            row += rows
            start.append(len(row))
    return np.array(start, np.int64), np.array(row, np.int64)


def colours(found: Nodes) -> list[list[int]]:
    """Sets of nodes no two of which act on the same node [CurtisPowellReid1974]."""
    near = found.neighbours()
    colour = [-1] * len(near)
    for node, others in enumerate(near):
        taken = {colour[c] for o in others | {node} for c in near[o] | {o}}
        colour[node] = next(c for c in range(len(near) + 1) if c not in taken)
    sets: list[list[int]] = [[] for _ in range(max(colour, default=-1) + 1)]
    for node, c in enumerate(colour):
        sets[c].append(node)
    return sets


def groups(found: Nodes, model: Model) -> tuple[Any, Any]:
    """Columns of w that one difference tells of: the a-th of every body of a colour; states."""
    size = sizes(found, model)
    first = np.concatenate([[0], np.cumsum(size)]).astype(np.int64)
    kinds = (range(model.n_r - 1), range(model.n_r - 1, found.bodies),
             range(found.bodies, found.bodies + found.states))  # fmt: skip
    taken: list[list[int]] = []
    for nodes_of in colours(found):
        for kind in kinds:
            own = [node for node in nodes_of if node in kind and node not in found.alone]
            taken += [[first[node] + a for node in own] for a in range(size[own[0]] if own else 0)]
    start = np.concatenate([[0], np.cumsum([len(g) for g in taken])]).astype(np.int64)
    return start, np.array([k for g in taken for k in g], np.int64)


def beam_entries(model: Model, start: Any, row: Any, in_group: Any) -> Any:
    """Where the tangent of every element of a beam stands in the Jacobian."""
    width = model.d_node // 2
    place = {(int(row[e]), k): e for k in range(model.v_node, model.n_v)
             for e in range(start[k], start[k + 1])}  # fmt: skip
    found = np.full((int(np.sum(model.beam[:, 1] - 1)), 12, 12), -1, np.int64)
    local = [(3 * part + c, width * part + c) for part in range(4) for c in range(width)]
    for first, count, _, element in model.beam.tolist():
        for n in range(count - 1):
            at = model.v_node + model.d_node * (first - model.n_r + n)
            for i, own_i in local:
                for j, own_j in local:
                    if in_group[at + own_j] < 0:
                        found[element + n, i, j] = place[at + own_i, at + own_j]
    return found.reshape(-1, 144)


def state_rows(mechanism: Mechanism, model: Model) -> list[tuple[int, int]]:
    """Constraint rows of drives by velocity: row, and the unknown of w that holds the place."""
    from trsim.elements.prescribed import AnyDrive

    found = []
    for e, instance in enumerate(mechanism.instances):
        if instance.section == "drives" or (instance.section == "events" and instance.row.states):
            own = AnyDrive(model, e)
            if 0 <= own.row < model.m and own.state >= 0:
                found.append((int(own.row), model.n_v + int(own.state) - N_BOOK))
    return found


def mass(model: Model, start: Any, row: Any) -> Any:
    """The entries of the mass matrix on the pattern of the Jacobian."""
    d, full = model.d, np.zeros((model.n, 6, 6))
    nodal = node_masses(model)
    for a in range(3):
        full[:, a, a] = model.mass
    full[:, 3:, 3:] = model.inertia.reshape(-1, 3, 3)
    kept = [0, 1, 5] if d == 3 else [0, 1, 2, 3, 4, 5]
    value = np.zeros(len(row))
    for column in range(len(start) - 1):
        for e in range(start[column], start[column + 1]):
            if column >= model.n_v:
                value[e] = float(row[e] == column)
            elif column >= model.v_node:
                value[e] = nodal.get((int(row[e]), column), 0.0)
            elif row[e] < model.v_node and row[e] // d == column // d:
                value[e] = full[1 + column // d, kept[row[e] % d], kept[column % d]]
    return value


def node_masses(model: Model) -> dict[tuple[int, int], float]:
    """The entries of the mass matrix between velocities of nodes."""
    width, found = model.d_node // 2, {}
    for first, count, at, _ in model.beam.tolist():
        o = model.v_node + model.d_node * (first - model.n_r)
        for k in range(2 * count):
            for p in range(min(model.consistent.shape[1], 2 * count - k)):
                for c in range(width):
                    i, j = o + width * k + c, o + width * (k + p) + c
                    found[i, j] = found[j, i] = float(model.consistent[at + k, p])
    return found


def tables(found: Nodes, mechanism: Mechanism, model: Model) -> dict[str, Any]:
    """The fields SparseBuffers adds to Buffers."""
    start, row = columns(found, model)
    group_start, group = groups(found, model)
    in_group = np.full(len(start) - 1, -1, np.int64)
    in_group[group] = np.repeat(np.arange(len(group_start) - 1), np.diff(group_start))
    held = np.array(state_rows(mechanism, model), np.int64).reshape(-1, 2)
    order = eliminated(found, model, held)
    places = entries(model, start, row, held, order.rank)
    return {
        "column_start": start,
        "row": row,
        "mass": mass(model, start, row),
        "group_start": group_start,
        "group": group,
        "in_group": in_group,
        "entry_beam": beam_entries(model, start, row, in_group),
        "state_row": held,
        **places,
        **order._asdict(),
        **room(model, len(start) - 1, len(places["entry_column"]), len(order.lower)),
    }


def eliminated(found: Nodes, model: Model, held: Any) -> Elimination:
    """Order of elimination and factors; constraint rows numbered as they stand in the model."""
    n_w, free = model.n_v + found.states, found.bodies + found.states
    joints = constraint_groups(found, model, held)
    near = found.neighbours() + [set(on) for _, on in joints]
    for k, (_, on) in enumerate(joints):
        for node in on:
            near[node].add(free + k)
    size = sizes(found, model) + [len(rows) for rows, _ in joints]
    hubs = {int(f) - 1 for f in np.flatnonzero(model.hub >= 0)}
    before = before_hubs(model)
    early = {free + k for k, (rows, _) in enumerate(joints) if before.issuperset(rows)}
    order = elimination(near, size, free, hubs, early)
    number = np.array([*range(n_w), *(n_w + j for rows, _ in joints for j in rows)], np.int64)
    rank = np.zeros(n_w + model.m, np.int64)
    rank[number] = order.rank
    return order._replace(rank=rank)


def before_hubs(model: Model) -> set[int]:
    """Constraint rows eliminated before a hub (assemble/pattern.py); none without hubs."""
    unknowns = model.row[model.column_start[:-1]]
    last = int(np.max(np.flatnonzero(unknowns >= model.m), initial=-1))
    return set(unknowns[: last + 1].tolist()) - set(range(model.m, len(unknowns)))


def entries(model: Model, start: Any, row: Any, held: Any, rank: Any) -> dict[str, Any]:
    """Where Jacobian, B, B^T and Phi_z stand among the entries, sorted by row and column."""
    n_w, slots = len(start) - 1, len(model.slot_row)
    frame = np.repeat(np.arange(model.n), np.diff(model.frame_start))
    at = np.repeat(np.arange(n_w), np.diff(start))
    rigid = frame < model.n_r
    width = np.where(rigid, model.d, model.d_node)
    first = np.where(
        rigid, model.d * (frame - 1), model.v_node + model.d_node * (frame - model.n_r)
    )
    inside = np.arange(6) < width[:, None]  # (slots, 6)
    b_row = n_w + np.repeat(model.slot_row, width)
    b_column = (first[:, None] + np.arange(6))[inside]
    rows = rank[np.concatenate([row, b_row, b_column, n_w + held[:, 0]])]
    cols = rank[np.concatenate([at, b_column, b_row, held[:, 1]])]
    sorted_by = np.lexsort((cols, rows))
    places = np.empty(len(rows), np.int64)
    places[sorted_by] = np.arange(len(rows))
    parts = np.cumsum([len(row), len(b_row), len(b_row)])
    jacobian, b, across, state = np.split(places, parts)
    wide = np.zeros((2, slots, 6), np.int64)
    wide[0][inside], wide[1][inside] = b, across
    return {
        "entry_start": np.searchsorted(rows[sorted_by], np.arange(len(rank) + 1)).astype(np.int64),
        "entry_column": cols[sorted_by],
        "entry": jacobian,
        "entry_row": wide[0],
        "entry_across": wide[1],
        "entry_state": state,
    }


def room(model: Model, n_w: int, n_entries: int, n_lower: int) -> dict[str, Any]:
    """Empty tables for numbers."""
    sizes = {
        "unknowns": n_w + model.m,
        "n_w": n_w,
        "n_x": len(model.column_start) - 1,
        "entries": n_entries,
        "lower": n_lower,
    }
    pair = np.zeros(sizes["unknowns"], complex)
    return {**zeros(SparseBuffers, model, sizes), "pair": pair}


def constraint_groups(found: Nodes, model: Model, held: Any) -> list[tuple[list[int], list[int]]]:
    """Constraint rows that act on the same nodes, and are before hubs or not: rows, nodes."""
    by_nodes: dict[tuple[int, ...], list[int]] = {}
    state, before = dict(held.tolist()), before_hubs(model)
    for j in range(model.m):
        named = model.line_frame[model.row_start[j] : model.row_start[j + 1]]
        on = {frame - 1 for frame in named.tolist() if frame > 0}
        if j in state:
            on.add(found.bodies + state[j] - model.n_v)
        by_nodes.setdefault((j in before, *sorted(on)), []).append(j)
    return [(rows, list(on)) for (_, *on), rows in by_nodes.items()]
