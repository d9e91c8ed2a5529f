"""The arrays of a model, one function for each group of them."""

from collections.abc import Sequence
from functools import cache, partial
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.addresses import Addresses
from trsim.assemble.dense import inverse, length, product
from trsim.assemble.instances import Instance, RowName
from trsim.assemble.light import lacking
from trsim.assemble.orientation import quaternion
from trsim.assemble.places import WOUND
from trsim.assemble.switches import BAND, CHANNEL, Switches
from trsim.elements import scene as scales
from trsim.elements.contract import FIRST_ROW, KINDS, N_BOOK, ContactNumbers, Element
from trsim.errors import ModelError

Array = NDArray[np.float64]

LIGHTEST, HEAVIEST = 1e-30, 1e30  # kg
STATE_SCALES = {"angle": scales.ANGLE, "stroke": scales.LENGTH, "speed": scales.SPEED}
VALUE_AT, BAND_AT = range(2)  # columns of `watch_at`
UNEQUAL = 1e5  # with all else of one size S = J M^-1 J^T loses as many digits
SMALLEST, LARGEST = 1e-12, 1e12  # m, radii of gyration and distances of a mechanism
ACTING = ("force", "energy")  # kernels of what acts on bodies
STRIKE = "strike"  # kernel of impacts
FARTHEST = 0.01  # of the mechanism with its anchors: the least that stands for the arm of a body


def tables(instances: list[Instance], rows: list[RowName]) -> tuple[NDArray[np.int64], Array]:
    """con and par of all instances; dropped constraint rows have the index -1."""
    con = padded([instance.row.con for instance in instances], -1, np.int64)
    for k, row in enumerate(rows):
        con[row.instance, FIRST_ROW + row.index] = k
    return con, padded([instance.row.par for instance in instances], 0.0, np.float64)


def padded(rows: Sequence[Sequence[float]], rest: float, kind: type) -> Any:
    """A table of rows, as wide as the widest."""
    table: Any = np.full((max(len(rows), 1), max(map(len, rows), default=1)), rest, kind)
    for e, row in enumerate(rows):
        table[e, : len(row)] = row
    return table


def watched_rows(
    instances: list[Instance], rows: Sequence[RowName], redundant: Sequence[RowName], size: float
) -> dict[str, Any]:
    """The rows that are only looked at, and what makes the opening of every row relative."""
    named = [(row.instance, row.index) for row in redundant]
    turning = [turns_by(instances[row.instance], row.index) for row in (*rows, *redundant)]
    return {
        "redundant": np.array(named, np.int64).reshape(-1, 2),
        "row_unit": np.where(turning, 1.0, size) if turning else np.zeros(0),
    }


def turns_by(instance: Instance, index: int) -> bool:
    """Whether a row of an element is an angle, as drives and locks of hinges are."""
    return instance.row.turns or instance.element.rows[index].startswith(("tilt", "turn"))


def judged(instances: Sequence[Instance]) -> NDArray[np.int64]:
    """The frames (n, 2) of instances whose channels are judged."""
    found = [x.row.con[:2] for x in instances if x.element.judged(x.row)]
    return np.array(found, np.int64).reshape(-1, 2)


def kernels(instances: list[Instance]) -> dict[str, NDArray[np.int64]]:
    """Per kind of kernel a table of (address, first row, end row); forces that do not act are left
    out of those in which they do, contacts whose touches take time out of impacts."""
    spans: dict[tuple[str, int], list[int]] = {}
    loaded: dict[str, Element] = {}
    part = 0
    for e, instance in enumerate(instances):
        key = instance.element.key
        part += int(e > 0 and instance.acts != instances[e - 1].acts)
        spans.setdefault((key, part), [e, e])[1] = e + 1
        loaded[key] = instance.element
    tables: dict[str, list[tuple[int, int, int]]] = {kind: [] for kind in KINDS}
    for (key, _), (a, b) in spans.items():
        for kind, kernel in loaded[key].kernels.items():
            if kind not in tables or (
                kind == STRIKE and not any(map(takes_no_time, instances[a:b]))
            ):
                continue
            if instances[a].acts or kind not in ACTING:
                tables[kind].append((kernel.address(), a, b))
    return {kind: np.array(rows, np.int64).reshape(-1, 3) for kind, rows in tables.items()}


