"""`check`: a scenario read and assembled, and what it is, without running it."""

from dataclasses import asdict
from typing import Any

from trsim.api.compiling import compiling
from trsim.api.hearing import Listener
from trsim.api.running import placed
from trsim.api.source import Given, Sets, called, loaded, settings
from trsim.api.stop import listening
from trsim.api.threads import one_thread
from trsim.errors import TrsimError

FACTS = (  # of a mechanism, that are told under their names
    "planar", "planar_assumed", "spatial_because", "mobility", "mobility_by_count", "redundant",
    "singular", "unique", "not_unique",
)  # fmt: skip


class Checked(dict[str, Any]):
    """What a scenario is once assembled, and what a run of it will meet.

    A dict with the words of `trsim check --json`; the most wanted of them are attributes.
    """

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies."""
        return list(self["bodies"])

    @property
    def mobility(self) -> int:
        """Free motions."""
        return int(self["mobility"])

    @property
    def redundant(self) -> list[str]:
        """Rows of joints that others repeat."""
        return list(self["redundant"])

    @property
    def notes(self) -> list[str]:
        """What looks wrong."""
        return list(self["notes"])


def check(scenario: Given, set: Sets | None = None, modes: bool = False) -> Checked:
    """Say what a scenario describes, and what a run of it will meet.

    scenario  the name of a file, a dict, or what `load` gave
    set       what is changed: {"joints.pin.clearance": "0.3 mm"}
    modes     whether small motions about the start are wanted as well

    Raises ScenarioError, ModelError, FileError.
    """
    with listening(), one_thread():
        return checked(Listener(), scenario, settings(set), modes)


def checked(hears: Listener, given: Given, sets: tuple[str, ...], modes: bool = False) -> Checked:
    """What a scenario is once assembled, where it would start, and what is fast in it."""
    name, scenario = called(given), loaded(given, sets)
    compiling(hears)
    from trsim.assemble.assemble import assemble
    from trsim.solve.diagnose.skipped import skipped

    found = Checked(file=name, title=scenario.title)
    try:
        with hears.doing(name) as doing:
            doing(f"assembling {len(scenario.bodies)} bodies")
            mechanism = assemble(scenario)
            check_output(scenario, mechanism)
            doing("finding redundant rows and what to release")
            found.update(described(scenario, mechanism))
            doing("looking for the start and its time scales")
            found.update(begun(scenario, mechanism, modes))
        found["notes"] += found.pop("doubts")
        found["skipped"] = list(skipped(scenario, mechanism))
        return found
    except TrsimError as error:
        raise placed(error, scenario) from None


def check_output(scenario: Any, mechanism: Any) -> None:
    """Refuse what a run refuses before it begins: rows without number, points without channels."""
    from trsim.solve.outcome import settings

    if scenario.solver.end is not None:
        settings(scenario, mechanism)
    if scenario.poincare or scenario.phase_portraits:
        from trsim.store.points import plan

        plan(scenario, mechanism)


def described(scenario: Any, mechanism: Any) -> dict[str, Any]:
    """Bodies, joints and what the assembly found out about them."""
    from trsim.scenario.lint import lint
    from trsim.scenario.load_sets import told
    from trsim.scenario.weights import weights

    model = mechanism.model
    frame = scenario.frame and scenario.frame.moved
    return {
        "frame": frame._asdict() if frame else None,
        "bodies": list(scenario.bodies),
        "weights": [weight._asdict() for weight in weights(scenario)],
        "joints": {name: spec.type for name, spec in scenario.joints.items()},
        "drives": list(scenario.drives),
        "forces": {name: spec.type for name, spec in scenario.forces.items()},
        "load_sets": told(scenario),
        "contacts": [mechanism.instances[e].name for e in model.contact],
        "events": {e.name: e.in_words() for e in mechanism.stages.switches.events},
        "sections": {one.name: one.row.said for one in mechanism.instances if one.row.said},
        "pairs": {name: law.taken for name, law in scenario.contact_laws.items() if law.pair},
        "tables": {f.name: of_table(f.spec) for f in mechanism.functions if f.spec.kind == "table"},
        "unknowns": int(model.n_v),
        "constraints": int(model.m),
        **{name: getattr(mechanism, name) for name in FACTS},
        "kinematic": is_driven(scenario, mechanism),
        "release": released(scenario, mechanism),
        "notes": [*mechanism.notes, *lint(scenario), *scenario.bare],
    }


def is_driven(scenario: Any, mechanism: Any) -> bool:
    """Whether kinematic analysis takes the scenario."""
    from trsim.solve.start.driven import check_driven

    try:
        check_driven(scenario, mechanism)
    except TrsimError:
        return False
    return True


def of_table(spec: Any) -> str:
    """A table in words: its variable, its curve, and what it is outside of its rows."""
    outside = {"hold": "holds the end values", "extrapolate": "goes straight on",
               "refuse": "ends the run"}[spec.ends]  # fmt: skip
    return (
        f"of {spec.of}, {len(spec.x)} rows from {spec.x[0]:g} to {spec.x[-1]:g}, "
        f"{spec.interpolation}; outside it {outside}"
    )


def released(scenario: Any, mechanism: Any) -> dict[str, Any] | None:
    """What to let go where rows are redundant."""
    from trsim.assemble.release import release

    found = release(scenario, mechanism)
    if found is None:
        return None
    return {
        **{key: value for key, value in vars(found).items() if key != "changes"},
        "joints": {change.joint: change.becomes for change in found.changes},
        "types": {change.joint: change.type for change in found.changes if change.type},
    }


def begun(scenario: Any, mechanism: Any, shapes: bool) -> dict[str, Any]:
    """The start of a run, and its time scales; its own errors are those of the scenario."""
    from trsim.scenario.methods import METHODS
    from trsim.solve.diagnose import doubts
    from trsim.solve.diagnose.bar_scales import bar_scales
    from trsim.solve.diagnose.mesh_error import mesh_errors
    from trsim.solve.diagnose.modes import modes
    from trsim.solve.diagnose.scales import scales
    from trsim.solve.path.begin import check as check_path
    from trsim.solve.simulate import begun_by, check_step
    from trsim.solve.start.driven import check_driven
    from trsim.solve.start.projected import projected

    end = scenario.solver.end
    if end is None:  # a scale of time is needed, not how long it would run
        solver = scenario.solver.model_copy(update={"end": 1.0})
        scenario = scenario.model_copy(update={"solver": solver})
    if METHODS[scenario.solver.method].driven:
        check_driven(scenario, mechanism)
    if METHODS[scenario.solver.method].rests or any(mechanism.stages.switches.static):
        check_path(scenario, mechanism)
    at = begun_by(scenario, mechanism, True)
    of_start = scales(scenario, mechanism, at)
    check_step(scenario, of_start)
    found = asdict(of_start)
    meshes = {mesh.name: mesh._asdict() for mesh in mesh_errors(scenario, mechanism, at.y)}
    found["eigenvalues"] = [[x.real, x.imag] for x in found["eigenvalues"]]
    return {
        "start": {
            "position_residual": at.moved,
            "force_residual": at.residual,
            "length": at.length,
            "speed": at.speed,
            "closed_contacts": [
                mechanism.instances[e].name for e in mechanism.model.contact if at.mem[e, 0] > 0.0
            ],
            "projected": asdict(projected(mechanism, at)),
        },
        "doubts": list(doubts.of_start(scenario, mechanism, at)),
        "scales": {**found, "end": end},
        "flexible": [
            {**asdict(bar), "mesh": meshes.get(bar.name)}
            for bar in bar_scales(scenario, mechanism, of_start.contacts)
        ],
        "every": scenario.output.every or (end / 1000.0 if end is not None else None),
        **({"modes": [asdict(mode) for mode in modes(mechanism, at)]} if shapes else {}),
    }
