"""A number that varies: a constant, a table or an expression, in one flat array.

    constant     0, c
    table        1, variable, n, held, then the table of `tables.cubics`
                                                      variable -1: t, else the sensor's index
    expression   2, n_in, n_op, first slot, result slot, n_in sensors,
                 n_op (code, a, b, watched, held), slots

An expression is straight-line code over slots of three numbers (f, f', f''): t, the sensors
read, one for each operation, which takes slots a and b, and the constants.  Equal parts are
computed once.  All addresses count from the offset o of the function, so functions may be
joined in any order.

A function has corners: the points of its table, and operations with branches (operations.py).  At
each of them `held` says on which piece the function is evaluated, drawn on beyond its ends, and
`watched` whether the time alone decides when the corner is met (BY_TIME) or sensors too
(BY_SENSORS).  FREE of both, a function is evaluated as it is written.

    held of a root     FREE, DRAWN where it is one of what is never negative; so of a power
    held of a table    FREE, BELOW its first point, k: between points k and k + 1, n: above

The slots are scratch space of the evaluation inside `tab` itself, which spares an allocation
per call: `tab` must be writable, and two threads must not evaluate the same array.  Processes may.
"""

import math

from trsim.kernels.lazy import internal
from trsim.laws.operations import (
    ADD,
    ATAN2,
    BINARY,
    CORNERED,
    DIV,
    DRAWN,
    FREE,
    MAX,
    MIN,
    MONOTONE,
    MUL,
    NEG,
    NEVER_NEGATIVE,
    POW,
    QUINTIC,
    SMOOTHSTEP,
    SQRT,
    SUB,
    UNARY,
    branch_at,
    operation,
    operation_rates,
    switching,
)
from trsim.laws.tables import akima, cubics, held_cubic, interval_at

CONSTANT, TABLE, EXPRESSION = 0, 1, 2
VALUE = 1  # of a constant
N_IN, N_OP, SLOTS, RESULT, HEAD = range(1, 6)  # of an expression; HEAD: its first sensor
VARIABLE, POINTS, HELD_OF_TABLE, OF_TABLE = range(1, 5)  # of a table; OF_TABLE: its first point
WATCHED, HELD, WIDTH = 3, 4, 5  # of an operation; WIDTH: the next one
UNWATCHED, BY_TIME, BY_SENSORS = 0, 1, 2


def constant(c):
    """A constant, as numbers for `tab`."""
    return [float(CONSTANT), float(c)]


def table(x, y, variable=-1, ends="hold", interpolation="akima"):
    """A table of t (variable -1) or of sensor number `variable`, as numbers for `tab`."""
    found = cubics(x, y, ends, interpolation)
    return [float(TABLE), float(variable), float(len(x)), FREE, *found]


def _folded(code, a, b):
    """The value of an operation on constants; nan where it has none."""
    try:
        f = operation.python(code, a, b, FREE)
        return math.nan if isinstance(f, complex) else float(f)
    except (ValueError, ArithmeticError):
        return math.nan


