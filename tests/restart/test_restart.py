"""SAVE and RESTART: the state comes back bit for bit, and no failure costs the file that was there."""

from __future__ import annotations

import errno
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas
import pytest
from support.every_group_kind import every_kind
from support.handmade_map import two_blocks
from support.mechanics_scenes import box, model, on_base
from trials.interrupted_processes import kill_saves

from udec_ia import Model
from udec_ia.checker import check_links
from udec_ia.errors import MESSAGES, UdecError
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES, scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import lay_out, read_table
from udec_ia.restart import info, load, save
from udec_ia.restart import restart_writer as writing

SCHEMES = tuple(ALL_SCHEMES)
DECK = ["START", "* a comment with \u00e9 and a stray byte \udcff", "", "CYCLE 100"]
DOC = Path(__file__).parents[2] / "docs" / "restart-format.md"


def parts(array: MainArray) -> list[tuple[bytes, str]]:
    """The whole state: bytes and type of each of the four views."""
    return [(view.tobytes(), view.dtype.str) for view in array.h]


def same(one: MainArray, other: MainArray) -> bool:
    return parts(one) == parts(other) and (one.scheme, one.fixed) == (other.scheme, other.fixed)


@pytest.mark.parametrize("name", SCHEMES)
def test_state_and_deck_come_back(name: str, tmp_path: Path) -> None:
    array = two_blocks(name)
    before = parts(array)
    path = save(array, tmp_path / "deeper" / "two.h5", DECK)
    assert parts(array) == before
    restored, deck, *_ = load(path)
    assert same(array, restored)
    assert deck == DECK
    assert not np.shares_memory(restored.h.ia, array.h.ia)


@pytest.mark.parametrize("name", SCHEMES)
def test_empty_array_comes_back(name: str, tmp_path: Path) -> None:
    array = MainArray(scheme(name))
    restored, deck, *_ = load(save(array, tmp_path / "empty.h5"))
    assert same(array, restored)
    assert deck == []


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("mtop", [1, 2000])
def test_fixed_size_comes_back(name: str, mtop: int, tmp_path: Path) -> None:
    array = MainArray(scheme(name), mtop)
    restored, _, *_ = load(save(array, tmp_path / "fixed.h5"))
    assert same(array, restored)
    assert restored.limit == array.limit


@pytest.mark.parametrize("name", SCHEMES)
def test_junk_and_growth_come_back(name: str, tmp_path: Path) -> None:
    array = two_blocks(name)
    groups = [find(array.h, g.NVCN) for _ in range(3)]
    for group in groups:
        lose(array.h, group, g.NVCN)
    array.h.ci[g.NWANT] = len(array.h.ia)
    assert array.grow()
    restored, _, *_ = load(save(array, tmp_path / "grown.h5"))
    assert same(array, restored)
    assert find(restored.h, g.NVCN) == find(array.h, g.NVCN) == groups[-1]


@pytest.mark.parametrize("name", SCHEMES)
def test_every_bit_of_a_real_comes_back(name: str, tmp_path: Path) -> None:
    """Not-a-numbers with a payload, signed zeros and infinities are states too: a run that blew up."""
    array = two_blocks(name)
    quiet = array.scheme.real_type.type("nan").tobytes()
    odd = np.frombuffer(bytes([quiet[0] | 1]) + quiet[1:], array.scheme.real_type)[0]
    array.h.cr[g.AKN : g.AKN + 4] = [odd, -0.0, np.inf, np.finfo(array.scheme.real_type).smallest_subnormal]
    assert same(array, load(save(array, tmp_path / "odd.h5"), unchecked=True).array)


def masked(path: Path) -> tuple[bytes, bytes]:
    """The HDF5 part with the contents of /volatile blotted out, and the seal without its checksum."""
    data = bytearray(path.read_bytes())
    with h5py.File(path) as file:
        for dataset in file["volatile"].values():
            start, size = dataset.id.get_offset(), dataset.dtype.itemsize
            data[start : start + size] = bytes(size)
    return bytes(data[512:]), re.sub(rb"sha256 [0-9a-f]{64}", b"", data[:512])


