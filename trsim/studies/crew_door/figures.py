"""The figures of the study of the crew door, by the numbers they have there."""

from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from trsim.report.display import Shown
from trsim.report.style import colour, panels, thinned
from trsim.scenario.methods import METHODS
from trsim.studies.claim import Cases
from trsim.studies.crew_door import side_view
from trsim.studies.drawing import Drawn, alike, lettered, with_legend

LATCH, HINGE = "latch_angle", "opening"
X_LABELS = {LATCH: "latch shaft (deg)", HINGE: "hinge (deg)"}
LEVER = {"inner": 0.30, "outer": 0.25, "jettison": 0.25}  # m, of the handles
RELEASED = 113.0  # deg of the hinge, where it lets go in jettison
FEET = (("fwd", "-200mm"), ("mid", "0mm"), ("aft", "200mm"))
STAIRS = range(1, 7)
BOTH = (("motion", ""), ("static path", "path"))


class Curve(NamedTuple):
    """A channel in a panel."""

    channel: str
    label: str
    factor: float = 1.0  # of its SI value


class Panel(NamedTuple):
    """Curves over one place: all runs, or `of` them by their labels."""

    title: str
    quantity: str  # with its unit
    curves: tuple[Curve, ...]


def over(shown: list[Shown], x: str, of: Sequence[Panel], most: float = np.inf) -> Any:
    """A panel below the other, each with its curves of all runs over a place, up to `most` of it.

    A run keeps its colour; of several curves of one run each has a dash of its own.  A static path
    beside a motion is a thin black line over it.
    """
    still = [METHODS[one.run.group("solver")["method"]].rests for one in shown]
    figure, axes = panels(len(of), 1, height=2.3, width=6.8)
    for a, panel, letter in zip(axes[:, 0], of, "abcdef", strict=False):
        for k, one in enumerate(shown):
            place, path = one.values(x), still[k] and not all(still)
            kept = place <= most
            style = {"color": "black", "lw": 0.6} if path else {"color": colour(k), "lw": 1.3}
            for dash, curve in zip(("-", "--", ":"), panel.curves, strict=False):
                if not one.has(curve.channel):
                    continue
                y = curve.factor * one.run.channel(curve.channel)[kept]
                label = ", ".join(text for text in (one.label, curve.label) if text)
                a.plot(*thinned(place[kept], y), dash, label=label, **style)
        a.set_ylabel(panel.quantity)
        a.margins(x=0.01)
        lettered(a, letter if len(of) > 1 else "", panel.title)
        a.legend(loc="best", fontsize=7)
    axes[-1, 0].set_xlabel(X_LABELS[x])
    alike([[a] for a in axes[:, 0]], x=True)
    figure.align_ylabels()
    return figure


def handle_load(hand: str) -> Panel:
    """The load at a handle, from the torque of its drive."""
    lever = LEVER[hand]
    return Panel(f"load at the {hand} handle", f"force (N), torque over {lever:g} m",
                 (Curve("handle.force", "", 1.0 / lever),))  # fmt: skip


CONTACTS = (
    Panel("Stop1", "force (N)", (Curve("fwd_stop1.normal_force", "fwd"),
                                 Curve("aft_stop1.normal_force", "aft"))),
    Panel("upper guide", "force (N)", (Curve("fwd_guide.normal_force", "fwd"),
                                       Curve("aft_guide.normal_force", "aft"))),
)  # fmt: skip
HINGES = Panel("hinges", "force (N)", (Curve("hinge.locating_load", "fwd"),
                                       Curve("hinge.floating_load", "aft")))  # fmt: skip


def rod(channel: str, title: str) -> Panel:
    return Panel(title, "force (N)", (Curve(channel, ""),))


