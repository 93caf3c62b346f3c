"""A state in the words of another scheme: every number in its field, every pointer to its group.

A word of IA() is known only by its group and field. So every word must be in one group or in the junk list,
and every pointer must lead to a group of the kind that the table gives it. Groups keep their order in memory,
side by side, and the junk list is empty afterwards. IA() keeps its number of words unless the groups need
more or the addresses end before. A number that does not fit is refused, and reals that lose digits are
counted (field_translation.py). The tolerances are those of the rounding length in reals of the new width.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.checker.memory_words import gaps
from udec_ia.compiling.interpreted_kernels import interpreted
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap.word_scheme import Scheme
from udec_ia.heap_tools.field_translation import Fit, Translation
from udec_ia.heap_tools.written_state import words_of
from udec_ia.kernels.geometry.tolerances import tolset
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import layouts
from udec_ia.reader.field_reading import TABLE, TARGETS
from udec_ia.reader.group_lists import Lists
from udec_ia.reader.list_walks import Unsound
from udec_ia.reader.word_map import Atlas, junk_list, names


def groups_in_list_order(array: MainArray) -> dict[str, Any]:
    """Addresses of the groups of every kind, in the order of their lists, those of blocks block by block.

    Raises Unsound unless the groups in use and the junk list fill the heap, each word once, and every pointer
    is 0 or leads to a group of its kind.
    """
    words, free = len(array.h.ia), int(array.h.ci[g.MFREE])
    if not 1 <= free <= words + 1:
        raise Unsound(f"MFREE is {free}, which is no address in an array of {words} words")
    lists = Lists(array)
    found = {group.name: lists.addresses(group.name) for group in TABLE.groups}
    _check_words(array, found)
    _check_pointers(array, lists)
    return found


def junk_words(array: MainArray) -> int:
    """Words of the junk list."""
    return sum(size for chain in junk_list(array.h) for _, size in chain)


def _check_words(array: MainArray, found: dict[str, Any]) -> None:
    """Unsound unless groups and junk groups, in the order of their addresses, lie end to end."""
    layout = layouts(array.scheme.ratio)
    junk = np.array([one for chain in junk_list(array.h) for one in chain], np.int64).reshape(-1, 2)
    at = np.concatenate([*found.values(), junk[:, 0]])
    size = np.concatenate([*(np.full(len(at), layout[kind].size) for kind, at in found.items()), junk[:, 1]])
    order = np.argsort(at)
    for _, after, start in gaps(at[order], size[order], int(array.h.ci[g.MFREE])).tolist():
        if start > after:
            raise Unsound(f"words {after} to {start - 1} are in no group, so their meaning is unknown")
        raise Unsound(
            f"the group that ends at word {after - 1} and the one that begins at {start} share words"
        )


def _check_pointers(array: MainArray, lists: Lists) -> None:
    """Unsound unless every pointer of a group or of the common block is 0 or leads to a group of its kind."""
    for kind, at in lists.address.items():
        for field in TABLE.group(kind).fields:
            targets = TARGETS[str(field.target)] if field.target else ()
            for i in range(field.count if targets else 0):
                for row, value in lists.invalid_pointers(kind, field.name, i, targets, True)[:1]:
                    (owner,) = names(Atlas(array.h), at[row : row + 1])
                    raise Unsound(f"{field.name} of {owner} points to {value}, which is not a {field.target}")
    for field in TABLE.common:
        value = lists.common(field.name) if field.target else 0
        if value and not lists.are_groups(np.array([value]), TARGETS[str(field.target)])[0]:
            raise Unsound(f"{field.name} points to {value}, which is no {field.target}")


class Rewritten(NamedTuple):
    """A state in other words. old: former scheme; before, junk: words in use before, and those of junk."""

    array: MainArray
    fit: Fit
    old: Scheme
    before: int
    junk: int


def rewrite(array: MainArray, to: Scheme) -> Rewritten:
    """The state of `array`, which stays as it is, in the words of the scheme `to`.

    Raises Unsound if there are groups whose kinds cannot be known, UdecError 1 if the addresses
    of `to` end before the groups do, and 28 if its integers or reals cannot hold all numbers.
    """
    found = groups_in_list_order(array)
    _check_addresses(found, to)
    work = Translation(words_of(array), TABLE, to, found)
    work.move()
    fresh = MainArray(to, work.room)
    fresh.fixed = array.fixed
    work.write(fresh.h.ia[: work.used])
    common, fit = work.variables(), work.fit
    _check_fit(fit, to)
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


def _check_fit(fit: Fit, to: Scheme) -> None:
    """Error 28 if there are numbers that do not fit."""
    if fit.first is None:
        return
    name, value = fit.first
    if isinstance(value, int):
        limits = np.iinfo(to.int_type)
        holds = f"{to.int_bits}-bit integers hold {limits.min} to {limits.max}"
    else:
        holds = f"{to.real_bits}-bit reals store numbers up to {np.finfo(to.real_type).max:.2g}"
    more = f", the first of {fit.misfits} numbers that these words cannot hold" if fit.misfits > 1 else ""
    raise UdecError(28, f"{name} is {value}{more}", f"{holds}: take wider words")
