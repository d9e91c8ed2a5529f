"""Result files damaged in every way one can think of, and the commands that read them.

    python -m tests.surgery WHOLE FOLDER FIRST END

does the cases FIRST..END to copies of WHOLE in FOLDER, in this process, and tells of each one line
of JSON: what was done, and how the commands ended.  HDF5 may end or stop the process; the case that
was begun last is then the one.
"""

import contextlib
import io
import json
import os
import random
import shutil
import signal
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np

HANGS = 60  # s of wall time of one command
ENDS = {0, 2, 3, 4, 5, 7}  # exit codes; 1 is a bug, 6 that of sweeps


# --- objects of a file -----------------------------------------------------------------------


def objects(file: h5py.File) -> list[str]:
    """The paths of all groups and datasets, each link once."""
    found: list[str] = []

    def walk(group: h5py.Group, above: str) -> None:
        for name in group:
            found.append(f"{above}{name}")
            if isinstance(group[name], h5py.Group) and above.count("/") < 5:
                walk(group[name], f"{above}{name}/")

    walk(file, "")
    return found


TEXTS = ["", "x", "done", "running", "\x1b[31mred", "a\nb", "null", "{}", "[1]", "é\u202e",
         "9" * 400, "B", "stroke", "N", "furlong", "1e999", "../../etc/passwd"]  # fmt: skip
VALUES: list[Any] = [
    0, -1, 1.5, np.nan, np.inf, -np.inf, 1e300, 2**62, True, b"\xff\xfe", np.bytes_(b"\xff"),
    h5py.Empty("f8"), h5py.Empty("S1"), np.arange(3.0), np.array(["a", "b"], object),
    np.zeros((0,)), np.zeros((2, 2)), np.array(1 + 2j), np.zeros(2, [("a", "i4"), ("b", "f8")]),
    np.float32(3), np.uint8(200), np.int64(-(2**63)), np.void(b"abc"),
]  # fmt: skip


def thing(dice: random.Random) -> Any:
    return dice.choice(TEXTS) if dice.random() < 0.4 else dice.choice(VALUES)


def like(dice: random.Random, n: int) -> tuple[dict[str, Any], str]:
    """What to make a dataset of."""
    kind = dice.randrange(12)
    if kind == 0:
        return {"data": thing(dice)}, "something"
    if kind == 1:
        return {
            "shape": (n,),
            "dtype": dice.choice(["i4", "f4", "u1", "?", "c16", "S3", "S1"]),
        }, "type"
    if kind == 2:
        return {
            "shape": dice.choice([(), (0,), (1,), (n, 1), (n, 7), (2, 2, 2), (n + 5,)])
        }, "shape"
    if kind == 3:
        huge = dice.choice([(2**40,), (2**33, 3), (2**60,)])
        return {"shape": huge, "maxshape": (None, *huge[1:]), "chunks": True}, "huge"
    if kind == 4:
        return {"shape": (n,), "dtype": h5py.vlen_dtype(np.int32)}, "ragged"
    if kind == 5:
        return {"shape": (n,), "dtype": h5py.ref_dtype}, "references"
    if kind == 6:
        return {"data": np.array(dice.choices(TEXTS, k=max(n, 1)), object)}, "texts"
    if kind == 7:
        return {"data": np.array([b"\xff\xc3"] * max(n, 1), "S4")}, "no UTF-8"
    if kind == 8:
        return {"data": np.full(n, dice.choice([np.nan, np.inf, -1.0, 1e300, 0.0]))}, "values"
    if kind == 9:
        return {"data": dice.choice(TEXTS)}, "text"
    if kind == 10:
        return {"shape": (n,), "dtype": np.dtype([("a", "f8"), ("b", "S2")])}, "compound"
    return {"shape": (n,), "external": [("/etc/hostname", 0, 8 * max(n, 1))]}, "external storage"


