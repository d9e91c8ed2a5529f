"""J M^-1 J^T, and what else the rows of J do to the bodies, frame by frame.

A slot is a row on one of its moving frames; the slots of a frame are neighbours (pattern.py).  Of
each, in the axes of the solve (planar x', y', omega_z; spatial the velocity and the body-axes
angular velocity),

    B = its part of J,        W = M^-1 B^T,        S = sum of B W over the slots that share a frame

so every loop here goes through the bodies once, and through lists from beginning to end.  Of a hub
B and -M stand in the matrix themselves (pattern.py).
"""

from trsim.assemble.on_beams import PLAIN, ROWS, call_beams
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear


@internal
def rows(s):
    """B, W and S of the J of the last evaluation."""
    clear(s.value)
    if s.first.size > s.m:  # there are hubs
        clear(s.through)
    pair = planar_rows(s) if s.d == 3 else spatial_rows(s)
    if s.n_r < s.n:
        call_beams(s.on_beams[ROWS], s, s.x, s.x, pair)


@internal
def planar_rows(s):
    """B and W of x', y' and omega_z, and what they add to S."""
    J, B, W, value, entry, frame_start = s.J, s.B, s.W, s.value, s.entry, s.frame_start
    pair = 0
    for f in range(1, s.n_r):
        first, behind, alone = frame_start[f], frame_start[f + 1], s.hub[f] < 0
        by_mass, by_inertia = s.mass_inverse[f], s.inertia_inverse[f, 8]
        for p in range(first, behind):
            l = s.slot_line[p]
            b0, b1, b2 = J[l, 0], J[l, 1], J[l, 5]
            w0, w1, w2 = b0 * by_mass, b1 * by_mass, b2 * by_inertia
            B[p, 0], B[p, 1], B[p, 2] = b0, b1, b2
            W[p, 0], W[p, 1], W[p, 2] = w0, w1, w2
            if alone:
                o = first
                while o < p:  # two at a time: there are few
                    value[entry[pair]] += B[o, 0] * w0 + B[o, 1] * w1 + B[o, 2] * w2
                    value[entry[pair + 1]] += B[o + 1, 0] * w0 + B[o + 1, 1] * w1 + B[o + 1, 2] * w2
                    o, pair = o + 2, pair + 2
                if o == p:
                    value[entry[pair]] += B[o, 0] * w0 + B[o, 1] * w1 + B[o, 2] * w2
                    pair += 1
        if s.hub[f] >= 0:
            pair = hub_mass(s, f, hub_rows(s, f, B, W, pair))
    return pair


@internal
def spatial_rows(s):
    """B and W of the velocity and the body-axes angular velocity, and what they add to S."""
    J, B, W, value, entry, frame_start = s.J, s.B, s.W, s.value, s.entry, s.frame_start
    X, K, slot_line, mass_inverse, hub = s.X, s.inertia_inverse, s.slot_line, s.mass_inverse, s.hub
    pair = 0
    for f in range(1, s.n_r):
        first, behind, alone = frame_start[f], frame_start[f + 1], hub[f] < 0
        by_mass = mass_inverse[f]
        r0, r1, r2, r3, r4, r5, r6, r7, r8 = (
            X[f, 3], X[f, 4], X[f, 5], X[f, 6], X[f, 7], X[f, 8], X[f, 9], X[f, 10], X[f, 11],
        )  # fmt: skip
        k0, k1, k2, k3, k4, k5, k6, k7, k8 = (
            K[f, 0], K[f, 1], K[f, 2], K[f, 3], K[f, 4], K[f, 5], K[f, 6], K[f, 7], K[f, 8],
        )  # fmt: skip
        for p in range(first, behind):
            l = slot_line[p]
            b0, b1, b2, t0, t1, t2 = J[l, 0], J[l, 1], J[l, 2], J[l, 3], J[l, 4], J[l, 5]
            b3 = r0 * t0 + r3 * t1 + r6 * t2
            b4 = r1 * t0 + r4 * t1 + r7 * t2
            b5 = r2 * t0 + r5 * t1 + r8 * t2
            w0, w1, w2 = b0 * by_mass, b1 * by_mass, b2 * by_mass
            w3 = k0 * b3 + k1 * b4 + k2 * b5
            w4 = k3 * b3 + k4 * b4 + k5 * b5
            w5 = k6 * b3 + k7 * b4 + k8 * b5
            B[p, 0], B[p, 1], B[p, 2], B[p, 3], B[p, 4], B[p, 5] = b0, b1, b2, b3, b4, b5
            W[p, 0], W[p, 1], W[p, 2], W[p, 3], W[p, 4], W[p, 5] = w0, w1, w2, w3, w4, w5
            if alone:
                for o in range(first, p + 1):
                    value[entry[pair]] += (
                        B[o, 0] * w0 + B[o, 1] * w1 + B[o, 2] * w2
                        + (B[o, 3] * w3 + B[o, 4] * w4 + B[o, 5] * w5)
                    )  # fmt: skip
                    pair += 1
        if s.hub[f] >= 0:
            pair = hub_mass(s, f, hub_rows(s, f, B, W, pair))
    return pair


