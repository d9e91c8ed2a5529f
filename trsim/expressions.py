"""Expressions a scenario may contain: parsed by Python's grammar, read by a whitelist.

    + - * / **   < <= > >= == !=   numbers, names, dotted names of sensors, the functions below

A parsed expression is nested tuples:

    ("number", 2.0)   ("name", "B.angle")   ("call", "sin", (node, ...))
    ("unary", "-", node)   ("binary", "+", left, right)

Nothing is ever executed: `evaluate` walks the tuples.  A comparison is 1 or 0.

    smoothstep(s)                3 s^2 - 2 s^3,               s clipped to 0..1
    step(x, x0, h0, x1, h1)      h0 + (h1 - h0) smoothstep((x - x0)/(x1 - x0))
    step5(x, x0, h0, x1, h1)     the same with 10 s^3 - 15 s^4 + 6 s^5
    havsin(x, x0, h0, x1, h1)    the same with (1 - cos(pi s))/2
"""

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Mapping

from trsim.errors import ScenarioError, described, known

Node = tuple
LONGEST = 1000  # characters
DEEPEST = 40  # nested operations
OF_SWEEPS = "lin(a, b, n) and log(a, b, n) are values of a sweep: `trsim sweep` takes them."

_CHARACTERS = re.compile(r"[A-Za-z0-9_.,()+\-*/<>=!\s]*")

_WITH_UNIT = re.compile(r"(?<![\w.])[0-9.]+(?:[eE][+-]?[0-9]+)? +[A-Za-z][\w*/]*")

NOTHING, SOME = 37.0, 2.0  # exp(-37) = 8.5e-17, less than the rounding of 1; exp(-2) = 0.14
LOW = 5  # degree of a polynomial that has nothing short between two corners
EDGES = (-NOTHING, -SOME, SOME, NOTHING)  # u of exp(u) at which it has corners: laws/operations.py


def _clipped(s: float) -> float:
    return min(max(s, 0.0), 1.0)


def _smoothstep(s: float) -> float:
    s = _clipped(s)
    return s * s * (3.0 - 2.0 * s)


def _step(x: float, x0: float, h0: float, x1: float, h1: float) -> float:
    return h0 + (h1 - h0) * _smoothstep((x - x0) / (x1 - x0))


def _step5(x: float, x0: float, h0: float, x1: float, h1: float) -> float:
    s = _clipped((x - x0) / (x1 - x0))
    return h0 + (h1 - h0) * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)


def _sign(x: float) -> float:
    return float((x > 0.0) - (x < 0.0))


def _havsin(x: float, x0: float, h0: float, x1: float, h1: float) -> float:
    return h0 + (h1 - h0) * 0.5 * (1.0 - math.cos(math.pi * _clipped((x - x0) / (x1 - x0))))


STEPS = ("step", "step5", "havsin")

# word -> function, fewest arguments, most arguments
FUNCTIONS: dict[str, tuple[Callable[..., float], int, int]] = {
    "min": (min, 2, 50),
    "max": (max, 2, 50),
    "abs": (abs, 1, 1),
    "sqrt": (math.sqrt, 1, 1),
    "sin": (math.sin, 1, 1),
    "cos": (math.cos, 1, 1),
    "tan": (math.tan, 1, 1),
    "asin": (math.asin, 1, 1),
    "acos": (math.acos, 1, 1),
    "atan2": (math.atan2, 2, 2),
    "floor": (math.floor, 1, 1),
    "sign": (_sign, 1, 1),
    "exp": (math.exp, 1, 1),
    "log": (math.log, 1, 1),
    "step": (_step, 5, 5),
    "step5": (_step5, 5, 5),
    "havsin": (_havsin, 5, 5),
    "smoothstep": (_smoothstep, 1, 1),
}

# functions by whose words entries may be called all the same: one is a call, the other is not
ALSO_NAMES = frozenset({"floor", "sign"})

# sign -> what Python's grammar calls it, function
_BINARY: dict[str, tuple[type, Callable[[float, float], float]]] = {
    "+": (ast.Add, operator.add),
    "-": (ast.Sub, operator.sub),
    "*": (ast.Mult, operator.mul),
    "/": (ast.Div, operator.truediv),
    "**": (ast.Pow, math.pow),  # float ** float would turn a negative base into a complex number
    "<": (ast.Lt, operator.lt),
    "<=": (ast.LtE, operator.le),
    ">": (ast.Gt, operator.gt),
    ">=": (ast.GtE, operator.ge),
    "==": (ast.Eq, operator.eq),
    "!=": (ast.NotEq, operator.ne),
}
OPERATORS = {sign: function for sign, (_, function) in _BINARY.items()}
_SIGNS = {kind: sign for sign, (kind, _) in _BINARY.items()}
BINDS = {"+": 1, "-": 1, "*": 2, "/": 2, "**": 4}  # more strongly than comparisons
COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")

