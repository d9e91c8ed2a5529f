"""The fixed list of operators: what may be put in place of a piece of source text.

    comparison   < for <=, > for >=, == for !=, in for not in, is for is not, and back
    direction    < for >, <= for >=, and back
    arithmetic   + for -, * for /, and back; ** and // and % become *
    augmented    the same of +=, -=, *=, /=
    logic        and for or, and back; a condition or its opposite
    number       0 for 1, n + 1 for another whole number, 2 x for another one; True for False
    extreme      min for max, and back; abs(x) and -x become x
    index        x[k] becomes x[k - 1], range(n) becomes range(n - 1)
    statement    a call, an assignment to an entry or an attribute, an augmented one: left out
    flow         break for continue, and back; return for a statement, where nothing is returned

Nothing is done to text: docstrings, messages, annotations, names.
"""

import ast
import builtins
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

COMPARISONS = {
    ast.Lt: ("<=", ">"), ast.LtE: ("<", ">="), ast.Gt: (">=", "<"), ast.GtE: (">", "<="),
    ast.Eq: ("!=",), ast.NotEq: ("==",), ast.In: ("not in",), ast.NotIn: ("in",),
    ast.Is: ("is not",), ast.IsNot: ("is",),
}  # fmt: skip
ARITHMETIC = {
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.Pow: "*",
    ast.FloorDiv: "*", ast.Mod: "*",
}  # fmt: skip
EXTREMES = {"min": "max", "max": "min"}
SOLID = (ast.expr, ast.stmt)  # nodes that know their place


@dataclass(frozen=True, order=True)
class Mutation:
    """One change of one file: bytes start..end of its text become `new`."""

    file: str
    line: int
    start: int
    end: int
    new: str
    operator: str

    def of(self, text: bytes) -> bytes:
        """The text with the change."""
        return text[: self.start] + self.new.encode() + text[self.end :]

    def told(self, text: bytes) -> str:
        """Where it is, the line as it was, and what it became."""
        old = text[self.start : self.end].decode()
        short = [" ".join(part.split())[:60] for part in (old, self.new)]
        return f"{self.file}:{self.line} [{self.operator}] {short[0]!r} -> {short[1]!r}"


class Places:
    """Bytes of a text by line and column, as ast counts them."""

    def __init__(self, text: bytes) -> None:
        self.text, self.starts = text, [0]
        for line in text.splitlines(keepends=True):
            self.starts.append(self.starts[-1] + len(line))

    def of(self, node: ast.AST) -> tuple[int, int]:
        assert isinstance(node, SOLID)
        assert node.end_lineno is not None and node.end_col_offset is not None
        start = self.starts[node.lineno - 1] + node.col_offset
        return start, self.starts[node.end_lineno - 1] + node.end_col_offset

    def source(self, node: ast.AST) -> str:
        start, end = self.of(node)
        return self.text[start:end].decode()

    def between(self, left: ast.AST, right: ast.AST, old: str) -> tuple[int, int] | None:
        """The operator between two operands; None where comments or brackets hide it."""
        start, end = self.of(left)[1], self.of(right)[0]
        gap = self.text[start:end]
        words = old.encode()
        if b"#" in gap or gap.strip(b" \t\r\n()\\") != words:
            return None
        at = start + gap.index(words)
        return at, at + len(words)


SIGNS = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
    ast.In: "in", ast.NotIn: "not in", ast.Is: "is", ast.IsNot: "is not", ast.Add: "+",
    ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**", ast.FloorDiv: "//", ast.Mod: "%",
    ast.And: "and", ast.Or: "or",
}  # fmt: skip


def mutations(file: str, text: bytes) -> list[Mutation]:
    """All mutations of a file, in the order of its text."""
    places, tree = Places(text), ast.parse(text)
    found = []
    for node in solid(tree):
        for start, end, new, operator in (*changes(node, places), *returns(node, places)):
            line = text.count(b"\n", 0, start) + 1
            found.append(Mutation(file, line, start, end, new, operator))
    return sorted(found)


