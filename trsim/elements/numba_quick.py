"""numba without its look for scipy's linear algebra.

numba.np.arraymath imports it, a fifth of a second of start-up, only to learn whether it is there;
no kernel of ours calls it.  It is hidden while numba looks and free for everybody else afterwards.
Import this module before the rest of numba is touched.
"""

import sys

_SOUGHT = "scipy.linalg.cython_blas"

if _SOUGHT in sys.modules:
    import numba.np.arraymath
else:
    sys.modules[_SOUGHT] = None  # type: ignore[assignment]
    import numba.np.arraymath  # noqa: F401

    del sys.modules[_SOUGHT]
