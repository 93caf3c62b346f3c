"""DUMP gives back every word of the array, and says what each of them is."""

from __future__ import annotations

import pytest
from support.handmade_map import two_blocks

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, puti, putr
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import lay_out, read_table
from udec_ia.output.word_dump import dump
from udec_ia.reader.list_walks import corners, groups


def words(text: str) -> dict[int, int]:
    """Address -> word, read back from a dump."""
    found: dict[int, int] = {}
    for line in text.splitlines()[1:]:
        address, numbers, _ = (part.strip() for part in line.split("|"))
        if numbers.startswith("0 to address"):
            numbers = "0 " * (int(numbers.split()[-1]) - int(address) + 1)
        found |= {int(address) + i: int(word) for i, word in enumerate(numbers.split())}
    return found


def meaning(text: str, label: str) -> dict[str, str]:
    """Field -> printed value of the group with this label."""
    found: dict[str, str] = {}
    current = ""
    for line in text.splitlines()[1:]:
        for word in line.split("|")[2].split():
            if "@" in word:
                current = word
            elif "=" in word and current == label:
                name, value = word.split("=")
                assert name not in found, f"{label} {name} is annotated twice"
                found[name] = value
    return found


@pytest.mark.parametrize("scheme", ALL_SCHEMES)
@pytest.mark.parametrize("window", [(1, 8192), (1, 1), (2, 2), (7, 42), (40, 91), (300, 700), (5000, 8192)])
def test_every_word_is_there(scheme: str, window: tuple[int, int]) -> None:
    h = two_blocks(scheme).h
    n, m = window
    text = dump(h, n, m)
    assert words(text) == {iad: int(h.ia[iad - 1]) for iad in range(n, m + 1)}
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.parametrize("scheme", ALL_SCHEMES)
def test_every_field_is_annotated_once(scheme: str) -> None:
    h = two_blocks(scheme).h
    text = dump(h, 1, int(h.ci[g.MFREE]) - 1)
    block = next(groups(h, "block"))
    for kind, iad in {"block": block, "corner": corners(h, block)[1]}.items() | {
        (kind, next(groups(h, kind))) for kind in ("contact", "domain")
    }:
        printed = meaning(text, f"{kind}@{iad}")
        fields = read_table().group(kind).fields
        assert list(printed) == ["head" if f.role == "head" else f.name for f in fields]
    assert meaning(text, f"block@{block}")["KX"] == "0.5"
    assert meaning(text, f"block@{block}")["KBFIX"] == "1"
    assert meaning(text, f"block@{block}")["head"] == "MRIG"


def test_a_window_that_begins_inside_a_real_shows_the_whole_real() -> None:
    """Word 8 is the second half of KX (words 7 and 8)."""
    h = two_blocks("i32r64").h
    assert meaning(dump(h, 8, 8), "block@1") == {"KX": "0.5"}


def test_the_five_pointers() -> None:
    h = two_blocks().h
    names = ("MFREE", "JUNK", "IBPNT", "ICPNT", "IDPNT")
    expected = "  ".join(f"{name} {h.ci[getattr(g, name)]}" for name in names)
    assert dump(h, 1, 1).splitlines()[0] == expected


def spare(h: Memory) -> tuple[int, int, int]:
    """Two corner groups and a domain group, taken and given back: three junk groups in two chains."""
    taken = find(h, g.NVCR), find(h, g.NVCR), find(h, g.NVDO)
    for group, size in zip(taken, (g.NVCR, g.NVCR, g.NVDO), strict=True):
        lose(h, group, size)
    return taken


@pytest.mark.parametrize("scheme", ALL_SCHEMES)
def test_junk_is_named(scheme: str) -> None:
    array = two_blocks(scheme)
    h = array.h
    text = ""
    for group in spare(h):
        text = dump(h, group, group)
        assert f"junk@{group}, " in text
    size = lay_out(read_table().group("domain"), array.scheme.ratio).size
    assert f"{size} words" in text


def test_a_heap_without_heads_is_still_dumped() -> None:
    """Nothing can be reached from empty list heads: the raw words stay, marked as not linked."""
    h = two_blocks().h
    h.ci[[g.IBPNT, g.ICPNT, g.IDPNT, g.IODPNT]] = 0
    text = dump(h, 1, 8192)
    assert "not linked" in text
    assert "@" not in text
    assert words(text) == {iad: int(h.ia[iad - 1]) for iad in range(1, 8193)}


@pytest.mark.parametrize("wrong", [-5, 2, 300, 10**6])
def test_wild_pointers_are_not_followed(wrong: int) -> None:
    """A block list that leads astray: the second block is still reached through its contacts."""
    h = two_blocks().h
    lower, upper = groups(h, "block")
    puti(h, lower, g.KB, wrong)
    text = dump(h, 1, 8192)
    assert meaning(text, f"block@{lower}")["KB"] == str(wrong)
    assert meaning(text, f"block@{upper}")["KY"] == "1.5"


def test_reals_that_are_no_numbers() -> None:
    h = two_blocks().h
    putr(h, 1, g.KX, float("nan"))
    assert meaning(dump(h, 1, 20), "block@1")["KX"] == "nan"


@pytest.mark.parametrize("window", [(0, 5), (-3, 5), (6, 5), (1, 8193), (9000, 9001)])
def test_addresses_outside_the_array(window: tuple[int, int]) -> None:
    with pytest.raises(UdecError) as error:
        dump(two_blocks().h, *window)
    assert error.value.number == 30
    assert "8192" in error.value.advice
