"""The monitor, on a model that only writes down what it is told."""

import io
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from support.call_recorder import Recorder

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.deck.command_monitor import run_deck
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.interactive_session import converse, history, history_file
from udec_ia.errors import UdecError


def obey(deck: str, model: Recorder | None = None) -> tuple[Recorder, str]:
    """Run `deck`; the model afterwards, and what was printed."""
    model = model or Recorder()
    out = io.StringIO()
    run_deck(model, deck, out)
    return model, out.getvalue()


def refused(deck: str, model: Recorder | None = None) -> tuple[Recorder, UdecError]:
    """Run `deck`, which must end in an error."""
    model = model or Recorder()
    with pytest.raises(UdecError) as caught:
        run_deck(model, deck, io.StringIO())
    return model, caught.value


def test_every_line_is_echoed_before_what_it_prints() -> None:
    model = Recorder()
    model.answers |= {"print": "a table", "plot": Path("results/plot.png")}
    _, printed = obey("START\n\n* one\nP B\n* two\nPLOT 0\n+ C\n* three\n", model)
    before, after = "> START\n>\n> * one\n> P B\na table\n", "> + C\nwritten: results/plot.png\n> * three\n"
    assert printed == f"{before}> * two\n> PLOT 0\n{after}"


def test_stop_ends_the_run_and_the_rest_is_ignored() -> None:
    model, printed = obey("START\nSTOP\nEND\nNONSENSE\n")
    assert model.names == ["start", "stop"]
    assert "END" not in printed


def test_end_is_the_end_without_stop_too() -> None:
    assert obey("START\nEND\nNONSENSE")[0].names == ["start"]


@pytest.mark.parametrize("deck", ["", "\n\n", "* nothing\n", "END\n", "STOP\n", "\ufeff", ",(=)/\n"])
def test_an_empty_deck_is_no_error(deck: str, tmp_path: Path) -> None:
    path = tmp_path / "empty.dat"
    path.write_text(deck, encoding="utf-8")
    model = Recorder()
    run_deck(model, path, io.StringIO())
    assert model.names == []


def test_the_first_command_is_start_or_restart() -> None:
    model, error = refused("* a comment\n CYCLE 1\n")
    assert (error.number, error.line, error.column, error.saved) == (3, 2, 2, None)
    assert model.names == []
    assert obey("RESTART a.h5\nCYCLE 1")[0].names == ["restart", "cycle"]
    assert "PROperty" in obey("HELP\n")[1]


def test_commands_that_were_obeyed_are_logged() -> None:
    model, _ = refused("START\n* a comment\nBLOCK 0 0\n+ 1 1\n+ 1 1\nCYCLE 5\nCYCLE x\n")
    assert model.session.deck_log == ["START", "BLOCK 0 0", "+ 1 1", "+ 1 1", "CYCLE 5"]


def test_an_error_saves_the_state_names_the_file_and_ends_the_run() -> None:
    model, error = refused("START\nGRAVITY 0\n")
    assert model.calls[1:] == [("save", ((Path("results") / "rescue.h5").absolute(),), {}), ("stop", (), {})]
    assert error.saved == str(Path("results/rescue.h5"))
    assert str(error).endswith(f"are saved in {error.saved}")


def test_a_failing_save_does_not_hide_the_error() -> None:
    model, out = Recorder(), io.StringIO()
    model.failures["save"] = OSError(28, "No space left on device")
    with pytest.raises(UdecError) as caught:
        run_deck(model, "START\nCYCLE 10.5\n", out)
    assert (caught.value.number, caught.value.saved) == (10, None)
    assert "could not be saved: [Errno 28] No space left" in out.getvalue()
    assert model.names[-1] == "stop"


def test_a_run_that_can_write_no_file_ends_with_its_summary(tmp_path: Path) -> None:
    """The folder for files is an ordinary file: PLOT says so at once, and is undone."""
    folder, out = tmp_path / "file", io.StringIO()
    folder.touch()
    model = Model(out=folder)
    with pytest.raises(UdecError) as caught:
        run_deck(model, "START\nBLOCK 0 0 0 1 1 1 1 0\nPLOT 0\nSTOP\n", out)
    assert (caught.value.number, caught.value.line, caught.value.saved) == (31, 3, None)
    assert str(folder) in caught.value.message
    assert out.getvalue().count("could not be saved") == 1
    assert "not all pictures were written" not in out.getvalue()
    assert out.getvalue().count("1 block, 0 contacts, largest normal force 0 N/m; no file written") == 1


