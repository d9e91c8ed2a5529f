"""docs/install.md and packaging/: what can be typed is typed, and all agree on what is needed."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

from benchmarks.gallery.tutorial import Ended, follow, steps
from trsim.cli import main
from trsim.scenario.shipped import TEMPLATES
from trsim.version import __version__

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
NEEDED = {name.lower().replace(">=", " >=") for name in PROJECT["project"]["dependencies"]}


def test_commands_of_the_page(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)

    def typed(words):
        with pytest.raises(SystemExit) as ended:
            main(words)
        return ended.value.code, capsys.readouterr().out

    done = list(follow(TEXT, typed))
    assert [one for one in done if isinstance(one, Ended) and one.code] == []
    assert "version" in done[0].line and (tmp_path / "trsim.json").exists()


def test_files_that_are_named_exist():
    for name in re.findall(r"packaging/[\w./]+|trsim/[\w./]+\.py|\]\((\w+\.md)", TEXT):
        assert (ROOT / "docs" / name).exists() if name else True
    for name in ("packaging/conda/meta.yaml", "packaging/Containerfile", "trsim/system.py"):
        assert name in TEXT and (ROOT / name).exists()
    by_hand = "".join(step.text for step in steps(TEXT) if "by-hand" in step.marks)
    assert "pip install" in by_hand and "conda build" in by_hand and "podman build" in by_hand


def test_the_conda_recipe():
    text = (ROOT / "packaging" / "conda" / "meta.yaml").read_text()
    assert f'{{% set version = "{__version__}" %}}' in text
    plain = re.sub(r"\{%.*?%\}", "", text).replace("{{ PYTHON }}", "python")
    recipe = yaml.safe_load(plain.replace("{{ version }}", "0"))
    run = {name.replace("matplotlib-base", "matplotlib") for name in recipe["requirements"]["run"]}
    python = f"python {PROJECT['project']['requires-python']}"
    assert run == NEEDED | {python}
    (backend,) = PROJECT["build-system"]["requires"]
    assert set(recipe["requirements"]["host"]) == {python, "pip", backend.replace(">=", " >=")}
    (entry,) = PROJECT["project"]["scripts"].items()
    assert recipe["build"]["entry_points"] == [" = ".join(entry)]
    assert recipe["about"]["license"] == PROJECT["project"]["license"]["text"]
    for command in recipe["test"]["commands"]:
        assert command.split()[0] == "trsim"


def test_the_container_file():
    text = (ROOT / "packaging" / "Containerfile").read_text()
    words = [line.split(maxsplit=1) for line in text.splitlines() if line[:1].isupper()]
    assert words[0][0] == "FROM" and words[-1] == ["ENTRYPOINT", '["trsim"]']
    assert {verb for verb, _ in words} <= {"FROM", "COPY", "RUN", "ENV", "USER", "WORKDIR",
                                           "ENTRYPOINT"}  # fmt: skip
    version = words[0][1].split(":")[1].split("-")[0]
    assert f">={version}" == PROJECT["project"]["requires-python"]
    ignored = (ROOT / ".dockerignore").read_text().split()
    assert {".git", ".venv", "runs"} <= {*ignored} and "scenarios" not in ignored


def completed(*words):
    """What the shell is told of the last of these words."""
    return subprocess.run(
        [sys.executable, "-c", "from trsim.cli import main; main()"],
        capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT), "_TRSIM_COMPLETE": "bash_complete",
             "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)},
    ).stdout  # fmt: skip


def test_completion():
    assert completed("trsim", "in") == "plain,init\n"
    assert completed("trsim", "init", "--te") == "plain,--template\n"
    for words in (("trsim", "init", "slider"), ("trsim", "init", "--template", "slider")):
        told = completed(*words)
        wanted = [name for name in TEMPLATES if name.startswith("slider")]
        assert [line.split(",")[1] for line in told.splitlines()] == wanted


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_lines_of_the_shells(shell):
    assert f"_TRSIM_COMPLETE={shell}_source trsim" in TEXT
    out = subprocess.run(
        [sys.executable, "-c", "from trsim.cli import main; main([])"], capture_output=True,
        text=True, env={**os.environ, "PYTHONPATH": str(ROOT),
                        "_TRSIM_COMPLETE": f"{shell}_source"},
    )  # fmt: skip
    # click asks bash for its version, which is not everywhere
    assert "_trsim_completion" in out.stdout or (shell == "bash" and out.returncode)
