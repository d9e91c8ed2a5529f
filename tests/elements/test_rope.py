"""Rope: hoists and drums against closed forms, derivatives over wheels, and what is refused."""

import numpy as np
import pytest

from trsim.assemble.equations import constraints, poses
from trsim.elements.scene import scene
from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import doubts

from ..runs import built, energy_error, run

G = 9.81
METHODS = {
    "dop853": ("tolerance: 1e-10", 1e-9),
    "radau": ("method: radau, tolerance: 1e-9", 1e-7),
    "ggl": ("method: radau, formulation: ggl, tolerance: 1e-9", 1e-7),
    "rk4": ("method: rk4, step: 1e-3", 1e-9),
    "generalized_alpha": ("method: generalized_alpha, tolerance: 1e-5", 1e-4),
}


def hoist(through, more="", solver="tolerance: 1e-10", end=1.0, masses=(3, 2)):
    """Two masses on vertical rails, at x = 0 and x = 1."""
    rope = ", ".join(f"{{{place}}}" for place in through)
    return f"""
bodies:
  load: {{mass: {masses[0]}, inertia: 0.01, at: [0, -2], angle: 0.5}}
  weight: {{mass: {masses[1]}, inertia: 0.01, at: [1, -1], angle: -0.8}}
joints:
  rail: {{type: prismatic, bodies: [ground, load], axis: [0, 1]}}
  other: {{type: prismatic, bodies: [ground, weight], axis: [0, 1]}}
  line: {{type: rope, through: [{rope}]}}
sensors: {{s: {{joint: rail}}, w: {{joint: other}}}}
gravity: [0, -{G}, 0]
solver: {{end: {end}, {solver}}}
output: {{every: 0.01, channels: ["*"]}}
{more}
"""


BLOCK = (
    "body: ground, at: [-0.1, 0]",
    "body: load, at: [0, -2], radius: 0.1, turn: left",
    "body: ground, at: [0.55, 0], radius: 0.45, turn: right",
    "body: weight, at: [1, -1]",
)


@pytest.mark.parametrize("method", METHODS)
def test_a_hoist_over_two_pulleys(method):
    """One of them on the load: 2 s + w = 0,  T = m_w (g + w'') = m (g + s'')/2."""
    solver, error = METHODS[method]
    r = run(hoist(BLOCK, solver=solver, end=0.5))
    a = (2 * 2 - 3) * G / (3 + 4 * 2)  # of the load, upwards
    assert r["s"] == pytest.approx(a * r.t**2 / 2, abs=error)
    assert r["w"] == pytest.approx(-a * r.t**2, abs=error)
    assert r["line.tension"] == pytest.approx(3 * (G + a) / 2, abs=1e3 * error)
    assert energy_error(r) < max(100 * error, 1e-9)


def test_eyes_instead_of_wheels():
    """Where all its parts stay vertical."""
    eyes = ("body: ground, at: [0, 0]", "body: load, at: [0, -2]", "body: ground, at: [0, 0]",
            "body: ground, at: [1, 0]", "body: weight, at: [1, -1]")  # fmt: skip
    for planar in ("true", "false"):
        text = hoist(eyes, end=0.5, more=f"planar: {planar}")
        r = run(text.replace("inertia: 0.01", "inertia: [0.01, 0.01, 0.01]"))
        assert r["s"] == pytest.approx(G / 11 * r.t**2 / 2, abs=1e-9)


