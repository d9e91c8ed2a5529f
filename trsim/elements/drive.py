"""Drive: prescribed motion of a joint coordinate, rigid or through a spring and damper.

    rigid        Phi = x - f(t) = 0,   F = -lambda
    compliant    F = -k (x - f) - c (x' - f'),   c = 2 zeta sqrt(k m)

x is the angle or stroke of the joint.  f is the prescribed position or, if a velocity is
prescribed, its integral from the initial value of x (a state of the element).  F acts on body j
along the axis of the joint; the channel `force` is sign F.
"""

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt
from pydantic import model_validator

from trsim.elements.contract import (
    DAMPERS,
    DRIVES,
    SPRINGS,
    Channel,
    Element,
    Row,
    kernel,
    measured,
)
from trsim.elements.frames import (
    act_along,
    along_row,
    arm,
    at_both,
    cross,
    dot,
    on_joint,
    relative_spin,
    scaled,
    spin,
    turn_lines,
)
from trsim.elements.prescribed import AnyDrive, holds, prescribed
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.kernels.lazy import internal
from trsim.varying import Function


class Compliance(Spec):
    """A spring and a damper in parallel, in series with the prescribed motion.

    stiffness      stiffness of the spring
    damping        damping of the damper; 0 unless this or damping_ratio is given
    damping_ratio  zeta of c = 2 zeta sqrt(k m)
    mass           m in this formula. Unless given, it is the mass of the driven body, or, on a
                   hinge, its moment of inertia about the axis, I + m d^2, with d the distance of
                   its centre of mass from the axis. The driven body is the second one of the joint,
                   or the first one if the second is the ground; bodies attached to it do not count
    """

    stiffness: Annotated[float, Gt(0), Unit("N/m", "N*m/rad")]
    damping: Annotated[float, Ge(0), Unit("N*s/m", "N*m*s/rad")] | None = None
    damping_ratio: Annotated[float, Ge(0), Unit("-")] | None = None
    mass: Annotated[float, Gt(0), Unit("kg", "kg*m^2")] | None = None


class Drive(Spec):
    """A prescribed position or velocity of a joint coordinate, as a function of t only.

    joint       joint whose coordinate is driven: revolute or prismatic
    position    prescribed coordinate
    velocity    prescribed rate; the coordinate starts where the joint is
    sign        sign of the channel `force`; the motion does not depend on it
    compliance  spring and damper between the prescribed motion and the joint; rigid without it
    """

    type: ClassVar[str] = "drive"
    joint: str
    position: Function("m", "rad") | None = None
    velocity: Function("m/s", "rad/s") | None = None
    sign: Literal[1, -1] = 1
    compliance: Compliance | None = None

    @model_validator(mode="after")
    def one_motion(self):
        if (self.position is None) == (self.velocity is None):
            raise ValueError("give either `position` or `velocity`")
        return self

    def at_rest(self):
        """The drive without its damper, which would push a joint at rest along with the motion."""
        if self.compliance is None:
            return self
        without = {"damping": None, "damping_ratio": None}
        return self.model_copy(update={"compliance": self.compliance.model_copy(update=without)})


WITH_UNITS = ("stiffness", "damping", "mass")  # of a compliance


def pack(name, spec, at):
    x = at.coordinate(spec.joint)
    by_velocity = spec.position is None
    word = "velocity" if by_velocity else "position"
    rates = ("rad/s", "m/s") if by_velocity else ("rad", "m")
    at.check_unit(x.kind, *rates, "drives", name, word)
    if spec.compliance is not None:
        at.check_units(x.kind, Compliance, WITH_UNITS, "drives", name, "compliance")
    motion = spec.velocity if by_velocity else spec.position
    wanted = rates[0 if x.kind == "angle" else 1]
    f = at.function(motion, word, time_only=True, wanted=wanted)
    state = at.state(x.kind, follows=x.entry) if by_velocity else -1
    k = c = 0.0
    if spec.compliance is not None:
        k = spec.compliance.stiffness
        last, first = (x.i, x.j) if x.turned else (x.j, x.i)
        driven = last or first  # the ground is not driven
        m = spec.compliance.mass or (
            at.inertia_about(driven, x.axis, x.s_j if driven == x.j else x.s_i)
            if x.kind == "angle"
            else at.mass(driven)
        )
        zeta = spec.compliance.damping_ratio
        if zeta is not None and m == 0.0:
            what = "the driven body has no mass that a damping ratio could be one of"
            path = ("compliance", "damping_ratio")
            raise ScenarioError(what, "give `mass`, or `damping` instead", path)
        c = 2.0 * zeta * (k * m) ** 0.5 if zeta is not None else spec.compliance.damping or 0.0
    turns = x.kind == "angle"
    act = {"state": state, "motion": f, "stiffness": k, "damping": c}
    own = AnyDrive.packed(spec, **on_joint(x), rotates=turns, **act)
    return Row(*own, is_force=k > 0.0, states=(state,), turns=turns)


