"""FUNCTION, the sines of BOUNDARY, and what follows a FUNCTION: signals in time.

A FUNCTION is given by its points or read from a file. Boundary conditions follow it
(kernels.body.boundary_conditions), and so do numbers of the common block: gravity and properties of materials
(kernels.drive.followed_functions). Such a number has a follower with the value that the factor multiplies.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers, puti, putr, size_of
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.followed_functions import set_followers
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.common.number_limits import finite, whole
from udec_ia.reader.list_walks import chain

NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([EeDd][+-]?[0-9]+)?")
COMMENTS = "*;#!"  # a line that begins with one of them is a comment, as in a deck
BeforeGroups = Callable[[], None]  # called before groups are made or given back
USERS = [  # kinds of groups that follow a signal, and their pointers to it
    (group.name, field.name)
    for group in read_table().groups
    for field in group.fields
    if (field.target, field.role) == ("signal", "member")
]
POINT = re.compile(r"[tf]([0-9]+)")  # parameter of an error of set_function, with the number of the point


def make_sine(h: Memory, frequency: float, lasts: float) -> int:
    """A signal that is a sine of the given frequency (Hz) from now on, for a time (s)."""
    isg = _make_signal(h)
    putr(h, isg, g.KTFREQ, frequency)
    put_beginning(h, isg, float(h.cd[g.TIME]))
    putr(h, isg, g.KTLAST, lasts)
    return isg


def put_beginning(h: Memory, isg: int, begins: float) -> None:
    """Let the sine `isg` begin at a time of the model, with what a real cannot hold of it in KTREST."""
    putr(h, isg, g.KTBEG, begins)
    putr(h, isg, g.KTREST, begins - float(getr(h, isg, g.KTBEG)))


def _make_signal(h: Memory) -> int:
    isg = int(find(h, g.NVSG))
    puti(h, isg, HEAD, g.MSIG)
    puti(h, isg, g.KT, int(h.ci[g.ISGPNT]))
    h.ci[g.ISGPNT] = isg
    return isg


def find_function(h: Memory, number: int) -> int:
    """The signal that is FUNCTION `number`, 0 if there is none."""
    signals = list_of(h, "signal").tolist()
    return next((s for s in signals if iget(h, s, g.KTP) and iget(h, s, g.KTNUM) == number), 0)


def existing_function(h: Memory, number: int) -> int:
    """The same. Error 26 if there is none."""
    signal = find_function(h, number)
    if not signal:
        advice = f"define it first: FUNCTION {number} t1 f1 t2 f2 ..."
        raise UdecError(26, f"FUNCTION {number}", advice, parameter="function")
    return signal


def set_function(array: MainArray, number: int, points: Sequence[tuple[float, float]]) -> None:
    """FUNCTION: factors over time, in place of a function of the same number, for all that follows it.

    points: (time, factor), by ascending time. Errors 26 and 28.
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
    isg = find_function(array.h, number)
    if isg:
        held = {k: iw for k, iw in followers(array.h).items() if iget(array.h, iw, g.KWS) == isg}
        values = {k: float(getr(array.h, iw, g.KWB)) for k, iw in held.items()}
        check_products(array, values, [f for _, f in points])
    require(array, size_of(array.h, g.NVSG) + len(points) * size_of(array.h, g.NVTP))
    h = array.h
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


