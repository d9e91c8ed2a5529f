"""Which constraint rows are solved: those in the plane of a planar scene, no redundant ones."""

from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.addresses import Addresses
from trsim.assemble.instances import Instance, RowName
from trsim.assemble.rank import (
    of_length_one,
    one_by_one,
    plainly_independent,
    unique_reactions,
)
from trsim.assemble.reduce import Drawn, moves
from trsim.assemble.redundant import Dependence, dependences
from trsim.assemble.shaky import shaky
from trsim.elements.contract import ends
from trsim.elements.scene import Model
from trsim.errors import ModelError

Array = NDArray[np.float64]

# cosines against the tangent of a flexible bar: of what points along it, and of a part that counts
ALONG, PARTLY = 1.0 - 1e-9, 1e-6


def all_rows(instances: list[Instance], held: Collection[str] = ()) -> list[RowName]:
    """Every constraint row of the elements, in three dimensions.

    held: the locks of user events that are closed; as drawn they are open.
    """
    rows = []
    for n, instance in enumerate(instances):
        if instance.row.is_force:
            continue
        if instance.section == "events" and instance.name not in held:
            continue
        for index, axis in enumerate(instance.element.rows):
            turns = axis.startswith(("tilt", "turn"))
            if axis == instance.row.unheld:
                continue
            frames = instance.row.frames(index)
            rows.append(RowName(instance.name, axis, n, index, frames, turns))
    return rows


class Chosen(NamedTuple):
    """Rows of the solve, and what was found of them."""

    kept: list[RowName]
    found: list[Dependence]
    inside: list[int]  # rows with a part in what moves: those kept and redundant ones
    plain: bool  # whether these are independent beyond doubt


def in_solve(full: Model, J: Array, planar: bool) -> NDArray[np.bool_]:
    """Rows with a part in the plane; all of them in space."""
    if not planar:
        return np.ones(len(J), bool)
    return np.abs(J[:, moves(full, True)]).max(axis=1, initial=0.0) > 1e-9


def reactions(drawn: Drawn, chosen: Chosen, planar: bool) -> tuple[list[int], list[int]]:
    """Rows of the solve whose reaction the motion determines, and those where it does not."""
    if chosen.plain:
        return chosen.inside, []
    keep, inside = moves(drawn.scene, planar), np.array(chosen.inside, np.int64)
    unique = unique_reactions(drawn.J[:, keep][inside], drawn.scale[keep])
    return inside[unique].tolist(), inside[~unique].tolist()


def choose_rows(drawn: Drawn, instances: list[Instance], planar: bool) -> Chosen:
    """Rows of the solve: in the plane where the scene is planar, the redundant ones dropped."""
    full, y6, rows, J = drawn.scene, drawn.y, drawn.rows, drawn.J
    candidates = np.flatnonzero(in_solve(full, J, planar)).tolist()
    is_drive = [instances[r.instance].section in ("drives", "events") for r in rows]
    is_lock = [instances[r.instance].section == "events" for r in rows]
    # translations first: where a choice is left, moments go rather than forces; then locks, which
    # may hold what is held already, and drives last
    order = sorted(candidates, key=lambda k: (is_drive[k], not is_lock[k], rows[k].rotation, k))
    keep = moves(full, planar)
    R = of_length_one(J[:, keep], drawn.scale[keep])
    if plainly_independent(R[order]):
        return Chosen([rows[k] for k in candidates], [], candidates, True)
    geometric = [k for k in candidates if not is_drive[k]]
    found = dependences(full, y6, keep, order, geometric, one_by_one(R, order))
    for f in found:
        if is_drive[f.row] and not is_lock[f.row] and f.everywhere:
            name = rows[f.row].element
            raise ModelError(
                "moves a coordinate that joints or another drive already fix",
                "two drives on one degree of freedom? remove one, or give it compliance",
                ("drives", name),
            )
    redundant = {f.row for f in found if f.everywhere}
    return Chosen([rows[k] for k in candidates if k not in redundant], found, candidates, False)


def check_shaky(drawn: Drawn, instances: list[Instance], planar: bool, chosen: Chosen) -> None:
    """Refuse joints that are proved to allow motions to first order only."""
    if not chosen.found:
        return
    rows = drawn.rows
    geometric = [k for k in chosen.inside if instances[rows[k].instance].section == "joints"]
    redundant = {f.row for f in chosen.found if f.everywhere}
    told = shaky(drawn.scene, drawn.y, rows, geometric, redundant, planar)
    if told is None:
        return
    names = dict.fromkeys(rows[k].element for k in told.rows)
    can = "none of them goes on" if told.at_most == 0 else f"only {told.at_most} of them go on"
    raise ModelError(
        f"as drawn {', '.join(names)} allow {told.first_order} motions, but to first order only: "
        f"{can}, as two bars stretched on one line cannot swing (a shaky mechanism)",
        "draw it as it moves, give a joint a clearance or a bar that stretches, or leave out what "
        "cannot move",
        ("joints", next(iter(names))),
    )


