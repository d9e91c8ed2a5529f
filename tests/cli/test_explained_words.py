"""`trsim explain` knows every word of the tables in docs/scenarios.md, all units, and topics."""

import re

import pytest

from tests.test_circles import ROOT
from trsim.errors import UsageError
from trsim.scenario.explain import explained
from trsim.scenario.topics import NUMBERS, TOPICS
from trsim.statuses import STATUSES
from trsim.units import BASE, DERIVED, unit

NAMES = {  # in tables, that are no words of a file: names and numbers in examples, files, commands
    *("guide", "handle", "table", "tip", "speed", "phase_1", "phase_2"),
    *("z1", "z2", "r1", "r2", "c1", "kx", "ky", "kz", "starts", "from", "to", "z", "a"),
    *("path", "csv", "FILE", "channel", "trsim", "check", "export", "any", "the", "or", "its"),
    *("DRIVE", "JOINT", "BODY", "FORCE", "ROPE", "TIME", "PERIOD", "CHANNEL", "NAME"),
}


def known(word):
    try:
        return explained(word)
    except UsageError:
        return None


def rows():
    """The cells of the tables of the page, which say what a word means behind them."""
    for line in (ROOT / "docs/scenarios.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if line.startswith("|") and not set(line) <= set("|-: ") and len(cells) > 1:
            yield cells


def words():
    """Words of the first column, and of what stands as code in the second one."""
    found = set()
    for first, second, *_ in rows():
        codes = re.findall(r"`([^`]*)`", first) or [first]
        codes += re.findall(r"`([^`]*)`", second)
        found |= {word for code in codes for word in re.findall(r"[A-Za-z_]\w*", code)}
    return found - {"section", "key", "keys", "type", "what", "without", "dot"}


def test_every_word_of_the_tables():
    found = words()
    assert len(found) > 250
    assert [word for word in sorted(found - NAMES) if known(word) is None] == []


def test_names_are_none_of_these():
    """What is left out above stands in the tables, and is no word that is explained."""
    there = words() | {"NAME"}
    assert {*NAMES} <= there
    assert {word for word in NAMES if known(word)} <= {"table", "tip", "NAME"}


@pytest.mark.parametrize("word", ["torsion", "shear", "buckling", "friction", "units", "ground"])
def test_topics(word, trsim):
    code, out, _ = trsim("explain", word)
    assert code == 0
    assert out.startswith(f"{word}: {TOPICS[word].split()[0]}")


def test_a_topic_names_words_that_are_explained():
    for topic, text in TOPICS.items():
        for code in re.findall(r"`([^`]*)`", text):
            if not code.startswith("trsim "):
                for word in re.findall(r"[A-Za-z_]\w*", code):
                    assert known(word) or word in ("crank", "JOINT"), (topic, word)


def test_every_number_of_a_run():
    from trsim.analyse.outputs import KINDS

    assert NUMBERS.keys() == KINDS.keys()
    for word in KINDS:
        assert any(f"`trsim show FILE {word}:" in page["text"] for page in known(word)["topics"])


def test_commands_in_topics_are_there():
    from trsim.cli import COMMANDS

    for text in TOPICS.values():
        for command in re.findall(r"`trsim (\w+)", text):
            assert command in COMMANDS


@pytest.mark.parametrize("word", [*BASE, *DERIVED])
def test_every_unit_by_name(word):
    [page] = explained(word)["units"]
    assert page["factor"] == float(unit(word)[0])
    assert unit(page["unit"]) == (1, unit(word)[1])  # SI


def test_units(trsim):
    found = explained("units")["units"]
    assert [page["word"] for page in found] == [*BASE, *DERIVED]
    out = trsim("explain", "units")[1].splitlines()
    assert "1 mm = 0.001 m, a length" in out and "1 m, a length" in out
    assert (
        "1 rpm = 0.104719755 rad/s, an angular velocity" in out
        and "1 % = 0.01, a plain number" in out
    )


@pytest.mark.parametrize(
    "word, line",
    [
        ("N*m/rad", "1 N*m/rad, a torsional stiffness"),
        ("N/mm", "1 N/mm = 1000 N/m, a stiffness"),
        ("kN*s/m^2", "1 kN*s/m^2 = 1000 m^-1*kg*s^-1"),
    ],
)
def test_products_of_units(word, line, trsim):
    assert trsim("explain", word)[1].splitlines() == [line]


def test_what_a_key_may_be(trsim):
    assert [page["place"] for page in explained("gerstmayr")["values"]] == [
        "rigid_body.flexible.curvature", "ancf_cable.curvature",
    ]  # fmt: skip
    assert {page["word"] for page in explained("akima")["functions"]} == {"interpolation"}
    assert "sweep.method: grid | zip" in trsim("explain", "sobol")[1]


def test_what_is_recorded(trsim):
    [page] = explained("locating_force")["channels"]
    assert page["element"] == "shaft" and page["unit"] == "N"
    assert trsim("explain", "locating_force")[1].startswith(
        "NAME.locating_force: a channel of shaft"
    )


def test_how_a_run_ends():
    for status in STATUSES:
        assert known(status), status


def test_an_unknown_word_gets_the_nearest(trsim):
    code, _, err = trsim("explain", "torsoin")
    assert code == 2 and "Did you mean 'torsion'?" in err
