"""The scenarios of the problems that come in sizes: windows (P4), chains (P5), chains on one body.

`python -m benchmarks.problems` writes the smallest of each into scenarios/validation.
"""

from collections.abc import Iterable
from math import cos, hypot, radians, sin
from typing import NamedTuple

from benchmarks.measure import SCENARIOS

VALIDATION = SCENARIOS / "validation"

# --- P4 ----------------------------------------------------------------------------------------

WINDOWS = """\
# P4: {n} four-bar windows side by side: {bodies} links of 1 m and 1 kg, one degree of freedom.  It
# starts upright with the upper pins at 1 m/s along x and turns over and over; every half turn all
# pins lie on one line and the Jacobian loses rank.
# Expected: all uprights share one angle, theta'' = k sin(theta) with k = {k:.9f} 1/s^2
# (tests/data/p4_windows.json); energy is conserved.
title: Four-bar windows, N = {n}
planar: true
gravity: [0, -9.81, 0]
"""


def windows(n: int) -> str:
    """N four-bars in a row: pins A0..AN on the ground, B0..BN above them."""
    k = 9.81 * ((n + 1) / 2 + n) / ((n + 1) / 3 + n)
    rod = f"mass: 1, inertia: {1 / 12!r}"
    lines = [WINDOWS.format(n=n, bodies=2 * n + 1, k=k) + "bodies:"]
    for i in range(n + 1):
        lines.append(f"  upright{i}: {{{rod}, at: [{i}, 0.5], velocity: [0.5, 0], "
                     "angular_velocity: [0, 0, -1]}")  # fmt: skip
    for i in range(n):
        lines.append(f"  bar{i}: {{{rod}, at: [{i + 0.5}, 1], velocity: [1, 0]}}")
    lines.append("joints:")
    for i in range(n + 1):
        lines.append(f"  A{i}: {{type: revolute, bodies: [ground, upright{i}], at: [{i}, 0]}}")
    for i in range(n):
        for end, x in (("left", i), ("right", i + 1)):
            lines.append(f"  B{x}_{end}: {{type: revolute, bodies: [upright{x}, bar{i}], "
                         f"at: [{x}, 1]}}")  # fmt: skip
    lines.append("sensors: {theta: {joint: A0, sign: -1}}")
    lines.append("solver: {end: 10 s, tolerance: 1e-7}")
    lines.append('output: {every: 10 ms, channels: ["upright0.*", "theta*", "energy.*"]}')
    return "\n".join(lines) + "\n"


# --- P5 ----------------------------------------------------------------------------------------

LENGTH, MASS, RADIUS = 0.1, 0.1, 0.005  # of a rod: m, kg, m
ABOUT = 0.5 * MASS * RADIUS**2  # kg m^2 about the rod's axis
ACROSS = MASS * LENGTH**2 / 12 + MASS * RADIUS**2 / 4  # kg m^2


class Rod(NamedTuple):
    """How a rod starts."""

    angle: float  # rad, in the plane z = 0 from +x
    turn: float  # rad/s about y
    spin: float  # rad/s about itself


CHAIN = """\
# P5: an open chain of {n} rods of 0.1 m and 0.1 kg, radius 5 mm, on spherical joints; the first one
# holds on to the origin.  It starts as one straight line along +x that turns about y at 1 rad/s;
# gravity is along -y.
# Expected: the tip after 0.2 s as in tests/data/p5_chains.json; energy is conserved.
title: Open chain of {n} rods
"""

BENT = """\
# P5, bending: an open chain of {n} rods of 0.1 m and 0.1 kg, radius 5 mm, on spherical joints; the
# first one holds on to the origin.  It starts as a zigzag in the plane z = 0, rods at +0.3 and
# -0.3 rad to +x in turn, the first at +0.3; each rod turns about y at 1 or 3 rad/s in turn and all
# spin at 40 rad/s about themselves, so every joint bends from the start; gravity is along -y.
# Expected: the tip after 0.2 s as in tests/data/p5_chains.json; energy is conserved.
title: Bending chain of {n} rods
"""


def chain(n: int) -> str:
    """An open chain that starts as one rigid line."""
    return _chain(CHAIN, straight_rods(n))


def bending_chain(n: int) -> str:
    """An open chain that starts as a zigzag, every joint turning."""
    return _chain(BENT, zigzag_rods(n))


def straight_rods(n: int) -> list[Rod]:
    return [Rod(0.0, 1.0, 0.0)] * n


def zigzag_rods(n: int) -> list[Rod]:
    return [Rod(0.3, 1.0, 40.0) if i % 2 == 0 else Rod(-0.3, 3.0, 40.0) for i in range(n)]


