"""Groups of every kind change places in IA(), and nothing that they say changes."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive import relocate as naive
from naive.relocate import differences, essence
from support.every_group_kind import GROUPS, every_kind
from support.mechanics_scenes import box, model

from udec_ia import Model, UdecError
from udec_ia.heap.junk_list import chains_below
from udec_ia.heap.main_array import compact, relocate
from udec_ia.heap_tools.renumber_groups import arrange
from udec_ia.layout.offsets import MFREE
from udec_ia.output.drawn_outlines import snapshot
from udec_ia.reader.group_tables import all_addresses
from udec_ia.reader.word_map import junk_list

UNKNOWN = {"next", "back"}  # the lists may run in another order


@pytest.fixture(autouse=True)
def folder_of_its_own(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)


def large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("udec_ia.heap_tools.renumber_groups.MANY_BLOCKS", 2)


def rows(m: Model) -> dict[str, Any]:
    return {group.name: m.table(group.name) for group in GROUPS}


@pytest.mark.parametrize("kind", [group.name for group in GROUPS])
def test_the_scene_has_every_kind_of_group(kind: str) -> None:
    assert len(every_kind().table(kind)) > 1


@pytest.mark.parametrize("build", ["i16r32", "i32r64"])
def test_every_group_says_what_it_said_before(build: str) -> None:
    """In random order: each word is the same, or the new address of the group that the old one named."""
    m, rng = every_kind(build), np.random.default_rng(1)
    before = rows(m)
    moved = relocate(m.array, {kind: rng.permutation(table["address"]) for kind, table in before.items()})
    assert m.check() == []
    after = rows(m)
    for group in GROUPS:
        old, new = before[group.name], after[group.name]
        new = new[np.argsort(new["address"])[np.searchsorted(np.sort(new["address"]), moved[old["address"]])]]
        for field in group.fields:
            if field.role not in UNKNOWN:
                values = old[field.name] if field.target is None else moved[old[field.name]]
                assert np.array_equal(new[field.name], values), f"{field.name} of {group.name}"


@pytest.mark.parametrize("how", ["list order", "random addresses"])
def test_where_groups_lie_does_not_change_a_bit_of_the_physics(how: str) -> None:
    here, there = every_kind(), every_kind()
    if how == "list order":
        relocate(there.array, {kind: table["address"] for kind, table in rows(there).items()})
    else:
        there.session.array = naive.relocate(there.array, np.random.default_rng(2))
    assert differences(essence(here.array), essence(there.array)) == []
    for m in (here, there):
        m.cycle(100)
        assert m.check() == []
    assert np.abs(here.table("zone")["KZS22"]).max() > 0
    assert np.abs(here.table("sdef")["KS122"]).max() > 0
    assert differences(essence(here.array), essence(there.array)) == []


def test_a_large_model_loses_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other sums, in another order, are off by a last digit of the greatest in each cycle."""
    here, there = every_kind(), every_kind()
    large(monkeypatch)
    used = int(there.h.ci[MFREE])
    there.cycle(0)
    assert int(there.h.ci[MFREE]) <= used
    assert there.check() == []
    assert not np.array_equal(here.table("block")["KX"], there.table("block")["KX"])
    assert {kind: len(table) for kind, table in rows(here).items()} == {
        kind: len(table) for kind, table in rows(there).items()
    }
    monkeypatch.setattr("udec_ia.heap_tools.renumber_groups.MANY_BLOCKS", 500)
    cycles = 100
    for m in (here, there):
        m.cycle(cycles)
        assert m.check() == []
    for kind, x, y, v in (("block", "KX", "KY", "KYD"), ("gridpoint", "KXG", "KYG", "KYDG")):
        one, two = by_place(here.table(kind), x, y)[v], by_place(there.table(kind), x, y)[v]
        assert np.abs(one).max() > 0
        assert np.abs(one - two).max() < cycles**2 * np.finfo(float).eps * np.abs(one).max()

    for one, two in zip(here.histories(), there.histories(), strict=True):
        most = np.abs(one.numbers[:, 2]).max()
        assert most > 0
        assert np.abs(one.numbers - two.numbers).max() < cycles**2 * np.finfo(float).eps * most


