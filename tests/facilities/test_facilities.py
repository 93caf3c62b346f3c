"""Facilities: what a planted scene uses is listed and nothing else, its words as counted by hand."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.census import census
from naive.layout import count_words
from support.every_group_kind import every_kind
from support.mechanics_scenes import on_base

from udec_ia import Model, UdecError
from udec_ia.cli import main
from udec_ia.facilities import facility_costs as cost
from udec_ia.facilities.facilities_in_use import FACILITIES, facilities, facilities_without_effect
from udec_ia.facilities.facility_costs import WITHOUT, costs
from udec_ia.heap.accessors import puti
from udec_ia.heap_tools.memory_use import junk
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.word_map import Atlas
from udec_ia.running.run_cycles import prepare

BARE = {"blocks and contacts", "domain pass", "energy monitor"}
KINDS = {
    "blocks and contacts": ("block", "corner", "contact", "domain"),
    "SDEF": ("sdef",),
    "FDEF": ("fdef", "zone", "gridpoint"),
    "BOUNDARY": ("bound",),
    "FUNCTION": ("signal", "tabpoint", "follower"),
    "HISTORY": ("history", "summand"),
}


def size_of(kind: str, ratio: int) -> int:
    """Words of a group."""
    return count_words([(one.name, one.real, one.count) for one in read_table().group(kind).fields], ratio)[1]


def scene(**given: Any) -> Model:
    return on_base(2.0, 1.0, 0.1, 12.0, **given)


def in_junk(m: Model) -> int:
    return sum(row[3] for row in junk(Atlas(m.array.h)).rows if row[0] == "junk")


def used(m: Model) -> dict[str, int]:
    """Words by the names of what is listed."""
    return {row[0]: row[1] for row in facilities(m.array).rows}


def vain(m: Model) -> dict[str, str]:
    return {row[0]: row[1] for row in facilities_without_effect(m.array).rows}


def test_each_facility_says_how_to_do_without_it() -> None:
    assert [one.name for one in FACILITIES] == [*WITHOUT]


@pytest.mark.parametrize(
    ("command", "names"),
    [
        (lambda m: None, set()),
        (lambda m: m.damping(0.5, 10.0), {"DAMPING MASS", "DAMPING STIFFNESS"}),
        (lambda m: m.damping(0.5, 10.0, "mass"), {"DAMPING MASS"}),
        (lambda m: m.damping(0.0, 10.0), set()),
        (lambda m: m.damping(local=0.8), {"DAMPING to rest"}),
        (lambda m: m.fraction(0.5, scaled=True), {"FRACTION SCALED"}),
        (lambda m: m.energy("on"), {"ENERGY"}),
        (lambda m: (m.energy("on"), m.energy("off")), set()),
        (lambda m: m.history(10, "unbalanced"), {"HISTORY"}),
        (lambda m: m.boundary(-1, 1, 0, 1, xforce=1.0), {"BOUNDARY"}),
        (lambda m: m.boundary(-1, 1, 0, 1, xforce=1.0, sine=(1.0, 1.0)), {"BOUNDARY", "FUNCTION"}),
        (lambda m: (m.function(1, 0.0, 1.0), m.gravity(0.0, -1.0, function=1)), {"FUNCTION"}),
        (lambda m: (m.boundary(-1, 1, 0, 1, xforce=1.0), m.boundary(-1, 1, 0, 1, free=True)), set()),
        (lambda m: m.change(-1, 1, 0, 1, type="sdef"), {"SDEF"}),
        (lambda m: (m.change(-1, 1, 0, 1, type="sdef"), m.change(-1, 1, 0, 1, type="rigid")), set()),
        (lambda m: m.change(-9, 9, -1, 1, constitutive=2), {"joint law"}),
    ],
)
def test_what_a_scene_uses_is_listed_and_nothing_else(
    command: Callable[[Model], object], names: set[str]
) -> None:
    m = scene()
    command(m)
    assert used(m).keys() == BARE | names


def test_a_scene_that_cannot_move_has_no_domain_pass_and_no_watch() -> None:
    m = scene()
    m.fix(-9, 9, -9, 9)
    assert used(m).keys() == {"blocks and contacts"}


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
def test_words_are_those_of_the_groups(build: str) -> None:
    m = every_kind(build)
    m.split(0.5, -0.5, 0.5, 2)
    m.delete(0, 0.5, 0, 1)  # leaves junk
    groups, words = census(m.array), used(m)
    for name, kinds in KINDS.items():
        counted = sum(len(groups[kind]) * size_of(kind, m.array.scheme.ratio) for kind in kinds)
        assert words[name] == counted > 0
    assert sum(words.values()) + in_junk(m) == m.array.h.ci[g.MFREE] - 1


@pytest.mark.parametrize(
    ("commands", "name"),
    [
        (lambda m: m.damping(combined=0.8), "DAMPING to rest"),
        (lambda m: m.fraction(0.5, scaled=True), "FRACTION SCALED"),
        (lambda m: (m.damping(combined=0.8), m.fraction(0.5, scaled=True)), "to rest with SCALED"),
    ],
)
def test_relaxations_are_counted_once(commands: Callable[[Model], object], name: str) -> None:
    m = scene()
    commands(m)
    prepare(m.array)
    words = used(m)
    assert words[name] == len(census(m.array)["relax"]) * size_of("relax", 2) > 0
    assert sum(words.values()) + in_junk(m) == m.array.h.ci[g.MFREE] - 1


# ---- in vain


def fixed(m: Model) -> None:
    m.fix(-9, 9, -9, 9)


@pytest.mark.parametrize(
    ("in_vain", "with_effect", "name", "why"),
    [
        (
            lambda m: (m.damping(0.5, 10.0, "mass"), fixed(m)),
            lambda m: m.damping(0.5, 10.0, "mass"),
            "DAMPING MASS",
            "every block is fixed",
        ),
        (lambda m: (m.energy("on"), fixed(m)), lambda m: m.energy("on"), "ENERGY", "every block is fixed"),
        (fixed, lambda m: None, "GRAVITY", "every block is fixed"),
        (
            lambda m: m.damping(0.5, 10.0, "internal"),
            lambda m: (m.change(-1, 1, 0, 1, type="sdef"), m.damping(0.5, 10.0, "internal")),
            "DAMPING INTERNAL",
            "no block is simply-deformable",
        ),
        (
            lambda m: m.damping(local=0.0),
            lambda m: m.damping(local=0.1),
            "DAMPING to rest",
            "its fraction is 0",
        ),
        (
            lambda m: m.change(-9, 9, -1, 0, type="sdef"),
            lambda m: m.change(-1, 1, 0, 1, type="sdef"),
            "SDEF, FDEF",
            "not strained, being fixed: 1 deformable block",
        ),
        (fixed, lambda m: None, "FIX", "calculated between fixed blocks, where nothing moves: 2 contacts"),
        (
            lambda m: m.boundary(-9, 9, -1, 0, xforce=1.0),
            lambda m: m.boundary(-9, 9, -1, 1, xforce=1.0),
            "BOUNDARY",
            "loads fixed blocks only",
        ),
        (
            lambda m: m.function(7, 0.0, 1.0),
            lambda m: (m.function(7, 0.0, 1.0), m.boundary(-1, 1, 0, 1, xforce=1.0, function=7)),
            "FUNCTION 7",
            "nothing follows it",
        ),
        (
            lambda m: (m.history(1000, "unbalanced"), m.cycle(2)),
            lambda m: (m.history(2, "unbalanced"), m.cycle(2)),
            "HISTORY 1",
            "every 1000 cycles; the run has only 2 cycles",
        ),
        (
            lambda m: m.property(3, kn=1e8),
            lambda m: (m.property(3, kn=1e8), m.change(-1, 1, 0, 1, material=3)),
            "PROPERTY MATERIAL=3",
            "no block and no contact has this material",
        ),
        (
            lambda m: m.property(1, bulk=1e8, g=1e8),
            lambda m: (m.property(1, bulk=1e8, g=1e8), m.change(-1, 1, 0, 1, type="sdef")),
            "PROPERTY MATERIAL=1",
            "no block of this material is deformable",
        ),
        (
            lambda m: m.property(1, dilation=0.1),
            lambda m: (m.property(1, dilation=0.1), m.change(-9, 9, -1, 1, constitutive=2)),
            "PROPERTY",
            "DILATION of material 1",
        ),
    ],
)
def test_what_is_asked_for_in_vain_is_named_with_the_reason(
    in_vain: Callable[[Model], object],
    with_effect: Callable[[Model], object],
    name: str,
    why: str,
    tmp_path: Path,
) -> None:
    m, other = scene(), scene()
    m.out = other.out = tmp_path
    in_vain(m)
    with_effect(other)
    assert why in vain(m)[name]
    assert name not in vain(other)


def test_damaged_lists_are_not_followed() -> None:
    m = scene()
    block = int(m.table("block")["address"][0])
    puti(m.array.h, block, g.KB, block)
    assert used(m).keys() >= {"blocks and contacts"}
    assert vain(m) == vain(scene())  # nothing follows the list of blocks
    m.history(10, "unbalanced")
    history = int(m.table("history")["address"][0])
    puti(m.array.h, history, g.KH, history)
    listing = facilities_without_effect(m.array)
    assert "damaged" in listing.head[0]
    assert not [*listing.rows]


# ---- what it costs


def test_the_price_is_what_a_cycle_takes_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a clock of our own: the account a fifth of a cycle, histories a tenth, nothing else anything."""
    clock = [0.0]

    def cycle(array: Any, n: int, **given: Any) -> None:
        account, recorded = array.h.ci[g.LENER] != 0, array.h.ci[g.IHPNT] != 0
        clock[0] += n * 1e-6 * (7 + 2 * account + recorded)

    m = scene()
    m.energy("on")
    m.history(10, "unbalanced")
    before = m.array.copy()
    monkeypatch.setattr(cost, "cycle", cycle)
    monkeypatch.setattr(cost, "process_time", lambda: clock[0])
    listing = costs(m.array, seconds=0.0)
    rows = {row[0]: row for row in listing.rows}
    assert listing.head[0].startswith("a cycle takes 10,000 ns")
    assert rows["ENERGY"][3:6] == (2000, 20.0, 0.0)
    assert rows["HISTORY"][1:6] == (size_of("history", 2), 4 * size_of("history", 2), 1000, 10.0, 0.0)
    assert {rows[name][3] for name in rows.keys() - {"ENERGY", "HISTORY"}} == {0, ""}
    assert "cannot be left out" in rows["blocks and contacts"][-1]
    assert all(np.array_equal(a, b) for a, b in zip(m.array.h, before.h, strict=True))


