"""What is written to the array in Python is proved before it is followed. Other ways to write are refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.mechanics_scenes import side_by_side

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.layout import offsets as g
from udec_ia.layout.offsets import JPHASE, KX, MTOP, TDEL
from udec_ia.model.model_session import Session


@pytest.mark.parametrize(
    "write",
    [
        lambda m: m.h.ia.__setitem__(slice(0, 40), 7),
        lambda m: np.add.at(m.h.ia, [4, 5, 6, 7], 1000),
        lambda m: m.h.ci.__setitem__(MTOP, 10**9),
        lambda m: m.h.ci.__setitem__(JPHASE, 9),
        lambda m: m.h.ra[2:60:3].__setitem__(Ellipsis, np.nan),
    ],
)
def test_words_that_were_damaged_in_python_are_found_before_they_are_followed(
    write: Callable[[Model], None],
) -> None:
    m = side_by_side()
    m.cycle(5)
    kept = m.array.h.ia.copy(), m.array.h.ci.copy()
    held = m.h
    write(m)
    for follow in (
        lambda: m.cycle(1),
        lambda: m.split(-1, 2, 5, 2),
        lambda: m.save("never.h5"),
        lambda: m.property(1, density=1.0),
        lambda: m.print("energy"),
    ):
        with pytest.raises(UdecError) as caught:
            follow()
        assert caught.value.number == 20
    held.ia[:], held.ci[:] = kept
    assert m.cycle(1) == 1
    assert not Path("never.h5").exists()


def test_what_is_written_soundly_stays_and_reading_costs_no_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    m = side_by_side()
    m.cycle(5)
    proofs = []
    monkeypatch.setattr(Session, "prove", lambda self: proofs.append(1) or setattr(self, "written", False))
    for _ in range(3):
        m.cycle(int(1 + 0 * m.h.cr[TDEL] + m.h.ia[:5].sum() * 0))
    assert proofs == []
    m.h.cr[TDEL] *= 2
    m.h.ra[int(m.table("block")["address"][0]) // 2 + KX[1]] += 0.0
    m.cycle(1)
    assert proofs == [1]


def test_what_is_written_among_commands_is_proved_before_it_is_followed() -> None:
    m = side_by_side()
    place = int(m.table("corner")["address"][0]) - 1 + g.KL[1]

    def action() -> None:
        m.h.ia[place] = 10**8
        m.round(0.1)

    with pytest.raises(UdecError) as caught:
        m.whole(action)
    assert caught.value.number == 20
    with pytest.raises(UdecError) as caught:
        m.why_none("split", 0, 0, 1, 1)
    assert caught.value.number == 20


def test_other_ways_to_write_are_refused() -> None:
    h = side_by_side().h
    for write in (lambda: h.ia.fill(0), lambda: np.copyto(h.cr, 1.0), lambda: np.asarray(h.ci).sort()):
        with pytest.raises(ValueError, match="read-only"):
            write()
    own = h.ia.copy()
    own[:] = 0
    assert h.ia.any()


@pytest.mark.parametrize(
    "view",
    [
        lambda h: h.ia,
        lambda h: h.ra[3:],
        lambda h: np.asarray(h.ia),
        lambda h: h.cr.view(np.ndarray),
        lambda h: np.frombuffer(h.ci.data, h.ci.dtype),
        lambda h: h.cd.base,
    ],
)
def test_no_view_can_be_made_writeable(view: Callable[[Memory], Any]) -> None:
    words = np.asarray(view(side_by_side().h))
    with pytest.raises(ValueError, match="WRITEABLE"):
        words.setflags(write=True)


def lose_words(m: Model) -> None:
    """MFREE is larger than what FIND has handed out."""
    m.h.ci[g.MFREE] += 1000


def lose_junk(m: Model) -> None:
    """The junk list is empty, and groups that were given back are in no list."""
    m.delete(2, 4, 0, 2)
    assert m.h.ci[g.JUNK]
    m.h.ci[g.JUNK] = 0


@pytest.mark.parametrize("lose", [lose_words, lose_junk])
def test_all_commands_refuse_words_that_are_in_no_group(lose: Callable[[Model], None]) -> None:
    """CYCLE and commands do what SAVE does."""
    for follow in (
        lambda m: m.cycle(1),
        lambda m: m.split(-1, 2, 5, 2),
        lambda m: m.save("never.h5"),
        lambda m: m.property(1, density=1.0),
    ):
        m = side_by_side()
        m.cycle(5)
        lose(m)
        with pytest.raises(UdecError) as caught:
            follow(m)
        assert caught.value.number == 20
        assert "in no group" in caught.value.detail
    assert not Path("never.h5").exists()