class _Code:
    """Straight-line code of an expression while it is being written; a slot is a tuple."""

    def __init__(self, sensors):
        self.sensors = sensors
        self.inputs, self.constants, self.steps = {}, {}, {}

    def number(self, c):
        slot = ("constant", c, math.copysign(1.0, c))  # the sign of zero matters to atan2
        return self.constants.setdefault(slot, slot)

    def name(self, name):
        if name == "t":
            return ("t", 0)
        if name == "pi":
            return self.number(math.pi)
        if name not in self.sensors:
            known = ", ".join(["t", "pi", *self.sensors])
            raise ValueError(f"nothing here is called '{name}'.  Known: {known}.")
        return self.inputs.setdefault(name, ("input", len(self.inputs)))

    def step(self, code, a, b=None):
        """The slot of an operation: folded if constant, shared if it was there before."""
        b = a if b is None else b
        if a[0] == b[0] == "constant":
            f = _folded(code, a[1], b[1])
            if not math.isfinite(f):
                raise ValueError("a constant part of the expression is infinite or undefined")
            return self.number(f)
        if code == DIV and b[:2] == ("constant", 0.0):
            raise ValueError("the expression divides by zero")
        return self.steps.setdefault((code, a, b), ("step", len(self.steps)))

    def watched(self):
        """Whether each operation has corners, and what decides when they are met."""
        sensed = set(self.inputs.values())
        out = []
        for (code, a, b), slot in self.steps.items():
            by_sensors = a in sensed or b in sensed
            if by_sensors:
                sensed.add(slot)
            cornered = code in CORNERED and (a != b or code >= NEG)
            out.append((BY_SENSORS if by_sensors else BY_TIME) if cornered else UNWATCHED)
        return out

    def never_negative(self, slot):
        """Whether a slot is zero or more whatever t and the sensors are, by the way it is made."""
        if slot[0] == "constant":
            return slot[1] >= 0.0
        if slot[0] != "step":
            return False
        code, a, b = list(self.steps)[slot[1]]
        if code in NEVER_NEGATIVE or (code == MUL and a == b):
            return True
        if code == MAX:
            return self.never_negative(a) or self.never_negative(b)
        if code == POW:
            return self.never_negative(a)
        return code in MONOTONE and self.never_negative(a) and self.never_negative(b)

    def drawn(self, code, a, b):
        """Whether an operation is a root or a broken power of what is never negative."""
        broken = code == POW and not (b[0] == "constant" and float(b[1]).is_integer())
        return (broken or code == SQRT) and self.never_negative(a)

    def slot(self, node):
        """The slot of a node of the tree, after writing whatever it needs."""
        kind, word = node[0], node[1]
        if kind == "number":
            return self.number(float(word))
        if kind == "name":
            return self.name(word)
        if kind == "unary":
            a = self.slot(node[2])
            return a if word == "+" else self.step(NEG, a)
        if kind == "binary":
            a, b = self.slot(node[2]), self.slot(node[3])
            if word == "**" and b[:2] == ("constant", 2.0):
                return self.step(MUL, a, a)
            return self.step(BINARY[word], a, b)
        return self.call(word, [self.slot(argument) for argument in node[2]])

    def call(self, name, args):
        """The slot of a function's value; the steps are built from their cores."""
        if name in UNARY and len(args) == 1:
            return self.step(UNARY[name], args[0])
        if name == "atan2" and len(args) == 2:
            return self.step(ATAN2, *args)
        if name in ("min", "max") and len(args) >= 2:
            f = args[0]
            for a in args[1:]:
                f = self.step(MIN if name == "min" else MAX, f, a)
            return f
        if name in ("step", "step5") and len(args) == 5:
            x, x0, h0, x1, h1 = args
            x = self.step(DIV, self.step(SUB, x, x0), self.step(SUB, x1, x0))
            f = self.step(SMOOTHSTEP if name == "step" else QUINTIC, x)
            return self.step(ADD, h0, self.step(MUL, self.step(SUB, h1, h0), f))
        raise ValueError(f"there is no function {name} of {len(args)} arguments")


def expression(node, sensors):
    """An expression, as numbers for `tab`.

    Parameters
    ----------
    node : tuple             tree made by `trsim.expressions.parse`, parameters substituted
    sensors : dict           name of a sensor -> its row of S

    Returns
    -------
    list[float]              the function; a constant if nothing in it varies

    Raises
    ------
    ValueError               unknown name or function, or a constant part such as 1/0
    """
    code = _Code(sensors)
    result = code.slot(node)
    if result[0] == "constant":
        return constant(result[1])
    first = HEAD + len(code.inputs) + WIDTH * len(code.steps)
    place = {("t", 0): first}
    for slots in (code.inputs, code.steps, code.constants):
        for slot in slots.values():
            place[slot] = first + 3 * len(place)
    out = [EXPRESSION, len(code.inputs), len(code.steps), first, place[result]]
    out += [sensors[name] for name in code.inputs]
    for (op, a, b), watched in zip(code.steps, code.watched(), strict=True):
        out += [op, place[a], place[b], watched, DRAWN if code.drawn(op, a, b) else FREE]
    for slot in place:
        out += [slot[1] if slot[0] == "constant" else 0.0, 0.0, 0.0]
    return [float(x) for x in out]


def slots_of(code):
    """How many slots an expression has, as numbers for `tab`."""
    return (len(code) - int(code[SLOTS])) // 3


@internal
def operations(tab, o):
    """How many operations an expression has, where the first of them stands, and its slot."""
    n_in = int(tab[o + N_IN])
    return int(tab[o + N_OP]), o + HEAD + n_in, o + int(tab[o + SLOTS]) + 3 * (1 + n_in)


@internal
def operands(tab, o, p):
    """The code of the operation at p, and its slots a and b."""
    return int(tab[p]), o + int(tab[p + 1]), o + int(tab[p + 2])


@internal
def read(tab, slot):
    """The three numbers of a slot."""
    return tab[slot], tab[slot + 1], tab[slot + 2]


@internal
def write(tab, slot, f):
    """Three numbers into a slot."""
    tab[slot], tab[slot + 1], tab[slot + 2] = f


