"""Machine code of others is not loaded: owners, modes, links, and where the folder is."""

import os
import re
import stat
import subprocess
import sys
from math import sin

import pytest

from tests import small
from tests.elsewhere import PATH, needs
from tests.store.outside import ROOT
from trsim.cli import main
from trsim.errors import ModelError
from trsim.kernels import kept
from trsim.kernels.machine import Compiled
from trsim.kernels.signatures import f8, float64
from trsim.solve.march import complete

SOMEBODY = 12345  # no user of this machine
AS_ROOT = hasattr(os, "geteuid") and os.geteuid() == 0  # only root can give files away


def plus(x):
    return sin(x) + 1.0


def fresh():
    return Compiled(plus, float64(f8))


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A cache folder with machine code in it."""
    home = tmp_path / "cache"
    monkeypatch.setenv("XDG_CACHE_HOME", str(home))
    kept._settled.cache_clear()
    fresh().address()
    kept._settled.cache_clear()
    yield home
    kept._settled.cache_clear()


@pytest.fixture
def no_compiler(monkeypatch):
    """What has to be compiled fails."""
    monkeypatch.setitem(sys.modules, "trsim.kernels.compiler", None)


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


@pytest.mark.parametrize("mask", [0o022, 0o002, 0o000])
def test_what_is_made_is_for_the_user_alone(mask, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "deep" / "cache"))
    before = os.umask(mask)
    try:
        fresh().address()
    finally:
        os.umask(before)
    code = kept.folder()
    assert code == tmp_path / "deep" / "cache" / "trsim" / "code"
    assert [mode(path) for path in (code, *code.parents[:3])] == [0o700] * 4
    assert {mode(path) for path in code.iterdir()} == {0o600}
    assert not kept.refused()


def test_it_is_loaded_again(home, no_compiler):
    assert fresh()(0.0) == 1.0 and not kept.refused()


def open_it(path):
    path.chmod(0o777)


def open_it_to_the_group(path):
    path.chmod(0o770)


def give_it_away(path):
    os.chown(path, SOMEBODY, SOMEBODY)


def link_it(path):
    aside = path.with_name("aside")
    path.rename(aside)
    path.symlink_to(aside)


CHANGES = {
    "open": (open_it, r"others may write in .* \(mode 777\)"),
    "open to the group": (open_it_to_the_group, r"others may write in .* \(mode 770\)"),
    "another's": (give_it_away, r"belongs to another user \(12345\)"),
    "link": (link_it, "is a link"),
}
FOLDERS = {"cache": ".", "trsim": "trsim", "code": "trsim/code"}
FINE = {("open to the group", "cache"), ("link", "cache")}  # what is below it is the user's alone


@pytest.mark.parametrize("folder", FOLDERS)
@pytest.mark.parametrize("change", CHANGES)
def test_a_folder_of_others_is_not_used(change, folder, home, monkeypatch):
    """A private one is, by children too, and it is gone at the end."""
    if change == "another's" and not AS_ROOT:
        pytest.skip("only root can give files away")
    if change != "link" and not hasattr(os, "geteuid"):
        pytest.skip("the test itself uses geteuid")
    alter, reason = CHANGES[change]
    alter(home / FOLDERS[folder])
    if (change, folder) in FINE:
        assert not kept.refused() and kept.folder() == home / "trsim" / "code"
        return
    before = sorted(home.rglob("*"))
    at_end = []
    monkeypatch.setattr(kept.atexit, "register", lambda *call: at_end.append(call))
    function = fresh()
    assert re.search(reason, kept.refused())
    assert function(0.0) == 1.0
    private = kept.folder()
    assert home not in private.parents and sorted(home.rglob("*")) == before
    assert os.environ["XDG_CACHE_HOME"] == str(private.parents[1])
    assert mode(private) == mode(private.parents[1]) == 0o700
    monkeypatch.setitem(sys.modules, "trsim.kernels.compiler", None)
    assert fresh()(0.0) == 1.0  # it was kept there
    [(remove, *given)] = at_end
    remove(*given)
    assert not private.parents[1].exists()


@needs("geteuid", "O_NOFOLLOW")
@pytest.mark.parametrize("change", [open_it, open_it_to_the_group, give_it_away, link_it])
def test_a_file_of_others_is_compiled_again(change, home, monkeypatch):
    """In an own folder that may be: somebody's backup, or a mode gone wrong."""
    if change is give_it_away and not AS_ROOT:
        pytest.skip("only root can give files away")
    file = fresh().file
    change(file)
    with pytest.raises(OSError):
        kept.content(file)
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "trsim.kernels.compiler", None)
        with pytest.raises(ImportError):
            fresh().address()
    assert fresh()(0.0) == 1.0
    assert mode(file) == 0o600 and not file.is_symlink()
    assert kept.content(file)


@pytest.mark.parametrize("kind", ["folder", pytest.param("pipe", marks=needs("mkfifo"))])
def test_what_is_no_file_is_not_read(kind, home):
    file = fresh().file
    file.unlink()
    os.mkfifo(file) if kind == "pipe" else file.mkdir()
    assert fresh()(0.0) == 1.0


