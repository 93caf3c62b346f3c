"""udec convert, renumber and patch: what they write, what goes along, and what they refuse."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from naive.relocate import differences, essence
from support.every_group_kind import every_kind
from support.seldom_compiled import compiled_if_usual

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.heap.accessors import puti
from udec_ia.heap.word_scheme import scheme
from udec_ia.heap_tools.convert_word_scheme import convert
from udec_ia.heap_tools.renumber_groups import renumber
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import table
from udec_ia.restart import load, load_to_change, look_into, save

LAWS = ["mohr-coulomb", "joint-dilation"]
MOVED = "addresses differ from here on"


@pytest.fixture(scope="module", name="source")
def file_with_all_that_a_run_leaves(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Groups of every kind, junk, laws, histories with numbers, after some cycles."""
    folder = tmp_path_factory.mktemp("source")
    m = Model(out=folder, constitutive=LAWS)
    made = every_kind()
    m.run(made.deck())
    m.property(1, block_cohesion=1e5, block_friction=0.5, dilation=0.1, critical_slip=0.01)
    m.change(2, 4, -1, 1, constitutive=2)
    m.cycle(40)
    return m.save(folder / "source.h5")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def block(file: Path) -> int:
    return int(table(look_into(file), "block")["address"][2])


COMMANDS = {
    "convert": (["--build", "i16r64"], f"* udec convert --build i16r64: {MOVED}"),
    "renumber": ([], f"* udec renumber: {MOVED}"),
    "patch": (
        ["FRAC = 0.05,  block@{}.KXD=0.5", "GRAVY = -3"],
        "PATCH FRAC = 0.05, block@{}.KXD=0.5, GRAVY = -3",
    ),
}


