"""FIND and LOSE with a dict: what the heap's memory management must do, in the plainest way.

Fresh memory is taken from the next free address; a lost group waits on the stack of its size and the one
lost last is found first. Nothing is known here of words or links.
"""

from __future__ import annotations


class Memory:
    """free: next fresh address. top: last address. used, junk: what is where."""

    def __init__(self, top: int) -> None:
        self.free = 1
        self.top = top
        self.used: dict[int, int] = {}
        self.junk: dict[int, list[int]] = {}

    def find(self, size: int) -> int:
        """Address of a group of `size` words, 0 if there is no room."""
        if self.junk.get(size):
            group = self.junk[size].pop()
        elif self.free + size - 1 <= self.top:
            group = self.free
            self.free += size
        else:
            return 0
        self.used[group] = size
        return group

    def lose(self, group: int) -> None:
        """Give the group back."""
        size = self.used.pop(group)
        self.junk.setdefault(size, []).append(group)

    def words(self) -> list[int]:
        """Every word of every group, used or junk, in order: 1, 2, 3, ... if they tile the heap."""
        groups = list(self.used.items()) + [(g, size) for size, stack in self.junk.items() for g in stack]
        return sorted(word for group, size in groups for word in range(group, group + size))
