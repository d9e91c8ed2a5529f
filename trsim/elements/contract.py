"""What an element is: a spec, its kernels and its channels, exported as one `Element`.

The user's words end in `pack`; from there on an element is rows of numbers.  Every instance of
every element owns one row e of the three tables of a model,

    con (N, n_con) int64     where: frames, joint coordinate, constraint rows, further indices,
                             further joint coordinates
    par (N, n_par) float64   how much: constants of the instance, SI
    mem (N, n_mem) float64   what it remembers; frozen while a step is being tried

whose columns have names (kernels/columns.py), and the instances of one element are neighbours: a
kernel is called once, as kernel(t, scene, a, b), for its rows a <= e < b.  An element says what it
does with one of them, (t, scene, e): it reads poses and twists of the scene in world axes (X, V),
joint coordinates and sensors (S, angles unwrapped), the states z, and writes what its kind may:

    force       F[i] += force, moment about the centre of mass (N, N*m); zd[...] += powers, rates
    constraint  phi, phi_t, J, gamma of its rows:  phi' = J V + phi_t,   J V' = gamma; J of row k
                are the lines from row_start[k] on, one for each frame that Row.frames names
    coordinate  S[s] = value and rate; S[s, 0] comes in holding the branch to unwrap to,
                the angle itself in a planar scene
    gaps        gap[e] = penetration (m, > 0 in contact), its rate (m/s); or how far a limit of
                the element is exceeded, and its rate
    corners     corner[e] = how far the element has left the branch it remembers of a law with
                corners (< 0: inside), and the branch to go on with; `force` keeps the largest
                such value it meets in left[e].  Where what rubs fully knows no sign of its speed,
                slid[e, :3] = the velocity at which it slides, world axes, else 0
    energy      E[SPRINGS], E[CONTACTS], E[GRAVITY] += stored energy (J)
    stiffness   tangent, viscous: minus the derivatives of the forces of each element of a beam
    measure     (t, scene, e, o): out[o + c] = channel c, where somebody asked.  May also read the
                accelerations A = V' and the multipliers lam
    load        of what rubs in a joint, loads[e] = Load: how its reaction, pressed[e], presses,
                and what friction is made of it; zd of its states      assemble/rubbing.py
    rub         F[i] += the wrenches of the friction force rubbed[e]
    strike      blow[k] = force, moment on body j, then on body i, world axes, of an impulse of 1
                along the normal, k = 0, and along two directions across it; zero where it has none
    slip        blow[0, :3] = the velocity at which body j slides on body i where they touch, world
                axes; asked of single instances only, along static paths

A spec of the section `bodies` says of itself

    flexible          how it bends, a Cable; None where it is rigid
    bar(start, end)   where it is flexible: the bar that is solved, which lies between these places
                      unless it has its own
    origin            where its mass, centre and inertia come from, in words
    as_rigid()        a rigid body, with
    tensor            its inertia, row by row, and whether all of it is known

and one of a force that pushes back from a limit, `pressed(joints)`: the two bodies it pushes apart,
and the hinge about whose axis it does, or None.

The fields are listed in scene.py.  Body 0 is the ground: X[0] the identity, V[0] zero.  No kernel
has a branch for it.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import wraps
from math import inf
from typing import Any, NamedTuple

from trsim.elements.scene import Scene
from trsim.kernels.calls import caller
from trsim.kernels.columns import V3, Columns, f8, i8, memory
from trsim.kernels.lazy import internal
from trsim.kernels.machine import Compiled
from trsim.kernels.signatures import Signature, void
from trsim.statuses import Ended

KINDS = (
    *("force", "constraint", "coordinate", "gaps", "corners", "energy", "stiffness", "measure"),
    *("load", "rub", "strike"),
)


class Memory(Columns):
    """The first N_MEM columns of mem are the march's; those of the element follow."""

    phase: memory  # of elements with a gap
    impact_speed: memory  # m/s
    branch: memory
    since: memory  # s: when the prescribed motion of a drive began, see scenario/event.py


PHASE, IMPACT_SPEED, BRANCH, SINCE = (column.at for column in Memory.columns.values())
FLIGHT, CONTACT, UNLOCATED = 0.0, 1.0, 2.0  # phases; UNLOCATED: the integrator finds no events
WHOLE = 9.0  # branch: the law with all its branches


class Pair(Memory):
    """Of every element between two frames."""

    i: i8
    j: i8
    coordinate: i8  # in S, or -1


