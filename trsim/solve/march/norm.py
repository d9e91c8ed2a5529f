"""The error norm: what one unit of error is, entry by entry of the state.

Lengths are weighed by the smallest gap or penetration that matters, not by the distance from the
origin; rotations by that length over the body's arm; velocities by that length times the frequency
of the contact.  Without contacts the length is the reach of its largest body, and the speed the
largest met in the run, the end of the step as its start predicts it included:

    speed = min(most, max(met, |v + h v'|))

`most` is known at the start: its speeds, or what its accelerations give over that length,
sqrt(a length), or that length per run.  A fall would get there; a stiff spring vibrates with less.
"""

import numpy as np

from trsim.elements.contract import FLIGHT, SCENE, ContactNumbers, Memory, compiled
from trsim.elements.scene import ANGLE, MAGNITUDE, RATE
from trsim.elements.scene import LENGTH as LENGTH_SCALE
from trsim.elements.scene import SPEED as SPEED_SCALE
from trsim.kernels import signatures as types
from trsim.kernels.lazy import internal
from trsim.solve.march.accelerations import largest
from trsim.solve.march.record import BUFFERS, RECORD, SETTINGS

AHEAD = 1.0  # times the change of speed that accelerations make in a step: what it may come to
RAMPS = 20.0  # a step may err by 10 % of friction at a tolerance of 0.01, by 2.7e-6 at 1e-6


@internal
def weights(s, r, b, setting, h):
    """1 / (tolerance times unit) of every entry of y in a step h; zero outside the norm.

    Lengths are weighed by the smallest gap or penetration that matters, not by the distance from
    the origin; rotations by that length over the body's arm; velocities by the matching speed.
    """
    if r.top_speed < r.speed_cap:
        follow(s, r, h)
    length, tolerance = r.length, setting.step_error
    speed = min(r.speed, felt(s, r), rubbed(s, r, h))
    for c in range(b.weight.size):
        b.weight[c] = weighed(s, length, speed, tolerance, c)


@internal
def felt(s, r):
    """The unit of velocities that forces of loaded contacts ask for: F_e chi dv/d0' is then as much
    of the largest force met as the unit of lengths makes.

    A contact that began with a light touch, small d0', turns velocities into more force than one
    that began with a hard one; where it comes to carry a load that counts.
    """
    speed = 1e300
    for c in range(s.contact.size):
        own, depth = ContactNumbers(s, c), r.gap[c, 0]
        first = Memory(r, s.contact[c]).impact_speed
        chi = own.damping
        if depth > 0.0 and first > 0.0 and chi > 0.0:
            share = (depth / max(r.impact[c], depth)) ** own.exponent
            speed = min(speed, own.arm * first / (chi * share))
    return speed


@internal
def rubbed(s, r, h):
    """The unit of velocities that friction asks for where a step may come to its ramp: RAMPS of it,
    as an error of the sliding speed is that much of the friction there."""
    speed, reach = 1e300, -1.0
    for c in range(s.contact.size):
        ramp = ContactNumbers(s, c).ramp
        if ramp > 0.0 and Memory(r, s.contact[c]).phase != FLIGHT:
            if reach < 0.0:
                reach = AHEAD * h * largest(s, r.yd, 0.0)
            if -r.corner[c] < ramp + reach:
                speed = min(speed, RAMPS * ramp)
    return speed


@internal
def follow(s, r, h):
    """Let the unit of velocities follow the speeds met, and those a step h leads to."""
    met, ahead = r.top_speed, 0.0
    for c in range(s.n_q, s.n_q + s.n_v):
        met = max(met, s.scale[c] * abs(r.y[c]))
        ahead = max(ahead, s.scale[c] * abs(r.y[c] + h * r.yd[c]))
    r.top_speed = met
    r.speed = min(max(met, ahead), r.speed_cap)


@internal
def weight_of(s, r, tolerance, c):
    """1 / (tolerance times unit) of one entry of y."""
    return weighed(s, r.length, r.speed, tolerance, c)


@internal
def weighed(s, length, speed, tolerance, c):
    """1 / (tolerance times unit) of one entry, with these units of length and speed."""
    kind, scale = s.scale_kind[c], s.scale[c]
    if kind == LENGTH_SCALE:
        return 1.0 / (tolerance * length)
    if kind == ANGLE:
        return scale / (tolerance * length)
    if kind == SPEED_SCALE:
        return 1.0 / (tolerance * speed)
    if kind == RATE:
        return scale / (tolerance * speed)
    if kind == MAGNITUDE:
        return 1.0 / (tolerance * scale)
    return 0.0


@internal
def squares(x, weight, first, beyond):
    """The sum of the squares of these entries, weighed."""
    total = 0.0
    for c in range(first, beyond):
        total += (x[c] * weight[c]) ** 2
    return total


@internal
def grow(s, r, c):
    """Let the unit of the error norm follow the deepest penetration met."""
    depth = r.gap[c, 0]
    if depth > r.impact[c]:
        r.impact[c] = depth
        units(s, r)


@internal
def units(s, r):
    """Length and speed of the error norm from the penetrations met so far; a soft stop makes no
    unit longer than bodies reach."""
    length, speed = 1e300, 1e300
    for c in range(s.contact.size):
        own = ContactNumbers(s, c)
        K, n, mass, arm = own.stiffness, own.exponent, own.mass, own.arm
        depth = min(r.impact[c], own.clearance, s.reach / arm)
        if depth <= 0.0:
            continue
        length = min(length, depth * arm)
        # the frequency of the contact at that depth turns the length into a speed
        speed = min(speed, depth * arm * np.sqrt(n * K * depth ** (n - 1.0) / mass))
    if length < 1e300:
        r.length, r.speed, r.speed_cap = length, speed, 0.0


@compiled(types.void(SCENE, RECORD, BUFFERS, SETTINGS))
def weigh(s, r, b, setting):
    """`weights`, for solvers outside."""
    weights(s, r, b, setting, r.h)
