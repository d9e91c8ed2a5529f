"""Surfaces that are touched, and the balls and rollers that touch them."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from trsim import elements
from trsim.elements.surface import Surface, pieces_of
from trsim.report.animation import solids
from trsim.report.animation.drawing import GROUND, Array, Drawing
from trsim.report.animation.motion import Motion
from trsim.report.animation.plates import plate
from trsim.report.animation.solids import Mesh, circle
from trsim.report.animation.things import STOP, Look, Thing, colours, origin, pose
from trsim.report.animation.wires import wire

TURN = 0.02  # rad, by which a line turns at a place that is drawn
WIRE = 0.3  # half widths of a link: radius of a wire
POINT = 0.4  # the same: radius of a point
LONG = 20.0  # the same: half the length of a plane
CORNERS = 48  # of a circle


def contacts(drawn: Drawing) -> Iterator[tuple[str, Any]]:
    """The contacts between bodies that are drawn."""
    for name, spec in drawn.scenario.forces.items():
        if elements.load(spec.type).picture != "touch":
            continue
        if {spec.surface.body, spec.ball.body} <= {GROUND, *drawn.bodies, *drawn.bars}:
            yield name, spec


def touched(moved: Motion, look: Look) -> Iterator[Thing]:
    """Each surface on its body, and the ball on its own."""
    drawn = moved.drawn
    for name, spec in contacts(drawn):
        surface, ball = spec.surface, spec.ball
        both = ((surface.body, surface_mesh(spec, look)), (ball.body, ball_mesh(spec, look)))
        for body, mesh in both:
            # the surface of the ground is in the layer of what meets it
            lift = look.lift(ball.body if body == GROUND else body)
            mesh = mesh.moved(lift - origin(drawn, body))
            colour = STOP if body == GROUND else colours(drawn)[body]
            yield Thing(f"{name} {body}", ((mesh, colour),), *pose(moved, body))


def surface_mesh(spec: Any, look: Look) -> Mesh:
    """The surface in its place as drawn."""
    surface, at = spec.surface, np.array(spec.surface.at)
    axes, thin = axes_of(surface), WIRE * look.radius
    if surface.shape == "plane":
        far = np.array(spec.ball.at) - at
        middle = at + far - (far @ axes[1]) * axes[1] - 0.5 * thin * axes[1]
        half = LONG * look.radius
        deep = look.thick if look.normal is not None else half
        return solids.box(np.array([2.0 * half, thin, 2.0 * deep]), axes).moved(middle)
    if surface.shape == "sphere":
        if not surface.hollow:
            return solids.ball(surface.radius).moved(at)
        rings = [
            wire(circle(surface.radius, CORNERS) @ axes[list(pair)], thin, axes[across], True)
            for pair, across in (((0, 1), 2), ((1, 2), 0), ((0, 2), 1))
        ]
        return solids.joined(*rings).moved(at)
    flat = outline(surface)
    if surface.hollow or not (surface.closed or surface.shape == "cylinder"):
        closed = surface.closed or surface.shape == "cylinder"
        return wire(flat @ axes[:2], thin, axes[2], closed).moved(at)
    return plate(flat, look.thick, axes).moved(at)


def axes_of(surface: Surface) -> Array:
    """x, y and z of a surface as drawn, in rows."""
    return np.array([surface.frame.x, surface.frame.y, surface.frame.z])


def outline(surface: Surface) -> Array:
    """Places [x, y] along a profile or round a cylinder, no more than are seen."""
    if surface.shape == "cylinder":
        return circle(surface.radius or 0.0, CORNERS)
    places = pieces_of(surface, -1 if surface.hollow else 1, inward=True).outline
    along = np.diff(places, axis=0)
    places, along = places[np.append(True, np.linalg.norm(along, axis=1) > 0.0)], along
    kept = [0]
    for k in range(1, len(places) - 1):
        a, b = places[k] - places[kept[-1]], places[k + 1] - places[k]
        turn = abs(a[0] * b[1] - a[1] * b[0])
        if turn > TURN * np.linalg.norm(a) * np.linalg.norm(b):
            kept.append(k)
    return places[[*kept, len(places) - 1][: None if not surface.closed else -1]]


def ball_mesh(spec: Any, look: Look) -> Mesh:
    """The ball in its place; in a flat mechanism a roller."""
    ball, radius = spec.ball, spec.ball.radius or POINT * look.radius
    if ball.corners is not None:
        axes = axes_of(spec.surface)
        return plate(rounded(np.array(ball.corners), radius), look.thick, axes).moved(
            np.array(ball.at)
        )
    if look.normal is None:
        return solids.ball(radius).moved(np.array(ball.at))
    return solids.cylinder(radius, look.thick, look.normal).moved(np.array(ball.at))


def rounded(corners: Array, radius: float) -> Array:
    """Places [x, y] along a convex outline with a round edge."""
    x, y = (corners - corners.mean(axis=0)).T
    if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) < 0.0:
        corners = corners[::-1]
    ways = np.roll(corners, -1, axis=0) - corners
    turns = np.arctan2(ways[:, 1], ways[:, 0]) - 0.5 * np.pi  # of the normals of the sides
    found = []
    for k, corner in enumerate(corners):
        turn = np.mod(turns[k] - turns[k - 1], 2.0 * np.pi)
        u = turns[k - 1] + turn * np.linspace(0.0, 1.0, 2 + int(CORNERS * turn / (2.0 * np.pi)))
        found.append(corner + radius * np.column_stack([np.cos(u), np.sin(u)]))
    return np.vstack(found)
