"""Templates and instances: what they become, and what the user sees when they are wrong."""

import json
from pathlib import Path

import pytest
import yaml

from trsim.assemble.assemble import assemble
from trsim.elements import ELEMENTS
from trsim.elements import load as element
from trsim.errors import TrsimError
from trsim.fields import _PointUnit, _VectorUnit
from trsim.frame import Frame
from trsim.scenario.lint import lint
from trsim.scenario.load import load, loads, locate, valid
from trsim.scenario.meanings import specs
from trsim.scenario.memory import Memory
from trsim.sweeps.plan import faults, plan

TURNED = "{at: [0, 0.3, 0.4], y_axis: [0, 0.6, 0.8]}"
TEXT = """\
parameters: {g: 9.81, load: 7}
templates:
  chain:
    parameters: {load: 1, m: 2}
    bodies:
      door: {mass: m, inertia: [1, 2, 3], at: [0.1, 0.2]}
      rod: {mass: 1, inertia: [1, 1, 1], velocity: [0, 0, 0]}
    joints:
      B: {type: revolute, bodies: [frame, door], at: [0.1, 0]}
      P: {type: revolute, bodies: [door, rod], at: [0, 0.1]}
    sensors:
      opening: {joint: B}
    forces:
      air: {type: applied_load, body: door, frame: door, direction: [1, 0, 0],
            force: "load*g*smoothstep(opening) + stroke"}
      spring: {type: torsion_spring, joint: B, stiffness: 5 N*m/rad}
bodies:
  frame: {mass: 1, inertia: [1, 1, 1]}
joints:
  guide: {type: prismatic, bodies: [ground, frame], axis: [1, 0, 0]}
sensors:
  stroke: {joint: guide}
contact_laws:
  pin: {normal: hunt_crossley, restitution: 0.5, stiffness: 1e9, bearing_radius: 10 mm}
instances:
  left: {template: chain, frame: FRAME, parameters: {load: 1.02}}
  right: {template: chain, joints: {B: {clearance: 0.3 mm, contact: pin}}}
solver: {end: 1}
"""
SECTIONS = ("bodies", "joints", "drives", "sensors", "forces", "events")
TEXT = TEXT.replace("FRAME", TURNED)


def shown(text, sets=()):
    with pytest.raises(TrsimError) as caught:
        loads(text, sets, "a.yaml")
    return caught.value.show()


# --- what they become ------------------------------------------------------------------------


def test_names_of_the_template_are_those_of_the_instance():
    s = loads(TEXT)
    assert list(s.bodies) == ["frame", "left_door", "left_rod", "right_door", "right_rod"]
    assert s.joints["left_B"].bodies == ("frame", "left_door")
    assert s.sensors["right_opening"].joint == "right_B"
    assert s.forces["left_air"].frame == "left_door"
    assert s.forces["left_air"].force.sensors == {"left_opening", "stroke"}


def test_parameters_are_local():
    s = loads(TEXT)
    assert s.parameters == {"g": 9.81, "load": 7}
    numbers = [json.dumps(s.forces[f"{name}_air"].force.node) for name in ("left", "right")]
    assert str(1.02 * 9.81) in numbers[0]
    assert "9.81]" in numbers[1]
    assert s.bodies["left_door"].mass == 2.0
    assert s.forces["left_spring"].stiffness == 5.0  # its m is a unit


def test_points_are_moved_and_directions_turned():
    s = loads(TEXT)
    assert s.bodies["left_door"].at == pytest.approx((0.1, 0.3 + 0.2 * 0.6, 0.4 + 0.2 * 0.8))
    assert s.bodies["left_rod"].at == (0.0, 0.3, 0.4)  # left out: the origin of the frame
    assert s.joints["left_B"].axis == pytest.approx((0.0, -0.8, 0.6))  # left out: its z axis
    assert s.joints["right_B"].axis == (0.0, 0.0, 1.0)
    assert s.forces["left_air"].direction == (1.0, 0.0, 0.0)


def test_an_instance_overrides_its_template():
    s = loads(TEXT)
    assert (s.joints["left_B"].type, s.joints["right_B"].type) == ("revolute", "clearance_joint")
    assert s.joints["right_B"].clearance == 3e-4
    without = loads(TEXT.replace("joints: {B: {clea", "forces: {air: null}, joints: {B: {clea"))
    assert list(without.forces) == ["left_air", "left_spring", "right_spring"]


