"""A run reaches nothing outside: no socket, no process, no text that becomes code."""

import ast
import shutil
import socket
import subprocess
import sys
import tomllib

import pytest

from trsim.cli import main

from . import drawn, small
from .store.outside import ROOT, warm
from .watching import NETWORK, PROCESSES, Watch, apart

CALLS = {"eval", "exec", "compile", "__import__", "breakpoint"}
MODULES = {"pickle", "cPickle", "marshal", "shelve", "dill", "joblib", "socket", "ssl", "urllib",
           "http", "ftplib", "smtplib", "requests", "pty", "code", "codeop"}  # fmt: skip
OF_OS = {"system", "popen", "fork", "forkpty"}
UNSAFE_YAML = {"load", "load_all", "unsafe_load", "full_load", "Loader", "UnsafeLoader"}


def faults(tree):
    """Lines of a module with something forbidden, and what it is."""
    for node in ast.walk(tree):
        line = getattr(node, "lineno", 0)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in CALLS:
            yield line, node.func.id
        if isinstance(node, ast.Import | ast.ImportFrom):
            names = [getattr(node, "module", None) or "", *(alias.name for alias in node.names)]
            yield from ((line, name) for name in names if name.split(".")[0] in MODULES)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            of = node.value.id
            if of == "os" and (node.attr in OF_OS or node.attr.startswith(("exec", "spawn"))):
                yield line, f"os.{node.attr}"
            if of == "yaml" and node.attr in UNSAFE_YAML:
                yield line, f"yaml.{node.attr}"
        if isinstance(node, ast.keyword) and node.arg == "shell":
            yield node.value.lineno, "shell="


def test_no_text_becomes_code():
    found = {
        f"{path.relative_to(ROOT)}:{line}: {what}"
        for path in sorted((ROOT / "trsim").rglob("*.py"))
        for line, what in faults(ast.parse(path.read_text()))
    }
    assert found == set()


@pytest.mark.parametrize(
    "text",
    ["eval(x)", "import pickle", "from pickle import loads", "yaml.load(x)", "os.system(x)",
     "subprocess.run(x, shell=True)", "exec(x)", "import urllib.request", "os.execv(x, y)"],
)  # fmt: skip
def test_each_would_be_seen(text):
    assert list(faults(ast.parse(text)))


def test_ruff_guards_the_rest():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["ruff"]["lint"]
    assert "S" in settings["select"]
    assert not any(rule.startswith("S") and rule[1:2].isdigit() for rule in settings["ignore"])
    ignored = settings["per-file-ignores"]
    assert not any(pattern.startswith(("trsim", "*")) for pattern in ignored)


def test_a_run_reaches_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    drawn.few(monkeypatch)
    (tmp_path / "crank.yaml").write_text(small.SLIDER_CRANK)
    commands = [
        ("check", "crank.yaml"),
        ("run", "crank.yaml", "-q", "--set", *small.FEW),
        ("show", "runs/crank.h5"),
        ("report", "runs/crank.h5", "-o", "figures"),
        ("export", "runs/crank.h5", "--csv"),
    ]
    warm()  # a first run compiles in a second process

    def typed():
        codes = []
        with Watch((*NETWORK, *PROCESSES)) as seen:
            for words in commands:
                with pytest.raises(SystemExit) as ended:
                    main(list(words))
                codes.append(ended.value.code)
        return seen, codes

    seen, codes = apart(typed)
    assert seen == []
    assert codes == [0] * len(commands)


def test_it_would_be_seen():
    def reaching():
        with Watch((*NETWORK, *PROCESSES)) as seen:
            socket.socket().close()
            subprocess.run([sys.executable, "-c", ""], check=True)
        return seen

    seen = apart(reaching)
    assert seen[0].startswith("socket.")
    assert any(event.startswith("subprocess.Popen") for event in seen)


def test_the_repository_has_no_links():
    """One would lead to a place of another machine; `.venv` is made, never kept."""
    git = shutil.which("git")
    if git is None or not (ROOT / ".git").exists():
        pytest.skip("this is no checkout")
    listed = subprocess.run(  # noqa: S603
        [git, "ls-files", "--stage"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout.splitlines()
    assert [line for line in listed if line.startswith("120000")] == []
