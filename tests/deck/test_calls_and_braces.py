"""CALL, arithmetic in braces, continuation as in UDEC 7, other encodings, and defaults."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from udec_ia import Model, UdecError
from udec_ia.deck.arithmetic import calculate
from udec_ia.layout import offsets as g

BLOCK = "BLOCK 0,0 0,2 2,2 2,0\n"
DECK = f"START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8\n{BLOCK}SPLIT -1 1 3 1\nFIX BELOW 0 1 2 1\nGRAVITY 0 -10\n"


def run(tmp_path: Path, text: str) -> tuple[Model, str]:
    m, out = Model(out=tmp_path), io.StringIO()
    m.run(text, out)
    return m, out.getvalue()


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1+2*3", 7),
        ("(1+2)*3", 9),
        ("-2**2", -4),
        ("1e8/2", 5e7),
        ("sqrt(2)*sin(45)", 1),
        ("tan(45)+cos(60)", 1.5),
        ("2*PI", 6.283185307179586),
    ],
)
def test_arithmetic(text: str, value: float) -> None:
    assert calculate(text) == pytest.approx(value)


@pytest.mark.parametrize(
    "text", ["", "1+", "a", "1/0", "sqrt(-1)", "__import__('os')", "[1]", "1e300*1e300", "2 3", "True"]
)
def test_what_is_no_arithmetic(text: str) -> None:
    with pytest.raises((ValueError, ArithmeticError)):
        calculate(text)


def test_braces_calculate_with_variables(tmp_path: Path) -> None:
    m, out = run(tmp_path, "START\nDEFAULT KN=1E8 A=30\nPROP MAT={1+1} KN={$KN/2} KS={2*${KN}} F={tan($A)}\n")
    assert float(m.h.cr[g.AKN + 1]) == 5e7
    assert float(m.h.cr[g.AKS + 1]) == 2e8
    assert float(m.h.cr[g.AMU + 1]) == pytest.approx(0.5773502691896257)
    assert "PROP MAT=2 KN=50000000" in out


def test_an_error_in_braces_has_its_place(tmp_path: Path) -> None:
    with pytest.raises(UdecError) as error:
        run(tmp_path, "START\nDEFAULT KN=1E8\nPROP MAT=1 KN={$KN/}\n")
    assert (error.value.number, error.value.line, error.value.column) == (10, 3, 15)
    with pytest.raises(UdecError) as error:
        run(tmp_path, "START\nPROP MAT=1 KN={$KN}\n")
    assert error.value.number == 7


def test_decks_call_one_another(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "main.dat").write_text("START\nDEFAULT W=3\nCALL parts/block.dat\nSPLIT -1 1 9 1\n")
    (tmp_path / "parts" / "block.dat").write_text("CALL deep.dat\nBLOCK 0,0 0,2 $W,2 $W,0\nRETURN\nSTOP\n")
    (tmp_path / "parts" / "deep.dat").write_text("GRAVITY 0 -10\n")
    m = Model(out=tmp_path)
    m.run(tmp_path / "main.dat", io.StringIO())
    assert len(m.table("block")) == 2
    assert float(m.h.cr[g.GRAVY]) == -10
    copy = Model(out=tmp_path)
    copy.run(m.deck(), io.StringIO())
    assert copy.h.ia.tobytes() == m.h.ia.tobytes()


def test_what_cannot_be_called(tmp_path: Path) -> None:
    (tmp_path / "loop.dat").write_text("START\nCALL loop.dat\n")
    (tmp_path / "wrong.dat").write_text("START\nCALL part.dat\n")
    (tmp_path / "part.dat").write_text("\nGRAVITY 0\n")
    for name, number, file in (("loop.dat", 28, "loop.dat"), ("wrong.dat", 7, "part.dat")):
        with pytest.raises(UdecError) as error:
            Model(out=tmp_path).run(tmp_path / name, io.StringIO())
        assert error.value.number == number
        assert Path(str(error.value.file)).name == file
    with pytest.raises(UdecError) as error:
        run(tmp_path, "START\nCALL nothere.dat\n")
    assert error.value.number == 29


@pytest.mark.parametrize("mark", ["&", "...", " & ; a remark"])
def test_a_mark_at_the_end_of_a_line_continues_it(tmp_path: Path, mark: str) -> None:
    m, _ = run(tmp_path, f"START\nPROP MAT=1 DENS=2000 {mark}\n* a comment\nKN=1E8 {mark}\n KS=2E8\n{BLOCK}")
    assert [float(m.h.cr[k]) for k in (g.DENS, g.AKN, g.AKS)] == [2000, 1e8, 2e8]
    assert len(m.table("block")) == 1


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig", "latin-1"])
def test_decks_in_other_encodings(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "deck.dat"
    path.write_bytes(f"; Böschung\r\n{DECK}CYCLE 10\r\n".encode(encoding))
    m = Model(out=tmp_path)
    m.run(path, io.StringIO())
    assert int(m.h.ci[g.MCTOT]) == 10


def test_solve_without_a_number(tmp_path: Path) -> None:
    m, out = run(tmp_path, f"{DECK}DAMPING LOCAL=0.8\nSOLVE\nPRINT MAX\n")
    assert m.solve().wanted == 1e-5
    assert "force ratio 1e-05 reached" in out
    force = next(line for line in out.splitlines() if line.startswith("normal force"))
    assert float(force.split()[2]) == pytest.approx(2000 * 10 * 2 / 2, rel=1e-4)


def test_contacts_without_stiffness_get_that_of_the_blocks(tmp_path: Path) -> None:
    deck = DECK.replace("KN=1E8 KS=1E8", "BULK=1E9 G=6E8")
    m, out = run(tmp_path, f"{deck}CYCLE 10\nCYCLE 10\n")
    assert float(m.h.cr[g.AKN]) == float(m.h.cr[g.AKS]) == pytest.approx(10 * (1e9 + 0.8e9))
    assert out.count("has no KN and KS") == 1
    assert out.count("rounding length") == 1
    with pytest.raises(UdecError) as error:
        run(tmp_path, f"{DECK.replace('KN=1E8 KS=1E8', '')}CYCLE 1\n")
    assert error.value.number == 11


def test_a_deck_of_udec_7_runs_unchanged(tmp_path: Path) -> None:
    """Four blocks on a slope: the upper one slides when friction is less than the slope."""
    text = """; a comment