def test_a_frame_may_use_the_numbers_of_its_instance_and_be_given_by_the_template():
    frame = 'frame: {at: [0, "0.5*sin(chi)", "0.5*cos(chi)"], y_axis: [0, "sin(chi)", "cos(chi)"]}'
    text = TEXT.replace("m: 2}", f"m: 2, chi: 0}}\n    {frame}").replace(
        f"frame: {TURNED}, parameters: {{", "parameters: {chi: 30 deg, "
    )
    s = loads(text)
    assert s.bodies["left_rod"].at == pytest.approx((0.0, 0.25, 0.5 * 3**0.5 / 2))
    assert s.bodies["right_rod"].at == (0.0, 0.0, 0.5)


def test_words_are_no_names():
    text = """
templates:
  t:
    bodies:
      world: {mass: 1, inertia: 1}
"""
    assert "the name 'world' is reserved" in shown(text)
    text = (
        TEXT.replace("rod:", "up:").replace("door, rod]", "door, up]")
        + """
events: {open: {when: left_opening, value: 1, crosses: up, do: {lock: [left_B]}}}
"""
    )
    assert loads(text).events["open"].crosses == "up"


def test_events_of_a_template():
    text = TEXT.replace(
        "    sensors:\n      opening",
        "    events:\n      stop: {when: opening, value: 2*m, do: {lock: [B], end: true}}\n"
        "    sensors:\n      opening",
    )
    event = loads(text, ["instances.left.parameters.m=3"]).events["left_stop"]
    assert (event.when, event.value, event.do.lock) == ("left_opening", 6.0, ("left_B",))
    wrong = shown_by_assembly(text.replace("value: 2*m", "value: 5 mm"))
    assert "a.yaml:12:36: events.left_stop.value: wrong unit: 'mm'" in wrong


def test_what_an_event_sets_has_the_unit_of_its_drive():
    text = TEXT.replace(
        "    sensors:\n      opening",
        "    drives:\n      motor: {joint: P, velocity: 1}\n"
        "    events:\n      go: {when: opening, do: {set: {motor: {velocity: 1 m/s}}}}\n"
        "    sensors:\n      opening",
    )
    found = shown_by_assembly(text)
    assert found.startswith("a.yaml:14:56: events.left_go.do.set.left_motor.velocity: wrong unit")


def shown_by_assembly(text):
    s = loads(text, name="a.yaml")
    with pytest.raises(TrsimError) as caught:
        assemble(s)
    return locate(caught.value, s).show()


def test_an_identity_frame_is_the_flat_scenario():
    text = TEXT.replace(f"frame: {TURNED}, ", "frame: {x_axis: [2, 0, 0], y_axis: [1, 3, 0]}, ")
    flat = yaml.safe_load(text)
    template, instances = flat.pop("templates")["chain"], flat.pop("instances")
    template = json.dumps({key: template[key] for key in SECTIONS if key in template})
    for name in instances:
        own = template.replace("load*", "1.02*" if name == "left" else "1*").replace('"m"', "2")
        for word in ("door", "rod", "B", "P", "opening", "air", "spring"):
            for before, after in ('""', "()", "(,"):
                own = own.replace(before + word + after, f"{before}{name}_{word}{after}")
        for section, entries in json.loads(own).items():
            flat.setdefault(section, {}).update(entries)
    flat["joints"]["right_B"] |= {"clearance": "0.3 mm", "contact": "pin"}
    a, b = loads(text), loads(json.dumps(flat))
    for section in SECTIONS:
        assert getattr(a, section) == getattr(b, section)
    ours, theirs = assemble(a).model, assemble(b).model
    for name, array in ours.arrays().items() if hasattr(ours, "arrays") else ():
        assert array.tobytes() == getattr(theirs, name).tobytes(), name


# --- the tree stays as written ---------------------------------------------------------------


def test_a_setting_of_an_unfolded_name_is_shown_its_place():
    with pytest.raises(TrsimError) as caught:
        loads(TEXT, ["joints.left_B.clearance=0.3mm"])
    assert "instances.left.joints.B.clearance" in caught.value.hint


def test_settings_reach_templates_and_instances():
    both = loads(TEXT, ["templates.chain.joints.P.clearance=0.1mm"])
    assert [both.joints[f"{name}_P"].type for name in ("left", "right")] == ["clearance_joint"] * 2
    one = loads(TEXT, ["instances.left.joints.P.clearance=0.1mm"])
    assert [one.joints[f"{name}_P"].type for name in ("left", "right")] == [
        "clearance_joint",
        "revolute",
    ]
    assert "templates" in one.resolved
    assert "left_B" not in one.resolved["joints"]
    assert "Did you mean 'left'?" in shown(TEXT, ["instances.letf.parameters.load=1"])


