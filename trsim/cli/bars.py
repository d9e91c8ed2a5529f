"""Flexible bars for a reader: what they give way, how they move."""

from typing import Any

STRAIGHT = 1e-9  # of the length: an error that is rounding


def bar_lines(found: dict[str, Any]) -> list[str]:
    """What each flexible bar gives way, and how it moves."""
    told = []
    for bar in found["flexible"]:
        told += [
            f"  flexible    {bar['name']}: {bar['elements']} elements on {bar['length']:.4g} m, "
            f"{bar['mass']:.3g} kg",
            f"              gives way {bar['axial']:.2e} m/N along (L/EA), {bar['bending']:.2e} "
            f"m/N in its middle between hinges (L^3/48EI), {bar['cantilever']:.2e} m/N as a "
            "cantilever (L^3/3EI)",
            *(
                f"              {joint}: {share:.0%} of the compliance of contact and bar in line "
                "is the contact's, at the load of the start"
                for joint, share in bar["contact_shares"].items()
            ),
            f"              bends at {bar['lowest']:.3g} Hz and above between hinges; the mesh "
            f"reaches at most {bar['highest']:.3g} Hz: explicit steps below "
            f"{bar['explicit_step']:.1e} s",
            f"              a wave along it takes {bar['wave']:.1e} s" + rows_line(found, bar),
            mesh_line(bar),
        ]
    return told


def mesh_line(bar: dict[str, Any]) -> str:
    """How wrong its mesh makes the start, or where that can be found."""
    mesh, lead = bar["mesh"], "              its mesh: "
    if mesh is None:
        return lead + "no estimate of its error (`stretching: full`, or more than 100 elements)"
    if mesh["relative"] < STRAIGHT:
        return lead + "no error at the start, where nothing bends it; a run gives its own estimate"
    return lead + (
        f"wrong by about {mesh['error']:.1e} m at the start, {mesh['relative']:.1e} of the length "
        f"(estimated by halving the elements); {mesh['wanted']} elements would make it 1e-4; a "
        "run gives its own"
    )


def rows_line(found: dict[str, Any], bar: dict[str, Any]) -> str:
    """Whether the rows of the output show its motions."""
    every = found["every"]
    if not every:
        return ""
    shown = 0.5 / every
    faster = f"; output.every {every:.2g} s shows nothing above {shown:.3g} Hz"
    return faster if shown < 0.5 / bar["wave"] else ""
