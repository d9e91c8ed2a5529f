"""Tests of trsim/sweeps."""
