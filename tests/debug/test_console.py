"""The debugger as it is talked to: what each command says and does, and that nothing breaks it."""

from __future__ import annotations

import io
import re
import signal
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.debugger_decks import PILE

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.debug import Console, debug
from udec_ia.layout import offsets as g


def talk(out: Path, *lines: str, deck: str = PILE) -> str:
    """What the debugger says to these commands, which it repeats behind its prompt."""
    output = io.StringIO()
    debug(Model(out=out), deck, output, lines)
    return re.sub(r"^\(\d+(?: past)?\) .*\n", "", output.getvalue(), flags=re.M)


def test_it_stops_before_the_first_command(tmp_path: Path) -> None:
    assert talk(tmp_path, "where") == "at the beginning\nat the beginning\n"


def test_stepping_and_going(tmp_path: Path) -> None:
    output = talk(
        tmp_path, "goto 70", "step", "step 3", "rs", "rs 4", "goto line 13", "goto now", "c", "goto 5"
    )
    places = re.findall(r"^after (?:cycle (\d+) of )?line (\d+)", output, re.M)
    cycles = [("70", "14"), ("71", "14"), ("74", "14"), ("73", "14"), ("69", "14")]
    assert places == [*cycles, ("60", "12"), ("74", "14"), ("", "17"), ("5", "12")]
    assert "the deck has ended" in output


def test_names_may_be_cut_short(tmp_path: Path) -> None:
    whole = talk(tmp_path, "goto 30", "reverse-step 2", "print TIME", "where")
    assert talk(tmp_path, "go 30", "reverse-s 2", "p TIME", "w") == whole


def test_stops_at_what_was_asked_for(tmp_path: Path) -> None:
    """Forwards while it runs, forwards again in the past, and backwards: the same places."""
    output = talk(tmp_path, "break broken", *["c"] * 9)
    forward = re.findall(r"broken: (contact@\d+).*\nafter cycle (\d+)", output)
    assert len(forward) > 1
    again = talk(tmp_path, "break broken", *["c"] * 9, "goto 61", *["c"] * len(forward))
    assert re.findall(r"broken: (contact@\d+).*\nafter cycle (\d+)", again)[len(forward) :] == forward
    back = talk(tmp_path, "goto 61", "goto line 17", "break broken", *["rc"] * (len(forward) + 2))
    assert re.findall(r"broken: (contact@\d+).*\nafter cycle (\d+)", back) == forward[::-1]
    assert re.search(r"broken: contact@.*(\n    .*)*\nafter line 13: DELETE", back)
    assert "no break or watch: not hit before" in back


def test_watching_a_word(tmp_path: Path) -> None:
    output = talk(
        tmp_path, "goto 1", "watch block@721.KYD < -0.2", "c", "delete 1", "info", "print block@721.KYD"
    )
    value = float(re.search(r"block@721.KYD = (\S+)", output)[1])  # type: ignore[index]
    assert value < -0.2
    before = talk(tmp_path, "goto 1", "watch block@721.KYD < -0.2", "c", "rs", "print block@721.KYD")
    assert float(re.search(r"block@721.KYD = (\S+)", before)[1]) >= -0.2  # type: ignore[index]


def test_a_condition_is_stopped_at(tmp_path: Path) -> None:
    """When it comes true for a group: so it is not yet in the cycle before."""
    wanted = "block where KYD < -0.2"
    output = talk(tmp_path, "goto 61", f"break {wanted}", "c", f"find {wanted}")
    found = re.search(r"break block .*(block@\d+)\nafter cycle (\d+)", output)
    assert found
    format_number = f"  {found[1]} "
    assert format_number in output
    assert format_number not in talk(tmp_path, f"goto {int(found[2]) - 1}", f"find {wanted}")
    assert "did you mean" in talk(tmp_path, "goto 3", "break block where KYDD < 1")


def test_within_a_cycle(tmp_path: Path) -> None:
    output = talk(
        tmp_path, "goto 50", *["rs pass", "rs group", "rs write"], *["s write", "s group", "s pass"]
    )
    assert output.count("within the next cycle") >= 4
    assert "ford of contact@" in output
    assert "after cycle 50 of line 12" in output.splitlines()[-1]


@pytest.mark.parametrize("by", ["pass", "group", "write"])
@pytest.mark.parametrize(
    ("lines", "kind"),
    [
        (["goto 50", "patch FRAC = 0.05", "rs 2"], "CYCLE"),  # a cycle precedes the PATCH
        (["goto 50", "patch FRAC = 0.05", "rs"], "PATCH"),
        (["goto line 9", "step 9", "goto line 9"], "CHANGE"),
        (["goto 5", "goto line 12", "rs"], "HISTORY"),
    ],
)
def test_a_step_inside_what_is_no_cycle_is_refused(
    tmp_path: Path, by: str, lines: list[str], kind: str
) -> None:
    """The event that comes next is named: it never does nothing without a word."""
    output = "".join(talk(tmp_path, *lines, f"step {by}").splitlines()[-3:])
    assert ("within the next cycle" in output) == (kind == "CYCLE")
    assert ("not a cycle" in output) == (kind != "CYCLE")
    assert kind in output


