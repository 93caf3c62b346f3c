"""Histories in files, in what PRINT and DUMP show, and in pictures."""

from __future__ import annotations

import csv
from pathlib import Path

import h5py
import numpy as np
import pytest
from support.mechanics_scenes import block, push, standing_block

from udec_ia import UdecError
from udec_ia.layout import offsets as g
from udec_ia.output.history_graph import Wanted, figure


def test_files_say_what_was_recorded(tmp_path: Path) -> None:
    m = standing_block(tmp_path)
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
    m = standing_block(tmp_path)
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
    m = standing_block(tmp_path)
    (height,) = m.history(1, "KY", at=(0, 0.5))
    with pytest.raises(UdecError, match=r"udec-history\.h5") as caught:
        m.cycle(3)
    assert caught.value.number == 31
    assert len(height.numbers) == 4


def test_print_and_dump_show_histories(tmp_path: Path) -> None:
    m = standing_block(tmp_path)
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
    m = standing_block(tmp_path)
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


def test_the_picture(tmp_path: Path) -> None:
    """A panel for each field, a curve for each history that breaks off where its group has gone."""
    m = standing_block(tmp_path)
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
    assert (upper.get_ylabel(), lower.get_ylabel()) == ("KY (m)", "UNBALANCED (kN/m)")
    assert [len(axes.lines) for axes in (upper, lower)] == [2, 1]
    gone, stays = (np.asarray(line.get_ydata()) for line in upper.lines)
    assert np.isnan(gone).tolist() == [False] * 5 + [True] * 4
    assert not np.isnan(stays).any()
    assert upper.get_legend() is not None
    with pytest.raises(UdecError) as caught:
        m.plot(0, history=True)
    assert caught.value.number == 10


def test_one_history_against_another(tmp_path: Path) -> None:
    """The numbers of the cycles that both have: those of the files, and in one unit for each axis."""
    m = standing_block(tmp_path)
    m.history(2, "KY", at=[(0, 0.5), (0, -0.5)])
    m.history(3, "KYD", at=(0, 0.5))
    m.cycle(13)
    upper, lower, speed = (one.numbers for one in m.histories())
    both = np.intersect1d(upper[:, 0], speed[:, 0])
    (axes,) = figure(m.histories(), "scene", Wanted(1, against=3)).axes
    (line,) = axes.lines
    largest = np.abs(speed[np.isin(speed[:, 0], both), 2]).max()
    unit, size = ("µm/s", 1e-6) if largest < 1e-4 else ("mm/s", 1e-3) if largest < 0.1 else ("m/s", 1.0)
    assert axes.get_xlabel().startswith("KYD 3: block@")
    assert axes.get_xlabel().endswith(f"({unit})")
    np.testing.assert_allclose(np.asarray(line.get_xdata()), speed[np.isin(speed[:, 0], both), 2] / size)
    np.testing.assert_array_equal(line.get_ydata(), upper[np.isin(upper[:, 0], both), 2])
    (axes,) = figure(m.histories(), "scene", Wanted(1, less=2, logx=True)).axes
    np.testing.assert_allclose(np.asarray(axes.lines[0].get_ydata()), upper[:, 2] - lower[:, 2])
    assert (axes.get_ylabel(), axes.get_xscale(), axes.get_yscale()) == ("KY less KY (m)", "log", "linear")
    assert len(figure(m.histories(), "scene", Wanted(2)).axes) == 1


def test_histories_that_cannot_be_compared(tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    m.history(2, "KY", at=(0, 0.5))
    m.history(1, "unbalanced")
    m.cycle(2)
    m.history(5, "KY", at=(0, 0.5))
    for words, number, parameter in (
        ({"history": 4}, 10, "history"),
        ({"history": 0}, 10, "history"),
        ({"history": 1, "less": 2}, 10, "less"),
        ({"history": True, "against": 1}, 10, "history"),
        ({"history": 1, "against": 3}, 26, "against"),
        ({"less": 1}, 10, "history"),
        ({"history": 1, "less": 1, "logy": True}, 28, "logy"),
    ):
        with pytest.raises(UdecError) as caught:
            m.plot(**words)
        assert (caught.value.number, caught.value.parameter) == (number, parameter)
    assert not list(tmp_path.glob("*.png"))


def test_words_of_histories_in_a_deck(tmp_path: Path) -> None:
    """HISTORY with and without a number, and the line that a call in Python is."""
    m = standing_block(tmp_path)
    m.history(1, "KY", at=[(0, 0.5), (0, -0.5)])
    m.cycle(2)
    m.plot(history=1, less=2, against=1, logy=True)
    m.plot(history=True)
    last = m.deck().splitlines()[-2:]
    assert last == ["PLOT HISTORY 1 LESS 2 AGAINST 1 LOGY", "PLOT HISTORY"]
    printed = m.run("\n".join(last) + "\n")
    assert printed is not None
    assert printed.count("written: ") == 4


@pytest.mark.parametrize("words", ["1 LESS", "1 AGAINST", "1 LESS 1 LESS 2", "AGAINST"])
def test_words_of_histories_that_lack_a_number_are_errors(words: str, tmp_path: Path) -> None:
    """They are not read in the words of UDEC 7, where all histories would be drawn."""
    m = standing_block(tmp_path)
    m.history(1, "KY", at=[(0, 0.5), (0, -0.5)])
    m.cycle(2)
    with pytest.raises(UdecError):
        m.run(f"PLOT HISTORY {words}\n")
    assert not list(tmp_path.glob("*.png"))
