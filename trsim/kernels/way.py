"""The way numba compiles for us: pipeline.py's where it knows this numba, else numba's own."""

import trsim.kernels.numba_quick  # before numba

# isort: split

import sys
from typing import Any

way: Any
try:
    import trsim.kernels.pipeline

    way = trsim.kernels.pipeline
except (AttributeError, ImportError) as error:  # it takes parts of numba's inside
    import trsim.kernels.numba_own

    way = trsim.kernels.numba_own
    print(f"trsim: compiling takes longer, with the same results: {error}", file=sys.stderr)
