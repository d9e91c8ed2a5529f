"""Files of the working folder are data: none is executed, whatever its name, by any command."""

import json
import os
import shutil
import subprocess
import sys
import time
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from tests import small
from tests.store.outside import ROOT, warm
from tests.store.test_resume import cut
from trsim import child, cli
from trsim.assemble.assemble import assemble
from trsim.scenario.load import loads

# whatever trsim, its children, numba, HDF5 and matplotlib may import
NAMES = sorted({
    name for name in (*sys.stdlib_module_names, *packages_distributions(), "sitecustomize",
                      "usercustomize", "pip", "setuptools", "IPython", "cython", "cffi")
    if name.isidentifier() and name != "trsim"
})  # fmt: skip
BARE = """
import sys
print(*sys.modules)
"""
PLANTED = "open('executed', 'a').write(__name__ + '\\n')\nraise SystemExit('planted')\n"
SWEEP = "sweep: {joints.B.clearance: [0.4 mm, 0.5 mm]}\n"
LONGER = ("solver.end=0.05",)
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONSAFEPATH"}
ENVIRONMENT["PYTHONPATH"] = str(ROOT)
PATIENCE = 120.0  # s
# of a run whose report has few figures, and the page and the tables of any
ONE_OF_EACH = ("output.channels=[stroke, B.contact_force]",)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with results, what a dead run left, a sweep, and the planted files."""
    folder = tmp_path_factory.mktemp("working")
    warm()
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    (folder / "many.yaml").write_text(small.SLIDER_CRANK + SWEEP)
    small.copy(folder / "done.h5", *ONE_OF_EACH)
    scenario = loads(small.SLIDER_CRANK, LONGER)
    cut(folder / "dead.h5", scenario, assemble(scenario), 2)
    for name in {*NAMES} - by_python(folder):
        (folder / f"{name}.py").write_text(PLANTED)
    (folder / ".numba_config.yaml").write_text("disable_jit: 1\n")
    return folder


def by_python(folder):
    """What Python itself imports for -m, from the folder it is begun in, before any module runs."""
    (folder / "bare.py").write_text(BARE)
    told = subprocess.run(
        [sys.executable, "-m", "bare"], cwd=folder, capture_output=True, text=True, check=True
    )
    (folder / "bare.py").unlink()
    return {name.split(".")[0] for name in told.stdout.split()}


def planted(folder, here):
    """A copy of the folder; of the planted files, which nobody writes, under second names."""

    def copied(path, to):
        return (os.link if path.endswith(".py") else shutil.copy2)(path, to)

    shutil.copytree(folder, here, copy_function=copied)


def ended(folder, command, *arguments, **environment):
    """Run a command line there; exit code and all it said."""
    done = subprocess.run(  # noqa: S603
        [*command, *arguments], cwd=folder, env={**ENVIRONMENT, **environment},
        capture_output=True, text=True, timeout=PATIENCE,
    )  # fmt: skip
    return done.returncode, done.stdout + done.stderr


COMMANDS = (
    ("init", "pendulum", "--force"),
    ("check", "crank.yaml"),
    ("run", "crank.yaml", "-o", "run.h5"),
    ("run", "crank.yaml", "-o", "dead.h5", "--resume", "--set", *LONGER),
    ("recover", "done.h5", "-o", "found.h5"),
    ("sweep", "many.yaml", "-o", "many", "--jobs", "1"),
    ("status", "many"),
    ("merge", "many", "-o", "one"),
    ("report", "done.h5", "-o", "figures", "--dpi", "40"),
    ("statics", "crank.yaml", "-o", "rest.h5"),
    ("show", "done.h5", "--verify"),
    ("export", "done.h5", "--csv", "-o", "done.csv"),
    ("explain", "revolute"),
    ("schema", "-o", "schema.json"),
    ("bench", "crank.yaml", "--methods", "dop853", "--tolerances", "1e-3", "--reference",
     "dop853:1e-4", "--repeats", "1"),
)  # fmt: skip
COMPILING = ("check", "run", "sweep", "statics", "bench")


def test_every_command_is_tried():
    assert {words[0] for words in COMMANDS} == {*cli.COMMANDS}
    assert {"h5py", "numba", "fcntl", "random", "yaml", "numpy", "click", "json"} <= {*NAMES}


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: words[0])
def test_no_command_executes_a_file_of_the_working_folder(words, folder, tmp_path):
    """With -m, which puts that folder in front of the path; in this order.

    Commands that need no machine code find no cache: the next test has nothing to add to them.
    """
    if (
        words[0] in ("status", "merge") and not (folder / words[1]).exists()
    ):  # where others did not run here
        sweep = next(one for one in COMMANDS if one[0] == "sweep")
        assert ended(folder, [sys.executable, "-m", "trsim"], *sweep)[0] == 0
    empty = {} if words[0] in COMPILING else {"XDG_CACHE_HOME": str(tmp_path)}
    code, said = ended(folder, [sys.executable, "-m", "trsim"], *words, **empty)
    assert not (folder / "executed").exists(), (folder / "executed").read_text()
    assert code == 0, said
    assert not kept(tmp_path)


SAFE = {
    "trsim": [str(Path(sys.executable).with_name("trsim"))],
    "python -P -m trsim": [sys.executable, "-P", "-m", "trsim"],
}


@pytest.mark.parametrize("how", SAFE)
def test_with_a_safe_path_none_is_executed(how, folder, tmp_path):
    """Not even what Python itself imports, or where a folder is called as its package is."""
    if how == "trsim" and not Path(SAFE[how][0]).exists():
        pytest.skip("it is not installed")
    here = tmp_path / "here"
    planted(folder, here)
    (here / "trsim").mkdir()
    missing = [here / f"{name}.py" for name in NAMES if not (here / f"{name}.py").exists()]
    for path in (here / "trsim" / "__init__.py", *missing):
        path.write_text(PLANTED)
    for words in (("check", "crank.yaml"), ("recover", "done.h5", "-o", "again.h5")):
        code, said = ended(here, SAFE[how], *words)
        assert not (here / "executed").exists(), (here / "executed").read_text()
        assert code == 0, said


@pytest.mark.parametrize(
    "words", [one for one in COMMANDS if one[0] in COMPILING], ids=lambda words: words[0]
)
def test_no_command_executes_one_with_an_empty_cache(words, folder, tmp_path):
    """Until it has compiled something and waits for more."""
    here = tmp_path / "here"
    planted(folder, here)
    shutil.rmtree(here / "many", ignore_errors=True)  # a sweep that is done compiles nothing
    environment = {**ENVIRONMENT, "XDG_CACHE_HOME": str(tmp_path / "cache")}
    process = subprocess.Popen(  # noqa: S603
        [sys.executable, "-m", "trsim", *words], cwd=here, env=environment,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    until = time.monotonic() + PATIENCE
    while process.poll() is None and time.monotonic() < until and not kept(tmp_path / "cache"):
        time.sleep(0.01)
    process.kill()
    process.wait()
    assert not (here / "executed").exists(), (here / "executed").read_text()
    assert kept(tmp_path / "cache")


def kept(cache):
    """The machine code in a cache folder."""
    return list(cache.glob("trsim/code/*.code"))


def test_the_second_process_of_a_first_run_executes_none(folder, tmp_path):
    command = child.command("trsim.kernels.ahead", "trsim.solve.methods.rk4")
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


OTHER_SETTINGS = {
    "of others": b"savefig.dpi: 20\naxes.facecolor: red\ntext.usetex: True\n",
    "unknown": b"no.such.key: 1\n",
    "no text": b"\xff\xfe",
    "never read": None,
}


EACH = """
import json, sys
from trsim.cli import main
for words in json.loads(sys.argv[1]):
    try:
        main(words)
    except SystemExit as ended:
        assert ended.code == 0, (words, ended.code)
