"""docs/debugger.md: its deck runs under the debugger, and its commands print what stands below them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from udec_ia.cli import main

TEXT = (Path(__file__).parents[2] / "docs" / "debugger.md").read_text()
DECK = "".join(
    f"{line[4:]}\n" for line in re.findall(r"^    START\n(?:    .*\n)+", TEXT, re.M)[0].splitlines()
)
SHOWN = re.findall(r"^    \$ udec (debug fall.dat --commands (\w+.txt))\n((?:    .*\n)*)", TEXT, re.M)
DECK_SAYS = ("> ", " CYCLE", " SPLIT", " FIX", " DELETE", "compiling")
LINE = re.compile(r":\d+\)")  # of a source


def test_there_is_something_shown() -> None:
    assert len(SHOWN) == TEXT.count("$ udec") == 5


@pytest.mark.parametrize(("command", "script", "shown"), SHOWN)
def test_the_page_shows_what_is_printed(
    command: str,
    script: str,
    shown: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("fall.dat").write_text(DECK)
    Path(script).write_text("".join(f"{line}\n" for line in re.findall(r"^    \(.*?\) (.*)", shown, re.M)))
    assert main(command.split()) == 0
    printed = [line for line in capsys.readouterr().out.splitlines() if not line.startswith(DECK_SAYS)]
    assert [LINE.sub(":)", line) for line in printed] == [
        LINE.sub(":)", line[4:]) for line in shown.splitlines()
    ]
