"""When an expression of t changes its course: at comparisons with t, at the ends of steps.

a t + b > c      at (c - b) / a
step(x, x0, h0, x1, h1), smoothstep(x)      where x, linear in t, is x0 and x1 (0 and 1)
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from trsim.errors import ScenarioError
from trsim.expressions import Node, evaluate

COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")
LINEAR = 1e-9  # relative: what bends more has no single instant


def instants(node: Node) -> set[float]:
    """The times at which an expression changes its course, as far as they depend on t alone."""
    match node:
        case ("call", word, arguments):
            found = set[float]().union(*map(instants, arguments))
            if word in ("step", "step5"):
                ends = (arguments[1], arguments[3])
            elif word == "smoothstep":
                ends = (("number", 0.0), ("number", 1.0))
            else:
                return found
            return found.union(*(crossing(arguments[0], end) for end in ends))
        case ("unary", _, operand):
            return instants(operand)
        case ("binary", sign, left, right):
            found = instants(left) | instants(right)
            return found | crossing(left, right) if sign in COMPARISONS else found
    return set()


def crossing(left: Node, right: Node) -> set[float]:
    """The time at which two expressions, linear in t alone, are equal."""
    try:
        d0, d1, d2 = (evaluate(left, {"t": t}) - evaluate(right, {"t": t}) for t in (0.0, 1.0, 2.0))
    except ScenarioError:  # of sensors, or without a value there
        return set()
    slope = d1 - d0
    if slope == 0.0 or abs(d2 - d1 - slope) > LINEAR * (abs(d0) + abs(d1) + abs(d2)):
        return set()
    return {-d0 / slope}


def shortest_pulse(functions: Iterator[Any], end: float) -> float:
    """The shortest time between two such instants of one function within the run, s; inf for none.

    functions: FunctionSpec.  A step that is no longer cannot pass over a pulse unseen.
    """
    shortest = float("inf")
    for function in functions:
        if function.kind != "expression":
            continue
        times = sorted(t for t in instants(function.node) if 0.0 <= t <= end)
        shortest = min([shortest, *(b - a for a, b in pairwise(times) if b > a)])
    return shortest
