"""Which cases of a plan are run: all of them, or those that what came out so far asks for.

Cases are chosen in batches, and a batch only from what the batches before it gave: neither the
order in which cases end has a say, nor the number of workers, nor what else is in the folder.  So a
sweep that is gone on with makes the same choices again, from its ledger.  The cases of each name in
`cases:` are chosen by themselves, with the rule of their `sweep:`

    until     so many samples that a number is sure enough (enough.py)
    refine    the values of a grid between which something changes (refined.py)
"""

from collections.abc import Callable, Iterator

from trsim.errors import UsageError
from trsim.sweeps.choosing import Choosing, Part, Results
from trsim.sweeps.enough import of_indices, of_means
from trsim.sweeps.plan import Case, Chosen, Plan
from trsim.sweeps.refined import refined


class Batches:
    """The cases of a plan, batch by batch; `chosen` is there once no further one is asked for."""

    def __init__(self, plan: Plan, results: Results) -> None:
        self.parts, self.results = parts(plan), results
        self.chosen: Chosen | None = None

    def __iter__(self) -> Iterator[list[Case]]:
        going = [(part, rule(part)(part, self.results)) for part in self.parts]
        asked, told = set[str](), dict[str, str]()
        while going:
            batch, left = list[Case](), []
            for part, choosing in going:
                try:
                    batch.extend(part.cases[k] for k in next(choosing))
                    left.append((part, choosing))
                except StopIteration as end:
                    told[part.name] = end.value
            going = left
            asked.update(case.name for case in batch)
            if batch:
                yield batch
        said = [(part.name, told[part.name]) for part in self.parts if told[part.name]]
        lines = (f"{name}: {text}" if name else text for name, text in said)
        self.chosen = Chosen(frozenset(asked), tuple(lines))


def parts(plan: Plan) -> list[Part]:
    """The cases of a plan by their names in `cases:`."""
    found: dict[str, list[Case]] = {name: [] for name in plan.trees}
    for case in plan.cases:
        found[case.case].append(case)
    return [Part(name, tuple(own), plan.trees[name].sweep) for name, own in found.items()]


def rule(part: Part) -> Callable[[Part, Results], Choosing]:
    """What chooses the cases of a part."""
    if part.sweep.refine:
        return refined
    if part.sweep.until:
        return of_indices if part.sweep.method == "sobol" else of_means
    return every


def every(part: Part, _: Results) -> Choosing:
    """All cases at once."""
    yield list(range(len(part.cases)))
    return ""


def check_whole(plan: Plan, shards: int) -> None:
    """Refuse to choose cases from the part of them that one shard knows."""
    if plan.adaptive and shards > 1:
        what = "`until` and `refine` choose cases from what all others gave, a shard has its own"
        hint = "Use --dask for several machines, or take them out of the `sweep:`."
        raise UsageError(what, hint)
