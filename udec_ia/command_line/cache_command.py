"""The cache of machine code: its size, clearing it, and compiling before the first run.

udec cache size
udec cache clear
udec cache warm [--build NAME] [--rigid]
"""

from __future__ import annotations

import argparse
import os
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import Call, call_command, word_scheme
from udec_ia.errors import UdecError
from udec_ia.printable_text import counted

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing

VERBS = ("cache",)
TEXT = "machine code on disk: its size, clear it, or warm it, so that the first run does not wait"
MEGABYTE = 1e6
RIGID = """START
PROPERTY MATERIAL=1 DENSITY=2000 KN=1E8 KS=1E8 FRICTION=0.5 BULK=1E8 G=5E7
GRAVITY 0 -10
BLOCK 0,0 0,3 4,3 4,0
SPLIT -1,1 5,1
SPLIT 2,1 2,4
DELETE 2,4 1,3
FIX 0,4 0,1
ROUND 0.1
DAMPING 0.5 10 MASS
CYCLE 2
"""
DEFORMABLE = """BLOCK 0,3 0,4 1,4 1,3
BLOCK 1,3 1,4 2,4 2,3
CHANGE 0,1 3,4 SDEF
GENERATE 1,2 3,4 AUTOMATIC EDGE 1
CYCLE 2
SOLVE 1E-3 LIMIT 2
"""


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    cache = commands.add_parser("cache", help=TEXT, description=TEXT)
    actions = cache.add_subparsers(dest="what", required=True)
    call_command(actions, "size", "the folder of the machine code, and how large it is", _size)
    call_command(actions, "clear", "delete the machine code of all versions", _clear)
    warm = call_command(actions, "warm", "compile what most runs need", _warm)
    word_scheme(warm)
    warm.add_argument("--rigid", action="store_true", help="only what scenes of rigid blocks need")


def _size(_: argparse.Namespace) -> Call:
    return Call("command_line.cache_command.report_size")


def _clear(_: argparse.Namespace) -> Call:
    return Call("command_line.cache_command.delete_code")


def _warm(args: argparse.Namespace) -> Call:
    return Call("command_line.cache_command.compile_common", (args.build, args.rigid))


def _folders() -> tuple[Path, list[Path]]:
    """The folder of the machine code, and that of each version of the sources in it."""
    from udec_ia.compiling.cache_folder import cache_home

    home = cache_home()
    if home.exists() and not home.is_dir():
        raise UdecError(31, f"{home} is no folder", "set UDEC_CACHE to a folder, or unset it")
    found = sorted(home.glob("*-numba*")) if home.is_dir() else []
    return home, [folder for folder in found if folder.is_dir()]


def report_size() -> Listing:
    """The folder of the machine code, and how large it is by version of the sources."""
    from udec_ia.reader.printed_listing import Listing

    home, folders = _folders()
    rows: list[tuple[object, ...]] = []
    for folder in folders:
        sizes = [path.stat().st_size for path in folder.rglob("*.nbc")]
        rows.append((folder.name, len(sizes), round(sum(sizes) / MEGABYTE, 1)))
    return Listing([str(home)], ("version", "routines", "MB"), rows)


def delete_code() -> Listing:
    """Delete the machine code of all versions; it is compiled again when it is needed."""
    from udec_ia.reader.printed_listing import Listing

    home, folders = _folders()
    for folder in folders:
        shutil.rmtree(folder, ignore_errors=True)
    return Listing([f"{home}: {counted(len(folders), 'folder')} deleted"])


def compile_common(build: str, rigid: bool = False) -> Listing:
    """Compile what most runs with the words of `build` need, in this process alone."""
    from udec_ia.compiling.cache_folder import warm_mark
    from udec_ia.compiling.second_compiler import SWITCH, compile_kernels, find_kernels
    from udec_ia.model import Model
    from udec_ia.reader.printed_listing import Listing

    os.environ[SWITCH] = "0"
    with TemporaryDirectory() as out:
        model = Model(build, out=out)
        model.tell = model.inform = lambda _: None
        done = compile_kernels(find_kernels(lambda: model.run(RIGID)))
        if not rigid:
            done += compile_kernels(find_kernels(lambda: model.run(DEFORMABLE)))
    warm_mark(build).touch()
    return Listing([f"{done} routines compiled for {build}"])
