"""Shards in folders of their own, made into the folder of one sweep."""

import csv
import json
import os
import shutil
from itertools import islice

import h5py
import pytest

from tests import elsewhere
from tests.sweeps.test_go import SETS, TEXT, contents, here, made
from trsim.analyse.outputs import scalar
from trsim.errors import FileError, UsageError
from trsim.store.lock import writing
from trsim.store.read import verify
from trsim.sweeps.go import Shard, go, needs
from trsim.sweeps.ledger import Entry, entries
from trsim.sweeps.merge import Lost, merge
from trsim.sweeps.plan import plan
from trsim.sweeps.study import study

FORCE = "peak:B.contact_force"


def shards(scenario, folder, n=2, keep="all"):
    """The folders of n shards."""
    planned = plan(str(scenario), SETS, "one")._replace(keep=keep, numbers=(FORCE,))
    found = []
    for i in range(1, n + 1):
        found.append(folder / f"{i}")
        for _ in go(planned, found[-1], "one", here, Shard(i, n)):
            pass
    return planned, found


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    path = tmp_path_factory.mktemp("scenario") / "crank.yaml"
    path.write_text(TEXT)
    return path


@pytest.fixture(scope="module")
def filed(scenario, tmp_path_factory):
    """A plan, and the folders of two shards with result files."""
    return shards(scenario, tmp_path_factory.mktemp("filed"))


@pytest.fixture(scope="module")
def kept(scenario, tmp_path_factory):
    """The same, with records."""
    return shards(scenario, tmp_path_factory.mktemp("kept"), keep="summary")


@pytest.fixture(scope="module")
def calm(filed, tmp_path_factory):
    """The folder of the same sweep made in one piece."""
    folder = tmp_path_factory.mktemp("calm") / "whole"
    assert len([*go(filed[0], folder, "one", here)]) == 1 + 4
    return folder


@pytest.fixture
def two(filed, tmp_path):
    """Folders of two shards that may be changed."""
    for folder in filed[1]:
        shutil.copytree(folder, tmp_path / folder.name)
    return filed[0], [tmp_path / folder.name for folder in filed[1]]


def done(folders, output, link=False):
    """Merge; how many were to be taken, the entries, and what was lost."""
    n, *found = merge(folders, output, link)
    return (n, [one for one in found if isinstance(one, Entry)],
            [one for one in found if isinstance(one, Lost)])  # fmt: skip


def all_of(folder):
    """Every file, with what it holds and when it was written."""
    return {path.relative_to(folder): (path.read_bytes(), path.stat().st_mtime_ns)
            for path in sorted(folder.rglob("*")) if path.is_file()}  # fmt: skip


