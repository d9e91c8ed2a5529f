"""Contacts of balls with surfaces, and seals, written for the truth alone.

How far a ball is from a surface, by shape:

    plane      y                             sphere, cylinder   |p| - R, without z
    polygon    from its core, all sides moved inwards by rho, less rho: convex, rounded corners
    line       the least of the distances from its parts, on both sides
    ellipse    from its nearest place, of which the slope is zero

Forces by laws of their own words: K d^n with a loss, friction with a ramp or with bristles, moments
against rolling and spinning, all at the place of the surface below the centre.
"""

import numpy as np

from .vectors import (
    compiled,
    cross,
    dot,
    minus,
    out_of,
    plus,
    smooth,
    three,
    times,
)

PLANE, BALL, PIPE, POLYGON, LINE, ELLIPSE = range(6)
NO_FRICTION, RAMPED, BRISTLES = 0, 2, 3
# columns of a contact; 0..8 are the arms and the direction y, as of a wall
K, EXPONENT, MARK, SLOWEST, X_AXIS, Z_AXIS = 10, 11, 12, 13, 14, 17
SHAPE, RADIUS, OTHER, FREE, BALLS, CHI, DAMPING, RAMP = range(20, 28)
LAW, MU, V0, V1, ROLLING, SPINNING, FIRST, LAST, ROUND = range(28, 37)
MU_S, V_S, SIGMA0, SIGMA1, STATE, WIDTH = *range(37, 42), 44
# of a seal
LOAD, HEIGHT, AT, LOSS, RUB, FULL, ALONG, SPRINGS = 10, 14, 15, 16, 17, 18, 19, 22
MANY = np.polynomial.legendre.leggauss(24)
U24, W24 = 0.5 * (MANY[0] + 1), 0.5 * MANY[1]


@compiled
def from_parts(table, first, last, closed, x, y):
    """The distance from a line of straight parts, the way from its nearest place, and whether a
    closed one has the point inside."""
    best, bx, by, inside = 1e300, 0.0, 0.0, False
    n = last - first
    for k in range(n if closed else n - 1):
        a, b = first + k, first + (k + 1) % n
        ax, ay = table[a, 0], table[a, 1]
        ex, ey = table[b, 0] - ax, table[b, 1] - ay
        wx, wy = x - ax, y - ay
        u = min(1.0, max(0.0, (wx * ex + wy * ey) / (ex * ex + ey * ey)))
        dx, dy = wx - u * ex, wy - u * ey
        d = np.sqrt(dx * dx + dy * dy)
        if d < best:
            best, bx, by = d, dx, dy
        # a ray to the right
        if (ay > y) != (ay + ey > y) and x < ax + ex * (y - ay) / ey:
            inside = not inside
    return best, bx, by, inside


@compiled
def from_ellipse(a, b, x, y):
    """The signed distance from an ellipse and the unit vector away from it."""
    # nearest place (a cos u, b sin u): its slope along the ellipse vanishes; inside there are four
    u, least = 0.0, 1e300
    for k in range(64):
        turn = 2 * np.pi * k / 64
        far = (x - a * np.cos(turn)) ** 2 + (y - b * np.sin(turn)) ** 2
        if far < least:
            u, least = turn, far
    for _ in range(60):
        c, s = np.cos(u), np.sin(u)
        f = (b * b - a * a) * c * s + a * x * s - b * y * c
        f1 = (b * b - a * a) * (c * c - s * s) + a * x * c + b * y * s
        du = -f / f1
        u += du
        if abs(du) < 1e-15:
            break
    c, s = np.cos(u), np.sin(u)
    nx, ny = b * c, a * s
    l = np.sqrt(nx * nx + ny * ny)
    nx, ny = nx / l, ny / l
    return (x - a * c) * nx + (y - b * s) * ny, nx, ny


@compiled
def distance(p, f, table, x, y, z):
    """How far a place is from the surface of contact f, and the way from it, in its axes."""
    shape, free = int(p[f, SHAPE]), p[f, FREE]
    if shape == PLANE:
        return y, (0.0, 1.0, 0.0)
    if shape == ELLIPSE:
        s, nx, ny = from_ellipse(p[f, RADIUS], p[f, OTHER], x, y)
        return free * s, (free * nx, free * ny, 0.0)
    if shape in (POLYGON, LINE):
        closed = shape == POLYGON
        d, dx, dy, inside = from_parts(table, int(p[f, FIRST]), int(p[f, LAST]), closed, x, y)
        sign = -1.0 if inside and closed else 1.0
        by = free * sign / d if d > 0.0 else 0.0
        return free * (sign * d - p[f, ROUND]), (by * dx, by * dy, 0.0)
    zz = z if shape == BALL else 0.0
    far = np.sqrt(x * x + y * y + zz * zz)
    if far == 0.0:
        return -free * p[f, RADIUS], (free, 0.0, 0.0)
    return free * (far - p[f, RADIUS]), (free * x / far, free * y / far, free * zz / far)


