"""Names for the columns of tables: what an instance holds in its row of con, of par and of mem.

    class Own(Columns):
        body: i8              con: a number that says where
        tilt: constraint_row  con: the index of a constraint row, -1 unless it is in force
        stiffness: f8         par: a number
        axis: V3              par: three numbers, read as a tuple
        masses: run(f8)       par: all that follow, read as an array; run(f8, 6): six of them
        phase: memory         mem: a number that may be written

Fields stand in their table in the order they are written in, those of the base class first.
`class Other(Columns, par="table")` names columns of another table of the record.

    own = Own(scene, e)                  compiled or not: own.axis, own.masses[k], own.phase = 1.0
    Own.packed(spec, body=3, axis=a)     con and par of a row: of every field its number, or that
                                         of `spec` under the same name; constraint rows are not
                                         given, only assembly knows them
    Own.of(row).axis                     the same of a packed row
    Own.columns["stiffness"].at          the column

To compiled code `own.axis` is three loads; what it must know is in compiler.py.
"""

from __future__ import annotations

from dataclasses import replace
from inspect import get_annotations
from typing import TYPE_CHECKING, Any, NamedTuple

from trsim.kernels.signatures import KINDS

__all__ = ["V3", "Column", "Columns", "Layout", "constraint_row", "f8", "i8", "memory", "run"]

NUMBER, TUPLE, ARRAY = "number", "tuple", "array"


class Column(NamedTuple):
    """Where a field stands, and how it is read."""

    table: str  # of a record: con, par, mem
    number: int = 1  # of columns; 0: all that follow
    form: str = NUMBER
    packed: bool = True  # told by whoever packs the row
    at: int = 0  # the first of its columns

    def __get__(self, own: Any, _: Any = None) -> Any:
        if own is None:
            return self
        row = own._row[self.table]
        if self.form == NUMBER:
            return row[self.at]
        part = row[self.at : self.at + self.number] if self.number else row[self.at :]
        return tuple(part) if self.form == TUPLE else part

    def __set__(self, own: Any, value: float) -> None:
        if self.table != "mem":
            raise AttributeError("constants of an instance cannot be written")
        own._row[self.table][self.at] = value


if TYPE_CHECKING:  # what the annotations mean to Python
    f8 = float
    i8 = int
    V3 = tuple[float, float, float]
    constraint_row = int
    memory = float
else:
    from trsim.kernels.signatures import f8, i8

    V3 = Column("par", 3, TUPLE)
    constraint_row = Column("con", packed=False)
    memory = Column("mem", packed=False)
OF_KINDS: dict[Any, Any] = {KINDS["f8"]: Column("par"), KINDS["i8"]: Column("con")}


def run(kind: Any, number: int = 0) -> Any:
    """Some columns, or all that follow, read as an array."""
    return OF_KINDS.get(kind, kind)._replace(number=number, form=ARRAY)


class Numbers(NamedTuple):
    """A packed row."""

    con: tuple[int, ...]
    par: tuple[float, ...]


class Layout(type):
    """What a class of columns is: its fields have their places."""

    columns: dict[str, Column]
    told: set[str]  # those that whoever packs the row gives
    tables: list[str]  # where its columns are

    def __new__(cls, name: str, bases: tuple[type, ...], space: dict[str, Any], **_: str) -> Any:
        return super().__new__(cls, name, bases, space)

    def __init__(cls, name: str, bases: Any, space: Any, **tables: str) -> None:
        super().__init__(name, bases, space)
        cls.columns = dict(getattr(cls, "columns", {}))
        for field, kind in get_annotations(cls).items():
            column: Any = OF_KINDS.get(kind, kind)
            table = tables.get(column.table, column.table)
            there = (c.number for c in cls.columns.values() if c.table == table)
            cls.columns[field] = column._replace(table=table, at=sum(there))
            setattr(cls, field, cls.columns[field])
        cls.told = {name for name, column in cls.columns.items() if column.packed}
        cls.tables = list(dict.fromkeys(column.table for column in cls.columns.values()))


class Columns(metaclass=Layout):
    """The columns of one instance; subclasses annotate their fields."""

    def __init__(self, record: Any, e: int) -> None:
        """record: what has the tables; e: the row."""
        tables = [table for table in type(self).tables if hasattr(record, table)]
        self._row: dict[str, Any] = {table: getattr(record, table)[e] for table in tables}

    @classmethod
    def of(cls, row: Any) -> Any:
        """The columns of a packed row."""
        own = cls.__new__(cls)
        own._row = {"con": row.con, "par": row.par}
        return own

    @classmethod
    def packed(cls, like: Any = None, /, **values: Any) -> Numbers:
        """con and par of a row."""
        found = cls.numbers(like, **values)
        con, par = found.get("con", ()), found.get("par", ())
        return Numbers(tuple(map(int, con)), tuple(map(float, par)))

    @classmethod
    def numbers(cls, like: Any = None, /, **values: Any) -> dict[str, list[Any]]:
        """A row of each table."""
        if like is not None:
            named = {name: getattr(like, name, None) for name in cls.told - values.keys()}
            values |= {name: value for name, value in named.items() if value is not None}
        wrong: set[str] = cls.told ^ values.keys()
        found: dict[str, list[Any]] = {table: [] for table in cls.tables}
        for name, (table, number, form, packed, first) in cls.columns.items() if not wrong else ():
            row = found[table]
            if form == NUMBER and packed:
                row.append(values[name])
            else:
                row += values[name] if packed else (-1,) * number
            if number and len(row) != first + number:
                wrong.add(name)
        if wrong:
            raise TypeError(f"{cls.__qualname__}: fields {sorted(wrong)} are missing or wrong")
        return found

    @classmethod
    def changed(cls, row: Any, **values: float) -> Any:
        """A packed row, a dataclass, with other numbers in some of its columns."""
        tables = {"con": list(row.con), "par": list(row.par)}
        for name, value in values.items():
            column = cls.columns[name]
            tables[column.table][column.at] = value
        return replace(row, con=tuple(tables["con"]), par=tuple(tables["par"]))
