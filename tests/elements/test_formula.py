"""Formulas of sensors: values and rates, in loads, events and portraits."""

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, USER

from ..runs import built, energy_error, run

SPRUNG = """
bodies: {block: {mass: 2, inertia: 1, velocity: [1, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
sensors:
  x: {joint: rail}
  v: {type: point_velocity, body: block, at: [0, 0], axis: [1, 0]}
  side: {type: reaction, joint: rail, axis: [0, 1]}
  all: {type: energy}
  kin: {type: energy, of: kinetic}
  two: {type: formula, value: "2*x + 0.3*t", unit: m}
  sum: {type: formula, value: "two**2 + sin(3*x)"}
  ratio: {type: formula, value: "side/(1 + v**2)", unit: N}
  share: {type: formula, value: kin/all}
forces:
  spring: {type: applied_load, body: block, direction: [1, 0], force: -50*x}
  press: {type: applied_load, body: block, direction: [0, -1], force: "5*max(0, bent)"}
gravity: [0, -10]
solver: {end: 2, tolerance: 1e-10}
output: {every: 0.01}
"""
TEXT = SPRUNG.replace("  two:", "  bent: {type: formula, value: x - 0.1}\n  two:")


def test_values_and_rates():
    r = run(TEXT)
    x = 0.2 * np.sin(5 * r.t)
    v = np.cos(5 * r.t)
    assert r["two"] == pytest.approx(2 * x + 0.3 * r.t, abs=1e-8)
    assert r["two.rate"] == pytest.approx(2 * v + 0.3, abs=1e-7)
    assert r["sum"] == pytest.approx(r["two"] ** 2 + np.sin(3 * r["x"]), abs=1e-12)
    press = 5 * np.maximum(0, x - 0.1)
    assert r["press.magnitude"] == pytest.approx(press, abs=1e-8)
    assert r["ratio"] == pytest.approx((20 + press) / (1 + v**2), abs=1e-6)
    assert r["kin"] == pytest.approx(r["energy.kinetic"], rel=1e-12)
    assert r["all"] == pytest.approx(
        r["energy.kinetic"] + r["energy.stored.springs"] + r["energy.stored.gravity"], abs=1e-12
    )
    assert r["share"] == pytest.approx(r["kin"] / r["all"], rel=1e-12)
    units = {c.name: c.unit for c in r.mechanism.columns}
    assert (units["two"], units["two.rate"], units["ratio"]) == ("m", "m/s", "N")
    assert "ratio.rate" not in units and "sum.rate" not in units
    assert energy_error(r) < 1e-8


def test_rates_of_sensors_stand_in_formulas():
    """In a load, too: a damper that is stiffer the farther it is out."""
    slow = '{type: formula, value: "abs(x - 0.1)*x.rate", unit: m^2/s}'
    text = TEXT.replace("  bent:", f"  slow: {slow}\n  bent:")
    one = run(text.replace("-50*x", "-50*x - 8*slow"))
    two = run(TEXT.replace("-50*x", "-50*x - 8*abs(x - 0.1)*x.rate"))
    assert one["slow"] == pytest.approx(np.abs(one["x"] - 0.1) * one["x.rate"], abs=1e-12)
    assert one["slow"].max() > 0.05 and "slow.rate" not in {c.name for c in one.mechanism.columns}
    assert np.array_equal(one["x"], two["x"])


def test_what_is_only_looked_at_changes_no_step():
    bare = "\n".join(
        line for line in TEXT.splitlines()
        if not any(word in line for word in ("two", "ratio", "share", "energy", "reaction"))
    )  # fmt: skip
    one, two = run(TEXT), run(bare)
    assert np.array_equal(one["block.position"], two["block.position"])
    assert one.outcome.statistics["steps"] == two.outcome.statistics["steps"]


def test_a_load_by_a_formula_is_the_load_with_its_expression():
    written = TEXT.replace("max(0, bent)", "max(0, x - 0.1)")
    one, two = run(TEXT), run(written)
    assert np.array_equal(one["press.magnitude"], two["press.magnitude"])
    assert one.outcome.statistics["steps"] == two.outcome.statistics["steps"]


