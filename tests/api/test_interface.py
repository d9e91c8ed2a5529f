"""trsim from Python: load, check, run, sweep, Result, Sweep, and the errors of the command."""

import sys
import threading
import warnings
from importlib import import_module

import numpy as np
import pytest

import trsim
from tests import drawn, inside, small
from tests.store import outside
from trsim.cli import main

G, SPEED, END = 9.81, 3.0, 0.5
BALL = {"mass": 2.0, "inertia": 0.01, "velocity": [SPEED, 0]}
DROP = {
    "title": "drop",
    "bodies": {"ball": BALL},
    "gravity": [0, -G, 0],
    "solver": {"end": "0.5 s"},
    "output": {"every": "10 ms"},
}
pytestmark = pytest.mark.filterwarnings("ignore::trsim.TrsimWarning")


@pytest.fixture
def drop():
    return trsim.run(DROP)


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "crank.yaml").write_text(small.SLIDER_CRANK, encoding="utf-8")
    return tmp_path


def fails(error, call, *words):
    with pytest.raises(error) as caught:
        call()
    for word in words:
        assert word in str(caught.value)
    return caught.value


# --- start -----------------------------------------------------------------------------------


def test_import_is_quick():
    """Nothing but the version is imported before something is asked for."""
    code = "import sys; before = {*sys.modules}; import trsim; print(sorted(n for n in sys.modules"
    code += " if n not in before and n.startswith('trsim')), len({*sys.modules} - before))"
    out, _ = outside.started(outside.ROOT, "-c", code).communicate()
    names, count = out.rsplit(maxsplit=1)
    assert names == "['trsim', 'trsim.version']"
    assert int(count) == 2  # none of Python's own that was not there


def test_names():
    for name in trsim.__all__:
        assert getattr(trsim, name) is not None and name in dir(trsim)
    with pytest.raises(AttributeError, match="no attribute 'simulate'"):
        trsim.simulate  # noqa: B018
    import_module("trsim.sweeps.plan")
    assert callable(trsim.sweep)


# --- a dict, a file --------------------------------------------------------------------------


def test_a_drop_falls(drop):
    """y = -g t^2 / 2, x = v t."""
    assert (drop.status, drop.reason, drop.title) == ("done", "", "drop")
    t, place = drop.time, drop["ball.position"]
    assert t == pytest.approx(np.linspace(0, END, 51))
    assert place[:, 0] == pytest.approx(SPEED * t, abs=1e-12)
    assert place[:, 1] == pytest.approx(-G * t * t / 2, abs=1e-12)
    assert drop["ball.position.y"] == pytest.approx(place[:, 1])
    assert "ball.position.y" in drop and "ball.speed" not in drop
    assert len(drop) == len(drop.names)


def test_the_same_as_of_the_command(here, drop):
    """A dict, its file and what `load` gives: the same bytes of results."""
    import json

    (here / "drop.yaml").write_text(json.dumps(DROP), encoding="utf-8")
    with pytest.raises(SystemExit) as ended:
        main(["run", "drop.yaml", "-q"])
    assert ended.value.code == 0
    content = trsim.Result("runs/drop.h5").run.attributes["content_sha256"]
    assert trsim.run("drop.yaml", "other.h5").summary["content_sha256"] == content
    assert drop.summary["content_sha256"] == trsim.run(trsim.load(DROP)).summary["content_sha256"]
    again = trsim.run("runs/drop.h5")
    assert str(again.file) == "runs/drop.again.h5" or again.file.name == "drop.again.h5"
    assert again.summary["content_sha256"] == content
    assert trsim.run("drop.yaml").file.parts == ("runs", "drop.h5")


def test_of_numpy():
    """Arrays and numbers of numpy are lists and numbers."""
    given = {
        **DROP,
        "gravity": np.array([0, -G, 0]),
        "bodies": {"ball": {**BALL, "mass": np.float32(2)}},
    }
    assert trsim.load(given).resolved == trsim.load(DROP).resolved
    assert trsim.load({**DROP, "gravity": (0, -G, 0)}).resolved == trsim.load(DROP).resolved


def test_words_stay_words():
    """A text that YAML would take for something else."""
    for word in ("1e3", "no", "null", "a: b # c", "ü \u2028 \x85 \"'", "- x"):
        assert trsim.load({**DROP, "title": word}).title == word


