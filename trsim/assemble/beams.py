"""Nodes of beams: poses, rows and inertia.                                   elements/ancf_cable.py

A node is a frame as every other: kernels see its pose and twist, and push and turn it.  Its
coordinates are its place r and its slope g = dr/dx (x: undeformed length), and so are its rates,

    tangent  t = g / |g|,        omega = g x g' / |g|^2        no spin about the tangent: no torsion
    omega' = g x g'' / |g|^2 - 2 sigma omega,                  sigma = g . g' / |g|^2
    a moment m on the node is the slope force  m x g / |g|^2

A beam's mass matrix is constant; node by node it is a band of scalars times the unit matrix, so
M^-1 costs one pass along the beam and back, and rows of J that meet on a beam meet through the few
entries of M^-1 between their nodes (`across`).
"""

from math import sqrt

from trsim.elements.contract import SCENE, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A1, i8, void

ON_BEAMS = void(SCENE, A1, A1, i8)  # of what is called by its address: on_beams.py


@internal
def components(s):
    """Directions a node moves in: two in a plane, three in space."""
    return s.d_node // 2


@compiled(ON_BEAMS)
def node_poses(s, y, out, k):
    """X, V and the slopes G of all nodes at y."""
    X, V, G, width = s.X, s.V, s.G, components(s)
    q, v = s.q_node, s.n_q + s.v_node
    for f in range(s.n_r, s.n):
        for c in range(width):
            X[f, c], V[f, c] = y[q + c], y[v + c]
            G[f, c], G[f, 3 + c] = y[q + width + c], y[v + width + c]
        q, v = q + s.d_node, v + s.d_node
        g0, g1, g2 = G[f, 0], G[f, 1], G[f, 2]
        w0, w1, w2 = G[f, 3], G[f, 4], G[f, 5]
        square = g0 * g0 + g1 * g1 + g2 * g2
        inverse = 1.0 / sqrt(square) if square > 0.0 else 0.0
        t0, t1, t2 = g0 * inverse, g1 * inverse, g2 * inverse
        inverse *= inverse
        V[f, 3] = (g1 * w2 - g2 * w1) * inverse
        V[f, 4] = (g2 * w0 - g0 * w2) * inverse
        V[f, 5] = (g0 * w1 - g1 * w0) * inverse
        if width == 2:
            X[f, 3], X[f, 4], X[f, 6], X[f, 7] = t0, -t1, t1, t0
        else:
            cross_section(X, s.axes, f, t0, t1, t2)


@internal
def cross_section(X, axes, f, t0, t1, t2):
    """Axes of a node in space: those as drawn, turned along the shortest way to the tangent.

    With a the tangent in these axes and k = 1 / (1 + a_x)

        R = R_0 [a, e_y - k a_y (e_x + a), e_z - k a_z (e_x + a)]

    What spins about the tangent is of no consequence (rows.check_space).
    """
    R = axes[f]
    a = R[0] * t0 + R[3] * t1 + R[6] * t2
    b = R[1] * t0 + R[4] * t1 + R[7] * t2
    c = R[2] * t0 + R[5] * t1 + R[8] * t2
    square = b * b + c * c
    if a > 0.0:
        k = 1.0 / (1.0 + a)
        bb, bc, cc = k * b * b, k * b * c, k * c * c
    elif square > 0.0:  # the same, without the difference of nearly equal numbers
        k = (1.0 - a) / square
        bb, bc, cc = k * b * b, k * b * c, k * c * c
    else:  # straight back
        bb, bc, cc = 2.0, 0.0, 0.0
    for r in range(3):
        u, v, w = R[3 * r], R[3 * r + 1], R[3 * r + 2]
        X[f, 3 + 3 * r] = u * a + v * b + w * c
        X[f, 4 + 3 * r] = -u * b + v * (1.0 - bb) - w * bc
        X[f, 5 + 3 * r] = -u * c - v * bc + w * (1.0 - cc)


@internal
def slope_force(s, f, c):
    """What acts along component c of the slope of node f: the elastic force and the moments."""
    G, F = s.G, s.F
    square = G[f, 0] * G[f, 0] + G[f, 1] * G[f, 1] + G[f, 2] * G[f, 2]
    a, b = (c + 1) % 3, (c + 2) % 3
    return s.Q[f, c] + (F[f, 3 + a] * G[f, b] - F[f, 3 + b] * G[f, a]) / square


@compiled(ON_BEAMS)
def node_accelerations(s, x, out, k):
    """free = M^-1 F of all nodes."""
    width = components(s)
    for f in range(s.n_r, s.n):
        for c in range(width):
            s.free[f, c] = s.F[f, c]
            s.free[f, width + c] = slope_force(s, f, c)
    divide_by_mass(s, s.free)


