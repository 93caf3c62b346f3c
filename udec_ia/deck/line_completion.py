"""What can follow in a line that is being typed: keywords of commands, their words, and names of files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from udec_ia.deck.command_forms import match
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import WORD
from udec_ia.errors import UdecError
from udec_ia.reader.block_groups import groups_of_blocks
from udec_ia.reader.list_walks import Unsound

DELIMITERS = " \t,=()"  # between the words of a line
LONGEST = 200  # suggestions


def completions(model: Any, before: str, typed: str) -> list[str]:
    """Words that begin as `typed`, which follows `before` in its line.

    The first word is a command. After it come its words, files of a command that takes one, and behind GROUP
    the names of groups. Case follows what was typed.
    """
    words = WORD.findall(before)
    if not words:
        return _beginning(typed, (command.keyword for command in COMMANDS))
    command = match(COMMANDS, words[0])
    if command is None:
        return []
    if words[-1].upper() == "GROUP":
        return _beginning(typed, _groups(model))
    if command.name == "help":
        return _beginning(typed, (one.keyword for one in COMMANDS))
    last = match(command.words, words[-1])
    if last is not None and last.text and last.sets == "path":  # FUNCTION n FILE
        return _files(typed)
    found = _beginning(typed, (word.keyword for word in command.words))
    return found + (_files(typed) if command.text == "path" else [])


def _beginning(typed: str, keywords: Iterable[str]) -> list[str]:
    """Keywords that begin as `typed`, in its case, with a blank behind each."""
    as_typed: Callable[[str], str] = str.lower if typed.islower() else str.upper
    found = dict.fromkeys(as_typed(word) + " " for word in keywords if word.upper().startswith(typed.upper()))
    return [*found][:LONGEST]


def _groups(model: Any) -> list[str]:
    """Names of groups of blocks; none of a damaged array."""
    with suppress(Unsound, UdecError, IndexError, ValueError):
        return [*groups_of_blocks(model.array.h)]
    return []


def _files(typed: str) -> list[str]:
    """Files and folders that begin as `typed`."""
    folder, _, name = typed.rpartition("/")
    try:
        entries = sorted(
            os.scandir(Path(folder or ("/" if typed.startswith("/") else "."))), key=lambda e: e.name
        )
    except OSError:
        return []
    prefix = f"{folder}/" if "/" in typed else ""
    return [
        f"{prefix}{one.name}" + ("/" if one.is_dir() else " ")
        for one in entries
        if one.name.startswith(name) and (name.startswith(".") or not one.name.startswith("."))
    ][:LONGEST]
