"""Groups of every kind change places in IA(), and nothing that they say changes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive import relocate as naive
from naive.relocate import differences, essence
from support.every_group_kind import GROUPS, every_kind

from udec_ia import Model
from udec_ia.heap.main_array import relocate
from udec_ia.heap_tools.renumber_groups import arrange
from udec_ia.layout.offsets import MFREE
from udec_ia.output.drawn_outlines import snapshot

UNKNOWN = {"next", "back"}  # the lists may run in another order


@pytest.fixture(autouse=True)
def folder_of_its_own(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)


def large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("udec_ia.heap_tools.renumber_groups.LARGE", 2)


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
    monkeypatch.setattr("udec_ia.heap_tools.renumber_groups.LARGE", 500)
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
