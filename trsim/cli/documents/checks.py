"""Documents about scenarios that are checked."""

from typing import NotRequired

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.assemble import release
from trsim.cli.documents.common import Document, Number, Subject, of
from trsim.frame import Frame
from trsim.scenario.weights import Weight
from trsim.solve.diagnose.bar_scales import BarScale
from trsim.solve.diagnose.mesh_error import MeshError
from trsim.solve.diagnose.modes import Mode
from trsim.solve.diagnose.scales import Scales
from trsim.solve.start.projected import Projected


class Release(of(release.Release, "changes")):
    """What to let go: no row is redundant then, all reactions are unique, no freedom is gained.

    joints  joint -> what it is without its rows, in words; "" where it has no name
    types   joint -> its type in a scenario, where there is one
    """

    joints: dict[str, str]
    types: dict[str, str]


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
    projected: of(Projected)


class ScalesOfRun(of(Scales)):
    """Stiffness and time scales at the start.

    end  of the run, s; null where the scenario has none
    """

    end: Number


class Bar(of(BarScale)):
    """What a flexible bar gives way, and its slowest and fastest motion.

    mesh  what it makes wrong at the start; null: not estimated
    """

    mesh: of(MeshError) | None


class Checked(Subject):
    """What a scenario is once assembled, and what a run of it will meet.

    file               as given
    frame              in which all of it is drawn; null: the world's
    bodies             names
    weights            mass, centre and inertia of each body, and where they come from
    joints             name -> type
    drives             names
    forces             name -> type
    load_sets          load set -> the factor it acts with and its loads, in words
    contacts           names of joints and stops
    events             user event -> when it happens and what it does, in words
    sections           section of a body -> what lies beyond it and what acts there, in words
    pairs              contact law -> what it takes of a pair of materials, with origins
    tables             load or motion -> its variable, its curve, and what it is outside, in words
    planar             whether the motion stays in a plane
    planar_assumed     whether nothing but the start says so
    spatial_because    what reaches out of the x-y plane; none where `planar: false` is given
    unknowns           velocities
    constraints        rows kept, drives included
    mobility_by_count  unknowns less all rows
    kinematic          whether `method: kinematic` takes it: all is driven, and nothing lets go
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

    frame: of(Frame) | None
    bodies: list[str]
    weights: list[of(Weight)]
    joints: dict[str, str]
    drives: list[str]
    forces: dict[str, str]
    load_sets: dict[str, str]
    contacts: list[str]
    events: dict[str, str]
    sections: dict[str, str]
    pairs: dict[str, str]
    tables: dict[str, str]
    planar: bool
    planar_assumed: bool
    spatial_because: list[str]
    unknowns: int
    constraints: int
    mobility_by_count: int
    kinematic: bool
    singular: list[str]
    unique: list[str]
    release: Release | None
    notes: list[str]
    start: Start
    scales: ScalesOfRun
    flexible: list[Bar]
    every: Number
    modes: NotRequired[list[of(Mode)]]
    skipped: list[str]


class Check(Document):
    """trsim check.

    scenarios  those without errors, in the order given
    """

    scenarios: list[Checked]
