"""Measurements are made by hand: that each can begin is seen here."""

from importlib import import_module

import pytest

from benchmarks.__main__ import LONG, NAMES


@pytest.mark.parametrize("name", (*NAMES, *LONG))
def test_each_can_begin(name):
    module = import_module(f"benchmarks.{name}")
    assert callable(module.main)
    assert module.__doc__
