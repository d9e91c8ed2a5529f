"""A run as an animation: a .glb for other programs, and a page that plays it by itself."""

from os import PathLike
from pathlib import Path

from trsim.report.animation.reel import Film
from trsim.store.read import Run


def film(run: Run, magnified: float = 1.0) -> Film:
    """The animation of a run.  Raises UsageError where there is nothing to show."""
    from trsim.report.animation.shoot import shoot

    return shoot(run, magnified)


def section(run: Run, magnified: float = 1.0) -> str:
    """The animation as a part of a page, HTML."""
    from trsim.report.animation.page import part

    return part(film(run, magnified))


def write(
    path: str | PathLike, folder: str | PathLike, magnified: float = 1.0
) -> tuple[list[Path], tuple[str, ...]]:
    """Write animation.glb and animation.html of a result file into a folder.

    magnified: how many times its size the clearance is drawn.  Returns the files and the warnings.
    Raises FileError, UsageError.
    """
    from trsim.report.animation.page import whole
    from trsim.store.read import read
    from trsim.store.target import Kind, file_errors, fresh

    made = film(read(path), magnified)
    glb = Kind("animation of trsim", lambda start: b'"generator":"trsim"' in start)
    page = Kind("page of trsim", lambda start: b'content="trsim"' in start)
    written = []
    for ending, kind, data in (("glb", glb, made.glb), ("html", page, whole(made).encode())):
        target = Path(folder) / f"animation.{ending}"
        with file_errors(target), fresh(target, kind, [path]) as unfinished:
            unfinished.write_bytes(data)
        written.append(target)
    return written, made.warnings
