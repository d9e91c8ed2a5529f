"""What a command is given to run: a scenario file, or a result file with its scenario inside."""

from pathlib import Path
from typing import Any

from trsim.errors import TrsimError, unreadable

SIGNATURE = b"\x89HDF\r\n\x1a\n"


def is_result(source: str) -> bool:
    """Whether it is HDF5, whatever its name."""
    if unreadable(source) is not None:  # a FIFO would wait for its other end
        return False
    try:
        with open(source, "rb") as file:
            return file.read(8) == SIGNATURE
    except OSError:
        return False


def loaded(source: str, sets: tuple[str, ...]) -> Any:
    """The scenario; that of a result file is the one it was made from, as resolved then."""
    from trsim.scenario.load import load, loads

    if not is_result(source):
        return load(source, sets)
    from trsim.store.read import read

    run = read(source)
    scenario = loads(run.text("scenario/resolved"), sets, f"{source}/scenario/resolved")
    # its source is still what the user wrote: the new result says so too
    scenario._text = run.text("scenario/text")
    names, digests = run.text("scenario/files"), run.text("scenario/files_sha256")
    scenario._tree.files = dict(zip(names, digests, strict=True))
    return scenario


def same(source: str, summary: dict[str, Any]) -> bool | None:
    """Whether a new result holds what the one it was made from holds; None if there is none."""
    from trsim.store.read import read

    try:
        before = read(source).attributes.get("content_sha256") if is_result(source) else None
    except TrsimError:
        return None
    return summary.get("content_sha256") == before if before else None


def stem(source: str) -> str:
    """The name of the result, without its ending: never that of the result it was made from."""
    name = Path(source).name
    if not is_result(source):
        return Path(source).stem
    return name.removesuffix(".part").removesuffix(".h5") + ".again"
