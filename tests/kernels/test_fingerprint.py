"""The key of a kernel: whatever its machine code depends on changes it, found here another way."""

import ast
import os
import pkgutil
import re
import subprocess
import sys
from collections import defaultdict
from enum import IntEnum
from functools import cache, partial
from importlib import import_module
from math import isfinite
from pathlib import Path
from types import FunctionType, ModuleType

import numpy as np
import pytest

import trsim
from trsim.kernels import fingerprint, machine
from trsim.kernels.lazy import Lazy, internal
from trsim.kernels.machine import Caller, Compiled
from trsim.kernels.signatures import f8, float64
from trsim.sweeps.slot import ONE_THREAD

# --- every kernel of the package -----------------------------------------------------------------


ROOMS = ("kernels", "laws", "elements", "assemble", "solve")


@cache
def kernels():
    """All functions that are compiled and kept."""
    found = {}
    for name in ROOMS:
        folder = Path(trsim.__file__).parent / name
        for module in pkgutil.walk_packages([str(folder)], f"trsim.{name}."):
            for value in vars(import_module(module.name)).values():
                if isinstance(value, Compiled):
                    found[value.python] = value
    return list(found.values())


def test_no_other_package_has_kernels():
    package = Path(trsim.__file__).parent
    decorated = re.compile(r"^@(compiled|kernel|equation|helper|internal|law)\b", re.MULTILINE)
    having = [path for path in package.rglob("*.py") if decorated.search(path.read_text())]
    assert {path.relative_to(package).parts[0] for path in having} == set(ROOMS)


@cache
def tree(file):
    """The functions of a source file by the line they begin in."""
    found = {}
    for node in ast.walk(ast.parse(Path(file).read_text())):
        if isinstance(node, ast.FunctionDef):
            first = min(node.lineno, *(d.lineno for d in node.decorator_list), node.lineno)
            found[node.name, first] = node
    return found


@cache
def read(python):
    """What the source of a function names beside its own variables: (namespace, name) -> value."""
    code = python.__code__
    node = tree(code.co_filename)[code.co_name, code.co_firstlineno]
    body = [part for statement in node.body for part in ast.walk(statement)]
    own = {a.arg for a in ast.walk(node.args) if isinstance(a, ast.arg)}
    own |= {n.id for n in body if isinstance(n, ast.Name) and not isinstance(n.ctx, ast.Load)}
    found = {}
    for part in body:
        if isinstance(part, ast.Name) and part.id not in own and part.id in python.__globals__:
            found[id(python.__globals__), part.id] = python.__globals__, part.id
        names = dotted(part)
        if names and names[0] not in own and names[0] in python.__globals__:
            scope = python.__globals__
            for name in names[:-1]:
                if not isinstance(scope.get(name), ModuleType):
                    break
                scope = vars(scope[name])
            else:
                found[id(scope), names[-1]] = scope, names[-1]
    return [(scope, name) for scope, name in found.values()
            if not isinstance(scope[name], ModuleType)]  # fmt: skip


def dotted(node):
    """The names of a.b.c."""
    names = []
    while isinstance(node, ast.Attribute):
        names.append(node.attr)
        node = node.value
    return [node.id, *reversed(names)] if isinstance(node, ast.Name) and names else []


def callees(python):
    """The functions of ours that a function reaches at once."""
    values = [scope[name] for scope, name in read(python)]
    return [value.python for value in values if isinstance(value, Lazy)]


@cache
def reached(python):
    """A function and all that it reaches."""
    found, waiting = set(), [python]
    while waiting:
        one = waiting.pop()
        if one not in found:
            found.add(one)
            waiting += callees(one)
    return found


@pytest.fixture
def told(monkeypatch):
    """told(kernel, edited): the digest in its key; what reaches `edited` is read again."""
    kept, callers, whole = {}, defaultdict(set), fingerprint._function.__wrapped__

    def remembered(python, told_of):
        if python not in kept:
            kept[python] = whole(python, told_of)
            for callee in kept[python].reached:
                callers[callee].add(python)
        return kept[python]

    def key(kernel, edited=()):
        for python in above(edited, callers) if edited else ():
            kept.pop(python, None)
        return fingerprint._function(kernel.python, fingerprint._code).digest

    monkeypatch.setattr(fingerprint, "_function", remembered)
    return key


