"""Machine code kept between runs: an undamaged one, or a fresh one (the key: test_fingerprint)."""

import gc
import sys
from math import sin
from pathlib import Path

import numpy as np
import pytest
from numba.core.errors import NumbaError
from numba.core.registry import cpu_target
from numba.core.types.functions import BaseFunction

from trsim.elements.contract import compiled
from trsim.kernels import fingerprint, machine
from trsim.kernels.lazy import internal
from trsim.kernels.machine import Compiled, folder
from trsim.kernels.packed import Packed
from trsim.kernels.signatures import A1, A2, T3, Kind, f8, float64, i8, int64, void

FACTOR = 2.0


@internal
def scaled(x):
    return FACTOR * x


def total(x, table, k, add):
    """Arguments of every kind."""
    for i in range(x.size):
        add += scaled(x[i]) * table[k, i]
    return add + sin(add)


TOTAL = float64(A1, A2, i8, f8)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return folder()


def arguments():
    return np.array([1.0, 2.0, 3.0]), np.arange(6.0).reshape(2, 3), 1, 0.5


def expected():
    x, table, k, add = arguments()
    add += float(FACTOR * x @ table[k])
    return add + np.sin(add)


def test_a_second_one_loads_what_the_first_has_kept(cache, monkeypatch):
    assert Compiled(total, TOTAL)(*arguments()) == pytest.approx(expected(), rel=1e-15)
    [file] = cache.glob("*.code")
    assert file.stat().st_size < 20_000
    monkeypatch.setitem(sys.modules, "trsim.kernels.compiler", None)  # an import would fail
    assert Compiled(total, TOTAL)(*arguments()) == pytest.approx(expected(), rel=1e-15)


@pytest.mark.parametrize("damage", ["cut", "flip", "empty"])
def test_damaged_code_is_compiled_again(damage, cache, monkeypatch):
    function = Compiled(total, TOTAL)
    function.address()
    content = function.file.read_bytes()
    middle = len(content) // 2
    damaged = {
        "cut": content[:middle],
        "flip": content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :],
        "empty": b"",
    }
    function.file.write_bytes(damaged[damage])
    assert Compiled(total, TOTAL)(*arguments()) == pytest.approx(expected(), rel=1e-15)
    monkeypatch.setitem(sys.modules, "trsim.kernels.compiler", None)
    assert Compiled(total, TOTAL).address()  # and kept again


