"""P1 by hand: the slider-crank with play in its two degrees of freedom, as a bound of what can be.

The crank turns at a constant rate, so rod angle phi and slider x are all that is unknown:

    (J + m l^2/4) phi'' = -m l/2 u(phi) x a_P + l u(phi) x f + (R_B + d) F_t         about P
    m_s x''             = -f_x

with P the crank pin, u the rod's direction, f the force on the bearing at the end of the rod,
F_t the friction on it.  DOP853 with located touches and separations, in one compiled function for
this mechanism alone: no constraints, no tables, no energy book, no peaks, no output but samples.
"""

import time
from math import cos, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numba import njit

from trsim.solve.methods.dop853_tableau import E3, E5, A, C, D

CRANK, ROD, CLEARANCE, BEARING = 0.05, 0.12, 0.5e-3, 10e-3  # m
ROD_MASS, ROD_INERTIA, SLIDER = 0.21, 2.5e-4, 0.14  # kg, kg m^2, kg
RATE = 5000 * 2 * pi / 60  # rad/s of the crank
K = 4 / 3 / (2 * (1 - 0.3**2) / 207e9) * sqrt(BEARING * (BEARING - CLEARANCE) / CLEARANCE)
CHI = 0.75 * (1 - 0.9**2)
V0, V1 = 1e-4, 1e-3  # m/s, ramp of the friction
INERTIA = ROD_INERTIA + ROD_MASS * ROD**2 / 4  # of the rod about P
REDUCED = 1 / (1 / SLIDER + ROD**2 / INERTIA)  # kg, about that of an impact
DEPTH = (1.25 * REDUCED / K) ** 0.4  # m, of an impact at 1 m/s: the unit of the error norm
SPEED = DEPTH * sqrt(1.5 * K * sqrt(DEPTH) / REDUCED)  # m/s

fast = njit(cache=True, error_model="numpy", fastmath={"contract"})


@fast
def play(t, y):
    """Penetration and its rate, m and m/s."""
    theta, phi = RATE * t, y[0]
    seen = geometry(y, cos(theta), sin(theta), cos(phi), sin(phi))
    return seen[0], seen[1]


@fast
def geometry(y, c, s, u_x, u_y):
    """Penetration and rate, normal and velocity of the journal against the rod's end.

    c, s: cosine and sine of the crank angle; u: direction of the rod.
    """
    e_x, e_y = y[1] - CRANK * c - ROD * u_x, -CRANK * s - ROD * u_y
    size = sqrt(e_x * e_x + e_y * e_y)
    inverse = 1.0 / size if size > 0.0 else 0.0
    n_x, n_y = e_x * inverse, e_y * inverse
    v_x = y[3] + RATE * CRANK * s + y[2] * ROD * u_y
    v_y = -RATE * CRANK * c - y[2] * ROD * u_x
    return size - CLEARANCE, v_x * n_x + v_y * n_y, n_x, n_y, v_x, v_y


@fast
def rates(t, y, touching, approach, mu, out):
    """y' of y = (phi, x, phi', x'); approach: speed of the touch, m/s."""
    c, s, u_x, u_y = cos(RATE * t), sin(RATE * t), cos(y[0]), sin(y[0])
    # -m l/2 u x a_P with a_P = -rate^2 crank (c, s)
    moment = 0.5 * ROD_MASS * ROD * RATE**2 * CRANK * (u_x * s - u_y * c)
    pull = 0.0
    if touching:
        d, d_dot, n_x, n_y, v_x, v_y = geometry(y, c, s, u_x, u_y)
        if d > 0.0:
            F = max(K * d * sqrt(d) * (1.0 + CHI * d_dot / approach), 0.0)
            reach = BEARING + d
            # sliding of the journal on the bearing, along (-n_y, n_x)
            v_t = v_y * n_x - v_x * n_y - y[2] * reach
            F_t = mu * F * min(max((abs(v_t) - V0) / (V1 - V0), 0.0), 1.0)
            F_t = F_t if v_t > 0.0 else -F_t
            f_x, f_y = F * n_x - F_t * n_y, F * n_y + F_t * n_x  # on the bearing
            moment += ROD * (u_x * f_y - u_y * f_x) + reach * F_t
            pull = f_x
    out[0], out[1], out[2], out[3] = y[2], y[3], moment / INERTIA, -pull / SLIDER


