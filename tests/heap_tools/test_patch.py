"""Words are given values by name: the right ones, all or none, and only if the state is sound with them."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.every_group_kind import GROUPS, every_kind

from udec_ia import Model
from udec_ia.checker import check
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES, scheme
from udec_ia.heap_tools.patch_words import patch
from udec_ia.heap_tools.rewrite_heap import rewrite
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, Group, read_table
from udec_ia.reader.group_tables import table

TABLE = read_table()


@cache
def base(name: str = "i32r64") -> MainArray:
    return every_kind().array if name == "i32r64" else rewrite(base(), scheme(name)).array


def image(array: MainArray) -> tuple[bytes, ...]:
    return tuple(part.tobytes() for part in (array.h.ia, array.h.ci, array.h.cr, array.h.cd))


def address(array: MainArray, kind: str, row: int = 0) -> int:
    return int(table(array, kind)["address"][row])


def forms(array: MainArray) -> dict[str, tuple[str, str, Any]]:
    """What may be written, and the place that it means: kind, field, and a value that is sound there."""
    block, zone = address(array, "block", 2), address(array, "zone", 3)
    same = int(table(array, "zone")["KZG"][3][1])
    return {
        f"block@{block}.KXD = 0.5": ("block", "KXD", 0.5),
        f" Block@{block}.kxd=5D-1 ": ("block", "KXD", 0.5),
        f"block@{block}.KMAT = 7": ("block", "KMAT", 7),
        f"{block + g.KMAT[array.scheme.ratio >> 1]} = 7": ("block", "KMAT", 7),
        f"zone@{zone}.KZG(2) = {same}": ("zone", "KZG", same),
        "FRAC = .25": ("", "FRAC", 0.25),
        "akn(3)=+1.e9": ("", "AKN", 1e9),
        "time = -4": ("", "TIME", -4.0),
        "NMADE = 12": ("", "NMADE", 12),
    }


@pytest.mark.parametrize("name", ALL_SCHEMES)
def test_every_form(name: str) -> None:
    for text, (kind, field, value) in forms(base(name)).items():
        array = base(name).copy()
        (former,) = patch(array, text).former
        assert (former.now, former.what.rpartition(".")[2].split("(")[0]) == (value, field), text
        if kind:
            row = {"block": 2, "zone": 3}[kind]
            assert value in np.atleast_1d(table(array, kind)[field][row])
        assert patch(array, *[text]).former[0].value == value


def faults(array: MainArray) -> dict[str, tuple[int, str]]:
    """What must not be written: the number of the error, and what it says."""
    block, corner = address(array, "block", 2), address(array, "corner", 4)
    last = int(array.h.ci[g.MFREE]) - 1
    history = address(array, "history")
    real = block + array.scheme.ratio * (g.KX[array.scheme.ratio >> 1] - 1)
    over = 2 ** (array.scheme.int_bits - 1)
    return {
        "": (10, "'' is not an assignment"),
        "FRAC": (10, "'FRAC' is not an assignment"),
        "FRAC =": (10, "is not an assignment"),
        "= 4": (10, "is not an assignment"),
        "FRAC = 0.1 = 0.2": (10, "'0.1 = 0.2' is not a number, which FRAC is"),
        "FRAC = nan": (10, "'nan' is not a number"),
        "FRAC = 0.1,": (10, "'' is not an assignment"),
        "FRAK = 0.1": (10, "FRAK is not a variable of the common block"),
        "FRAC(2) = 0.1": (10, "FRAC has no element 2"),
        "AKN = 1": (10, "AKN has 50 elements"),
        "AKN(0) = 1": (10, "AKN has no element 0"),
        "AKN(51) = 1": (10, "AKN has no element 51"),
        "FRAC = 1e999": (28, "FRAC cannot be 1e999"),
        "NBLK = 9223372036854775808": (28, "NBLK cannot be 9223372036854775808"),
        f"block@{block}.KXQ = 1": (10, "KXQ is not a field of a block\nthere are HEAD, KB, "),
        f"block@{block + 1}.KXD = 1": (10, f"there is no block at {block + 1}"),
        f"corner@{block}.KXP = 1": (10, f"there is no corner at {block}\nthat word is in block@{block}"),
        "block@0.KXD = 1": (10, "there is no block at 0"),
        "block@999999999999.KXD = 1": (10, "there is no block at 999999999999"),
        f"brick@{block}.KXD = 1": (10, "brick is not a kind of group"),
        f"block@{block}.KMAT = 1.5": (10, "'1.5' is not an integer, which block@"),
        f"block@{block}.KMAT = {over}": (28, f"block@{block}.KMAT cannot be {over}"),
        f"block@{block}.KMAT = {'9' * 5000}": (28, f"block@{block}.KMAT cannot be 9999"),
        f"block@{block}.KMAT = 51": (
            28,
            f"not be sound: invariant 2: KMAT of block@{block} is 51, not 1 to 50",
        ),
        f"corner@{corner}.KNB = {corner}": (
            28,
            f"KNB of corner@{corner} points to {corner}, which is no block",
        ),
        f"{real} = 1": (10, f"{real} is in the real block@{block}.KX\ngive block@{block}.KX = VALUE"),
        "0 = 1": (30, f"the words in use are 1 to {last}"),
        f"{last + 1} = 1": (30, f"{last + 1}"),
        f"history@{history}.KHN = 3": (10, f"history@{history}.KHN states what was recorded"),
        f"MTOP = {len(array.h.ia) - 4}": (28, "MTOP is"),
        f"MFREE = {len(array.h.ia) + 2}": (28, "MFREE is"),
        "MFREE = 0": (28, "MFREE is 0"),
        "DTOL = 0.049": (28, "tolerances do not follow from the rounding length, 0.049"),
        "IBPNT = 0": (28, "and "),
        f"FRAC = 0.1, block@{block}.KXD = 1, FRAC = 0.2": (10, "FRAC is given two values"),
    }


@pytest.mark.parametrize("name", ["i16r32", "i32r64", "i64r64"])
def test_every_fault_leaves_all_as_it_was(name: str) -> None:
    """Alone, and behind an assignment that would be right."""
    array = base(name).copy()
    before = image(array)
    for text, (number, says) in faults(array).items():
        for assignments in ((text,), ("GRAVY = -3", text)):
            with pytest.raises(UdecError) as caught:
                patch(array, *assignments)
            assert caught.value.number == number, text[:99]
            assert says in str(caught.value), text[:99]
            assert image(array) == before, text[:99]


PLACES = [(group, field, i) for group in GROUPS for field in group.fields for i in range(field.count)]


@settings(max_examples=60)
@given(
    st.sampled_from(PLACES), st.integers(0, 2**20), st.integers(-2, 60), st.floats(-1e3, 1e3), st.booleans()
)
def test_one_word_changes_or_none(
    place: tuple[Group, Field, int], row: int, whole: int, real: float, same: bool
) -> None:
    """Any field of any group: with force the word alone has the value, and without it too if it is sound."""
    group, field, i = place
    array, forced = base().copy(), base().copy()
    rows, before = table(array, group.name), image(array)
    row %= len(rows)
    value = np.atleast_1d(rows[field.name][row])[i].item() if same else real if field.real else whole
    element = f"({i + 1})" if field.count > 1 else ""
    text = f"{group.name}@{rows['address'][row]}.{field.name}{element} = {value!r}"
    if group.name == "history" and field.role == "data" and field.target is None:
        with pytest.raises(UdecError, match="states what was recorded"):
            patch(array, text)
        return
    sound = patch(forced, text, force=True).broken == []
    rows[field.name].reshape(len(rows), -1)[row, i] = value
    assert np.count_nonzero(forced.h.ia != array.h.ia) <= (array.scheme.ratio if field.real else 1)
    if sound:
        patch(array, text)
        assert image(array) == image(forced)
        assert np.array_equal(table(array, group.name)[field.name], rows[field.name])
    else:
        with pytest.raises(UdecError, match="error 28"):
            patch(array, text)
        assert image(array) == before
    assert check(array) == []


# ---- a model


def test_a_model_and_its_deck(tmp_path: Path) -> None:
    """As RSET: noted, obeyed as a whole, and what was found for the last time-step is found anew."""
    m = every_kind()
    m.out = tmp_path
    m.cycle(5)
    block = address(m.array, "block", 3)
    assert m.h.ci[g.LREADY] == 1
    m.patch(f"block@{block}.KXD = 0.25,\n FRAC = 0.05")
    assert m.h.ci[g.LREADY] == 0
    assert m.session.log.lines[-1] == f"PATCH block@{block}.KXD = 0.25, FRAC = 0.05"
    before, deck = image(m.array), m.deck()
    for wrong in (f"block@{block}.KMAT = 99", "FRAC = 0.2, FRAK = 1"):
        with pytest.raises(UdecError):
            m.patch(wrong)
        assert image(m.array) == before
        assert m.deck() == deck
    m.cycle(5)
    again = Model(out=tmp_path / "again")
    again.run(m.deck())
    used = int(m.h.ci[g.MFREE]) - 1
    assert again.h.ia[:used].tobytes() == m.h.ia[:used].tobytes()
    assert again.deck() == m.deck()


def test_a_patch_that_is_taken_back(tmp_path: Path) -> None:
    m = every_kind()
    m.out = tmp_path
    block = address(m.array, "block", 3)
    m.fix(0, 1, 0, 1)
    m.patch(f"block@{block}.KXD = 0.25")
    before = image(m.array)

    def two() -> None:
        m.patch(f"block@{block}.KMAT = 2")
        m.free(0, 1, 0, 1)
        m.split(0, 0, 0, 0)

    with pytest.raises(UdecError):
        m.whole(two)
    assert image(m.array) == before
    assert m.check() == []


def test_a_patch_proves_what_rset_has_touched() -> None:
    """What RSET has bent is in the way of a patch that does not mend it; one that does makes all well."""
    m = every_kind()
    corner = m.table("corner")[4]
    which = m.array.scheme.ratio >> 1
    m.rset(float(corner["KXP"]) + 0.1, int(corner["address"]), g.KXP[which])
    with pytest.raises(UdecError, match="would not be sound"):
        m.patch("FRAC = 0.2")
    m.patch(f"corner@{corner['address']}.KXP = {float(corner['KXP'])!r}")
    m.split(0.5, 0.2, 0.5, 2)
    assert m.check() == []


def test_in_a_deck(tmp_path: Path) -> None:
    m = every_kind()
    m.out = tmp_path
    block = address(m.array, "block", 3)
    m.run(f"PATCH block@{block}.KXD = 0.25, {block + g.KMAT[1]} = 2 ; to the right\n")
    assert m.table("block")[["KXD", "KMAT"]][3].tolist() == (0.25, 2)
    assert m.session.log.lines[-1].startswith("PATCH block@")
    for line, number, column in (("PATCH", 7, 6), ("PATCH FRAK = 2", 10, 7), ("PATCH NBLK = 3", 28, 7)):
        with pytest.raises(UdecError) as caught:
            m.run(line)
        assert (caught.value.number, caught.value.column) == (number, column)
