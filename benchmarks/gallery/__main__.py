"""`python -m benchmarks.gallery [TEMPLATE...]`: docs/gallery.md, and the pictures asked for.

A picture is the mechanism at one moment, or several, beside the curves of the first `--plot` that
the template itself tells one to try.  `first_mechanism` stands for the pictures of that page.
"""

import io
import os
import shlex
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from PIL import Image
from pygltflib import GLTF2

from benchmarks.gallery import still
from benchmarks.gallery.page import DOCS, PAGE, PICTURES, marker, page
from benchmarks.gallery.tutorial import follow, pictures
from trsim.analyse.plotted import plotted, rows
from trsim.cli import main
from trsim.report import style
from trsim.report.animation.shoot import shoot
from trsim.report.display import Shown, compared
from trsim.report.marks import spaced
from trsim.scenario.shipped import TEMPLATES, Template, template
from trsim.store.read import read

FIRST = "first_mechanism"
SIZE = (420, 330)  # pixels of the drawing
GHOST = 0.22  # how much of an earlier moment is seen
COLOURS = 128  # of a picture: it stays small


class Scene(NamedTuple):
    """What a picture shows."""

    at: tuple[float, ...] = (0.0,)  # moments, parts of the run; the last one in full
    trace: str | None = None  # a point whose path is drawn


SCENES = {
    "pendulum": Scene((0.09, 0.18, 0.0)),
    "four-bar": Scene((0.25, 0.0), "pen"),
    "slider-crank": Scene((0.2, 0.1)),
    "slider-crank-clearance": Scene((0.2, 0.1)),
    "cam": Scene((0.1,)),
    "gear-pair": Scene((0.0,)),
    "robot-arm": Scene((0.0, 0.4, 0.65)),
    "whitworth": Scene((0.1,)),
    "scotch-yoke": Scene((0.35,)),
    "toggle-clamp": Scene((1.0, 0.0)),
    "cardan-shaft": Scene((0.07,)),
    "crane": Scene((0.0, 0.4, 0.9)),
    "washing-machine": Scene((0.05,)),
    "door-closer": Scene((0.25, 0.12, 0.0)),
    "vibratory-feeder": Scene((1.0, 0.0)),
    "ball-on-an-incline": Scene((0.55, 0.8, 1.0)),
    "reverser": Scene((0.0, 0.6, 0.95)),
    "door": Scene((0.0, 0.5, 1.0)),
}


def trsim(*words: str) -> None:
    """A command line, which has to end well."""
    try:
        main([*words, "-q"])
    except SystemExit as ended:
        if ended.code:
            raise RuntimeError(f"trsim {' '.join(words)} ended with {ended.code}") from None


def words_of(found: Template) -> str:
    """What the first plot of a template is of."""
    for line in found.commands:
        words = shlex.split(line)
        if "--plot" in words:
            return words[words.index("--plot") + 1]
    raise ValueError(f"{found.name} tells of no plot")


def drawing(film: bytes, scene: Scene) -> tuple[Any, still.Eye]:
    """The mechanism at some moments, (height, width, 3)."""
    gltf = GLTF2.load_from_bytes(film)
    times = still.frames(gltf)
    seen = still.eye(gltf, SIZE)
    made = np.ones((SIZE[1], SIZE[0], 3))
    for k, part in enumerate(scene.at):
        frame = int(np.argmin(np.abs(times - part * times[-1])))
        colours, covered = still.picture(gltf, frame, seen, SIZE)
        much = (1.0 if k == len(scene.at) - 1 else GHOST) * (covered > 0.0)
        made = made * (1.0 - much) + colours * much
    return made, seen


