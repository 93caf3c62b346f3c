"""STAGE: several named states in one file, a ZIP archive of restart files.

The name of the archive and that of a stage, as in `slope-stages.zip/excavated`, stand wherever the name of a
restart file may stand. Any program for ZIP archives extracts the restart files.
"""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from pathlib import Path

from udec_ia.errors import UdecError
from udec_ia.file_replacement import put_in_place
from udec_ia.restart.file_seal import RefusedError

FIRST = "udec_ia-stages"  # the first file in the archive, by which it is known
TEXT = "Restart files of udec_ia, one for each STAGE of a run.\n"
HEADER = 30  # bytes of a ZIP archive before the name of its first file
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")
OTHER = "is no file of stages of udec_ia"


def add_stage(path: Path, name: str, image: bytes, begins: bool = False) -> None:
    """Keep the restart file `image` as stage `name` in the archive `path`, in place of one of that name.

    begins: the archive gets this stage only; others in it are those of an earlier run.
    Error 10 for an impossible name, 31 if the archive cannot be written.
    """
    if not NAME.fullmatch(name) or name == FIRST:
        advice = "a stage has a name of letters, digits and _ . -, 64 at most"
        raise UdecError(10, f"{name!r} cannot be the name of a stage", advice, parameter="name")
    kept: dict[str, bytes] = {}
    if path.is_file():
        try:
            with zipfile.ZipFile(path) as before:
                names = [one for one in before.namelist() if one not in (FIRST, name) and not begins]
                kept = {one: before.read(one) for one in names}
        except (zipfile.BadZipFile, zlib.error) as error:
            raise UdecError(31, f"{path} {OTHER} or is damaged, and stays as it is") from error
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr(FIRST, TEXT, zipfile.ZIP_STORED)
        for one, content in {**kept, name: image}.items():
            archive.writestr(one, content)
    put_in_place(path, buffer.getvalue(), _judge)


def _judge(front: bytes, size: int) -> str:
    """Why a file that begins with `front` is no file of stages; "" if it is one."""
    del size
    return "" if front[HEADER : HEADER + len(FIRST)] == FIRST.encode() else OTHER


def is_stage(path: Path) -> bool:
    """True if `path` names a stage in an archive, as slope-stages.zip/excavated does."""
    return path.parent.suffix == ".zip" and path.parent.is_file()


def read_stage(path: Path) -> bytes:
    """The restart file that is the stage of that name. RefusedError if there is none."""
    try:
        with zipfile.ZipFile(path.parent) as archive:
            names = [one for one in archive.namelist() if one != FIRST]
            if path.name not in names:
                raise RefusedError("does not exist", f"{path.parent.name} has {', '.join(names)}")
            return archive.read(path.name)
    except zipfile.BadZipFile as error:
        raise RefusedError(f"is damaged: {error}") from error
