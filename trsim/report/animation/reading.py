"""What a run was made of, from the scenario in its result file."""

import numpy as np

from trsim import elements
from trsim.assemble.members import members
from trsim.assemble.orientation import quaternion
from trsim.elements.joint import perpendicular
from trsim.fields import direction
from trsim.report.animation.drawing import (
    GROUND,
    JOINTS,
    LINES,
    Array,
    Drawing,
    Joint,
    Line,
    Spot,
)
from trsim.report.animation.guides import behind, guides, near, plated
from trsim.report.animation.shapes import boxed
from trsim.report.animation.strands import ropes
from trsim.report.animation.trains import LONG, rim, transmissions
from trsim.scenario.load import loads
from trsim.store.read import Run

ALONG_Z = (0.0, 0.0, 1.0)  # of a joint that has no axis


def drawing(run: Run) -> Drawing:
    """What a run was made of; bodies without a recorded place are left out and named."""
    scenario = loads(run.text("scenario/resolved"))
    bodies, axes, bars, thickness, lost = {}, {}, {}, {}, []
    for name, spec in members(scenario).items():
        nodes = spec.elements + 1 if spec.flexible else 0
        channels = [f"{name}.node{k}.position" for k in range(nodes)] or [f"{name}.position"]
        if any(channel not in run.units for channel in channels):
            lost.append(name)
        elif spec.flexible:
            part = np.linspace(0.0, 1.0, nodes)[:, None]
            bars[name] = (1.0 - part) * np.array(spec.start) + part * np.array(spec.end)
            thickness[name] = spec.thickness
        else:
            bodies[name], axes[name] = np.array(spec.at), np.roll(quaternion(spec), -1)
    planar = bool(run.group("mechanism").get("planar", False))
    found = Drawing(scenario, bodies, axes, bars, thickness, planar, tuple(lost))
    moving, skipped = transmissions(found)
    found = found._replace(
        joints=joints(found),
        lines=lines(found),
        guides=guides(found),
        moving=moving,
        ropes=ropes(found),
        skipped=skipped,
    )
    return found._replace(held=held(found), corners=corners(found))


def joints(drawn: Drawing) -> tuple[Joint, ...]:
    """The joints between bodies that are drawn."""
    scenario = drawn.scenario
    released = {name for event in scenario.events.values() for name in event.do.release}
    found = []
    for name, spec in scenario.joints.items():
        made, clearance = elements.load(spec.type), getattr(spec, "clearance", 0.0)
        # a clearance of 0 is an ideal joint, also where it was written down
        picture = elements.load(made.ideal if made.ideal and not clearance else made.key).picture
        if picture not in JOINTS or not all(drawn.has(body) for body in spec.bodies):
            continue
        i, j = spec.bodies
        at = getattr(spec, "at", None)
        if at is None:  # a slide: at the centre of the second body
            at = drawn.bodies[j] if j in drawn.bodies else middle(drawn, j)
        axes = np.array(perpendicular(getattr(spec, "axis", None) or ALONG_Z, spec.drawn_in))
        if picture == "cross":
            axes[1] = direction(spec.second_axis)
            axes[0] = np.cross(axes[1], axes[2])
        radius = 0.0
        if picture == "journal":
            law = spec.contact or next(iter(scenario.contact_laws))
            radius = scenario.contact_laws[law].bearing_radius or 0.0
        found.append(Joint(name, picture, i, j, np.array(at), axes, clearance, radius,
                           name in released, getattr(spec, "pitch", 0.0)))  # fmt: skip
    return tuple(found)


def lines(drawn: Drawing) -> tuple[Line, ...]:
    """Actuators, springs, bushings and links between bodies that are drawn."""
    found, of = [], drawn.scenario
    for name, spec in {**of.joints, **of.drives, **of.forces}.items():
        picture = elements.load(spec.type).picture
        if picture not in LINES or not all(drawn.has(body) for body in spec.bodies):
            continue
        axes, slide = np.eye(3), None
        if picture == "block":
            axes, free = np.array(spec.axes), np.flatnonzero(np.equal(spec.stiffness, 0.0))
            slide = int(free[0]) if len(free) == 1 else None
        first, second = (spec.at, spec.at) if picture == "block" else spec.points
        ends = np.array(first), np.array(second)
        i, j = spec.bodies
        found.append(Line(name, picture, i, j, ends, axes, slide))
    return tuple(found)


def middle(drawn: Drawing, body: str) -> Array:
    """Halfway along a bar; the origin of the ground."""
    return drawn.bars[body].mean(axis=0) if body in drawn.bars else np.zeros(3)


def held(drawn: Drawing) -> tuple[Spot, ...]:
    """Points that bodies reach to, beside those of joints and lines."""
    found = []
    for guide in drawn.guides:
        found.append((guide.j, behind(drawn, guide)))
        found += [] if plated(guide) else [(guide.i, near(drawn, guide))]
    for joint in drawn.joints:
        found += [(body, joint.at) for body in (joint.i, joint.j) if joint.picture == "thread"]
    # where a load acts there is something of the body
    for spec in drawn.scenario.forces.values():
        body, at = getattr(spec, "body", None), getattr(spec, "at", None)
        found += [(body, np.array(at))] if body in drawn.bodies and at is not None else []
        found += [(spec.ball.body, np.array(spec.ball.at))] if hasattr(spec, "ball") else []
    found += [(place.body, place.at) for rope in drawn.ropes for place in rope.places]
    return tuple((body, at) for body, at in found if body != GROUND)


def corners(drawn: Drawing) -> tuple[Spot, ...]:
    """Points that have to be in the picture: of shapes, curves, wheels."""
    found = [(body, at) for body in drawn.bodies for at in boxed(drawn.shape(body))]
    for guide in drawn.guides:
        low, high = guide.curve.place.min(axis=0), guide.curve.place.max(axis=0)
        box = np.array([[x, y] for x in (low[0], high[0]) for y in (low[1], high[1])])
        found += [(guide.i, at) for at in guide.placed(box)]
    for wheel in drawn.moving.wheels:
        found += [(wheel.carrier, at) for at in rim(wheel)]
    for worm in drawn.moving.worms:
        half = 0.5 * LONG * drawn.moving.wheels[worm.wheel].radius
        found += [(worm.carrier, worm.at + side * half * worm.axis) for side in (-1.0, 1.0)]
    for place in (place for rope in drawn.ropes for place in rope.places):
        sides = abs(place.bend) * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])
        found += [(place.body, place.at + side) for side in sides]
    return tuple(found)
