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
    ("trsim/laws/corners.py", "code, y = POW, ((2.0, 2.0), (0.0, 0.0))", "1.0"): (
        "the rate of an exponent is not read where that is a whole number"
    ),
    (
        "trsim/elements/bend.py",
        "STRAIGHT = 1e-10  "
        "# sine of a bend below which rounding alone says about which axis it bends",
        "2e-10",
    ): "rounding of places is larger than a bend that is in between, and so is what it turns by",
    (
        "trsim/elements/joint.py",
        "along = sum(p * q for p, q in zip(x, a, strict=True))",
        "False",
    ): "both are directions of three numbers",
    (
        "trsim/laws/profiles.py",
        "starts, ways = (np.array(c) for c in zip(*map(beginning, pieces), strict=True))",
        "False",
    ): "every piece has one place and one tangent",
    (
        "trsim/elements/sprung.py",
        "low = min((y for x, y in zip(elastic.x, elastic.y, strict=True) if x >= 0.0), "
        "default=0.0)",
        "1.0",
    ): "what stands for a table without such points is asked only whether it is below zero",
    ("trsim/laws/contact.py", "for k in range(3, 20):", "21"): (
        "the term more is 1e-24 of the sum where the series is used, x <= 1/2"
    ),
    (
        "trsim/assemble/rubbing.py",
        "SETTLED = 1e-12  # the same, where it gets no less",
        "2e-12",
    ): "ends the same contraction as rounding has stopped it, with forces alike in 11 digits",
    ("trsim/assemble/shaky.py", "if len(forms) == 1:", "0"): (
        "of one form there is one direction, of length 1 after every step; the turns end with none"
    ),
    ("trsim/assemble/linear.py", "change, size = 0.0, 0.0", "1.0"): (
        "refines to the end what is refined enough: what follows is below rounding"
    ),
    (
        "trsim/solve/path/between.py",
        "ROUNDING = 1e-13  # of the largest of its kind: differences of places in balance",
        "2e-13",
    ): "leaves out extremes that are beyond what is known by less than balances are off",
    (
        "trsim/solve/path/newton.py",
        "IN_RAMP = 1e-6  # of the ramp: differences of sliding",
        "2e-06",
    ): ("a central difference of a law that is straight over a million times the step"),
    (
        "trsim/solve/diagnose/swings.py",
        "sound = np.abs(value[np.isfinite(value) & (np.abs(value) < 1e299)])",
        "2e+299",
    ): "peaks are 1e300 where nothing was looked at; no run gets as far as 1e299",
    (
        "trsim/solve/diagnose/doubts.py",
        'given = numbers.get("work_of_projection_relative", 0.0)',
        "1.0",
    ): "told only where too much was given, which a run without the number has not",
}
