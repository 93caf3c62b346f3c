"""Quantities: their worth against what the tables say, where places are looked for, and what is refused."""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from udec_ia import Model
from udec_ia.reader.group_conditions import Wrong
from udec_ia.studies.execute_run import execute
from udec_ia.studies.quantities import DEFAULTS, read_quantities, read_rule
from udec_ia.studies.study_run import StudyRun

FALL = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5
BLOCK 0,0 0,3 2,3 2,0
SPLIT -1,1 3,1
SPLIT -1,2 3,2
FIX 0,2 0,1
GRAVITY 0 -10
ENERGY ON
DAMP 0.3 5 MASS
HISTORY 10 KYD AT 1,2.5
CYCLE 100
DELETE 0,2 1,2
CYCLE 100
"""
TIE = "block(1, 2.5).YDISPLACEMENT"


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Model:
    m = Model(out=tmp_path_factory.mktemp("model"))
    m.run(FALL)
    return m


def worth(tmp_path: Path, *texts: str, deck: str = FALL) -> tuple[list[float], tuple[str, ...]]:
    """Values of quantities at the end of a deck, and remarks."""
    result = execute(StudyRun("run", deck, quantities=texts), tmp_path)
    assert result.status == "ended", result.message
    return [*result.quantities.values()], result.remarks


def test_they_are_what_the_tables_say(model: Model, tmp_path: Path) -> None:
    blocks, contacts = model.table("block"), model.table("contact")
    upper = blocks[blocks["KBFIX"] == 0][0]
    speeds = model.histories()[0].numbers[:, 2]
    expected: dict[str, float] = {
        "time": model.histories()[0].numbers[-1, 1],
        "cycles": 200,
        "KINETIC": model.balance().kinetic,
        "max block.KY": blocks["KY"].max(),
        "min block.KYD": blocks["KYD"].min(),
        "mean block.KX": blocks["KX"].mean(),
        "sum contact.KCFN": contacts["KCFN"].sum(),
        "count block": 2,
        "count block where KY > 1 and KYD < 0": 1,
        "max block.KY where KY < 1": blocks["KY"].min(),
        "block(1, 2.5).KYD": upper["KYD"],
        TIE: upper["KY"] - 2.5,
        "block(1, 2.5).DISPLACEMENT": math.hypot(upper["KX"] - 1, upper["KY"] - 2.5),
        "max block.DISPLACEMENT": math.hypot(upper["KX"] - 1, upper["KY"] - 2.5),
        "last history 1": speeds[-1],
        "max history 1": speeds.max(),
        "min history 1": speeds.min(),
        "mean history 1": speeds.mean(),
        "energy.mass_damping": model.balance().mass_damping,
        "energy.residual": model.balance().residual,
    }
    found, remarks = worth(tmp_path, *expected)
    assert dict(zip(expected, found, strict=True)) == expected
    assert remarks == ()


def test_a_block_that_has_gone_has_no_value_and_its_address_is_nobody_elses(tmp_path: Path) -> None:
    """After DELETE a SPLIT takes the words of the block that was deleted; that one is not taken for it."""
    (value,), remarks = worth(tmp_path, "block(1, 1.5).KY", deck=FALL + "SPLIT 1,1.5 1,4\nCYCLE 1\n")
    assert math.isnan(value)
    assert remarks == ("block(1, 1.5).KY has no value: the block that was nearest was deleted",)


def test_a_block_is_followed_to_another_address(tmp_path: Path) -> None:
    """DISPLACEMENTS moves all blocks."""
    before, _, after = FALL.partition("DELETE 0,2 1,2\n")
    asked = "block(1, 2.5).KY", TIE, "block(1, 0.5).KY"
    expected, _ = worth(tmp_path, *asked, deck=before + after)
    found, _ = worth(tmp_path, *asked, deck=before + "DISPLACEMENTS\n" + after)
    assert found == expected
    assert found[0] == pytest.approx(2.5, abs=0.01)
    assert found[1] == pytest.approx(found[0] - 2.5, abs=1e-12)
    assert found[2] == 0.5


def test_what_comes_and_goes_is_looked_for_in_the_end(tmp_path: Path) -> None:
    """The contacts on which the upper blocks stand are there until the middle one is deleted."""
    (value, many), _ = worth(tmp_path, "contact(0, 1).KYC", "count contact", deck=FALL.partition("DELETE")[0])
    assert many == 4
    assert value == pytest.approx(1, abs=0.01)
    (value,), remarks = worth(tmp_path, "contact(0, 1).KYC")
    assert math.isnan(value)
    assert remarks == ("contact(0, 1).KYC has no value: no contact has a position",)


def test_before_the_first_cycle_places_are_those_of_now(tmp_path: Path) -> None:
    still = FALL.partition("CYCLE")[0]
    assert worth(tmp_path, "block(1, 2.5).KY", "max block.DISPLACEMENT", deck=still)[0] == [2.5, 0]


@pytest.mark.parametrize(
    ("quantity", "reason"),
    [
        ("solve.ratio", "there was no SOLVE"),
        ("last history 2", "there is no history 2"),
        ("max block.KX where KX > 99", "there is no such block"),
        ("zone(1, 1).KZS11", "there is no zone yet"),
    ],
)
def test_why_there_is_no_value(quantity: str, reason: str, tmp_path: Path) -> None:
    (value,), remarks = worth(tmp_path, quantity)
    assert math.isnan(value)
    assert remarks == (f"{quantity} has no value: {reason}",)


JOINTS = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8
JPROPERTY JMATERIAL=1 KN=1E8 KS=1E8 FRICTION=0.3 TENSION=1E3
BLOCK 0,0 0,4 2,4 2,0
SPLIT -1,1 3,1 JOINT=1 JMATERIAL=1
SPLIT -1,2 3,2 JOINT=1 JMATERIAL=1
FIX 0,2 0,1
FIX 0,2 1,2
GRAVITY 2 20
CYCLE 30
"""


