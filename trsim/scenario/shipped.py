"""The scenarios that come with trsim, which `trsim init` writes.

They are those of the project.  A wheel carries them in the package, as trsim/shipped
(pyproject.toml); in a checkout, installed or not, they are the folder scenarios beside it.
"""

import re
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import NamedTuple

import yaml

from trsim.errors import FileError, UsageError, described, known

SHIPPED, BESIDE = "shipped", "scenarios"
# name -> its files, the one to begin with first; a folder stands for all that is in it
TEMPLATES: dict[str, tuple[str, ...]] = {
    "pendulum": ("gallery/pendulum.yaml",),
    "four-bar": ("gallery/four_bar.yaml",),
    "slider-crank": ("gallery/slider_crank.yaml",),
    "slider-crank-clearance": ("gallery/slider_crank_clearance.yaml",),
    "cam": ("validation/cam_flat.yaml",),
    "gear-pair": ("gallery/gear_pair.yaml",),
    "robot-arm": ("validation/robot_arm.yaml",),
    "whitworth": ("validation/whitworth.yaml",),
    "scotch-yoke": ("gallery/scotch_yoke.yaml",),
    "toggle-clamp": ("gallery/toggle_clamp.yaml",),
    "cardan-shaft": ("validation/cardan_shaft.yaml",),
    "crane": ("gallery/crane.yaml",),
    "washing-machine": ("gallery/washing_machine.yaml",),
    "door-closer": ("gallery/door_closer.yaml",),
    "vibratory-feeder": ("gallery/vibratory_feeder.yaml",),
    "ball-on-an-incline": ("validation/ball_on_an_incline.yaml",),
    "sweep": ("gallery/sweep.yaml", "gallery/pendulum.yaml"),
    "reverser": ("thrust_reverser/clearance_ab_0.3mm.yaml", "thrust_reverser"),
    "door": ("crew_door/opening.yaml", "crew_door"),
}
FOLDERS = ("reverser", "door")  # written into a folder of their own
_TRY = re.compile(r"^# Try: (.*(?:\n#       .*)*)", re.MULTILINE)


class Template(NamedTuple):
    """A scenario to begin with, as text, and what belongs to it."""

    name: str
    files: dict[str, bytes]  # by name, the one to begin with first

    @property
    def first(self) -> str:
        return next(iter(self.files))

    @property
    def text(self) -> str:
        return self.files[self.first].decode()

    @property
    def title(self) -> str:
        return str(yaml.safe_load(self.text)["title"])

    @property
    def about(self) -> str:
        """What its first line says: what it is, and what to expect."""
        return self.text.splitlines()[0].removeprefix("# ").removeprefix("Expected: ")

    @property
    def commands(self) -> list[str]:
        """What to try, as its comment says."""
        found = _TRY.search(self.text)
        lines = found[1].replace("\n#", "\n").splitlines() if found else []
        return [line.strip() for line in lines]

    def called(self, file: str) -> "Template":
        """The same under another name of its file, in the commands too."""
        old, new = Path(self.first).stem, Path(file).stem
        lines = self.text.splitlines(keepends=True)
        own = re.compile(rf"(?<![\w/]){re.escape(old)}\.yaml|(?<=runs/){re.escape(old)}(?![\w])")
        changed = [
            own.sub(lambda m: file if m[0].endswith(".yaml") else new, line)
            if line.startswith("#")
            else line
            for line in lines
        ]
        return Template(self.name, {file: "".join(changed).encode()})


def template(word: str) -> Template:
    """The template of a name, however its words are joined.  Raises UsageError, FileError."""
    name = named(word)
    if name is None:
        what = f"no template is named {described(word)}"
        raise UsageError(what, f"{known(word, TEMPLATES)}  `trsim init --list` says what they are.")
    top = root()
    found: dict[str, bytes] = {}
    for path in TEMPLATES[name]:
        place = top.joinpath(*path.split("/"))
        parts = sorted(place.iterdir(), key=lambda one: one.name) if place.is_dir() else [place]
        for part in parts:
            found.setdefault(part.name, part.read_bytes())
    return Template(name, found)


def named(word: str) -> str | None:
    """The name of a template as TEMPLATES has it."""
    by = {_letters(name): name for name in TEMPLATES}
    return by.get(_letters(word))


def _letters(word: str) -> str:
    return re.sub(r"[-_ ]", "", word.casefold())


def root() -> Traversable:
    """The folder of all scenarios."""
    package = files("trsim")
    inside = package / SHIPPED
    if inside.is_dir():
        return inside
    beside = Path(str(package)).parent / BESIDE
    if (beside / "gallery").is_dir():
        return beside
    what = f"this installation of trsim has no scenarios: {inside} is missing"
    raise FileError(what, "Please reinstall it: `pip install --force-reinstall trsim`.")
