"""trsim status: how far a sweep is."""

from pathlib import Path

import click

from trsim.cli.frame import Answer, framed

SHOWN = 20  # failed cases that are told one by one


@click.command("status")
@click.argument("folder", type=click.Path())
@framed
def command(answer: Answer, folder: str) -> None:
    """Say how far the sweep in FOLDER is: cases by status, those that failed, the time left."""
    from trsim.sweeps.ledger import counts, in_a_line
    from trsim.sweeps.study import MISSING, study

    found = study(Path(folder))
    told = counts(case.status for case in found.cases)
    bad = [case for case in found.cases if case.failed]
    changed = [case for case in found.cases if case.changed]
    walls = [case.entry.wall for case in found.cases if case.entry and case.entry.wall]
    mean = sum(walls) / len(walls) if walls else None
    answer.data |= {
        "folder": folder,
        "source": found.source,
        "cases": len(found.cases),
        "counts": told,
        "failed": [{"case": c.name, "status": c.status, "reason": c.reason} for c in bad],
        "wall_of_a_case": mean,
        "chosen": list(found.chosen),
    }
    said = ", ".join(f"{n} {status}" for status, n in told.items())
    answer.put(f"{folder}: {len(found.cases)} cases of {found.source}: {said}")
    if told.get(MISSING) and mean:
        about = "at most about" if found.adaptive else "about"
        answer.put(f"missing: {about} {told[MISSING] * mean:.0f} s of one processor")
    for text in found.chosen:
        answer.put(text)
    for case in changed[:SHOWN]:
        answer.put(f"{case.name}: {case.reason}")
    for case in bad[:SHOWN]:
        answer.put(f"{case.name}: {case.status}: {in_a_line(case.reason)[:300]}")
    if len(bad) > SHOWN:
        answer.put(f"... and {len(bad) - SHOWN} more, in {Path(folder) / 'index.csv'}")
