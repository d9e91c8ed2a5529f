"""Figure 3: friction and contact laws, drawn from the functions that the solver calls."""

from typing import Any

import numpy as np

from trsim.errors import UsageError
from trsim.report.display import Shown
from trsim.report.style import colour, panels
from trsim.studies.drawing import Drawn
from trsim.studies.numbers import Number

MU, V0, V1 = 0.3, 1e-4, 1e-3  # -, m/s, m/s: of the study
RADIUS, STEEL, RESTITUTION = 0.010, (207e9, 0.29), 0.9  # m; Pa, -: of the study
CLEARANCES = (0.1e-3, 0.3e-3, 0.5e-3)  # m
SPEEDS = (0.1, 0.3)  # m/s, of the impacts drawn
MASS = 1.25  # kg: of the door at its hinge, ours
NEAR = 1e-12  # m/s, beside rest


def number(text: str) -> Number:
    """A number of a law: restitution:GIVEN, over what is given, or jump:LAW at rest, over F_n."""
    from trsim.laws.contact import damping_factor, delivered_restitution
    from trsim.laws.friction import coulomb, modified_coulomb

    kind, _, of = text.partition(":")
    if kind == "restitution":
        chi = damping_factor("lankarani_nikravesh", float(of))
        return Number(delivered_restitution(chi) / float(of), "-")
    if kind == "jump":
        law = {"coulomb": lambda v: coulomb(1.0, v, MU),
               "modified_coulomb": lambda v: modified_coulomb(1.0, v, MU, V0, V1)}[of]  # fmt: skip
        return Number(abs(law(NEAR) - law(-NEAR)), "-")
    raise UsageError(f"no such number of a law: '{text}'")


def figure_3(_: list[Shown]) -> Any:
    """Both friction laws over sliding speed; the contact law over penetration."""
    from trsim.laws.friction import coulomb, modified_coulomb

    figure, axes = panels(2, 2, height=2.5)
    speed = np.linspace(-2.0 * V1, 2.0 * V1, 801)
    left, right = axes[0]
    for side in (-1.0, 1.0):
        half = speed[speed * side > 0.0]
        left.plot(1e3 * half, [coulomb(1.0, v, MU) for v in half], color=colour(0), lw=1.2)
    left.plot([0.0], [0.0], "o", ms=3, color=colour(0))
    right.plot(1e3 * speed, [modified_coulomb(1.0, v, MU, V0, V1) for v in speed],
               color=colour(0), lw=1.2)  # fmt: skip
    for edge, name in ((V0, "v0"), (V1, "v1")):
        right.axvline(1e3 * edge, color="0.6", ls=":", lw=0.8)
        right.annotate(name, (1e3 * edge, 0.33), ha="left", xytext=(2, 0), color="0.4",
                       textcoords="offset points", fontsize=8)  # fmt: skip
    for a, text in ((left, "(a) Coulomb"), (right, "(b) modified Coulomb")):
        a.set_title(text, loc="left")
        a.set_xlabel("sliding speed (mm/s)")
        a.set_ylim(-0.4, 0.4)
    left.set_ylabel("friction force / normal force (-)")
    stiffnesses(axes[1, 0])
    loops(axes[1, 1])
    return figure


def stiffnesses(axes: Any) -> None:
    """The elastic force for both readings of the radii."""
    from trsim.laws.contact import Pair, elastic, hertz_stiffness

    depth = np.linspace(0.0, 25e-6, 200)
    for k, c in enumerate(CLEARANCES):
        for form, dash in (("internal", "-"), ("paper", "--")):
            K = hertz_stiffness(RADIUS, RADIUS - c, STEEL, STEEL, form)
            force = [1e-3 * elastic(d, Pair(K, 1.5, c, 0)) for d in depth]
            label = f"{1e3 * c:g} mm" if form == "internal" else None
            axes.plot(1e6 * depth, force, dash, color=colour(k), label=label, lw=1.2)
    axes.plot([], [], "--", color="0.4", label="Rᵢ + Rⱼ")
    axes.set_ylim(0.0, 6.0)
    axes.set_xlabel("penetration (\u00b5m)")
    axes.set_ylabel("normal force (kN)")
    axes.set_title("(c) elastic part, by clearance", loc="left")
    axes.legend(loc="center right")


def loops(axes: Any) -> None:
    """Force over penetration in free impacts, 0.3 mm."""
    from trsim.laws.contact import Pair, damping_factor, hertz_stiffness, normal_force

    c = CLEARANCES[1]
    K = hertz_stiffness(RADIUS, RADIUS - c, STEEL, STEEL, "internal")
    pair = Pair(K, 1.5, c, 0, damping_factor("lankarani_nikravesh", RESTITUTION))
    for k, start in enumerate(SPEEDS):
        d, v, h = 0.0, start, 2e-8  # semi-implicit steps of a fraction of the contact time
        path = [(0.0, 0.0)]
        while d >= 0.0:
            force = normal_force(d, v, start, pair)
            v -= h * force / MASS
            d += h * v
            path.append((1e6 * d, 1e-3 * force))
        x, y = np.array(path).T
        axes.plot(x, y, color=colour(k), lw=1.2, label=f"{start:g} m/s")
    axes.set_xlabel("penetration (\u00b5m)")
    axes.set_ylabel("normal force (kN)")
    axes.set_title(f"(d) impacts of {MASS:g} kg, restitution {RESTITUTION:g}", loc="left")
    axes.legend(loc="upper left")


FIGURES = (
    Drawn("3", "ab", "Friction laws, as the solver evaluates them; contact laws beside them.", (),
          figure_3),
)  # fmt: skip
