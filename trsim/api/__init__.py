"""What Python and the command line call: load, check, run, sweep, merge, and what comes of a run.

`import trsim` gives all of it under its own name (docs/python.md).  The commands read options, call
what is here, and print.
"""
