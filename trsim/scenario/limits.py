"""How large a mechanism may be unless its file says more.

A few lines with templates make thousands of bodies, and hours of assembly: who means that says so,
`limits: {bodies: 1000}`.  What instances make is counted before anything is made of it.
"""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from annotated_types import Ge, Le

from trsim.errors import ScenarioError, described
from trsim.fields import Spec
from trsim.scenario.merge import mapping
from trsim.scenario.template import SECTIONS

Count = Annotated[int, Ge(1), Le(1_000_000)]


class Limits(Spec):
    """How much of a kind a mechanism may have; more takes minutes to hours to assemble.

    bodies   largest number of rigid bodies and flexible bars
    rows     largest number of constraint rows of joints and drives
    nodes    largest number of nodes of all flexible bars
    entries  largest number of points, bodies, joints, drives, sensors, forces and events together
    """

    type: ClassVar[str] = "limits"
    bodies: Count = 200
    rows: Count = 1500
    nodes: Count = 2000
    entries: Count = 2000


KINDS = {"bodies": "bodies", "rows": "constraint rows", "nodes": "nodes of flexible bars",
         "entries": "entries"}  # fmt: skip


def too_many(kind: str, count: int, limit: int, *path: str, how: str = "") -> ScenarioError:
    """The error of a mechanism that has too many of a kind."""
    what = f"{count} {KINDS[kind]}{how}: at most {limit} unless `limits` says more"
    hint = f"If they are meant, write `limits: {{{kind}: {count}}}`; it will take its time."
    return ScenarioError(what, hint, path)


def allowed(data: dict[str, Any], kind: str) -> int:
    """The limit in a tree that is not validated yet; where that is wrong it is found there."""
    found = mapping(data, "limits").get(kind)
    default: int = Limits.model_fields[kind].default
    return found if isinstance(found, int) and not isinstance(found, bool) else default


def before_unfolding(data: dict[str, Any], templates: dict, instances: dict) -> Iterator[Any]:
    """What is too much of what instances will make, before it is made."""
    made: dict[str, dict[str, int]] = {"bodies": {}, "entries": {}}
    for given in instances.values():
        word = given.get("template") if isinstance(given, dict) else None
        of = templates.get(word) if isinstance(word, str) else None
        for section in SECTIONS:
            n = len(mapping(of, section))
            for kind in ("bodies", "entries") if section == "bodies" else ("entries",):
                made[kind][str(word)] = made[kind].get(str(word), 0) + n
    for kind, counts in made.items():
        total, limit = sum(counts.values()), allowed(data, kind)
        if total > limit:
            most = max(counts, key=lambda word: counts[word])
            many = f" {counts[most]} of them" if counts[most] < total else ""
            how = f",{many} of instances of {described(most)}"
            yield too_many(kind, total, limit, "instances", how=how)


def sizes(scenario: Any) -> Iterator[ScenarioError]:
    """What a validated scenario has too much of."""
    from trsim import elements

    limits = scenario.limits
    if len(scenario.bodies) > limits.bodies:
        yield too_many("bodies", len(scenario.bodies), limits.bodies, "bodies")
    entries = sum(len(getattr(scenario, section)) for section in SECTIONS)
    if entries > limits.entries:
        yield too_many("entries", entries, limits.entries)
    bars = {name: spec.flexible for name, spec in scenario.bodies.items()}
    nodes = {name: bar.elements + 1 for name, bar in bars.items() if bar is not None}
    if sum(nodes.values()) > limits.nodes:
        most = max(nodes, key=lambda name: nodes[name])
        how = f", {nodes[most]} of them of {described(most)}" if len(nodes) > 1 else ""
        yield too_many("nodes", sum(nodes.values()), limits.nodes, "bodies", most, how=how)
    rows = sum(
        len(elements.load(spec.type).rows)
        for section in ("joints", "drives")
        for spec in getattr(scenario, section).values()
    )
    if rows > limits.rows:
        yield too_many("rows", rows, limits.rows, "joints")