def above(edited, callers):
    """Functions, and all whose digests were made of theirs at any time."""
    found, waiting = set(), list(edited)
    while waiting:
        one = waiting.pop()
        if one not in found:
            found.add(one)
            waiting += callers.get(one, ())
    return found


def test_an_edit_of_any_function_changes_the_keys_of_all_kernels_that_reach_it(told):
    before = {kernel: told(kernel) for kernel in kernels()}
    everything = set().union(*(reached(kernel.python) for kernel in kernels()))
    assert len(kernels()) > 90 and len(everything) > 400
    missed = []
    for python in everything:
        code = python.__code__
        python.__code__ = code.replace(co_consts=(*code.co_consts, "edited"))
        first = (python,)
        for kernel in kernels():
            if python in reached(kernel.python):
                if told(kernel, first) == before[kernel]:
                    missed.append((kernel.file.name, python.__qualname__))
                first = ()
        python.__code__ = code
        told(kernels()[0], (python,))
    assert not missed
    assert {kernel: told(kernel) for kernel in kernels()} == before


def other(value):
    """Another value of the same kind."""
    if isinstance(value, int | float):
        return value + max(1, abs(value)) if isfinite(value) else 0.0
    if isinstance(value, np.ndarray):
        changed = value.copy()
        changed.flat[-1] += 1
        return changed
    if isinstance(value, tuple):
        return (*value[:-1], other(value[-1]))
    if isinstance(value, Caller):
        return Caller(float64(*value.signature.arguments, f8))
    return None


def test_another_value_of_any_constant_changes_the_keys_of_all_kernels_that_read_it(told):
    before = {kernel: told(kernel) for kernel in kernels()}
    everything = set().union(*(reached(kernel.python) for kernel in kernels()))
    places, readers = {}, defaultdict(set)
    for python in everything:
        for scope, name in read(python):
            places[id(scope), name] = scope, name
            readers[id(scope), name].add(python)
    missed, changed = [], 0
    for place, (scope, name) in places.items():
        value = scope[name]
        replaced = other(value)
        if replaced is None:
            assert isinstance(value, Lazy) or callable(value)
            continue
        changed += 1
        scope[name] = replaced
        first = tuple(readers[place])
        for kernel in kernels():
            if not readers[place].isdisjoint(reached(kernel.python)):
                if told(kernel, first) == before[kernel]:
                    missed.append((kernel.file.name, name))
                first = ()
        scope[name] = value
        told(kernels()[0], tuple(readers[place]))
    assert not missed and changed > 300


def test_the_files_that_tell_numba_how_to_compile_are_in_every_key():
    """All of the package that making machine code imports, but what is told by its content."""
    package, found, waiting = Path(trsim.__file__).parent, set(), ["kernels/compiler.py"]
    while waiting:
        file = waiting.pop()
        if file in found:
            continue
        found.add(file)
        for node in ast.walk(ast.parse((package / file).read_text())):
            named = [node.module] if isinstance(node, ast.ImportFrom) else []
            named += [a.name for a in node.names] if isinstance(node, ast.Import) else []
            for name in (n for n in named if n.startswith("trsim.")):
                path = Path(*name.split(".")[1:])
                is_folder = (package / path).is_dir()
                waiting.append(str(path / "__init__.py" if is_folder else path.with_suffix(".py")))
    assert found <= set(fingerprint.COMPILER)
    assert "kernels/fingerprint.py" in fingerprint.COMPILER


def test_the_settings_of_numba_are_in_every_key(monkeypatch):
    before = fingerprint._surroundings.__wrapped__()
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    assert fingerprint._surroundings.__wrapped__() != before


def test_what_a_sweep_gives_its_processes_is_in_none(monkeypatch):
    """They load what a run has compiled."""
    before = fingerprint._surroundings.__wrapped__()
    for name in ONE_THREAD:
        monkeypatch.setenv(name, "7")
    assert fingerprint._surroundings.__wrapped__() == before


# --- ways to reach something ---------------------------------------------------------------------


def function(source, **scope):
    """A function of its own, with the globals given."""
    exec(compile(source, "test", "exec"), scope)  # noqa: S102
    return scope["f"]


def one(x):
    return x + 1.0


def two(x):
    return x + 2.0


