"""FUNCTION, and the sines of BOUNDARY: the signals that boundary conditions follow in time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, puti, putr, size_of
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.common.limits import finite, whole
from udec_ia.ops.common.lists import chain
from udec_ia.ops.common.memory import require


def make_sine(h: Memory, frequency: float, lasts: float) -> int:
    """A signal that is a sine of the given frequency for a time."""
    isg = _make_signal(h)
    putr(h, isg, g.KTFREQ, frequency)
    begins = float(h.cd[g.TIME])
    putr(h, isg, g.KTBEG, begins)
    putr(h, isg, g.KTREST, begins - float(getr(h, isg, g.KTBEG)))
    putr(h, isg, g.KTLAST, lasts)
    return isg


def _make_signal(h: Memory) -> int:
    isg = int(find(h, g.NVSG))
    puti(h, isg, HEAD, g.MSIG)
    puti(h, isg, g.KT, int(h.ci[g.ISGPNT]))
    h.ci[g.ISGPNT] = isg
    return isg


def find_function(h: Memory, number: int) -> int:
    """The signal that is FUNCTION `number`. Error 26 if there is none."""
    for isg in chain(h, int(h.ci[g.ISGPNT]), g.KT):
        if iget(h, isg, g.KTP) and iget(h, isg, g.KTNUM) == number:
            return isg
    raise UdecError(26, f"FUNCTION {number}", f"define it first: FUNCTION {number} t1 f1 t2 f2 ...")


def set_function(array: MainArray, number: int, points: Sequence[tuple[float, float]]) -> None:
    """FUNCTION: factors over time, for boundary conditions; a function of the same number is replaced.

    points: (time, factor), the times in ascending order. Errors 26 and 28.
    """
    if not points:
        raise UdecError(26, "a function needs at least one point", "FUNCTION n t1 f1 t2 f2 ...")
    if not 1 <= whole(n=number) <= array.scheme.top_address:
        advice = f"a function has a number from 1 to {array.scheme.top_address}"
        raise UdecError(28, f"n is {number}", advice, parameter="n")
    for k, (t, f) in enumerate(points, 1):
        finite(array, **{f"t{k}": t, f"f{k}": f})
    for k, ((t1, f1), (t2, f2)) in enumerate(pairwise(points), 2):
        if t2 <= t1:
            raise UdecError(28, f"{t2:g} follows {t1:g}", "times must increase", parameter=f"t{k}")
        finite(array, **{f"t{k} - t{k - 1}": t2 - t1, f"f{k} - f{k - 1}": f2 - f1})
    require(array, size_of(array.h, g.NVSG) + len(points) * size_of(array.h, g.NVTP))
    h = array.h
    isg = next(
        (
            s
            for s in chain(h, int(h.ci[g.ISGPNT]), g.KT)
            if iget(h, s, g.KTP) and iget(h, s, g.KTNUM) == number
        ),
        0,
    )
    for it in chain(h, iget(h, isg, g.KTP), g.KTPN) if isg else ():
        lose(h, it, g.NVTP)
    isg = isg or _make_signal(h)
    puti(h, isg, g.KTNUM, number)
    first = 0
    for t, f in reversed(points):
        it = int(find(h, g.NVTP))
        puti(h, it, g.KTPN, first)
        putr(h, it, g.KTPT, t)
        putr(h, it, g.KTPF, f)
        first = it
    puti(h, isg, g.KTP, first)


def lose_sines(h: Memory, unused: set[int]) -> None:
    """Give back those of the signals `unused` that are sines: no command can name them."""
    before = 0
    for isg in chain(h, int(h.ci[g.ISGPNT]), g.KT):
        if isg not in unused or iget(h, isg, g.KTP):
            before = isg
            continue
        if before:
            puti(h, before, g.KT, iget(h, isg, g.KT))
        else:
            h.ci[g.ISGPNT] = iget(h, isg, g.KT)
        puti(h, isg, HEAD, 0)
        lose(h, isg, g.NVSG)
