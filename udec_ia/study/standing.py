"""What stands where the table of a study and its pictures are to go: looked at before the runs begin."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from udec_ia.errors import UdecError
from udec_ia.files import check_name
from udec_ia.study.pictures import pictures_of
from udec_ia.study.table import FIRST, files_of

FRONTS = {".csv": FIRST, ".h5": b"\x89HDF\r\n", ".png": b"\x89PNG\r\n", ".svg": b"<?xml "}
DRAWN_BY = b"Matplotlib"  # stands at the beginning of our pictures
BEGINNING = 1024  # bytes of them


def check(paths: Iterable[Path]) -> None:
    """Error 31 unless the files `paths` can be written, as far as that can be told beforehand."""
    for path in paths:
        front = FRONTS[path.suffix]
        try:
            there = _begins(path)
            check_name(path, there if there.startswith(front) else front)
        except OSError as error:
            raise UdecError(31, f"{path}: {error.strerror or error}") from error


def drawn_before(base: Path) -> list[Path]:
    """The pictures that an earlier study has drawn beside its table; [] without one."""
    if not _begins(files_of(base)[0]).startswith(FIRST):
        return []
    return [path for path in pictures_of(base) if DRAWN_BY in _begins(path)]


def _begins(path: Path) -> bytes:
    """The beginning of a file, b"" if there is none that can be read."""
    with suppress(OSError):
        if path.is_file():
            with path.open("rb") as file:
                return file.read(BEGINNING)
    return b""
