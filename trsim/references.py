"""References: the keys of a spec whose text is the name of something else.

What is typed `str` is a reference, alone or in a list, and so are the keys of a mapping.  Words (a
Literal), quantities and expressions are typed otherwise.
"""

from collections.abc import Mapping
from functools import cache
from typing import Any, Literal, get_args, get_origin


@cache
def _is_reference(annotation: Any) -> bool:
    """Whether `str` stands anywhere in the type of a key."""
    if annotation is str:
        return True
    if get_origin(annotation) is Literal:
        return False
    return any(_is_reference(part) for part in get_args(annotation))


def renamed(fields: Mapping[str, Any], data: dict, names: Mapping[str, str]) -> dict:
    """The data of a spec with these fields, with other names for those in `names`."""
    found = dict(data)
    for key, value in data.items():
        if key in fields and _is_reference(fields[key].annotation):
            found[key] = _meant(value, names)
    return found


def _meant(value: Any, names: Mapping[str, str]) -> Any:
    if isinstance(value, str):
        joint, dot, coordinate = value.rpartition(".")
        return names.get(value) or names.get(joint, joint) + dot + coordinate
    if isinstance(value, list | tuple):
        return [_meant(item, names) for item in value]
    if isinstance(value, dict):
        return {_meant(key, names): item for key, item in value.items()}
    return value
