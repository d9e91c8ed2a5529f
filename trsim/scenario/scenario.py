"""What a scenario may contain, section by section.

The elements bring their own specs: the word after `type:` says which, and only those that a
scenario uses are imported.
"""

from collections.abc import Iterable
from functools import partial
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

from annotated_types import Ge, Gt, Interval
from pydantic import AfterValidator, BeforeValidator, PrivateAttr, model_validator

from trsim import elements
from trsim.elements.placed import Placed
from trsim.errors import Place, ScenarioError, closest, described, edits, known
from trsim.fields import EMPTY, Flag, Spec, Unit, vector
from trsim.numbers import written
from trsim.scenario import shown
from trsim.scenario.contact_law import ContactLaw
from trsim.scenario.event import Event
from trsim.scenario.initial import Initial, initial_of
from trsim.scenario.limits import Limits
from trsim.scenario.load_sets import Level, LoadSet, scaled
from trsim.scenario.methods import GGL, INDEX_1, METHODS
from trsim.scenario.phases import Phase, driven_first, events_of, resting
from trsim.scenario.sections import PhasePortrait, PoincareSection
from trsim.scenario.sizing import Sizing
from trsim.scenario.template import Instance, Placement, Template
from trsim.scenario.text import Tree
from trsim.scenario.totals import Total
from trsim.scenario.unfolded import Entry, Unfolded

Seconds = Annotated[float, Gt(0), Unit("s")]
# s, of a run.  The solver takes what is below 1e-60 (m, m/s, J; NOTHING of solve/march/land.py) for
# none: 1 m/s^2 moves a body from rest by as much in 1.4e-30 s, and the first step is shorter than a
# run.  From 1e-26 s on nothing is lost of that motion; the rest is for accelerations down to
# 1e-12 m/s^2
SHORTEST = 1e-20
Rate = Annotated[float, Ge(0), Unit("1/s")]


# --- elements --------------------------------------------------------------------------------


def _Element(section: str) -> BeforeValidator:
    """Makes an entry of a section a spec, of the class that its `type` names."""
    return BeforeValidator(partial(_element, section))


def _element(section: str, data: Any, info: Any) -> Any:
    context, scope = info.context or {}, None
    if isinstance(data, Entry):
        data, scope = data
        context = {**context, **scope._asdict()}
    if not isinstance(data, dict):
        raise ScenarioError(f"must be a mapping of keys, got {described(data)}")
    memory, key = context.get("memory"), ()
    context = {**context, "points": info.data.get("points", _AnyPoint())}
    if memory is not None:
        key = memory.key(section, data, context["parameters"], scope, context["points"])
        if key in memory.made:
            return memory.made[key]
    spec: Any = elements.load(word(section, data)).spec
    rest = {key: value for key, value in data.items() if key != "type"}
    made = spec.model_validate(rest, context=context)
    if memory is not None:
        memory.made[key] = made
    return made


class _AnyPoint(dict):
    """What is taken for the points where one of them is wrong: its fault is told already."""

    def __missing__(self, name: str) -> Placed:
        return Placed()


def word(section: str, data: dict) -> str:
    """Which element an entry of a section is."""
    words = [name for name, of in elements.ELEMENTS.items() if of == section]
    named = data.get("type", elements.DEFAULT.get(section))
    if named is None:
        near = [key for key in data if edits(key, "type") == 1]
        if near:
            what = f"unknown key {described(near[0])}"
            raise ScenarioError(what, "Did you mean 'type'?", (near[0],))
        raise ScenarioError("field required: type", known("", words))
    if not isinstance(named, str) or named not in words:
        raise ScenarioError(f"unknown type {described(named)}", known(named, words), ("type",))
    key, other = elements.BECOMES.get(named, ("", named))
    return other if key and any(edits(one, key) <= 1 for one in data) else named


