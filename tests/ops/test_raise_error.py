"""What a kernel leaves in NERR and IERAD becomes that error, whatever group it is about."""

from __future__ import annotations

import pytest

from udec_ia import Model
from udec_ia.errors import ADVICE, ERRORS, OVERLAP_TOO_GREAT, UdecError
from udec_ia.layout import offsets as g
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.cycle_errors import raise_error


@pytest.mark.parametrize("kind", ["block", "corner", "contact", "domain"])
def test_an_error_is_told_by_its_own_number(kind: str) -> None:
    m = Model()
    m.block(0, 0, 0, 1, 2, 1, 2, 0)
    m.split(1, -1, 1, 2)
    m.round(0.05)
    h, address = m.array.h, int(m.table(kind)["address"][0])
    number = max(ERRORS) - 5  # one that has no message of its own
    h.ci[g.NERR], h.ci[g.IERAD] = number, address
    with pytest.raises(UdecError) as caught:
        raise_error(m.array, LawBook())
    assert (caught.value.number, caught.value.group) == (number, address)
    assert f"{kind}@{address} in cycle 0" in str(caught.value)
    assert caught.value.advice == ADVICE[number]
    assert h.ci[g.NERR] == h.ci[g.IERAD] == 0
    raise_error(m.array, LawBook())


def test_an_overlap_whose_contact_has_gone_is_error_15() -> None:
    m = Model()
    m.block(0, 0, 0, 1, 2, 1, 2, 0)
    m.array.h.ci[g.NERR], m.array.h.ci[g.IERAD] = OVERLAP_TOO_GREAT, int(m.table("block")["address"][0])
    with pytest.raises(UdecError, match="in cycle 0") as caught:
        raise_error(m.array, LawBook())
    assert caught.value.number == 15
