"""A study as trsim.sweeps.study gives it, of runs that were made already."""

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from trsim.store.read import read

_read = cache(read)  # no case is written again, and those of a design have few files


@dataclass(frozen=True)
class Case:
    name: str
    values: dict
    file: Path
    status: str = "done"
    reason: str = ""
    changed: bool = False

    @property
    def there(self):
        return self.file.is_file()

    def run(self):
        return _read(self.file)


@dataclass(frozen=True)
class Study:
    cases: tuple
    keys: tuple = ("joints.B.clearance",)
    units: dict = field(default_factory=lambda: {"joints.B.clearance": "m"})
    method: str = "grid"
    samples: int = 0
    seed: int = 0
    written: dict = field(default_factory=lambda: {"joints.B.clearance": "mm"})


def of_blocks(a, b, keys, samples, file=Path("none.h5")):
    """The cases of Saltelli's design: values (samples, d) of the blocks A and B."""
    blocks = [("A", a), ("B", b)]
    for i in range(len(keys)):
        mixed = a.copy()
        mixed[:, i] = b[:, i]
        blocks.append((f"AB{i + 1}_", mixed))
    cases = tuple(
        Case(f"{name}{k:04d}", dict(zip(keys, row.tolist(), strict=True)), file)
        for name, block in blocks
        for k, row in enumerate(block)
    )
    return Study(cases, tuple(keys), dict.fromkeys(keys, "-"), "sobol", samples, 1)
