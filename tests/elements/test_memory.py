"""Memory of elements: as wide as the widest of a scene asks for, each instance in its own row."""

import sys
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

from trsim import elements
from trsim.elements.contract import Channel, Element, Memory, Row, kernel
from trsim.elements.scene import N_MEM, scene
from trsim.fields import Spec
from trsim.kernels.columns import i8, memory

from ..runs import run


class Own(Memory):
    body: i8
    time: memory


class Clock(Spec):
    """Remembers the time of the last row."""

    type: ClassVar[str] = "clock"
    body: str


def pack(name, spec, at):
    return Row(*Own.packed(body=at.body(spec.body)))


@kernel
def measure(t, scene, e):
    own = Own(scene, e)
    own.time = t
    if scene.wanted[e] >= 0:
        scene.out[scene.wanted[e]] = own.time


CLOCK = Element(
    key="clock", section="forces", spec=Clock, pack=pack, n_mem=1,
    channels=(Channel("time", "s", "of the last row"),), kernels={"measure": measure},
)  # fmt: skip
SCENE = """
bodies: {ball: {mass: 1, inertia: 0.1, velocity: [1, 0]}}
forces:
  one: {type: clock, body: ball}
  two: {type: clock, body: ball}
  stop: {type: limit_stop, point: {body: ball, at: [0, 0]},
         wall: {body: ground, at: [0.5, 0], normal: [-1, 0]}, stiffness: 1e5}
solver: {end: 1, tolerance: 1e-9}
"""


def test_an_element_with_a_column_more(monkeypatch):
    monkeypatch.setitem(elements.ELEMENTS, "clock", "forces")
    monkeypatch.setitem(sys.modules, "trsim.elements.clock", SimpleNamespace(ELEMENT=CLOCK))
    found = run(SCENE)
    for name in ("one", "two"):
        assert found[f"{name}.time"] == pytest.approx(found.t, abs=1e-12)
    rows = {instance.name: e for e, instance in enumerate(found.mechanism.instances)}
    work = scene(found.mechanism.model)
    assert work.mem.shape == (len(rows), N_MEM + 1)
    measure(0.7, work, rows["one"], rows["one"] + 1)
    changed = np.argwhere(work.mem)
    assert changed.tolist() == [[rows["one"], N_MEM]]


def test_without_such_an_element_the_table_is_as_wide_as_all_need():
    lines = [line for line in SCENE.splitlines() if "clock" not in line]
    found = run("\n".join(lines))
    assert scene(found.mechanism.model).mem.shape[1] == N_MEM
