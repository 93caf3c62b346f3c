"""The command `udec`: run a deck, check a restart file, show what is in one, or inspect it word by word.

Exit status: 0 if all went well, 1 after an error, 2 if the command line itself is wrong, 130 after Ctrl-C and
143 after SIGTERM. Both may come at any time, also while modules are being loaded: modules that take long to
load are imported when a command needs them.
"""

from __future__ import annotations

import argparse
import io
import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from threading import current_thread, main_thread
from typing import Any, NoReturn

import udec_ia
from udec_ia.command_line import VERBS as SUBCOMMANDS
from udec_ia.command_line import add_commands
from udec_ia.command_line.command_options import given, variables, word_scheme
from udec_ia.errors import UdecError
from udec_ia.file_replacement import takes_files
from udec_ia.interrupt_signals import SIGNALS, Terminated, allow_signals, defer_signals, terminate
from udec_ia.layout.field_table import StaleLayout
from udec_ia.printable_text import printable, visible

ERROR, MISUSE, INTERRUPTED, TERMINATED = 1, 2, 130, 143
VERBS = ("run", *SUBCOMMANDS)


class _Parser(argparse.ArgumentParser):
    """A parser whose messages repeat no control characters of the arguments to the terminal."""

    def error(self, message: str) -> NoReturn:
        super().error(visible(message))


def arguments() -> argparse.ArgumentParser:
    """The command line."""
    parser = _Parser(
        prog="udec",
        description="The distinct element program UDEC. Alone, it takes commands from the terminal; with the "
        "name of a deck it runs it.",
    )
    parser.add_argument(
        "--checked",
        action="store_true",
        help="compiled routines check every address before they read or write there (slower)",
    )
    parser.add_argument("--version", action="version", version=f"udec_ia {udec_ia.__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    run = commands.add_parser("run", help="run a deck")
    run.add_argument("deck", nargs="?", type=Path, help="file of commands (default: standard input)")
    word_scheme(run)
    run.add_argument(
        "--out", type=Path, help="folder for plots and restart files (default: the current folder)"
    )
    run.add_argument("--mtop", type=int, help="size of the main array in words (default: it grows as needed)")
    run.add_argument(
        "--constitutive",
        action="append",
        metavar="LAW",
        help="laws of constitutive numbers 2 to 5 and of joint models JL2 to JL5: a Python file, "
        "joint-dilation or mohr-coulomb; repeatable",
    )
    variables(run)
    run.add_argument("--animate", action="store_true", help="write an animated picture of the run")
    run.set_defaults(action=_run)
    add_commands(commands)
    return parser


def _run(args: argparse.Namespace) -> int:
    if args.out is not None and not takes_files(args.out):
        print(f"udec: --out {printable(str(args.out))}: files cannot be written there", file=sys.stderr)
        return MISUSE
    from udec_ia.deck.command_monitor import run_deck
    from udec_ia.deck.interactive_session import converse, history, history_file
    from udec_ia.model import Model

    out = args.out or Path()
    try:
        values = given(args.set)
    except ValueError as error:
        print(f"udec: {visible(str(error))}", file=sys.stderr)
        return MISUSE
    try:
        model = Model(build=args.build, mtop=args.mtop, out=out, constitutive=args.constitutive)
    except (ValueError, MemoryError) as error:
        print(f"udec: --mtop {args.mtop}: {error}", file=sys.stderr)
        return MISUSE
    model.animate = args.animate
    model.progress = sys.stdout
    if args.deck is not None:
        model.name = args.deck.stem
    if args.deck is not None:
        run_deck(model, args.deck, sys.stdout, values).stop()
    elif sys.stdin.isatty():
        with history(history_file(), model):
            converse(model, sys.stdout, values=values)
    else:
        run_deck(model, sys.stdin, sys.stdout, values, "stdin").stop()
    return 0


def completed(given: Sequence[str]) -> list[str]:
    """The command line with the `run` that may be left out before the name of a deck."""
    first = given[0] if given else ""
    if first == "--checked":
        return [first, *completed(given[1:])]
    if first in VERBS or first in ("-h", "--help", "--version"):
        return list(given)
    if first and not first.startswith("-") and not os.path.exists(first):
        verbs = ", ".join(f"udec {verb}" for verb in VERBS)
        arguments().error(f"there is no file {printable(first)}, and the commands are {verbs}: udec --help")
    return ["run", *given]


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv` (by default that of the process); returns the exit status."""
    former: dict[int, Any] = {}
    try:
        if current_thread() is main_thread():
            former = {number: signal.getsignal(number) for number in SIGNALS}
            signal.signal(signal.SIGTERM, terminate)
        with defer_signals(), allow_signals():
            return _main(sys.argv[1:] if argv is None else argv)
    except KeyboardInterrupt as interrupt:
        for number in former:  # the process ends anyway
            signal.signal(number, signal.SIG_IGN)
        print(f"\ninterrupted{_saved(interrupt)}", file=sys.stderr)
        return TERMINATED if isinstance(interrupt, Terminated) else INTERRUPTED
    finally:
        for number, handler in former.items():
            if argv is None:  # the process ends here
                signal.signal(number, signal.SIG_IGN)
            elif handler is not None:  # None: not set by Python
                signal.signal(number, handler)


def _saved(interrupt: BaseException | None) -> str:
    """Where a run that was interrupted is saved, however many interrupts came on top of the first."""
    while interrupt is not None:
        if isinstance(interrupt, KeyboardInterrupt) and interrupt.args and interrupt.args[0]:
            return f": the results so far are saved in {visible(interrupt.args[0])}"
        interrupt = interrupt.__context__
    return ""


def _last_of_output() -> None:
    """Flush standard output, or drop it: Python would try again at its end."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _checked() -> bool:
    """Choose the checked build; False if it is too late for that."""
    loaded = sys.modules.get("udec_ia.compiling.build_choice")
    if loaded is None:
        os.environ["UDEC_CHECKED"] = "1"
    return loaded is None or bool(loaded.CHECKED)


def _main(argv: Sequence[str]) -> int:
    for stream in (sys.stdin, sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    line = completed(argv)
    args = arguments().parse_args(line)
    if args.checked and not _checked():
        print(
            "udec: --checked: kernels are already loaded: set UDEC_CHECKED=1 before they are", file=sys.stderr
        )
        return MISUSE
    try:
        status: int = args.action(args)
        sys.stdout.flush()
    except UdecError as error:
        _last_of_output()
        print(visible(str(error)), file=sys.stderr)
        return ERROR
    except StaleLayout as error:
        print(f"udec: {error}", file=sys.stderr)
        return ERROR
    except MemoryError as error:
        _last_of_output()
        detail = str(error).partition(" for an array")[0]
        print(f"udec: there is not enough memory{f': {detail}' if detail else ''}", file=sys.stderr)
        return ERROR
    except BrokenPipeError:  # the reader of the output has gone
        _last_of_output()
        return ERROR
    except OSError as error:
        _last_of_output()
        where = "standard output" if error.filename is None else printable(str(error.filename))
        print(f"udec: {where}: {error.strerror or error}", file=sys.stderr)
        return ERROR
    return status
