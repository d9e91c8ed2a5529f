"""Arithmetics that one processor can run: each rounds in places of its own.

Where a result may differ between processors:

    dense linear algebra    OpenBLAS has kernels for each family of processors
    sin, cos, exp, pow      the C library has them with and without fused multiplication
    sums and sin of arrays  numpy has them for several widths of vectors
    machine code            is made for the processor at hand

All of them can be chosen by the environment of a process.
"""

import os
import platform
import re
from functools import cache
from pathlib import Path
from typing import NamedTuple

AVX2 = frozenset({"avx", "avx2", "fma"})
AVX512 = AVX2 | {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}
WITHOUT = "glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-AVX,-FMA,-FMA4"


class Arithmetic(NamedTuple):
    """What a process is given, and what the processor must have for it."""

    name: str
    environment: dict[str, str]
    needs: frozenset[str] = frozenset()

    @property
    def missing(self) -> str:
        """Why it cannot be run here; empty where it can.

        OpenBLAS takes the kernels it is told to, also those whose instructions the processor
        does not have: the process would be killed.
        """
        if platform.machine() != "x86_64":
            return f"needs x86_64, not {platform.machine()}"
        return " ".join(sorted(self.needs - flags()))

    def surroundings(self) -> dict[str, str]:
        """The environment of a process that has it, and none of the others."""
        chosen = {key for one in ARITHMETICS for key in one.environment}
        return {k: v for k, v in os.environ.items() if k not in chosen} | self.environment


def kernels(name: str, needs: frozenset[str]) -> Arithmetic:
    """OpenBLAS's of a family of processors."""
    return Arithmetic(f"OpenBLAS {name}", {"OPENBLAS_CORETYPE": name}, needs)


OLD = {
    "OPENBLAS_CORETYPE": "Prescott", "GLIBC_TUNABLES": WITHOUT, "NUMBA_CPU_NAME": "generic",
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4",
}  # fmt: skip
ARITHMETICS = (
    kernels("SkylakeX", AVX512),
    kernels("Haswell", AVX2),
    kernels("Zen", AVX2),
    kernels("Prescott", frozenset({"pni"})),
    Arithmetic("C library without FMA and AVX2", {"GLIBC_TUNABLES": WITHOUT}),
    Arithmetic("machine code for any processor", {"NUMBA_CPU_NAME": "generic"}),
    Arithmetic("numpy without AVX", {"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"}),
    Arithmetic("all of an old processor", OLD),
)


@cache
def flags() -> frozenset[str]:
    """What the processor can do, in Linux's words."""
    try:
        text = Path("/proc/cpuinfo").read_text()
    except OSError:
        return frozenset()
    found = re.search(r"^flags\s*:(.*)$", text, re.MULTILINE)
    return frozenset(found[1].split()) if found else frozenset()
