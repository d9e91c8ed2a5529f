"""Sine and cosine of one angle together: the same bits on every processor, whatever its C library.

    x = n pi/2 + y + l,   |y| <= pi/4,   n whole
    sin y = y + y^3 S(y^2),   cos y = 1 - y^2/2 + y^4 C(y^2)

pi/2 is taken as three parts of which the first two have 33 bits, so that n times each of them is
exact, and l is what is lost of y.  S and C are the polynomials of least error of fdlibm 5.3
(k_sin.c, k_cos.c).                                                        [Sun1993] [CodyWaite1980]
"""

from math import cos, sin

from trsim.kernels.lazy import internal

FARTHEST = 1e6  # rad: up to there n has 20 bits; beyond, the C library
TWO_OVER_PI = 6.36619772367581382433e-01
WHOLE = 6755399441055744.0  # 1.5 * 2^52: added and taken away it leaves the nearest whole number
FIRST, SECOND, THIRD = (
    1.57079632673412561417e00,
    6.07710050630396597660e-11,
    2.02226624879595063154e-21,
)
S1, S2, S3, S4, S5, S6 = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
C1, C2, C3, C4, C5, C6 = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)


@internal
def sine_cosine(x):
    """sin x and cos x, each off by less than one unit in its last place.

    Parameters
    ----------
    x : float            rad

    Returns
    -------
    (float, float)
    """
    if not abs(x) < FARTHEST:  # also what is no number
        return sin(x), cos(x)
    n = (x * TWO_OVER_PI + WHOLE) - WHOLE
    far = x - n * FIRST
    part = n * SECOND
    near = far - part
    part = n * THIRD - ((far - near) - part)
    y = near - part
    lost = (near - y) - part

    z = y * y
    cube = z * y
    s = S2 + z * (S3 + z * (S4 + z * (S5 + z * S6)))
    s = y - ((z * (0.5 * lost - cube * s) - lost) - cube * S1)
    c = z * (C1 + z * (C2 + z * (C3 + z * (C4 + z * (C5 + z * C6)))))
    half = 0.5 * z
    one = 1.0 - half
    c = one + (((1.0 - one) - half) + (z * c - y * lost))

    quarter = int(n) & 3
    if quarter & 1:
        s, c = c, -s
    if quarter & 2:
        s, c = -s, -c
    return s, c