def modules(value):
    """value, as an attribute of a module in a module."""
    outer, inner = ModuleType("outer"), ModuleType("outer.inner")
    outer.inner, inner.g = inner, value
    return outer


def closed(value):
    def f(x):
        return value(x) if callable(value) else value + x

    return f


PLAIN = "def f(x): return g(x)"
HELD = "def f(x):\n  h = m.inner.g\n  return h(x)"
NAMES = [f"name_{k}" for k in range(300)]  # more than a byte can count
MANY = f"def f(x):\n  y = {'+'.join(NAMES)}\n  return m.inner.g(x)"
WAYS = {
    "by name": lambda g: function(PLAIN, g=g),
    "law": lambda g: function(PLAIN, g=internal(g)),
    "kernel": lambda g: function(PLAIN, g=Compiled(g, float64(f8))),
    "module": lambda g: function("def f(x): return m.inner.g(x)", m=modules(g)),
    "a law of a module": lambda g: function(
        "def f(x): return m.inner.g(x)", m=modules(internal(g))
    ),
    "module, as a value": lambda g: function(HELD, m=modules(g)),
    "many names": lambda g: function(MANY, m=modules(g), **dict.fromkeys(NAMES, 1)),
    "closure": closed,
    "closure of a closure": lambda g: closed(closed(g)),
    "default": lambda g: function("def f(x, h=g): return h(x)", g=g),
    "named default": lambda g: function("def f(x, *, h=g): return h(x)", g=g),
    "tuple": lambda g: function("def f(x): return g[1][0](x)", g=(1, (g,))),
    "dictionary": lambda g: function("def f(x): return g['a'](x)", g={"a": g}),
    "inner function": lambda g: function("def f(x):\n  def h(y): return g(y)\n  return h(x)", g=g),
    "comprehension": lambda g: function("def f(x): return sum([g(y) for y in x])", g=g),
    "decorated": lambda g: closed(partial_of(g)),
}


def partial_of(g):
    """A function around another."""

    def around(x):
        return g(x)

    return around


def key(python):
    fingerprint._function.cache_clear()
    return fingerprint.of(python, float64(f8))


@pytest.mark.parametrize("way", WAYS)
def test_a_function_is_seen_whichever_way_it_is_reached(way):
    assert key(WAYS[way](one)) == key(WAYS[way](one)) != key(WAYS[way](two))


class Colour(IntEnum):
    RED = 1


class Other(IntEnum):
    RED = 2


Other.__qualname__ = Colour.__qualname__

VALUES = {
    "number": (1.0, 2.0),
    "kind of number": (1, 1.0),
    "truth": (1, True),
    "sign of zero": (0.0, -0.0),
    "last digit": (0.1, 0.1 + 2e-17),
    "text": ("a", "b"),
    "tuple": ((1, (2.0, 3.0)), (1, (2.0, 4.0))),
    "nesting": (((1, 2), 3), (1, 2, 3)),
    "list": ([1, 2], [1, 3]),
    "dictionary": ({"a": 1}, {"a": 2}),
    "set": (frozenset("ab"), frozenset("ac")),
    "array": (np.zeros(3), np.array([0.0, 0.0, 1e-300])),
    "type of array": (np.zeros(3), np.zeros(3, np.int64)),
    "shape": (np.zeros((2, 3)), np.zeros((3, 2))),
    "order": (np.zeros((2, 3)), np.zeros((2, 3), order="F")),
    "array in a tuple": ((np.zeros(2),), (np.ones(2),)),
    "numpy's number": (np.float64(1.0), np.float64(2.0)),
    "member": (Colour.RED, Other.RED),
    "enumeration": (Colour, Other),
    "signature": (Caller(float64(f8)), Caller(float64(f8, f8))),
}
READERS = {
    "global": lambda g: function("def f(x): return g", g=g),
    "attribute": lambda g: function("def f(x): return m.inner.g", m=modules(g)),
    "closure": closed,
    "default": lambda g: function("def f(x, h=g): return h", g=g),
    "inside a callee": lambda g: function(PLAIN, g=function("def f(x): return g", g=g)),
}


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("value", VALUES)
def test_a_value_is_seen_whichever_way_it_is_read(value, reader):
    first, second = (READERS[reader](g) for g in VALUES[value])
    assert (key(first) != key(second)) == (repr(VALUES[value][0]) != repr(VALUES[value][1])
                                           or value in ("order", "shape"))  # fmt: skip


