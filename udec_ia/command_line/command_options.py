"""What all commands have in common: --json, --python, shared arguments, and how they end."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Collection, Sequence
from functools import partial
from importlib import import_module
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from udec_ia.errors import DAMAGED, UdecError
from udec_ia.printable_text import folded, visible

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing, Tables

MISUSE = 2
SECONDS = {"": 1.0, "s": 1.0, "m": 60.0, "h": 3600.0}
Look = Callable[[argparse.Namespace], "Listing | Tables"]
Script = Callable[[argparse.Namespace], str]


def command(commands: Any, verb: str, text: str, look: Look, script: Script) -> argparse.ArgumentParser:
    """A command that prints what `look` finds, or with --python the lines of `script`.

    What these raise as IndexError or ValueError is a wrong argument. The parser that is returned has no
    arguments yet but --json and --python.
    """
    parser: argparse.ArgumentParser = commands.add_parser(verb, help=text, description=text)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument(
        "--python", action="store_true", help="print how to do the same in Python, and do nothing else"
    )
    parser.set_defaults(action=partial(_execute, verb, look, script))
    return parser


class Call(NamedTuple):
    """A call of a function of the library, which is all that a command does.

    function: its name within udec_ia. path: of the restart file whose "array", or the "atlas" of that, is the
    first argument. given, named: the other arguments.
    """

    function: str
    given: tuple[Any, ...] = ()
    named: dict[str, Any] = {}  # noqa: RUF012  never changed
    path: Path | None = None
    subject: str = "atlas"

    def result(self) -> Listing | Tables:
        """What the function returns."""
        module, _, name = self.function.rpartition(".")
        function: Callable[..., Listing | Tables] = getattr(import_module(f"udec_ia.{module}"), name)
        first: list[Any] = []
        if self.path is not None:
            from udec_ia.reader.word_map import Atlas
            from udec_ia.restart import look_into

            array = look_into(self.path)
            first = [Atlas(array.h) if self.subject == "atlas" else array]
        return function(*first, *self.given, **self.named)

    def script(self) -> str:
        """Lines of Python that print the same."""
        module, _, name = self.function.rpartition(".")
        given = [*map(_literal, self.given), *(f"{key}={_literal(one)}" for key, one in self.named.items())]
        lines = [f"from udec_ia.{module} import {name}", ""]
        if self.path is not None:
            given = [self.subject, *given]
            lines = [
                *lines[:1],
                "from udec_ia.reader.word_map import Atlas",
                "from udec_ia.restart import look_into",
                "",
                f"array = look_into({str(self.path)!r})  # of a model: model.array",
                "atlas = Atlas(array.h)",
            ]
        return "\n".join([*lines, f"print({name}({', '.join(given)}).as_text(), end='')"])


def _literal(value: Any) -> str:
    """A value as Python reads it."""
    return f"float('{value}')" if isinstance(value, float) and not isfinite(value) else repr(value)


def call_command(
    commands: Any, verb: str, text: str, call: Callable[[argparse.Namespace], Call]
) -> argparse.ArgumentParser:
    """A command that prints what a function of the library returns."""
    return command(commands, verb, text, lambda args: call(args).result(), lambda args: call(args).script())


def options_given(args: argparse.Namespace, *names: str) -> dict[str, Any]:
    """Those of some options that were given."""
    return {name: vars(args)[name] for name in names if vars(args)[name] is not None}


def file(parser: argparse.ArgumentParser, name: str = "file") -> None:
    """The argument FILE."""
    parser.add_argument(name, type=Path, metavar=name.upper(), help="a restart file, sound or damaged")


def word_scheme(parser: argparse.ArgumentParser) -> None:
    """The argument --build NAME."""
    from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME

    parser.add_argument(
        "--build",
        choices=ALL_SCHEMES,
        default=DEFAULT_SCHEME,
        help="widths of integers and reals in bits (default: %(default)s)",
    )


def variables(parser: argparse.ArgumentParser) -> None:
    """The argument --set NAME=VALUE."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="value of a variable of the deck ($NAME), in place of its DEFAULT; repeatable",
    )


def study_options(parser: argparse.ArgumentParser, quantity: str, out: str) -> None:
    """The arguments that sweep and trade share. quantity: what one is for. out: the default folder."""
    repeated = (
        ("--quantity", "QUANTITY", f'{quantity}, as in "force = max contact.KCFN"'),
        ("--constitutive", "LAW", "as for udec run"),
    )
    for option, metavar, text in repeated:
        parser.add_argument(option, action="append", default=[], metavar=metavar, help=f"{text}; repeatable")
    word_scheme(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help=f"folder for all files (default: {out})")
    parser.add_argument("--jobs", type=int, metavar="N", help="processes (default: one for each processor)")


def names(option: str, text: str | None, known: Collection[str]) -> list[str]:
    """The names in a list with commas, each once; [] without the option. ValueError for unknown ones."""
    if text is None:
        return []
    found = [one.strip() for one in text.split(",")]
    for name in found:
        if name not in known:
            raise ValueError(f"{option} {name or repr(text)}: choose from {', '.join(known)}")
    return [*dict.fromkeys(found)]


def given(texts: Sequence[str]) -> dict[str, str]:
    """The values of --set, by name. ValueError for anything else."""
    found: dict[str, str] = {}
    for text in texts:
        name, equal, value = (part.strip() for part in text.partition("="))
        if not equal:
            raise ValueError(f"--set {text}: give a name and a value, as in --set F=0.4")
        if name.upper() in found:
            raise ValueError(f"--set {text}: {name} has a value already")
        found[name.upper()] = value
    return found


def seconds(option: str, text: str) -> float:
    """Seconds of 60s, 5m or 1h. ValueError for anything else."""
    found = re.fullmatch(r"(\d+\.?\d*)\s*([smh]?)", text.strip())
    if found is None:
        raise ValueError(f"{option} {text}: give a time as in 60s, 5m or 1h")
    return float(found[1]) * SECONDS[found[2]]


def _execute(verb: str, look: Look, script: Script, args: argparse.Namespace) -> int:
    try:
        if args.python:
            print(script(args))
            return 0
        found = look(args)
    except (IndexError, ValueError) as error:
        print(folded(visible(f"udec {verb}: {error}")), file=sys.stderr)
        return MISUSE
    except UdecError as error:
        if error.number == DAMAGED and "file" in args:  # found in the file, not caused by a run
            error.advice = f"udec check {args.file} lists all that is wrong in it"
        raise
    _print(found, args.json)
    return found.status


def _print(found: Listing | Tables, as_json: bool) -> None:
    """In colours to a terminal, as plain text elsewhere; line by line, however long it is."""
    if as_json:
        sys.stdout.writelines(found.json())
        sys.stdout.write("\n")
    elif sys.stdout.isatty():
        from udec_ia.command_line.coloured_listing import show

        show(found, sys.stdout)
    else:
        sys.stdout.writelines(f"{visible(line.text)}\n" for line in found.lines())
