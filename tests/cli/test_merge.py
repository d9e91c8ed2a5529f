"""trsim merge as a user types it, and as Python calls it."""

import pytest

import trsim as library
from tests import small
from tests.sweeps.test_go import here
from trsim.sweeps.folder import write_plan
from trsim.sweeps.go import Shard, engine, go
from trsim.sweeps.plan import plan

VARY = ("joints.B.clearance=lin(0.4 mm, 0.5 mm, 3)", "solver.end=0.5 ms")
SWEEP = ("sweep", "crank.yaml", *(word for one in VARY for word in ("--set", one)))


@pytest.fixture
def shards(scenario):
    """The folders of two of three shards, in the current folder."""
    planned = plan("crank.yaml", VARY, engine())
    for i in (1, 2):
        assert len([*go(planned, scenario.parent / f"s{i}", engine(), here, Shard(i, 3))]) == 2
    return scenario.parent


def test_merged_told_and_gone_on_with(shards, trsim, answer):
    code, out, err = trsim("merge", "s1", "s2", "-o", "whole")
    assert (code, out) == (0, "whole/index.csv\n")
    assert "whole: 3 cases, 2 taken in" in err and "2 done, 1 missing" in err
    assert "1 missing" in trsim("status", "whole")[1]
    code, told = answer("merge", "s1", "s2", "-o", "whole", "--link")
    assert (told["cases"], told["taken"], told["left_out"]) == (3, 0, [])
    assert told["counts"] == {"done": 2, "missing": 1}
    code, _, err = trsim(*SWEEP, "-o", "whole", "--explain", "--dry-run")
    assert code == 0 and "1 of 3 cases are to be run" in err


def test_what_is_left_out_and_refused(shards, trsim, answer):
    [file] = (shards / "s1" / "cases").glob("*.h5")
    whole = file.read_bytes()
    file.write_bytes(b"other")
    code, _, err = trsim("merge", "s1", "s2", "-o", "whole")
    assert code == 0
    assert f"s1: warning: case {file.stem} is left out: its file was changed" in err
    file.write_bytes(whole)
    assert answer("merge", "s1", "s2", "-o", "whole")[1]["taken"] == 1
    (shards / "x.yaml").write_text(small.SLIDER_CRANK)
    (shards / "other").mkdir()
    write_plan(shards / "other", plan("x.yaml", ("solver.max_steps=[3, 4]",), engine()), engine())
    for words, code, what in (
        (("s1", "other", "-o", "w"), 2, "other is of another sweep than s1: case max_steps=3"),
        (("s1", "-o", "s1"), 2, "s1 is in s1, which is to stay as it is"),
        (("-o", "w"), 2, "Missing argument"),
        (("s1",), 2, "Missing option"),
        (("s1", "none", "-o", "w"), 7, "none: no such folder"),
        (("s1", "crank.yaml", "-o", "w"), 7, "not the folder of a sweep"),
    ):
        ended, _, err = trsim("merge", *words)
        assert (ended, what in err) == (code, True), err


def test_from_python(shards):
    found = library.merge([shards / "s1", "s2"], "whole", link=True)
    assert [case.status for case in found.cases] == ["done", "done", "missing"]
    assert found.cases[0].file.stat().st_nlink == 2
    for wrong in ("s1", []):
        with pytest.raises(library.UsageError, match=r"a list of folders|no folders"):
            library.merge(wrong, "w")
