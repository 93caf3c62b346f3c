"""Files that are extended in two copies that take turns: whole at every moment, whatever happens."""

from __future__ import annotations

import os
from pathlib import Path

import h5py
import numpy as np
import pytest
from support.mechanics_scenes import G

from udec_ia import Model, UdecError
from udec_ia.output.history_files import GrowingFile


class Text:
    """Lines to be kept in a file; how often the whole was written."""

    def __init__(self, path: Path) -> None:
        self.turns = GrowingFile(path)
        self.lines: list[str] = []
        self.wholes = 0

    def whole(self) -> bytes:
        self.wholes += 1
        return "".join(self.lines).encode()

    def extend(self, copy: Path, mark: int) -> None:
        with copy.open("a") as file:
            file.writelines(self.lines[mark:])

    def add(self) -> None:
        self.lines.append(f"line {len(self.lines)}\n")
        self.turns.put(len(self.lines), self.whole, self.extend)


def test_two_copies_take_turns(tmp_path: Path) -> None:
    path = tmp_path / "new" / "text"
    text = Text(path)
    for n in range(1, 7):
        text.add()
        assert path.read_text() == "".join(text.lines)
        assert text.wholes == min(n, 2)
    text.turns.close()
    assert [one.name for one in path.parent.iterdir()] == ["text"]
    text.add()
    assert path.read_text() == "".join(text.lines)


def test_what_is_interrupted_is_not_in_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a line has been written to the hidden copy: the file has none of it, then or later."""
    text = Text(tmp_path / "text")
    for _ in range(4):
        text.add()
    before = (tmp_path / "text").read_text()

    def half(copy: Path, mark: int) -> None:
        with copy.open("a") as file:
            file.write("li")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        text.turns.put(5, text.whole, half)
    assert (tmp_path / "text").read_text() == before
    for _ in range(3):
        text.add()
        assert (tmp_path / "text").read_text() == "".join(text.lines)


@pytest.mark.parametrize("name", ["text", ".udec-*.tmp"])
@pytest.mark.parametrize("what", ["goes", "changes"])
def test_what_somebody_else_has_changed_is_written_anew(tmp_path: Path, name: str, what: str) -> None:
    text = Text(tmp_path / "text")
    for _ in range(4):
        text.add()
    (file,) = tmp_path.glob(name)
    if what == "goes":
        file.unlink()
    else:
        file.write_text("line 0 and something else\n")
    for _ in range(3):
        text.add()
        assert (tmp_path / "text").read_text() == "".join(text.lines)


def test_a_file_of_another_kind_that_comes_between_stays(tmp_path: Path) -> None:
    text = Text(tmp_path / "text")
    text.add()
    text.add()
    (tmp_path / "text").write_text("notes\n")
    with pytest.raises(UdecError) as caught:
        text.add()
    assert caught.value.number == 31
    assert (tmp_path / "text").read_text() == "notes\n"
    assert len(list(tmp_path.iterdir())) == 1


def test_hidden_files_of_others_stay_and_a_mode_is_kept(tmp_path: Path) -> None:
    others = tmp_path / ".text", tmp_path / ".text.last"
    for other in others:
        other.write_text("notes\n")
    text = Text(tmp_path / "text")
    for n in range(5):
        text.add()
        if n == 1:
            (tmp_path / "text").chmod(0o600)
    assert (tmp_path / "text").stat().st_mode & 0o777 == 0o600
    text.turns.close()
    assert [other.read_text() for other in others] == ["notes\n"] * 2


def test_a_file_system_without_second_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, "link", refuse)
    text = Text(tmp_path / "text")
    for n in range(1, 5):
        text.add()
        assert (tmp_path / "text").read_text() == "".join(text.lines)
        assert text.wholes == n
    assert [one.name for one in tmp_path.iterdir()] == ["text"]


def falling(out: Path) -> Model:
    m = Model(out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.gravity(0, -G)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1)
    m.fix(0, 2, 0, 1)
    m.history(1, "KY", at=(1, 1.5))
    m.history(3, "unbalanced")
    return m


def test_many_short_cycles_leave_the_files_of_one_long_one(tmp_path: Path) -> None:
    """Also while somebody holds them open; a history that is added on the way makes a new column."""
    one, many = falling(tmp_path / "one"), falling(tmp_path / "many")
    one.cycle(26)
    recorded = 1
    for n in range(12):
        many.cycle(2)
        many.cycle(0)
        recorded += 2
        with h5py.File(tmp_path / "many" / "udec-history.h5") as file:
            assert len(file["1/value"]) == recorded
            if n in (4, 9):
                many.cycle(1)
                recorded += 1
    for m in (one, many):
        m.history(5, "TIME")
        m.cycle(10)
        m.stop()
    texts = [(tmp_path / name / "udec-history.csv").read_text() for name in ("one", "many")]
    assert texts[0] == texts[1]
    for m, name in ((one, "one"), (many, "many")):
        with h5py.File(tmp_path / name / "udec-history.h5") as file:
            for series in m.histories():
                group = file[str(series.number)]
                written = np.column_stack([group[column] for column in ("cycle", "time", "value")])
                assert np.array_equal(written, series.numbers)
        assert sorted(path.name for path in (tmp_path / name).iterdir()) == [
            "udec-history.csv",
            "udec-history.h5",
        ]