def check_rubbing(
    instances: list[Instance], rows: list[RowName], not_unique: list[int], found: list[Dependence]
) -> None:
    """Friction of a joint whose reaction the motion does not determine.

    not_unique: rows whose reaction it does not; found: rows that depend on others.
    """
    several = [rows[k] for k in not_unique] if any(f.everywhere for f in found) else []
    for instance in instances:
        own = [row for row in several if row.element == instance.row.rubs]
        if own:
            others = dict.fromkeys(r.element for r in several if r.element != instance.row.rubs)
            raise ModelError(
                f"the reaction of '{instance.row.rubs}', which makes this friction, is not unique: "
                f"{', '.join(row.axis for row in own)} may be shared"
                + (f" with {', '.join(others)}" if others else " among its own rows"),
                "replace a joint by one that holds less, as `trsim check` proposes, so that the "
                "mechanism has no redundant rows there",
                (instance.section, instance.name),
            )


def check_pressed(instances: list[Instance], kept: list[RowName], planar: bool) -> None:
    """Friction of a joint that holds nothing in the plane, so that nobody knows what presses it."""
    held = {row.element for row in kept}
    for instance in instances:
        if planar and instance.row.rubs and instance.row.rubs not in held:
            raise ModelError(
                f"'{instance.row.rubs}' holds nothing in the x-y plane, and what presses it is not "
                "solved for in a planar scene",
                "set `planar: false`, and give three inertias of each body",
                (instance.section, instance.name),
            )


def dropped(rows: list[RowName], found: list[Dependence]) -> list[RowName]:
    """The rows that are not solved, as others hold what they do."""
    return [rows[f.row] for f in found if f.everywhere]


def check_inertias(at: Addresses, planar: bool, because: str = "") -> None:
    """A single inertia is about z: not enough in space.  because: why the scene is spatial."""
    if planar:
        return
    for name, spec in at.members.items():
        if spec.flexible is None and not spec.tensor[1]:
            raise ModelError(
                "one inertia (about z) is not enough in a scene that is not planar"
                + (f": {because}" if because else ""),
                "give three principal inertias, or six numbers with the products",
                ("bodies", name, "inertia"),
            )


def check_space(at: Addresses, instances: list[Instance]) -> None:
    """What cannot be in space: elements of the plane, and what a flexible bar cannot do, as it has
    no torsion and bends alike all around."""
    for instance in instances:
        if instance.element.in_plane(instance.row):
            raise ModelError(
                f"a {instance.element.key} like this one is solved in the x-y plane only, and the "
                "scene leaves it",
                "draw the mechanism in the x-y plane; `trsim check` says what leaves it",
                (instance.section, instance.name),
            )
    for name, spec in at.members.items():
        if spec.flexible is not None and not spec.flexible.numbers[2]:
            raise ModelError(
                "a flexible bar in space bends alike in all directions, and this section does not",
                "use a round or square section, or draw the mechanism in the x-y plane",
                ("bodies", name),
            )
    loads(at, instances)
    resisted(at, instances)
    cross_sections(at, instances)
    for instance in instances:
        if instance.section != "joints" or not instance.element.holds_twist:
            continue
        if any(at.is_node(f) for f in ends(instance.row)):
            raise ModelError(
                f"a {instance.element.key} holds the turning of a flexible bar about itself, "
                "and in space that has no torsion",
                "join it by `spherical` or `fixed`, or draw the mechanism in the x-y plane",
                ("joints", instance.name),
            )


def loads(at: Addresses, instances: list[Instance]) -> None:
    """A torque along a flexible bar in space, which turns nothing."""
    for instance in instances:
        for node, frame, direction in instance.turning.torques:
            if not at.is_node(node):
                continue
            along = at.rotation[frame] @ np.array(direction) @ at.rotation[node][:, 0]
            if abs(along) > PARTLY:
                part = "" if abs(along) > ALONG else f"with {abs(along):.2g} of it "
                raise ModelError(
                    f"turns '{at.owners[node]}' {part}about itself, and in space that has no "
                    "torsion",
                    "give the torque a direction across the bar, make the bar rigid "
                    "(`flexible: false`), or draw the mechanism in the x-y plane",
                    (instance.section, instance.name, "direction"),
                )


def resisted(at: Addresses, instances: list[Instance]) -> None:
    """What may hold places of a flexible bar in space and no turns: bushings, rough balls."""
    for instance in instances:
        node = next(filter(at.is_node, instance.turning.held), None)
        if node is not None:
            raise ModelError(
                f"holds the turning of '{at.owners[node]}', a flexible bar, about itself, and in "
                "space that has no torsion",
                "leave out what acts against turns, as rotational stiffness, let it act on a rigid "
                "body fixed to the bar, or draw the mechanism in the x-y plane",
                (instance.section, instance.name),
            )


def cross_sections(at: Addresses, instances: list[Instance]) -> None:
    """What would be carried along by the cross-section of a bar in space, whose turn about the bar
    nobody knows: welds of bars at an angle, walls and directions across a bar."""
    for instance in instances:
        con = instance.row.con
        for frame, direction in instance.turning.axes:
            if at.is_node(frame) and abs(direction[0]) < ALONG:
                raise ModelError(
                    f"turns with '{at.owners[frame]}', a flexible bar, of which in space nobody "
                    "knows how it turns about itself",
                    "let it turn with a rigid body, or draw the mechanism in the x-y plane",
                    (instance.section, instance.name),
                )
        bars = instance.element.welds and at.is_node(con[0]) and at.is_node(con[1])
        if bars and abs(np.dot(at.tangent(con[0]), at.tangent(con[1]))) < ALONG:
            raise ModelError(
                "welds two flexible bars at an angle, and in space these have no torsion",
                "join them by `spherical`, make them rigid (`flexible: false`), or draw the "
                "mechanism in the x-y plane",
                ("joints", instance.name),
            )