@pytest.mark.parametrize("name", SCHEMES)
def test_repeated_saves_differ_in_volatile_only(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    array = two_blocks(name)
    one = save(array, tmp_path / "one.h5", DECK)
    monkeypatch.setattr(writing, "_now", lambda: "1980-03-01T00:00:00Z")
    monkeypatch.setattr(writing.platform, "node", lambda: "another-machine")
    two = save(array, tmp_path / "two.h5", DECK)
    assert one.read_bytes() != two.read_bytes()
    assert masked(one) == masked(two)
    assert save(array, tmp_path / "three.h5", DECK).read_bytes() == two.read_bytes()


def test_a_restored_state_is_saved_alike(tmp_path: Path) -> None:
    array = two_blocks()
    one = save(array, tmp_path / "one.h5", DECK)
    two = save(*load(one)[:1], tmp_path / "two.h5", load(one)[1])
    assert masked(one) == masked(two)


def fail(code: int) -> Any:
    def failing(*_: object) -> None:
        raise OSError(code, os.strerror(code))

    return failing


@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_failing_write_leaves_the_old_file(
    step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = save(MainArray(scheme("i32r64")), tmp_path / "run.h5")
    old = path.read_bytes()
    if step == "fsync":
        monkeypatch.setattr(os, "fsync", fail(errno.ENOSPC))
    else:
        monkeypatch.setattr(Path, "replace", fail(errno.ENOSPC))
    with pytest.raises(UdecError, match=r"run\.h5: No space left") as caught:
        save(two_blocks(), path)
    assert caught.value.number == 31
    assert caught.value.advice
    assert path.read_bytes() == old
    assert list(tmp_path.iterdir()) == [path]


def test_writing_into_a_folder_or_below_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    for path in (tmp_path / "folder", tmp_path / "file" / "run.h5"):
        with pytest.raises(UdecError, match="cannot be written") as caught:
            save(two_blocks(), path)
        assert caught.value.number == 31
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["file", "folder"]


def test_file_modes_follow_the_user(tmp_path: Path) -> None:
    (tmp_path / "plain").touch()
    path = save(two_blocks(), tmp_path / "run.h5")
    assert path.stat().st_mode == (tmp_path / "plain").stat().st_mode


KILLED = """
import os, signal, sys
sys.path.insert(0, sys.argv[2])
from support.handmade_map import two_blocks
from support.mechanics_scenes import box, model
from udec_ia.restart import save
os.fsync = lambda handle: os.kill(os.getpid(), signal.SIGKILL)
save(two_blocks(), sys.argv[1])
"""


def test_a_kill_while_saving_leaves_the_old_file(tmp_path: Path) -> None:
    path = save(MainArray(scheme("i64r64")), tmp_path / "run.h5", DECK)
    tests = str(Path(__file__).parents[1])
    root = str(Path(__file__).parents[2])
    done = subprocess.run(
        [sys.executable, "-c", KILLED, str(path), tests],
        env={**os.environ, "PYTHONPATH": root},
        timeout=120,
        check=False,
    )
    assert done.returncode == -9
    assert load(path)[1] == DECK
    leftover = [p for p in tmp_path.iterdir() if p != path]
    assert [p.suffix for p in leftover] == [".tmp"]


def test_kills_at_any_moment_of_a_save_leave_the_old_file_or_the_new_one() -> None:
    """A part of what tools/robustness.py interrupts tries."""
    assert kill_saves(15, seed=3, seconds=60) == []


@pytest.mark.parametrize("name", SCHEMES)
def test_the_file_explains_itself(name: str, tmp_path: Path) -> None:
    """The program printed in the document reads the blocks with h5py and NumPy alone."""
    array = two_blocks(name)
    path = save(array, tmp_path / "two.h5")
    (program,) = re.findall(r"```python\n(.*?)```", DOC.read_text(), re.S)
    assert "udec" not in program.replace("out/restart.h5", "")
    result: dict[str, Any] = {}
    exec(program.replace("out/restart.h5", str(path)), result)
    assert result["blocks"] == [(0.5, 0.5), (0.5, 1.5)]


def test_layout_and_commons_are_in_the_file(tmp_path: Path) -> None:
    table = read_table()
    with h5py.File(save(two_blocks("i16r64"), tmp_path / "two.h5")) as file:
        assert list(file["common"]) == sorted(field.name for field in table.common)
        assert file["common/AKN"].shape == (50,)
        assert file["common/GRAVY"][()] == -10.0
        for group in table.groups:
            layout = lay_out(group, 4)
            rows = file[f"layout/{group.name}"]
            assert [row["name"].decode() for row in rows] == [field.name for field in group.fields]
            assert dict(zip(layout.offset, rows["offset"].tolist(), strict=True)) == layout.offset
            assert rows.attrs["size"] == layout.size


def test_front_can_be_read_by_a_person(tmp_path: Path) -> None:
    front = save(two_blocks(), tmp_path / "two.h5").read_bytes()[:512].decode("ascii")
    assert front.startswith("udec_ia restart file\nformat 1.3\nbytes ")
    assert front.endswith("\n")


@pytest.mark.parametrize("name", SCHEMES)
def test_info(name: str, tmp_path: Path) -> None:
    array = two_blocks(name)
    array.h.ci[g.MCTOT], array.h.cd[g.TIME] = 1234, 0.5
    path = save(array, tmp_path / "two.h5", DECK)
    lines = dict(line.split(maxsplit=1) for line in info(path).splitlines())
    assert lines["file"] == str(path)
    assert lines["words"].startswith(name)
    assert lines["layout"] == "that of this program"
    assert lines["IA()"] == f"{array.h.ci[g.MFREE] - 1} words in use; its size grows as needed"
    assert lines["model"] == "2 blocks, 2 contacts (0 virtual), 2 domains"
    assert lines["run"].startswith("1234 cycles, time 0.5 s")
    assert lines["deck"] == "4 command lines"


def test_what_rset_has_bent_is_not_cut_after_a_restart(tmp_path: Path) -> None:
    """An outline that crosses itself would lead SPLIT astray; put right again, it is cut."""
    m = model(*box(0, 4, 0, 2), d=0.1)
    m.split(-1, 1, 5, 1)
    corner = m.table("corner")[0]
    offset = g.KXP[m.array.scheme.ratio >> 1]
    m.rset(float(corner["KXP"]) + 9, int(corner["address"]), offset)
    other = Model.restore(save(m.array, tmp_path / "bent.h5", []), unchecked=True)
    for one in (m, other):
        with pytest.raises(UdecError) as refused:
            one.split(2, -1, 2, 3)
        assert refused.value.number == 20
        one.rset(float(corner["KXP"]), int(corner["address"]), offset)
        assert one.split(2, -1, 2, 3) == 2


def test_what_an_error_of_the_run_has_spoilt_says_so_when_it_is_taken_up_again(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    m = on_base(b=4, h=2, d=0.1, width=6)
    m.cycle(1)
    Model.restore(m.save(tmp_path / "before.h5"))
    assert "run of this state" not in caplog.text
    m.boundary(-2, 2, 0.5, 4, yvel=-2 * m.h.cr[g.DTOL] / m.h.cr[g.TDEL])
    with pytest.raises(UdecError, match="error 15"):
        m.cycle(100)
    cycle = m.h.ci[g.MCTOT]
    again = Model.restore(m.save(tmp_path / "after.h5"))
    told = f"error 15 in cycle {cycle}, contact overlap too great, has ended a run of this state"
    assert told in caplog.text
    assert f"ended     {told}" in info(tmp_path / "after.h5")
    again.split(0, -2, 0, 4)  # what has happened has happened
    assert told in info(again.save(tmp_path / "later.h5"))
    again.start()
    assert again.h.ci[g.NSPOIL] == 0
    for number, broken in ((0, 0), (max(MESSAGES), 0), (max(MESSAGES) + 1, 1), (-1, 1)):
        again.array.h.ci[g.NSPOIL] = number
        found = [one for one in check_links(again.array) if "NSPOIL" in str(one)]
        assert len(found) == broken


def test_tables_are_the_groups_without_this_program(tmp_path: Path) -> None:
    m = every_kind(structures=True)
    with h5py.File(m.save(tmp_path / "all.h5")) as file:
        for kind in file["tables"]:
            rows, expected = file["tables"][kind][:], m.frame(kind).reset_index()
            assert list(rows.dtype.names) == list(expected.columns)
            assert pandas.DataFrame(rows).equals(expected)
            units = file["tables"][kind].attrs["units"].decode().split("\n")
            assert [one.strip("-") for one in units[1:]] == list(expected.attrs["units"].values())
            names = file["layout"][kind]["name"].astype(str).tolist()
            assert list(dict.fromkeys(name.partition("_")[0] for name in rows.dtype.names)) == [
                "address",
                *names,
            ]
        assert {"block", "contact", "zone", "displacement"} <= set(file["tables"])
