"""`trsim show FILE WORD...`: a number a line, for scripts."""

import numpy as np
import pytest

from tests import small
from trsim.store.read import read

PENDULUM = """\
title: Turning disc
bodies: {disc: {mass: 2, inertia: 0.5, at: [0.2, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, disc], at: [0, 0]}}
drives: {motor: {joint: hinge, velocity: 30 rpm}}
sensors: {turned: {joint: hinge}}
solver: {end: 2 s, tolerance: 1e-9}
output: {every: 10 ms}
"""


@pytest.fixture
def disc(tmp_path, monkeypatch):
    """A disc that turns at pi rad/s for two seconds."""
    monkeypatch.chdir(tmp_path)
    small.run(tmp_path / "x.h5", text=PENDULUM)
    return tmp_path / "x.h5"


def test_a_number_with_its_unit(disc, trsim):
    code, out, _ = trsim("show", disc, "final:turned")
    value, unit = out.split()
    assert (code, unit) == (0, "rad")
    assert float(value) == float(read(disc).channel("turned")[-1])  # to the last bit
    assert float(value) == pytest.approx(2.0 * np.pi, rel=1e-7)


def test_in_a_unit_the_number_stands_alone(disc, trsim):
    for unit, wanted in (("rpm", 30.0), ("deg/s", 180.0), ("rad/s", np.pi)):
        code, out, _ = trsim("show", disc, "mean:turned.rate", "--unit", unit)
        assert code == 0
        assert float(out) == pytest.approx(wanted, rel=1e-9)


def test_a_line_for_each_of_several(disc, trsim):
    words = ("peak:turned@0.5..1", "least:disc.position.x", "final:disc.position.y", "summary:rows")
    code, out, _ = trsim("show", disc, *words)
    values = [line.split() for line in out.splitlines()]
    assert code == 0
    assert [unit for _, unit in values[:3]] == ["rad", "m", "m"]
    assert values[3] == ["201"]  # without a unit
    found = [float(value) for value, _ in values[:3]]
    np.testing.assert_allclose(found, [np.pi, -0.2, 0.0], atol=1e-7)


def test_each_takes_the_unit_of_its_kind(disc, trsim):
    words = ("final:turned", "least:disc.position.x")
    code, out, _ = trsim("show", disc, *words, "--unit", "mm", "--unit", "deg")
    assert code == 0
    np.testing.assert_allclose([float(x) for x in out.split()], [360.0, -200.0], rtol=1e-6)


def test_document(disc, answer):
    code, document = answer("show", disc, "final:turned", "--unit", "deg")
    [value] = document["values"]
    assert (code, value["what"], value["unit"]) == (0, "final:turned", "deg")
    assert value["value"] == pytest.approx(360.0, rel=1e-7)
    assert document["rows"] == 201


@pytest.mark.parametrize(
    "words, what, hint",
    [
        (("turned",), "'turned' does not say which number", "peak:turned"),
        (("trned",), "no number of a run: 'trned'", "KIND:OF"),
        (("peek:turned",), "no number of a run", "Did you mean 'peak'?"),
        (("max:turned",), "no number of a run: 'max:turned'", "Write peak:turned."),
        (("min:turned@0..1",), "no number of a run", "Write least:turned@0..1."),
        (("peak:trned",), "no channel named 'trned'", "Did you mean 'turned'?"),
        (("final:disc.position",), "3 components", "'disc.position.x'"),
        (("final:turned", "--unit", "mm"), "'mm' is no unit of final:turned", "rad"),
        (("final:turned", "--unit", "dge"), "unknown unit 'dge'", "Did you mean 'deg'?"),
        (
            ("final:turned", "summary:time", "--unit", "deg"),
            "'deg' is no unit of summary:time",
            "in s",
        ),
        (("--unit", "deg"), "--unit goes with a number", "peak:"),
    ],
)
def test_wrong_words(words, what, hint, disc, trsim):
    code, out, err = trsim("show", disc, *words)
    assert (code, out) == (2, "")
    assert what in err and hint in err, err


def test_no_number_is_said(tmp_path, trsim):
    """The play of a pin that never leaves its bearing for a second time has no mean between."""
    small.run(tmp_path / "x.h5", "solver.end=1e-5")
    code, out, err = trsim("show", tmp_path / "x.h5", "between:B")
    assert (code, out.split()) == (0, ["nan", "s"])
    assert "nothing to make it of" in err


def test_rounding_of_a_conversion_is_not_printed(disc, trsim):
    """60 deg is 1.0471975511965976 rad, and that 59.99999999999999 deg."""
    from math import pi

    from trsim.analyse.outputs import in_units

    value, _ = in_units("x", (pi / 3.0, "rad"), ("deg",))
    assert repr(value) != "60.0"
    small.run(disc.parent / "y.h5", "drives.motor.velocity=30 deg/s", text=PENDULUM)
    code, out, _ = trsim("show", disc.parent / "y.h5", "final:turned", "--unit", "deg")
    assert (code, out) == (0, f"{float(out):.15g}\n")
    assert float(out) == pytest.approx(60.0, rel=1e-7)


def test_the_reaction_of_a_pin_with_play_in_a_plane_is_its_contact_force(tmp_path, trsim):
    small.run(tmp_path / "x.h5")
    words = {"peak:B.reaction": True, "peak:|B.reaction|@0..": True, "peak:B.contact_force": False}
    for word, told in words.items():
        code, _, err = trsim("show", tmp_path / "x.h5", word)
        assert code == 0
        assert ("B.contact_force is the force in that pin" in err) is told
