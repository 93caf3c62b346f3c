"""udec sweep and sweep(): the table, its files and pictures, messages, and what is refused."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from support.study_decks import PILE

from udec_ia import UdecError, sweep
from udec_ia.cli import main
from udec_ia.studies.sweep import folder_name

QUANTITIES = ("time", "v = block(1, 2.5).KYD", "solve.ratio")


@pytest.fixture
def pile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, with a deck."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pile.dat").write_text(PILE)
    return tmp_path


def test_the_table_in_all_its_forms(pile: Path) -> None:
    """Python and CSV have the same numbers, bit for bit; a failed run is a line."""
    found = sweep("pile.dat", {"F": [0.1, -1], "n": "10:20:2"}, quantities=QUANTITIES, jobs=0)
    table = found.table
    assert [*table.columns] == [
        *("run", "F", "N", "time", "v", "solve.ratio"),
        *("status", "error", "cycles", "seconds", "words", "warnings", "message"),
    ]
    assert table.columns["F"].tolist() == [0.1, 0.1, -1, -1]
    assert table.columns["N"].tolist() == [10, 20, 10, 20]
    assert table.columns["cycles"].tolist() == [10, 20, 0, 0]
    assert table.columns["status"] == ["ended", "ended", "error", "error"]
    assert np.isnan(table.columns["v"][2:]).all()
    assert table.columns["v"].tolist()[:2] == [one.quantities["v"] for one in found.results[:2]]
    names = ["pile.csv", "pile.png", "pile.svg"]
    assert found.files == [Path("pile-sweep") / name for name in names]
    with (pile / "pile-sweep" / "pile.csv").open(newline="") as file:
        rows = [*csv.DictReader(file)]
    assert [float(row["v"]) for row in rows[:2]] == table.columns["v"].tolist()[:2]
    assert [row["run"] for row in rows] == ["F=0.1,N=10", "F=0.1,N=20", "F=-1,N=10", "F=-1,N=20"]
    assert found.summary == ["4 of 4 runs: 2 ended, 2 error"]


def test_a_second_sweep_takes_what_is_there(pile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """More values are only added; another deck, or another quantity, begins anew, with a message."""
    command = ["sweep", "pile.dat", "--jobs", "0", "--set", "N=10", "--set"]
    assert main([*command, "F=0.1,0.2"]) == 0
    assert main([*command, "F=0.1,0.2,0.3"]) == 0
    printed = capsys.readouterr().out
    assert "3 of 3 runs: 3 ended\n2 runs kept, as the input is the same\n" in printed
    assert "2 of 3: N=10,F=0.2 ended, 10 cycles" in printed
    Path("pile.dat").write_text(PILE + "*\n")
    assert main([*command, "F=0.1,0.2", "--quantity", "time"]) == 0
    printed = capsys.readouterr().out
    assert "2 runs done again: deck and quantities changed\n" in printed
    assert "(done again: deck and quantities changed)" in printed
    assert "kept" not in printed


@pytest.mark.parametrize(
    ("values", "drawn"),
    [
        ({"F": [0.1, 0.2, -1]}, True),
        ({"F": 0.1, "N": [10, 20]}, True),
        ({"F": [0.1, 0.2], "N": [5, 10]}, True),
        ({"F": 0.1}, False),
        ({"KIND": ["ON", "OFF"]}, False),
        ({"F": [0.1, 0.2], "N": [5, 10], "KIND": ["ON", "OFF"]}, False),
    ],
)
def test_pictures_of_one_variable_and_of_two(values: dict[str, object], drawn: bool, pile: Path) -> None:
    deck = PILE.replace("F=0.5 N=200", "F=0.5 N=5 KIND=ON").replace("HISTORY", "ENERGY $KIND\nHISTORY")
    found = sweep(deck, values, quantities=("time", "x = max block.KX"), jobs=0, out="here")  # type: ignore[arg-type]
    kinds = {path.suffix for path in found.files}
    assert kinds == ({".csv", ".png", ".svg"} if drawn else {".csv"})
    if drawn:
        assert "x" in (pile / "here" / "deck.svg").read_text()
        assert (pile / "here" / "deck.png").stat().st_size > 5000


def test_the_command_prints_what_programs_can_read(pile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = [
        "sweep",
        "pile.dat",
        "--set",
        "F=0.1",
        "--set",
        "N=10",
        "--jobs",
        "0",
        "--quantity",
        "v = time",
    ]
    assert main([*command, "--json"]) == 0
    printed, progress = capsys.readouterr()
    (row,) = json.loads(printed)["rows"]
    assert (row["F"], row["status"], row["cycles"]) == (0.1, "ended", 10)
    assert "1 of 1: F=0.1,N=10 ended" in progress
    assert main([*command, "--python"]) == 0
    script = capsys.readouterr().out
    exec(compile(script, "script", "exec"), {})
    assert "'v'" in capsys.readouterr().out


def test_a_rule_and_a_limit(pile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = [
        "sweep",
        "pile.dat",
        "--set",
        "F=0.1",
        "--jobs",
        "0",
        "--stop",
        "cycles >= 30",
        "--every",
        "10",
    ]
    assert main([*command, "--limit", "1m"]) == 0
    assert "F=0.1 stopped, cycles >= 30, 30 cycles" in capsys.readouterr().out
    assert json.loads((pile / "pile-sweep" / "runs" / "F=0.1" / "result.json").read_text())["limit"] == 60


@pytest.mark.parametrize(
    ("arguments", "status", "told"),
    [
        (["--set", "F"], 2, "--set F: give a name and a value"),
        (["--set", "F=1:2"], 2, "a range is first:last:number"),
        (["--set", "F=1", "--quantity", "KYD"], 2, "KYD of which block?"),
        (["--set", "F=1", "--quantity", "F = time"], 2, "the table has another column F"),
        (["--set", "F=1", "--quantity", "status = time"], 2, "the table has another column status"),
        (["--set", "F=1", "--quantity", "cycles"], 2, "the table has another column cycles"),
        (["--set", "F=1", "--stop", "time"], 2, "a rule ends with a comparison and a number"),
        (["--set", "F=1", "--limit", "soon"], 2, "give a time as in 60s, 5m or 1h"),
        (["--set", "F=1", "--every", "0"], 2, "every 0 cycles"),
        (["--set", "F=1", "--jobs", "-2"], 2, "-2 jobs"),
        (
            ["--set", "F=1", "--dask", "nonsense"],
            2,
            "no dask scheduler at nonsense: it needs a host and a port",
        ),
        (["--set", "FX=1"], 1, "pile.dat has no $FX\ndid you mean F?"),
    ],
)
def test_what_is_refused_before_anything_runs(
    arguments: list[str], status: int, told: str, pile: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sweep", "pile.dat", *arguments]) == status
    assert told in capsys.readouterr().err
    assert not Path("pile-sweep").exists()


def test_files_that_are_not_there_or_not_ours(pile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What stands in the place of a table or a picture is refused before any run."""
    assert main(["sweep", "no.dat", "--set", "F=1"]) == 1
    assert "udec: no.dat: No such file or directory" in capsys.readouterr().err
    (pile / "pile-sweep").mkdir()
    for kind in ("csv", "png", "svg"):
        file = pile / "pile-sweep" / f"pile.{kind}"
        file.write_text("something of mine\n")
        with pytest.raises(UdecError, match=f"31: file cannot be written: pile-sweep/pile.{kind} exists"):
            sweep("pile.dat", {"F": [0.1, 0.2], "N": 5}, jobs=0)
        assert file.read_text() == "something of mine\n"
        assert not (pile / "pile-sweep" / "runs").exists()
        file.unlink()


