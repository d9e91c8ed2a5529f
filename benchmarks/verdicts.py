"""The study of the thrust reverser: how many readings of its claims have which verdict, its peaks.

What `make paper` does is done first where it is missing; rerun it to resume.
"""

import csv
import subprocess
from collections import Counter
from pathlib import Path

from benchmarks.measure import ROOT, SCENARIOS, trsim
from benchmarks.tables import head, row
from trsim.studies.claim import INDEPENDENT, WORTH

SCENARIO = SCENARIOS / "thrust_reverser" / "paper.yaml"
FOLDER = ROOT / "runs" / "paper"
PAGE = FOLDER / "page"
VERDICTS = ("confirmed", "contradicted", "undetermined")


def command(*words: str) -> None:
    """Raises CalledProcessError where the command fails."""
    subprocess.run(trsim(*words), check=True, stdout=subprocess.PIPE, cwd=ROOT)  # noqa: S603


def lines(path: Path) -> list[list[str]]:
    """Of a table, without its head."""
    text = path.read_text(encoding="utf-8")
    return list(csv.reader(line for line in text.splitlines() if not line.startswith("#")))[1:]


def main() -> None:
    """Print the tables."""
    command("sweep", str(SCENARIO), "-o", str(FOLDER), "-q")
    command("report", "--paper", "thrust-reverser", str(FOLDER), "-o", str(PAGE), "-q")
    readings = lines(PAGE / "claims.csv")
    count = Counter((line[6], line[5]) for line in readings)
    head("agreement", *VERDICTS)
    for worth, told in (WORTH | {INDEPENDENT: "independent of our choices"}).items():
        row(told, *(str(count[worth, verdict]) for verdict in VERDICTS))
    print(f"\n{len({line[0] for line in readings})} claims, {len(readings)} readings\n")
    head("asynchronous", "actuator", "study N", "here N", "difference N", "%", "at mm/s")
    for odd, actuator, *numbers in lines(PAGE / "peaks.csv"):
        study, ours, off, part, speed = map(float, numbers)
        row(odd, actuator, f"{study:.0f}", f"{ours:.0f}", f"{off:.0f}", f"{part:.1f}",
            f"{speed:.0f}")  # fmt: skip


if __name__ == "__main__":
    main()
