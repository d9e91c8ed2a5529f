"""One case: its scenario run into its result file, in the process that calls."""

import time
from collections.abc import Callable, Generator
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from trsim.errors import FileError, SolverError, TrsimError
from trsim.scenario.methods import METHODS
from trsim.scenario.vary import SUMMARY
from trsim.solve.blocks import Blocks
from trsim.sweeps.ledger import DIGEST, REFUSED

CHECKPOINT = 60.0  # s of wall time between two
PATIENCE = 10.0  # s
CONTACT = ("impacts", "fastest_impact", "peak_force", "peak_time")
STATISTICS = (
    "steps", "position_residual", "joints_open_relative", "redundant_open_relative",
    "energy_residual_relative", "integration_cpu",
)  # fmt: skip


def prepare() -> None:
    """Load what every case needs."""
    for name in ("assemble.assemble", "solve.simulate", "store.hdf5"):
        import_module(f"trsim.{name}")
    import_module("llvmlite.binding")


def run(task: dict[str, Any], begun: Callable[[], None]) -> dict[str, Any]:
    """How a case ended: status, reason, summary.

    task: `resolved`, the data of the scenario; `text` and `files`, what it was read from; `target`;
    `digest` of the case.  begun: called when the first results are there, so compiling is over.
    """
    clock = time.perf_counter()
    try:
        summary = _ran(task, begun)
    except FileError as error:
        return {"status": "no file", "reason": error.show()}
    except SolverError as error:
        return {"status": "failed", "reason": error.show()}
    except TrsimError as error:
        return {"status": REFUSED, "reason": error.show()}
    return {
        "status": summary["status"],
        "reason": summary["reason"],
        "content": summary["content_sha256"],
        "wall": time.perf_counter() - clock,
        "summary": brief(summary) | summary["asked"],
        **({"record": summary["record"]} if "record" in summary else {}),
    }


def brief(summary: dict[str, Any]) -> dict[str, Any]:
    """The part of the summary of a run that a table of runs shows."""
    found = {name: summary[name] for name in ("time", "rows", "events")}
    found["warnings"] = len(summary["warnings"])
    found |= {n: summary["statistics"][n] for n in STATISTICS if n in summary["statistics"]}
    for joint, contact in summary["contacts"].items():
        for name in CONTACT:
            found[f"{joint}.{name}"] = contact[name]
    return found


def _ran(task: dict[str, Any], begun: Callable[[], None]) -> dict[str, Any]:
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import of_case
    from trsim.solve.simulate import simulate
    from trsim.store.hdf5 import Around, write

    target = Path(task["target"])
    scenario = of_case(task["resolved"])
    scenario._text = task["text"]
    scenario._tree.files = dict(task["files"])
    passes = ""
    if scenario.sizing is not None:
        from trsim.solve.sizing import sized

        found = sized(scenario)
        scenario, passes = found.scenario, found.in_words
    if task["keep"] == SUMMARY:
        return _summarised(task, scenario, begun)
    kept = _checkpoint(target, scenario)
    mechanism = assemble(scenario)

    def closing(file: Any) -> dict[str, Any]:
        file["provenance"].attrs[DIGEST] = task["digest"]
        if passes:
            file["provenance"].attrs["sizing"] = passes
        return {}

    blocks = _told(simulate(scenario, mechanism, kept.state if kept else None), begun)
    every = CHECKPOINT if METHODS[scenario.solver.method].marches else 0.0
    around = Around(task["command"], every, kept, closing)
    summary = write(target, scenario, mechanism, blocks, around)
    return summary | {"asked": asked(target, task["numbers"])}


def _summarised(task: dict[str, Any], scenario: Any, begun: Callable[[], None]) -> dict[str, Any]:
    """Run a case of which a record is all that is kept."""
    from trsim.assemble.assemble import assemble
    from trsim.solve.simulate import simulate
    from trsim.store.live import Taking
    from trsim.sweeps.summary import record, sent

    mechanism = assemble(scenario)
    taking = Taking(Path(task["target"]), scenario, mechanism)
    live, summary = taking.all(_told(simulate(scenario, mechanism), begun))
    told = record(live, task["numbers"])
    packed = sent(told)
    numbers = {word: value for word, (value, _) in told["asked"].items()}
    return summary | {"content_sha256": packed["content"], "record": packed["record"],
                      "asked": numbers}  # fmt: skip


def asked(target: Path, words: list[str]) -> dict[str, float | None]:
    """Numbers of a result file by their words; None where it has none."""
    if not words:
        return {}
    from trsim.store.read import read
    from trsim.sweeps.summary import number

    run = read(target)
    return {word: number(run, word)[0] for word in words}


def _told(
    blocks: Generator[Any, None, Any], begun: Callable[[], None]
) -> Generator[Any, None, Any]:
    """The blocks of a run; that the first is there is told."""
    run = Blocks(blocks)
    for k, block in enumerate(run):
        if k == 0:
            begun()
        yield block
    return run.outcome


def _checkpoint(target: Path, scenario: Any) -> Any:
    """Where an earlier, broken off run of the same case goes on; None at the start."""
    from trsim.store.checkpoint import beside, differences, load
    from trsim.store.own import remove
    from trsim.store.target import PART

    path, part = beside(target), target.with_name(target.name + ".part")
    _alone(target)
    kept = None
    if path.is_file() and part.is_file():
        with suppress(FileError):
            kept = load(path)
    if kept and not differences(kept, scenario):
        return kept
    remove(part, PART)
    return None


def _alone(target: Path) -> None:
    """Wait for a process of a sweep that was killed, which may still be ending.

    Raises FileError where it goes on.
    """
    from trsim.store.lock import refuse_if_written

    until = time.monotonic() + PATIENCE
    while True:
        try:
            return refuse_if_written(target)
        except FileError:
            if time.monotonic() > until:
                raise
            time.sleep(0.1)


def task(case: Any, plan: Any, target: Path) -> dict[str, Any]:
    """What `run` needs to know of a case; JSON can hold it."""
    return {
        "name": case.name,
        "resolved": case.data,
        "text": plan.text,
        "files": plan.files,
        "target": str(target),
        "digest": case.digest,
        "command": f"trsim sweep {plan.source}",
        "keep": plan.keep,
        "numbers": list(plan.numbers),
    }
