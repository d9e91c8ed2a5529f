"""Corners of functions that sensors meet: looked for on the dense output, none is passed over.

On a part of a step that begins and ends with S_0 and S_1 of a sensor, l seconds long,

    |S''| <= M                                               spread.py
    S  in [min(S_0, S_1) - M l^2/8, max(S_0, S_1) + M l^2/8]
    S' in (S_1 - S_0)/l + [-M l/2, M l/2]

and interval arithmetic (laws/ranges.py) makes of them the range of u and of u' of every corner.
A part on which u stays on its piece, or on which u' has one sign and u ends on its piece, is
clear; one on which u' has one sign and u ends elsewhere has one root; every other one is halved.
Of the rate of a sensor the same holds a derivative further (spread_rates.py); its own rate, which
tells where a corner is left to, is the mean of the step.

What is on a corner and at rest, or swings about one within the error allowed, is left free: the
function is then evaluated as it is written, until it has gone away.

The dense output of a long step says when a short event begins, but its stages may lie before and
behind it.  A step that leaves a piece of exp (laws/operations.py) long before its end is therefore
taken again, shorter: the stages of what is accepted lie on the piece, and its error is known.
"""

from math import inf, isfinite

from trsim.assemble.equations import evaluate, set_poses
from trsim.assemble.features import (
    ENTRY,
    HELD_FROM,
    HELD_TO,
    INSTANCE,
    KIND,
    NEAR,
    OFFSET,
    READS,
    SENSED,
    hold_sensed,
)
from trsim.assemble.travel import ANGLES, RATE_OF
from trsim.elements.contract import SCENE, compiled
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import I1, f8, i8
from trsim.laws.corners import (
    CLEAR,
    UNSURE,
    brief,
    corner,
    enclosed,
    ends_of,
    located,
    neighbour,
    piece_at,
    sensed,
)
from trsim.laws.functions import FREE
from trsim.solve.march.calls import IMPLICIT_AT, LAST_AT, SEARCH, STAGES_AT, STEP_AT
from trsim.solve.march.corners import NONE, show
from trsim.solve.march.dense_output import build
from trsim.solve.march.events import FINEST, LOOKS, SAME, hidden_depth
from trsim.solve.march.features import keep, other_side
from trsim.solve.march.illinois import TRIALS, between, is_narrow, narrowed
from trsim.solve.march.record import BUFFERS, RECORD, SETTINGS
from trsim.solve.march.spread import fill_net, spread, spread_at_stages
from trsim.solve.march.spread_rates import rate_at_stages, spread_of_rate

EITHER_WAY = -1.0  # sign of a spread whose M bounds |g''|: of a distance that is the larger one
UNCERTAIN = 3.0  # a step too long to be certain; NONE: no corner in it
SEEN = 0.8  # of a step: a short event that fills less of it may lie between its stages
BRIEF = 1e-9  # of a run: what is shorter is not looked for
THETA, PLACE, NEXT = range(3)  # of b.met
LAST, TIMES, FAR = range(3)  # of r.chatter
AHEAD = 1e-3  # of the next step: how far u is looked at behind a corner
HALVINGS, LITTLE = 40, 0.05  # of the next step, by four; of the velocities
JUMPS = 0.5  # of the difference between two pieces ahead of a corner: as much at the corner itself
SMALL = 1e4  # errors allowed, by which a jump changes a rate in the rest of a run
OFTEN = 20  # corners met in a row within the error allowed: it is no longer located

TURN = types.int64(SCENE, RECORD, BUFFERS, SETTINGS, I1, i8)
BEYOND = types.float64(SCENE, BUFFERS, f8)
call_turn, call_beyond = caller(TURN), caller(BEYOND)


