"""Files that are sealed well and hold a state that `check` finds unsound: no command goes on from them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from support.every_group_kind import every_kind

from udec_ia import Model, UdecError
from udec_ia.errors import MESSAGES, OVERLAP_TOO_GREAT
from udec_ia.heap.accessors import getr, iget, puti, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import table
from udec_ia.restart import load, save

Change = Callable[[MainArray], None]


def contact_code(array: MainArray) -> None:
    """A contact of a corner with an edge becomes one of two corners, or the other way round."""
    contact = int(table(array, "contact")["address"][0])
    code = iget(array.h, contact, g.KCCOD)
    puti(array.h, contact, g.KCCOD, 1 if code != 1 else 2)


def corner_place(array: MainArray) -> None:
    """A corner has moved by five rounding lengths."""
    corner = int(table(array, "corner")["address"][0])
    putr(array.h, corner, g.KXP, getr(array.h, corner, g.KXP) + 5 * array.h.cr[g.DTOL])


def velocity(array: MainArray) -> None:
    """A velocity is not a number."""
    putr(array.h, int(table(array, "block")["address"][0]), g.KXD, np.nan)


CHANGES: dict[str, Change] = {"contact code": contact_code, "corner": corner_place, "velocity": velocity}


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    m = every_kind()
    m.out = tmp_path_factory.mktemp("saved")
    m.cycle(20)
    return m.save()


@pytest.fixture(params=CHANGES)
def wrong(request: pytest.FixtureRequest, saved: Path, tmp_path: Path) -> Path:
    """A file of an unsound state, which says nothing of that."""
    array = load(saved).array
    CHANGES[request.param](array)
    return save(array, tmp_path / "wrong.h5")


def test_restart_refuses_what_check_finds_unsound(wrong: Path) -> None:
    found = Model.check_file(wrong)
    assert found
    with pytest.raises(UdecError) as caught:
        Model.restore(wrong)
    assert caught.value.number == 29
    assert found[0].message[:100] in caught.value.detail


def test_cycle_and_save_refuse_what_was_taken_by_force(wrong: Path, tmp_path: Path) -> None:
    forced = Model.restore(wrong, force=True, out=tmp_path)
    for refused in (lambda: forced.cycle(1), lambda: forced.solve(0.1), lambda: forced.save()):
        with pytest.raises(UdecError) as caught:
            refused()
        assert caught.value.number == 20
    assert not (tmp_path / "restart.h5").exists()
    assert forced.check() == Model.check_file(wrong)
    assert forced.print("blocks")


def test_unchecked_makes_no_proof_before_save(wrong: Path, tmp_path: Path) -> None:
    """The links are proved all the same; what looks at outlines, and SAVE, prove the rest."""
    quick = Model.restore(wrong, unchecked=True, out=tmp_path)
    for refused in (lambda: quick.split(0, 0, 1, 1), lambda: quick.save()):
        with pytest.raises(UdecError) as caught:
            refused()
        assert caught.value.number == 20
    array = load(wrong, unchecked=True).array
    array.h.ci[g.IBPNT] = 1
    with pytest.raises(UdecError) as caught:
        load(save(array, tmp_path / "links.h5"), unchecked=True)
    assert caught.value.number == 29


def test_unchecked_in_a_deck(wrong: Path, saved: Path, tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    with pytest.raises(UdecError) as caught:
        m.run(f"RESTART {wrong}\n")
    assert caught.value.number == 29
    m.run(f"RESTART {saved} UNCHECKED\nCYCLE 1\nSAVE again.h5\n")
    assert Model.restore(tmp_path / "again.h5").check() == []
    with pytest.raises(UdecError, match="FORCE"):
        m.restart(saved, force=True, unchecked=True)


def test_a_state_that_an_error_has_ended_is_there_to_be_looked_at(wrong: Path, tmp_path: Path) -> None:
    array = load(wrong, force=True).array
    array.h.ci[g.NSPOIL] = OVERLAP_TOO_GREAT
    ended = save(array, tmp_path / "ended.h5")
    assert MESSAGES[OVERLAP_TOO_GREAT]
    m = Model.restore(ended, out=tmp_path)
    assert m.print("contacts")
    assert m.save() == tmp_path / "restart.h5"
