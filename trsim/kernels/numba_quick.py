"""numba without its look for scipy's linear algebra, and without a file of the current folder.

numba.np.arraymath imports the first, a fifth of a second of start-up, only to learn whether it is
there; no kernel of ours calls it.  `.numba_config.yaml` in the folder a command is begun in would
change the machine code of whoever works there; variables of the environment still do, and are in
the key of what is kept.  Both are hidden while numba looks, and free for everybody else afterwards.
Import this module before numba.
"""

import sys
import warnings

_SOUGHT = ("scipy.linalg.cython_blas", "yaml")

if "numba" not in sys.modules:
    _there = {name: sys.modules.get(name) for name in _SOUGHT}
    if _there["scipy.linalg.cython_blas"] is not None:
        del _there["scipy.linalg.cython_blas"]
    sys.modules.update(dict.fromkeys(_there))  # type: ignore[arg-type]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that it cannot read the file
            import numba.core.config
            import numba.np.arraymath
    finally:
        for _name, _module in _there.items():
            del sys.modules[_name]
            if _module is not None:
                sys.modules[_name] = _module
    numba.core.config._config_fname = ""
