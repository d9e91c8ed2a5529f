"""What speaks against believing a run: of its start and of how it went, each with its numbers.

start      a position or a velocity is not the one that was given
overlaps   at the start, which throw bodies apart                              overlaps.py
contacts   pressed in by more than their law is made for: a half width of the contact of half the
           radius, a^2 = d R_i R_j / c = (R/2)^2 or d = c/4, and a twentieth of the radius
bars       strained by more than a linear law holds                                    strained.py
elements   what they say themselves: a bushing turned to half a turn, gears that hardly moved
meshes     of bars bent further than their elements follow                           mesh_error.py
turns      too fast for a fixed step
sizes      of bodies so far apart that the smallest may turn as it likes                sizes.py
waves      of bars that steps were too long to follow: no fault, but to be known
rounding   steps were judged by what rounding lets be seen                       march/rounding.py
vibrations are too small for the tolerance, but not their accelerations                   faint.py
energy     the book of the run does not close
hinges     that came apart with a drive or a lock on them                              unhinged.py
branches   the run changed from one to another where they nearly meet                   crossed.py
sections   have points between swings that are not resolved                              swings.py
extremes   of forces are chance, next to where rows depend on each other                 chance.py
rows       that were left out as redundant are open, though not so far that the run ended
friction   in several joints may not have been the only one that fits
"""

from collections.abc import Iterator
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim import elements
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.onward import undecided
from trsim.assemble.reduce import closest, world_rates
from trsim.elements.contract import STORED
from trsim.elements.scene import PROJECTION, scene, workspace
from trsim.scenario.methods import METHODS
from trsim.solve.diagnose.adrift import of_drift
from trsim.solve.diagnose.bar_scales import largest
from trsim.solve.diagnose.chance import GIVEN, closes, of_extremes, too_much_given
from trsim.solve.diagnose.crossed import of_branches
from trsim.solve.diagnose.faint import of_vibrations
from trsim.solve.diagnose.mesh_error import of_meshes
from trsim.solve.diagnose.overlaps import of_overlaps
from trsim.solve.diagnose.sizes import of_sizes
from trsim.solve.diagnose.skipped import unread
from trsim.solve.diagnose.strained import of_bars
from trsim.solve.diagnose.swings import of_sections
from trsim.solve.diagnose.unended import of_phases
from trsim.solve.diagnose.unhinged import of_hinges
from trsim.solve.march.openings import apart
from trsim.solve.march.record import Record
from trsim.solve.methods.rk4 import PER_RADIAN
from trsim.solve.outcome import NOTHING, Outcome, natural, whose
from trsim.solve.start.angles import follow
from trsim.solve.start.bars import places
from trsim.solve.start.consistent import Start
from trsim.solve.start.projected import given_velocities, projected
from trsim.statuses import WELL

Array = NDArray[np.float64]

MOVED, TURNED = 1e-4, 1e-3  # of the mechanism's size, rad: more than the digits of a drawing
SETTLED, SETTLED_TURN = 0.01, 0.05  # the same: more than what is ordinary of a balance
FAR, TURNED_FAR = 0.1, 0.5  # the same: a balance is no longer the one next to a drawing
VELOCITIES = (("velocity", "m/s", slice(3)), ("angular_velocity", "rad/s", slice(3, 6)))
CHANGED = 1e-3  # of a speed that was given
OF_CLEARANCE, OF_RADIUS = 0.25, 0.05  # penetrations
LOST = 1e-3  # of the largest energy exchanged: a run that loses more says so
WORKS = 1e-3  # the same of works in fixed steps, which no error control lengthens or shortens
AT_REST = 1e-9  # of the largest stored energy: kinetic energy of what does not move
COARSE = 0.2  # rad in a fixed step: 31 steps a turn
PASSED = 2.0  # periods of the fastest wave in a mean step
TOLD = 3  # jumps of velocities, one by one
ROUNDED = 2.0  # times what a tolerance allows: rounding is not known any better
OPEN = 1e-5  # of the mechanism's size: joints open by more, without projection