def _Scoped(spec: type[Spec]) -> BeforeValidator:
    """Makes an entry that has a scope a spec, read as it is meant there; others are as they are."""

    def read(data: Any, info: Any) -> Any:
        if not isinstance(data, Entry):
            return data
        context = {**(info.context or {}), **data.scope._asdict()}
        return spec.model_validate(data.data, context=context)

    return BeforeValidator(read)


# --- sections --------------------------------------------------------------------------------


class Baumgarte(Spec):
    """Constraint stabilisation: phi'' + 2 alpha phi' + beta^2 phi = 0.

    alpha  rate of decay
    beta   frequency
    """

    type: ClassVar[str] = "baumgarte"
    alpha: Rate
    beta: Rate


class SolverSpec(Spec):
    """How, how far and how exactly the motion is integrated.

    method         auto: dop853, and radau where the motion is stiff; generalized_alpha: stiff
                   motion to two or three digits; rk4: fixed steps; kinematic: mechanisms with all
                   degrees of freedom driven; static_path: equilibrium at each position of the
                   drives, without inertia; those of scipy: independent checks
    formulation    equations that radau solves: index1 with projection, or, for many bodies, ggl,
                   the stabilised index 2 with sparse matrices; chosen by trsim unless given
    end            time at which the run ends, at least 1e-20 s; needed by `run`, not by `check`
    step           size of the steps of rk4
    tolerance      approximate error of a smooth motion at the end of a run, relative to the size of
                   clearances or of bodies; the error of one step is kept smaller
    stabilisation  method that keeps the joints closed
    baumgarte      rates of Baumgarte's stabilisation
    first_step     size of the first step; chosen by trsim unless given
    max_step       largest step; give it if a smooth load or motion is shorter than a 200th of the
                   run
    max_steps      largest number of steps; the run fails if it needs more
    locate_events  end steps exactly where contacts open or close; rk4 does so only if this is true
    force          run even if a fixed step is known to be too large
    """

    type: ClassVar[str] = "solver"
    method: Literal[tuple(METHODS)] = "auto"  # type: ignore[valid-type]
    formulation: Literal[INDEX_1, GGL] | None = None  # type: ignore[valid-type]
    end: Seconds | None = None
    step: Seconds | None = None
    tolerance: Annotated[float, Interval(ge=1e-14, le=1e-1), Unit("-")] = 1e-8
    stabilisation: Literal["projection", "baumgarte", "none"] = "projection"
    baumgarte: Baumgarte | None = None
    first_step: Seconds | None = None
    max_step: Seconds | None = None
    max_steps: Annotated[int, Gt(0)] | None = None
    locate_events: Flag | None = None
    force: Flag = False

    @model_validator(mode="after")
    def consistent(self) -> "SolverSpec":
        if self.end is not None and self.end < SHORTEST:
            what = f"a run of {self.end:.3g} s is shorter than any motion that can be resolved"
            hint = (
                "What is below 1e-60 m, m/s or J counts as nothing, and in so short a time a body "
                f"may move by less: give at least {SHORTEST:g} s, and check the unit."
            )
            raise ScenarioError(what, hint, ("end",))
        if not METHODS[self.method].adaptive and self.step is None:
            hint = "Write for example `step: 1e-5`."
            raise ScenarioError(f"method {self.method} needs a step", hint)
        if METHODS[self.method].driven and self.stabilisation != "projection":
            what = f"method {self.method} finds places that close all joints"
            hint = "There is nothing to stabilise: leave `stabilisation` out."
            raise ScenarioError(what, hint, ("stabilisation",))
        if self.baumgarte is not None and self.stabilisation != "baumgarte":
            hint = "Write `stabilisation: baumgarte` as well."
            raise ScenarioError("baumgarte is not the stabilisation", hint, ("baumgarte",))
        if self.formulation is not None and GGL not in METHODS[self.method].files:
            hint = f"Method {self.method} has one formulation only: leave it out."
            raise ScenarioError("formulation is a choice of radau and auto", hint, ("formulation",))
        if self.formulation == GGL and self.stabilisation == "baumgarte":
            hint = "Its positions and velocities are held by multipliers: leave one of the two out."
            raise ScenarioError("ggl needs no baumgarte", hint, ("formulation",))
        return self

    @property
    def locates(self) -> bool:
        """Whether steps end where contacts open or close."""
        if self.locate_events is None:
            return METHODS[self.method].adaptive
        return self.locate_events


