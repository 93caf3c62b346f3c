"""HISTORY: what is recorded is what the tables show, whatever becomes of the run and of the group."""

from __future__ import annotations

import csv
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from handmade import two_blocks
from kinds import GROUPS, every_kind
from mechanics import at, block, on_base, push
from naive.relocate import relocate

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import getr, iget, puti
from udec_ia.heap.memory import find, lose
from udec_ia.inspect.check import check, check_links
from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table
from udec_ia.ops.commands.history import define, definitions, named
from udec_ia.ops.commands.recordable import recordable
from udec_ia.ops.run.watch import ROWS, Watch
from udec_ia.output.graph import figure

KINDS = ("block", "corner", "contact", "domain")


def standing(out: Path, **numbers: Any) -> Model:
    """A block of 1 by 1 at rest on a fixed base; two contacts, which carry no force yet."""
    m = on_base(1.0, 1.0, 0.1, 4.0, friction=0.5, **numbers)
    m.out = out
    return m


def value(m: Model, kind: str, address: int, field: str) -> float:
    """The field of one group, by the table; NaN if there is no such group."""
    rows = m.table(kind)
    (found,) = rows[field][rows["address"] == address] if address in rows["address"] else (np.nan,)
    return float(found)


def test_every_field_of_every_kind_of_group_is_recorded(tmp_path: Path) -> None:
    """Cycle by cycle the same, bit for bit, as the tables of the same run without these histories.

    Every CYCLE finds a time-step for the zones as they are, so both runs are cut into the same pieces.
    """
    m, twin = every_kind(), every_kind()
    m.out = twin.out = tmp_path
    before = len(m.histories())
    for one in (m, twin):
        one.cycle(5)
    wanted = []
    for group in GROUPS:
        address = int(m.table(group.name)["address"][-1])
        for field in group.fields:
            if field.role != "head" and field.count == 1 and group.name != "history":
                m.history(1, field.name, address)
                wanted.append((group.name, address, field.name))
    m.history(1, "time")
    m.history(1, "MCTOT")
    seen = []
    for k in range(12):
        for one in (m, twin):
            one.cycle(int(k > 0))
        seen.append([value(twin, *one) for one in wanted] + [twin.h.cd[g.TIME], twin.h.ci[g.MCTOT]])
    recorded = np.column_stack([one.numbers[:, 2] for one in m.histories()[before:]])
    assert np.array_equal(recorded, np.array(seen, float))
    assert np.array_equal(m.histories()[before].numbers[:, 0], np.arange(5, 17))
    assert np.array_equal(m.histories()[-1].numbers[:, 1], recorded[:, -2])


def test_what_has_no_single_number_is_not_recorded() -> None:
    names = recordable()
    fields = [field for group in read_table().groups for field in group.fields]
    histories = {field.name for field in read_table().group("history").fields}
    assert {f.name for f in fields if f.count == 1} - names.keys() == {"HEAD"} | histories
    assert {f.name for f in read_table().common if f.count == 1} <= names.keys()
    assert names.keys().isdisjoint({"KZG", "AKN", "HEAD"})


def state(m: Model) -> list[Any]:
    return [m.table(kind).tolist() for kind in KINDS] + [m.h.cr.tolist(), m.h.cd.tolist()]


def test_recording_changes_nothing_and_does_not_depend_on_the_commands(tmp_path: Path) -> None:
    """Multiples of n only, each once, over CYCLE commands of any length; more rows than fit at once."""
    plain = standing(tmp_path / "plain")
    plain.damping(0.3, 10)
    plain.cycle(ROWS + 700)
    runs = []
    for pieces in ([ROWS + 700], [1, 1, 5, 0, ROWS, 693]):
        m = standing(tmp_path / str(len(pieces)))
        m.damping(0.3, 10)
        m.history(1, "KY", at=(0, 0.5))
        m.history(7, "unbalanced")
        m.history(40, "KY", at=(0, 0.5))
        for n in pieces:
            m.cycle(n)
        assert state(m) == state(plain)
        runs.append([one.numbers for one in m.histories()])
    for one, other in zip(*runs, strict=True):
        assert np.array_equal(one, other)
    every, by_seven, by_forty = runs[0]
    assert np.array_equal(every[:, 0], np.arange(ROWS + 701))
    assert np.array_equal(by_seven[:, 0], np.arange(0, ROWS + 701, 7))
    assert np.array_equal(by_forty, every[::40])


