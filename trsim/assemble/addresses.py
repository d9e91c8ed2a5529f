"""What `pack` may ask: where a body, a point or a joint coordinate is (places.py), and where a
function or a sensor lives."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from trsim.assemble.cornered import Cornered, cornered
from trsim.assemble.instances import Named
from trsim.assemble.overshoot import overshoot
from trsim.assemble.places import Places
from trsim.assemble.poles import Guard, guards
from trsim.assemble.waves import Swinging
from trsim.elements.coordinates import ANY, bend_of, split
from trsim.errors import ScenarioError, known
from trsim.expressions import LOW, degree, names, rebuilt
from trsim.laws import functions
from trsim.laws.waves import waves
from trsim.numbers import unit_meant
from trsim.scenario.load import unit_of
from trsim.units import fits
from trsim.varying import RATE

NO_NAMES: Mapping[str, tuple[int, str]] = {}
UNITS = {"angle": "rad", "stroke": "m", "arc": "m", "time": "s", "speed": "m/s"}


@dataclass
class Addresses(Places):
    """The places of a scenario, and what is packed so far."""

    tab: list[float] = field(default_factory=lambda: [0.0])
    sensors: dict[str, int] = field(default_factory=dict)
    rates: dict[int, int] = field(default_factory=dict)  # entry of S -> that of its rate
    timed: bool = False  # something depends on t explicitly
    sensed: bool = False  # or on a sensor, and may be short between two corners
    instances: dict[tuple[str, str], Any] = field(default_factory=dict)  # packed so far
    switches: Any = None  # of user events, once all elements are packed
    end: float | None = None  # s, of the run, where its functions are wanted with their corners
    functions: list[Cornered] = field(default_factory=list)  # those that have some
    packed_functions: list[Named] = field(default_factory=list)
    waves: list[Swinging] = field(default_factory=list)
    shown: list[Swinging] = field(default_factory=list)  # formulas
    guards: list[Guard] = field(default_factory=list)  # of functions that may have no value
    jumped: dict[int, Any] = field(default_factory=dict)  # of drives: offset -> jumps at each

    def sensor(self, name: str) -> int:
        """Index of a sensor in S."""
        if name not in self.sensors:
            self.sensors[name] = self.entry()
        return self.sensors[name]

    def rate_of(self, entry: int) -> int:
        """Index of the rate of an entry of S in S, as functions read it."""
        if entry not in self.rates:
            self.rates[entry] = self.entry()
        return self.rates[entry]

    def acting_on(self, body: int) -> list[tuple[int, Any]]:
        """The joints, drives, forces and locks packed so far that push or hold a body, by their
        numbers."""
        found = []
        for e, instance in enumerate(self.instances.values()):
            places = instance.element.acts_at
            acted = (f for f, _ in places(instance.row)) if places else instance.named_by_rows
            if instance.section not in ("", "bodies", "points", "sensors") and body in (*acted,):
                found.append((e, instance))
        return found

    def numbered(self, section: str, name: str) -> tuple[int, Any]:
        """An instance that is packed before the one that asks, with its number."""
        return [*self.instances].index((section, name)), self.instances[section, name]

    def joint_of(self, instance: Any) -> str:
        """The joint along whose coordinate a drive, a force or a lock acts; of others none."""
        name, joints = instance.name, self.scenario.joints
        spec = getattr(self.scenario, instance.section, {}).get(name)
        if instance.section == "events" and instance.row.states:  # a lock, by what it holds
            return split(name.rpartition(".")[0], joints)[0]
        return split(getattr(spec, "joint", None) or "", joints)[0]

    def packed(self, section: str, name: str, path: tuple[str | int, ...]) -> Any:
        """The instance of an element that is packed before the one that asks."""
        if (section, name) not in self.instances:
            there = [n for s, n in self.instances if s == section]
            raise ScenarioError(f"nothing named '{name}' in {section}", known(name, there), path)
        return self.instances[section, name]

    def sensor_kind(self, name: str) -> str:
        """What a sensor shows: an angle or a stroke, its own or that of its joint."""
        own = self.elements["sensors", name].coordinates
        joint = "" if own else self.scenario.sensors[name].joint
        if joint and bend_of(joint, self.scenario.joints)[0]:
            return "angle"
        return own[0] if own else self.coordinate(joint, ANY).kind

    def contact_law(self, name: str | None) -> Any:
        laws = self.scenario.contact_laws
        if name is None and len(laws) == 1:
            return next(iter(laws.values()))
        if name is None or name not in laws:
            what = f"no contact law named '{name}'" if name else "no contact law is named"
            raise ScenarioError(what, known(str(name), laws) if laws else "add it under "
                                "contact_laws", ("contact",) if name else ())  # fmt: skip
        return laws[name]

    def function(
        self, spec: Any, *path: str | int, time_only: bool = False, wanted: str = "",
        local: Mapping[str, tuple[int, str]] = NO_NAMES, free: bool = False,
    ) -> int:  # fmt: skip
        """Store a function of t or of sensors in tab; its offset.

        wanted: the unit of its values where the field allows several; local: names of its own,
        their entries of S and units; free: no run holds it on a piece.
        """
        offset = len(self.tab)

        def known(name: str) -> int:
            return local[name][0] if name in local else self.known_sensor(name, time_only, path)

        if spec.kind == "expression" and not local:
            spec = replace(spec, node=self.inlined(spec.node, path))
        if spec.kind == "constant":
            code = functions.constant(spec.value)
        elif spec.kind == "table":
            variable = -1 if spec.of == "t" else known(spec.of)
            unit = local[spec.of][1] if spec.of in local else ""
            self.check_table(spec, unit or self.unit_of_variable(spec.of), wanted, *path)
            self.timed = self.timed or variable < 0
            self.sensed = self.sensed or variable >= 0
            self.notes += [] if free else overshoot(spec, path)
            code = functions.table(spec.x, spec.y, variable, spec.ends, spec.interpolation)
        else:
            self.timed = self.timed or "t" in names(spec.node)
            used = spec.inputs
            # what is a polynomial between its corners has nothing short there
            self.sensed = self.sensed or (bool(used) and degree(spec.node) > LOW)
            indices = {name: known(name) for name in used}
            code = functions.expression(spec.node, indices)
        if self.end is not None and not free:
            try:
                found = cornered(spec, code, offset, self.end)
                self.check_corners(found)
                self.functions += found
            except ScenarioError as error:
                raise error.at(*path) from None
        if waves(code) and not free:
            self.waves.append(Swinging(offset, code))
        self.tab.extend(code)
        if spec.kind == "expression" and self.end is not None and not free:
            self.guards += guards(self, spec.node, offset, indices)
        if not free:
            self.packed_functions.append(Named(".".join(map(str, path)), offset, spec))
        return offset

    def inlined(self, node: Any, path: tuple[str | int, ...], within: tuple[str, ...] = ()) -> Any:
        """An expression with those of formulas in the place of their names."""
        if node[0] != "name" or node[1] not in self.scenario.sensors:
            return rebuilt(node, lambda part: self.inlined(part, path, within))
        name = node[1]
        stands_for = self.elements["sensors", name].stands_for
        if stands_for is None:
            return node
        if name in within:
            what = f"'{name}' refers to itself: {' -> '.join((*within, name))}"
            raise ScenarioError(what, "a formula names sensors that stand before it", path)
        return self.inlined(stands_for(self.scenario.sensors[name]), path, (*within, name))

    def read_by_formula(self, name: str, path: tuple[str, ...]) -> Any:
        """The packed row of a sensor that a formula names, which stands before it."""
        sensors = self.scenario.sensors
        if name not in sensors:
            what = f"no parameter or sensor named '{name}'"
            raise ScenarioError(what, known(name, [*sensors, *self.scenario.parameters, "t"]), path)
        if ("sensors", name) not in self.instances:
            what = f"'{name}' stands behind it in the file, or is the formula itself"
            raise ScenarioError(what, "a formula names sensors that stand before it", path)
        instance = self.instances["sensors", name]
        if instance.channels[0].name:
            what = f"'{name}' ({instance.element.key}) shows several numbers"
            raise ScenarioError(what, "name a sensor of one number, such as a `reaction`", path)
        return instance.row

    def frames_of_sensor(self, name: str) -> frozenset[int]:
        """The frames that a packed sensor depends on."""
        instance = self.instances["sensors", name]
        found: frozenset[int] = instance.element.acts_on(instance.row)
        return found

    def stored(self, node: Any, inputs: Iterable[str], path: tuple[str, ...]) -> int:
        """Store an expression of packed sensors and their rates that nothing of the motion depends
        on; its offset."""
        offset, indices = len(self.tab), dict[str, int]()
        for name in sorted(inputs):
            own = name.removesuffix(RATE)
            indices[name] = self.sensor(name) if own == name else self.rate_of_sensor(own, path)
        try:
            code = functions.expression(node, indices)
        except ScenarioError as error:
            raise error.at(*path) from None
        if waves(code):
            self.shown.append(Swinging(offset, code))
        self.tab += code
        return offset

    def check_corners(self, found: list[Cornered]) -> None:
        """Refuse corners that are met by a sensor without bounds: one could be passed over."""
        met = {k for one in found for k in one.sensed}
        for name, k in self.sensors.items():
            packed = self.instances.get(("sensors", name))
            if k in met and packed and not packed.row.travel:
                raise ScenarioError(
                    f"'{name}' ({packed.element.key}) meets a corner of this function, and has no "
                    "bounds by which it could be found",
                    "write a smooth function: v*sqrt(v**2 + 1e-12) for v*abs(v)",
                )

    def check_table(self, spec: Any, found: str, wanted: str, *path: str | int) -> None:
        """Refuse units of a table's columns that are not those of its variable and its values."""
        x, y = spec.units
        if x and not fits(x, found):
            what = f"wrong unit: '{x}'; '{spec.of}' is in {found}"
            raise ScenarioError(what, "", (*path, "table"))
        if wanted and not fits(y, wanted):
            what = f"wrong unit: '{y}'; this number is in {wanted}"
            raise ScenarioError(what, "", (*path, "table"))

    def unit_of_variable(self, name: str) -> str:
        """The unit of t, of a sensor or of its rate."""
        if name == "t":
            return UNITS["time"]
        own = UNITS[self.sensor_kind(name.removesuffix(RATE))]
        return f"{own}/s" if name.endswith(RATE) else own

    def check_unit(self, kind: str, angle: str, stroke: str, *path: str) -> None:
        """Refuse a written unit that does not fit a joint that turns, or one that slides."""
        written = self.scenario.quantity(*path)
        wanted = angle if kind == "angle" else stroke
        if written is None or fits(written[1], wanted):
            return
        does = {"angle": "the joint turns", "stroke": "the joint slides"}
        raise ScenarioError(
            f"wrong unit: '{written[1]}'; {does.get(kind, 'a point meets a wall')}",
            f"this number is in {wanted}",
            path[2:],
        )

    def check_units(self, kind: str, spec: type, keys: Sequence[str], *path: str) -> None:
        """The same of some keys of a spec, fields with a unit for strokes and one for angles."""
        for key in keys:
            of: Any = unit_of(spec, key)
            stroke, angle = of.units
            self.check_unit(kind, angle, stroke, *path, key)

    def known_sensor(self, name: str, time_only: bool, path: tuple[str | int, ...]) -> int:
        """Entry of S of a sensor, or of the rate of one."""
        own = name.removesuffix(RATE)
        if time_only and own not in self.scenario.sensors:
            hint = known(name, [*self.scenario.parameters, "t"])
            hint = "  ".join(filter(None, [hint, unit_meant(name)]))
            raise ScenarioError(f"no parameter named '{name}'", hint, path)
        if time_only:
            raise ScenarioError(
                f"'{name}' cannot stand here: a drive depends on t only",
                "a load may depend on sensors",
                path,
            )
        first, _, rest = own.partition(".")
        if rest and first in self.scenario.sensors:
            raise ScenarioError(
                f"'{name}' cannot stand in a function",
                f"of a sensor there are `{first}` and `{first}{RATE}`; what depends on an "
                "acceleration is a mass, not a load",
                path,
            )
        if own not in self.scenario.sensors:
            hint = known(name, [*self.scenario.sensors, *self.scenario.parameters, "t"])
            hint = "  ".join(filter(None, [hint, unit_meant(name)]))
            raise ScenarioError(f"no parameter or sensor named '{name}'", hint, path)
        self.check_early(own, path)
        return self.sensor(name) if own == name else self.rate_of_sensor(own, path)

    def rate_of_sensor(self, name: str, path: tuple[str | int, ...]) -> int:
        """Index in S of the rate of a packed sensor.  Refuses one of which that is no velocity."""
        packed = self.instances["sensors", name]
        if not packed.row.travel:
            raise ScenarioError(
                f"'{name}' ({packed.element.key}) is no place and no angle: its rate is known "
                "only once the accelerations are",
                "take the rate of a sensor of places; what depends on an acceleration is a mass",
                path,
            )
        return self.rate_of(self.sensor(name))

    def is_early(self, name: str) -> bool:
        """Whether a sensor shows a number of places and velocities alone, an entry of S."""
        return "coordinate" in self.elements["sensors", name].kernels

    def check_early(self, name: str, path: tuple[str | int, ...]) -> None:
        """Refuse a sensor that shows no number of places and velocities."""
        if self.elements["sensors", name].stands_for:
            what = f"'{name}' is a formula: neither a table nor a rate of it can stand here"
            hint = "a table of the sensor itself, or an expression with the rates of its sensors"
            raise ScenarioError(what, hint, path)
        if not self.is_early(name):
            key = self.elements["sensors", name].key
            raise ScenarioError(
                f"'{name}' ({key}) is known only once the accelerations are",
                "take a sensor of places or velocities",
                path,
            )