FIRST_ROW = Pair.columns["coordinate"].at + 1  # of con: constraint rows come behind

# z: the energy book, power flowing into the mechanism (W), in front of the elements' own states
DRIVES, LOADS, DAMPERS, IMPACTS, FRICTION, N_BOOK = 0, 1, 2, 3, 4, 5
BOOK = ("drives", "loads", "dampers", "impacts", "friction")

# E: stored energy
SPRINGS, CONTACTS, GRAVITY = 0, 1, 2
STORED = ("springs", "contacts", "gravity")


SCENE = Scene.kind
KERNEL = void(f8, SCENE, i8, i8)  # t, scene, first row, end row
call_kernel = caller(KERNEL)


def compiled(signature: Signature) -> Callable[[Callable], Compiled]:
    """Decorator for functions called by address or from Python."""
    return lambda python: Compiled(python, signature)


def kernel(python: Callable) -> Compiled:
    """Decorator of what a kernel does with one instance e: the kernel is the loop over them."""
    one = internal(python)

    @wraps(python)
    def loop(t, scene, a, b):  # type: ignore[no-untyped-def]
        for e in range(a, b):
            one(t, scene, e)

    return Compiled(loop, KERNEL)


def measured(python: Callable) -> Compiled:
    """The same of kernels `measure`: of instances that are asked for, with their first column."""
    one = internal(python)

    @wraps(python)
    def loop(t, scene, a, b):  # type: ignore[no-untyped-def]
        for e in range(a, b):
            if scene.wanted[e] >= 0:
                one(t, scene, e, scene.wanted[e])

    return Compiled(loop, KERNEL)


class Channel(NamedTuple):
    """One recorded quantity per instance and output time."""

    name: str
    unit: str
    meaning: str
    size: int = 1
    least: float = -inf  # a lower bound by its definition alone
    turn: bool = False  # one about any axis, whose largest angle every run is judged by
    moves: bool = False  # of places and rates alone: no force has to be known for it

    def unit_on(self, own: str) -> str:
        """The unit where it depends on what it acts along, a coordinate in `own`: rad or m."""
        turning = {"drive": "N*m" if own == "rad" else "N"}
        return turning.get(self.unit, self.unit.replace("coordinate", own))

    def on(self, own: str) -> "Channel":
        """The same channel in that unit."""
        if "coordinate" not in self.unit and self.unit != "drive":
            return self
        return self._replace(unit=self.unit_on(own))


def moving(name: str, unit: str, meaning: str, size: int = 1) -> Channel:
    """A channel of places and rates alone."""
    return Channel(name, unit, meaning, size, moves=True)


# what every joint with constraint rows records
REACTIONS = (
    Channel("reaction", "N", "constraint force on the second body, world axes", 3),
    Channel("reaction_moment", "N*m", "constraint moment on the second body at the joint", 3),
)


class Impact(NamedTuple):
    """A touch faster than the slowest impact that takes no time."""

    rule: str  # of laws/impact.py
    restitution: float
    static: float = 0.0  # coefficients of friction
    kinetic: float = 0.0


class Contact(NamedTuple):
    """What the solver must know of a contact to step through it (error norm, first step)."""

    stiffness: float  # N/m^exponent
    exponent: float
    clearance: float  # m, of a journal in its bearing; inf where the contact is none
    slowest_impact: float  # m/s
    damping: float  # chi: of the elastic force at the rate at which the contact began
    state: int = -1  # first entry of z that a touch sets to zero
    slope: float = 0.0  # s/m, of its coefficient of friction over the speed, at rest
    jump: int = -1  # column of par with the coefficient of a friction that jumps at rest
    radius: float = 0.0  # m, of the bearing of a journal
    impact: Impact | None = None
    states: int = 1  # how many such entries there are
    known_to: float = inf  # m, the depth to which its law is given
    lost: int = -1  # entry of z with what damping has taken, J; what friction has, behind it
    ramp: float = 0.0  # m/s, of the sliding speed, over which its friction comes in; 0: it has none


class ContactNumbers(Columns, par="contact_par"):
    """The same in a model, with what depends on the bodies."""

    stiffness: f8
    exponent: f8
    mass: f8  # kg, effective; of a stop on an angle an inertia, that of its bodies at `arm`
    clearance: f8
    slowest_impact: f8
    arm: f8  # turns its depth, an angle, into the length that errors are weighed with; or 1
    damping: f8
    ramp: f8


