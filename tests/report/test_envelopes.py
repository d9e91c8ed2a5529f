"""The envelope of a sweep as tables, lines and pictures."""

import csv
from dataclasses import replace

import pytest

from tests.analyse.test_envelope import DOWN, cases  # noqa: F401
from tests.report.test_figures import drawn
from trsim.analyse.envelope import envelope
from trsim.errors import UsageError
from trsim.report import check_asked, envelopes, studies
from trsim.report.asked import Asked
from trsim.report.style import look


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_tables_lines_and_pictures(cases, tmp_path):  # noqa: F811
    asked = Asked(envelope="hinge.reaction*, angle", at="angle", along=("bob.velocity.x",))
    found = studies.draw(cases, asked, [], tmp_path)
    names = [path.name for path in found.files]
    assert names == ["envelope.png", "envelope_2.png", "envelope.csv", "envelope_cases.csv"]
    assert all(0.005 < drawn(path) < 0.5 for path in found.files[:2])
    table = rows(tmp_path / "envelope.csv")
    [one] = [r for r in table if (r["quantity"], r["extreme"]) == ("hinge.reaction", "magnitude")]
    assert (one["case"], one["unit"], one["known from"]) == ("load.2", "N", "motion")
    assert float(one["value"]) == pytest.approx(2.0 * DOWN, rel=1e-7)
    assert float(one["y"]) == pytest.approx(2.0 * DOWN, rel=1e-5)
    assert float(one["bob.velocity.x [m/s]"]) < -4.0
    assert float(one["angle [rad]"]) == pytest.approx(-1.5708, abs=1e-3)
    assert [r["x"] for r in table if r["quantity"] == "angle"] == ["", ""]
    every = rows(tmp_path / "envelope_cases.csv")
    assert {r["case"]: r["status"] for r in every} == {
        "load.1": "done", "load.2": "done", "same.as.2": "done", "heavy": "failed", "bare": "done",
        "lost": "missing",
    }  # fmt: skip
    assert {r["value"] for r in every if r["case"] in ("heavy", "bare", "lost")} == {"nan"}
    told = "\n".join(found.lines)
    parts = ("magnitude hinge.reaction in load.2 at", "bare: no hinge.reaction",
                 "did not end well and are left out: heavy", "no result and are left out: lost",
                 "bare: no channel named 'angle'",
             "zero in every case: hinge.reaction.z")  # fmt: skip
    assert [text for text in parts if text not in told] == []
    assert found.values[0].unit in ("N", "rad")


def test_picture(cases):  # noqa: F811
    one = studies.shown(cases)
    of = [q for q in envelope(cases, ["angle", "hinge.reaction"], "", []) if q.unit == "rad"]
    with look():
        axes = envelopes.figure(one, of, "rad").axes[0]
    assert [tick.get_text() for tick in axes.get_yticklabels()] == ["angle"]
    [bar] = axes.patches
    ends = bar.get_x(), bar.get_x() + bar.get_width()
    assert ends == (pytest.approx(-180.0, abs=0.1), pytest.approx(0.0, abs=1e-9))
    assert "(deg)" in axes.get_xlabel()


def test_what_an_envelope_goes_with(cases, tmp_path):  # noqa: F811
    file = cases.cases[0].file
    wrong = [([file], Asked(envelope="forces"), "not for result files"),
             ([tmp_path], Asked(at="angle"), "--at goes with"),
             ([tmp_path], Asked(along=("angle",)), "--with goes with")]  # fmt: skip
    for paths, asked, what in wrong:
        with pytest.raises(UsageError, match=what):
            check_asked(paths, asked)
    few = replace(cases, cases=cases.cases[:1])
    with pytest.raises(UsageError, match="no channel named 'angel'"):
        studies.draw(few, Asked(envelope="forces", at="angel"), [], tmp_path)
