"""Units: of what is read from tables, and of every channel that is written."""

import json

import h5py
import numpy as np
import pytest

from trsim import elements
from trsim.assemble.assemble import assemble
from trsim.elements.contract import REACTIONS
from trsim.errors import ScenarioError, TrsimError, UsageError
from trsim.report import figures
from trsim.report.display import compared
from trsim.scenario.load import load, loads
from trsim.scenario.table import rows
from trsim.solve.simulate import simulate
from trsim.store.export import export
from trsim.store.hdf5 import write
from trsim.store.read import read
from trsim.units import titled

# --- titles ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, name, unit",
    [
        ("force [kN]", "force", "kN"),
        (" q2 [deg] ", "q2", "deg"),
        ("force (kN)", "force", "kN"),
        ("[mm]", "", "mm"),
        ("M[N*m]", "M", "N*m"),
        ("rate [1/s]", "rate", "1/s"),
        ("force", "force", ""),
        ("", "", ""),
    ],
)
def test_titles(text, name, unit):
    assert titled(text) == (name, unit)


@pytest.mark.parametrize(
    "text, what, hint",
    [
        ("force [kn]", "unknown unit 'kn'", "Did you mean 'kN'?"),
        ("M [Nm]", "unknown unit 'Nm'", "Did you mean 'N*m'?"),
        ("a [m/s2]", "unknown unit 's2'", "Did you mean 'm/s^2'?"),
        ("q [degrees]", "unknown unit 'degrees'", "Did you mean 'deg'?"),
        ("t [sec]", "unknown unit 'sec'", "Did you mean 's'?"),
        ("force (measured)", "unknown unit 'measured'", ""),
        ("force [kN", "no title of a column", "in brackets"),
        ("[kN] force", "no title of a column", "in brackets"),
        ("force []", "no title of a column", "in brackets"),
        ("f [N] [kN]", "no title of a column", "in brackets"),
    ],
)
def test_titles_that_tell_no_unit(text, what, hint):
    with pytest.raises(ScenarioError) as caught:
        titled(text)
    assert caught.value.what.startswith(what)
    assert hint in caught.value.hint


# --- tables of a scenario --------------------------------------------------------------------

PENDULUM = """\
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
sensors:
  q2: {joint: hinge}
forces:
  load: {type: applied_load, body: rod, direction: [0, 0, 1], torque: {table: load.csv, of: q2}}
solver: {end: 0.1 s}
"""
SLIDE = """\
bodies:
  block: {mass: 2 kg, inertia: 0.01 kg*m^2}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
sensors:
  stroke: {joint: slide}
drives:
  motor: {joint: slide, position: {table: load.csv}}
solver: {end: 0.1 s}
"""


def table(folder, text, scenario=PENDULUM):
    """What is read of a CSV file."""
    (folder / "load.csv").write_text(text)
    found = loads(scenario, folder=folder)
    if "load" in found.forces:
        return found.forces["load"].torque, found
    return found.drives["motor"].position, found


def test_units_of_titles_are_honoured(tmp_path):
    found, scenario = table(tmp_path, "# of the wind\nq2 [deg], load [kN*mm]\n-90, 1\n180, 2.5\n")
    assert found.x == pytest.approx((-np.pi / 2, np.pi), rel=1e-15)
    assert found.y == pytest.approx((1.0, 2.5), rel=1e-15)
    assert found.units == ("deg", "kN*mm")
    assert not scenario.bare
    again = loads(json.dumps(scenario.resolved))  # as a sweep hands it on
    assert again.forces["load"].torque == found


