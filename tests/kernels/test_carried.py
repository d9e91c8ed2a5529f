"""Machine code that comes with the package: used where it fits to the last bit, else not at all."""

import json
import os
import platform
import subprocess
import sys
import zlib
from pathlib import Path

import h5py
import numpy as np
import pytest

from tests.kernels.objects import sections
from tests.kernels.test_machine import TOTAL, arguments, expected, total
from tests.sizes import RELEASE
from trsim.assemble.assemble import assemble
from trsim.kernels import carried, carry, fingerprint, kept, machine
from trsim.kernels.columns import Columns
from trsim.kernels.lazy import PYTHON, internal
from trsim.kernels.machine import Compiled
from trsim.kernels.packed import A2, Packed
from trsim.kernels.signatures import f8, float64, i8
from trsim.scenario.load import load
from trsim.solve.methods.rk4 import step

pytestmark = [
    pytest.mark.skipif(PYTHON, reason="nothing is compiled"),
    pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="another processor"),
]
ROOT = Path(__file__).parents[2]
SCENARIOS = ROOT / "scenarios"
BASE, BEST = "x86-64", "x86-64-v3"


@pytest.fixture
def place(tmp_path, monkeypatch):
    """An empty cache, and a folder of code that is carried, empty as yet."""
    (tmp_path / "carried").mkdir()
    (tmp_path / "cache").mkdir(0o700)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(carried, "FOLDER", tmp_path / "carried")
    monkeypatch.setattr(carried, "_told", [])
    carried._chosen.cache_clear()
    yield tmp_path / "carried"
    carried._chosen.cache_clear()


def carry_some(place, *functions, targets=(BASE,)):
    return carry.carry(list(functions), targets, place)


def compiled(function, monkeypatch, capfd):
    """Whether calling it compiles, what is said of it, and what it returns."""
    seen, original = [], Compiled._compiled

    def watched(one):
        seen.append(one)
        return original(one)

    monkeypatch.setattr(Compiled, "_compiled", watched)
    value = function(*arguments())
    return bool(seen), capfd.readouterr().err, value


def used(function, monkeypatch, capfd):
    """Whether code that is carried is used: nothing is compiled, kept or said."""
    monkeypatch.setitem(sys.modules, "trsim.kernels.compiler", None)  # an import would fail
    value = function(*arguments())
    return value == pytest.approx(expected(), rel=1e-15) and not any(kept.folder().glob("*"))


def refused(function, monkeypatch, capfd):
    """What is said where code that is carried is not used; results are as ever."""
    compiles, said, value = compiled(function, monkeypatch, capfd)
    assert compiles and value == pytest.approx(expected(), rel=1e-15)
    return said


def test_what_is_carried_is_used(place, monkeypatch, capfd):
    carry_some(place, Compiled(total, TOTAL))
    capfd.readouterr()
    assert Compiled(total, TOTAL).known
    assert used(Compiled(total, TOTAL), monkeypatch, capfd)
    assert capfd.readouterr().err == ""


def test_code_of_the_user_comes_first(place, monkeypatch):
    own = Compiled(total, TOTAL)
    own.address()
    carry_some(place, Compiled(total, TOTAL))
    monkeypatch.setattr(carried, "code", None)  # calling it would fail
    assert Compiled(total, TOTAL)(*arguments()) == pytest.approx(expected(), rel=1e-15)


def test_where_nothing_is_carried_nothing_is_said(place, monkeypatch, capfd):
    assert refused(Compiled(total, TOTAL), monkeypatch, capfd) == ""


# --- what does not fit ---------------------------------------------------------------------------


def other(x, table, k, add):
    """As `total` was before somebody edited it."""
    return add - x[0] * table[k, 0]


@pytest.mark.parametrize("named", ["total", "other"])
def test_other_sources_are_compiled(named, place, monkeypatch, capfd):
    monkeypatch.setattr(other, "__name__", named)
    monkeypatch.setattr(other, "__module__", total.__module__)
    carry_some(place, Compiled(other, TOTAL))
    capfd.readouterr()
    said = refused(Compiled(total, TOTAL), monkeypatch, capfd)
    assert ("test_machine.total was changed since" in said) == (named == "total")


def test_another_constant_is_other_sources(place, monkeypatch):
    carry_some(place, Compiled(total, TOTAL))
    assert carried.code(total, TOTAL)
    monkeypatch.setitem(total.__globals__, "FACTOR", 3.0)
    monkeypatch.setattr(fingerprint, "_function", fingerprint._function.__wrapped__)
    assert carried.code(total, TOTAL) is None


