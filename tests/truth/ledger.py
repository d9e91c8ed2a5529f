"""What became of every scene of a commit: a file of lines, taken up again where it was left."""

import hashlib
import json
import os
import signal
import subprocess
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "runs" / "truth"
CHUNK = 5
LIMIT = 300  # s for a scene: one that goes on for ever is a finding, and holds up no other


def commit() -> str:
    """The commit that is checked out."""
    asked = ["git", "-C", str(ROOT), "rev-parse", "HEAD"]
    return subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()  # noqa: S603


def seed(commit: str, family: str, k: int) -> int:
    """Of the k-th scene of a family: drawn anew with every commit."""
    digest = hashlib.sha256(f"{commit} {family} {k}".encode()).hexdigest()
    return int(digest[:8], 16)


def known(file: Path) -> dict[tuple[str, int], dict[str, Any]]:
    """Scenes judged so far; a line that was cut off counts as none."""
    found = {}
    for line in file.read_text().splitlines() if file.exists() else ():
        try:
            one = json.loads(line)
        except ValueError:
            continue
        found[one["family"], one["seed"]] = one
    return found


def judged(scenes: list[tuple[str, int]]) -> list[dict[str, Any]]:
    """In a process of its own."""
    from .trial import cautious

    def late(*_: Any) -> None:
        raise TimeoutError(f"more than {LIMIT} s")

    signal.signal(signal.SIGALRM, late)
    found = []
    for family, seed in scenes:
        signal.alarm(LIMIT)
        found.append(cautious(family, seed).line())
        signal.alarm(0)
    return found


def chunks(left: list[tuple[str, int]]) -> Iterator[list[tuple[str, int]]]:
    for k in range(0, len(left), CHUNK):
        yield left[k : k + CHUNK]


def run(count: int, workers: int, of: str | None = None, names: tuple[str, ...] = ()) -> Path:
    """Judge `count` scenes of each family at a commit; what is known of it is not done again."""
    from .phased import FAMILIES

    at = of or commit()
    file = FOLDER / f"{at[:12]}.jsonl"
    file.parent.mkdir(parents=True, exist_ok=True)
    drawn = [(f, seed(at, f, k)) for k in range(count) for f in names or FAMILIES]
    done = known(file)
    left = [scene for scene in drawn if scene not in done]
    print(f"{len(drawn)} scenes, {len(left)} left; {file}", flush=True)
    begun, n = time.monotonic(), 0
    with ProcessPoolExecutor(workers) as pool, file.open("a") as log:
        jobs = [pool.submit(judged, part) for part in chunks(left)]
        for job in as_completed(jobs):
            for line in job.result():
                log.write(json.dumps(line, default=float) + "\n")
                n += 1
                if line["verdict"] not in ("right", "told"):
                    what = line["what"] or line["why"]
                    print(f"{line['family']} {line['seed']}: {line['verdict']}: {what}", flush=True)
            log.flush()
            os.fsync(log.fileno())
    print(f"{n} scenes in {time.monotonic() - begun:.0f} s", flush=True)
    return file
