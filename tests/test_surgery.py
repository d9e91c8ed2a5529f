"""Damaged result files, ledgers, plans and checkpoints: no command ends with exit 1, dies or hangs.

Result files are read by processes of their own, which may die.  With FUZZ=FOLDER in the environment
what was done is kept there, and the same command goes on with the rest.
"""

import hashlib
import io
import json
import os
import random
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from tests import small
from tests.sizes import size
from tests.store.test_resume import cut
from tests.surgery import ended
from tests.test_mutants import mutated
from trsim.assemble.assemble import assemble
from trsim.scenario.load import loads
from trsim.solve import simulate as solver
from trsim.store import checkpoint
from trsim.sweeps.ledger import Entry

ROOT = Path(__file__).parent.parent
FILES, LEDGERS, CHECKPOINTS = size(36, 2_000), size(200, 2_000), size(60, 2_000)
PARTS = range(size(1, 2))  # each begins a process
ENDS = {0, 2, 3, 4, 5, 7}


@pytest.fixture(autouse=True)
def undisturbed(monkeypatch):
    monkeypatch.delenv("TRSIM_DEBUG", raising=False)


# --- result files ----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("surgery") / "whole.h5"
    small.run(path, "output.channels=[stroke, B, A]", "output.every=0.1 ms")
    return path