def excavate(m: Model) -> str:
    m.function(7, 0.0, 1.0, 0.1, 0.0)
    m.delete(2, 3.07, 1, 2, function=7)
    return ""


def fill(m: Model) -> str:
    m.delete(2, 3.07, 1, 2)
    m.cycle(20)
    m.ppressure(2, 3, 1, 2, 3.3e4, state="held")
    m.cycle(10)
    m.fill(2.5, 1.5)
    return ""


def miss(m: Model) -> str:
    with pytest.raises(UdecError) as caught:
        m.boundary(-0.3, -0.1, -5, 5, xvel=0.01)
    return re.sub(r"@\d+", "", caught.value.detail)


@pytest.mark.parametrize("command", [excavate, fill, miss])
def test_where_groups_lie_does_not_change_what_commands_do(command: Callable[[Model], str]) -> None:
    def leaning_bricks() -> Model:
        m = model(*box(0, 5, 0, 4), d=0.03, friction=0.5, stiffness=(1e9, 1e9))
        m.property(1, bulk=1e9, g=5e8)
        for y in (1, 2, 3):
            m.split(-1, y, 6, y)
        for x in (1, 2, 3, 4):
            m.split(x, 0.5, x + 0.07, 5)
        m.fix(0, 5, 0, 1)
        m.fluid(kw=1e7)
        m.ppressure(-1, 6, -1, 5, level=4.0)
        m.cycle(20)
        m.generate(-1, 6, -1, 5, edge=0.5)
        m.cycle(20)
        return m

    here, there = leaning_bricks(), leaning_bricks()
    there.session.array = naive.relocate(there.array, np.random.default_rng(3))
    assert command(here) == command(there)
    for m in (here, there):
        m.cycle(20)
    assert differences(essence(here.array), essence(there.array)) == []


def by_place(table: Any, x: str, y: str) -> Any:
    return table[np.lexsort((table[y], table[x].round(6)))]


def test_a_stage_may_come_before_displacements_and_the_first_cycle(monkeypatch: pytest.MonkeyPatch) -> None:
    """Addresses change twice after it."""
    large(monkeypatch)
    m = Model()
    m.property(1, density=2000, kn=1e9, ks=1e9)
    for i in (2, 0, 1):
        m.block(i, 0, i, 1, i + 1, 1, i + 1, 0)
    m.stage("one")
    places = dict(zip(m.table("block")["address"].tolist(), m.table("block")["KX"].tolist(), strict=True))
    m.displacements()
    m.cycle(0)
    moved = m.session.addresses_since["one"]
    after = dict(zip(m.table("block")["address"].tolist(), m.table("block")["KX"].tolist(), strict=True))
    assert {int(moved[address]): x for address, x in places.items()} == after


def test_a_small_model_stays_as_it_is() -> None:
    m = every_kind()
    before = m.h.ia.tobytes()
    assert arrange(m.array) is None
    assert m.h.ia.tobytes() == before