class OutputSpec(Spec):
    """What is recorded, and how often.

    every     simulated time between two rows; end/1000 unless given
    channels  names, patterns such as 'B.*', or names of elements; all but *.rotation unless given
    """

    type: ClassVar[str] = "output"
    every: Seconds | None = None
    channels: tuple[str, ...] = ("*",)


class Source(NamedTuple):
    """What a scenario was read from."""

    text: str  # as given
    files: dict[str, str]  # name -> sha256: the scenario, what it extends, tables


class Scenario(Spec):
    """A mechanism and a load case, checked and in SI units; nothing changes it any more.

    title            a line for figures and tables
    planar           whether the motion stays in the x-y plane; detected unless given
    gravity          acceleration due to gravity, world axes
    frame            axes in which all positions, directions and velocities are given; the world
                     axes unless given
    parameters       named numbers that every number may use: `velocity: 2*speed`
    points           named points on bodies or on the ground, which other entries may use; their
                     motion is recorded
    bodies           rigid bodies and flexible bars
    joints           what holds bodies together
    drives           prescribed motion of joints
    sensors          named measurements, such as angles and strokes, for loads, expressions and
                     plots
    forces           what acts on bodies
    contact_laws     named contact laws
    initial          how the mechanism starts, if not as drawn with the drives at their speeds
    solver           how, how far and how exactly the motion is integrated
    output           what is recorded, and how often
    phase_portraits  one channel against another
    poincare         two channels, plotted each time the motion crosses a surface: zero crossings, a
                     period, touches
    events           what happens when a sensor or the time crosses a value
    templates        parts of the mechanism that are described once; instances put them in place
    instances        templates put in place; entry `door` of instance `left` is left_door
    load_sets        loads that act together, with factors of limit and ultimate load
    loads            which load sets act: `{gust: ultimate}`, limit, ultimate or a factor
    totals           total mass of several bodies; one of them takes the rest
    sizing           a load that replaces the force of a drive, found by repeated runs
    limits           the largest numbers of bodies, rows, nodes and entries
    phases           load steps in order: what each one drives, locks and releases, and what
                     ends it
    cases            named overrides, each a scenario of a sweep; not used by `run`
    sweep            values of keys to vary, by dotted path; not used by `run`
    report           units of figures and tables: `units: {angle: deg, speed: rpm}`
    """

    title: str = ""
    planar: Flag | None = None
    gravity: vector("m/s^2", named=False) = (0.0, 0.0, 0.0)  # type: ignore[valid-type]
    frame: Placement | None = None
    parameters: dict[str, Any] = EMPTY  # numbers, Measured where they were written with a unit
    points: dict[str, Annotated[Any, _Element("points")]] = EMPTY  # first: all others may name them
    bodies: dict[str, Annotated[Any, _Element("bodies")]] = EMPTY
    joints: dict[str, Annotated[Any, _Element("joints")]] = EMPTY
    drives: dict[str, Annotated[Any, _Element("drives")]] = EMPTY
    sensors: dict[str, Annotated[Any, _Element("sensors")]] = EMPTY
    forces: dict[str, Annotated[Any, _Element("forces")]] = EMPTY
    contact_laws: dict[str, ContactLaw] = EMPTY
    initial: Annotated[Any, BeforeValidator(initial_of)] = Initial()
    solver: SolverSpec = SolverSpec()
    output: OutputSpec = OutputSpec()
    phase_portraits: dict[str, PhasePortrait] = EMPTY
    poincare: dict[str, PoincareSection] = EMPTY
    events: dict[str, Annotated[Event, _Scoped(Event)]] = EMPTY
    templates: dict[str, Template] = EMPTY
    instances: dict[str, Instance] = EMPTY
    load_sets: dict[str, LoadSet] = EMPTY
    loads: dict[str, Level] | None = None
    totals: dict[str, Annotated[Total, _Scoped(Total)]] = EMPTY
    sizing: Sizing | None = None
    limits: Limits = Limits()
    phases: tuple[Phase, ...] = ()
    cases: dict[str, Any] = EMPTY
    sweep: dict[str, Any] = EMPTY
    report: Annotated[dict[str, Any], AfterValidator(shown.report)] = EMPTY

    @model_validator(mode="after")
    def complete(self) -> "Scenario":
        """Loads as their sets act; phases as events; bodies that take the rest of a total as they
        are then."""
        self.forces.update(scaled(self.load_sets, self.loads, self.forces))
        if self.phases:
            self.drives.update(driven_first(self))
            self.events.update(events_of(self))
        self._resting = resting(self)
        if self.totals:
            from trsim.scenario.remainder import remainders  # needs numpy

            self.bodies.update(remainders(self.totals, self.bodies))
        return self

    _resting: frozenset[str] = PrivateAttr(frozenset())
    _tree: Tree = PrivateAttr()
    _unfolded: Unfolded = PrivateAttr()
    _text: str = PrivateAttr()

    @property
    def resting(self) -> frozenset[str]:
        """The forces that do not act at the start, see phases.py."""
        return self._resting

    @property
    def source(self) -> Source:
        return Source(self._text, self._tree.files)

    @property
    def resolved(self) -> dict[str, Any]:
        """The plain data after extends, tables and --set: JSON and YAML can hold it."""
        return self._tree.data

    def place(self, path: tuple) -> Place | None:
        """Where in the files a path of the scenario stands."""
        return self._unfolded.place(path)

    def entry(self, section: str, name: str) -> str:
        """An entry in words: its path, and where it stands."""
        place = self.place((section, name))
        return f"{section}.{name}" + (f" ({place.show()})" if place else "")

    def quantity(self, *path: str) -> tuple[float, str] | None:
        """The quantity at the path of an entry, a parameter's too, and its unit; None: no unit."""
        raw = self._unfolded.value(path)
        scope = self._unfolded.scope(path)
        own = scope.parameters if scope else self.parameters
        # 1/t is none per tonne
        return written(raw, {"t": None, **own}) if isinstance(raw, str) else None

    def raw(self, path: tuple) -> Any:
        """What is written at a path; None where nothing is."""
        return self._unfolded.value(path)

    def points_at(self, *path: str) -> tuple[Any, ...]:
        """The points named at the path of an entry, a place or a list of them; None for numbers."""
        raw, scope = self._unfolded.value(path), self._unfolded.scope(path)
        meant = scope.names if scope else {}
        words = raw if isinstance(raw, list) else [raw]
        return tuple(
            self.points.get(meant.get(one, one)) if isinstance(one, str) else None for one in words
        )

    @property
    def bare(self) -> tuple[str, ...]:
        """What is said of the columns of CSV files that have no unit."""
        return tuple(
            f"{'.'.join(map(str, path))}: {columns} without a unit: read as SI; a title such as "
            f"`force [kN]` tells it"
            for path, columns in self._tree.bare.items()
        )

    def written(self, path: tuple) -> tuple:
        """Where in the files the path of an entry is written: of an instance, in its template."""
        return self._unfolded.written(path)

    def meant(self, path: Iterable[str]) -> tuple[str, ...]:
        """The path of an entry, for one that leads to it through a template or an instance."""
        return self._unfolded.meant(path)


def suggestion(name: str, spec: type[Spec], present: dict) -> tuple[str | None, str]:
    """The key that was probably meant in a mapping of this spec, and the whole hint."""
    keys = [*spec.model_fields]
    keys += ["extends"] if spec is Scenario else []
    keys += ["type"] if spec.type in elements.ELEMENTS else []
    keys += elements.BECOMES.get(spec.type, ())[:1]
    close = closest(name, [key for key in keys if key not in present]) or closest(name, keys)
    return close, known(name, keys, close)
