"""Analyses of runs, each one file: arrays in, numbers out."""