def _chain(head: str, rods: list[Rod]) -> str:
    """The text of a chain; velocities follow from rod to rod:  v_end = v_start + omega x L d."""
    n = len(rods)
    lines = [head.format(n=n) + "planar: false", "gravity: [0, -9.81, 0]"]
    lines += [f"parameters: {{about: {ABOUT!r}, across: {ACROSS!r}}}", "bodies:"]
    joints, outer = [], "ground"
    at, velocity = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for i, (angle, turn, spin) in enumerate(rods):
        d = (cos(angle), sin(angle), 0.0)
        omega = (spin * d[0], turn + spin * d[1], 0.0)
        sweep = (0.0, 0.0, -turn * d[0])  # omega x d
        lines.append(
            f"  rod{i}: {{mass: {MASS}, inertia: [about, across, across], "
            f"at: {_ahead(at, d, 0.5)}, angle: {angle}, "
            f"velocity: {_ahead(velocity, sweep, 0.5)}, angular_velocity: {list(omega)}}}"
        )
        joints.append(f"  ball{i}: {{type: spherical, bodies: [{outer}, rod{i}], at: {list(at)}}}")
        at, velocity = tuple(_ahead(at, d, 1.0)), tuple(_ahead(velocity, sweep, 1.0))
        outer = f"rod{i}"
    lines += ["joints:", *joints, "solver: {end: 0.2 s, tolerance: 1e-8}"]
    lines.append(f'output: {{every: 10 ms, channels: ["rod{n - 1}.*", "energy.*"]}}')
    return "\n".join(lines) + "\n"


STIFF = """\
# A chain of {n} rods of 20 mm and 10 g on hinges with torsion springs and dampers, clamped at one
# end and let go under gravity: a beam in pieces, with bending modes from some Hz to 15 kHz.
# Expected: it falls, swings and settles; the tip of every implicit method is the same.
title: Stiff chain of {n} rods
gravity: [0, -9.81, 0]
planar: {planar}
"""


def stiff_chain(n: int, planar: bool = True) -> str:
    """Rods on hinges with stiff torsion springs."""
    length, mass = 0.02, 0.01
    across = mass * length**2 / 12
    inertia = f"{across!r}" if planar else f"[{across / 10!r}, {across!r}, {across!r}]"
    lines = [STIFF.format(n=n, planar=str(planar).lower()) + "bodies:"]
    lines += [
        f"  rod{i}: {{mass: {mass}, inertia: {inertia}, at: [{length * (i + 0.5)!r}, 0]}}"
        for i in range(n)
    ]
    lines.append("joints:")
    for i in range(n):
        outer = f"rod{i - 1}" if i else "ground"
        lines.append(f"  pin{i}: {{type: revolute, bodies: [{outer}, rod{i}], "
                     f"at: [{length * i!r}, 0]}}")  # fmt: skip
    lines.append("forces:")
    lines += [f"  spring{i}: {{type: torsion_spring, joint: pin{i}, stiffness: 2000, damping: 0.2}}"
              for i in range(n)]  # fmt: skip
    lines.append("solver: {method: radau, end: 50 ms, tolerance: 1e-6}")
    lines.append(f'output: {{every: 1 ms, channels: ["rod{n - 1}.*", "energy.*"]}}')
    return "\n".join(lines) + "\n"


HUNG = """\
# {n} chains of three bodies round the x axis, all hinged to one body that slides along x: a
# thrust reverser in space, where the rows of all chains meet on the fairing.  Steps of 1 ms, for a
# cost of each; the motion would allow longer ones.
# Expected: chains differ by their places round the axis only, so all doors turn alike.
title: {n} chains on one body
planar: false
bodies:
  fairing: {{mass: 50, inertia: [18.1, 5.6, 17.9], at: [0.128, 0, 0.497], velocity: [0.5, 0, 0]}}
"""
RADIUS_OF_A = 0.459  # m, of the supports round the x axis
KNEE, UPPER, LOWER = (-0.074336, 0.207061), (-0.047267, 0.230794), (-0.242, 0.241)  # P, Q, B
LINKS = {  # mass, kg; principal inertias along the link, across it, about e_t; centre; direction
    "large_rod": (0.5, (2e-4, 2.017e-3, 2.017e-3), (-0.037168, 0.103530), KNEE),
    "transfer": (0.3, (4e-5, 1.777e-4, 1.777e-4), (-0.068720, 0.206465), (0.027069, 0.023733)),
    "door": (5.0, (7.35e-2, 8.93e-2, 1.584e-2), (-0.144634, 0.235897), (0.194733, -0.010206)),
}


