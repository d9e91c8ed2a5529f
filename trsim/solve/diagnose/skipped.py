"""What a run of this scenario leaves out, and why: every line is a branch of the code not taken."""

from collections.abc import Iterator
from typing import Any

from trsim import elements
from trsim.assemble.layout import all_names
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.sections import without_play
from trsim.errors import some
from trsim.instants import peaked
from trsim.varying import FunctionSpec

UNREAD = ("cases", "sweep")  # keys a scenario may have that `run` does not act on
SHOWN = 4  # names of a list


def skipped(scenario: Any, mechanism: Mechanism) -> tuple[str, ...]:
    """Sentences "what: why"."""
    parts = (_rows, _bars, _contacts, _stabilisation, _start, _peaks, _channels, _points)
    texts = (text for part in parts for text in part(scenario, mechanism))
    return (*texts, *unread(scenario))


def _rows(scenario: Any, mechanism: Mechanism) -> Iterator[str]:
    """Unknowns and constraint rows that are not solved for."""
    model = mechanism.model
    if mechanism.planar:
        rows = sum(len(i.element.rows) for i in mechanism.instances if i.section == "joints")
        inside = len(mechanism.unique) + len(mechanism.not_unique)
        drives = sum(name.split(".")[0] in scenario.drives for name in mechanism.rows)
        yield (
            "motion out of the plane: planar, so 3 of 6 unknowns of a body are solved and "
            f"{rows + drives - inside} rows of the joints are not needed; reactions out of the "
            "plane are reported as zero"
        )
    if mechanism.redundant:
        yield (
            f"{len(mechanism.redundant)} redundant rows ({some(mechanism.redundant, SHOWN)}): the "
            f"other rows hold the mechanism; reactions are those of least norm"
        )
    if model.m == 0:
        yield "constraints: no joint or drive has a row in the solve, so nothing is factorised"


def _bars(scenario: Any, mechanism: Mechanism) -> Iterator[str]:
    """What the elements of flexible bars leave out."""
    if not mechanism.beams:
        return
    twist = "" if mechanism.planar else ", and what would need it is refused"
    yield (
        f"torsion and shear of {some(mechanism.beams, SHOWN)}: elements of flexible bars stretch "
        f"and bend, and do not twist{twist}; rotary inertia of their sections is left out too"
    )


def _contacts(scenario: Any, mechanism: Mechanism) -> Iterator[str]:
    """Events and friction."""
    number, solver = len(mechanism.model.contact), scenario.solver
    if number == 0:
        yield "contact events: no joint has clearance and there is no limit stop"
    elif not solver.locates:
        told = solver.locate_events is False
        why = "`locate_events: false`" if told else f"{solver.method} has a fixed step"
        yield f"location of touches: {why}, a contact begins at the end of a step"
    joints = [j for j in scenario.joints.values() if elements.load(j.type).ideal]
    ideal = [n for n, j in scenario.joints.items() if getattr(j, "clearance", None) == 0.0]
    if ideal:
        yield f"play of {some(ideal, SHOWN)}: clearance 0 is an ideal joint"
    frictions = [law.friction.law for law in scenario.contact_laws.values()]
    if joints and all(law == "none" for law in frictions):
        yield "friction: no contact law has any"


def _stabilisation(scenario: Any, mechanism: Mechanism) -> Iterator[str]:
    kind = scenario.solver.stabilisation
    if mechanism.model.m and kind != "projection":
        yield f"projection to the constraints: `stabilisation: {kind}`"


def _start(scenario: Any, mechanism: Mechanism) -> Iterator[str]:
    if not any(scenario.gravity):
        yield "weight: `gravity` is not given"
    if scenario.solver.end is None:
        yield "a run: `solver.end` is not given, and `trsim run` asks for it"
    if not scenario.initial.settles:
        yield "static equilibrium: `initial` asks for none, the start is as drawn"


def _peaks(scenario: Any, mechanism: Mechanism) -> Iterator[str]:
    """Smooth loads that may be short events which only the stages of steps see."""
    found = [
        name for name, load in scenario.forces.items() if any(map(_peaked, vars(load).values()))
    ]
    if found and scenario.solver.max_step is None:
        yield (
            f"a search inside steps for narrow peaks of {some(found, SHOWN)}: quotients and powers "
            "of what varies have no edges as exp has; `solver: {max_step: ...}` bounds the steps"
        )


def _peaked(value: Any) -> bool:
    return isinstance(value, FunctionSpec) and value.kind == "expression" and peaked(value.node)


def _channels(scenario: Any, mechanism: Mechanism) -> Iterator[str]:
    """Channels nobody asked for."""
    wanted = {c.name for c in mechanism.columns if c.wanted}
    every = [
        n for n in all_names(mechanism.instances, mechanism.model.jumps) if "." in n or n in wanted
    ]
    missing = [name for name in every if name not in wanted]
    if missing:
        yield f"{len(missing)} of {len(every)} channels: `output.channels` does not ask for them"


def _points(scenario: Any, mechanism: Mechanism) -> Iterator[str]:
    """Sections and portraits in a bearing that has no play here."""
    for name, spec in scenario.poincare.items():
        if joint := without_play(scenario, (spec.when, spec.at_onset, *spec.plot)):
            yield f"section '{name}': the clearance of {joint} is 0"
    for name, spec in scenario.phase_portraits.items():
        if joint := without_play(scenario, (spec.x, spec.y)):
            yield f"phase portrait '{name}': the clearance of {joint} is 0"


def unread(scenario: Any) -> Iterator[str]:
    """Sections that `run` reads and does not act on."""
    given = [key for key in UNREAD if getattr(scenario, key)]
    if given:
        yield f"`{'`, `'.join(given)}`: one run takes the scenario as it stands outside of them"
