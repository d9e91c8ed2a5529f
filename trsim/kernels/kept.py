"""The folder of machine code: what is loaded from it runs, so only the user may write there.

It is trsim/code below $XDG_CACHE_HOME, if that is an absolute path, else below ~/.cache.  Files are
looked at by the handles they are read through, never by name alone: an ordinary file of the user's,
in a folder of the user's, and neither can be written by anybody else.

    of which        owner          may not be written by
    cache folder    user or root   everybody, unless it is sticky like /tmp
    trsim, code     user           anybody else
    a file          user           anybody else

Where a folder does not fit, a private one takes its place until this process ends; its children
find it by the same variable.
"""

import atexit
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from trsim import system

PLACE = ("trsim", "code")
ONLY_MINE = 0o700
OTHERS = stat.S_IWGRP | stat.S_IWOTH
_refused: dict[str, str] = {}  # private folders, and why there had to be one


def folder() -> Path:
    """Where machine code is kept."""
    return _settled(os.environ.get("XDG_CACHE_HOME", ""), os.environ.get("HOME", ""))


def refused() -> str:
    """Why the folder that would be used is not; empty where it is."""
    return _refused.get(str(folder()), "")


@cache
def _settled(given: str, _: str) -> Path:
    try:
        home = Path(given if os.path.isabs(given) else os.path.expanduser("~/.cache"))
        why = fault(home)
    except OSError:  # read and written no more than a folder that is full
        why = ""
    if not why:
        return home.joinpath(*PLACE)
    try:
        private = tempfile.mkdtemp(prefix="trsim-")
    except OSError:
        private = os.devnull  # nothing can be read or written below it
    else:
        atexit.register(_removed, private, os.getpid())
    os.environ["XDG_CACHE_HOME"] = private
    made = Path(private).joinpath(*PLACE)
    _refused[str(made)] = why
    return made


def _removed(private: str, number: int) -> None:
    """Remove a private folder at the end of the process that made it."""
    if os.getpid() == number:
        shutil.rmtree(private, ignore_errors=True)


def fault(home: Path) -> str:
    """Why machine code is not loaded from below a cache folder; empty where it may be."""
    if not home.is_absolute():
        return f"{home} is not an absolute path"
    if not home.exists():
        return ""
    found, told = home.stat(), system.TELLS_OWNERS
    if told and found.st_uid not in (system.user(), 0):
        return _of_another(home, found)
    if told and found.st_mode & stat.S_IWOTH and not found.st_mode & stat.S_ISVTX:
        return _open_to_others(home, found)
    for inner in (home / PLACE[0], home.joinpath(*PLACE)):
        if not os.path.lexists(inner):
            return ""
        found = inner.lstat()
        if stat.S_ISLNK(found.st_mode):
            return f"{inner} is a link"
        if told and found.st_uid != system.user():
            return _of_another(inner, found)
        if told and found.st_mode & OTHERS:
            return _open_to_others(inner, found)
    return ""


def _of_another(path: Path, found: os.stat_result) -> str:
    return f"{path} belongs to another user ({found.st_uid})"


def _open_to_others(path: Path, found: os.stat_result) -> str:
    return f"others may write in {path} (mode {stat.S_IMODE(found.st_mode):o})"


def make(path: Path) -> None:
    """Make a folder, and those it is in, for the user alone, unless they are there."""
    if not path.is_dir():
        make(path.parent)
        with suppress(FileExistsError):
            path.mkdir(ONLY_MINE)


def content(path: Path) -> bytes:
    """A file of ours.  Raises OSError where there is none, or one that others may have written."""
    with _opened(path.parent) as place:
        flags = os.O_RDONLY | system.O_NOFOLLOW | system.O_NONBLOCK | system.O_BINARY
        name, within = _from(place, path)
        handle = os.open(name, flags, **within)
        with open(handle, "rb") as file:
            if not (_mine(handle) and stat.S_ISREG(os.fstat(handle).st_mode)):
                raise PermissionError(f"{path} may have been written by others")
            return file.read()


def store(path: Path, parts: list[bytes]) -> None:
    """Write a file of ours; readers see all of it or nothing.  Raises OSError."""
    make(path.parent)
    part = f"{path.name}.{os.getpid()}-{os.urandom(4).hex()}"
    with _opened(path.parent) as place:
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | system.O_NOFOLLOW
        name, within = _from(place, path.with_name(part))
        handle = os.open(name, flags | system.O_BINARY, 0o600, **within)
        try:
            with open(handle, "wb") as file:
                file.writelines(parts)
            os.replace(name, _from(place, path)[0], src_dir_fd=place, dst_dir_fd=place)
        except BaseException:
            with suppress(OSError):
                os.unlink(name, **within)
            raise


def _from(place: int | None, path: Path) -> tuple[str, dict[str, int]]:
    """How a file is named from an open folder, or without one, and the rest of the call."""
    return (str(path), {}) if place is None else (path.name, {"dir_fd": place})


@contextmanager
def _opened(path: Path) -> Iterator[int | None]:
    """A folder that only the user can write in; None where folders are not opened.  Raises OSError
    where it is another's."""
    if not system.OPENS_FOLDERS:
        yield None
        return
    handle = os.open(path, os.O_RDONLY | system.O_DIRECTORY | system.O_NOFOLLOW)
    try:
        if not _mine(handle):
            raise PermissionError(f"others may write in {path}")
        yield handle
    finally:
        os.close(handle)


def _mine(handle: int) -> bool:
    """Whether something belongs to the user, and nobody else can write it."""
    found = os.fstat(handle)
    if not system.TELLS_OWNERS:
        return True
    return found.st_uid == system.user() and not found.st_mode & OTHERS
