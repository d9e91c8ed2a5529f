"""Documents about result files."""

from typing import Literal, NotRequired, Required

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.cli.documents.certificate import Certificate
from trsim.cli.documents.common import Document, Number, Result, of
from trsim.cli.documents.runs import Contact, Results, Statistics
from trsim.report.asked import Value
from trsim.statuses import Status
from trsim.store.describe import PACKAGES
from trsim.store.points import Dispersion


class Solver(Statistics, total=False):
    """The settings of the solver, and what it did; nothing in a file that was not completed.

    method         as in the scenario, all of these
    formulation    of the equations of motion
    end            s
    step           s
    tolerance      of the run
    stabilisation  of the constraints
    first_step     s
    max_step       s
    max_steps      of a run
    locate_events  whether steps end where contacts open or close
    force          whether a warning was overruled
    rounding_of_tolerance  what rounding made of a step at most, in units of what the tolerance
                           allows; there where it is more
    unproved_frictions     evaluations whose friction in joints was not proved to be the only one
                           that fits; there where there were some
    unfollowed_steps       looks into a step in which more happened than sections and events can
                           follow; there where there were some
    lowest_eigenvalue      of stiffness against mass along a static path, 1/s^2
    lowest_eigenvalue_time  when, s
    inertia_ratio          what inertia would change of the force of a drive of a static path, at
                           most, over the largest that it has
    inertia_ratio_time     when, s
    """

    method: str
    formulation: str
    end: Number
    step: Number
    tolerance: Number
    stabilisation: str
    first_step: Number
    max_step: Number
    max_steps: int
    locate_events: bool
    force: bool
    rounding_of_tolerance: Number
    unproved_frictions: int
    unfollowed_steps: int
    lowest_eigenvalue: Number
    lowest_eigenvalue_time: Number
    inertia_ratio: Number
    inertia_ratio_time: Number


class Summary(TypedDict, total=False):
    """A run in a few numbers; contacts alone in a file that was not completed.

    time      simulated until, s
    rows      output rows
    events    of contacts and of the solver
    contacts  by name
    """

    time: Number
    rows: int
    events: int
    contacts: Required[dict[str, Contact]]


Versions = TypedDict("Versions", dict.fromkeys(PACKAGES, str), total=False)  # type: ignore[misc]


class Provenance(Versions, total=False):
    """Where the file comes from: command, machine, versions; times in s.

    twin_integration_cpu  of the twin of a certified run, s
    keys                  of a twin: what its run depends on
    """

    command: str
    machine: str
    platform: str
    processors: int
    began: str
    resumed: int
    resumed_at: str
    wall_time: Number
    cpu_time: Number
    integration_cpu: Number
    trsim: str
    python: str
    hdf5: str
    twin_integration_cpu: Number
    keys: str
    recovered_from: str
    recovered_by: str


class Show(Document, Result):
    """trsim show.

    file            as given
    format          of all result files
    format_version  of this one
    status          how the run stands or ended
    reason          why
    content_sha256  of all results; only in a complete file
    verified        true if --verify found the same hash; otherwise null
    rows            output rows that can be read
    channels        name -> unit
    summary         the run in a few numbers
    solver          its settings, and what it did
    warnings        what looked wrong: in the scenario, at the start, in the results
    redundant       constraint rows left out of the solve, "joint.axis"
    provenance      where the file comes from
    phase           names of phase portraits
    poincare        section -> number of points
    dispersion      section -> how far its points lie apart
    certificate     what a twin says of the run, where it had one
    values          the numbers that were asked for
    """

    format: str
    format_version: int
    status: Status
    content_sha256: NotRequired[str]
    verified: Literal[True] | None
    rows: int
    channels: dict[str, str]
    summary: Summary
    solver: Solver
    provenance: Provenance
    phase: list[str]
    poincare: dict[str, int]
    dispersion: dict[str, of(Dispersion)]
    certificate: NotRequired[Certificate]
    values: NotRequired[list[of(Value)]]


class Report(Document):
    """trsim report.

    folder  of the figures and tables
    files   written, in that folder
    values  numbers of the analyses that were asked for
    told    what they say in words: how a number was made, why there is none, what speaks against it
    """

    folder: str
    files: list[str]
    values: NotRequired[list[of(Value)]]
    told: NotRequired[list[str]]


class Export(Document):
    """trsim export.

    file      written
    rows      lines after the first, or frames
    channels  columns after the time; components of vectors are NAME.x, NAME.y, NAME.z
    """

    file: str
    rows: int
    channels: list[str]


class Recover(Document, Results):
    """trsim recover.

    file            the result file that was made
    part            the file it was made of
    was             the status of that, or ?
    title           of the scenario
    status          of the new file
    reason          the same in words
    content_sha256  of all results
    """

    file: str
    part: str
    was: Status | Literal["?"]
    title: str
    status: Status
    reason: str
    content_sha256: str