def laid_out(first, second):
    """The same function of a record, with its fields, and the columns of a row, in some order."""
    record = type("Table", (Packed,), {"__annotations__": dict.fromkeys([first, second], "A2")})
    own = type("Own", (Columns,), {"__annotations__": dict.fromkeys([first, second], f8)})

    def read(s, e):
        return own(s, e).a

    return read, float64(record.kind, i8)


def test_another_layout_is_other_sources(place):
    assert A2
    (one, kinds), (two, swapped) = laid_out("par", "a"), laid_out("a", "par")
    (same, again) = laid_out("par", "a")
    assert carried.key(one, kinds) == carried.key(same, again)
    assert len({carried.key(f, k) for f in (one, two) for k in (kinds, swapped)}) == 4


def rewrite(path, change):
    """Change what a file says of itself, digest and all."""
    told, begin = carried.index(path)
    change(told)
    carried.write(path, told, path.read_bytes()[begin:])
    carried._chosen.cache_clear()


CHANGES = {
    "system": (lambda i: i["for"].update(system="x86_64 plan9"), "system: x86_64 plan9 there"),
    "features": (lambda i: i["for"].update(features=["avx9"]), "features: avx9 there, none here"),
    "files": (
        lambda i: i["for"].update({"files of trsim that make code": "0"}),
        "files of trsim that make code: 0 there",
    ),
    "more": (lambda i: i["for"].update(more="1"), "more: 1 there, None here"),
    "less": (lambda i: i["for"].pop("system"), "system: None there"),
    "python": (
        lambda i: i.update(keys={"cpython 3.9": i["keys"][carried.python()]}),
        f"it is for cpython 3.9, this is {carried.python()}",
    ),
}


@pytest.mark.parametrize("what", CHANGES)
def test_code_made_for_something_else_is_not_used(what, place, monkeypatch, capfd):
    change, why = CHANGES[what]
    [path] = carry_some(place, Compiled(total, TOTAL))
    rewrite(path, lambda index: None)
    assert carried.code(total, TOTAL)
    rewrite(path, change)
    capfd.readouterr()
    said = refused(Compiled(total, TOTAL), monkeypatch, capfd)
    assert len(said.splitlines()) == 1 and why in said
    kept.folder().joinpath("x").parent.mkdir(exist_ok=True)
    for file in kept.folder().glob("*.code"):
        file.unlink()
    assert refused(Compiled(total, TOTAL), monkeypatch, capfd) == ""  # told once


def test_settings_of_numba(place, monkeypatch, capfd):
    carry_some(place, Compiled(total, TOTAL))
    monkeypatch.setenv("NUMBA_OPT", "2")
    assert carried.code(total, TOTAL) is None
    assert "variables of numba: none there, ['NUMBA_OPT', '2'] here" in carried._chosen(place)[1]


@pytest.mark.parametrize("version", ["0.61", "0.99", "(none)"])
def test_a_numba_that_may_call_otherwise(version, place, monkeypatch):
    carry_some(place, Compiled(total, TOTAL))
    monkeypatch.setattr(carried, "numba", lambda: version)
    assert carried.code(total, TOTAL) is None
    assert f"numba {version} is not" in carried._chosen(place)[1]


def test_the_numba_that_is_here_is_known():
    import numba

    assert carried.numba() == ".".join(map(str, numba.version_info[:2]))


# --- processors ----------------------------------------------------------------------------------


def test_a_processor_gets_no_code_it_cannot_run(place, monkeypatch, capfd):
    best, base = carry_some(place, Compiled(total, TOTAL), targets=(BEST, BASE))
    can = set(carried.TARGETS[BEST])
    for has, chosen in [(can, best), (can | {"avx512f"}, best), (can - {"fma"}, base)]:
        monkeypatch.setattr(carried, "processor", lambda has=has: has)
        carried._chosen.cache_clear()
        assert carried._chosen(place)[0].path == chosen
    base.unlink()
    carried._chosen.cache_clear()
    capfd.readouterr()
    said = refused(Compiled(total, TOTAL), monkeypatch, capfd)
    assert "this processor lacks fma" in said


@pytest.mark.parametrize("target", carried.TARGETS)
def test_features_of_this_processor(target):
    """LLVM knows every word; what is asked for beyond it would be ignored."""
    import llvmlite.binding as llvm

    assert set(carried.TARGETS[target]) <= llvm.get_host_cpu_features().keys()
    assert carried.processor() == {k for k, has in llvm.get_host_cpu_features().items() if has}


# --- damage --------------------------------------------------------------------------------------


