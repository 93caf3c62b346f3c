"""States in the words of other schemes: against a converter of dicts, to and fro, and going on."""

from __future__ import annotations

import struct
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.census import census
from naive.relocate import differences, essence
from naive.word_schemes import common, put_together, take_apart
from support import random_deformable_scenes as soft_scenes
from support import random_scenes as scenes
from support.every_group_kind import every_kind
from support.mechanics_scenes import colliding
from support.seldom_compiled import compiled_if_usual

from udec_ia import Model
from udec_ia.checker import check
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, iget, puti, putr
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap.word_scheme import ALL_SCHEMES, Scheme, scheme
from udec_ia.heap_tools.convert_word_scheme import convert, settle
from udec_ia.heap_tools.renumber_groups import renumber
from udec_ia.heap_tools.rewrite_heap import rewrite
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, read_table
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import Unsound

TABLE = read_table()
SCHEMES = list(ALL_SCHEMES.values())
MEMORY = {"JUNK", "MFREE", "MTOP"}
TOLERANCES = {f"{letter}TOL" for letter in "ABCDEFGH"} | {"DTOL2"}


@cache
def base(name: str = "i32r64") -> MainArray:
    """Groups of every kind, with junk, before the first cycle, in the words of any scheme."""
    if name == "i32r64":
        return every_kind().array
    return rewrite(base(), scheme(name)).array


def scrambled(array: MainArray, rng: np.random.Generator) -> MainArray:
    """A copy with random numbers in all that is no pointer, no head code and no count of the memory."""
    other = array.copy()
    h, real_type = other.h, other.scheme.real_type
    for kind, at in census(other).items():
        for field in TABLE.group(kind).fields:
            for iad in at if field.role == "data" and field.target is None else ():
                k = getattr(g, field.name)
                if field.real:
                    putr(h, iad, k, real_type.type(number(rng)))
                else:
                    puti(h, iad, k, int(rng.integers(-(2**15), 2**15)))
    for field in TABLE.common:
        values = variable(h, field)
        if field.real and field.name not in TOLERANCES:
            values[:] = [number(rng) for _ in values]
        elif field.role == "data" and field.target is None and field.name not in MEMORY | TOLERANCES:
            values[:] = rng.integers(-(2**62), 2**62)
    h.ci[g.IERAD] = 0
    return other


def number(rng: np.random.Generator) -> float:
    """A real that fits in 32 bits, of any size, too small for all digits at times, or special."""
    if rng.random() < 0.1:
        return float(rng.choice([0.0, -0.0, np.inf, -np.inf, np.nan, 1e-300, 2.0**-140]))
    return float(rng.standard_normal() * 10.0 ** rng.integers(-44, 38))


def used(array: MainArray) -> bytes:
    return array.h.ia[: int(array.h.ci[g.MFREE]) - 1].tobytes()