def test_pictures_of_an_earlier_sweep_go(pile: Path) -> None:
    """They would show other runs than the table beside them."""
    folder = pile / "here"
    sweep("pile.dat", {"F": [0.1, 0.2], "N": 5}, jobs=0, out=folder)
    assert (folder / "pile.png").exists()
    sweep("pile.dat", {"F": 0.1, "N": 5}, jobs=0, out=folder)
    assert sorted(path.name for path in folder.iterdir()) == ["pile.csv", "runs"]


def test_names_of_folders() -> None:
    assert folder_name({"F": 0.1, "N": 5}) == "F=0.1,N=5"
    long = folder_name({f"V{k}": math.pi for k in range(30)})
    assert len(long) < 140
    assert long != folder_name({f"V{k}": math.pi for k in range(29)} | {"V29": 1})


def test_what_solve_has_to_say_stands_in_the_table(pile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A run that ends without rest has ended, and its line says so."""
    (pile / "pile.dat").write_text(PILE.partition("CYCLE")[0] + "SOLVE 1E-6 LIMIT $N\nSTOP\nEND\n")
    found = sweep("pile.dat", {"F": 0.5, "N": [20, 30]}, quantities=("time",), jobs=0)
    assert found.table.columns["status"] == ["ended", "ended"]
    for text in found.table.columns["message"]:
        assert text.startswith("SOLVE 1e-06 NOT REACHED (")
    assert main(["sweep", "pile.dat", "--set", "F=0.5", "--set", "N=20,30", "--jobs", "0"]) == 0
    assert "SOLVE 1e-06 NOT REACHED" in capsys.readouterr().out


def test_a_deck_as_it_is(pile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without values there is one run, in a folder with the name of the deck."""
    assert main(["sweep", "pile.dat", "--jobs", "0", "--quantity", "v = block(1, 2.5).KYD"]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("1 run: the deck as it is\n1 of 1: pile ended, 200 cycles")
    with (pile / "pile-sweep" / "pile.csv").open(newline="") as file:
        rows = [*csv.DictReader(file)]
    (one,) = sweep("pile.dat", {"F": 0.5, "N": 200}, quantities=("v = block(1, 2.5).KYD",), jobs=0).results
    assert [(row["run"], float(row["v"])) for row in rows] == [("pile", one.quantities["v"])]
    assert [result.name for result in sweep(PILE, {}, jobs=0).results] == ["deck"]


def test_the_exit_status_is_1_if_no_run_has_a_result(pile: Path) -> None:
    command = ["sweep", "pile.dat", "--jobs", "0", "--set", "N=5", "--set"]
    assert main([*command, "F=-1,-2"]) == 1
    assert main([*command, "F=-1,0.1"]) == 0
    assert main([*command, "F=0.1", "--stop", "cycles >= 1", "--every", "1"]) == 0


def test_what_cannot_be_swept(pile: Path) -> None:
    with pytest.raises(ValueError, match="F has the value 1000000 twice"):
        sweep("pile.dat", {"F": "1e6,1000000", "N": 10}, jobs=0)
    with pytest.raises(ValueError, match="unknown word scheme 'x': choose one of"):
        sweep("pile.dat", {"F": 0.1}, build="x", jobs=0)
    assert not (pile / "pile-sweep").exists()


def test_whole_numbers_beyond_a_column_of_integers_are_reals(pile: Path) -> None:
    found = sweep(PILE.replace("KN=1E8", "KN=$KN"), {"KN": [10**8, 10**20], "N": 1}, jobs=0)
    assert found.table.columns["KN"].dtype == np.float64


@pytest.mark.parametrize(
    "save", ["../same.h5", "{folder}/same.h5", "a/../../same.h5", "{folder}/x/../same.h5"]
)
def test_runs_do_not_overwrite_the_file_of_one_another(save: str, pile: Path) -> None:
    """That is error 31 at the SAVE, before any run."""
    deck = PILE + f"SAVE {save.format(folder=pile)}\n"
    with pytest.raises(UdecError, match="31") as caught:
        sweep(deck, {"F": [0.1, 0.2], "N": 5}, jobs=0)
    assert caught.value.line == len(deck.splitlines())
    assert not [*pile.rglob("deck.dat"), *pile.rglob("same.h5")]


def test_runs_may_save_to_files_of_their_own_anywhere(pile: Path) -> None:
    deck = PILE + f"SAVE end.h5\nSAVE {pile}/F$F.h5\nSAVE ../kept-F$F.h5\nSTOP\nSAVE ../same.h5\n"
    found = sweep(deck, {"F": [0.1, 0.2], "N": 5}, jobs=0, out=pile / "out")
    assert [one.status for one in found.results] == ["ended", "ended"]
    assert {path.name for path in pile.glob("*.h5")} == {"F0.1.h5", "F0.2.h5"}
    assert {path.name for path in (pile / "out" / "runs").glob("*.h5")} == {"kept-F0.1.h5", "kept-F0.2.h5"}
    assert sweep(PILE + "SAVE ../same.h5\n", {"F": 0.1}, jobs=0).results[0].status == "ended"


@pytest.mark.parametrize("content", [b"\x7fELF\x00\x01", b"START\n* a \x00\nSTOP\n"])
@pytest.mark.parametrize("command", ["sweep", "trade", "diverge"])
def test_a_binary_file_is_no_deck(
    content: bytes, command: str, pile: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("x.dat").write_bytes(content)
    more = ["y.dat"] if command == "diverge" else ["--out", "out"]
    assert main([command, "x.dat", *more]) == 2
    assert "x.dat is not a deck: line" in capsys.readouterr().err
    assert not Path("out").exists()


def test_a_text_with_a_nul_is_no_deck(pile: Path) -> None:
    for wrong in ("\0", "\ud800"):
        with pytest.raises(ValueError, match="is not a deck: line 11 contains"):
            sweep(PILE + f"* {wrong}\n", {"F": 0.1}, jobs=0)
