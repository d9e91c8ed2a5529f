"""Which mutations are tried: drawn uniformly over the lines of the rooms where anything can be.

Every line has a number of its own, made of the seed, its file and its text, and those of the
smallest numbers are drawn.  So a change of one line changes nothing about the others, and what is
known of them stays known.
"""

import hashlib
from collections import Counter
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
def lines(root: Path = ROOT) -> dict[str, list[Mutation]]:
    """The mutations of each line that has any, by what names it: its file, text and which one of
    several such it is."""
    found: dict[str, list[Mutation]] = {}
    for file in sources(root):
        data = (root / file).read_bytes()
        texts = data.decode().split("\n")
        of_line: dict[int, list[Mutation]] = {}
        for one in mutations(file, data):
            of_line.setdefault(one.line, []).append(one)
        seen: Counter[str] = Counter()
        for number in sorted(of_line):
            text = texts[number - 1].strip()
            seen[text] += 1
            found[f"{file}\n{text}\n{seen[text]}"] = of_line[number]
    return found


@cache
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
    numbers = {name: number(seed, name) for name in lines(root)}
    order = sorted(numbers, key=lambda name: numbers[name])[:count]
    return [lines(root)[name][numbers[name] % len(lines(root)[name])] for name in order]


def number(seed: str, name: str) -> int:
    """A number like one thrown, always the same for the same words."""
    return int.from_bytes(hashlib.sha256(f"{seed}\n{name}".encode()).digest())
