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
    """A copy of the package, changed as the page says; what is not changed keeps its bytecode."""
    root = tmp_path_factory.mktemp("copy")
    shutil.copytree(ROOT / "trsim", root / "trsim")
    for section in KINDS:
        for kind, path, text in blocks(section):
            file = root / path
            assert file.exists() == (kind == "diff"), path
            file.write_text(text if kind == "python" else changed(file.read_text(), text))
    return root


EACH = """
import json, sys
from contextlib import redirect_stdout
from io import StringIO
from trsim.cli import main
said = []
for words in json.load(sys.stdin):
    out = StringIO()
    with redirect_stdout(out):
        try:
            main(words)
        except SystemExit as ended:
            assert not ended.code, (words, ended.code)
    said.append(out.getvalue())
print(json.dumps(said))
"""


def trsim(copy, *lines):
    """What the changed package says to command lines, in its folder and in one process."""
    found = subprocess.run(  # noqa: S603
        [sys.executable, "-c", EACH], cwd=copy, capture_output=True, text=True,
        input=json.dumps([line.split() for line in lines]),
        env={**os.environ, "PYTHONPATH": str(copy)},
    )  # fmt: skip
    assert found.returncode == 0, found.stdout + found.stderr
    return json.loads(found.stdout)


@pytest.fixture(scope="module")
def examples(copy):
    """What `explain` has as the example of each new element."""
    told = trsim(copy, "explain orientation --json", "explain drag --json")
    return [json.loads(page)["elements"][0]["example"] for page in told]


def simulated(copy, *texts):
    """The channels of runs of the changed package, all in one process."""
    names = [f"scene{k}" for k in range(len(texts))]
    for name, text in zip(names, texts, strict=True):
        (copy / f"{name}.yaml").write_text(text)
    trsim(copy, *(f"run {name}.yaml -o {name}.h5" for name in names))
    for name in names:
        with h5py.File(copy / f"{name}.h5") as file:
            yield {name: np.array(data) for name, data in file.items() if hasattr(data, "shape")}


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


def test_the_joint(copy, examples):
    """It falls as if it were free, and what would turn it is held."""
    [found] = simulated(copy, examples[0])
    t = found["time"][:, None]
    place = t * [1.0, 0.0, 0.0] - 9.81 * t**2 / 2 * [0.0, 0.0, 1.0]
    assert found["ball.position"] == pytest.approx(place, abs=1e-6)
    assert found["ball.angular_velocity"] == pytest.approx(0 * place, abs=1e-9)
    held = -5.0 * np.array([0.0, -0.6, 0.8])
    assert found["steady.reaction_moment"] == pytest.approx(held + 0 * place, abs=1e-6)


def test_the_force(copy, examples):
    """v = -v_e tanh(g t / v_e) with m g = c v_e^2."""
    [found] = simulated(copy, examples[1])
    end = np.sqrt(2 * 9.81 / 0.5)
    fast = end * np.tanh(9.81 * found["time"] / end)
    assert found["drop.velocity"][:, 1] == pytest.approx(-fast, abs=1e-6)
    assert found["air.force"] == pytest.approx(0.5 * fast**2, abs=1e-5)
    assert np.abs(found["energy.residual"]).max() < 1e-6


def test_the_law(copy):
    """What a journal slides against loses energy, and friction is smooth."""
    [found] = simulated(copy, """
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
    text = """
bodies: {mass: {mass: 1, inertia: 1, at: [1, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, mass], axis: [1, 0]}}
forces: {spring: {type: spring_damper, bodies: [ground, mass], points: [[-9, 0], [1, 0]],
         stiffness: 100, free_length: 9}}
solver: {end: 1, method: heun, step: STEP}
"""
    runs = simulated(copy, *(text.replace("STEP", step) for step in ("2e-3", "1e-3")))
    errors = [np.abs(r["mass.position"][:, 0] - np.cos(10 * r["time"])).max() for r in runs]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_the_command(copy):
    (copy / "ball.yaml").write_text(BALL)
    plain, told, schema = trsim(copy, "weigh ball.yaml", "weigh ball.yaml --json", "schema weigh")
    assert plain == "2\n"
    assert json.loads(told)["mass"] == 2.0
    assert json.loads(schema)["title"] == "trsim weigh --json"