def read_function(array: MainArray, number: int, path: Path) -> None:
    """FUNCTION n FILE: as `set_function`, with points from a file.

    Parameters
    ----------
    array
        Main array.
    number
        Number of the function.
    path
        Text file with a line for each point: time and factor, apart by blanks, a comma or a tab. Empty lines
        are skipped, and lines that begin with * ; # or !.

    Raises
    ------
    UdecError
        26 for a file that cannot be read, 10, 26 and 28 for its contents, with the line in the file. Nothing
        is changed then.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is not a text file"
        advice = "FILE takes the name of a text file with two columns, t and f"
        raise UdecError(26, f"{path}: {reason}", advice, parameter="path") from error
    points, lines = [], []
    for line, row in enumerate(text.splitlines(), 1):
        if row.strip() and row.lstrip()[0] not in COMMENTS:
            points.append(_point(row, f"{path}:{line}"))
            lines.append(line)
    if not points:
        raise UdecError(26, f"{path}: it has no points", "a line is a time and a factor", parameter="path")
    try:
        set_function(array, number, points)
    except UdecError as error:
        place = POINT.fullmatch(error.parameter)
        if place is None:
            raise
        detail = f"{path}:{lines[int(place[1]) - 1]}: {error.detail}"
        raise UdecError(error.number, detail, error.advice, parameter="path") from None


def _point(row: str, place: str) -> tuple[float, float]:
    """The time and the factor in a row of a file. place: of the row, for errors."""
    words = re.split(r"[,\s]+", row.strip().rstrip(","))
    for word in words:
        if not NUMBER.fullmatch(word):
            advice = "a line is a time and a factor; one with # in front is a comment"
            raise UdecError(10, f'{place}: "{word[:40]}" is not a number', advice, parameter="path")
    if len(words) != 2:
        detail = f"{place}: {len(words)} numbers in place of a time and a factor"
        raise UdecError(26, detail, "give two columns, t and f", parameter="path")
    time, factor = (float(word.upper().replace("D", "E")) for word in words)
    return time, factor


# ---- numbers of the common block that follow a FUNCTION


def followers(h: Memory) -> dict[int, int]:
    """Followers by the index of their number in the reals of the common block."""
    found = list_of(h, "follower")
    return dict(zip(integers(h, found, g.KWN).tolist(), found.tolist(), strict=True))


def followed_names(h: Memory, signal: int) -> list[str]:
    """The numbers of the common block that follow `signal`, as GRAVY or AMU(2)."""
    reals, found = read_table().common_reals, []
    for number, iw in followers(h).items():
        if iget(h, iw, g.KWS) == signal:
            field, element = reals[number]
            found.append(f"{field.name}({element + 1})" if field.count > 1 else field.name)
    return found


def check_followed(
    array: MainArray, function: int, given: Collection[str], may_follow: Collection[str], advice: str
) -> None:
    """Error 26 for a FUNCTION that is not defined, or without a property; 10 for one that cannot follow it.

    given: names of the properties of a command. may_follow: those that can. advice: for the others.
    """
    existing_function(array.h, whole(function=function))
    if not given:
        raise UdecError(26, "no property follows the FUNCTION", "PROPERTY MATERIAL=1 FRICTION=0.6 FUNCTION=1")
    for name in given:
        if name not in may_follow:
            raise UdecError(10, f"{name.upper()} cannot follow a FUNCTION", advice, parameter=name)


def set_numbers(
    array: MainArray,
    values: Mapping[int, float],
    function: int | None,
    before_groups: BeforeGroups = lambda: None,
) -> None:
    """Set numbers of the common block, which follow a FUNCTION from now on, or none.

    values: by index of the number.
    """
    if function is not None:
        check_products(array, values, factors_of(array.h, existing_function(array.h, function)))
        before_groups()
        require(array, words_to_follow(array.h, values))
        follow(array.h, values, existing_function(array.h, function))
        return
    if array.h.ci[g.IFWPNT]:
        before_groups()
        stop_following(array.h, values)
    for number, value in values.items():
        array.h.cr[number] = value


def check_products(array: MainArray, values: Mapping[int, float], factors: Sequence[float]) -> None:
    """Error 28 if a factor times one of the values does not fit its number of the common block.

    values: by index of the number.
    """
    for number, value in values.items():
        field, _ = read_table().common_reals[number]
        for factor in (min(factors), max(factors)):
            if field.allowed and factor < 0:
                detail = f"the factor {factor:g} would make {field.name}, {field.text}, negative"
                raise UdecError(28, detail, "take factors of 0 or more", parameter="function")
            finite(array, function=value * factor)


def factors_of(h: Memory, signal: int) -> list[float]:
    """The factors at the points of a FUNCTION."""
    return [float(getr(h, it, g.KTPF)) for it in chain(h, iget(h, signal, g.KTP), g.KTPN)]


def words_to_follow(h: Memory, numbers: Iterable[int]) -> int:
    """Words of new followers that `follow` needs for these numbers."""
    return len(set(numbers) - followers(h).keys()) * size_of(h, g.NVFW)


def follow(h: Memory, values: Mapping[int, float], signal: int) -> None:
    """Let numbers of the common block follow a FUNCTION, and set them to their present values.

    values: by index of the number; there is room for the followers. signal: the FUNCTION.
    """
    known = followers(h)
    for number, value in values.items():
        iw = known.get(number) or _make_follower(h, number)
        puti(h, iw, g.KWS, signal)
        putr(h, iw, g.KWB, value)
    set_followers(h)


def _make_follower(h: Memory, number: int) -> int:
    iw = int(find(h, g.NVFW))
    for k, n in ((HEAD, g.MFLW), (g.KW, int(h.ci[g.IFWPNT])), (g.KWN, number)):
        puti(h, iw, k, n)
    h.ci[g.IFWPNT] = iw
    return iw


def stop_following(h: Memory, numbers: Iterable[int]) -> None:
    """Give the followers of these numbers of the common block back."""
    known = followers(h)
    drop(h, "follower", [known[number] for number in numbers if number in known])