_REFUSED: dict[type, str] = {
    ast.And: "'and': multiply comparisons, or use min",
    ast.Or: "'or': add comparisons, or use max",
    ast.Not: "'not': write 1 - x",
    ast.IfExp: "'if': multiply by a comparison, or use step",
    ast.Lambda: "'lambda'",
    ast.Mod: "'%'",
    ast.FloorDiv: "'//'",
    ast.Tuple: "a comma outside a function (a decimal point is '.')",
}

ALLOWED = (
    "Allowed: + - * / **, comparisons, numbers, pi, t, parameters, sensors, "
    f"{', '.join(FUNCTIONS)}."
)


def parse(text: str) -> Node:
    """The expression as nested tuples.  Raises ScenarioError for anything not on the list."""
    if len(text) > LONGEST:
        raise ScenarioError(f"expression of {len(text)} characters; at most {LONGEST}")
    end = _CHARACTERS.match(text).end()  # type: ignore[union-attr]
    if end < len(text):
        hint = "A power is written x**2." if text[end] == "^" else ALLOWED
        raise ScenarioError(f"{text[end]!r} cannot stand in an expression", hint)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(" ".join(text.split()), mode="eval")
    except SyntaxError as error:
        reason = (error.msg or "").split(". Perhaps")[0]
        hint = ALLOWED
        if re.match(r"\s*(lin|log)\s*\(", text):
            hint = OF_SWEEPS
        elif re.search(r"[0-9],[0-9]", text):
            hint = "A decimal point is '.'"
        elif found := _WITH_UNIT.search(text):
            hint = (
                f"A unit cannot stand inside an expression: write {found[0]!r} in SI, or as a "
                f"parameter, `parameters: {{x: {found[0]}}}`, and x here."
            )
        raise ScenarioError(f"not an expression: {described(text)} ({reason})", hint) from None
    except (ValueError, MemoryError, RecursionError):
        raise ScenarioError("expression nested too deeply", ALLOWED) from None
    node = _read(tree.body, 0)
    substitute(node, {})  # a constant part that has no value is refused here, 9**9**9 for one
    return node


def _read(tree: ast.AST, depth: int) -> Node:
    if depth > DEEPEST:
        raise ScenarioError(f"expression nested more than {DEEPEST} deep")
    depth += 1
    match tree:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return ("number", _finite(value))
        case ast.Name() | ast.Attribute():
            return ("name", _name(tree))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return ("unary", "-", _read(operand, depth))
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _read(operand, depth)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _SIGNS:
            return ("binary", _SIGNS[type(op)], _read(left, depth), _read(right, depth))
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _SIGNS:
            return ("binary", _SIGNS[type(op)], _read(left, depth), _read(right, depth))
        case ast.Compare(ops=[_, _, *_]):
            raise ScenarioError("comparison of three", "Write (a < b)*(b < c).")
        case ast.Call(func=ast.Name(id=word), args=arguments, keywords=[]):
            _check_call(word, len(arguments))
            return ("call", word, tuple(_read(argument, depth) for argument in arguments))
        case ast.Call():
            raise ScenarioError("only the listed functions can be called, by position", ALLOWED)
    kind = getattr(tree, "op", tree)
    refused = _REFUSED.get(type(tree)) or _REFUSED.get(type(kind)) or f"'{ast.unparse(tree)}'"
    raise ScenarioError(f"not allowed in an expression: {refused}", ALLOWED)


def _check_call(word: str, n: int) -> None:
    if word not in FUNCTIONS:
        hint = OF_SWEEPS if word == "lin" else known(word, FUNCTIONS)
        raise ScenarioError(f"no function named {described(word)}", hint)
    _, fewest, most = FUNCTIONS[word]
    if not fewest <= n <= most:
        wanted = str(fewest) if fewest == most else f"{fewest} or more"
        raise ScenarioError(f"{word} takes {wanted} argument{'s' * (wanted != '1')}, got {n}")


def _name(tree: ast.AST) -> str:
    """`B` or `B.angle`; a dot may follow a name only."""
    parts = []
    while isinstance(tree, ast.Attribute):
        parts.append(tree.attr)
        tree = tree.value
    if not isinstance(tree, ast.Name):
        raise ScenarioError("a dot may follow a name only", ALLOWED)
    parts.append(tree.id)
    name = ".".join(reversed(parts))
    if any(part.startswith("__") for part in parts):
        raise ScenarioError(f"not a name: {described(name)}", ALLOWED)
    if name in FUNCTIONS and name not in ALSO_NAMES:
        raise ScenarioError(f"{name} is a function: write {name}(...)")
    return name


def parts(node: Node) -> tuple[Node, ...]:
    """The expressions that a function or an operator is applied to."""
    match node:
        case ("call", _, arguments):
            return arguments
        case ("unary", _, operand):
            return (operand,)
        case ("binary", _, left, right):
            return left, right
    return ()


def rebuilt(node: Node, change: Callable[[Node], Node]) -> Node:
    """The expression with each of its parts changed."""
    match node:
        case ("call", word, arguments):
            return ("call", word, tuple(map(change, arguments)))
        case ("unary" | "binary" as kind, sign, *operands):
            return (kind, sign, *map(change, operands))
    return node


