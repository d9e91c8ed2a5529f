"""Which mutations are tried: drawn uniformly over the lines of the rooms where anything can be."""

import hashlib
import random
from functools import cache
from pathlib import Path

from .operators import Mutation, mutations

ROOT = Path(__file__).parents[2]
ROOMS = ("solve", "laws", "elements", "assemble", "scenario", "store")


def sources(root: Path = ROOT) -> list[str]:
    """Files of the rooms, as they are called from the root."""
    found = [path for room in ROOMS for path in (root / "trsim" / room).rglob("*.py")]
    return sorted(path.relative_to(root).as_posix() for path in found)


@cache
def lines(root: Path = ROOT) -> list[list[Mutation]]:
    """The mutations of each line that has any."""
    found: dict[tuple[str, int], list[Mutation]] = {}
    for file in sources(root):
        for one in mutations(file, (root / file).read_bytes()):
            found.setdefault((file, one.line), []).append(one)
    return [found[place] for place in sorted(found)]


def digest(root: Path = ROOT) -> str:
    """Of everything a verdict depends on: sources, tests and what they read."""
    told = hashlib.sha256()
    for name in ("trsim", "tests", "scenarios", "pyproject.toml"):
        place = root / name
        for path in sorted(place.rglob("*")) if place.is_dir() else [place]:
            if path.suffix in (".py", ".yaml", ".csv", ".json", ".toml"):
                told.update(path.relative_to(root).as_posix().encode() + path.read_bytes())
    return told.hexdigest()[:16]


def drawn(count: int, seed: str, root: Path = ROOT) -> list[Mutation]:
    """The first `count` mutations of a seed: of lines drawn one after another, one each."""
    dice = random.Random(seed)
    order = dice.sample(lines(root), len(lines(root)))
    return [dice.choice(line) for line in order[:count]]