@compiled
def speed_at(r, v, w, b, place):
    return plus(three(v, b, 0), cross(three(w, b, 0), minus(place, three(r, b, 0))))


@compiled
def meeting(p, f, i, j, r, v, w, R, table):
    """Depth, its rate, the way out, and the place of the surface below the centre."""
    origin = plus(three(r, i, 0), out_of(R, i, three(p, f, 0)))
    centre = plus(three(r, j, 0), out_of(R, j, three(p, f, 3)))
    d = minus(centre, origin)
    ex = out_of(R, i, three(p, f, X_AXIS))
    ey = out_of(R, i, three(p, f, 6))
    ez = out_of(R, i, three(p, f, Z_AXIS))
    s, m = distance(p, f, table, dot(ex, d), dot(ey, d), dot(ez, d))
    n = plus(plus(times(m[0], ex), times(m[1], ey)), times(m[2], ez))
    rate = -dot(n, minus(speed_at(r, v, w, j, centre), speed_at(r, v, w, i, centre)))
    return p[f, BALLS] - s, rate, n, minus(centre, times(s, n))


@compiled
def sliding(n, i, j, r, v, w, place):
    """The velocity of body j against body i at a place, without its part along n; its size."""
    u = minus(speed_at(r, v, w, j, place), speed_at(r, v, w, i, place))
    u = minus(u, times(dot(n, u), n))
    return u, np.sqrt(dot(u, u))


@compiled
def normal(p, f, d, rate, first):
    """Its elastic part, and the whole force."""
    if d <= 0.0:
        return 0.0, 0.0
    elastic = p[f, K] * d ** p[f, EXPONENT]
    if p[f, RAMP] > 0.0:
        F = elastic + p[f, DAMPING] * smooth(d / p[f, RAMP])[0] * rate
    else:
        F = elastic * (1.0 + p[f, CHI] * rate / first)
    return elastic, max(F, 0.0)


@compiled
def share(p, f, speed):
    """Of full friction at a speed."""
    return min(1.0, max(0.0, (speed - p[f, V0]) / (p[f, V1] - p[f, V0])))


@compiled
def rolling(n, i, j, w):
    """Relative turning across n and along n."""
    turn = minus(three(w, j, 0), three(w, i, 0))
    along = dot(n, turn)
    across = minus(turn, times(along, n))
    return across, np.sqrt(dot(across, across)), along


@compiled
def rubbed(p, f, i, j, F, n, place, r, v, w, R, z):
    """Force and moment on body j that rub, the power lost, and the rates of both bristles."""
    u, speed = sliding(n, i, j, r, v, w, place)
    T, M, first, second = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0, 0.0
    if p[f, LAW] == RAMPED and speed > 0.0:
        T = times(-p[f, MU] * F * share(p, f, speed) / speed, u)
    if p[f, LAW] == BRISTLES:
        ez = out_of(R, i, three(p, f, Z_AXIS))
        t = out_of(R, i, three(p, f, X_AXIS)) if p[f, SHAPE] == PLANE else cross(n, ez)
        k = int(p[f, STATE])
        g = p[f, MU] + (p[f, MU_S] - p[f, MU]) * np.exp(-((speed / p[f, V_S]) ** 2))
        weak = p[f, SIGMA1] / (1.0 + p[f, SIGMA1] * speed / g)
        first = dot(t, u) - p[f, SIGMA0] * speed / g * z[k]
        second = dot(ez, u) - p[f, SIGMA0] * speed / g * z[k + 1]
        T = plus(
            times(-F * (p[f, SIGMA0] * z[k] + weak * first), t),
            times(-F * (p[f, SIGMA0] * z[k + 1] + weak * second), ez),
        )
    lost = -dot(T, u)
    if p[f, ROLLING] > 0.0 or p[f, SPINNING] > 0.0:
        across, size, along = rolling(n, i, j, w)
        ball = p[f, BALLS]
        if size > 0.0:
            M = times(-F * p[f, ROLLING] * share(p, f, ball * size) / size, across)
        twist = -F * p[f, SPINNING] * share(p, f, ball * abs(along)) * np.sign(along)
        M = plus(M, times(twist, n))
        lost -= dot(M, minus(three(w, j, 0), three(w, i, 0)))
    return T, M, lost, first, second


@compiled
def seal_ends(p, f, i, j, r, R):
    """Way out of the plane, the begin of the line and the line, and how both ends are pressed."""
    n = out_of(R, i, three(p, f, 6))
    begin = plus(three(r, j, 0), out_of(R, j, three(p, f, 3)))
    line = out_of(R, j, three(p, f, ALONG))
    d = minus(begin, plus(three(r, i, 0), out_of(R, i, three(p, f, 0))))
    x0 = p[f, HEIGHT] - dot(n, d)
    return n, begin, line, x0, x0 - dot(n, line)


@compiled
def seal_gap(p, f, i, j, r, v, w, R):
    """How deep the line is pressed most, and the rate there."""
    n, begin, line, x0, x1 = seal_ends(p, f, i, j, r, R)
    place = begin if x0 >= x1 else plus(begin, line)
    c = minus(place, times(p[f, HEIGHT] - max(x0, x1), n))
    rate = -dot(n, minus(speed_at(r, v, w, j, c), speed_at(r, v, w, i, c)))
    return max(x0, x1), rate, n


