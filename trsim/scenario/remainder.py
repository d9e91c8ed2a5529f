"""The body that takes the rest of a total.

    m_r = m - sum m_k
    c_r = (m c - sum m_k c_k)/m_r
    I_r = I - sum (I_k + S(m_k, c_k)) - S(m_r, c_r)

m, c and I are known of the total, from a balance or a drawing, r is the remainder, k are the other
bodies, and S(m_k, c_k) is the inertia about c of a mass at c_k.
"""

from typing import Any

import numpy as np

from trsim.elements.inertia import tensor_of, written
from trsim.elements.weighing import axes_of, of_body, turned
from trsim.errors import ScenarioError, known
from trsim.laws.solids import Bulk, moved, possible, together
from trsim.scenario.totals import Total


def remainders(totals: dict[str, Total], bodies: dict[str, Any]) -> dict[str, Any]:
    """The bodies that take the rest, as they are then.  Raises ScenarioError with its path."""
    found: dict[str, Any] = {}
    for name, total in in_order(totals, bodies):
        try:
            found[total.remainder] = rest(total, {**bodies, **found})
        except ScenarioError as error:
            raise error.at("totals", name) from None
    return found


def in_order(totals: dict[str, Total], bodies: dict[str, Any]) -> list[tuple[str, Total]]:
    """The totals, each behind those whose remainders are among its bodies, whatever the file."""
    others, taken = dict[str, list[str]](), set[str]()
    for name, total in totals.items():
        try:
            others[name] = members(total, bodies)
            if total.remainder in taken:
                what = f"'{total.remainder}' is the remainder of another total already"
                raise ScenarioError(what, "a body takes the rest of one", ("remainder",))
        except ScenarioError as error:
            raise error.at("totals", name) from None
        taken.add(total.remainder)
    found, left = list[tuple[str, Total]](), dict(totals)
    while left:
        unknown = {total.remainder for total in left.values()}
        ready = [name for name in left if not unknown & {*others[name]}]
        if not ready:
            name = next(iter(left))
            what = f"the totals {', '.join(left)} wait for the remainders of each other"
            hint = "leave the remainder of the one out of the bodies of the other"
            raise ScenarioError(what, hint, ("totals", name, "remainder"))
        found += [(name, left.pop(name)) for name in ready]
    return found


def rest(total: Total, bodies: dict[str, Any]) -> Any:
    """The remainder of a total as it is then."""
    names = members(total, bodies)
    own, others = bodies[total.remainder], [bodies[k].as_rigid() for k in names]
    weight = sum(one.mass for one in others)
    mass = total.mass - weight
    if mass <= 0.0:
        what = f"the other bodies weigh {weight:.6g} kg, no less than the total"
        raise ScenarioError(what, "check their masses and units", ("mass",))
    centre = np.array(own.at)
    if total.at is not None:
        moments = sum(one.mass * np.array(one.at) for one in others)
        centre = (total.mass * np.array(total.at) - moments) / mass
    changed = own.model_copy(update={"mass": mass, "at": tuple(centre.tolist())})
    if total.inertia is None:
        return changed
    about = together(map(of_body, (*others, changed))).centre
    return changed.model_copy(update={"inertia": inertia_left(total, changed, others, about)})


def members(total: Total, bodies: dict[str, Any]) -> list[str]:
    """The bodies of a total without its remainder."""
    names = list(total.bodies) if total.bodies is not None else list(bodies)
    for path, name in (*((("bodies", k), one) for k, one in enumerate(names)),
                       (("remainder",), total.remainder)):  # fmt: skip
        if name not in bodies:
            raise ScenarioError(f"no body named '{name}'", known(name, bodies), path)
    if len(set(names)) < len(names):
        raise ScenarioError("names a body twice", "name each once", ("bodies",))
    if total.remainder not in names:
        what = f"the remainder '{total.remainder}' is none of its bodies"
        raise ScenarioError(what, "name it among them, too", ("remainder",))
    if getattr(bodies[total.remainder], "flexible", None) is not None:
        what = f"the remainder '{total.remainder}' is flexible: its mass follows from its section"
        raise ScenarioError(what, "choose a rigid body", ("remainder",))
    return [name for name in names if name != total.remainder]


def inertia_left(total: Total, remainder: Any, others: list[Any], about: Any) -> Any:
    """The inertia that is left for the remainder, in its own axes."""
    wanted, whole = tensor_of(total.inertia)
    used = sum((moved(of_body(one), about) for one in others), np.zeros((3, 3)))
    empty = Bulk(remainder.mass, np.array(remainder.at), np.zeros((3, 3)))
    R = axes_of(total.drawn_in)
    left = np.reshape(wanted, (3, 3)) - R.T @ (used + moved(empty, about)) @ R
    known_all = all(one.tensor[1] for one in others)
    if whole and not known_all:
        what = "one of its bodies has an inertia about z only"
        raise ScenarioError(what, "give one number, the total about z", ("inertia",))
    if left[2, 2] <= 0.0 or (whole and not possible(left)):
        shown = ", ".join(f"{left[k, k]:.4g}" for k in range(3)) if whole else f"{left[2, 2]:.4g}"
        raise ScenarioError(
            f"no body has the inertia that is left for '{total.remainder}': {shown} kg*m^2",
            "check the total and the inertias and places of the other bodies",
            ("inertia",),
        )
    if not whole:
        return float(left[2, 2])
    return written(turned(remainder, R @ left @ R.T, into_body=True))
