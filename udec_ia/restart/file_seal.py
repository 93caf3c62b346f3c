"""The seal of a restart file, its first 512 bytes, and how a file is refused: as error 29, with its name.

HDF5 leaves a "user block" at the front of a file to its users. That of a restart file is a readable text
(`head -c 512 FILE`) with the length and SHA-256 of all that follows. It is checked before the HDF5 library
sees the file, because that library trusts what it reads: damaged metadata can make it crash.

Code that reads a file raises RefusedError; `refusing` turns this into error 29, and also all other exceptions
between the disk and the array.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from udec_ia.errors import UdecError

OTHER_FILE = "RESTART reads files written by SAVE: give the name of such a file"
OTHER_TABLE = "was written with another field table: "
OLDER_FILE = "use another restart file, or run the deck again from START"


class RefusedError(Exception):
    """A file cannot be read: what is wrong (a phrase that follows its name), and what to do."""

    def __init__(self, what: str, advice: str = OLDER_FILE) -> None:
        self.what = what
        self.advice = advice
        super().__init__(what)


@contextmanager
def refusing(path: Path) -> Iterator[None]:
    """Turn every exception within into UdecError 29."""
    try:
        yield
    except RefusedError as error:
        raise UdecError(29, f"{path} {error.what}", error.advice) from error
    except OSError as error:
        raise UdecError(29, f"{path} cannot be read: {error.strerror or error}", OTHER_FILE) from error
    except MemoryError as error:
        raise UdecError(29, f"{path} is larger than the available memory", OLDER_FILE) from error
    except Exception as error:  # the HDF5 library has no common base class for its complaints
        what = f"{path} cannot be understood: {type(error).__name__}: {error}"
        raise UdecError(29, what, OLDER_FILE) from error


SIZE = 512  # the smallest user block that HDF5 allows
MAGIC = b"udec_ia restart file\n"
VERSION = (1, 3)  # a reader of major version n reads every minor version of n
HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
TEXT = """\
format {major}.{minor}
bytes {size}
sha256 {digest}
The rest of this file, from byte 512 on, is HDF5: h5dump and h5py open it as it is.
`udec info FILE` says what it holds; docs/restart-format.md describes it.
"""
PATTERN = re.compile(rb"format (\d{1,9})\.(\d{1,9})\nbytes (\d{1,18})\nsha256 [0-9a-f]{64}\n")


def seal(image: memoryview, version: tuple[int, int] = VERSION) -> bytes:
    """The seal for the HDF5 part `image`."""
    major, minor = version
    digest = hashlib.sha256(image).hexdigest()
    text = MAGIC + TEXT.format(major=major, minor=minor, size=len(image), digest=digest).encode()
    return text.ljust(SIZE - 1) + b"\n"


def read_sealed(file: BinaryIO, file_size: int) -> tuple[bytes, tuple[int, int]]:
    """The whole file, seal included, and its format version.

    RefusedError unless every byte is as it was when it was sealed; the version is left to be compared
    with the one in the HDF5 part, since the checksum does not cover it.
    """
    front = file.read(SIZE)
    version = read_front(front, file_size)
    file.seek(0)
    data = file.read(file_size)
    if data[:SIZE] != seal(memoryview(data)[SIZE:], version):
        raise RefusedError("is damaged: its checksum (SHA-256) is wrong")
    return data, version


def read_front(front: bytes, file_size: int) -> tuple[int, int]:
    """The format version, as the seal in the first bytes of a file gives it.

    RefusedError unless they are a seal of a format that this program reads and the file is as long as that
    says.
    """
    if not front:
        raise RefusedError("is empty", OTHER_FILE)
    if front.startswith(HDF5_SIGNATURE):
        raise RefusedError("is an HDF5 file, but not a restart file of udec_ia", OTHER_FILE)
    if front.startswith(b"PK"):
        raise RefusedError(
            "is an archive, perhaps of stages", "name one of its stages, as in slope-stages.zip/rest"
        )
    if front[: len(MAGIC)] != MAGIC[: len(front)]:
        raise RefusedError("is not a restart file of udec_ia", OTHER_FILE)
    if len(front) < SIZE:
        raise RefusedError(f"is cut short: only {len(front)} bytes are there")
    found = PATTERN.match(front, len(MAGIC))
    if found is None:
        raise RefusedError("is damaged: its first lines cannot be read")
    major, minor, size = int(found[1]), int(found[2]), int(found[3])
    if major != VERSION[0]:
        raise RefusedError(
            f"has format {major}.{minor}, and this program reads format {VERSION[0]}",
            "read it with the version of udec_ia that wrote it",
        )
    if file_size < SIZE + size:
        raise RefusedError(f"is cut short: {file_size} of {SIZE + size} bytes are there")
    if file_size > SIZE + size:
        raise RefusedError(f"is damaged: it has {file_size} bytes and should have {SIZE + size}")
    return major, minor
