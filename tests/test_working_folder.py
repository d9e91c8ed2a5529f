"""Files of the working folder are data: none is executed, whatever its name, by any command."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests import small
from tests.store.outside import ROOT, warm
from tests.store.test_resume import cut
from trsim import child
from trsim.assemble.assemble import assemble
from trsim.spec.load import loads

# what trsim, its children, numba, HDF5 and matplotlib import
NAMES = ("h5py", "numba", "fcntl", "random", "yaml", "click", "numpy", "ctypes", "subprocess",
         "json", "tempfile", "matplotlib", "scipy", "llvmlite", "sitecustomize")  # fmt: skip
PLANTED = "open('executed', 'a').write(__name__ + '\\n')\nraise SystemExit('planted')\n"
SWEEP = "sweep: {joints.B.clearance: [0.4 mm, 0.5 mm]}\n"
LONGER = ("solver.end=0.05",)
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONSAFEPATH"}
ENVIRONMENT["PYTHONPATH"] = str(ROOT)
PATIENCE = 120.0  # s


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with results, what a dead run left, a sweep, and the planted files."""
    folder = tmp_path_factory.mktemp("working")
    warm()
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    (folder / "many.yaml").write_text(small.SLIDER_CRANK + SWEEP)
    small.run(folder / "done.h5")
    scenario = loads(small.SLIDER_CRANK, LONGER)
    cut(folder / "dead.h5", scenario, assemble(scenario), 2)
    for name in NAMES:
        (folder / f"{name}.py").write_text(PLANTED)
    (folder / ".numba_config.yaml").write_text("disable_jit: 1\n")
    return folder


def ended(folder, command, *arguments, **environment):
    """Run a command line there; exit code and all it said."""
    done = subprocess.run(  # noqa: S603
        [*command, *arguments], cwd=folder, env={**ENVIRONMENT, **environment},
        capture_output=True, text=True, timeout=PATIENCE,
    )  # fmt: skip
    return done.returncode, done.stdout + done.stderr


COMMANDS = (
    ("check", "crank.yaml"),
    ("run", "crank.yaml", "-o", "run.h5"),
    ("run", "crank.yaml", "-o", "dead.h5", "--resume", "--set", *LONGER),
    ("recover", "done.h5", "-o", "found.h5"),
    ("sweep", "many.yaml", "-o", "many", "--jobs", "1"),
    ("status", "many"),
    ("report", "done.h5", "-o", "figures"),
    ("show", "done.h5", "--verify"),
    ("export", "done.h5", "--csv", "-o", "done.csv"),
    ("explain", "revolute"),
    ("schema", "-o", "schema.json"),
)


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: words[0])
def test_no_command_executes_a_file_of_the_working_folder(words, folder):
    """With -m, which puts that folder in front of the path; in this order."""
    code, said = ended(folder, [sys.executable, "-m", "trsim"], *words)
    assert not (folder / "executed").exists(), (folder / "executed").read_text()
    assert code == 0, said


def test_the_installed_command_executes_none(folder):
    """Not even where a folder is called as its package is."""
    command = Path(sys.executable).with_name("trsim")
    if not command.exists():
        pytest.skip("it is not installed")
    (folder / "trsim").mkdir()
    (folder / "trsim" / "__init__.py").write_text(PLANTED)
    for words in (("check", "crank.yaml"), ("recover", "done.h5", "-o", "again.h5")):
        code, said = ended(folder, [str(command)], *words)
        assert not (folder / "executed").exists(), (folder / "executed").read_text()
        assert code == 0, said
    shutil.rmtree(folder / "trsim")


def test_a_first_run_executes_none(folder, tmp_path):
    """With an empty cache, until it has compiled something."""
    environment = {**ENVIRONMENT, "XDG_CACHE_HOME": str(tmp_path)}
    process = subprocess.Popen(
        [sys.executable, "-m", "trsim", "run", "crank.yaml"], cwd=folder, env=environment,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    until = time.monotonic() + PATIENCE
    while process.poll() is None and time.monotonic() < until and not kept(tmp_path):
        time.sleep(0.1)
    process.kill()
    process.wait()
    assert kept(tmp_path)
    assert not (folder / "executed").exists(), (folder / "executed").read_text()


def kept(cache):
    """The machine code in a cache folder."""
    return list(cache.glob("trsim/code/*.code"))


def test_the_second_process_of_a_first_run_executes_none(folder, tmp_path):
    command = child.command("trsim.elements.ahead", "trsim.solve.rk4")
    environment = {**ENVIRONMENT, "XDG_CACHE_HOME": str(tmp_path)}
    with subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.PIPE) as process:  # noqa: S603
        process.wait(PATIENCE)
    assert kept(tmp_path)
    assert not (folder / "executed").exists(), (folder / "executed").read_text()


def test_a_child_has_the_package_of_its_parent(tmp_path):
    """Whatever else is called trsim, in the folder or on the path."""
    other = tmp_path / "trsim"
    other.mkdir()
    (other / "__init__.py").write_text(PLANTED)
    command = child.command("trsim.store.recover", "none.h5", "new.h5")
    done = subprocess.run(  # noqa: S603
        command, cwd=tmp_path, capture_output=True, text=True,
        env={**ENVIRONMENT, "PYTHONPATH": str(tmp_path)}, timeout=PATIENCE,
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (1, ""), done.stderr
    assert done.stderr == "No such file or directory\n"
    assert not (tmp_path / "executed").exists()


def test_every_process_of_python_is_begun_in_one_place():
    """child.py; nothing else says which Python to run, or with which modules."""
    package = Path(child.__file__).parent
    found = {
        str(path.relative_to(package)) for path in package.rglob("*.py")
        if "sys.executable" in path.read_text() or "multiprocessing" in path.read_text()
    }  # fmt: skip
    assert found == {"child.py"}
