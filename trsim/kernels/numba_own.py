"""numba's own way of compiling, for versions that pipeline.py does not know.

It optimises every callee by itself and again as part of each caller: slower, with more machine
code, and the same results.
"""

from contextlib import nullcontext as quick
from types import CodeType
from typing import Any

import llvmlite.binding as llvm
from numba.core import config
from numba.core.registry import cpu_target

__all__ = ["OPTIONS", "made_of", "quick", "refresh", "translated"]

OPTIONS: dict[str, Any] = {}  # of njit


def refresh() -> None:
    """Let numba find what was registered with it."""
    cpu_target.typing_context.refresh()
    cpu_target.target_context.refresh()


def made_of(_: Any) -> frozenset[CodeType]:
    """numba does not tell."""
    return frozenset()


def translated(library: Any, symbol: str, processor: Any = None) -> tuple[Any, bytes]:
    """One function with all it calls: LLVM's module, and its machine code."""
    if processor is not None:
        raise NotImplementedError("numba has optimised it for this processor")
    module = llvm.parse_assembly(library.get_llvm_str())
    for function in module.functions:
        if not function.is_declaration:
            function.linkage = "external" if function.name == symbol else "internal"
    machine = llvm.Target.from_triple(module.triple).create_target_machine(
        cpu=config.CPU_NAME or llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten() if config.CPU_FEATURES is None
        else config.CPU_FEATURES,
        opt=3, reloc="static" if module.triple.startswith("x86") else "default", jit=True,
    )  # fmt: skip
    return module, machine.emit_object(module)
