"""Link: a pendulum on a rod without mass, a connecting rod, its force and its length."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run

SPACES = ["true", "false"]
BOB = """
planar: {planar}
bodies:
  bob: {{mass: 2, inertia: [0.01, 0.01, 0.01], at: [{x}, -0.3], angle: 1, velocity: [1, 0]}}
joints: {{rod: {{type: link, bodies: [ground, bob], points: [[{o}, 0.1], [{x}, -0.3]]}}}}
gravity: [0, -9.81, 0]
solver: {{end: 3, tolerance: 1e-10{solver}}}
output: {{every: 0.01, channels: ["*"]}}
"""


@pytest.mark.parametrize("planar", SPACES)
@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_a_pendulum(planar, method):
    """The rod pulls with m v^2/l + m g cos(angle), along itself, and turns nothing."""
    o = 2e3
    r = run(BOB.format(planar=planar, o=o, x=o + 0.3, solver=f", method: {method}"))
    assert r.mechanism.planar == (planar == "true")
    d = r["bob.position"] - [o, 0.1, 0]
    assert np.linalg.norm(d, axis=1) == pytest.approx(0.5, abs=1e-8)
    v = np.sum(r["bob.velocity"] ** 2, axis=1)
    pull = 2 * v / 0.5 - 2 * 9.81 * d[:, 1] / 0.5
    assert r["rod.force"] == pytest.approx(pull, abs=1e-6)
    assert r["rod.reaction"] == pytest.approx(-pull[:, None] * d / 0.5, abs=1e-6)
    assert r["rod.reaction_moment"] == pytest.approx(0 * d, abs=1e-7)
    assert r["bob.angular_velocity"] == pytest.approx(0 * d, abs=1e-9)
    assert energy_error(r) < 1e-9


def test_in_any_plane():
    """A conical pendulum: omega^2 = g/(l cos(angle)), and the pull m g/cos(angle)."""
    omega = np.sqrt(9.81 / 0.4)
    r = run(f"""
planar: false
bodies: {{bob: {{mass: 2, inertia: [0.01, 0.02, 0.03], at: [0.3, 0, -0.4],
        velocity: [0, {0.3 * float(omega)!r}, 0]}}}}
joints: {{rod: {{type: link, bodies: [bob, ground], points: [[0.3, 0, -0.4], [0, 0, 0]]}}}}
gravity: [0, 0, -9.81]
solver: {{end: 5, tolerance: 1e-11}}
""")
    place = 0.3 * np.stack([np.cos(omega * r.t), np.sin(omega * r.t)], axis=1)
    assert r["bob.position"][:, :2] == pytest.approx(place, abs=1e-7)
    assert r["rod.force"] == pytest.approx(2 * 9.81 / 0.8, abs=1e-6)


ENGINE = """
planar: {planar}
bodies:
  crank: {{mass: 1, inertia: [0.01, 0.01, 0.01], angle: 0.6}}
  piston: {{mass: 2, inertia: [0.01, 0.01, 0.01], at: [0.17, 0]}}
joints:
  bearing: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  guide: {{type: prismatic, bodies: [ground, piston], axis: [1, 0, 0]}}
  rod: {{type: link, bodies: [crank, piston], points: [[0.05, 0], [0.17, 0]]}}
drives: {{motor: {{joint: bearing, velocity: 20}}}}
solver: {{end: 1, tolerance: 1e-10}}
output: {{every: 0.01, channels: ["*"]}}
"""


@pytest.mark.parametrize("planar", SPACES)
def test_a_connecting_rod(planar):
    """Both bodies move, three turns: x = r cos(a) + sqrt(l^2 - r^2 sin(a)^2), m x'' = force."""
    r = run(ENGINE.format(planar=planar))
    a = 20 * r.t
    root = np.sqrt(0.12**2 - (0.05 * np.sin(a)) ** 2)
    assert r["piston.position"][:, 0] == pytest.approx(0.05 * np.cos(a) + root, abs=1e-8)
    push = 2 * r["piston.acceleration"][:, 0]
    assert r["rod.force"] == pytest.approx(-push * 0.12 / root, abs=1e-5)
    assert r["rod.reaction"][:, 0] == pytest.approx(push, abs=1e-5)
    assert (r["rod.force"].min() < -10) and (r["rod.force"].max() > 10)
    assert energy_error(r) < 1e-9


def test_pressed_it_is_negative():
    r = run("""
bodies: {block: {mass: 3, inertia: 1, at: [0, 1]}}
joints:
  guide: {type: prismatic, bodies: [ground, block], axis: [0, 1]}
  leg: {type: link, bodies: [ground, block], points: [[0, 0], [0, 1]]}
gravity: [0, -10]
solver: {end: 0.1}
""")
    assert r["leg.force"] == pytest.approx(-30.0) and r["leg.reaction"][:, 1] == pytest.approx(30.0)


@pytest.mark.parametrize("planar", SPACES)
def test_a_length_that_is_given(planar):
    """The piston is moved to where the rod is that long."""
    longer = "points: [[0.05, 0], [0.17, 0]], length: 150 mm"
    text = ENGINE.format(planar=planar).replace("points: [[0.05, 0], [0.17, 0]]", longer)
    r = run(text)
    assert r["piston.position"][0, 0] == pytest.approx(0.2, abs=1e-9)
    a = 20 * r.t
    root = np.sqrt(0.15**2 - (0.05 * np.sin(a)) ** 2)
    assert r["piston.position"][:, 0] == pytest.approx(0.05 * np.cos(a) + root, abs=1e-8)


def platform(legs):
    """A plate on links from the ground, as those of a flight simulator."""
    at = np.deg2rad([0, 17, 120, 137, 240, 257])
    feet = np.stack([np.cos(at), np.sin(at), 0 * at], axis=1)
    heads = np.stack([0.5 * np.cos(at[[1, 2, 3, 4, 5, 0]] - 0.2),
                      0.5 * np.sin(at[[1, 2, 3, 4, 5, 0]] - 0.2), 0 * at + 1], axis=1)  # fmt: skip
    links = "\n".join(
        f"  leg_{k}: {{type: link, bodies: [ground, plate], "
        f"points: [{feet[k].tolist()}, {heads[k].tolist()}]}}"
        for k in range(legs)
    )
    return (
        feet,
        heads,
        f"""
