"""docs/three-faults.md: three planted faults are found by the commands that it shows."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.cli import main

TEXT = (Path(__file__).parents[2] / "docs" / "three-faults.md").read_text()
SHOWN = re.findall(r"^    \$ udec (.*)\n((?:    .*\n)*)", TEXT, re.M)
DECK_SAYS = ("> ", " CYCLE", " SPLIT", " FIX", "written:")  # that the debugger runs
LINE = re.compile(r":\d+\)")  # of a source


def block_of(first: str) -> str:
    """The indented lines that begin with this one."""
    (found,) = re.findall(rf"^    {re.escape(first)}.*\n(?:    .*\n)+", TEXT, re.M)
    return "".join(f"{line[4:]}\n" for line in found.splitlines())


def prepare(folder: Path) -> None:
    """The deck, its laws, and what runs of it have written."""
    law, deck = block_of("def clj2"), block_of("START")
    laws = {
        "springs.py": law,
        "drifts.py": law.replace("max(fs +", "max(fs * (1 - 1e-4) +"),
        "wrong.py": law.replace("fs + m.ks", "fs - m.ks"),
    }
    for name, text in laws.items():
        Path(name).write_text(text)
    assert len(set(laws.values())) == 3
    Path("slope.dat").write_text(deck)
    Path("sign.txt").write_text("".join(f"{line}\n" for line in re.findall(r"^    \(\d+\) (.*)", TEXT, re.M)))
    for name, before in (("drifts.py", "drift-"), ("springs.py", "")):
        Model(out=folder, constitutive=name).run(deck.replace("STOP\n", ""))
        if before:
            for file in ("rest.h5", "later.h5"):
                Path(file).rename(before + file)


def test_what_the_page_shows_finds_the_faults(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    prepare(tmp_path)
    assert len(SHOWN) == TEXT.count("$ udec") == 11
    capsys.readouterr()
    for command, shown in SHOWN:
        main(shlex.split(command))
        printed = capsys.readouterr().out.splitlines()
        if command.startswith("debug"):
            printed = [LINE.sub(":)", line) for line in printed if not line.startswith(DECK_SAYS)]
            shown = LINE.sub(":)", shown)
        assert printed == [line[4:] for line in shown.splitlines()], command
