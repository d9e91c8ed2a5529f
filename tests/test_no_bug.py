"""No input ends with exit 1: names, shapes, sizes and files that once did.

Found by hand or by the mutants of test_mutants.py and test_surgery.py.
"""

import contextlib
import json
import shutil

import h5py
import numpy as np
import pytest

from tests import drawn, inside, small
from tests.surgery import ended
from trsim.errors import ScenarioError, TrsimError
from trsim.scenario.load import loads
from trsim.scenario.names import IN_FILES, RESERVED
from trsim.sweeps.folder import read_plan
from trsim.sweeps.ledger import Entry, entries, entry_of

# --- names -----------------------------------------------------------------------------------

HINGE = """\
parameters: {PARAMETER: 1}
bodies:
  BODY: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  JOINT: {type: revolute, bodies: [ground, BODY], at: [0, 0], clearance: 1 mm, contact: LAW}
  second: {type: revolute, bodies: [ground, BODY], at: [0, 0]}
sensors:
  SENSOR: {joint: second}
drives:
  DRIVE: {joint: second, position: 0.1*t}
forces:
  FORCE: {type: applied_load, body: BODY, direction: [1, 0], force: 1}
contact_laws:
  LAW: {normal: lankarani_nikravesh, bearing_radius: 10 mm, youngs_modulus: 207 GPa, poisson: 0.3,
        restitution: 0.9}
events:
  EVENT: {when: t, value: 1 ms, do: {record: true}}
solver: {end: 2 ms}
"""
KINDS = ("PARAMETER", "BODY", "JOINT", "SENSOR", "DRIVE", "FORCE", "LAW", "EVENT")


def checked(folder, text, command="check"):
    (folder / "scene.yaml").write_text(text)
    return ended(
        [command, str(folder / "scene.yaml"), *(["-o", "x.h5"] if command == "run" else [])]
    )


@pytest.mark.parametrize("name", sorted(RESERVED))
def test_reserved_names(name):
    """Every name that means something else, for everything that a user names."""
    for kind in KINDS:
        with pytest.raises(TrsimError) as caught:
            loads(HINGE.replace(kind, name))
        assert f"the name '{name}' is reserved" in caught.value.show()


def test_what_stands_beside_channels_is_reserved(tmp_path):
    text = small.SLIDER_CRANK + "events: {now: {when: t, value: 1 ms, do: {record: true}}}\n"
    small.run(tmp_path / "x.h5", "solver.end=2 ms", text=text)
    with h5py.File(tmp_path / "x.h5") as file:
        others = {n for n, item in file.items() if isinstance(item, h5py.Group)}
        others |= {n.split(".")[0] for n, item in file.items() if item.attrs.get("CLASS")}
        assert "recorded" in others
    assert {*others, "certificate"} <= IN_FILES <= RESERVED


@pytest.mark.parametrize(
    "section",
    [
        "phase_portraits: {NAME: {x: SENSOR, y: SENSOR.rate}}",
        "poincare: {NAME: {every: 1 ms, plot: [SENSOR, SENSOR.rate]}}",
    ],
)
@pytest.mark.parametrize("name", ["a/b", "''", ".", "..", "é", "a.b", "a" * 101, "' '"])
def test_names_of_portraits_and_sections(section, name):
    with pytest.raises(ScenarioError, match="not a name"):
        loads(f"{HINGE}{section.replace('NAME', name)}\n")


# --- templates -------------------------------------------------------------------------------

TEMPLATE = """\
templates:
  arm:
    bodies: {{rod: {{mass: 1, inertia: 1, at: {0}}}}}
    joints: {{pin: {{type: revolute, bodies: [ground, rod], at: [0, 0], axis: {1}}}}}
instances:
  left: {{template: arm, frame: {{at: [0, 1, 0]}}}}
"""


@pytest.mark.parametrize("wrong", ["[null, 0]", "[{a: 1}, 0]", "[0, [1], 2]", "[true, 0]",
                                   "null", "{a: 1}", "[[0, 0], 1]", "[~, ~, ~]"])  # fmt: skip
@pytest.mark.parametrize("at", [0, 1])
def test_points_of_a_template(wrong, at, tmp_path):
    values = ["[0, 0]", "[0, 0, 1]"]
    values[at] = wrong
    code, said = checked(tmp_path, TEMPLATE.format(*values))
    assert code == 3
    assert "must be" in said


# --- sizes -----------------------------------------------------------------------------------

