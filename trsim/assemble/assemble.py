"""Scenario -> Model: pack the elements, drop what the scene does not need, lay out the outputs."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from trsim import elements
from trsim.assemble.addresses import Addresses
from trsim.assemble.build import Parts, as_drawn, build, spans
from trsim.assemble.hubs import hubs
from trsim.assemble.instances import Column, Instance, RowName, Section
from trsim.assemble.jumps import find_jumps
from trsim.assemble.layout import columns_of_forces, layout
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.members import members
from trsim.assemble.planar import Planarity, listed, planarity
from trsim.assemble.reduce import Drawn
from trsim.assemble.rows import (
    all_rows,
    check_inertias,
    check_pressed,
    check_rubbing,
    check_shaky,
    check_space,
    choose_rows,
    dropped,
    reactions,
)
from trsim.assemble.sections import sections
from trsim.assemble.stages import Choice, Stages, silent
from trsim.assemble.switches import SECTION, Switches, locks, parks, switches
from trsim.assemble.tables import drawn
from trsim.assemble.torsion import check_torsion
from trsim.assemble.waves import swinging
from trsim.elements.contract import Pair
from trsim.elements.coordinates import of_joint
from trsim.elements.rows import column_of
from trsim.elements.scene import Model
from trsim.errors import ScenarioError


def assemble(
    scenario: Any,
    ideal: frozenset[str] = frozenset(),
    drives: Mapping[str, Any] | None = None,
    coordinates: tuple[str, ...] = (),
    stiff: bool = False,
    planar: bool | None = None,
) -> Mechanism:
    """Build the model.  Raises ScenarioError, ModelError.

    For the start of a run - ideal: clearance joints to take as ideal ones; drives: drives instead
    of the scenario's; coordinates: joints whose coordinate is needed though nobody asks for it;
    stiff: flexible bars as rigid ones; planar: whether the run is, found out unless given.
    """
    at, instances = pack(scenario, ideal, drives, coordinates, stiff)
    rows = all_rows(instances)
    parts = Parts.of(at, instances)
    look = Drawn.of(*as_drawn(parts, rows), rows)  # one workspace for all
    verdict = planarity(scenario, look, at, instances) if planar is None else Planarity(planar)
    planar = verdict.planar
    check_inertias(at, planar, listed(verdict.reasons))
    if not planar:
        check_space(at, instances)
        if at.beams and drives is None and not ideal:  # of a start the run has said so
            check_torsion(look, at, instances)
    chosen = choose_rows(look, instances, planar)
    kept, found = chosen.kept, chosen.found
    if drives is None and not ideal:  # of a start clearances may be left out
        check_shaky(look, instances, planar, chosen)
    d = 3 if planar else 6
    own = hubs(look, kept, planar, spans(at))
    model = build(parts, kept, d, own, dropped(rows, found), look.scene)
    y0 = drawn(at, d)
    columns: list[Column] = []
    shown: tuple[Section, ...] = ()
    if drives is None and not stiff:  # nobody asks for channels of a start
        fields, columns = layout(scenario, model, instances, at.switches)
        at.switches = replace(at.switches, silent=columns_of_forces(columns, instances))
        fields["silent"] = silent(instances, at.switches)
        waves = swinging(at, instances, at.waves + at.shown)
        of_sections, shown = sections(scenario, fields["heard"], instances, columns, waves)
        model = model.replaced(**fields, **of_sections)
    names = [f"{r.element}.{r.axis}" for r in rows]
    unique, not_unique = reactions(look, chosen, planar)
    if drives is None and not ideal:
        check_pressed(instances, kept, planar)
        check_rubbing(instances, rows, not_unique, found)
    return Mechanism(
        model=model,
        y0=y0,
        instances=tuple(instances),
        columns=tuple(columns),
        planar=planar,
        # what depends on a place that is driven depends on time
        timed=at.timed or (at.sensed and bool(scenario.drives)),
        planar_assumed=verdict.assumed,
        spatial_because=verdict.because(),
        mobility=model.n_v - model.m,
        mobility_by_count=model.n_v - len(unique) - len(not_unique),
        redundant=tuple(names[f.row] for f in found if f.everywhere),
        singular=tuple(names[f.row] for f in found if not f.everywhere),
        unique=tuple(names[k] for k in unique),
        not_unique=tuple(names[k] for k in not_unique),
        rows=tuple(f"{r.element}.{r.axis}" for r in kept),
        follows=tuple(follow for _, follow in at.states),
        coordinates=at.coordinates,
        frames=at.frames,
        beams=at.beams,
        notes=(*verdict.notes(), *notes(scenario), *at.notes, *sampled(at.switches)),
        stages=stages(at, instances, Choice(model, kept, dropped(rows, found)), planar),
        functions=tuple(at.packed_functions),
        guards=tuple(at.guards),
        sections=shown,
    )


def stages(at: Addresses, instances: list[Instance], first: Choice, planar: bool) -> Stages:
    """What user events make of the mechanism; planarity is that of the start.

    Of joints that are proved to move to first order only nothing is asked: each stage has joints of
    the start, and fewer of them hold less.
    """
    d = 3 if planar else 6

    def built(instances: list[Instance], rows: list[RowName]) -> Choice:
        parts = Parts.of(at, instances)
        look = Drawn.of(*as_drawn(parts, rows), rows)
        chosen = choose_rows(look, instances, planar)
        check_rubbing(instances, rows, reactions(look, chosen, planar)[1], chosen.found)
        own, left = hubs(look, chosen.kept, planar, spans(at)), dropped(rows, chosen.found)
        model = build(parts, chosen.kept, d, own, left, look.scene)
        return Choice(model, chosen.kept, left)

    def rebuilt(instances: list[Instance], kept: list[RowName], left: list[RowName]) -> Model:
        parts, rows = Parts.of(at, instances), [*kept, *left]
        own = hubs(Drawn.of(*as_drawn(parts, rows), rows), kept, planar, spans(at))
        return build(parts, kept, d, own, left)

    angles = {} if planar else {x.entry: x for x in at.coordinates.values() if x.kind == "angle"}
    rigid = [i for i in instances if i.section in ("drives", SECTION) and not i.row.is_force]
    turning = [((i.section, i.name), angles.get(Pair.of(i.row).coordinate)) for i in rigid]
    turning += [
        ((i.section, i.name), angles.get(entry)) for i in instances for entry in i.row.relates
    ]
    held = [(of, angle) for of, angle in turning if angle is not None]
    return Stages(at.switches, instances, first, built, rebuilt, held)


def notes(scenario: Any) -> tuple[str, ...]:
    """What the user should know before the run."""
    return tuple(
        f"contact law '{name}': Coulomb friction jumps where sliding stops; expect tiny "
        "steps there, and prefer modified_coulomb or sticking"
        for name, law in scenario.contact_laws.items()
        if law.friction.law == "coulomb"
    )


def sampled(switches: Switches) -> tuple[str, ...]:
    """The user events that are not certain to be found."""
    return tuple(text for event in switches.events if (text := event.sampled()))


def pack(  # type: ignore[no-untyped-def]
    scenario: Any,
    ideal: frozenset[str],
    drives: Mapping[str, Any] | None,
    coordinates: tuple[str, ...],
    stiff: bool = False,
):
    """Every element of the scenario as an Instance, neighbours of one kind together."""
    wanted: list[tuple[str, str, str, Any]] = []
    bodies = members(scenario, stiff)
    sections = {s: getattr(scenario, s) for s in ("points", "joints", "drives", "sensors")}
    sections |= {"bodies": bodies, "forces": scenario.forces}
    held = {} if drives is not None else locks(scenario) | parks(scenario)
    sections |= {SECTION: held} if drives is None else {"drives": drives}
    for section, entries in sections.items():
        for name, spec in entries.items():
            key = spec.type
            other = elements.load(key).ideal
            if other and (spec.clearance == 0.0 or name in ideal):
                key = other
            wanted.append((key, section, name, spec))
    for key, section in elements.ELEMENTS.items():
        if not section:  # made from a key of the scenario
            made = elements.load(key).of_scenario(scenario, bodies)
            wanted += [(key, section, name, spec) for name, spec in made]
    order = {key: n for n, key in enumerate(elements.ELEMENTS)}
    wanted.sort(key=lambda item: order[item[0]])
    kinds = {key: elements.load(key) for key, *_ in wanted}
    at = Addresses(scenario, {(s, n): kinds[key] for key, s, n, _ in wanted}, bodies)
    at.of_start = bool(ideal) or stiff or drives is not None
    at.end = None if drives is not None or stiff else scenario.solver.end
    instances = []
    for key, section, name, spec in wanted:
        told, known = len(at.notes), len(at.packed_functions)
        try:
            acts = section != "forces" or name not in scenario.resting
            row = kinds[key].pack(name, spec, at)
        except ScenarioError as error:
            raise error.at(section, name) from None
        except ValueError as error:
            raise ScenarioError(str(error), path=(section, name)) from None
        rows = {name: row} | {f"{name}.{k}": part for k, part in enumerate(row.parts, start=1)}
        for own, packed in rows.items():
            instances.append(Instance(section, own, kinds[key], packed, acts))
            at.instances[section, own] = instances[-1]
        at.packed_functions[known:] = [
            f._replace(name=f"{section}.{name}.{f.name}") for f in at.packed_functions[known:]
        ]
        if len(at.notes) > told:
            place = scenario.place((section, name))
            line = f"{place.show()}: " if place else ""
            at.notes[told:] = [f"{line}{section}.{name}.{note}" for note in at.notes[told:]]
    at.switches = switches(scenario, at, instances) if drives is None else Switches()
    if at.end is not None:
        at.jumped = find_jumps(at, instances)
    if at.jumped and at.switches.jumps < 0:
        at.switches = replace(at.switches, jumps=at.state(0.0))
    for name in coordinates:
        for own in of_joint(name, scenario.joints):
            at.coordinate(own)
    # a joint learns its coordinate only after everybody who asks for it was packed
    for n, instance in enumerate(instances):
        if instance.section == "joints" and instance.element.coordinates:
            con = [*instance.row.con]
            for k, name in enumerate(of_joint(instance.name, scenario.joints)):
                if name in at.coordinates:
                    con[column_of(k, len(instance.element.rows))] = at.coordinates[name].entry
            if (*con,) != instance.row.con:
                instances[n] = replace(instance, row=instance.row.with_con(con))
    return at, instances