def bars(shown: list[Shown], of: Sequence[tuple[str, str]], groups: Sequence[str]) -> Any:
    """A panel for each number; bars of the last row, grouped by the labels before a comma.

    of: (channel, title).  groups: what stands below the bars, in their order.
    """
    figure, axes = panels(len(of), 1, height=2.0, width=6.8)
    kinds = list(dict.fromkeys(one.label.partition(",")[0] for one in shown))
    wide = 0.8 / len(kinds)
    for a, (channel, title), letter in zip(axes[:, 0], of, "abcdef", strict=False):
        for k, kind in enumerate(kinds):
            mine = [one for one in shown if one.label.partition(",")[0] == kind]
            at = [groups.index(one.label.partition(",")[2].strip() or kind) for one in mine]
            heights = [float(one.run.channel(channel)[-1]) for one in mine]
            a.bar(
                np.array(at) + (k - 0.5 * (len(kinds) - 1)) * wide * (len(groups) > len(kinds)),
                heights,
                wide if len(groups) > len(kinds) else 0.6,
                color=colour(k),
                label=kind,
            )
        a.set_xticks(range(len(groups)), groups)
        a.set_ylabel("force (N)")
        lettered(a, letter if len(of) > 1 else "", title)
    if len(groups) > len(kinds):
        with_legend(figure, axes[0, 0], [Shown(shown[0].run, kind, {}) for kind in kinds])
    figure.align_ylabels()
    return figure


RUNNING: Cases = tuple((f"{place}, {stair}", f"running,foot={foot},stair={stair}")
                       for place, foot in FEET for stair in STAIRS)  # fmt: skip
CUT = ("cb_cut.reaction_moment", "counterbalance handle on its arm")
OTHERS: Cases = (
    ("own weight", "opened"), ("three men", "three_men"), ("wind", "wind_60kt"),
    ("arm, aft", "side_arm_aft"), ("arm, fwd", "side_arm_fwd"),
    ("handle, aft", "side_handle_aft"), ("handle, fwd", "side_handle_fwd"),
)  # fmt: skip
LOADS = (("hinge.locating_load", "hinge fwd"), ("hinge.floating_load", "hinge aft"),
         ("cb_rod_force", "rod of the counterbalance"), ("wire.force", "wire"))  # fmt: skip


def bars_of_others(shown: list[Shown]) -> Any:
    """Bars of single cases, each with a label of its own."""
    figure, axes = panels(3, 2, height=2.2, width=6.8)
    of = (*LOADS, CUT)
    for a, (channel, title), letter in zip(axes.flat, of, "abcde", strict=False):
        heights = [float(np.linalg.norm(one.run.channel(channel)[-1])) for one in shown]
        a.barh(range(len(shown)), heights, color=colour(0))
        a.set_yticks(range(len(shown)), [one.label for one in shown])
        a.invert_yaxis()
        a.set_xlabel("moment (N m)" if channel == CUT[0] else "force (N)")
        lettered(a, letter, title)
    axes[-1, -1].axis("off")
    return figure


LIFT_INNER = (("motion", "lift_inner"), ("static path", "path_inner"))
LIFT_GAP = (("motion, gap 1.3 mm", "lift_inner_gap"), ("static path, gap 1.3 mm", "path_inner_gap"))
PRESSED = (("motion", "lift_inner_op"), ("static path", "path_inner_op"))
WIND = (("none", "open"), ("opening wind", "open_opening_wind"),
        ("closing wind", "open_closing_wind"))  # fmt: skip
FAST = tuple((label, case.replace("open", "open_fast", 1)) for label, case in WIND)
OPEN_CLOSE = (("opening", "{}_open"), ("closing", "{}_close"))


def jammed(name: str, more: Cases = ()) -> Cases:
    return (*((label, case.format(name)) for label, case in OPEN_CLOSE), *more)


WEIGHTLESS = (("opening, without weight", "jam_outer_inner_open_weightless"),
              ("closing, without weight", "jam_outer_inner_close_weightless"))  # fmt: skip
RATES = (
    Panel("rate of the hinge", "rate (deg/s)", (Curve("opening.rate", "", 180.0 / np.pi),)),
    Panel("its acceleration", "acceleration (rad/s²)", (Curve("opening.acceleration", ""),)),
)
INERTIAS = (
    ("30 kg m²", "jettison"),
    ("45 kg m²", "jettison_heavy"),
    ("20 kg m²", "jettison_light"),
)
SECTION = Panel("latch shaft at a bolt hole", "bending moment (N m)",
                (Curve("latch_section.bending", ""),))  # fmt: skip
LET_GO = (("driven", "lift_inner"), ("let go at the change of sign", "let_go"),
          ("let go at 80 deg", "let_go_late"))  # fmt: skip
