"""Mutations that change nothing anybody could see, each looked at: (file, line of text, new)."""

EQUIVALENT: dict[tuple[str, str, str], str] = {
    ("trsim/solve/march/events.py", "for trial in range(2):", "3"): (
        "a fall found is behind `low`, so the second trial always leaves the loop"
    ),
    (
        "trsim/assemble/dense.py",
        "if abs(off) <= 1e-17 * sqrt(abs(A[p, p] * A[q, q])) or abs(off) < 1e-300:",
        "2e-300",
    ): "guards a division against numbers that are next to none",
    (
        "trsim/solve/march/record.py",
        'pole_first: A2 = of("at_poles", 2)  # S at both ends of a part of a step',
        "3",
    ): "a column that nobody reads or writes",
    (
        "trsim/elements/joint_friction.py",
        "entries=filled((x.entry for x in parts), -1), states=filled(states, -1),",
        "1",
    ): "fills what is behind `number`, up to which they are read",
    ("trsim/assemble/onward.py", "for _ in range(STEPS):", "(STEPS) - 1"): (
        "steps that halve what is left end by their own size after some 40; others are idle before"
    ),
    (
        "trsim/solve/diagnose/doubts.py",
        "if energy[0] <= AT_REST * np.max(np.abs(energy[1 : 1 + len(STORED)])):",
        "0",
    ): "the kinetic energy is no smaller than a billionth of itself, unless all are zero",
    (
        "trsim/solve/methods/ggl_tables.py",
        'at_push: A2 = of("lines", 6)  '
        "# minus the derivative of loads against lam: B, but for friction",
        "7",
    ): "a column that nobody reads or writes",
    (
        "trsim/solve/march/complete.py",
        "if method[SEARCH_AT] > 0 or method[CORNERS_AT] > 0:",
        ">=",
    ): (
        "an address is never negative; with neither search nothing is found, and nothing is changed"
    ),
    (
        "trsim/solve/march/record.py",
        "model: Model, n_y: int, stages: int, dense_rows: int, step_rows: int = 0, points: int = 0",
        "1",
    ): "of 1 and of 0 rows in a step the buffer has 1024",
    ("trsim/solve/march/sensed.py", "for k in range(TRIALS):", "(TRIALS) - 1"): (
        "every fourth trial halves: what 199 leave of a step is next to the rounding of its time"
    ),
    (
        "trsim/solve/methods/radau.py",
        "jitter(s, r, b, setting, b.K[F], b.K[F + 1])",
        "-",
    ): "scratch: `guess` fills the rows of W anew before any step reads them",
}
