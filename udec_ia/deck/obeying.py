"""What the monitor needs of a model, beside a method for every command of the table."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeVar

from udec_ia.heap.accessors import Memory

R = TypeVar("R")


class ObeyingSession(Protocol):
    """What it needs of the session of the model: attributes as in model_session.Session."""

    started: bool
    tell: Callable[[str], None]
    inform: Callable[[str], None]
    explain_step: bool
    logs_calls: bool

    @property
    def out(self) -> Path:
        """The folder for files."""

    def log_lines(self, lines: Sequence[Any]) -> None:
        """Log what was obeyed."""


class Obeying(Protocol):
    """A model; its commands are found by their names."""

    @property
    def session(self) -> ObeyingSession:
        """Where warnings go, and what is logged."""

    @property
    def h(self) -> Memory:
        """The array."""

    def whole(self, action: Callable[[], R]) -> R:
        """Have all that `action` does done, or nothing of it."""

    def why_none(self, command: str, a: float, b: float, c: float, d: float) -> str:
        """Why a command has found nothing."""

    def save(self, path: str | Path | None = None, *, force: bool = False) -> Path:
        """SAVE."""

    def check_file(self, path: str | Path) -> list[Any]:
        """All violations in a restart file."""

    def stop(self) -> str:
        """STOP."""

    def summary(self) -> str:
        """The line that sums up the run."""
