"""trsim merge: folders of the same sweep made into one."""

from pathlib import Path

import click

from trsim.cli.frame import NAMED, Answer, framed


@click.command("merge")
@click.argument("folders", nargs=-1, required=True, type=click.Path())
@click.option("-o", "--output", type=NAMED, required=True, help="Folder that is made.")
@click.option("--link", is_flag=True, help="Give result files a second name; do not copy them.")
@framed
def command(answer: Answer, folders: tuple[str, ...], output: str, link: bool) -> None:
    """Make one folder of the FOLDERS of shards that were run on machines without a common one.

    All must be of the same scenario, the same --set and the same trsim.  Nothing in them is
    changed.  The same command again goes on where it was broken off, and adds what is new.
    """
    from trsim.api.merge import merged

    found = merged(answer, folders, Path(output), link)
    answer.data |= {
        "folder": output,
        "cases": found.cases,
        "taken": found.taken,
        "counts": found.counts,
        "left_out": [
            {"case": one.case, "folder": str(one.folder), "why": one.why} for one in found.lost
        ],
    }
    answer.put(str(Path(output) / "index.csv"))
    answer.say(found.told)