planar: false
bodies: {{plate: {{mass: 10, inertia: [1, 1, 2], at: [0.1, 0.05, 1.1], angle: 0.3}}}}
joints:
{links}
gravity: [0, 0, -9.81]
solver: {{end: 0.3, tolerance: 1e-9}}
""",
    )


def test_six_links_hold_a_plate():
    """Their forces are those of six equations of balance, solved here."""
    feet, heads, text = platform(6)
    r = run(text)
    assert (r.mechanism.mobility, r.mechanism.redundant) == (0, ())
    n = (heads - feet) / np.linalg.norm(heads - feet, axis=1)[:, None]
    balance = np.vstack([n.T, np.cross(heads, n).T])
    weight = np.array([0, 0, -98.1])
    load = np.concatenate([weight, np.cross([0.1, 0.05, 1.1], weight)])
    found = [r[f"leg_{k}.force"][0] for k in range(6)]
    # pulled, a rod pulls the plate towards its foot
    assert found == pytest.approx(np.linalg.solve(balance, load), abs=1e-7)


def test_five_links_leave_one_motion():
    *_, text = platform(5)
    r = run(text)
    assert (r.mechanism.mobility, r.mechanism.redundant) == (1, ())
    assert np.ptp(r["plate.position"][:, 2]) > 1e-4 and energy_error(r) < 1e-8


def test_two_links_that_hold_the_same():
    """The second one is told as redundant, and that neither force is the only one possible."""
    text = BOB.format(planar="true", o=0, x=0.3, solver="")
    rod = "{type: link, bodies: [ground, bob], points: [[0, 0.1], [0.3, -0.3]]}"
    m = built(text.replace("joints: {", f"joints: {{again: {rod}, "))
    assert (m.mobility, m.redundant) == (2, ("rod.length",))
    assert set(m.not_unique) == {"again.length", "rod.length"}


def test_it_comes_apart():
    r = run(BOB.format(planar="true", o=0, x=0.3, solver="")
            + "events: {cut: {when: t, value: 1, do: {release: [rod]}}}")  # fmt: skip
    free = r.t > 1
    assert r["bob.acceleration"][free] == pytest.approx([0, -9.81, 0] + 0 * r["bob.position"][free])
    assert r["rod.force"][free] == pytest.approx(0.0) and np.abs(r["rod.force"][~free]).min() > 1


@pytest.mark.parametrize("planar", SPACES)
def test_it_holds_the_end_of_a_flexible_bar(planar):
    """Also in space, where the bar may turn about itself."""
    r = run(f"""
planar: {planar}
bodies:
  bar: {{type: ancf_cable, start: [0, 0], end: [1, 0], elements: 2, section: {{diameter: 20 mm}},
        youngs_modulus: 2 GPa, density: 1000}}
joints:
  root: {{type: spherical, bodies: [ground, bar], at: [0, 0]}}
  rope: {{type: link, bodies: [ground, bar], points: [[1, 1], [1, 0]]}}
gravity: [0, -9.81]
solver: {{end: 0.02}}
""")
    far = np.linalg.norm(r["bar.tip"] - [1, 1, 0], axis=1)
    assert far == pytest.approx(1.0, abs=1e-7) and r["rope.force"].max() > 0.5


def test_a_link_out_of_the_plane():
    text = BOB.format(planar="true", o=0, x=0.3, solver="").replace("[0, 0.1]", "[0, 0.1, 0.2]")
    with pytest.raises(TrsimError, match="holds bodies at an angle to the plane"):
        built(text)


@pytest.mark.parametrize(
    "points, length, key, words, hint",
    [
        ("[[0.3, -0.3], [0.3, -0.3]]", "", "points", "coincide", "draw them apart"),
        ("[[0.1, 0.2], [0.10000000000000002, 0.2]]", "", "points", "coincide", "`spherical`"),
        ("[[0, 0], [0.3, 0]]", ", length: 0", "length", "must be > 0", "in m"),
        ("[[0, 0], [0.3, 0]]", ", length: -1", "length", "must be > 0", "in m"),
        ("[[0, 0]]", "", "points", "2", ""),
    ],
)
def test_refused(points, length, key, words, hint):
    with pytest.raises(TrsimError) as caught:
        built(f"""
bodies: {{bob: {{mass: 2, inertia: 1}}}}
joints: {{rod: {{type: link, bodies: [ground, bob], points: {points}{length}}}}}
""")
    assert caught.value.path[:3] == ("joints", "rod", key)
    assert words in caught.value.what and hint in caught.value.hint


def test_a_length_out_of_reach():
    rest = BOB.format(planar="true", o=0, x=0.3, solver="").replace("-0.3]]}", "-0.3]], length: 3}")
    pin = "joints: {pin: {type: revolute, bodies: [ground, bob], at: [0.2, -0.3]}, "
    with pytest.raises(TrsimError, match=r"rod\.length stays open") as caught:
        run(rest.replace("joints: {", pin))
    assert caught.value.path == ("joints", "rod")
