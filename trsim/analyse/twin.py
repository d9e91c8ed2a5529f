"""How the twin of a run is made: by the other family of methods, at a tighter tolerance.

A method that shares neither stages nor order nor implicitness with the run's makes other errors;
what the two share is the mechanism, its forces and the search for events.
"""

from typing import Any

from trsim.analyse.precision import TIGHTEST
from trsim.analyse.trajectory import Look, Setting, changed, marched, unwatched
from trsim.scenario.methods import METHODS

SHARE = 1.0 / 20.0  # of a run: how long a trial is
DECADES = (2, 1)  # how much tighter, by powers of ten, in the order of trial
ROUNDING = 3.0  # times the steps for a tenth of the tolerance; dop853 takes 1.4, radau 1.7 to 2


def twin_setting(scenario: Any, mechanism: Any, look: Look = unwatched) -> Setting:
    """The other method, at a tolerance as much tighter as rounding allows.

    Below some tolerance a method sees nothing but the rounding of its steps: they become many times
    more, or are held to the rounding instead (solve/march/rounding.py), and no better.  Short
    trials find it.  Raises what `simulate` raises.
    """
    method = METHODS[scenario.solver.method].twin
    tolerance = found = scenario.solver.tolerance
    steps, _ = trial(scenario, mechanism, method, tolerance, look)
    for decades in DECADES:
        tighter = max(tolerance / 10.0**decades, TIGHTEST)
        more, rounded = trial(scenario, mechanism, method, tighter, look)
        if not rounded and more <= ROUNDING**decades * steps:
            found = tighter
            break
    return Setting(method, float(f"{found:.6g}"))  # without the last digits of divisions


def trial(
    scenario: Any, mechanism: Any, method: str, tolerance: float, look: Look
) -> tuple[int, bool]:
    """Steps of the beginning of a run, and whether rounding was more than some were allowed."""
    end = SHARE * scenario.solver.end
    short = changed(scenario, "solver", method=method, tolerance=tolerance, step=None, end=end)
    outcome = marched(changed(short, "output", every=end), mechanism, look)[1]
    return int(outcome.statistics["steps"]), "rounding_of_tolerance" in outcome.statistics


def overrides(scenario: Any, setting: Setting) -> tuple[str, ...]:
    """What makes a scenario that of its twin, as for --set; its events are always located."""
    found = [f"solver.method={setting.method}", f"solver.tolerance={setting.tolerance!r}"]
    if scenario.solver.locate_events is False:
        found.append("solver.locate_events=true")
    return tuple(found)
