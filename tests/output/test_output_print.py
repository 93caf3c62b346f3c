"""PRINT shows every field of every group, in order, within 120 columns."""

from __future__ import annotations

import pytest
from support.handmade_map import two_blocks
from support.mechanics_scenes import box, model

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import puti, putr
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.output.printed_tables import LINE, printout
from udec_ia.reader.list_walks import boundary, corners, groups, loop
from udec_ia.studies.verification_tools import fan

EVERYTHING = ("blocks", "contacts", "corners", "domains", "list", "dlist")
KINDS = {"blocks": "block", "contacts": "contact", "corners": "corner", "domains": "domain"}


def cells(text: str) -> dict[tuple[str, str], str]:
    """(address, column name) -> printed text, over all the stacked tables of a printout."""
    found: dict[tuple[str, str], str] = {}
    for table in (part for part in text.split("\n\n") if "\naddress" in part):
        _, names, *rows = table.splitlines()
        for row in rows:
            values = row.split()
            if values[0].isdigit():
                found |= {(values[0], name): v for name, v in zip(names.split(), values, strict=True)}
    return found


@pytest.mark.parametrize("what", KINDS)
@pytest.mark.parametrize("scheme", ALL_SCHEMES)
def test_every_field_of_every_group(scheme: str, what: str) -> None:
    h = two_blocks(scheme).h
    kind = KINDS[what]
    addresses = (
        [c for b in groups(h, "block") for c in corners(h, b)] if kind == "corner" else groups(h, kind)
    )
    text = printout(h, what)
    printed = {key for key in cells(text) if key[1] not in ("address", "type")}
    fields = [field.name for field in read_table().group(kind).fields if field.role != "head"]
    assert printed == {(str(iad), name) for iad in addresses for name in fields}
    assert max(map(len, text.splitlines())) <= LINE


def test_values_and_units() -> None:
    """The head codes are written out, fields stand under their names, units under the names."""
    h = two_blocks().h
    lower, upper = groups(h, "block")
    putr(h, upper, g.KXD, -1.25e-7)
    printed = cells(printout(h, "blocks"))
    assert printed[str(lower), "type"] == "MRIG"
    assert printed[str(lower), "KB"] == str(upper)
    assert float(printed[str(upper), "KXD"]) == -1.25e-7
    assert float(printed[str(upper), "KBI"]) == pytest.approx(2000 / 6, rel=1e-5)
    assert "rad/s" in printout(h, "blocks").splitlines()[4].split()


def test_wide_numbers_are_stacked() -> None:
    """Numbers that fill their columns give more tables, never longer lines, and lose no field."""
    h = two_blocks().h
    narrow = printout(h, "blocks")
    for block in groups(h, "block"):
        for field in read_table().group("block").fields:
            if field.real:
                putr(h, block, getattr(g, field.name), -1.23456e-100)
    wide = printout(h, "blocks")
    assert max(map(len, wide.splitlines())) <= LINE
    assert wide.count("\n\n") > narrow.count("\n\n")
    assert cells(wide).keys() == cells(narrow).keys()


def test_lists_are_in_order() -> None:
    h = two_blocks().h
    tables = printout(h, "list").split("\n\n")[1:]
    for block, table in zip(groups(h, "block"), tables, strict=True):
        printed = [int(row.split()[0].split("@")[1]) for row in table.splitlines()[3:]]
        assert table.startswith(f"block@{block}:")
        assert printed == list(boundary(h, block))


def test_loops_are_in_order_and_name_the_block_they_follow() -> None:
    h = two_blocks().h
    tables = printout(h, "dlist").split("\n\n")[1:]
    for domain, table in zip(groups(h, "domain"), tables, strict=True):
        rows = [row.split()[:2] for row in table.splitlines()[3:]]
        printed = [tuple(int(cell.split("@")[1]) for cell in row) for row in rows]
        assert printed == list(loop(h, domain))
    assert "(the outer one)" in tables[1]
    assert "(the outer one)" not in tables[0]


