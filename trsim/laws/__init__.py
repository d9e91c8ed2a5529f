"""Laws: numbers in, numbers out.  No bodies, no names of a scenario, no state of a run.

`law` compiles a scalar law; elements call laws directly from their kernels.
"""

from numba import njit

law = njit(cache=True, error_model="numpy")
