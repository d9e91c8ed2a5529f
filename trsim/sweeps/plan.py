"""The plan of a sweep: its cases, each with a name, its data and a digest of all it depends on.

Cases share the pieces of data that they do not change, so a piece is read, checked and hashed once.
"""

import hashlib
import json
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from trsim.errors import Place, ScenarioError, TrsimError, UsageError
from trsim.scenario import vary
from trsim.scenario.cases import cases as named_cases
from trsim.scenario.expand import SWEPT, expand
from trsim.scenario.load import of_tree, valid
from trsim.scenario.memory import Memory
from trsim.scenario.merge import keys_of, put, setting
from trsim.scenario.scenario import Scenario
from trsim.scenario.text import Tree
from trsim.sweeps.digest import Digests
from trsim.sweeps.points import Point, points
from trsim.sweeps.values import mixed, units, written

CASE = "case"  # the key of the named cases
LONGEST = 80  # letters of a name


class Case(NamedTuple):
    """One run of a sweep."""

    name: str  # of its file, too
    case: str  # of `cases:`; "" without any
    values: dict[str, Any]  # independent key -> value as written
    data: dict[str, Any]
    digest: str


class Plan(NamedTuple):
    """All runs of a sweep."""

    source: str
    text: str  # of the scenario, as given
    files: dict[str, str]  # it was read from -> sha256
    keys: tuple[str, ...]  # that vary by themselves; CASE first where there are named cases
    units: dict[str, str]  # SI
    written: dict[str, str]  # the units that values have in the scenario; of keys with one
    method: str
    samples: int
    seed: int
    cases: tuple[Case, ...]
    keep: str  # of what cases give, see vary.py
    wished: bool  # whether that was asked for
    numbers: tuple[str, ...]
    sets: tuple[str, ...]  # of the command line
    trees: dict[str, "_Named"]  # of the named cases

    @property
    def adaptive(self) -> bool:
        """Whether it depends on what comes out which cases are run."""
        return any(one.sweep.until or one.sweep.refine for one in self.trees.values())

    def scenario(self, case: Case) -> Scenario:
        """The scenario of a case.  Raises what is wrong with it, with its place."""
        return self.trees[case.case].scenario(case)


class Chosen(NamedTuple):
    """Which cases of a plan an adaptive sweep asked for, known once it has ended."""

    cases: frozenset[str]
    told: tuple[str, ...]  # why no further ones: a line for each name in `cases:`


class _Setting(NamedTuple):
    """An axis of the command line, or of the file."""

    axis: vary.Axis
    at: Place
    key_place: Place


class _Named(NamedTuple):
    """A named case, before anything varies."""

    tree: Tree
    text: str
    sweep: vary.Sweep
    settings: dict[str, _Setting]

    def with_values(self, values: dict[str, Any]) -> Tree:
        """The tree of a case; values: of the keys that vary by themselves.

        Raises what the rules of --set have against a key.
        """
        data = json.loads(json.dumps(self.tree.data))
        tree = Tree(data, dict(self.tree.marks), dict(self.tree.keys), self.tree.files)
        for key, setting_ in self.settings.items():
            source = setting_.axis.same_as or key
            put(tree, keys_of(key), values[source], setting_.at, setting_.key_place)
        for key in SWEPT:
            tree.data.pop(key, None)
        return tree

    def scenario(self, case: Case) -> Scenario:
        return of_tree(self.with_values(case.values), self.text)


