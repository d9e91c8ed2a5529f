"""The arrays of a model, one function for each group of them."""

from collections.abc import Sequence
from functools import cache, partial
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.addresses import Addresses
from trsim.assemble.dense import inverse
from trsim.assemble.instances import Instance, RowName
from trsim.assemble.light import lacking
from trsim.assemble.orientation import quaternion
from trsim.assemble.places import WOUND
from trsim.assemble.sizes import Sizes
from trsim.assemble.switches import BAND, CHANNEL, Switches
from trsim.elements import scene as scales
from trsim.elements.contract import FIRST_ROW, KINDS, N_BOOK, ContactNumbers, Element
from trsim.errors import ModelError

Array = NDArray[np.float64]

LIGHTEST, HEAVIEST = 1e-30, 1e30  # kg
STATE_SCALES = {"angle": scales.ANGLE, "stroke": scales.LENGTH, "speed": scales.SPEED}
VALUE_AT, BAND_AT = range(2)  # columns of `watch_at`
UNEQUAL = 1e5  # with all else of one size S = J M^-1 J^T loses as many digits
SMALLEST, LARGEST = 1e-12, 1e12  # m, radii of gyration
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
    width = max(map(len, rows), default=1)
    table = [(*row, *(rest,) * (width - len(row))) for row in rows] or [(rest,) * width]
    return np.array(table, kind)


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


def masses(at: Addresses, d: int, sizes: Sizes) -> Masses:
    """Those of all frames.  Raises ModelError for what no body has."""
    n = len(at.frames)
    light: dict[int, Array] = {}
    stand_ins = cache(partial(masses_and_arms, at, sizes))  # asked for by light bodies only
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
        tensor, complete = spec.tensor
        more = lacking(name, spec, lambda f=f: stand_ins()[f], d == 3)
        mass[f], inertia[f] = spec.mass, tensor
        if more is None:
            check_radius(name, spec.mass, tensor if complete else tensor[8:])
        else:
            light[f] = more
            mass[f] += more[0]
            inertia[f] += more[1:]
        mass_inverse[f] = 1.0 / mass[f]
        if d == 3:
            inertia_inverse[f, 8] = 1.0 / inertia[f, 8]
        elif complete:
            inertia_inverse[f] = inverse(inertia[f].reshape(3, 3)).ravel()
        else:  # only for the look at the rows before planarity is known
            inertia_inverse[f, [0, 4, 8]] = 1.0 / inertia[f, 8]
    inertia += 0.0  # no zero with a sign
    which, more = np.array(list(light), np.int64), np.array(list(light.values())).reshape(-1, 10)
    return Masses(mass, inertia, mass_inverse, inertia_inverse, which, more)


def masses_and_arms(at: Addresses, sizes: Sizes) -> list[tuple[float, float]]:
    """Of every frame what stands for a mass of the mechanism, between its largest and its smallest,
    kg, and for an arm, m."""
    found = [one for name in at.members if (one := at.members[name].as_rigid().mass) > 0.0]
    mean = sqrt(min(found)) * sqrt(max(found)) if found else 1.0
    return [(mean, arm or sizes.whole) for arm in sizes.arms]


def unequal(at: Addresses, of: Masses, arms: list[float], d: int) -> bool:
    """Whether a body is far lighter than others, or far easier to turn than it is to move by its
    arms or to turn about another axis."""
    n = at.n_rigid
    if n < 2:
        return False
    mass, inertia = of.mass[1:n], of.inertia[1:n]
    moments = inertia[:, 8:] if d == 3 else np.linalg.eigvalsh(inertia.reshape(-1, 3, 3))
    swung = mass * np.array(arms[1:n]) ** 2
    turned = (np.maximum(moments[:, -1], swung) > UNEQUAL * moments[:, 0]).any()
    return bool(turned or mass.max() > UNEQUAL * mass.min())


def check_radius(name: str, mass: float, inertia: tuple[float, ...]) -> None:
    """Refuse inertias that turn into no number: sqrt(I / m) is a length of the body.

    inertia: a tensor, row by row, or one moment.
    """
    if any(inertia[k] for k in (1, 2, 5) if k < len(inertia)):
        moments = np.linalg.eigvalsh(np.reshape(inertia, (3, 3))).tolist()
    else:
        moments = sorted(inertia[::4])
    for moment in moments:
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


def lone(at: Addresses, sizes: Sizes, of: Masses) -> float:
    """What stands for the arm of a body to which nothing is fixed away from its centre, m.

    How far bodies and what is fixed to them lie apart, or the largest radius of gyration.  Points
    of the ground do not count: a mass on a spring that is anchored far away does not move so far.
    """
    part = slice(1, at.n_rigid)
    bodies = zip(of.inertia[part, ::4].tolist(), of.mass[part].tolist(), strict=True)
    gyration = max((sqrt(max(*moments, 0.0) / mass) for moments, mass in bodies), default=0.0)
    return min(sizes.whole, max(sizes.apart, gyration, FARTHEST * sizes.whole))


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