@internal
def run(tab, o):
    """Value of an expression whose inputs are in their slots."""
    n, p, out = operations(tab, o)
    for _ in range(n):
        code, a, b = operands(tab, o, p)
        tab[out] = operation(code, tab[a], tab[b], tab[p + HELD])
        p += WIDTH
        out += 3
    return tab[o + int(tab[o + RESULT])]


@internal
def run_rates(tab, o):
    """Value and two derivatives of an expression whose inputs are in their slots."""
    n, p, out = operations(tab, o)
    for _ in range(n):
        code, a, b = operands(tab, o, p)
        write(tab, out, operation_rates(code, read(tab, a), read(tab, b), tab[p + HELD]))
        p += WIDTH
        out += 3
    return read(tab, o + int(tab[o + RESULT]))


@internal
def looked_up(tab, o, x):
    """Value and two derivatives of a table at x, on the piece it is held on."""
    held, n = tab[o + HELD_OF_TABLE], int(tab[o + POINTS])
    if held == FREE:
        return akima(tab, o + OF_TABLE, n, x)
    return held_cubic(tab, o + OF_TABLE, n, x, held)


@internal
def inputs(tab, o, t, S):
    """Put t and the sensors into their slots, as values."""
    slot = o + int(tab[o + SLOTS])
    tab[slot] = t
    for i in range(int(tab[o + N_IN])):
        tab[slot + 3 * (i + 1)] = S[int(tab[o + HEAD + i]), 0]


@internal
def hold(tab, o, t, S, which):
    """Hold a function on the pieces it is on at t: those met by time, or those met by sensors.

    Parameters
    ----------
    tab, o, t, S             as in `value`
    which : int              BY_TIME or BY_SENSORS
    """
    if tab[o] == TABLE:
        k = int(tab[o + VARIABLE])
        if (which == BY_TIME) == (k < 0):
            x = t if k < 0 else S[k, 0]
            tab[o + HELD_OF_TABLE] = interval_at(tab, o + OF_TABLE, int(tab[o + POINTS]), x)
    if tab[o] != EXPRESSION:
        return
    inputs(tab, o, t, S)
    n, p, out = operations(tab, o)
    for _ in range(n):
        code, a, b = operands(tab, o, p)
        if tab[p + WATCHED] == which:
            tab[p + HELD] = branch_at(code, switching(code, tab[a], tab[b]))
        tab[out] = operation(code, tab[a], tab[b], tab[p + HELD])
        p += WIDTH
        out += 3


@internal
def value(tab, o, t, S):
    """The number at time t.

    Parameters
    ----------
    tab : (n_tab,)           flat array; the slots of an expression are overwritten
    o : int                  offset of the function
    t : float                time, s
    S : (n_s, 2)             values and rates of the sensors; only values are read

    Returns
    -------
    float
    """
    kind = tab[o]
    if kind == CONSTANT:
        return tab[o + VALUE]
    if kind == TABLE:
        k = int(tab[o + VARIABLE])
        return looked_up(tab, o, t if k < 0 else S[k, 0])[0]
    inputs(tab, o, t, S)
    return run(tab, o)


@internal
def value_and_rate(tab, o, t, S):
    """The number at time t and its total rate in time, through the rates of the sensors.

    Parameters
    ----------
    tab, o, t, S             as in `value`

    Returns
    -------
    (float, float)           f and df/dt
    """
    kind = tab[o]
    if kind == CONSTANT:
        return tab[o + VALUE], 0.0
    if kind == TABLE:
        k = int(tab[o + VARIABLE])
        f, f_x, _ = looked_up(tab, o, t if k < 0 else S[k, 0])
        return f, f_x if k < 0 else f_x * S[k, 1]
    slot = o + int(tab[o + SLOTS])
    write(tab, slot, (t, 1.0, 0.0))
    for i in range(int(tab[o + N_IN])):
        k, slot = int(tab[o + HEAD + i]), slot + 3
        # the second derivative of a sensor is unknown and not asked for
        write(tab, slot, (S[k, 0], S[k, 1], 0.0))
    f, f1, _ = run_rates(tab, o)
    return f, f1


@internal
def motion(tab, o, t):
    """A prescribed motion and its first and second derivative in time.

    Parameters
    ----------
    tab, o, t                as in `value`

    Returns
    -------
    (float, float, float)    f, f', f''; all nan if the function reads a sensor
    """
    kind = tab[o]
    if kind == CONSTANT:
        return tab[o + VALUE], 0.0, 0.0
    if kind == TABLE and tab[o + VARIABLE] < 0.0:
        return looked_up(tab, o, t)
    if kind == TABLE or tab[o + N_IN] > 0.0:
        return math.nan, math.nan, math.nan
    write(tab, o + int(tab[o + SLOTS]), (t, 1.0, 0.0))
    return run_rates(tab, o)
