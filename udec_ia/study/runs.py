"""One run of a study: what goes into it, and what comes out.

What comes out depends on nothing but what has gone in, and on the program. So a result that was kept stands
for the run, as long as it says of itself that it was made of the same things (`Run.made_of`): keeping.py.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from udec_ia.deck.deck_statements import statements
from udec_ia.deck.deck_variables import Values, Variables
from udec_ia.deck.lines_and_calls import command_of, parse
from udec_ia.errors import UdecError
from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.running.observer import Observer
from udec_ia.study.reading import DEFAULTS, read, read_rule
from udec_ia.version import __version__

DECK = "deck.dat"  # in the folder of a run
EVERY = 100  # cycles between two looks whether to stop
ENDED, ERROR, STOPPED, LATE, DIED = "ended", "error", "stopped", "timed out", "died"
STATUSES = (ENDED, ERROR, STOPPED, LATE, DIED)
PACKAGE = Path(__file__).parent.parent


@dataclass(frozen=True)
class Run:
    """What goes into a run. It can be sent to another process.

    name: of its folder, and no other's in its study. deck: the text. file: what errors call the deck; without
    it they name deck.dat in the folder of the run. values: of variables. quantities: as they are written
    (reading.py). build, constitutive: as for Model; laws are files or names. stop: rules, looked at
    every `every` cycles: the run ends with the first that holds. limit: processor seconds without compiling,
    after which the run is ended. Raises ValueError for quantities and rules that cannot be understood, and
    for a word scheme, looks and limits that are none.
    """

    name: str
    deck: str
    file: str = ""
    values: Values = field(default_factory=dict)
    quantities: tuple[str, ...] = DEFAULTS
    build: str = DEFAULT_SCHEME
    constitutive: tuple[str, ...] = ()
    stop: tuple[str, ...] = ()
    every: int = EVERY
    limit: float | None = None

    def __post_init__(self) -> None:
        scheme(self.build)
        read(self.quantities)
        for rule in self.stop:
            read_rule(rule)
        if self.every < 1:
            raise ValueError(f"every {self.every} cycles: give 1 or more")
        if self.limit is not None and not 0 < self.limit < math.inf:
            raise ValueError(f"a limit of {self.limit} s: give a number above 0")
        laws = tuple(str(Path(law).absolute()) if Path(law).is_file() else law for law in self.constitutive)
        object.__setattr__(self, "constitutive", laws)

    def observers(self, model: Any) -> Sequence[Observer]:
        """What looks on at each CYCLE or SOLVE of its model, besides: other studies see more."""
        return ()

    @property
    def made_of(self) -> dict[str, str]:
        """All that its result depends on, by what it is called; what is long as its SHA-256."""
        looks = f" every {self.every} cycles" if self.stop else ""
        return {
            "deck": _digest(self.deck.encode()),
            "values": json.dumps({name: str(value) for name, value in sorted(self.values.items())}),
            "build": self.build,
            "restart files": json.dumps(_restart_files(self)),
            "laws": json.dumps([_law(law) for law in self.constitutive]),
            "quantities": json.dumps(self.quantities),
            "rule to stop": json.dumps(self.stop) + looks,
            "program": f"{__version__} {_program()}",
        }


@dataclass(frozen=True)
class Result:
    """What has come of a run.

    status: "ended", "error", "stopped" by a rule, "timed out" at the limit, or "died" if the process did.
    error: number of the error, 0 for none or one without a number. message: of the error, or the rule; of a
    run that ended what its SOLVEs have to say, "" for nothing. quantities: in the order of the run's, NaN for
    those without a value. remarks: why they have none. cycles, time (s): done until then. words: of IA() in
    use. seconds: of processor time without compiling; wall_seconds: of the clock, with it. peak_memory: bytes
    that the process had at most, 0 where that is not known. made_of: see Run. limit: of the run. warnings:
    that the program has told, in order. of_system: something else than the deck has ended it: a file that
    cannot be written, no memory, a package that is missing, a process that has died.
    """

    name: str
    values: dict[str, Any]
    status: str
    error: int = 0
    message: str = ""
    quantities: dict[str, float] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    cycles: int = 0
    time: float = 0.0
    words: int = 0
    seconds: float = 0.0
    wall_seconds: float = 0.0
    peak_memory: int = 0
    made_of: dict[str, str] = field(default_factory=dict)
    limit: float | None = None
    warnings: tuple[str, ...] = ()
    of_system: bool = False

    @property
    def outcome(self) -> dict[str, Any]:
        """All of it that does not depend on the machine, with numbers as they are written."""
        machine = ("seconds", "wall_seconds", "peak_memory", "limit")
        return {name: value for name, value in plain(asdict(self)).items() if name not in machine}


def plain(value: Any) -> Any:
    """What JSON has: a number that is none, or infinite, as text."""
    if isinstance(value, Mapping):
        return {name: plain(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _restart_files(run: Run) -> list[str]:
    """SHA-256 of the restart files that the deck names by their whole paths; others are its own."""
    found: list[str] = []
    with suppress(UdecError):  # which the run will end in
        for statement in Variables(run.values).filled(statements(run.deck.splitlines(), run.file)):
            command = command_of(statement)
            if command is not None and command.name == "restart":
                path = Path(parse(statement).named.get("path", ""))
                found += [_digest(path.read_bytes())] if path.is_absolute() and path.is_file() else []
    return found


def _law(law: str) -> str:
    return _digest(Path(law).read_bytes()) if Path(law).is_file() else law


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


@cache
def _program() -> str:
    """Hash of the program."""
    digest = hashlib.sha256()
    for path in sorted(PACKAGE.rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
