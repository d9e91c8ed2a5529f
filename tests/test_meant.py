"""What a text that is no unit probably means, and that a guess is never of another size."""

import pytest

from trsim.errors import ScenarioError
from trsim.numbers import number
from trsim.units import BASE, DERIVED, KINDS, UnitError, unit


def hint(text, *wanted):
    with pytest.raises(ScenarioError) as caught:
        number(f"2 {text}", wanted or ("-",))
    return caught.value.hint


@pytest.mark.parametrize(
    "text, wanted, ours",
    [
        ("kgm2", "kg*m^2", "kg*m^2"),
        ("kgm^2", "kg*m^2", "kg*m^2"),
        ("kg m^2", "kg*m^2", "kg*m^2"),
        ("kg.m2", "kg*m^2", "kg*m^2"),
        ("kg-m2", "kg*m^2", "kg*m^2"),
        ("kgmm2", "kg*m^2", "kg*mm^2"),
        ("Nms2", "kg*m^2", "N*m*s^2"),  # and not N*ms^2, which is no inertia
        ("Nm", "N*m", "N*m"),
        ("Nmm", "N*m", "N*mm"),
        ("kNm", "N*m", "kN*m"),
        ("N m", "N*m", "N*m"),
        ("NM", "N*m", "N*m"),
        ("ft-lb", "N*m", "ft*lbf"),  # a pound in it is a force
        ("Nm/rad", "N*m/rad", "N*m/rad"),
        ("Nm/deg", "N*m/rad", "N*m/deg"),
        ("Nms/rad", "N*m*s/rad", "N*m*s/rad"),
        ("Ns/mm", "N*s/m", "N*s/mm"),
        ("kN/M", "N/m", "kN/m"),
        ("Nm^-1", "N/m", "N/m"),
        ("N per mm", "N/m", "N/mm"),
        ("m/s2", "m/s^2", "m/s^2"),
        ("ms-2", "m/s^2", "m/s^2"),
        ("m/sec^2", "m/s^2", "m/s^2"),
        ("rad/(sec)", "rad/s", "rad/s"),
        ("RPM", "rad/s", "rpm"),
        ("degrees", "rad", "deg"),
        ("Degs", "rad", "deg"),
        ("millimetres", "m", "mm"),
        ("inches", "m", "in"),
        ("MM", "m", "mm"),
        ("Kg", "kg", "kg"),
        ("lbs", "kg", "lb"),
        ("pounds", "kg", "lb"),
        ("pounds", "N", "lbf"),
        ("kilonewtons", "N", "kN"),
        ("tonnes", "kg", "t"),
        ("secs", "s", "s"),
        ("milliseconds", "s", "ms"),
        ("mpa", "N/m^2", "MPa"),
        ("dge", "rad", "deg"),
        ("kg/m3", "kg/m^3", "kg/m^3"),
        ("g/cm3", "kg/m^3", "g/cm^3"),
    ],
)
def test_what_was_meant(text, wanted, ours):
    assert hint(text, wanted).startswith(f"Did you mean '{ours}'?")
    assert number(f"2 {ours}", (wanted,)) > 0.0


def test_without_what_is_wanted():
    with pytest.raises(UnitError) as caught:
        unit("kgm2")
    assert caught.value.hint.startswith("Did you mean 'kg*m^2'?  Known: m, kg, s")


@pytest.mark.parametrize("text, wanted", [("mg", "kg"), ("nn", "N"), ("kk", "kg"), ("q", "m")])
def test_no_guess(text, wanted):
    """By the nearest letters mg would be kg."""
    assert "Did you mean" not in hint(text, wanted)


def test_what_else_there_is():
    assert hint("mg", "kg") == "This number is a mass, in kg.  Known: kg, g, t, lb."
    assert hint("q", "rad").endswith("Known: rad, mrad, deg, °, rev, turn.")
    assert hint("Nm", "kg").startswith("'N*m' is a torque or an energy.  This number is a mass")
    assert "Known" not in hint("q", "N*m/rad")


WAYS = (
    lambda text: text.replace("*", ""),
    lambda text: text.replace("*", "").replace("^", ""),
    lambda text: text.replace("*", "."),
    lambda text: text.replace("*", " "),
    lambda text: text.replace("*", " · "),
    lambda text: text.replace("*", "-").replace("^", ""),
    lambda text: text.replace("s", "sec"),
)
LARGE = {"m": "mm", "kg": "t", "N": "kN", "s": "ms", "rad": "deg"}
WRITTEN = [text for text in KINDS if text not in ("-", "W", "1/s")]
WRITTEN += ["*".join(LARGE.get(w, w) for w in text.split("*")) for text in WRITTEN]


@pytest.mark.parametrize("text", dict.fromkeys(WRITTEN))
@pytest.mark.parametrize("way", range(len(WAYS)))
def test_a_guess_has_the_size_that_was_written(text, way):
    """Every kind of number in the ways people write it: where something is guessed it is that."""
    other = WAYS[way](text)
    if other == text:
        return
    try:
        assert unit(other) == unit(text)
    except ScenarioError:
        guess = hint(other, text).split("'")
        assert guess[0] == "Did you mean " and unit(guess[1]) == unit(text), (other, guess)


def test_nothing_hangs():
    for text in ("m" * 39, "Nm" * 19, "kg" * 12 + "^2", "x" * 500, "s-" * 15, "(" * 30):
        with pytest.raises(ScenarioError):
            number(f"2 {text}", ("kg*m^2",))


def test_every_word_is_a_unit():
    for word in (*BASE, *DERIVED):
        assert unit(word)[0] > 0
