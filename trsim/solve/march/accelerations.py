"""The error of accelerations, where it says more than that of places and velocities.

A small vibration beside a larger, slower motion has places and speeds that are little of the
largest, and may have all of the acceleration.  What an error (x, v) of a step makes of it is

    a = w sqrt(w^2 |x|^2 + |v|^2)            turned by the phase, of the same size in any

at the frequency w of what the error consists of.  With a sum D of stages that leaves nothing of
what is slow, w^2 = |D v'| / |D x|: any phase and, of motions of several frequencies, that of the
fastest that is seen.  In units of the tolerance and the largest acceleration met this is no more
than the error of the motion, unless accelerations are small for the speeds there are.

What lies inside a step may be off by more than its end: a method whose dense output is tells so by
its `inside`, and complete.py asks where output rows lie there.

Nothing is asked for that rounding makes: of the forces, of what joints take of them, or, by what is
stiff, of places and rates.
"""

from math import sqrt

from trsim.elements.contract import FLIGHT, Memory
from trsim.kernels.lazy import internal

ROUNDING = 2e-14  # of accelerations that cancel: what is left
ROUNDED = 5e-16  # of places, the mechanism's size and speeds: what places and rates are rounded to
WIDEST = 20.0  # rad: w h of a step that sees what it passes over
# entries of a body that errors of DOP853 are the mean of: drawn vibrations are off by 25 tolerances
EACH = 9.0
FURTHEST = 3000.0  # times their share of the largest: what errors of speeds count at most
# times the tolerance as written: what accelerations of a step may be off by at most, those of a run
# if each estimate were right and of one sign, and what is left to a step of very many, without and
# with touches
ALLOWED, RUN, ONE, KICKED = 10.0, 100.0, 0.5, 0.25
TWICE = 2.0  # what is told of a jump, see `jumped`
TURNED = 0.1  # rad, by what is stiff in a step: units of touches say nothing of it


@internal
def held(s, r, h):
    """Whether accelerations of a step h are held to the tolerance.

    Waves in bars are to be passed over.  Touches have units of their own, which say nothing of what
    else is stiff: in touch they are enough where that turns by less than TURNED in the step.  Where
    the rows of a loop nearly depend on each other accelerations tell of what a state is off them,
    not of motion.
    """
    stiff = max(r.vibration, r.decay**2)  # 0 with methods that do not look for it: there may be any
    return settles(s) and (stiff == 0.0 or stiff * h * h > TURNED**2 or untouched(s, r))


@internal
def untouched(s, r):
    """Whether nothing touches at the start of the step."""
    for c in range(s.contact.size):  # noqa: SIM110 - a generator does not compile
        if touches(s, r, c):
            return False
    return True


@internal
def touches(s, r, c):
    """Whether the contact c has begun, or a step is about to begin it."""
    return r.gap[c, 0] > 0.0 or Memory(r, s.contact[c]).phase != FLIGHT


@internal
def settles(s):
    """Whether what is stiff is brought to rest (settle.py): waves in bars are passed over."""
    return (s.status[6] == 0 or s.near_rows == 0.0) and 1 < s.n_r == s.n


@internal
def largest(s, yd, most):
    """The larger of `most` and the accelerations in yd, of turns at their arm."""
    for c in range(s.n_q, s.n_q + s.v_node):
        most = max(most, s.scale[c] * abs(yd[c]))
    return most


@internal
def apart(s, a, times, c):
    """The largest acceleration in a - times c, of turns at their arm, m/s^2."""
    most = 0.0
    for k in range(s.n_q, s.n_q + s.v_node):
        most = max(most, s.scale[k] * abs(a[k] - times * c[k]))
    return most


@internal
def together(total, squares, entries):
    """The error of several bodies, m/s^2, from the sums of their squared errors e and of e^2:

        sqrt(squares / total / entries)

    the root of the mean of as many entries of each where all bodies take part alike, and that of
    one body whatever others are at rest beside it.
    """
    return sqrt(squares / (entries * total)) if total > 0.0 else 0.0


@internal
def squared(s, x, first, beyond):
    """The sum of the squares of these entries, of turns at their arm: m^2 or m^2/s^2.

    The weights of the error norm would not do: where rounding has shown (rounding.py) they make
    little of an entry, whatever its error is.
    """
    total = 0.0
    for c in range(first, beyond):
        total += (s.scale[c] * x[c]) ** 2
    return total


@internal
def frequency(turned, placed, h):
    """w^2 by the squares of |D v'| and |D x|, as far as a step h sees it."""
    widest = (WIDEST / h) ** 2
    return min(sqrt(turned / placed), widest) if turned < placed * widest**2 else widest