new
title SLOPE
round 0.15
block (0,0) (0,24) (30,24) (30,0)
crack (0,3) (30,12)
fix range 0,30 0,9
prop mat=1 d=2400
prop jmat=1 jkn=2e9 jks=2e9 jfric=30
change jmat=1
set grav 0 -9.81
damp auto
hist unbal
hist yvel 19,20
cycle 2000
prop jmat=1 jfric=15
damp 0 1
reset disp time hist
cycle time 0.5
quit
"""
    m, out = run(tmp_path, text)
    assert "read as: SPLIT 0 3 30 12" in out
    (upper,) = m.table("block")[m.table("block")["KY"] > 12]
    down = 9.81 * (0.2873478855663454 - 0.2679491924311227 * 0.9578262852211514)  # sin psi - tan 15 cos psi
    assert float(upper["KXD"]) == pytest.approx(-down * 0.5 * 0.9578262852211514, rel=0.02)
    with pytest.raises(UdecError) as error:
        run(tmp_path, "new\nreinforce 1 1 2 2\n")
    assert error.value.number == 2
    assert "SPROPERTY" in str(error.value)
    with pytest.raises(UdecError) as error:
        run(tmp_path, "new\ncable 1,1 5,5 5 1 1\n")  # with numbers in place of SEGMENTS and SMATERIAL
    assert error.value.number == 10
