"""Trees of trsim beside each other: this one, and the state before from git, or a folder's."""

import io
import os
import subprocess
import sys
import tarfile
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from benchmarks.measure import ROOT

KEPT = ROOT / "runs" / "before"  # trees of older commits, with their machine code
# the last commit before work on the speed of sweeps, of four pins and of `auto` began; it runs in
# today's .venv, and sweeps keep numbers there already
BEFORE = "f0e39dd4"
SHORT = 8  # digits of a commit


class Refused(RuntimeError):
    """A tree cannot do what is measured."""

    def __init__(self, tree: "Tree", why: str) -> None:
        super().__init__(f"{tree.name}: {why}")
        self.tree = tree


class Tree(NamedTuple):
    """Sources of trsim, with the Python that runs them."""

    folder: Path
    name: str
    cache: str = ""  # folder of its machine code; empty: the user's

    @property
    def python(self) -> str:
        """Its own interpreter; where it has none, this one."""
        own = self.folder / ".venv" / "bin" / "python"
        return str(own) if own.exists() else sys.executable

    @property
    def variables(self) -> dict[str, str]:
        """What its processes find in their environment."""
        cache = {"XDG_CACHE_HOME": self.cache} if self.cache else {}
        return {"PYTHONPATH": str(self.folder), **cache}

    @property
    def environment(self) -> dict[str, str]:
        return {**os.environ, **self.variables}

    def trsim(self, *words: str) -> list[str]:
        """A command, whatever folder it is called from."""
        return [self.python, "-P", "-m", "trsim", *words]

    def said(self, *words: str) -> str:
        """What a command prints; Refused where it does not succeed."""
        command = self.trsim(*words)
        done = subprocess.run(  # noqa: S603
            command, capture_output=True, text=True, env=self.environment
        )
        if done.returncode:
            raise Refused(self, done.stderr.strip() or f"exit code {done.returncode}")
        return done.stdout


HERE = Tree(ROOT, "this tree")


def there(asked: str) -> Tree:
    """The tree in a folder, or that of a revision; LookupError where git has no such one."""
    folder = Path(asked)
    if (folder / "trsim").is_dir():
        return Tree(folder.resolve(), asked)
    name = revision(asked)
    made = KEPT / name
    if not made.exists():
        made.parent.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(dir=made.parent) as part:  # what is broken off is no tree
            unpack(name, Path(part) / name)
            with suppress(OSError):  # Windows has no links for everybody
                (Path(part) / name / ".venv").symlink_to((ROOT / ".venv").resolve())
            (Path(part) / name).rename(made)
    return Tree(made, name, str(made / ".cache"))


def revision(asked: str) -> str:
    """The commit that is meant, in short."""
    words = ["git", "-C", str(ROOT), "rev-parse", "--verify", "--quiet", f"{asked}^{{commit}}"]
    why = f"{asked} is neither a folder with trsim nor in the history that is here"
    try:
        done = subprocess.run(words, capture_output=True, text=True)  # noqa: S603
    except FileNotFoundError as error:  # there is no git
        raise LookupError(why) from error
    if done.returncode:
        raise LookupError(why)
    return done.stdout.strip()[:SHORT]


def unpack(commit: str, folder: Path, *names: str) -> None:
    """Write the files of a commit, or those named, into a folder."""
    words = ["git", "-C", str(ROOT), "archive", commit, "--", *names]
    packed = subprocess.run(words, check=True, stdout=subprocess.PIPE).stdout  # noqa: S603
    with tarfile.open(fileobj=io.BytesIO(packed)) as tar:
        tar.extractall(folder, filter="data")