def test_a_group_that_has_gone_leaves_nan_and_is_told_once(tmp_path: Path) -> None:
    """A block that jumps loses a contact; landing makes a new one at the same address."""
    m, told = standing(tmp_path, fraction=0.5), []
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
        f"history {one.number}: {one.group} has gone, NaN is recorded from now on"
        for one in m.histories()
        if one.lost
    ]


def test_a_deleted_block_is_not_followed(tmp_path: Path) -> None:
    m, told = standing(tmp_path), []
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
    whole, first = standing(tmp_path / "whole"), standing(tmp_path / "first")
    for m in (whole, first):
        m.history(3, "KY", at=(0, 0.5))
        m.history(4, "KCFN", at=(1, 0))
        m.damping(0.3, 10)
    whole.cycle(50)
    whole.cycle(60)
    first.cycle(50)
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
    m = standing(tmp_path)
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
    m, told = standing(tmp_path), []
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
    m, moved = standing(tmp_path), standing(tmp_path)
    for one in (m, moved):
        one.history(1, "KXP", at=(0.5, 1))
        one.history(1, "KY", at=(0, 0.5))
        one.history(1, "KCFN", at=(1, 0))
    moved.array = relocate(moved.array, np.random.default_rng(1))
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


def test_a_point_means_the_nearest_group(tmp_path: Path) -> None:
    """By brute force over the tables; a domain is where its contacts are on the mean."""
    m = standing(tmp_path)
    m.split(-9, 0.5, 9, 0.5)
    m.split(0, 0.4, 0, 2)
    m.cycle(1)
    rng = np.random.default_rng(5)
    contacts = m.table("contact")
    real = contacts[contacts["KCCOD"] != 4]
    places: dict[str, dict[int, Any]] = {
        "KX": {row["address"]: (row["KX"], row["KY"]) for row in m.table("block")},
        "KXP": {row["address"]: (row["KXP"], row["KYP"]) for row in m.table("corner")},
        "KCN": {row["address"]: (row["KXC"], row["KYC"]) for row in real},
        "KPP": {
            address: np.mean([(c["KXC"], c["KYC"]) for c in real if address in (c["KD1"], c["KD2"])], axis=0)
            for address in m.table("domain")["address"]
            if address != m.h.ci[g.IODPNT]
        },
    }
    for field, where in places.items():
        for point in rng.uniform((-2.5, -1.5), (2.5, 1.5), (25, 2)).tolist():
            (one,) = m.history(1, field, at=[point])
            distance = {a: np.hypot(p[0] - point[0], p[1] - point[1]) for a, p in where.items()}
            assert distance[int(one.group.split("@")[1])] == pytest.approx(min(distance.values()))