def test_an_open_frame_follows(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks, corners, contacts, domains and grid-points of the states drawn before CYCLE."""
    m = every_kind()
    m.plot(0, contacts=True, domains=True, displacements=True)
    large(monkeypatch)
    m.cycle(0)
    assert m.session.plots is not None
    assert m.session.plots.frame is not None
    (state,) = m.session.plots.frame.states
    now = snapshot(m.h, contacts=True, domains=True, inside=True)
    assert state.contacts is not None
    assert state.field is not None
    assert now.contacts is not None
    assert now.field is not None
    for one, two, place in (
        (state.outlines, now.outlines, "centroid"),
        (state.contacts, now.contacts, "place"),
        (state.field, now.field, "place"),
    ):
        there = dict(zip(two.address.tolist(), getattr(two, place).tolist(), strict=True))
        assert [there[address] for address in one.address.tolist()] == getattr(one, place).tolist()
    assert set(state.outlines.corner_address) == set(now.outlines.corner_address)
    assert {one.address for one in state.domains} == {one.address for one in now.domains}


@pytest.mark.parametrize("build", ["i16r32", "i32r64"])
@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_groups_from_an_address_on_are_compacted(build: str, share: float) -> None:
    """They say what they said before; those below stay, and the junk between these."""
    here, there = every_kind(build), every_kind(build)
    order = all_addresses(there.array)
    hosts = np.sort(np.concatenate([order[group.name] for group in GROUPS if not group.behind]))
    first = int(hosts[int(share * (len(hosts) - 1))])
    below = hosts[hosts < first].tolist()
    junk = chains_below(junk_list(here.h), first)
    assert share == 0.0 or junk
    compact(there.array, order, first)
    assert there.check() == []
    assert differences(essence(here.array), essence(there.array)) == []
    after = all_addresses(there.array)
    assert set(below) <= set(np.concatenate(list(after.values())).tolist())
    assert junk_list(there.h) == junk
    for group in GROUPS:
        distances = np.diff(np.sort(after[group.name][after[group.name] >= first]))
        assert len(set(distances.tolist())) <= 1
    for m in (here, there):
        m.cycle(100)
        assert m.check() == []
    assert differences(essence(here.array), essence(there.array)) == []


def test_there_may_be_nothing_to_compact() -> None:
    m = every_kind()
    words, common = m.h.ia.copy(), m.h.ci.copy()
    compact(m.array, all_addresses(m.array), int(m.h.ci[MFREE]))
    assert np.array_equal(m.h.ia, words)
    assert np.array_equal(m.h.ci, common)


@pytest.mark.parametrize("mtop", [10, 30])
def test_an_array_shorter_than_a_group_can_be_lengthened(mtop: int) -> None:
    m = Model(mtop=mtop)
    m.displacements()
    m.jproperty(1, kn=1e9, ks=1e9)
    m.fluid(kw=1e7)
    assert m.check() == []


@pytest.mark.parametrize("per_length", [False, True])
def test_zones_that_many_blocks_get_after_a_cycle_lie_together(
    monkeypatch: pytest.MonkeyPatch, per_length: bool
) -> None:
    """With the corners and contacts that they bring; the physics have the same bits."""
    here, first = zoned_late(per_length)
    monkeypatch.setattr("udec_ia.ops.commands.generate_zones.MANY_BLOCKS", 2)
    there, _ = zoned_late(per_length)
    assert differences(essence(here.array), essence(there.array)) == []
    assert np.array_equal(here.table("block")["address"], there.table("block")["address"])
    for kind in ("zone", "gridpoint", "corner", "contact", "domain"):
        assert len(distances_between(here, kind, first)) > 1
        assert len(distances_between(there, kind, first)) == 1
    for m in (here, there):
        m.cycle(100)
        assert m.check() == []
    assert differences(essence(here.array), essence(there.array)) == []


def zoned_late(per_length: bool) -> tuple[Model, int]:
    """Bricks that get zones after the first cycle, and the first address of what they bring."""
    m = model(*box(0, 4, 0, 3), d=0.05, friction=0.3)
    m.property(1, bulk=1e8, g=5e7)
    if per_length:
        m.jproperty(1, kn=1e9, ks=1e9, friction=0.3, between=(1, 1))
    for y in (1, 2):
        m.split(-1, y, 5, y)
    for j in range(3):
        m.split(1 + j / 2, j, 1 + j / 2, j + 1)
        m.split(3 - j / 2, j, 3 - j / 2, j + 1)
    m.fix(0, 4, 0, 1)
    m.cycle(20)
    m.change(-1, 5, -1, 4, type="fdef")
    first = int(m.h.ci[MFREE])
    m.generate(-1, 5, -1, 4, edge=0.4)
    return m, first


def distances_between(m: Model, kind: str, first: int) -> set[int]:
    """From a group of `kind` to the next one, from the address `first` on, in words."""
    at = np.sort(m.table(kind)["address"])
    return set(np.diff(at[at >= first]).tolist())