@compiled
def pressed(x0, x1):
    """The part of the line that is pressed."""
    low, high = 0.0, 1.0
    if x0 <= 0.0 and x1 <= 0.0:
        return 0.0, 0.0
    if x0 < 0.0:
        low = -x0 / (x1 - x0)
    if x1 < 0.0:
        high = x0 / (x0 - x1)
    return low, high


@compiled
def slow_part(n, line, x, height, i, j, r, v, w, full, loss):
    """Between which places along a line it slides slower than that: twice the slowest one where
    there are none; and where damping has its kink.  Both rates are linear along the line."""
    first, last, rates = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0)
    for k in range(2):
        place = line[0] if k == 0 else plus(line[0], line[1])
        c = minus(place, times(height - x[k], n))
        speed = minus(speed_at(r, v, w, j, c), speed_at(r, v, w, i, c))
        slip = minus(speed, times(dot(n, speed), n))
        rates = (rates[1], -dot(n, speed))
        if k == 0:
            first = slip
        else:
            last = slip
    kink = -1e9
    if loss > 0.0 and rates[0] != rates[1]:
        kink = (-1.0 / loss - rates[0]) / (rates[1] - rates[0])
    d = minus(last, first)
    A, B, C = dot(d, d), dot(first, d), dot(first, first) - full * full
    if 1e-24 * dot(first, first) > A or A == 0.0:
        return 1e9, 1e9, kink
    root = np.sqrt(max(B * B - A * C, 0.0)) / A
    return -B / A - root, -B / A + root, kink


@compiled
def sealed(p, f, i, j, r, v, w, R, Q):
    """Forces of a seal, added to both bodies; power lost by damping and by friction; the whole
    force on body j."""
    n, begin, line, x0, x1 = seal_ends(p, f, i, j, r, R)
    low, high = pressed(x0, x1)
    whole, damped, rub = (0.0, 0.0, 0.0), 0.0, 0.0
    if high <= low:
        return damped, rub, whole
    length = np.sqrt(dot(line, line))
    springs = int(p[f, SPRINGS])
    slowly = slow_part(
        n, (begin, line), (x0, x1), p[f, HEIGHT], i, j, r, v, w, p[f, FULL], p[f, LOSS]
    )
    early, late = min(max(slowly[0], low), high), min(max(slowly[1], low), high)
    n_e = springs if springs > 0 else 24
    n_l = springs if springs > 0 else 144
    for part in range(2):
        for k in range(n_e if part == 0 else n_l):
            if springs > 0:
                u, weight = (k + 0.5) / springs, 1.0 / springs
            elif part == 1:  # finer towards where it is slow; cut where damping has a kink
                piece, s = k // 24, U24[k % 24]
                lo = early if piece // 2 == 1 else (low if piece < 2 else late)
                hi = late if piece // 2 == 1 else (early if piece < 2 else high)
                middle = min(max(slowly[2], lo), hi)
                if piece % 2 == 0:
                    hi = middle
                else:
                    lo = middle
                beside = hi == early if piece < 2 else lo == late
                power = 4 if beside and piece // 2 != 1 else 1
                weight = power * s ** (power - 1) * W24[k % 24] * (hi - lo)
                u = hi - s**power * (hi - lo) if piece < 2 else lo + s**power * (hi - lo)
            elif x0 < x1:  # finer towards where the load ends
                u = low + (high - low) * U24[k] ** 2
                weight = (high - low) * 2.0 * U24[k] * W24[k]
            else:
                u = high - (high - low) * U24[k] ** 2
                weight = (high - low) * 2.0 * U24[k] * W24[k]
            x = x0 + u * (x1 - x0)
            if x <= 0.0:
                continue
            q = p[f, LOAD] * (x / p[f, AT]) ** p[f, EXPONENT] * length * weight
            place = plus(begin, times(u, line))
            c = minus(place, times(p[f, HEIGHT] - x, n))
            if part == 0:
                F = times(q, n)
            else:
                speed = minus(speed_at(r, v, w, j, c), speed_at(r, v, w, i, c))
                rate = -dot(n, speed)
                slip = plus(speed, times(rate, n))
                size = np.sqrt(dot(slip, slip))
                loss = max(q * p[f, LOSS] * rate, -q)
                F = times(loss, n)
                damped += loss * rate
                if size > 0.0:
                    slow = p[f, RUB] * q * min(1.0, size / p[f, FULL])
                    F = minus(F, times(slow / size, slip))
                    rub += slow * size
            whole = plus(whole, F)
            for b, sign in ((i, -1.0), (j, 1.0)):
                if b > 0:
                    moment = cross(minus(c, three(r, b, 0)), F)
                    for a in range(3):
                        Q[b, a] += sign * F[a]
                        Q[b, 3 + a] += sign * moment[a]
    return damped, rub, whole
