"""Mutations that change nothing anybody could see, each looked at: (file, line of text, new)."""

EQUIVALENT: dict[tuple[str, str, str], str] = {
    ("trsim/solve/march/events.py", "for trial in range(2):", "3"): (
        "a fall found is behind `low`, so the second trial always leaves the loop"
    ),
}