def test_what_leads_astray_is_named(source: Path, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The pointer goes before the words that are lost with it, and the way to the rest of it is told."""
    at = block(source)
    assert main(["patch", str(source), "bad.h5", f"block@{at}.KP = 5", "--force"]) == 0
    assert (
        f"NOT SOUND: invariant 2: KP of block@{at} points to 5, which is no corner" in capsys.readouterr().out
    )
    assert main(["convert", "bad.h5", "to.h5", "--build", "i64r64"]) == 1
    output = capsys.readouterr().err
    assert f"KP of block@{at} points to 5, which is no corner" in output
    assert "udec check bad.h5 lists all that is wrong in it" in output


@pytest.mark.parametrize("verb", COMMANDS)
def test_all_goes_along(verb: str, source: Path, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Deck, with what was done, laws and recorded numbers, whose groups are called as they are now."""
    given, line = COMMANDS[verb]
    given = [text.format(block(source)) for text in given]
    assert main([verb, str(source), "to.h5", *given]) == 0
    assert "written: to.h5\n" in capsys.readouterr().out
    old, new = load(source), load("to.h5")
    assert new.deck == [*old.deck, line.format(block(source))]
    assert new.laws == old.laws
    assert len(new.laws) == 2
    assert [len(one.numbers) for one in old.series] == [5, 5, 5, 5]
    histories = table(new.array, "history")
    for one, two, watched in zip(old.series, new.series, histories["KHG"], strict=True):
        assert np.array_equal(one.numbers, two.numbers)
        assert (two.name, two.place, two.every) == (one.name, one.place, one.every)
        assert two.group == (f"{one.group.split('@')[0]}@{watched}" if watched else "")
    assert Model.check_file("to.h5") == []


@pytest.mark.parametrize("verb", ["convert", "renumber"])
def test_the_run_goes_on_to_the_last_bit(verb: str, source: Path, folder: Path) -> None:
    """With laws, boundary conditions and histories."""
    main([verb, str(source), "to.h5", *COMMANDS[verb][0]])
    here, there = (Model.restore(file, constitutive=LAWS, out=folder) for file in (source, Path("to.h5")))
    for m in (here, there):
        with compiled_if_usual(m.array.scheme.name):
            m.cycle(40)
    assert differences(essence(here.array), essence(there.array)) == []
    for one, two in zip(here.histories(), there.histories(), strict=True):
        assert np.array_equal(one.numbers, two.numbers)


@pytest.mark.parametrize("verb", COMMANDS)
def test_the_program_that_it_prints_writes_the_same(
    verb: str, source: Path, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = [text.format(block(source)) for text in COMMANDS[verb][0]]
    main([verb, str(source), "to.h5", *given])
    capsys.readouterr()
    assert main([verb, str(source), "other.h5", *given, "--python"]) == 0
    assert not Path("other.h5").exists()
    subprocess.run([sys.executable, "-c", capsys.readouterr().out], check=True, capture_output=True)
    one, two = load("to.h5"), load("other.h5")
    for part in ("ia", "ci", "cr", "cd"):
        assert np.array_equal(getattr(one.array.h, part), getattr(two.array.h, part)), part
    assert one.deck == two.deck
    assert [series.group for series in one.series] == [series.group for series in two.series]


def test_what_they_say(source: Path, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["convert", str(source), "to.h5", "--build", "i64r64", "--json"]) == 0
    output = json.loads(capsys.readouterr().out)["head"]
    assert output == ["written: to.h5", *convert(load(source).array, scheme("i64r64")).head]
    assert main(["renumber", str(source), "to.h5", "--json"]) == 0
    told, listing = json.loads(capsys.readouterr().out), renumber(load(source).array)
    assert told["head"] == ["written: to.h5", *listing.head]
    assert [tuple(row.values()) for row in told["rows"]] == list(listing.rows)
    assert main(["patch", str(source), "to.h5", "FRAC = 0.05"]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed == ["written: to.h5", "values given: 1", "what  before   now", "FRAC     0.1  0.05"]


@pytest.mark.parametrize("verb", COMMANDS)
def test_what_is_not_written_over(
    verb: str, source: Path, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Neither the file that is read, by whatever name, nor anything but a restart file."""
    given = [text.format(block(source)) for text in COMMANDS[verb][0]]
    Path("link.h5").symlink_to(source)
    Path("deck.dat").write_text("START\n")
    before = source.read_bytes()
    for to, says in (
        (str(source), "is the file that is read"),
        ("link.h5", "is the file that is read"),
        ("deck.dat", "is not a restart file of udec_ia, and stays as it is"),
        (str(folder), "is a folder"),
    ):
        assert main([verb, str(source), to, *given]) == 1
        assert says in capsys.readouterr().err
    assert source.read_bytes() == before
    assert Path("deck.dat").read_text() == "START\n"
    assert main([verb, "none.h5", "to.h5", *given]) == 1
    assert "error 29" in capsys.readouterr().err
    assert sorted(path.name for path in folder.iterdir()) == ["deck.dat", "link.h5"]


def test_a_refusal_leaves_the_file_that_is_there(
    source: Path, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    there = Path("to.h5")
    main(["renumber", str(source), "to.h5"])
    before, at = there.read_bytes(), block(source)
    assert main(["patch", str(source), "to.h5", "FRAC = 0.1", f"block@{at}.KMAT = 77"]) == 1
    printed = capsys.readouterr().out
    assert printed.splitlines()[-2:] == ["violation", f"invariant 2: KMAT of block@{at} is 77, not 1 to 50"]
    assert "NOT written: to.h5" in printed
    assert main(["patch", str(source), "to.h5", f"block@{at}.KMAD = 7"]) == 1
    assert there.read_bytes() == before
    assert main(["patch", str(source), "to.h5", "--force", f"block@{at}.KMAT = 77"]) == 0
    assert "NOT SOUND: invariant 2: KMAT of block" in capsys.readouterr().out
    assert load_to_change("to.h5").deck[-1] == f"* udec patch --force: block@{at}.KMAT = 77"
    assert main(["check", "to.h5"]) == 1
    assert main(["patch", "to.h5", "mended.h5", f"block@{at}.KMAT = 1"]) == 0
    assert main(["check", "mended.h5"]) == 0


def test_narrow_reals_that_make_it_unsound(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    m = Model()
    m.block(1e5, 0, 1e5, 1, 1e5 + 1, 1, 1e5 + 1, 0)
    m.round(0.05)
    m.save("far.h5")
    assert main(["convert", "far.h5", "to.h5", "--build", "i32r32"]) == 1
    assert "the rounding length is 0.05" in capsys.readouterr().out
    assert not Path("to.h5").exists()
    assert main(["convert", "far.h5", "to.h5", "--build", "i32r32", "--force"]) == 0
    assert look_into("to.h5").scheme == scheme("i32r32")


def test_damaged_files(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A wrong number goes along, a wrong link is refused until a patch has mended it."""
    m = every_kind()
    blocks, contact = m.table("block")["address"], int(m.table("contact")["address"][0])
    array = m.array.copy()
    puti(array.h, int(blocks[1]), g.KMAT, 60)
    save(array, "number.h5", [], {}, m.histories())
    puti(array.h, contact, g.KB1, 3)
    save(array, "link.h5", [], {}, m.histories())
    for verb, given in (("convert", ["--build", "i64r64"]), ("renumber", [])):
        assert main([verb, "number.h5", "to.h5", *given]) == 0
        assert table(look_into("to.h5"), "block")["KMAT"].tolist() == [1, 60, 1, 1, 1, 1, 1]
        assert main([verb, "link.h5", "other.h5", *given]) == 1
        assert f"contact@{contact} is in the list of block@1, but its KB1 is 3 and" in capsys.readouterr().err
    right = int(m.table("contact")["KB1"][0])
    mend = [f"contact@{contact}.KB1 = {right}", f"block@{blocks[1]}.KMAT = 1"]
    assert main(["patch", "link.h5", "mended.h5", *mend]) == 0
    assert differences(essence(load("mended.h5").array), essence(m.array)) == []


def test_histories_that_cannot_be_told(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    m = every_kind()
    array = m.array.copy()
    history = int(array.h.ci[g.IHPNT])
    puti(array.h, history, g.KH, history)
    save(array, "round.h5", [], {}, m.histories())
    puti(array.h, history, g.KH, 0)
    puti(array.h, history, g.KHF, 999)
    save(array, "unknown.h5", [], {}, m.histories())
    for name in ("round.h5", "unknown.h5"):
        assert main(["patch", name, "to.h5", "FRAC = 0.1"]) == 1
        assert "does not say what its histories have recorded" in capsys.readouterr().err