def test_a_damaged_main_array_is_saved_by_force() -> None:
    model = Recorder()
    model.fails("cycle", 20)
    error = refused("START\nCYCLE 1\n", model)[1]
    assert "the damaged state is saved in results/rescue.h5" in str(error)
    assert model.names == ["start", "cycle", "save", "stop"]
    assert model.calls[2][2] == {"force": True}


def test_an_interrupted_run_is_saved() -> None:
    model = Recorder()
    model.failures["cycle"] = KeyboardInterrupt()
    with pytest.raises(KeyboardInterrupt, match=r"rescue\.h5"):
        run_deck(model, "START\nCYCLE 1\n", io.StringIO())
    assert model.names == ["start", "cycle", "save", "stop"]


@pytest.mark.parametrize(
    ("line", "parameter", "column"),
    [
        ("BLOCK MAT=99 0 0 0 1 1 1", "material", 11),
        ("BLOCK 0 0 0 1 1 1", "material", 1),
        ("BLOCK 0,0 0,1\n+ 1,1", "y2", 13),
        ("PROP M 1 KN=1 K=2", "kn", 13),
        ("PROP M 1 KN=1 K=2", "bulk", 17),
        ("DAMP 9 10", "freq", 8),
        ("CYCLE 5", "", 1),
        ("GEN 0 1 0 1 AUTO", "mode", 13),
        ("SAVE there/it.h5", "", 6),
        ("SAVE", "", 1),
        ("HELP FOO", "", 6),
    ],
)
def test_errors_of_the_model_point_at_the_parameter_to_blame(line: str, parameter: str, column: int) -> None:
    model = Recorder()
    for name in ("block", "property", "damping", "cycle", "generate", "save"):
        model.failures[name] = UdecError(28, parameter=parameter)
    _, error = refused(f"START\n{line}\n", model)
    assert (error.line, error.column, error.source) == (2, column, line.split("\n")[0])
    assert error.advice


def test_a_command_that_takes_blocks_says_how_many() -> None:
    """Cut along the middle, then across both halves; what happens to none says so."""
    out = io.StringIO()
    lines = (
        "BLOCK 0,0 0,2 2,2 2,0\nSPLIT -1,1 3,1\nSPLIT 1,-1 1,3\nSPLIT 5,5 6,6\nFIX 0 2 0 1\nFREE 0 1 0 1\n"
    )
    run_deck(Model(), f"START\n{lines}CHANGE 0 2 0 2 MAT=3\nDELETE 0 1 0 1\nDELETE 0 1 0 1\n", out)
    assert [line for line in out.getvalue().split("\n") if not line.startswith(">")] == [
        " SPLIT: 1 block cut off, 2 blocks now",
        " SPLIT: 2 blocks cut off, 4 blocks now",
        " SPLIT: no block was cut: the line meets no block; all blocks lie in x 0 to 2, y 0 to 2",
        " FIX: 2 blocks fixed",
        " FREE: 1 block set free",
        " CHANGE: 4 blocks changed",
        " DELETE: 1 block deleted, 3 blocks now",
        " DELETE: no block in range: no centroid in x 0 to 1, y 0 to 1, "
        "the nearest is block@535 at (0.5, 1.5)",
        "",
    ]


def test_files_named_in_a_deck_are_in_the_folder_for_files() -> None:
    model, _ = obey("START\nSAVE one.h5\nSAVE\nRESTART one.h5\nSAVE /there/one.h5\n")
    in_out, elsewhere = {"path": Path("results/one.h5")}, {"path": Path("/there/one.h5")}
    assert [named for _, _, named in model.calls[1:]] == [in_out, {}, in_out, elsewhere]


def test_a_folder_that_is_not_there_yet_has_one_above_it(tmp_path: Path) -> None:
    model = Recorder()
    model.out = tmp_path / "new"
    run_deck(model, "START\nRESTART ../old/one.h5\n", io.StringIO())
    assert model.calls[1][2] == {"path": tmp_path / "old" / "one.h5"}