def test_a_motion_in_degrees_runs_in_radians(tmp_path):
    (tmp_path / "turn.csv").write_text("t [ms],q [deg]\n0,0\n50,45\n100,90\n")
    text = PENDULUM.split("forces:")[0] + (
        "drives: {motor: {joint: hinge, position: {table: turn.csv}}}\nsolver: {end: 0.1 s}\n"
    )
    scenario = loads(text, folder=tmp_path)
    run = write(tmp_path / "x.h5", scenario, (m := assemble(scenario)), simulate(scenario, m))
    assert run["status"] == "done"
    assert read(tmp_path / "x.h5").channel("q2")[-1] == pytest.approx(np.pi / 2, rel=1e-9)


@pytest.mark.parametrize(
    "text, told",
    [
        ("q2, load\n0, 1\n1, 2\n", "column 1 (q2) and column 2 (load) of load.csv"),
        ("q2 [deg], load\n0, 1\n1, 2\n", "column 2 (load) of load.csv"),
        ("0, 1\n1, 2\n", "column 1 and column 2 of load.csv"),
    ],
)
def test_a_column_without_a_unit_is_si_and_check_says_so(text, told, tmp_path):
    found, scenario = table(tmp_path, text)
    assert found.y == (1.0, 2.0)
    (note,) = scenario.bare
    assert note.startswith(f"forces.load.torque.table: {told} without a unit: read as SI")


@pytest.mark.parametrize(
    "text, where, what",
    [
        ("q2 [deg], load [kNm]\n0,1\n1,2\n", "load.csv:1:11", "unknown unit 'kNm'"),
        ("# x\n\nq2 [dge], load [N*m]\n0,1\n1,2\n", "load.csv:3:1", "unknown unit 'dge'"),
        ("q2, load\ndeg, N*m\n0,1\n1,2\n", "load.csv:2:1", "a second line of titles"),
        ("q2 [deg] load [N*m]\n0,1\n1,2\n", "load.csv:1:1", "1 titles, but 2 columns"),
        ("q2 [deg], load [N*m], x\n0,1\n1,2\n", "load.csv:1:1", "3 titles, but 2 columns"),
        ("q2 [mm], load [N*m]\n0,1\n1,2\n", None, "wrong unit: 'mm'; 'q2' is in rad"),
        ("t [s], load [N*m]\n0,1\n1,2\n", None, "wrong unit: 's'; 'q2' is in rad"),
        ("q2 [deg], load [kN]\n0,1\n1,2\n", "<text>:8", "wrong unit: 'kN' is a force"),
    ],
)
def test_units_that_do_not_fit(text, where, what, tmp_path):
    with pytest.raises(ScenarioError) as caught:
        assemble(table(tmp_path, text)[1])
    assert what in caught.value.what
    if where:
        assert caught.value.place.show().startswith(where)


@pytest.mark.parametrize(
    "text, what",
    [
        ("t [s], x [mm]\n0,0\n1,2\n", None),
        ("t [s], x [deg]\n0,0\n1,2\n", "wrong unit: 'deg'; this number is in m"),
        ("x [mm], x [mm]\n0,0\n1,2\n", "wrong unit: 'mm'; 't' is in s"),
    ],
)
def test_units_of_a_motion_are_those_of_its_joint(text, what, tmp_path):
    found, scenario = table(tmp_path, text, SLIDE)
    if what is None:
        assert found.y == (0.0, 0.002)
        assemble(scenario)
        return
    with pytest.raises(ScenarioError) as caught:
        assemble(scenario)
    assert caught.value.what == what


@pytest.mark.parametrize(
    "given, what",
    [
        ("{table: load.csv, of: q2, units: [deg, N*m]}", None),
        ("{table: load.csv, of: q2, units: [rad, N*m]}", "the title says deg, `units` says 'rad'"),
        ("{table: [[0 deg, 1], [1 mm, 2]], of: q2}", "one kind of unit, not deg and mm"),
        ("{table: [[0, 1 kN*m], [1, 2]], of: q2, units: [deg, kN*m]}", "and so has its column"),
        ("{table: [[0, 1], [1, 2]], of: q2, units: [s, N*m]}", "wrong unit: 's'; 'q2' is in rad"),
    ],
)
def test_units_are_said_once(given, what, tmp_path):
    text = PENDULUM.replace("{table: load.csv, of: q2}", given)
    if what is None:
        assert table(tmp_path, "q2 [deg], load\n0, 1\n180, 2\n", text)[0].x[1] == np.pi
        return
    with pytest.raises(ScenarioError) as caught:
        assemble(table(tmp_path, "q2 [deg], load\n0, 1\n180, 2\n", text)[1])
    assert what in caught.value.what


