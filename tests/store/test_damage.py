"""Files cut short or changed: read in a process of its own, noticed or harmless."""

import json
import signal
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from tests import small
from tests.elsewhere import needs
from tests.sizes import size
from tests.store.outside import ROOT, started
from trsim.store.hdf5 import read

CUTS = size(60, 1_000)
FLIPS = size(140, 10_000)  # bytes
NOTICED = 0.99  # of the changes of contents

# Reads damaged copies of a file: argv = original, work file, kind, first case, end.
# A copy is damaged in place and mended, so that the disk is not waited for.
READER = """
import signal, sys
import h5py
import numpy as np
from pathlib import Path
from trsim.errors import FileError
from trsim.store.read import opened, verify

original, work, kind, begin, end = sys.argv[1:]

def contents(path):
    "Every name, type, number, text and attribute; references to scales apart."
    found = {}
    def put(name, item):
        found[name] = [str(type(item))]
        if isinstance(item, h5py.Dataset):
            found[name] += [str(item.dtype), item.shape, plain(item[()])]
        for key in sorted(item.attrs):
            if key not in ("DIMENSION_LIST", "REFERENCE_LIST"):
                found[name].append((key, plain(item.attrs[key])))
    def walk(above, group):
        put(above, group)
        for name in sorted(group):
            inside = isinstance(group[name], h5py.Group)
            (walk if inside else put)(f"{above}/{name}", group[name])
    with opened(Path(path)) as file:
        walk("", file)
    return found

def plain(value):
    value = np.asarray(value)
    return value.tolist() if value.dtype.kind in "OSU" else value.tobytes()

def outcome():
    try:
        if not verify(work):
            return "changed"
        read = contents(work)
        names = sorted(n for n in {*read, *expected} if read.get(n) != expected.get(n))
        return f"missed:{names[0]}" if names else "harmless"
    except (FileError, MemoryError):
        return "refused"
    except Exception as error:
        return f"raised:{type(error).__name__}"

whole = Path(original).read_bytes()
expected = contents(original)
dice = np.random.default_rng(11)
places = dice.integers(1, len(whole), 10_000)
masks = dice.integers(1, 256, 10_000)
Path(work).write_bytes(whole)
for k in range(int(begin), int(end)):
    signal.alarm(60)  # a reader that hangs ends
    place = int(places[k])
    with open(work, "r+b") as file:
        if kind == "cut":
            file.truncate(place)
        else:
            file.seek(place)
            file.write(bytes([whole[place] ^ int(masks[k])]))
    print(outcome(), flush=True)
    with open(work, "r+b") as file:
        file.seek(place)
        file.write(whole[place:] if kind == "cut" else whole[place : place + 1])
"""


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result with every kind of table, but few channels: it is read a thousand times."""
    path = tmp_path_factory.mktemp("damage") / "run.h5"
    small.run(path, "output.channels=[stroke, B.force, B.penetration]", "solver.end=1.5 ms")
    return read(path)


def outcomes(result, folder, kind, count):
    """How often what became of damaged copies, read in two processes at a time."""
    halves = [(0, count // 2), (count // 2, count)]
    with ThreadPoolExecutor() as pool:
        return sum(pool.map(lambda half: part(result, folder, kind, *half), halves), Counter())


def part(result, folder, kind, begin, end):
    """The same of the cases begin..end; a reader that dies or hangs costs one of them."""
    found = []
    while begin + len(found) < end:
        words = (result.path, folder / f"{begin}.h5", kind, begin + len(found), end)
        out, err = (process := started(ROOT, "-c", READER, *map(str, words))).communicate()
        found += out.splitlines()
        if begin + len(found) < end:
            assert process.returncode < 0, err[-800:]
            found.append("hung" if process.returncode == -signal.SIGALRM else "died")
    return Counter(found)


@needs("alarm")
def test_truncated(result, tmp_path):
    found = outcomes(result, tmp_path, "cut", CUTS)
    print(f"{CUTS} truncations: {dict(found)}")
    assert found == {"refused": CUTS}


@needs("alarm")
def test_flipped(result, tmp_path):
    """Of the bytes that hold something, at least NOTICED are; the rest change nothing."""
    found = outcomes(result, tmp_path, "flip", FLIPS)
    changed = FLIPS - found["harmless"]
    noticed = found["refused"] + found["changed"]
    print(f"{FLIPS} changed bytes: {dict(found)}; {noticed / changed:.2%} of {changed} noticed")
    known = {"refused", "changed", "harmless", "died", "hung"}
    assert all(what in known or what.startswith("missed") for what in found)
    assert noticed >= NOTICED * changed
    assert found["harmless"] < 0.2 * FLIPS


# Shows and recovers files, one command after the other: each line a code, then a document
COMMANDS = """
import contextlib, io, json, signal, sys
from trsim.cli import main
for name in sys.argv[1:]:
    for command in ("show", "recover"):
        signal.alarm(20)
        out, code = io.StringIO(), 0
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
            try:
                main([command, name, "--json"])
            except SystemExit as ended:
                code = ended.code
        print(json.dumps([name, command, code, json.loads(out.getvalue())]), flush=True)
"""
SHARES = [0.3, 0.6, 0.9]


@pytest.fixture(scope="module")
def truncated(running_part, tmp_path_factory):
    """What becomes of a part of which a share is left: folder, and (code, document) by command."""
    folder, content = tmp_path_factory.mktemp("truncated"), running_part.read_bytes()
    for share in SHARES:
        (folder / f"{share}.h5.part").write_bytes(content[: int(share * len(content))])
    names = [f"{share}.h5.part" for share in SHARES]
    out, _ = started(folder, "-c", COMMANDS, *names).communicate(timeout=120)
    told = {}
    for name, command, code, document in map(json.loads, out.splitlines()):
        told[name, command] = code, document
    return folder, told


@needs("alarm")
@pytest.mark.parametrize("share", SHARES)
def test_truncated_part_is_settled_at_once_and_recovered(share, truncated):
    """HDF5 in SWMR mode would go on looking for what is not there."""
    folder, told = truncated
    for name in ("show", "recover"):
        code, document = told[f"{share}.h5.part", name]
        if name == "show" and code == 7:
            assert "trsim recover" in document["errors"][0]["hint"]
            continue
        print(f"cut at {share:.0%}, {name}: {document.get('rows', document['errors'])}")
        assert code in (0, 7)
        if name == "recover" and code == 0:
            run = read(folder / f"{share}.recovered.h5")
            assert np.all(np.diff(run.time) > 0.0)
            assert np.all(np.isfinite(run.channel("B.force")))
