"""Every command, driven to every exit code it can end with, held to the schema of its document."""

import errno
import json
import math
import os
import shutil
import signal
from typing import get_args

import pytest
from jsonschema import Draft202012Validator, SchemaError

from tests import drawn, inside, small
from tests.cli.conftest import SCHEMAS, faults
from tests.store import outside
from trsim.assemble.assemble import assemble
from trsim.cli import COMMANDS
from trsim.cli.documents.files import Solver
from trsim.cli.documents.runs import RunStatistics
from trsim.cli.frame import EXIT_CODES
from trsim.cli.published import ENDS, WORDS
from trsim.errors import TrsimError
from trsim.scenario.load import loads
from trsim.scenario.scenario import SolverSpec
from trsim.solve.simulate import simulate
from trsim.statuses import STATUSES, Status
from trsim.store.describe import CPU
from trsim.store.hdf5 import write
from trsim.sweeps.folder import write_plan
from trsim.sweeps.plan import plan

VARIED = ("--set", "solver.tolerance=[1e-6]", "-o", "sweep", "-j", "1", "--retries", "0")
GOOD = {
    "init": ("pendulum",),
    "run": ("crank.yaml", "--certify"),
    "sweep": ("crank.yaml", *VARIED),
    "status": ("sweep",),
    "merge": ("sweep", "-o", "whole"),
    "check": ("crank.yaml",),
    "statics": ("crank.yaml", "-o", "rest.h5"),
    "report": ("x.h5",),
    "show": ("x.h5",),
    "export": ("x.h5", "--csv"),
    "recover": ("x.h5",),
    "explain": ("drive",),
    "schema": ("run",),
    "bench": (
        *("crank.yaml", "--methods", "dop853,radau", "--tolerances", "1e-3"),
        *("--reference", "dop853:1e-5", "--repeats", "1"),
    ),
}
SEAMS = {  # what a command calls to do its work
    "init": "trsim.cli.init.write",
    "run": "trsim.cli.run.one",
    "sweep": "trsim.api.sweep.go",
    "status": "trsim.sweeps.study.study",
    "merge": "trsim.api.merge.going_on",
    "check": "trsim.cli.check.one",
    "statics": "trsim.cli.statics.one",
    "report": "trsim.report.report",
    "show": "trsim.store.read.read",
    "export": "trsim.store.export.export",
    "recover": "trsim.store.recover.recover",
    "explain": "trsim.scenario.explain.explained",
    "schema": "trsim.cli.published.published",
    "bench": "trsim.cli.bench.one",
}
USAGE = {  # beside wrong options
    "init": ("pendlum",),
    "run": ("crank.yaml", "-o", "crank.yaml"),
    "check": ("crank.yaml", "--set", "nonsense"),
    "statics": ("crank.yaml", "-o", "crank.yaml"),
    "sweep": ("crank.yaml",),
    "merge": ("sweep", "-o", "sweep"),
    "export": ("x.h5", "--csv", "--channels", "strke"),
    "recover": ("x.h5", "-o", "x.h5"),
    "explain": ("drvie",),
    "schema": ("rnu",),
    "bench": ("crank.yaml", "--methods", "dop583"),
}
NO_FILE = {
    "init": ("crank.yaml/x",),
    "run": ("crank.yaml", "-o", "crank.yaml/x.h5"),
    "check": ("none.yaml",),
    "statics": ("none.yaml",),
    "report": ("x.h5", "-o", "crank.yaml/x"),
    "show": ("none.h5",),
    "sweep": (*("crank.yaml", *VARIED), "-o", "crank.yaml/x"),
    "status": ("none",),
    "merge": ("none", "-o", "whole"),
    "export": ("x.h5", "--csv", "-o", "crank.yaml/x.csv"),
    "recover": ("none.h5.part",),
    "schema": ("-o", "crank.yaml/x.json"),
    "bench": ("crank.yaml", "-o", "crank.yaml/x"),
}
WRONG = {  # exit code -> text of the scenario, and what it is replaced by
    3: ("clearance: 0.5 mm", "clearance: 0.5 kg"),
    4: ("drives:", "drives:\n  twin: {joint: O, velocity: 1 rpm}"),
    5: ("method: dop853", "method: rk4, force: true, step: 0.05 ms"),
    6: ("method: dop853", "method: rk4, force: true, step: 0.05 ms"),
}


