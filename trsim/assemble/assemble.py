"""Scenario -> Model: pack the elements, drop what the scene does not need, lay out the outputs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim import elements
from trsim.assemble.addresses import Addresses
from trsim.assemble.equations import derivative
from trsim.assemble.layout import Column, layout
from trsim.assemble.pattern import pattern
from trsim.assemble.reduce import (
    IN_PLANE,
    OUT_OF_PLANE,
    Dependence,
    dependences,
    is_planar,
    jacobian,
    unique_reactions,
    weights,
)
from trsim.elements import scene as scales
from trsim.elements.contract import (
    FIRST_ROW,
    KINDS,
    N_BOOK,
    PHASE,
    UNLOCATED,
    Element,
    Row,
)
from trsim.elements.scene import BAUMGARTE, NONE, PROJECTION, Model, scene
from trsim.errors import ModelError, ScenarioError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Instance:
    """One element of the scenario, packed."""

    section: str
    name: str
    element: Element
    row: Row


@dataclass(frozen=True)
class RowName:
    """A constraint row, for messages and reports."""

    element: str  # joint or drive
    axis: str
    instance: int
    index: int  # which of the element's rows
    frames: tuple[int, int]
    rotation: bool


@dataclass(frozen=True)
class Mechanism:
    """A model with the names that go with its numbers."""

    model: Model
    y0: Array  # as drawn; velocities as given, z zero
    instances: tuple[Instance, ...]
    columns: tuple[Column, ...]
    planar: bool
    planar_assumed: bool  # nothing holds the bodies in their plane
    mobility: int  # degrees of freedom left, drives counted as constraints
    redundant: tuple[str, ...]  # rows dropped, "joint.axis"
    singular: tuple[str, ...]  # rows dependent only as drawn
    not_unique: tuple[str, ...]  # rows whose reaction the motion does not determine
    rows: tuple[str, ...]  # rows in the solve
    follows: tuple[int, ...]  # coordinate each element state starts at, or -1
    coordinates: Mapping[str, Any]  # joint -> JointCoordinate
    frames: Mapping[str, int]
    notes: tuple[str, ...]


def assemble(
    scenario: Any,
    ideal: frozenset[str] = frozenset(),
    drives: Mapping[str, Any] | None = None,
    coordinates: tuple[str, ...] = (),
) -> Mechanism:
    """Build the model.  Raises ScenarioError, ModelError.

    For the start of a run - ideal: clearance joints to take as ideal ones; drives: drives instead
    of the scenario's; coordinates: joints whose coordinate is needed though nobody asks for it.
    """
    at, instances = pack(scenario, ideal, drives, coordinates)
    full = build(scenario, at, instances, all_rows(instances), 6)
    y6 = drawn(scenario, at, 6)
    planar, assumed = planarity(scenario, full, y6)
    check_inertias(scenario, planar)
    kept, found = choose_rows(full, y6, instances, planar)
    d = 3 if planar else 6
    model = build(scenario, at, instances, kept, d)
    y0 = drawn(scenario, at, d)
    model, columns = layout(scenario, model, instances, at, planar)
    names = {k: f"{r.element}.{r.axis}" for k, r in enumerate(all_rows(instances))}
    _, _, J = jacobian(full, 0.0, y6)
    plane = IN_PLANE if planar else [*IN_PLANE, *OUT_OF_PLANE]
    keep = [6 * f + c for f in range(full.n - 1) for c in plane]
    inside = in_solve(J, planar)
    unique = unique_reactions(J[:, keep][inside], weights(full)[keep])
    rows = all_rows(instances)
    return Mechanism(
        model=model,
        y0=y0,
        instances=tuple(instances),
        columns=tuple(columns),
        planar=planar,
        planar_assumed=assumed,
        mobility=d * (model.n - 1) - model.m + sum(not f.everywhere for f in found),
        redundant=tuple(names[f.row] for f in found if f.everywhere),
        singular=tuple(names[f.row] for f in found if not f.everywhere),
        not_unique=tuple(
            names[k] for k, u in zip(np.flatnonzero(inside).tolist(), unique, strict=True) if not u
        ),
        rows=tuple(f"{r.element}.{r.axis}" for r in rows if r in kept),
        follows=tuple(follow for _, follow in at.states),
        coordinates=at.coordinates,
        frames=at.frames,
        notes=notes(scenario, assumed),
    )


def notes(scenario: Any, assumed: bool) -> tuple[str, ...]:
    """What the user should know before the run."""
    said = []
    if assumed:
        said.append(
            "planar motion assumed: nothing holds the bodies in their plane; "
            "set `planar: false` for a spatial run"
        )
    for name, law in scenario.contact_laws.items():
        if law.friction.law == "coulomb":
            said.append(
                f"contact law '{name}': Coulomb friction jumps where sliding stops; expect tiny "
                "steps there, and prefer modified_coulomb or sticking"
            )
    return tuple(said)


def pack(  # type: ignore[no-untyped-def]
    scenario: Any,
    ideal: frozenset[str],
    drives: Mapping[str, Any] | None,
    coordinates: tuple[str, ...],
):
    """Every element of the scenario as an Instance, neighbours of one kind together."""
    wanted: list[tuple[str, str, str, Any]] = []
    sections = {s: getattr(scenario, s) for s in ("bodies", "joints", "drives", "sensors")}
    if drives is not None:
        sections["drives"] = drives
    sections["forces"] = scenario.forces
    for section, members in sections.items():
        for name, spec in members.items():
            key = spec.type
            if key == "clearance_joint" and (spec.clearance == 0.0 or name in ideal):
                key = "revolute"
            wanted.append((key, section, name, spec))
    if any(scenario.gravity):
        gravity = elements.load("gravity")
        for name, spec in scenario.bodies.items():
            if spec.mass > 0.0:
                field = gravity.spec(body=name, field=scenario.gravity)
                wanted.append(("gravity", "", name, field))
    order = list(elements.ELEMENTS)
    wanted.sort(key=lambda item: order.index(item[0]))
    kinds = {key: elements.load(key) for key, *_ in wanted}
    at = Addresses(scenario, {(s, n): kinds[key] for key, s, n, _ in wanted})
    instances = []
    for key, section, name, spec in wanted:
        try:
            instances.append(Instance(section, name, kinds[key], kinds[key].pack(name, spec, at)))
        except ScenarioError as error:
            raise error.at(section, name) from None
        except ValueError as error:
            raise ScenarioError(str(error), path=(section, name)) from None
    for name in coordinates:
        if at.elements["joints", name].coordinate:
            at.coordinate(name)
    # a joint learns its coordinate only after everybody who asks for it was packed
    for n, instance in enumerate(instances):
        if instance.section == "joints" and instance.name in at.coordinates:
            row = instance.row
            index = at.coordinates[instance.name].entry
            con = (*row.con[:2], index, *row.con[3:])
            row = Row(con, row.par, row.contact)
            instances[n] = Instance(instance.section, instance.name, instance.element, row)
    return at, instances


def all_rows(instances: list[Instance]) -> list[RowName]:
    """Every constraint row of the elements, in three dimensions."""
    rows = []
    for n, instance in enumerate(instances):
        i, j = instance.row.con[0], instance.row.con[1] if len(instance.row.con) > 1 else 0
        if instance.element.key == "drive" and instance.row.par[9] > 0.0:
            continue  # a compliant drive is a force
        for index, axis in enumerate(instance.element.rows):
            turns = axis.startswith(("tilt", "turn"))
            rows.append(RowName(instance.name, axis, n, index, (i, j), turns))
    return rows


def build(
    scenario: Any, at: Addresses, instances: list[Instance], rows: list[RowName], d: int
) -> Model:
    """The arrays of a model with the given constraint rows, without outputs."""
    n, N = len(at.frames), max(len(instances), 1)
    con, par = tables(instances, rows)
    mass, inertia, mass_inverse, inertia_inverse = masses(scenario, d)
    solver = scenario.solver
    size = extent(at)
    n_z = N_BOOK + len(at.states)
    scale_kind, scale = norm(at, d, size)
    contacts = [e for e, i in enumerate(instances) if i.row.contact is not None]
    stabilisation = {"none": NONE, "baumgarte": BAUMGARTE, "projection": PROJECTION}
    baumgarte = solver.baumgarte
    return Model(
        d=d,
        n=n,
        n_q=(3 if d == 3 else 7) * (n - 1),
        n_v=d * (n - 1),
        n_z=n_z,
        m=len(rows),
        mass=mass,
        inertia=inertia,
        mass_inverse=mass_inverse,
        inertia_inverse=inertia_inverse,
        depth=at.at_start[:, 2].copy(),
        con=con,
        par=par,
        tab=np.array(at.tab),
        n_s=at.n_s,
        turn=turns(at, d),
        **kernels(instances),
        **pattern([r.frames for r in rows]),
        derivative=derivative.address(),
        stabilisation=stabilisation[solver.stabilisation],
        alpha=baumgarte.alpha if baumgarte else 0.0,
        beta=baumgarte.beta if baumgarte else 0.0,
        scale_kind=scale_kind,
        scale=scale,
        contact=np.array(contacts, np.int64),
        contact_par=contact_numbers(scenario, at, instances, contacts),
        contact_state=contact_states(instances, contacts),
        contact_width=np.array(
            [sum(c.size for c in instances[e].element.channels) for e in contacts], np.int64
        ),
        wanted=np.full(N, -1, np.int64),
        joint_out=np.zeros((0, 4), np.int64),
        column_energy=-1,
        n_out=0,
        size=size,
    )


def tables(instances: list[Instance], rows: list[RowName]) -> tuple[NDArray[np.int64], Array]:
    """con and par of all instances; dropped constraint rows have the index -1."""
    number = {(r.instance, r.index): k for k, r in enumerate(rows)}
    cons: list[list[int]] = []
    for n, instance in enumerate(instances):
        c = instance.row.con
        own = [number.get((n, k), -1) for k in range(len(instance.element.rows))]
        cons.append([*c[:FIRST_ROW], *own, *c[FIRST_ROW:]] if own else list(c))
    con = np.full((max(len(cons), 1), max((len(c) for c in cons), default=1)), -1, np.int64)
    for e, numbers in enumerate(cons):
        con[e, : len(numbers)] = numbers
    pars = [instance.row.par for instance in instances]
    par = np.zeros((max(len(pars), 1), max((len(p) for p in pars), default=1)))
    for e, p in enumerate(pars):
        par[e, : len(p)] = p
    return con, par


def kernels(instances: list[Instance]) -> dict[str, NDArray[np.int64]]:
    """Per kind of kernel a table of (address, first row, end row)."""
    spans: dict[str, list[int]] = {}
    loaded: dict[str, Element] = {}
    for e, instance in enumerate(instances):
        key = instance.element.key
        spans.setdefault(key, [e, e])[1] = e + 1
        loaded[key] = instance.element
    tables: dict[str, list[tuple[int, int, int]]] = {kind: [] for kind in KINDS}
    for key, (a, b) in spans.items():
        for kind, kernel in loaded[key].kernels.items():
            tables[kind].append((kernel.address(), a, b))
    return {kind: np.array(rows, np.int64).reshape(-1, 3) for kind, rows in tables.items()}


def masses(scenario: Any, d: int) -> tuple[Array, Array, Array, Array]:
    """Masses and inertia tensors of the frames, and their inverses."""
    from trsim.elements.rigid_body import tensor

    n = 1 + len(scenario.bodies)
    mass, inertia = np.zeros(n), np.zeros((n, 9))
    mass_inverse, inertia_inverse = np.zeros(n), np.zeros((n, 9))
    for f, (name, spec) in enumerate(scenario.bodies.items(), start=1):
        mass[f] = spec.mass
        inertia[f], complete = tensor(spec.inertia)
        known = inertia[f].reshape(3, 3)
        if spec.mass == 0.0:
            raise ModelError("a body without mass cannot be solved for", "give it a mass",
                             ("bodies", name, "mass"))  # fmt: skip
        mass_inverse[f] = 1.0 / spec.mass
        if (complete and np.linalg.eigvalsh(known).min() <= 0.0) or inertia[f, 8] <= 0.0:
            raise ModelError(
                "an inertia must be positive about every axis",
                "check the moments and products",
                ("bodies", name, "inertia"),
            )
        if d == 3:
            inertia_inverse[f, 8] = 1.0 / inertia[f, 8]
        elif complete:
            inertia_inverse[f] = np.linalg.inv(known).ravel()
        else:  # only for the look at the rows before planarity is known
            inertia_inverse[f, [0, 4, 8]] = 1.0 / inertia[f, 8]
    return mass, inertia, mass_inverse, inertia_inverse


def drawn(scenario: Any, at: Addresses, d: int) -> Array:
    """y as drawn, with the bodies' given velocities; z zero."""
    n, n_z = len(at.frames), N_BOOK + len(at.states)
    n_q = (3 if d == 3 else 7) * (n - 1)
    y = np.zeros(n_q + d * (n - 1) + n_z)
    for f, spec in enumerate(scenario.bodies.values(), start=1):
        v = n_q + d * (f - 1)
        if d == 3:
            y[3 * (f - 1) : 3 * f] = (*spec.at[:2], spec.angle)
            y[v : v + 3] = (*spec.velocity[:2], spec.angular_velocity[2])
        else:
            q = 7 * (f - 1)
            y[q : q + 3] = spec.at
            y[q + 3], y[q + 6] = np.cos(spec.angle / 2), np.sin(spec.angle / 2)
            y[v : v + 3] = spec.velocity
            y[v + 3 : v + 6] = at.axes(f, spec.angular_velocity)
    return y