@compiled(SEARCH)
def corners_ahead(s, r, b, setting, method):
    """Where sensors first meet a corner in the step at hand, whose end was evaluated last.

    As theta in [0, 1]; NONE, the scene is then again as evaluated there; UNCERTAIN where a shorter
    step is needed.  Fills b.met.
    """
    for n in range(s.feature.shape[0]):
        b.met[n, THETA] = NONE
    if s.sensed.shape[0] == 0:
        return NONE
    for k in range(s.sensed.shape[0]):
        entry = s.sensed[k, ENTRY]
        b.shown[k, 0], b.shown[k, 1] = r.sight[k], s.S[entry, 0]
        if s.sensed[k, KIND] > RATE_OF:  # its own rate: the mean of the step
            s.S[entry, 1] = (b.shown[k, 1] - b.shown[k, 0]) / b.h
    if b.built == 0 and method[STAGES_AT] > 0:
        for k in range(s.sensed.shape[0]):
            kind, e, entry = s.sensed[k, KIND], s.sensed[k, INSTANCE], s.sensed[k, ENTRY]
            if kind > RATE_OF:
                most, L, M = rate_at_stages(s, r, b, (kind, e))
            else:
                most, (L, M) = -1.0, spread_at_stages(s, r, b, (kind, e), EITHER_WAY)
            see(s, b, k, L, M, b.h)
            limit(b.seen[entry], most)
        if verdict(s, b, b.t, b.t + b.h) == CLEAR:
            return NONE
    evaluations = s.status[1]
    if b.built == 0:
        build(s, r, b, method)
    fill_net(s, r, b, method)
    first = first_corner(s, r, b, setting)
    if first >= 1.0:
        if s.status[1] > evaluations:
            evaluate(s, b.t + b.h, b.y1, b.K[method[LAST_AT]])
        else:
            set_poses(s, b.y1)
    return first


@internal
def see(s, b, k, L, M, length):
    """The ranges of sensor k and of its rate in `length` s, from what it shows at both ends."""
    seen, first, last = b.seen[s.sensed[k, ENTRY]], b.shown[k, 0], b.shown[k, 1]
    mean = (last - first) / length
    if M >= 0.0 and isfinite(M):
        away, bend = 0.125 * M * length * length, 0.5 * M * length
        seen[0], seen[1] = min(first, last) - away, max(first, last) + away
        seen[2], seen[3] = mean - bend, mean + bend
    elif L >= 0.0 and isfinite(L):
        seen[0], seen[1] = 0.5 * (first + last - L * length), 0.5 * (first + last + L * length)
        seen[2], seen[3] = -L, L
    else:
        seen[0], seen[1], seen[2], seen[3] = -inf, inf, -inf, inf


@internal
def limit(seen, most):
    """Take into a range that what it is of is never larger than `most`, where that is known."""
    if most >= 0.0:
        seen[0], seen[1] = max(seen[0], -most), min(seen[1], most)


@internal
def verdict(s, b, t0, t1):
    """The worst of all functions, on the part of the step whose ranges are in b.seen."""
    worst = CLEAR
    for n in range(s.feature.shape[0]):
        if s.feature[n, SENSED] > 0:
            found = enclosed(s.tab, s.feature[n, OFFSET], (t0, t1), s.S, b.seen, b.box)
            worst = max(worst, found)
    return worst


@internal
def first_corner(s, r, b, setting):
    """The first corner that is met, by halving; b.shown holds the sensors at both ends."""
    low, high, t, h = 0.0, 1.0, b.t, b.h
    again = setting.fixed_step == 0.0  # a shorter step can be had
    for _ in range(LOOKS):
        show(s, r, b, high)
        length, short = (high - low) * h, high - low < FINEST
        hidden = True
        for k in range(s.sensed.shape[0]):
            kind, e = s.sensed[k, KIND], s.sensed[k, INSTANCE]
            b.shown[k, 1] = s.S[s.sensed[k, ENTRY], 0]
            if kind > RATE_OF:
                most, L, M = spread_of_rate(s, r, b, (kind, e), (low, high))
            else:
                most, (L, M) = -1.0, spread(s, r, b, (kind, e), EITHER_WAY, (low, high))
            see(s, b, k, L, M, length)
            limit(b.seen[s.sensed[k, ENTRY]], most)
            seen = b.seen[s.sensed[k, ENTRY]]
            hidden = hidden and seen[1] - seen[0] < hidden_depth(s, r, setting, kind)
        found = verdict(s, b, t + low * h, t + high * h)
        if found == UNSURE and not (short or hidden):
            high = 0.5 * (low + high)
            continue
        if found == UNSURE and not hidden and short:
            r.unproved += 1
            if again:
                return UNCERTAIN
        if found != CLEAR:
            first = roots(s, r, b, low, high)
            if first <= 1.0:
                unseen = first < SEEN and first * h > BRIEF * setting.t_end
                return UNCERTAIN if again and unseen and leaves_brief(s, b) else first
        if high >= 1.0:
            return NONE
        step = 2.0 * (high - low)
        low, high = high, min(1.0, high + step)
        for k in range(s.sensed.shape[0]):
            b.shown[k, 0] = b.shown[k, 1]
    r.unproved += 1
    return UNCERTAIN if again else NONE