BAR = """\
bodies:
  bar: {{type: ancf_cable, start: [0, 0], end: [{0}, 0], section: {{diameter: {1}}},
        youngs_modulus: {2}, density: {3}}}
joints:
  clamp: {{type: fixed, bodies: [ground, bar], at: [0, 0]}}
solver: {{end: 1 ms, tolerance: 1e-4}}
"""


@pytest.mark.parametrize("length", [1e-200, 1e-40, 1e-12, 1e20])
@pytest.mark.parametrize("key", range(4))
def test_absurd_bars(length, key, tmp_path):
    """Length, section, modulus and density; too small or too large by many digits."""
    values = [1.0, 0.01, 207e9, 7850.0]
    values[key] = length if key == 0 else values[key] * length**2
    code, said = checked(tmp_path, BAR.format(*map(repr, values)))
    assert code in (3, 4)
    assert "can be solved" in said or "no quantity" in said or "must be" in said or "bar" in said


def test_usual_bars_are_solvable():
    from trsim.assemble.members import members

    for length, diameter, E, density in (
        (1e-6, 1e-8, 400e9, 20e3), (1e-3, 5e-6, 5e6, 1e3), (0.1, 1e-4, 207e9, 7850),
        (10.0, 0.5, 70e9, 2700), (2e3, 0.1, 200e9, 7850), (1.0, 0.02, 1e4, 320),
    ):  # fmt: skip
        assert members(loads(BAR.format(length, diameter, E, density)))


def many(bodies, instances, more=""):
    entries = "".join(f"      b{k}: {{mass: 1, inertia: 1}}\n" for k in range(bodies))
    copies = "".join(f"  i{k}: {{template: arm}}\n" for k in range(instances))
    return f"templates:\n  arm:\n    bodies:\n{entries}instances:\n{copies}{more}"


@pytest.mark.parametrize("bodies, instances", [(20, 60), (150, 300), (600, 1500)])
def test_too_many_bodies(bodies, instances, tmp_path):
    """Counted before anything is made of a template."""
    code, said = checked(tmp_path, many(bodies, instances))
    assert code == 3
    n = bodies * instances
    assert f"{n} bodies, of instances of 'arm': at most 200 unless `limits` says more" in said
    assert f"`limits: {{bodies: {n}}}`" in said


def test_limits_are_raised():
    assert len(loads(many(3, 70, "limits: {bodies: 210}")).bodies) == 210
    with pytest.raises(Exception, match="6 bodies, of instances of 'arm': at most 5"):
        loads(many(2, 3, "limits: {bodies: 5}"))
    with pytest.raises(Exception, match="must be a whole number, got 'x'"):
        loads(many(2, 3, "limits: {bodies: x}"))


def test_too_many_nodes_rows_and_entries(tmp_path):
    bar = "type: ancf_cable, end: [1, 0], section: {diameter: 1 cm}, youngs_modulus: 1e9"
    bars = "".join(f"  b{k}: {{{bar}, start: [0, {k + 1}], density: 1, elements: 900}}\n"
                   for k in range(3))  # fmt: skip
    code, said = checked(tmp_path, f"bodies:\n{bars}")
    assert (code, "2703 nodes of flexible bars, 901 of them of 'b0'" in said) == (3, True)
    body = "bodies: {a: {mass: 1, inertia: 1}}\n"
    joints = "".join(f"  j{k}: {{type: fixed, bodies: [ground, a], at: [0, 0]}}\n"
                     for k in range(260))  # fmt: skip
    code, said = checked(tmp_path, f"{body}joints:\n{joints}")
    assert (code, "1560 constraint rows: at most 1500" in said) == (3, True)
    forces = "".join(f"      f{k}: {{type: applied_load}}\n" for k in range(40))
    arms = many(1, 60).replace("instances:", f"    forces:\n{forces}instances:")
    code, said = checked(tmp_path, arms)
    assert (code, "2460 entries, of instances of 'arm': at most 2000" in said) == (3, True)


# --- result files ----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "run.h5"
    small.copy(path, "output.channels=[stroke, B, A]", "output.every=0.1 ms")
    return path


def replaced(file, name, value):
    del file[name]
    file[name] = value


def group(file, name):
    del file[name]
    file.create_group(name)