def test_damaged_lists_are_printed_as_far_as_they_go() -> None:
    """A contact list that breaks after its first contact: that one is printed, and where it breaks."""
    h = two_blocks().h
    first, second = groups(h, "contact")
    puti(h, first, g.KC, 7)
    text = printout(h, *EVERYTHING)
    assert f"the heap is damaged here: the list link of contact@{first} points to 7" in text
    assert (str(first), "KXC") in cells(text.split("Corners")[0])
    assert (str(second), "KXC") not in cells(text.split("Corners")[0])


@pytest.mark.parametrize("wrong", [-511936084, 0, 2, 10**6])
@pytest.mark.parametrize("kind", ["sdef", "fdef"])
def test_extensions_that_are_nowhere_are_named(kind: str, wrong: int) -> None:
    m = model(*box(0, 2, 0, 1), d=0.1)
    m.change(0, 2, 0, 1, type=kind)
    if kind == "fdef":
        fan(m, 1, 0.5)
    (block,) = groups(m.h, "block")
    puti(m.h, block, g.KBEX, wrong)
    text = printout(m.h, "blocks", "gridpoints", "zones")
    assert f"the heap is damaged here: KBEX of block@{block} points to {wrong}" in text


def test_an_empty_heap_has_nothing_to_print() -> None:
    h = two_blocks().h
    h.ci[[g.IBPNT, g.ICPNT, g.IDPNT, g.NBLK, g.NCON, g.NDOM]] = 0
    assert "No blocks\n\nNo contacts\n\nNo corners\n\nNo domains" in printout(h, *EVERYTHING)


@pytest.mark.parametrize(("what", "number"), [((), 7), (("blocks", "rocks"), 10)])
def test_wrong_parameters(what: tuple[str, ...], number: int) -> None:
    with pytest.raises(UdecError) as error:
        printout(two_blocks().h, *what)
    assert error.value.number == number


def test_zones_are_printed_with_their_strain_rates() -> None:
    """Velocities that are linear in x and y strain all zones alike; before the first step, in their place."""
    m = model(*box(0, 2, 0, 1), d=0.1)
    m.change(0, 2, 0, 1, type="fdef")
    fan(m, 1, 0.5, edge_points=1)
    for row in m.table("gridpoint"):
        x, y = float(row["KXG"]), float(row["KYG"])
        putr(m.h, int(row["address"]), g.KXDG, 0.25 * x + 0.75 * y)
        putr(m.h, int(row["address"]), g.KYDG, 0.5 * x - 0.125 * y)
    printed = cells(printout(m.h, "zones").split("\n\n")[1])
    zones = [str(address) for address in m.table("zone")["address"]]
    assert len(zones) == 8
    for zone in zones:
        found = [float(printed[zone, name]) for name in ("e11", "e12", "e22")]
        assert found == pytest.approx([0.25, 0.625, -0.125], rel=1e-5)


def test_a_zone_that_points_anywhere_has_no_strain_rates() -> None:
    m = model(*box(0, 2, 0, 1), d=0.1)
    m.change(0, 2, 0, 1, type="fdef")
    fan(m, 1, 0.5)
    first, *others = (int(address) for address in m.table("zone")["address"])
    puti(m.h, first, g.KZG, 10**9, 1)
    printed = cells(printout(m.h, "zones").split("\n\n")[1])
    assert [printed[str(first), name] for name in ("e11", "e12", "e22")] == ["nan"] * 3
    assert all(printed[str(zone), "e11"] == "0" for zone in others)


def test_a_gap_is_no_overlap() -> None:
    """The greatest overlap is that of a contact which overlaps, however wide the gaps of others are."""
    m = Model()
    m.property(1, density=1000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1)
    one, two = m.table("contact")["address"].tolist()
    putr(m.h, one, g.KCN, -0.5)
    putr(m.h, two, g.KCN, 0.001)
    line = next(line for line in printout(m.h, "max").splitlines() if line.startswith("overlap"))
    assert line.split()[1:4] == ["0.001", "m", f"contact@{two}"]
