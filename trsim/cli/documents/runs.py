"""Documents about scenarios that are run."""

from typing import NotRequired

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.cli.documents.certificate import Certified
from trsim.cli.documents.common import Document, Number, Result, Subject, of
from trsim.solve.rest import Resting
from trsim.statuses import Ended


class Contact(TypedDict):
    """What happened in one contact.

    impacts         onsets
    fastest_impact  approach speed, m/s or rad/s
    peak_force      largest contact force, N or N*m
    peak_time       when, s
    steps           accepted steps in touch
    """

    impacts: int
    fastest_impact: Number
    peak_force: Number
    peak_time: Number
    steps: int


class Statistics(TypedDict, total=False):
    """What the solver did.

    steps                     accepted
    rejected_steps            made again, smaller
    evaluations               right-hand sides
    factorisations            of the constraint matrix
    dense_outputs             interpolants made
    events                    onsets and separations located
    unproved_searches         searches for an event in a step that gave up; 0 where all is proved
    corners                   of friction laws, passed
    method_switches           between the explicit and the implicit method
    jacobians                 made by the implicit method
    newton_iterations         of the implicit method
    position_residual         largest of the constraints, m or rad
    velocity_residual         largest of the constraints, m/s or rad/s
    start_position_residual   removed by closing the joints at the start, m or rad
    start_force_residual      left by the equilibrium, N
    energy_residual           largest error of the energy book, J
    energy_residual_relative  the same over the largest energy exchanged
    work_error_relative       of the works in the energy book, estimated step by step and summed,
                              over the largest energy exchanged; 0 with a method of scipy
    work_of_projection        J
    work_of_projection_relative  its size over the largest energy exchanged
    joints_open_relative      largest open constraint over the mechanism's size: without projection
                              any, with it of the rows left out as redundant
    redundant_open_relative   largest opening of rows left out as redundant, over the mechanism's
                              size, of angles in rad
    redundant_open_rate       the same of their rates, 1/s
    """

    steps: int
    rejected_steps: int
    evaluations: int
    factorisations: int
    dense_outputs: int
    events: int
    unproved_searches: int
    corners: int
    method_switches: int
    jacobians: int
    newton_iterations: int
    position_residual: Number
    velocity_residual: Number
    start_position_residual: Number
    start_force_residual: Number
    energy_residual: Number
    energy_residual_relative: Number
    work_error_relative: Number
    work_of_projection: Number
    work_of_projection_relative: Number
    joints_open_relative: Number
    redundant_open_relative: Number
    redundant_open_rate: Number


class RunStatistics(Statistics, total=False):
    """What the solver did, and how long it took.

    integration_cpu        s
    rounding_of_tolerance  what rounding made of a step at most, in units of what the tolerance
                           allows; only where that was more than 1
    unproved_frictions     evaluations whose friction in joints was not proved to be the only one
                           that fits; only where there were some
    unfollowed_steps       looks into a step in which more happened than sections and events can
                           follow; only where there were some
    lowest_eigenvalue      of stiffness against mass along a static path, 1/s^2
    lowest_eigenvalue_time  when, s
    inertia_ratio          what inertia would change of the force of a drive of a static path, at
                           most, over the largest that it has
    inertia_ratio_time     when, s
    """

    rounding_of_tolerance: Number
    unproved_frictions: int
    unfollowed_steps: int
    lowest_eigenvalue: Number
    lowest_eigenvalue_time: Number
    inertia_ratio: Number
    inertia_ratio_time: Number
    integration_cpu: Number


class Results(TypedDict):
    """A run in a few numbers.

    time      simulated until, s
    rows      output rows
    events    of contacts and of the solver
    contacts  by name
    """

    time: Number
    rows: int
    events: int
    contacts: dict[str, Contact]


class Ran(Results, Result):
    """A run that ended.

    file            its result file
    status          how it ended; after `failed` the exit code is 5
    reason          why it failed, or which user event ended it
    statistics      what the solver did
    redundant       constraint rows left out of the solve, "joint.axis"
    content_sha256  of all results; the same for the same results
    resumed_from    simulated time of the checkpoint it went on from, s; null without one
    identical       whether they are those of the result file that was run again
    certificate     what a twin says of it, with --certify
    sizing          what each pass left of the force of the drive, of that without the load; with
                    the key `sizing`
    settled         how far the equilibrium it began in is from the drawing, where that is much
    """

    status: Ended
    statistics: RunStatistics
    content_sha256: str
    resumed_from: Number
    identical: NotRequired[bool]
    certificate: NotRequired[Certified]
    sizing: NotRequired[list[Number]]
    settled: NotRequired[str]


class Run(Document):
    """trsim run.

    runs  those that ended, also the failed ones, in the order given
    """

    runs: list[Ran]


class Channel(TypedDict):
    """A channel at rest.

    unit   of it
    value  one number, or the components
    """

    unit: str
    value: list[Number]


class Turned(TypedDict):
    """How a body has turned against the drawing.

    body      its name
    rotation  rotation vector in world axes, rad
    """

    body: str
    rotation: list[Number]


class Statics(Document, Subject):
    """trsim statics.

    file            as given
    result          the result file, of one row
    redundant       constraint rows that others repeat, "joint.axis"
    equilibrium     whether it is stable, and how nearly
    elements        name -> type
    sections        name -> section of the scenario it stands in
    channels        at rest, in SI units; reactions that are not unique are those of least norm
    turns           how bodies have turned
    content_sha256  of the result file
    warnings        what looks wrong in the scenario; a balance that is not stable
    """

    result: str
    equilibrium: of(Resting)
    elements: dict[str, str]
    sections: dict[str, str]
    channels: dict[str, Channel]
    turns: list[Turned]
    content_sha256: str
    warnings: list[str]
