"""Losses of a contact are summed up where its channels are asked for by name."""

import pytest

from ..runs import built

TEXT = """
bodies: {{ball: {{mass: 1, inertia: 0.01, at: [0, 0.1]}}}}
forces:
  touch: {{type: surface_contact, surface: {{body: ground, shape: plane}},
          ball: {{body: ball, at: [0, 0.1], radius: 0.1}}}}
contact_laws: {{soft: {{normal: impact, stiffness: 1e5, exponent: 1.5, damping: 30, ramp: 0.05,
                friction: {{law: none}}}}}}
output: {{channels: [{channel}]}}
solver: {{end: 1}}
"""


@pytest.mark.parametrize("name", ["damping_loss", "friction_loss"])
def test_the_loss_of_a_single_touch(name):
    columns = {c.name: c.unit for c in built(TEXT.format(channel=f"touch.{name}")).columns}
    assert columns[f"touch.{name}"] == "J"
    assert f"touch.{name}" not in {
        c.name for c in built(TEXT.format(channel="touch.normal_force")).columns
    }