def written(node: Node, within: int = 0) -> str:
    """An expression as a user would write it.

    within: how strongly what it stands in binds, see BINDS.
    """
    match node:
        case ("number", value):
            text, binds = f"{value:.10g}", 5 if value >= 0.0 else 3
        case ("name", name):
            return str(name)
        case ("call", word, arguments):
            return f"{word}({', '.join(map(written, arguments))})"
        case ("unary", sign, operand):
            text, binds = sign + written(operand, 3), 3
        case ("binary", sign, left, right):
            binds = BINDS.get(sign, 0)
            first = sign == "**" or binds == 0
            between = sign if sign == "**" else f" {sign} " if binds < 2 else sign
            text = f"{written(left, binds + first)}{between}{written(right, binds + 1)}"
    return f"({text})" if binds < within else text


def names(node: Node) -> set[str]:
    """All names in an expression, `t` and `pi` among them."""
    return {node[1]} if node[0] == "name" else set().union(*map(names, parts(node)))


def degree(node: Node) -> float:
    """The degree of the polynomials in its names that an expression consists of between its
    corners; infinite where it is something else."""
    match node:
        case ("number", _):
            return 0
        case ("name", name):
            return 0 if name == "pi" else 1
        case ("unary", _, operand):
            return degree(operand)
        case ("binary", "+" | "-", left, right):
            return max(degree(left), degree(right))
        case ("binary", "*", left, right):
            return degree(left) + degree(right)
        case ("binary", "/", left, right):
            return degree(left) if degree(right) == 0 else math.inf
        case ("binary", "**", left, ("number", power)) if power >= 0 and power == int(power):
            return power * degree(left) if power > 0 else 0
        case ("binary", sign, left, right) if sign != "**":  # a comparison
            return 0 if max(degree(left), degree(right)) < math.inf else math.inf
        case ("call", "min" | "max" | "abs", arguments):
            return max(map(degree, arguments))
        case ("call", "floor" | "sign", (x,)):
            return 0 if degree(x) < math.inf else math.inf
        case ("call", "smoothstep", (x,)):
            return 3 * degree(x)
        case ("call", "step" | "step5" as word, (x, *ends)) if not any(map(degree, ends)):
            return (3 if word == "step" else 5) * degree(x)
    return math.inf


def renamed(node: Node, names: Mapping[str, str]) -> Node:
    """The expression with other names for those in `names`; of `B.angle` what counts is B."""
    if node[0] == "name":
        first, dot, rest = node[1].partition(".")
        return ("name", names.get(first, first) + dot + rest)
    return rebuilt(node, lambda part: renamed(part, names))


def substitute(node: Node, values: Mapping[str, float]) -> Node:
    """The expression with numbers for the names in `values` and for pi; constant parts folded."""
    match node:
        case ("name", name) if name in values or name == "pi":
            return ("number", float(values.get(name, math.pi)))
        case ("name" | "number", _):
            return node
    new = rebuilt(node, lambda part: substitute(part, values))
    if new[1] in STEPS and new[2][1] == new[2][3]:
        raise ScenarioError(f"{new[1]} from x0 to x1 = x0", "A jump needs x1 other than x0.")
    constant = all(part[0] == "number" for part in parts(new))
    if constant:
        return ("number", evaluate(new, {}))
    return haversine(*new[2]) if new[:2] == ("call", "havsin") else new


def haversine(x: Node, x0: Node, h0: Node, x1: Node, h1: Node) -> Node:
    """A step by a haversine, of simpler operations; its ends are corners of min and max."""

    def binary(sign: str, a: Node, b: Node) -> Node:
        return ("binary", sign, a, b)

    zero, one, half = ("number", 0.0), ("number", 1.0), ("number", 0.5)
    part = binary("/", binary("-", x, x0), binary("-", x1, x0))
    part = ("call", "min", (("call", "max", (part, zero)), one))
    wave = ("call", "cos", (binary("*", ("number", math.pi), part),))
    rise = binary("*", binary("-", one, wave), half)
    return binary("+", h0, binary("*", binary("-", h1, h0), rise))


def evaluate(node: Node, values: Mapping[str, float]) -> float:
    """The number an expression stands for.  No value, or none that is finite, is an error."""
    match node:
        case ("number", value):
            return value
        case ("name", name):
            if name in values:
                return float(values[name])
            if name == "pi":
                return math.pi
            raise ScenarioError(f"no value for {described(name)}", known(name, values))
        case ("unary", _, operand):
            return -evaluate(operand, values)
        case ("call", word, nodes):
            function, arguments = FUNCTIONS[word][0], [evaluate(a, values) for a in nodes]
            shown = f"{word}({', '.join(f'{a:g}' for a in arguments)})"
        case ("binary", sign, left, right):
            function, arguments = OPERATORS[sign], [evaluate(left, values), evaluate(right, values)]
            shown = f"{arguments[0]:g} {sign} {arguments[1]:g}"
    try:
        return _finite(function(*arguments))
    except (ArithmeticError, ValueError):
        raise ScenarioError(f"{shown} has no finite value") from None


def _finite(value: float) -> float:
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ScenarioError("a number in an expression is too large")
    return number
