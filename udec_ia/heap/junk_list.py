"""The junk list: groups that were given back, in a chain for each size (report 3.4).

The figure of the junk list (Fig. 6) is lost. Our reading keeps one chain for each size, so that a
request never has to search through groups of other sizes:

    JUNK -> first group of size a  --(word 2)-->  first group of size b  --> ... --> 0
                |(word 0)                              |(word 0)
            next group of size a                   next group of size b
                |                                      |
                0                                      0

Word 0 of a junk group: next junk group of the same size, or 0. Word 1: its size. Word 2: first group
of the next size, or 0; it has a meaning only in the first group of a chain.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.build_choice import offset

JNEXT = offset("JNEXT", (0, 0, 0), "junk group")
JSIZE = offset("JSIZE", (1, 1, 1), "junk group")
JSIZES = offset("JSIZES", (2, 2, 2), "junk group")


def junk_chains(words: Any, first: int) -> list[list[tuple[int, int]]]:
    """The junk list of the words in use, from `first` (JUNK) on, as far as it makes sense.

    For each size the groups of its chain, address and words.
    """
    free, found, seen = len(words) + 1, [], set()
    word, (following, size_at, sizes) = memoryview(words), (at[0] - 1 for at in (JNEXT, JSIZE, JSIZES))
    while 1 <= first < free - JSIZES[0] and first not in seen:
        size, after, chain = word[first + size_at], word[first + sizes], []
        iad = first
        while size > 0 and 1 <= iad <= free - size and iad not in seen:
            seen.add(iad)
            chain.append((iad, size))
            iad = word[iad + following]
        if not chain:
            break
        found.append(chain)
        first = after
    return found


def chains_below(chains: list[list[tuple[int, int]]], first: int) -> list[list[tuple[int, int]]]:
    """The junk groups of `chains`, which are as of `junk_chains`, below the address `first`."""
    below = ([(iad, size) for iad, size in chain if iad < first] for chain in chains)
    return [chain for chain in below if chain]


def link_chains(words: Any, chains: list[list[tuple[int, int]]]) -> int:
    """Link the junk groups of `chains`, which have their sizes (word 1) already, in this order; returns JUNK.

    chains: as of `junk_chains`, none of them empty.
    """
    following, _, sizes = (at[0] - 1 for at in (JNEXT, JSIZE, JSIZES))
    after = 0
    for chain in reversed(chains):
        at = [iad for iad, _ in chain]
        words[np.array(at) + following] = [*at[1:], 0]
        words[at[0] + sizes] = after
        after = at[0]
    return after
