"""Running a kernel that may ask for memory."""

from __future__ import annotations

from offsets.generated import MFREE, MTOP, NERR, NWANT
from udec_ia.errors import UdecError
from udec_ia.heap.array import MainArray
from udec_ia.heap.words import ALL_SCHEMES


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
        advice = f"run with --mtop of more than {need} words, or without --mtop to let the array grow"
    else:
        advice = f"run with --build {' or '.join(wider)}: 16-bit addresses end at 32767"
    raise UdecError(1, f"{need} words are needed, the main array has {int(ci[MTOP])}", advice)


def require(array: MainArray, words: int) -> None:
    """Make sure that `words` words of fresh memory are there before anything is changed."""
    ci = array.h.ci
    if ci[MFREE] + words - 1 > ci[MTOP]:
        ci[NWANT] = words
        find_room(array)
