"""Kernels that call kernels: how a hundred small ones become a few pieces of machine code.

numba makes machine code of every function it compiles, and optimises it once more inside each of its
callers, layer upon layer. Most kernels are only ever called by kernels. So a kernel has two compiled
forms. Its *part* is what other kernels link in: code that is neither optimised nor translated. Its
*whole*, made when Python calls the kernel, takes in the parts of all kernels below it, and is optimised,
translated and kept on disk.

A part is made once for the types of its arguments, not once more for every literal it is called with. What
an operator or an accessor makes of its arguments is found once, and not wherever it stands. And what numba
would look for in every function, though no kernel has it, is not looked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, ClassVar

from numba import njit, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.extending import models, register_model, typeof_impl

from udec_ia.compiling.code_cache import use_cache
from udec_ia.compiling.compile_time import compiling
from udec_ia.signals import poll

NOT_IN_KERNELS = "inline_closure_likes", "nopython_rewrites"  # closures, expressions of whole arrays


class _NoEnvironment:
    """Keeps no Python objects for a function: a part has no use for any."""

    def set_env(self, name: str, env: Any) -> None:
        pass


class _Part(JITCodeLibrary):
    """Code for others to link in. What it calls is noted, and linked in by them."""

    codegen = _NoEnvironment()

    def _optimize_functions(self, ll_module: Any) -> None:
        """A part is optimised where it has been taken in."""

    def finalize(self) -> None:
        self._finalized = True


class _Whole(JITCodeLibrary):
    """Code with everything it calls in it."""

    _linking_libraries: list[Any]

    def finalize(self) -> None:
        found: dict[Any, None] = {}
        _add_called(self._linking_libraries, found)
        self._linking_libraries = [*reversed(found)]  # callers first: LLVM takes in what has been asked for
        super().finalize()


def _add_called(libraries: Iterable[Any], found: dict[Any, None]) -> None:
    """Add `libraries` and what their parts call, each after all that it calls."""
    for library in libraries:
        if library not in found:
            if isinstance(library, _Part):
                _add_called(library._linking_libraries, found)
            found[library] = None


class _Remembering:
    """A typing context of numba's, `knows`, that keeps what it has found of what is no kernel."""

    found: ClassVar[dict[Any, Any]] = {}  # signature, by function and types of its arguments

    def __init__(self, knows: Any) -> None:
        self._knows = knows

    def __getattr__(self, name: str) -> Any:
        return getattr(self._knows, name)

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        """Signature of a call; None if there is none."""
        key = func, tuple(args)
        signature = self.found.get(key)
        if signature is None:
            signature = self._knows.resolve_function_type(func, args, kws)
            if isinstance(func, types.Function) and not kws:
                self.found[key] = signature
        return signature


class _KernelCompiler(Compiler):
    form: type[JITCodeLibrary]

    def define_pipelines(self) -> Any:
        state = self.state
        state.library = self.form(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        state.typingctx = _Remembering(state.typingctx)
        (pipeline,) = super().define_pipelines()
        pipeline.passes = [one for one in pipeline.passes if one[0]._name not in NOT_IN_KERNELS]
        return [pipeline]


class _PartCompiler(_KernelCompiler):
    form = _Part


class _WholeCompiler(_KernelCompiler):
    form = _Whole

    def compile_extra(self, function: Callable[..., Any]) -> Any:
        """Compile `function` with all the parts that it needs. What is found on disk does not come here."""
        with compiling():
            return super().compile_extra(function)


class LinkedKernel:
    """A compiled function in both its forms: called from Python it is whole, from a kernel a part.

    folder: of the machine code of the whole. outlined: kernels call the whole, too, by its address.
    """

    def __init__(self, function: Callable[..., Any], folder: Path, outlined: bool, **flags: Any) -> None:
        self.whole = njit(no_cfunc_wrapper=not outlined, pipeline_class=_WholeCompiler, **flags)(function)
        use_cache(self.whole, folder)
        self.part = njit(
            no_cfunc_wrapper=True, no_cpython_wrapper=True, pipeline_class=_PartCompiler, **flags
        )(function)


class _KernelType(types.Dispatcher):
    """What a kernel is to the kernels that call it."""

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Signature of a call, for which the part is compiled unless it has been.

        Between the parts of what takes a minute to compile, an interrupt does no harm.
        """
        poll()
        return super().get_call_type(context, tuple(types.unliteral(arg) for arg in args), kws)


register_model(_KernelType)(models.OpaqueModel)


@typeof_impl.register(LinkedKernel)
def _type_of(linked: LinkedKernel, _: Any) -> _KernelType:
    return _KernelType(linked.part)