def index(folder):
    """Its rows, without wall times."""
    with (folder / "index.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    return [{**row, "wall_time": "", "integration_cpu": ""} for row in rows]


@pytest.mark.parametrize("link", [False, True])
def test_as_if_one_machine_had_run_all(filed, calm, tmp_path, link):
    planned, folders = filed
    before, output = list(map(all_of, folders)), tmp_path / "whole"
    assert done(folders, output, link)[0] == 4
    assert list(map(all_of, folders)) == before
    assert contents(output) == contents(calm)
    assert index(output) == index(calm)
    assert (output / "plan.json").read_bytes() == (calm / "plan.json").read_bytes()
    assert {path.relative_to(output) for path in output.rglob("*")} == {
        path.relative_to(calm) for path in calm.rglob("*")
    }
    assert all(verify(case.file) for case in study(output).cases)
    assert [need.why for _, need in needs(planned, output, "one")] == [""] * 4
    for case in study(output).cases:
        names = [folder / "cases" / case.file.name for folder in folders]
        [name] = [name for name in names if name.exists()]
        assert name.samefile(case.file) == link
        assert name.stat().st_mtime_ns == case.file.stat().st_mtime_ns
        # the ledger tells of the file as it is: nobody has to look into it
        assert case.entry == entries(output)[case.name]
        assert case.entry.changed == case.file.stat().st_mtime_ns


def test_records(kept, filed, tmp_path):
    planned, folders = kept
    before, output = list(map(all_of, folders)), tmp_path / "whole"
    assert done(folders, output)[0] == 4
    assert list(map(all_of, folders)) == before
    assert not any((output / "cases").iterdir())
    assert [need.why for _, need in needs(planned, output, "one")] == [""] * 4
    files = {case.name: case for folder in filed[1] for case in study(folder).cases if case.there}
    for case in study(output).cases:
        assert scalar(case.run(), FORCE) == scalar(files[case.name].run(), FORCE)
    assert done([*folders, *filed[1]], output)[0] == 4  # files are more than records
    assert all(case.filed for case in study(output).cases)
    assert done([*folders, *filed[1]], output)[0] == 0


def test_more_is_added_later(two, tmp_path):
    planned, (one, other) = two
    output = tmp_path / "whole"
    assert len(done([one], output)[1]) == 2
    assert [case.status for case in study(output).cases] == ["done", "missing"] * 2
    assert len(done([other], output)[1]) == 2
    assert [case.status for case in study(output).cases] == ["done"] * 4
    assert done([one, other], output)[0] == 0
    assert [need.why for _, need in needs(planned, output, "one")] == [""] * 4


@pytest.mark.parametrize("keep", ["all", "summary"])
def test_broken_off_and_gone_on_with(keep, filed, kept, tmp_path):
    """After each of its cases, and in the midst of a file that is copied."""
    _, folders = filed if keep == "all" else kept
    output = tmp_path / "whole"
    for n in range(4):
        going = merge(folders, output)
        assert next(going) == 4 - n
        assert isinstance(next(going), Entry)
        going.close()
        assert len(entries(output)) == n + 1
    last = output / "ledger.jsonl"
    lines = last.read_bytes().splitlines(keepends=True)
    last.write_bytes(b"".join(lines[:3]) + lines[3][:40])  # killed: two lines are lost
    case = study(folders[1]).cases[3]
    half = output / "cases" / f"{case.name}.h5.4711"
    if keep == "all":
        half.write_bytes(case.file.read_bytes()[:5000])
    assert len(done(folders, output)[1]) == 1
    assert not half.exists()
    assert contents(output) == {
        one.name: one.entry.content
        for folder in folders
        for one in study(folder).cases
        if one.there
    }
    assert len(entries(output)) == 4
    last.unlink()  # what its files say of themselves is enough, of records their folder is asked
    assert done(folders[:1], output)[0] == (4 if keep == "all" else 2)


def test_contradictions_are_refused_by_name(two, scenario, tmp_path):
    planned, (one, other) = two
    case = planned.cases[0].name
    made(scenario, tmp_path / "again", shard=Shard(1, 4))
    file = tmp_path / "again" / "cases" / f"{case}.h5"
    with h5py.File(file, "r+") as inside:
        inside.attrs["content_sha256"] = "0" * 64
    (tmp_path / "again" / "ledger-1of4.jsonl").unlink()
    again = json.loads((tmp_path / "again/plan.json").read_text())
    again["numbers"] = [FORCE]
    (tmp_path / "again/plan.json").write_text(json.dumps(again))
    before, folders = all_of(other), [one, other, tmp_path / "again"]
    with pytest.raises(FileError) as told:
        list(merge(folders, tmp_path / "whole"))
    assert told.value.what == f"{one} and {folders[2]} have different results of case {case}"
    assert not (tmp_path / "whole" / "plan.json").exists()
    assert all_of(other) == before
    done([one, other], tmp_path / "whole")  # and what is there already counts too
    with pytest.raises(FileError, match=f"have different results of case {case}"):
        list(merge([folders[2]], tmp_path / "whole"))


def lines(folder, *found):
    """Add lines to a ledger."""
    with (folder / "ledger-9of9.jsonl").open("a") as file:
        file.writelines(json.dumps(entry._asdict()) + "\n" for entry in found)


def died(case, at, reason=""):
    return Entry(case.name, case.digest, "one", "crashed", reason, 3, "", 0, 0, at, 0.0, {})


def test_of_several_the_best_is_taken(two, tmp_path):
    """A result before none, whichever came later; of two that failed the later."""
    planned, (one, other) = two
    first, second = planned.cases[0], planned.cases[1]
    ledger = other / "ledger-2of2.jsonl"  # in which the second is done
    done_in = ledger.read_text().splitlines(keepends=True)
    ledger.write_text("".join(line for line in done_in if second.name not in line))
    (other / "cases" / f"{second.name}.h5").unlink()
    lines(one, died(second, 1.0, "early"))
    lines(other, died(first, 3e9), died(second, 2.0, "late"))
    for folders in ([one, other], [other, one]):
        output = tmp_path / f"whole of {folders[0].name}"
        done(folders, output)
        found = study(output).named
        assert found[first.name].status == "done"
        assert (found[second.name].status, found[second.name].reason) == ("crashed", "late")
    later = tmp_path / "later"  # its own line is later than that of the result which it gets
    done([other], later)
    assert study(later).named[first.name].status == "crashed"
    done([one], later)
    assert study(later).named[first.name].status == "done"


def test_a_record_is_taken_before_none(kept, tmp_path):
    planned, folders = kept
    case, bad = planned.cases[0], tmp_path / "bad"
    bad.mkdir()
    shutil.copy(folders[1] / "plan.json", bad)
    lines(bad, died(case, 3e9))
    assert len(done([*folders, bad], tmp_path / "whole")[1]) == 4
    assert study(tmp_path / "whole").named[case.name].status == "done"


def test_what_is_not_what_the_ledger_tells_of_is_left_out(two, kept, tmp_path):
    planned, (one, other) = two
    case = planned.cases[0].name
    file = one / "cases" / f"{case}.h5"
    file.write_bytes(file.read_bytes()[:1000])
    _, found, lost = done([one, other], tmp_path / "whole")
    assert lost == [Lost(case, one, "its file was changed")]
    assert len(found) == 3
    assert [case.status for case in study(tmp_path / "whole").cases] == ["missing", *["done"] * 3]
    shutil.copytree(kept[1][0], tmp_path / "records")
    path = tmp_path / "records" / "summaries-1of2.jsonl.gz"
    data = bytearray(path.read_bytes())
    data[50] ^= 255
    path.write_bytes(data)
    _, found, lost = done([tmp_path / "records", kept[1][1]], tmp_path / "half")
    assert [(one.case, "is damaged from byte 0" in one.why) for one in lost] == [(case, True)]
    assert len(found) == 3


def test_other_sweeps_are_refused(two, scenario, tmp_path):
    _, (one, _) = two
    strange = tmp_path / "strange"
    made(scenario, strange, shard=Shard(1, 4))
    told = json.loads((strange / "plan.json").read_text())
    cases = told["cases"]
    for change, why in (
        ({}, "its numbers differ"),
        ({"engine": "two"}, "it was made by trsim two, not one"),
        ({"cases": cases[1:]}, f"it has no case {cases[0]['name']}"),
        ({"cases": [*cases, {**cases[0], "name": "more"}]}, "case more is of it alone"),
        ({"cases": [{**cases[0], "digest": "0"}, *cases[1:]]}, "has other numbers"),
        ({"cases": cases[::-1]}, "its cases come in another order"),
    ):  # fmt: skip
        (strange / "plan.json").write_text(json.dumps(told | change))
        with pytest.raises(UsageError, match=why):
            list(merge([one, strange], tmp_path / "whole"))
        with pytest.raises(UsageError, match=why):
            list(merge([one], strange))
    assert not (tmp_path / "whole").exists()


def test_where_it_may_not_go(two, tmp_path):
    _, (one, other) = two
    before = all_of(one)
    for output in (one, one / "cases", tmp_path / "link"):
        if output.name == "link":
            output.symlink_to(one)
        with pytest.raises(UsageError, match="which is to stay as it is"):
            list(merge([other, one], output))
    assert all_of(one) == before
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    with pytest.raises(UsageError, match="a folder of other files"):
        list(merge([one, other], tmp_path / "mine"))
    with pytest.raises(FileError, match="no such folder"):
        list(merge([one, tmp_path / "none"], tmp_path / "whole"))


@elsewhere.needs("fcntl")
def test_folders_that_are_being_written(two, tmp_path):
    _, (one, other) = two
    for busy in (one / "ledger-1of2.jsonl", tmp_path / "whole" / "ledger-1of2.jsonl",
                 tmp_path / "whole" / "ledger.jsonl"):  # fmt: skip
        with writing(busy), pytest.raises(FileError, match="is being written by process"):
            list(merge([one, other], tmp_path / "whole"))
    assert done([one, other], tmp_path / "whole")[0] == 4


def test_linked_only_where_that_is_possible(two, tmp_path, monkeypatch):
    _, folders = two

    def elsewhere(*_):
        raise OSError(18, "Invalid cross-device link")

    monkeypatch.setattr(os, "link", elsewhere)
    with pytest.raises(FileError, match="cannot be a second name") as told:
        list(merge(folders, tmp_path / "whole", link=True))
    assert "Without --link files are copied" in told.value.hint
    assert done(folders, tmp_path / "whole")[0] == 4


def test_what_is_replaced_leaves_its_other_name_alone(two, tmp_path):
    """A case that is run again in the folder that was made does not change the one it came from."""
    planned, folders = two
    done(folders, tmp_path / "whole", link=True)
    before = list(map(all_of, folders))
    changed = planned._replace(cases=(planned.cases[0]._replace(digest="other"),))
    assert len([*islice(go(changed, tmp_path / "whole", "one", here), 2)]) == 2
    assert list(map(all_of, folders)) == before
