"""glTF 2.0 in one binary file (.glb): a node for every thing, with its meshes and its motion."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.report.animation.drawing import Array
from trsim.report.animation.solids import Mesh
from trsim.report.animation.things import Thing

FLOAT, WORD, LONG = 5126, 5123, 5125  # component types
VERTICES, INDICES = 34962, 34963  # what a buffer view is for
KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
RESTS = 1e-9  # of the size: what moves by less does not; a turn in parts of its quaternion
METALLIC, ROUGH = 0.1, 0.6


class Store:
    """Arrays one after the other, the binary part, and meshes; what is the same is stored once."""

    def __init__(self, gltf: Any) -> None:
        self.gltf, self.size = gltf, 0
        self.chunks: list[bytes] = []
        self.known: dict[tuple[bytes, tuple[int, ...]], int] = {}
        self.meshes: dict[tuple[tuple[int, str], ...], int] = {}
        self.materials: dict[str, int] = {}

    def add(self, values: NDArray[Any], target: int | None = None, bounds: bool = False) -> int:
        """The number of the accessor of an array (n) or (n, m)."""
        from pygltflib import Accessor, BufferView

        values = np.ascontiguousarray(values)
        data = values.tobytes()
        key = (data, values.shape)
        if key in self.known:
            return self.known[key]
        view = BufferView(buffer=0, byteOffset=self.size, byteLength=len(data), target=target)
        table = values.reshape(len(values), -1)
        kinds = {"float32": FLOAT, "uint16": WORD, "uint32": LONG}
        accessor = Accessor(
            bufferView=len(self.gltf.bufferViews),
            componentType=kinds[values.dtype.name],
            count=len(values),
            type=KINDS[table.shape[1]],
        )
        if bounds:
            accessor.min, accessor.max = table.min(axis=0).tolist(), table.max(axis=0).tolist()
        self.gltf.bufferViews.append(view)
        self.gltf.accessors.append(accessor)
        rest = -len(data) % 4  # arrays begin at multiples of four
        self.chunks.append(data + bytes(rest))
        self.size += len(data) + rest
        self.known[key] = len(self.gltf.accessors) - 1
        return self.known[key]

    def mesh(self, thing: Thing) -> int:
        """The number of the meshes of a thing, as one."""
        from pygltflib import Mesh as Shape

        key = tuple((id(mesh), colour) for mesh, colour in thing.pieces)
        if key not in self.meshes:
            parts = [self.primitive(mesh, colour) for mesh, colour in thing.pieces]
            self.gltf.meshes.append(Shape(primitives=parts, name=thing.name))
            self.meshes[key] = len(self.gltf.meshes) - 1
        return self.meshes[key]

    def primitive(self, mesh: Mesh, colour: str) -> Any:
        from pygltflib import Attributes, Primitive

        small = len(mesh.points) <= 1 << 16
        corners = mesh.triangles.reshape(-1).astype(np.uint16 if small else np.uint32)
        places = self.add(mesh.points.astype(np.float32), VERTICES, bounds=True)
        normals = self.add(mesh.normals.astype(np.float32), VERTICES)
        if colour not in self.materials:
            self.gltf.materials.append(material(colour))
            self.materials[colour] = len(self.gltf.materials) - 1
        return Primitive(
            attributes=Attributes(POSITION=places, NORMAL=normals),
            indices=self.add(corners, INDICES),
            material=self.materials[colour],
        )


def glb(things: Sequence[Thing], time: Array, extras: dict[str, Any]) -> bytes:
    """The file: y up, metres, seconds from the first frame."""
    from pygltflib import GLTF2, Animation, Asset, Buffer, Scene

    gltf = GLTF2(asset=Asset(version="2.0", generator="trsim"), scene=0)
    gltf.scenes = [Scene(nodes=list(range(len(things))), extras=extras)]
    store = Store(gltf)
    animation = Animation(name="motion")
    times = (time - time[0]).astype(np.float32)
    size = max((float(np.abs(thing.place).max()) for thing in things), default=0.0)
    for k, thing in enumerate(things):
        gltf.nodes.append(node(thing, store.mesh(thing)))
        if len(time) > 1:
            animate(animation, store, times, thing, k, size)
    if animation.channels:
        gltf.animations = [animation]
    gltf.buffers = [Buffer(byteLength=store.size)]
    gltf.set_binary_blob(b"".join(store.chunks))
    return b"".join(gltf.save_to_bytes())


def material(colour: str) -> Any:
    """A matt colour; glTF has linear light, colours are written as sRGB."""
    from pygltflib import Material, PbrMetallicRoughness

    shade = [int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    linear = [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shade]
    look = PbrMetallicRoughness(
        baseColorFactor=[*linear, 1.0], metallicFactor=METALLIC, roughnessFactor=ROUGH
    )
    return Material(pbrMetallicRoughness=look, name=colour, doubleSided=False)


def node(thing: Thing, mesh: int) -> Any:
    """The pose at the first frame."""
    from pygltflib import Node

    made = Node(mesh=mesh, name=thing.name)
    made.translation, made.rotation = thing.place[0].tolist(), thing.turn[0].tolist()
    if thing.scale is not None:
        made.scale = thing.scale[0].tolist()
    if thing.label:
        made.extras = {"label": thing.label}
    return made


def animate(animation: Any, store: Store, times: Array, thing: Thing, k: int, size: float) -> None:
    """Channels of what changes; size: of all that there is, m."""
    from pygltflib import AnimationChannel, AnimationChannelTarget, AnimationSampler

    tracks = {"translation": thing.place, "rotation": thing.turn, "scale": thing.scale}
    for path, values in tracks.items():
        if values is None or len(values) == 1:
            continue
        if np.ptp(values, axis=0).max() <= RESTS * (size if path == "translation" else 1.0):
            continue
        sampler = AnimationSampler(
            input=store.add(times, bounds=True),
            output=store.add(values.astype(np.float32)),
            interpolation="LINEAR",
        )
        target = AnimationChannelTarget(node=k, path=path)
        channel = AnimationChannel(sampler=len(animation.samplers), target=target)
        animation.channels.append(channel)
        animation.samplers.append(sampler)
