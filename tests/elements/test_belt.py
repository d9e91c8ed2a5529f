"""Belt: rims that go equally fast, which way pulleys turn, on carriers, and what is refused."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run

R1, R2, I1, I2 = 0.05, 0.12, 0.002, 0.01


def pulleys(belt="", axes=("[0, 0, 1]", "[0, 0, 1]"), bodies="[ground, fan]", more=""):
    """A motor of constant torque and a fan; spatial where the axes are."""
    return f"""
bodies:
  motor: {{mass: 1, inertia: [0.01, 0.01, {I1}], at: [0, 0], angle: 0.4}}
  fan: {{mass: 2, inertia: [0.02, 0.02, {I2}], at: [0.4, 0.1], angle: -1}}
joints:
  shaft: {{type: revolute, bodies: [ground, motor], at: [0, 0], axis: {axes[0]}}}
  axle: {{type: revolute, bodies: {bodies}, at: [0.4, 0.1], axis: {axes[1]}}}
  line: {{type: belt, joints: [shaft, axle], radii: [{R1}, {R2}]{belt}}}
sensors: {{a: {{joint: shaft}}, b: {{joint: axle}}}}
forces: {{push: {{type: applied_load, body: motor, frame: world, direction: [0, 0, 1], torque: 3}}}}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01, channels: ["*"]}}
{more}
"""


CASES = {
    "open": (pulleys(), 1, 1),
    "crossed": (pulleys(", crossed: true"), -1, -1),
    "an axis the other way": (pulleys(axes=("[0, 0, 1]", "[0, 0, -1]")), -1, 1),
    "carrier second": (pulleys(bodies="[fan, ground]"), -1, 1),
}


@pytest.mark.parametrize("case", CASES)
def test_the_rims_go_equally_fast(case):
    """I_1 w' = M - r_1 F,  I_2 w r_1/r_2 = r_2 F:  over many turns."""
    text, sign, way = CASES[case]
    r = run(text)
    i = R1 / R2
    rate = 3 / (I1 + i * i * I2)
    assert r["a"][-1] > 100 * 2 * np.pi
    assert r["a"] == pytest.approx(rate * r.t**2 / 2, rel=1e-9, abs=1e-9)
    assert r["b"] == pytest.approx(sign * i * r["a"], rel=1e-9, abs=1e-9)
    spin = r["fan.angular_velocity"][:, 2]
    assert spin == pytest.approx(way * i * rate * r.t, rel=1e-9, abs=1e-9)
    assert r["line.torque_1"] == pytest.approx(-i * i * I2 * rate, rel=1e-9)
    assert energy_error(r) < 1e-9


REFUSED = {
    "not parallel": (
        pulleys(axes=("[0, 0, 1]", "[0, 1, 0]"), more="planar: false"), "not parallel",
    ),
    "inside each other": (pulleys().replace("0.4, 0.1", "0.04, 0.01"), "an open belt"),
    "crossed and near": (
        pulleys(", crossed: true").replace("0.4, 0.1", "0.1, 0.1"), "a crossed belt",
    ),
    "no radius": (pulleys().replace(f"{R2}]", "0]"), "must be > 0"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refused(what):
    text, said = REFUSED[what]
    with pytest.raises(TrsimError, match=said):
        built(text)
