"""Curve: a line in a plane of a body, through points, in a file, or by two expressions.

    points       cubic spline through them, its parameter the length of the chords: c'' is
                 continuous; periodic where closed, else c'' = 0 at the ends (natural), or
                 directions of the tangents there (clamped)
    expressions  x(s), y(s), taken as they are

Coordinates are those of a plane of the body: an origin and two axes, as drawn.
"""

from math import inf
from typing import Annotated, Any, ClassVar, NamedTuple

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import core_schema

from trsim import expressions
from trsim.elements.placed import Placed
from trsim.elements.prescribed import rates_along
from trsim.errors import ScenarioError, described
from trsim.fields import Flag, Unit, direction, point, vector
from trsim.laws import functions
from trsim.laws.curves import BEND, PLACES, WEIGHTS
from trsim.units import check_dimension, titled
from trsim.varying import Column

MOST_POINTS = 5000
SAMPLES = 4000  # of a formula; of a spline PER_PIECE for each piece, and no fewer than LEAST
PER_PIECE, LEAST = 16, 1000
CORNERS = {"abs", "min", "max", "step", "smoothstep", "sign", "floor"}  # not smooth: no curvature
SAME = 1e-9  # of the size of a curve: places that are one
SHORT = 1e-6  # of the fastest: a curve that stands still has no tangent
JUMP = 0.05  # of the largest tangent: it changes its way in no step between two samples by more
EXACT = 1e-13  # of its length: error of the length of a piece
LONGEST = 2e4  # of u: a curve that turns so often, or so sharply, is refused


class _Places(Unit):
    """Rows [x, y], of which the first may be titles with units, as in a file."""

    def convert(self, value: Any, context: dict, words: tuple[str, ...] = ()) -> Any:
        if not isinstance(value, list | tuple):
            raise ScenarioError(f"must be rows [x, y], got {described(value)}")
        units, first = ["", ""], 0
        if value and isinstance(value[0], list) and _titles(value[0]):
            units, first = [titled(text)[1] for text in value[0]], 1
            for text in filter(None, units):
                check_dimension(text, self.units)
        rows = []
        for k, row in enumerate(value[first:], start=first):
            if not isinstance(row, list | tuple) or len(row) != 2:
                raise ScenarioError(f"a row is [x, y], got {described(row)}", path=(k,))
            columns = [Column(text, self.units) for text in units]
            found = []
            for c, (column, item) in enumerate(zip(columns, row, strict=True)):
                if not isinstance(item, str | int | float):
                    raise ScenarioError(f"must be a number, got {described(item)}", path=(k, c))
                try:
                    found.append(column.number(item, context.get("parameters") or {}))
                except ScenarioError as error:
                    raise error.at(k, c) from None
            rows.append(tuple(found))
        return tuple(rows)


def _titles(row: list) -> bool:
    texts = [type(item) for item in row] == [str, str]
    return texts and any(text.rstrip().endswith("]") for text in row)