@kernel
def constraint(t, scene, e):
    own = AnyDrive(scene, e)
    i, j, k = own.i, own.j, own.row
    if k < 0:
        return
    f, f_dot, f_ddot = prescribed(t, scene, e)
    axis = arm(scene.X, i, own.axis)
    if own.rotates == 1:
        turn_lines(scene, k, axis)
        scene.gamma[k] = f_ddot - dot(cross(spin(scene.V, i), axis), relative_spin(scene.V, i, j))
    else:
        along_row(scene, e, axis, k)
        scene.gamma[k] += f_ddot
    scene.phi[k] = scene.S[own.coordinate, 0] - f
    scene.phi_t[k] = -f_dot


@kernel
def force(t, scene, e):
    S, zd = scene.S, scene.zd
    own = AnyDrive(scene, e)
    state, k = own.state, own.stiffness
    if k == 0.0 and state < 0:
        return
    f, f_dot, _ = prescribed(t, scene, e)
    if state >= 0:
        zd[state] = f_dot if holds(scene, e) else 0.0
    if k > 0.0:
        s = own.coordinate
        slip = S[s, 1] - f_dot
        damping = -own.damping * slip
        pull = -k * (S[s, 0] - f) + damping
        zd[DAMPERS] += damping * slip
        zd[DRIVES] += pull * f_dot
        act(scene, e, pull)


@internal
def act(scene, e, pull):
    """Apply the drive's force or torque to both bodies."""
    own = AnyDrive(scene, e)
    act_along(scene, e, scaled(pull, arm(scene.X, own.i, own.axis)), own.rotates)


@kernel
def energy(t, scene, e):
    own = AnyDrive(scene, e)
    if own.stiffness > 0.0:
        f, _, _ = prescribed(t, scene, e)
        slip = scene.S[own.coordinate, 0] - f
        scene.E[SPRINGS] += 0.5 * own.stiffness * slip * slip


@measured
def measure(t, scene, e, o):
    S, out = scene.S, scene.out
    own = AnyDrive(scene, e)
    f, f_dot, _ = prescribed(t, scene, e)
    s = own.coordinate
    if not holds(scene, e):
        f, f_dot = S[s, 0], S[s, 1]
    if own.row >= 0:
        pull = -scene.lam[own.row]
    else:
        pull = -own.stiffness * (S[s, 0] - f) - own.damping * (S[s, 1] - f_dot)
    out[o], out[o + 1], out[o + 2], out[o + 3] = own.sign * pull, f, f_dot, pull * f_dot


ELEMENT = Element(
    key="drive",
    section="drives",
    spec=Drive,
    pack=pack,
    acts_at=at_both,
    rows=("motion",),
    channels=(
        Channel("force", "drive", "sign times the force or torque on the second body"),
        Channel(
            "position", "coordinate", "prescribed coordinate of the joint; its own once released"
        ),
        Channel("velocity", "coordinate/s", "its rate"),
        Channel("power", "W", "power given to the mechanism"),
    ),
    loads={"force": "force"},
    kernels={"constraint": constraint, "force": force, "energy": energy, "measure": measure},
    example="""
bodies:
  disc: {mass: 2 kg, inertia: 0.01 kg*m^2}
joints:
  bearing: {type: revolute, bodies: [ground, disc], at: [0, 0]}
drives:
  motor: {joint: bearing, position: "0.5*smoothstep(t/0.2)"}
solver: {end: 0.3 s}
""",
)
