"""What is made in calls of HDF5 is what h5py makes, and what was told of it is what is read."""

import h5py
import numpy as np
import pytest
from h5py import h5a

from tests import small
from trsim.store.content import content_hash, told_hash
from trsim.store.made import Book, Layout
from trsim.store.read import verify

ALL = (
    small.SLIDER_CRANK
    + "events: {m: {when: stroke, crosses: down, value: -1 mm, do: {record: true}}}\n"
    + "phase_portraits: {p: {x: crank.position.y, y: stroke}, q: {x: stroke, y: stroke.rate}}\n"
)
VALUES = ["µm", "", 3, 2.5, True, np.float64(np.nan), np.int64(-1), ["a", "µ"], [1.5, 2.5]]


@pytest.fixture
def files(tmp_path):
    """Two empty files."""
    with h5py.File(tmp_path / "a.h5", "w") as one, h5py.File(tmp_path / "b.h5", "w") as other:
        yield one, other


def attributes(item):
    """Type, shape and value of each attribute; of references the names they lead to."""
    found = {}
    for name, value in item.attrs.items():
        opened = h5a.open(item.id, name.encode())
        found[name] = (opened.get_type().encode(), opened.shape, str(named(item.file, value)))
    return found


def named(file, value):
    """A value with the names of objects in place of references to them."""
    if isinstance(value, h5py.Reference):
        return file[value].name
    if isinstance(value, list | tuple | np.ndarray | np.void):
        return [named(file, part) for part in value]
    return value


def test_attributes_are_those_of_h5py(files):
    mine, other = files
    book = Book(mine)
    for k, value in enumerate(VALUES):
        book.attribute("", f"a{k}", value)
        other.attrs[f"a{k}"] = value
    book.attribute("", "a0", "again")
    other.attrs["a0"] = "again"
    assert attributes(mine) == attributes(other)
    assert told_hash(book) == content_hash(mine) == content_hash(other)


def test_datasets_are_those_of_h5py(files):
    mine, other = files
    book, text = Book(mine), h5py.string_dtype()
    given = {"word": ("µm", text), "words": (["a", "µ", ""], text), "none": ([], text),
             "numbers": ([1.0, np.inf], "f8"), "counts": ([3, -1], "i8"), "told": ([True], "?"),
             "empty": ([], "f8"), "µ": ([1.0], "f8")}  # fmt: skip
    for name, (value, dtype) in given.items():
        book.values(name, value, dtype)
        other.create_dataset(name, data=np.array(value, dtype))
    book.link("again", "numbers")
    other["again"] = other["numbers"]
    for name in other:
        assert mine[name].id.get_type().equal(other[name].id.get_type()), name
        assert (mine[name].shape, mine[name].maxshape) == (other[name].shape, other[name].maxshape)
        assert str(mine[name][()]) == str(other[name][()])
    assert told_hash(book) == content_hash(mine) == content_hash(other)


def test_scales_are_attached_as_hdf5_does(files):
    """Also where one is attached to more, later."""
    mine, other = files
    book, names = Book(mine), ("a", "b", "c", "d")
    for name in ("time", "axis"):
        book.values(name, [1.0, 2.0, 3.0], "f8")
        other[name] = [1.0, 2.0, 3.0]
        book.scale(name, name)
        other[name].make_scale(name)
    for name in names:
        book.values(name, np.ones((3, 3)), "f8")
        other[name] = np.ones((3, 3))
        other[name].dims[0].attach_scale(other["time"])
    for name in ("b", "c"):
        other[name].dims[1].attach_scale(other["axis"])
    book.attach([("a", ("time", "")), ("b", ("time", "axis"))])
    book.attach([("c", ("time", "axis")), ("d", ("time", ""))])
    for name in ("time", "axis", "b", "c"):
        assert attributes(mine[name]) == attributes(other[name]), name
    assert mine["a"].dims[0].keys() == ["time"] and not mine["a"].dims[1].keys()
    mine["b"].dims[0].detach_scale(mine["time"])  # HDF5 finds what it is to take away
    assert [mine[of].name for of, _ in mine["time"].attrs["REFERENCE_LIST"]] == ["/a", "/d", "/c"]


def test_what_was_told_is_what_is_read(tmp_path):
    small.run(tmp_path / "run.h5", "output.channels=[O, stroke]", text=ALL)
    assert verify(tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5") as file:
        assert {*file["phase"]} == {"p", "q"} and len(file["recorded/time"]) > 0


def test_what_makes_other_files_has_another_digest():
    others = [0, 0.0, False, -0.0, "0", "", [0], [0.0], ["0"], ["0", ""], np.float32(0.0)]
    told = [("attribute", "", "x", value) for value in others]
    told += [
        ("values", "x", [0.0], "f8"),
        ("values", "x", [[0.0]], "f8"),
        ("values", "x", [0], int),
    ]
    told += [("group", "x"), ("group", "y"), ("link", "x", "y"), ("scale", "x", "y")]
    told += [("dataset", "x", "f8", Layout((0,), (n,), fill)) for n in (1, 2) for fill in (0, 1)]
    told += [("attach", [("x", scales)]) for scales in (("y",), ("z",), ("", "y"))]
    found = set()
    for name, *given in told:
        book = Book()
        getattr(book, name)(*given)
        found.add(book.digest())
    assert len(found) == len(told)