def test_wheels_that_turn():
    """A wheel with inertia is a drum of two ropes: no slip, over many turns."""
    up = ("body: load, at: [0, -2]", "body: wheel, at: [0.3, 0], radius: 0.3, turn: right")
    text = hoist(up, end=4)
    wheel = "  wheel: {mass: 1, inertia: 0.2, at: [0.3, 0], angle: 2}\n"
    joints = """  axle: {type: revolute, bodies: [ground, wheel], at: [0.3, 0]}
  second: {type: rope, through: [{body: wheel, at: [0.3, 0], radius: 0.3, turn: right},
           {body: weight, at: [1, -1]}]}
"""
    text = text.replace("bodies:\n", f"bodies:\n{wheel}").replace("joints:\n", f"joints:\n{joints}")
    text = text.replace("[1, -1]", "[0.6, -20]")
    text = text.replace("sensors: {", "sensors: {turn: {joint: axle}, ")
    r = run(text)
    a = (3 - 2) * G / (3 + 2 + 0.2 / 0.3**2)  # of the weight, upwards
    assert r["w"] == pytest.approx(a * r.t**2 / 2, abs=1e-8)
    assert r["turn"] == pytest.approx(a * r.t**2 / 2 / 0.3, abs=1e-8)
    assert r["turn"][-1] > 4 * np.pi
    assert r["line.tension"] == pytest.approx(3 * (G - a), abs=1e-7)
    assert r["second.tension"] == pytest.approx(2 * (G + a), abs=1e-7)


def test_a_winch():
    """A drum that a motor turns winds up the rope; the torque is tension times radius."""
    text = hoist(
        ("body: weight, at: [0.25, 0], radius: 0.25, turn: left", "body: load, at: [0, -2]")
    )
    text = text.replace("at: [1, -1], angle: -0.8", "at: [0.25, 0], angle: 9").replace(
        "other: {type: prismatic, bodies: [ground, weight], axis: [0, 1]}",
        "other: {type: revolute, bodies: [ground, weight], at: [0.25, 0]}",
    )
    drive = "drives: {motor: {joint: other, velocity: '-7*smoothstep(t/0.3)'}}"
    r = run(text + drive, "solver.end=1", fails=False)
    # the rope hangs from the left of the drum, so it comes up as that turns clockwise
    assert r["s"] == pytest.approx(-0.25 * r["w"], abs=1e-9)
    T = 3 * (G + r["load.acceleration"][:, 1])
    assert r["line.tension"] == pytest.approx(T, abs=1e-6)
    torque = r["motor.force"] - 0.01 * r["weight.angular_acceleration"][:, 2]
    assert torque == pytest.approx(-0.25 * T, abs=1e-6)


@pytest.mark.parametrize("turn, side", [("left", 1), ("right", -1)])
@pytest.mark.parametrize("method", METHODS)
def test_unwinding_from_a_cylinder(method, turn, side):
    """Without weight the speed v stays, and  l^2 = l_0^2 + 2 r v t: an involute."""
    solver, error = METHODS[method]
    v, r0, l0 = 3.0, 0.2, 0.5
    # the free part goes along x from the cylinder; the mass moves so that it unwinds
    r = run(f"""
bodies:
  stone: {{mass: 2, inertia: 0.01, at: [{l0}, {-side * r0}], velocity: [0, {-side * v}]}}
joints:
  line: {{type: rope, through: [{{body: ground, at: [0, 0], radius: {r0}, turn: {turn}}},
         {{body: stone, at: [{l0}, {-side * r0}]}}]}}
solver: {{end: 6, {solver}}}
output: {{every: 0.01, channels: ["*"]}}
""")
    length = np.sqrt(l0**2 + 2 * r0 * v * r.t)
    angle = -side * (length - l0) / r0  # what has come off
    e = np.array([np.cos(angle), np.sin(angle)])
    n = np.array([-np.sin(angle), np.cos(angle)])
    place = length * e - side * r0 * n
    assert abs(angle[-1]) > 2 * np.pi
    assert r["stone.position"][:, 0] == pytest.approx(place[0], abs=30 * error)
    assert r["stone.position"][:, 1] == pytest.approx(place[1], abs=30 * error)
    assert r["line.tension"] == pytest.approx(2 * v**2 / length, abs=1e4 * error)


