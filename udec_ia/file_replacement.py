"""Files are written in one step, and replace only a file of their own kind.

The content goes to a temporary file in the same folder, which is then renamed: the file has the old content
or the new, never a part, whatever ends the program. With `force` it is on the disk before, to survive a power
failure, too.

The program replaces only what it has written. Files of one kind begin alike, so the existing file must begin
as the new one does: a picture does not replace a deck, and nothing replaces a device. The new file has the
mode of the former one, and its owner and group where that is allowed. A link stays; the file that it leads to
is replaced.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import stat
from collections.abc import Callable
from pathlib import Path

from udec_ia.errors import UdecError

FRONT = 512  # bytes that show what a file is
SIGNATURE = 6  # bytes in which PNG, SVG, GIF, HDF5 and our tables differ from each other and from a deck
LEAVE = "a file may only replace one of its own kind: use another name or folder, or move the existing file"
Content = bytes | memoryview
Judge = Callable[[bytes, int], str]


def put_in_place(path: Path, content: Content, judge: Judge | None = None, *, force: bool = True) -> None:
    """Write `content` as the file `path`; its folder is made if it is not there.

    judge: takes the first bytes and the size of the existing file, and returns why it may not be replaced,
    or ""; by default it must begin as `content` does. force: wait until the file is on the disk, which may
    take as long as a thousand cycles. Error 31 if that fails; an existing file is then unchanged.
    """
    try:
        there = _status(path)
        target = Path(os.path.realpath(path))
        if there is None:
            target.parent.mkdir(parents=True, exist_ok=True)
        else:
            _check_replaceable(path, target, there, judge or _alike(path, content))
        _write(target, content, there, force)
    except OSError as error:
        raise UdecError(31, f"{path}: {error.strerror or error}") from error


def check_name(path: Path, content: Content) -> None:
    """Error 31 unless there is no file `path`, or one that begins as `content` does and may be replaced."""
    there = _status(path)
    if there is not None:
        _check_replaceable(path, Path(os.path.realpath(path)), there, _alike(path, content))


def _status(path: Path) -> os.stat_result | None:
    """Status of the file `path`, None if there is none. Error 31 for an impossible name."""
    try:
        return path.stat()
    except FileNotFoundError:
        return None
    except ValueError as error:  # a NUL, or a character that the file system cannot spell
        raise UdecError(31, f"{path} cannot be the name of a file: {error}", "take another name") from error


def _check_replaceable(path: Path, target: Path, there: os.stat_result, judge: Judge) -> None:
    """Error 31 unless the file may be replaced."""
    if not stat.S_ISREG(there.st_mode):
        what = "a folder" if stat.S_ISDIR(there.st_mode) else "a device, a pipe or a socket"
        raise UdecError(31, f"{path} is {what}", LEAVE)
    if not (there.st_mode & 0o222 and os.access(target, os.W_OK)):
        raise UdecError(31, f"{path} is read-only", "use another name, or make it writable")
    with target.open("rb") as file:  # it may have been replaced since
        reason = judge(file.read(FRONT), os.fstat(file.fileno()).st_size)
    if reason:
        raise UdecError(31, f"{path} {reason}, and stays as it is", LEAVE)


def _alike(path: Path, content: Content) -> Judge:
    """Judges by the first bytes, which must be those of `content`."""

    def judge(front: bytes, _: int) -> str:
        alike = front.startswith(bytes(content[:SIGNATURE]))
        return "" if alike else f"exists, but is not a {path.suffix[1:].upper()} file of this program"

    return judge


def _write(target: Path, content: Content, before: os.stat_result | None, force: bool) -> None:
    temporary = target.with_name(f".udec-{secrets.token_hex(8)}.tmp")
    mode = 0o666 if before is None else 0o600  # less what the user's mask forbids
    try:
        with open(temporary, "xb", opener=lambda name, flags: os.open(name, flags, mode)) as file:
            file.write(content)
            if before is not None:
                _keep_rights(temporary, before)
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


def last_number(folder: Path, name: str) -> int:
    """The greatest n for which there is a file name-n.* in `folder`, or 0."""
    numbered = re.compile(rf"{re.escape(name)}-(\d+)\.[^.]+")
    found = (numbered.fullmatch(path.name) for path in (folder.iterdir() if folder.is_dir() else ()))
    return max((int(one[1]) for one in found if one), default=0)


def _keep_rights(file: Path, before: os.stat_result) -> None:
    """Give `file` the mode of what it replaces, and its owner and group as far as that is allowed.

    If the group cannot be kept, the new group gets no rights.
    """
    if hasattr(os, "chown"):
        for owner, group in ((-1, before.st_gid), (before.st_uid, -1)):
            with contextlib.suppress(PermissionError):
                os.chown(file, owner, group)
    same_group = file.stat().st_gid == before.st_gid
    file.chmod(before.st_mode & (0o777 if same_group else 0o707))


def takes_files(folder: Path) -> bool:
    """False if no file can be put into `folder`, as far as is known before it is made."""
    there = next(path for path in (folder.absolute(), *folder.absolute().parents) if path.exists())
    return there.is_dir() and os.access(there, os.W_OK | os.X_OK)


def _sync_folder(folder: Path) -> None:
    """Force the new name to the disk too."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