def test_what_belongs_to_deformable_blocks_is_found_by_points(tmp_path: Path) -> None:
    """Extensions are where the block is, zones amid grid-points, conditions where their subjects are."""
    m = every_kind()
    m.out = tmp_path

    def chosen(field: str, *at: float) -> int:
        return int(m.history(1, field, at=at)[0].group.partition("@")[2])

    gridpoints = {(r["KXG"], r["KYG"]): r["address"] for r in m.table("gridpoint")}
    assert chosen("KXDG", 3.55, 0.6) == gridpoints[3.5, 0.5]
    zone = at(m, "zone", chosen("KZS11", 3.5, 0.9))
    corners = [at(m, "gridpoint", int(address)) for address in zone["KZG"]]
    assert sorted((p["KXG"], p["KYG"]) for p in corners) == [(3, 1), (3.5, 0.5), (4, 1)]
    for x, extension in ((1.5, "KS111"), (4.5, "KFNG")):
        assert chosen(extension, x, 0.6) == block(m, x, 0.5)["KBEX"]
    assert at(m, "bound", chosen("KUVX", 0.5, 0.5))["KUB"] == block(m, 0.5, 0.5)["address"]
    assert at(m, "bound", chosen("KUFX", 3, 1.1))["KUG"] == gridpoints[3, 1]
    edge = at(m, "bound", chosen("KUCXX", 6, 0.8))
    assert edge["KUB"] == block(m, 5.5, 0.5)["address"]
    assert edge["KUP"] != 0
    with pytest.raises(UdecError, match="give its address"):
        m.history(1, "KTNOW", at=(0, 0))


def test_files_say_what_was_recorded(tmp_path: Path) -> None:
    m = standing(tmp_path)
    m.name = "scene"
    m.history(2, "KY", at=(0, 0.5))
    m.history(3, "unbalanced")
    m.cycle(7)
    with (tmp_path / "scene-history.csv").open() as file:
        head, *rows = csv.reader(file)
    address = block(m, 0, 0.5)["address"]
    assert head == ["cycle", "time (s)", f"1: KY of block@{address} (m)", "2: UNBALANCED (N/m)"]
    assert [int(row[0]) for row in rows] == [0, 2, 3, 4, 6]
    assert [bool(row[2]) for row in rows] == [True, True, False, True, True]
    with h5py.File(tmp_path / "scene-history.h5") as file:
        for number, one in enumerate(m.histories(), 1):
            group = file[str(number)]
            numbers = np.column_stack([group[name] for name in ("cycle", "time", "value")])
            assert np.array_equal(numbers, one.numbers)
            assert group.attrs["unit"].decode() == one.unit
            assert group.attrs["every"] == one.every
            written = [
                (float(row[0]), float(row[1]), float(row[1 + number])) for row in rows if row[1 + number]
            ]
            assert written == [tuple(row) for row in one.numbers.tolist()]
    assert {path.suffix for path in tmp_path.iterdir()} == {".csv", ".h5"}
    assert "scene-history.csv, scene-history.h5" in m.stop()


def test_what_an_error_cuts_short_is_in_the_files(tmp_path: Path) -> None:
    """Error 15 ends the CYCLE after the cycle in which it arises, and that is recorded too."""
    m = standing(tmp_path)
    (height,) = m.history(1, "KY", at=(0, 0.5))
    push(m, int(block(m, 0, 0.5)["address"]), yd=-30.0)
    with pytest.raises(UdecError) as caught:
        m.cycle(1000)
    assert caught.value.number == 15
    assert 1 < len(height.numbers) == int(m.h.ci[g.MCTOT]) + 1
    with h5py.File(tmp_path / "udec-history.h5") as file:
        assert file["1/value"][-1] == block(m, 0, 0.5)["KY"]


def test_a_full_disk_is_error_31(tmp_path: Path) -> None:
    (tmp_path / "udec-history.h5").mkdir()
    m = standing(tmp_path)
    (height,) = m.history(1, "KY", at=(0, 0.5))
    with pytest.raises(UdecError, match=r"udec-history\.h5") as caught:
        m.cycle(3)
    assert caught.value.number == 31
    assert len(height.numbers) == 4


