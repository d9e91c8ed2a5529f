"""A run of a scenario with `sizing`: the load is found first, by passes that are told."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from trsim.api.compiling import compiling
from trsim.api.hearing import Listener
from trsim.api.running import Wanted, placed
from trsim.api.stop import look
from trsim.errors import FileError, TrsimError, UsageError

Closing = Callable[[Any], dict[str, Any]]


def found(
    hears: Listener, source: str, target: Path, scenario: Any, wanted: Wanted
) -> tuple[Any, list[float], Closing]:
    """The scenario with the load as found, what each pass left, and what stores that in the file.

    The load is also written as a table beside the result, NAME.sizing.csv.
    """
    if wanted.certify:
        hint = "Certify the run of its result file: `trsim run NAME.h5 --certify`."
        raise UsageError("a run that sizes a load is many runs", hint)
    compiling(hears, scenario.solver.method)
    from trsim.solve.sizing import sized

    def passed(count: int, left: float) -> None:
        look()
        of = f"of the force of '{scenario.sizing.drive}'"
        hears.say(f"{source}: pass {count}: {left:.3g} {of} is left")

    try:
        result = sized(scenario, passed)
    except TrsimError as error:
        raise placed(error, scenario) from None
    path = target.with_name(f"{target.name.removesuffix('.h5')}.sizing.csv")
    write(path, scenario, result)
    hears.say(f"{source}: the load is in {path}")

    def closing(file: Any) -> dict[str, Any]:
        file["provenance"].attrs["sizing"] = result.in_words
        return {}

    return result.scenario, result.relative, closing


def write(path: Path, scenario: Any, result: Any) -> None:
    """The load as a table of two columns."""
    wanted = scenario.sizing
    lines = [f"# {wanted.load}: what is left of '{wanted.drive}' in each pass: "
             + result.in_words]  # fmt: skip
    lines += [f"{x!r}, {F!r}" for x, F in zip(result.x.tolist(), result.load.tolist(), strict=True)]
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}", "", file=str(path)) from None
