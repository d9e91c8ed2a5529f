"""The floor of rounding: what no step can see, and is therefore not asked for.

Where steps fail that should not, the last one is made again from a state whose entries are moved by
their last bit.  What its end differs by

    n_c = |y1_c(y + d) - y1_c(y)|,        |d_c| = eps max(|y_c|, unit of c), signs mixed

is what rounding makes of an entry in such a step, whatever makes it large: unequal masses and
inertias, rows nearly dependent, stiff springs, places far from the origin, matrices of Newton's
method.  Its error estimate cannot tell less.  Where n_c is more than PART of what the tolerance
allows, the entry is weighed by it instead; steps would shrink to nothing otherwise, since shorter
ones look no better.  The largest such excess of a run is told (doubts.py), and the twin of a
certificate keeps above it.

Where Newton's method fails because its increments do not fall below it, there is no end to look
at; radau.py then takes the rounding of the derivative through its matrix.

Where rows nearly depend on each other, d from where they do, rounding is felt 1/d^2 times: what was
seen there is forgotten as soon as they are independent again, or longer steps behind would be
judged by it.

Of steps that fail one is looked at in APART steps, where many fail, and where steps stay short:
after a touch they grow again.  Of those that do not one is looked at in OVERDUE of one length: a
controller that sees errors come may keep steps short enough for none to fail.
"""

from trsim.assemble.equations import evaluate
from trsim.assemble.linear import SOUND
from trsim.elements.contract import SCENE, compiled
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import I1, f8
from trsim.kernels.vectors import clear, copy_to
from trsim.solve.march.calls import NO_STEP, call_step
from trsim.solve.march.norm import weight_of
from trsim.solve.march.record import BUFFERS, RECORD, REJECTED, SETTINGS

EPS = 2.2e-16
APART = 32  # steps between two looks
OVERDUE = 400  # the same where none need fail
MARGIN = 4.0  # between the difference of two steps and what others may be
FADES = 0.5  # of what was seen, every APART steps
STUCK = 5.0  # times a step that fails: none before it was longer, where rounding is to blame
MANY, MOST = 6, 3  # steps to a failure, of one step the second and the first: of sound ones fewer
PART = 0.1  # of the tolerance: below, rounding does not show in the error of a step

#                         scene  record  buffers  setting step h
LOOK_CLOSER = types.void(SCENE, RECORD, BUFFERS, SETTINGS, I1, f8)
call_look_closer = caller(LOOK_CLOSER)


@compiled(LOOK_CLOSER)
def look_closer(s, r, b, setting, method, h):
    """Make the trial step that ended in b.y1 again, a bit beside; fill r.noise, per second."""
    t, counted = r.t, (s.status[1], s.status[2], s.status[3])
    y, yd, y1 = b.rough[0], b.rough[1], b.rough[2]
    copy_to(y, r.y)
    copy_to(yd, r.yd)
    copy_to(y1, b.y1)
    beside(s, r, setting, y, r.y, 1.0)
    evaluate(s, t, r.y, r.yd)
    passing = s.m > 0 and s.status[0] != SOUND
    copy_to(b.K[0], r.yd)
    if call_step(method[0], s, r, b, setting, t, h) < NO_STEP:
        for c in range(y.size):
            y1[c] -= b.y1[c]
        noted(s, r, setting, y1, h)
        r.passing = 1.0 if passing else 0.0
    copy_to(r.y, y)
    copy_to(r.yd, yd)
    s.status[1], s.status[2], s.status[3] = counted


@internal
def beside(s, r, setting, y, moved, sign):
    """moved <- y with every entry moved by its last bit, or to the other side with the sign -1."""
    for c in range(y.size):
        weight = weight_of(s, r, setting.step_error, c)
        unit = 1.0 / (weight * setting.step_error) if weight > 0.0 else 0.0
        d = sign * EPS * max(abs(y[c]), unit)
        # neighbours in ways of their own
        moved[c] = y[c] + (d if (c * c + c // 2) % 4 < 2 else -d)


@internal
def to_look(r, h):
    """Whether a trial that failed is to be looked at: one of many, where steps have been short for
    a while."""
    steps, failed = r.steps - r.looked, r.rejected - r.failed
    second = r.after_rejection == REJECTED
    if steps < APART or (MANY if second else MOST) * failed < steps:
        return False
    return stuck(r, h)


@internal
def overdue(r, h):
    """Whether a trial that did not fail is to be looked at, and made again."""
    if r.steps - r.looked < OVERDUE or r.after_rejection > 0:
        return False
    return stuck(r, h)


@internal
def stuck(r, h):
    """Whether no step was much longer than h since it was last asked; steps, failures and the
    longest step are counted again from here."""
    told = r.longest <= STUCK * h
    r.looked, r.failed, r.longest = r.steps, r.rejected, 0.0
    return told


@internal
def jitter(s, r, b, setting, f, g):
    """f <- f(y + d) + f(y - d) - 2 f(y) at the state of the record: of the derivatives only
    rounding is left; g: scratch."""
    t = r.t
    counted = (s.status[1], s.status[2], s.status[3])
    beside(s, r, setting, r.y, b.y1, 1.0)
    evaluate(s, t, b.y1, f)
    beside(s, r, setting, r.y, b.y1, -1.0)
    evaluate(s, t, b.y1, g)
    for c in range(f.size):
        f[c] += g[c] - 2.0 * r.yd[c]
    s.status[1], s.status[2], s.status[3] = counted


@internal
def noted(s, r, setting, step, h):
    """Take the changes `step` of a step h for what rounding makes of it."""
    for c in range(r.noise.size):
        r.noise[c] = max(r.noise[c], MARGIN * abs(step[c]) / h)
    largest(s, r, setting)


@internal
def largest(s, r, setting):
    """The largest noise in units of the tolerance per second."""
    r.noisy = 0.0
    for c in range(r.noise.size):
        noisy = r.noise[c] * weight_of(s, r, setting.step_error, c)
        if noisy > r.noisy:
            r.noisy, r.noisy_at = noisy, c


@internal
def blunted(s, r, b, h):
    """Weigh what rounding hides in a step h by the rounding."""
    if r.noisy * h <= PART:
        return
    for c in range(b.weight.size):
        floor = r.noise[c] * h
        if b.weight[c] * floor > PART:
            b.weight[c] = PART / floor


@internal
def remember(s, r, setting, h):
    """Keep the largest excess of rounding over what the tolerance allows of a step; forget noise
    that is not seen again."""
    r.longest = max(r.longest, h)
    if r.noisy == 0.0:
        return
    rounded = r.noisy * h / MARGIN
    if rounded > r.rounded:
        r.rounded, r.rounded_at = rounded, r.noisy_at
        r.rounded_by = r.noise[int(r.noisy_at)] * h / MARGIN
    if r.passing > 0.0 and s.status[0] == SOUND:
        r.noisy = r.passing = 0.0
        clear(r.noise)
        return
    if (r.steps - r.looked) % APART == 0:
        for c in range(r.noise.size):
            r.noise[c] *= FADES
        largest(s, r, setting)