@pytest.fixture(scope="module")
def prepared(tmp_path_factory):
    folder = tmp_path_factory.mktemp("prepared")
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    small.copy(folder / "x.h5", *small.FEW)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        see = plan("crank.yaml", VARIED[1:2])
    (folder / "sweep").mkdir()
    write_plan(folder / "sweep", see, "")
    return folder


@pytest.fixture
def folder(prepared, scenario):
    """A scenario, its result file, and a sweep that did not begin, in the current folder."""
    shutil.copytree(prepared, scenario.parent, dirs_exist_ok=True)
    return scenario.parent


@pytest.fixture
def document(trsim, monkeypatch):
    """Runs a command line with --json, and holds what it says to the contract."""
    inside.sweeps(monkeypatch)
    inside.recovering(monkeypatch)

    def told(*arguments, code=0, command=None):
        ended, out, err = trsim(*arguments, "--json")
        document = json.loads(out)  # and nothing else is there
        assert ended == code == document["exit_code"], err
        assert faults(document, command or arguments[0]) == []
        assert "\x1b" not in out + err
        return document

    return told


def breaks(monkeypatch, command, action):
    """Have a command do something else in the midst of its work."""
    monkeypatch.setattr(SEAMS[command], action)


def raising(error):
    def raises(*_, **__):
        raise error

    return raises


def killing(number):
    return lambda *_, **__: os.kill(os.getpid(), number)


@pytest.fixture(scope="module")
def found():
    """What commands told that did their work, by name."""
    return {}


@pytest.fixture
def good(found, folder, document, monkeypatch):
    """The document of a command that does its work, which it does once."""

    def told(command):
        if command not in found:
            drawn.few(monkeypatch)
            drawn.blank(monkeypatch)
            found[command] = document(command, *GOOD[command])
        return found[command]

    return told


# --- every command and every exit code -------------------------------------------------------


@pytest.mark.parametrize(
    "command, code", [(command, code) for command in COMMANDS for code in sorted(ENDS[command])]
)
def test_document(command, code, folder, document, good, monkeypatch):
    if code == 0:
        assert good(command)["errors"] == []
        return
    arguments = GOOD[command]
    if code == 1:
        breaks(monkeypatch, command, raising(ZeroDivisionError("division by zero")))
    elif code == 2:
        document(command, "--nonsense", code=2)
        arguments = USAGE.get(command, ())
    elif (command, code) == ("bench", 5):  # the method of the scenario counts for nothing there
        arguments = (*arguments, "--set", "solver.max_steps=3")
    elif code in WRONG:
        arguments += ("--dry-run",) if (command, code) == ("sweep", 4) else ()
        (folder / "crank.yaml").write_text(small.SLIDER_CRANK.replace(*WRONG[code]))
    elif code == 7 and command in NO_FILE:
        arguments = NO_FILE[command]
    elif code == 7:  # explain opens no file of the user's
        breaks(monkeypatch, command, raising(OSError(errno.EIO, "Input/output error")))
    elif code in (130, 143):
        breaks(monkeypatch, command, killing({130: signal.SIGINT, 143: signal.SIGTERM}[code]))
    told = document(command, *arguments, code=code)
    assert [error["exit_code"] for error in told["errors"]] == [code]


@pytest.mark.parametrize("arguments", [(), ("rnu",), ("--nonsense", "run"), ("-q", "check", "x")])
def test_no_command(arguments, document):
    assert document(*arguments, code=2, command="trsim")["command"] is None


def test_interrupted_before_the_command_began(document, monkeypatch):
    monkeypatch.setattr("trsim.cli.Commands.invoke", raising(KeyboardInterrupt()))
    document("run", "x.yaml", code=130)


def test_one_failure_among_several(folder, document):
    (folder / "bad.yaml").write_text("bodies: 3\njoints: 4")
    told = document("run", "bad.yaml", "none.yaml", "crank.yaml", code=3)
    assert [error["exit_code"] for error in told["errors"]] == [3, 3, 7]
    assert [run["file"] for run in told["runs"]] == ["runs/crank.h5"]


