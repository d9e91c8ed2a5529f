"""What Python's own audit sees: files opened, code run, sockets, processes."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

NETWORK = ("socket.", "urllib.", "http.", "ftplib.", "smtplib.")
PROCESSES = ("subprocess.", "os.system", "os.exec", "os.fork", "os.posix_spawn", "os.spawn", "pty.")

_watches: list[tuple[tuple[str, ...], list[str]]] = []
_hooked = False


def _hook(event: str, arguments: tuple) -> None:
    for events, seen in _watches:
        if event.startswith(events):
            seen.append(f"{event} {arguments!r}")


@contextmanager
def watched(*events: str) -> Iterator[list[str]]:
    """The events that begin with one of these words, as they come."""
    global _hooked
    if not _hooked:  # a hook cannot be taken away again
        sys.addaudithook(_hook)
        _hooked = True
    watch: tuple[tuple[str, ...], list[str]] = (events, [])
    _watches.append(watch)
    try:
        yield watch[1]
    finally:
        _watches.remove(watch)
