"""Flexible bars in motion: known answers, plane against space, methods, orders, energy."""

import numpy as np
import pytest

from trsim.assemble.assemble import assemble as assembled
from trsim.assemble.equations import derivative
from trsim.elements.scene import scene
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.start.consistent import start

from ..runs import assemble, energy_error, run, scenario
from ..test_scenarios import VALIDATION

PENDULUM = (VALIDATION / "beam_pendulum.yaml").read_text()
IN_SPACE = ("planar=false", "joints.pin.type=spherical")


def ahead(r):
    """How much longer the bar of the spin-up is, and how far its tip is ahead, as it turns, m."""
    along, across = np.cos(r["turned"]), np.sin(r["turned"])
    x, y = r["bar.tip"][:, 0], r["bar.tip"][:, 1]
    return along * x + across * y - 10.0, along * y - across * x


def test_spin_up():
    """Simo and Vu-Quoc, against 16 elements of an independent computation."""
    r = run((VALIDATION / "beam_spin_up.yaml").read_text())
    u1, u2 = ahead(r)
    lowest = np.argmin(u2)
    assert (u2[lowest], r.t[lowest]) == pytest.approx((-0.573776, 6.76), rel=2e-3)
    assert u1.min() == pytest.approx(-0.0188205, rel=5e-3)
    assert u1[r.t > 16].mean() == pytest.approx(6.0**2 * 1.2 * 10.0**3 / (3 * 2.8e7), rel=2e-3)
    assert np.abs(u2[r.t > 16]).max() == pytest.approx(0.003643, rel=5e-2)
    assert r["turned"][-1] == pytest.approx(75.0, abs=1e-9)
    assert energy_error(r) < 1e-5


def test_the_plane_is_the_space():
    tight = "solver.end=0.1", "solver.tolerance=1e-12", "solver.method=dop853"
    flat, deep = run(PENDULUM, *tight), run(PENDULUM, *tight, *IN_SPACE)
    assert flat.mechanism.planar and not deep.mechanism.planar
    for k in range(5):
        node = f"rope.node{k}.position"
        assert deep[node] == pytest.approx(flat[node], abs=1e-9)
    assert deep["pin.reaction"] == pytest.approx(flat["pin.reaction"], abs=1e-5)


@pytest.fixture(scope="module")
def swung():
    """The tip after 0.2 s."""
    r = run(PENDULUM, "solver.end=0.2", "solver.tolerance=1e-12", "solver.method=dop853")
    return r["rope.tip"][-1]


@pytest.mark.parametrize(
    ("method", "bound"),
    [
        ("method=dop853", 1e-8),
        ("method=auto", 1e-8),
        ("method=radau solver.formulation=index1", 1e-8),
        ("method=radau solver.formulation=ggl", 1e-8),
        ("method=generalized_alpha solver.tolerance=1e-5", 1e-4),
    ],
)
def test_methods_agree(method, bound, swung):
    sets = [f"solver.{word.removeprefix('solver.')}" for word in method.split()]
    r = run(PENDULUM, "solver.end=0.2", *sets)
    assert r["rope.tip"][-1] == pytest.approx(swung, abs=bound)
    assert energy_error(r) < bound


def test_order_of_rk4(swung):
    error = [
        np.abs(
            run(PENDULUM, "solver.end=0.2", "solver.method=rk4", f"solver.step={h}")["rope.tip"][-1]
            - swung
        ).max()
        for h in (4e-4, 2e-4)
    ]
    assert np.log2(error[0] / error[1]) == pytest.approx(4.0, abs=0.3)


@pytest.mark.parametrize("space", [(), IN_SPACE])
def test_damping_takes_energy_and_the_book_closes(space):
    r = run(PENDULUM, "bodies.rope.damping=2 ms", *space)
    work = r["energy.work.dampers"]
    assert np.all(np.diff(work) <= 0.0) and work[-1] < -1e-3
    assert energy_error(r) < 1e-7
    free = run(PENDULUM, *space)
    assert np.all(free["energy.work.dampers"] == 0.0)
    assert energy_error(free) < 1e-7


def test_a_damped_bar_that_only_turns_keeps_its_energy():
    """Damping sees strains, not turns."""
    text = """
bodies: {bar: {type: ancf_cable, start: [-0.5, 0], end: [0.5, 0], area: 1e-4, second_moment: 1e-9,
               youngs_modulus: 2e9, density: 1000, damping: 1 ms, angular_velocity: [0, 0, 3]}}
solver: {end: 1 s, tolerance: 1e-9}
"""
    r = run(text)
    stretched = 1000 * 9 / (2 * 2e9) * 0.25 / 2 * 1e-4 * 1e3  # J, far more than centrifugal strain
    assert 0.0 <= -r["energy.work.dampers"][-1] < stretched
    assert r["bar.angular_velocity"][-1] == pytest.approx([0, 0, 3], rel=1e-5)


