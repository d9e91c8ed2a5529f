"""The methods of integration: what can be known of each without running it.

Everything that depends on the method of a run asks here; how steps are made is in solve/methods.
"""

from typing import NamedTuple

INDEX_1 = "index1"  # accelerations from Phi'' = 0, then projection
GGL = "ggl"  # the stabilised index 2 of Gear, Gupta and Leimkuhler


class Method(NamedTuple):
    """What the rest of trsim knows of a method.

    order     of its steps, the highest: errors fall with step^order; of one that integrates no
              motion that of the energy book
    files     formulation -> modules of solve/methods, the explicit one first.  Without any an
              integrator of scipy makes the steps (`marches` is False), with a state of its own: no
              checkpoints, no user events, and nobody looks at its trial steps
    adaptive  chooses its steps by the tolerance, and locates touches unless told otherwise;
              else steps are fixed, and touches located only if told
    explicit  begins with explicit steps: no Jacobian, and where it chooses them they are held to
              what the feedback of Baumgarte's stabilisation allows
    twin      the method that a run is certified by: another family, other errors
    driven    only where drives and joints leave nothing free: places are found, not integrated, at
              every output row
    rests     at every place forces balance without inertia: followed along t, not integrated; its
              steps are made by solve/path
    """

    order: int
    files: dict[str, tuple[str, ...]]
    adaptive: bool = True
    explicit: bool = False
    twin: str = "auto"
    driven: bool = False
    rests: bool = False

    @property
    def control(self) -> str:
        """The key of `solver` that decides how exact it is."""
        return "tolerance" if self.adaptive else "step"

    @property
    def marches(self) -> bool:
        """Whether its steps are made here, and not by scipy."""
        return bool(self.files)

    @property
    def chooses(self) -> bool:
        """Whether steps are made by one of two methods, an explicit and an implicit one."""
        return any(len(modules) > 1 for modules in self.files.values())


METHODS = {
    "auto": Method(
        8, {INDEX_1: ("dop853", "radau"), GGL: ("dop853", "radau_ggl")}, explicit=True, twin="radau"
    ),
    "dop853": Method(8, {INDEX_1: ("dop853",)}, explicit=True, twin="radau"),
    "radau": Method(5, {INDEX_1: ("radau",), GGL: ("radau_ggl",)}, twin="dop853"),
    "generalized_alpha": Method(2, {INDEX_1: ("generalized_alpha",)}),
    "rk4": Method(4, {INDEX_1: ("rk4",)}, adaptive=False, explicit=True),
    "kinematic": Method(4, {INDEX_1: ("kinematic",)}, explicit=True, driven=True),
    "static_path": Method(2, {}, rests=True),
    "scipy:BDF": Method(5, {}),
    "scipy:Radau": Method(5, {}),
    "scipy:RK45": Method(5, {}, explicit=True),
}
REFERENCES = ("radau", "dop853")  # what others are measured against; the second beside the first