@pytest.mark.parametrize(
    ("what", "number", "parameter"),
    [
        ({"field": "KXX", "address": 1}, 10, "field"),
        ({"field": "AKN"}, 10, "field"),
        ({"field": "KX"}, 7, "field"),
        ({"field": "KX", "address": 3}, 30, "address"),
        ({"field": "KX", "address": 1, "at": (0, 0)}, 10, "at"),
        ({"field": "KX", "at": (0, 0, 1)}, 8, "at"),
        ({"field": "KX", "at": (0, np.nan)}, 28, "at"),
        ({"field": "KZM", "at": (0, 0)}, 26, "field"),
        ({"field": "TIME", "at": (0, 0)}, 10, "at"),
        ({"field": "unbalanced", "address": 1}, 10, "address"),
        ({"field": "TIME", "n": 0}, 28, "n"),
        ({"field": "TIME", "n": -3}, 28, "n"),
        ({"field": "TIME", "n": 2**31}, 28, "n"),
    ],
)
def test_wrong_parameters(what: dict[str, Any], number: int, parameter: str, tmp_path: Path) -> None:
    m = standing(tmp_path)
    before = m.h.ia.tobytes(), m.h.ci.tobytes()
    with pytest.raises(UdecError) as caught:
        m.history(**{"n": 1} | what)
    assert (caught.value.number, caught.value.parameter) == (number, parameter)
    assert (m.h.ia.tobytes(), m.h.ci.tobytes()) == before
    assert m.histories() == []


def test_no_room_for_a_history(tmp_path: Path) -> None:
    m = Model(mtop=110, out=tmp_path)
    m.block(0, 0, 0, 1, 1, 0)
    with pytest.raises(UdecError, match="main array has 110"):
        m.history(1, "KX", at=[(0, 0)] * 4)
    assert m.histories() == []
    assert m.h.ci[g.IHPNT] == 0


@pytest.mark.parametrize(("field", "number"), [("KHK", 99), ("KHF", 999), ("KHN", 0), ("KHG", "corner")])
def test_the_checker_knows_histories(field: str, number: int | str, tmp_path: Path) -> None:
    m = standing(tmp_path)
    m.history(5, "KY", at=(0, 0.5))
    m.history(5, "TIME")
    assert check(m.array) == []
    address = int(m.table("history")["address"][0])
    puti(
        m.h,
        address,
        getattr(g, field),
        int(m.table("corner")["address"][0]) if number == "corner" else int(number),
    )
    broken = [violation.message for violation in check_links(m.array)]
    assert any(field in message and f"history@{address}" in message for message in broken)


def test_a_damaged_history_stops_the_next_cycle(tmp_path: Path) -> None:
    m = standing(tmp_path)
    m.history(5, "KY", at=(0, 0.5))
    m.rset(1e300, int(m.table("history")["address"][0]), 2)
    with pytest.raises(UdecError) as caught:
        m.cycle(1)
    assert caught.value.number == 20


def test_print_and_dump_show_histories(tmp_path: Path) -> None:
    m = standing(tmp_path)
    assert "No histories" in m.print("histories")
    m.history(5, "KY", at=(0, 0.5))
    m.cycle(10)
    (group,) = m.table("history")
    line = m.print("histories").splitlines()[-1].split()
    assert line[:4] == ["1:", "KY", f"block@{group['KHG']}", "(0,"]
    assert line[4:7] == ["0.5)", "5", "3"]
    dumped = m.dump(int(group["address"]), int(group["address"]) + 7)
    assert all(part in dumped for part in (f"history@{group['address']}", f"KHG={group['KHG']}", "MHIS"))


def test_a_deck_says_what_it_records(tmp_path: Path) -> None:
    m = standing(tmp_path)
    printed = m.run("HIS 10 KXD AT 0,0.5 0,-1\nHISTORY 5 UNB\nHISTORY 1 time\nCYCLE 5\nPLOT HISTORY\nP HIS\n")
    assert printed is not None
    lines = printed.splitlines()
    mine, base = block(m, 0, 0.5)["address"], block(m, 0, -0.5)["address"]
    assert lines[1] == f"history 1: KXD of block@{mine} at (0, 0.5), every 10 cycles: x velocity"
    assert lines[2].startswith(f"history 2: KXD of block@{base} at (0, -0.5), every 10")
    assert "history 4: TIME, every cycle: time since the first cycle" in lines
    files = [Path(line.split(": ")[1]) for line in lines if line.startswith("written")]
    assert [path.name for path in files] == ["udec-history-1.png", "udec-history-1.svg"]
    assert all(path.stat().st_size > 1000 for path in files)


