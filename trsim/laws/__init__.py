"""Laws: numbers in, numbers out.  No bodies, no names of a scenario, no state of a run.

Elements call laws directly from their kernels.
"""
