"""Figures where it matters that they are made, and not what they look like (tests/report does)."""

from itertools import count

from matplotlib.figure import Figure

from trsim.report import figures, style

DOTS = 40  # an inch


def few(monkeypatch, of_each=False):
    """From now on figures have few dots, and each kind is drawn once: of_each report, or of the
    first, and of the others the first figure."""
    planned, seen = figures.planned, set()

    def chosen(runs):
        if of_each:
            seen.clear()
        for k, (name, make) in zip(count(), planned(runs), strict=False):
            kind = name.partition("_")[0]
            if k == 0 or kind not in seen:
                yield name, make
            seen.add(kind)

    monkeypatch.setattr(figures, "planned", chosen)
    coarse(monkeypatch)


def blank(monkeypatch):
    """From now on a figure is made and named, and what is written is an empty one: painting takes
    two thirds of its time, and whether it can be is for tests/report."""

    def picture(_figure, target):
        Figure(figsize=(0.1, 0.1), dpi=DOTS).savefig(
            target, format="png", metadata=style.ABOUT["png"]
        )

    monkeypatch.setattr(style, "picture", picture)


def coarse(monkeypatch):
    """From now on figures have few dots."""
    monkeypatch.setattr(style, "DPI", DOTS)
    monkeypatch.setattr(style, "SLIDES", style.SLIDES._replace(dpi=DOTS))
