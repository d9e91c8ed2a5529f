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
}
