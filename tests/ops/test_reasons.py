"""What a command says when it has found nothing, or something that it cannot use: why, and what is near."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from udec_ia import Model, UdecError
from udec_ia.deck.command_forms import match
from udec_ia.deck.command_monitor import run_deck
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.keyword_suggestions import ALSO_CALLED
from udec_ia.layout.offsets import TIME

U = (0, 0, 0, 3, 1, 3, 1, 1, 2, 1, 2, 3, 3, 3, 3, 0)  # a notch from above


@pytest.fixture(autouse=True)
def in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that ends in an error saves itself there."""
    monkeypatch.chdir(tmp_path)


def run_line(m: Model, line: str) -> str:
    """What `line` prints."""
    printed = m.run(line)
    assert printed is not None
    return printed.removeprefix(f"> {line}\n").strip()


def refused_or_said(m: Model, line: str, column: int) -> str:
    """What `line` prints, or what error 24 says at `column`."""
    try:
        return run_line(m, line)
    except UdecError as error:
        return error.message if (error.number, error.column) == (24, column) else str(error)


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("5 -1 5 5", "the line ends inside block@1 at (5, 5);"),
        ("5 5 15 5", "the line begins inside block@1 at (5, 5);"),
        ("4 5 6 5.5", "the line begins inside block@1 at (4, 5) and ends inside block@1 at (6, 5.5);"),
        ("0 0 5 5", "the line ends inside block@1 at (5, 5);"),
        ("0 -1 0 11", "the line only touches block@1,"),
        ("-5 5 5 15", "the line only touches block@1,"),
        ("2 0 8 0", "the line only touches block@1,"),
        ("20 20 30 30", "the line meets no block; all blocks lie in x 0 to 10, y 0 to 10"),
        ("11 5 30 30", "the line meets no block;"),
    ],
)
def test_why_no_block_is_cut(line: str, reason: str) -> None:
    m = Model()
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    assert run_line(m, f"SPLIT {line}").startswith(f"SPLIT: no block was cut: {reason}")


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("1 1 2 1", "only touches block@1"),
        ("1 3 1 1", "only touches block@1"),
        ("1.2 2 1.8 2.5", "meets no block"),
        ("1.5 2 1.5 0.5", "ends inside block@1 at (1.5, 0.5)"),
        ("0.5 2 2.5 2", "begins inside block@1 at (0.5, 2) and ends inside block@1 at (2.5, 2)"),
    ],
)
def test_why_a_block_with_a_notch_is_not_cut(line: str, reason: str) -> None:
    """Inside the notch is outside the block; its floor is an edge like others."""
    m = Model()
    m.block(*U)
    assert reason in run_line(m, f"SPLIT {line}")


def test_a_line_that_ends_in_two_blocks_names_both() -> None:
    m = Model()
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    m.split(-1, 5, 11, 5)
    upper = int(m.table("block")[0]["address"])
    assert f"begins inside block@1 at (2, 4) and ends inside block@{upper} at (2, 6);" in run_line(
        m, "SPLIT 2 4 2 6"
    )


@pytest.mark.parametrize("line", ["SPLIT 0 0 1 1", "FIX 0 1 0 1", "DELETE 0 1 0 1"])
def test_before_the_first_block(line: str) -> None:
    m = Model()
    m.start()
    assert run_line(m, line).endswith("there is no block yet: create one with BLOCK")


TURNED = "x1 = 10 is not below x2 = 0, where a range is x1 x2 y1 y2"
NEAREST = "no centroid in x 0 to 1, y 0 to 1, the nearest is block@1 at (5, 2.5)"


@pytest.mark.parametrize("command", ["FIX", "FREE", "DELETE", "CHANGE", "INSITU", "GENERATE", "BOUNDARY"])
def test_why_no_block_is_in_the_range(command: str) -> None:
    m = Model()
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    m.split(-1, 5, 11, 5)
    rest = {"CHANGE": " MAT 2", "INSITU": " 1 0 1", "GENERATE": " AUTO EDGE 1", "BOUNDARY": " YVEL 0"}.get(
        command, ""
    )
    for where, reason in (
        ("10 0 0 10", TURNED),
        ("0 1 0 1", NEAREST),
        ("5 6 2 3", "the nearest is block@1 at (5, 2.5), on a limit and so outside"),
    ):
        found = refused_or_said(m, f"{command} {where}{rest}", len(command) + 2)
        wanted = reason.replace("centroid", "grid-point and no centroid") if command == "BOUNDARY" else reason
        assert found.endswith(wanted)


def test_what_boundary_looks_for() -> None:
    m = Model()
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    with pytest.raises(
        UdecError, match=r"no edge with both ends in .*, the nearest is block@1's at \(0, 0\) to \(0, 10\)"
    ):
        m.boundary(-3, -2, 0, 9, stress=(1, 0, 0))
    assert run_line(m, "BOUNDARY 0 1 0 1 FREE") == "BOUNDARY: no condition in range: there are none"
    m.boundary(0, 10, 0, 10, yvel=1)
    assert "PRINT BOUNDARIES" in run_line(m, "BOUNDARY 0 1 0 1 FREE")
    assert run_line(m, "BOUNDARY 10 0 0 10 FREE").endswith(TURNED)


def test_initial_stress_needs_blocks_that_carry_it() -> None:
    m = Model()
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    with pytest.raises(UdecError, match="all blocks there are rigid, such as block@1") as caught:
        m.insitu(0, 10, 0, 10, 1, 0, 1)
    assert "CHANGE 0 10 0 10 SDEF" in caught.value.advice
    m.change(0, 10, 0, 10, "fdef")
    with pytest.raises(UdecError, match="no zones yet") as caught:
        m.insitu(0, 10, 0, 10, 1, 0, 1)
    assert caught.value.advice.startswith("GENERATE")


def test_what_rset_and_damage_are_about() -> None:
    """An offset counts from 1; damage is told as what was found and where, whatever routine comes upon it."""
    m = Model()
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    with pytest.raises(UdecError, match="offset 0") as caught:
        m.rset(1, 1, 0)
    assert (caught.value.number, caught.value.parameter) == (30, "ioff")
    assert caught.value.advice.startswith("offsets count from 1")
    m.rset(1e30, 1, 1)
    with pytest.raises(UdecError, match=r"the main array is damaged: .*IBPNT points to 1, ") as caught:
        m.fix(0, 1, 0, 1)
    assert caught.value.number == 20
    assert "DELC" not in str(caught.value)


def test_restart_says_what_it_goes_on_from(tmp_path: Path) -> None:
    m = Model(out=tmp_path, build="i32r32")
    m.property(1, density=1, kn=1, ks=1)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1)
    m.cycle(3)
    m.save()
    out = io.StringIO()
    run_deck(Model(out=tmp_path), "RESTART\n", out)
    file = tmp_path / "restart.h5"
    time = f"t = {float(m.h.cd[TIME]):.4g} s"
    assert f" RESTART: {file}: 2 blocks, 2 contacts, 3 cycles, {time}, words of i32r32\n" in out.getvalue()


def test_other_names_lead_to_ours() -> None:
    """Every other name is one that no command has, and leads to a keyword."""
    keywords = {one.keyword.upper() for command in COMMANDS for one in (command, *command.words)}
    assert {name for names in ALSO_CALLED.values() for name in names.split()} <= keywords
    alone = [name for name, means in ALSO_CALLED.items() if match(COMMANDS, means.split()[0])]
    assert [name for name in alone if match(COMMANDS, name)] == []
