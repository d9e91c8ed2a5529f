"""Documents about scenarios that are checked."""

from typing import Literal, NotRequired

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.cli.documents.common import Document, Number


class Release(TypedDict):
    """What to let go: no row is redundant then, all reactions are unique, no freedom is gained.

    rows          "joint.axis", as many as are redundant
    joints        joint -> what it is without its rows, in words; "" where it has no name
    types         joint -> its type in a scenario, where there is one
    alternatives  other choices that are as good; the first in the file is given
    proven        whether nothing depends on anything without these rows, as drawn and nearby
    """

    rows: list[str]
    joints: dict[str, str]
    types: dict[str, str]
    alternatives: int
    proven: bool


class Projection(TypedDict):
    """What the start changed in the drawing.

    position_before  largest residual of the constraints as drawn, m or rad
    position_after   and at the start
    position_row     whose was the largest, "joint.axis"; "" for none
    velocity_before  largest residual of their rates with the velocities given, m/s or rad/s
    velocity_after   and at the start
    velocity_row     whose was the largest
    shift            longest way of a centre of mass from where it is drawn, m
    shift_body       whose
    turn             largest turn of a body from how it is drawn, rad
    turn_body        whose
    slip             largest change of a velocity that was given, m/s
    slip_body        whose
    spin             largest change of an angular velocity that was given, rad/s
    spin_body        whose
    """

    position_before: Number
    position_after: Number
    position_row: str
    velocity_before: Number
    velocity_after: Number
    velocity_row: str
    shift: Number
    shift_body: str
    turn: Number
    turn_body: str
    slip: Number
    slip_body: str
    spin: Number
    spin_body: str


class Start(TypedDict):
    """Where a run would start.

    position_residual  removed by closing the joints, m or rad
    force_residual     left by the equilibrium, N
    length             smallest length that matters to the error norm, m
    speed              the same, m/s
    closed_contacts    contacts in touch
    projected          what the start changed in the drawing
    """

    position_residual: Number
    force_residual: Number
    length: Number
    speed: Number
    closed_contacts: list[str]
    projected: Projection


class ContactScale(TypedDict):
    """How fast a contact is, pressed as the largest force of the start would.

    name           joint or stop
    closed         whether it is in touch at the start
    depth          penetration, m or rad
    force          N or N*m
    stiffness      tangent, N/m or N*m/rad
    mass           that moves, with all joints and drives in force, kg or kg*m^2; null: nothing can
    half_period    of its vibration, s; null where nothing can move
    impact_time    from touch to separation at the slowest impact, s; null where nothing can move
    friction_rate  1/s, of the ramp of modified Coulomb friction; 0 without one
    unit           of the force, N or N*m
    """

    name: str
    closed: bool
    depth: Number
    force: Number
    stiffness: Number
    mass: Number
    half_period: Number
    impact_time: Number
    friction_rate: Number
    unit: str


class Scales(TypedDict):
    """Stiffness and time scales at the start.

    eigenvalues    of the linearised motion, [real, imaginary] in 1/s, largest first, without zeros
    zeros          how many of them are zero
    decay          largest rate at which a motion fades, 1/s; 0 for none
    growth         largest rate at which one grows, 1/s; 0 for none
    frequency      largest, rad/s; 0 for none
    natural_time   slowest period, or the time a motion through the mechanism's size takes, s
    contacts       each contact
    fastest        rate that limits explicit steps, 1/s
    fastest_is     what it is the rate of, in words; "" for nothing
    explicit_step  largest stable step of rk4, s; null where nothing limits it
    end            of the run, s; null where the scenario has none
    """

    eigenvalues: list[list[Number]]
    zeros: int
    decay: Number
    growth: Number
    frequency: Number
    natural_time: Number
    contacts: list[ContactScale]
    fastest: Number
    fastest_is: str
    explicit_step: Number
    end: Number


