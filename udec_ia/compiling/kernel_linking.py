"""Kernels that call kernels: how a hundred small ones become a few pieces of machine code.

numba makes machine code of every function, and optimises it once more inside each of its callers. So a kernel
has two compiled forms. Its *part* is what other kernels link in: code that is neither optimised nor
translated, made once for the types of its arguments and not for every literal. Its *complete* form, compiled
when Python calls the kernel, contains the parts of all kernels below it, and is optimised, translated and
stored on disk.
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
from udec_ia.interrupt_signals import poll

NOT_IN_KERNELS = "inline_closure_likes", "nopython_rewrites"  # closures, expressions of whole arrays


class _NoEnvironment:
    """Keeps no Python objects for a function: a part has no use for any."""

    def set_env(self, name: str, env: Any) -> None:
        pass


class _Part(JITCodeLibrary):
    """Code for others to link in, which also link in what it calls."""

    codegen = _NoEnvironment()

    def _optimize_functions(self, ll_module: Any) -> None:
        """A part is optimised where it has been taken in."""

    def finalize(self) -> None:
        self._finalized = True


class _Complete(JITCodeLibrary):
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


class _CachedSignatures:
    """A typing context of numba that caches the signatures of calls, but for those of kernels."""

    found: ClassVar[dict[Any, Any]] = {}  # signature, by function and types of its arguments

    def __init__(self, context: Any) -> None:
        self._context = context

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        """Signature of a call, or None."""
        key = func, tuple(args)
        signature = self.found.get(key)
        if signature is None:
            signature = self._context.resolve_function_type(func, args, kws)
            if isinstance(func, types.Function) and not kws:
                self.found[key] = signature
        return signature


class _KernelCompiler(Compiler):
    form: type[JITCodeLibrary]

    def define_pipelines(self) -> Any:
        state = self.state
        state.library = self.form(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        state.typingctx = _CachedSignatures(state.typingctx)
        (pipeline,) = super().define_pipelines()
        pipeline.passes = [one for one in pipeline.passes if one[0]._name not in NOT_IN_KERNELS]
        return [pipeline]


class _PartCompiler(_KernelCompiler):
    form = _Part


class _CompleteCompiler(_KernelCompiler):
    form = _Complete


class LinkedKernel:
    """A compiled function in both forms: `dispatcher` is complete, for Python, and `part` is for kernels.

    folder: of the machine code on disk. outlined: kernels call the complete form, too, by its address.
    """

    def __init__(self, function: Callable[..., Any], folder: Path, outlined: bool, **flags: Any) -> None:
        complete = njit(no_cfunc_wrapper=not outlined, pipeline_class=_CompleteCompiler, **flags)
        self.dispatcher = complete(function)
        use_cache(self.dispatcher, folder)
        self.part = njit(
            no_cfunc_wrapper=True, no_cpython_wrapper=True, pipeline_class=_PartCompiler, **flags
        )(function)


class _KernelType(types.Dispatcher):
    """What a kernel is to the kernels that call it."""

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Signature of a call; compiles the part if need be. An interrupt does no harm between two parts."""
        poll()
        return super().get_call_type(context, tuple(types.unliteral(arg) for arg in args), kws)


register_model(_KernelType)(models.OpaqueModel)


@typeof_impl.register(LinkedKernel)
def _type_of(linked: LinkedKernel, _: Any) -> _KernelType:
    return _KernelType(linked.part)
