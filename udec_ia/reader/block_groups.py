"""Names of groups of blocks (GROUP), as the words of IA() hold them: two characters in a word."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, integers
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import groups

WORDS = 6
NAME = re.compile(rf"[A-Z][A-Z0-9_.-]{{0,{2 * WORDS - 1}}}")
SHIFT = 128  # a character has 7 bits


def letters_of(name: str) -> list[int]:
    """The words of a name, in which small letters are capital ones. Error 10 for an impossible name."""
    if not NAME.fullmatch(name.upper()):
        advice = f"a group has a name of up to {2 * WORDS} letters, digits and _ . -, a letter first"
        raise UdecError(10, f"{name!r} cannot be the name of a group", advice, parameter="name")
    codes = [*name.upper().encode("ascii"), *[0] * (2 * WORDS - len(name))]
    return [SHIFT * one + two for one, two in zip(codes[::2], codes[1::2], strict=True)]


def groups_of_blocks(h: Memory) -> dict[str, Any]:
    """The addresses of the blocks in each group, by name, in the order of the list."""
    members = np.array(list(groups(h, "member")), np.int64)
    words = np.stack([integers(h, members, g.KIN, i) for i in range(WORDS)], axis=1)
    pairs = np.stack([words // SHIFT, words % SHIFT], axis=2).reshape(len(members), 2 * WORDS)
    names = [bytes(row[row > 0].tolist()).decode("ascii") for row in pairs.astype(np.uint8)]
    blocks = integers(h, members, g.KIB)
    return {name: blocks[[k for k, one in enumerate(names) if one == name]] for name in dict.fromkeys(names)}