def curves(figure: Figure, place: Any, shown: Shown, word: str) -> None:
    """The curves of a plot, a panel for each unit, as `report --plot` draws them."""
    of = plotted(word)
    found = rows(shown.run, of)
    groups: dict[str, list[str]] = {}
    for channel in of.y:
        groups.setdefault(shown.run.unit(channel), []).append(channel)
    inner = place.subgridspec(len(groups), 1)
    x_factor, x_unit = shown.display(shown.run.unit(of.x))
    axes = None
    for row, (si, channels) in enumerate(groups.items()):
        axes = figure.add_subplot(inner[row, 0], sharex=axes)
        factor, unit = shown.display(si)
        for k, channel in enumerate(channels):
            x, y = found.x * x_factor, found.y[channel] * factor
            axes.plot(*(style.thinned(x, y) if of.x == "time" else (x, y)),
                      color=style.colour(k), ls=style.DASHES[k % 4], label=channel)  # fmt: skip
        name = spaced(channels[0].strip("|")) if len(channels) == 1 else ""
        axes.set_ylabel(f"{name}\n({unit})" if name else f"({unit})")
        if len(channels) > 1:
            axes.legend(fontsize=7)
        if row < len(groups) - 1:
            axes.tick_params(labelbottom=False)
        if "position" in of.x and "position" in channels[0]:
            axes.set_aspect("equal", adjustable="datalim")
    assert axes is not None
    axes.set_xlabel(f"{spaced(of.x)} ({x_unit})")


def composed(result: Path, scene: Scene, word: str) -> Image.Image:
    """The drawing on the left, the curves on the right."""
    run = read(result)
    shown = compared([run])[0]
    made, seen = drawing(shoot(run, 1.0).glb, scene)
    with style.look():
        figure = Figure(figsize=(8.4, 3.4), dpi=100, layout="constrained")
        grid = figure.add_gridspec(1, 2, width_ratios=[SIZE[0], 420])
        left = figure.add_subplot(grid[0, 0])
        left.imshow(np.clip(made, 0, 1), interpolation="antialiased")
        if scene.trace:
            path = still.onto(seen, run.channel(f"{scene.trace}.position"), SIZE)
            left.plot(path[:, 0], path[:, 1], color=style.colour(1), lw=1.2)
        left.set_axis_off()
        curves(figure, grid[0, 1], shown, word)
        held = io.BytesIO()
        figure.savefig(held, format="png", metadata={"Software": "trsim"})
    return Image.open(held)


def small(image: Image.Image, path: Path) -> None:
    """Write a picture with few colours."""
    image.convert("RGB").quantize(COLOURS).save(path, optimize=True)
    print(path.name, path.stat().st_size)


def make(name: str) -> None:
    """The picture of a template, in the current folder's runs."""
    found = template(name)
    trsim("init", name, "--force")
    folder = Path(name if Path(name).is_dir() else ".")
    target = PICTURES / f"{name}.png"
    if name not in SCENES:  # a sweep
        trsim("sweep", found.first, "-o", "runs/sweep")
        trsim("report", "runs/sweep", "--table", "peak:pivot.reaction", "-o", "runs/figures")
        (figure,) = Path("runs/figures").glob("*.png")
        small(Image.open(figure), target)
        return
    result = Path("runs") / f"{name}.h5"
    trsim("run", str(folder / found.first), "-o", str(result))
    small(composed(result, SCENES[name], words_of(found)), target)


def tutorial() -> None:
    """The pictures of docs/first_mechanism.md: figures that its commands draw, and the wiper."""
    text = (DOCS / f"{FIRST}.md").read_text(encoding="utf-8")
    for _ in follow(text, typed):
        pass
    for name in pictures(text, FIRST):
        if name == "wiper.png":
            made = composed(
                Path("runs/wiper.h5"), Scene((0.125, 0.346, 0.0), "tip"), "swing : turn"
            )
        else:
            made = Image.open(Path("figures") / name)
        small(made, DOCS / FIRST / name)


def typed(words: list[str]) -> tuple[int, str]:
    """The exit code of a command line; its words are shown as they are said."""
    try:
        main(words)
    except SystemExit as ended:
        return int(ended.code or 0), ""


if __name__ == "__main__":
    asked = sys.argv[1:] or [*TEMPLATES, FIRST]
    with tempfile.TemporaryDirectory() as there:
        os.chdir(there)
        for name in asked:
            tutorial() if name == FIRST else make(name)
    every = {*TEMPLATES} <= {*asked}  # else the marker tells of the pictures that stay
    PAGE.write_text(page("" if every else marker()), encoding="utf-8", newline="\n")