def check_against_naive(array: MainArray, to: Scheme, made: MainArray) -> None:
    """Every byte of the heap, every variable of the common block."""
    raw, new = put_together(take_apart(array), to.name)
    assert used(made) == raw
    expected = common(array, new, to.name, len(raw) * 8 // to.int_bits)
    for field in TABLE.common:
        if field.name not in TOLERANCES | {"MTOP"}:
            values = variable(made.h, field)
            assert np.array_equal(values, expected[field.name], equal_nan=field.real), field.name
    assert made.h.ci[g.MTOP] == len(made.h.ia)
    assert not made.h.ia[int(made.h.ci[g.MFREE]) - 1 :].any()


@pytest.mark.parametrize("to", SCHEMES, ids=lambda one: one.name)
@pytest.mark.parametrize("name", ALL_SCHEMES)
def test_every_word_is_that_of_the_naive_converter(name: str, to: Scheme) -> None:
    array = base(name)
    check_against_naive(array, to, rewrite(array, to).array)


@settings(max_examples=25)
@given(st.integers(0, 2**32), st.sampled_from([*ALL_SCHEMES]), st.sampled_from(SCHEMES))
def test_whatever_the_numbers_are(seed: int, name: str, to: Scheme) -> None:
    array = scrambled(base(name), np.random.default_rng(seed))
    check_against_naive(array, to, rewrite(array, to).array)


@settings(max_examples=15)
@given(st.integers(0, 2**32), st.sampled_from([*ALL_SCHEMES]), st.sampled_from(SCHEMES))
def test_into_wider_words_and_back_is_the_same_state(seed: int, name: str, to: Scheme) -> None:
    """Word for word, if there was no junk; IA() loses words that are no whole real of the wider scheme."""
    array = scrambled(base(name), np.random.default_rng(seed))
    packed = rewrite(array, array.scheme).array
    if to.real_bits < array.scheme.real_bits or to.int_bits < array.scheme.int_bits:
        return
    back = rewrite(rewrite(packed, to).array, array.scheme).array
    assert used(back) == used(packed)
    assert back.h.ci[g.MTOP] == packed.h.ci[g.MTOP] // to.ratio * to.ratio
    back.h.ci[g.MTOP] = packed.h.ci[g.MTOP]
    assert back.h.ci.tobytes() == packed.h.ci.tobytes()
    assert back.h.cd.tobytes() == packed.h.cd.tobytes()
    assert np.array_equal(back.h.cr, packed.h.cr, equal_nan=True)


@pytest.mark.parametrize("to", ["i16r64", "i64r64"])
def test_the_map_is_the_same(to: str) -> None:
    """By the orders of all lists; in the order of memory, and without junk."""
    array = base()
    assert array.h.ci[g.JUNK] != 0
    made = convert(array, scheme(to))
    assert differences(essence(array), essence(made.array)) == []
    assert (made.broken, check(made.array), made.array.h.ci[g.JUNK]) == ([], [], 0)
    order = [np.argsort([*map(int, np.concatenate([*census(one).values()]))]) for one in (array, made.array)]
    assert np.array_equal(*order)


def test_an_empty_model_and_one_block() -> None:
    empty = Model()
    empty.start()
    one = Model()
    one.block(0, 0, 0, 1, 1, 1, 1, 0)
    for m in (empty, one):
        for to in SCHEMES:
            made = convert(m.array, to)
            assert (made.broken, made.array.scheme) == ([], to)
            assert check(made.array) == []


# ---- going on


def sum_of_states(m: Model) -> list[Any]:
    """All that a run has computed: the map with its numbers, and what was recorded."""
    return [essence(m.array), *(one.numbers for one in m.histories())]


def alike(one: list[Any], two: list[Any]) -> bool:
    return differences(one[0], two[0]) == [] and all(map(np.array_equal, one[1:], two[1:]))


@pytest.mark.parametrize("to", ["i16r64", "i64r64"])
def test_a_run_in_integers_of_another_width_goes_on_to_the_last_bit(to: str, tmp_path: Path) -> None:
    here = every_kind()
    here.out = tmp_path
    here.cycle(30)
    there = Model(to, out=tmp_path / "there")
    there.restart(here.save(tmp_path / "here.h5"))
    there.session.array = convert(here.array, scheme(to)).array
    for m in (here, there):
        with compiled_if_usual(m.array.scheme.name):
            m.cycle(50)
            m.split(-1, 0.7, 1.2, 0.7)
            m.cycle(20)
    assert len(here.histories()[0].numbers) == 11
    assert alike(sum_of_states(here), sum_of_states(there))
    assert there.check() == []


def test_a_cycle_that_stopped_half_way_goes_on_to_the_last_bit(tmp_path: Path) -> None:
    """For want of memory, in any of its passes: in other words and in another order."""
    whole = colliding(tmp_path)
    start, words, cycles = whole.save(), int(whole.h.ci[g.MFREE]) - 1, 2000
    whole.cycle(cycles)
    phases = set()
    for more in range(0, 400, 80):
        m = Model(mtop=words + more, out=tmp_path)
        m.restart(start)
        with pytest.raises(UdecError, match="error 1:"):
            m.cycle(cycles)
        phases.add(int(m.h.ci[g.JPHASE]))
        m.session.array = convert(m.array, scheme("i64r64")).array
        renumber(m.array)
        m.array.refit(None)
        m.cycle(cycles - int(m.h.ci[g.MCTOT]))
        assert differences(essence(m.array), essence(whole.array)) == []
    assert phases - {g.AT_BLOCKS}


@pytest.fixture(scope="module", name="narrow")
def after_cycles_in_narrow_reals(tmp_path_factory: pytest.TempPathFactory) -> Model:
    m = every_kind("i32r32")
    m.out = tmp_path_factory.mktemp("narrow")
    m.cycle(100)
    return m


def fields_of(kind: str) -> tuple[Field, ...]:
    """The fields of a kind of group."""
    return TABLE.group(kind).fields


def test_wider_reals_start_from_the_same_numbers(narrow: Model) -> None:
    """What does not follow from the corners is as it was; what does is so in the new digits."""
    exact = rewrite(narrow.array, scheme("i32r64")).array
    assert check(exact) != []
    made = convert(narrow.array, scheme("i32r64"))
    assert (made.broken, check(made.array)) == ([], [])
    assert "found anew from the corners" in made.head[1]
    one, two = essence(exact), essence(made.array)
    of_water = {"KPP", "WATMAP"} | {field.name for kind in ("water", "pipe") for field in fields_of(kind)}
    changed = {name.split()[0] for name in differences(one, two)}
    assert changed - of_water == {"KXCP", "KYCP", "KRAD", "KBRO", "KCN", "KXC", "KYC"}
    for name in {name for name in differences(one, two) if name.split()[0] not in of_water}:
        assert np.abs(one[name] - two[name]).max() < 100 * np.finfo(np.float32).eps
    assert differences(essence(narrow.array), one) == [*sorted_tolerances(narrow.array, exact)]


def sorted_tolerances(one: MainArray, two: MainArray) -> list[str]:
    """Names of the tolerances that differ, in the order of the table."""
    return [
        f.name for f in TABLE.common if f.real and not np.array_equal(variable(one.h, f), variable(two.h, f))
    ]


def test_wider_reals_go_on(narrow: Model, tmp_path: Path) -> None:
    """Sound in every digit, cut and cycled; near to what the narrow ones do for a while."""
    wide = Model("i32r64", out=tmp_path)
    wide.restart(narrow.save(tmp_path / "narrow.h5"))
    wide.session.array = convert(wide.array, scheme("i32r64")).array
    other = Model.restore(tmp_path / "narrow.h5", out=tmp_path)
    for m in (wide, other):
        m.cycle(20)
        assert m.check() == []
    rounding = 7.0 * float(np.finfo(np.float32).eps)  # of a coordinate, in 32-bit reals
    for name, slack in (("KCN", 4 * rounding), ("KCFN", 4 * rounding * 1e8)):  # KN
        one, two = (m.table("contact")[name] for m in (wide, other))
        assert np.abs(one - two).max() < slack
    wide.split(-1, 0.7, 1.2, 0.7)
    wide.cycle(50)
    assert wide.check() == []


@pytest.mark.parametrize("to", ["i16r32", "i32r32"])
def test_narrower_reals(to: str, tmp_path: Path) -> None:
    """They are sound and go on; the report counts those that have lost digits, and how many digits."""
    m = every_kind()
    m.out = tmp_path
    m.cycle(100)
    made = convert(m.array, scheme(to))
    assert (made.broken, check(made.array)) == ([], [])
    wide = np.concatenate([m.array.h.cr, *(reals(m.array, group.name) for group in TABLE.groups)])
    with np.errstate(under="ignore"):
        back = wide.astype(np.float32).astype(np.float64)
    lost = back != wide
    relative = np.abs((back - wide)[lost] / wide[lost]).max()
    assert made.head[1].startswith(
        f"{np.count_nonzero(lost)} of {len(wide)} reals have lost digits; the largest relative change is "
        f"{relative:.2g}, in K"
    )
    m.save(tmp_path / "wide.h5")
    there = Model(to, out=tmp_path)
    there.restart(tmp_path / "wide.h5")
    there.session.array = made.array
    there.cycle(100)
    assert there.check() == []


def reals(array: MainArray, kind: str) -> Any:
    rows = table(array, kind)
    names = [field.name for field in TABLE.group(kind).fields if field.real]
    return np.concatenate([rows[name].ravel() for name in names]) if names else np.zeros(0)


def test_what_follows_from_the_corners_is_what_round_makes_of_them(narrow: Model) -> None:
    """The kernels' way: ROUND by the same length rounds all corners anew and brings contacts up to them."""
    mine, theirs = (rewrite(narrow.array, scheme("i32r64")).array for _ in range(2))
    settle(mine)
    m = Model("i32r64")
    m.start()
    m.session.array = theirs
    m.round(float(theirs.h.cr[g.DTOL]))
    for kind, names in (("corner", ("KXCP", "KYCP", "KRAD")), ("contact", ("KXC", "KYC", "KCN"))):
        one, two = table(mine, kind), table(m.array, kind)
        assert np.array_equal(one["address"], two["address"])
        for name in names:
            assert np.abs(one[name] - two[name]).max() < 1e-14


def test_coordinates_too_coarse_for_the_rounding_are_told() -> None:
    """Far from the origin 32-bit reals cannot tell a rounding from nothing: ROUND would refuse it there."""
    m = Model()
    m.block(1e5, 0, 1e5, 1, 1e5 + 1, 1, 1e5 + 1, 0)
    m.round(0.05)
    made = convert(m.array, scheme("i32r32"))
    assert "the rounding length is 0.05, and 32-bit reals resolve 0.0119" in str(made.broken[-1])


@pytest.mark.parametrize("seed", [3, 8, 17, 32])
@pytest.mark.parametrize("play", [scenes.play, soft_scenes.play], ids=["rigid", "all types"])
def test_random_scenes_in_reals_of_the_other_width(play: Any, seed: int) -> None:
    """Sound at once and twenty cycles later; narrow ones, unless they are too coarse for the rounding."""
    for name, other in (("i32r32", "i32r64"), ("i32r64", "i32r32")):
        m = Model(name)
        m.tell = lambda _: None
        scene = play(seed, m, cycles=(5, 20))
        made = convert(scene.model.array, scheme(other))
        if made.broken and other == "i32r32":
            assert all("it must be at least" in str(one) for one in made.broken)
            continue
        assert made.broken == []
        there = Model(other)
        there.start()
        there.tell, there.session.array = m.tell, made.array
        if not scene.ended:
            there.cycle(20)
            assert check(there.array) == []


def test_between_two_passes_contacts_are_left_alone() -> None:
    array = base("i32r32").copy()
    array.h.ci[g.JPHASE] = g.AT_CONTACTS
    before = table(array, "contact")["KCN"].astype(float)
    made = convert(array, scheme("i32r64"))
    assert made.array.h.ci[g.JPHASE] == g.AT_CONTACTS
    assert np.array_equal(table(made.array, "contact")["KCN"], before)


# ---- what does not fit


def test_integers_that_do_not_fit() -> None:
    array = base().copy()
    history = int(array.h.ci[g.IHPNT])
    for iad in (history, iget(array.h, history, g.KH)):
        puti(array.h, iad, g.KHN, 100_000)
    with pytest.raises(
        UdecError, match=rf"KHN of history@{history} is 100000, the first of 2 numbers"
    ) as caught:
        convert(array, scheme("i16r64"))
    assert "16-bit integers hold -32768 to 32767" in str(caught.value)


def test_reals_that_do_not_fit() -> None:
    array = base().copy()
    corner = int(table(array, "corner")["address"][5])
    array.h.cr[g.PAR1 + 2] = -1e300
    with pytest.raises(UdecError, match=r"PAR1\(3\) is -1e\+300\n32-bit reals store numbers up to 3.4e\+38"):
        convert(array, scheme("i32r32"))
    putr(array.h, corner, g.KYDP, 1e39)
    with pytest.raises(UdecError, match=rf"KYDP of corner@{corner} is 1e\+39, the first of 2 numbers"):
        convert(array, scheme("i32r32"))
    putr(array.h, corner, g.KYDP, 3.4028235677973366e38)  # just rounds up to infinity
    with pytest.raises(UdecError, match="the first of 2"):
        convert(array, scheme("i16r32"))
    assert getr(convert(array, scheme("i64r64")).array.h, 1, g.KX) == getr(array.h, 1, g.KX)


def test_reals_that_are_too_small_are_counted() -> None:
    array = base().copy()
    array.h.cr[g.PAR1 : g.PAR1 + 3] = 1e-300, 2.0**-149, 2.0**-150  # the second is a number of 32 bits
    made = convert(array, scheme("i32r32"))
    assert made.head[1].endswith("; too small, now 0: 2")
    assert made.array.h.cr[g.PAR1 : g.PAR1 + 3].tolist() == [0, 2.0**-149, 0]


@pytest.mark.parametrize(("name", "to"), [("i32r64", "i32r32"), ("i32r32", "i32r64")])
def test_numbers_that_have_run_away(name: str, to: str) -> None:
    """They are converted, and told to be unsound, or refused; nothing else is raised."""
    rng, told = np.random.default_rng(2), 0
    for _ in range(40):
        array = base(name).copy()
        h, reals = array.h, int(array.h.ci[g.MFREE]) // array.scheme.ratio
        for _ in range(int(rng.integers(1, 4))):
            h.ra[int(rng.integers(reals))] = rng.choice([0.0, -1.0, 1e30, np.nan, np.inf, -1e-30])
        try:
            told += convert(array, scheme(to)).broken != []
        except UdecError:
            continue
    assert told > 5


def test_addresses_that_do_not_fit() -> None:
    m = Model()
    m.block(0, 0, 0, 1, 30, 1, 30, 0)
    for k in range(1, 150):
        m.split(k / 5, -1, k / 5, 2)
    assert m.h.ci[g.MFREE] < 32768
    with pytest.raises(UdecError, match=r"error 1.* words of i16r64, whose last address is 32767"):
        convert(m.array, scheme("i16r64"))


def test_a_fixed_array_stays_as_large_as_the_groups_allow() -> None:
    m = Model(mtop=500)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.split(-1, 0.5, 2, 0.5)
    made = convert(m.array, scheme("i64r64")).array
    assert (len(made.h.ia), made.fixed) == (500, True)
    made = convert(m.array, scheme("i16r64")).array
    assert (len(made.h.ia), made.fixed) == (int(made.h.ci[g.MFREE]) - 1, True)
    assert check(made) == []


@pytest.mark.parametrize("name", ["i16r32", "i64r64"])
def test_a_damaged_heap_is_converted_as_it_is_or_refused(name: str) -> None:
    """Never otherwise: nothing is lost or put right, and nothing is made of what cannot be told apart."""
    array, rng = base(name), np.random.default_rng(5)
    words, done = int(array.h.ci[g.MFREE]) - 1, 0
    for _ in range(200):
        other = array.copy()
        for _ in range(int(rng.integers(1, 4))):
            at = int(rng.integers(words))
            other.h.ia[at] = rng.choice([0, 1, -1, int(rng.integers(words)), 32767, int(other.h.ia[at]) + 1])
        to = SCHEMES[int(rng.integers(len(SCHEMES)))]
        try:
            made = rewrite(other, to).array
        except UdecError:
            continue
        done += 1
        check_against_naive(other, to, made)
    assert 20 < done < 180


def test_a_broken_list_is_named() -> None:
    array = base().copy()
    corner = int(table(array, "corner")["address"][3])
    puti(array.h, corner, g.KNB, corner)
    with pytest.raises(Unsound, match=rf"KNB of corner@{corner}.* points to {corner}, which is not a block"):
        convert(array, scheme("i64r64"))
    array = base().copy()
    bound = int(array.h.ci[g.IBNPNT])
    puti(array.h, bound, g.KU, 0)
    with pytest.raises(Unsound, match=r"words \d+ to \d+ are in no group"):
        convert(array, scheme("i64r64"))


def test_naive_refuses_what_does_not_fit() -> None:
    array = base().copy()
    puti(array.h, int(array.h.ci[g.IHPNT]), g.KHN, 100_000)
    with pytest.raises(struct.error):
        put_together(take_apart(array), "i16r32")