def planarity(scenario: Any, full: Model, y6: Array) -> tuple[bool, bool]:
    """(planar, only assumed)."""
    from trsim.assemble.equations import forces, poses

    def sample(y: Array) -> Array:
        w = scene(full)
        w.mem[:, PHASE] = UNLOCATED
        poses(w, y)
        forces(w, 0.0)
        return w.F.copy()

    if scenario.planar is False or full.n == 1:
        return False, False
    inside, held = is_planar(full, y6, sample)
    velocities = y6[full.n_q : full.n_q + full.n_v].reshape(-1, 6)
    inside = inside and not np.any(velocities[:, OUT_OF_PLANE])
    if scenario.planar and not inside:
        raise ModelError(
            "`planar: true`, but joints, loads or velocities leave the x-y plane",
            "draw the mechanism in the x-y plane or set `planar: false`",
            ("planar",),
        )
    return inside, inside and not held and scenario.planar is None


def check_inertias(scenario: Any, planar: bool) -> None:
    """A single inertia is about z: not enough in space."""
    if planar:
        return
    for name, spec in scenario.bodies.items():
        if isinstance(spec.inertia, float):
            raise ModelError(
                "one inertia (about z) is not enough in a scene that is not planar",
                "give three principal inertias, or six numbers with the products",
                ("bodies", name, "inertia"),
            )


