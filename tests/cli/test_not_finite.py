"""A force that stops being a number during a run: exit 5, and only numbers in the file."""

import h5py
import numpy as np
import pytest

from tests import small
from trsim.scenario.methods import METHODS
from trsim.store.read import read, verify

END = 1.5e-3  # s; the contact has closed by then
LAWS = {
    "nan": f"log({END} - t)",
    "inf": f"1e-9/max(0, {END} - t)",
}
STEPS = {"rk4": ", step: 1e-6"}


def tables(file):
    """Every dataset of numbers that grows with the run, by name."""
    found = {}
    file.visititems(
        lambda name, item: (
            found.update({name: item[()]})
            if isinstance(item, h5py.Dataset) and item.maxshape[:1] == (None,)
            else None
        )
    )
    return found


MOVED = [name for name, method in METHODS.items() if not method.driven and not method.rests]


@pytest.mark.parametrize("method", MOVED)
@pytest.mark.parametrize("law", LAWS)
def test_only_numbers_are_written(method, law, scenario, answer):
    text = small.SLIDER_CRANK.replace("method: dop853", f"method: {method}{STEPS.get(method, '')}")
    text += "forces:\n  push: {type: applied_load, body: slider, direction: [1, 0, 0],"
    scenario.write_text(f'{text} force: "{LAWS[law]}"}}\n')
    code, document = answer("run", "crank.yaml")
    assert code == 5, document["errors"]
    run = read("runs/crank.h5")
    assert verify(run.path)
    assert run.attributes["status"] == "failed" and run.attributes["reason"]
    with h5py.File(run.path) as file:
        found = tables(file)
    # each under one of its names: the orbit of B is made of its steps
    assert {"B.force", "events/time"} < set(found)
    assert {"steps/B/time", "orbit/B/steps/time"} & set(found)
    for name, rows in found.items():
        if rows.dtype.kind == "f":
            assert np.all(np.isfinite(rows)), name
    assert run.rows > 50
    print(f"{method}, {law}: {run.rows} rows and {len(found)} tables, all finite")
