"""Coordinates of joints by name: `hinge`; of a joint with several `slide.angle`, `slide.stroke`."""

from collections.abc import Mapping
from typing import Any

from trsim import elements
from trsim.elements.rows import ARC, COORDINATES
from trsim.errors import ScenarioError, known

ANY = "any"  # kind of coordinate: also a length along a curve
BEND = "bend"  # of a joint; it is watched and stopped, and nothing drives or relates it


def split(reference: str, joints: Any) -> tuple[str, str]:
    """The joint that is meant and which of its coordinates, where that is said; all texts."""
    joint, _, which = reference.rpartition(".")
    return (joint, which) if reference not in joints and joint in joints else (reference, "")


def of_joint(joint: str, joints: Mapping[str, Any]) -> dict[str, str]:
    """The coordinates of a joint, by what they are called; of others none."""
    there = elements.load(joints[joint].type).coordinates if joint in joints else ()
    return {joint if len(there) == 1 else f"{joint}.{one}": one for one in there}


def bend_of(reference: str, joints: Mapping[str, Any]) -> tuple[str, Any]:
    """The joint whose bend is meant and the axes between which it is; ("", None) where none is.

    Raises ScenarioError of a joint that has no axes to count it from.
    """
    joint, which = split(reference, joints)
    if which != BEND or elements.load(joints[joint].type).bends is None:
        return "", None
    axes = elements.load(joints[joint].type).bends(joints[joint])
    if axes is None:
        what = f"'{joint}' has no axes between which it could bend"
        hint = f"give joints.{joint} an `axis`, and a `second_axis` where it is drawn bent"
        raise ScenarioError(what, hint, ("joint",))
    return joint, axes


def named(
    reference: str, joints: Mapping[str, Any], kind: str = "", path: tuple = ("joint",)
) -> tuple[str, str, str]:
    """What the coordinate is called that is meant, its joint and which of its coordinates it is.

    kind: what it must be, angle, stroke, or ANY; unless given one of the first two.  Raises
    ScenarioError where it is none, or may be several.
    """
    joint, which = split(reference, joints)
    if joint not in joints:
        raise ScenarioError(f"no joint named '{reference}'", known(reference, joints), path)
    there, word = of_joint(joint, joints), joints[joint].type
    if not there:
        hint = "name a revolute or a prismatic joint"
        if elements.load(word).sways:
            hint += (
                f"; a `ball_spring` holds and damps this one, sensors and a `limit_stop` know its "
                f"bend, `{joint}.{BEND}`"
            )
        raise ScenarioError(f"joint '{joint}' ({word}) has no coordinate", hint, path)
    if which == BEND and elements.load(word).bends is not None:
        raise ScenarioError(
            f"the bend of '{joint}' is none of its coordinates",
            f"sensors and a `limit_stop` know it; here name {' or '.join(there)}",
            path,
        )
    if which and which not in there.values():
        raise ScenarioError(f"joint '{joint}' has no {which}", known(reference, there), path)
    if kind != ANY and any(COORDINATES[own].kind == ARC for own in there.values()):
        raise ScenarioError(
            f"the place of '{joint}' on its curve is a length along it, and no angle or stroke",
            "sensors, events and a `limit_stop` know it; drive or hold another joint",
            path,
        )
    fits = [
        (name, own)
        for name, own in there.items()
        if which in ("", own) and kind in ("", ANY, COORDINATES[own].kind)
    ]
    if not fits:
        own = " and ".join(map(article, [which] if which else there.values()))
        raise ScenarioError(
            f"joint '{joint}' has {own}, not {article(kind)}",
            "name a revolute joint" if kind == "angle" else "name a prismatic joint",
            path,
        )
    if len(fits) > 1:
        what = f"joint '{joint}' has several coordinates"
        raise ScenarioError(what, f"name one of them: {', '.join(there)}", path)
    return fits[0][0], joint, fits[0][1]


def article(coordinate: str) -> str:
    """A coordinate with its article."""
    return f"{'an' if coordinate in ('angle', 'x') else 'a'} {coordinate}"


def called(reference: str, joints: Mapping[str, Any]) -> str:
    """What the coordinate is called that is meant; the reference itself where it is none."""
    try:
        return named(reference, joints, ANY)[0]
    except ScenarioError:
        return reference