class Mesh(TypedDict):
    """What the mesh of a flexible bar makes wrong of its shape at the start: an estimate.

    name      of the body
    elements  how many
    error     of the node that is farthest off, m
    relative  of the length
    wanted    elements for a relative error of 1e-4
    """

    name: str
    elements: int
    error: Number
    relative: Number
    wanted: int


class Bar(TypedDict):
    """What a flexible bar gives way, and its slowest and fastest motion.

    name            of the body
    elements        how many
    length          m
    mass            kg
    axial           compliance along it, L/EA, m/N
    bending         across, in the middle between hinges at its ends, L^3/(48 EI), m/N
    cantilever      across, at the end of a cantilever, L^3/(3 EI), m/N
    lowest          bending frequency between hinges, Hz
    wave            time an axial wave takes from end to end, s
    highest         largest frequency of its mesh, Hz
    explicit_step   largest step of rk4 that is stable for it, s
    contact_shares  joint with clearance -> its compliance at the load of the start, as a part of
                    that of contact and bar in line
    mesh            what it makes wrong at the start; null: not estimated
    """

    name: str
    elements: int
    length: Number
    mass: Number
    axial: Number
    bending: Number
    cantilever: Number
    lowest: Number
    wave: Number
    highest: Number
    explicit_step: Number
    contact_shares: dict[str, Number]
    mesh: Mesh | None


class Moved(TypedDict):
    """What a body does in a mode; the largest motion of all is 1.

    body         its name
    translation  x, y, z
    rotation     about x, y, z, rad times the mechanism's size
    """

    body: str
    translation: list[Number]
    rotation: list[Number]


class Mode(TypedDict):
    """A small motion about the start.

    kind           oscillates, decays, grows or free
    frequency      Hz, damped; 0 where it does not oscillate
    damping_ratio  negative where it grows
    rate           real part of the eigenvalue, 1/s
    shape          the bodies that move
    """

    kind: Literal["oscillates", "decays", "grows", "free"]
    frequency: Number
    damping_ratio: Number
    rate: Number
    shape: list[Moved]


class Checked(TypedDict):
    """What a scenario is once assembled, and what a run of it will meet.

    file               as given
    title              of the scenario
    bodies             names
    joints             name -> type
    drives             names
    forces             name -> type
    contacts           names of joints and stops
    events             user event -> when it happens and what it does, in words
    planar             whether the motion stays in a plane
    planar_assumed     whether nothing but the start says so
    spatial_because    what reaches out of the x-y plane; none where `planar: false` is given
    unknowns           velocities
    constraints        rows kept, drives included
    mobility           degrees of freedom by rank, drives counted as constraints
    mobility_by_count  unknowns less all rows
    redundant          rows dropped
    singular           rows that depend on others only as drawn
    unique             reactions that the motion determines
    not_unique         reactions that it does not determine
    release            what to let go of a mechanism with redundant rows; null without them
    notes              what looks wrong
    start              where a run would start
    scales             stiffness and time scales
    flexible           each flexible bar
    every              time between two rows of the output, s; null where it has no end
    modes              small motions about the start, slowest first; with --modes
    skipped            what a run leaves out, and why
    """

    file: str
    title: str
    bodies: list[str]
    joints: dict[str, str]
    drives: list[str]
    forces: dict[str, str]
    contacts: list[str]
    events: dict[str, str]
    planar: bool
    planar_assumed: bool
    spatial_because: list[str]
    unknowns: int
    constraints: int
    mobility: int
    mobility_by_count: int
    redundant: list[str]
    singular: list[str]
    unique: list[str]
    not_unique: list[str]
    release: Release | None
    notes: list[str]
    start: Start
    scales: Scales
    flexible: list[Bar]
    every: Number
    modes: NotRequired[list[Mode]]
    skipped: list[str]


class Check(Document):
    """trsim check.

    scenarios  those without errors, in the order given
    """

    scenarios: list[Checked]
