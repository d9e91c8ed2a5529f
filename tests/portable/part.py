"""What of the suite is tried under every arithmetic, and what of that in `make test`."""

# Everything that asserts numbers of mechanisms: rows, ranks, starts, motions, analyses.  Commands,
# files, sweeps, reports and texts have no arithmetic of their own.
PART = (
    "tests/laws", "tests/assemble", "tests/solve", "tests/analyse", "tests/test_scenarios.py",
)  # fmt: skip
# Rank, elimination, runs with both ways of elimination: next to dense linear algebra, 10 s.  Which
# bodies are hubs, and what they cost, is counted, and has no arithmetic
SMALL = (
    "tests/assemble/test_hubs.py", "tests/assemble/test_rank.py", "tests/solve/test_rounding.py",
    "-k", "not radau and not scipy and not small_mechanisms and not proportion and not have_names",
)  # fmt: skip
