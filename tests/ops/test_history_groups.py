"""A history and its group: what is recorded when the group goes, changes places, or is saved and restored."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from naive.relocate import relocate
from support.handmade_map import two_blocks
from support.mechanics_scenes import block, push, standing_block, value

from udec_ia import Model, UdecError
from udec_ia.heap.find_lose import find, lose
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.history_definitions import define, definitions, named


def test_a_group_that_has_gone_leaves_nan_and_is_told_once(tmp_path: Path) -> None:
    """A block that jumps loses a contact; landing makes a new one at the same address."""
    m, told = standing_block(tmp_path, fraction=0.5), []
    m.tell = told.append
    contacts = m.table("contact")["address"].tolist()
    m.history(1, "KCN", at=[(-1, 0), (1, 0)])
    assert sorted(one.address for one in definitions(m.array)) == sorted(contacts)
    push(m, int(block(m, 0, 0.5)["address"]), yd=2.0)
    seen: dict[int, list[float]] = {address: [] for address in contacts}
    reused = False
    for _ in range(250):
        m.cycle(1)
        for address in contacts:
            lost = bool(seen[address]) and np.isnan(seen[address][-1])
            now = value(m, "contact", address, "KCN")
            reused |= lost and not np.isnan(now)
            seen[address].append(np.nan if lost else now)
    gone = [address for address in contacts if np.isnan(seen[address][-1])]
    assert gone
    assert reused
    for one in m.histories():
        address = int(one.group.split("@")[1])
        assert np.array_equal(one.numbers[1:, 2], seen[address], equal_nan=True)
        assert one.lost == (address in gone)
    assert [text for text in told if "time-step" not in text] == [
        f"history {one.number}: {one.group} was deleted; NaN is recorded from here on"
        for one in m.histories()
        if one.lost
    ]


def test_a_loss_is_told_in_the_deck(tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    m.split(-9, 0.5, 9, 0.5)
    printed = m.run("HISTORY 1 KY AT 0,0.75\nDELETE -1 1 0.6 0.9\nCYCLE 1\n")
    assert printed is not None
    assert re.search(r"^ CYCLE: history 1: block@\d+ was deleted; NaN", printed, re.MULTILINE)


def test_a_deleted_block_is_not_followed(tmp_path: Path) -> None:
    m, told = standing_block(tmp_path), []
    m.tell = told.append
    m.split(-9, 0.5, 9, 0.5)
    (upper,) = m.history(10, "KY", at=(0, 0.75))
    m.cycle(10)
    assert m.delete(-1, 1, 0.6, 0.9) == 1
    m.cycle(20)
    assert np.isnan(upper.numbers[2:, 2]).all()
    assert not np.isnan(upper.numbers[:2, 2]).any()
    assert len(upper.numbers) == 4
    assert len(told) == 1


def test_giving_a_group_back_blinds_its_histories_only() -> None:
    array = two_blocks()
    h = array.h
    groups = [int(find(h, g.NVGP)) for _ in range(2)]
    define(array, named("KXG"), [*groups, groups[0]], 1)
    lose(h, groups[0], g.NVGP)
    assert [one.address for one in definitions(array)] == [0, groups[1], 0]
    assert find(h, g.NVGP) == groups[0]
    assert [one.lost for one in definitions(array)] == [True, False, True]


def test_save_and_restart_go_on_recording(tmp_path: Path) -> None:
    """Elsewhere and under another name: the files hold all that was recorded from the first cycle on."""
    whole, first = standing_block(tmp_path / "whole"), standing_block(tmp_path / "first")
    for m in (whole, first):
        m.history(3, "KY", at=(0, 0.5))
        m.history(4, "KCFN", at=(1, 0))
        m.damping(0.3, 10)
    whole.cycle(50)
    whole.cycle(60)
    first.cycle(50)
    (tmp_path / "there").mkdir()
    saved = first.save((tmp_path / "there" / "half.h5").absolute())
    second = Model.restore(saved)
    second.out, second.name = tmp_path / "second", "other"
    assert [str(one) for one in second.histories()] == [str(one) for one in first.histories()]
    second.cycle(60)
    for one, two in zip(whole.histories(), second.histories(), strict=True):
        assert np.array_equal(one.numbers, two.numbers)
    text = (tmp_path / "whole" / "udec-history.csv").read_text()
    assert (tmp_path / "second" / "other-history.csv").read_text() == text
    second.start()
    assert second.histories() == []


def test_restart_takes_back_what_was_recorded_later(tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    (height,) = m.history(1, "KY", at=(0, 0.5))
    m.cycle(5)
    m.save()
    m.cycle(5)
    expected = height.numbers
    m.restart()
    assert len(m.histories()[0].numbers) == 6
    m.cycle(5)
    assert np.array_equal(m.histories()[0].numbers, expected)


def test_a_loss_is_told_once_over_a_restart(tmp_path: Path) -> None:
    m, told = standing_block(tmp_path), []
    m.tell = told.append
    m.split(-9, 0.5, 9, 0.5)
    m.history(1, "KY", at=(0, 0.75))
    m.delete(-1, 1, 0.6, 0.9)
    m.cycle(1)
    m.save()
    m.restart()
    m.cycle(1)
    assert len(told) == 1
    assert m.histories()[0].lost


def test_histories_follow_groups_that_change_places(tmp_path: Path) -> None:
    m, moved = standing_block(tmp_path), standing_block(tmp_path)
    for one in (m, moved):
        one.history(1, "KXP", at=(0.5, 1))
        one.history(1, "KY", at=(0, 0.5))
        one.history(1, "KCFN", at=(1, 0))
    moved.session.array = relocate(moved.array, np.random.default_rng(1))
    before = [one.address for one in definitions(m.array)]
    assert [one.address for one in definitions(moved.array)] != before
    for one in (m, moved):
        one.cycle(40)
    for one, two in zip(m.histories(), moved.histories(), strict=True):
        assert np.array_equal(one.numbers, two.numbers)


def test_histories_follow_the_order_of_a_large_map(tmp_path: Path) -> None:
    """Before the first cycle of 500 blocks the groups are put in the order of the map."""
    m = Model(out=tmp_path)
    m.property(1, density=1000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 25, 20, 25, 20, 0)
    for k in range(1, 25):
        m.split(-1, k, 21, k)
    for k in range(1, 20):
        m.split(k, -1, k, 26)
    assert len(m.table("block")) == 500
    points = [(1.5, 22.5), (17.5, 3.5)]
    series = m.history(1, "KX", at=points)
    before = [one.group for one in series]
    m.cycle(1)
    assert [one.group for one in series] != before
    assert np.concatenate([one.numbers[:, 2] for one in series]).tolist() == [1.5, 1.5, 17.5, 17.5]


def jointed(tmp_path: Path) -> Model:
    """Two blocks side by side on a bed joint with a joint material, which leans them; 1980 between them."""
    m = Model(out=tmp_path)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.jproperty(1, kn=1e8, ks=1e8, friction=0.5, cohesion=1e3)
    m.block(0, 0, 0, 3, 4, 3, 4, 0)
    m.split(-1, 1, 5, 1, joint=1, jmaterial=1)
    m.split(2, 1, 2, 4)
    m.fix(0, 4, 0, 1)
    m.round(0.05)
    m.gravity(3, -10)
    m.damping(local=0.8)
    return m


def test_a_joint_at_a_place_is_that_of_the_nearest_contact_that_has_one(tmp_path: Path) -> None:
    """Every field of the joint, through all cycles: what the table has; the place is that of the contact."""
    m = jointed(tmp_path)
    fields = ("KCJSN", "KCJTS", "KCJSLIP", "KCJL", "KCJFLAG")
    series = [m.history(1, field, at=(2.2, 1.6))[0] for field in fields]
    contacts, joints = m.table("contact"), m.table("joint")
    near = np.hypot(contacts["KXC"] - 2.2, contacts["KYC"] - 1.6)
    assert joints["KCJMAT"][near.argmin()] == 0  # between the two blocks
    near[joints["KCJMAT"] == 0] = np.inf
    k = int(near.argmin())
    assert {one.group for one in series} == {f"joint@{joints['address'][k]}"}
    assert series[0].place == "({:.4g}, {:.4g})".format(contacts["KXC"][k], contacts["KYC"][k])
    seen = []
    for _ in range(50):
        m.cycle(1)
        row = m.table("joint")[k]
        seen.append([float(row[field]) for field in fields])
    assert np.array([one.numbers[1:, 2] for one in series]).T.tolist() == seen
    assert seen[-1][0] > 0


def test_a_joint_is_lost_with_its_contact_and_an_edge_stays(tmp_path: Path) -> None:
    m = jointed(tmp_path)
    (one,) = m.history(1, "KCJSN", at=(0.1, 1))
    (edge,) = m.history(1, "KEJ", at=(4, 1))
    m.cycle(5)
    at = int(definitions(m.array)[0].address)
    assert one.numbers[-1, 2] == m.table("joint")["KCJSN"][m.table("joint")["address"] == at][0]
    corners, edges = m.table("corner"), m.table("edge")
    there = edges["address"] == int(edge.group.split("@")[1])
    assert np.hypot(corners["KXP"][there] - 4, corners["KYP"][there] - 1) < 0.01
    assert edge.numbers[-1, 2] == edges["KEJ"][there][0]
    m.delete(0, 2, 1, 4)
    m.cycle(5)
    assert np.isnan(one.numbers[-1, 2])
    assert not edge.lost


def test_a_joint_is_asked_for_where_there_is_none(tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    with pytest.raises(UdecError) as raised:
        m.history(1, "KCJSN", at=(0, 0))
    assert raised.value.number == 26
    m.split(-9, 0.5, 9, 0.5, joint=1)  # edges have numbers now, contacts no joint materials
    with pytest.raises(UdecError) as raised:
        m.history(1, "KCJSN", at=(0, 0))
    assert raised.value.number == 26
