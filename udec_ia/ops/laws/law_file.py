"""The user's laws: read from plain Python, checked and compiled (Appendix IV-4; udec_ia.laws).

Every fault of a law is error 34, which points at the line of the user's file.
"""

from __future__ import annotations

import dis
import hashlib
import inspect
import linecache
import os
import re
import traceback
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import numpy as np

from udec_ia.compiling.build_choice import DISABLED
from udec_ia.compiling.law_calls import FIRST, LAST
from udec_ia.errors import UdecError
from udec_ia.layout.material import JointMaterial, Material
from udec_ia.printable_text import counted

NUMBERS = range(FIRST, LAST + 1)
RESULTS = {f"{law}{n}": count for law, count in (("cl", 3), ("clj", 2), ("jl", 5)) for n in NUMBERS}
# of numbers that a law returns
SHIPPED = Path(__file__).parents[2] / "laws"
FORMS = {
    3: "(s11, s12, s22, de11, de12, de22, m) and return ds11, ds12, ds22",
    2: "(fn, fs, dun, dus, un, us, m) and return dfn, dfs",
    5: "(sn, ts, dun, dus, un, us, v1, v2, v3, m) and return sn, ts, v1, v2, v3",
}
REALS = {3: 6, 2: 6, 5: 9}  # numbers that a law is called with, beside its material
MATERIALS = {3: Material, 2: Material, 5: JointMaterial}
UNCHECKED = ("flat", "as_strided")  # whose indices numba never checks
NAMED = ("LOAD_ATTR", "LOAD_METHOD", "LOAD_GLOBAL")
COLOURS = re.compile(r"\x1b\[[0-9;]*m")
Given = str | Path | Mapping[str, Callable[..., Any]]


@dataclass(frozen=True)
class Law:
    """A law: `name` is cl2 ... jl5, `origin` the name of its file, digest the SHA-256 of the text.

    python: the law for interpreted kernels. address: of its machine code for compiled kernels, else 0. code:
    owner of the machine code. function: the function of the user. failed_at: the reals with which it has
    raised its first exception, else NaN.
    """

    name: str
    origin: str
    digest: str
    python: Callable[..., tuple[float, ...]]
    address: int
    code: Any
    function: FunctionType
    failed_at: Any

    def raised(self, material: Material | JointMaterial) -> tuple[str, str]:
        """The exception of the law with its place, and the arguments of the call; "" without an exception."""
        if np.isnan(self.failed_at[0]):
            return "", ""
        names = inspect.signature(self.function).parameters
        called = ", ".join(
            f"{name} = {value:.6g}" for name, value in zip(names, self.failed_at, strict=False)
        )
        return f": {self._reason(material)}", f"correct the law; it was called with {called}"

    def _reason(self, material: Material | JointMaterial) -> str:
        """The exception that the Python function raises with the same arguments."""
        law, code = _in_python(self.function, RESULTS[self.name], self.failed_at), self.function.__code__
        try:
            with np.errstate(all="ignore"):
                law(*self.failed_at, material)
        except Exception as error:
            line = _line(error, code.co_filename) or code.co_firstlineno
            text = " ".join(str(error).split())
            return f"{type(error).__name__}: {text}, in line {line} of {Path(code.co_filename).name}"
        return "an exception that only compiled code raises"


def read_laws(given: Given | Iterable[Given] | None) -> dict[str, Law]:
    """The laws in files, in laws of the program, or in mappings from names to functions."""
    if given is None:
        return {}
    sources = [given] if isinstance(given, str | Path | Mapping) else list(given)
    laws: dict[str, Law] = {}
    for source in sources:
        found = _of_mapping(source) if isinstance(source, Mapping) else _of_file(_find(source))
        for law in found:
            if law.name in laws:
                detail = f"{law.name} is defined by {laws[law.name].origin} and by {law.origin}"
                raise _wrong(detail, "use another number for one of them")
            laws[law.name] = law
    return laws