GUIDE_FORWARD = Panel("upper guide, forward", "force (N)", (Curve("fwd_guide.normal_force", ""),))
COUNTER = (rod("cb_rod_force", "rod of the counterbalance"),)


def latch(number: str, caption: str, cases: Cases, *of: Panel) -> Drawn:
    return Drawn(number, "abcdef"[: len(of)], caption, cases, partial(over, x=LATCH, of=of))


def hinge(number: str, caption: str, cases: Cases, *of: Panel) -> Drawn:
    drawn = partial(over, x=HINGE, of=of, most=RELEASED)
    return Drawn(number, "abcdef"[: len(of)], caption, cases, drawn)


def lifted(case: str) -> Cases:
    return (("no overpressure", case), ("2500 N", f"{case}_op"))


FIGURES: tuple[Drawn, ...] = (
    side_view.FIGURE,
    latch("23", "Load at the inner handle over the latch, without overpressure.", LIFT_INNER,
          handle_load("inner")),
    latch("24", "The same with a gap of 1.3 mm at Stop1, and the forces at Stop1 and guide.",
          (*LIFT_INNER[:1], *LIFT_GAP), handle_load("inner"), *CONTACTS),
    latch("27", "Forces at Stop1 and upper guide, without overpressure.", LIFT_INNER, *CONTACTS),
    latch("28", "Load at the inner handle, with overpressure.", PRESSED, handle_load("inner")),
    latch("29", "Forces at Stop1 and upper guide, with overpressure.", PRESSED, *CONTACTS),
    latch("30", "The handle is let go.", LET_GO, handle_load("inner"), GUIDE_FORWARD),
    latch("31", "Gearbox jammed, 1334 N at the outer handle.", jammed("jam_gearbox_outer"),
          rod("P7P10", "rod P7P10")),
    latch("32", "Outer handle jammed, 1334 N at the inner handle.",
          jammed("jam_outer_inner", WEIGHTLESS), rod("P2P6", "rod P2P6")),
    hinge("33", "Forces at the hinges in opening, 4.8 s.", WIND, HINGES),
    hinge("34", "Force in the rod of the counterbalance in opening, 4.8 s.", WIND, *COUNTER),
    Drawn("35", "ab", "One man running: hinges.", RUNNING,
          partial(bars, of=LOADS[:2], groups=[str(n) for n in STAIRS])),
    Drawn("36", "", "One man running: rod of the counterbalance.", RUNNING,
          partial(bars, of=LOADS[2:3], groups=[str(n) for n in STAIRS])),
    Drawn("37", "", "One man running: wire.", RUNNING,
          partial(bars, of=LOADS[3:], groups=[str(n) for n in STAIRS])),
    hinge("38", "Jettison: the motion, with three inertias of the door.", INERTIAS, *RATES),
    hinge("39", "Jettison: forces at the hinges.", INERTIAS, HINGES),
    latch("41", "Load at the outer handle.", lifted("lift_outer"), handle_load("outer")),
    latch("43", "Lifting with the outer handle: Stop1 and upper guide.", lifted("lift_outer"),
          *CONTACTS),
    latch("45", "Load at the jettison handle, in flight.", lifted("lift_jettison"),
          handle_load("jettison")),
    latch("47", "Lifting with the jettison handle: Stop1 and upper guide.",
          lifted("lift_jettison"), *CONTACTS),
    latch("49", "Gearbox jammed, 1334 N at the inner handle.", jammed("jam_gearbox_inner"),
          rod("P7P10", "rod P7P10"), rod("P2P6", "rod P2P6")),
    latch("50", "Gearbox jammed, 1334 N at the outer handle: P2P6.", jammed("jam_gearbox_outer"),
          rod("P2P6", "rod P2P6")),
    hinge("51", "Forces at the hinges in opening, 2.5 s.", FAST, HINGES),
    hinge("54", "Force in the rod of the counterbalance, 2.5 s.", FAST, *COUNTER),
    Drawn("55", "abcde", "The opened door in other load cases.", OTHERS, bars_of_others),
    latch("of the latch shaft", "Bending moment of the latch shaft at a bolt hole, in axes that "
          "turn with it.", (("no overpressure", "lift_inner"), ("2500 N", "lift_inner_op"),
                            ("gearbox jammed", "jam_gearbox_inner_open")), SECTION),
)  # fmt: skip