def test_a_loss_is_told_in_the_deck(tmp_path: Path) -> None:
    m = standing(tmp_path)
    m.split(-9, 0.5, 9, 0.5)
    printed = m.run("HISTORY 1 KY AT 0,0.75\nDELETE -1 1 0.6 0.9\nCYCLE 1\n")
    assert printed is not None
    assert re.search(r"^ CYCLE: history 1: block@\d+ has gone, NaN", printed, re.MULTILINE)


def test_the_picture(tmp_path: Path) -> None:
    """A panel for each field, a curve for each history that breaks off where its group has gone."""
    m = standing(tmp_path)
    m.tell = lambda text: None
    with pytest.raises(UdecError, match="nothing was recorded"):
        m.plot(history=True)
    m.split(-9, 0.5, 9, 0.5)
    m.history(1, "KY", at=[(0, 0.75), (0, 0.25)])
    m.history(2, "unbalanced")
    m.cycle(4)
    m.delete(-1, 1, 0.6, 0.9)
    m.cycle(4)
    upper, lower = figure(m.histories(), "scene").axes
    assert (upper.get_ylabel(), lower.get_ylabel()) == ("KY (m)", "UNBALANCED (N/m)")
    assert [len(axes.lines) for axes in (upper, lower)] == [2, 1]
    gone, stays = (np.asarray(line.get_ydata()) for line in upper.lines)
    assert np.isnan(gone).tolist() == [False] * 5 + [True] * 4
    assert not np.isnan(stays).any()
    assert upper.get_legend() is not None
    with pytest.raises(UdecError) as caught:
        m.plot(0, history=True)
    assert caught.value.number == 10


SCHEMES = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from mechanics import on_base
for build in ("i16r32", "i32r32", "i16r64", "i32r64", "i64r64"):
    m = on_base(1.0, 1.0, 0.1, 4.0, build=build)
    m.out = Path(sys.argv[2]) / build
    m.history(1, "KCFN", at=(1, 0))
    m.history(1, "KCM", at=(1, 0))
    m.history(1, "ratio")
    address = int(m.history(1, "KY", at=(0, 0.5))[0].group.split("@")[1])
    seen = []
    for _ in range(25):
        contacts, blocks = m.table("contact"), m.table("block")
        nearest = contacts[contacts["KXC"] > 0][0]
        row = blocks[blocks["address"] == address][0]
        seen.append((float(nearest["KCFN"]), 1.0, float(row["KY"])))
        m.cycle(1)
    force, material, _, height = (one.numbers[:-1, 2].tolist() for one in m.histories())
    assert list(zip(force, material, height)) == seen, build
    assert not m.check(), build
"""


def test_all_word_schemes_interpreted(tmp_path: Path) -> None:
    """The kernels' source on every scheme, against the tables; compiled, the default scheme above."""
    tests = Path(__file__).parents[1]
    subprocess.run(
        [sys.executable, "-c", SCHEMES, str(tests), str(tmp_path)],
        env={**os.environ, "PYTHONPATH": str(tests.parent), "NUMBA_DISABLE_JIT": "1"},
        timeout=300,
        check=True,
    )


def test_a_watch_on_a_bare_array_makes_its_own_series() -> None:
    array = two_blocks()
    define(array, named("KX"), [int(array.h.ci[g.IBPNT])], 2)
    watch = Watch(array, [])
    watch.begin()
    assert watch.series[0].numbers.tolist() == [[0.0, 0.0, 0.5]]
    assert iget(array.h, int(array.h.ci[g.IHPNT]), g.KHN) == 2
    assert getr(array.h, int(array.h.ci[g.IBPNT]), g.KX) == 0.5
