"""Texts are read and written the same on every system: as UTF-8, with the ends of lines given."""

import ast
from collections.abc import Iterator

import pytest

from .test_circles import ROOT, modules

TEXT = {"read_text": 0, "write_text": 1}  # methods -> the place of `encoding`
OPENING = {"open": 1, "fdopen": 1, "TemporaryFile": 0, "NamedTemporaryFile": 0}  # -> of the mode
WRITES = set("wax+")


def mode_of(call: ast.Call, name: str) -> str | None:
    """The mode of a call that opens a file; None where it is not written down."""
    at = OPENING[name] - (name == "open" and isinstance(call.func, ast.Attribute))
    given = {one.arg: one.value for one in call.keywords}
    node = given.get("mode") or (call.args[at] if len(call.args) > at else None)
    if node is None:
        return "w+b" if name.endswith("TemporaryFile") else "r"
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def faults(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Where a file is opened as text without its encoding, or written without ends of lines."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = getattr(node.func, "attr", getattr(node.func, "id", ""))
        of = ast.unparse(node.func).rpartition(".")[0] if name in OPENING else ""
        given = {one.arg for one in node.keywords}
        if {"text", "universal_newlines"} & given and "encoding" not in given:
            yield node.lineno, "texts of a process without an encoding"
        if name in TEXT:
            if "encoding" not in given and len(node.args) <= TEXT[name]:
                yield node.lineno, f"{name} without an encoding"
            if name == "write_text" and "newline" not in given:
                yield node.lineno, "write_text without newline"
        elif (name in OPENING and of not in ("os", "webbrowser", "self")) or name == "fdopen":
            mode = mode_of(node, name)
            if mode is None or "b" in mode:
                continue
            if "encoding" not in given:
                yield node.lineno, f"{name} without an encoding"
            if WRITES & set(mode) and "newline" not in given:
                yield node.lineno, f"{name} to write without newline"


def test_every_text_has_its_encoding_and_its_ends_of_lines():
    found = {}
    for name, path in modules(ROOT).items():
        if ones := [*faults(ast.parse(path.read_text(encoding="utf-8")))]:
            found[name] = ones
    assert found == {}


@pytest.mark.parametrize(
    "source",
    [
        "open(path)", "path.open()", "open(path, 'w')", "open(path, mode='a', encoding='utf-8')",
        "path.open('w', encoding='utf-8')", "path.read_text()", "path.write_text(text)",
        "path.write_text(text, encoding='utf-8')", "path.write_text(text, 'utf-8')",
        "os.fdopen(handle, 'w')", "tempfile.NamedTemporaryFile('w')", "with open(path) as f: pass",
        "subprocess.run(command, text=True)",
    ],
)  # fmt: skip
def test_a_fault_is_found(source):
    assert [*faults(ast.parse(source))]


@pytest.mark.parametrize(
    "source",
    [
        "open(path, 'rb')", "path.open('wb')", "open(path, encoding='utf-8')", "os.open(path, 0)",
        "path.open('w', newline='', encoding='utf-8')", "path.read_text(encoding='ascii')",
        "path.read_text('utf-8')", "path.write_text(t, encoding='utf-8', newline='')",
        "TemporaryFile(dir=folder)", "os.fdopen(handle, 'wb')", "self.open()",
    ],
)  # fmt: skip
def test_what_is_none(source):
    assert not [*faults(ast.parse(source))]