@internal
def stiffness(r, h):
    """w^2 of the fastest vibration or decay there could be, as far as a step h sees it."""
    return min(max(r.vibration, r.decay**2), (WIDEST / h) ** 2)


@internal
def in_units(s, r, setting, h, error, times):
    """An error of accelerations in units of what is allowed, none of it rounding.

    error: its size, that of the largest acceleration, and w^2 of what it consists of, 0 where that
    is not known; times: the tolerance.  Where accelerations are less than a FURTHEST of what speeds
    give at that, it is rounding as well.
    """
    off, most, mean = error
    most = max(most, sqrt(mean) * r.speed / FURTHEST)
    allowed = times * setting.tolerance * most
    units = off / allowed if allowed > 0.0 else 0.0
    return units if units <= 1.0 else off / max(allowed, rounded(s, r, sqrt(mean) * h))


@internal
def share(s, setting, h, one):
    """What a step h may be off by, times the tolerance: of a vibration errors add up, step by step,
    to RUN of a run of many; not less than `one` in a step, or KICKED where touches begin it anew.
    """
    least = min(one, KICKED) if s.contact.size > 0 else one
    return max(least, min(ALLOWED, RUN * h / setting.t_end))


@internal
def doubted(s, r, setting, h, error):
    """Note what accelerations may be off by where that is more than is allowed and no rounding.

    error: see `in_units`.
    """
    off, most, mean = error
    w = sqrt(mean)
    if off > ALLOWED * setting.tolerance * most and off > rounded(s, r, w * h):
        r.blur, r.blur_w = off, w


@internal
def jumped(s, r, setting, off):
    """Note what is stiff of f(y) - P'(0), `off`, the jump of the dense output's rate from the step
    before to this one: in equal steps of a smooth motion half of it is off at their ends.

    To stages far longer than what is stiff a spring is a constraint whose force is right to h^2,
    and no estimate of places and velocities sees it.  Where the motion is not smooth a jump says
    too much: it counts from TWICE what other errors do.
    """
    allowed = TWICE * ALLOWED * setting.tolerance * r.top_acceleration
    if 0.5 * off > max(allowed, r.blur, rounded(s, r, 0.0)):
        r.blur = 0.5 * off


@internal
def exceeded(r, setting, off, most, part):
    """Note what accelerations are off by where that is more than `part` tolerances, be it rounding
    or not."""
    if off > part * setting.tolerance * most:
        r.excess = off


@internal
def rounded(s, r, turned):
    """What rounding makes of accelerations, m/s^2.

    turned: rad, by which what the error consists of turns in the step, 0 where it is not known;
    rounding of speeds is felt that many times.  Of what spins fast, about an axis that needs no
    torque, gyroscopic torques cancel.
    """
    free = r.speed**2 / r.length
    for f in range(1, s.n_r):
        if s.d == 6:
            k = s.n_q + 6 * (f - 1) + 3
            turning = r.y[k] * r.y[k] + r.y[k + 1] * r.y[k + 1] + r.y[k + 2] * r.y[k + 2]
            free = max(free, turning * s.scale[k])
        for c in range(s.d):
            turns = c == 2 if s.d == 3 else c > 2
            free = max(free, abs(s.free[f, c]) * (s.reach if turns else 1.0))
    noise = largest(s, r.noise, 0.0) if r.noisy > 0.0 else 0.0
    turned = max(min(turned, WIDEST), 1.0) if turned > 0.0 else WIDEST
    return max(ROUNDING * free, turned * noise)


@internal
def unknown(r, far):
    """What the rounding of rates and of places as far as `far` makes of accelerations, by what is
    stiff, m/s^2."""
    return ROUNDED * (r.vibration * far + r.decay * r.speed)


@internal
def furthest(s, y, most):
    """The larger of `most` and the coordinates of bodies in y, m."""
    width, places = (3, 2) if s.d == 3 else (7, 3)
    for f in range(s.n_r - 1):
        for c in range(width * f, width * f + places):
            most = max(most, abs(y[c]))
    return most


@internal
def blurred(r, h):
    """Keep the largest error of accelerations that an accepted step h was not held for, and the sum
    of those that are more than their share, as rounding may have them: it adds up as well.

    How fast it turns is that of the longest such step: in short ones rounding is seen.
    """
    r.blurred_sum += r.excess
    if r.blur > 0.0:
        r.blurred = max(r.blurred, r.blur)
        if h > r.blurred_h:
            r.blurred_h, r.blurred_w = h, r.blur_w
