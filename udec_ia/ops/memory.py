"""Running a kernel that may ask for memory, and going back when something is refused half-way."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from offsets.generated import MFREE, MTOP, NCON, NERR, NSPARE, NVCN, NVDO, NWANT
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import size_of
from udec_ia.heap.array import MainArray
from udec_ia.heap.words import ALL_SCHEMES

SPARE_CONTACTS = 64  # contacts that can be made before IA() grows, besides a quarter of those there are


def find_room(array: MainArray) -> None:
    """Make the room that an interrupted kernel asked for; error 1 if the scheme or --mtop forbids it."""
    if array.grow():
        return
    ci = array.h.ci
    need = int(ci[MFREE] + ci[NWANT]) - 1
    ci[NERR] = ci[NWANT] = 0
    wider = [
        s.name
        for s in ALL_SCHEMES.values()
        if s.top_address >= need and s.real_bits == array.scheme.real_bits
    ]
    if array.fixed and need <= array.scheme.top_address:
        advice = f"this line needs --mtop {need} at least: leave --mtop out to let the array grow"
    else:
        advice = f"run with --build {' or '.join(wider)}: 16-bit addresses end at 32767"
    raise UdecError(1, f"{need} words are needed, the main array has {int(ci[MTOP])}", advice)


def keep_spare(array: MainArray) -> None:
    """Have memory to spare for the contacts and domains of the updates to come.

    An array that grew in the midst of an update would make its contacts in another order, and the order of
    sums is the last bit of a force. So the array grows before: when and how often it does changes nothing.
    An array of fixed size, or one that has reached its limit, uses its last word instead.
    """
    ci = array.h.ci
    if array.fixed:
        ci[NSPARE] = 0
        return
    pair = size_of(array.h, NVCN) + size_of(array.h, NVDO)
    words = pair * (SPARE_CONTACTS + int(ci[NCON]) // 4)
    ci[NSPARE] = words
    if ci[MFREE] + words - 1 > ci[MTOP]:
        ci[NWANT] = words
        if not array.grow():
            ci[NSPARE] = ci[NWANT] = ci[NERR] = 0


def require(array: MainArray, words: int) -> None:
    """Make sure that `words` words of fresh memory are there before anything is changed."""
    ci = array.h.ci
    if ci[MFREE] + words - 1 > ci[MTOP]:
        ci[NWANT] = words
        find_room(array)


@contextmanager
def all_or_nothing(array: MainArray) -> Iterator[None]:
    """Let an error leave the array as it was before the block."""
    before = array.copy()
    try:
        yield
    except UdecError:
        array.h = before.h
        raise