class Load(Columns, par="loads"):
    """How the reaction of a joint presses surfaces together, and what friction that makes.

    The friction force is (normal + preload) times per_load.
    """

    normal: f8  # N, the load that the reaction makes: a norm of it
    preload: f8  # N, what there is without it
    per_load: f8  # friction along the sliding speed, of a load of 1
    slip: f8  # m/s, sliding speed
    by_force: V3  # derivatives of the load against the force of the reaction
    by_moment: V3  # and against its moment, 1/m


class Limit(NamedTuple):
    """What ends a run where the gap of an element rises through zero; located like an event."""

    name: str  # behind the element's: stall
    value: float  # the limit itself
    unit: str
    status: Ended
    said: str  # what has happened


@dataclass(frozen=True)
class Row:
    """One packed instance, its constants by Columns.packed of its element."""

    con: tuple[int, ...]  # its constraint rows, from FIRST_ROW on, are -1 here
    par: tuple[float, ...]
    contact: Contact | None = None
    channels: tuple[Channel, ...] | None = None  # of this instance, where they are not its kind's
    is_force: bool = False  # its constraint rows are never in force: a drive with compliance
    states: tuple[int, ...] = ()  # entries of z it reads or changes
    limits: tuple[Limit, ...] = ()
    turns: bool = False  # it acts on an angle, or about an axis: so do units that depend on it
    # what its gap or its coordinate is: angle, stroke, distance; solve/march/spread.py
    travel: str = ""
    kink: float = float("inf")  # |gap| at which it passes from one of two branches to the other
    speed: int = -1  # entry of S of which only the rate is there, that of what it travels
    unheld: str = ""  # the row of its element that holds nothing here
    reads: frozenset[str] = frozenset()  # sensors its functions depend on
    piston: int = -1  # entry of z with the stroke of a piston that a supply moves
    slip: int = -1  # and with its rate less that of the prescribed motion
    length: float = 0.0  # m, as drawn, of the line it drives the ends of apart
    relates: tuple[int, ...] = ()  # entries of S with the coordinates a joint relates
    named: tuple[tuple[int, ...], ...] = ()  # frames of each of its rows, where not those of `con`
    leaps: float = 0.0  # N, by how much its force jumps where its coordinate passes zero
    rubs: str = ""  # the joint whose reaction makes its friction
    said: str = ""  # what `check` says of it beside its words in the scenario
    parts: tuple["Row", ...] = ()  # rows of their own that belong to it: NAME.1, NAME.2, ...
    # of what rubs, for a load of 1: stiffness and damping at rest, 1/m and s/m; the rate at which
    # bristles follow a speed of 1, 1/m
    grips: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def with_con(self, con: Iterable[int]) -> "Row":
        """The same with other columns of con; `replace` asks for every field one by one."""
        row = object.__new__(type(self))
        vars(row).update(vars(self), con=tuple(con))
        return row

    def frames(self, index: int) -> tuple[int, ...]:
        """The frames that a constraint row of it names, each once, in the order of its lines of J:
        unless it says otherwise the first two columns of con."""
        return self.named[index] if self.named else self.con[:2]


class Reach(NamedTuple):
    """What an instance does that could leave the x-y plane; see assemble/planar.py.

    Directions and points are (frame, three numbers in the axes of the frame, from its centre).
    """

    hinges: tuple = ()  # axes bodies turn about
    slides: tuple = ()  # directions bodies slide along
    forces: tuple = ()  # directions of forces
    torques: tuple = ()  # axes of torques
    lines: tuple = ()  # (i, point, j, point): a force between two points
    places: tuple = ()  # (frame, point, frames): where a force acts, and on which bodies
    tensors: tuple = ()  # (frame, three axes, three numbers, whether of turns): linear laws
    shown: tuple = ()  # directions of what is read
    about: tuple = ()  # axes about which turns are read
    always: bool = False  # acts at any time and place, so that its forces can be seen at any
    tilts: bool = False  # lets bodies turn out of the plane, though its rows hold in it


class Turning(NamedTuple):
    """How an instance depends on the turns of frames, or acts on them: of a flexible bar in space
    nobody knows how it turns about itself; see assemble/torsion.py and rows.py.

    Points and directions are (frame, three numbers in the axes of the frame, from its centre).
    """

    frames: tuple[int, ...] = ()  # whose turns it feels, or acts on
    points: tuple = ()  # where it pushes or holds: all that it feels of these frames
    axes: tuple = ()  # directions that turn with a frame; zero: several
    torques: tuple = ()  # (frame it turns, frame of its direction, direction)
    held: tuple[int, ...] = ()  # frames whose turns it resists