def test_a_dict_is_left_as_it_is():
    before = repr(DROP)
    trsim.run(DROP, set={"bodies.ball.mass": "3 kg"})
    assert repr(DROP) == before


def test_set(drop):
    assert trsim.load(DROP, {"bodies.ball.mass": "3 kg"}).bodies["ball"].mass == 3.0
    assert trsim.load(trsim.load(DROP), {"bodies.ball.mass": 4}).bodies["ball"].mass == 4.0
    found = trsim.run(DROP, set={"gravity": [0, -2 * G, 0]})
    assert found["ball.position.y"][-1] == pytest.approx(-G * END * END)


def test_files_that_a_dict_names(here):
    """Lie in the current folder; their faults have lines."""
    (here / "load.csv").write_text("0, 1\n1, x\n", encoding="utf-8")
    force = {"type": "applied_load", "body": "ball", "direction": [1, 0, 0]}
    given = {**DROP, "forces": {"push": {**force, "force": {"table": "load.csv"}}}}
    fails(trsim.ScenarioError, lambda: trsim.load(given), "load.csv:2:")


def test_a_file_is_there_as_long_as_its_result():
    found = trsim.run(DROP)
    file = found.file
    assert file.is_file()
    del found
    assert not file.exists()


def test_a_run_that_is_refused_leaves_no_folder(tmp_path, monkeypatch):
    """It was removed once Python came upon it, with a ResourceWarning anywhere."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    for given in ({**DROP, "solver": {}}, {**DROP, "gravity": "down"}):
        with pytest.raises(trsim.ScenarioError) as refused:
            trsim.run(given)
        assert refused.value and not [*tmp_path.iterdir()]


# --- what is refused -------------------------------------------------------------------------


def push(t):
    return 3 * t


def test_a_function_of_python_is_refused():
    """With what to write instead."""
    force = {"type": "applied_load", "body": "ball", "direction": [1, 0, 0]}
    for given in (push, lambda t: t, np.sin, float):
        scene = {**DROP, "forces": {"push": {**force, "force": given}}}
        words = ("forces.push.force", "a function of Python", "sin(2*pi*t)", "table")
        error = fails(trsim.ScenarioError, lambda scene=scene: trsim.run(scene), *words)
        assert error.path == ("forces", "push", "force")
    fails(trsim.ScenarioError, lambda: trsim.run(DROP, set={"gravity": push}), "push")


@pytest.mark.parametrize(
    "change, words",
    [
        ({"bodies": {"ball": {"mass": -1}}}, ("scenario: bodies.ball.mass: must be >= 0", "kg")),
        ({"bodies": {"ball": {"masss": 1}}}, ("unknown key 'masss'", "Did you mean 'mass'?")),
        ({"title": float("nan")}, ("title: not a finite number",)),
        ({"gravity": [0, float("inf"), 0]}, ("gravity.1: not a finite number",)),
        ({"bodies": {1: BALL}}, ("bodies: a key must be a word, got 1",)),
        ({"bodies": {"ball": object()}}, ("bodies.ball: an object of the type object",)),
        ({"bodies": [1]}, ("bodies: must be a mapping",)),
        ({"solver": {"end": "0.5 kg"}}, ("solver.end", "'kg' is a mass")),
    ],
)
def test_a_wrong_dict(change, words):
    """The place in it, what is wrong, and what to do; no line, which it has not."""
    error = fails(trsim.ScenarioError, lambda: trsim.load({**DROP, **change}), *words)
    assert error.exit_code == 3
    assert "scenario:0" not in str(error) and "^" not in str(error)


def test_a_dict_in_itself():
    given = dict(DROP)
    given["bodies"] = given
    fails(trsim.ScenarioError, lambda: trsim.load(given), "holds itself")


def test_a_wrong_file_has_its_line(here):
    text = small.SLIDER_CRANK.replace("clearance: 0.5 mm", "clearance: 0.5 kg")
    (here / "wrong.yaml").write_text(text, encoding="utf-8")
    for call in (trsim.load, trsim.check, trsim.run):
        error = fails(trsim.ScenarioError, lambda call=call: call("wrong.yaml"), "wrong.yaml:9:")
        assert (error.place.line, error.path) == (9, ("joints", "B", "clearance"))
    fails(trsim.FileError, lambda: trsim.load("none.yaml"), "none.yaml: no such file")
    fails(trsim.UsageError, lambda: trsim.load(3), "the name of a file or a dict")
    fails(trsim.UsageError, lambda: trsim.load("a: 1\nb: 2"), "yaml.safe_load")
    fails(trsim.UsageError, lambda: trsim.run("crank.yaml", "crank.yaml"), "crank.yaml")
    fails(trsim.UsageError, lambda: trsim.run(DROP, certify="foo:1"), "no method 'foo'")
    fails(trsim.UsageError, lambda: trsim.run(DROP, checkpoint=float("nan")), "checkpoint")
    fails(trsim.UsageError, lambda: trsim.run(DROP, set=["a=1"]), "no dict")
    endless = {**DROP, "solver": {}}
    fails(trsim.ScenarioError, lambda: trsim.run(endless), "field required: end")


def test_several_faults_at_once():
    wrong = {**DROP, "bodies": {"ball": {"mass": -1, "inertia": -1}}}
    error = fails(trsim.Problems, lambda: trsim.load(wrong))
    assert [one.path[-1] for one in error.problems] == ["mass", "inertia"]


def test_a_run_that_fails(here):
    """Its error has what was computed; without `raises` that is what is given."""
    set = {"solver.method": "rk4", "solver.force": True, "solver.step": "0.05 ms"}
    error = fails(trsim.SolverError, lambda: trsim.run("crank.yaml", set=set), "the solver failed")
    assert error.result.status == "failed" and error.result.file.is_file()
    found = trsim.run("crank.yaml", set=set, raises=False)
    assert found.status == "failed" and found.reason


def test_warnings_are_pythons():
    """Each once, at the line of whoever called."""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        found = trsim.run(DROP)
    said = [str(one.message) for one in heard]
    assert [one.category for one in heard] == [trsim.TrsimWarning]
    assert "planar motion assumed" in said[0] and heard[0].filename == __file__
    assert len(found.warnings) == 1


def test_messages_go_to_the_log(here, caplog):
    with caplog.at_level("INFO", "trsim"):
        trsim.run("crank.yaml", certify="radau:1e-8")
    assert "crank.yaml: first its twin, by radau at 1e-08" in caplog.text


def test_in_another_thread(here):
    """Signals belong to the first one."""
    found = []
    thread = threading.Thread(target=lambda: found.append(trsim.run(DROP)))
    thread.start()
    thread.join()
    assert found[0].status == "done"


INTERRUPTED = """
import signal, threading, time, trsim
from pathlib import Path