CRANK = """
planar: true
bodies:
  crank:  {mass: 0.3, inertia: 1e-4, at: [0.025, 0]}
  rod:    {mass: 0.21, inertia: 2.52e-4, at: [0.11, 0], FLEXIBLE}
  slider: {mass: 0.14, inertia: 1e-4, at: [0.17, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  big_end: {type: revolute, bodies: [crank, rod], at: [0.05, 0]}
  pin:     {type: revolute, bodies: [rod, slider], at: [0.17, 0]}
  guide:   {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}
drives:
  motor: {joint: bearing, velocity: 60}
solver: {end: 0.1 s, tolerance: 1e-7}
output: {every: 1 ms}
"""
STEEL = "flexible: {elements: 2, section: {diameter: 12 mm}, youngs_modulus: 207 GPa}"


def test_a_stiff_rod_is_a_rigid_one():
    """Within its compliance: forces of inertia over EA / L, and their sag 5 q L^4 / 384 E I."""
    soft = STEEL.replace("207 GPa", "20.7 GPa")  # vibrates three times as slowly
    rigid, bent = run(CRANK.replace(", FLEXIBLE", "")), run(CRANK.replace("FLEXIBLE", soft))
    E, A, I, L = 20.7e9, np.pi / 4 * 0.012**2, np.pi / 64 * 0.012**4, 0.12
    w = 60.0**2 * 0.05
    shorter, sag = (0.14 + 0.21) * 2 * w * L / (E * A), 5 * 0.21 / L * w * L**4 / (384 * E * I)
    assert np.abs(bent["slider.position"] - rigid["slider.position"]).max() < 2 * shorter
    assert 0.2 * sag < bent["rod.deflection"].max() < 2.5 * sag
    assert energy_error(bent) < 1e-5
    # what vibrates in it stays about the reaction of the rigid one
    across = bent["guide.reaction"][:, 1] - rigid["guide.reaction"][:, 1]
    assert abs(across.mean()) < 0.05 * np.abs(rigid["guide.reaction"][:, 1]).max()


def test_bars_made_stiff_are_rigid_bodies():
    """The mechanism in which a start is looked for moves as the one drawn with rigid bars."""
    rates = []
    for text, stiff in ((CRANK.replace("FLEXIBLE", STEEL), True),
                        (CRANK.replace(", FLEXIBLE", ""), False)):  # fmt: skip
        mechanism = assembled(scenario(text), stiff=stiff)
        rigid = scenario(CRANK.replace(", FLEXIBLE", ""))
        y = start(rigid, assemble(rigid), located=True).y
        yd = np.zeros_like(y)
        derivative(scene(mechanism.model), 0.0, y, yd)
        rates.append(yd)
    assert rates[0] == pytest.approx(rates[1], rel=1e-9, abs=1e-9)


STRETCHED = """
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {width: 10 mm},
        youngs_modulus: 207e9, density: 7850}
  block: {mass: 1, inertia: 0.01, at: [1, 0]}
joints:
  A: {type: revolute, bodies: [ground, bar], at: [0, 0]}
  B: {type: revolute, bodies: [bar, block], at: [1, 0]}
  track: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
drives:
  stretch: {joint: track, velocity: "1e-3*min(t/1e-2, 1)"}
solver: {end: 20 ms, tolerance: 1e-4}
"""


def test_what_moves_only_because_a_bar_gives_way():
    """A rigid bar could not be stretched; the run does not start with rigid ones then."""
    r = run(STRETCHED)
    assert r["bar.node2.axial_force"][-1] == pytest.approx(207e9 * 1e-4 * 15e-6, rel=1e-3)
    assert r["stretch.force"][-1] == pytest.approx(207e9 * 1e-4 * 15e-6, rel=1e-3)


def test_waves_passed_over_are_told():
    slow = STRETCHED.replace("1e-3*min(t/1e-2, 1)", "1e-3*sin(3*t)").replace("20 ms", "1 s")
    told, followed = (
        run(slow, "solver.method=radau"),
        run(slow, "solver.max_step=2e-6", "solver.end=1e-3"),
    )
    said = [
        [d for d in doubts(r.scenario, r.mechanism, r.outcome) if "passed over" in d]
        for r in (told, followed)
    ]
    assert len(said[0]) == 1 and said[0][0].startswith("bodies.bar: steps of")
    assert said[1] == []
