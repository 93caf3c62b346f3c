"""The command `udec`: its exit status, what it writes where, and that it never shows a traceback."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import udec_ia
from udec_ia.cli import main
from udec_ia.model import Model

ROOT = Path(__file__).parents[2]
SMALL = "START\nBLOCK 0,0 0,1 1,1 1,0\nSAVE\nSTOP\nEND\n"


def udec(*arguments: str | Path, deck: bytes = b"", **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the command in a process of its own, with `deck` on its standard input."""
    done = subprocess.run(
        [sys.executable, "-m", "udec_ia", *map(str, arguments)],
        input=deck,
        capture_output=True,
        timeout=120,
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        check=False,
    )
    out, err = done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")
    assert "Traceback" not in err
    return subprocess.CompletedProcess(done.args, done.returncode, out, err)


@pytest.fixture
def in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_an_error_ends_with_status_1_and_says_where(in_folder: Path) -> None:
    Path("deck.dat").write_text("START\nPROP MAT=1 DENSITEE=2000\n")
    done = udec("run", "deck.dat")
    assert done.returncode == 1
    assert done.stdout.startswith("> START\n> PROP MAT=1 DENSITEE=2000\n")
    assert 'deck.dat:2:12: error 10: unrecognised parameter: "DENSITEE"\n' in done.stderr
    assert "\n    PROP MAT=1 DENSITEE=2000\n               ^\ndid you mean DENSITY?" in done.stderr
    saved = in_folder / "rescue.h5"
    assert f"are saved in {saved}" in done.stderr
    assert saved.exists()


def test_a_deck_on_standard_input(in_folder: Path) -> None:
    done = udec("run", "--out", "results", deck=SMALL.encode())
    assert done.returncode == 0
    assert "> BLOCK" in done.stdout
    assert udec(deck=b"STOP\n").returncode == 0
    assert "stdin:1:1: error 3" in udec(deck=b"CYCLE 1\n").stderr


