"""A remark to the user: a text with a key that stays the same when its words or numbers change."""

from __future__ import annotations

from typing import Any, Self


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
