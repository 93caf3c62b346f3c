"""The checker: silent on a sound map, and sure to name what was damaged."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support.handmade_map import ROUNDING, SIDE, two_blocks

from udec_ia.checker import Violation, check
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, Offset, getr, iget, puti, putr
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap.word_scheme import ALL_SCHEMES, scheme
from udec_ia.heap_tools.patch_words import patch
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, read_table
from udec_ia.reader.list_walks import corners, groups

SCHEMES = tuple(ALL_SCHEMES)
TABLE = read_table()
KINDS = ("block", "corner", "contact", "domain")


def addresses(h: Memory, kind: str) -> list[int]:
    if kind == "corner":
        return [corner for block in groups(h, "block") for corner in corners(h, block)]
    return list(groups(h, kind))


def numbers(found: list[Violation]) -> set[int]:
    return {violation.invariant for violation in found}


def naming(found: list[Violation], *texts: str) -> set[int]:
    """Numbers of the violations whose message has all the texts."""
    return {violation.invariant for violation in found if all(text in str(violation) for text in texts)}


@pytest.mark.parametrize("name", SCHEMES)
def test_sound_maps_have_no_violations(name: str) -> None:
    assert check(two_blocks(name)) == []
    assert check(MainArray(scheme(name))) == []
    assert check(MainArray(scheme(name), mtop=99)) == []


@pytest.mark.parametrize(
    ("name", "value", "printed"),
    [
        ("JPHASE", 9, "JPHASE is 9, not 0 to 4"),
        ("NSPOIL", 1461, "NSPOIL is 1461, which is not the number of an error"),
        ("MTOP", 5, "MTOP is 5, but the main array has"),
        ("DTOL", 0.7, "tolerances do not follow from the rounding length, 0.7"),
        ("CTOL", 0.0, "tolerances do not follow from the rounding length"),
    ],
)
def test_what_a_restart_file_is_refused_for_is_named(name: str, value: float, printed: str) -> None:
    """Of the common block: what routines believe without a further test."""
    array = two_blocks()
    (field,) = (field for field in TABLE.common if field.name == name)
    variable(array.h, field)[0] = value
    assert naming(check(array), printed)


@pytest.mark.parametrize("name", SCHEMES)
def test_junk_is_part_of_a_sound_heap(name: str) -> None:
    array = two_blocks(name)
    taken = [(int(find(array.h, nv)), nv) for nv in (g.NVCR, g.NVCR, g.NVBL, g.NVDO, g.NVCR)]
    assert numbers(check(array)) == {1}  # words in no list are lost
    for group, nv in taken:
        lose(array.h, group, nv)
    assert check(array) == []


def test_a_violation_reads_as_a_sentence() -> None:
    array = two_blocks()
    array.h.ci[g.NBLK] = 3
    (violation,) = check(array)
    assert violation == Violation(5, "NBLK, the number of blocks, is 3, but counting gives 2")
    assert str(violation) == f"invariant 5: {violation.message}"


POINTERS = [
    (kind, field)
    for kind in KINDS
    for field in TABLE.group(kind).fields
    if field.target is not None and field.role != "head"
]
OF_ROLE = {  # which invariants a wrong pointer of a role can break, besides pointing to nothing (2, 6)
    "next": {2},
    "back": {2},
    "member": {2, 3},
    "host": {2, 3, 4},
    "clockwise": {2, 3},
    "clockback": {2, 3},
    "anticlockwise": {2, 3},
    "associate": {2, 3},
    "loop": {2, 4},
    "extension": {1, 2},
    "backlink": {6},
}


@pytest.mark.parametrize("bad", ["nothing", "neighbour", "inside", "beyond", "negative"])
@pytest.mark.parametrize(("kind", "field"), POINTERS, ids=lambda value: getattr(value, "name", value))
def test_a_wrong_pointer_is_named(kind: str, field: Field, bad: str) -> None:
    """0 where it may not be, another group of the same kind, no group: the message names the pointer."""
    for iad in addresses(two_blocks().h, kind):
        array = two_blocks()
        h, offset = array.h, getattr(g, field.name)
        was = iget(h, iad, offset)
        others = [other for other in addresses(h, kind) if other != was]
        value = {
            "nothing": 0,
            "neighbour": others[0],
            "inside": addresses(h, "block")[0] + 2,
            "beyond": len(h.ia) + 1000,
            "negative": -3,
        }[bad]
        if value == was or (bad == "nothing" and field.role in ("extension", "backlink")):
            continue
        puti(h, iad, offset, value)
        found = check(array)
        if bad == "nothing" and field.role == "next":  # a list cut short: its count says so
            assert 5 in naming(found, f"the number of {kind}s")
            continue
        if bad == "inside" and field.name == "KDEX":  # an extension has no head code: it could be there
            assert 1 in naming(found, f"{field.target}@{value}")
            continue
        assert naming(found, field.name, f"@{iad}") & OF_ROLE[field.role], [str(v) for v in found]


REALS = [(kind, field) for kind in KINDS for field in TABLE.group(kind).fields if field.real]


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize(("kind", "field"), REALS, ids=lambda value: getattr(value, "name", value))
def test_a_real_that_is_no_number_is_named(kind: str, field: Field, value: float) -> None:
    for iad in addresses(two_blocks().h, kind)[:2]:
        array = two_blocks()
        putr(array.h, iad, getattr(g, field.name), value)
        expected = 9 if field.name in ("KBFX", "KBFY", "KBFT") else 7
        assert expected in naming(check(array), field.name, f"{kind}@{iad} ")


@pytest.mark.parametrize("field", [f for f in TABLE.common if f.real], ids=lambda field: field.name)
def test_a_common_real_that_is_no_number_is_named(field: Field) -> None:
    array = two_blocks()
    variable(array.h, field)[-1] = np.nan
    assert naming(check(array), field.name, f"({field.count})" if field.count > 1 else "") >= {7}


@pytest.mark.parametrize(
    ("index", "value", "number"),
    [
        (g.NBLK, 3, 5),
        (g.NCON, 1, 5),
        (g.NDOM, 0, 5),
        (g.NVIRT, 1, 5),
        (g.IBPNT, 3, 2),
        (g.IBPNT, 0, 5),
        (g.ICPNT, 10**9, 2),
        (g.IDPNT, 0, 5),
        (g.IODPNT, 0, 2),
        (g.IODPNT, 1, 2),
        (g.MFREE, 100, 1),
        (g.MFREE, -5, 1),
        (g.MFREE, 10**12, 1),
        (g.MTOP, 7, 1),
        (g.JUNK, 5, 1),
        (g.JUNK, -5, 1),
        (g.JUNK, 10**12, 1),
    ],
)
def test_a_wrong_integer_of_the_common_block(index: int, value: int, number: int) -> None:
    array = two_blocks()
    array.h.ci[index] = value
    assert number in numbers(check(array))


Damage = Callable[[Memory], int]  # returns the address that must be named


def first(kind: str, offset: Offset, value: float) -> Damage:
    """A real of the first group of `kind` gets another value."""

    def damage(h: Memory) -> int:
        iad = addresses(h, kind)[0]
        putr(h, iad, offset, value)
        return iad

    return damage


def first_int(kind: str, offset: Offset, value: int) -> Damage:
    """An integer of the first group of `kind` gets another value."""

    def damage(h: Memory) -> int:
        iad = addresses(h, kind)[0]
        puti(h, iad, offset, value)
        return iad

    return damage


def swap_corners(h: Memory) -> int:
    """The outline of the first block is turned over by exchanging the places of two opposite corners."""
    block = addresses(h, "block")[0]
    _, a, _, b = corners(h, block)
    for k in (g.KXP, g.KYP):
        one, two = getr(h, a, k), getr(h, b, k)
        putr(h, a, k, two)
        putr(h, b, k, one)
    return block


def long_rounding(h: Memory) -> int:
    h.cr[g.DTOL] = 0.51 * SIDE
    return addresses(h, "corner")[0]


def virtual_with_force(h: Memory) -> int:
    contact = first_int("contact", g.KCCOD, 4)(h)
    putr(h, contact, g.KCFN, 1.0)
    h.ci[g.NVIRT] = 1
    return contact


def deep(h: Memory) -> int:
    h.cr[g.DTOL2] = -0.01
    return addresses(h, "contact")[0]


DAMAGES: list[tuple[str, Damage, int]] = [
    ("head code of a block", first_int("block", (0, 0, 0), 5), 2),
    ("head code of a corner", first_int("corner", (0, 0, 0), 0), 3),
    ("mass", first("block", g.KBM, -1.0), 7),
    ("inertia", first("block", g.KBI, -1.0), 7),
    ("greatest corner distance", first("block", g.KBRO, 0.5), 7),
    ("material of a block", first_int("block", g.KMAT, 0), 2),
    ("material of a contact", first_int("contact", g.KCM, 51), 2),
    ("law of a block", first_int("block", g.KCONS, 0), 2),
    ("law of a contact", first_int("contact", g.KCC, 6), 2),
    ("corner moved", first("corner", g.KXP, -0.01), 7),
    ("circle moved", first("corner", g.KXCP, ROUNDING + 0.001), 7),
    ("radius", first("corner", g.KRAD, ROUNDING - 0.001), 7),
    ("outline turned over", swap_corners, 7),
    ("edges too short for two roundings", long_rounding, 7),
    ("contact code unknown", first_int("contact", g.KCCOD, 5), 2),
    ("contact code 0", first_int("contact", g.KCCOD, 0), 2),
    ("overlap of the record", first("contact", g.KCN, 0.001), 7),
    ("contact point across", first("contact", g.KXC, 0.11), 7),
    ("contact point along", first("contact", g.KYC, 1.01), 7),
    ("overlap beyond DTOL2", deep, 7),
    ("virtual contact that is no bridge", virtual_with_force, 4),
    ("virtual contact with a force", virtual_with_force, 9),
]


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize(("damage", "number"), [d[1:] for d in DAMAGES], ids=[d[0] for d in DAMAGES])
def test_a_damage_is_named(damage: Damage, number: int, name: str) -> None:
    array = two_blocks(name)
    iad = damage(array.h)
    found = check(array)
    assert number in naming(found, f"@{iad}") | naming(found, f" {iad}"), [str(v) for v in found]


def upper_block(h: Memory) -> tuple[int, list[int]]:
    block = addresses(h, "block")[1]
    return block, corners(h, block)


def shift(h: Memory, dx: float, dy: float) -> None:
    """Move the upper block; nothing else learns of it."""
    block, ring = upper_block(h)
    for iad, pairs in ((block, ((g.KX, g.KY),)), *((c, ((g.KXP, g.KYP), (g.KXCP, g.KYCP))) for c in ring)):
        for kx, ky in pairs:
            putr(h, iad, kx, getr(h, iad, kx) + dx)
            putr(h, iad, ky, getr(h, iad, ky) + dy)


def set_contacts(h: Memory, **values: float) -> None:
    for contact in addresses(h, "contact"):
        for name, value in values.items():
            putr(h, contact, getattr(g, name), value)


@pytest.mark.parametrize("name", SCHEMES)
def test_overlap_must_be_that_of_the_outlines(name: str) -> None:
    array = two_blocks(name)
    shift(array.h, 0.0, -0.25 * ROUNDING)
    assert numbers(check(array)) == {7}
    set_contacts(array.h, KCN=0.25 * ROUNDING, KYC=SIDE - 0.125 * ROUNDING)
    assert check(array) == []
    set_contacts(array.h, KCN=0.2501 * ROUNDING)
    assert len(check(array)) == 2


@pytest.mark.parametrize("name", SCHEMES)
def test_code_must_be_that_of_the_outlines(name: str) -> None:
    """Shifted to the right the left arc of the upper block stands on the edge of the lower: code 3 there."""
    array = two_blocks(name)
    h = array.h
    shift(h, 0.3, 0.0)
    left, right = addresses(h, "contact")
    wrong = check(array)
    assert 7 in naming(wrong, f"contact@{left}") & naming(wrong, f"contact@{right}")
    lower = addresses(h, "block")[0]
    a1, a2, a3, _ = corners(h, lower)
    # on the lower block the left contact leaves the arc of a2 for the edge that ends at a3
    for item, offset, value in (
        (a1, g.KL, a2),
        (a2, g.KLB, a1),
        (a2, g.KL, left),
        (left, g.KLB1, a2),
        (left, g.KL1, right),
        (right, g.KLB1, left),
        (left, g.KCP1, a3),
        (left, g.KCCOD, 3),
        (right, g.KCCOD, 2),
    ):
        puti(h, item, offset, value)
    putr(h, left, g.KXC, 0.3 + ROUNDING)
    # the right contact is now one of the lower block's arc a3 with the bottom edge of the upper block
    b1, b2, b3, b4 = upper_block(h)[1]
    ring = [b1, b2, b3, b4, right, left]
    for i, item in enumerate(ring):
        after, before = ring[(i + 1) % 6], ring[i - 1]
        puti(h, item, g.KL if item not in (left, right) else g.KL2, after)
        puti(h, item, g.KLB if item not in (left, right) else g.KLB2, before)
    puti(h, right, g.KCP2, b1)
    assert check(array) == []
    puti(h, left, g.KCCOD, 1)
    assert 7 in naming(check(array), f"contact@{left}")


def test_contacts_out_of_order_are_named() -> None:
    """A narrow upper block stands with two corners on one edge; the list has the right one first."""
    array = two_blocks()
    h = array.h
    left, right = addresses(h, "contact")
    lower, upper = addresses(h, "block")
    low, up = corners(h, lower), corners(h, upper)
    for corner, x in zip(up, (0.3, 0.3, 0.7, 0.7), strict=True):
        inward = ROUNDING if x == 0.3 else -ROUNDING
        putr(h, corner, g.KXP, x)
        putr(h, corner, g.KXCP, x + inward)
    putr(h, upper, g.KBRO, float(np.hypot(0.2, 0.5)))
    putr(h, upper, g.KBM, 800.0)
    putr(h, upper, g.KBI, 800.0 * (0.4**2 + 1.0) / 12)
    relink(h, lower, [low[0], low[1], left, right, low[2], low[3]])
    for contact, x in ((left, 0.3 + ROUNDING), (right, 0.7 - ROUNDING)):
        puti(h, contact, g.KCCOD, 3)
        puti(h, contact, g.KCP1, low[2])
        putr(h, contact, g.KXC, x)
    assert check(array) == []
    relink(h, lower, [low[0], low[1], right, left, low[2], low[3]])
    assert 3 in naming(check(array), f"contact@{left}", f"contact@{right}")


def relink(h: Memory, block: int, ring: list[int]) -> None:
    """Make `ring` the clockwise list of `block`, which is KB1 of its contacts."""
    contacts = set(addresses(h, "contact"))
    for i, item in enumerate(ring):
        puti(h, item, g.KL1 if item in contacts else g.KL, ring[(i + 1) % len(ring)])
        puti(h, item, g.KLB1 if item in contacts else g.KLB, ring[i - 1])


@pytest.mark.parametrize(("dx", "dy"), [(0.0, -0.02), (0.05, -0.3), (-0.9, -0.08), (0.0, -1.0), (0.37, -0.6)])
def test_overlap_without_a_contact_is_named(dx: float, dy: float) -> None:
    """Both contacts made virtual: whatever overlaps then is overlap without a contact."""
    array = two_blocks()
    h = array.h
    lower, upper = addresses(h, "block")
    shift(h, dx, 0.2)
    for contact in addresses(h, "contact"):
        puti(h, contact, g.KCCOD, 4)
    h.ci[g.NVIRT] = 2
    assert 8 not in numbers(check(array))
    shift(h, 0.0, dy - 0.2)
    assert 8 in naming(check(array), f"block@{lower}", f"block@{upper}")


def test_one_of_two_contacts_missing_is_named() -> None:
    """The upper block is pressed in; the contact on its right is taken for virtual: that place is named."""
    array = two_blocks()
    h = array.h
    shift(h, 0.0, -0.2 * ROUNDING)
    set_contacts(h, KCN=0.2 * ROUNDING, KYC=SIDE - 0.1 * ROUNDING)
    assert check(array) == []
    _, right = addresses(h, "contact")
    puti(h, right, g.KCCOD, 4)
    h.ci[g.NVIRT] = 1
    b4 = upper_block(h)[1][3]
    assert 8 in naming(check(array), f"corner@{b4}")


JUNK_DAMAGES: list[tuple[str, int, int]] = [
    # word of the first junk group, what is written there: its own address is 0 here
    ("a chain that bites its tail", 0, 0),
    ("a size that no group has", 1, 3),
    ("a size that goes on beyond MFREE", 1, -7),
    ("sizes in a circle", 2, 0),
]


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize(("word", "value"), [d[1:] for d in JUNK_DAMAGES], ids=[d[0] for d in JUNK_DAMAGES])
def test_damaged_junk_list(word: int, value: int, name: str) -> None:
    array = two_blocks(name)
    h = array.h
    group = int(find(h, g.NVCR))
    lose(h, group, g.NVCR)
    assert check(array) == []
    h.ia[group - 1 + word] = value or group
    assert 1 in naming(check(array), str(group))


def test_nothing_may_point_into_junk() -> None:
    array = two_blocks()
    h = array.h
    group = int(find(h, g.NVCR))
    lose(h, group, g.NVCR)
    corner = addresses(h, "corner")[0]
    puti(h, corner, g.KNB, group)
    assert 1 in naming(check(array), f"corner@{corner}", f"junk@{group}")


def test_a_group_in_use_may_not_be_junk_too() -> None:
    array = two_blocks()
    corner = addresses(array.h, "corner")[0]
    array.h.ci[g.JUNK] = corner
    array.h.ia[corner] = 20  # KL reads as a legal size
    assert 1 in naming(check(array), f"junk@{corner}")


BOUND = 2.0  # seconds; a sound map of this size takes some milliseconds


def bounded(array: MainArray) -> list[Violation]:
    """What the checker finds, in bounded time: if it had to compile, the second time."""
    for _ in range(2):
        start = perf_counter()
        found = check(array)
        if perf_counter() - start < BOUND:
            return found
    raise AssertionError("the checker takes too long")


def small(name: str) -> MainArray:
    """The two blocks with some junk, in an array as small as it can be: garbage hits something there."""
    array = two_blocks(name)
    for group, nv in [(int(find(array.h, nv)), nv) for nv in (g.NVCR, g.NVDO, g.NVCR)]:
        lose(array.h, group, nv)
    return array


WORDS = st.one_of(st.integers(-3, 600), st.integers(-(2**63), 2**63 - 1))
REALS_OF_ALL_SORTS = st.floats(width=64, allow_nan=True, allow_infinity=True)


def write_anything(array: MainArray, data: Any) -> None:
    h = array.h
    bits = h.ia.itemsize * 8
    for _ in range(data.draw(st.integers(1, 6))):
        what = data.draw(st.sampled_from(("ia", "ia", "ia", "ra", "ci", "cr")))
        target = getattr(h, what)
        used = int(two_blocks(array.scheme.name).h.ci[g.MFREE]) + 8 if what in ("ia", "ra") else len(target)
        at = data.draw(st.integers(0, min(used, len(target)) - 1))
        if what in ("ra", "cr"):
            with np.errstate(over="ignore"):
                target[at] = np.float64(data.draw(REALS_OF_ALL_SORTS)).astype(target.dtype)
        else:
            value = data.draw(WORDS)
            target[at] = value if what == "ci" else (value + 2 ** (bits - 1)) % 2**bits - 2 ** (bits - 1)


@settings(deadline=None, max_examples=200, suppress_health_check=[HealthCheck.too_slow])
@given(name=st.sampled_from(SCHEMES), data=st.data())
def test_no_garbage_stops_the_checker(name: str, data: Any) -> None:
    array = small(name)
    write_anything(array, data)
    before = [part.tobytes() for part in array.h]
    found = bounded(array)
    assert all(1 <= violation.invariant <= 9 and violation.message for violation in found)
    assert [part.tobytes() for part in array.h] == before


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("name", SCHEMES)
def test_nothing_but_garbage(name: str, seed: int) -> None:
    """The whole heap drawn at random, as words of few values, so that many of them are addresses."""
    random = np.random.default_rng(seed)
    array = small(name)
    top = int(array.h.ci[g.MFREE])
    array.h.ia[: top - 1] = random.integers(0, random.choice([8, 50, top]), top - 1)
    found = bounded(array)
    assert found


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("FRAC", -1.0),
        ("ALPHA", -100.0),
        ("BETA", -1e-3),
        ("AMU(1)", -3.0),
        ("DENS(1)", -5.0),
        ("AKN(1)", -1e8),
    ],
)
def test_numbers_of_the_common_block_are_in_their_ranges(name: str, value: float) -> None:
    """What no command would take is told, and a patch with it is refused."""
    array = two_blocks("i32r64")
    with pytest.raises(UdecError, match=r"would not be sound: invariant 5: "):
        patch(array, f"{name} = {value}")
    found = patch(array, f"{name} = {value}", force=True).broken
    assert [
        one for one in found if one.message == f"{name} is {value:g}, not 0 or more" and one.invariant == 5
    ]


def test_what_kinetic_damping_remembers_may_be_negative() -> None:
    """A kinetic energy between two half steps is a product of their velocities."""
    array = two_blocks("i32r64")
    array.h.cd[g.EMOVES] = -1e-3
    assert not check(array)