def test_a_file_that_cannot_be_written_is_error_31() -> None:
    model = Recorder()
    model.failures["save"] = PermissionError(13, "Permission denied", "run.h5")
    _, error = refused("START\nSAVE run.h5", model)
    assert (error.number, error.column) == (31, 6)
    assert "Permission denied: run.h5" in error.message


printable_soup = st.lists(
    st.sampled_from([command.keyword for command in COMMANDS])
    | st.sampled_from([word.keyword for command in COMMANDS for word in command.words])
    | st.integers().map(str)
    | st.floats().map(str)
    | st.sampled_from(["\n", "\n", "\n+", "\n*", "+", "=", "(", "\x00", "\t", "\r", "\x85", "\u2028"])
    | st.text(max_size=5)
)


def fault(deck: str) -> UdecError | None:
    """The error that `deck` ends in on a model that is started already, or None."""
    model = Recorder()
    model.session.started = True
    try:
        run_deck(model, deck, io.StringIO())
    except UdecError as error:
        return error
    return None


@example("\n \n PAtch")  # a line of blanks before a command with a text
@given(printable_soup.map(" ".join) | st.binary().map(lambda raw: raw.decode("utf-8", "replace")))
def test_any_text_is_obeyed_or_refused_with_a_place(soup: str) -> None:
    error = fault(f"\n{soup}")
    if error is None:
        return
    assert error.line is not None
    assert error.column is not None
    source = ["\n", *io.StringIO(soup, newline=None)][error.line - 1].rstrip("\n")
    assert 1 <= error.column <= len(source) + 1
    assert source[error.column - 1 :].startswith(error.token or "")
    assert error.advice


class Typist:
    """Types lines at the prompt, and keeps the prompts."""

    def __init__(self, *lines: str | BaseException) -> None:
        self.lines = list(lines)
        self.prompts: list[str] = []

    def __call__(self, prompt: str) -> str:
        self.prompts.append(prompt)
        line = self.lines.pop(0) if self.lines else EOFError()
        if isinstance(line, BaseException):
            raise line
        return line


def talk(*lines: str | BaseException) -> tuple[Recorder, str, list[str]]:
    model, out, typist = Recorder(), io.StringIO(), Typist(*lines)
    converse(model, out, typist)
    return model, out.getvalue(), typist.prompts


def test_a_session_goes_on_after_an_error_and_saves_nothing() -> None:
    model, printed, _ = talk("CYCLE 1", "START", "CYCLE x", "CYCLE 2", "STOP", "CYCLE 3")
    assert model.names == ["start", "cycle", "stop"]
    assert "terminal:1:1: error 3" in printed
    assert "terminal:3:7: error 10" in printed


def test_a_session_whose_stop_fails_ends_with_the_summary_and_the_error() -> None:
    model, out = Recorder(), io.StringIO()
    model.failures["stop"] = PermissionError(13, "Permission denied", "run-plot-1.png")
    model.answers["summary"] = "0 cycles"
    with pytest.raises(UdecError) as caught:
        converse(model, out, Typist("START", "STOP"))
    assert caught.value.number == 31
    assert out.getvalue().endswith("\n0 cycles\n")


SQUARE = ("block", (0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0), {})


def test_a_list_is_asked_for_until_an_empty_line_or_a_command() -> None:
    model, _, prompts = talk("START", "BLOCK 0 0", "0 1", "* which is the top", "+ 1 1", "1 0", "", "CYCLE 1")
    assert prompts == ["> ", "> ", *5 * ["+ "], "> ", "> "]
    assert model.calls[1] == SQUARE
    assert model.names == ["start", "block", "cycle", "stop"]
    model, printed, _ = talk("START", "BLOCK 0 0 0 1 1 1 1 0", "SPLIT -1 .5 2 .5", "P B")
    assert model.calls[1] == SQUARE
    assert model.names == ["start", "block", "split", "print", "stop"]
    assert "error" not in printed


