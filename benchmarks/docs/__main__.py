"""python -m benchmarks.docs [NAME ...]: make what is stale in the docs again; --check names it.

Each entry of made.py is made by its own command, and its page is written at once, so the same
command goes on where it was ended.  What measures times, takes long or is copied by hand is left
unless it is named.
"""

import argparse
import shlex
import sys

from benchmarks.docs import marks
from benchmarks.docs.made import MADE
from benchmarks.docs.marks import ROOT, TABLE, Marked

KEPT = ROOT / "runs" / "docs"  # what commands printed


def every() -> list[Marked]:
    return [one for page in marks.pages() for one in marks.marked(page)]


def check() -> int:
    """Name what is stale; 1 if anything is."""
    found = [(one, why) for one in every() if (why := marks.stale(one))]
    for one, why in found:
        print(f"{one.page.relative_to(ROOT)}:{one.line}: {one.whole}: {why}")
        print(f"  make docs NAMES={one.name}   runs: {one.command}")
    fresh = len(every()) - len(found)
    print(f"{len(found)} stale, {fresh} as their sources are")
    return 1 if found else 0


def make(name: str) -> None:
    """Run the command of an entry, and write what it prints where it belongs."""
    entry = MADE[name]
    print(f"{name}: {entry.command}", flush=True)
    words = shlex.split(entry.command)
    if "FOLDER" in words:
        print("  type it by hand, with the folder of an older tree; then --copied")
        return
    if words[0] in ("python", "trsim"):
        words[:1] = [sys.executable] if words[0] == "python" else [sys.executable, "-m", "trsim"]
    printed = marks.printed(words).decode()
    KEPT.mkdir(parents=True, exist_ok=True)
    (KEPT / f"{name}.txt").write_text(printed, encoding="utf-8", newline="\n")
    if entry.way == "copied":
        print(f"  {KEPT.relative_to(ROOT)}/{name}.txt has what it printed. Copy the numbers, then:")
        print(f"  python -m benchmarks.docs --copied {name}")
        return
    write(name, printed)


def write(name: str, printed: str) -> None:
    """Renew the pieces of an entry: their markers, and the tables that its command printed."""
    tables = [match[0].rstrip() for match in TABLE.finditer(printed)]
    for page in marks.pages():
        count = len([one for one in marks.marked(page) if one.name == name])
        for k in range(count):  # places move as the page is written
            text = page.read_text(encoding="utf-8")
            one = [one for one in marks.marked(page, text) if one.name == name][k]
            body = "".join(f"{line}\n" for line in text.splitlines()[one.first : one.last])
            if MADE[name].way == "tables":
                body = f"\n{tables[max(one.table, 1) - 1]}\n\n"
            text = marks.replaced(text, one, body)
            page.write_text(text, encoding="utf-8", newline="\n")
            print(f"  {page.relative_to(ROOT)}:{one.line}")


def main() -> int:
    read = argparse.ArgumentParser(prog="python -m benchmarks.docs", description=__doc__)
    read.add_argument("names", nargs="*", metavar="NAME")
    read.add_argument("--check", action="store_true", help="name what is stale; exit code 1 if any")
    read.add_argument("--copied", action="store_true", help="the numbers of NAME have been copied")
    asked = read.parse_args()
    if wrong := [name for name in asked.names if name not in MADE]:
        read.error(f"no entry {wrong[0]}; known: {', '.join(MADE)}")
    if asked.check:
        return check()
    for name in asked.names or sorted({one.name for one in every() if marks.stale(one)}):
        if asked.copied:
            write(name, "")
        elif asked.names or not MADE[name].asked:
            make(name)
        else:
            print(f"{name}: left, {MADE[name].asked}; make docs NAMES={name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
