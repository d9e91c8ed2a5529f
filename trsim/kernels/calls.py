"""Calling a function by its address.

The tables of a model hold addresses of machine code, so the solver is compiled once per
installation and a scenario loads only the elements it uses.  A call costs a few nanoseconds.
"""

from trsim.kernels.machine import Caller
from trsim.kernels.signatures import Signature


def caller(signature: Signature) -> Caller:
    """A function call(address, *arguments) for functions of the given signature."""
    return Caller(signature)
