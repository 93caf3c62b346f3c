"""A recording shows elsewhere what the run has shown, and no other file is taken for one."""

from __future__ import annotations

import io
import json
import re
import zipfile
from pathlib import Path

import pytest
from support.debugger_decks import PILE

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.debug import debug, read_recording, replay
from udec_ia.errors import UdecError

LOOKS = (
    "goto 30",
    "print block@721.KYD TIME",
    "why block@721.KY",
    "rc block@721.KBFIX",
    "goto 100",
    "dump 1/50",
)
LAW = "def clj2(fn, fs, dun, dus, un, us, m):\n    return m.kn * dun, m.ks * dus\n"


def answers(text: str) -> str:
    """The answers to LOOKS."""
    return text.partition(") goto 30\n")[2]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A recording of 130 cycles, and the output of the run itself."""
    folder = tmp_path_factory.mktemp("recording")
    path, printed = folder / "run.udecrec", io.StringIO()
    deck = PILE.replace("FRICTION=0.02", "FRICTION=$F")
    debug(Model(out=folder), deck, printed, ["goto 130", f"record {path}", *LOOKS], "pile.dat", {"F": 0.02})
    return path, printed.getvalue()


def test_it_shows_what_the_run_has_shown(recorded: tuple[Path, str], tmp_path: Path) -> None:
    path, live = recorded
    found, printed = read_recording(path), io.StringIO()
    assert (found.name, found.values, found.build) == ("pile.dat", {"F": "0.02"}, "i32r64")
    replay(Model(build=found.build, out=tmp_path), found, printed, [*LOOKS, "info"])
    assert "deck pile.dat, with F=0.02\n" in printed.getvalue()
    assert answers(printed.getvalue()).startswith(answers(live))
    assert "why" in answers(live)
    assert "after cycle 130 of line 14" in printed.getvalue()


def test_it_can_be_looked_at_and_not_continued(
    recorded: tuple[Path, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, _ = recorded
    script, again = tmp_path / "script.txt", tmp_path / "again.udecrec"
    script.write_text(f"continue\nresume\npatch FRAC = 0.2\nrecord {again}\nrecord {script}\nlist\n")
    assert main(["debug", "--replay", str(path), "--commands", str(script)]) == 0
    printed = capsys.readouterr().out
    assert "this is a recording: go back, or quit" in printed
    assert printed.count("can be looked at, not continued") == 2
    assert "CYCLE 360" in printed
    assert "is not a recording of the debugger" in " ".join(printed.split())
    assert script.read_text().startswith("continue")
    one, two = read_recording(path), read_recording(again)
    assert (one.spans, one.now, one.deck, [*one.copies]) == (two.spans, two.now, two.deck, [*two.copies])
    with pytest.raises(SystemExit):
        main(["debug", "--replay"])
    assert main(["debug", str(script), "--replay", str(path)]) == main(["debug"]) == 2


def rewritten(path: Path, to: Path, change: object) -> Path:
    """A copy in which recording.json is changed by a function."""
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(to, "w") as new:
        for name in old.namelist():
            data = old.read(name)
            if name == "recording.json":
                about = json.loads(data)
                change(about)  # type: ignore[operator]
                data = json.dumps(about).encode()
            new.writestr(name, data)
    return to


def test_another_version_is_refused(recorded: tuple[Path, str], tmp_path: Path) -> None:
    def older(about: dict[str, dict[str, str]]) -> None:
        about["origin"]["version"] = "0.0.7"

    def other_table(about: dict[str, dict[str, str]]) -> None:
        about["origin"]["field table"] = "0"

    for change, says in (
        (older, r"made by udec_ia 0\.0\.7, and this is"),
        (other_table, "another field table"),
    ):
        with pytest.raises(UdecError, match=says) as refused:
            read_recording(rewritten(recorded[0], tmp_path / "other.udecrec", change))
        assert refused.value.number == 29
        assert "deck.dat" in refused.value.advice


def test_damaged_files_are_refused(recorded: tuple[Path, str], tmp_path: Path) -> None:
    """One wrong byte, a missing end, or parts that do not fit: error 29, or the same contents."""
    image, damaged = recorded[0].read_bytes(), tmp_path / "damaged.udecrec"
    whole = read_recording(recorded[0])
    refused = 0
    for k in range(0, len(image), max(len(image) // 150, 1)):
        damaged.write_bytes(image[:k] + bytes([image[k] ^ 0x41]) + image[k + 1 :])
        try:
            found = read_recording(damaged)
            assert (found.spans, found.now, found.deck) == (whole.spans, whole.now, whole.deck)
        except UdecError as error:
            refused += error.number == 29
    assert refused > 100
    changes = (
        lambda about: about.update(now=7),
        lambda about: about["copies"].popitem(),
        lambda about: about["spans"].pop(3),
        lambda about: about["copies"].update({"5": ["i64r64", False]}),
        lambda about: about.pop("laws"),
        lambda about: about.update(build="i8"),
    )
    for change in changes:
        rewritten(recorded[0], damaged, change)
        with pytest.raises(UdecError, match="damaged or no recording"):
            read_recording(damaged)
    for data in (b"", b"START\nSTOP\n", image[: len(image) // 2]):
        damaged.write_bytes(data)
        with pytest.raises(UdecError, match="recording"):
            read_recording(damaged)


def test_laws_are_given_again(tmp_path: Path) -> None:
    law, path = tmp_path / "law.py", tmp_path / "run.udecrec"
    law.write_text(LAW)
    deck = PILE.replace("CHANGE 0,2 1,2 SDEF", "CHANGE 0,2 1,2 SDEF\nCHANGE 0 4 0 4 CONS=2")
    debug(Model(out=tmp_path, constitutive=law), deck, io.StringIO(), ["goto 20", f"record {path}"])
    found = read_recording(path)
    assert found.laws["clj2"][0] == "law.py"
    with pytest.raises(UdecError, match=r"clj2 of law\.py.*not given") as refused:
        replay(Model(), found, io.StringIO(), [])
    assert refused.value.number == 9
    law.write_text(LAW + "# changed\n")
    with pytest.raises(UdecError, match="is not that of the recording"):
        replay(Model(constitutive=law), found, io.StringIO(), [])
    law.write_text(LAW)
    printed = io.StringIO()
    replay(Model(out=tmp_path, constitutive=law), found, printed, ["goto 7"])
    assert re.search(r"after cycle 7 of line", printed.getvalue())
