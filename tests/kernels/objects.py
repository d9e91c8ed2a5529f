"""What is in object files of compiled functions, for processes that import little else."""


def sections(objects):
    """Instructions and constants of an object file; names have counts of the compiler in them."""
    import llvmlite.binding as llvm

    parts = llvm.ObjectFileRef.from_data(objects).sections()
    told = [((part.name() or b"").decode(), part.data().hex()) for part in parts]
    return [(name, data) for name, data in told if name.startswith((".ltext", ".text", ".rodata"))]
