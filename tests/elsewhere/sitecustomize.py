"""Python begins without what a system that is not POSIX lacks.

What Python, numpy and pytest themselves ask for on this system stays: getuid, uname, SIGKILL.
"""

import errno
import fcntl  # for what is asked below; nobody after this finds it
import os
import signal
import sys

MODULES = ("fcntl", "resource", "pwd", "grp", "termios", "tty", "pty", "readline", "syslog")
OF_OS = (
    *("O_DIRECTORY", "O_NOFOLLOW", "O_NONBLOCK", "O_PATH", "O_CLOEXEC", "O_SYNC", "O_NOCTTY"),
    *("fork", "forkpty", "register_at_fork", "posix_spawn", "posix_spawnp", "killpg", "setsid"),
    *("setpgid", "getpgid", "getpgrp", "setpgrp", "nice", "getpriority", "setpriority"),
    *("geteuid", "getgid", "getegid", "getgroups", "getresuid", "chown", "fchown"),
    *("lchown", "fchmod", "fchdir", "chroot", "mkfifo", "mknod", "statvfs", "fstatvfs"),
    *("pread", "pwrite", "preadv", "pwritev", "posix_fallocate", "posix_fadvise", "sendfile"),
    *("sched_getaffinity", "sched_setaffinity", "sched_yield", "sysconf", "confstr"),
    *("getloadavg", "ttyname", "ctermid", "openpty", "lockf", "sync", "fdatasync", "pipe2"),
)
OF_SIGNAL = (
    *("SIGALRM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGPIPE", "SIGPROF", "SIGVTALRM"),
    *("SIGXCPU", "SIGXFSZ", "SIGCHLD", "SIGTSTP", "SIGCONT", "SIGSTOP", "alarm", "setitimer"),
    *("getitimer", "pause", "pthread_kill", "pthread_sigmask", "sigwait", "siginterrupt"),
    *("ITIMER_REAL", "ITIMER_PROF", "ITIMER_VIRTUAL"),
)

sys.modules.update(dict.fromkeys(MODULES))  # None: there is no such module
for module, names in ((os, OF_OS), (signal, OF_SIGNAL)):
    for name in names:
        if hasattr(module, name):
            delattr(module, name)
os.supports_fd.clear()
os.supports_dir_fd.clear()
os.O_BINARY = 1 << 30
real = {name: getattr(os, name) for name in ("open", "replace", "unlink", "fsync")}
flags_of, READING = fcntl.fcntl, os.O_RDONLY


def opened(path, flags, mode=0o777, *, dir_fd=None):
    """Files only, by their whole names; of ours none may have its ends of lines changed."""
    if dir_fd is not None:
        raise NotImplementedError("dir_fd unavailable on this platform")
    if not isinstance(path, int) and os.path.isdir(path):
        raise PermissionError(errno.EACCES, "Permission denied", path)
    ours = sys._getframe(1).f_globals.get("__name__", "").startswith("trsim.")
    assert not ours or path == os.devnull or flags & os.O_BINARY, f"{path} is opened as text"
    return real["open"](path, flags & ~os.O_BINARY, mode)


def replaced(source, target, *, src_dir_fd=None, dst_dir_fd=None):
    if src_dir_fd is not None or dst_dir_fd is not None:
        raise NotImplementedError("dir_fd unavailable on this platform")
    return real["replace"](source, target)


def removed(path, *, dir_fd=None):
    if dir_fd is not None:
        raise NotImplementedError("dir_fd unavailable on this platform")
    return real["unlink"](path)


def synced(handle):
    """Of what is open to be written."""
    number = handle if isinstance(handle, int) else handle.fileno()
    if flags_of(number, 3) & 3 == READING:  # F_GETFL, O_ACCMODE
        raise OSError(errno.EBADF, "Bad file descriptor")
    return real["fsync"](number)


os.open, os.replace, os.unlink, os.remove, os.fsync = opened, replaced, removed, removed, synced
os.environ["TRSIM_ELSEWHERE"] = "1"