def returns(node: ast.AST, places: Places) -> Iterator[tuple[int, int, str, str]]:
    """A return in place of each statement of a function that returns nothing, but its last."""
    if not isinstance(node, ast.FunctionDef):
        return
    inner = [x for statement in node.body for x in ast.walk(statement)]
    kinds = (ast.FunctionDef, ast.Lambda, ast.Yield, ast.YieldFrom)
    if any(isinstance(x, kinds) or (isinstance(x, ast.Return) and x.value) for x in inner):
        return
    for statement in node.body[1:]:
        yield *places.of(statement), "return", "flow"


def solid(tree: ast.AST) -> Iterator[ast.AST]:
    """What is executed: no annotations, no texts, nothing for type checkers alone."""
    todo = [tree]
    while todo:
        node = todo.pop()
        if isinstance(node, ast.JoinedStr):
            continue
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            continue
        yield node
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns", "type_params"):
                continue
            parts = value if isinstance(value, list) else [value]
            todo += [part for part in parts if isinstance(part, ast.AST)]


def changes(node: ast.AST, places: Places) -> Iterator[tuple[int, int, str, str]]:
    """What may be put in place of a node, or of its operator: (start, end, new, operator)."""
    match node:
        case ast.Compare(left=left, ops=ops, comparators=others):
            operands = [left, *others]
            for a, op, b in zip(operands, ops, others, strict=False):
                kind = COMPARISONS[type(op)]
                if where := places.between(a, b, SIGNS[type(op)]):
                    for new, name in zip(kind, ("comparison", "direction"), strict=False):
                        yield *where, new, name
        case ast.BinOp(left=left, op=op, right=right) if type(op) in ARITHMETIC:
            text = (isinstance(x, ast.Constant) and isinstance(x.value, str | bytes)
                    for x in (left, right))  # fmt: skip
            where = places.between(left, right, SIGNS[type(op)])
            if where and not any(text) and not isinstance(left, ast.JoinedStr):
                yield *where, ARITHMETIC[type(op)], "arithmetic"
        case ast.AugAssign(target=target, op=op, value=value):
            if type(op) in ARITHMETIC and (
                where := places.between(target, value, f"{SIGNS[type(op)]}=")
            ):
                yield *where, f"{ARITHMETIC[type(op)]}=", "augmented"
            yield *places.of(node), "pass", "statement"
        case ast.BoolOp(op=op, values=values):
            new = "or" if isinstance(op, ast.And) else "and"
            for a, b in pairwise(values):
                if where := places.between(a, b, SIGNS[type(op)]):
                    yield *where, new, "logic"
        case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test):
            yield *places.of(test), opposite(test, places), "logic"
        case ast.Constant(value=value) if isinstance(value, bool | int | float):
            yield *places.of(node), other(value), "number"
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            yield *places.of(node), places.source(operand), "extreme"
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            if name in EXTREMES:
                yield *places.of(node.func), EXTREMES[name], "extreme"
            elif name == "range" and arguments:
                end = arguments[min(len(arguments), 2) - 1]
                yield *places.of(end), f"({places.source(end)}) - 1", "index"
            elif name == "abs" and len(arguments) == 1:
                yield *places.of(node), f"({places.source(arguments[0])})", "extreme"
        case ast.Subscript(slice=inside):
            for k in inside.elts if isinstance(inside, ast.Tuple) else [inside]:
                if isinstance(k, ast.Name) and not hasattr(builtins, k.id):  # no list[int]
                    yield *places.of(k), f"{k.id} - 1", "index"
        case ast.Expr(value=ast.Call()):
            yield *places.of(node), "pass", "statement"
        case ast.Assign(targets=targets) if all(
            isinstance(x, ast.Subscript | ast.Attribute) for x in targets
        ):
            yield *places.of(node), "pass", "statement"
        case ast.Break():
            yield *places.of(node), "continue", "flow"
        case ast.Continue():
            yield *places.of(node), "break", "flow"


def opposite(test: ast.expr, places: Places) -> str:
    """A condition that holds where this one does not."""
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        return f"({places.source(test.operand)})"
    return f"(not ({places.source(test)}))"


def other(value: bool | int | float) -> str:
    """Another number in place of one."""
    if isinstance(value, bool):
        return str(not value)
    if isinstance(value, int):
        return {0: "1", 1: "0"}.get(value, str(value + 1))
    return repr(2.0 * value) if value else "1.0"