def _wrong(detail: str, advice: str = "", code: CodeType | None = None, line: int = 0) -> UdecError:
    """Error 34, at `line` of the file of `code` (its first line if 0)."""
    error = UdecError(34, detail, advice)
    if code is not None:
        _place(error, code.co_filename, line or code.co_firstlineno)
    return error


def _place(error: UdecError, file: str, line: int, column: int = 0) -> UdecError:
    """`error`, pointing at a line of `file`: at `column`, or at its first word."""
    text = linecache.getline(file, line).rstrip()
    error.file, error.line = file, line
    error.source = "".join(c if c.isprintable() else " " for c in text) or None
    error.column = column or len(text) - len(text.lstrip()) + 1
    return error


def _line(error: BaseException, file: str) -> int:
    """The last line of `file` in the traceback of `error`; 0 if there is none."""
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    return (lines[-1] if lines else 0) or 0


def _find(name: str | Path) -> Path:
    """The file `name`, or the file of the program's law of this name."""
    path = Path(name)
    shipped = SHIPPED / f"{path.stem.replace('-', '_')}.py"
    there = os.path.isfile(path) or path.name != str(name) or not shipped.is_file()
    return path if there else shipped


def _of_file(path: Path) -> list[Law]:
    """The laws that the file defines."""
    file = str(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        names = sorted(law.stem.replace("_", "-") for law in SHIPPED.glob("[!_]*.py"))
        reason = getattr(error, "strerror", None) or error
        raise _wrong(f"{file} cannot be read: {reason}", f"give a file, or {' or '.join(names)}") from error
    return _of_shipped(path, text) if path.parent == SHIPPED else _of_text(path, text)


def _of_text(path: Path, text: str) -> list[Law]:
    """The laws that the file of this text defines."""
    file = str(path)
    linecache.checkcache(file)
    space: dict[str, Any] = {"__name__": path.stem, "__file__": file}
    try:
        exec(compile(text, file, "exec", dont_inherit=True), space)
    except SyntaxError as error:
        wrong = _wrong(f"{error.msg}", "this is not valid Python")
        raise _place(wrong, error.filename or file, error.lineno or 1, error.offset or 0) from error
    except (Exception, SystemExit) as error:
        raise _place(_wrong(f"{type(error).__name__}: {error}"), file, _line(error, file) or 1) from error
    functions = {name: space[name] for name in RESULTS if name in space}
    if not functions:
        raise _wrong(f"{file} defines no law", f"a law is a function called {', '.join(RESULTS)}")
    digest = hashlib.sha256(text.encode()).hexdigest()
    return [_law(name, function, path.name, digest) for name, function in functions.items()]


_of_shipped = cache(_of_text)  # a process compiles each law of the program once


def _of_mapping(functions: Mapping[str, Callable[..., Any]]) -> list[Law]:
    """The laws of a mapping; the digest is of the source of each function, or else of its bytecode."""
    laws = []
    for name, function in functions.items():
        if name not in RESULTS:
            raise _wrong(f"{name!r} is not the name of a law", f"laws are {', '.join(RESULTS)}")
        code = _plain(name, function).__code__
        try:
            text = inspect.getsource(code)
        except OSError:
            text = code.co_code.hex()
        laws.append(_law(name, function, "Python", hashlib.sha256(text.encode()).hexdigest()))
    return laws


def _plain(name: str, function: Any) -> FunctionType:
    """The given Python function, or the one behind a compiled function."""
    plain = getattr(function, "py_func", function)
    if not isinstance(plain, FunctionType):
        raise _wrong(f"{name} is not a function", f"a law is a function: def {name}{FORMS[RESULTS[name]]}")
    return plain


def _law(name: str, function: Any, origin: str, digest: str) -> Law:
    """The law `name`. Error 34 if its arguments, its text or its results are wrong."""
    plain = _plain(name, function)
    n = RESULTS[name]
    advice = f"a law must take {FORMS[n]}"
    try:
        inspect.signature(plain).bind(*range(REALS[n] + 1))
    except TypeError as error:
        raise _wrong(f"{name} does not take {REALS[n] + 1} arguments", advice, plain.__code__) from error
    failed_at = np.full(REALS[n], np.nan)
    python = _in_python(plain, n, failed_at)
    if DISABLED:
        return Law(name, origin, digest, python, 0, None, plain, failed_at)
    from udec_ia.compiling.law_calls_numba import compiled_types, machine_code

    compiled = _compiled(function, {})
    try:
        state, material = compiled_types(MATERIALS[n], REALS[n])
        compiled.compile((*state, material))
    except Exception as error:  # numba raises undocumented types
        raise _not_compiled(name, error, plain.__code__) from error
    (signature,) = compiled.nopython_signatures
    if not _are_numbers(signature.return_type, n):
        detail = f"{name} returns {signature.return_type} instead of {n} numbers"
        raise _wrong(detail, advice, plain.__code__)
    code = machine_code(compiled, MATERIALS[n], n, failed_at)
    return Law(name, origin, digest, python, code.address, code, plain, failed_at)


def _in_python(function: FunctionType, n: int, failed_at: Any) -> Callable[..., tuple[float, ...]]:
    """`function` for interpreted kernels: it returns `n` numbers, and records the arguments of a failure."""

    def law(*given: Any) -> tuple[float, ...]:
        try:
            numbers = tuple(map(float, function(*given)))
            if len(numbers) != n:
                raise ValueError(f"{counted(len(numbers), 'number')} returned instead of {n}")
        except Exception:
            if np.isnan(failed_at[0]):
                failed_at[:] = given[:-1]
            raise
        return numbers

    return law


def _compiled(given: Any, done: dict[FunctionType, Any]) -> Any:
    """A compiled copy of the function `given` and of the functions of the same file that it calls.

    Indices are checked, unless it is decorated with numba.njit(boundscheck=False).
    """
    from numba import njit

    function: FunctionType = getattr(given, "py_func", given)
    checked = getattr(given, "targetoptions", {}).get("boundscheck") is not False
    for step in dis.get_instructions(function):
        line = (step.positions.lineno if step.positions else None) or 0
        if step.opname == "RAISE_VARARGS":
            advice = 'return float("nan") instead: the run then stops with error 35'
            raise _wrong(f"{function.__name__} raises an exception", advice, function.__code__, line)
        if checked and step.opname in NAMED and step.argval in UNCHECKED:
            advice = "index the array itself, or the result of its method ravel"
            detail = f"numba does not check the indices of {step.argval}"
            raise _wrong(detail, advice, function.__code__, line)
    space = dict(function.__globals__)
    parts = function.__code__, space, function.__name__, function.__defaults__, function.__closure__
    copy = FunctionType(*parts)
    done[function] = njit(error_model="numpy", boundscheck=checked)(copy)
    for name in function.__code__.co_names:
        called = space.get(name)
        plain = getattr(called, "py_func", called)
        if isinstance(plain, FunctionType) and plain.__globals__ is function.__globals__:
            space[name] = done[plain] if plain in done else _compiled(called, done)
    return done[function]


def _not_compiled(name: str, error: Exception, code: CodeType) -> UdecError:
    """Error 34 with the first informative lines of numba's message, at the line of the file in it."""
    message = COLOURS.sub("", str(error))
    reasons = [line.strip() for line in message.splitlines() if line.strip()]
    reasons = [line for line in reasons if not line.startswith(("Failed in", "- "))]
    reason = " ".join(reasons[: 2 if reasons[0].endswith(":") else 1]) if reasons else type(error).__name__
    lines = re.findall(rf'File "[^"]*{re.escape(Path(code.co_filename).name)}", line (\d+)', message)
    advice = "laws are compiled: use numbers, math and NumPy functions, and functions of the same file only"
    return _wrong(f"{name} cannot be compiled: {reason}", advice, code, int(lines[-1]) if lines else 0)


def _are_numbers(returned: Any, n: int) -> bool:
    """True if a compiled type is a tuple of `n` numbers."""
    from numba import types

    kinds = (types.Float, types.Integer, types.Boolean)
    return (
        isinstance(returned, types.BaseTuple)
        and len(returned) == n
        and all(isinstance(types.unliteral(item), kinds) for item in returned)
    )
