"""What hangs on bodies that are parked: bodies that joints hold to them alone.

Take the parked bodies and the joints that have come apart away.  What is joined to a parked body
and, without it, not to the ground hangs on it: held there it costs six rows, free it would swing.
"""

from collections.abc import Collection, Iterable

from trsim.assemble.instances import Instance


def hanging(
    parked: Iterable[str], instances: Iterable[Instance], frames: dict[str, int],
    apart: Collection[str],
) -> tuple[str, ...]:  # fmt: skip
    """The parked bodies and what hangs on them, in the order of the scene.

    frames: of rigid bodies; apart: joints that are.
    """
    links = [
        of_joint(one) for one in instances if one.section == "joints" and one.name not in apart
    ]
    own = {frames[name] for name in parked}
    held = reached({0}, links, own)
    near = reached(own, links, {0})
    return tuple(name for name, f in frames.items() if f in own or (f in near and f not in held))


def of_joint(instance: Instance) -> frozenset[int]:
    """The frames that a joint holds together; of a relation of other joints none."""
    if instance.row.relates:
        return frozenset()
    return instance.named_by_rows or frozenset(instance.row.con[:2])


def reached(begin: set[int], links: Iterable[frozenset[int]], without: set[int]) -> set[int]:
    """The frames that joints lead to from some, not through others."""
    found, links = set(begin), [link - without | (link & begin) for link in links]
    while more := {f for link in links if link & found for f in link} - found:
        found |= more
    return found
