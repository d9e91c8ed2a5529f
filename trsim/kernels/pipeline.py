"""numba with only what compiling our functions takes.

What numba does for every function and ours do not need is left out:

* machine code for each callee.  A callee's code goes as it is written into the one function that
  is asked for; that is optimised and translated once.  numba optimises and translates every
  function by itself, and again as part of each caller.
* reference counts, wrappers, closures, array expressions, and the passes that look for them.
* where each variable dies.  Only what is counted is released there.
* the question, at every look into an array, whether the index is negative.  Ours never are.
* copies of loops whose length is not known: ours are short, and the copies never run.
* calls of the C library in place of loops that clear or copy: a call takes longer than they do.
* the overloads of an operator, tried one after the other, for types they were tried for before.

What is compiled is the same program: without `fastmath` no optimisation changes a number.
"""

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from types import CodeType
from typing import Any

import llvmlite.binding as llvm
import numba
from numba.core import base, cgutils, ir, transforms, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase
from numba.core.compiler_machinery import LoweringPass, PassManager, register_pass
from numba.core.postproc import PostProcessor
from numba.core.registry import cpu_target
from numba.core.typed_passes import (
    AnnotateTypes,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.types.containers import UniTuple
from numba.core.types.functions import BaseFunction
from numba.core.types.misc import unliteral
from numba.core.untyped_passes import (
    FixupArgs,
    GenericRewrites,
    IRProcessing,
    ReconstructSSA,
    TranslateByteCode,
)
from numba.np import arrayobj

from trsim.kernels.signatures import KNOWN

if numba.version_info[:2] not in {(0, minor) for minor in KNOWN}:
    raise ImportError(f"numba {numba.__version__} is not among the versions known here")

# the only way to say it, for all of the process
llvm.set_option("trsim", "-unroll-runtime=false")
llvm.set_option("trsim", "-disable-loop-idiom-memset")
llvm.set_option("trsim", "-disable-loop-idiom-memcpy")


class Library(JITCodeLibrary):
    """One function as it was written, and the libraries of those it calls."""

    python: Any = None  # the function, where it is one of ours

    def add_ir_module(self, ir_module: Any) -> None:
        text = cgutils.normalize_ir_text(str(ir_module))
        self._final_module.link_in(llvm.parse_assembly(text))

    def finalize(self) -> None:
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        return 0  # it has no machine code of its own

    @property
    def codegen(self) -> Any:
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """Compiled code does not ask for its environment."""

    def _get_module_for_linking(self) -> Any:
        """The function with all it calls, as one module."""
        module = self._final_module.clone()
        for library in _below(self):
            theirs = library._final_module
            if not isinstance(library, Library):
                theirs = library._get_module_for_linking()
            module.link_in(theirs, preserve=True)
        for function in _written(module):
            function.linkage = "linkonce_odr"
        return module


def _below(library: Library) -> list[Any]:
    """All libraries a library needs, each once."""
    found: dict[Any, None] = {}
    waiting = list(library._linking_libraries)
    while waiting:
        one = waiting.pop()
        if one not in found:
            found[one] = None
            waiting += one._linking_libraries if isinstance(one, Library) else ()
    return list(found)


def _written(module: Any) -> list[Any]:
    """Functions a module has the code of."""
    return [function for function in module.functions if not function.is_declaration]


@register_pass(mutates_CFG=False, analysis_only=False)
class OwnLibrary(LoweringPass):
    """Where what is made of a function goes."""

    _name = "own_library"

    def __init__(self) -> None:
        LoweringPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        state.library = Library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.python = state.func_id.func
        return False


PASSES = (
    TranslateByteCode, FixupArgs, IRProcessing, GenericRewrites, ReconstructSSA,
    NopythonTypeInference, PreLowerStripPhis, AnnotateTypes, OwnLibrary, NativeLowering,
    NoPythonBackend,
)  # fmt: skip


class Pipeline(CompilerBase):
    """From bytecode to LLVM's language, for loops over arrays and numbers."""

    def define_pipelines(self) -> list[PassManager]:
        manager = PassManager("loops")
        for step in PASSES:
            manager.add_pass(step, step.__name__)
        manager.finalize()
        return [manager]


OPTIONS = {"pipeline_class": Pipeline}  # of njit


def made_of(library: Library) -> frozenset[CodeType]:
    """The code of our functions that a library consists of."""
    ours = (getattr(one, "python", None) for one in (library, *_below(library)))
    return frozenset(python.__code__ for python in ours if python is not None)


def translated(library: Library, symbol: str, processor: Any = None) -> tuple[Any, bytes]:
    """One function with all it calls, optimised: LLVM's module, and its machine code.

    processor: the target machine, where it is not numba's.
    """
    module, codegen = library._get_module_for_linking(), library._codegen
    for function in _written(module):
        function.linkage = "external" if function.name == symbol else "internal"
    module.verify()
    theirs = codegen._tm
    codegen._tm = machine = processor or theirs
    try:
        passes, builder = codegen._module_pass_manager()
    finally:
        codegen._tm = theirs
    passes.run(module, builder)
    return module, machine.emit_object(module)


_THEIR_CALL_TYPE = BaseFunction.get_call_type


def _index(context: Any, builder: Any, kind: Any, index: Any, size: Any) -> Any:
    """An index as it stands, where numba would count a negative one from the end."""
    return context.cast(builder, index, kind, types.intp)


def _blocks_only(post: PostProcessor, *_: Any, **__: Any) -> None:
    """What must follow a change of a function; numba would also look where its variables live."""
    post.func_ir.blocks = transforms.canonicalize_cfg(post.func_ir.blocks)


def _variables(statement: Any) -> list[Any]:
    """The variables that a statement or an expression names."""
    found: list[Any] = []
    for value in (statement._kws if type(statement) is ir.Expr else statement.__dict__).values():
        if type(value) is ir.Var:
            found.append(value)
        elif isinstance(value, ir.Inst | list | tuple | dict):
            found += statement._rec_list_vars(value)
    return found


@cache
def _call_type(function: BaseFunction, arguments: tuple[Any, ...]) -> Any:
    return _THEIR_CALL_TYPE(function, cpu_target.typing_context, arguments, {})


def _remembered(function: Any, context: Any, arguments: Any, named: dict[str, Any]) -> Any:
    """Signature that one of numba's functions is called with, looked for once."""
    if named:
        return _THEIR_CALL_TYPE(function, context, arguments, named)
    plain = tuple(unliteral(kind) for kind in arguments)
    # of numbers and of their arrays the value of a constant makes no difference
    alike = all(isinstance(kind, types.Number | types.Array | UniTuple) for kind in plain)
    return _call_type(function, plain if alike else tuple(arguments))


# what takes the place of numba's while it compiles for us: of what, under which name
OURS = (
    (BaseFunction, "get_call_type", _remembered),
    (PostProcessor, "run", _blocks_only),
    (arrayobj, "fix_integer_index", _index),
    (base, "_has_loc", cache(base._has_loc)),
    (ir.Stmt, "list_vars", _variables),
    (ir.Expr, "list_vars", _variables),
)


@contextmanager
def quick() -> Iterator[None]:
    """numba while it compiles for us.

    Its own parts go into our libraries too, the types of calls are remembered, nothing is looked
    for in registries but what compiling itself puts there.  No garbage is collected: nearly all
    that is made stays.
    """
    target, typing = cpu_target.target_context, cpu_target.typing_context
    codegen, collects = target.codegen(), gc.isenabled()
    typing.refresh()  # in this order, or numba tries the overloads of numbers last
    target.refresh()
    theirs = [(codegen, "_library_class", codegen._library_class)]
    theirs += [(owner, name, getattr(owner, name)) for owner, name, _ in OURS]
    intrinsics = next(iter(target._registries))  # where numba registers those of ours
    gc.disable()
    codegen._library_class = Library
    for owner, name, ours in OURS:
        setattr(owner, name, ours)
    target.refresh = lambda: target.install_registry(intrinsics)
    typing.refresh = lambda: None
    try:
        yield
    finally:
        for owner, name, value in theirs:
            setattr(owner, name, value)
        del target.refresh, typing.refresh
        gc.freeze()
        if collects:
            gc.enable()


def refresh() -> None:
    """Let numba find what was registered with it since it began to compile for us."""
    target = cpu_target.target_context
    type(cpu_target.typing_context).refresh(cpu_target.typing_context)
    type(target).refresh(target)
