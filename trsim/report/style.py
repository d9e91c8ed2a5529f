"""The look of all figures: sizes for print, light grid, colours that survive a photocopier."""

import io
import re
import textwrap
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from trsim.arrays import Array
from trsim.errors import FileError, UsageError, unreadable
from trsim.report.defaults import Figure, FigureCanvasAgg, matplotlib
from trsim.report.display import Shown
from trsim.report.looks import DOTS, Looks, inches
from trsim.store.target import FIGURES, file_errors, fresh

CHARACTER = 0.085  # inch: a letter of a title
WIDTH = 6.3  # inch: the text width of an A4 page
DPI = 150
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES = ("-", "--", "-.", ":")
NO_NUMBER = "without a number"  # label of the crosses of `missed`
STRETCHES = 1500  # of a curve: more than the pixels can show
RC: Any = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-4, 5),
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "lines.linewidth": 0.8,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "figure.constrained_layout.h_pad": 0.06,
    "agg.path.chunksize": 10000,
    "svg.hashsalt": "trsim",
    "pdf.fonttype": 42,
}
SLIDES = Looks(size="118", dpi=300)  # smaller, so that letters and lines are larger in it
ABOUT: dict[str, Any] = {
    "png": {"Software": "trsim"},
    "pdf": {"Creator": "trsim", "Producer": None, "CreationDate": None},
    "svg": {"Creator": "trsim", "Date": None},
}
# settings of a style file by which `savefig` lays a figure out itself
LAYING = ("savefig.bbox", "figure.autolayout", "figure.constrained_layout.use")
MANY = 20_000  # points of a curve that stays a picture in a PDF or SVG


class Sheet(NamedTuple):
    """What figures are made as: settings beside RC, colours, kind of file, inches, dots an inch."""

    rc: dict[str, Any] = {}  # noqa: RUF012
    colours: tuple[str, ...] = COLOURS
    form: str = "png"
    size: tuple[float, float | None] | None = None
    dpi: int = DPI
    shots: dict[Path, bytes] = {}  # noqa: RUF012  figures that a page cannot show, as PNG


_sheets = [Sheet()]  # the last one is at work


@contextmanager
def asked(looks: Looks) -> Iterator[Sheet]:
    """Figures are made as asked for.  Raises UsageError, FileError for what cannot be."""
    _sheets.append(sheet(looks))
    try:
        yield _sheets[-1]
    finally:
        _sheets.pop()


def sheet(looks: Looks) -> Sheet:
    rc: dict[str, Any] = {}
    usual = SLIDES if looks.style == "slides" else Looks()
    if looks.style not in ("", "slides"):
        rc = of_file(looks.style)
    dpi = looks.dpi or usual.dpi or DPI
    if not DOTS[0] <= dpi <= DOTS[1]:
        raise UsageError(f"{dpi} dots per inch are no figure", f"Give {DOTS[0]} to {DOTS[1]}.")
    colours = rc["axes.prop_cycle"].by_key().get("color") if "axes.prop_cycle" in rc else None
    return Sheet(
        rc, tuple(colours or COLOURS), looks.form, inches(looks.size or usual.size), dpi, {}
    )


def of_file(name: str) -> dict[str, Any]:
    """The settings of a style file of matplotlib: KEY: VALUE, a line each."""
    path = Path(name)
    if path.suffix != ".mplstyle":
        what = f"no style named '{name}'"
        raise UsageError(what, "Say slides, or name a style file of matplotlib, NAME.mplstyle.")
    if (missing := unreadable(path)) is not None:
        raise missing
    found: dict[str, Any] = {}
    known = set(matplotlib.rcParams)
    for number, line in enumerate(
        path.read_text(encoding="utf-8", errors="replace").split("\n"), 1
    ):
        text = re.sub(r"(^|\s)#.*", "", line).strip()
        key, colon, value = (part.strip() for part in text.partition(":"))
        if not text:
            continue
        if not colon or key not in known or key.startswith("backend"):
            raise FileError(f"{name}:{number}: no setting of a figure: {text[:60]}", file=name)
        try:
            found[key] = matplotlib.RcParams({key: value})[key]
        except ValueError as error:
            raise FileError(f"{name}:{number}: {str(error)[:200]}", file=name) from None
    return found


def look() -> Any:
    """A context in which figures are made and saved."""
    return matplotlib.rc_context(RC | _sheets[-1].rc)


def colour(k: int) -> str:
    colours = _sheets[-1].colours
    return colours[k % len(colours)]


def panels(
    rows: int, columns: int = 1, height: float = 2.0, width: float = WIDTH, *,
    table: bool = False, **options: Any,
) -> tuple[Figure, Any]:  # fmt: skip
    """A figure and its axes, (rows, columns).

    table: of text, which needs its room whatever size is asked for.
    """
    sheet, size = _sheets[-1], (width, rows * height + 0.4)
    if sheet.size and not table:
        size = sheet.size[0], sheet.size[1] or size[1]
    figure = Figure(figsize=size, dpi=sheet.dpi, layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False, **options)


