"""When the implicit method gives back to the explicit one."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.march import record as rec
from trsim.solve.methods.auto import CHEAP_STEPS, EXPLICIT, IMPLICIT, STABLE, change, choose

from ..pieces import piece


@pytest.mark.parametrize("load, method", [(0.3, EXPLICIT), (0.75, IMPLICIT), (1.5, IMPLICIT)])
def test_what_is_given_back_is_well_within_the_limit_of_stability(load, method):
    """At three quarters of it what is stiff would tremble: the explicit method is held to less."""
    r = SimpleNamespace(
        method=IMPLICIT, stiff=0, not_stiff=0, history=1, jacobian=1, past_error=0.0,
        factored_h=0.0, next_look=0, explicit_rate=0.0, steps=40, method_switches=0, t=0.0,
        event_rows=1, jacobian_rate=10.0 * load * STABLE, vibration=0.0, decay=0.0, fading=0,
    )  # fmt: skip
    s = SimpleNamespace(con=np.zeros((1, 2)))
    b = SimpleNamespace(events=np.zeros((2, rec.N_EVENT)))
    alone = piece(choose, change=piece(change, note_event=lambda *_: None))
    for _ in range(CHEAP_STEPS):
        assert r.method == IMPLICIT
        alone(s, r, b, 0.1, 0)
    assert r.method == method
    assert r.method_switches == (method == EXPLICIT)
