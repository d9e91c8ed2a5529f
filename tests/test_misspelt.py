"""Every key of every spec, misspelt by one edit, is found and corrected."""

from collections import Counter
from itertools import islice
from typing import get_args

import pytest

from trsim import elements
from trsim.errors import TrsimError
from trsim.fields import Spec
from trsim.scenario.load import loads
from trsim.scenario.scenario import Scenario

LETTERS = "abcdefghijklmnopqrstuvwxyz_"
LEAST = 0.95  # of the misspellings get the right suggestion
BESIDE = 16  # misspelt keys in one text: fewer than the problems that are listed


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


def written(path, lines, needed, *typos):
    """The scenario, its keys one to a line, and the line of the last misspelt one."""
    text = [f"{'  ' * depth}{'-' if key == 0 else f'{key}:'}" for depth, key in enumerate(path)]
    text[2:2] = [f"    {line}" for line in lines]
    indent = "  " * len(path)
    text += [f"{indent}{key}: 1" for key in (*needed, *typos)]
    return "\n".join(text) + "\n", len(text)


def problems(text):
    """What is said of a scenario, by the text of each problem; what is said twice is left out."""
    with pytest.raises(TrsimError) as caught:
        loads(text)
    said = Counter(p.what for p in caught.value.problems)
    return {p.what: p for p in caught.value.problems if said[p.what] == 1}


def batched(words, n):
    """The words, n at a time: itertools has it from Python 3.12 on."""
    rest = iter(words)
    return iter(lambda: tuple(islice(rest, n)), ())


def told(path, lines, needed, typos):
    """Each misspelling with its problem and its line.

    One text has many of them, in a third of the time.  What is not told of one there, or elsewhere
    than expected, is asked again of a text of its own.
    """
    for some in batched(typos, BESIDE):
        text, last = written(path, lines, needed, *some)
        found = problems(text)
        for line, typo in enumerate(some, last - len(some) + 1):
            one = found.get(f"unknown key '{typo}'")
            if one is None or one.place is None or one.place.line != line:
                text, line = written(path, lines, needed, typo)
                one = problems(text).get(f"unknown key '{typo}'")
            yield typo, one, line


def test_every_key_of_every_spec():
    count, right, elsewhere, wrong = 0, 0, [], []
    for path, lines, spec in all_places():
        keys = set(spec.model_fields) | ({"type"} if lines else set())
        for key in spec.model_fields:
            needed = [k for k, f in spec.model_fields.items() if f.is_required() and k != key]
            typos = sorted({*slips(key)} - keys - {"", "extends"})
            for typo, found, line in told(path, lines, needed, typos):
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