def test_a_case_takes_units_along_with_its_table(tmp_path):
    """Units of one file do not stay behind when a case names another."""
    (tmp_path / "a.csv").write_text("t [ms], x [mm]\n0, 0\n100, 5\n")
    (tmp_path / "b.csv").write_text("t, x\n0, 0\n0.1, 0.004\n")
    text = SLIDE.replace("load.csv", "a.csv")
    (tmp_path / "s.yaml").write_text(text)
    over = load(tmp_path / "s.yaml", ["drives.motor.position.table=b.csv"])
    assert load(tmp_path / "s.yaml").drives["motor"].position.y == (0.0, 0.005)
    assert over.drives["motor"].position.y == (0.0, 0.004)


@pytest.mark.parametrize("number", ["1_000", "0x10", "٣", "1e999", "nan", ""])
def test_numbers_of_tables_are_plain(number):
    with pytest.raises(ScenarioError):
        rows(f"0, 1\n{number}, 2\n".encode(), "a.csv")


@pytest.mark.parametrize(
    "text, what",
    [
        ("stiffness: 1e4 N*m/rad", "wrong unit: 'N*m/rad'; a point meets a wall"),
        ("stiffness: 1e4 N/m, ramp: 0.01 deg", "wrong unit: 'deg'; a point meets a wall"),
    ],
)
def test_a_wall_is_no_angle(text, what):
    stop = "{type: limit_stop, point: {body: block, at: [0, 0]}, "
    stop += f"wall: {{body: ground, at: [1, 0], normal: [-1, 0]}}, {text}}}"
    with pytest.raises(ScenarioError) as caught:
        assemble(loads(SLIDE.split("drives:")[0] + f"forces: {{stop: {stop}}}"))
    assert caught.value.what == what


# --- channels --------------------------------------------------------------------------------