@fast
def stage(k, y, h, s, out):
    """out = y + h sum_j A[s, j] k[j]."""
    a = b = c = d = 0.0
    for j in range(s):
        f = A[s, j]
        if f != 0.0:
            a += f * k[j, 0]
            b += f * k[j, 1]
            c += f * k[j, 2]
            d += f * k[j, 3]
    out[0], out[1], out[2], out[3] = y[0] + h * a, y[1] + h * b, y[2] + h * c, y[3] + h * d


@fast
def step(t, y, h, touching, approach, mu, k, y1, weight):
    """A trial step from y to y1; k[0] holds y'.  Returns the error in units of the tolerance."""
    for s in range(1, 12):
        stage(k, y, h, s, y1)
        rates(t + C[s] * h, y1, touching, approach, mu, k[s])
    error5 = error3 = 0.0
    for c in range(4):
        e5 = e3 = 0.0
        for s in range(12):
            e5 += E5[s] * k[s, c]
            e3 += E3[s] * k[s, c]
        error5 += (e5 * weight[c]) ** 2
        error3 += (e3 * weight[c]) ** 2
    stage(k, y, h, 12, y1)
    rates(t + h, y1, touching, approach, mu, k[12])
    bottom = error5 + 0.01 * error3
    return h * error5 / sqrt(4.0 * bottom) if bottom > 0.0 else 0.0


@fast
def dense(t, y, h, y1, touching, approach, mu, k, P, scratch):
    """The seven rows of the interpolant."""
    for s in range(13, 16):
        stage(k, y, h, s, scratch)
        rates(t + C[s] * h, scratch, touching, approach, mu, k[s])
    for c in range(4):
        P[0, c] = y1[c] - y[c]
        P[1, c] = h * k[0, c] - P[0, c]
        P[2, c] = 2.0 * P[0, c] - h * (k[12, c] + k[0, c])
        for r in range(4):
            total = 0.0
            for s in range(16):
                total += D[r, s] * k[s, c]
            P[3 + r, c] = h * total


@fast
def interpolate(P, y, theta, out):
    rest = 1.0 - theta
    for c in range(4):
        p = P[5, c] + theta * P[6, c]
        p = P[4, c] + rest * p
        p = P[3, c] + theta * p
        p = P[2, c] + rest * p
        p = P[1, c] + theta * p
        p = P[0, c] + rest * p
        out[c] = y[c] + theta * p


@fast
def inside(P, y, t, h, theta, column, scratch):
    """Penetration (column 0) or its rate (1) at t + theta h."""
    interpolate(P, y, theta, scratch)
    return play(t + theta * h, scratch)[column]


@fast
def crossing(P, y, t, h, low, high, column, rising, scratch):
    """Where the penetration or its rate changes its sign between low and high: Illinois steps."""
    f_low = inside(P, y, t, h, low, column, scratch)
    f_high = inside(P, y, t, h, high, column, scratch)
    side = 0
    for _ in range(100):
        if high - low <= 4e-16 * max(1.0, high):
            break
        middle = high - f_high * (high - low) / (f_high - f_low)
        if not low < middle < high:
            middle = 0.5 * (low + high)
        f = inside(P, y, t, h, middle, column, scratch)
        if f == 0.0:
            return middle
        if (f > 0.0) == rising:
            high, f_high, f_low = middle, f, 0.5 * f_low if side == 1 else f_low
            side = 1
        else:
            low, f_low, f_high = middle, f, 0.5 * f_high if side == -1 else f_high
            side = -1
    return high


