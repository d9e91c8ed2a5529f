"""Every key of every spec, misspelt by one edit, is found and corrected."""

from typing import get_args

import pytest

from trsim import elements
from trsim.errors import TrsimError
from trsim.fields import Spec
from trsim.scenario.load import loads
from trsim.scenario.scenario import Scenario

LETTERS = "abcdefghijklmnopqrstuvwxyz_"
LEAST = 0.95  # of the misspellings get the right suggestion


def specs_in(annotation):
    """The specs a key may hold."""
    if isinstance(annotation, type) and issubclass(annotation, Spec):
        return [annotation]
    return [spec for part in get_args(annotation) for spec in specs_in(part)]


def places(spec, path, lines):
    """(path of a mapping, first line of its entry, its spec), for a spec and all within it."""
    yield path, lines, spec
    for key, field in spec.model_fields.items():
        for inner in specs_in(field.annotation):
            yield from places(inner, (*path, key, *below(field.annotation)), lines)


def below(annotation):
    """What stands between a key and a spec that it holds: a name, a place in a list, nothing."""
    parts = get_args(annotation)
    if parts[:1] == (str,):
        return ("thing",)
    if parts[1:] == (Ellipsis,):
        return (0,)
    return next(filter(None, map(below, parts)), ())


def all_places():
    yield from places(Scenario, (), [])
    for word, section in elements.ELEMENTS.items():
        if section:
            lines = [] if elements.DEFAULT.get(section) == word else [f"type: {word}"]
            yield from places(elements.load(word).spec, (section, "thing"), lines)


def slips(word):
    """A letter left out, doubled, replaced, put in; two swapped: all places, some letters."""
    for k in range(len(word)):
        letter = LETTERS[(7 * k + len(word)) % len(LETTERS)]
        yield word[:k] + word[k + 1 :]
        yield word[:k] + word[k] + word[k:]
        yield word[:k] + letter + word[k + 1 :]
        yield word[:k] + letter + word[k:]
        yield word[:k] + word[k + 1 : k + 2] + word[k] + word[k + 2 :]


def written(path, lines, needed, typo):
    """The scenario, its keys one to a line, and the line of the misspelt one."""
    text = [f"{'  ' * depth}{'-' if key == 0 else f'{key}:'}" for depth, key in enumerate(path)]
    text[2:2] = [f"    {line}" for line in lines]
    indent = "  " * len(path)
    text += [f"{indent}{key}: 1" for key in (*needed, typo)]
    return "\n".join(text) + "\n", len(text)


def problem(text, typo):
    with pytest.raises(TrsimError) as caught:
        loads(text)
    found = [p for p in caught.value.problems if p.what == f"unknown key '{typo}'"]
    return found[0] if len(found) == 1 else None


def test_every_key_of_every_spec():
    count, right, elsewhere, wrong = 0, 0, [], []
    for path, lines, spec in all_places():
        keys = set(spec.model_fields) | ({"type"} if lines else set())
        for key in spec.model_fields:
            needed = [k for k, f in spec.model_fields.items() if f.is_required() and k != key]
            for typo in sorted({*slips(key)} - keys - {"", "extends"}):
                text, line = written(path, lines, needed, typo)
                found = problem(text, typo)
                count += 1
                if found is None or found.place is None or found.place.line != line:
                    elsewhere.append((*path, key, typo))
                elif f"Did you mean '{key}'?" in found.hint:
                    right += 1
                else:
                    wrong.append((*path, key, typo, found.hint))
    print(f"{count} misspelt keys: {right / count:.2%} corrected, {len(elsewhere)} misplaced")
    assert count > 3000
    assert elsewhere == []
    assert right >= LEAST * count, wrong
