"""The debugger's commands that look into the memory where one stands: those of the workshop."""

from __future__ import annotations

import cmd
from collections.abc import Callable
from typing import Any

from udec_ia.checker import check
from udec_ia.debug.session import Debugger
from udec_ia.heap_tools.heap_dump import ALONE, common, dump
from udec_ia.heap_tools.heap_lookup import walk, what, who
from udec_ia.heap_tools.heap_search import find
from udec_ia.heap_tools.memory_use import heap_map, junk
from udec_ia.heap_tools.pointer_graph import graph
from udec_ia.reader.listing import Listing


class Looks(cmd.Cmd):
    """They print what `udec what`, `udec who` ... print of a file.

    A PLACE is 412, block@88 or block@88.KXD.
    """

    debugger: Debugger

    def do_what(self, text: str) -> None:
        """what PLACE: what a word is, and its group."""
        self._look(what, text)

    def do_who(self, text: str) -> None:
        """who PLACE: all words that point there."""
        self._look(who, text)

    def do_walk(self, text: str) -> None:
        """walk LIST [PLACE]: along a list."""
        self._look(walk, text)

    def do_find(self, text: str) -> None:
        """find KIND where CONDITION: groups for which it is true."""
        self.stdout.write(find(self.debugger.atlas, text).as_text())

    def do_dump(self, text: str) -> None:
        """dump [PLACE[-LAST|/COUNT] | common]: words with their fields; all words if nothing is given."""
        atlas = self.debugger.atlas
        found = common(atlas) if text == ALONE else dump(atlas, text or None)
        self.stdout.writelines(f"{line.text}\n" for line in found.lines())

    def do_map(self, _: str) -> None:
        """map: the memory, a letter for each kind of group."""
        self._look(heap_map, "")

    def do_graph(self, text: str) -> None:
        """graph PLACE [DEPTH]: the pointers around a group."""
        self._look(graph, text)

    def do_junk(self, _: str) -> None:
        """junk: how full the memory is."""
        self._look(junk, "")

    def do_check(self, _: str) -> None:
        """check: all violations of the invariants."""
        found = check(self.debugger.array)
        self.stdout.writelines(f"{line}\n" for line in (map(str, found) if found else ("sound",)))

    def _look(self, look: Callable[..., Listing], text: str) -> None:
        given: list[Any] = [int(word) if word.isdecimal() else word for word in text.split()]
        try:
            listing = look(self.debugger.atlas, *given)
        except TypeError:
            raise ValueError(f"{self.lastcmd.split()[0]} takes other arguments: see help") from None
        self.stdout.write(listing.as_text())
