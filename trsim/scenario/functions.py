"""What stands in functions of a scenario, in words: functions of expressions, keys of tables."""

from collections.abc import Iterator

from trsim.expressions import FUNCTIONS
from trsim.varying import ENDS, INTERPOLATIONS, OUTSIDE, TABLE_KEYS

S = "s = (x - x0)/(x1 - x0), cut to 0..1"
CALLS = {
    "min": ("a, b, ...", "the smallest of some numbers"),
    "max": ("a, b, ...", "the largest of some numbers"),
    "abs": ("x", "the absolute value of x"),
    "sqrt": ("x", "the square root; there is none of a number below zero"),
    "sin": ("x", "the sine of an angle in rad"),
    "cos": ("x", "the cosine of an angle in rad"),
    "tan": ("x", "the tangent of an angle in rad"),
    "asin": (
        "x",
        "the angle, rad, whose sine is x; a run ends, with a message, if x is outside -1 to 1",
    ),
    "acos": (
        "x",
        "the angle, rad, whose cosine is x; a run ends, with a message, if x is outside -1 to 1",
    ),
    "atan2": ("y, x", "the angle, rad, of the direction (x, y), from -pi to pi"),
    "floor": ("x", "the largest whole number that is not above x"),
    "sign": ("x", "-1, 0 or 1 for x below, at or above zero"),
    "exp": ("x", "e to the power of x"),
    "log": ("x", "the natural logarithm; there is none of zero or of a number below zero"),
    "step": ("x, x0, h0, x1, h1", f"from h0 at x0 to h1 at x1 by 3 s^2 - 2 s^3, {S}"),
    "step5": ("x, x0, h0, x1, h1", f"from h0 at x0 to h1 at x1 by 10 s^3 - 15 s^4 + 6 s^5, {S}"),
    "havsin": ("x, x0, h0, x1, h1", f"from h0 at x0 to h1 at x1 by (1 - cos(pi s))/2, {S}"),
    "smoothstep": ("x", "3 x^2 - 2 x^3, with x cut to 0..1"),
}
OF_TABLES = {
    "table": "rows [x, y] instead of an expression, x rising, or the name of a CSV file; the first "
    'row may hold titles with units: ["s [mm]", "force [N]"]',
    "of": "what x is: t, a sensor, or the rate of one; t unless given",
    "units": "units of x and y, [mm, N], if the titles do not give them; SI unless given",
    "interpolation": "between rows: akima (smooth, each piece from a few neighbouring rows), "
    "linear, or spline (cubic, with a continuous second derivative); akima "
    "unless given",
    "outside": "before the first and after the last row: hold (their values), extend (the curve "
    "continues) or error (the run ends); hold unless given",
    "ends": "the same in older words: hold, extrapolate, refuse",
}
VALUES = {"interpolation": INTERPOLATIONS, "outside": tuple(OUTSIDE), "ends": ENDS}


def functions() -> Iterator[dict[str, str]]:
    """Word, how it is written and what it means, of every function and every key of tables."""
    for word in FUNCTIONS:
        arguments, meaning = CALLS[word]
        yield {"word": word, "written": f"{word}({arguments})", "meaning": meaning}
    for key in TABLE_KEYS:
        more = "" if key == "table" else f", {key}: ..."
        yield {"word": key, "written": f"{{table: [[x, y], ...]{more}}}", "meaning": OF_TABLES[key]}
