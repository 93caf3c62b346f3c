"""udec verify: what it lists, prints and writes, and what it does when a problem goes wrong."""

from __future__ import annotations

import json
import runpy
import sys
from pathlib import Path

import pytest
from PIL import Image

from udec_ia.cli import main
from udec_ia.studies.verification import problem_names

PAGE = Path(__file__).parents[2] / "docs" / "studies" / "verification_page.py"
FALLING = '''"""A number that is {what}

    n = 1

Source: nobody, 2000
"""

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid", "fdef")


def solve(case):
    m = case.model()
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    {statement}
    case.graph("x", "y", {{"exact": ([0, 1], [0, 1])}}, [([0, 1], [0, 1])])
    yield Answer("n | m", "", {value}, 1.0, {{"nothing": 1e-9, "last digit": case.last_digit}})
'''


def problem(
    folder: Path, name: str, what: str = "one", value: str = "1.0", statement: str = "m.round(0.1)"
) -> str:
    """The path of a file with a problem."""
    path = folder / f"{name}.py"
    path.write_text(FALLING.format(what=what, value=value, statement=statement))
    return str(path)


def test_all_problems_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--list"]) == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split()[:2] == ["problem", "blocks"]
    assert [line.split()[0] for line in lines] == problem_names()


def test_one_problem_of_ones_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", problem(tmp_path, "mine"), "--blocks", "rigid"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("1 case, all within tolerance\n")
    assert err.startswith("mine, rigid, i32r64: 1 of 1 within tolerance, at most 0 % of it")


def test_files_of_models_do_not_go_into_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A history, also where the problem fails afterwards."""
    here = tmp_path / "here"
    here.mkdir()
    written = (
        "m.property(1, density=2.0, kn=1.0, ks=1.0); m.history(1, 'TIME'); m.cycle(3); "
        "assert any(m.out.glob('*.csv'))"
    )
    given = [
        problem(tmp_path, "good", statement=written),
        problem(tmp_path, "bad", statement=f"{written}; 1 / 0"),
    ]
    monkeypatch.chdir(here)
    assert main(["verify", *given, "--blocks", "rigid", "--json"]) == 1
    good, bad = json.loads(capsys.readouterr().out)["rows"]
    assert good["verdict"] == "holds"
    assert bad["why"].startswith("ZeroDivisionError")
    assert not [*here.iterdir()]


def test_what_goes_wrong_is_a_row_and_no_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = [
        problem(tmp_path, "off", value="1.001"),
        problem(tmp_path, "nan", value="float('nan')"),
        problem(tmp_path, "error", statement="m.round(5)"),
        problem(tmp_path, "bug", statement="1 / 0"),
        problem(tmp_path, "good"),
    ]
    assert main(["verify", *given, "--blocks", "fdef", "--json"]) == 1
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert [row["problem"] for row in rows] == ["off", "nan", "error", "bug", "good"]
    assert [row["verdict"] for row in rows] == ["FAILS"] * 4 + ["holds"]
    assert rows[0]["error"] == pytest.approx(1e-3)
    assert rows[0]["tolerance"] == pytest.approx(1e-9, rel=1e-6)
    assert rows[2]["why"].startswith("error 14: rounding length too great")
    assert "ZeroDivisionError" in rows[3]["why"]
    assert "line 16 of" in rows[3]["why"]


def test_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given = [problem(tmp_path, "one"), problem(tmp_path, "two", what="two", value="2.0")]
    folder = tmp_path / "out"
    command = ["page.py", str(folder), *given, "--build", "i32r64,i32r32"]
    monkeypatch.setattr(sys, "argv", command)
    assert runpy.run_path(str(PAGE))["main"]() == 0
    page = (folder / "verification.md").read_text()
    assert f"\n    python {' '.join(command)}\n" in page
    assert "| [one](#a-number-that-is-one) | A number that is one | rigid, fdef | 4 | 0 % |" in page
    assert "| [two](#a-number-that-is-two) | A number that is two | rigid, fdef | 4 | **fails** |" in page
    assert "| fdef | i32r32 | n \\| m | 2 | 1 | 1e+02 % **too much** | 6.1e-06 % | 6e-06 % last digit" in page
    pictures = sorted((folder / "images" / "verify").iterdir())
    assert [path.name for path in pictures] == ["one.png", "two.png"]
    for path in pictures:
        with Image.open(path) as picture:
            assert picture.format == "PNG"


@pytest.mark.parametrize(
    ("given", "printed"),
    [
        (["inclin"], "there is no problem inclin: udec verify --list names them all"),
        (["qqq"], "there is no problem qqq: udec verify --list names them all"),
        (["--blocks", "soft"], "--blocks soft: choose from rigid, sdef, fdef"),
        (["--build", "i8r8"], "--build i8r8: choose from i16r32"),
        (["ball", "--blocks", "fdef"], "none of these problems makes sense for fdef in i32r64"),
    ],
)
def test_a_wrong_command_line(given: list[str], printed: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", *given]) == 2
    assert f"udec verify: {printed}" in capsys.readouterr().err


def test_a_file_that_is_no_problem(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "law.py"
    path.write_text('"""Nothing."""\n')
    assert main(["verify", str(path)]) == 2
    complaint = " ".join(capsys.readouterr().err.split())  # folded where the path lets it be
    assert "is not a problem: ValueError: it needs a docstring, BLOCKS and solve(case)" in complaint
    path.write_text("1 +\n")
    assert main(["verify", str(path)]) == 2
    assert "SyntaxError" in capsys.readouterr().err


def test_python_does_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["verify", problem(tmp_path, "mine"), "--blocks", "rigid"]
    assert main([*command, "--python"]) == 0
    script = capsys.readouterr().out
    exec(compile(script, "script", "exec"), {})
    assert "mine, rigid, i32r64: 1 of 1 within tolerance" in capsys.readouterr().out


def test_short_reals_are_not_tried_on_what_they_lose(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = Path(problem(tmp_path, "fine"))
    path.write_text(path.read_text() + "\n\nREALS = 64\n")
    assert main(["verify", str(path), "--build", "i32r32,i32r64", "--blocks", "rigid"]) == 0
    out, err = capsys.readouterr()
    assert "not run with 32-bit reals, which are too coarse for them: fine\n" in out
    assert "i32r32" not in err
    assert main(["verify", str(path), "--build", "i32r32"]) == 2