def test_words_are_those_that_running_without_sets_free() -> None:
    """As run; what cannot be run without says why: here the block would have no zones left to hold it."""
    m = every_kind()
    rows = {row[0]: row for row in costs(m.array, m.session.laws, seconds=0.0).rows}
    words = used(m)
    words["BOUNDARY"] += size_of("signal", m.array.scheme.ratio)  # its sine goes with it
    assert {name: rows[name][1] for name in words if name != "FDEF"} == {
        name: words[name] for name in words if name != "FDEF"
    }
    assert rows["FDEF"][1] > words["FDEF"]  # the conditions on its grid-points go with it
    needed = ("blocks and contacts", "joint materials")  # water needs their apertures
    assert all(isinstance(rows[name][3], int) for name in words if name not in needed)


def test_a_scene_can_run_without_histories_and_with_scaled_masses_without_zones(tmp_path: Path) -> None:
    m = scene()
    m.out = tmp_path
    m.property(1, bulk=1e8, g=5e7)
    for field in ("kyd", "kxd", "ky"):
        m.history(5, field, at=(0, 0.5))
    m.fraction(0.5, scaled=True)
    m.generate(-2, 2, 0, 2, edge=0.7)
    m.cycle(10)
    rows = {row[0]: row for row in costs(m.array, seconds=0.0).rows}
    for name in ("HISTORY", "FDEF", "FRACTION SCALED"):
        assert isinstance(rows[name][3], int), rows[name]
    assert rows["HISTORY"][1] == 3 * size_of("history", m.array.scheme.ratio)


# ---- the command


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = str(scene().save(tmp_path / "s.h5"))
    assert main(["info", file]) == 0
    text = capsys.readouterr().out
    assert main(["info", file, "--python"]) == 0
    exec(capsys.readouterr().out, {})
    assert capsys.readouterr().out == text
    assert main(["info", file, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {row["facility"] for row in found["facilities"]["rows"]} == BARE
    assert found["file"]["head"] == text.splitlines()[: len(found["file"]["head"])]
    assert main(["info", file, "--budget", "5s"]) == 2
    capsys.readouterr()
    assert main(["info", file, "--cost", "--budget", "0s", "--json"]) == 0
    assert {row["facility"] for row in json.loads(capsys.readouterr().out)["rows"]} == BARE


def test_a_state_that_cannot_go_on_has_no_price(tmp_path: Path) -> None:
    m = scene()
    m.property(1, density=0)
    with pytest.raises(UdecError, match="12"):
        costs(m.array)