def test_modes(folder, document, trsim):
    (folder / "swing.yaml").write_text("""
gravity: [0, -9.81]
bodies: {bob: {mass: 1, inertia: 1e-6, at: [0, -1]}}
joints: {pivot: {type: revolute, bodies: [ground, bob], at: [0, 0]}}
""")
    [found] = document("check", "swing.yaml", "--modes")["scenarios"]
    [mode] = found["modes"]
    assert mode["frequency"] == pytest.approx(9.81**0.5 / (2 * math.pi), rel=1e-5)
    assert "0.498" in trsim("check", "swing.yaml", "--modes")[1]
    assert "modes" not in document("check", "swing.yaml")["scenarios"][0]


def test_analyses_of_report(folder, document, trsim, monkeypatch):
    monkeypatch.setattr("trsim.report.figures.draw", lambda *_: [])  # no analysis is in them
    small.copy(folder / "x.h5")
    words = ("--table", "points:journal,peak:B.contact_force", "--lyapunov", "stroke")
    told = document("report", "x.h5", *words)
    assert [value["what"] for value in told["values"][1:]] == [
        "points:journal",
        "peak:B.contact_force",
    ]
    assert told["values"][0]["value"] is None  # of one stroke there is none
    assert "undetermined" in told["told"][0]
    assert "values" not in document("report", "x.h5")
    document("report", "x.h5", "--sobol", "peak:B.contact_force", code=2)
    document("report", "x.h5", "--table", "peek:B.contact_force", code=2)
    assert "= " in trsim("report", "x.h5", "--table", "points:journal")[1]


def test_more_errors_than_are_listed(folder, document):
    keys = "\n".join(f"  b{k}: {{}}" for k in range(40))
    (folder / "bad.yaml").write_text(f"bodies:\n{keys}")
    told = document("check", "bad.yaml", code=3)
    assert len(told["errors"]) + told["unlisted"] == 40
    assert told["errors"][0]["what"] == "field required: mass (kg) and inertia (kg*m^2)"


def test_a_file_name_that_is_no_text(tmp_path):
    process = outside.trsim(tmp_path, "show", os.fsdecode(b"\xff.h5"), "--json")
    told = json.loads(process.communicate(timeout=60)[0])
    assert told["errors"][0]["what"].startswith("\udcff.h5: no such file")


def test_nobody_can_be_told(tmp_path):
    """A full disk behind standard output is told on the other one."""
    with open("/dev/full", "w") as full:
        for options in ((), ("--json",)):
            process = outside.trsim(tmp_path, "explain", "drive", *options, stdout=full)
            assert "No space left on device" in process.communicate(timeout=60)[1]
            assert process.returncode == 7


# --- the schemas -----------------------------------------------------------------------------


def mappings(data, path=()):
    """The path of every mapping in a document."""
    if isinstance(data, dict):
        yield path
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        if isinstance(value, dict | list):
            yield from mappings(value, (*path, key))


def changed(document, path, change):
    """A copy of a document with one of its mappings changed."""
    copy = json.loads(json.dumps(document))
    inner = copy
    for key in path:
        inner = inner[key]
    change(inner)
    return copy


FREE = {("schema", "schema")}  # a JSON Schema may hold anything


@pytest.mark.parametrize("command", COMMANDS)
def test_schemas_can_fail(command, good):
    """A key too many is seen everywhere, a key too few at the top."""
    told = good(command)
    for path in mappings(told):
        if (command, *path[:1]) not in FREE:
            assert faults(changed(told, path, lambda it: it.update(extra=[None])), command), path
    for key in SCHEMAS[command]["then"]["required"]:
        assert faults({name: value for name, value in told.items() if name != key}, command), key
    assert faults({**told, "exit_code": 1}, command)  # an error without an error
    assert faults({**told, "exit_code": 6}, command)
    other = "show" if command != "show" else "run"
    assert faults(told, other)


def taken_apart(schema, found):
    """`true`, which stands for any schema; the schemas in it, each with `true` for those inside,
    go to `found` as texts.

    A schema is one by the rules of JSON Schema if all of these are: no rule looks at two of them
    together.  What is no schema where one has to be stays where it is, and breaks a rule there.
    """
    if not isinstance(schema, dict):
        return schema
    alone = dict(schema)
    for key, inner in schema.items():
        if key in ("$defs", "properties") and isinstance(inner, dict):
            alone[key] = {name: taken_apart(one, found) for name, one in inner.items()}
        elif key in ("allOf", "anyOf", "oneOf", "prefixItems") and isinstance(inner, list):
            alone[key] = [taken_apart(one, found) for one in inner]
        elif key in ("additionalProperties", "items", "not", "if", "then", "else"):
            alone[key] = taken_apart(inner, found)
    found.add(json.dumps(alone, sort_keys=True))
    return True


