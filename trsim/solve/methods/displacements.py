"""Displacements: the small moves that go with the velocities, against the generalised coordinates.

An implicit method works with w = (v, states of elements) and with displacements dx counted in the
axes of the velocities: three (planar) or six numbers a body, turns as vectors in body axes; of a
node of a beam the coordinates themselves.
"""

from math import cos, sin, sqrt

from trsim.elements.contract import N_BOOK
from trsim.kernels.lazy import internal


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
def part_of(s, k):
    """Which of the velocities of its frame the k-th is."""
    return k % s.d if k < s.v_node else (k - s.v_node) % s.d_node


@internal
def quaternion(y, p):
    """The four numbers of y from p on."""
    return y[p], y[p + 1], y[p + 2], y[p + 3]


@internal
def turning(e, o):
    """Twice the rate of the quaternion e with the angular velocity o, in body axes."""
    return (
        -e[1] * o[0] - e[2] * o[1] - e[3] * o[2],
        e[0] * o[0] + e[2] * o[2] - e[3] * o[1],
        e[0] * o[1] + e[3] * o[0] - e[1] * o[2],
        e[0] * o[2] + e[1] * o[1] - e[2] * o[0],
    )


@internal
def turned_by(e, d):
    """2 conj(e) o d: the small rotation, body axes, that a change d of the quaternion e means."""
    return (
        2.0 * (e[0] * d[1] - e[1] * d[0] - e[2] * d[3] + e[3] * d[2]),
        2.0 * (e[0] * d[2] - e[2] * d[0] - e[3] * d[1] + e[1] * d[3]),
        2.0 * (e[0] * d[3] - e[3] * d[0] - e[1] * d[2] + e[2] * d[1]),
    )


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
    half = 0.5 * part
    about = (half if a == 3 else 0.0, half if a == 4 else 0.0, half if a == 5 else 0.0)
    change = turning(quaternion(y, q + 3), about)
    for c in range(4):
        y[q + 3 + c] += change[c]


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
    return turned_by(quaternion(r.y, q + 3), quaternion(source, q + 3))[a - 3]


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
    rate = turning(quaternion(y, 7 * f + 3), (w[v + 3], w[v + 4], w[v + 5]))
    return 0.5 * rate[a - 3]


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