def test_what_a_formula_reads_is_measured_whoever_asks():
    r = run(TEXT.replace("every: 0.01}", "every: 0.01, channels: [ratio]}"))
    full = run(TEXT)
    assert np.array_equal(r["ratio"], full["ratio"])
    wanted = {c.name for c in r.mechanism.columns if c.wanted}
    assert wanted == {"ratio"} | {n for n in wanted if n.startswith("energy.")}


def test_in_events_and_portraits():
    more = (
        "events: {half: {when: share, value: 0.5, crosses: down, times: 1, do: {record: true}}}\n"
    )
    more += "phase_portraits: {p: {x: ratio, y: sum}}\n"
    text = TEXT.replace("-50*x}", "0}").replace("0.01}", "0.01}\n" + more)
    text = text.replace("forces:", "forces:\n  s: {type: spring_damper, bodies: [ground, block], "
                        "points: [[-1, 0], [0, 0]], stiffness: 50}")  # fmt: skip
    r = run(text)
    times = r.events[r.events[:, EVENT_KIND] == USER][:, EVENT_TIME]
    assert times == pytest.approx([np.pi / 4 / 5], abs=1e-7)


@pytest.mark.parametrize(
    "old, new, path, what",
    [
        ('"2*x + 0.3*t"', "2", ("sensors", "two", "value"), "is an expression"),
        ('"2*x + 0.3*t"', "sum + x", None, "refers to itself|stands behind"),
        ('"2*x + 0.3*t"', "two + x", None, "refers to itself|stands behind"),
        ('"2*x + 0.3*t"', "2*y", ("sensors", "two", "value"), "no parameter or sensor named 'y'"),
        ("unit: m}", "unit: mm}", ("sensors", "two", "unit"), "no SI unit"),
        ("unit: m}", "unit: bananas}", ("sensors", "two"), "unit"),
        ("-50*x", "-50*ratio", None, "known only once"),
        ("-50*x", "{table: [[0, 1], [1, 2]], of: bent}", None, "neither a table nor a rate"),
        ("-50*x", "-50*bent.rate", None, "neither a table nor a rate"),
        ('"2*x + 0.3*t"', "2*v.rate", ("sensors", "two", "value"), "no place and no angle"),
        ('"2*x + 0.3*t"', "2*bent.rate", ("sensors", "two", "value"), "no place and no angle"),
    ],
)
def test_refused(old, new, path, what):
    assert old in TEXT
    with pytest.raises(TrsimError, match=what) as caught:
        built(TEXT.replace(old, new))
    [error] = caught.value.problems
    assert path is None or error.path[: len(path)] == path


def test_a_load_by_a_formula_of_itself():
    text = TEXT.replace("x - 0.1}", "bent - 0.1}")
    with pytest.raises(TrsimError, match="refers to itself: bent -> bent"):
        built(text)


@pytest.mark.parametrize("value", ["1/x", "x/x", "log(x)", "sqrt(-1 - x)"])
def test_no_number_at_the_start_is_refused(value):
    with pytest.raises(TrsimError, match="no finite number at the start") as caught:
        run(TEXT.replace("2*x + 0.3*t", value))
    [error] = caught.value.problems
    assert error.path == ("sensors", "two")


@pytest.mark.parametrize("method", ["dop853", "radau", "rk4, step: 1e-3", "scipy:RK45"])
def test_no_number_later_ends_the_run_and_is_named(method):
    text = TEXT.replace("2*x + 0.3*t", "1/(t - 0.5)").replace(
        "tolerance: 1e-10", f"method: {method}"
    )
    r = run(text, fails=True)
    assert "sensor 'two' shows no finite number" in r.outcome.reason
    assert r.t[-1] < 0.5
    assert run(text.replace("t - 0.5", "t - 3.5"), fails=False).outcome.status == "done"
