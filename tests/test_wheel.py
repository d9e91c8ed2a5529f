"""What a wheel holds, and that `trsim init` works from it as from a checkout."""

import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest

from trsim.scenario.shipped import SHIPPED, TEMPLATES

ROOT = Path(__file__).parents[1]
WHEEL = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"][
    "wheel"
]
EVERY = """
import sys
from trsim.cli import main
from trsim.scenario.shipped import TEMPLATES, root, template

print("root", root())
for name in TEMPLATES:
    for words in (["init", name, "-q"], ["check", template(name).first, "-q"]):
        if words[0] == "check" and name in ("reverser", "door"):
            words[1] = f"{name}/{words[1]}"
        try:
            main([*words, *["--force"] * (words[0] == "init")])
        except SystemExit as ended:
            print(name, words[0], ended.code)
"""


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    """The package as a wheel has it: built where hatchling is installed, else laid out alike."""
    folder = tmp_path_factory.mktemp("wheel")
    if find_spec("hatchling"):
        built = folder / "built"
        subprocess.run(  # noqa: S603
            [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(built)],
            cwd=ROOT, check=True, capture_output=True,
        )  # fmt: skip
        (wheel,) = built.glob("*.whl")
        zipfile.ZipFile(wheel).extractall(folder / "site")
        return folder / "site"
    for part in WHEEL["only-include"]:
        away = shutil.ignore_patterns("__pycache__")
        shutil.copytree(
            ROOT / part, folder / "site" / WHEEL["sources"].get(part, part), ignore=away
        )
    return folder / "site"


def listed(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def test_a_wheel_holds_the_package_and_the_scenarios(unpacked):
    there = {name for name in listed(unpacked) if name.startswith("trsim/")}
    scenarios = {f"trsim/{SHIPPED}/{name}" for name in listed(ROOT / "scenarios")}
    sources = {f"trsim/{name}" for name in listed(ROOT / "trsim") if "__pycache__" not in name}
    assert scenarios <= there
    assert there == scenarios | sources
    for name in scenarios:
        own = ROOT / "scenarios" / name.removeprefix(f"trsim/{SHIPPED}/")
        assert (unpacked / name).read_bytes() == own.read_bytes()


def test_templates_of_a_wheel(unpacked, tmp_path):
    """Every one is written and checked by the package of the wheel, away from the checkout."""
    ended = subprocess.run(  # noqa: S603
        [sys.executable, "-c", EVERY], cwd=tmp_path, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(unpacked)},
    )  # fmt: skip
    said = [line.split() for line in ended.stdout.splitlines()]
    assert ["root", str(unpacked / "trsim" / SHIPPED)] in said, ended.stderr
    ends = [words for words in said if words[1:2] in (["init"], ["check"])]
    assert ends == [[name, verb, "0"] for name in TEMPLATES for verb in ("init", "check")], (
        ended.stderr
    )


def test_an_editable_install_copies_nothing():
    """Its scenarios are those of the checkout: files of `force-include` would be copies."""
    assert WHEEL["dev-mode-dirs"] == ["."] and "force-include" not in WHEEL