signal.signal(signal.SIGINT, signal.default_int_handler)  # also where a shell had it ignored

def end():
    while not Path("long.h5.part").exists() or Path("long.h5.part").stat().st_size < 200_000:
        time.sleep(0.02)
    signal.raise_signal(signal.SIGINT)

def interrupted():
    threading.Thread(target=end, daemon=True).start()
    try:
        trsim.run("crank.yaml", "long.h5", {"solver.end": "0.15 s"}, checkpoint=0.05)
    except KeyboardInterrupt as stop:
        print(stop)
    print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)

interrupted()
whole = trsim.run("crank.yaml", "long.h5", {"solver.end": "0.15 s"}, resume=True)
print(whole.summary["resumed_from"] > 0, whole.summary["content_sha256"])
"""


def test_interrupted_and_resumed(here):
    """Ctrl-C ends a run safely; the call that is told goes on, to the same bytes."""
    out, err = outside.started(here, "-c", INTERRUPTED).communicate()
    told, before, resumed = out.splitlines()
    assert "long.h5.part holds the run until" in told, err
    again = "`trsim.run('crank.yaml', 'long.h5', set={'solver.end': '0.15 s'}, checkpoint=0.05, "
    assert f"{again}resume=True)` goes on with the run" in told
    assert before == "True"
    unbroken = trsim.run("crank.yaml", "unbroken.h5", {"solver.end": "0.15 s"})
    assert resumed == f"True {unbroken.summary['content_sha256']}"


# --- check -----------------------------------------------------------------------------------


def test_check(here):
    found = trsim.check("crank.yaml", modes=True)
    # a crank that a motor turns, a slider on a guide, and a rod that is loose at one end
    assert (found.mobility, found.redundant) == (2, [])
    assert found.bodies == ["crank", "rod", "slider"]
    assert found["modes"] and found["contacts"] == ["B"]
    assert any("planar motion assumed" in note for note in trsim.check(DROP).notes)
    assert trsim.check(DROP).mobility == 3


# --- results ---------------------------------------------------------------------------------


def test_frame(drop):
    table = drop.frame("ball.position", "energy.kinetic", units={"ball.position": "mm"})
    assert list(table.columns) == [*(f"ball.position.{axis}" for axis in "xyz"), "energy.kinetic"]
    assert table["ball.position.y"].iloc[-1] == pytest.approx(-1e3 * G * END * END / 2)
    assert table.attrs["units"]["ball.position.y"] == "mm"
    assert table.attrs["units"]["energy.kinetic"] == "J" and table.index.name == "time"
    assert set(drop.frame().columns) >= {"ball.velocity.x", "energy.residual"}
    fails(trsim.UsageError, lambda: drop.frame("ball.positon"), "Did you mean 'ball.position'?")
    fails(trsim.UsageError, lambda: drop.frame("ball.position", units={"ball.velocity": "m/s"}))


def test_dataset(drop):
    pytest.importorskip("xarray")
    found = drop.dataset("ball.position", "energy.kinetic")
    last = found["ball.position"].sel({"component.xyz": "y"}).isel(time=-1)
    assert float(last) == pytest.approx(-G * END * END / 2)
    assert found["ball.position"].attrs["units"] == "m" and found.time.attrs["units"] == "s"
    assert set(drop.dataset()) == set(drop.names)


def test_no_xarray(drop, monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    fails(trsim.UsageError, drop.dataset, "pip install xarray")


def test_numbers(drop):
    fall = G * END * END / 2
    assert drop.number("final:ball.position.y") == pytest.approx(-fall)
    assert drop.number("final:ball.position.y", "mm") == pytest.approx(-1e3 * fall)
    assert drop.number("mean:ball.position.x@0.1..0.3", "cm") == pytest.approx(20 * SPEED)
    assert drop.channel("ball.velocity.x", "km/h") == pytest.approx(3.6 * SPEED)
    fails(trsim.UsageError, lambda: drop.number("peek:x"), "Did you mean 'peak'?")
    fails(trsim.UsageError, lambda: drop.channel("ball.position", "kg"), "no unit of a number in m")
    fails(trsim.UsageError, lambda: drop.channel("ball.position", "mmm"), "mmm")
    fails(trsim.UsageError, lambda: drop["ball.place"], "no channel named 'ball.place'")


def test_events_and_peaks(here):
    found = trsim.run("crank.yaml")
    events = found.events
    assert set(events["kind"]) >= {"onset"} and set(events["element"]) >= {"B"}
    assert events["time"].is_monotonic_increasing
    peaks = found.peaks
    of = peaks[(peaks.channel == "B.contact_force") & (peaks.extreme == "largest")].iloc[0]
    assert of.value == found.number("peak:B.contact_force") > 0.0 and of.unit == "N"
    assert list(found.frame("stroke").columns) == ["stroke"]
    assert found.solver["method"] == "dop853" and found.scenario["title"] == found.title


def test_what_a_notebook_shows(here, drop):
    text = trsim.run("crank.yaml", set={"title": "a <b>"})._repr_html_()
    assert "a &lt;b&gt;" in text and "done" in text and "B.contact_force" in text
    assert "planar motion assumed" in drop._repr_html_()
    assert "done" in repr(drop)


def test_figures(drop, here, monkeypatch):
    drawn.few(monkeypatch)
    found = drop.plot("ball.position.y : ball.position.x", window="0..1")
    assert [one.png[:8] for one in found] == [b"\x89PNG\r\n\x1a\n"]
    assert found[0]._repr_png_() == found[0].png
    assert found._repr_html_().startswith('<img alt="plot_ball') and "base64" in found._repr_html_()
    (path,) = found.save(here / "figures")
    assert path.read_bytes() == found[0].png
    (here / "x.png").write_bytes(b"mine")
    fails(trsim.UsageError, lambda: found[0].save(here / "x.png"), "exists")
    assert drop.report(here / "all") and drop.plot()
    fails(trsim.UsageError, lambda: drop.plot("ball.place"), "ball.place")
    fails(trsim.UsageError, lambda: drop.plot("ball.position.y", window="90..91"), "no row lies in")


def test_result_of_no_result(here):
    fails(trsim.FileError, lambda: trsim.Result("none.h5"), "no such file")
    fails(trsim.FileError, lambda: trsim.Result("crank.yaml"), "is not a result file")


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (lambda run: trsim.Result(None), "is the name of its file, not nothing"),
        (lambda run: trsim.Result(7), "is the name of its file, not 7"),
        (lambda run: trsim.Sweep(None), "is the name of its folder, not nothing"),
        (lambda run: run[None], "name of a channel is a word, not nothing"),
        (lambda run: run.channel(3), "name of a channel is a word, not 3"),
        (lambda run: run.frame(None), "name of a channel is a word, not nothing"),
        (lambda run: run.number(None), "number of a run is a word, not nothing"),
        (lambda run: run.number("final:ball.position.y", 3), "unit is a word, not 3"),
        (lambda run: run.plot(None), "figure is a word, not nothing"),
        (lambda run: run.plot("ball.position.y", window=3), "window is a word, not 3"),
        (lambda run: run.report(None), "folder has a name, not nothing"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_is_no_word(asked, words, drop):
    fails(trsim.UsageError, lambda: asked(drop), words)


# --- sweeps ----------------------------------------------------------------------------------


def test_sweep(here):
    """Of a dict: falls under two gravities, and a mass that matters not."""
    axes = {"bodies.ball.velocity.0": ["1 m/s", "2 m/s"], "bodies.ball.mass": "lin(1 kg, 3 kg, 2)"}
    found = trsim.sweep(DROP, "swept", set=axes, jobs=2)
    assert len(found) == 4 and [case.status for case in found.cases] == ["done"] * 4
    table = found.frame("final:ball.position.x", units={"final:ball.position.x": "mm"})
    key = "bodies.ball.velocity.0"
    assert list(table["final:ball.position.x"]) == pytest.approx(list(1e3 * END * table[key]))
    assert table.attrs["units"] == {
        key: "m/s", "bodies.ball.mass": "kg", "final:ball.position.x": "mm",
    }  # fmt: skip
    assert [len(one.names) for one in found] == [len(found[0].names)] * 4
    assert found[found.cases[1].name]["ball.velocity.x"][0] == pytest.approx(table[key].iloc[1])
    assert "<table" in found._repr_html_() and "4 cases, 4 with results" in repr(found)
    before = found[0].file.stat().st_mtime_ns
    again = trsim.sweep(DROP, "swept", set=axes)
    assert again[0].file.stat().st_mtime_ns == before
    fails(trsim.UsageError, lambda: found["none"], "no case named 'none'")
    fails(trsim.UsageError, lambda: found.frame(units={"x": "m"}), "no column")
    assert len(trsim.Sweep("swept")) == 4


def test_a_sweep_that_fails(here, monkeypatch):
    inside.sweeps(monkeypatch)
    set = {"solver.method": ["dop853", "rk4"], "solver.force": True, "solver.step": "0.05 ms"}
    error = fails(trsim.CasesFailed, lambda: trsim.sweep("crank.yaml", "s", set=set, jobs=1))
    assert error.exit_code == 6 and len(error.result) == 2
    found = trsim.sweep("crank.yaml", "s", set=set, raises=False)
    statuses = {case.values["solver.method"]: case.status for case in found.cases}
    assert statuses == {"dop853": "done", "rk4": "failed"}


@pytest.mark.parametrize(
    "options",
    [{"jobs": 0}, {"shard": (3, 2)}, {"shard": (0, 2)}, {"retries": -1}, {"memory": -1},
     {"time_limit": float("nan")}],
)  # fmt: skip
def test_senseless_options(options, here):
    (name,) = options
    call = lambda: trsim.sweep(DROP, "s", set={"bodies.ball.mass": [1, 2]}, **options)  # noqa: E731
    fails(trsim.UsageError, call, name)
    assert not (here / "s").exists()


def test_sweeps_refused(here):
    fails(trsim.UsageError, lambda: trsim.sweep(DROP, "s"), "nothing to vary")
    fails(trsim.UsageError, lambda: trsim.sweep(trsim.load(DROP), "s"), "a scenario file or a dict")
    wrong = {"bodies.ball.mass": [1, -2]}
    fails(trsim.ScenarioError, lambda: trsim.sweep(DROP, "s", set=wrong), "must be >= 0, got -2")
    fails(trsim.FileError, lambda: trsim.Sweep("none"))
