"""Formula: an expression of other sensors, and of t.

    s = f(t, sensors)          s' = df/dt from the rates of the sensors, if all of them have one

The expression may use rates of sensors, `x*x.rate`; then the formula has no rate of its own.

It is evaluated as written.  If the value is not a finite number, for example after a division by
zero, the run ends.  A load may use the formula by its name; its corners are then located like those
of any other load.
"""

from typing import ClassVar

from trsim.elements.contract import Channel, Element, Pair, Row, measured
from trsim.elements.shown import on_pendulum
from trsim.errors import ScenarioError
from trsim.fields import Spec
from trsim.kernels.columns import i8, run
from trsim.laws.functions import value, value_and_rate
from trsim.units import unit
from trsim.varying import Function


class Formula(Spec):
    """A sum, a ratio, or any other expression of sensors that are defined before it in the file.

    value  the expression, in SI units
    unit   SI unit of the value, for files and figures
    """

    type: ClassVar[str] = "formula"
    value: Function("-")
    unit: str = "-"


class Own(Pair):
    """Of one instance."""

    function: i8  # in tab
    rates: i8  # 1: it has a rate
    frames: run(i8)  # that its sensors depend on


def pack(name, spec, at):
    if spec.value.kind != "expression":
        what = "a formula is an expression of sensors, such as `x + 2*y`"
        raise ScenarioError(what, "name a sensor in it", ("value",))
    if unit(spec.unit)[0] != 1:
        what = f"'{spec.unit}' is no SI unit, and the expression is in SI units"
        raise ScenarioError(what, "write m, not mm", ("unit",))
    read = sorted(spec.value.sensors)
    rows = [at.read_by_formula(one, ("value",)) for one in read]
    # not `at.function`: what is only looked at changes no step
    offset = at.stored(spec.value.node, spec.value.inputs, ("value",))
    rates = all(row.travel for row in rows) and not {*spec.value.inputs} - {*read}
    frames = sorted({f for one in read for f in at.frames_of_sensor(one)})
    own = Own.packed(
        i=0, j=0, coordinate=at.sensor(name), function=offset, rates=rates, frames=frames
    )
    shown = (Channel("", spec.unit, "value of the expression"),)
    if rates:
        per = "1/s" if spec.unit == "-" else f"({spec.unit})/s" if "/" in spec.unit else None
        shown += (Channel("rate", per or f"{spec.unit}/s", "its rate"),)
    return Row(*own, channels=shown, reads=frozenset(read))


@measured
def measure(t, scene, e, o):
    own, S = Own(scene, e), scene.S
    if own.rates == 1:
        scene.out[o], scene.out[o + 1] = value_and_rate(scene.tab, own.function, t, S)
    else:
        scene.out[o] = value(scene.tab, own.function, t, S)
    S[own.coordinate, 0] = scene.out[o]


def acts_on(row):
    return frozenset(f for f in Own.of(row).frames if f >= 0)


ELEMENT = Element(
    key="formula",
    section="sensors",
    spec=Formula,
    pack=pack,
    acts_on=acts_on,
    channels=(
        Channel("", "-", "value of the expression"),
        Channel("rate", "1/s", "its rate"),
    ),
    stands_for=lambda spec: spec.value.node,
    kernels={"measure": measure},
    example=on_pendulum(
        "turn: {joint: hinge}", 'cosine: {type: formula, value: "cos(turn) + 0.1*turn"}'
    ),
)