@internal
def roots(s, r, b, low, high):
    """The first of the corners that lie between two places, each met once; fills b.met."""
    first = NONE
    for n in range(s.feature.shape[0]):
        if s.feature[n, SENSED] == 0:
            continue
        for k in range(s.feature[n, HELD_FROM], s.feature[n, HELD_TO]):
            o, place = s.feature[n, OFFSET], s.held[k]
            if not sensed(s.tab, o, place) or s.tab[place] == FREE:
                continue
            show(s, r, b, high)
            u, _, _ = corner_at(s, n, place, b.t + high * b.h)
            least, most = ends_of(s.tab, o, place)
            if least <= u <= most:
                continue
            at = root(s, r, b, (n, place), u > most, (low, high))
            if at < b.met[n, THETA]:
                b.met[n, THETA], b.met[n, PLACE] = at, place
                b.met[n, NEXT] = neighbour(s.tab, o, place, u > most)
            first = min(first, at)
    for n in range(s.feature.shape[0]):
        if b.met[n, THETA] > first + SAME:
            b.met[n, THETA] = NONE
    return first


@internal
def leaves_brief(s, b):
    """Whether a corner in b.met ends a piece that may be a short event."""
    for n in range(s.feature.shape[0]):
        if b.met[n, THETA] <= 1.0 and brief(s.tab, s.feature[n, OFFSET], int(b.met[n, PLACE])):
            return True
    return False


@internal
def corner_at(s, n, place, t):
    """Of a corner, at the poses of the scene: u, its rate and its size."""
    located(s.tab, s.feature[n, OFFSET], t, s.S)
    return corner(s.tab, s.feature[n, OFFSET], place, s.S)


@internal
def root(s, r, b, whose, above, part):
    """Where u leaves its piece between two places of the step, just behind it.

    whose: the function, and the place of the corner in tab.
    """
    (n, place), (low, high), t, h = whose, part, b.t, b.h
    least, most = ends_of(s.tab, s.feature[n, OFFSET], place)
    end = most if above else least
    f_high = corner_at(s, n, place, t + high * h)[0] - end
    show(s, r, b, low)
    f_low = corner_at(s, n, place, t + low * h)[0] - end
    if (f_low > 0.0) == above and f_low != 0.0:
        return low  # outside as it begins: to rounding on the corner, and on its way out
    bracket = (low, f_low, high, f_high, 0.0)
    for k in range(TRIALS):
        if is_narrow(bracket):
            break
        middle = between(bracket, k)
        show(s, r, b, middle)
        f = corner_at(s, n, place, t + middle * h)[0] - end
        if f == 0.0:
            return middle
        bracket = narrowed(bracket, middle, f, above)
    return bracket[2]


@compiled(BEYOND)
def beyond(s, b, t):
    """How much earlier than at t the corner in b.met is met, s, at the poses of the scene."""
    first = -1
    for n in range(s.feature.shape[0]):
        if b.met[n, THETA] <= 1.0 and (first < 0 or b.met[n, THETA] < b.met[first, THETA]):
            first = n
    if first < 0:
        return 0.0
    place = int(b.met[first, PLACE])
    u, rate, _ = corner_at(s, first, place, t)
    least, most = ends_of(s.tab, s.feature[first, OFFSET], place)
    end = most if abs(u - most) < abs(u - least) else least
    return (u - end) / rate if rate != 0.0 else 0.0