@internal
def divide_by_mass(s, u):
    """u <- M^-1 u on the rows of all nodes: one pass along every beam and one back.

    M = L D L^T; a row of L meets place and slope of its own node and of the one before.
    """
    L, width = s.band, components(s)
    for b in range(s.beam.shape[0]):
        first, nodes, at = s.beam[b, 0], s.beam[b, 1], s.beam[b, 2]
        for n in range(nodes):
            f, k = first + n, at + 2 * n
            for c in range(width):
                place, slope = u[f, c], u[f, width + c]
                if n > 0:
                    r, g = u[f - 1, c], u[f - 1, width + c]
                    place -= L[k - 2, 2] * r + L[k - 1, 1] * g
                    slope -= L[k - 2, 3] * r + L[k - 1, 2] * g
                u[f, c], u[f, width + c] = place, slope - L[k, 1] * place
        for back in range(nodes):
            n = nodes - 1 - back
            f, k = first + n, at + 2 * n
            for c in range(width):
                place, slope = u[f, c] * L[k, 0], u[f, width + c] * L[k + 1, 0]
                if back > 0:
                    r, g = u[f + 1, c], u[f + 1, width + c]
                    place -= L[k, 2] * r + L[k, 3] * g
                    slope -= L[k + 1, 1] * r + L[k + 1, 2] * g
                u[f, c], u[f, width + c] = place - L[k, 1] * slope, slope


@internal
def node_rows(s):
    """B of the slots on nodes."""
    J, B, G, width = s.J, s.B, s.G, components(s)
    for f in range(s.n_r, s.n):
        square = G[f, 0] * G[f, 0] + G[f, 1] * G[f, 1] + G[f, 2] * G[f, 2]
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            l = s.slot_line[p]
            for c in range(width):
                x, y = (c + 1) % 3, (c + 2) % 3
                B[p, c] = J[l, c]
                B[p, width + c] = (J[l, 3 + x] * G[f, y] - J[l, 3 + y] * G[f, x]) / square


@internal
def node_products(s, B, pair):
    """What the slots on nodes add to S, with their rows in B; pair: of `entry`, the first."""
    value, entry, across, width = s.value, s.entry, s.across, components(s)
    start = pair
    for b in range(s.beam.shape[0]):
        first, end = s.beam[b, 0], s.beam[b, 0] + s.beam[b, 1]
        for p in range(s.frame_start[first], s.frame_start[end]):
            for o in range(s.frame_start[first], p + 1):
                total = 0.0
                for c in range(width):
                    d = width + c
                    total += B[p, c] * (
                        across[pair - start, 0] * B[o, c] + across[pair - start, 1] * B[o, d]
                    )
                    total += B[p, d] * (
                        across[pair - start, 2] * B[o, c] + across[pair - start, 3] * B[o, d]
                    )
                # a row that names two nodes of a beam meets itself twice
                twice = o != p and s.slot_row[o] == s.slot_row[p]
                value[entry[pair]] += 2.0 * total if twice else total
                pair += 1


@compiled(ON_BEAMS)
def node_plain_rows(s, x, out, pair):
    """What the slots on nodes add to J J^T from `pair` on; slopes are weighed by the size."""
    B, value, width, turn = s.B, s.value, components(s), 1.0 / (s.size * s.size)
    for b in range(s.beam.shape[0]):
        first, end = s.beam[b, 0], s.beam[b, 0] + s.beam[b, 1]
        for f in range(first, end):
            for p in range(s.frame_start[f], s.frame_start[f + 1]):
                for o in range(s.frame_start[first], p + 1):
                    if o >= s.frame_start[f]:
                        for c in range(width):
                            value[s.entry[pair]] += B[p, c] * B[o, c]
                            value[s.entry[pair]] += B[p, width + c] * B[o, width + c] * turn
                    pair += 1


@compiled(ON_BEAMS)
def node_right_hand_side(s, x, out, k):
    """x += J M^-1 F + 2 sigma J_omega omega of the slots on nodes."""
    B, G, V, free = s.B, s.G, s.V, s.free
    for f in range(s.n_r, s.n):
        if s.frame_start[f] == s.frame_start[f + 1]:
            continue
        square = G[f, 0] * G[f, 0] + G[f, 1] * G[f, 1] + G[f, 2] * G[f, 2]
        sigma = (G[f, 0] * G[f, 3] + G[f, 1] * G[f, 4] + G[f, 2] * G[f, 5]) / square
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            total = 0.0
            for c in range(s.d_node):
                total += B[p, c] * free[f, c]
            for c in range(3):
                total -= 2.0 * sigma * s.J[s.slot_line[p], 3 + c] * V[f, 3 + c]
            x[s.slot_row[p]] += total


@internal
def gathered(s, u, x):
    """u = J^T x on the rows of all nodes."""
    for f in range(s.n_r, s.n):
        for c in range(s.d_node):
            u[f, c] = 0.0
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for c in range(s.d_node):
                u[f, c] += s.B[p, c] * x[s.slot_row[p]]


