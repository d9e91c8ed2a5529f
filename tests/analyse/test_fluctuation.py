"""Fluctuation: slow curves leave nothing, fast ones their rms."""

import numpy as np
import pytest

from trsim.analyse.fluctuation import fluctuation, high_pass

t = np.arange(0.0, 1.0, 1e-4)


def test_a_straight_line_leaves_nothing_inside():
    assert np.abs(high_pass(t, 3.0 + 2.0 * t)[200:-200]).max() < 1e-12


def test_a_fast_sine_keeps_its_rms():
    x = 5.0 * t + 0.3 * np.sin(2 * np.pi * 1000.0 * t)
    assert fluctuation(t, x, 0.1, 0.9) == pytest.approx(0.3 / np.sqrt(2), rel=1e-3)


def test_a_slow_sine_is_taken_out():
    assert fluctuation(t, np.sin(2 * np.pi * 1.0 * t), 0.1, 0.9) < 2e-3


def test_one_row_or_none_fluctuates_by_no_number():
    assert np.isnan(fluctuation(t[:1], t[:1], 0.0, 1.0))
    assert np.isnan(fluctuation(t[:0], t[:0], 0.0, 1.0))
