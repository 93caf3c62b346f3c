"""The form of a command: its kind, numbers, words and list, and how typed words match keywords (MATCH).

A keyword is printed as in the report: its upper-case letters must be typed, the others may be omitted from
the end. `PROperty` is matched by PRO, PROP and property, not by PR or PROPS. If two keywords match, the first
one in the table is taken: R is Restart, FR is FRaction.

Numbers are named as in the report: names that begin with i to n are integers, all others reals. A command has
numbers, then words in any order, then a list. The method of Model that has its full keyword as its name gets
numbers and list as positional arguments, and words by name.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum, auto
from typing import TypeVar

MANY = 20  # number of choices from which on a form has the name of the argument instead
LIMITS = "x1 x2 y1 y2"  # of a range
SEVERAL = "*"  # a word that sets this is itself a positional argument


@dataclass(frozen=True)
class Word:
    """A keyword among the parameters of a command.

    values: names of the numbers that follow; several are one tuple. One in brackets may be left
    off. repeated: a list of such tuples follows.
    text: the rest of the line follows, as the name of a file. replaces: it stands in place of the list of the
    command, or of its numbers if it has no list. sets: the argument that the word sets; by default the
    keyword itself, in lower case. Without values the word sets True, or its own name if it shares an argument
    with others.
    """

    keyword: str
    values: str = ""
    sets: str = ""
    repeated: bool = False
    text: bool = False
    replaces: bool = False

    @property
    def argument(self) -> str:
        return self.sets or self.keyword.lower()

    @property
    def form(self) -> str:
        """The word as the report prints it: `Material n`."""
        return f"{self.keyword} {self.values}".strip() + (" ..." if self.repeated else "")


class Kind(Enum):
    """The kind of a command: it changes the model, runs cycles, shows something or controls the session."""

    CHANGES = auto()
    RUNS = auto()
    SHOWS = auto()
    SESSION = auto()


CHANGES, RUNS, SHOWS, SESSION = Kind


@dataclass(frozen=True)
class Counts:
    """What the number counts that a command returns, as in `3 blocks deleted, 9 blocks now`.

    thing, done: block, deleted. none: text instead of 0. of_all: the number of all such things follows.
    with_word: a word of the command, and the thing that is counted if it is given.
    """

    thing: str
    done: str
    none: str = "no block in range"
    of_all: bool = False
    with_word: tuple[str, str] = ("", "")


@dataclass(frozen=True)
class Command:
    """A command of the language.

    counts: what the number counts that its method returns; None if it is for Python only. numbers, optional:
    names of the numbers. first: the argument that its first word must set; first_error: if it does not.
    list: names of one tuple of the list at the end. text: name of a parameter that is the rest of the line
    without the last word, if that is one of `words`; needs_text: it must be given. opens: may come before
    START. begins: replaces the model. ends: ends the run. writes_words: writes any word of the array, by name
    or by address. of_all: without a range it is about everything. when_empty: what is shown if it finds
    nothing. ours: the part of the command that is not in Appendix I-1.
    """

    keyword: str
    kind: Kind
    help: str
    example: str
    numbers: str = ""
    optional: str = ""
    words: tuple[Word, ...] = ()
    first: str = ""
    first_error: int = 10
    list: str = ""
    text: str = ""
    needs_text: bool = False
    opens: bool = False
    begins: bool = False
    ends: bool = False
    writes_words: bool = False
    of_all: bool = False
    counts: Counts | None = None
    when_empty: str = ""
    ours: str = ""

    @property
    def name(self) -> str:
        """The full keyword in lower case: the name of the method of Model."""
        return self.keyword.lower()

    @property
    def is_work(self) -> bool:
        """True if the command changes the model, runs it, or puts another in its place."""
        return self.kind in (CHANGES, RUNS) or self.begins

    @property
    def has_range(self) -> bool:
        """True if the first four numbers are a range, in whose place words may stand."""
        return self.numbers.startswith(LIMITS)

    @property
    def extends(self) -> bool:
        """True if the command takes a list, for which one line is often too short."""
        return bool(self.list) or any(word.repeated for word in self.words)

    @property
    def form(self) -> str:
        """The command as the report prints it, optional parts in brackets."""
        others = "".join(f" | {word.form}" for word in self.words if word.replaces)
        numbers = self.numbers if self.list else self.numbers + others
        numbers = f"[{numbers}]" if self.of_all else numbers
        parts = [self.keyword, numbers, *(f"[{name}]" for name in self.optional.split())]
        parts += [self.text if self.needs_text else f"[{self.text}]"] if self.text else []
        for argument in dict.fromkeys(word.argument for word in self.words if not word.replaces):
            forms = [word.form for word in self.words if word.argument == argument]
            if argument == SEVERAL:
                parts += forms
            else:
                choice = " | ".join(forms) if len(forms) < MANY else argument
                parts.append(choice if argument == self.first else f"[{choice}]")
        parts += [f"{self.list} ...{others}"] if self.list else []
        return " ".join(part for part in parts if part)


N = TypeVar("N", Command, Word)


def required(keyword: str) -> str:
    """The letters of `keyword` that must be typed: those up to its last upper-case one."""
    return keyword.rstrip("abcdefghijklmnopqrstuvwxyz")


def matches(keyword: str, typed: str) -> bool:
    """True if `typed` has all required letters of `keyword`, and no others than its own."""
    return (
        typed.isascii() and len(typed) >= len(required(keyword)) and keyword.upper().startswith(typed.upper())
    )


def match(table: Iterable[N], typed: str) -> N | None:
    """The first entry of `table` whose keyword matches `typed` (MATCH, Appendix III-3), or None."""
    return next((entry for entry in table if matches(entry.keyword, typed)), None)
