"""Tests of trsim/sweep."""