def check_schema(schema):
    """Hold a schema to the rules; of what is in it many times a copy is enough."""
    found = set()
    taken_apart(schema, found)
    for text in found:
        Draft202012Validator.check_schema(json.loads(text))


@pytest.mark.parametrize("wrong", [{"type": "numbr"}, {"required": "x"}, {"minItems": -1}, 1])
def test_what_is_no_schema_is_seen(wrong):
    inner = {"properties": {"a": {"anyOf": [{"items": wrong}, True]}}}
    for schema in ({"$defs": {"x": inner}}, {"then": inner}, {"prefixItems": [inner]}):
        with pytest.raises(SchemaError):
            check_schema(schema)


@pytest.mark.parametrize("word", WORDS)
def test_schemas_are_published(word, trsim, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    check_schema(SCHEMAS[word])
    code, out, err = trsim("schema", word)
    assert (code, json.loads(out), err) == (0, SCHEMAS[word], "")
    code, out, err = trsim("schema", word, "-o", "deep/trsim.json")
    assert (code, out) == (0, "deep/trsim.json\n")
    assert ("# yaml-language-server: $schema=deep/trsim.json" in err) == (word == "scenario")
    assert json.loads((tmp_path / "deep/trsim.json").read_text()) == SCHEMAS[word]
    assert trsim("schema", "trsim", "-o", "deep/trsim.json")[0] == 0  # an older one may be replaced


def test_schema_says_what_every_key_means():
    def silent(entry, path):
        for key, rule in entry.get("properties", {}).items():
            if not rule.get("description") and "const" not in rule:
                yield (*path, key)
        for name, inner in entry.get("$defs", {}).items():
            if not name.startswith("part_"):
                yield from silent(inner, (*path, name))

    keys = [key for word in WORDS for key in silent(SCHEMAS[word], (word,))]
    assert [key for key in keys if key[1:2] != ("Provenance",)] == []


def test_schema_replaces_no_other_file(folder, document):
    text = (folder / "crank.yaml").read_text()
    (folder / "other.json").write_text('{"title": "mine"}')
    for name in ("crank.yaml", "other.json", "x.h5"):
        told = document("schema", "trsim", "-o", name, code=2)
        assert "is not a schema of trsim" in told["errors"][0]["what"]
    assert (folder / "crank.yaml").read_text() == text


def test_schema_modeline_is_a_scenario_comment(folder, document):
    modeline = document("schema", "-o", "trsim.json")["modeline"]
    (folder / "crank.yaml").write_text(f"{modeline}\n{small.SLIDER_CRANK}")
    document("check", "crank.yaml")


# --- statuses --------------------------------------------------------------------------------


JAMS = """
bodies: {block: {mass: 2, inertia: 0.01}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
forces: {wall: {type: spring_damper, bodies: [ground, block], points: [[1, 0], [0, 0]],
                stiffness: 1e4}}
drives: {jack: {type: actuator, bodies: [ground, block], points: [[-0.5, 0], [0, 0]],
                velocity: 0.1, stiffness: 1e5, stall: 5}}
solver: {end: 20 ms}
"""

# a rod that turns, while it slides along a rough line, to where no friction goes with its reaction
LEAPS = """
bodies: {rod: {mass: 1, inertia: 0.3333, at: [0.0871557, 0.9961947],
               velocity: [9.9923894, -0.1743115], angular_velocity: [0, 0, -2]}}
joints: {line: {type: inline, bodies: [ground, rod], at: [0, 0], axis: [1, 0, 0]}}
forces: {rub: {type: joint_friction, joint: line,
               friction: {law: modified_coulomb, coefficient: 2, v0: 0, v1: 1e-3}}}
gravity: [0, -9.81]
solver: {end: 1}
"""


RESTS = """
bodies: {rod: {mass: 1, inertia: 0.1}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
forces: {rope: {type: spring, bodies: [ground, rod], points: [[0, 2], [0, 1]], tension_only: true,
         elastic: "1e3*stretch", free_length: 1.5}}
solver: {end: 1}
"""
ENDINGS = {
    "stalled": RESTS + "phases: [{stall: {energy: 1e-3, for: 0.1 s}}]",
    "slack": RESTS + "phases: [{drive: {}, taut: [rope]}]",
    "released": RESTS + "phases: [{release: [hinge], for: 0.1 s}]",
}
# pressed down by more than its springs carry: they snap through
TURNS_BACK = """
planar: true
bodies:
  top: {mass: 1 kg, inertia: 0.01 kg*m^2, at: [0, 0.3]}
joints:
  guide: {type: prismatic, bodies: [ground, top], axis: [0, 1]}
forces:
  left: {type: spring_damper, bodies: [ground, top], points: [[-1, 0], [0, 0.3]], stiffness: 1000}
  load: {type: applied_load, body: top, direction: [0, -1], force: "20*t"}
solver: {method: static_path, end: 1 s}
output: {every: 20 ms}
"""


def of_every_status(folder, monkeypatch):
    """Result files with every status there is; the one of a run that goes on is copied."""
    scenario = loads(small.SLIDER_CRANK, ["solver.end=20ms"])
    mechanism = assemble(scenario)
    monkeypatch.setattr("trsim.store.hdf5.FLUSHED", 0.0)

    def blocks(stop):
        yielded = simulate(scenario, mechanism)
        yield next(yielded)
        shutil.copy(folder / "y.h5.part", folder / "running.h5.part")
        if stop:
            raise KeyboardInterrupt
        return (yield from yielded)

    with pytest.raises(KeyboardInterrupt):
        write(folder / "y.h5", scenario, mechanism, blocks(True))
    small.run(folder / "failed.h5", text=small.SLIDER_CRANK.replace(*WRONG[5]))
    small.run(folder / "jammed.h5", text=JAMS)
    small.run(folder / "limit.h5", text=TURNS_BACK)
    small.run(folder / "leaps.h5", text=LEAPS)
    for status, text in ENDINGS.items():
        small.run(folder / f"{status}.h5", text=text)
    return {
        **{status: f"{status}.h5" for status in ENDINGS},
        "done": "x.h5",
        "jammed": "jammed.h5",
        "limit": "limit.h5",
        "painleve": "leaps.h5",
        "failed": "failed.h5",
        "interrupted": "y.h5.part",
        "running": "running.h5.part",
        "recovered": "running.recovered.h5",
    }


def test_every_status_is_shown(folder, document, monkeypatch):
    files = of_every_status(folder, monkeypatch)
    assert document("recover", files["running"])["was"] == "running"
    assert set(files) == set(STATUSES) == set(get_args(Status))
    for status, file in files.items():
        assert document("show", file)["status"] == status


def test_a_run_whose_friction_has_no_solution_fails(folder, document):
    (folder / "rod.yaml").write_text(LEAPS)
    told = document("run", "rod.yaml", "-o", "rod.h5", code=5)
    assert told["runs"][0]["status"] == "painleve" and told["runs"][0]["time"] < 0.1
    assert "forces.rub (rod.yaml:" in told["errors"][0]["what"]


# --- paths in errors -------------------------------------------------------------------------

PATHS = [  # text, its replacement, path of the error, a value that mends it by --set
    ("end: 3 ms", "end: 3 mm", "solver.end", "3 ms"),
    ("end: 3 ms", "end: -1", "solver.end", "3 ms"),
    ("at: [0.11, 0]", "at: [0.11, x]", "bodies.rod.at.1", "0"),
    ("type: prismatic", "type: prismatik", "joints.guide.type", "prismatic"),
    ("[rod, slider]", "[rod]", "joints.B.bodies", "[rod, slider]"),
    ("[rod, slider]", "[rodd, slider]", "joints.B.bodies.0", "rod"),
    ("[rod, slider]", "[rod, sliddr]", "joints.B.bodies.1", "slider"),
    ("contact: pin}", "contact: pim}", "joints.B.contact", "pin"),
    ("clearance: 0.5 mm", "clearance: 11 mm", "joints.B.clearance", "0.5 mm"),
    ("joint: O, ", "joint: P, ", "drives.motor.joint", "O"),
    ("5000 rpm", "2*stoke", "drives.motor.velocity", "5000 rpm"),
    ("5000 rpm", "{table: [[0, 1], [0, 2]]}", "drives.motor.velocity.table.1", "[1, 2]"),
    ("law: none", "law: nne", "contact_laws.pin.friction.law", "none"),
    ("when: B.e", "when: B.x", "poincare.journal.when", "B.eccentricity_x_rate"),
    ("plot: [B.e", "plot: [B.x", "poincare.journal.plot.0", "B.eccentricity_x"),
    ("output: {", "output: {channels: [B, xx], ", "output.channels.1", "A"),
    ("output: {", "initial: {equilibrium: [C]}\noutput: {", "initial.equilibrium.0", None),
    ("mass: 0.21", "mass: 0", "bodies.rod.mass", "0.21"),  # exit code 4
    ("title: ", "parameters: {a: b}\ntitle: ", "parameters.a", "1"),
    # what is missing, or too much, is told of the mapping
    ("clearance: 0.5", "clearnce: 0.5", "joints.B", None),
    ("end: 3 ms, ", "", "solver", None),
    ("restitution: 0.9, ", "", "contact_laws.pin", None),
    ("law: none", "law: coulomb", "contact_laws.pin.friction", None),
    ("output: {", "initial: {gude: 1}\noutput: {", "initial", None),
    ("title: ", "titel: ", "", None),
    # what is given once, and cannot be mended by --set
    *[(*WRONG[4], "drives.motor", None), (*WRONG[5], "", None)],
    ("title: ", "extends: no.yaml\ntitle: ", "extends", None),
    ("title: ", "extends: [no.txt]\ntitle: ", "extends.0", None),
    ("5000 rpm", "{table: no.csv}", "drives.motor.velocity.table", None),
    ("sensors:", "sensors:\n  t: {joint: A}", "sensors.t", None),
    ("title: ", "sweep: {joints.C.at: [1]}\ntitle: ", "sweep.joints.C.at", None),
    ("sensors:", "drives:", "", None),  # twice
    ("sensors:", "sensors: ]", "", None),  # not YAML
]


@pytest.mark.parametrize("old, new, path, mended", PATHS)
def test_path_of_an_error(old, new, path, mended, scenario, trsim):
    assert old in small.SLIDER_CRANK
    scenario.write_text(small.SLIDER_CRANK.replace(old, new, 1))
    code, out, _ = trsim("run", "crank.yaml", "--json")
    [error] = json.loads(out)["errors"]
    assert code in (3, 4, 5)
    assert error["path"] == path
    assert (error["line"] is not None) == (code != 5)
    assert error["file"] == "crank.yaml"
    if mended:
        assert trsim("check", "crank.yaml", "--set", f"{path}={mended}")[0] == 0


def test_paths_of_other_errors(folder, document):
    """Of --set the path is that of the value; where no scenario is wrong there is none,
    but the file that is at fault."""
    for sets, path in (("solver.end=3 kg", "solver.end"), ("joints.C.at=1", "joints")):
        [error] = document("check", "crank.yaml", "--set", sets, code=3)["errors"]
        assert (error["path"], error["file"]) == (path, "--set")
    for arguments in (("show", "none.h5"), ("run", "none.yaml")):
        [error] = document(*arguments, code=7)["errors"]
        assert (error["path"], error["file"], error["line"]) == ("", arguments[1], None)


# --- where it is told in words ---------------------------------------------------------------


def test_docs(pytestconfig, trsim):
    text = (pytestconfig.rootpath / "docs" / "commands.md").read_text()
    for code, told in EXIT_CODES.items():
        assert f"| {code} | {told} |" in text
    for status, told in STATUSES.items():
        assert f"| {status} | {told} |" in text
    for command in COMMANDS:
        assert f"`trsim {command}" in text
    _, out, _ = trsim("--help")
    assert all(f"{code} {told}" in " ".join(out.split()) for code, told in EXIT_CODES.items())


def test_exit_codes_of_errors():
    """Every class of errors has a code of the list; every code is one a command can end with."""
    assert {kind.exit_code for kind in TrsimError.__subclasses__()} <= set(EXIT_CODES)
    assert set().union(*ENDS.values()) == set(EXIT_CODES)


def test_show_knows_what_a_file_tells_of_the_solver():
    """Every setting that is one value, and all statistics but times, stand in its document."""
    settings = {name for name in SolverSpec.model_fields if name != "baumgarte"}
    told = settings | set(RunStatistics.__annotations__) - {CPU}
    assert told == set(Solver.__annotations__)
