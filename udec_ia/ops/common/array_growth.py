"""Memory for kernels that stop for lack of it, and undoing a command that fails half-way."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from udec_ia.compiling.build_choice import forget_kinds
from udec_ia.errors import OVERFLOW, UdecError
from udec_ia.heap.main_array import MainArray, lengthen, words_to_lengthen
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.kernels.links.longer_groups import contact_words, domain_words
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import all_addresses

SPARE_CONTACTS = 64  # contacts that can be made before IA() grows, besides a quarter of those there are


def find_room(array: MainArray) -> None:
    """Provide the memory that a kernel has requested; error 1 if the scheme or --mtop forbids it.

    A request may include a reserve, so the array takes all possible words before the error.
    """
    if array.grow():
        return
    ci = array.h.ci
    if ci[g.MTOP] == array.limit:
        raise _overflow(array)
    ci[g.NWANT] = array.limit - int(ci[g.MFREE]) + 1
    array.grow()


def _overflow(array: MainArray) -> UdecError:
    """Error 1 for a request that cannot be met."""
    ci = array.h.ci
    need = int(ci[g.MFREE] + ci[g.NWANT]) - 1
    ci[g.NWANT] = 0
    if ci[g.NERR] == OVERFLOW:
        ci[g.NERR] = 0
    wider = [
        s.name
        for s in ALL_SCHEMES.values()
        if s.top_address >= need and s.real_bits == array.scheme.real_bits
    ]
    if array.fixed and need <= array.scheme.top_address:
        advice = f"this line needs at least --mtop {need}: omit --mtop to let the array grow"
    else:
        advice = f"run from START with --build {' or '.join(wider)}: 16-bit addresses end at 32767"
    return UdecError(1, f"{need} words are needed, the main array has {int(ci[g.MTOP])}", advice)


def keep_spare(array: MainArray) -> None:
    """Reserve memory for the contacts and domains of the next updates.

    An array that grew within an update would make contacts in another order, which changes the last bit of
    force sums. So it grows before. An array of fixed size, or at its limit, uses its last word instead.
    """
    ci = array.h.ci
    pair = contact_words(array.h) + domain_words(array.h)
    words = min(pair * (SPARE_CONTACTS + int(ci[g.NCON]) // 4), array.limit - int(ci[g.MFREE]) + 1)
    if ci[g.MFREE] + words - 1 > ci[g.MTOP]:
        ci[g.NWANT] = words
        array.grow()
    ci[g.NSPARE] = words if ci[g.MTOP] < array.limit else 0


def require(array: MainArray, words: int) -> None:
    """Provide `words` words of new memory before anything is changed. Error 1 without memory."""
    ci = array.h.ci
    if ci[g.MFREE] + words - 1 > ci[g.MTOP]:
        ci[g.NWANT] = words
        if not array.grow():
            raise _overflow(array)


def lengthen_groups(array: MainArray, flag: str) -> None:
    """Give groups those that lie behind them in scenes with `flag`, once. Error 1, and nothing is changed."""
    if array.h.ci[getattr(g, flag)] == 0:
        order = all_addresses(array)
        require(array, words_to_lengthen(array, order, flag))
        lengthen(array, order, flag)


def refit(array: MainArray, mtop: int | None) -> None:
    """Give the array the fixed size `mtop`, or let it grow if None. Error 1 if it holds more than that."""
    if not array.refit(mtop):
        used = int(array.h.ci[g.MFREE]) - 1
        detail = f"{used} words are in use, and --mtop is {mtop}"
        advice = f"--mtop may be {used} to {array.scheme.top_address}: omit it to let the array grow"
        raise UdecError(1, detail, advice)


@contextmanager
def all_or_nothing(array: MainArray) -> Iterator[None]:
    """Restore the array if a UdecError is raised within this context."""
    h, used = array.h, int(array.h.ci[g.MFREE]) - 1
    parts = h.ia[:used], h.ci, h.cr, h.cd
    before = [part.copy() for part in parts]
    try:
        yield
    except UdecError:
        h.ia[used : int(array.h.ci[g.MFREE]) - 1] = 0  # as FIND leaves what it has not handed out
        for part, old in zip(parts, before, strict=True):
            part[:] = old
        array.h = h
        forget_kinds(h.ia)
        raise