class Masses(NamedTuple):
    """Masses and inertia tensors of the frames, and their inverses.

    Of a light body they hold what it is solved with, `lacking` (light.py).  Of a node of a beam its
    share of them, lumped: for what is judged, not solved, by them.
    """

    mass: Array  # (n)
    inertia: Array  # (n, 9)
    mass_inverse: Array
    inertia_inverse: Array
    light: NDArray[np.int64]  # frames of light bodies
    lacking: Array  # (n_light, 10)


def masses(at: Addresses, d: int) -> Masses:
    """Those of all frames.  Raises ModelError for what no body has."""
    n = len(at.frames)
    light: dict[int, Array] = {}
    stand_ins = cache(partial(masses_and_arms, at))  # asked for by light bodies only
    mass, inertia = np.zeros(n), np.zeros((n, 9))
    mass_inverse, inertia_inverse = np.zeros(n), np.zeros((n, 9))
    for beam in at.beams.values():
        part = slice(beam.first, beam.first + beam.nodes)
        element = beam.per_length * beam.length
        mass[part] = element
        mass[[beam.first, beam.first + beam.nodes - 1]] *= 0.5
        inertia[part, 0::4] = mass[part, None] * beam.length**2 / 48.0
    for f, name in enumerate(at.owners[1 : at.n_rigid], start=1):
        spec = at.members[name]
        if spec.mass != 0.0 and not LIGHTEST <= spec.mass <= HEAVIEST:
            raise ModelError(f"no body of a mechanism has a mass of {spec.mass:.3g} kg",
                             "check its unit", ("bodies", name, "mass"))  # fmt: skip
        more = lacking(name, spec, lambda f=f: stand_ins()[f], d == 3)
        inertia[f], complete = spec.tensor
        mass[f], inertia[f] = spec.mass + more[0], inertia[f] + more[1:]
        known = inertia[f].reshape(3, 3)
        mass_inverse[f] = 1.0 / mass[f]
        if np.any(more):
            light[f] = more
        else:
            check_radius(name, spec.mass, known if complete else known[2:, 2:])
        if d == 3:
            inertia_inverse[f, 8] = 1.0 / inertia[f, 8]
        elif complete:
            inertia_inverse[f] = inverse(known).ravel()
        else:  # only for the look at the rows before planarity is known
            inertia_inverse[f, [0, 4, 8]] = 1.0 / inertia[f, 8]
    which, more = np.array(list(light), np.int64), np.array(list(light.values())).reshape(-1, 10)
    return Masses(mass, inertia, mass_inverse, inertia_inverse, which, more)


def masses_and_arms(at: Addresses) -> list[tuple[float, float]]:
    """Of every frame what stands for a mass of the mechanism, between its largest and its smallest,
    kg, and for an arm, m."""
    found = [one for name in at.members if (one := at.members[name].as_rigid().mass) > 0.0]
    mean, size = sqrt(min(found)) * sqrt(max(found)) if found else 1.0, extent(at)
    return [(mean, arm or size) for arm in levers(at, 0.0)]


def unequal(at: Addresses, mass: Array, inertia: Array, d: int) -> bool:
    """Whether a body is far lighter than others, or far easier to turn than it is to move by its
    arms or to turn about another axis."""
    n = at.n_rigid
    if n < 2:
        return False
    moments = inertia[1:n, 8:] if d == 3 else np.linalg.eigvalsh(inertia[1:n].reshape(-1, 3, 3))
    swung = mass[1:n] * np.array(levers(at, 0.0)[1:n]) ** 2
    turned = np.any(np.maximum(moments[:, -1], swung) > UNEQUAL * moments[:, 0])
    return bool(turned or mass[1:n].max() > UNEQUAL * mass[1:n].min())


def check_radius(name: str, mass: float, inertia: Array) -> None:
    """Refuse inertias that turn into no number: sqrt(I / m) is a length of the body."""
    for moment in np.linalg.eigvalsh(inertia).tolist():
        radius = sqrt(moment / mass)
        if not SMALLEST <= radius <= LARGEST:
            raise ModelError(
                f"a radius of gyration sqrt(inertia/mass) of {radius:.3g} m",
                f"between {SMALLEST:g} and {LARGEST:g} m can be solved; check mass and inertia",
                ("bodies", name, "inertia"),
            )