def test_words_of_the_command_continue_a_list_and_other_words_do_not() -> None:
    lines = ("GEN 0 1 0 1 M", "GRID 0 0 1 0", "0 1", "Z (1 2 3)", "2 3 4", "NONSENSE")
    model, printed, _ = talk("START", *lines, "GEN 0 1 0 1 AUTO EDGE 1", "G 0 -10")
    named = {
        "mode": "manual",
        "gridpoints": [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)],
        "zones": [(1, 2, 3), (2, 3, 4)],
    }
    assert model.calls[1] == ("generate", (0.0, 1.0, 0.0, 1.0), named)
    assert model.names == ["start", "generate", "generate", "gravity", "stop"]
    assert printed.count("error") == printed.count("terminal:7:1: error 2: ") == 1


def test_comments_at_the_terminal_neither_end_nor_hide_a_line() -> None:
    model, printed, _ = talk(
        "START ; go", "BLOCK 0 0 0 1 # left", "; note", "1 1 1 0", "", "CYCLE + ! so many", "1#!"
    )
    assert model.calls[1] == SQUARE
    assert model.calls[2] == ("cycle", (1,), {})
    assert "error" not in printed


def test_a_plus_at_the_end_of_a_line_continues_any_command() -> None:
    model, printed, prompts = talk("START", "PROP MAT=1 KN=1E8 +", "KS=1E8+", "F=0.3", "CYCLE 1")
    assert prompts == ["> ", "> ", "+ ", "+ ", "> ", "> "]
    assert model.calls[1:3] == [
        ("property", (), {"material": 1, "kn": 1e8, "ks": 1e8, "friction": 0.3}),
        ("cycle", (1,), {}),
    ]
    assert model.session.deck_log == ["START", "PROP MAT=1 KN=1E8", "+ KS=1E8", "+ F=0.3", "CYCLE 1"]
    assert "error" not in printed


def test_a_plus_after_a_command_that_was_obeyed_says_how_to_continue_it() -> None:
    model, printed, _ = talk("START", "PROP MAT=1 KN=1E8", "+ DENS=2000", "CYCLE 1", "SAVE a+")
    assert model.names == ["start", "property", "cycle", "save", "stop"]
    assert "terminal:3:1: error 2" in printed
    assert "end the line of the command with +" in printed


def test_the_end_of_input_obeys_what_is_pending() -> None:
    model, _, _ = talk("START", "BLOCK 0 0 0 1 1 1 1 0")
    assert model.calls[1] == SQUARE
    assert model.names == ["start", "block", "stop"]


def test_ctrl_c_drops_the_line_and_not_the_session() -> None:
    model, printed, _ = talk("START", "BLOCK 0 0", KeyboardInterrupt(), "CYCLE 1")
    assert model.names == ["start", "cycle", "stop"]
    assert "interrupted" in printed


def test_the_history_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    readline = pytest.importorskip("readline")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    with history(history_file()):
        readline.add_history("GRAVITY 0 -10")
    readline.clear_history()
    with history(history_file()):
        assert readline.get_history_item(1) == "GRAVITY 0 -10"
    readline.clear_history()


@pytest.mark.parametrize("one_line", [True, False])
@pytest.mark.parametrize("seekable", [True, False])
def test_a_deck_that_does_not_end_is_an_error(
    one_line: bool, seekable: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whether it comes from a file or through a pipe, in one line or many."""
    monkeypatch.setattr("udec_ia.deck.deck_statements.LARGEST", 1000)

    class Endless(io.StringIO):
        def seekable(self) -> bool:
            return seekable

    text = "*" * 3000 if one_line else "* comment\n" * 300
    with pytest.raises(UdecError) as caught:
        run_deck(Recorder(), Endless(text), io.StringIO(), name="pipe")
    assert caught.value.number == 28
    assert "pipe" in caught.value.message


def test_all_commands_that_read_decks_have_the_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("udec_ia.deck.deck_statements.LARGEST", 100)
    deck = tmp_path / "long.dat"
    deck.write_text("* comment\n" * 30)
    for name in ("run", "debug", "trade", "sweep"):
        more = ["--set", "F=1,2"] if name == "sweep" else []
        with suppress(SystemExit):
            assert main([name, str(deck), "--out", str(tmp_path / name), *more]) not in (0, None)
