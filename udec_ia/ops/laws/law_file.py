"""Laws of the user's: read from plain Python, looked at, and compiled (Appendix IV-4; udec_ia.laws).

Whatever is wrong with a law is error 34, which points at the line of the user's file.
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
from udec_ia.layout.material import Material
from udec_ia.printable_text import counted

NUMBERS = range(FIRST, LAST + 1)
RESULTS = {f"cl{n}": 3 for n in NUMBERS} | {f"clj{n}": 2 for n in NUMBERS}  # how many numbers a law returns
SHIPPED = Path(__file__).parents[2] / "laws"
FORMS = {
    3: "(s11, s12, s22, de11, de12, de22, m) and return ds11, ds12, ds22",
    2: "(fn, fs, dun, dus, un, us, m) and return dfn, dfs",
}
UNCHECKED = ("flat", "as_strided")  # where numba takes any index, whatever it is told
NAMED = ("LOAD_ATTR", "LOAD_METHOD", "LOAD_GLOBAL")
COLOURS = re.compile(r"\x1b\[[0-9;]*m")
Given = str | Path | Mapping[str, Callable[..., Any]]


@dataclass(frozen=True)
class Law:
    """A law that was given: `name` is cl2 ... clj5, `origin` the name of its file.

    digest: SHA-256 of the text of the file. python, address: what stands among the calls of a Laws, for
    kernels that are interpreted and for those that are compiled: the address of its machine code, 0 where
    nothing is. code: owner of the machine code. function: the law itself. noted: the six reals with which it
    has raised an exception, not numbers as long as it has not.
    """

    name: str
    origin: str
    digest: str
    python: Callable[..., tuple[float, ...]]
    address: int
    code: Any
    function: FunctionType
    noted: Any

    def raised(self, material: Material) -> tuple[str, str]:
        """What the law has raised and where, and what it was called with; "" if it has raised nothing."""
        if np.isnan(self.noted[0]):
            return "", ""
        names = inspect.signature(self.function).parameters
        called = ", ".join(f"{name} = {value:.6g}" for name, value in zip(names, self.noted, strict=False))
        return f": {self._reason(material)}", f"correct the law; it was called with {called}"

    def _reason(self, material: Material) -> str:
        """What the Python function raises when it is called as the law was."""
        law, code = _in_python(self.function, RESULTS[self.name], self.noted), self.function.__code__
        try:
            with np.errstate(all="ignore"):
                law(*self.noted, material)
        except Exception as error:
            line = _line(error, code.co_filename) or code.co_firstlineno
            said = " ".join(str(error).split())
            return f"{type(error).__name__}: {said}, in line {line} of {Path(code.co_filename).name}"
        return "an exception that only compiled code raises"


def read_laws(given: Given | Iterable[Given] | None) -> dict[str, Law]:
    """The laws in files, in laws that come with the program, or in mappings from names to functions."""
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
    """The last line of `file` on the way to where `error` was raised; 0 if there is none."""
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    return (lines[-1] if lines else 0) or 0


def _find(name: str | Path) -> Path:
    """The file `name`, or that of the law which comes with the program under this name."""
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


_of_shipped = cache(_of_text)  # they depend on nothing but their text: a process compiles each once


def _of_mapping(functions: Mapping[str, Callable[..., Any]]) -> list[Law]:
    """The laws of a mapping, whose text is that of the functions, as far as Python can tell it."""
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
    """The Python function that was given, or that the given one was compiled from."""
    plain = getattr(function, "py_func", function)
    if not isinstance(plain, FunctionType):
        raise _wrong(f"{name} is not a function", f"a law is a function: def {name}{FORMS[RESULTS[name]]}")
    return plain


def _law(name: str, function: Any, origin: str, digest: str) -> Law:
    """The law `name`, once its arguments, its text and what it returns are seen to be right."""
    plain = _plain(name, function)
    n = RESULTS[name]
    advice = f"a law must take {FORMS[n]}"
    try:
        inspect.signature(plain).bind(*range(7))
    except TypeError as error:
        raise _wrong(f"{name} does not take 7 arguments", advice, plain.__code__) from error
    noted = np.full(6, np.nan)
    python = _in_python(plain, n, noted)
    if DISABLED:
        return Law(name, origin, digest, python, 0, None, plain, noted)
    from udec_ia.compiling.law_calls_numba import MATERIAL, STATE, machine_code

    compiled = _compiled(function, {})
    try:
        compiled.compile((*STATE, MATERIAL))
    except Exception as error:  # numba has more of them than it documents
        raise _not_compiled(name, error, plain.__code__) from error
    (signature,) = compiled.nopython_signatures
    if not _are_numbers(signature.return_type, n):
        detail = f"{name} returns {signature.return_type} instead of {n} numbers"
        raise _wrong(detail, advice, plain.__code__)
    code = machine_code(compiled, n, noted)
    return Law(name, origin, digest, python, code.address, code, plain, noted)


def _in_python(function: FunctionType, n: int, noted: Any) -> Callable[..., tuple[float, ...]]:
    """`function` as Python runs it, to return `n` numbers; as compiled, it notes what it raises for."""

    def law(*given: Any) -> tuple[float, ...]:
        try:
            numbers = tuple(map(float, function(*given)))
            if len(numbers) != n:
                raise ValueError(f"{counted(len(numbers), 'number')} returned instead of {n}")
        except Exception:
            if np.isnan(noted[0]):
                noted[:] = given[:6]
            raise
        return numbers

    return law


def _compiled(given: Any, done: dict[FunctionType, Any]) -> Any:
    """A compiled copy of the function `given`, with what it calls of the same file compiled too.

    Indices are checked, unless its author has decorated it with numba.njit(boundscheck=False).
    """
    from numba import njit

    function: FunctionType = getattr(given, "py_func", given)
    checked = getattr(given, "targetoptions", {}).get("boundscheck") is not False
    for step in dis.get_instructions(function):
        if step.opname == "RAISE_VARARGS":
            advice = 'return float("nan") instead: the run then stops with error 35'
            raise _wrong_step(f"{function.__name__} raises an exception", advice, function, step)
        if checked and step.opname in NAMED and step.argval in UNCHECKED:
            advice = "index the array itself, or the result of its method ravel"
            raise _wrong_step(f"numba does not check the indices of {step.argval}", advice, function, step)
    space = dict(function.__globals__)
    copy = FunctionType(
        function.__code__, space, function.__name__, function.__defaults__, function.__closure__
    )
    done[function] = njit(error_model="numpy", boundscheck=checked)(copy)
    for name in function.__code__.co_names:
        called = space.get(name)
        plain = getattr(called, "py_func", called)
        if isinstance(plain, FunctionType) and plain.__globals__ is function.__globals__:
            space[name] = done[plain] if plain in done else _compiled(called, done)
    return done[function]


def _wrong_step(detail: str, advice: str, function: FunctionType, step: dis.Instruction) -> UdecError:
    """Error 34, at the line of `function` that `step` was made from."""
    line = step.positions.lineno if step.positions else None
    return _wrong(detail, advice, function.__code__, line or 0)


def _not_compiled(name: str, error: Exception, code: CodeType) -> UdecError:
    """Error 34 with the first lines of numba's that say something, at the line of the file that they name."""
    said = [line.strip() for line in COLOURS.sub("", str(error)).splitlines()]
    reasons = [line for line in said if line and not line.startswith(("Failed in", "- "))]
    reason = " ".join(reasons[: 2 if reasons[0].endswith(":") else 1]) if reasons else type(error).__name__
    lines = re.findall(rf'File "[^"]*{re.escape(Path(code.co_filename).name)}", line (\d+)', "\n".join(said))
    advice = "laws are compiled: use numbers, math and NumPy functions, and functions of the same file only"
    return _wrong(f"{name} cannot be compiled: {reason}", advice, code, int(lines[-1]) if lines else 0)


def _are_numbers(returned: Any, n: int) -> bool:
    """True if a compiled type is that of `n` numbers."""
    from numba import types

    kinds = (types.Float, types.Integer, types.Boolean)
    return (
        isinstance(returned, types.BaseTuple)
        and len(returned) == n
        and all(isinstance(types.unliteral(item), kinds) for item in returned)
    )
