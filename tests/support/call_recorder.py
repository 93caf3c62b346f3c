"""A model that only writes down what it is told, to test the deck language without any mechanics."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from udec_ia import Model
from udec_ia.deck.command_table import COMMANDS
from udec_ia.errors import UdecError

MONITORS_OWN = {"default", "help", "end"}
METHODS = {command.name for command in COMMANDS} - MONITORS_OWN | {"summary"}


class Recorder:
    """Takes every method that a command calls. calls: (name, positional, named) of each call, in order.

    answers: what a method returns. failures: what it raises instead.
    """

    def __init__(self) -> None:
        self.session = self
        self.out = Path("results")
        self.started = False
        self.tell = self.inform = print
        self.explain_step = False
        self.deck_log: list[str] = []
        self.log_lines = self.deck_log.extend
        self.logs_calls = True
        self.calls: list[tuple[str, tuple[Any, ...], dict[str, Any]]] = []
        self.answers: dict[str, object] = {"save": Path("results/rescue.h5")}
        self.failures: dict[str, BaseException] = {}

    help = staticmethod(Model.help)

    def check_file(self, path: Path) -> list[object]:
        return []

    def write_rest_of_pictures(self) -> list[Path]:
        return []

    def whole(self, action: Callable[[], object]) -> object:
        return action()

    def __getattr__(self, name: str) -> Any:
        if name not in METHODS:
            raise AttributeError(name)

        def method(*positional: Any, **named: Any) -> object:
            self.calls.append((name, positional, named))
            if name in self.failures:
                raise self.failures[name]
            if name in ("start", "restart"):
                self.started = True
            return self.answers.get(name)

        return method

    def fails(self, name: str, number: int) -> None:
        """Let the method `name` raise the error `number`."""
        self.failures[name] = UdecError(number)

    @property
    def names(self) -> list[str]:
        """Names of the methods that were called."""
        return [name for name, _, _ in self.calls]
