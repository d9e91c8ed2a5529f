"""Figures of bodies whatever sensors there are, and of springs, dampers and bushings."""

import numpy as np
import pytest

from tests import small
from tests.report.test_figures import drawn
from trsim.report import components, figures, report
from trsim.report.display import compared
from trsim.report.style import look
from trsim.store.read import read

SPRUNG = """\
title: Mass on springs
planar: false
bodies: {block: {mass: 2, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0.5]}}
joints: {guide: {type: prismatic, bodies: [ground, block], axis: [0, 0, 1]}}
sensors: {height: {joint: guide}}
forces:
  strut: {type: spring_damper, bodies: [ground, block], points: [[0, 0, 0], [0, 0, 0.5]],
          stiffness: 200, free_length: 0.5}
  mount: {type: bushing, bodies: [ground, block], at: [0, 0, 0.5], stiffness: [0, 0, 250],
          damping: [0, 0, 0], rotational_stiffness: [0, 0, 0]}
  push: {type: applied_load, body: block, at: [0, 0, 0.5], direction: [0, 0, 1], force: 9}
solver: {end: 1 s, tolerance: 1e-10}
output: {every: 5 ms}
"""


@pytest.fixture(scope="module")
def sprung(tmp_path_factory):
    """9 N on 450 N/m and 2 kg: z = 20 mm (1 - cos 15 t)."""
    path = tmp_path_factory.mktemp("components") / "sprung.h5"
    small.run(path, text=SPRUNG)
    return path


def test_forces_and_bodies_beside_sensors(sprung, tmp_path):
    written = report(sprung, tmp_path)
    names = {path.stem for path in written if path.suffix == ".png"}
    assert {"motion_height", "body_block", "force_strut", "force_mount"} <= names
    assert "force_push" not in names  # the load is what the scenario says
    for path in written:
        if path.stem.startswith(("force_", "body_")):
            assert 0.005 < drawn(path) < 0.5


def test_curves_are_those_of_a_mass_on_springs(sprung):
    runs = compared([read(sprung)])
    with look():
        made = dict(figures.everything(runs))
    strut, mount, block = (made[name] for name in ("force_strut", "force_mount", "body_block"))
    t = read(sprung).time
    z = 0.02 * (1.0 - np.cos(15.0 * t))
    upper, lower = strut.axes
    assert (upper.get_ylabel(), lower.get_ylabel()) == ("force\n(N)", "length\n(mm)")
    np.testing.assert_allclose(np.abs(upper.lines[0].get_ydata()), 200.0 * z, atol=1e-6)
    np.testing.assert_allclose(lower.lines[0].get_ydata(), 500.0 + 1e3 * z, atol=1e-6)
    force = mount.axes[0]
    assert force.get_ylabel() == "force\n(N)"
    np.testing.assert_allclose(np.abs(force.lines[0].get_ydata()), 250.0 * z, atol=1e-6)
    assert mount.legends[0].get_texts()[0].get_text() == "z"
    assert [a.get_ylabel() for a in block.axes] == ["position\n(mm)", "velocity\n(m/s)"]
    [line] = block.axes[1].lines
    np.testing.assert_allclose(line.get_ydata(), 0.3 * np.sin(15.0 * t), atol=1e-8)


HANGING = """\
bodies: {bob: {mass: 3, inertia: 1e-9, at: [0, -2]}}
joints: {cord: {type: link, bodies: [ground, bob], points: [[0, 0], [0, -2]]}}
gravity: [0, -10, 0]
solver: {end: 0.1 s}
"""


def test_force_along_a_rod(tmp_path):
    """3 kg hang on it: 30 N."""
    small.run(tmp_path / "x.h5", text=HANGING)
    with look():
        made = dict(figures.everything(compared([read(tmp_path / "x.h5")])))
    [axes] = made["force_cord"].axes
    np.testing.assert_allclose(np.abs(axes.lines[0].get_ydata()), 30.0, rtol=1e-9)


def test_several_runs_have_colours_and_components_dashes(paths):
    runs = compared([read(path) for path in paths])
    with look():
        [(_, make)] = components.body(runs, "rod")
        made = make()
    way = [(line.get_color(), line.get_linestyle()) for line in made.axes[0].lines]
    assert len({*way}) == len(way) == 4  # x and y of two runs
    assert len({colour for colour, _ in way}) == 2
