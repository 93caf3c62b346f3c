"""What the tab key offers, what `?` answers, and what a shell completes."""

from __future__ import annotations

import io
import shutil
import subprocess
from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.interactive_session import converse
from udec_ia.deck.line_completion import DELIMITERS, completions


def two_blocks() -> Model:
    m = Model()
    m.start()
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1)
    return m


def after_tab(m: Model, line: str) -> list[str]:
    """What is offered at the end of a line, whose last word readline finds by the delimiters."""
    begins = max(line.rfind(one) for one in DELIMITERS) + 1
    return completions(m, line[:begins], line[begins:])


def test_commands_words_groups_and_files(tmp_path: Path) -> None:
    m = two_blocks()
    m.group("upper", 0, 2, 1, 2)
    assert completions(m, "", "prop") == ["property "]
    assert completions(m, "  ", "VEL") == ["VELOCITY "]
    assert len(completions(m, "", "")) == len(COMMANDS)
    assert completions(m, "CHANGE 0 2 0 1 ", "M") == ["MATERIAL "]
    assert completions(m, "nonsense ", "m") == []
    assert completions(m, "DELETE GROUP ", "U") == ["UPPER "]
    (tmp_path / "stage.h5").write_bytes(b"")
    (tmp_path / "stages").mkdir()
    for command in ("RESTART ", "CALL ", "FUNCTION 1 FILE "):
        assert after_tab(m, f"{command}{tmp_path}/sta") == [f"{tmp_path}/stage.h5 ", f"{tmp_path}/stages/"]


def test_a_question_is_answered_and_the_session_goes_on() -> None:
    lines = iter(["START", "CHANGE ?", "?", "NOPE ?", "* why?", "INFO", "CHECK", "STOP"])
    out = io.StringIO()
    converse(Model(), out, ask=lambda prompt: next(lines))
    text = out.getvalue()
    assert "Example: CHANGE" in text
    assert text.count("error 2") == 1
    assert "sound" in text
    assert "before it can run" in text


def test_check_names_what_is_wrong() -> None:
    m = two_blocks()
    assert m.run("CHECK") == "> CHECK\nsound: all invariants hold\n"
    m.h.ia[int(m.table("contact")["address"][0])] = 77
    assert "sound: all" not in str(m.run("CHECK"))


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
def test_bash_completes_commands_and_options(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "bash"]) == 0
    script = capsys.readouterr().out

    def completed(*words: str) -> set[str]:
        ask = f'COMP_WORDS=({" ".join(words)}); COMP_CWORD={len(words) - 1}; _udec; echo "${{COMPREPLY[@]}}"'
        done = subprocess.run(["bash", "-c", script + ask], capture_output=True, text=True, check=True)
        return set(done.stdout.split())

    assert {"telescope", "tidy"} & completed("udec", "tel") == {"telescope"}
    assert "--build" in completed("udec", "run", "--bu")
    assert completed("udec", "cache", "wa") == {"warm"}
