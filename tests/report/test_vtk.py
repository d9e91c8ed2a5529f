"""Files for ParaView, read back with xml and numpy: points are where the channels say."""

import base64
import xml.etree.ElementTree as tree

import numpy as np
import pytest

from tests import small
from trsim.report.vtk import write
from trsim.store.read import read

SPINNING = """
planar: false
bodies:
  box: {shape: [{box: [0.2, 0.3, 0.4], at: [10, -5, 2]}], density: 1000, velocity: [1, 2, 3],
        angular_velocity: [3, 1, -2]}
solver: {end: 1 s, tolerance: 1e-10}
output: {every: 10 ms, channels: ["*", "*.rotation"]}
"""
BEAM = """
bodies:
  beam: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, area: 1e-4,
         second_moment: 8e-10, youngs_modulus: 70e9, density: 2700}
joints: {clamp: {type: fixed, bodies: [ground, beam], at: [0, 0]}}
gravity: [0, -9.81, 0]
solver: {end: 20 ms}
output: {every: 1 ms}
"""


def arrays(path):
    """The arrays of a grid by their names, and the names of its bodies."""
    kinds = {"Float64": "<f8", "Int64": "<i8", "UInt8": "<u1"}
    found = {}
    for one in tree.parse(path).iter("DataArray"):  # noqa: S314
        data = base64.b64decode(one.text)
        assert int.from_bytes(data[:8], "little") == len(data) - 8
        values = np.frombuffer(data[8:], kinds[one.get("type")])
        found[one.get("Name")] = values.reshape(-1, int(one.get("NumberOfComponents") or 1))
    [names] = tree.parse(path).iter("Array")  # noqa: S314
    text = bytes(map(int, names.text.split())).decode()
    return found, text.split("\0")[:-1]


def frames(path):
    """Times and grids of a collection."""
    root = tree.parse(path).getroot()  # noqa: S314
    assert root.get("type") == "Collection"
    for one in root.iter("DataSet"):
        yield float(one.get("timestep")), *arrays(path.parent / one.get("file"))


def of(folder, text, name="x"):
    small.run(folder / "run.h5", text=text)
    run = read(folder / "run.h5")
    return run, *write(run, folder / f"{name}.pvd")


def test_a_free_box_turns_about_its_recorded_centre(tmp_path):
    """Its corners are r + R s, with place and rotation from the file, and move with v + w x r."""
    run, count, warnings = of(tmp_path, SPINNING)
    found = list(frames(tmp_path / "x.pvd"))
    assert (count, len(found), warnings) == (101, 101, ())
    np.testing.assert_allclose([time for time, *_ in found], run.time)
    s = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.15, 0.15) for z in (-0.2, 0.2)])
    for k in (0, 37, 100):
        _, grid, names = found[k]
        assert names == ["box"]
        R = run.channel("box.rotation")[k].reshape(3, 3)
        place, v, w = (run.channel(f"box.{c}")[k] for c in
                       ("position", "velocity", "angular_velocity"))  # fmt: skip
        wanted = place + s @ R.T
        # every corner stands for each of its faces: the eight of them, and nothing else
        away = np.linalg.norm(grid["points"][:, None] - wanted[None], axis=2)
        assert away.min(axis=1).max() < 1e-9 and away.min(axis=0).max() < 1e-9
        speed = v + np.cross(w, grid["points"] - place)
        np.testing.assert_allclose(grid["velocity"], speed, atol=1e-9)
        assert np.isnan(grid["axial_force"]).all()
    assert not np.allclose(found[0][1]["points"], found[100][1]["points"] - [1, 2, 3], atol=0.05)


def test_cells_are_sound(tmp_path):
    of(tmp_path, SPINNING)
    _, grid, _ = next(iter(frames(tmp_path / "x.pvd")))
    ends, kinds = grid["offsets"].ravel(), grid["types"].ravel()
    corners = np.diff(ends, prepend=0)
    assert len(ends) == len(kinds) == len(grid["body"])
    assert {*zip(kinds.tolist(), corners.tolist(), strict=True)} == {(5, 3)}
    assert ends[-1] == len(grid["connectivity"]) and grid["connectivity"].max() < len(
        grid["points"]
    )
    a, b, c = grid["points"][grid["connectivity"].reshape(-1, 3)].transpose(1, 0, 2)
    origin = np.array([10.0, -5.0, 2.0])
    volume = np.sum((a - origin) * np.cross(b - origin, c - origin)) / 6.0
    assert volume == pytest.approx(0.2 * 0.3 * 0.4, rel=1e-9)  # closed, and seen from outside