CRAFTED = {
    "a status that is none": lambda f: f.attrs.modify("status", "fine"),
    "a status of several": lambda f: f.attrs.create("status", np.array(["a", "b"], object)),
    "a status that is a number": lambda f: f.attrs.create("status", 3),
    "a status without value": lambda f: f.attrs.create("status", h5py.Empty("S1")),
    "no title": lambda f: f.attrs.pop("title"),
    "a title of bytes": lambda f: f.attrs.create("title", np.void(b"ab")),
    "a version that is text": lambda f: f.attrs.create("format_version", "1"),
    "a group for a channel's rows": lambda f: group(f, "time"),
    "a dataset for a group": lambda f: replaced(f, "steps", np.arange(3.0)),
    "a dataset for a contact": lambda f: replaced(f, "steps/B", np.arange(3.0)),
    "a portrait of groups": lambda f: group(f, "phase/B/time"),
    "words that are numbers": lambda f: replaced(f, "mechanism/redundant", np.arange(3.0)),
    "numbers that are words": lambda f: replaced(f, "stroke", np.array([b"ab"] * 31)),
    "numbers of another kind": lambda f: replaced(f, "stroke", np.zeros(31, "c16")),
    "compounds": lambda f: replaced(f, "A.reaction", np.zeros(31, [("a", "f8")])),
    "too many dimensions": lambda f: replaced(f, "A.reaction", np.zeros((31, 3, 2))),
    "parts that differ in length": lambda f: replaced(f, "mechanism/clearance", np.zeros(2)),
    "a soft link": lambda f: replaced(f, "stroke", h5py.SoftLink("/time")),
    "a link to nowhere": lambda f: replaced(f, "stroke", h5py.SoftLink("/nowhere")),
    "a link to another file": lambda f: replaced(f, "stroke", h5py.ExternalLink("y.h5", "/time")),
    "a group in itself": lambda f: f["steps"].__setitem__("again", f["/"]),
    "rows kept elsewhere": lambda f: (f.pop("stroke"), f.create_dataset(
        "stroke", (1,), "f8", external=[("/etc/hostname", 0, 8)])),
    "rows beyond the file": lambda f: (f.pop("stroke"), f.create_dataset(
        "stroke", (2**50,), "f8", chunks=(64,), maxshape=(None,))),
    "a name that is no UTF-8": lambda f: f.id.move(b"stroke", b"str\xffke"),
    "a number of the solver as text": lambda f: f["solver"].attrs.create("tolerance", "x"),
    "a contact without numbers": lambda f: f["summary/B"].attrs.pop("impacts"),
    "a section without surface": lambda f: f["poincare/journal"].attrs.pop("when"),
    "units that are numbers": lambda f: f["stroke"].attrs.create("units", 3.0),
    "peaks of different length": lambda f: replaced(f, "peaks/time", np.zeros(2)),
    "events without kinds": lambda f: f["events"].pop("kind"),
}  # fmt: skip


@pytest.mark.parametrize("what", CRAFTED)
def test_crafted_files(what, whole, tmp_path):
    """With a content hash that is right: nothing but their shape tells."""
    from trsim.store.content import content_hash

    path = tmp_path / "x.h5"
    shutil.copy(whole, path)
    with h5py.File(path, "r+") as file:
        CRAFTED[what](file)
        if "beyond" not in what and "in itself" not in what:  # a hash would have no end
            with contextlib.suppress(Exception):
                file.attrs["content_sha256"] = content_hash(file)
    for command, *options in (
        ("show", "--json"), ("show", "--verify"), ("export", "--csv"),
        ("report", "--table", "final:stroke"),
    ):  # fmt: skip
        words = [command, str(path), *options]
        code, said = ended(words)
        assert code == 7, (words, said)
    assert "is damaged: " in said or "not a result of trsim" in said


@pytest.mark.parametrize("text", ["[1]", "{", "3", "", "null", '{"a": 1}', "[" * 5000])
def test_a_file_without_its_scenario(text, whole, tmp_path):
    from trsim.store.content import content_hash

    path = tmp_path / "x.h5"
    shutil.copy(whole, path)
    with h5py.File(path, "r+") as file:
        replaced(file, "scenario/resolved", text)
        file.attrs["content_sha256"] = content_hash(file)
    for command, *options in (("show", "--json"), ("check",), ("report", "--compare", str(whole))):
        code, said = ended([command, str(path), *options])
        assert code in (0, 2, 3, 7), said


