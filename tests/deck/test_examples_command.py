"""`udec examples`: the examples are listed and copied as they are; what exists and differs stays."""

from __future__ import annotations

from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.command_line.examples_command import copy_examples, list_examples
from udec_ia.errors import UdecError

EXAMPLES = Path(__file__).parents[2] / "examples"
DECKS = {path.stem: path.read_bytes() for path in EXAMPLES.glob("*.dat")}


def test_all_are_listed_with_what_they_show() -> None:
    rows = dict(list_examples().rows)
    assert {*rows} == {*DECKS}
    assert all(10 < len(title) < 140 for title in rows.values())


def test_copies_are_the_decks_and_run(tmp_path: Path) -> None:
    assert len(copy_examples(tmp_path / "decks").head) == len(DECKS)
    assert {path.stem: path.read_bytes() for path in (tmp_path / "decks").iterdir()} == DECKS
    m = Model(out=tmp_path / "out")
    m.run(tmp_path / "decks" / "incline.dat", values={"N": 20})
    assert m.check() == []


def test_a_file_that_differs_stays_and_nothing_is_copied(tmp_path: Path) -> None:
    (tmp_path / "opening.dat").write_text("mine")
    with pytest.raises(UdecError) as caught:
        copy_examples(tmp_path, "hopper", "opening")
    assert caught.value.number == 31
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]


def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["examples", "hopper.dat", "slab"]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"hopper.dat", "slab.dat"}
    before = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    assert main(["examples", "hopper"]) == 0
    assert {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()} == before
    assert main(["examples", "nothing"]) == 2
    assert "hopper" in capsys.readouterr().err