class Springs(NamedTuple):
    """Directions in which springs hold two bodies."""

    axes: tuple[tuple[float, ...], ...]  # three, in the axes of the first body
    place: tuple[float, ...]  # in the axes of the second one
    along: tuple[float, ...]  # stiffness along each of the three there
    about: tuple[float, ...]  # and about each


def ends(row: Row) -> frozenset[int]:
    """The frames of its rows; of most elements the first two columns of con."""
    return frozenset(row.con[:2]).union(*row.named)


@dataclass(frozen=True)
class Element:
    """One kind of element, as the rest of trsim sees it."""

    key: str  # the word in the scenario file, and the name of the module
    section: str  # where it stands in the scenario
    spec: type
    pack: Callable  # (name, spec, at) -> Row
    # (scenario, bodies) -> (name, spec) of each that a key of the scenario makes; of no section
    of_scenario: Callable[[Any, dict], Iterable[tuple[str, Any]]] = lambda *_: ()
    rows: tuple[str, ...] = ()  # names of the constraint rows of an instance
    holds: tuple[str, ...] = ()  # of a joint, what each row holds; see rows.py
    coordinates: tuple[str, ...] = ()  # what a joint, or a sensor without one, has: angle, stroke
    channels: tuple[Channel, ...] = ()
    loads: dict[str, str] = field(default_factory=dict)  # channels -> names in tables of loads
    acts_on: Callable[[Row], frozenset[int]] = ends  # frames whose motion its forces depend on
    # (row) -> (frame, point in its axes from its centre) of all places where it pushes or holds a
    # body, turns it included; the point is None where nobody can tell it.  None: its rows alone say
    # which bodies it holds
    acts_at: Callable[[Row], tuple] | None = None
    # (row) -> acted.Part of each place at which its rows do a share.  None: all of it at one
    bearings: Callable[[Row], tuple] | None = None
    reach: Callable[[Row], Reach] | None = None  # None: nothing but its rows
    turning: Callable[[Row], Turning] | None = None  # None: of all frames it acts on
    # (row) -> whether its channels are measured in any run, recorded or not: something is judged
    judged: Callable[[Row], bool] = lambda _: False
    # (name, spec, largest) -> what speaks against believing a run, in sentences; see doubts.py
    doubts: Callable[[str, Any, Callable], Iterable[str]] = lambda *_: ()
    # (spec) -> the expression of other sensors that a sensor is short for
    stands_for: Callable[[Any], tuple] | None = None
    # (scene, e): remembers where its body is, as an event puts its rows in force
    hold: Callable[[Scene, int], None] = lambda *_: None
    springs: Callable[[Row], Springs] | None = None  # what they hold is at rest at the start
    elastic: tuple[int, ...] = ()  # columns of par its elastic forces are proportional to
    viscous: tuple[int, ...] = ()  # and those of its material's damping
    # of what rubs: the columns of con and of par with the law, and with the first of its numbers
    slides: tuple[int, int] | None = None
    dear: bool = False  # no joint is released to it where another choice does as well
    sways: bool = False  # of a joint about a point: which turns it leaves is a rotation vector
    # (spec) -> axes of its bodies, as drawn, whose angle is the bend of a joint, or None; None: no
    # joint of this kind has one
    bends: Callable[[Any], tuple | None] | None = None
    meets: bool = False  # its bodies meet at the point `at`
    welds: bool = False  # its two bodies move as one
    pin: tuple[int, ...] = ()  # dimensions, 2 or 3, in which its rows hold a point and nothing else
    bears: bool = True  # of a joint: its reaction is a force and a moment, and is recorded
    in_plane: Callable[[Row], bool] = lambda _: False  # whether it can be solved there alone
    holds_twist: bool = True  # its rows hold how a flexible bar turns about itself
    picture: str = ""  # what it is drawn as in animations, see report/animation/drawing.py
    ideal: str = ""  # the element it is where it has no clearance
    n_mem: int = 0  # columns of mem of its own, behind the N_MEM of all
    kernels: dict[str, Compiled] = field(default_factory=dict)
    example: str = ""  # a scenario that runs, as short as it can be

    @property
    def reactions(self) -> tuple[Channel, ...]:
        return REACTIONS if self.section == "joints" and self.rows and self.bears else ()
