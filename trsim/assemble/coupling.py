"""Which unknowns of a mechanism act on which: the sparsity of its equations, before any number.

A node is what moves as one: a moving body (its d velocities) or a state of an element.  Two nodes
are coupled where a force, a joint or a rate of change of one depends on the other.  Drives held or
let go by user events are counted as they are in any stage, so the coupling is that of all stages.
"""

from typing import NamedTuple

from trsim.assemble.instances import Instance
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.members import Beam
from trsim.elements.contract import N_BOOK

AT_A_NODE = 1e-9  # of the mechanism's size: an arm so long has no lever


class Nodes(NamedTuple):
    """Nodes of a mechanism: bodies first, then the states of elements."""

    bodies: int
    states: int
    groups: tuple[frozenset[int], ...]  # nodes that are coupled with each other, once each
    alone: frozenset[int] = frozenset()  # nodes of beams on which nothing else acts

    def neighbours(self) -> list[set[int]]:
        """For each node the others it is coupled with."""
        found: list[set[int]] = [set() for _ in range(self.bodies + self.states)]
        for group in self.groups:
            for node in group:
                found[node] |= group - {node}
        return found


def nodes(mechanism: Mechanism) -> Nodes:
    """The nodes of a mechanism, and which of them its elements couple."""
    bodies, states = mechanism.model.n - 1, mechanism.model.n_z - N_BOOK
    of = _Coupling(mechanism, bodies)
    groups = {of.group(instance) for instance in mechanism.instances}
    of_beams = {k for beam in mechanism.beams.values() for k in nodes_of(beam)}
    acting = (of.group(i) for i in mechanism.instances if not holds_still(i, mechanism))
    alone = of_beams.difference(*acting)
    for beam in mechanism.beams.values():
        groups |= {frozenset((k, k + 1)) for k in nodes_of(beam)[:-1]}
    coupled = tuple(sorted((g for g in groups if len(g) > 1), key=sorted))
    return Nodes(bodies, states, coupled, frozenset(alone))


def holds_still(instance: Instance, mechanism: Mechanism) -> bool:
    """Whether an element is a pin right at its nodes of beams, along world axes: whatever these do,
    its rows stay as they are."""
    con, par = instance.row.con, instance.row.par
    if (2 if mechanism.planar else 3) not in instance.element.pin:
        return False
    first = mechanism.model.n_r
    arms = [par[3 * end : 3 * end + 3] for end in (0, 1) if con[end] >= first]
    return all(abs(x) <= AT_A_NODE * mechanism.model.size for arm in arms for x in arm)


def nodes_of(beam: Beam) -> range:
    """The nodes of a beam."""
    return range(beam.first - 1, beam.first - 1 + beam.nodes)


class _Coupling:
    def __init__(self, mechanism: Mechanism, bodies: int) -> None:
        self.bodies = bodies
        self.sensed = {
            instance.name: instance.element.acts_on(instance.row)
            for instance in mechanism.instances
            if instance.section == "sensors"
        }
        self.motions = mechanism.stages.switches.motions

    def group(self, instance: Instance) -> frozenset[int]:
        """The nodes that an element couples."""
        if instance.section not in ("joints", "drives", "forces", "events"):
            return frozenset()
        frames = set(instance.element.acts_on(instance.row))
        states = set(instance.row.states)
        if instance.section in ("drives", "events"):
            states |= {state for state, _ in self.motions.get(instance.name, ())}
        frames = frames.union(*(self.sensed[name] for name in instance.row.reads))
        own = {f - 1 for f in frames if f > 0}
        return frozenset(own | {self.bodies + z - N_BOOK for z in states if z >= 0})