@internal
def hub_rows(s, f, B, W, pair):
    """The rows on a hub, and what of S acts through it on their diagonal; `pair` moves on."""
    value, entry, through = s.value, s.entry, s.through
    for p in range(s.frame_start[f], s.frame_start[f + 1]):
        total = 0.0
        for c in range(s.d):
            value[entry[pair]] = B[p, c]
            total += B[p, c] * W[p, c]
            pair += 1
        through[s.slot_row[p]] += total
    return pair


@internal
def hub_mass(s, f, pair):
    """-M of a hub; `pair` moves on."""
    value, entry, I = s.value, s.entry, s.inertia
    if s.d == 3:
        value[entry[pair]] = value[entry[pair + 1]] = -s.mass[f]
        value[entry[pair + 2]] = -I[f, 8]
        return pair + 3
    for c in range(3):
        value[entry[pair + c]] = -s.mass[f]
    pair += 3
    for a in range(3):
        for c in range(a + 1):
            value[entry[pair]] = -I[f, 3 * a + c]
            pair += 1
    return pair


@internal
def plain_rows(s):
    """J J^T in place of S, from B; rotations are weighed by the mechanism's size."""
    B, value, turn = s.B, s.value, 1.0 / (s.size * s.size)
    clear(value)
    clear(s.through)
    pair = 0
    for f in range(1, s.n_r):
        if s.hub[f] >= 0:
            pair = plain_hub(s, f, pair, turn)
            continue
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for o in range(s.frame_start[f], p + 1):
                for a in range(s.d):
                    angular = a >= 3 or (s.d == 3 and a == 2)
                    value[s.entry[pair]] += B[p, a] * B[o, a] * (turn if angular else 1.0)
                pair += 1
    if s.n_r < s.n:
        call_beams(s.on_beams[PLAIN], s, s.x, s.x, pair)


@internal
def plain_hub(s, f, pair, turn):
    """J J^T of a hub, as if it had the mass 1 and the inertia 1 / turn; `pair` moves on."""
    B, value, entry = s.B, s.value, s.entry
    for p in range(s.frame_start[f], s.frame_start[f + 1]):
        for c in range(s.d):
            angular = c >= 3 or (s.d == 3 and c == 2)
            value[entry[pair]] = B[p, c]
            s.through[s.slot_row[p]] += B[p, c] * B[p, c] * (turn if angular else 1.0)
            pair += 1
    if s.d == 3:
        value[entry[pair]] = value[entry[pair + 1]] = -1.0
        value[entry[pair + 2]] = -1.0 / turn
        return pair + 3
    for c in range(3):
        value[entry[pair + c]] = -1.0
    for k in (3, 5, 8):  # the diagonal of what turns, row by row
        value[entry[pair + k]] = -1.0 / turn
    return pair + 9


@internal
def velocity_residual(s, k):
    """Phi' = J V + Phi_t of row k."""
    J, V, line_frame = s.J, s.V, s.line_frame
    start, end = s.row_start[k], s.row_start[k + 1]
    total = s.phi_t[k]
    for a in range(6):
        part = J[start, a] * V[line_frame[start], a]
        for l in range(start + 1, end):
            part += J[l, a] * V[line_frame[l], a]
        total += part
    return total


@internal
def pull(s, f, x):
    """free -= M^-1 J^T x of one rigid body, in the axes of the solve."""
    if s.d == 3:
        pull_planar(s, f, x)
    else:
        pull_spatial(s, f, x)


@internal
def pull_planar(s, f, x):
    """`pull` of a body in the plane; what is left, too: to read it again at once is slow."""
    W, a, slot_row = s.W, s.free, s.slot_row
    a0, a1, a2 = a[f, 0], a[f, 1], a[f, 2]
    for p in range(s.frame_start[f], s.frame_start[f + 1]):
        x_k = x[slot_row[p]]
        a0 -= W[p, 0] * x_k
        a1 -= W[p, 1] * x_k
        a2 -= W[p, 2] * x_k
    a[f, 0], a[f, 1], a[f, 2] = a0, a1, a2
    return a0, a1, a2


@internal
def pull_spatial(s, f, x):
    """`pull` of a body in space; what is left, too: to read it again at once is slow."""
    W, a, slot_row = s.W, s.free, s.slot_row
    a0, a1, a2 = a[f, 0], a[f, 1], a[f, 2]
    a3, a4, a5 = a[f, 3], a[f, 4], a[f, 5]
    for p in range(s.frame_start[f], s.frame_start[f + 1]):
        x_k = x[slot_row[p]]
        a0 -= W[p, 0] * x_k
        a1 -= W[p, 1] * x_k
        a2 -= W[p, 2] * x_k
        a3 -= W[p, 3] * x_k
        a4 -= W[p, 4] * x_k
        a5 -= W[p, 5] * x_k
    a[f, 0], a[f, 1], a[f, 2] = a0, a1, a2
    a[f, 3], a[f, 4], a[f, 5] = a3, a4, a5
    return a0, a1, a2, a3, a4, a5
