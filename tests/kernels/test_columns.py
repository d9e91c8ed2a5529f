"""Columns with names: the same places compiled, as Python and packed; in the key of a kernel."""

from dataclasses import dataclass

import numpy as np
import pytest

from trsim.elements.contract import compiled
from trsim.kernels import fingerprint
from trsim.kernels.columns import V3, Columns, constraint_row, f8, i8, memory, run
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A2, I2, Packed
from trsim.kernels.plain import run as plainly
from trsim.kernels.signatures import float64, void
from trsim.kernels.signatures import i8 as whole


class Tables(Packed):
    con: I2
    par: A2
    mem: A2


class Constants(Packed):
    par: A2


class First(Columns):
    body: i8
    tilts: run(constraint_row, 2)
    axis: V3
    phase: memory


class Own(First):
    state: i8
    stiffness: f8
    three: run(f8, 3)
    speed: memory
    masses: run(f8)


class Axis(Columns):
    """Only of par, which a record without the other tables has too."""

    axis: V3


TABLES = void(Tables.kind, whole)


@internal
def length(own):
    return own.axis[0] + 10.0 * own.axis[1] + 100.0 * own.axis[2]


@compiled(TABLES)
def work(s, e):
    own, first = Own(s, e), First(s, e)
    own.speed = length(own) + own.stiffness * own.phase
    total = 0.0
    for k in range(own.masses.size):
        total += own.masses[k]
    first.phase = total + 1000.0 * own.three[2]
    s.con[0, 0] = own.tilts[1] + 10 * first.body + 100 * own.state + 1000 * own.three.size


@compiled(float64(Constants.kind, whole))
def middle(s, e):
    return Axis(s, e).axis[1]


def tables():
    return Tables(
        con=np.arange(12).reshape(3, 4),
        par=np.arange(30.0).reshape(3, 10) + 1.0,
        mem=np.ones((3, 3)),
    )


def test_places():
    assert {name: column.at for name, column in Own.columns.items()} == {
        "body": 0, "tilts": 1, "axis": 0, "phase": 0, "state": 3, "stiffness": 3, "three": 4,
        "speed": 1, "masses": 7,
    }  # fmt: skip
    assert Own.stiffness.at == 3 and First.columns.keys() < Own.columns.keys()


def test_compiled_and_as_python():
    machine, plain = tables(), tables()
    work(machine, 1)
    plainly(work.python, plain, 1)
    assert machine.mem[1].tolist() == [
        1000.0 * 17.0 + 18.0 + 19.0 + 20.0,
        11.0 + 120.0 + 1300.0 + 14.0,
        1.0,
    ]
    assert machine.con[0, 0] == 6 + 10 * 4 + 100 * 7 + 3000
    for name, array in machine.arrays().items():
        np.testing.assert_array_equal(array, plain.arrays()[name])


def test_a_record_without_the_other_tables():
    record = Constants(par=np.arange(6.0).reshape(2, 3))
    assert middle(record, 1) == plainly(middle.python, record, 1) == 4.0


GIVEN = {"body": 3, "axis": (1, 2, 3), "state": -1, "stiffness": 4, "three": (5, 6, 7)}


@dataclass(frozen=True)
class Row:
    con: tuple
    par: tuple


def test_packed():
    row = Row(*Own.packed(**GIVEN, masses=[8, 9]))
    assert row == Row((3, -1, -1, -1), tuple(map(float, range(1, 10))))
    own = Own.of(row)
    assert (own.axis, own.stiffness, own.masses, own.tilts) == ((1, 2, 3), 4, (8, 9), (-1, -1))
    changed = Own.changed(row, stiffness=0.0, state=2)
    assert Own.of(changed).stiffness == 0.0 and Own.of(changed).state == 2
    assert Own.changed(changed, stiffness=4.0, state=-1) == row


@pytest.mark.parametrize(
    "wrong, named",
    [
        ({"axis": (1, 2)}, "axis"),
        ({"three": (1, 2, 3, 4)}, "three"),
        ({"friction": 1}, "friction"),
        ({"phase": 1.0}, "phase"),
        ({"tilts": (1, 2)}, "tilts"),
    ],
)
def test_packed_otherwise(wrong, named):
    with pytest.raises(TypeError, match=rf"Own: fields \['{named}'"):
        Own.packed(**GIVEN, masses=(), **wrong) if named not in GIVEN else Own.packed(
            **GIVEN | {"masses": ()} | wrong
        )
    with pytest.raises(TypeError, match=r"fields \['axis'\]"):
        Own.packed(**{k: v for k, v in GIVEN.items() if k != "axis"}, masses=())


def test_constants_are_not_written():
    own = Own(tables(), 0)
    own.phase = 3.0
    with pytest.raises(AttributeError):
        own.stiffness = 3.0

    @compiled(TABLES)
    def writes(s, e):
        own = Own(s, e)
        own.stiffness = 1.0

    with pytest.raises(Exception, match="cannot be written"):
        writes(tables(), 0)


def test_another_layout_is_another_key():
    def reads(columns):
        def f(s, e):
            return columns(s, e).stiffness

        return fingerprint.of(f, float64(Tables.kind, whole))

    class Same(First):
        state: i8
        stiffness: f8
        three: run(f8, 3)
        speed: memory
        masses: run(f8)

    class Other(First):
        state: i8
        damping: f8
        stiffness: f8

    assert reads(Own) == reads(Same) != reads(Other)
