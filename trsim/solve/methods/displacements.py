"""Displacements: the small moves that go with the velocities, against the generalised coordinates.

An implicit method works with w = (v, states of elements) and with displacements dx counted in the
axes of the velocities: three (planar) or six numbers a body, turns as vectors in body axes; of a
node of a beam the coordinates themselves.
"""

from math import cos, sin, sqrt

from trsim.elements.contract import N_BOOK
from trsim.kernels.vectors import internal


@internal
def active(s):
    """n_w: velocities and states of elements; the energy book feeds nothing."""
    return s.n_v + s.n_z - N_BOOK


@internal
def w_index(s, k):
    """Where the k-th entry of w stands in y."""
    return s.n_q + k if k < s.n_v else s.n_q + k + N_BOOK


@internal
def first_of(s, f):
    """Where the velocities of frame f begin in v."""
    return s.d * (f - 1) if f < s.n_r else s.v_node + s.d_node * (f - s.n_r)


@internal
def width_of(s, f):
    """How many there are."""
    return s.d if f < s.n_r else s.d_node


@internal
def frame_of(s, k):
    """The frame whose velocity is the k-th entry of w; the ground for states of elements."""
    if k < s.v_node:
        return 1 + k // s.d
    return s.n_r + (k - s.v_node) // s.d_node if k < s.n_v else 0


@internal
def displace(s, y, k, part):
    """Move y by `part` along the k-th displacement.  Returns nothing; y changes in place."""
    if s.d == 3 or k >= s.v_node:
        y[place_of(s, k)] += part
        return
    f, a = k // 6, k % 6
    q = 7 * f
    if a < 3:
        y[q + a] += part
        return
    e0, e1, e2, e3 = y[q + 3], y[q + 4], y[q + 5], y[q + 6]
    half = 0.5 * part
    if a == 3:
        y[q + 3] -= e1 * half
        y[q + 4] += e0 * half
        y[q + 5] += e3 * half
        y[q + 6] -= e2 * half
    elif a == 4:
        y[q + 3] -= e2 * half
        y[q + 4] -= e3 * half
        y[q + 5] += e0 * half
        y[q + 6] += e1 * half
    else:
        y[q + 3] -= e3 * half
        y[q + 4] += e2 * half
        y[q + 5] -= e1 * half
        y[q + 6] += e0 * half


@internal
def place_of(s, k):
    """Entry of y whose weight goes with the k-th displacement."""
    if k >= s.v_node:
        return s.q_node + k - s.v_node
    return k if s.d == 3 else 7 * (k // 6) + k % 6


@internal
def twisted(s, r, k, source):
    """The k-th displacement that a change `source` of the generalised coordinates means."""
    if s.d == 3 or k >= s.v_node:
        return source[place_of(s, k)]
    f, a = k // 6, k % 6
    q = 7 * f
    if a < 3:
        return source[q + a]
    y = r.y
    e0, e1, e2, e3 = y[q + 3], y[q + 4], y[q + 5], y[q + 6]
    d0, d1, d2, d3 = source[q + 3], source[q + 4], source[q + 5], source[q + 6]
    if a == 3:
        return 2.0 * (e0 * d1 - e1 * d0 - e2 * d3 + e3 * d2)
    if a == 4:
        return 2.0 * (e0 * d2 - e2 * d0 - e3 * d1 + e1 * d3)
    return 2.0 * (e0 * d3 - e3 * d0 - e1 * d2 + e2 * d1)


@internal
def moved_by(s, y, q, w):
    """Rate of the q-th of the generalised coordinates y when the velocities are w."""
    if q >= s.q_node:
        return w[s.v_node + q - s.q_node]
    if s.d == 3:
        return w[q]
    f, a = q // 7, q % 7
    v = 6 * f
    if a < 3:
        return w[v + a]
    p = 7 * f
    e0, e1, e2, e3 = y[p + 3], y[p + 4], y[p + 5], y[p + 6]
    o0, o1, o2 = w[v + 3], w[v + 4], w[v + 5]
    if a == 3:
        return 0.5 * (-e1 * o0 - e2 * o1 - e3 * o2)
    if a == 4:
        return 0.5 * (e0 * o0 + e2 * o2 - e3 * o1)
    if a == 5:
        return 0.5 * (e0 * o1 + e3 * o0 - e1 * o2)
    return 0.5 * (e0 * o2 + e1 * o1 - e2 * o0)


@internal
def turn(y, y1, p, u, v, w):
    """Quaternion y1[p:] = y[p:] turned by the rotation vector (u, v, w) in body axes."""
    angle = sqrt(u * u + v * v + w * w)
    c = cos(0.5 * angle)
    k = sin(0.5 * angle) / angle if angle > 1e-8 else 0.5
    e0, e1, e2, e3 = y[p], y[p + 1], y[p + 2], y[p + 3]
    u, v, w = k * u, k * v, k * w
    y1[p] = e0 * c - e1 * u - e2 * v - e3 * w
    y1[p + 1] = e1 * c + e0 * u + e2 * w - e3 * v
    y1[p + 2] = e2 * c + e0 * v + e3 * u - e1 * w
    y1[p + 3] = e3 * c + e0 * w + e1 * v - e2 * u
