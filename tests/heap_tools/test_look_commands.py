"""The looks on the command line: as text, as JSON, as a program that prints the same, and on a terminal."""

from __future__ import annotations

import io
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from rich.text import Text
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.command_line.coloured_listing import show
from udec_ia.heap_tools.heap_dump import common, dump
from udec_ia.heap_tools.heap_lookup import walk, what, who
from udec_ia.heap_tools.heap_search import find, find_pointers, find_value
from udec_ia.heap_tools.memory_use import heap_map, junk
from udec_ia.heap_tools.pointer_graph import graph
from udec_ia.output.word_dump import raw
from udec_ia.reader.printed_listing import Listing, Stream
from udec_ia.reader.word_map import Atlas
from udec_ia.restart import save


@pytest.fixture(scope="module")
def m() -> Model:
    return every_kind()


@pytest.fixture(scope="module")
def file(m: Model, tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(m.save(tmp_path_factory.mktemp("look") / "state.h5"))


@pytest.fixture(scope="module")
def bad(tmp_path_factory: pytest.TempPathFactory) -> Model:
    """A model with a contact that points to a corner as its block, and to nowhere."""
    model = every_kind()
    contact = int(model.table("contact")["address"][0])
    model.array.h.ia[contact + 1] = int(model.table("corner")["address"][0])
    model.array.h.ia[contact + 3] = 99999
    return model


def calls(m: Model) -> list[tuple[list[str], Listing]]:
    """Commands, and what the library finds."""
    atlas, block = Atlas(m.array.h), int(m.table("block")["address"][1])
    where = "block where KX > 2 and KMAT == 1"
    return [
        (["what", "40"], what(atlas, 40)),
        (["who", f"{block}"], who(atlas, block)),
        (["walk", "block", f"{block}"], walk(atlas, "block", block)),
        (["walk", "contact", "--field", "KCFN", "--limit", "3"], walk(atlas, "contact", None, "KCFN", 3)),
        (["junk"], junk(atlas)),
        (["dump"], dump(atlas)),
        (["dump", "common"], common(atlas)),
        (["dump", "40"], dump(atlas, 40, 40)),
        (["dump", "40-70", "--radix", "8"], dump(atlas, 40, 70, 8)),
        (["dump", "40/70"], dump(atlas, 40, 109)),
        (["dump", "--raw"], raw(atlas)),
        (["dump", "40/70", "--raw"], raw(atlas, 40, 109)),
        (["find", where], find(atlas, where)),
        (["find", where, "--limit", "1"], find(atlas, where, 1)),
        (["find", "--value", "-10", "--tolerance", "0.1"], find_value(atlas, -10.0, 0.1)),
        (["find", "--points-to", f"{block}"], find_pointers(atlas, block)),
        (["map"], heap_map(atlas)),
        (["graph", f"{block}"], graph(atlas, block)),
        (["graph", f"{block}", "--depth", "2"], graph(atlas, block, 2)),
    ]


def test_the_commands(m: Model, file: str, capsys: pytest.CaptureFixture[str]) -> None:
    for (name, *rest), listing in calls(m):
        assert main([name, file, *rest]) == 0
        assert capsys.readouterr().out == listing.as_text()
        assert main([name, file, *rest, "--json"]) == 0
        assert json.loads(capsys.readouterr().out) == json.loads(listing.as_json())
        assert main([name, file, *rest, "--python"]) == 0
        exec(compile(capsys.readouterr().out, name, "exec"), {})
        assert capsys.readouterr().out == listing.as_text()


def test_a_program_runs_alone(m: Model, file: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["what", file, "40", "--python"]) == 0
    program = capsys.readouterr().out
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == what(Atlas(m.array.h), 40).as_text()


def test_the_pictures(m: Model, file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    block = str(m.table("block")["address"][1])
    for name, *rest in (["map"], ["graph", block, "--depth", "2"]):
        out = tmp_path / f"{name}.{'png' if name == 'map' else 'dot'}"
        assert main([name, file, *rest, "--out", str(out)]) == 0
        assert f"wrote {out}\n" in capsys.readouterr().out
        first = out.read_bytes()
        assert main([name, file, *rest, "--out", str(out), "--python"]) == 0
        exec(compile(capsys.readouterr().out, name, "exec"), {})
        assert f"wrote {out}\n" in capsys.readouterr().out
        assert out.read_bytes() == first


def test_what_cannot_be_looked_at(file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "deck.png"
    deck.write_text("START\n")
    for given, says in (
        (["what", file, "0"], "IA() has the addresses 1 to"),
        (["who", file, "99999999"], "IA() has the addresses 1 to"),
        (["walk", file, "nothing"], "no list nothing"),
        (["walk", file, "block", "--field", "KXDD"], "did you mean KXD?"),
        (["dump", file, "5-3"], "there are no words 5 to 3"),
        (["dump", file, "5-0"], "there are no words 5 to 0"),
        (["dump", file, "5/0"], "there are no words 5 to 4"),
        (["dump", file, "x"], "X names no words of IA()"),
        (["dump", file, "common", "--raw"], "COMMON names no words of IA()"),
        (["find", file, "block where KXDD > 1"], "\n    block where KXDD > 1\n                ^\n"),
        (["find", file, "block", "--tolerance", "1"], "--tolerance goes with --value"),
        (["graph", file, "8000"], "only groups have pointers"),
        (["graph", file, "1", "--depth", "0"], "1 or more"),
        (["map", file, "--out", "m.pdf"], "ends in .png or .svg"),
    ):
        assert main(given) == 2
        assert says in capsys.readouterr().err
    for given in (["junk", str(tmp_path / "none.h5")], ["map", file, "--out", str(deck)]):
        assert main(given) == 1
        assert re.match("error (29|31)", capsys.readouterr().err)
    assert deck.read_text() == "START\n"
    for given in (["find", file], ["find", file, "block", "--value", "1"], ["dump", file, "--radix", "2"]):
        with pytest.raises(SystemExit) as ended:
            main(given)
        assert ended.value.code == 2
        assert "usage" in capsys.readouterr().err


# ---- on a terminal


class Terminal(io.StringIO):
    """A stream that says that it is a terminal."""

    def isatty(self) -> bool:
        return True


def shown(listing: Listing, monkeypatch: pytest.MonkeyPatch, width: int, **environment: str) -> str:
    for name in ("NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    colours = {
        "TERM": "xterm",
        "COLORTERM": "truecolor",
    }  # rich keeps the codes of the first one
    for name, value in {**colours, "COLUMNS": str(width), **environment}.items():
        monkeypatch.setenv(name, value)
    stream = Terminal()
    show(listing, stream)
    return stream.getvalue()


def test_a_terminal_gets_the_lines_in_colour(m: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    for _, listing in calls(m):
        wide = shown(listing, monkeypatch, 200)
        assert Text.from_ansi(wide).plain.rstrip("\n") == listing.as_text().rstrip("\n")
    assert "\x1b[" in shown(dump(Atlas(m.array.h), 1, 50), monkeypatch, 200)


def test_no_colour_where_it_is_not_wanted(m: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    for _, listing in calls(m):
        assert shown(listing, monkeypatch, 200, NO_COLOR="1") == listing.as_text()
        assert "\x1b" not in shown(listing, monkeypatch, 200, TERM="dumb")


@pytest.mark.parametrize("width", [80, 100, 140])
def test_a_narrow_terminal_is_kept_to(m: Model, monkeypatch: pytest.MonkeyPatch, width: int) -> None:
    """No line is wider, and nothing gets lost."""
    for _, listing in calls(m):
        narrow = shown(listing, monkeypatch, width, NO_COLOR="1")
        assert max(map(len, narrow.splitlines())) <= width
        assert narrow.split() == listing.as_text().split()


def test_what_is_wrong_is_red(bad: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    """And nothing else; also where it had to be folded."""
    contact = int(bad.table("contact")["address"][0])
    for width in (80, 200):
        text = shown(what(Atlas(bad.array.h), contact), monkeypatch, width)
        red = re.findall(r"\x1b\[1;38;2;224;32;27m([^\x1b]*)", text)
        told = " ".join(" ".join(red).split())
        assert "corner@" in told
        assert "no block outside IA(), no corner or contact" in told
        assert "material" not in told


def test_a_group_has_the_colour_of_its_kind_and_the_map_too(
    m: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = shown(dump(Atlas(m.array.h), 1, 60), monkeypatch, 200).splitlines()
    assert all("38;2;176;118;43m" in line for line in text[2:10])  # block
    letters = shown(heap_map(Atlas(m.array.h)), monkeypatch, 200)
    assert re.search(r"\x1b\[38;2;176;118;43m(B|b)", letters)
    assert re.search(r"\x1b\[2;38;2;156;150;140m-", letters)  # junk, dim


def test_the_command_asks_what_it_prints_to(file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.delenv("NO_COLOR", raising=False)
    for stream, coloured in ((Terminal(), True), (io.StringIO(), False)):
        monkeypatch.setattr(sys, "stdout", stream)
        assert main(["dump", file, "1/40"]) == 0
        assert ("\x1b[" in stream.getvalue()) == coloured


# ---- a listing


def test_rows_are_made_as_they_are_asked_for() -> None:
    made: list[int] = []

    def rows() -> Any:
        for k in range(5):
            made.append(k)
            yield f"g{k // 2}", k, 0.5 * k, "text"

    listing = Listing(["head"], ("group", "n", "x", "t"), Stream(rows), widths=(0, 3, 6, -4), headed=True)
    lines = listing.lines()
    assert made == []
    assert [next(lines).text for _ in range(4)] == ["head", "    n       x  t", "g0", "    0       0  text"]
    assert made == [0]
    assert listing.as_text() == listing.as_text()
    assert [line.heading for line in listing.lines()][2:] == ["g0"] * 3 + ["g1"] * 3 + ["g2"] * 2
    assert [row["n"] for row in json.loads(listing.as_json())["rows"]] == [0, 1, 2, 3, 4]


def test_numbers_stand_on_the_right_beside_what_is_missing() -> None:
    listing = Listing([], ("a", "b", "c"), [(1, "", "x"), ("", "y", 2), (300, "", "")])
    assert listing.as_text() == "  a  b  c\n  1     x\n     y  2\n300\n"
    assert json.loads(Listing(["a"], ("x",), [(float("nan"),)]).as_json()) == {
        "head": ["a"],
        "rows": [{"x": "nan"}],
    }


def test_a_damaged_file_has_an_unsound_heap_and_can_be_dumped(
    bad: Model, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = str(save(bad.array, tmp_path / "bad.h5"))
    assert main(["dump", path]) == 0
    assert ", no block" in capsys.readouterr().out