@pytest.mark.parametrize(
    "sources",
    [
        ("def f(x, y): return x", "def f(x, *y): return x"),
        ("def f(x, y): return x", "def f(x, *, y): return x"),
        ("def f(x): return 1.0", "def f(x): return 1"),
        ("def f(x): return x.a", "def f(x): return x.b"),
        ("def f(x): return (1, 2.0)", "def f(x): return (1, 2)"),
        ("def f(x): return x in {1, 2}", "def f(x): return x in {1, 3}"),
        ("def f(x):\n  try: return g(x)\n  except: return 1\n",
         "def f(x):\n  try: return g(x)\n  except: return 2\n"),
    ],
)  # fmt: skip
def test_another_source(sources):
    first, second = (function(source, g=one) for source in sources)
    assert key(first) != key(second)


def test_the_place_of_a_function_in_its_file_is_no_part_of_its_key():
    assert key(function("\n\n\n# a comment\ndef f(x): return x")) == key(
        function("def f(x): return x")
    )


REFUSED = {
    "a module itself": function("def f(x): return g(m)", m=modules(one), g=one),
    "a module under another name": function("def f(x):\n  h = m\n  return h.g(x)", m=modules(one)),
    "a module in a tuple": function("def f(x): return g[0].g(x)", g=(modules(one),)),
    "an object": function("def f(x): return g(x)", g=object()),
    "a partial": function("def f(x): return g(x)", g=partial(one)),
    "a method": function("def f(x): return g(x)", g=[].append),
    "an array of objects": function("def f(x): return g", g=np.array([one])),
    "a view with gaps": function("def f(x): return g", g=np.zeros((4, 4))[:, 1]),
    "a large array": function("def f(x): return g", g=np.zeros(125_001)),
    "a class": function("def f(x): return g(x)", g=Colour.__mro__[-1].__class__("Own", (), {})),
    "a generator": function("def f(x): return g", g=(x for x in ())),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_told_by_its_content_is_refused(case):
    with pytest.raises(TypeError, match=r"f: '[mg]' is a .* old machine code would run"):
        key(REFUSED[case])


def test_a_function_that_calls_itself_is_refused():
    scope = {}
    exec("def f(x): return g(x)\ndef g(x): return f(x)", scope)  # noqa: S102
    with pytest.raises(TypeError, match="calls itself"):
        key(scope["f"])


@pytest.mark.parametrize("g", [abs, np.sqrt, np.pi, np.float64, int, np.zeros, min])
def test_what_python_and_numpy_have_is_told_by_name(g):
    assert key(function("def f(x): return g", g=g)) == key(function("def f(x): return g", g=g))


def test_machine_code_that_the_key_does_not_cover_is_not_kept(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    inside = internal(FunctionType(two.__code__, {"__name__": __name__}, "inside"))
    outside = Compiled(function(PLAIN, g=inside, __name__=__name__), float64(f8))
    assert outside.key
    assert fingerprint.covered(outside.python) == {outside.python.__code__, two.__code__}
    monkeypatch.setattr(fingerprint, "covered", lambda python: {python.__code__})
    with pytest.raises(RuntimeError, match=r"does not cover \['two'\]"):
        outside.address()
    assert not list(machine.folder().glob("*.code"))
    monkeypatch.undo()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert outside(1.0) == 3.0


def through(g):
    """A function of the same code for every g."""
    inside = internal(g)

    def f(x):
        return inside(x)

    return f


def test_closures_of_one_body_are_covered_with_what_each_reaches():
    both = function(
        "def f(x): return g(x) + h(x)", g=internal(through(one)), h=internal(through(two))
    )
    codes = both.__code__, through(one).__code__, one.__code__, two.__code__
    assert fingerprint.covered(both) == set(codes)


def test_keys_are_those_of_every_process():
    """Nothing in them is an address or the order of a set."""
    code = f"import sys; sys.path.insert(0, {str(Path(__file__).parents[2])!r})\n" + (
        "from tests.kernels.test_fingerprint import kernels\n"
        "print(*sorted(kernel.file.name for kernel in kernels()))"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "1"}
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, env=environment
    )
    assert done.stdout.split() == sorted(kernel.file.name for kernel in kernels())