def test_two_places_are_a_link():
    text = """
planar: false
bodies:
  arm: {mass: 3, inertia: [0.2, 0.3, 0.4], at: [0.3, 0, 0], angle: 0.3}
  bob: {mass: 2, inertia: [0.02, 0.03, 0.01], at: [0.9, -0.1, 0.3], angular_velocity: [1, 2, 3]}
joints:
  pin: {type: spherical, bodies: [ground, arm], at: [0, 0, 0]}
  line: %s
gravity: [0, -9.81, 0]
solver: {end: 1.5, tolerance: 1e-10}
output: {every: 0.01, channels: ["*"]}
"""
    p, q = "[0.6, 0, 0]", "[0.8, -0.1, 0.25]"
    link = run(text % f"{{type: link, bodies: [arm, bob], points: [{p}, {q}]}}")
    r = run(text % f"{{type: rope, through: [{{body: arm, at: {p}}}, {{body: bob, at: {q}}}]}}")
    assert r["bob.position"] == pytest.approx(link["bob.position"], abs=1e-7)
    assert r["line.tension"] == pytest.approx(link["line.force"], abs=1e-4)


def test_on_a_flexible_bar():
    from .test_point_on_curve import FLEXIBLE

    link = "{type: link, bodies: [rod, ball], points: [[1, 0], [1, -0.3]]}"
    rope = "{type: rope, through: [{body: rod, at: [1, 0]}, {body: ball, at: [1, -0.3]}]}"
    for planar in ("true", "false"):
        r, other = (run(FLEXIBLE % (joint, planar)) for joint in (rope, link))
        assert r["ball.position"] == pytest.approx(other["ball.position"], abs=1e-9)
        assert r["tie.tension"] == pytest.approx(other["tie.force"], abs=1e-4)


@pytest.mark.parametrize("how", ["rail: 0.3", "rail.rate: 0.3"])
def test_starts(how):
    """The other mass goes along, twice as far and as fast."""
    r = run(hoist(BLOCK, f"initial: {{{how}}}", end=0.1))
    key = "s.rate" if "rate" in how else "s"
    assert r[key][0] == pytest.approx(0.3, abs=1e-9)
    assert r[key.replace("s", "w", 1)][0] == pytest.approx(-0.6, abs=1e-9)


# --- over wheels -----------------------------------------------------------------------------

THREE = """
planar: true
bodies:
  one: {mass: 1, inertia: 1, at: [0.1, 0.2], angle: 0.4}
  two: {mass: 1, inertia: 1, at: [1.2, 0.5], angle: -2}
  three: {mass: 1, inertia: 1, at: [0.8, -0.9], angle: 3}
joints:
  line:
    type: rope
    through:
      - {body: one, at: [0.2, -0.1], radius: 0.11, turn: left}
      - {body: two, at: [1.3, 0.4], radius: 0.2, turn: right}
      - {body: ground, at: [2.2, -0.3]}
      - {body: three, at: [0.9, -1], radius: 0.15, turn: right}
      - {body: one, at: [0, 0.3], radius: 0.07, turn: left}
"""


def rows(m, q, v):
    """Phi, J over the rates of the bodies, and gamma."""
    w = scene(m.model)
    for x in m.coordinates.values():
        w.branch[x.entry] = x.drawn
    poses(w, np.concatenate([q, v, np.zeros(m.model.n_z)]))
    constraints(w, 0.0)
    J = np.zeros((w.n, 6))
    for line in range(w.row_start[0], w.row_start[1]):
        J[w.line_frame[line]] += w.J[line]
    return w.phi[0], J[1:, [0, 1, 5]].ravel(), w.gamma[0]