@compiled(TURN)
def turn(s, r, b, setting, method, changed):
    """Go on from the end of the step behind the corners that sensors met there; whether the next
    step is shorter.

    changed: not 0 where what was held has changed already, by the time or by an event.
    """
    set_poses(s, r.y)
    t1, turned = b.t1, 0
    for n in range(s.feature.shape[0]):
        if s.feature[n, SENSED] > 0:
            turned += released(s, r, n, t1)
            if b.met[n, THETA] <= 1.0:
                if s.rated.shape[0] > 0 and slides(s, r, b, n, t1):
                    r.slid = 1 + s.feature[n, OFFSET]
                before = s.tab[int(b.met[n, PLACE])]
                s.tab[int(b.met[n, PLACE])] = b.met[n, NEXT]
                if often(s, r, b, setting, n, t1):
                    leave(s, r, b, setting, n, before)
                turned += 1
    if turned > 0 or changed > 0:
        for n in range(s.feature.shape[0]):
            if s.feature[n, SENSED] > 0:
                turned += hold_sensed(s, n, t1, 0)
    for k in range(s.sensed.shape[0]):
        r.sight[k] = s.S[s.sensed[k, ENTRY], 0]
    if turned > 0:
        evaluate(s, t1, r.y, r.yd)
        keep(s, r)
        other_side(s, r, b, t1)
    explicit = method[IMPLICIT_AT] == 0 and method[STEP_AT] > 0
    if not explicit and (turned > 0 or changed > 0) and other_pieces(s, b):
        turned += ease(s, r, b, t1)
    return turned


@internal
def slides(s, r, b, n, t1):
    """Whether the corner of feature n that was met drives u back from both of its sides.

    Only u of a rate can be: what the load does at once is an acceleration.
    """
    place, before = int(b.met[n, PLACE]), s.tab[int(b.met[n, PLACE])]
    near, ahead = corner_at(s, n, place, t1)[0], AHEAD * r.h
    least, most = ends_of(s.tab, s.feature[n, OFFSET], place)
    above = abs(near - most) < abs(near - least)
    slope_before = slope_on(s, r, b, n, place, (before, t1, ahead)) - near
    slope_next = slope_on(s, r, b, n, place, (b.met[n, NEXT], t1, ahead)) - near
    s.tab[place] = before
    evaluate(s, t1, r.y, r.yd)
    set_poses(s, r.y)
    return slope_before > 0.0 > slope_next if above else slope_before < 0.0 < slope_next


@internal
def slope_on(s, r, b, n, place, held):
    """u a little ahead at the accelerations that a piece gives."""
    s.tab[place], t1, ahead = held
    evaluate(s, t1, r.y, b.K[1])
    for c in range(r.y.size):
        b.y2[c] = r.y[c] + ahead * b.K[1, c]
    set_poses(s, b.y2)
    return corner_at(s, n, place, t1 + ahead)[0]


@internal
def other_pieces(s, b):
    """Whether a function that reads sensors is on other pieces than in the last step."""
    for n in range(s.feature.shape[0]):
        if s.feature[n, READS] > 0:
            for k in range(s.feature[n, HELD_FROM], s.feature[n, HELD_TO]):
                if s.tab[s.held[k]] != b.before[k]:
                    return True
    return False


@internal
def ease(s, r, b, t1):
    """Make the next step so short that what the new pieces do to the velocities is little.

    An implicit method takes a step much too long for one that rests there, and damps out what
    should swing.  Whether the new pieces matter is told from the accelerations with them and
    with those of before, at places straight ahead.  Returns whether the step is shorter.
    """
    most = 1.0  # of the velocities, in units of the tolerance
    for c in range(s.n_q, s.n_q + s.n_v):
        most = max(most, abs(r.y[c]) * b.weight[c])
    h = r.h
    for _ in range(HALVINGS):
        for c in range(r.y.size):
            b.y2[c] = r.y[c] + (h * r.yd[c] if c < s.n_q else 0.0)
        evaluate(s, t1, b.y2, b.K[1])
        swap(s, b)
        evaluate(s, t1, b.y2, b.K[2])
        swap(s, b)
        worst = 0.0
        for c in range(s.n_q, s.n_q + s.n_v):
            worst = max(worst, abs(b.K[1, c] - b.K[2, c]) * b.weight[c])
        if worst * h <= LITTLE * most:
            break
        h *= 0.25
    evaluate(s, t1, r.y, r.yd)
    shorter = h < r.h
    r.h = h
    return int(shorter)


@internal
def swap(s, b):
    """Exchange what functions are held on for what they were held on before."""
    for k in range(s.held.size):
        held = s.tab[s.held[k]]
        s.tab[s.held[k]], b.before[k] = b.before[k], held


