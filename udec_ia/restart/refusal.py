"""How a restart file is refused: always as error 29, with the name of the file.

Code that reads a file says what is wrong by RefusedError; `refusing` makes error 29 of that, and of
whatever else can go wrong between the disk and the array.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from udec_ia.errors import UdecError

OTHER_FILE = "RESTART reads files written by SAVE: give the name of such a file"
OTHER_TABLE = "was written with another field table: "
OLDER_FILE = "use another restart file, or run the deck again from START"


class RefusedError(Exception):
    """What is wrong with the file (a phrase that follows its name), and what to do about it."""

    def __init__(self, what: str, advice: str = OLDER_FILE) -> None:
        self.what = what
        self.advice = advice
        super().__init__(what)


@contextmanager
def refusing(path: Path) -> Iterator[None]:
    """Let nothing but UdecError 29 leave the block."""
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