def operate(file: h5py.File, dice: random.Random) -> str:
    """One change of the objects of a file, in words."""
    names = objects(file)
    top = [name for name in names if "/" not in name]
    name = dice.choice(top if dice.random() < 0.3 else names)
    item = file.get(name)
    n = len(item) if isinstance(item, h5py.Dataset) and item.shape else 3
    kind = dice.randrange(10)
    holder = file if item is None or dice.random() < 0.15 else item
    if kind == 0:
        del file[name]
        return f"without {name}"
    if kind == 1:
        del file[name]
        if isinstance(item, h5py.Group):
            file[name] = np.arange(4.0)
            return f"{name}: a dataset"
        file.create_group(name)
        return f"{name}: a group"
    if kind in (2, 3) and isinstance(item, h5py.Dataset):
        given, what = like(dice, n)
        kept = dict(item.attrs) if dice.random() < 0.7 else {}
        del file[name]
        made = file.create_dataset(name, **given)
        for key in ("units", "long_name"):
            if key in kept:
                made.attrs[key] = kept[key]
        return f"{name}: {what}"
    if kind in (4, 5):
        keys = [*holder.attrs] or ["units"]
        key = dice.choice(keys)
        if dice.random() < 0.3 and key in holder.attrs:
            del holder.attrs[key]
            return f"{holder.name} without {key}"
        value = thing(dice)
        holder.attrs[key] = value
        return f"{holder.name}.{key} = {value!r}"
    if kind == 6:
        link = dice.choice(["/", f"/{dice.choice(names)}", "/nowhere", f"/{name}"])
        del file[name]
        file[name] = h5py.SoftLink(link)
        return f"{name}: a link to {link}"
    if kind == 7:
        del file[name]
        file[name] = h5py.ExternalLink(dice.choice(["other.h5", "/etc/passwd", "x.h5"]), f"/{name}")
        return f"{name}: an external link"
    if kind == 8:
        other = dice.choice(names)
        if file.get(other) is not None:
            groups = ["steps", "summary", "phase", "poincare", "certificate", ""]
            new = f"{dice.choice(groups)}/{dice.choice(TEXTS[1:6])}q"
            with contextlib.suppress(ValueError, KeyError, RuntimeError, OSError, TypeError):
                file[new] = file[other]
            return f"{new}: also {other}"
    other = dice.choice(names)
    if other.startswith(name) or name.startswith(other) or file.get(other) is None:
        file.attrs[dice.choice(["exit_code", "errors", "command", "x"])] = thing(dice)
        return "another attribute"
    file.move(name, "between")
    file.move(other, name)
    file.move("between", other)
    return f"{name} and {other} exchanged"


def flipped(path: Path, dice: random.Random) -> str:
    """Bytes changed, or the end cut off."""
    size = path.stat().st_size
    with path.open("r+b") as file:
        if dice.random() < 0.15:
            file.truncate(dice.randrange(size))
            return "cut"
        told = []
        for _ in range(dice.choice([1, 1, 1, 2, 8])):
            # the first bytes hold what is found first, the objects lie everywhere
            place = dice.randrange(min(size, 4000) if dice.random() < 0.2 else size)
            file.seek(place)
            old = file.read(1)[0]
            file.seek(place)
            file.write(bytes([old ^ 1 << dice.randrange(8)]))
            told.append(place)
    return f"bytes {told}"


def texts(file: h5py.File, dice: random.Random) -> str:
    """The resolved scenario with something else in it."""
    data = json.loads(file["scenario/resolved"].asstr()[()])
    section = dice.choice([*data])
    entry = data[section]
    what = dice.choice([None, 0, "x", [], {}, [1, 2], {"a": 1}])
    if isinstance(entry, dict) and entry and dice.random() < 0.7:
        key = dice.choice([*entry])
        entry[key] = what
        section = f"{section}.{key}"
    else:
        data[section] = what
    if dice.random() < 0.1:
        data, section = what, "all of it"
    del file["scenario/resolved"]
    file["scenario/resolved"] = json.dumps(data)
    return f"scenario: {section} = {what!r}"