@pytest.mark.parametrize("seed", range(6))
def test_derivatives_over_wheels(seed):
    m, rng, h = built(THREE), np.random.default_rng(seed), 1e-5
    q = m.y0[:9] + 0.1 * rng.normal(size=9)
    v = rng.normal(size=9)
    phi, J, gamma = rows(m, q, v)
    columns = [(rows(m, q + h * e, v)[0] - rows(m, q - h * e, v)[0]) / (2 * h) for e in np.eye(9)]
    assert pytest.approx(np.array(columns), abs=1e-8) == J
    later, before = rows(m, q + h * v, v)[1], rows(m, q - h * v, v)[1]
    assert gamma == pytest.approx(-(later - before) @ v / (2 * h), abs=1e-7)
    assert rows(m, m.y0[:9], v)[0] == pytest.approx(0.0, abs=1e-14) and abs(phi) > 1e-3


def test_force_and_moment_add_up_to_none():
    m = built(THREE)
    w = scene(m.model)
    for x in m.coordinates.values():
        w.branch[x.entry] = x.drawn
    poses(w, m.y0)
    constraints(w, 0.0)
    force, moment = np.zeros(3), np.zeros(3)
    for line in range(w.row_start[0], w.row_start[1]):
        force += w.J[line, :3]
        moment += w.J[line, 3:] + np.cross(w.X[w.line_frame[line], :3], w.J[line, :3])
    assert force == pytest.approx(0.0, abs=1e-14) and moment == pytest.approx(0.0, abs=1e-14)


def test_length():
    """Of a hoist: 1.9 m up, half round, 2.1 ... and what a longer rope lowers at the start."""
    whole = 2 + np.pi * 0.1 + 2 + np.pi * 0.45 + 1
    same = run(hoist(BLOCK, end=0.01).replace("]}\nsensors", f"], length: {whole!r}}}\nsensors"))
    assert same["load.position"][0, 1] == pytest.approx(-2, abs=1e-12)
    longer = whole + 0.2
    r = run(hoist(BLOCK, end=0.01).replace("]}\nsensors", f"], length: {longer!r}}}\nsensors"))
    s, w = r["s"][0], r["w"][0]
    assert -2 * s - w == pytest.approx(0.2, abs=1e-9)


def told(r):
    return [said for said in doubts(r.scenario, r.mechanism, r.outcome) if "line" in said]


def test_a_rope_that_pushes_is_said():
    kick = "forces: {kick: {type: applied_load, body: weight, direction: [0, 1], force: 90}}"
    assert told(run(hoist(BLOCK, end=0.1), "output.channels=['s']")) == []
    [said] = told(run(hoist(BLOCK, kick, end=0.1), "output.channels=['s']"))
    assert "pushes by" in said and "slack" in said


def test_coming_off_a_wheel_ends_the_run():
    """A mass that swings up until the rope goes straight past the wheel it bent round."""
    text = """
bodies:
  stone: {mass: 1, inertia: 0.01, at: [1, -0.1], velocity: [0, %s]}
joints:
  line:
    type: rope
    through:
      - {body: ground, at: [-1, 0]}
      - {body: ground, at: [0, -0.2], radius: 0.2, turn: right}
      - {body: stone, at: [1, -0.1]}
solver: {end: 3}
"""
    r = run(text % 1)
    assert r.outcome.status == "jammed"
    assert "line came off one of its wheels" in r.outcome.reason
    assert r["line.tension"][-1] > 0
    # the other way it winds up to the wheel
    other = run(text % -1)
    assert other.outcome.status == "jammed" and "or ran up to one" in other.outcome.reason
    assert other.outcome.time > r.outcome.time


