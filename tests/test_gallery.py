"""The mechanisms of the gallery against closed forms, or against an integration of their own."""

from math import cos
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipk

from trsim.scenario.load import load

from .runs import run

GALLERY = Path(__file__).parents[1] / "scenarios" / "gallery"
g = 9.81


def go(name, *sets):
    return run(load(GALLERY / f"{name}.yaml", [*sets]))


def told(name, *numbers):
    """Whether the first line of a scenario says these numbers."""
    line = (GALLERY / f"{name}.yaml").read_text().splitlines()[0]
    return [number for number in numbers if number not in line] == []


def test_pendulum():
    r = go("pendulum", "solver.tolerance=1e-10")
    small = 2 * np.pi / np.sqrt(1.5 * g / 1.0)  # a rod about its end: m l^2/3, m g l/2
    period = small * 2 / np.pi * ellipk(np.sin(np.deg2rad(30)) ** 2)
    assert told("pendulum", f"{period:.4f}", f"{small:.4f}")
    down = np.flatnonzero((r["angle"][:-1] > 0) & (r["angle"][1:] <= 0))
    passes = [np.interp(0.0, -r["angle"][k : k + 2], r.t[k : k + 2]) for k in down]
    assert passes == pytest.approx([period / 4 + k * period for k in range(3)], abs=1e-5)


def test_pendulum_from_several_angles():
    """From rest to the lowest place: w^2 = 3 g (1 - cos)/l, and m w^2 l/2 is carried."""
    weight = 2.0 * g
    ends = [weight * (1 + 1.5 * (1 - np.cos(np.deg2rad(angle)))) for angle in (10, 170)]
    assert told("sweep", *(f"{end:.2f}" for end in ends))
    sweep = load(GALLERY / "sweep.yaml").sweep
    assert sweep["initial.pivot"] == "lin(10 deg, 170 deg, 9)"
    for angle, end in zip((10, 170), ends, strict=True):
        r = go("sweep", f"initial.pivot={angle}deg")
        carried = np.linalg.norm(r["pivot.reaction"], axis=1).max()
        assert carried == pytest.approx(end, rel=2e-3)  # rows are 10 ms apart


def pen(turn):
    """The coupler point of a four-bar after Hoeken (crank a, frame 2 a, all else 2.5 a)."""
    a, B = 0.05, 0.05 * np.exp(1j * turn)
    diagonal = 2 * a - B
    half = np.sqrt((2.5 * a) ** 2 - abs(diagonal) ** 2 / 4)
    return B + diagonal + 2j * half * diagonal / abs(diagonal)  # B + 2 (C - B)


def test_four_bar():
    r = go("four_bar", "solver.tolerance=1e-9")
    path = pen(np.pi + 2 * np.pi * r.t)
    assert r["pen.position"][:, 0] == pytest.approx(path.real, abs=1e-8)
    assert r["pen.position"][:, 1] == pytest.approx(path.imag, abs=1e-8)
    half = pen(np.linspace(np.pi / 2, 3 * np.pi / 2, 2001))
    assert told(
        "four_bar", f"{1e3 * np.ptp(half.imag):.3f} mm", f"{1e3 * np.ptp(half.real):.0f} mm"
    )


def test_slider_crank():
    r = go("slider_crank", "solver.tolerance=1e-9")
    turn, w = r["turn"], 20 * np.pi
    assert turn == pytest.approx(w * r.t, abs=1e-7)
    x = 0.05 * np.cos(turn) + np.sqrt(0.15**2 - (0.05 * np.sin(turn)) ** 2)
    assert r["slider.position"][:, 0] == pytest.approx(x, abs=1e-8)
    most = 0.05 * w**2 * (1 + 1 / 3)
    assert told("slider_crank", f"{most:.1f} m/s^2")
    assert r["slider.acceleration"][:, 0].min() == pytest.approx(-most, rel=1e-6)


def test_slider_crank_with_clearance():
    """A pin that is off by e moves the slider by e along the rod over the cosine of the rod."""
    r = go("slider_crank_clearance")
    turn = r["turn"]
    x = 0.05 * np.cos(turn) + np.sqrt(0.15**2 - (0.05 * np.sin(turn)) ** 2)
    off = r["slider.position"][:, 0] - x
    deep = max(r["pin.penetration"].max(), 0.0)
    steep = np.cos(np.arcsin(0.05 / 0.15))
    assert deep < 0.025e-3
    assert np.abs(off).max() < (0.5e-3 + deep) / steep < 0.56e-3
    assert off.min() < -0.45e-3 and off.max() > 0.45e-3  # it uses its play to both sides
    assert told("slider_crank_clearance", "0.55 mm")


def test_gear_pair():
    """On its pitch line the wheel goes as far as the pinion less the backlash."""
    r = go("gear_pair")
    late = r.t > 1.0
    lost = np.rad2deg((2 * np.deg2rad(10) * 0.02 - 0.5e-3) / 0.06)
    assert told("gear_pair", f"{lost:.2f}")
    # at the end of each push the pinion slows down faster than the brake: the wheel coasts on
    w, rate = 2 * np.pi, 0.5 / 2e-3
    left = np.arctan(w / rate)
    coasts = np.deg2rad(10) / 3 * (w * np.sin(left) / rate - (1 - np.cos(left)))
    want = np.deg2rad(lost) + 2 * coasts
    assert coasts < 2e-5
    assert np.ptp(r["wheel_angle"][late]) == pytest.approx(want, abs=2e-6)
    tight = go("gear_pair", "forces.teeth.backlash=0")
    assert np.rad2deg(np.ptp(tight["wheel_angle"][late])) == pytest.approx(20 / 3, abs=1e-3)