def save(figure: Figure, path: Path) -> Path:
    """Write the picture, without anything that changes from day to day; its name."""
    form = _sheets[-1].form
    path = path.with_suffix(f".{form}")
    as_written(figure)
    with letters_may_lack():
        if form == "pdf":
            shot = io.BytesIO()
            picture(figure, shot)
            _sheets[-1].shots[path] = shot.getvalue()
        if form != "png":
            sharp(figure)
        write(figure, path, form)
    return path


def write(figure: Figure, path: Path, form: str) -> None:
    with file_errors(path), fresh(path, FIGURES[form]) as unfinished:
        if form == "png":
            picture(figure, unfinished)
        else:
            figure.savefig(unfinished, format=form, metadata=ABOUT[form])


def as_written(figure: Figure) -> None:
    """Dollars in titles and names of files are no mathematics; powers at ticks are."""
    ticks = figure.findobj(matplotlib.axis.Tick)
    theirs = {id(text) for tick in ticks for text in (tick.label1, tick.label2)}
    for text in figure.findobj(matplotlib.text.Text):
        if id(text) not in theirs:
            text.set_parse_math(False)


@contextmanager
def letters_may_lack() -> Iterator[None]:
    """Letters that the font has not are boxes, and whoever looks at them needs no warning."""
    with warnings.catch_warnings():
        for text in ("Glyph .* missing", "Matplotlib currently does not support"):
            warnings.filterwarnings("ignore", text)
        yield


def picture(figure: Figure, target: Any) -> None:
    """Write it as PNG: laid out, then drawn once.

    `savefig` would draw a figure with a layout twice, and throw the first picture away.
    """
    layout = figure.get_layout_engine()
    rc: Any = matplotlib.rcParams
    given = rc["savefig.dpi"] != "figure"  # it is laid out for other dots then
    if layout is not None and not given and not any(rc[key] for key in LAYING):
        layout.execute(figure)
        figure.set_layout_engine(None)
    figure.savefig(target, format="png", metadata=ABOUT["png"])
    figure.set_layout_engine(layout)


def sharp(figure: Figure) -> None:
    """Curves as lines, which may be enlarged, unless they have very many points."""
    for line in figure.findobj(matplotlib.lines.Line2D):
        if np.size(line.get_xdata()) < MANY:
            line.set_rasterized(False)


def draw(path: Path, make: Callable[..., Figure], *given: Any, **options: Any) -> Path:
    """Make a figure and write it."""
    with look():
        return save(make(*given, **options), path)


def titled(figure: Figure, runs: list[Shown], text: str) -> None:
    """What is shown, and of which run; a run that did not end well says so."""
    run = runs[0].run
    name = (run.attributes["title"] or run.path.stem) if len(runs) == 1 else ""
    status = run.attributes["status"] if len(runs) == 1 else "done"
    end = "" if status == "done" else f" ({status})"
    wide = int(figure.get_figwidth() / CHARACTER)
    lines = [textwrap.fill(text, wide)] + ([textwrap.fill(name + end, wide)] if name else [])
    figure.suptitle("\n".join(lines), fontsize=10)


def legend(figure: Figure, axes: Any, runs: list[Shown]) -> None:
    """Which curve is which run, under the figure."""
    if len(runs) > 1:
        lines, names = axes.get_legend_handles_labels()
        once = dict(zip(names, lines, strict=True))
        if not once:  # no run has a row
            return
        figure.legend(once.values(), once.keys(), loc="outside lower center",
                      ncols=1 if max(map(len, once)) > 34 else min(3, len(once)))  # fmt: skip


def finished(figure: Figure, axes: Any, runs: list[Shown], text: str) -> Figure:
    """The figure with its title, and with its legend where it shows several runs."""
    figure.align_ylabels()
    titled(figure, runs, text)
    legend(figure, axes, runs)
    return figure


def thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """Fewer points that look the same: first, lowest, highest and last of every stretch of x."""
    if len(x) <= 4 * STRETCHES:
        return x, y
    of = ((x - x[0]) * (STRETCHES / (x[-1] - x[0]))).astype(int)
    first = np.flatnonzero(np.diff(of, prepend=-1))
    last = np.append(first[1:], len(x)) - 1
    order = np.lexsort((y, of))  # by value within each stretch; the stretches stay in place
    kept = np.unique(np.concatenate([first, last, order[first], order[last]]))
    return x[kept], y[kept]


def apart(axes: Any, noise: float = 0.0) -> None:
    """Room above and below a curve that hardly changes: rounding is not shown as a signal.

    noise: what in the units of the axis is no more than rounding.
    """
    low, high = axes.get_ylim()
    largest = max(abs(low), abs(high))
    if largest <= noise:
        axes.set_ylim(-1.0, 1.0)
    elif high - low < 1e-6 * largest:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.05 * largest, middle + 0.05 * largest)


def missed(axes: Any, places: list[float], label: str = NO_NUMBER) -> None:
    """Crosses on the horizontal axis, where there would be something; it reaches as far as they."""
    if places:
        axes.plot(places, np.zeros(len(places)), "x", color="0.45", ms=4.5, clip_on=False,
                  transform=axes.get_xaxis_transform(), label=label)  # fmt: skip
