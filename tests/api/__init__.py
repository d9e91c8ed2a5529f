"""Tests of trsim/api."""