ALL = """\
title: every element that may turn or slide
planar: false
bodies:
  wheel: {mass: 2 kg, inertia: [0.05, 0.05, 0.05], at: [0.2, 0, 0]}
  block: {mass: 2 kg, inertia: [0.01, 0.01, 0.01], at: [0, 1, 0]}
  disc: {mass: 2 kg, inertia: [0.05, 0.05, 0.05], at: [0, 2, 0]}
  sled: {mass: 2 kg, inertia: [0.05, 0.05, 0.05], at: [0, 3, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, wheel], at: [0.2, 0, 0], axis: [0, 1, 0]}
  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
  driven_hinge: {type: revolute, bodies: [ground, disc], at: [0, 2, 0], axis: [0, 0, 1]}
  driven_slide: {type: prismatic, bodies: [ground, sled], axis: [1, 0, 0]}
sensors:
  angle: {joint: hinge}
  stroke: {joint: slide}
drives:
  turning: {joint: driven_hinge, position: 0.1*t}
  sliding: {joint: driven_slide, position: 0.1*t}
forces:
  push: {type: applied_load, body: block, direction: [1, 0, 0], force: 30 N}
  twist: {type: applied_load, body: wheel, direction: [0, 1, 0], torque: 3 N*m}
  on_angle: {type: limit_stop, joint: hinge, upper: 0.02 rad, stiffness: 1e4 N*m/rad,
             ramp: 1e-3 rad}
  on_stroke: {type: limit_stop, joint: slide, upper: 2 mm, stiffness: 1e6 N/m}
  on_wall: {type: limit_stop, point: {body: block, at: [0, 1, 0]}, stiffness: 1e6 N/m,
            wall: {body: ground, at: [3 mm, 1, 0], normal: [-1, 0, 0]}}
  spring: {type: spring_damper, bodies: [ground, block], points: [[-0.2, 1, 0], [0, 1, 0]],
           stiffness: 5}
  coil: {type: torsion_spring, joint: hinge, stiffness: 1}
  rubs_turning: {type: joint_friction, joint: driven_hinge, radius: 10 mm, constant: 3 N*m,
                 friction: {law: modified_coulomb, coefficient: 0.1, v0: 0, v1: 1 mm/s}}
  rubs_sliding: {type: joint_friction, joint: driven_slide, constant: 3 N,
                 friction: {law: modified_coulomb, coefficient: 0.1, v0: 0, v1: 1 mm/s}}
  own_coil: {type: joint_spring, joint: hinge, elastic: "0.1*stretch"}
  own_spring: {type: joint_spring, joint: slide, damper: "0.1*rate"}
events:
  held: {when: t, value: 0.09 s, do: {lock: [hinge, slide], record: true}}
solver: {end: 0.1 s, tolerance: 1e-5}
output: {every: 1 ms}
"""
LENGTH = {"": "m", "rate": "m/s", "acceleration": "m/s^2"}
ANGLE = {"": "rad", "rate": "rad/s", "acceleration": "rad/s^2"}
REACTION = {"reaction": "N", "reaction_moment": "N*m"}
FORCE = {"force": "N", "position": "m", "velocity": "m/s", "power": "W"}
TORQUE = {"force": "N*m", "position": "rad", "velocity": "rad/s", "power": "W"}
BODY = {
    "position": "m", "velocity": "m/s", "acceleration": "m/s^2", "angular_velocity": "rad/s",
    "angular_acceleration": "rad/s^2",
}  # fmt: skip
STOP = {"normal_force": "N", "penetration": "m", "force": "N"}
EXPECTED = {
    **dict.fromkeys(("wheel", "block", "disc", "sled"), BODY),
    **dict.fromkeys(("hinge", "slide", "driven_hinge", "driven_slide"), REACTION),
    "angle": ANGLE,
    "stroke": LENGTH,
    "turning": TORQUE,
    "sliding": FORCE,
    "push": {"magnitude": "N", "load": "N"},
    "twist": {"magnitude": "N*m", "load": "N*m"},
    "on_angle": {"normal_force": "N*m", "penetration": "rad", "force": "N*m"},
    "on_stroke": STOP,
    "on_wall": STOP,
    "spring": {"force": "N", "length": "m"},
    "coil": {"torque": "N*m"},
    "rubs_turning": {"force": "N*m", "normal_force": "N", "sliding_speed": "m/s"},
    "rubs_sliding": {"force": "N", "normal_force": "N", "sliding_speed": "m/s"},
    "own_coil": {"force": "N*m", "elastic": "N*m", "stretch": "rad"},
    "own_spring": {"force": "N", "elastic": "N", "stretch": "m"},
    "hinge.lock": TORQUE,
    "slide.lock": FORCE,
}
# of the elements whose units depend on nothing, by their kind
FIXED = {
    "gear_mesh": {"force": "N", "play": "m", "torque_1": "N*m", "torque_2": "N*m"},
    "rigid_body": {**BODY, "rotation": "-"},
    "displacement": LENGTH,
    "distance": LENGTH,
    "section": {"force": "N", "moment": "N*m", "shear": "N", "bending": "N*m"},
    "point": LENGTH,
    "energy": {"": "J"},
    "formula": {"": "-", "rate": "1/s"},
    "point_velocity": {"": "m/s", "rate": "m/s^2"},
    "relative_angle": ANGLE,
    "marker": {"position": "m", "velocity": "m/s", "acceleration": "m/s^2", "rotation": "-"},
    "gravity": {},
    "parked": {"force": "N", "moment": "N*m"},
    "actuator": {"force": "N", "reaction": "N", "stroke": "m", "stroke_rate": "m/s",
                 "position": "m", "velocity": "m/s", "power": "W"},
    "sync_shaft": {"torque_1": "N*m", "force_1": "N", "force_2": "N", "difference": "m"},
    "distributed_load": {"magnitude": "N/m", "load": "N"},
    "ancf_cable": {"position": "m", "velocity": "m/s", "angular_velocity": "rad/s", "tip": "m",
                   "middle": "m", "deflection": "m", "strain_energy": "J",
                   "stretching_energy": "J",
                   **{f"node{k}.{name}": unit for k in range(5) for name, unit in
                      (("position", "m"), ("axial_force", "N"), ("bending_moment", "N*m"))}},
    "constant_velocity": {"bend": "rad"},
    "link": {"force": "N"},
    "gear": {"torque_1": "N*m", "torque_2": "N*m"},
    "belt": {"torque_1": "N*m", "torque_2": "N*m"},
    "rope": {"tension": "N", "push": "N"},
    "cam": {"normal_force": "N", "pull": "N", "curvature": "1/m", "place": "m", "arc": "m"},
    "point_on_curve": {"arc": "m"},
    "worm": {"torque_1": "N*m", "torque_2": "N*m"},
    "rack_and_pinion": {"torque_1": "N*m", "force_2": "N"},
    "coupler": {"torque_1": "N*m", "force_2": "N"},
    "spring_damper": EXPECTED["spring"],
    "wrench": {"force": "N", "moment": "N*m"},
    "spring": {"force": "N", "elastic": "N", "length": "m"},
    "ball_spring": {"moment": "N*m", "rotation_vector": "rad"},
    "bushing": {"force": "N", "moment": "N*m", "displacement": "m", "rotation_vector": "rad"},
    "torsion_spring": EXPECTED["coil"],
    "clearance_joint": {"normal_force": "N", "friction_force": "N", "contact_force": "N",
                        "penetration": "m", "penetration_rate": "m/s", "sliding_speed": "m/s",
                        "eccentricity_x": "m", "eccentricity_y": "m",
                        "eccentricity_x_rate": "m/s", "eccentricity_y_rate": "m/s",
                        "force": "N"},
    "seal": {"normal_force": "N", "friction_force": "N", "compression": "m",
             "contact_length": "m", "force": "N"},
    "surface_contact": {"normal_force": "N", "friction_force": "N", "contact_force": "N",
                        "penetration": "m", "penetration_rate": "m/s", "sliding_speed": "m/s",
                        "rolling_speed": "m/s", "patch_radius": "m", "damping_loss": "J",
                        "friction_loss": "J", "force_behind": "N", "force_at_seam": "N",
                        "place": "m", "force": "N"},
    "shaft": {"locating_force": "N", "floating_force": "N", "locating_load": "N",
              "floating_load": "N"},
}  # fmt: skip
# seen in the scene above
DEPENDS = {
    "drive",
    "sensor",
    "applied_load",
    "limit_stop",
    "joint_friction",
    "joint_spring",
    "reaction",
}


