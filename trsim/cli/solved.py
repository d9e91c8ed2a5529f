"""By which method a run was solved, and why that changed, in a line."""

from typing import Any

from trsim.scenario.methods import METHODS


def solved(summary: dict[str, Any]) -> str:
    """The method of a run, with the reason where `auto` changed it, and the CPU time.

    Where all phases are static, nothing was left to another method.
    """
    from trsim.store.read import read

    run = read(summary["file"])
    method = str(run.group("solver")["method"])
    phases = run.scenario.get("phases") or []
    if phases and all(phase.get("static") for phase in phases):
        method = "static_path"
    text = f"solved by {method}"
    if METHODS[method].chooses:
        text += f": {chosen(run, METHODS[method].files)}"
    cpu = summary["statistics"].get("integration_cpu")
    return text if cpu is None else f"{text}; {cpu:.3g} s of CPU"


def chosen(run: Any, files: dict[str, tuple[str, ...]]) -> str:
    """Which of its two methods made the steps, and why."""
    explicit, implicit = next(iter(files.values()))
    events = run.events
    there, back = (events.time[events.kind == kind] for kind in ("to implicit", "to explicit"))
    if not len(there):
        return f"{explicit} all the time, no stiff stretch was met"
    rate = float(events.speed[events.kind == "to implicit"][0])
    span = f"from t = {there[0]:.6g} to {back[0]:.6g} s" if len(back) else (
        f"from t = {there[0]:.6g} s on")  # fmt: skip
    held = f"so that stability, not accuracy, would set the steps of {explicit}"
    why = f"as the motion is stiff there (rates up to {rate:.3g} 1/s), {held}"
    many = len(there) + len(back)
    more = f"; {many} changes of method" if many > 2 else ""
    return f"{explicit}, {span} {implicit}, {why}{more}"