def told(log):
    """The cases that ended, and the one that was begun last."""
    lines = [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []
    done = {line["case"]: line for line in lines if "case" in line}
    return done, max((line["begun"] for line in lines if "begun" in line), default=-1)


def done(whole, folder, log, first, end):
    """All cases of a range; those during which the process died."""
    died = {}
    while len({**(found := told(log)[0]), **died}) < end - first:
        begin = first + len({**found, **died})
        words = ("-W", "ignore", "-m", "tests.surgery", whole, folder, begin, end)
        with log.open("ab") as out:
            process = subprocess.run(  # noqa: S603
                [sys.executable, *map(str, words)], stdout=out, cwd=ROOT,
                env={**os.environ, "PYTHONPATH": str(ROOT)},
            )  # fmt: skip
        if process.returncode:
            died[max(told(log)[1], begin)] = process.returncode
    return told(log)[0], died


@pytest.mark.parametrize("part", PARTS)
def test_damaged_files(part, whole, tmp_path):
    count = FILES // len(PARTS)
    kept = Path(os.environ.get("FUZZ") or tmp_path) / f"files_{part}.jsonl"
    kept.parent.mkdir(parents=True, exist_ok=True)
    found, died = done(whole, tmp_path, kept, part * count, (part + 1) * count)
    ends = Counter(f"{name} {code}" for line in found.values()
                   for name, code in line["commands"].items())  # fmt: skip
    print(f"{len(found)} files: {dict(sorted(ends.items()))}; died: {died}")
    assert not died
    assert not [line for line in found.values() if line["bad"]]


# --- ledgers and plans -----------------------------------------------------------------------

CASES = ("one", "two", "three")
PLAN = {
    "format": "trsim sweep", "version": 1, "source": "s.yaml", "engine": "e", "keys": ["a.b"],
    "units": {"a.b": "m"}, "written": {"a.b": "mm"}, "method": "grid", "samples": 0, "seed": 0,
    "cases": [{"name": n, "digest": "d", "values": {"a.b": 1.0}} for n in CASES],
}  # fmt: skip
LINES = [Entry(name, "d", "e", status, "", 1, "c", 10, 20, 3.0, 0.5, {"time": 1.0})._asdict()
         for name, status in zip(CASES, ("done", "failed", "crashed"), strict=True)]  # fmt: skip
WRONG = [None, [], {}, True, "x", "", -1, 1.5, 10**400, [1], {"a": [1]}, "../x", "\0", float("nan")]


def changed(tree, dice):
    """One thing in a tree of JSON replaced, left out, doubled or renamed."""
    tree = json.loads(json.dumps(tree))
    inner, key = tree, None
    while True:
        keys = list(inner) if isinstance(inner, dict) else list(range(len(inner)))
        if not keys:
            return tree
        key = dice.choice(keys)
        if not isinstance(inner[key], dict | list) or dice.random() < 0.3:
            break
        inner = inner[key]
    kind = dice.randrange(4)
    if kind == 0:
        del inner[key]
    elif kind == 1 and isinstance(inner, list):
        inner.append(inner[key])
    elif kind == 1:
        inner[str(key) + "x"] = inner.pop(key)
    else:
        inner[key] = dice.choice(WRONG)
    return tree


def test_damaged_ledgers(tmp_path):
    counts = Counter()
    for k in range(LEDGERS):
        dice = random.Random(f"ledger {k}")
        plan, lines = json.dumps(PLAN).encode(), [json.dumps(line).encode() for line in LINES]
        which = dice.randrange(4)
        if which == 0:
            plan = json.dumps(changed(PLAN, dice)).encode()
        elif which == 1:
            plan = mutated(plan, dice)
        elif which == 2:
            place = dice.randrange(len(LINES))
            lines[place] = json.dumps(changed(LINES[place], dice)).encode()
        else:
            lines = [mutated(b"\n".join(lines), dice)]
        (tmp_path / "plan.json").write_bytes(plan)
        (tmp_path / "ledger.jsonl").write_bytes(b"\n".join(lines))
        for words in (
            ["status", str(tmp_path), "--json"],
            ["report", str(tmp_path), "--table", "summary:time"][: 4 * (k % 4 == 0)],
        ):
            if not words:
                continue
            code, said = ended(words)
            counts[code] += 1
            assert code in ENDS, (plan, lines, said)
    print(f"{LEDGERS} ledgers and plans: {dict(counts)}")


# --- checkpoints -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def broken_off(tmp_path_factory):
    """The folder of a run that was broken off."""
    folder = tmp_path_factory.mktemp("broken_off")
    scenario = loads(small.SLIDER_CRANK, small.FEW)
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(solver, "VISIT", 100)  # steps of a block
        cut(folder / "x.h5", scenario, assemble(scenario), 1)
    return folder


def archive(body, dice):
    """The parts of a checkpoint with one of another shape or type, left out, or more."""
    with np.load(io.BytesIO(body), allow_pickle=False) as old:
        parts = {name: old[name] for name in old.files}
    name = dice.choice([*parts, "about", "about", "about"])
    kind = dice.randrange(7)
    if kind == 0:
        del parts[name]
    elif kind == 1 and name == "about":
        about = json.loads(parts[name].item())
        parts[name] = np.array(json.dumps(changed(about, dice)))
    elif kind == 1:
        parts[f"{name}x"] = parts.pop(name)
    elif kind == 2:
        parts[name] = parts[name][..., None]
    elif kind == 3:
        parts[name] = np.array("x")
    elif kind == 4:
        parts[name] = np.zeros(3, bool)
    elif kind == 5:
        parts[name] = np.repeat(parts[name].ravel(), 2)
    else:
        parts[name] = parts[name].astype("S9")
    found = io.BytesIO()
    np.savez(found, **parts)
    return found.getvalue()


def test_damaged_checkpoints(broken_off, tmp_path, at_once):
    counts, folder = Counter(), tmp_path / "run"
    whole = checkpoint.beside(broken_off / "x.h5").read_bytes()
    _, _, body = whole.partition(b"\n")
    for k in range(CHECKPOINTS):
        dice = random.Random(f"checkpoint {k}")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(broken_off, folder)
        damaged = mutated(whole, dice) if dice.random() < 0.3 else None
        if damaged is None:  # by somebody who knows how
            inner = archive(body, dice) if dice.random() < 0.8 else mutated(body, dice)
            digest = hashlib.sha256(inner).hexdigest()
            damaged = f"{checkpoint.MAGIC} {digest}\n".encode() + inner
        checkpoint.beside(folder / "x.h5").write_bytes(damaged)
        words = ["run", str(folder / "crank.yaml"), "--resume", "-o", str(folder / "x.h5"), "-q",
                 "--set", *small.FEW]  # fmt: skip
        code, said = ended(words)
        counts[code] += 1
        assert code in ENDS, (k, said)
    print(f"{CHECKPOINTS} checkpoints: {dict(counts)}")