def plan(
    path: str, sets: Iterable[str] = (), engine: str = "",
    read: Callable[[str], tuple[Tree, str]] = expand,
) -> Plan:  # fmt: skip
    """The plan of a scenario file; sets: numbers, or axes where the value is one.

    engine: what identifies the program that makes the runs; read: gives the tree of `path`, and its
    text.
    """
    sets = tuple(sets)
    fixed, axes = _sorted(sets)
    tree, text = read(path)
    named: dict[str, _Named] = {}
    for name, inner in named_cases(tree).items():
        for keys, new, at, key_place in fixed:
            put(inner, keys, new, at, key_place)
        named[name] = _with_axes(inner, text, axes, [".".join(keys) for keys, *_ in fixed])
    first = next(iter(named.values()))
    if "" in named and not first.sweep.axes:
        hint = (
            "Write `sweep: {joints.A.clearance: [0.1 mm, 0.3 mm]}` in it, or give --set KEY=[...]."
        )
        raise UsageError(f"{path} says nothing to vary", hint)
    digests = Digests(engine)
    found = [case for name, one in named.items() for case in _cases(name, one, digests)]
    keys = tuple(dict.fromkeys(key for case in found for key in case.values))
    shown = written(found, keys)
    si = units(named, found, keys, shown)
    if "" not in named:
        keys, si = (CASE, *keys), {CASE: "-", **si}
    sweep = max((one.sweep for one in named.values()), key=lambda one: one.samples)
    sweeps = [one.sweep for one in named.values()]
    if len({(one.keep or vary.ALL, one.numbers) for one in sweeps}) > 1:
        what = f"the cases of {path} differ in what is kept of them"
        raise UsageError(
            what, "Write the same `keep` and `numbers` in every `sweep`, or use --keep."
        )
    _check_numbers(sweep, first.tree)
    wished = max(one.keep for one in sweeps)  # no two differ
    keep = wished or (vary.ALL if len(found) <= vary.FEW else vary.SUMMARY)
    return Plan(
        path, text, tree.files, keys, si, shown, sweep.method, sweep.samples, sweep.seed,
        tuple(_distinct(found)), keep, bool(wished), sweep.numbers, sets, named,
    )  # fmt: skip


def faults(found: Plan) -> Iterator[tuple[Case, TrsimError]]:
    """The cases that are no scenarios, with what is wrong."""
    memory, good = Memory(), True
    for case in found.cases:
        if not valid(case.data, memory) or case is found.cases[0]:
            try:
                found.scenario(case)
            except TrsimError as error:
                good = False
                yield case, error
    if good:
        yield from mixed(found.cases, found.keys)


# --- axes ------------------------------------------------------------------------------------


def _sorted(sets: Iterable[str]) -> tuple[list[Any], list[tuple[str, Any, Place, Place]]]:
    """Settings of one value each, and those of an axis."""
    fixed, axes = [], []
    for text in sets:
        keys, new, at, key_place = setting(text)
        if vary.varies(new):
            axes.append((".".join(keys), new, at, key_place))
        else:
            fixed.append((keys, new, at, key_place))
    return fixed, axes


def _with_axes(
    tree: Tree, text: str, axes: list[tuple[str, Any, Place, Place]], fixed: list[str]
) -> _Named:
    """A named case with the axes of its file and of the command line, which come last.

    fixed: keys with a value on the command line; they do not vary, nor does what lies below them.
    """
    given = tree.data.get("sweep")
    block = dict(given) if isinstance(given, dict) else {}
    for key in list(block):
        if any(f"{key}.".startswith(f"{one}.") for one in fixed):
            del block[key]
    for key, value, at, _ in axes:
        if isinstance(_at(tree.data, key), list) and not any(isinstance(v, list) for v in value):
            hint = f"For one value write --set {key}=[[...]]."
            raise ScenarioError("a list of values varies the key, which is a list itself", hint,
                                tuple(keys_of(key)), at)  # fmt: skip
    if not set(block) - set(vary.SETTINGS) and not axes and isinstance(given, dict) and fixed:
        block = {key: block[key] for key in vary.KEPT if key in block}  # nothing varies any more
    where = {key: (at, key_place) for key, _, at, key_place in axes}
    block |= {key: value for key, value, *_ in axes}
    try:
        sweep = vary.sweep(block if given is None or isinstance(given, dict) else given)
        settings = {}
        for axis in sweep.axes:
            path = ("sweep", axis.key)
            unknown = Place("--set", 0, 1, "")
            in_file = tree.place(path) or unknown, tree.key_place(path) or unknown
            settings[axis.key] = _Setting(axis, *where.get(axis.key, in_file))
    except ScenarioError as error:
        key = error.path[0] if error.path else ""
        path = ("sweep", *error.path)
        place = where[key][0] if key in where else tree.place(path)
        raise ScenarioError(error.what, error.hint, path, place) from None
    return _Named(tree, text, sweep, settings)