def test_sweeps(tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text(
        TEXT
        + """
sweep:
  templates.chain.parameters.load: [1, 2]
  instances.right.joints.B.clearance: [0.1 mm, 0.2 mm]
  instances.left.bodies.door.mass: [3, 4]
  instances.right.frame: [{at: [0, 0]}, {at: [0, 1]}]
"""
    )
    found = plan(str(path))
    assert list(faults(found)) == []
    assert found.units["instances.right.joints.B.clearance"] == "m"
    assert found.units["instances.left.bodies.door.mass"] == "kg"
    last = found.scenario(found.cases[-1])
    assert last.joints["right_B"].clearance == 2e-4
    assert last.bodies["left_door"].mass == 4.0
    assert last.bodies["right_rod"].at == (0.0, 1.0, 0.0)
    assert len({case.digest for case in found.cases}) == 16
    assert "no 'clearanc'" not in shown(TEXT + "sweep: {instances.left.joints.C.at: [[0, 1]]}")
    assert "no 'C'" in shown(TEXT + "sweep: {instances.left.joints.C.at: [[0, 1]]}")


def test_what_is_known_of_a_piece_depends_on_where_it_stands():
    data = loads(TEXT).resolved
    memory = Memory()
    assert valid(data, memory)
    doors = [spec for key, spec in memory.made.items() if '"inertia": [1, 2, 3]' in key[1]]
    assert sorted(door.at for door in doors) == sorted(
        [loads(TEXT).bodies[f"{name}_door"].at for name in ("left", "right")]
    )
    other = {**data, "instances": {"left": {"template": "chain", "parameters": {"load": "x"}}}}
    assert not valid(other, memory)


def test_cases_and_extends(tmp_path):
    (tmp_path / "base.yaml").write_text(TEXT)
    path = tmp_path / "a.yaml"
    path.write_text("extends: base.yaml\ninstances: {third: {template: chain}, left: null}\n")
    s = load(path)
    assert [name for name in s.joints if name.endswith("B")] == ["right_B", "third_B"]


# --- errors ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("template: chain, joints", "template: chian, joints",
         "a.yaml:27:21: instances.right.template: no template named 'chian'"),
        ("  right: {", "  1st: {", "a.yaml:27:3: instances.1st: not a name: '1st'"),
        ("y_axis: [0, 0.6, 0.8]", "y_axis: [2, 0, 0]",
         "a.yaml:26:62: instances.left.frame.y_axis: y_axis is parallel to x_axis"),
        ("y_axis: [0, 0.6, 0.8]", "x_axis: [0, 0, 0]",
         "a.yaml:26:62: instances.left.frame.x_axis: an axis must not be zero"),
        ("y_axis: [0, 0.6, 0.8]", "y_axs: [0, 1, 0]",
         "a.yaml:26:54: instances.left.frame: unknown key 'y_axs'"),
        ("y_axis: [0, 0.6, 0.8]", "y_axis: [0, 1 kg, 0]",
         "a.yaml:26:66: instances.left.frame.y_axis.1: wrong unit: 'kg'"),
        ("    sensors:", "    sensor:", "a.yaml:11:5: templates.chain: unknown key 'sensor'"),
        ("parameters: {load: 1.02}", "parameters: {laod: 1}",
         "instances.left.parameters.laod: template 'chain' has no parameter 'laod'"),
        ("parameters: {load: 1.02}", "parameters: {load: 2 kk}",
         "instances.left.parameters.load: unknown unit"),
        ("{load: 1, m: 2}", "{load: q, m: 2}",
         "a.yaml:4:24: templates.chain.parameters.load: no parameter named 'q'"),
        ("at: [0.1, 0.2]}", "at: 7}",
         "a.yaml:6:47: templates.chain.bodies.door.at: must be [x, y] or [x, y, z], got 7"),
        ("at: [0.1, 0.2]}", "att: [0, 0]}",
         "a.yaml:6:43: templates.chain.bodies.door: unknown key 'att'"),
        ("clearance: 0.3 mm", "clearance: 0.3 kg",
         "a.yaml:27:52: instances.right.joints.B.clearance: wrong unit: 'kg'"),
        ("joints: {B: {cl", "joints: {BB: {cl",
         "a.yaml:27:37: instances.right.joints.BB: template 'chain' has no 'BB'"),
        ("  frame: {mass: 1", "  left_rod: {mass: 1, inertia: 1}\n  frame: {mass: 1",
         "a.yaml:27:3: instances.left: its entry 'rod' is 'left_rod', a name that is taken"),
        ("  stroke: {joint: guide}", "  stroke: {joint: guide}\n  left_rod: {joint: guide}",
         "the name 'left_rod' is taken by bodies.left_rod"),
        ("      opening:", "      rod:",
         "a.yaml:12:7: templates.chain.sensors.rod: the name 'rod' is taken by bodies.rod"),
        ("    sensors:\n", "    instances: {a: {template: chain}}\n    sensors:\n",
         "a.yaml:11:5: templates.chain.instances: a template has no instances of others"),
        ("    bodies:\n", "    drives: 3\n    bodies:\n",
         "a.yaml:5:13: templates.chain.drives: must be a mapping, got 3"),
        (f"frame: {TURNED}", "frame: 3", "instances.left.frame: must be a mapping, got 3"),
        ("{template: chain, joints", "{joints",
         "a.yaml:27:3: instances.right: field required: template"),
    ],
)  # fmt: skip
def test_message(old, new, message):
    assert old in TEXT
    found = shown(TEXT.replace(old, new))
    assert message in found
    assert found.count(" ^") == 1, found  # said once