def test_a_folder_that_cannot_be_written_to(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert Compiled(total, TOTAL)(*arguments()) == pytest.approx(expected(), rel=1e-15)


def test_what_cannot_be_kept_is_refused(cache):
    @compiled(void(A1))
    def allocates(x):
        x[:] = np.zeros(x.size) + 1.0

    with pytest.raises(NumbaError):
        allocates.address()


def test_what_another_process_compiled_meanwhile_is_taken(cache, monkeypatch):
    Compiled(total, TOTAL).address()
    seen, read = [], machine._read

    def later(path):  # as if it were not there at first
        seen.append(path)
        return read(path) if len(seen) > 1 else None

    monkeypatch.setattr(machine, "_read", later)
    monkeypatch.setitem(sys.modules, "trsim.kernels.compiler", None)
    assert Compiled(total, TOTAL)(*arguments()) == pytest.approx(expected(), rel=1e-15)


@pytest.mark.parametrize("first", ["Python", "compiled code"])
def test_a_law_called_from_both_sides(first, cache):
    @internal
    def inside(x):
        return min(x, 2.0) + 1.0

    @internal
    def outside(x):
        return 2.0 * inside(x)

    @compiled(float64(f8))
    def kernel(x):
        return outside(x)

    order = [outside, kernel] if first == "Python" else [kernel, outside]
    assert [call(x) for call in order for x in (1.0, 3.0)] == [4.0, 6.0, 4.0, 6.0]


def test_numba_is_left_as_it_was(cache):
    def state():
        typing, target = cpu_target.typing_context, cpu_target.target_context
        inside = "refresh" in vars(typing), "refresh" in vars(target), gc.isenabled()
        return BaseFunction.get_call_type, target.codegen()._library_class, inside

    Compiled(total, TOTAL).address()
    before = state()
    with pytest.raises(NumbaError):
        Compiled(lambda x: x.nothing, float64(f8)).address()
    assert state() == before and before[2] == (False, False, True)


def test_results():
    @compiled(int64(i8, A1))
    def count(k, x):
        return k + x.size

    @compiled(void(A1, f8))
    def fill(x, value):
        for k in range(x.size):
            x[k] = value

    assert count(3, np.zeros(4)) == 7
    x = np.zeros(3)
    assert fill(x, 2.5) is None and x.tolist() == [2.5] * 3


@pytest.mark.parametrize(
    "wrong",
    [
        (np.zeros((2, 2)), np.zeros((2, 3)), 1, 0.5),  # dimensions
        (np.zeros(3, np.int64), np.zeros((2, 3)), 1, 0.5),  # type
        (np.zeros(6)[::2], np.zeros((2, 3)), 1, 0.5),  # not contiguous
        (np.zeros(3), np.zeros((2, 3)), 1),  # one missing
    ],
)
def test_wrong_arguments(wrong):
    with pytest.raises(TypeError):
        Compiled(total, TOTAL)(*wrong)


# --- the key ---------------------------------------------------------------------------------


def key(python=total, signature=TOTAL):
    fingerprint._function.cache_clear()
    return fingerprint.of(python, signature)


def test_the_key_follows_what_the_code_depends_on(monkeypatch):
    before = key()
    assert key() == before
    assert key(signature=float64(A1, A2, i8, i8)) != before
    monkeypatch.setitem(globals(), "FACTOR", 3.0)  # read by a function that `total` calls
    assert key() != before
    monkeypatch.setitem(globals(), "FACTOR", 2.0)
    monkeypatch.setitem(globals(), "scaled", internal(lambda x: FACTOR * x * x))
    assert key() != before


def test_the_key_follows_the_fields_of_records():
    class One(Packed):
        a: A1
        n: i8

    class Other(Packed):
        a: A1
        b: A1
        n: i8

    other = Kind("One", fields=Other.kind.fields)
    assert key(signature=void(One.kind)) != key(signature=void(other))
    with pytest.raises(TypeError, match="missing or unknown"):
        One(a=np.zeros(2))
    with pytest.raises(TypeError, match="dimensions"):
        One(a=np.zeros((2, 2)), n=1)


def test_tables_are_as_wide_as_code_takes_them_to_be():
    class Table(Packed):
        a: T3

    @compiled(float64(Table.kind))
    def corner(table):
        return table.a[1, 2]

    values = np.arange(6.0).reshape(2, 3)
    assert corner(Table(a=values)) == 5.0
    assert corner(Table(None, {"a": (2, 3)})) == 0.0
    with pytest.raises(TypeError, match="2 columns instead of 3"):
        Table(a=np.zeros((3, 2)))
    with pytest.raises(TypeError, match="2 columns instead of 3"):
        Table(None, {"a": (3, 2)})


def test_no_index_counts_from_the_end():
    """Compiled code takes an index as it stands: a negative one would read beside the array."""
    import ast

    package, found = Path(machine.__file__).parents[1], []
    names = ("kernels", "elements", "laws", "assemble", "solve")
    for path in (path for name in names for path in (package / name).rglob("*.py")):
        for function in ast.walk(ast.parse(path.read_text())):
            if not isinstance(function, ast.FunctionDef) or not compiled_by(function):
                continue
            found += [
                f"{path.name}:{node.lineno}"
                for node in ast.walk(function)
                if isinstance(node, ast.Subscript)
                for part in ast.walk(node.slice)
                if isinstance(part, ast.UnaryOp) and isinstance(part.op, ast.USub)
            ]
    assert not found


def compiled_by(function):
    """Whether a function is compiled: one of our decorators stands above it."""
    import ast

    names = {"compiled", "internal", "equation", "kernel", "helper", "law"}
    return any(names & {n.id for n in ast.walk(d) if isinstance(n, ast.Name)}
               for d in function.decorator_list)  # fmt: skip