@pytest.mark.parametrize("by", ["pass", "group", "write"])
def test_a_step_back_inside_what_is_no_cycle_is_refused(tmp_path: Path, by: str) -> None:
    assert "not a cycle" in talk(tmp_path, "goto 50", "patch FRAC = 0.05", f"reverse-step {by}")
    assert "not a cycle" in talk(tmp_path, f"reverse-step {by}")


ESCAPE = "\x1b[2J"


def test_escape_sequences_do_not_reach_the_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the file of commands, of its name, and of the deck and its name."""
    monkeypatch.chdir(tmp_path)
    deck, script = Path(f"pile{ESCAPE}.dat"), Path(f"commands{ESCAPE}.txt")
    deck.write_text(PILE.replace("GRAVITY", f"*{ESCAPE}\nGRAVITY"))
    commands = ["", "print", "find block where", "find", "watch", "break", "born", "help", "what", "dump"]
    commands += ["goto", "step", "patch", "delete", "walk", "graph", "reverse-continue", "wrote"]
    lines = ["goto 3", "goto line 4", "list", *(f"{command} {ESCAPE}\x07" for command in commands)]
    script.write_text("\n".join([*lines, f"find block where {ESCAPE} > 1", ""]))
    assert main(["debug", str(deck), "--commands", str(script)]) == 0
    assert main(["debug", str(deck), "--commands", f"none{ESCAPE}"]) == 1
    assert main(["debug", f"none{ESCAPE}"]) == 1
    printed = "".join(capsys.readouterr())
    assert len(printed.splitlines()) > len(lines)
    assert all(line.isprintable() for line in printed.splitlines())


def test_an_error_is_stopped_at(tmp_path: Path) -> None:
    deck = PILE.replace("KN=8E6", "KN=1E4").replace("STOP\n", "")
    output = io.StringIO()
    lines = ["c", "rs 2", "print MCTOT", "check", "c", "c", "rs", "print TIME"]
    debug(Model(out=tmp_path), deck, output, lines)
    assert "error 15" in output.getvalue()
    assert "the deck has ended in an error: go back, or quit" in output.getvalue()
    assert output.getvalue().splitlines()[-1].startswith("TIME = ")
    assert re.search(r"MCTOT = \d+", output.getvalue())


def test_wrong_commands_are_told(tmp_path: Path) -> None:
    output = talk(
        tmp_path,
        *["nonsense", "goto x", "goto 9999999 7", "break", "watch", "print", "print nothing@1.KX", "what"],
        *[
            "what x",
            "what 1 2 3",
            "walk",
            "who",
            "wrote",
            "why",
            "born",
            "born x",
            "delete 4",
            "step -1",
            "resume 3",
        ],
        *["step pass", "reverse-step group", "reverse-continue x", "goto line", "EOF"],
    )
    assert "Traceback" not in output
    assert "no command nonsense" in output


COMMANDS = (
    "step rs rc goto print watch break delete "
    "what who walk junk dump map graph wrote why born info list c where"
)
ARGUMENTS = ["", "1", "3", "40", "block@1.KX", "TIME", "412", "pass", "group", "made", "x@y.z", "-", "line 4"]


@given(
    st.lists(st.tuples(st.sampled_from(COMMANDS.split()), st.sampled_from(ARGUMENTS)), max_size=12),
)
@settings(max_examples=25, deadline=None)
def test_any_talk_ends(tmp_path_factory: pytest.TempPathFactory, lines: list[tuple[str, str]]) -> None:
    output = talk(tmp_path_factory.mktemp("talk"), *[" ".join(line) for line in lines])
    assert "Traceback" not in output


def test_completion(tmp_path: Path) -> None:
    found: dict[str, list[str]] = {}

    def ask(told: list[str]) -> None:
        found["names"] = console.completenames("re")
        found["groups"] = console.completedefault("block@", "print block@", 6, 12)
        found["fields"] = console.completedefault("kx", "print block@1.kx", 14, 16)
        found["path"] = console.completedefault("KX", "print block@1.KP.KX", 17, 19)
        found["after @"] = console.completedefault("1.KX", "print block@1.KX", 12, 16)  # as readline cuts it

    console = Console(Model(out=tmp_path), io.StringIO())
    console.debugger.stopped = ask  # type: ignore[assignment]
    from udec_ia.deck.deck_statements import statements

    console.debugger.run(list(statements(PILE.splitlines(), "pile")))
    assert found["names"] == ["record", "resume", "reverse-continue", "reverse-step"]
    assert found["path"] == ["KXP", "KXCP", "KXDP"]
    assert "block@1" in found["groups"]
    assert "KXD" in found["fields"]
    assert found["after @"] == ["1.KX", "1.KXD"]


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck, script = tmp_path / "pile.dat", tmp_path / "script"
    deck.write_text(PILE)
    script.write_text("goto 20\nprint MCTOT\n")
    assert main(["debug", str(deck), "--out", str(tmp_path), "--commands", str(script)]) == 0
    assert "MCTOT = 20" in capsys.readouterr().out
    assert main(["debug", str(tmp_path / "none.dat")]) == 1


def test_ctrl_c_stops_the_run_and_not_the_debugger(tmp_path: Path) -> None:
    """In a process of its own: a long run, interrupted, looked at and left."""
    deck = tmp_path / "long.dat"
    deck.write_text(PILE.replace("CYCLE 60", "CYCLE 60\nCYCLE 100000000"))
    process = subprocess.Popen(
        [sys.executable, "-m", "udec_ia", "debug", str(deck), "--out", str(tmp_path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write("continue\n")
    process.stdin.flush()
    for line in process.stdout:
        if "CYCLE 100000000" in line:
            break
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate("print MCTOT\nreverse-step 10\nquit\n", timeout=120)
    assert "interrupted" in out
    assert re.search(r"MCTOT = \d+", out)
    assert process.returncode == 0


def test_expressions_and_paths_are_printed(tmp_path: Path) -> None:
    output = talk(tmp_path, "goto 70", "print block@721.KP.KYP", "print block@721.KP.KYP - block@721.KY * 2")
    corner, y = re.search(r"block@721.KP.KYP is (corner@\d+).KYP = (\S+) m", output).groups()  # type: ignore[union-attr]
    difference = float(re.search(r"block@721.KY \* 2 = (\S+)", output)[1])  # type: ignore[index]
    again = talk(tmp_path, "goto 70", f"print {corner}.KYP block@721.KY {corner}.KNB")
    y_again, centre, block = re.findall(r" = (\S+)", again)
    assert (y, block) == (y_again, "721")
    assert difference == float(y) - 2 * float(centre)
    output = talk(tmp_path, "goto 70", "print TIME", "print block@721.KY", "print abs(TIME-block@721.KY)")
    time, height, far = map(float, re.findall(r" = (\S+)", output))
    assert far == abs(time - height)
    wrong = talk(tmp_path, "goto 70", "print block@721.KX.KXP", "print 1 + FROG", "watch block@721.KX.KYP")
    assert wrong.count("KX of block@721 is not a pointer") == 2
    assert wrong.count("\n" + " " * 14 + "^") == 2
    assert "    1 + FROG\n        ^" in wrong
    wrong = talk(tmp_path, "print FRAC .KP + 1", "print AMU(1)(2) + 1", "print FRAC + _x")
    assert wrong.count("this is no name of a word") == 3
    wrong = talk(tmp_path, "print 412 * 2", "watch 412 - 3", "print abs + 1", "print")
    assert wrong.count("names no word") == 3
    assert "give a word or an expression" in wrong


def test_an_expression_is_watched(tmp_path: Path) -> None:
    """It stops where a run cycle by cycle has another value; a comparison where it comes true."""
    expression, steps = "block@721.KP.KYP / 9 - block@721.KYD", [f"goto {n}" for n in range(1, 60)]
    output = talk(tmp_path, *[line for step in steps for line in (step, f"print {expression}")])
    values = [float(text) for text in re.findall(r"KYD = (\S+)", output)]
    limit = sorted(values)[len(values) // 2]
    true = [n for n, (one, two) in enumerate(pairwise(values), 2) if one <= limit < two]
    assert len(values) == 59
    assert true
    output = talk(tmp_path, "goto 1", f"watch {expression} > {limit!r}", *["c"] * len(true))
    assert [int(n) for n in re.findall(r"-> True\nafter cycle (\d+)", output)] == true
    looks = "watch block@721.KYD * 2", "c", "c", "delete", "goto 30", "rc block@721.KP.KYP"
    output = talk(tmp_path, "goto 1", *looks)
    assert re.findall(r"^after cycle (\d+) ", output, re.M) == ["1", "2", "3", "30", "29"]


def test_unsound_states_are_stopped_at(tmp_path: Path) -> None:
    deck = PILE.replace("CYCLE 360\n", "CYCLE 5\nRSET 9. 721 4\n* then\n")
    found = talk(tmp_path, "goto 60", "break unsound", "c", "check", deck=deck)
    assert re.search(r"1: unsound: invariant \d+: (.|\n)*\nafter line 15: RSET", found)
    assert re.search(r"^invariant \d+: ", found.partition("after line 15")[2], re.M)


def test_a_model_goes_on_after_it_was_debugged(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.debug(PILE.replace("STOP\n", ""), script=["goto 5", "continue", "continue"])
    before = int(m.h.ci[g.MCTOT])
    m.cycle(3)
    m.run("CYCLE 2")
    assert int(m.h.ci[g.MCTOT]) == before + 5


def test_elements_are_counted_from_one(tmp_path: Path) -> None:
    output = talk(tmp_path, "goto 12", "print block@1.KX(0)", "print AKN(0)", f"print block@{10**25}.KX")
    assert "KX has no element 0" in output
    assert "AKN has no element 0" in output
    assert f"there is no block at {10**25}" in output


def test_help_knows_names_as_they_are_typed(tmp_path: Path) -> None:
    output = talk(tmp_path, "help rs", "help reverse-step", "step \u00b2")
    assert output.count("reverse-step") >= 2
    assert "No help" not in output
    assert "\u00b2 is not a number" in output