def hung_chains(n: int) -> str:
    """Pull-rod chains in sectors of one arc, as drawn in a plane (x, y) through the axis each."""
    bodies, joints, forces = [HUNG.format(n=n).rstrip()], ["joints:"], ["forces:"]
    joints.append("  guide: {type: prismatic, bodies: [ground, fairing], axis: [1, 0, 0]}")
    for i in range(n):
        chi = radians(-72.0 + 144.0 * i / (n - 1) if n > 1 else 0.0)
        out, aside = (0.0, sin(chi), cos(chi)), (0.0, -cos(chi), sin(chi))  # e_r, e_t = e_x x e_r
        for name, (mass, inertia, centre, along) in LINKS.items():
            moving = "velocity: [0.5, 0, 0], " if name == "door" else ""
            bodies.append(f"  {name}{i}: {{mass: {mass}, at: {_placed(centre, out)}, {moving}"
                          f"inertia: {_turned(inertia, along, out, aside)}}}")  # fmt: skip
        pin = f"axis: {_listed(aside)}"
        joints += [
            f"  A{i}: {{type: universal, bodies: [ground, large_rod{i}], "
            f"at: {_placed((0.0, 0.0), out)}, {pin}, second_axis: {_across(KNEE, out)}}}",
            f"  P{i}: {{type: spherical, bodies: [large_rod{i}, transfer{i}], "
            f"at: {_placed(KNEE, out)}}}",
            f"  Q{i}: {{type: revolute, bodies: [door{i}, transfer{i}], "
            f"at: {_placed(UPPER, out)}, {pin}}}",
            f"  B{i}: {{type: revolute, bodies: [fairing, door{i}], "
            f"at: {_placed(LOWER, out)}, {pin}}}",
        ]
        forces.append(f"  spring{i}: {{type: torsion_spring, joint: B{i}, stiffness: 3}}")
    solver = "solver: {end: 0.2 s, tolerance: 1e-7, max_step: 1 ms}"
    output = "output: {every: 0.1 s, channels: []}\n"
    return "\n".join([*bodies, *joints, *forces, solver, output])


def _placed(point: tuple[float, float], out: tuple) -> list[float]:
    """(x, y) of a chain's plane in space."""
    return _listed((point[0], *((RADIUS_OF_A + point[1]) * c for c in out[1:])))


def _across(along: tuple[float, float], out: tuple) -> list[float]:
    """The direction across a link in its chain's plane."""
    x, y = along
    return _listed((-y, *(x * c for c in out[1:])))


def _turned(inertia: tuple, along: tuple[float, float], out: tuple, aside: tuple) -> list[float]:
    """Principal inertias along a link, across it and aside as a tensor: xx, yy, zz, xy, xz, yz."""
    length = hypot(*along)
    x, y = along[0] / length, along[1] / length
    axes = ((x, y * out[1], y * out[2]), (-y, x * out[1], x * out[2]), aside)
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    return _listed(
        sum(I * e[i] * e[j] for I, e in zip(inertia, axes, strict=True)) for i, j in pairs
    )


def _listed(numbers: Iterable[float]) -> list[float]:
    return [round(float(number), 15) for number in numbers]


def _ahead(start: tuple, direction: tuple, part: float) -> list[float]:
    return [a + part * LENGTH * b for a, b in zip(start, direction, strict=True)]


# --- stiff where it does not move ---------------------------------------------------------------

# weights on arms that spin, with dampers whose decay takes 1e-4 s
GOVERNOR = """\
title: A governor on dampers
bodies:
  hub: {mass: 1, inertia: 0.1, at: [0, 0]}
  left: {mass: 1, inertia: 0.01, at: [0.1, 0]}
  right: {mass: 1, inertia: 0.01, at: [-0.1, 0]}
joints:
  pin: {type: revolute, bodies: [ground, hub], at: [0, 0]}
  left_arm: {type: prismatic, bodies: [hub, left], axis: [1, 0, 0], at: [0.1, 0]}
  right_arm: {type: prismatic, bodies: [hub, right], axis: [-1, 0, 0], at: [-0.1, 0]}
drives:
  motor: {joint: pin, velocity: "10 + 5*sin(2*t)"}
forces:
  left_spring: {type: joint_spring, joint: left_arm, elastic: "2000*stretch", damper: "1e4*rate"}
  right_spring: {type: joint_spring, joint: right_arm, elastic: "2000*stretch", damper: "1e4*rate"}
solver: {end: 5 s, tolerance: 1e-6}
"""


def main() -> None:
    (VALIDATION / "windows_2.yaml").write_text(windows(2))
    (VALIDATION / "chain_10.yaml").write_text(chain(10))
    (VALIDATION / "bending_chain_10.yaml").write_text(bending_chain(10))


if __name__ == "__main__":
    main()
