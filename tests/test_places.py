"""The place that an error names is that of the wrong value: its line and its column."""

import re

import pytest

from trsim.errors import TrsimError
from trsim.scenario.explain import explained
from trsim.scenario.load import loads
from trsim.scenario.text import read

EVERY = explained()
EXAMPLES = {page["word"]: page["example"] for page in EVERY["elements"]}
EXAMPLES |= {page["word"]: page["example"] for page in EVERY["sections"] if page["example"]}
WRONG = "3 qqq"  # no unit
NUMBER = re.compile(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?( [A-Za-z][A-Za-z*/^0-9]*)?$")


def numbers(text):
    """Path and place of every number in a text, and where it stands there."""
    tree = read(text)
    lines = text.splitlines(keepends=True)
    for path, mark in tree.marks.items():
        value = tree.data
        for key in path:
            value = value[key]
        written = re.match(r"[^,\]}\n#]+", lines[mark.line - 1][mark.column - 1 :])
        if isinstance(value, dict | list | bool) or not written:
            continue
        if NUMBER.match(written[0].strip()):
            start = sum(map(len, lines[: mark.line - 1])) + mark.column - 1
            yield path, mark, slice(start, start + len(written[0].rstrip()))


@pytest.mark.parametrize("word", EXAMPLES)
def test_a_wrong_number(word):
    text, count = EXAMPLES[word], 0
    for path, mark, where in numbers(text):
        changed = f"{text[: where.start]}{WRONG}{text[where.stop :]}"
        with pytest.raises(TrsimError) as caught:
            loads(changed)
        places = [(one.place.line, one.place.column) for one in caught.value.problems]
        assert (mark.line, mark.column) in places, (path, caught.value.show())
        count += 1
    assert count > 2
