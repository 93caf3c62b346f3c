"""A state in the words of another scheme: every number in its field, every pointer to the group it meant.

Sizes and offsets of groups differ with the number of integers in the space of a real, so each group is
written anew, field by field by the table, and all addresses follow (field_translation.py). Groups keep their
order in memory, side by side, and the junk list is empty afterwards. Where FIND takes its words from changes
no result.

IA() keeps its number of words, unless the groups need more or the addresses end before. The tolerances are
those that reals of the new width make of the rounding length, as RESTART asks for.

What does not fit is refused, and reals that lose digits are counted. Nothing else happens to a number: into
wider words and back again is the same state, word for word if there was no junk.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.interpreting import interpreted
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap.word_scheme import Scheme
from udec_ia.heap_tools.field_translation import Translation
from udec_ia.heap_tools.movable_groups import junk_words, movable, name_at
from udec_ia.heap_tools.word_fit import Fit
from udec_ia.heap_tools.written_state import words_of
from udec_ia.kernels.geometry.tolerances import tolset
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts, read_table

TABLE = read_table()


class Rewritten(NamedTuple):
    """A state in other words, and what that has cost its reals.

    old, before, junk: the scheme that it was in, words that were in use, and how many of them were junk.
    """

    array: MainArray
    fit: Fit
    old: Scheme
    before: int
    junk: int


def rewrite(array: MainArray, to: Scheme) -> Rewritten:
    """The state of `array`, which stays as it is, in the words of the scheme `to`.

    Raises Unsound if there are groups that cannot be told apart (movable.py), UdecError 1 if the addresses
    of `to` end before the groups do, and 28 if its integers or reals cannot hold all numbers.
    """
    found = movable(array)
    _check_addresses(found, to)
    work = Translation(words_of(array), TABLE, to, found)
    work.move()
    fresh = MainArray(to, work.room)
    fresh.fixed = array.fixed
    work.write(fresh.h.ia[: work.used])
    common, fit = work.variables(), work.fit
    _check_fit(array, fit, to)
    for field in TABLE.common:
        variable(fresh.h, field)[:] = common[field.name]
    if to.real_bits != array.scheme.real_bits:
        with interpreted():  # it is a few numbers: numba need not be loaded for them
            tolset(fresh.h, fresh.h.cr[g.DTOL])
    return Rewritten(fresh, fit, array.scheme, int(array.h.ci[g.MFREE]) - 1, junk_words(array))


def _check_addresses(found: dict[str, Any], to: Scheme) -> None:
    """Error 1 if the addresses of `to` end before the groups that were `found` do."""
    used = sum(layouts(to.ratio)[kind].size * len(at) for kind, at in found.items())
    if used > to.top_address // to.ratio * to.ratio:
        detail = f"the groups take {used} words of {to.name}, whose last address is {to.top_address}"
        raise UdecError(1, detail, "take wider integers")


def _check_fit(array: MainArray, fit: Fit, to: Scheme) -> None:
    """Error 28 if there are numbers that do not fit."""
    if fit.first is None:
        return
    kind, address, name, value = fit.first
    what = f"{name} of {name_at(array, address)}" if kind else name
    if isinstance(value, int):
        limits = np.iinfo(to.int_type)
        holds = f"{to.int_bits}-bit integers hold {limits.min} to {limits.max}"
    else:
        holds = f"{to.real_bits}-bit reals hold numbers up to {np.finfo(to.real_type).max:.2g}"
    more = f", the first of {fit.misfits} numbers that these words cannot hold" if fit.misfits > 1 else ""
    raise UdecError(28, f"{what} is {value}{more}", f"{holds}: take wider words")