def test_a_hash_tells_a_damaged_file_from_a_bug(whole, tmp_path, monkeypatch):
    """What nobody expected is the fault of a file that is not as a run leaves it, else ours."""
    monkeypatch.delenv("TRSIM_DEBUG", raising=False)

    def broken(*_):
        raise ZeroDivisionError("nobody expected this")

    monkeypatch.setattr("trsim.cli.show.lines", broken)
    code, said = ended(["show", str(whole)])
    assert (code, "This is a bug in trsim" in said) == (1, True)
    path = tmp_path / "x.h5"
    shutil.copy(whole, path)
    with h5py.File(path, "r+") as file:
        file["stroke"][3] += 1.0
    code, said = ended(["show", str(path)])
    assert (code, "its content hash differs" in said) == (7, True)
    with h5py.File(path, "r+") as file:
        from trsim.store.content import content_hash

        file["stroke"][3] = np.nan
        file.attrs["content_sha256"] = content_hash(file)
    code, said = ended(["show", str(path)])
    assert (code, "values of stroke that are no numbers" in said) == (7, True)


def test_a_recovered_file_without_rows(whole, tmp_path, monkeypatch):
    drawn.few(monkeypatch, of_each=True)
    inside.recovering(monkeypatch)
    part = tmp_path / "x.h5.part"
    shutil.copy(whole, part)

    def emptied(group):
        for item in group.values():
            if isinstance(item, h5py.Group):
                emptied(item)
            elif item.shape and item.maxshape[0] is None:
                item.resize(0, axis=0)

    with h5py.File(part, "r+") as file:
        emptied(file)
        del file.attrs["content_sha256"], file["summary/B"]
        file.attrs["status"] = "interrupted"
        group(file, "peaks")
    assert ended(["recover", str(part)])[0] == 0
    path, out = str(tmp_path / "x.recovered.h5"), ["-o", str(tmp_path / "out")]
    for words in (["show", path], ["show", path, "--verify"], ["export", path, "--csv"],
                  ["report", path, *out], ["report", str(whole), path, *out]):  # fmt: skip
        code, said = ended(words)
        assert code == 0, (words, said)
    for words in (["--table", "final:stroke"], ["--spectrum", "stroke"], ["--lyapunov", "stroke"],
                  ["--compare", path], ["--animate"]):  # fmt: skip
        code, said = ended(["report", path, *words, *out])
        assert code == 2, (words, said)


# --- sweeps ----------------------------------------------------------------------------------

LINE = Entry("a", "d", "e", "done", "", 1, "c", 10, 20, 3.0, 0.5, {"time": 1.0, "word": "x"})


@pytest.mark.parametrize("name", Entry._fields)
@pytest.mark.parametrize("wrong", [None, [], {"a": [1]}, True, "x", 1.5, 10**400])
def test_a_line_of_a_ledger_costs_itself_alone(name, wrong, tmp_path):
    told = {**LINE._asdict(), "case": "b", name: wrong}
    good = json.dumps(LINE._asdict()).encode()
    (tmp_path / "ledger.jsonl").write_bytes(
        b"\n".join([good, json.dumps(told).encode(), b"[1]", b"3", b'"x"', b"\xff", b"[" * 9999])
    )
    found = entries(tmp_path)
    assert found["a"] == LINE
    entry = entry_of(json.dumps(told).encode())
    assert entry is None or isinstance(getattr(entry, name), type(getattr(LINE, name)))
    assert set(found) <= {"a", "b", "x"}


PLAN = {
    "format": "trsim sweep", "version": 1, "source": "s.yaml", "engine": "e", "keys": ["a.b"],
    "units": {"a.b": "m"}, "written": {}, "method": "grid", "samples": 0, "seed": 0,
    "cases": [{"name": "one", "digest": "d", "values": {"a.b": 1.0}}],
}  # fmt: skip
PATHS = [*((key,) for key in PLAN), ("cases", 0), *(("cases", 0, k) for k in PLAN["cases"][0]),
         ("keys", 0), ("units", "a.b"), ("cases", 0, "values", "a.b")]  # fmt: skip


@pytest.mark.parametrize("path", PATHS, ids=lambda p: ".".join(map(str, p)))
def test_a_plan_with_a_wrong_type(path, tmp_path):
    (tmp_path / "plan.json").write_text(json.dumps(PLAN))
    assert read_plan(tmp_path) == PLAN
    for wrong in (None, [], {}, True, "../x", 1.5, [1], {"a": [1]}, 10**400, "\0"):
        told = json.loads(json.dumps(PLAN))
        inner = told
        for key in path[:-1]:
            inner = inner[key]
        inner[path[-1]] = wrong
        (tmp_path / "plan.json").write_text(json.dumps(told))
        for words in (["status", str(tmp_path), "--json"],
                      ["report", str(tmp_path), "--table", "final:x"]):  # fmt: skip
            code, said = ended(words)
            assert code in (0, 2, 7), (wrong, said)