def test_scotch_yoke():
    r = go("scotch_yoke", "solver.tolerance=1e-9")
    turn, w = 10 * np.pi * r.t, 10 * np.pi
    assert r["yoke.position"][:, 0] == pytest.approx(0.05 * np.cos(turn), abs=1e-8)
    most = 2.0 * 0.05**2 * w**2 / 2
    assert told("scotch_yoke", f"{most:.3f} N*m")
    assert r["motor.force"] == pytest.approx(most * np.sin(2 * turn), abs=1e-5)


def test_washing_machine():
    """Above resonance: m e w^2 over |K - M w^2 + i C w|, of four struts at 45 degrees."""
    r = go("washing_machine")
    w = 125.664
    shake = 4 * 0.025 * w**2 / abs(2 * 8000 - 40 * w**2 + 2 * 150j * w)
    assert told("washing_machine", f"{1e3 * shake:.3f} mm", "2.5 mm")
    late = r.t > 5.5
    # a row lies within 1 ms of each extreme; struts turn by 2.6 mm in 410 mm, to the second order
    between = 1 - np.cos(w * 1e-3)
    for name in ("shake", "sway"):
        assert np.ptp(r[name][late]) / 2 == pytest.approx(shake, rel=between + 2e-3)
    assert np.abs(r["shake"]).max() > 1.5 * shake  # on its way through resonance


def test_toggle_clamp():
    """Virtual work: the torque of the hand times its turn is the force of the pad times its way."""
    r = go("toggle_clamp")
    length, k = 0.1, 1e6
    a0, a = np.deg2rad(10), np.deg2rad(10 - 12 * r.t)
    way = 2 * length * (np.cos(a) - np.cos(a0))
    assert r["stroke"] == pytest.approx(way, abs=1e-9)
    assert np.abs(r["pad.force"]) == pytest.approx(k * way, abs=1e-3)
    torque = 2 * length * np.sin(a) * k * way
    assert r["hand.force"] == pytest.approx(torque, abs=1e-4)
    assert told("toggle_clamp", f"{k * 2 * length * (1 - np.cos(a0)):.0f} N", f"{torque.max():.1f}")
    assert r["hand.force"][-1] < -10.0  # beyond the line it holds itself


def test_crane():
    """In the axes of the trolley the load swings about atan(a/g), from where it hangs."""
    r = go("crane", "solver.tolerance=1e-10")
    middle, pull = np.arctan(1 / g), np.hypot(1, g)
    most = 100 * pull * (3 - 2 * np.cos(middle))
    assert told("crane", f"{np.rad2deg(2 * middle):.3f}", f"{most:.1f} N")
    swing = solve_ivp(lambda _, y: [y[1], -pull / 4 * np.sin(y[0] - middle)], (0, 4), [0.0, 0.0],
                      t_eval=r.t, rtol=1e-11, atol=1e-12).y  # fmt: skip
    assert r["swing"] == pytest.approx(swing[0], abs=1e-7)
    tension = 100 * (pull * np.cos(swing[0] - middle) + 4 * swing[1] ** 2)
    assert r["rope.tension"] == pytest.approx(tension, rel=1e-6)


def test_door_closer():
    """A linear equation until the door is shut: the roots of I s^2 + c s + k."""
    r = go("door_closer", "solver.tolerance=1e-10")
    inertia, c, k, rest = 2 + 30 * 0.4**2, 25.0, 4.0, -3.0 / 4.0
    slow, fast = sorted(np.roots([inertia, c, k]), reverse=True)

    def opening(t, n=0):
        start = np.pi / 2 - rest
        both = fast * slow**n * np.exp(slow * t) - slow * fast**n * np.exp(fast * t)
        return (rest if n == 0 else 0.0) + start * both / (fast - slow)

    shut = brentq(opening, 1.0, 9.0)
    assert told("door_closer", f"{shut:.3f} s", f"{-np.rad2deg(opening(shut, 1)):.2f} deg/s")
    open_ = r.t < shut - 0.02
    assert r["opening"][open_] == pytest.approx(opening(r.t[open_]), abs=1e-7)
    assert r["opening"][r.t > shut + 0.5] == pytest.approx(0.0, abs=1e-3)


def test_vibratory_feeder():
    """Newton's law along the tray, with the same friction, by another program."""
    tilt, A, w, mu, v1 = np.deg2rad(20), 1e-3, 50 * np.pi, 0.3, 5e-3

    down, along = float(np.sin(tilt)), float(np.cos(tilt))

    def rates(t, y):
        push = A * w**2 * cos(w * t)
        rubs = mu * (g + push * down) * max(-1.0, min(1.0, y[1] / v1))
        return [y[1], -push * along - rubs]

    own = solve_ivp(rates, (0, 1), [0, 0], method="LSODA", rtol=1e-9, atol=1e-12, max_step=5e-4)
    assert told("vibratory_feeder", f"{1e3 * own.y[0, -1]:.1f} mm")
    r = go("vibratory_feeder")
    assert r["way"][-1] == pytest.approx(own.y[0, -1], rel=1e-4)
    assert r["way.rate"][-1] == pytest.approx(own.y[1, -1], abs=1e-4)
