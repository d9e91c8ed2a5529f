"""The motion as files of ParaView: X.pvd lists the times, X_frames/ has a grid for each of them.

    rigid bodies    their drawn shapes; without one the three axes of the body
    flexible bars   lines from node to node, as they are recorded
    cells           body: its number in the list `bodies`
    points          velocity, where it is recorded; of bars axial_force and bending_moment

Nothing is moved into layers: every point is where it is.  nan stands where there is no value.
"""

import base64
from collections.abc import Iterator
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.arrays import Array
from trsim.report.animation import turns
from trsim.report.animation.bodies import links
from trsim.report.animation.motion import Motion, motion
from trsim.report.animation.things import look
from trsim.store.read import Run
from trsim.store.target import HEADER, Kind, file_errors, fresh

MADE = "<!-- made by trsim -->"
GRID = Kind("grid of trsim", lambda start: MADE.encode() in start[:HEADER])
LINE, TRIANGLE = 3, 5  # kinds of cells: a line of two points, a triangle
AXIS = 3.0  # half widths of a link: length of the axes of a body without a shape
OF_NODES = ("axial_force", "bending_moment")
NAMES = {"Float64": "<f8", "Int64": "<i8", "UInt8": "<u1"}


class Part(NamedTuple):
    """A body over the frames, or (1, .) of what stands still."""

    body: str
    points: Array  # (frames, n, 3) m
    velocity: Array  # (frames, n, 3) m/s
    along: Array  # (frames, n, 2): axial force and bending moment of a bar, N and N*m
    cells: NDArray[np.int64]  # (m, 2) or (m, 3): points of the cells


def write(run: Run, target: Path) -> tuple[int, tuple[str, ...]]:
    """Write the files; how many frames there are, and warnings.

    Raises FileError, and UsageError where the run holds the place of no body.
    """
    moved = motion(run, even=True)  # ParaView plays one frame after the other
    every = list(parts(run, moved))
    folder = target.with_name(f"{target.stem}_frames")
    width, entries = len(str(len(moved.time) - 1)), []
    for k, time in enumerate(moved.time.tolist()):
        path = folder / f"{target.stem}_{k:0{width}}.vtu"
        put(path, grid(every, k), run)
        name = escape(f"{folder.name}/{path.name}", quote=True)
        entries.append(f'<DataSet timestep="{time!r}" part="0" file="{name}"/>\n')
    put(target, document("Collection", "".join(entries)), run)
    return len(moved.time), moved.warnings


def put(path: Path, text: str, run: Run) -> None:
    with file_errors(path), fresh(path, GRID, [run.path]) as unfinished:
        unfinished.write_text(text, encoding="utf-8", newline="\n")


# --- what is shown ---------------------------------------------------------------------------


def parts(run: Run, moved: Motion) -> Iterator[Part]:
    """Every body of which there are places."""
    sizes = replace(look(moved.drawn), pitch=0.0)
    shapes = {thing.name: thing for thing in links(moved, sizes)}
    for body, place in moved.places.items():
        turn = moved.turns[body]
        if body in shapes:
            meshes = [mesh for mesh, _ in shapes[body].pieces]
            own = np.concatenate([mesh.points for mesh in meshes])
            starts = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
            cells = np.concatenate([mesh.triangles + start for mesh, start in
                                    zip(meshes, starts, strict=False)])  # fmt: skip
        else:
            axes = turns.turned(moved.drawn.axes[body], np.eye(3))
            own = np.concatenate([np.zeros((1, 3)), AXIS * sizes.radius * axes])
            cells = np.array([[0, 1], [0, 2], [0, 3]])
        out = turns.turned(turn[:, None, :], own[None])
        points = place[:, None, :] + out
        yield Part(body, points, velocities(run, moved, body, out), nothing(points, 2), cells)
    for bar, nodes in moved.nodes.items():
        count = nodes.shape[1]
        cells = np.stack([np.arange(count - 1), np.arange(1, count)], axis=1)
        names = [f"{bar}.node{k}" for k in range(count)]
        speeds = [recorded(run, f"{name}.velocity", moved, 3) for name in names]
        loads = [[recorded(run, f"{name}.{what}", moved, 1)[:, 0] for what in OF_NODES]
                 for name in names]  # fmt: skip
        yield Part(bar, nodes, np.stack(speeds, axis=1), np.moveaxis(np.array(loads), 2, 0), cells)