def test_assembly_knows_the_line():
    text = TEXT.replace("bodies: [door, rod]", "bodies: [door, rood]")
    assert shown_by_assembly(text).startswith("a.yaml:10:42: joints.left_P.bodies.1: no body named")
    old = "sensors:\n      opening: {joint: B"
    text = TEXT.replace(old, f"{old}, at_start: 3 mm")
    assert "a.yaml:12:37: sensors.left_opening.at_start: wrong unit: 'mm'" in shown_by_assembly(
        text
    )


def test_only_some_instances():
    text = TEXT.replace("mass: m", "mass: sqrt(m)").replace("load: 1.02", "m: -1")
    found = shown(text)
    assert "a.yaml:6:20: templates.chain.bodies.door.mass: sqrt(-1) has no finite value" in found
    assert "  In left." in found


def test_notes():
    text = TEXT.replace("  left: {template: chain", "  #").replace(
        "  right: {template: chain", "  #"
    )
    told = lint(loads(text.replace("instances:", "sweep: {}")))
    assert "templates.chain: no instance uses it; put it in place under `instances`" in told
    assert not any("no instance" in note for note in lint(loads(TEXT)))
    heavy = loads(TEXT.replace("inertia: [1, 2, 3]", "inertia: [1, 2, 9]"))
    assert [note for note in lint(heavy) if "no body has one" in note] == [
        note for note in lint(heavy) if note.startswith("templates.chain.bodies.door.inertia: ")
    ]
    assert len([note for note in lint(heavy) if "no body has one" in note]) == 1


# --- every vector of every element -----------------------------------------------------------

FREE_LENGTHS: set[str] = set()  # lengths along the world's axes that are no places


def vectors(annotation):
    """The marks of the vectors in the type of a key."""
    for mark in getattr(annotation, "__metadata__", ()):
        if isinstance(mark, _VectorUnit):
            yield mark
    for part in getattr(annotation, "__args__", ()):
        yield from vectors(part)


def test_places_are_points():
    """A vector in m is a place, and moves with the frame of an instance: write `point("m")`."""
    seen = 0
    for word in ELEMENTS:
        for spec in specs(element(word).spec):
            for key, field in spec.model_fields.items():
                marks = [m for m in field.metadata if isinstance(m, _VectorUnit)]
                for mark in (*marks, *vectors(field.annotation)):
                    seen += 1
                    place = isinstance(mark, _PointUnit) or f"{word}.{key}" in FREE_LENGTHS
                    assert place == ("m" in mark.units), f"{word}.{key}"
    assert seen > 20


def test_the_documented_example():
    text = (Path(__file__).parents[1] / "docs/scenarios.md").read_text()
    example = text.split("## Templates")[1].split("```yaml scene\n")[1].split("```")[0]
    s = loads(example)
    assert {"port_door", "star_door"} <= set(s.bodies)
    assemble(s)


def test_frames():
    frame = Frame((1.0, 2.0, 3.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    assert frame.moved((1.0, 0.0, 0.0)) == (1.0, 3.0, 3.0)
    assert frame.inside(frame.turned((0.3, 0.4, 0.5))) == (0.3, 0.4, 0.5)
    assert frame.flat
    assert frame.quaternion == pytest.approx((0.5**0.5, 0.0, 0.0, 0.5**0.5))