@pytest.mark.parametrize("line", [["deck.dat"], ["deck.dat", "--out", "new"], ["--out", "new", "deck.dat"]])
def test_the_name_of_a_deck_is_enough(
    line: list[str], in_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("deck.dat").write_text(SMALL)
    assert main(line) == 0
    assert "> BLOCK" in capsys.readouterr().out
    assert Path("new" if "new" in line else ".", "restart.h5").exists()


def test_a_word_that_is_neither_command_nor_deck(in_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["chekc", "restart.h5"])
    assert caught.value.code == 2
    printed = capsys.readouterr().err
    assert "there is no file chekc, and the commands are udec run, udec info, udec check" in printed


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are text elsewhere")
def test_a_deck_whose_name_is_no_utf8(in_folder: Path) -> None:
    deck = os.fsencode(in_folder) + b"/d\xe9ck.dat"
    Path(os.fsdecode(deck)).write_text(SMALL.replace("SAVE", "PLOT\nSAVE\nPLOT 7"))
    done = subprocess.run(
        [os.fsencode(sys.executable), b"-m", b"udec_ia", b"run", deck],
        capture_output=True,
        timeout=120,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        check=False,
    )
    printed = done.stderr.decode()
    assert (done.returncode, "Traceback" in printed) == (1, False)
    assert ":5:6: error 28: value out of range: PLOT 7" in printed
    assert b"d\xe9ck-plot-1.png" in os.listdir(os.fsencode(in_folder))


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
def test_nothing_can_be_written_to_the_standard_output(in_folder: Path) -> None:
    Path("deck.dat").write_text(SMALL)
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "udec_ia", "run", "deck.dat"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=120,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            check=False,
        )
    assert done.returncode == 1
    assert "standard output: No space left on device" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_restart_file_is_no_deck(in_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Model().save(in_folder / "run.h5")
    assert main(["run.h5"]) == 1
    told = capsys.readouterr().err
    assert told.endswith(
        "this is a restart file: udec info shows its contents, RESTART in a deck continues from it\n"
    )


def test_check_and_info_of_a_saved_run(in_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("deck.dat").write_text(SMALL.replace("SAVE", "SAVE one.h5"))
    assert main(["run", "deck.dat"]) == 0
    capsys.readouterr()
    assert main(["check", "one.h5"]) == 0
    assert capsys.readouterr().out == "one.h5: sound\n"
    assert main(["info", "one.h5"]) == 0
    assert capsys.readouterr().out


NARROW = """
import resource, sys
from udec_ia.cli import main
main(["info", "large.h5"])
size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize() + 250 * 2**20
resource.setrlimit(resource.RLIMIT_AS, (size, size))
sys.exit(main(["convert", "large.h5", "to.h5", "--build", "i64r64"]))
"""


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the limit is set by what Linux tells")
def test_memory_that_is_not_there_is_told(in_folder: Path) -> None:
    """An array has room for 40 million words that its file need not hold: 160 MB, and 320 MB converted."""
    model = Model("i32r64", mtop=40_000_000)
    model.block(0, 0, 0, 1, 1, 1, 1, 0)
    model.save("large.h5")
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", NARROW]
    done = subprocess.run(command, capture_output=True, timeout=120, env=environment, check=False, text=True)
    assert done.returncode == 1
    assert done.stderr.startswith("udec: there is not enough memory")
    assert "Traceback" not in done.stderr
    assert not Path("to.h5").exists()


@pytest.mark.parametrize("verb", ["check", "info"])
def test_a_foreign_file_is_refused(verb: str, in_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("foreign.h5").write_bytes(b"not a restart file")
    assert main([verb, "foreign.h5"]) == 1
    assert "error 29" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["missing.dat", "."])
def test_a_deck_that_cannot_be_read(name: str, in_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", name]) == 1
    assert capsys.readouterr().err.endswith(
        f"udec: {name}: {'Is a directory' if name == '.' else 'No such file or directory'}\n"
    )


def test_a_main_array_of_no_size(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "--mtop", "0"]) == 2
    assert "--mtop 0: mtop must lie between" in capsys.readouterr().err


def test_a_folder_that_takes_no_files_is_refused_before_the_run(
    in_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The folder, or the one in which it would have to be made, is an ordinary file."""
    Path("deck.dat").write_text(SMALL)
    for out in ("deck.dat", "deck.dat/results/deep"):
        assert main(["run", "deck.dat", "--out", out]) == 2
        printed = capsys.readouterr()
        assert printed.err == f"udec: --out {out}: files cannot be written there\n"
        assert printed.out == ""
    assert main(["run", "deck.dat", "--out", "results/deep"]) == 0
    assert list(Path("results/deep").iterdir())


def test_an_unknown_build_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["run", "--build", "i8r8"])
    assert caught.value.code == 2
    assert "i16r32" in capsys.readouterr().err


def test_the_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"udec_ia {udec_ia.__version__}\n"


def test_garbage_is_refused_on_an_ascii_terminal_too() -> None:
    done = udec("run", deck=bytes(range(256)), PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    assert done.returncode == 1
    assert "error 2" in done.stderr


def test_a_closed_pipe_ends_the_run_quietly() -> None:
    deck = "HELP\n" * 2000
    command = f"{sys.executable} -m udec_ia run | head -1"
    done = subprocess.run(
        command, shell=True, input=deck, capture_output=True, text=True, timeout=120, cwd=ROOT, check=False
    )
    assert done.stdout == "> HELP\n"
    assert "Traceback" not in done.stderr
    assert "BrokenPipe" not in done.stderr


def test_ctrl_c_ends_a_run_cleanly() -> None:
    command = [sys.executable, "-m", "udec_ia"]
    with subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
    ) as run:
        assert run.stdin is not None
        assert run.stdout is not None
        run.stdin.write("HELP\n* a line that may be continued\nHELP\n")
        run.stdin.flush()
        assert run.stdout.readline() == "> HELP\n"  # it runs, and waits for more
        run.send_signal(signal.SIGINT)
        _, err = run.communicate(timeout=120)
    assert run.returncode == 130
    assert err.endswith("\ninterrupted\n")
    assert "Traceback" not in err


def test_nothing_heavy_is_loaded_to_run_a_deck() -> None:
    code = "import sys, udec_ia.cli; print([m for m in ('matplotlib', 'PIL') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True)
    assert done.stdout == "[]\n"
