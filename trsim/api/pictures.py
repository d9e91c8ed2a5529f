"""Figures as a notebook shows them, drawn by what draws those of `trsim report`."""

import base64
import tempfile
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import NamedTuple

from trsim.errors import FileError
from trsim.store.target import FIGURE, file_errors, fresh


class Picture(NamedTuple):
    """One figure."""

    name: str
    png: bytes

    def _repr_png_(self) -> bytes:
        return self.png

    def save(self, path: str | Path) -> Path:
        """Write it; nothing but a figure of trsim is replaced."""
        path = Path(path)
        with fresh(path, FIGURE) as unfinished, file_errors(path):
            unfinished.write_bytes(self.png)
        return path


class Pictures(list[Picture]):
    """Figures, one under the other in a notebook."""

    def _repr_html_(self) -> str:
        return "".join(
            f'<img alt="{escape(one.name)}" style="max-width: 100%; display: block" '
            f'src="data:image/png;base64,{base64.b64encode(one.png).decode("ascii")}">'
            for one in self
        )

    def save(self, folder: str | Path) -> list[Path]:
        """Write all of them into a folder, under their names."""
        return [one.save(Path(folder) / f"{one.name}.png") for one in self]


def pictures(
    files: Sequence[Path], words: tuple[str, ...], window: str = "", overlay: tuple[str, ...] = ()
) -> Pictures:
    """The figures of runs, or of the folder of a sweep.  Raises UsageError, FileError."""
    from trsim import report
    from trsim.report.asked import Asked

    try:
        folder = tempfile.TemporaryDirectory(prefix="trsim-")
    except OSError as error:
        raise FileError(f"no folder for figures: {error.strerror or error}") from None
    with folder as name:
        if words or window or overlay:
            asked = Asked(plot=words, window=window, overlay=tuple(overlay))
            made = report.analysed([str(file) for file in files], name, asked).files
        else:
            made = report.report([str(file) for file in files], name)
        drawn = [path for path in made if path.suffix == ".png"]
        return Pictures(Picture(path.stem, path.read_bytes()) for path in drawn)
