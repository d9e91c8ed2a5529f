"""Fixed joint: two bodies move as one.

    Phi_1..3 = r_j + p_j - r_i - p_i = 0
    Phi_4..6 = u_i . a_j = 0,  w_i . a_j = 0,  w_i . u_j = 0

reaction and reaction_moment act on body j at the point, world axes.
"""

from typing import ClassVar

from trsim.elements.contract import Row
from trsim.elements.frames import points
from trsim.elements.joint import Joint, Z, joint, perpendicular, triads
from trsim.elements.rows import POINT, TILTS, TURN, Axes


class Fixed(Joint):
    """A weld between two bodies; its reaction is that in a cut through the point `at`."""

    type: ClassVar[str] = "fixed"


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    places = points(at, i, j, spec.at, spec.at)
    if at.tangent(i) and not at.tangent(j):
        # t . u = t . w = 0 with the tangent t of bar i and u, w fixed in body j: rows tilt 1, turn
        t = at.axes(i, at.tangent(i))
        u, w, _ = perpendicular(at.tangent(i))
        axes = {"u_i": t, "w_i": t, "a_i": t, "u_j": at.axes(j, w), "a_j": at.axes(j, u)}
        return Row(*Axes.packed(**places, **axes, drawn=0.0), unheld="tilt 2")
    # a bar has no torsion, so about its tangent the weld holds nothing: of bar j the row `turn`
    axes = triads(i, j, at.tangent(j) or Z, at)
    return Row(*Axes.packed(**places, **axes), unheld="turn" if at.tangent(j) else "")


ELEMENT = joint(
    key="fixed",
    spec=Fixed,
    rows=(*POINT, *TILTS, TURN),
    pack=pack,
    holds_twist=False,  # it leaves out the row that would
    example="""
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
  tip: {mass: 1 kg, inertia: 0.01 kg*m^2, at: [0.5, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
  weld: {type: fixed, bodies: [rod, tip], at: [0.4, 0]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