"""
REPORT = [sys.executable, "-P", "-m", "trsim", "report", "done.h5", "--dpi", "40"]
ONE_FIGURE = ("--plot", "B.contact_force : stroke")


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """Figures where no settings lie beside the run: all of its report, and one asked for."""
    folder = tmp_path_factory.mktemp("alone")
    small.copy(folder / "done.h5", *ONE_OF_EACH)
    both = [[*REPORT[4:], *asked, "-o", name] for name, asked in (("all", ()), ("one", ONE_FIGURE))]
    code, said = ended(folder, [sys.executable, "-P", "-c", EACH], json.dumps(both))
    assert code == 0, said
    return folder


@pytest.mark.parametrize("settings", OTHER_SETTINGS)
def test_figures_do_not_depend_on_settings_of_the_folder(settings, alone, tmp_path):
    """matplotlib reads a file matplotlibrc of it, were it not imported elsewhere.

    It would be read with the import: one figure shows that a bad one is not, all show it of a good
    one.
    """
    small.copy(tmp_path / "done.h5", *ONE_OF_EACH)
    if OTHER_SETTINGS[settings] is None:
        os.mkfifo(tmp_path / "matplotlibrc")
    else:
        (tmp_path / "matplotlibrc").write_bytes(OTHER_SETTINGS[settings])
    name, asked = ("all", ()) if settings == "of others" else ("one", ONE_FIGURE)
    code, said = ended(tmp_path, REPORT, *asked, "-o", "beside", TRSIM_DEBUG="1")
    assert code == 0, said
    assert "matplotlibrc" not in said
    figures = sorted((alone / name).glob("*.png"))
    assert figures
    for figure in figures:
        assert (tmp_path / "beside" / figure.name).read_bytes() == figure.read_bytes()


def test_every_process_of_python_is_begun_in_one_place():
    """child.py; nothing else says which Python to run, or with which modules."""
    package = Path(child.__file__).parent
    found = {
        str(path.relative_to(package)) for path in package.rglob("*.py")
        if "sys.executable" in path.read_text() or "multiprocessing" in path.read_text()
    }  # fmt: skip
    assert found == {"child.py"}