@fast
def event(P, y, t, h, touching, at_0, at_1, scratch):
    """Where in the step (0..1) the touch or the separation lies; 2 where there is none.

    at_0, at_1: penetration and rate at the ends of the step.
    """
    sign = -1.0 if touching else 1.0
    low, high = 0.0, 1.0
    if sign * at_1[0] < 0.0:
        if not sign * at_0[1] > 0.0 > sign * at_1[1]:
            return 2.0
        high = crossing(P, y, t, h, 0.0, 1.0, 1, not touching, scratch)
        if sign * inside(P, y, t, h, high, 0, scratch) <= 0.0:
            return 2.0
    if sign * at_0[1] < 0.0 and abs(at_0[0]) < 1e-6 * CLEARANCE:
        # it starts on the last event: from the end backwards to a point on the right side
        low = 0.5 * high
        while sign * inside(P, y, t, h, low, 0, scratch) > 0.0 and low > 1e-12:
            low *= 0.5
    return crossing(P, y, t, h, low, high, 0, not touching, scratch)


@fast
def march(tolerance, end, mu, first_step, at, velocity):
    """Integrate to `end`; the slider's velocity at the times `at`.  Returns steps and events."""
    k, P = np.zeros((16, 4)), np.zeros((7, 4))
    y, y1, scratch, weight = np.zeros(4), np.zeros(4), np.zeros(4), np.zeros(4)
    y[0], y[1], y[2], y[3] = 0.0, CRANK + ROD, -RATE * CRANK / ROD, 0.0
    weight[0], weight[1] = ROD / (tolerance * DEPTH), 1.0 / (tolerance * DEPTH)
    weight[2], weight[3] = ROD / (tolerance * SPEED), 1.0 / (tolerance * SPEED)
    t, h, touching, approach = 0.0, first_step, False, 1.0
    steps, events, sample, grown = 0, 0, 0, 5.0
    rates(t, y, touching, approach, mu, k[12])
    at_0 = play(t, y)
    while t < end:
        h = min(h, end - t)
        k[0] = k[12]
        error = step(t, y, h, touching, approach, mu, k, y1, weight)
        steps += 1
        if not error <= 1.0:
            h *= max(0.2, 0.9 * error ** (-0.125)) if error < 1e300 else 0.1
            k[12], grown = k[0], 1.0
            continue
        at_1, theta, built = play(t + h, y1), 2.0, False
        sign = -1.0 if touching else 1.0
        if sign * at_1[0] >= 0.0 or sign * at_0[1] > 0.0 > sign * at_1[1]:
            dense(t, y, h, y1, touching, approach, mu, k, P, scratch)
            built = True
            theta = event(P, y, t, h, touching, at_0, at_1, scratch)
        part = min(theta, 1.0)
        if sample < at.size and at[sample] <= t + part * h and not built:
            dense(t, y, h, y1, touching, approach, mu, k, P, scratch)
        while sample < at.size and at[sample] <= t + part * h:
            interpolate(P, y, (at[sample] - t) / h, scratch)
            velocity[sample] = scratch[3]
            sample += 1
        if theta <= 1.0:
            interpolate(P, y, theta, scratch)
            y[:] = scratch
            t, touching, events = t + theta * h, not touching, events + 1
            at_0 = play(t, y)
            rates(t, y, touching, 1.0, mu, k[12])
            if touching:
                approach = max(at_0[1], 1e-6)
                depth = (1.25 * REDUCED * approach**2 / K) ** 0.4
                h = 0.02 * 2.94 * depth / approach * tolerance ** (1 / 3)
                rates(t, y, touching, approach, mu, k[12])
        else:
            y[:] = y1
            t, at_0 = t + h, at_1
            h *= min(grown, max(0.3, 0.9 * (error + 1e-30) ** (-0.125)))
        grown = 5.0
    return steps, events


class Measured(NamedTuple):
    """A run of the hand-written program."""

    cpu: float  # s
    velocity: np.ndarray  # m/s of the slider at the times asked for
    steps: int
    events: int


def run(tolerance: float, mu: float, at: np.ndarray, first_step: float) -> Measured:
    """Three milliseconds of P1."""
    velocity = np.zeros(at.size)
    clock = time.process_time()
    steps, events = march(tolerance, 3e-3, mu, first_step, at, velocity)
    return Measured(time.process_time() - clock, velocity, steps, events)