@needs("geteuid", "O_NOFOLLOW")
def test_a_folder_that_changes_hands_meanwhile(home):
    """It is looked at whenever something is read, not only at the start."""
    assert kept.folder() == home / "trsim" / "code"
    kept.folder().chmod(0o777)
    with pytest.raises(PermissionError):
        kept.content(fresh().file)
    with pytest.raises(PermissionError):
        kept.store(kept.folder() / "x.code", [b""])
    assert fresh()(0.0) == 1.0


@pytest.mark.parametrize("given", ["", "relative/cache", "./cache", "~/cache"])
def test_a_relative_cache_folder_is_ignored(given, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path / "user"))
    monkeypatch.setenv("XDG_CACHE_HOME", given)
    assert kept.folder() == tmp_path / "user" / ".cache" / "trsim" / "code"
    fresh().address()
    assert [path.name for path in tmp_path.iterdir()] == ["user"]


def test_a_relative_home_is_none(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", "here")
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    assert "absolute" in kept.refused()
    fresh().address()
    assert not list(tmp_path.iterdir())
    kept._settled.cache_clear()


@needs("O_NOFOLLOW")
def test_a_lock_that_is_a_link_is_not_followed(home, tmp_path):
    """The file it leads to is not made."""
    lock = kept.folder() / "lock"
    lock.unlink(missing_ok=True)
    lock.symlink_to(tmp_path / "precious")
    fresh().file.unlink()
    assert fresh()(0.0) == 1.0
    assert not (tmp_path / "precious").exists()


@pytest.mark.skipif(not AS_ROOT, reason="only root can give files away")
def test_a_command_says_so_once_and_goes_on(home, tmp_path, capsys, monkeypatch):
    give_it_away(home / "trsim")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "crank.yaml").write_text(small.SLIDER_CRANK)
    (tmp_path / "again.yaml").write_text(small.SLIDER_CRANK)

    def refused(scenario):
        raise ModelError("compiling is left out")

    monkeypatch.setattr("trsim.kernels.ahead.begin", lambda *names: None)
    monkeypatch.setattr("trsim.assemble.assemble.assemble", refused)
    with pytest.raises(SystemExit):
        main(["run", "crank.yaml", "again.yaml"])
    said = capsys.readouterr().err
    assert said.count("belongs to another user (12345)") == 1
    assert "nothing is loaded from the cache" in said and "XDG_CACHE_HOME" in said


@pytest.mark.parametrize("fault", ["damaged", "cannot be looked into"])
def test_a_command_that_has_to_compile_says_so(fault, home, tmp_path, capsys, monkeypatch):
    """Also where there is a file of that name, or where nobody can tell."""
    looked_for = Compiled(complete.complete.python, complete.complete.signature)
    monkeypatch.setattr(complete, "complete", looked_for)  # that of other tests is left alone
    if fault == "damaged":
        kept.store(looked_for.file, [b"not machine code"])
    else:
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / ("long" * 100)))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "crank.yaml").write_text(small.SLIDER_CRANK)

    def refused(scenario):
        raise ModelError("compiling is left out")

    monkeypatch.setattr("trsim.kernels.ahead.begin", lambda *names: None)
    monkeypatch.setattr("trsim.assemble.assemble.assemble", refused)
    with pytest.raises(SystemExit) as ended:
        main(["run", "crank.yaml"])
    said = capsys.readouterr().err
    assert "compiling (once per installation" in said
    assert ("machine code cannot be kept" in said) == (fault != "damaged")
    assert ended.value.code == ModelError.exit_code


NOBODY = 65534
AS_NOBODY = """
import os
from tests.kernels.test_kept import fresh
from trsim.kernels import kept
function = fresh()
function.key  # what others may not read has been read
os.setgroups([])
os.setgid({0})
os.setuid({0})
print(kept.refused(), kept.folder(), function.file.exists(), sep="\\n")
if function.file.exists():
    assert function(0.0) == 1.0
"""


@pytest.mark.skipif(not AS_ROOT, reason="only root can give files away")
@pytest.mark.parametrize("change", ["root's", "open", "own"])
def test_what_another_user_finds(change, home, tmp_path):
    """A folder of root's, or one that all may write, is not used; his own is."""
    for path in [home, *home.rglob("*")]:
        path.chmod(0o777 if change == "open" else 0o755)
        if change != "root's":
            os.chown(path, NOBODY, NOBODY)
    # what is above it stays open: another process of the suite may be in it at the same time
    for path in (tmp_path, *tmp_path.parents):
        if mode(path) & 0o011 != 0o011:
            path.chmod(mode(path) | 0o011)
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", AS_NOBODY.format(NOBODY)], cwd=ROOT, capture_output=True,
        text=True, timeout=120, env={**os.environ, "PYTHONPATH": PATH},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    told, folder, there = done.stdout.splitlines()
    why = {"root's": r"belongs to another user \(0\)", "open": "others may write", "own": ""}
    assert re.search(why[change], told) and bool(told) == (change != "own")
    assert (folder == str(home / "trsim" / "code")) == (there == "True") == (change == "own")
