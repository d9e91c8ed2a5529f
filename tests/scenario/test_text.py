"""YAML text to data: the core schema, marks, and every hostile file refused where it stands."""

import pytest
import yaml

from trsim.errors import ScenarioError
from trsim.scenario import text as module
from trsim.scenario.text import DEEPEST, LARGEST, decoded, read


@pytest.fixture(params=["C", "Python"], autouse=True)
def loader(request, monkeypatch):
    """Both of PyYAML's parsers give the same."""
    if request.param == "Python":
        monkeypatch.setattr(module, "LOADER", yaml.SafeLoader)


SCALARS = {
    "1e-3": 1e-3,
    "1E5": 1e5,
    "2.1e11": 2.1e11,
    "-1.5": -1.5,
    ".5": 0.5,
    "5.": 5.0,
    "+7": 7,
    "0": 0,
    "0x1f": 31,
    "0o17": 15,
    "123456789012345678901": 123456789012345678901.0,
    "true": True,
    "False": False,
    "null": None,
    "~": None,
    "": None,
    "no": "no",
    "on": "on",
    "yes": "yes",
    "010": "010",
    "1:30": "1:30",
    "2024-01-01": "2024-01-01",
    "1_000": "1_000",
    "1e": "1e",
    "'1'": "1",
    '"true"': "true",
    "0.3 mm": "0.3 mm",
    "2*speed": "2*speed",
    "inf": "inf",
}


@pytest.mark.parametrize("text", SCALARS)
def test_scalar(text):
    value = read(f"a: {text}").data["a"]
    assert value == SCALARS[text]
    assert type(value) is type(SCALARS[text])


def test_keys_are_text():
    assert list(read("1: a\non: b\nnull: c\n~: d").data) == ["1", "on", "null", "~"]


def test_marks():
    tree = read("a:\n  b: [1, {c: 2}]\nd: |\n  text\n", "f.yaml")
    assert tree.data == {"a": {"b": [1, {"c": 2}]}, "d": "text\n"}
    where = {path: (place.line, place.column) for path, place in tree.marks.items()}
    assert where == {
        (): (1, 1),
        ("a",): (1, 1),  # of a mapping: its key
        ("a", "b"): (2, 6),
        ("a", "b", 0): (2, 7),
        ("a", "b", 1): (2, 10),
        ("a", "b", 1, "c"): (2, 14),
        ("d",): (3, 4),
    }
    assert tree.keys["a", "b"].column == 3
    assert tree.marks["a", "b", 0].excerpt == "  b: [1, {c: 2}]"
    assert tree.marks[("d",)].file == "f.yaml"
    assert tree.place(("a", "b", 7, "x")) == tree.marks["a", "b"]
    assert tree.key_place(("d",)).column == 1


@pytest.mark.parametrize("text", ["\ufefftitle: x", "title: x\r\n", "--- \ntitle: x\n...\n"])
def test_accepted(text):
    assert read(text).data == {"title": "x"}


def test_place_after_carriage_returns():
    with pytest.raises(ScenarioError) as caught:
        read("a: 1\r\nb: 2\r\n a: *x\r\n")
    assert caught.value.place.line == 3


BOMB = "a: &a [x, x]\n" + "".join(f"a{k}: &a{k} [*a, *a]\n" for k in range(20))

HOSTILE = {
    BOMB: (1, 4, "anchors and aliases are not allowed"),
    "a: 1\nb: *a": (2, 4, "anchors and aliases are not allowed"),
    "a: " + "[" * 20_000: (1, 3 + DEEPEST + 1, f"nested more than {DEEPEST} deep"),
    "{a: " * 20_000: (1, 4 * DEEPEST + 5, f"nested more than {DEEPEST} deep"),
    "a: !!python/object/apply:os.system [ls]": (1, 4, "tags are not allowed"),
    "a: !x y": (1, 4, "tags are not allowed: '!x'"),
    "a: 1\nb: 2\na: 3": (3, 1, "key 'a' stands here twice"),
    "a: {b: 1, b: 2}": (1, 11, "key 'b' stands here twice"),
    "a: [1, .nan]": (1, 8, "not a finite number: '.nan'"),
    "a: -.inf": (1, 4, "not a finite number: '-.inf'"),
    "a: 1e400": (1, 4, "not a finite number: '1e400'"),
    "a: " + "9" * 400: (1, 4, "not a finite number"),
    "a: x\0y": (1, 5, "character 0x00 cannot stand in a scenario"),
    "a: 1\nb: \x1b[31m": (2, 4, "character 0x1b cannot stand in a scenario"),
    'a: "x\\0y"': (1, 4, "a character that cannot be printed"),
    'a: "\\e[31m"': (1, 4, "a character that cannot be printed"),
    "a:\n\tb: 1": (2, 1, "not YAML: found character"),
    "": (1, 1, "the scenario is empty"),
    "# nothing\n": (1, 1, "the scenario is empty"),
    "[1, 2]": (1, 1, "a scenario is a mapping, got a list of 2"),
    "words": (1, 1, "a scenario is a mapping, got 'words'"),
    "a: 1\n---\nb: 2": (2, 1, "a second document starts here"),
    "? [a]\n: 1": (1, 3, "a key must be a word"),
    '"\\n": 1': (1, 1, "not a key"),
    "a: b: c": (1, 5, "not YAML: mapping values are not allowed"),
    "a: @x": (1, 4, "not YAML: found character"),
    "a: [1, 2": (1, 4, "not YAML: "),
    "a: 'x": (1, 6, "not YAML: found unexpected end of stream"),
    "a: " + "x" * LARGEST: (None, None, "<text> is larger than 1 MB"),
    "a: [" + "1," * 120_000 + "]": (1, None, "more than 20000 values"),
}


@pytest.mark.parametrize("text", HOSTILE, ids=lambda text: repr(text[:24]))
def test_hostile(text):
    line, column, what = HOSTILE[text]
    with pytest.raises(ScenarioError) as caught:
        read(text)
    error = caught.value
    assert error.what.startswith(what)
    assert len(error.show()) < 500
    if line is None:
        assert error.place is None
    else:
        assert error.place.line == line
    if column is not None and not what.startswith("not YAML"):
        assert error.place.column == column


@pytest.mark.parametrize(
    "text, hint",
    [
        ("a:\n\tb: 1", "Indent with spaces"),
        ("a: b: c", "Two ':' on one line?"),
        ("a: @x", "Quote a text that starts with a special character."),
        ("a: [1, 2\nb: 3", "A comma or a closing bracket is missing."),
        ("a: 1\nb: 2\na: 3", "First on line 1."),
        ("a: *b", "Use `parameters` or `extends`."),
    ],
)
def test_hint(text, hint):
    with pytest.raises(ScenarioError) as caught:
        read(text)
    assert caught.value.hint.startswith(hint)


@pytest.mark.parametrize("data", ["tïtle: x".encode("latin-1"), "title: x".encode("utf-16")])
def test_encoding(data):
    with pytest.raises(ScenarioError, match="not UTF-8") as caught:
        decoded(data, "f.yaml")
    assert caught.value.hint == "Save the file as UTF-8."
    assert caught.value.place.file == "f.yaml"


def test_encoding_error_is_located():
    with pytest.raises(ScenarioError) as caught:
        decoded(b"a: 1\nb: x\xff", "f.yaml")
    assert caught.value.show().startswith("f.yaml:2:5: not UTF-8: byte 0xff")


def test_byte_order_mark():
    assert decoded(b"\xef\xbb\xbftitle: x", "f") == "title: x"
