"""A remark to the user: a text with a key that stays the same when its words or numbers change.

A warning is a Python warning of the category UdecWarning, and a record of the log udec_ia.
"""

from __future__ import annotations

import logging
import sys
import warnings
from types import FrameType
from typing import Any, Self

log = logging.getLogger("udec_ia")


class Remark(str):
    """The text of a remark. key: its name, as `step-above-bound`, for programs and tests."""

    __slots__ = ("key",)
    key: str

    def __new__(cls, key: str, text: str) -> Self:
        """A remark with that key and text."""
        remark = super().__new__(cls, text)
        remark.key = key
        return remark

    def __reduce__(self) -> tuple[Any, ...]:
        """Key and text, for pickle and copy."""
        return type(self), (self.key, str(self))


class UdecWarning(UserWarning):
    """A warning of a command. key: its name, as `step-above-bound`, or "" (docs/python.md lists the keys)."""

    def __init__(self, text: str, key: str = "") -> None:
        super().__init__(text, key)
        self.key = key

    def __str__(self) -> str:
        return str(self.args[0])


def give_warning(text: str) -> None:
    """Give a Python warning at the line that called the program, and log it if the log has a handler.

    Without a handler the log would print it on standard error, where Python prints the warning already.
    """
    key = getattr(text, "key", "")
    if log.hasHandlers():
        log.warning(text, extra={"key": key})
    frame: FrameType | None = sys._getframe()
    level = 1
    while frame is not None and frame.f_back is not None and _is_ours(frame):
        frame, level = frame.f_back, level + 1
    warnings.warn(UdecWarning(str(text), key), stacklevel=level)


def _is_ours(frame: FrameType) -> bool:
    """True for a function of this package."""
    return str(frame.f_globals.get("__name__", "")).partition(".")[0] == "udec_ia"
