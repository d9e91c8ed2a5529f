"""Spectral density: known powers, lines, intervals and signs of aliasing."""

from dataclasses import replace

import numpy as np
import pytest

from tests import small
from trsim.analyse.spectrum import beyond, of_channel, rate, sampling, spectrum
from trsim.analyse.window import Window, window
from trsim.errors import UsageError
from trsim.store.read import read

RATE = 1000.0  # Hz
t = np.arange(20_000) / RATE


def noise(n=20_000, seed=0):
    return np.random.default_rng(seed).standard_normal(n)


def test_density_of_white_noise():
    """Variance 9 over 500 Hz: 3 / sqrt(500) everywhere."""
    found = spectrum(t, 3.0 * noise())
    assert np.mean(found.density[5:-5] ** 2) == pytest.approx(9.0 / 500.0, rel=0.03)
    assert found.rms == pytest.approx(3.0, rel=0.03)
    assert found.nyquist == pytest.approx(500.0)
    assert found.segments == 8


def test_interval_covers_the_true_density():
    true = 1.0 / np.sqrt(500.0)
    inside = []
    for seed in range(30):
        found = spectrum(t[:4000], noise(4000, seed))
        d = found.density[3:-3]
        inside.append(np.mean((d * found.low <= true) & (true <= d * found.high)))
    print(f"covers {np.mean(inside):.3f}, 0.95 expected")
    assert 0.93 <= np.mean(inside) <= 0.97


@pytest.mark.parametrize("frequency", [50.0, 123.4, 311.7])
def test_a_line_has_its_frequency_and_amplitude(frequency):
    x = 2.5 * np.cos(2 * np.pi * frequency * t) + 0.05 * noise()
    found = spectrum(t, x)
    peak = found.peaks[0]
    assert peak.frequency == pytest.approx(frequency, abs=0.2 * found.resolution)
    assert peak.amplitude == pytest.approx(2.5, rel=0.03)
    assert found.resolution == pytest.approx(1.5 * RATE / 4444, rel=1e-3)


@pytest.mark.parametrize("frequency", [37.3, 41.25, 111.1, 217.05])
def test_a_line_between_two_frequencies_has_its_amplitude(frequency):
    """Up to half a bin of 2.25 Hz away; a parabola through the decibels would be 3 % out."""
    few = t[:4000]
    peak = spectrum(few, 0.010 * np.sin(2 * np.pi * frequency * few)).peaks[0]
    assert peak.amplitude == pytest.approx(0.010, rel=1e-3)
    assert peak.frequency == pytest.approx(frequency, abs=1e-3)


def test_a_straight_line_is_no_oscillation():
    found = spectrum(t, 5.0 + 3.0 * t)
    assert found.rms < 1e-10


def test_what_is_slower_than_a_segment_is_lacking():
    """A sine of 2.5 periods: 8 segments, each of half a period, hold a twentieth of its power."""
    x = np.sin(2 * np.pi * t / 8.0)
    found = spectrum(t, x)
    assert found.length == pytest.approx(4.444)
    assert found.bent == pytest.approx(np.std(x), rel=0.1)
    assert found.lacks == pytest.approx(1.0 - (found.rms / found.bent) ** 2)
    assert found.lacks > 0.7 and not found.sloped
    once = spectrum(t, x, 1)
    assert once.lacks < 0.2
    for all_of_it in (noise(), np.sin(2 * np.pi * t), np.full(len(t), 1e5), 5.0 + noise()):
        assert not spectrum(t, all_of_it).lacks
    ramp = spectrum(t, 5.0 + 3.0 * t + noise())
    assert ramp.sloped and not ramp.lacks
    assert not spectrum(t, 0.1 * t + noise()).lacks


def test_what_goes_on_beyond_nyquist_is_told():
    assert "folded back" in spectrum(t, noise()).warnings[0]
    slow = np.convolve(noise(), np.hanning(41) / np.hanning(41).sum(), "same")
    assert spectrum(t, slow).warnings == ()


def test_too_little_is_refused():
    with pytest.raises(UsageError, match="too few"):
        spectrum(t[:60], t[:60])
    with pytest.raises(UsageError, match="evenly spaced"):
        sampling(np.array([0.0, 1.0, 2.0, 3.5]))
    with pytest.raises(UsageError, match="fewer than two"):
        sampling(np.array([1.0]))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("spectrum") / "run.h5"
    small.run(path)
    return read(path)


def test_channel_of_a_run(run):
    found = of_channel(run, "crank_angle.rate", window(run))
    assert found.nyquist == pytest.approx(50e3)
    with pytest.raises(UsageError, match=r"B\.contact_force: .* too few"):
        of_channel(run, "B.contact_force", window(run, "0..1e-4"))


def test_extremes_between_the_rows_are_told(run):
    """A contact force rises and falls between rows that are far apart."""
    x = run.channel("B.contact_force")
    [peak] = [p for p in run.peaks if p[:2] == ("B.contact_force", "largest")]
    whole = Window(0.0, 1.0)
    sparse = x[x < 0.5 * peak.value]
    share = (peak.value - sparse.max()) / np.ptp(sparse)
    assert beyond(run, "B.contact_force", whole, sparse) == pytest.approx(share)
    assert share > 0.1
    assert beyond(run, "B.contact_force", Window(0.0, 0.5 * peak.time), sparse) == 0.0


def test_time_has_no_spectrum(run):
    with pytest.raises(UsageError, match="time has no spectrum"):
        of_channel(run, "time", window(run))


def test_one_row_is_too_few(run):
    one = replace(run, rows=1)
    with pytest.raises(UsageError, match="fewer than two rows"):
        of_channel(one, "stroke", window(one))


SHAKEN = """
bodies: {m: {mass: 1, inertia: 1}}
joints: {g: {type: prismatic, bodies: [ground, m], axis: [1, 0, 0]}}
drives: {d: {joint: g, position: "0.01*sin(2*pi*900*t) + 0.002*sin(2*pi*70*t)"}}
sensors: {s: {joint: g}}
solver: {end: 1, tolerance: 1e-8}
"""


@pytest.mark.parametrize("every", ["1 ms", "0.3 ms"])
def test_a_pure_tone_beyond_nyquist_is_told_by_its_rate(every, tmp_path):
    """900 Hz in rows of 1 kHz is a line at 100 Hz; 70 Hz beside it is right."""
    small.run(tmp_path / "run.h5", f"output.every={every}", text=SHAKEN)
    shaken = read(tmp_path / "run.h5")
    folded = every == "1 ms"
    for channel in ("s", "s.rate", "m.position.x", "m.velocity.x", "d.position"):
        found = of_channel(shaken, channel, window(shaken))
        line = found.peaks[0].frequency
        assert line == pytest.approx(100.0 if folded else 900.0, abs=0.5)
        told = [f"the line at {line:.5g} Hz was folded back from beyond 500 Hz: "] * folded
        assert [text[: len(told[0])] for text in found.warnings] == told
        assert all(f"goes with {900:.4g} Hz" in text for text in found.warnings)


def test_the_rate_of_a_channel(run):
    assert rate(run, "stroke") == "stroke.rate"
    assert rate(run, "stroke.rate") == "stroke.acceleration"
    assert rate(run, "B.eccentricity_x") == "B.eccentricity_x_rate"
    assert rate(run, "rod.velocity.y") == "rod.acceleration.y"
    assert rate(run, "rod.acceleration.y") == rate(run, "B.contact_force") == ""
