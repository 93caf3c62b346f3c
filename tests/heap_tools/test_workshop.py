"""docs/workshop.md: its deck runs, and its commands print what stands below them."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.command_line import VERBS

PAGE = Path(__file__).parents[2] / "docs" / "workshop.md"
TEXT = PAGE.read_text()
DECK = "".join(
    f"{line[4:]}\n" for line in re.findall(r"^    START\n(?:    .*\n)+", TEXT, re.M)[0].splitlines()
)
SHOWN = re.findall(r"^    \$ udec (.*)\n((?:    .*\n)*)", TEXT, re.M)
BAD = re.compile(r"violation|\d numbers? differ|\d words differ|they differ")  # what ends with the status 1


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder in which the deck was run."""
    monkeypatch.chdir(tmp_path)
    Model(out=tmp_path).run(DECK.replace("STOP\n", ""))
    return tmp_path


def test_there_is_something_shown() -> None:
    # These have pages of their own.
    others = {"cache", "completion", "debug", "examples", "export", "fos", "info", "sweep", "trade", "verify"}
    assert {command.split()[0] for command, _ in SHOWN} == {*VERBS} - others


def test_the_page_shows_what_is_printed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for command, shown in SHOWN:
        assert main(shlex.split(command)) == bool(BAD.search(shown.partition("\n")[0])), command
        printed = capsys.readouterr().out
        assert printed == "".join(f"{line[4:]}\n" for line in shown.splitlines()), command


def test_the_page_shows_what_a_wrong_condition_gets(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (shown,) = re.findall(r"^    (udec find: .*)\n((?:    .*\n)+)", TEXT, re.M)
    wrong = shown[1].splitlines()[0].strip()
    assert main(["find", "slide.h5", wrong]) == 2
    assert capsys.readouterr().err == f"{shown[0]}\n" + "".join(
        f"{line[4:]}\n" for line in shown[1].splitlines()
    )
