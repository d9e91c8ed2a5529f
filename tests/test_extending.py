"""The page on extending: its code works in a copy of the package, and its table counts right."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs/extending.md").read_text()
BLOCK = re.compile(r"```(python|diff) file=(\S+)\n(.*?)```", re.DOTALL)
KINDS = {"A joint": "a joint", "A force": "a force", "A law": "a friction law",
         "A method": "a method", "A command": "a command"}  # fmt: skip
BALL = "bodies: {ball: {mass: 2, inertia: [1, 1, 1], velocity: [1, 0, 0]}}\n"


def blocks(section):
    """What one section of the page writes: (new file or change, path, text)."""
    return BLOCK.findall(PAGE.split(f"\n## {section}\n")[1].split("\n## ")[0])


def changed(text, change):
    """A text with lines taken out and put in, at the one place that the change fits."""
    lines = change.splitlines(keepends=True)
    before = "".join(line[1:] for line in lines if line[0] in " -")
    after = "".join(line[1:] for line in lines if line[0] in " +")
    before, after = (part.removesuffix("\n") for part in (before, after))
    assert text.count(before) == 1, before
    return text.replace(before, after)


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the package, changed as the page says."""
    root = tmp_path_factory.mktemp("copy")
    shutil.copytree(ROOT / "trsim", root / "trsim", ignore=shutil.ignore_patterns("__pycache__"))
    for section in KINDS:
        for kind, path, text in blocks(section):
            file = root / path
            assert file.exists() == (kind == "diff"), path
            file.write_text(text if kind == "python" else changed(file.read_text(), text))
    return root


def trsim(copy, *arguments):
    """A command line of the changed package, in its folder."""
    found = subprocess.run(  # noqa: S603
        [sys.executable, "-m", "trsim", *arguments], cwd=copy, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(copy)},
    )  # fmt: skip
    assert found.returncode == 0, found.stdout + found.stderr
    return found.stdout


def simulated(copy, text):
    """The channels of a run of the changed package."""
    (copy / "scene.yaml").write_text(text)
    trsim(copy, "run", "scene.yaml", "-o", "scene.h5")
    with h5py.File(copy / "scene.h5") as file:
        return {name: np.array(data) for name, data in file.items() if hasattr(data, "shape")}


@pytest.mark.parametrize("section", KINDS)
def test_what_had_to_be_touched(section):
    row = next(line for line in PAGE.splitlines() if line.startswith(f"| {KINDS[section]} |"))
    told = tuple(int(cell) for cell in row.split("|")[2:5])
    made = blocks(section)
    new = {path for kind, path, _ in made if kind == "python"}
    touched = {path for kind, path, _ in made if kind == "diff"}
    lines = sum(
        len(text.splitlines()) if kind == "python" else text.count("\n+") + text.startswith("+")
        for kind, _, text in made
    )
    assert (len(new), len(touched), lines) == told


def test_the_joint(copy):
    """It falls as if it were free, and what would turn it is held."""
    page = json.loads(trsim(copy, "explain", "orientation", "--json"))["elements"][0]
    found = simulated(copy, page["example"])
    t = found["time"][:, None]
    place = t * [1.0, 0.0, 0.0] - 9.81 * t**2 / 2 * [0.0, 0.0, 1.0]
    assert found["ball.position"] == pytest.approx(place, abs=1e-6)
    assert found["ball.angular_velocity"] == pytest.approx(0 * place, abs=1e-9)
    held = -5.0 * np.array([0.0, -0.6, 0.8])
    assert found["steady.reaction_moment"] == pytest.approx(held + 0 * place, abs=1e-6)


def test_the_force(copy):
    """v = -v_e tanh(g t / v_e) with m g = c v_e^2."""
    page = json.loads(trsim(copy, "explain", "drag", "--json"))["elements"][0]
    found = simulated(copy, page["example"])
    end = np.sqrt(2 * 9.81 / 0.5)
    fast = end * np.tanh(9.81 * found["time"] / end)
    assert found["drop.velocity"][:, 1] == pytest.approx(-fast, abs=1e-6)
    assert found["air.force"] == pytest.approx(0.5 * fast**2, abs=1e-5)
    assert np.abs(found["energy.residual"]).max() < 1e-6


def test_the_law(copy):
    """What a journal slides against loses energy, and friction is smooth."""
    found = simulated(copy, """
bodies: {disc: {mass: 2, inertia: 0.01, at: [0, -1e-4], angular_velocity: [0, 0, 50]}}
joints: {pin: {type: revolute, bodies: [ground, disc], at: [0, 0], clearance: 0.1 mm}}
contact_laws:
  steel: {normal: flores, stiffness: 1e8, restitution: 0.5, bearing_radius: 10 mm,
          friction: {law: smooth, coefficient: 0.2, v0: 0.1}}
gravity: [0, -9.81, 0]
solver: {end: 0.05}
""")  # fmt: skip
    normal, slip, friction = (found[f"pin.{name}"] for name in
                              ("normal_force", "sliding_speed", "friction_force"))  # fmt: skip
    assert normal.max() > 1.0
    law = -0.2 * normal * slip / np.sqrt(slip**2 + 0.1**2)
    assert friction == pytest.approx(law, abs=1e-9 * normal.max())


def test_the_method(copy):
    """Half the step, a quarter of the error."""
    errors = []
    for step in (2e-3, 1e-3):
        found = simulated(copy, f"""
bodies: {{mass: {{mass: 1, inertia: 1, at: [1, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, mass], axis: [1, 0]}}}}
forces: {{spring: {{type: spring_damper, bodies: [ground, mass], points: [[-9, 0], [1, 0]],
          stiffness: 100, free_length: 9}}}}
solver: {{end: 1, method: heun, step: {step}}}
""")  # fmt: skip
        errors.append(np.abs(found["mass.position"][:, 0] - np.cos(10 * found["time"])).max())
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_the_command(copy):
    (copy / "ball.yaml").write_text(BALL)
    assert trsim(copy, "weigh", "ball.yaml") == "2\n"
    assert json.loads(trsim(copy, "weigh", "ball.yaml", "--json"))["mass"] == 2.0
    assert json.loads(trsim(copy, "schema", "weigh"))["title"] == "trsim weigh --json"
