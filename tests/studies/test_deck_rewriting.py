"""Settings put other numbers in the lines of a deck, and leave everything else where it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from udec_ia.errors import UdecError
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.settings import Fraction, Numbers, Setting

DECK = """\
START
* a remark
DEFAULT F=0.2 N=100
PROP MAT=1 DENS=2000 KN=1.E8 KS=5D7
+ BULK=1E9 G=1E9 ; soft
ROUND 0.5
FRAC $F  SAFE
HIST 10 KINETIC
BLOCK 0 0 0 1 1 1 1 0
GEN 0 1 0 1 AUTO EDGE 0.25
CYCLE $N
PLOT 0
SOLVE 1E-3 LIMIT 500
STOP
CYCLE 7
"""


def lines(setting: Setting, numbers: Numbers | None = None, text: str = DECK) -> list[str]:
    return Deck(text, "x.dat").written(setting, numbers, Fraction(0.1)).splitlines()


def test_the_deck_as_it_is_only_loses_what_shows() -> None:
    found = lines(Setting())
    assert found[:2] == ["START", "* a remark"]
    assert found[3:6] == DECK.splitlines()[3:6]
    assert (found[2], found[11]) == ("* DEFAULT F=0.2 N=100", "* PLOT 0")
    assert (found[6], found[10], found[12]) == ("FRACTION 0.2 SAFE", "CYCLE 100", "SOLVE 0.001 LIMIT 500")
    assert found[13:] == ["STOP", "CYCLE 7"]


def test_a_step_changes_the_fraction_the_cycles_and_the_intervals() -> None:
    found = lines(Setting(step=0.5), Numbers(1.0, (200, None), (2.0, 2.0)))
    assert (found[6], found[7], found[10]) == ("FRACTION 0.1 SAFE", "HIST 20 KINETIC", "CYCLE 200")
    assert found[12] == "SOLVE 0.001 LIMIT 1000"


def test_a_deck_without_fraction_gets_one_behind_start() -> None:
    found = lines(Setting(step=2.0), Numbers(0.5), "START\nBLOCK 0 0 0 1 1 1 1 0\nCYCLE 5\n")
    assert found == ["START", "FRACTION 0.1", "BLOCK 0 0 0 1 1 1 1 0", "CYCLE 5"]


def test_levers_of_the_model_change_their_numbers_only() -> None:
    found = lines(Setting(stiffness=2.0, rounding=0.5, edge=0.1))
    assert found[3:6] == [
        "PROP MAT=1 DENS=2000 KN=200000000 KS=100000000",
        "+ BULK=1E9 G=1E9 ; soft",
        "ROUND 0.25",
    ]
    assert found[9] == "GEN 0 1 0 1 AUTO EDGE 0.025"


def test_the_stiffness_of_joint_materials_is_varied_too() -> None:
    deck = (
        "START\nJPROPERTY JMATERIAL=1 KN=1E9 KS=5E8 C=1E5\n"
        "JPROPERTY JMATERIAL=2 KN=1E8 KS=1E8 C=1E5 CONTACT\n"
        "JPROPERTY JMATERIAL=3 YIELDING KN=1E9 KS=1E9 KNMAX=2E9\n"
    )
    stiffer = lines(Setting(stiffness=2.0), text=deck)
    assert [one for one in stiffer if one.startswith("JPROP")] == [
        "JPROPERTY JMATERIAL=1 KN=2000000000 KS=1000000000 C=1E5",
        "JPROPERTY JMATERIAL=2 KN=200000000 KS=200000000 C=1E5 CONTACT",
        "JPROPERTY JMATERIAL=3 YIELDING KN=2000000000 KS=2000000000 KNMAX=4000000000",
    ]
    finer = lines(Setting(contact=0.5), text=deck)  # of contacts alone
    assert [one for one in finer if one.startswith("JPROP")][:2] == [
        "JPROPERTY JMATERIAL=1 KN=1E9 KS=5E8 C=1E5",
        "JPROPERTY JMATERIAL=2 KN=50000000 KS=50000000 C=50000 CONTACT",
    ]


def test_levers_of_rest() -> None:
    assert lines(Setting(ratio=0.1))[12] == "SOLVE 0.0001 LIMIT 5000"
    assert lines(Setting(static=True))[12] == "SOLVE 0.001 LIMIT 500 STATIC"
    assert Deck("START\nSOLVE 1E-3\nCYCLE 0\n", "x").rests
    assert not Deck(DECK, "x").rests


def test_rigid_blocks_have_no_zones() -> None:
    assert lines(Setting(types="rigid"))[9] == "* GEN 0 1 0 1 AUTO EDGE 0.25"


def test_blocks_are_made_simply_deformable_before_the_first_run() -> None:
    found = lines(Setting(types="sdef"))
    assert found[9:12] == [
        "* GEN 0 1 0 1 AUTO EDGE 0.25",
        "CHANGE -1E30 1E30 -1E30 1E30 SDEF",
        "CYCLE 100",
    ]


def test_a_restart_file_is_found_from_any_folder(tmp_path: Path) -> None:
    (tmp_path / "a.h5").touch()
    deck = Deck("RESTART a.h5\nCYCLE 5\n", "x", {}, tmp_path)
    assert deck.written(Setting()).splitlines()[0] == f'RESTART "{tmp_path / "a.h5"}"'


def test_what_is_no_deck_is_refused_at_its_place() -> None:
    with pytest.raises(UdecError) as raised:
        Deck("START\nCICLE 5\n", "x.dat")
    assert raised.value.number == 2
    assert "x.dat:2" in str(raised.value)
