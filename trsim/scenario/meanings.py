"""What the docstrings of specs say about their keys.

A line of a docstring that begins with a key and two or more spaces tells what the key means; lines
indented to the same column continue it.  The rest describes the whole.
"""

import inspect
import re
from collections.abc import Iterator
from functools import cache
from typing import Any, get_args

from trsim.fields import Spec


@cache
def meanings(of: type) -> dict[str, str]:
    """Key -> its meaning, of a class with annotations and those it inherits from; not changed."""
    found: dict[str, str] = {}
    for base in reversed(of.__mro__):
        own: dict[str, list[str]] = {}
        for key, line in _lines(base):
            own.setdefault(key, []).append(line)
        found |= {key: " ".join(lines) for key, lines in own.items() if key}
    return found


def description(of: type) -> str:
    """The docstring of a class without its keys."""
    return "\n".join(line for key, line in _lines(of) if not key).strip()


def _lines(of: type) -> Iterator[tuple[str, str]]:
    """(key, part of its meaning) or ("", line) for each line of the docstring."""
    keys = inspect.get_annotations(of)
    key, column = "", 0
    for line in inspect.cleandoc(of.__doc__ or "").splitlines():
        begun = re.match(r"(\w+)  +(?=\S)", line)
        if begun and begun[1] in keys:
            key, column = begun[1], begun.end()
        elif not key or line[:column].strip() or not line.strip():
            key, column = "", 0
        yield key, line[column:]


def specs(spec: type[Spec]) -> Iterator[type[Spec]]:
    """A spec and all that its keys may hold."""
    yield spec
    for field in spec.model_fields.values():
        yield from inside(field.annotation)


def inside(annotation: Any) -> Iterator[type[Spec]]:
    """The specs in the type of a key, and in theirs."""
    if isinstance(annotation, type) and issubclass(annotation, Spec):
        yield from specs(annotation)
    for part in get_args(annotation):
        yield from inside(part)
