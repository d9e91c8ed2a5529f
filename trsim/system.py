"""What only some systems have, and what takes its place on the others.

locks of files      none: nobody is kept out
processors allowed  all there are
flags of `os.open`  not asked for
owners, modes       not asked: the folder of a user is his by other means
folders             not opened: files are named by their whole path, and only files are synced
limits of memory    none: `LIMITS_MEMORY` tells
"""

import os
import sys

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]
try:
    import resource
except ImportError:
    resource = None  # type: ignore[assignment]

LOCKS = fcntl is not None  # whether files can be locked
O_DIRECTORY = getattr(os, "O_DIRECTORY", 0)
O_NOFOLLOW = getattr(os, "O_NOFOLLOW", 0)
O_NONBLOCK = getattr(os, "O_NONBLOCK", 0)
O_BINARY = getattr(os, "O_BINARY", 0)  # of Windows, where else ends of lines change on their way
TELLS_OWNERS = hasattr(os, "geteuid")  # whether owner and mode of a file say who may write it
OPENS_FOLDERS = os.open in os.supports_dir_fd  # and names files from there
MEMORY_NOW = "/proc/self/statm"  # pages, of Linux
LIMITS_MEMORY = resource is not None and os.path.exists(MEMORY_NOW)
PR_SET_PDEATHSIG = 1  # of prctl(2)
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3  # of mallopt(3)
KEPT = 1 << 30  # bytes: of larger arrays nothing is kept


def processors() -> int:
    """How many this process may use."""
    allowed = getattr(os, "sched_getaffinity", None)
    return len(allowed(0)) if allowed else os.cpu_count() or 1


def opened(path: str | os.PathLike, flags: int, mode: int = 0o666) -> int:
    """The handle of a file, as of `os.open`: no link is followed, and bytes are as they are."""
    return os.open(path, flags | O_NOFOLLOW | O_BINARY, mode)


def user() -> int:
    """The number of the user, as owner of files."""
    return getattr(os, "geteuid", int)()  # 0, as `stat` has it where there are no such numbers


def lock(handle: int, shared: bool = False) -> None:
    """Lock a file, until it is closed.  Raises OSError, BlockingIOError where it is another's."""
    if fcntl:
        fcntl.flock(handle, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)


def lock_byte(handle: int, place: int, wait: bool) -> None:
    """Lock one byte of a file as this process; raises as `lock` does."""
    if fcntl:
        fcntl.lockf(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB), 1, place)


def beginning(handle: int, size: int) -> bytes:
    """The first bytes of an open file."""
    if hasattr(os, "pread"):
        return os.pread(handle, size, 0)
    os.lseek(handle, 0, os.SEEK_SET)
    return os.read(handle, size)


def lengthen(handle: int, end: int, more: int) -> None:
    """Let a file have room for more bytes behind its end.  Raises OSError."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(handle, end, more)
    else:
        os.write(handle, bytes(more))


def limit_memory(more: int) -> None:
    """Allow the process so many bytes of memory more than it has now."""
    with open(MEMORY_NOW, encoding="ascii") as file:
        has = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (has + more, has + more))


def keep_memory() -> None:
    """Have the C library keep what is freed for the next arrays; glibc alone can.

    Otherwise each large array is memory that the system must find and clear anew.
    """
    if sys.platform == "linux":
        import ctypes

        library = ctypes.CDLL(None)
        if hasattr(library, "mallopt"):
            library.mallopt(M_MMAP_THRESHOLD, KEPT)
            library.mallopt(M_TRIM_THRESHOLD, KEPT)


def end_with_parent() -> None:
    """Have the system end this process with the one that began it; Linux alone can."""
    if sys.platform == "linux":
        import ctypes
        import signal

        parent = os.getppid()
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)