def test_units_of_the_elements():
    assert {*FIXED, *DEPENDS} <= {*elements.ELEMENTS}
    for word in {*elements.ELEMENTS} - DEPENDS:
        channels = elements.load(word).channels
        assert {c.name: c.unit for c in channels} == FIXED.get(word, {}), word
    assert {c.name: c.unit for c in REACTIONS} == REACTION


@pytest.fixture(scope="module")
def every(tmp_path_factory):
    """The run of a scene with every element that may turn or slide."""
    path = tmp_path_factory.mktemp("units") / "every.h5"
    scenario = loads(ALL)
    mechanism = assemble(scenario)
    told = write(path, scenario, mechanism, simulate(scenario, mechanism))
    assert told["status"] == "done"
    assert told["contacts"]["on_angle"]["impacts"] and told["contacts"]["on_wall"]["impacts"] == 0
    return path


def named(wanted):
    return {
        (f"{owner}.{name}" if name else owner): unit
        for owner, channels in wanted.items()
        for name, unit in channels.items()
    }


def test_units_of_channels(every):
    run = read(every)
    units = {name: unit for name, unit in run.units.items() if not name.startswith("energy.")}
    assert units == named(EXPECTED)
    assert {run.units[n] for n in run.names if n.startswith("energy.")} == {"J"}
    assert all(peak.unit == run.unit(peak.channel) for peak in run.peaks)


