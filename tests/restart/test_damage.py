"""Single words that are wrong: check() and RESTART name them, whatever kind of group they stand in."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.checker import check, check_links
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, Offset, getr, iget, puti, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.group_tables import table
from udec_ia.restart import load, save

TOOL = Path(__file__).parents[2] / "tools" / "damaged_files.py"


def test_single_words_changed() -> None:
    """A few hundred changes by the tool; it fails for each that should have been refused."""
    done = subprocess.run(
        [sys.executable, str(TOOL), "words", "--changes", "150", "--seed", "7"],
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def sound() -> MainArray:
    """Groups of every kind, and no violation."""
    array = every_kind().array
    assert check(array) == []
    return array


def where(array: MainArray, kind: str, field: str, wanted: bool = True) -> int:
    """The first group of `kind` whose `field` is not 0, or is."""
    rows = table(array, kind)
    return int(rows["address"][(rows[field] != 0) == wanted][0])


def other(array: MainArray, kind: str, address: int, same: str = "", differ: bool = True) -> int:
    """Another group of `kind`; with `same`, one in which that field is another one, or is the same one."""
    rows = table(array, kind)
    (here,) = rows[rows["address"] == address]
    for row in rows:
        if row["address"] != address and (not same or (row[same] != here[same]) == differ):
            return int(row["address"])
    raise AssertionError


Change = Callable[[MainArray], tuple[int, Offset, int]]  # group, field and new value


def put(kind: str, field: str, value: int, of: str = "") -> Change:
    """`value` into `field` of the first group of `kind` whose field `of` is not 0."""

    def change(array: MainArray) -> tuple[int, Offset, int]:
        group = where(array, kind, of) if of else int(table(array, kind)["address"][0])
        return group, getattr(g, field), value

    return change


def another_zone_point(array: MainArray) -> tuple[int, Offset, int]:
    """A grid-point of the same block that the zone does not have."""
    zone = table(array, "zone")[0]
    fdef = next(row for row in table(array, "fdef") if row["KFZ"] == zone["address"])
    point = int(fdef["KFG"])
    while point in zone["KZG"]:
        point = iget(array.h, point, g.KG)
    return int(zone["address"]), g.KZG, point


def foreign_zone_point(array: MainArray) -> tuple[int, Offset, int]:
    zone = table(array, "zone")[0]
    foreign = next(row["KFG"] for row in table(array, "fdef") if row["KFZ"] not in (0, int(zone["address"])))
    return int(zone["address"]), g.KZG, int(foreign)


def foreign_corner(array: MainArray) -> tuple[int, Offset, int]:
    bound = where(array, "bound", "KUP")
    return bound, g.KUP, other(array, "corner", iget(array.h, bound, g.KUP), "KNB")


def foreign_block(array: MainArray) -> tuple[int, Offset, int]:
    bound = where(array, "bound", "KUP")
    return bound, g.KUB, other(array, "block", iget(array.h, bound, g.KUB))


def inner_outer(array: MainArray) -> tuple[int, Offset, int]:
    """The first zone has two of its grid-points exchanged: it lies on the other side of them."""
    zone = table(array, "zone")[0]
    return int(zone["address"]), g.KZG, int(zone["KZG"][1])


CASES: dict[str, tuple[Change, str]] = {
    "a corner without its grid-point": (put("corner", "KGP", 0, "KGP"), "KGP of corner@"),
    "a grid-point without its corner": (put("gridpoint", "KCOR", 0, "KCOR"), "KGP of corner@"),
    "a zone with another grid-point": (another_zone_point, "zone"),
    "a zone with a grid-point twice": (inner_outer, "zone"),
    "a zone with a grid-point of another block": (foreign_zone_point, "and not of block@"),
    "a condition on no grid-point": (put("bound", "KUG", 0, "KUG"), "acts on no grid-point"),
    "a condition on a foreign corner": (foreign_corner, "and not of block@"),
    "a condition on another block": (foreign_block, "and not of block@"),
    "an edge without its other end": (put("bound", "KUQ", 0, "KUP"), "on that corner, names no edge"),
    "grid-points miscounted": (put("fdef", "KFNG", 3), "KFNG of fdef@"),
    "zones miscounted": (put("fdef", "KFNZ", 9), "KFNZ of fdef@"),
    "KFMIX": (put("fdef", "KFMIX", 2), "is 2, not 0 to 1"),
    "KBFIX": (put("block", "KBFIX", 3), "is 3, not 0 to 2 or 4 or 6 or 8 or 10 or 12 or 14"),
    "KGFIX": (put("gridpoint", "KGFIX", 4), "is 4, not 0 to 3"),
    "KGEDGE": (put("gridpoint", "KGEDGE", -1), "is -1, not 0 to 1"),
    "KGEDGE of a rounded corner": (put("gridpoint", "KGEDGE", 1, "KCOR"), "which is rounded"),
    "KUFIX": (put("bound", "KUFIX", 5), "is 5, not 0 to 4"),
    "a velocity that is not held": (put("bound", "KUFIX", 3, "KUFIX"), "conditions give it the velocities"),
    "KHK": (put("history", "KHK", 99), "name nothing that is recorded"),
    "KHN": (put("history", "KHN", 0), "is 0, not"),
    "a FUNCTION without a number": (put("signal", "KTNUM", 0, "KTNUM"), "but it has points"),
    "a sine with a number": (put("signal", "KTNUM", 4, "KTFREQ"), "but it has no points"),
}


@pytest.mark.parametrize("case", CASES)
def test_a_wrong_word_is_named(case: str, sound: MainArray, tmp_path: Path) -> None:
    """By the proof that RESTART makes too."""
    change, text = CASES[case]
    array = sound.copy()
    group, offset, value = change(array)
    assert iget(array.h, group, offset) != value
    puti(array.h, group, offset, value)
    found = [violation.message for violation in check_links(array)]
    assert any(text in message for message in found), found
    with pytest.raises(UdecError) as caught:
        load(save(array, tmp_path / "wrong.h5"))
    assert caught.value.number == 29


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("MCTOT", -1),
        ("NMADE", -1),
        ("NBROKE", -5),
        ("NSOFT", 3),
        ("LSHORT", 2),
        ("JPHASE", 5),
        ("NSPARE", -1),
    ],
)
def test_a_wrong_number_of_the_common_block_is_named(name: str, value: int, sound: MainArray) -> None:
    array = sound.copy()
    array.h.ci[getattr(g, name)] = value
    assert any(name in violation.message for violation in check_links(array))


def test_no_other_domain_is_the_outer_one(sound: MainArray) -> None:
    outer = int(sound.h.ci[g.IODPNT])
    others = [int(row["address"]) for row in table(sound, "domain") if row["address"] != outer]
    assert others
    for domain in others:
        array = sound.copy()
        array.h.ci[g.IODPNT] = domain
        assert any(f"domain@{outer} lies around" in str(violation) for violation in check_links(array))


def test_where_blocks_lie_in_each_other_no_domain_is_judged_by_its_area(tmp_path: Path) -> None:
    """A state that error 15 has ended a run of is saved and restored, however deep its blocks have gone."""
    m = Model(out=tmp_path)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.block(0, 0, 0, 4, 6, 4, 6, 0)
    for line in ((-1, 1, 7, 1), (-1, 2, 7, 2), (2, 1, 2, 4), (4, 1, 4, 4)):
        m.split(*line)
    m.fix(0, 6, 0, 1)
    m.gravity(0, -10)
    m.fraction(4.916)
    with pytest.raises(UdecError, match="error 15"):
        m.cycle(3)
    assert any("around all blocks" not in str(one) for one in m.check())
    assert check_links(m.array) == []
    assert Model.restore(m.save(tmp_path / "spoilt.h5")).h.ci[g.NSPOIL] == 15


def move(h: Memory, group: int, kx: Offset, dx: float) -> None:
    putr(h, group, kx, getr(h, group, kx) + dx)


def test_zones_that_are_no_pairs_are_named(sound: MainArray) -> None:
    """Four zones around a point are two pairs in the order that goes round, and none in another."""
    array = sound.copy()
    h, fdef = array.h, int(table(array, "fdef")["address"][0])
    puti(h, fdef, g.KFMIX, 1)
    assert check(array) == []
    one = iget(h, fdef, g.KFZ)
    two = iget(h, one, g.KZ)
    three = iget(h, two, g.KZ)
    four = iget(h, three, g.KZ)
    for zone, after in ((one, three), (three, two), (two, four)):
        puti(h, zone, g.KZ, after)
    assert any("KFMIX of block@" in str(violation) for violation in check_links(array))


def test_a_zone_that_is_turned_over_is_named(sound: MainArray) -> None:
    array = sound.copy()
    move(array.h, where(array, "gridpoint", "KCOR", False), g.KXG, 2.0)
    assert any("the area of zone@" in str(violation) for violation in check(array))


def test_a_grid_point_beside_its_corner_is_named(sound: MainArray) -> None:
    array = sound.copy()
    move(array.h, where(array, "gridpoint", "KCOR"), g.KXG, 1e-6)
    assert any("but KXG of its grid-point is" in str(violation) for violation in check(array))


def test_every_integer_of_the_table_says_what_it_may_be() -> None:
    """A new code without a range would go unproved."""
    fields = read_table()
    for kind, those in (*((group.name, group.fields) for group in fields.groups), ("common", fields.common)):
        for field in those:
            if not field.real and (field.role != "head" or kind == "common"):
                assert field.allowed, f"{field.name} of {kind}"


def test_times_of_a_function_ascend(sound: MainArray) -> None:
    array = sound.copy()
    point = where(array, "tabpoint", "KTPN")
    putr(array.h, point, g.KTPT, np.inf)
    assert any("of the point before it" in str(violation) for violation in check(array))
