"""Places of forces named after a point of a body on which the force does not act."""

from collections.abc import Iterator
from typing import Any


def strangers(scenario: Any) -> Iterator[str]:
    """A point is a place as drawn, whoever names it; fixed in another body it leaves its own."""
    for section in ("drives", "forces"):
        for name, spec in getattr(scenario, section).items():
            for path, bodies in _places(spec):
                named = scenario.points_at(section, name, *path)
                for point, body in zip(named, bodies, strict=False):
                    if point is not None and point.body not in ("ground", body):
                        yield (
                            f"{'.'.join((section, name, *path))}: a point of '{point.body}', and "
                            f"it acts on '{body}', where the point is as drawn; is the other body "
                            "meant?"
                        )


def _places(spec: Any) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """Paths of places in a spec, and the body that each place there is fixed in."""
    if hasattr(spec, "body"):
        yield ("at",), (spec.body,)
    if hasattr(spec, "points"):
        yield ("points",), spec.bodies
    for key in ("point", "wall"):
        if getattr(spec, key, None) is not None:
            yield (key, "at"), (getattr(spec, key).body,)