REFUSED = {
    "one place": (BLOCK[:1], "two places or more"),
    "one body": (("body: load, at: [0, -2]", "body: load, at: [0, -1]"), "all its places are on"),
    "no turn": (("body: load, at: [0, -2]", "body: ground, at: [0, 0], radius: 0.1"), "`turn`"),
    "turn of a point": (
        ("body: load, at: [0, -2]", "body: ground, at: [0, 0], turn: left"), "that of a wheel",
    ),
    "coincide": (
        ("body: load, at: [0, -2]", "body: ground, at: [0, -2]", "body: weight, at: [1, 0]"),
        "coincide as drawn",
    ),
    "overlap": (
        ("body: load, at: [0, 0.05]", "body: ground, at: [0, 0], radius: 0.1, turn: left"),
        "overlap as drawn",
    ),
    "straight past": (
        ("body: load, at: [-1, 0.1]", "body: ground, at: [0, 0], radius: 0.1, turn: right",
         "body: weight, at: [1, 0.1]"),
        "straight past this wheel",
    ),
    "no body": (("body: lod, at: [0, -2]", "body: ground, at: [0, 0]"), "no body named 'lod'"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refused(what):
    through, said = REFUSED[what]
    with pytest.raises(TrsimError, match=said):
        built(hoist(through))


def test_two_drums_are_a_belt():
    """A rope from one onto the other, open and crossed, that holds both ways."""
    text = """
bodies:
  one: {mass: 1, inertia: 0.002, at: [0, 0], angle: 1}
  two: {mass: 1, inertia: 0.01, at: [0.4, 0.1], angle: -2}
joints:
  shaft: {type: revolute, bodies: [ground, one], at: [0, 0]}
  axle: {type: revolute, bodies: [ground, two], at: [0.4, 0.1]}
  line: %s
sensors: {a: {joint: shaft}, b: {joint: axle}}
forces: {push: {type: applied_load, body: one, direction: [0, 0, 1], torque: "3*cos(2*t)"}}
solver: {end: 3, tolerance: 1e-10}
"""
    for crossed, turn in (("false", "left"), ("true", "right")):
        rope = (
            "{type: rope, through: [{body: one, at: [0, 0], radius: 0.05, turn: left}, "
            f"{{body: two, at: [0.4, 0.1], radius: 0.12, turn: {turn}}}]}}"
        )
        belt = f"{{type: belt, joints: [shaft, axle], radii: [0.05, 0.12], crossed: {crossed}}}"
        r, other = run(text % rope), run(text % belt)
        assert np.ptp(other["a"]) > 20 * np.pi
        for name in ("a", "b"):
            assert r[name] == pytest.approx(other[name], abs=1e-6)


def test_a_rope_that_is_cut():
    cut = "events: {cut: {when: t, value: 0.2, do: {release: [line]}}}"
    r = run(hoist(BLOCK, cut, end=0.5))
    assert r["load.acceleration"][-1] == pytest.approx([0, -G, 0], abs=1e-9)
    assert r["line.tension"][-1] == 0.0 and r["line.tension"][10] > 1.0
    assert r.outcome.status == "done"


def test_wheels_are_refused_in_space():
    text = hoist(BLOCK, "planar: false").replace("inertia: 0.01", "inertia: [0.01, 0.01, 0.01]")
    with pytest.raises(TrsimError, match="in the x-y plane only"):
        built(text)


def test_templates_name_their_own_bodies():
    r = run(f"""
templates:
  lift:
    bodies:
      load: {{mass: 3, inertia: 0.01, at: [0, -2]}}
      weight: {{mass: 2, inertia: 0.01, at: [1, -1]}}
    joints:
      rail: {{type: prismatic, bodies: [ground, load], axis: [0, 1]}}
      other: {{type: prismatic, bodies: [ground, weight], axis: [0, 1]}}
      line: {{type: rope, through: [{", ".join(f"{{{p}}}" for p in BLOCK)}]}}
    sensors: {{s: {{joint: rail}}}}
instances:
  a: {{template: lift}}
  b: {{template: lift, frame: {{at: [5, 1]}}}}
gravity: [0, -{G}, 0]
solver: {{end: 0.5, tolerance: 1e-10}}
""")
    assert r["a_s"] == pytest.approx(G / 11 * r.t**2 / 2, abs=1e-9)
    assert r["b_s"] == pytest.approx(G / 11 * r.t**2 / 2, abs=1e-9)