@compiled(ON_BEAMS)
def node_stress(s, x, out, row):
    """x += J M^-1 J_row^T of all nodes, for a row that need not be one of the solve."""
    J, B, G, u, width = s.J, s.B, s.G, s.moved, components(s)
    for f in range(s.n_r, s.n):
        for c in range(s.d_node):
            u[f, c] = 0.0
    for l in range(s.row_start[row], s.row_start[row + 1]):
        f = s.line_frame[l]
        if f < s.n_r:
            continue
        square = G[f, 0] * G[f, 0] + G[f, 1] * G[f, 1] + G[f, 2] * G[f, 2]
        for c in range(width):
            a, b = (c + 1) % 3, (c + 2) % 3
            u[f, c] += J[l, c]
            u[f, width + c] += (J[l, 3 + a] * G[f, b] - J[l, 3 + b] * G[f, a]) / square
    divide_by_mass(s, u)
    for f in range(s.n_r, s.n):
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for c in range(s.d_node):
                x[s.slot_row[p]] += B[p, c] * u[f, c]


@compiled(ON_BEAMS)
def pull_nodes(s, x, out, k):
    """free -= M^-1 J^T x of all nodes."""
    u = s.moved
    gathered(s, u, x)
    divide_by_mass(s, u)
    for f in range(s.n_r, s.n):
        for c in range(s.d_node):
            s.free[f, c] -= u[f, c]


@compiled(ON_BEAMS)
def node_rates(s, y, yd, k):
    """q' and V' of all nodes into yd, and V' as twists into A."""
    A, G, V, width = s.A, s.G, s.V, components(s)
    q, v = s.q_node, s.n_q + s.v_node
    for f in range(s.n_r, s.n):
        for c in range(s.d_node):
            yd[q + c], yd[v + c] = y[v + c], s.free[f, c]
        q, v = q + s.d_node, v + s.d_node
        square = G[f, 0] * G[f, 0] + G[f, 1] * G[f, 1] + G[f, 2] * G[f, 2]
        sigma = (G[f, 0] * G[f, 3] + G[f, 1] * G[f, 4] + G[f, 2] * G[f, 5]) / square
        w0, w1 = s.free[f, width], s.free[f, width + 1]
        w2 = s.free[f, 5] if width == 3 else 0.0
        for c in range(width):
            A[f, c] = s.free[f, c]
        A[f, 3] = (G[f, 1] * w2 - G[f, 2] * w1) / square - 2.0 * sigma * V[f, 3]
        A[f, 4] = (G[f, 2] * w0 - G[f, 0] * w2) / square - 2.0 * sigma * V[f, 4]
        A[f, 5] = (G[f, 0] * w1 - G[f, 1] * w0) / square - 2.0 * sigma * V[f, 5]


@internal
def times_mass(s, v, x, o, out):
    """out <- M x of all nodes; their entries begin at x[v] and at out[o]."""
    M, width, step = s.consistent, components(s), s.d_node
    for b in range(s.beam.shape[0]):
        first, nodes, at = s.beam[b, 0], s.beam[b, 1], s.beam[b, 2]
        for n in range(nodes):
            i, k = step * (first - s.n_r + n), at + 2 * n
            for c in range(width):
                r, g = x[v + i + c], x[v + i + width + c]
                place = M[k, 0] * r + M[k, 1] * g
                slope = M[k, 1] * r + M[k + 1, 0] * g
                if n > 0:
                    r, g = x[v + i - step + c], x[v + i - step + width + c]
                    place += M[k - 2, 2] * r + M[k - 1, 1] * g
                    slope += M[k - 2, 3] * r + M[k - 1, 2] * g
                if n + 1 < nodes:
                    r, g = x[v + i + step + c], x[v + i + step + width + c]
                    place += M[k, 2] * r + M[k, 3] * g
                    slope += M[k + 1, 1] * r + M[k + 1, 2] * g
                out[o + i + c], out[o + i + width + c] = place, slope


@compiled(ON_BEAMS)
def node_kinetic(s, y, out, _):
    """s.moved[0, 0] = kinetic energy of all beams at y, J: 1/2 v^T M v with M as it was before it
    was factorised."""
    T, width = 0.0, components(s)
    for b in range(s.beam.shape[0]):
        first, rows, at = s.beam[b, 0], 2 * s.beam[b, 1], s.beam[b, 2]
        v = s.n_q + s.v_node + s.d_node * (first - s.n_r)
        for c in range(width):
            for k in range(rows):
                here = y[v + s.d_node * (k // 2) + width * (k % 2) + c]
                T += 0.5 * s.consistent[at + k, 0] * here * here
                for p in range(1, 4):
                    if k + p < rows:
                        o = k + p
                        T += (
                            s.consistent[at + k, p]
                            * here
                            * y[v + s.d_node * (o // 2) + width * (o % 2) + c]
                        )
    s.moved[0, 0] = T
