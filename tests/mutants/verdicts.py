"""What is known of mutations, in a file that goes with the project: one line of JSON each.

That a test noticed a mutation stands while the source file and the file of that test are the same;
after a change that test is the first to be tried again.  That none did stands while nothing at all
has changed.
"""

import hashlib
import json
import os
import re
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from .drawn import ROOT, digest
from .operators import Mutation

FILE = Path(__file__).parent / "verdicts.jsonl"
KILLED = "killed"

Key = tuple[str, str, str, int, str]


@cache
def sha(file: str, root: Path = ROOT) -> str:
    """Of a file, as it is called from the root; "" where there is none."""
    path = root / file
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16] if path.is_file() else ""


def key(one: Mutation) -> Key:
    return one.file, sha(one.file), one.operator, one.start, one.new


def test_of(by: str) -> str:
    """The file of a test: "" of what did not end, or ended the process."""
    return by.partition("::")[0] if by.startswith("tests/") else ""


@dataclass
class Verdicts:
    """The verdicts that stand; more are added as they come."""

    file: Path = FILE
    known: dict[Key, dict[str, Any]] = field(default_factory=dict)
    lapsed: dict[str, dict[str, Any]] = field(default_factory=dict)  # killed before a change

    def __post_init__(self) -> None:
        """Read the file.  A line that was cut off counts as none."""
        for text in self.file.read_text().splitlines() if self.file.exists() else ():
            try:
                one = json.loads(text)
                at = one["file"], one["source"], one["operator"], one["start"], one["new"]
            except (ValueError, KeyError):
                continue
            if stands(one):
                self.known[at] = one
            if one["verdict"] == KILLED:
                self.lapsed[likeness(one["told"])] = one

    def of(self, one: Mutation) -> dict[str, Any] | None:
        return self.known.get(key(one))

    def before(self, one: Mutation) -> dict[str, Any] | None:
        """What was known of a mutation like this one before its file or its test changed."""
        return self.lapsed.get(likeness(one.told((ROOT / one.file).read_bytes())))

    def add(self, one: Mutation, found: dict[str, Any]) -> None:
        """Keep a verdict, at once."""
        test = test_of(found["by"])
        found = {**found, "source": sha(one.file), "test": test and sha(test), "all": digest()}
        self.known[key(one)] = found
        with self.file.open("a") as log:
            log.write(json.dumps(found) + "\n")
            log.flush()
            os.fsync(log.fileno())

    def tidy(self, wanted: list[Mutation]) -> None:
        """Leave in the file what stands or was known of these mutations, in their order."""
        found = [told for one in wanted if (told := self.of(one) or self.before(one))]
        fresh = self.file.with_suffix(".new")
        fresh.write_text("".join(json.dumps(told) + "\n" for told in found))
        fresh.replace(self.file)


def likeness(told: str) -> str:
    """What tells a mutation when lines have moved: its file, operator, old and new text."""
    return re.sub(r":\d+ ", " ", told, count=1)


def stands(one: dict[str, Any]) -> bool:
    """Whether a verdict still holds; that of another source is found under no key."""
    test = test_of(one["by"])
    if one["verdict"] == KILLED and test:
        return bool(one["test"]) and one["test"] == sha(test)
    return one["verdict"] == KILLED or one["all"] == digest()
