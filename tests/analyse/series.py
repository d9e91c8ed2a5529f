"""Series with known largest Lyapunov exponents, and noise."""

import numpy as np

LN2 = float(np.log(2.0))


def logistic(n, r=4.0):
    """x' = r x (1 - x): ln 2 per step for r = 4, periods 2 and 3 for r = 3.2 and 3.83."""
    x = np.empty(n)
    last = 0.3456
    for k in range(n + 1000):
        last = r * last * (1.0 - last)
        if k >= 1000:
            x[k - 1000] = last
    return np.arange(n, dtype=float), x


def henon(n):
    """a = 1.4, b = 0.3: 0.419 per step."""
    x, y, out = 0.1, 0.1, np.empty(n)
    for k in range(n + 100):
        x, y = 1.0 - 1.4 * x * x + y, 0.3 * x
        if k >= 100:
            out[k - 100] = x
    return np.arange(n, dtype=float), out


def flow(rates, start, n, every, before):
    """n rows of an ordinary differential equation after some time; classical Runge-Kutta."""

    def moved(s, k, h):
        return [x + h * v for x, v in zip(s, k, strict=True)]

    def step(s, h):
        k1 = rates(s)
        k2 = rates(moved(s, k1, h / 2))
        k3 = rates(moved(s, k2, h / 2))
        k4 = rates(moved(s, k3, h))
        four = zip(s, k1, k2, k3, k4, strict=True)
        return [x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in four]

    s, h = list(start), every / 2
    for _ in range(round(before / h)):
        s = step(s, h)
    out = np.empty((len(s), n))
    for k in range(n):
        out[:, k] = s
        s = step(step(s, h), h)
    return every * np.arange(n), out


def lorenz(n, every=0.02, start=(1.0, 1.0, 1.0), before=20.0):
    """sigma 10, rho 28, beta 8/3: 0.906 1/s."""

    def rates(s):
        return 10 * (s[1] - s[0]), s[0] * (28 - s[2]) - s[1], s[0] * s[1] - 8 / 3 * s[2]

    return flow(rates, start, n, every, before)  # all three components


def roessler(n):
    """a = b = 0.2, c = 5.7: 0.0714 1/s."""

    def rates(s):
        return -s[1] - s[2], s[0] + 0.2 * s[1], 0.2 + s[2] * (s[0] - 5.7)

    t, found = flow(rates, (1.0, 1.0, 1.0), n, 0.1, 100.0)
    return t, found[0]
