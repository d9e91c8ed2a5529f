"""A result file as its last flush left it, whatever became of its writer.

HDF5 refuses a file whose writer died in normal mode, waits minutes for a dead writer of SWMR mode
whose file was cut short, and refuses one that is shorter than it says.  All three are told in the
superblock, so a reader is shown another one: nobody writes, and the file ends where it ends.

    byte 8 version   11 flags   28..36 end of file   44..48 checksum of all before
"""

import io
import os
import struct
from pathlib import Path
from typing import Any

SIGNATURE = b"\x89HDF\r\n\x1a\n"
SIZE = 48  # bytes of a superblock of version 3 with addresses of 8 bytes
MASK = 0xFFFFFFFF


class Plain(io.RawIOBase):
    """The bytes of a file with a superblock that tells of no writer; zeros where it was cut."""

    def __init__(self, path: Path) -> None:
        self.file = path.open("rb")
        size = os.fstat(self.file.fileno()).st_size
        start = self.file.read(SIZE)
        self.start, self.size = start, size
        if len(start) == SIZE and start.startswith(SIGNATURE) and start[8] in (2, 3):
            stored = struct.unpack_from("<Q", start, 28)[0]
            self.size = max(size, stored) if stored < size + (1 << 40) else size
            body = start[:11] + b"\0" + start[12:28] + struct.pack("<Q", self.size) + start[36:44]
            self.start = body + struct.pack("<I", checksum(body))
        self.at = 0

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self.at = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self.at, os.SEEK_END: self.size}[whence]
        return self.at

    def readinto(self, buffer: Any) -> int:
        view = memoryview(buffer).cast("B")
        view = view[: max(self.size - self.at, 0)]
        self.file.seek(self.at)
        read = self.file.readinto(view) or 0
        view[read:] = bytes(len(view) - read)
        head = self.start[self.at : self.at + len(view)]
        view[: len(head)] = head
        self.at += len(view)
        return len(view)

    def close(self) -> None:
        if hasattr(self, "file"):  # Python closes also what could not be opened
            self.file.close()
        super().close()


def checksum(data: bytes) -> int:
    """Jenkins' lookup3 of at least 12 bytes, their number a multiple of 4, as HDF5 uses it."""
    words = struct.unpack(f"<{len(data) // 4}I", data)
    a = b = c = (0xDEADBEEF + len(data)) & MASK
    while len(words) > 3:
        a, b, c = _mixed(a + words[0] & MASK, b + words[1] & MASK, c + words[2] & MASK)
        words = words[3:]
    last = (*words, 0, 0)
    a, b, c = a + last[0] & MASK, b + last[1] & MASK, c + last[2] & MASK
    for n in (14, 11, 25, 16, 4, 14, 24):
        c = (c ^ b) - _turned(b, n) & MASK
        a, b, c = b, c, a
    return b


def _mixed(a: int, b: int, c: int) -> tuple[int, int, int]:
    for n in (4, 6, 8, 16, 19, 4):
        a = ((a - c) & MASK) ^ _turned(c, n)
        c = c + b & MASK
        a, b, c = b, c, a
    return a, b, c


def _turned(x: int, n: int) -> int:
    return (x << n | x >> (32 - n)) & MASK
