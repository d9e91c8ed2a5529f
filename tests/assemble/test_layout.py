"""Which channels are measured: those that are asked for, and those that others need."""

from ..runs import built

TEXT = """
bodies:
  a: {mass: 1, inertia: 0.01, at: [0.1, 0.2], velocity: [0, 3], angular_velocity: [0, 0, 2]}
  b: {mass: 1, inertia: 0.01, at: [0.5, -0.1]}
joints: {slide: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
sensors: {x: {joint: slide}, other: {joint: slide}}
output: {channels: [a.position]}
poincare: {turns: {when: x.rate, crosses: up, plot: [x, x.rate]}}
solver: {end: 1}
"""


def test_what_a_section_plots_is_measured_though_nobody_asked_for_it():
    wanted = {c.name: c.wanted for c in built(TEXT).columns}
    assert wanted["a.position"] and not wanted["x"] and not wanted["x.rate"]
    assert "other" not in wanted


def test_a_state_as_drawn_is_one_of_its_scene(monkeypatch):
    """As many numbers, and velocities where the scene has them."""
    from trsim.assemble import assemble as module

    seen, own = [], module.as_drawn
    monkeypatch.setattr(module, "as_drawn", lambda *given: seen.append(own(*given)) or seen[-1])
    built(TEXT)
    assert seen
    for full, y in seen:
        assert len(y) == full.n_q + full.n_v + full.n_z
        assert y[full.n_q : full.n_q + 6].tolist() == [0, 3, 0, 0, 0, 2]
