"""`trsim explain`: examples that run, channels that are recorded, a meaning for every key."""

import pytest

from trsim import elements
from trsim.assemble.assemble import assemble
from trsim.expressions import FUNCTIONS
from trsim.scenario.explain import explained, worded
from trsim.scenario.load import loads
from trsim.scenario.meanings import meanings, specs
from trsim.scenario.scenario import Scenario
from trsim.solve.simulate import simulate
from trsim.varying import TABLE_KEYS

EVERYTHING = explained()
# each once, in an order of its own: processes that share the tests must collect the same ones
SPECS = list(
    dict.fromkeys(spec for word in elements.ELEMENTS for spec in specs(elements.load(word).spec))
)


@pytest.mark.parametrize("page", EVERYTHING["elements"], ids=lambda page: page["word"])
def test_example_runs_and_records_what_is_said(page):
    more = [f"*.{kind}" for kind in ("rotation", "damping_loss")
            if any(channel["name"] == f"NAME.{kind}" for channel in page["channels"])]  # fmt: skip
    every = str(["*", *more])  # the others are not in the first
    scenario = loads(page["example"], [f"output.channels={every}"])
    mechanism = assemble(scenario)
    [instance] = [i for i in mechanism.instances if i.element.key == page["word"]]
    own = {c.name: c for c in mechanism.columns if f"{c.name}.".startswith(f"{instance.name}.")}
    assert len(own) == len(page["channels"]) or not instance.section
    for channel in page["channels"]:
        column = own[channel["name"].replace("NAME", instance.name)]
        assert column.unit in channel["unit"].split(" or ")
        assert (column.size, column.meaning) == (channel["size"], channel["meaning"])
    blocks = simulate(scenario, mechanism)
    while True:
        try:
            next(blocks)
        except StopIteration as end:
            assert end.value.status == "done"
            assert end.value.time == scenario.solver.end
            break


def test_example_of_events_runs():
    [page] = explained("events")["sections"]
    scenario = loads(page["example"])
    blocks = simulate(scenario, assemble(scenario))
    while True:
        try:
            next(blocks)
        except StopIteration as end:
            assert end.value.reason == "event 'over' ended the run"
            assert end.value.fired == {"jettison": 1, "over": 1}
            break


def test_example_of_phases_runs():
    [page] = explained("phases")["sections"]
    assert "load steps in order" in page["law"]
    places = {key["place"]: key for key in page["keys"]}
    assert places["phases.for"]["unit"] == "s" and places["phases.stall.energy"]["required"]
    scenario = loads(page["example"])
    blocks = simulate(scenario, assemble(scenario))
    while True:
        try:
            next(blocks)
        except StopIteration as end:
            assert end.value.status == "released"
            break


@pytest.mark.parametrize("spec", [*specs(Scenario), *SPECS], ids=lambda spec: spec.__name__)
def test_every_key_has_a_meaning(spec):
    assert set(meanings(spec)) == set(spec.model_fields)


def test_meanings_of_docstrings():
    class Base:
        """A base.

        one  first
        two  second,
             on two lines
        and  no key
        """

        one: int
        two: int

    class Derived(Base):
        """two  again
        six  sixth
        """

        two: int
        six: int

    assert meanings(Base) == {"one": "first", "two": "second, on two lines"}
    assert meanings(Derived) == {"one": "first", "two": "again", "six": "sixth"}


@pytest.mark.parametrize(
    "word, told",
    [
        ("torsion_spring", ["tau = T_0", "stiffness: number >= 0, N/m or N*m/rad",
                            "preload: number, N or N*m, default", "NAME.torque  [N*m]"]),
        ("clearance_joint", ["type: clearance_joint | revolute, required", "NAME.reaction  [N, 3",
                             "joint coordinate: angle", "axis: [x, y] or [x, y, z] or axis of a "]),
        ("gravity", ["E = -m g . r", "a section: [x, y] or [x, y, z], m/s^2"]),
        ("rigid_body", ["inertia: number >= 0 or 3 numbers or 6 numbers, kg*m^2",
                        "shape.cylinder: n"]),
        ("drive", ["velocity: number, expression or table, m/s or rad/s", "compliance.mass: numb"]),
        ("solver", ["method: auto | dop853 | radau | g", "tolerance: number >= 1e-14, <= 0.1, d",
                    "force: true or false, default false", "max_steps: whole number > 0"]),
        ("contact_laws", ["K = 4/(3 (s_i + s_j))",
                          "stiffness: internal | paper | cylinder | hertz | table or numb",
                          "friction.law: none | coulomb"]),
        ("initial", ["equilibrium: all or list of text", "NAME: number"]),
        ("forces", ["applied_load", "limit_stop"]),
        ("points", ["marker"]),
        ("marker", ["p'' = r''", "body: text, required", "at: [x, y] or [x, y, z], m, req"]),
        ("clearance", ["clearance_joint.clearance: number >= 0, m, required\n    radial c"]),
        ("at", ["applied_load.at", "limit_stop.wall.at", "revolute.at"]),
        ("wall.normal", ["wall.normal: [x, y] or [x, y, z] or axis of a point or these rel"]),
        ("floor", ["floor(x)", "the largest whole number"]),
        ("interpolation", ["{table: [[x, y], ...], interpolation: ...}", "akima"]),
        ("havsin", ["havsin(x, x0, h0, x1, h1)"]),
        ("friction", ["contact_laws.friction: mapping", "contact_laws.friction.v0: number >= 0"]),
    ],
)  # fmt: skip
def test_word(word, told, trsim):
    code, out, err = trsim("explain", word)
    assert (code, err) == (0, "")
    for text in told:
        assert text in out
    assert max(map(len, out.splitlines())) <= 100


def test_all_words_are_listed_and_known(trsim, answer):
    _, out, _ = trsim("explain")
    words = out.replace("elements:", "").replace("sections:", "").replace("keys:", "").split()
    assert {*elements.ELEMENTS, "solver", "extends", "clearance", "friction"} <= set(words)
    assert {key["place"].split(".")[-1] for key in EVERYTHING["keys"]} <= set(words)
    _, document = answer("explain")
    assert document["word"] is None
    assert [page["word"] for page in document["elements"]] == list(elements.ELEMENTS)


def test_unknown_word(trsim):
    code, out, err = trsim("explain", "torsoin_spring")
    assert (code, out) == (2, "")
    assert "Did you mean 'torsion_spring'?" in err


@pytest.mark.parametrize(
    "rule, told",
    [
        ({"type": "number", "exclusiveMinimum": -1, "maximum": 0.5}, "number > -1, <= 0.5"),
        ({"anyOf": [{"type": "string"}, {"type": "null"}]}, "text"),
        ({"type": "array", "prefixItems": [{"type": "string"}] * 2}, "[text, text]"),
        ({}, "anything"),
    ],
)
def test_types_in_words(rule, told):
    assert worded(rule) == told


def test_every_function_and_every_key_of_tables_is_explained():
    assert {page["word"] for page in EVERYTHING["functions"]} == {*FUNCTIONS, *TABLE_KEYS}
