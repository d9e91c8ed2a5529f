"""Reports of what is no run and no sweep say what to name; comparisons of one run, too."""

import pytest

from tests import small


@pytest.fixture
def report(tmp_path, monkeypatch, capsys):
    """Runs a command line in a folder with runs; exit code and standard error."""
    from trsim.cli import main

    monkeypatch.chdir(tmp_path)
    for name in ("a", "b"):
        small.copy(tmp_path / "runs" / f"{name}.h5")
    (tmp_path / "crank.yaml").write_text(small.SLIDER_CRANK)
    for folder in ("empty", "study/figures", "all/one", "all/two"):
        (tmp_path / folder).mkdir(parents=True)
    for folder in ("study", "all/one", "all/two"):
        (tmp_path / folder / "plan.json").write_text("{}")

    def command(*words):
        with pytest.raises(SystemExit) as ended:
            main(["report", *words])
        return ended.value.code, capsys.readouterr().err

    return command


@pytest.mark.parametrize(
    "name, what, hint",
    [
        ("runs", "runs: not the folder of a sweep", "name some: runs/a.h5, runs/b.h5."),
        ("empty", "empty: not the folder of a sweep", "or of the folder of a sweep"),
        ("study/figures", "not the folder of a sweep", "`trsim report study`"),
        ("all", "all: not the folder of a sweep", "name one: all/one, all/two."),
        (".", ".: not the folder of a sweep", "below it: runs/a.h5, runs/b.h5."),
        ("crank.yaml", "crank.yaml is not a result file", "`trsim run crank.yaml` makes"),
        ("a.h5", "a.h5: no such file", "There is runs/a.h5."),
        ("b", "b: no such file", "There is runs/b.h5."),
        ("c", "c: no such file", ""),
    ],
)
def test_what_is_no_run(name, what, hint, report):
    for more in ((), ("--plot", "stroke")):
        code, err = report(name, *more)
        assert code == 7
        assert what in err and hint in err, err


def test_one_run_has_nothing_to_compare_with(report):
    for words, hints in (
        (("--against", "stroke"), ("--compare --against stroke", "--plot 'CHANNEL : stroke'")),
        (("--compare",), ("`trsim report runs/a.h5 OTHER.h5 --compare`",)),
        (("--compare", "--against", "stroke"), ("OTHER.h5 --compare --against stroke",)),
    ):
        code, err = report("runs/a.h5", *words)
        assert code == 2
        assert all(hint in err for hint in hints), err