def _at(data: Any, key: str) -> Any:
    """What stands at a dotted path; None where nothing does."""
    for word in keys_of(key):
        if isinstance(data, list) and word.isdigit() and int(word) < len(data):
            data = data[int(word)]
        else:
            data = data.get(word) if isinstance(data, dict) else None
    return data


def _check_numbers(sweep: vary.Sweep, tree: Tree) -> None:
    """Check that what is to be kept of every case are numbers of a run."""
    if not sweep.numbers:
        return
    from trsim.analyse.outputs import check_word

    places: dict[str, tuple[str, ...]] = {word: ("until", word) for word, _ in sweep.until}
    places |= {word: ("refine", "by", word) for word, _ in sweep.refine.by} if sweep.refine else {}
    for word in sweep.numbers:
        try:
            check_word(word)
        except UsageError as error:
            path = ("sweep", *places.get(word, ("numbers",)))
            raise ScenarioError(error.what, error.hint, path, tree.place(path)) from None


# --- cases -----------------------------------------------------------------------------------


def _cases(name: str, one: _Named, digests: "Digests") -> Iterator[Case]:
    base = {key: value for key, value in one.tree.data.items() if key not in SWEPT}
    own = [axis.key for axis in one.sweep.axes if not axis.same_as]
    short = _short(own)
    try:
        found = points(one.sweep) if one.sweep.axes else [Point("", {})]
    except ScenarioError as error:
        path = ("sweep", *error.path)
        told = [each.at for each in one.settings.values() if each.at.file == "--set"]
        place = told[0] if told else one.tree.place(path)
        raise ScenarioError(error.what, error.hint, path, place) from None
    one.with_values(found[0].values)  # a key that cannot be set is told here
    for point in found:
        data = base
        for key, value in point.values.items():
            data = changed(data, keys_of(key), value)
        label = point.name or _label(short, point.values, own)
        whole = ",".join(part for part in (name, label) if part)
        yield Case(whole, name, {key: point.values[key] for key in own}, data, digests.of(data))


def changed(data: Any, keys: list[str], value: Any) -> Any:
    """Data with one value replaced; what it shares with the old is not copied."""
    if not keys:
        return value
    if isinstance(data, list):
        copy: Any = list(data)
        copy[int(keys[0])] = changed(copy[int(keys[0])], keys[1:], value)
        return copy
    copy = dict(data) if isinstance(data, dict) else {}
    copy[keys[0]] = changed(copy.get(keys[0]), keys[1:], value)
    return copy


def _short(keys: list[str]) -> dict[str, str]:
    """The fewest last words that tell keys apart."""
    found = {}
    for key in keys:
        words = key.split(".")
        for n in range(1, len(words) + 1):
            tail = words[-n:]
            if sum(other.split(".")[-n:] == tail for other in keys) == 1:
                break
        found[key] = ".".join(tail)
    return found


def _label(short: dict[str, str], values: dict[str, Any], own: list[str]) -> str:
    parts = [f"{short[key]}={_slug(values[key])}" for key in own]
    whole = ",".join(parts)
    if len(whole) <= LONGEST:
        return whole
    digest = hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:8]
    return f"{whole[: LONGEST - 9]}-{digest}"


def _slug(value: Any) -> str:
    text = value if isinstance(value, str) else json.dumps(value)
    text = re.sub(r"[0-9]+\.[0-9]{6,}", lambda match: f"{float(match[0]):.6g}", text)
    return re.sub(r"[^A-Za-z0-9_.+-]+", "_", re.sub(r"\s+", "", text)).strip("_") or "_"


def _distinct(found: list[Case]) -> Iterator[Case]:
    """The cases, with a number after a name that came before."""
    seen: dict[str, int] = {}
    for case in found:
        n = seen[case.name.casefold()] = seen.get(case.name.casefold(), 0) + 1
        yield case if n == 1 else case._replace(name=f"{case.name}~{n}")


def named_file(folder: Path, name: str) -> Path:
    """The result file of a case."""
    return Path(folder, "cases", f"{name}.h5")
