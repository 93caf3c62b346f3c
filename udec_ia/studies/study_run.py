"""One run of a study: its input, its result, and the file that keeps the result.

A kept result is used if it was made of the same input (`StudyRun.made_of`). The file ends with a digest of
its content: a damaged one is not used, and its run is repeated.
"""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

from udec_ia.deck import deck_statements
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.deck_variables import Values, Variables
from udec_ia.deck.lines_and_calls import Call, parse
from udec_ia.errors import UdecError
from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.printable_text import MESSAGE, printable
from udec_ia.studies.quantities import DEFAULTS, read_quantities, read_rule
from udec_ia.studies.run_folder import RESULT
from udec_ia.version import __version__

EVERY = 100  # cycles from one check of the rules to the next
ENDED, ERROR, STOPPED, LATE, DIED = "ended", "error", "stopped", "timed out", "died"
PACKAGE = Path(__file__).parent.parent
SEAL = "seal"  # field of the file: SHA-256 of the others


@dataclass(frozen=True)
class StudyRun:
    """The input of a run. It can be sent to another process. Raises ValueError for wrong input.

    name: of its folder, unique in its study. deck: the text. file: how errors name the deck; without it they
    name deck.dat in the folder of the run. values: of variables. quantities: see quantities.py. build,
    constitutive: as for Model; laws are files or names. stop: rules, checked every `every` cycles: the run
    ends with the first that holds. limit: processor seconds without compiling after which the run is ended.
    rehearsal: each CYCLE and SOLVE has one cycle.
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
    rehearsal: bool = False

    def __post_init__(self) -> None:
        scheme(self.build)
        read_quantities(self.quantities)
        for rule in self.stop:
            read_rule(rule)
        if self.every < 1:
            raise ValueError(f"every {self.every} cycles: give 1 or more")
        if self.limit is not None and not 0 < self.limit < math.inf:
            raise ValueError(f"a limit of {self.limit} s: give a number above 0")
        laws = tuple(str(Path(law).absolute()) if Path(law).is_file() else law for law in self.constitutive)
        object.__setattr__(self, "constitutive", laws)

    def observers(self, model: Any) -> list[Any]:
        """More observers of each CYCLE and SOLVE of `model` (execute_run.RunObserver)."""
        return []

    @property
    def made_of(self) -> dict[str, str]:
        """All input that the result depends on, by name; long input as its SHA-256."""
        every = f" every {self.every} cycles" if self.stop else ""
        return {
            "deck": _digest(self.deck.encode()),
            "values": json.dumps({name: str(value) for name, value in sorted(self.values.items())}),
            "build": self.build,
            "input files": json.dumps(_input_files(self)),
            "laws": json.dumps([_law(law) for law in self.constitutive]),
            "quantities": json.dumps(self.quantities),
            "rule to stop": json.dumps(self.stop) + every,
            "rehearsal": str(self.rehearsal),
            "program": f"{__version__} {_program()}",
        }

    def calls(self, *commands: str) -> Iterator[Call]:
        """The statements of these commands, up to STOP or END or what is wrong in the deck."""
        with suppress(UdecError):  # the run ends with it
            for statement in Variables(self.values).filled(statements(self.deck.splitlines(), self.file)):
                if statement.tokens:
                    call = parse(statement)
                    if call.command.ends:
                        return
                    if call.command.name in commands:
                        yield call


@dataclass(frozen=True)
class RunResult:
    """The result of a run.

    status: "ended", "error", "stopped" by a rule, "timed out" at the limit, or "died" if the process did.
    error: its number, 0 without one. message: of the error, or the rule; of a run that ended, what its SOLVEs
    report. quantities: NaN without a value; remarks: why. cycles, time (s): reached. words: of IA() in use.
    seconds: processor time without compiling. made_of: see StudyRun. limit: of the run. warnings: in order.
    of_system: it was ended by something else than its deck: a file that cannot be written, no memory, a
    missing package, a process that died. at_rest: False if a SOLVE ended without reaching its ratio.
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
    made_of: dict[str, str] = field(default_factory=dict)
    limit: float | None = None
    warnings: tuple[str, ...] = ()
    of_system: bool = False
    at_rest: bool = True


def read_deck(path: Path) -> str:
    """The text of the deck in a file. ValueError if the file is not a deck, OSError if it cannot be read."""
    text = deck_statements.read_deck(path)
    check_deck_text(text, printable(str(path), MESSAGE))
    return text


def check_deck_text(text: str, name: str) -> None:
    """ValueError if `text`, which errors call `name`, contains what no text has: a table cannot store it."""
    bad = re.search("[\0\ud800-\udfff]", text)
    if bad is not None:
        line = text.count("\n", 0, bad.start()) + 1
        raise ValueError(f"{name} is not a deck: line {line} contains {bad[0]!r}; give a file of commands")


def write_result(result: RunResult, folder: Path) -> None:
    """Write the result into the folder of its run, which exists. NaN and infinite numbers become text."""
    fields = asdict(result)
    fields["quantities"] = {
        name: value if math.isfinite(value) else str(value) for name, value in result.quantities.items()
    }
    text = json.dumps(fields | {SEAL: _seal(fields)}, indent=1)
    (folder / RESULT).write_text(text + "\n", encoding="utf-8")


def kept_result(run: StudyRun, folder: Path) -> tuple[RunResult | None, str]:
    """The result of `run` in its folder in `folder`; or None and why it is not used, "" if there is none."""
    try:
        fields = json.loads((folder / run.name / RESULT).read_text(encoding="utf-8"))
        if fields.pop(SEAL, "") != _seal(fields):
            raise ValueError("damaged")
        fields["quantities"] = {name: float(value) for name, value in fields["quantities"].items()}
        result = RunResult(**fields | {name: tuple(fields[name]) for name in ("remarks", "warnings")})
    except FileNotFoundError:
        return None, ""
    except (OSError, ValueError, TypeError, AttributeError, RecursionError):
        return None, "the result cannot be read"
    made_of = run.made_of
    changed = [name for name in made_of if result.made_of.get(name) != made_of[name]]
    if result.status == LATE and (run.limit is None or run.limit > (result.limit or 0)):
        changed.append("limit")
    if changed:
        return None, f"{' and '.join(changed)} changed"
    if result.of_system:
        return None, "the system had failed"
    return replace(result, name=run.name, values=dict(run.values)), ""


def _seal(fields: dict[str, Any]) -> str:
    return _digest(json.dumps(fields, sort_keys=True).encode())


def _input_files(run: StudyRun) -> list[str]:
    """SHA-256 of files of functions, and of restart files with absolute paths; others are the deck's own."""
    paths = [Path(call.named.get("path", "")) for call in run.calls("restart")]
    files = [path for path in paths if path.is_absolute()]
    files += [Path(run.file).parent / call.named.get("path", "") for call in run.calls("function")]
    return [_digest(path.read_bytes()) for path in files if path.is_file()]


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