def test_units_of_all_tables(every):
    with h5py.File(every) as file:
        for name in ("on_angle", "on_stroke", "on_wall"):
            steps = {k: d.attrs["units"] for k, d in file["steps"][name].items() if k != "time"}
            assert steps == EXPECTED[name], name
        recorded = {
            k: d.attrs["units"]
            for k, d in file["recorded"].items()
            if k not in ("time", "event") and not k.startswith("energy.")
        }
        assert recorded == named(EXPECTED)
        assert file["events"]["speed"].attrs["units"] == "rad/s or m/s or -"
        assert file["events"]["time"].attrs["units"] == "s"


def test_units_of_figures(every):
    shown = compared([read(every)])
    labels = {
        name: " | ".join(axes.get_ylabel() for axes in figure.axes)
        for name, figure in figures.everything(shown)
    }
    assert labels["contact_on_angle"] == "contact torque (N\u00b7m)"
    assert labels["contact_on_stroke"] == "contact force (N)"
    assert labels["drive_turning"] == "torque of turning (N\u00b7m)"
    assert labels["drive_sliding"] == "force of sliding (N)"
    assert labels["motion_angle"].startswith("angle\n(deg)")
    assert labels["motion_stroke"].startswith("stroke\n(mm)")


def test_units_of_numbers(every):
    from trsim.analyse.outputs import scalar

    run = read(every)
    for word, unit in (
        ("summary:contacts.on_angle.peak_force", "N*m"),
        ("summary:contacts.on_angle.fastest_impact", "rad/s"),
        ("summary:contacts.on_stroke.peak_force", "N"),
        ("summary:contacts.on_stroke.fastest_impact", "m/s"),
        ("summary:contacts.on_stroke.impacts", "-"),
        ("solver:energy_residual", "J"),
        ("peak:twist.magnitude", "N*m"),
        ("peak:hinge.lock.force", "N*m"),
    ):
        assert scalar(run, word)[1] == unit, word


def test_an_export_is_a_table(every, tmp_path):
    """What is exported is read again as a motion, and as an overlay, in its units."""
    from trsim.analyse.reference import given

    run = read(every)
    export(run, ["angle"], tmp_path / "load.csv")
    text = PENDULUM.split("forces:")[0]
    text += "drives: {motor: {joint: hinge, position: {table: load.csv}}}\nsolver: {end: 0.1 s}\n"
    motion = loads(text, folder=tmp_path).drives["motor"].position
    np.testing.assert_array_equal(motion.y, run.channel("angle"))
    assert motion.units == ("s", "rad")
    table = given(tmp_path / "load.csv", "time", {"angle": "rad"}, "s")
    np.testing.assert_array_equal(table.y["angle"], run.channel("angle"))
    lines = (tmp_path / "load.csv").read_text().replace("[rad]", "(mrad)")
    (tmp_path / "load.csv").write_text(lines)
    table = given(tmp_path / "load.csv", "time", {"angle": "rad"}, "s")
    np.testing.assert_allclose(table.y["angle"], 1e-3 * run.channel("angle"), rtol=1e-15)
    (tmp_path / "load.csv").write_text(lines.replace("(mrad)", "[mard]"))
    with pytest.raises(UsageError) as caught:
        given(tmp_path / "load.csv", "time", {"angle": "rad"}, "s")
    assert "Did you mean 'mrad'?" in caught.value.hint
    assert caught.value.place.show().endswith("load.csv:1:10")
    assert isinstance(caught.value, TrsimError)