@pytest.mark.parametrize("at", ["digest", "index", "code", "cut index", "cut code", "empty"])
def test_damaged_code_is_not_used(at, place, monkeypatch, capfd):
    [path] = carry_some(place, Compiled(total, TOTAL))
    content = path.read_bytes()
    begin = len(content) - len(content.split(b"\n", 2)[2])
    flips = {"digest": 3, "index": 90, "code": begin + (len(content) - begin) // 2}
    cuts = {"cut index": begin // 2, "cut code": len(content) - 5, "empty": 0}
    if at in flips:
        k = flips[at]
        content = content[:k] + bytes([content[k] ^ 1]) + content[k + 1 :]
    path.write_bytes(content[: cuts.get(at)])
    capfd.readouterr()
    said = refused(Compiled(total, TOTAL), monkeypatch, capfd)
    assert len(said.splitlines()) == 1 and "x86-64.code is damaged" in said


def test_every_bit_of_what_is_packed_counts(place):
    """No flipped bit gives other code than was made."""
    [path] = carry_some(place, Compiled(total, TOTAL))
    content, whole = path.read_bytes(), carried.code(total, TOTAL)
    begin = len(content) - len(content.split(b"\n", 2)[2])
    for k in range(begin, len(content), 7):
        path.write_bytes(content[:k] + bytes([content[k] ^ 16]) + content[k + 1 :])
        assert carried.code(total, TOTAL) in (None, whole)


def test_code_that_unpacks_and_is_not_what_was_made_is_not_used(place):
    [path] = carry_some(place, Compiled(total, TOTAL))
    told, begin = carried.index(path)
    whole = zlib.decompress(path.read_bytes()[begin:])
    assert carried.code(total, TOTAL)
    for k in range(70, len(whole), 101):  # behind its digest
        packed = zlib.compress(whole[:k] + bytes([whole[k] ^ 1]) + whole[k + 1 :])
        told["places"][0][1] = len(packed)
        carried.write(path, told, packed)
        carried._chosen.cache_clear()
        assert carried.code(total, TOTAL) is None


def test_code_of_another_function_is_not_taken_for_it(place):
    """As where a file is exchanged under a process that has read its index."""
    [path] = carry_some(place, Compiled(total, TOTAL), Compiled(other, TOTAL))
    assert carried.code(total, TOTAL)
    rewrite(path, lambda told: told["places"].__setitem__(0, told["places"][1]))
    assert "other" in carried.code(total, TOTAL)[0]  # who writes the index is believed
    carried._chosen(place)[0].places[0][2] = "0" * 64
    assert carried.code(total, TOTAL) is None


# --- making --------------------------------------------------------------------------------------


def test_what_was_made_is_not_made_again(place, monkeypatch):
    [path] = carry_some(place, Compiled(total, TOTAL))
    content = path.read_bytes()
    monkeypatch.setattr(Compiled, "translated", None)
    assert carry_some(place, Compiled(total, TOTAL)) == [path]
    assert path.read_bytes() == content


def test_a_part_that_is_damaged_is_made_again(place):
    carry_some(place, Compiled(total, TOTAL))
    [part] = (place / "parts").rglob("*.code")
    part.write_bytes(part.read_bytes()[:-1])
    carry_some(place, Compiled(total, TOTAL))
    carried._chosen.cache_clear()
    assert carried.code(total, TOTAL) == carried.opened(part.read_bytes()) is not None


def test_another_python_finds_the_same_code_by_keys_of_its_own(place, monkeypatch):
    [path] = carry_some(place, Compiled(total, TOTAL), Compiled(other, TOTAL))
    whole = carried.code(total, TOTAL)
    monkeypatch.setattr(carried, "python", lambda: "cpython 3.99")
    carried._chosen.cache_clear()
    assert carried.code(total, TOTAL) is None
    carry.add_keys([Compiled(other, TOTAL), Compiled(total, TOTAL)], path)
    carried._chosen.cache_clear()
    assert carried.code(total, TOTAL) == whole is not None
    monkeypatch.undo()
    monkeypatch.setattr(carried, "FOLDER", place)
    carried._chosen.cache_clear()
    assert carried.code(total, TOTAL) == whole


def test_no_keys_are_added_for_other_sources(place, monkeypatch):
    """Bytecode of an edited function would find the machine code it had before."""
    [path] = carry_some(place, Compiled(total, TOTAL))
    before = path.read_bytes()
    with pytest.raises(ValueError, match="other sources"):
        carry.add_keys([Compiled(other, TOTAL)], path)
    monkeypatch.setattr(carry, "sources", lambda: "edited")
    with pytest.raises(ValueError, match="other sources"):
        carry.add_keys([Compiled(total, TOTAL)], path)
    assert path.read_bytes() == before


def closed(numbers):
    """Functions of one place that differ by what is in their cells."""

    def of(n, inside):
        def f(x):
            return inside(x) + n

        return f

    def one(x):
        return x

    def two(x):
        return 2.0 * x

    return [of(n, internal(g)) for n in numbers for g in (one, two)]


def test_marks_tell_functions_apart_as_keys_do(monkeypatch):
    found = closed([1, 2])
    marks = [fingerprint.mark(f, float64(f8)) for f in found]
    assert len(set(marks)) == 4 and marks == [
        fingerprint.mark(f, float64(f8)) for f in closed([1, 2])
    ]
    ours = carry.functions()
    assert len({carry._mark(one) for one in ours}) == len(ours)


def test_functions_are_all_there_before_a_scenario_is_read():
    """No scenario of the project makes a compiled function that is not carried."""
    there = {carried.key(one.python, one.signature) for one in carry.functions()}
    assert len(there) > 200
    others = "thrust_reverser/clearance_ab_0.3mm.yaml", "thrust_reverser/spatial_shaft.yaml"
    paths = [SCENARIOS / name for name in (*others, "crew_door/closing.yaml")]
    for path in (*paths, *sorted((SCENARIOS / "validation").glob("*.yaml"))):
        assemble(load(path))
    ours = [one for one in machine.made if one.python.__module__.startswith("trsim.")]
    assert {carried.key(one.python, one.signature) for one in ours} == there


SAME = """
from tests.kernels.objects import sections
from trsim.solve.methods.rk4 import step
print(sections(step.translated()[1]))
"""


@pytest.mark.parametrize("target", carried.TARGETS)
def test_code_is_what_numba_makes_for_that_processor(target):
    features = ",".join(f"+{name}" for name in carried.TARGETS[target]) or "+sse2"
    asked = {"NUMBA_CPU_NAME": "x86-64", "NUMBA_CPU_FEATURES": features}
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", SAME], cwd=ROOT, env={**os.environ, **asked},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    made = sections(step.translated(carry.processor(target))[1])
    assert max(len(data) for _, data in made) > 1000
    assert done.stdout.strip() == str(made)


# --- a first run ---------------------------------------------------------------------------------

SCENE = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
gravity: [0, -9.81, 0]
solver: {end: 0.5 s}
"""
FIRST = """
import json, sys
from pathlib import Path
from trsim.kernels import carried, machine
carried.FOLDER = Path(sys.argv[1])
from trsim.cli import main
sys.argv = ["trsim", "run", "scene.yaml", "-o", sys.argv[2]]
try:
    main()
except SystemExit as end:
    assert not end.code
asked = [carried.key(f.python, f.signature) for f in machine.made if "entry" in vars(f)]
print(json.dumps([asked, [n for n in ("numba", "trsim.kernels.compiler") if n in sys.modules]]))
"""


def first(folder, carries, out, **environment):
    """The functions that a run asks for, what it imports to compile, and what it says."""
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", FIRST, str(carries), out], cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return *json.loads(done.stdout.splitlines()[-1]), done.stderr


def channels(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(
            lambda name, one: (
                found.update({name: one[()]})
                if isinstance(one, h5py.Dataset) and one.dtype.kind == "f"
                else None
            )
        )
    return found


MADE = ("elements.", "assemble.equations.")  # what adds up forces, at each step


def test_a_first_run_compiles_nothing(tmp_path, monkeypatch):
    """Half a minute goes into compiling all it needs for another processor: a release does.  Else
    those functions are, that the numbers of a run come from; of others the code is taken along that
    the run before left in the cache."""
    (tmp_path / "scene.yaml").write_text(SCENE)
    asked, _, _ = first(tmp_path, tmp_path / "none", "compiled.h5")
    (tmp_path / "carried").mkdir()
    wanted = [f for f in carry.functions() if carried.key(f.python, f.signature) in asked]
    assert len(wanted) == len(set(asked)) > 20
    made, translated = [], Compiled.translated

    def taken(one, processor=None):
        name = carried.name(one.python)
        there = None if RELEASE or name.startswith(MADE) else machine._read(one.file)
        made.extend([name] * (there is None))
        return there or translated(one, processor)

    monkeypatch.setattr(Compiled, "translated", taken)
    carry.carry(wanted, (BASE,), tmp_path / "carried")
    assert {"elements.gravity.force", "assemble.equations.derivative"} < set(made)
    cache = tmp_path / "cache"
    cache.mkdir(0o700)
    again, imported, said = first(
        tmp_path, tmp_path / "carried", "carried.h5", XDG_CACHE_HOME=str(cache)
    )
    assert again == asked and not imported
    assert "compiling" not in said and not list(cache.rglob("*.code"))
    mine, theirs = channels(tmp_path / "carried.h5"), channels(tmp_path / "compiled.h5")
    assert mine.keys() == theirs.keys() and mine
    for name, value in mine.items():
        # 0.5 s of a pendulum: a rounding grows tenfold at most
        np.testing.assert_allclose(value, theirs[name], rtol=1e-9, atol=1e-9, err_msg=name)
