"""Redundant rows in one line, for those who run a scenario or look at its results."""

from typing import Any


def redundancy(data: dict[str, Any]) -> str:
    """What was dropped, and the joints whose reactions that leaves undetermined."""
    rows = data["redundant"]
    joints = dict.fromkeys(row.split(".")[0] for row in data["not_unique"])
    more = "s" if len(rows) > 1 else ""
    told = (
        "those of least norm are told" if data["least_norm"] else "those of dropped rows are zero"
    )
    return (
        f"{len(rows)} constraint row{more} dropped ({', '.join(rows)}), mobility "
        f"{data['mobility']}; reactions of {', '.join(joints)} are not unique, {told}; "
        "`trsim check` says what to release"
    )