def velocities(run: Run, moved: Motion, body: str, out: Array) -> Array:
    """v + omega x r of points at r from the centre of mass, (frames, n, 3); nan if not recorded."""
    v = recorded(run, f"{body}.velocity", moved, 3)[:, None, :]
    omega = recorded(run, f"{body}.angular_velocity", moved, 3)[:, None, :]
    return v + np.cross(np.broadcast_to(omega, out.shape), out)


def recorded(run: Run, channel: str, moved: Motion, size: int) -> Array:
    """The frames of a channel, (frames, size); nan where it was not recorded."""
    if channel not in run.units:
        return np.full((len(moved.rows), size), np.nan)
    return run.channel(channel)[moved.rows].reshape(-1, size)


def nothing(points: Array, size: int) -> Array:
    return np.full((*points.shape[:2], size), np.nan)


# --- as a file -------------------------------------------------------------------------------


def grid(every: list[Part], k: int) -> str:
    """The grid of a frame."""
    points = np.concatenate([at(part.points, k) for part in every])
    starts = np.cumsum([0, *(part.points.shape[1] for part in every)])
    cells = [part.cells + start for part, start in zip(every, starts, strict=False)]
    corners = [one.shape[1] for one in cells for _ in range(len(one))]
    numbers = [number for number, one in enumerate(cells) for _ in range(len(one))]
    kinds = [LINE if corner == 2 else TRIANGLE for corner in corners]
    along = np.concatenate([at(part.along, k) for part in every])
    data = [
        array("velocity", np.concatenate([at(part.velocity, k) for part in every])),
        *(array(name, along[:, n]) for n, name in enumerate(OF_NODES)),
    ]
    where = [
        array("connectivity", np.concatenate([one.ravel() for one in cells]), "Int64"),
        array("offsets", np.cumsum(corners), "Int64"),
        array("types", np.array(kinds), "UInt8"),
    ]
    body = array("body", np.array(numbers), "Int64")
    piece = (
        f"<Points>\n{array('points', points)}</Points>\n<Cells>\n{''.join(where)}</Cells>\n"
        f"<PointData>\n{''.join(data)}</PointData>\n<CellData>\n{body}</CellData>\n"
    )
    head = f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(corners)}">\n'
    names = words("bodies", [part.body for part in every])
    inner = f"<FieldData>\n{names}</FieldData>\n{head}{piece}</Piece>\n"
    return document("UnstructuredGrid", inner)


def at(values: Array, k: int) -> Array:
    """The values at a frame."""
    found: Array = values[min(k, len(values) - 1)]
    return found


def document(kind: str, inner: str) -> str:
    return (
        f'<?xml version="1.0"?>\n{MADE}\n<VTKFile type="{kind}" version="1.0" '
        f'byte_order="LittleEndian" header_type="UInt64">\n<{kind}>\n{inner}</{kind}>\n</VTKFile>\n'
    )


def array(name: str, values: NDArray, kind: str = "Float64") -> str:
    """An array: its length in bytes and its numbers, in base64."""
    numbers = np.ascontiguousarray(values, dtype=NAMES[kind])
    wide = f' NumberOfComponents="{numbers.shape[1]}"' if numbers.ndim == 2 else ""
    data = np.array([numbers.nbytes], "<u8").tobytes() + numbers.tobytes()
    text = base64.b64encode(data).decode("ascii")
    head = f'<DataArray type="{kind}" Name="{name}"{wide} format="binary">'
    return f"{head}{text}</DataArray>\n"


def words(name: str, texts: list[str]) -> str:
    """An array of texts: their bytes, each text ended by a zero."""
    codes = " ".join(str(code) for text in texts for code in [*text.encode(), 0])
    head = f'<Array type="String" Name="{name}" NumberOfTuples="{len(texts)}" format="ascii">'
    return f"{head}{codes}</Array>\n"
