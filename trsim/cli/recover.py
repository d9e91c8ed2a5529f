"""trsim recover: what a dead run left, as a result file."""

from pathlib import Path

import click

from trsim.cli.frame import NAMED, Answer, framed


@click.command("recover")
@click.argument("part", type=click.Path())
@click.option("-o", "--output", type=NAMED, help="Result file.")
@framed
def command(answer: Answer, part: str, output: str | None) -> None:
    """Copy what a dead run left in FILE.part into a result file with status `recovered`.

    Default output: FILE.recovered.h5 beside it.  FILE.part stays as it is.
    """
    from trsim.store.recover import recover

    source = Path(part)
    stem = source.name.removesuffix(".part").removesuffix(".h5")
    target = Path(output) if output else source.parent / f"{stem}.recovered.h5"
    answer.say(f"reading {part} in a process of its own, as a damaged file may stop HDF5")
    found = recover(source, target)
    answer.data |= found
    answer.put(found["file"])
    answer.say(
        f"{found['file']}: recovered until t = {found['time']:.6g} s, {found['rows']} rows, "
        f"{found['events']} events; the run was '{found['was']}'"
    )
