"""Putting a file in its place in one step: its name stands for the old content or the new, not for a part.

The content goes to a temporary file in the same folder, which is renamed. Whatever becomes of the program,
the file is whole; what is to outlast a power failure as well is forced to the disk before.
"""

from __future__ import annotations

import contextlib
import os
import secrets
from pathlib import Path


def put_in_place(path: Path, content: bytes | memoryview, *, force: bool = True) -> None:
    """Write `content` as the file `path`; its folder is made if it is not there. Raises OSError.

    force: wait until it is on the disk, which may take as long as a thousand cycles. A file that stood there
    before is untouched if anything goes wrong.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    target = path.resolve()
    temporary = target.parent / f".udec-{secrets.token_hex(8)}.tmp"
    try:
        with temporary.open("xb") as file:
            file.write(content)
            if force:
                file.flush()
                os.fsync(file.fileno())
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    if force:
        with contextlib.suppress(OSError):  # not every file system can do it; the file itself is whole
            _sync_folder(target.parent)


def takes_files(folder: Path) -> bool:
    """False if no file can be put into `folder`, as far as that can be told before it is made."""
    there = next(path for path in (folder.absolute(), *folder.absolute().parents) if path.exists())
    return there.is_dir() and os.access(there, os.W_OK | os.X_OK)


def _sync_folder(folder: Path) -> None:
    """Force the new name to the disk too."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