def drawn(at: Addresses, d: int) -> Array:
    """y as drawn, with the bodies' given velocities; z zero."""
    n, n_z, width = at.n_rigid, N_BOOK + len(at.states), 2 if d == 3 else 3
    nodes = 2 * width * (len(at.frames) - n)
    n_q = (3 if d == 3 else 7) * (n - 1) + nodes
    y = np.zeros(n_q + d * (n - 1) + nodes + n_z)
    for name, beam in at.beams.items():
        spec = at.members[name]
        slope = np.tile(beam.tangent, (beam.nodes, 1))
        omega, centre = np.array(spec.angular_velocity), beam.places.mean(axis=0)
        rate = np.array(spec.velocity) + np.cross(omega, beam.places - centre)
        q = (3 if d == 3 else 7) * (n - 1) + 2 * width * (beam.first - n)
        v = n_q + d * (n - 1) + 2 * width * (beam.first - n)
        end = 2 * width * beam.nodes
        y[q : q + end] = np.hstack([beam.places[:, :width], slope[:, :width]]).ravel()
        turning = np.cross(omega, slope)
        y[v : v + end] = np.hstack([rate[:, :width], turning[:, :width]]).ravel()
    for f, name in enumerate(at.owners[1:n], start=1):
        spec = at.members[name]
        v = n_q + d * (f - 1)
        if d == 3:
            y[3 * (f - 1) : 3 * f] = (*spec.at[:2], at.about_z[f])
            y[v : v + 3] = (*spec.velocity[:2], spec.angular_velocity[2])
        else:
            q = 7 * (f - 1)
            y[q : q + 3] = spec.at
            y[q + 3 : q + 7] = quaternion(spec)
            y[v : v + 3] = spec.velocity
            y[v + 3 : v + 6] = at.axes(f, spec.angular_velocity)
    return y


def turns(at: Addresses, d: int) -> dict[str, Any]:
    """Planar joint angles: (entry of S, i, j, sign of the axis), for their branch, and what each
    is when the axes of its bodies are parallel: not 0 between a body of an instance and others;
    and the entries of all other angles, and of what else is known up to full turns."""
    found = [
        (x, 1 if x.axis[2] > 0 else -1)
        for x in (at.coordinates.values() if d == 3 else ())
        if x.kind == "angle" and not (at.is_node(x.i) or at.is_node(x.j)) and abs(x.axis[2]) > 0.5
    ]
    rows = [(x.entry, x.i, x.j, sign) for x, sign in found]
    alike = at.about_z == at.angle
    parallel = [
        0.0
        if alike[x.i] and alike[x.j] and not x.from_drawing
        else x.drawn - sign * (at.about_z[x.j] - at.about_z[x.i])
        for x, sign in found
    ]
    unwrapped = {x.entry for x, _ in found}
    wound = [x.entry for x in at.coordinates.values() if x.kind in ("angle", WOUND)]
    return {
        "turn": np.array(rows, np.int64).reshape(-1, 4),
        "parallel": np.array(parallel, float),
        "wound": np.array([e for e in wound if e not in unwrapped], np.int64),
    }


def extent(at: Addresses) -> float:
    """Size of the mechanism: the diagonal of the box around its points as drawn, m."""
    # the origin is none of its points, unless something is joined to the ground there
    corners = [*at.at_start[1:]] if len(at.at_start) > 1 else [at.at_start[0]]
    corners += [at.at_start[i] + product(at.rotation[i], np.array(s)) for i, s in at.points]
    far = np.max(np.abs(corners), axis=1)
    worst = int(np.argmax(far))
    if far[worst] > LARGEST:
        frames = [*range(1, len(at.frames)), *(i for i, _ in at.points)]
        name = at.owners[frames[worst]]
        raise ModelError(
            f"a point of '{name}' lies {far[worst]:.3g} m from the origin",
            f"a mechanism of at most {LARGEST:g} m can be solved; check the units",
            ("bodies", name) if name in at.scenario.bodies else ("joints",),
        )
    box = np.ptp(np.array(corners), axis=0)
    size = length(box)
    return size if size > 0.0 else 1.0


def lone(at: Addresses, size: float, mass: Array, inertia: Array) -> float:
    """What stands for the arm of a body to which nothing is fixed away from its centre, m.

    How far bodies and what is fixed to them lie apart, or the largest radius of gyration.  Points
    of the ground do not count: a mass on a spring that is anchored far away does not move so far.
    """
    corners = [*at.at_start[1:]]
    corners += [
        at.at_start[i] + product(at.rotation[i], np.array(s)) for i, s in at.points if i > 0
    ]
    apart = length(np.ptp(np.array(corners), axis=0)) if corners else 0.0
    n = at.n_rigid
    moments = inertia[1:n, [0, 4, 8]].max(axis=1, initial=0.0)
    gyration = float(np.sqrt(moments / mass[1:n]).max(initial=0.0))
    return min(size, max(apart, gyration, FARTHEST * size))


