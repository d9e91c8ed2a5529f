"""What became of cases, line by line: which line counts, and which are none."""

import json

import pytest

from trsim.sweeps.ledger import Entry, entries, entry_of, line_of

ENDED = Entry("a", "d", "e", "done", "", 1, "c", 10, 20, 3.0, 0.5, {"time": 1.0})


def written(path, *made):
    path.write_text("".join(json.dumps(one._asdict()) + "\n" for one in made))


def test_of_one_process_the_last_line_counts_whatever_its_clock_said(tmp_path):
    ahead = ENDED._replace(status="crashed", at=ENDED.at + 86_400.0)
    written(tmp_path / "ledger.jsonl", ahead, ENDED)
    assert entries(tmp_path) == {"a": ENDED}


def test_of_several_shards_the_latest_counts(tmp_path):
    later = ENDED._replace(status="crashed", at=ENDED.at + 1.0)
    written(tmp_path / "ledger-1of2.jsonl", later)
    written(tmp_path / "ledger-2of2.jsonl", ENDED)
    assert entries(tmp_path) == {"a": later}


@pytest.mark.parametrize(
    "change",
    [
        {"reason": "\ud800"},
        {"case": "\udfff"},
        {"summary": {"\udc00": 1.0}},
        {"status": ""},
        {"status": "x"},
        {"status": "Done"},
        {"attempts": True},
        {"at": 1e300},
        {"summary": {"time": []}},
    ],
    ids=str,
)
def test_what_is_no_line(change):
    line = json.dumps(ENDED._asdict() | change).encode()
    assert entry_of(json.dumps(ENDED._asdict()).encode()) == ENDED
    assert entry_of(line) is None


@pytest.mark.parametrize("half", [rb"\uD800", rb"\udfff", b"\xed\xa0\x80"], ids=repr)
def test_half_of_a_pair_however_it_is_written(half):
    line = json.dumps(ENDED._asdict() | {"reason": "HALF"}).encode()
    assert entry_of(line) is not None
    assert entry_of(line.replace(b"HALF", half)) is None


def test_letters_of_any_script():
    told = ENDED._replace(reason="\u00e4 \u6469 \U0001f527")
    assert entry_of(json.dumps(told._asdict()).encode()) == told


def test_a_line_that_was_changed_anywhere_is_none():
    line = line_of(ENDED._replace(content="0123abcd", summary={"time": 1.0, "steps": 12}))
    assert entry_of(line) is not None
    for k in range(len(line)):
        for bit in range(8):
            changed = bytearray(line)
            changed[k] ^= 1 << bit
            assert entry_of(bytes(changed)) is None, bytes(changed)


def test_words_of_a_check_sum_in_a_reason():
    told = ENDED._replace(reason='a line with , "check": 1}')
    assert entry_of(line_of(told)) == told


def test_lines_of_older_versions_have_no_check_sum(tmp_path):
    written(tmp_path / "ledger.jsonl", ENDED)
    assert entries(tmp_path) == {"a": ENDED}
