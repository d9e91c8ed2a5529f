"""A pendulum let go at rest, as a worker's job without a solver: it does not swing any higher."""

from trsim.sweeps.summary import sent


def run(task, begun):
    """The record of a run whose only channel is the angle: its peak is where it began."""
    begun()
    given = task["resolved"]["parameters"]
    start, unit = float(given["start"]), "rad"
    none = "no channel named 'angel'"
    told = {
        "attributes": {"title": "swing", "status": "done", "reason": ""},
        "rows": 2, "ends": [0.0, 1.0], "units": {"angle": unit}, "sizes": {}, "parts": {},
        "asked": {w: [start, unit] if w == "peak:angle" else [None, none] for w in task["numbers"]},
        "channels": {}, "contacts": {}, "summary": {"time": 1.0, "contacts": []},
    }  # fmt: skip
    kept = sent(told)
    numbers = {word: value for word, (value, _) in told["asked"].items()}
    return {"status": "done", "reason": "", "summary": numbers, **kept}