def in_solve(J: Array, planar: bool) -> NDArray[np.bool_]:
    """Rows with a part in the plane; all of them in space."""
    if not planar:
        return np.ones(len(J), bool)
    blocks = J.reshape(len(J), J.shape[1] // 6, 6)[:, :, IN_PLANE]
    return np.abs(blocks).max(axis=(1, 2), initial=0.0) > 1e-9


def choose_rows(
    full: Model, y6: Array, instances: list[Instance], planar: bool
) -> tuple[list[RowName], list[Dependence]]:
    """Rows of the solve: in the plane where the scene is planar, the redundant ones dropped."""
    rows = all_rows(instances)
    _, _, J = jacobian(full, 0.0, y6)
    candidates = np.flatnonzero(in_solve(J, planar)).tolist()
    is_drive = [instances[r.instance].element.key == "drive" for r in rows]
    # translations first: where a choice is left, moments go rather than forces; drives last
    order = sorted(candidates, key=lambda k: (is_drive[k], rows[k].rotation, k))
    columns = IN_PLANE if planar else [0, 1, 2, 3, 4, 5]
    geometric = [k for k in candidates if not is_drive[k]]
    found = dependences(full, y6, columns, order, geometric)
    for f in found:
        if is_drive[f.row] and f.everywhere:
            name = rows[f.row].element
            raise ModelError(
                "moves a coordinate that joints or another drive already fix",
                "two drives on one degree of freedom? remove one, or give it a `compliance`",
                ("drives", name),
            )
    dropped = {f.row for f in found if f.everywhere}
    return [rows[k] for k in candidates if k not in dropped], found


def turns(at: Addresses, d: int) -> NDArray[np.int64]:
    """Planar joint angles: (entry of S, i, j, sign of the axis), for their branch."""
    if d == 6:
        return np.zeros((0, 4), np.int64)
    rows = [
        (x.entry, x.i, x.j, 1 if x.axis[2] > 0 else -1)
        for x in at.coordinates.values()
        if x.kind == "angle"
    ]
    return np.array(rows, np.int64).reshape(-1, 4)


def extent(at: Addresses) -> float:
    """Size of the mechanism: the diagonal of the box around its points as drawn, m."""
    corners = [at.at_start[0], *at.at_start[1:]]
    corners += [at.at_start[i] + at.rotation[i] @ np.array(s) for i, s in at.points]
    box = np.ptp(np.array(corners), axis=0)
    size = float(np.linalg.norm(box))
    return size if size > 0.0 else 1.0


def norm(at: Addresses, d: int, size: float) -> tuple[NDArray[np.int64], Array]:
    """Unit of every entry of y in the error norm, and the lever of rotations."""
    kind: list[int] = []
    lever: list[float] = []
    arms = [0.0] * len(at.frames)
    for i, s in at.points:
        arms[i] = max(arms[i], float(np.linalg.norm(s)))
    arms = [a if a > 0.0 else size for a in arms]
    for arm in arms[1:]:
        kind += [scales.LENGTH] * (2 if d == 3 else 3) + [scales.ANGLE] * (1 if d == 3 else 4)
        lever += [1.0] * (2 if d == 3 else 3) + ([arm] if d == 3 else [2.0 * arm] * 4)
    for arm in arms[1:]:
        kind += [scales.SPEED] * (2 if d == 3 else 3) + [scales.RATE] * (1 if d == 3 else 3)
        lever += [1.0] * (2 if d == 3 else 3) + [arm] * (1 if d == 3 else 3)
    kind += [scales.OUTSIDE] * N_BOOK
    lever += [1.0] * N_BOOK
    for scale, _ in at.states:
        if isinstance(scale, str):
            kind.append(scales.ANGLE if scale == "angle" else scales.LENGTH)
            lever.append(size if scale == "angle" else 1.0)
        else:
            kind.append(scales.MAGNITUDE if scale else scales.OUTSIDE)
            lever.append(scale or 1.0)
    return np.array(kind, np.int64), np.array(lever)


def contact_numbers(
    scenario: Any, at: Addresses, instances: list[Instance], contacts: list[int]
) -> Array:
    """K, exponent, effective mass, clearance, slowest impact of every contact."""
    rows = []
    for e in contacts:
        row = instances[e].row
        assert row.contact is not None  # noqa: S101
        i, j = row.con[0], row.con[1]
        inverse = (1.0 / at.mass(i) if i else 0.0) + (1.0 / at.mass(j) if j else 0.0)
        c = row.contact
        rows.append((c.stiffness, c.exponent, 1.0 / inverse, c.clearance, c.slowest_impact))
    return np.array(rows, float).reshape(-1, 5)


def contact_states(instances: list[Instance], contacts: list[int]) -> NDArray[np.int64]:
    """The state of z a touch resets, or -1."""
    first = FIRST_ROW  # a clearance joint's own numbers start behind i, j and its coordinate
    states = [
        instances[e].row.con[first] if instances[e].element.key == "clearance_joint" else -1
        for e in contacts
    ]
    return np.array(states, np.int64)
