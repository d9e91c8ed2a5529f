"""Analyses of stored runs, each one file: arrays in, numbers out."""