def doubts(scenario: Any, mechanism: Mechanism, outcome: Outcome) -> tuple[str, ...]:
    """Sentences "section.name: what; what to do"."""
    at_start = replace(mechanism, model=scene(mechanism.model))  # one workspace for all of it
    return (
        *unread(scenario),
        *of_start(scenario, at_start, outcome.start),
        *of_overlaps(at_start, outcome.start),
        *of_contacts(scenario, mechanism, outcome.peaks),
        *of_elements(scenario, mechanism, outcome.peaks),
        *of_meshes(scenario, mechanism, outcome.bent),
        *of_bars(scenario, mechanism, outcome.peaks),
        *of_turns(scenario, outcome),
        *of_sizes(scenario, mechanism, outcome),
        *of_waves(mechanism, outcome),
        *of_rounding(scenario, mechanism, outcome),
        *of_vibrations(scenario, mechanism, outcome),
        *of_books(scenario, mechanism, outcome),
        *of_rows(mechanism, outcome),
        *of_hinges(mechanism, outcome.record),
        *of_events(outcome),
        *of_phases(mechanism, outcome),
        *of_branches(mechanism, outcome.record),
        *of_sections(scenario, mechanism, outcome.record),
        *of_drift(scenario, mechanism, outcome.record),
        *of_extremes(scenario, mechanism, outcome),
        *of_friction(mechanism, outcome),
        *outcome.said,
    )


