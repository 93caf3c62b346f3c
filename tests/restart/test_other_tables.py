"""A file that was written by another field table is read by its names, and goes on as if nothing had been.

The other table is that of this program with some lines changed; naive/retell.py writes the files.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from naive.relocate import differences, essence
from naive.retell import retell, write
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import variable
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.heap_tools.field_translation import translate
from udec_ia.heap_tools.written_state import TranslationError, words_of
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import TABLE, parse, read_table
from udec_ia.restart import info, look_into, read_stored_state

TEXT = TABLE.read_text()
OURS = read_table()


def scene(out: Path) -> Model:
    """Groups of every kind, histories of all sorts, an account of the energy, and junk."""
    m = every_kind()
    m.out = out
    m.history(2, "TIME")
    m.history(2, "kinetic")
    m.energy("on")
    m.cycle(4)
    m.delete(5, 6, 0, 1)
    m.cycle(2)
    assert m.h.ci[g.JUNK]
    return m


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Model:
    return scene(tmp_path_factory.mktemp("model"))


def line(name: str) -> str:
    """The line of a field."""
    return next(one for one in TEXT.splitlines(keepends=True) if one.split()[:1] == [name])


def before(name: str, *lines: str) -> str:
    """The table with lines before that of a field."""
    return TEXT.replace(line(name), "".join(f"{one}\n" for one in lines) + line(name))


def behind(name: str, *lines: str) -> str:
    return TEXT.replace(line(name), line(name) + "".join(f"{one}\n" for one in lines))


def swapped(one: str, two: str, text: str = TEXT) -> str:
    """The table with two lines that have changed places."""
    return text.replace(line(one), "\0").replace(line(two), line(one)).replace("\0", line(two))


def replaced(*pairs: tuple[str, str]) -> str:
    text = TEXT
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


def group(kind: str) -> str:
    """All lines of a kind of group."""
    start = TEXT.index(f"GROUP  {kind} ")
    ends = (TEXT.find(mark, start + 1) for mark in ("GROUP  ", "COMMON  "))
    return TEXT[start : min(end for end in ends if end > 0)]


NAIL = [
    "GROUP  nail  NVNA  INAPNT  ours | one nail",
    "HEAD   int   -      head  -    ours/2 | MNAIL",
    "KNA    int   nail   next  -    ours/2 | next nail; 0 at the end of the list",
    "KNAB   int   block! host  -    ours/2 | block that it is in",
    "KNAF   real  0..    data  N/m  ours/2 | force",
]
NAILS = replaced(
    ("HEAD  MSIG ", "HEAD  MNAIL  91  nail | nail\nHEAD  MSIG "),
    ("GROUP  signal", "\n".join(NAIL) + "\nGROUP  signal"),
    (
        line("NBLK"),
        "INAPNT int   nail   head  -    ours/2 | list of nails; 0 when there are none\n" + line("NBLK"),
    ),
)
CODES = replaced(
    ("VIRTUAL        4 ", "VIRTUAL        6 "),
    ("KCCOD  int   1..4 ", "KCCOD  int   1..6 "),
    ("GIVEN_X  2 ", "GIVEN_X  4 "),
    ("GIVEN_Y  4 ", "GIVEN_Y  2 "),
    ("ALONG_X  1 ", "ALONG_X  4 "),
    ("ALONG_Y  2 ", "ALONG_Y  1 "),
    ("KGFIX  int   0..3 ", "KGFIX  int   0..5 "),
    ("KUFIX  int   0..4 ", "KUFIX  int   0..5 "),
    ("TURNS  4 ", "TURNS  2 "),
    ("AT_CONTACTS  2 ", "AT_CONTACTS  3 "),
    ("AT_BROKEN    3 ", "AT_BROKEN    2 "),
)
BEFORE_FLAGS = "".join(one for one in CODES.splitlines(keepends=True) if one.split()[1:2] != ["TURNS"])
BEFORE_FLAGS = re.sub(r"(?m)^FLAG (?!.* KCJFLAG )", "CODE ", BEFORE_FLAGS).replace("KGFIX,KUFIX", "KGFIX")
ALONG = {1: 4, 2: 1, 3: 5}
NUMBERS = {
    "KCCOD": {4: 6},
    "KBFIX": {2: 4, 4: 2},
    "KGFIX": ALONG,
    "KUFIX": ALONG | {4: 2},
    "JPHASE": {2: 3, 3: 2},
}


class Case(NamedTuple):
    """Another table; codes: numbers that it has for ours; news: messages on a file written by it."""

    text: str
    news: tuple[str, ...] = ()
    codes: Mapping[str, Mapping[int, int]] = {}


NAMES = [field.name for field in OURS.group("block").fields]
FROM_KX = len(NAMES) - NAMES.index("KX")
CASES = {
    "comment": Case(replaced(("| one block\n", "| a block\n"), ("# type ", "# Type "))),
    "middle": Case(
        before("KX", "KNEW real - data m ours/2 | new"),
        ("fields not known here, and 0: 1 (KNEW of block)", f"fields elsewhere in the group: {FROM_KX} ("),
    ),
    "end": Case(
        behind("KLB", "KNEW int 0..9 data - ours/2 | new"),
        ("fields not known here, and 0: 1 (KNEW of corner)",),
    ),
    "pointer": Case(
        behind("KLB", "KNEW int contact data - ours/2 | new; 0 for none"),
        ("fields not known here, and 0: 1 (KNEW of corner)",),
    ),
    "swapped": Case(
        swapped("KXD", "KYD", swapped("KMAT", "KCONS")),
        ("fields elsewhere in the group: 4 (KMAT of block, KCONS of block, KXD of block, KYD",),
    ),
    "less": Case(
        TEXT.replace(line("KVGX"), "").replace("\nLAYOUT  ", "\nRETIRED  KVGX  2 | gradient\nLAYOUT  "),
        ("fields that are new and 0: 1 (KVGX of water)", "fields elsewhere in the group: 3 (KVGY of"),
    ),
    "kind": Case(
        NAILS,
        ("fields not known here, and 0: 1 (INAPNT)", "not known here, and empty: 1 (nail)"),
    ),
    "kind less": Case(
        TEXT.replace(group("jointext"), "").replace("jointext ", "any "), ("kinds of group that are new: 1",)
    ),
    "codes": Case(CODES, ("codes under another number: 8 (GIVEN_X",), NUMBERS),
    "codes before flags": Case(
        BEFORE_FLAGS,
        ("codes under another number: 7 (GIVEN_X",),
        NUMBERS,
    ),
    "heads": Case(
        replaced(("HEAD  MCOR   4", "HEAD  MCOR   96"), ("HEAD  MCON   5", "HEAD  MCON   4")),
        ("codes under another number: 2 (MCOR, MCON)",),
    ),
    "kinds in order": Case(
        TEXT.replace(group("corner"), "").replace(group("domain"), group("domain") + group("corner"))
    ),
    "common": Case(
        swapped("NCYC", "TIME", before("NCYC", "LNEW  int  0..1  data  -  ours/2 | new")),
        ("fields not known here, and 0: 1 (LNEW)",),
    ),
    "common less": Case(TEXT.replace(line("LSHORT"), ""), ("fields that are new and 0: 1 (LSHORT)",)),
    "reals of a kind": Case(replaced(("ESTOR   double", "ESTOR   real  "))),
    "all at once": Case(
        swapped("KUFX", "KUVY", CODES)
        .replace(line("KX"), "KNEW real*3 - data m ours/2 | new\n" + line("KX"))
        .replace(line("KHG"), "KHNEW int - data - ours/2 | new\n" + line("KHG"))
        .replace(line("TIME"), "TNEW double - data s ours/2 | new\n" + line("TIME")),
        ("fields not known here, and 0: 3 (TNEW, KNEW of block, KHNEW of history)",),
        NUMBERS,
    ),
}  # fmt: skip


def write_case(model: Model, folder: Path, case: Case, seed: int | None = 1) -> Path:
    """A file of the model, written by the other table with its groups in random order."""
    theirs = parse(case.text)
    rng = None if seed is None else np.random.default_rng(seed)
    words, common = retell(model.array, theirs, case.codes, rng=rng)
    return write(model.save(folder / "told.h5"), case.text, words, common, theirs)


@pytest.mark.parametrize("name", CASES)
def test_a_file_by_another_table_is_read_by_names(name: str, model: Model, tmp_path: Path) -> None:
    """Every field and variable is what it was, but for addresses; and histories go on."""
    case = CASES[name]
    path = write_case(model, tmp_path, case)
    other = Model.restore(path)
    assert differences(essence(model.array), essence(other.array)) == []
    told_of = [(one.name, one.numbers.tobytes()) for one in other.histories()]
    assert told_of == [(one.name, one.numbers.tobytes()) for one in model.histories()]
    assert other.check() == []
    printed = ", ".join(read_stored_state(path).news)
    for one in case.news:
        assert one in printed, printed
    assert bool(case.news) == bool(printed)
    assert (f"another one: {printed}" if printed else "that of this program\n") in info(path)


@pytest.mark.parametrize("name", CASES)
def test_words_by_another_table_are_those_that_a_program_with_it_writes(name: str, model: Model) -> None:
    """The other way round: what this program has written, read by the other table."""
    case = CASES[name]
    if name == "reals of a kind":
        with pytest.raises(TranslationError, match=r"ESTOR is .*, but it is real here"):
            translate(words_of(model.array), parse(case.text), model.array.scheme)
        return
    theirs, state = parse(case.text), words_of(model.array)
    got = translate(state, theirs, state.scheme)
    words, common = retell(model.array, theirs, case.codes)
    stays = len(got.ia) == len(state.ia)
    if not stays:
        assert got.ia.tobytes() == words.tobytes()
        assert [name for name in common if got.common[name].tobytes() != common[name].tobytes()] == []
    back = translate(got, OURS, state.scheme)
    assert [len(at) for at in (back.ia, got.ia, state.ia)].count(len(state.ia)) == (3 if stays else 1)
    for field in OURS.common:
        same = np.array_equal(back.common[field.name], state.common[field.name])
        assert same or (not stays and (field.target or field.name in ("JUNK", "MFREE"))), field.name


@pytest.mark.parametrize("name", ["middle", "codes", "heads", "common", "all at once"])
def test_what_was_read_goes_on_bit_for_bit(name: str, tmp_path: Path) -> None:
    one = scene(tmp_path)
    two = Model.restore(write_case(one, tmp_path, CASES[name]), out=tmp_path / "two")
    for m in (one, two):
        m.cycle(10)
        m.split(-1, 0.4, 1, 0.6)
        m.delete(0, 1, 0.5, 1)
        m.cycle(5)
    assert differences(essence(one.array), essence(two.array)) == []
    assert [s.numbers.tobytes() for s in one.histories()] == [s.numbers.tobytes() for s in two.histories()]


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_in_every_word_scheme(build: str, tmp_path: Path) -> None:
    one = every_kind(build)
    case = CASES["all at once"]
    other = Model.restore(write_case(one, tmp_path, case))
    assert differences(essence(one.array), essence(other.array)) == []
    for scheme in ALL_SCHEMES.values():
        state = translate(words_of(one.array), parse(case.text), scheme)
        assert state.ia.dtype == scheme.int_type


def test_a_comment_changes_nothing(model: Model, tmp_path: Path) -> None:
    """Not one bit, wherever it stands."""
    path = model.save(tmp_path / "one.h5")
    state = words_of(model.array)
    write(path, CASES["comment"].text, state.ia.copy(), dict(state.common), parse(CASES["comment"].text))
    array = Model.restore(path).array
    assert [part.tobytes() for part in array.h] == [part.tobytes() for part in model.array.h]


def refusal(path: Path, read: Callable[[Path], Any] = Model.restore) -> str:
    with pytest.raises(UdecError) as caught:
        read(path)
    assert caught.value.number == 29
    assert " was written with another field table: " in caught.value.detail
    return caught.value.detail


REFUSED: dict[str, tuple[str, dict[str, float], Mapping[str, Mapping[int, int]], str]] = {
    "a field that is not 0": (
        before("KX", "KNEW real - data m ours/2 | new"), {"KNEW": 2.5}, {},
        "KNEW of block@1 is 2.5, and that field is not known here, and 5 more",
    ),
    "a variable that is not 0": (
        before("NCYC", "LNEW int 0..9 data - ours/2 | new"), {"LNEW": 7}, {},
        "LNEW is 7, and that field is not known here",
    ),
    "a code that has gone": (
        CODES.replace("VIRTUAL        6 ", "HANGING        7 "), {}, NUMBERS | {"KCCOD": {2: 7}},
        "KCCOD of contact is 7, HANGING in the file, which is not known here",
    ),
    "a code without a name": (
        CODES, {}, NUMBERS | {"KCCOD": {1: 4}}, "KCCOD of contact is 4, which is no code in the file",
    ),
    "another type": (
        TEXT.replace(line("KX"), line("KX").replace("real", "int ")), {}, {},
        "KX of block@1 is 3, but it is real here",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_finds_no_place_is_refused(name: str, model: Model, tmp_path: Path) -> None:
    table, given, codes, what = REFUSED[name]
    theirs = parse(table)
    words, common = retell(model.array, theirs, codes, given)
    path = write(model.save(tmp_path / "told.h5"), table, words, common, theirs)
    assert what in refusal(path)
    assert what in refusal(path, look_into)
    assert what in info(path)


def test_a_history_of_what_is_not_known_is_refused(model: Model, tmp_path: Path) -> None:
    text, state = TEXT.replace(line("KYD"), line("KYD").replace("KYD ", "KYOLD ")), words_of(model.array)
    path = write(model.save(tmp_path / "old.h5"), text, state.ia.copy(), dict(state.common), parse(text))
    assert re.search("history@[0-9]+ records KYOLD of block, which is not known here", refusal(path))


def test_what_is_retired_is_told(model: Model) -> None:
    gone = "\nLAYOUT  ", "\nRETIRED  KBRO  2 | how far it reaches\nLAYOUT  "
    retired = parse(replaced((line("KBRO"), ""), gone))
    with pytest.raises(TranslationError) as caught:
        translate(words_of(model.array), retired, model.array.scheme)
    assert "that field is retired since layout 2 (how far it reaches) here" in caught.value.faults[0]


def test_a_new_field_that_may_not_be_0_is_refused(model: Model) -> None:
    for new, many in (("1..9", 6), ("domain!", 6)):
        theirs = parse(before("KX", f"KNEW int {new} data - ours/2 | new"))
        with pytest.raises(
            TranslationError,
            match=f"KNEW of block@1 is 0, as it is new, but must not be 0, and {many - 1} more",
        ):
            translate(words_of(model.array), theirs, model.array.scheme)
    headed = line("KTPN"), "HEAD int - head - ours/2 | MTAB\n" + line("KTPN")
    theirs = parse(
        replaced(("GROUP  tabpoint", "HEAD  MTAB  12  tabpoint | a point\nGROUP  tabpoint"), headed)
    )
    got = translate(words_of(model.array), theirs, model.array.scheme)
    back = translate(got, OURS, got.scheme)  # what the head code of one kind states, the kind itself states
    points = model.table("tabpoint")["address"] - 1
    assert (got.ia[points] == 12).all()
    assert (back.ia[points] == model.h.ia[points]).all()


def test_a_kind_of_which_there_are_groups_is_refused(model: Model) -> None:
    theirs = parse(TEXT.replace(group("signal"), "").replace("signal ", "any ").replace(line("ISGPNT"), ""))
    with pytest.raises(TranslationError, match=r"signal@[0-9]+ is of a kind that is not known here"):
        translate(words_of(model.array), theirs, model.array.scheme)


@pytest.mark.parametrize("where", ["group", "pointer", "lost", "junk"])
def test_groups_that_cannot_be_moved_are_refused(where: str, model: Model) -> None:
    """A damaged heap, with sizes that change: what is wrong is told, and nothing hangs."""
    array, theirs = model.array.copy(), parse(CASES["middle"].text)
    state = words_of(array)
    ratio = array.scheme.ratio >> 1
    corner = int(state.common["IBPNT"][0]) + g.KP[ratio] - 1
    what = {
        "group": "word [0-9]+ is in two groups",
        "pointer": "KP of block@[0-9]+ is 3, but there is no corner",
        "lost": "words [0-9]+ to [0-9]+ are in no group",
        "junk": "words [0-9]+ to [0-9]+ are in no group",
    }[where]
    if where == "group":
        state.ia[corner] += 2
        at = int(state.ia[corner])
        state.ia[at - 1] = g.MCOR
    elif where == "pointer":
        state.ia[corner] = 3
    elif where == "lost":
        state = state._replace(ia=np.append(state.ia, np.zeros(20, state.ia.dtype)))
    else:
        variable(array.h, next(field for field in OURS.common if field.name == "JUNK"))[:] = 0
    with pytest.raises(TranslationError, match=what):
        translate(state, theirs, state.scheme)
