"""Code lines of trsim/, by room: without docstrings, comments, blank lines and imports.

python -m benchmarks.lines                 of the working tree
python -m benchmarks.lines --at COMMIT     of a commit, and how many more there are now
"""

import argparse
import ast
import io
import subprocess
import tarfile
import tokenize
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parent.parent
PACKAGE = "trsim"
NO_CODE = {
    *(tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT),
    *(tokenize.ENCODING, tokenize.ENDMARKER),
}


def code_lines(text: str) -> int:
    """Lines of a module on which there is a token of its code."""
    lines = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in NO_CODE:
            lines.update(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(text)):
        # a string that stands alone is a docstring, wherever it stands
        alone = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if alone or isinstance(node, ast.Import | ast.ImportFrom):
            lines.difference_update(range(node.lineno, node.end_lineno + 1))
    return len(lines)


def room(path: str) -> str:
    """Which room a file is of: the folder in trsim/, of solve/ the one in that."""
    folders = path.split("/")[1:-1]
    return "/".join(folders[:2] if folders[:1] == ["solve"] else folders[:1]) or "."


def of_tree() -> Counter:
    """Code lines by room, of the working tree."""
    found: Counter = Counter()
    for path in sorted((ROOT / PACKAGE).rglob("*.py")):
        found[room(path.relative_to(ROOT).as_posix())] += code_lines(path.read_text())
    return found


def of_commit(commit: str) -> Counter:
    """Code lines by room, of a commit."""
    packed = subprocess.run(  # noqa: S603
        ["git", "archive", commit, PACKAGE],  # noqa: S607
        cwd=ROOT, capture_output=True, check=True,
    ).stdout  # fmt: skip
    found: Counter = Counter()
    with tarfile.open(fileobj=io.BytesIO(packed)) as files:
        for member in files:
            if member.name.endswith(".py"):
                found[room(member.name)] += code_lines(files.extractfile(member).read().decode())
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--at", metavar="COMMIT")
    commit = parser.parse_args().at
    now = of_tree()
    then = of_commit(commit) if commit else now
    for name in (*sorted({*now, *then}), ""):
        count, before = (n[name] if name else n.total() for n in (now, then))
        change = f"{before:8d}{count - before:+8d}" if commit else ""
        print(f"{name or 'total':18s}{count:8d}{change}")


if __name__ == "__main__":
    main()
