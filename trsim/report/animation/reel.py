"""What an animation is, before it is a page or a file."""

from typing import NamedTuple


class Film(NamedTuple):
    """An animation, and what is to be said of it."""

    glb: bytes
    title: str
    start: float  # s, of its first frame
    scale: float  # m/N of the arrows; 0 without contact forces
    magnified: float  # clearances
    open: float  # m, by which ideal joints come apart in it
    colours: dict[str, str]  # kind of body -> colour
    warnings: tuple[str, ...]