def test_slip_and_opening_of_joints(tmp_path: Path) -> None:
    """The block above is torn off by twice its tensile strength and more, the others are fixed."""
    m = Model(out=tmp_path)
    m.run(JOINTS)
    rows = m.table("contact")
    closure = rows["KCN"] + m.table("joint")["KCJOFF"]
    assert (closure < 0).sum() == 2
    expected = [np.abs(rows["KCS"]).max(), -closure.min(), 2]
    assert worth(tmp_path, "joints.slip", "joints.opening", "joints.broken", deck=JOINTS)[0] == expected
    contacts = Model(out=tmp_path)
    contacts.run(FALL)
    slip = np.abs(contacts.table("contact")["KCS"]).max()
    assert worth(tmp_path, "joints.slip", "joints.broken")[0] == [slip, 0]


def test_solve_is_asked_for_the_last_one(tmp_path: Path) -> None:
    texts = ("solve.reached", "solve.ratio", "solve.cycles", "solve.fallen")
    deck = FALL.replace("CYCLE 100", "SOLVE 1E-3 LIMIT 3")
    (reached, ratio, cycles, fallen), _ = worth(tmp_path, *texts, deck=deck)
    assert (reached, cycles, fallen) == (0, 3, 0)
    assert ratio > 1e-3


@pytest.mark.parametrize(
    ("text", "column", "reason"),
    [
        ("", 0, "this is not a quantity: write time"),
        ("tim", 0, "did you mean TIME?"),
        ("KXD", 0, "KXD of which block? write block(x, y).KXD, or max block.KXD"),
        ("v = KXD", 4, "KXD of which block?"),
        ("blok(1, 2).KY", 0, "did you mean BLOCK?"),
        ("block(1, 2).KYY", 12, "a block has no field KYY"),
        ("contact(1, 2).DISPLACEMENT", 14, "a contact has no field DISPLACEMENT"),
        ("largest block.KY", 0, "there are max, min, mean, sum"),
        ("max block.KY were KX > 1", 13, "the text after it must begin with: where"),
        ("max block.KY where KXX > 1", 19, "a block has no field KXX"),
        ("v = count block where KX > 1 and KXX", 33, "a block has no field KXX"),
        ("last history 0", 13, "histories count from 1"),
        ("energy.frictions", 7, "did you mean FRICTION?"),
        ("x = block(1e999,0).KXD", 10, "this is too large a number"),
        ("block(0, -1e400).KXD", 9, "this is too large a number"),
        (f"last history {'9' * 5000}", 13, "this is too large a number"),
        ("solve.done", 6, "there are reached, ratio, cycles, motion, fallen"),
    ],
)
def test_what_is_refused(text: str, column: int, reason: str) -> None:
    with pytest.raises(ValueError, match=r"\^$") as caught:
        read_quantities([text])
    first, source, caret = str(caught.value).split("\n")
    assert reason in first
    assert source == f"    {text}"
    assert caret == f"    {' ' * column}^"


def test_names_of_columns() -> None:
    texts = ["time", "v = block(1,2).KYD", "count block where KX == 2"]
    assert [*read_quantities(texts)] == ["time", "v", "count block where KX == 2"]
    assert [*read_quantities(DEFAULTS)] == ["time", "displacement", "force", "ratio"]
    with pytest.raises(ValueError, match="two quantities are called v: name one of them"):
        read_quantities(["v = time", "v = cycles"])


def test_rules() -> None:
    rule = read_rule("max block.KXD where KX > 3 >= -1e-2")
    assert (rule.comparison, rule.number) == (">=", -0.01)
    for wrong in ("max block.KXD", "KXD > 1", "time > x", "time > 1e999", ""):
        with pytest.raises(ValueError, match=r"\^"):
            read_rule(wrong)


PIECES = [
    "max",
    "count",
    "block",
    "contact",
    "(1, 2)",
    ".",
    "KX",
    "where",
    ">",
    "1",
    " ",
    "=",
    "history",
    "energy",
    "v",
]


@given(st.lists(st.sampled_from(PIECES), max_size=8).map("".join) | st.text(max_size=30))
def test_any_text_is_a_quantity_or_is_refused_with_a_place(text: str) -> None:
    with suppress(Wrong):  # which has a place
        read_quantities([text])


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=5))
def test_displacements_are_those_of_numpy(values: list[float]) -> None:
    from udec_ia.studies.quantities import DISPLACEMENTS

    moved: Any = np.column_stack([values, values[::-1]])
    lengths = [math.hypot(*row) for row in moved.tolist()]
    assert DISPLACEMENTS["DISPLACEMENT"](moved).tolist() == pytest.approx(lengths, rel=1e-15)
