"""The command that finds the factor of safety of the state that a deck or a restart file leads to.

udec fos DECK        udec fos slope.h5 --joints --tolerance 0.002 --jobs 2
"""

from __future__ import annotations

import argparse
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, given, variables, word_scheme
from udec_ia.printable_text import printable

if TYPE_CHECKING:
    from udec_ia.model import Model
    from udec_ia.reader.printed_listing import Listing

VERBS = ("fos",)
TEXT = "run a deck, and find the factor by which strengths can be divided before blocks fail"
COLUMNS = ("factor", "verdict", "cycles", "ratio", "moved", "x", "y", "fallen")


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = command(commands, "fos", TEXT, _fos, _script)
    parser.add_argument("file", type=Path, metavar="FILE", help="a deck, or a restart file")
    parser.add_argument("--range", metavar="WORDS", help="only the strength in this range")
    parser.add_argument("--blocks", action="store_true", help="only the strength inside blocks")
    parser.add_argument("--joints", action="store_true", help="only the strength of joints")
    text = "width of the bracket over the factor (default: 0.01)"
    parser.add_argument("--tolerance", type=float, default=0.01, help=text)
    parser.add_argument("--jobs", type=int, help="processes (default: up to 3, where that saves time)")
    parser.add_argument("--out", type=Path, default=Path(), help="folder for the picture (default: here)")
    word_scheme(parser)
    variables(parser)
    text = "laws, as for udec run; repeatable"
    parser.add_argument("--constitutive", action="append", metavar="LAW", help=text)


def _options(args: argparse.Namespace) -> dict[str, Any]:
    """The arguments of Model.fos."""
    named = {name: getattr(args, name) for name in ("blocks", "joints", "tolerance", "jobs")}
    return {name: value for name, value in named.items() if value not in (None, False)}


def _fos(args: argparse.Namespace) -> Listing:
    from udec_ia.reader.printed_listing import Listing

    found = _model(args).fos(*([args.range] if args.range else []), **_options(args))
    rows = [tuple(getattr(one, name) for name in COLUMNS) for one in found.trials]
    first, *_ = str(found).splitlines()
    head = [first, *(f"written: {printable(str(path))}" for path in found.files)]
    return Listing(head, COLUMNS, rows)


def _model(args: argparse.Namespace) -> Model:
    """The model at the end of the deck, or in the restart file."""
    import h5py

    from udec_ia.model import Model
    from udec_ia.restart.stage_file import is_stage

    if h5py.is_hdf5(args.file) or is_stage(args.file):
        model = Model.restore(args.file, constitutive=args.constitutive)
    else:
        model = Model(build=args.build, out=args.out, constitutive=args.constitutive)
        model.run(args.file, io.StringIO(), values=given(args.set))
    model.out, model.name = args.out, args.file.stem
    return model


def _script(args: argparse.Namespace) -> str:
    arguments = [repr(args.range)] if args.range else []
    arguments += [f"{name}={value!r}" for name, value in _options(args).items()]
    call = f"print(m.fos({', '.join(arguments)}))"
    return "\n".join(["from udec_ia import Model", "m = Model()", f"m.run({str(args.file)!r})", call])