def test_a_body_with_a_hole_and_one_without_a_shape(tmp_path):
    """The dark rings around a hole are meshes of their own: all points have cells, those of their
    own body."""
    hole = "{cylinder: 0.1, length: 0.4, at: [10, -5, 2], hole: true}"
    text = SPINNING.replace("at: [10, -5, 2]}]", f"at: [10, -5, 2]}}, {hole}]")
    text = text.replace("solver:", "  dot: {mass: 1, inertia: [1, 1, 1], at: [20, 0, 0]}\nsolver:")
    run, *_ = of(tmp_path, text)
    _, grid, names = list(frames(tmp_path / "x.pvd"))[-1]
    assert names == ["box", "dot"]
    parts = np.split(grid["connectivity"].ravel(), grid["offsets"].ravel()[:-1])
    used = {number: np.unique(np.concatenate([p for p, b in zip(parts, grid["body"], strict=True)
                                              if b == number])) for number in (0, 1)}  # fmt: skip
    assert sorted([*used[0], *used[1]]) == list(range(len(grid["points"])))
    for number, name in enumerate(names):
        away = np.linalg.norm(
            grid["points"][used[number]] - run.channel(f"{name}.position")[-1], axis=1
        )
        assert away.max() < 1.5  # they are ten metres apart


def test_a_bar_is_a_line_through_its_nodes(tmp_path):
    run, count, _ = of(tmp_path, BEAM)
    for k, (_, grid, names) in enumerate(frames(tmp_path / "x.pvd")):
        assert names == ["beam"]
        wanted = [run.channel(f"beam.node{n}.position")[k] for n in range(5)]
        np.testing.assert_array_equal(grid["points"], wanted)
        forces = [run.channel(f"beam.node{n}.bending_moment")[k] for n in range(5)]
        np.testing.assert_array_equal(grid["bending_moment"].ravel(), forces)
    assert k + 1 == count == 21
    assert grid["connectivity"].ravel().tolist() == [0, 1, 1, 2, 2, 3, 3, 4]
    assert {*grid["types"].ravel().tolist()} == {3}


def test_a_flat_mechanism_stays_in_its_plane(tmp_path):
    """The animation draws its links in layers; here a slider is where its channel says."""
    run, *_ = of(tmp_path, small.SLIDER_CRANK)
    _, grid, names = list(frames(tmp_path / "x.pvd"))[-1]
    heights = grid["points"][:, 2]
    for number in range(len(names)):
        cells = grid["connectivity"].reshape(-1, 3)[grid["body"].ravel() == number]
        assert heights[cells].max() == pytest.approx(-heights[cells].min(), abs=1e-12)
    cells = grid["body"].ravel() == names.index("slider")
    used = np.unique(grid["connectivity"].reshape(-1, 3)[cells])
    low, high = grid["points"][used].min(axis=0), grid["points"][used].max(axis=0)
    np.testing.assert_allclose(0.5 * (low + high), run.channel("slider.position")[-1], atol=1e-9)


def test_the_motion_does_not_jerk(tmp_path):
    """Of 801 rows every second one; all, 600 of them would be one row apart, or two."""
    small.run(tmp_path / "run.h5", "solver.end=8 ms")
    run = read(tmp_path / "run.h5")
    assert run.rows == 801
    count, _ = write(run, tmp_path / "x.pvd")
    root = tree.parse(tmp_path / "x.pvd").getroot()  # noqa: S314
    times = [float(one.get("timestep")) for one in root.iter("DataSet")]
    assert count == len(times) == 401
    np.testing.assert_allclose(np.diff(times), 2e-5, rtol=1e-9)


def test_command_and_what_it_replaces(tmp_path, monkeypatch):
    from trsim.cli import main

    monkeypatch.chdir(tmp_path)
    small.copy(tmp_path / "run.h5")

    def command(*words):
        with pytest.raises(SystemExit) as ended:
            main(["export", "run.h5", *words])
        return ended.value.code

    assert command("-o", "a b&c.pvd") == 0
    before = {path: path.read_bytes() for path in tmp_path.rglob("*.vtu")}
    assert command("-o", "a b&c.pvd") == 0
    assert before == {path: path.read_bytes() for path in tmp_path.rglob("*.vtu")}
    assert len(list(frames(tmp_path / "a b&c.pvd"))) == len(before) == 301
    (tmp_path / "a b&c.pvd").write_text("<VTKFile/>")
    assert command("-o", "a b&c.pvd") == 2
    assert command("-o", "x.pvd", "--channels", "stroke") == 2
    assert command("-o", "-", "--format", "pvd") == 2