def levers(at: Addresses, alone: float) -> list[float]:
    """Largest arm of every frame; `alone` where nothing is fixed away from its centre, m."""
    arms = [0.0] * len(at.frames)
    for i, s in at.points:
        arms[i] = max(arms[i], length(np.array(s)))
    for beam in at.beams.values():
        arms[beam.first : beam.first + beam.nodes] = [beam.whole] * beam.nodes
    return [a if a > 0.0 else alone for a in arms]


def norm(at: Addresses, d: int, size: float, arms: list[float]) -> tuple[NDArray[np.int64], Array]:
    """Unit of every entry of y in the error norm, and the lever of rotations."""
    kind: list[int] = []
    lever: list[float] = []
    width = 2 if d == 3 else 3
    bodies, nodes = arms[1 : at.n_rigid], arms[at.n_rigid :]
    angles, rates = (1, 1) if d == 3 else (4, 3)  # of a body: the four are of its quaternion
    for found, unit, turn, number, factor in (
        (bodies, scales.LENGTH, scales.ANGLE, angles, 1.0 if d == 3 else 2.0),
        (nodes, scales.LENGTH, scales.ANGLE, width, 1.0),
        (bodies, scales.SPEED, scales.RATE, rates, 1.0),
        (nodes, scales.SPEED, scales.RATE, width, 1.0),
    ):
        for arm in found:
            kind += [unit] * width + [turn] * number
            lever += [1.0] * width + [factor * arm] * number
    kind += [scales.OUTSIDE] * N_BOOK
    lever += [1.0] * N_BOOK
    for scale, _ in at.states:
        if isinstance(scale, str):
            kind.append(STATE_SCALES[scale])
            lever.append(size if scale == "angle" else 1.0)
        else:
            kind.append(scales.MAGNITUDE if scale else scales.OUTSIDE)
            lever.append(scale or 1.0)
    return np.array(kind, np.int64), np.array(lever)


def watched(switches: Switches, size: float) -> dict[str, Any]:
    """What user events watch, and where their work is booked."""
    events = switches.events
    watch = [(e.entry, e.direction, e.most) for e in events]
    # of a channel: watch.py
    scale = {"angle": 1.0, "stroke": size, "arc": size, "time": 0.0, CHANNEL: 0.0}
    at = [
        # of a limit the gap is watched, which has the limit taken off already
        (0.0, BAND * e.value) if e.kind == "limit" else (e.value, BAND * scale[e.kind])
        for e in events
    ]
    return {
        "watch": np.array(watch, np.int64).reshape(-1, 3),
        "watch_at": np.array(at, float).reshape(-1, 2),
        "jumps": switches.jumps,
    }


def contact_numbers(
    at: Addresses, instances: list[Instance], contacts: list[int], arms: list[float]
) -> Array:
    """ContactNumbers of every contact; of a stop on an angle the larger arm of its bodies."""
    rows = []
    for e in contacts:
        row = instances[e].row
        assert row.contact is not None  # noqa: S101
        i, j = row.con[0], row.con[1]
        inverse = (1.0 / at.mass(i) if i else 0.0) + (1.0 / at.mass(j) if j else 0.0)
        arm = max(arms[f] for f in (i, j) if f) if row.turns else 1.0
        numbers = ContactNumbers.numbers(row.contact, mass=arm**2 / inverse, arm=arm)
        rows.append(numbers["contact_par"])
    return np.array(rows, float).reshape(-1, len(ContactNumbers.columns))


def takes_no_time(instance: Instance) -> bool:
    """Whether touches of a contact are impacts that take no time."""
    contact = instance.row.contact
    return contact is not None and contact.impact is not None


def struck(at: Addresses, contacts: list[Instance]) -> NDArray[np.int64]:
    """1 of every contact whose touches take no time.  Raises ModelError for one with a bar."""
    found = np.array([takes_no_time(i) for i in contacts], np.int64)
    for instance, strikes in zip(contacts, found, strict=True):
        if strikes and max(instance.row.con[:2]) >= at.n_rigid:
            raise ModelError(
                "an impact that takes no time would strike one node of a flexible bar, whose mass "
                "is that of its elements: what comes of it depends on their number",
                "take a law of a force, as `identified`; of a stop leave out `restitution`",
                (instance.section, instance.name),
            )
    return found


def eccentricity(element: Element) -> int:
    """Where among its channels a contact has the place of its touch, or -1."""
    place = 0
    for channel in element.channels:
        if channel.name == "eccentricity_x":
            return place
        place += channel.size
    return -1