# --- parameters ------------------------------------------------------------------------------

SCENE = """
parameters: {w: 3 rad/s, x: 20 mm, a: 90 deg, k: 3 N/m, plain: 2, twice: 2*a, same: x}
bodies: {mass: {mass: 2, inertia: 0.01}}
joints: {guide: {type: prismatic, bodies: [ground, mass], at: [0, 0], axis: [0, 1]}}
sensors: {s: {joint: guide, at_start: 0}}
drives: {d: {joint: guide, velocity: 1, compliance: {stiffness: 3, damping: 0}}}
forces: {f: {type: applied_load, body: mass, direction: [0, 1], force: 3}}
initial: {guide: 0}
events: {e: {when: s, value: 1, do: {end: true}}}
solver: {end: 0.1}
"""


@pytest.mark.parametrize(
    "old, new, what",
    [
        ("mass: 2,", "mass: x,", "'mm' is a length; this number is a mass"),
        ("mass: 2,", "mass: -x,", "'-x' is a parameter in mm"),
        ("mass: 2,", "mass: same,", "'same' is a parameter in mm"),
        ("at: [0, 0]", "at: [0, a]", "'deg' is an angle; this number is a length"),
        ("at_start: 0", "at_start: a", "the joint slides"),
        ("velocity: 1,", "velocity: w,", "wrong unit: 'rad/s'"),
        ("velocity: 1,", "velocity: k,", "this number is a speed"),
        ("stiffness: 3", "stiffness: w", "this number is a stiffness"),
        ("force: 3", "force: k", "this number is a force"),
        ("force: 3", "force: {table: [[0, x], [1, x]]}", "this number is a force"),
        ("force: 3", "force: {table: [[0, 1], [1, x]], units: [s, kN]}", "so has its column"),
        ("guide: 0", "guide: a", "this number is a length"),
        ("guide: 0", "guide: 90 deg", "this number is a length"),
        ("guide: 0", "guide.rate: w", "this number is a speed"),
        ("value: 1", "value: a", "'s' is in m"),
        ("end: 0.1", "end: x", "this number is a time"),
    ],
)
def test_a_parameter_keeps_its_unit(old, new, what):
    assert SCENE.count(old) == 1
    with pytest.raises(TrsimError, match=what):
        assemble(loads(SCENE.replace(old, new)))


@pytest.mark.parametrize(
    "old, new",
    [
        ("mass: 2,", "mass: plain,"),
        ("mass: 2,", "mass: 100*x,"),  # an expression is of numbers in SI
        ("at: [0, 0]", "at: [0, same]"),
        ("at_start: 0", "at_start: x"),
        ("force: 3", "force: {table: [[0, plain], [1, 3]], units: [s, kN]}"),
        ("guide: 0", "guide: -x"),
        ("value: 1", "value: plain"),
        ("end: 0.1", "end: plain/10"),
    ],
)
def test_parameters_without_a_unit_and_expressions_are_si(old, new):
    assemble(loads(SCENE.replace(old, new)))


def test_a_parameter_of_an_instance_keeps_its_unit():
    text = """
templates:
  part:
    parameters: {x: 20 mm}
    bodies: {mass: {mass: 1, inertia: x}}
instances: {one: {template: part}, two: {template: part, parameters: {x: 2 kg*m^2}}}
solver: {end: 0.1}
"""
    with pytest.raises(TrsimError, match="'mm' is a length") as caught:
        loads(text)
    assert len(caught.value.problems) == 1
    loads(text.replace("20 mm", "20 kg*m^2"))