@internal
def often(s, r, b, setting, n, t1):
    """Whether a corner is met again and again within the error allowed: a rest on a corner.

    What u changes by with the time alone is not an error of a sensor.
    """
    place, chatter = int(b.met[n, PLACE]), r.chatter[n]
    rate, of_rates = corner_at(s, n, place, t1)[1], back(s, n, place, t1, RATE_OF)
    of_sensors = 0.5 * abs(rate - back(s, n, place, t1, -1))
    fastest = 1e-300  # sensor
    for k in range(s.sensed.shape[0]):
        own, kind = abs(s.S[s.sensed[k, ENTRY], 1]), s.sensed[k, KIND]
        if kind > RATE_OF:
            if of_rates == rate:
                continue
            own, kind = own * r.length / r.speed, kind - RATE_OF
        fastest = max(fastest, own * (s.reach if kind in ANGLES else 1.0))
    allowed = of_sensors / fastest * setting.step_error * r.length
    within = abs(rate) * (t1 - chatter[LAST]) <= allowed
    chatter[TIMES], chatter[LAST] = chatter[TIMES] + 1.0 if within else 0.0, t1
    if chatter[TIMES] <= OFTEN:
        return False
    chatter[FAR], chatter[TIMES] = allowed, 0.0
    return True


@internal
def back(s, n, place, t1, beyond):
    """The rate of u if sensors whose kind is beyond that went the other way."""
    turn_back(s, beyond)
    rate = corner_at(s, n, place, t1)[1]
    turn_back(s, beyond)
    return rate


@internal
def turn_back(s, beyond):
    """The other sign for the rates of those sensors."""
    for k in range(s.sensed.shape[0]):
        if s.sensed[k, KIND] > beyond:
            s.S[s.sensed[k, ENTRY], 1] = -s.S[s.sensed[k, ENTRY], 1]


@internal
def leave(s, r, b, setting, n, before):
    """Leave a corner free; where the function jumps there and drives u back from both sides, no
    motion goes on from it.

    before: the piece that ended there.  By what both pieces do to the acceleration of u differs at
    a jump as much at the corner as ahead of it, at a kink next to nothing.  A SMALL jump, as of
    two pieces whose numbers are rounded, is passed in few steps, and holds by next to nothing.
    """
    place, t1, ahead = int(b.met[n, PLACE]), b.t1, AHEAD * r.h
    way = corner_at(s, n, place, t1)[1]
    one = bend_on(s, r, b, n, place, (before, t1, 0.0, ahead))
    other = bend_on(s, r, b, n, place, (b.met[n, NEXT], t1, 0.0, ahead))
    if one * way > 0.0 > other * way:
        far = bend_on(s, r, b, n, place, (before, t1, ahead, ahead))
        far -= bend_on(s, r, b, n, place, (b.met[n, NEXT], t1, ahead, ahead))
        change = abs(one - other) * (setting.t_end - t1)
        matters = change > SMALL * r.chatter[n, FAR] * r.speed / r.length
        if matters and abs(one - other) > JUMPS * abs(far):
            r.slid = -1 - s.feature[n, OFFSET]
    s.tab[place] = FREE
    set_poses(s, r.y)


@internal
def bend_on(s, r, b, n, place, held):
    """u'' with the accelerations that a piece gives, a time after t1 on straight ways."""
    s.tab[place], t1, later, ahead = held
    for c in range(r.y.size):
        b.y2[c] = r.y[c] + (later * r.yd[c] if c < s.n_q else 0.0)
    evaluate(s, t1 + later, b.y2, b.K[1])
    rate = corner_at(s, n, place, t1 + later)[1]
    for c in range(r.y.size):
        b.y2[c] += ahead * b.K[1, c]
    set_poses(s, b.y2)
    return (corner_at(s, n, place, t1 + later + ahead)[1] - rate) / ahead


@internal
def released(s, r, n, t1):
    """Hold again what was left free on a corner, once it has gone away from it; how many."""
    held = 0
    for k in range(s.feature[n, HELD_FROM], s.feature[n, HELD_TO]):
        o, place = s.feature[n, OFFSET], s.held[k]
        if s.tab[place] != FREE or not sensed(s.tab, o, place):
            continue
        u, _, size = corner_at(s, n, place, t1)
        now = piece_at(s.tab, o, place, u)
        s.tab[place] = now
        least, most = ends_of(s.tab, o, place)
        if min(u - least, most - u) <= max(r.chatter[n, FAR], NEAR * size):
            s.tab[place] = FREE
        else:
            held += 1
            r.chatter[n, FAR] = 0.0
    return held