def damaged(whole: Path, path: Path, dice: random.Random) -> str:
    """A damaged copy; what was done to it."""
    path.unlink(missing_ok=True)
    shutil.copy(whole, path)
    if dice.random() < 0.3:
        return flipped(path, dice)
    told = []
    with h5py.File(path, "r+") as file:
        for _ in range(dice.choice([1, 1, 1, 2])):
            change = texts if dice.random() < 0.08 else operate
            with contextlib.suppress(KeyError, ValueError, OSError, RuntimeError, TypeError):
                told.append(change(file, dice))
        if dice.random() < 0.5:  # by somebody who knows how
            from trsim.store.content import content_hash
            from trsim.store.sound import check_sound

            with contextlib.suppress(Exception):
                check_sound(file)  # the hash of others may have no end
                file.attrs["content_sha256"] = content_hash(file)
                told.append("and its hash")
    return "; ".join(told)


# --- commands --------------------------------------------------------------------------------


def lines(path: Path, whole: Path, out: Path, dice: random.Random) -> list[list[str]]:
    """Command lines that read it."""
    file, to = str(path), str(out)
    found = [["show", file, "--json"]]
    if dice.random() < 0.5:
        found.append(["show", file, "--verify"])
    if dice.random() < 0.5:
        found.append(["export", file, "--csv", "-o", f"{to}/x.csv"])
    words = dice.choice([
        ["--table", "peak:B.contact_force,final:stroke,impacts:B,summary:contacts.B.peak_force"],
        ["--table", "dispersion:journal,points:journal,following:B,std:stroke@0..0.002"],
        ["--compare", str(whole)], ["--spectrum", "stroke"],
        ["--channels", "B*", "--compare", file],
        ["--section", "when=stroke.rate,crosses=up,plot=stroke:stroke.rate"],
        ["--lyapunov", "stroke"], ["--animate"], [],
    ])  # fmt: skip
    if dice.random() < (0.25 if words and words[0] == "--table" else 0.05):
        found.append(["report", file, "-o", f"{to}/figures", *words])
    if dice.random() < 0.1:
        found.append(["check", file])
    if dice.random() < 0.04:
        found.append(["run", file, "-o", f"{to}/again.h5", "--set", "solver.end=0.1 ms"])
    if dice.random() < 0.06:
        found.append(["recover", file, "-o", f"{to}/recovered.h5"])
    return found


def ended(words: list[str]) -> tuple[int, str]:
    """Exit code and messages of a command line, in this process."""
    from trsim.cli import main

    out, err = io.StringIO(), io.StringIO()
    code: Any = None
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main(words)
        except SystemExit as end:
            code = end.code or 0
        except BaseException as error:
            return 1, f"{type(error).__name__}: {error}"
    if "--json" in words:
        try:
            json.loads(out.getvalue())
        except ValueError:
            return 1, f"no JSON: {out.getvalue()[:200]}"
    if "Traceback" in err.getvalue():
        return 1, err.getvalue()[-2000:]
    return int(code), err.getvalue()


def cases(whole: Path, folder: Path, first: int, end: int) -> None:
    """Do the cases, and tell of each when it begins and how it ended."""
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    for k in range(first, end):
        dice = random.Random(f"surgery {k}")
        path, out = folder / "x.h5", folder / "out"
        what = damaged(whole, path, dice)
        told = {"case": k, "what": what, "commands": {}, "bad": []}
        for words in lines(path, whole, out, dice):
            print(json.dumps({"begun": k, "what": what, "command": words}), flush=True)
            signal.alarm(HANGS)
            code, said = ended(words)
            signal.alarm(0)
            told["commands"][words[0]] = code
            if code not in ENDS:
                told["bad"].append([words, code, said[-1500:]])
        print(json.dumps(told), flush=True)
        shutil.rmtree(out, ignore_errors=True)


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    cases(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]))