class _Formula(Unit):
    """An expression of s, in SI."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        def convert(value: Any, info: Any) -> Any:
            return self.convert(value, info.context or {})

        return core_schema.with_info_plain_validator_function(convert)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        return {"anyOf": [{"type": "number"}, {"type": "string", "title": "expression of s"}]}

    def convert(self, value: Any, context: dict, words: tuple[str, ...] = ()) -> Any:
        if isinstance(value, tuple):  # read already
            return value
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            what = f"must be an expression of s, got {described(value)}"
            raise ScenarioError(what, "for example `0.1*cos(s)`")
        parameters = {k: v for k, v in (context.get("parameters") or {}).items() if k != "s"}
        node = expressions.substitute(expressions.parse(str(value)), parameters)
        others = sorted(expressions.names(node) - {"s", "pi"})
        if others:
            what = f"a curve depends on s alone, not on '{others[0]}'"
            raise ScenarioError(what, "Parameters of the scenario may stand in it, and pi.")
        if corners := sorted(_corners(node)):
            what = f"'{corners[0]}' has a corner, where a curve has no curvature"
            raise ScenarioError(what, "Take smooth functions, or give points.")
        return expressions.renamed(node, {"s": "t"})


def _corners(node: tuple) -> set[str]:
    """What stands in an expression that is not smooth."""
    own = {node[1]} if node[0] == "call" and node[1] in CORNERS else set()
    if node[0] == "binary" and node[1] in ("<", "<=", ">", ">=", "==", "!="):
        own = {node[1]}
    return own.union(*map(_corners, expressions.parts(node)))


def _pair(value: Any) -> Any:
    """Two directions in the plane of a curve."""
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise ScenarioError("must be two directions, of both ends: [[x, y], [x, y]]")
    return value


Pair2 = tuple[float, float]
Column2 = Annotated[str, Field(min_length=1)]


class Curve(Placed):
    """A plane curve of a body: through points, or by expressions.

    at        origin of its coordinates, as drawn: a position, or the name of a point
    x_axis    direction of its x axis, as drawn
    y_axis    direction of its y axis, made perpendicular to x
    points    points [x, y] it passes through, in its own coordinates
    table     the same, from a CSV file of two columns
    columns   titles of x and y in a file with more columns, such as the recorded path of a point
    x         x as an expression of s, instead of points
    y         y as an expression of s
    range     first and last value of s
    closed    whether it continues from the last point to the first
    tangents  directions at both ends of an open curve through points; without them its curvature is
              zero at the ends
    """

    type: ClassVar[str] = "curve"
    at: point("m") = (0.0, 0.0, 0.0)
    x_axis: vector("-") = (1.0, 0.0, 0.0)
    y_axis: vector("-") = (0.0, 1.0, 0.0)
    points: Annotated[tuple[Pair2, ...], _Places("m")] | None = None
    table: Annotated[tuple[Pair2, ...], _Places("m")] | None = None
    columns: tuple[Column2, Column2] | None = None
    x: Annotated[tuple, _Formula("m")] | None = None
    y: Annotated[tuple, _Formula("m")] | None = None
    range: Annotated[Pair2, Unit("-", "rad", "m")] | None = None
    closed: Flag = False
    tangents: Annotated[tuple[Pair2, Pair2], BeforeValidator(_pair)] | None = None

    @model_validator(mode="after")
    def one_kind(self):
        given = [key for key in ("points", "table", "x") if getattr(self, key) is not None]
        if len(given) != 1:
            found = f"got {' and '.join(given)}" if given else "got none of them"
            what = f"a curve is one of points, a table, or expressions x and y; {found}"
            raise ScenarioError(what, "for example points: [[0, 0], [0.1, 0.02], [0.2, 0]]")
        by_formula = self.x is not None
        for key in ("y", "range"):
            if by_formula != (getattr(self, key) is not None):
                what = f"{key} {'is missing' if by_formula else 'goes with an expression x'}"
                raise ScenarioError(what, "x: 0.1*cos(s), y: 0.1*sin(s), range: [0, 2*pi]", (key,))
        if self.columns and self.table is None:
            raise ScenarioError("columns are those of a table", "table: path.csv", ("columns",))
        if self.range and not self.range[0] < self.range[1]:
            raise ScenarioError("the first s must be less than the last one", "", ("range",))
        if self.tangents and (self.closed or by_formula):
            what = "tangents are those at the ends of an open curve through points"
            raise ScenarioError(what, "leave them out", ("tangents",))
        return self

    @property
    def outline(self):
        """Places it goes through that lie far out, as drawn."""
        if self.x is None:
            return self.outermost(self.points or self.table)
        raw = by_formula(self)
        return self.outermost(raw.at(raw.nodes)[0])


class Sampled(NamedTuple):
    """A curve as numbers for `tab`, and places on it close to each other."""

    numbers: list[float]
    u: Any  # (n)
    place: Any  # (n, 2) m
    tangent: Any  # (n, 2) unit vectors
    bend: Any  # (n) 1/m, positive where it turns left
    length: float  # m
    closed: bool

    @property
    def size(self) -> float:
        """Diagonal of the box around it, m."""
        import numpy as np

        return float(np.linalg.norm(np.ptp(self.place, axis=0)))


class _Raw(NamedTuple):
    """A curve by its own parameter p, as a function that gives (n, 2) c, c', c'', c'''."""

    at: Any
    nodes: Any
    closed: bool
    functions: tuple[list[float], ...] = ()


def sampled(spec: Curve) -> Sampled:
    """The numbers of a curve.  Raises ScenarioError where it has no tangent, or no curvature."""
    import numpy as np

    raw = by_formula(spec) if spec.x is not None else by_points(spec)
    pieces = len(raw.nodes) - 1
    count = SAMPLES if raw.functions else max(PER_PIECE, -(-LEAST // pieces)) * pieces
    p = np.interp(np.linspace(0.0, pieces, count + 1), np.arange(pieces + 1), raw.nodes)
    c, c1, c2, _ = raw.at(p)
    speed = np.linalg.norm(c1, axis=1)
    slow = int(np.argmin(speed))
    if not speed[slow] > SHORT * speed.max():
        what = f"stands still at {named(c[slow])}: it has a tip there, or no length"
        raise ScenarioError(what, "a curve must have a tangent everywhere", ("curve",))
    turning = c1[:, 0] * c2[:, 1] - c1[:, 1] * c2[:, 0]
    scale = max(float(np.max(np.abs(turning) / speed**2)) / BEND, 1.0 / float(np.ptp(raw.nodes)))
    if scale * np.ptp(raw.nodes) > LONGEST:
        where = named(c[int(np.argmax(np.abs(turning) / speed**2))])
        what = f"turns too sharply at {where}: it is all but a corner"
        raise ScenarioError(what, "smooth the points, or take fewer of them", ("curve",))
    nodes, lengths = measured(raw)
    numbers = packed(raw, scale, nodes, lengths)
    u = (p - raw.nodes[0]) * scale
    tangent = c1 / speed[:, None]
    return Sampled(numbers, u, c, tangent, turning / speed**3, lengths[-1], raw.closed)


def named(place: Any) -> str:
    """A place in words."""
    return f"[{place[0]:.6g}, {place[1]:.6g}]"


def by_points(spec: Curve) -> _Raw:
    """A spline through points."""
    import numpy as np
    from scipy.interpolate import CubicSpline

    key = "points" if spec.points is not None else "table"
    given = getattr(spec, key)
    points = np.array(given, float).reshape(-1, 2)
    if len(points) > MOST_POINTS:
        what = f"{len(points)} points, and a curve may have {MOST_POINTS}"
        raise ScenarioError(what, "take every n-th of them", ("curve", key))
    size = float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
    if spec.closed and len(points) and np.linalg.norm(points[-1] - points[0]) > SAME * size:
        points = np.vstack([points, points[:1]])
    least = 4 if spec.closed else 2
    if len(points) < least:
        what = (
            f"{'a closed' if spec.closed else 'an open'} curve needs {least - spec.closed} points"
        )
        raise ScenarioError(what, f"got {len(given)}", ("curve", key))
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    same = int(np.argmin(chords))
    if chords[same] <= SAME * size:
        what = f"two neighbours are one place: {named(points[same])}"
        raise ScenarioError(what, "leave one of them out", ("curve", key, same))
    nodes = np.append(0.0, np.cumsum(chords))
    ends: Any = "periodic" if spec.closed else "natural"
    if spec.closed:
        points[-1] = points[0]
    if spec.tangents:
        for k, one in enumerate(spec.tangents):
            if not any(one):
                raise ScenarioError("a direction must not be zero", "", ("curve", "tangents", k))
        ends = tuple((1, np.array(direction(one))) for one in spec.tangents)
    spline = CubicSpline(nodes, points, bc_type=ends)

    def at(p: Any) -> Any:
        return tuple(spline(p, k) for k in range(4))

    return _Raw(at, nodes, spec.closed)


def by_formula(spec: Curve) -> _Raw:
    """A curve by its expressions; closed where it says so, and then it must be."""
    import numpy as np

    codes = []
    for key in ("x", "y"):
        try:
            codes.append(functions.expression(getattr(spec, key), {}))
        except ValueError as error:
            raise ScenarioError(str(error), path=("curve", key)) from None
    tabs = [np.array(code) for code in codes]

    def at(p: Any) -> Any:
        found = np.stack([rates_along(tab, 0, p) for tab in tabs], axis=1)
        if not np.isfinite(found).all():
            t = p[int(np.argmin(np.isfinite(found).all(axis=(1, 2))))]
            raise ScenarioError(f"has no finite value at s = {t:.6g}", "", ("curve",))
        c, c1, c2 = np.moveaxis(found, 2, 0)
        return c, c1, c2, np.zeros_like(c)

    first, last = spec.range
    p = np.linspace(first, last, SAMPLES + 1)
    c, c1, c2, _ = at(p)
    size, fastest = np.linalg.norm(np.ptp(c, axis=0)), np.linalg.norm(c1, axis=1).max()
    h = np.diff(p)[:, None]
    off = [np.diff(c, axis=0) / h - 0.5 * (c1[1:] + c1[:-1])]
    off += [np.diff(c1, axis=0) - 0.5 * h * (c2[1:] + c2[:-1])]
    jump = np.linalg.norm(off, axis=2).max(axis=0)
    if jump.max() > JUMP * fastest:
        s = p[int(np.argmax(jump))]
        what = f"has a corner at s = {s:.6g}, or changes its way too fast there"
        raise ScenarioError(what, "a curve must have a tangent and a curvature", ("curve",))
    if spec.closed:
        width = last - first
        for k, (one, what) in enumerate(((c, "places"), (c1, "tangents"), (c2, "curvatures"))):
            if np.linalg.norm(one[-1] - one[0]) > 1e-7 * max(size, fastest * width) / width**k:
                hint = "correct `range`, or give `closed: false`"
                raise ScenarioError(f"is not closed: its ends have other {what}", hint, ("curve",))
    return _Raw(at, np.linspace(first, last, 65), spec.closed, tuple(codes))


def measured(raw: _Raw) -> tuple[Any, Any]:
    """Nodes between which the length of the curve is as exact as numbers are, and length there."""
    import numpy as np

    x = np.array([*(-a for a in PLACES[::-1]), *PLACES])
    w = np.array([*WEIGHTS[::-1], *WEIGHTS])

    def lengths(nodes: Any) -> Any:
        half = 0.5 * np.diff(nodes)
        p = 0.5 * (nodes[1:] + nodes[:-1])[:, None] + half[:, None] * x
        speed = np.linalg.norm(raw.at(p.ravel())[1], axis=1).reshape(p.shape)
        return half * (speed @ w)

    nodes = raw.nodes
    own = lengths(nodes)
    for _ in range(8):
        fine = np.sort(np.append(nodes, 0.5 * (nodes[1:] + nodes[:-1])))
        halves = lengths(fine)
        off = np.abs(halves[::2] + halves[1::2] - own) > EXACT * halves.sum()
        if not off.any() or len(nodes) > 20 * MOST_POINTS:
            break
        nodes = np.sort(np.append(nodes, (0.5 * (nodes[1:] + nodes[:-1]))[off]))
        own = lengths(nodes)
    return nodes, np.append(0.0, np.cumsum(own))


def packed(raw: _Raw, scale: float, nodes: Any, lengths: Any) -> list[float]:
    """The numbers of laws/curves.py."""
    import numpy as np

    n = len(nodes)
    head = [float(raw.closed), float(n), 0.0, 0.0, float(nodes[0]), 1.0 / scale]
    u = (nodes - nodes[0]) * scale
    body = [*u.tolist(), *lengths.tolist()]
    if raw.functions:
        x, y = raw.functions
        place = len(head) + len(body)
        head[2:4] = float(place), float(place + len(x))
        return [*head, *body, *x, *y]
    # in the middle of a piece, as the third derivative jumps at its ends
    third = raw.at(0.5 * (nodes[1:] + nodes[:-1]))[3]
    c, c1, c2, _ = (one[:-1] for one in raw.at(nodes))
    rows = np.stack([c, c1 / scale, c2 / (2.0 * scale**2), third / (6.0 * scale**3)], axis=2)
    return [*head, *body, *rows.reshape(-1).tolist()]


# --- the drawing -----------------------------------------------------------------------------


def nearest(curve: Sampled, p: Any) -> tuple[float, float]:
    """u of the place nearest to a point among those sampled, and the distance, m.

    Raises ScenarioError where another piece of the curve is as near: it would not tell which.
    """
    import numpy as np

    away = np.linalg.norm(curve.place - np.array(p), axis=1)
    k = int(np.argmin(away))
    lower = (away <= np.roll(away, 1)) & (away <= np.roll(away, -1))
    step = float(np.linalg.norm(np.diff(curve.place, axis=0), axis=1).max())
    gap = np.abs(curve.u - curve.u[k])
    if curve.closed:
        gap = np.minimum(gap, curve.u[-1] - gap)
    others = lower & (gap > 1.0) & (away < away[k] + max(step, 1e-3 * curve.size))
    if others.any():
        other = curve.place[int(np.flatnonzero(others)[0])]
        raise ScenarioError(
            f"two pieces of the curve are as near to `at` as each other, at "
            f"{named(curve.place[k])} and {named(other)} of its coordinates",
            "draw the mechanism where it is near to one of them",
            ("at",),
        )
    return float(curve.u[k]), float(away[k])


def furthest(curve: Sampled, m: Any) -> float:
    """u of the place furthest along a direction among those sampled."""
    import numpy as np

    return float(curve.u[int(np.argmax(curve.place @ np.array(m)))])


def sharpest(curve: Sampled, side: float) -> tuple[float, Any]:
    """Least radius of curvature on a side (1 left, -1 right), and its place; inf where none."""
    import numpy as np

    bend = side * curve.bend
    k = int(np.argmax(bend))
    return (1.0 / float(bend[k]) if bend[k] > 0.0 else inf), curve.place[k]