def of_friction(mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """Frictions that feed each other so much that there might be other solutions."""
    many = int(outcome.statistics.get("unproved_frictions", 0))
    if many:
        names = [i.name for i in mechanism.instances if i.row.rubs]
        yield (
            f"forces.{names[0]}: in {many} evaluations friction of {', '.join(names)} feeds on "
            "itself so much that it is not proved to be the only one that fits; all starts looked "
            "at led to it; compare with smaller coefficients, or with a spring between the bodies"
        )


def of_start(scenario: Any, mechanism: Mechanism, begun: Start) -> Iterator[str]:
    """Positions and velocities that had to give way to joints and drives."""
    initial, static = scenario.initial, mechanism.stages.switches.static
    rests = METHODS[scenario.solver.method].rests or (any(static) and static[0])
    work = workspace(mechanism.model)
    mechanism = replace(mechanism, model=work)  # one workspace for all of it
    p = projected(mechanism, as_joined(mechanism, begun) if rests else begun)
    asked = initial.settles or initial.values  # then it is moved on purpose
    if not asked and p.shift > MOVED * mechanism.model.size:
        yield (
            f"bodies.{p.shift_body}: starts {p.shift:.2g} m from where it is drawn, to meet joints "
            "and drives at t = 0; correct the points"
        )
    elif not asked and p.turn > TURNED:
        yield (
            f"bodies.{p.turn_body}: starts turned by {p.turn:.2g} rad against the drawing, to meet "
            "joints and drives at t = 0; correct the points"
        )
    elif not asked and rests:
        yield from of_balance(mechanism, begun)
    rows = undecided(work, begun.y)
    if rows:
        names = dict.fromkeys(mechanism.rows[k].rpartition(".")[0] for k in rows)
        yield (
            f"joints.{next(iter(names))}: the run begins at rest where branches of the motion meet "
            f"({', '.join(names)} depend on each other as drawn), and the forces ask for none of "
            "them: which way it goes is not determined, nor are the accelerations there; give it a "
            "velocity, or draw it a little on its way"
        )
    given = twists(mechanism, begun, given_velocities(mechanism, begun))
    real = twists(mechanism, begun, world_rates(mechanism.model, begun.y).reshape(-1, 6))
    for name in given:
        for key, unit, part in VELOCITIES:
            was, now = (v[name][part] for v in (given, real))
            size = float(np.linalg.norm(was))
            if np.linalg.norm(now - was) > CHANGED * size > 0.0:
                yield (
                    f"bodies.{name}.{key}: given as {vector(was, size)}, starts with "
                    f"{vector(now, size)} {unit}, the nearest that joints and drives allow; give "
                    "velocities that fit together"
                )


def as_joined(mechanism: Mechanism, begun: Start) -> Start:
    """A start as joints and drives alone change the drawing, without the balance behind it."""
    y, _ = closest(workspace(mechanism.model), 0.0, follow(mechanism, mechanism.y0))
    return replace(begun, y=y)


def of_balance(mechanism: Mechanism, begun: Start) -> Iterator[str]:
    """A balance to begin in that is far from the drawing: there may be a nearer one."""
    p, size = projected(mechanism, begun), mechanism.model.size
    if p.shift > FAR * size or p.turn > TURNED_FAR:
        one, other = (f"{p.shift_body}", f"{p.shift:.2g} m away from where")
        if p.shift <= FAR * size:
            one, other = f"{p.turn_body}", f"turned by {p.turn:.2g} rad from how"
        yield (
            f"bodies.{one}: in the balance that the path begins in it is {other} it is drawn: is "
            "it the one meant? draw it near that one"
        )


def settled(scenario: Any, mechanism: Mechanism, begun: Start) -> str:
    """How far the equilibrium of the start moved a body, in words; empty where that is next to
    nothing, or no equilibrium was asked for, or values of joints moved it as well."""
    initial, static = scenario.initial, mechanism.stages.switches.static
    rests = METHODS[scenario.solver.method].rests or (any(static) and static[0])
    if initial.values or not (rests or initial.settles):
        return ""
    p, joined = (projected(mechanism, one) for one in (begun, as_joined(mechanism, begun)))
    if p.shift - joined.shift > SETTLED * mechanism.model.size:
        return f"the equilibrium at the start moved '{p.shift_body}' by {p.shift:.3g} m"
    if p.turn - joined.turn > SETTLED_TURN:
        return f"the equilibrium at the start turned '{p.turn_body}' by {p.turn:.3g} rad"
    return ""


def twists(mechanism: Mechanism, begun: Start, rates: Array) -> dict[str, Array]:
    """Velocity and angular velocity (6) of each body; of a flexible bar those of its chord."""
    model = mechanism.model
    found = {n: rates[f - 1] for n, f in mechanism.frames.items() if 0 < f < model.n_r}
    for name, beam in mechanism.beams.items():
        r, _ = places(mechanism, beam, begun.y)
        first, last = rates[beam.first - 1, :3], rates[beam.first + beam.nodes - 2, :3]
        chord = r[-1] - r[0]
        spin = np.cross(chord, last - first) / (chord @ chord)
        found[name] = np.concatenate([0.5 * (first + last), spin])
    return found


def vector(v: Array, size: float) -> str:
    """Three numbers; what is nothing to a size is rounding."""
    return "[" + ", ".join(f"{x if abs(x) > 1e-9 * size else 0.0:.4g}" for x in v) + "]"


def of_contacts(scenario: Any, mechanism: Mechanism, peaks: Array) -> Iterator[str]:
    """Journals that went deeper than their law holds."""
    column = {c.name: c.start for c in mechanism.columns}
    for name, joint in scenario.joints.items():
        if f"{name}.penetration" not in column or not elements.load(joint.type).ideal:
            continue
        depth, when = peaks[column[f"{name}.penetration"], :2].tolist()
        law = scenario.contact_laws.get(joint.contact) or next(iter(scenario.contact_laws.values()))
        c, R = joint.clearance, law.bearing_radius or np.inf
        # the cylinder's law knows how far a contact wraps around its pin
        if depth > OF_RADIUS * R or (depth > OF_CLEARANCE * c and law.stiffness != "cylinder"):
            radius = (
                f" and {depth / R:.2g} of the radius ({1e3 * R:.3g} mm)" if np.isfinite(R) else ""
            )
            yield (
                f"joints.{name}: the journal is pressed in by {1e3 * depth:.3g} mm at "
                f"{when:.4g} s, {depth / c:.2g} of the clearance ({1e3 * c:.3g} mm){radius}; its "
                f"law holds to about {OF_CLEARANCE:g} and {OF_RADIUS:g} of them: check stiffness, "
                "moduli and loads"
            )


def of_elements(scenario: Any, mechanism: Mechanism, peaks: Array) -> Iterator[str]:
    """What elements themselves say, by the largest sizes of channels in the run."""
    model, column = mechanism.model, {c.name: c.start for c in mechanism.columns}
    vectors = model.vector.tolist()

    def largest(channel: str, signed: bool = False) -> tuple[float, float]:
        """The largest size of a channel, or value, and when; 0 of one that is not recorded."""
        start = column.get(channel, -1)
        if start in vectors:
            start = model.n_out + vectors.index(start)
        high, at, low, then = peaks[start, :4].tolist() if start >= 0 else (0.0,) * 4
        return (high, at) if signed or high >= -low else (-low, then)

    for instance in mechanism.instances:
        entries = getattr(scenario, instance.section, {})
        if instance.entry in entries and not instance.row.parts:
            yield from instance.element.doubts(instance.name, entries[instance.entry], largest)
            yield from beyond_law(instance, *largest(f"{instance.name}.penetration", signed=True))


def beyond_law(instance: Any, depth: float, when: float) -> Iterator[str]:
    """A contact that was pressed in deeper than its law is given."""
    contact = instance.row.contact
    if contact is not None and depth > contact.known_to:
        yield (
            f"{instance.section}.{instance.name}: a penetration of {depth:.3g} m at {when:.4g} s "
            f"is beyond the last row of its table, {contact.known_to:.3g} m, where the force goes "
            "straight on; give the table more rows"
        )


def of_turns(scenario: Any, outcome: Outcome) -> Iterator[str]:
    """What a fixed step makes of the fastest turn: no tolerance holds it."""
    turn = float(outcome.record.step_turn)
    if turn > COARSE:
        step, order = scenario.solver.step, METHODS[scenario.solver.method].order
        yield (
            f"solver.step: a body turns by up to {turn:.2g} rad in a step of {step:.3g} s, which "
            f"makes RK4 err by about {turn**order / PER_RADIAN:.1g} of it, step after step; take "
            f"at most {step * COARSE / turn:.2g} s, or a method that chooses its steps"
        )


def of_waves(mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """Motion of flexible bars that implicit steps went past: it is damped out, not followed."""
    energy = outcome.peaks[mechanism.model.column_energy :, 0]
    if energy[0] <= AT_REST * np.max(np.abs(energy[1 : 1 + len(STORED)])):
        return
    steps, end = outcome.statistics["steps"], float(outcome.record.t)
    for name, beam in mechanism.beams.items():
        cells = (beam.length, beam.nodes - 1)
        fastest = largest(beam.stiffness, beam.bending, beam.per_length, *cells)
        if steps and end / steps > PASSED * 2.0 * pi / fastest:
            yield (
                f"bodies.{name}: steps of {end / steps:.2g} s on average passed over its fastest "
                f"waves ({fastest / (2.0 * pi):.2g} Hz) where the tolerance let them; a smaller "
                f"tolerance, or `max_step: {1.0 / fastest:.1g} s`, follows them"
            )


def of_jumps(mechanism: Mechanism, r: Record) -> Iterator[str]:
    """Rates of drives that jumped, with the impulses they meant."""
    many = int(r.n_jolts)
    for t, e, rate, impulse, work in r.jolt[: min(many, TOLD)].tolist():
        instance = mechanism.instances[int(e)]
        turn, of = ("rad/s", "N*m*s") if instance.row.turns else ("m/s", "N*s")
        yield (
            f"drives.{instance.name}: its velocity jumps by {rate:.4g} {turn} at t = {t:.6g} s: an "
            f"impulse of {impulse:.4g} {of}, which does {work:.4g} J (energy.work.events)"
        )
    if many > TOLD:
        yield f"velocities of drives jump {many - TOLD} times more: see the table of events"


def of_rounding(scenario: Any, mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """A tolerance below what the arithmetic can tell."""
    rounded = outcome.statistics.get("rounding_of_tolerance", 0.0)
    if rounded <= ROUNDED:
        return
    what = whose(mechanism, int(outcome.record.rounded_at))
    much, inside = outcome.record.rounded_by, f" in {what}" if what else ""
    yield (
        f"solver.tolerance: rounding makes up to {much:.2g} (SI) of a step{inside}, {rounded:.2g} "
        f"times what {scenario.solver.tolerance:g} allows; such steps were held to the rounding "
        "instead, since shorter ones are no better.  A larger tolerance costs less and loses "
        "nothing there; masses, inertias or stiffnesses far apart and places far from the origin "
        "are what makes it large"
    )


def of_books(scenario: Any, mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """An open energy book, work of the projection, open joints; nothing of what is at rest."""
    numbers = outcome.statistics
    least = NOTHING * natural(mechanism.model, outcome.start)
    work = abs(numbers.get("work_of_projection", 0.0))
    lost = numbers.get("energy_residual_relative", 0.0)
    if lost > LOST:
        hidden = "rounding_of_tolerance" in numbers
        smaller = "make `step` smaller" if scenario.solver.step else "tighten `tolerance`"
        remedy = "rounding has its part in it" if hidden else smaller
        yield (
            f"the energy book does not close, by {100 * lost:.2g} % of the largest energy "
            f"exchanged; {remedy}"
        )
    off = numbers.get("work_error_relative", 0.0)
    if np.any(outcome.record.worked) and off > WORKS:
        yield (
            "steps are so long that the works of the energy book are wrong by about "
            f"{100 * off:.2g} % of the largest energy exchanged, however well it closes: make "
            "`step` smaller"
        )
    yield from of_jumps(mechanism, outcome.record)
    given = numbers.get("work_of_projection_relative", 0.0)
    if too_much_given(scenario, outcome) and work > least and outcome.status in WELL:
        yield (
            f"bringing the mechanism back to its joints and drives did {100 * given:.2g} % of the "
            f"largest energy exchanged{brought_back(given, closes(mechanism.model))}"
        )
    apart = numbers.get("joints_open_relative", 0.0)
    if apart > OPEN and mechanism.model.stabilisation != PROJECTION:
        yield (
            f"joints were open by up to {apart:.2g} of the mechanism's size; "
            "`stabilisation: projection` closes them"
        )


def brought_back(given: float, near: bool) -> str:
    """Why, and what to do.  near: rows of joints may come to depend on each other."""
    if near and given <= GIVEN:
        return (
            ", and what follows is off by as much: where rows of joints nearly depend on each "
            "other, rounding makes steps short, and each of them is brought back.  Another "
            "`tolerance` may need fewer steps there; clearance or compliance in a joint avoids it"
        )
    bends = (
        "Or do branches of the motion nearly meet, so that it turns sharply there and rows on "
        "the way may be those of the other branch?  "
        if near
        else ""
    )
    return f"; does a drive jump?  {bends}Else `tolerance` or the step is too coarse"


def of_events(outcome: Outcome) -> Iterator[str]:
    """Steps in which a touch or an event could not be excluded."""
    if n := outcome.statistics.get("unproved_searches", 0):
        yield (
            f"solver.max_step: in {n:.0f} steps a touch or an event may have been passed over, "
            "because a gap stays next to zero all along; take a shorter `max_step`"
        )
    if n := outcome.statistics.get("unfollowed_steps", 0):
        yield (
            f"solver.step: {n:.0f} times more happened within a step than sections and events can "
            "follow; points or events may be missing: take a shorter step"
        )


def of_rows(mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """Redundant rows that were open by more than the accuracy asked for."""
    if outcome.status not in WELL:
        return
    if text := apart(mechanism, outcome.record):
        yield text
