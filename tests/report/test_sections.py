"""A section asked for after a run: its figure, and its table with the error of every point."""

import csv

import numpy as np
import pytest

from tests import small
from trsim.errors import UsageError
from trsim.report import analysed
from trsim.report.asked import Asked
from trsim.store.read import read

WRONG = "when=stroke,plot=stroke"
ASKED = "when=B.eccentricity_x_rate,crosses=up,plot=B.eccentricity_x:B.eccentricity_y"


def test_figure_and_table(tmp_path):
    small.copy(tmp_path / "run.h5")
    written = analysed([tmp_path / "run.h5"], tmp_path / "figures", Asked(section=(ASKED,))).files
    table, figure = written[-2:]
    stem = "section_B.eccentricity_x_rate_up_B.eccentricity_x_B.eccentricity_y"
    assert (table.name, figure.name) == (f"{stem}.csv", f"{stem}.png")
    with table.open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["run", "time", "x", "y", "time_error", "x_error", "y_error"]
    numbers = np.array([row[1:] for row in rows], float)
    located = read(tmp_path / "run.h5").poincare["journal"]
    assert np.all(np.abs(numbers[:, 0] - located.time) <= numbers[:, 3] + 1e-15)
    assert np.all(np.abs(numbers[:, 1] - located.x) <= numbers[:, 4] + 1e-15)


def test_refused(tmp_path):
    small.copy(tmp_path / "run.h5")
    with pytest.raises(UsageError, match="plot= is two channels"):
        analysed([tmp_path / "run.h5"], tmp_path / "figures", Asked(section=(WRONG,)))


def test_time_crosses_nothing_again(tmp_path):
    small.copy(tmp_path / "run.h5")
    with pytest.raises(UsageError, match="time does not cross"):
        analysed([tmp_path / "run.h5"], tmp_path, Asked(section=("when=time,plot=time:stroke",)))
