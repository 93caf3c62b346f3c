"""udec find: conditions against Python's own eval on rows of tables, numbers and pointers by brute force."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.every_group_kind import GROUPS, every_kind

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.heap_tools.heap_search import find, find_pointers, find_value
from udec_ia.printable_text import counted
from udec_ia.reader.group_conditions import LONGEST
from udec_ia.reader.word_map import NOTHING, TABLE, Atlas, kind_named
from udec_ia.studies.quantities import read_quantities

CODES = {one.name: one.value for one in TABLE.codes} | {one.name: one.value for one in TABLE.heads}
SCENES = {build: every_kind(build) for build in ("i16r32", "i32r64")}
FIELDS = {group.name: group.fields for group in GROUPS}


def expected(m: Model, kind: str, condition: str) -> list[int]:
    """Addresses by Python itself, row by row."""
    found = []
    for row in m.table(kind):
        names: dict[str, Any] = {"address": int(row["address"]), "abs": abs, **CODES}
        for field in FIELDS[kind]:
            value = row[field.name].tolist()
            names[field.name] = (lambda one: lambda k: one[k - 1])(value) if field.count > 1 else value
        if eval(condition, {"__builtins__": {}}, names):
            found.append(int(row["address"]))
    return sorted(found)


def numbers(kind: str) -> st.SearchStrategy[str]:
    """Expressions that are numbers."""
    names = [
        f"{field.name}({k + 1})" if field.count > 1 else field.name
        for field in FIELDS[kind]
        for k in range(field.count)
    ]
    leaf = st.one_of(
        st.sampled_from([*names, "address", "MRIG", "VIRTUAL"]),
        st.integers(-3, 2000).map(str),
        st.floats(-10, 10, allow_nan=False).map(repr),
    )
    return st.recursive(
        leaf,
        lambda part: st.one_of(
            st.tuples(part, st.sampled_from("+-*"), part).map(lambda one: f"({' '.join(one)})"),
            part.map(lambda one: f"abs({one})"),
            part.map(lambda one: f"-{one}"),
        ),
        max_leaves=4,
    )


@st.composite
def conditions(draw: st.DrawFn) -> tuple[str, str]:
    kind = draw(st.sampled_from(["block", "corner", "contact", "zone", "bound"]))
    signs = st.sampled_from(["<", "<=", ">", ">=", "==", "!="])
    number = numbers(kind)
    compared = st.one_of(
        st.tuples(number, signs, number).map(" ".join),
        st.tuples(number, signs, number, signs, number).map(" ".join),
    )
    truth = st.recursive(
        compared,
        lambda part: st.one_of(
            st.tuples(part, st.sampled_from(["and", "or"]), part).map(lambda one: f"({' '.join(one)})"),
            part.map(lambda one: f"not {one}"),
        ),
        max_leaves=3,
    )
    return kind, draw(truth)


@pytest.mark.parametrize("build", [*SCENES])
@settings(max_examples=60, deadline=None)
@given(conditions())
def test_conditions_are_those_of_python(build: str, given_one: tuple[str, str]) -> None:
    kind, condition = given_one
    text = f"{kind} where {condition}"
    if len(text) <= LONGEST:
        found = find(Atlas(SCENES[build].array.h), text)
        assert [row[0] for row in found.rows] == expected(SCENES[build], kind, condition)


@pytest.mark.parametrize("build", [*SCENES])
@pytest.mark.parametrize(
    "text",
    [
        "contacts where KB1.KX > KB2.KX",
        "corner where KNB.KMAT == 1 and KL.KXP > 1",
        "corners where not KL.KXP > 1",
        "block where KBEX.KS111 != 0 or KBEX == 0",
        "zone where KZG(1).KXG + KZG(2).KXG <= 2 * KZG(3).KXG",
        "blocks where KB.KB.KX > KX",
        "contact where KC.KCP1.KNB == KB1",
        "domain where KDLOOP.KB1.KP.KYP > 0 or address < 500",
    ],
)
def test_conditions_with_paths(build: str, text: str) -> None:
    """Against rows of tables: a comparison in which a pointer leads to no such field is false."""
    m = SCENES[build]
    rows = {int(row["address"]): row for group in GROUPS for row in m.table(group.name)}
    plural, _, condition = text.partition(" where ")
    kind = plural.removesuffix("s")

    def value(row: Any, path: str) -> str:
        for step in path.split("."):
            name, _, element = step.partition("(")
            if row is None or name not in row.dtype.names:
                return "float('nan')"
            number = row[name][int(element[:-1]) - 1] if element else row[name]
            row = rows.get(int(number)) if number == number and abs(number) < 2**31 else None
        return repr(number.item())

    def holds(row: Any) -> bool:
        filled = re.sub(
            r"\bK[A-Z]+\d*(?:\(\d\))?(?:\.K\w+(?:\(\d\))?)*", lambda one: value(row, one[0]), condition
        )
        return bool(
            eval(
                re.sub(r"(float\('nan'\)) !=", r"\1 ==", filled),
                {"address": int(row["address"]), "float": float},
            )
        )

    expected = sorted(int(row["address"]) for row in m.table(kind) if holds(row))
    found = [row[0] for row in find(Atlas(m.array.h), text).rows]
    assert found == expected


def test_what_is_shown_of_a_path() -> None:
    """Nothing where a pointer leads to no such group."""
    m = SCENES["i32r64"]
    listing = find(Atlas(m.array.h), "block where KBEX.KS111 != 1e99 or KX > -1")
    extensions = {int(row["address"]): float(row["KS111"]) for row in m.table("sdef")}
    blocks = np.sort(m.table("block"), order="address")
    assert listing.columns[2:] == ("KBEX.KS111", "KX")
    assert [row[2] for row in listing.rows] == [extensions.get(int(one), "") for one in blocks["KBEX"]]


def test_kinds_in_singular_and_plural(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Every kind, in every place that takes one."""
    m = SCENES["i32r64"]
    for group in GROUPS:
        name = group.name
        plural = {"history": "histories", "relax": "relaxes"}.get(name, name + "s")
        assert kind_named(plural) == kind_named(name.upper()) == name
        assert np.array_equal(m.table(plural), m.table(name))
        assert find(Atlas(m.array.h), plural) == find(Atlas(m.array.h), name)
    assert kind_named("grid-points") == "gridpoint"
    assert [kind_named(word) for word in ("", "s", "es", "blockss", "lists", "-")] == [None] * 6
    for name in ("block", "contact", "corner", "domain", "gridpoint", "zone", "history"):
        assert m.print(name) == m.print("histories" if name == "history" else name + "s")
    file, iad = str(m.save(tmp_path / "all.h5")), m.table("gridpoint")["address"].min()
    point, points = f"gridpoint@{iad}", f"grid-points@{iad}"
    for one, other in (
        (["walk", file, "contacts"], ["walk", file, "contact"]),
        (["walk", file, "blocks", "1"], ["walk", file, "block", "1"]),
        (["what", file, "blocks@1"], ["what", file, "block@1"]),
        (["dump", file, "blocks@1.KX"], ["dump", file, "block@1.KX"]),
        (["dump", file, f"{points}/3"], ["dump", file, f"{point}/3"]),
        (["dump", file, f"{points}-{points}"], ["dump", file, point]),
        (
            ["diff", file, file, "--only", "blocks", "grid-points.KXG"],
            ["diff", file, file, "--only", "block", "gridpoint.KXG"],
        ),
    ):
        assert main(one) == 0
        printed = capsys.readouterr().out
        assert main(other) == 0
        assert printed == capsys.readouterr().out
    assert [*read_quantities(["count contacts", "max blocks.KX where KX > 1"])]


def test_what_is_shown_of_what_is_found() -> None:
    m = SCENES["i32r64"]
    atlas = Atlas(m.array.h)
    listing = find(atlas, "block where KX > 2 and KMAT == 1 and KX < 1e9")
    assert listing.columns == ("address", "group", "KX", "KMAT")
    rows = m.table("block")
    rows = np.sort(rows[rows["KX"] > 2], order="address")
    wanted = [(int(r["address"]), f"block@{r['address']}", float(r["KX"]), 1) for r in rows]
    assert listing.rows == wanted
    short = find(atlas, "block where KX > 2", limit=2)
    assert short.rows == [row[:3] for row in wanted[:2]]
    assert short.head == [f"{len(wanted)} of 7 groups of the kind block; the first 2:"]
    assert len(find(atlas, "corner").rows) == len(m.table("corner"))


@pytest.mark.parametrize(
    ("condition", "says", "below"),
    [
        ("blok where KX > 1", "did you mean block?", "blok"),
        ("KXD > 1", "write block where KXD ...", "KXD"),
        ("block wher KX > 1", "after the kind of group write: where", "wher"),
        ("block where KXDD > 1", "did you mean KXD?", "KXDD"),
        ("block where kxd > 1", "did you mean KXD?", "kxd"),
        ("block where KXP > 1", "a block has no field KXP", "KXP"),
        ("block where KX = 1", "for equal write ==", "= 1"),
        ("block where KX", "this is a number", "KX"),
        ("block where KX > 1 and KY", "this is a number", "KY"),
        ("block where (KX > 1) + 1 > 2", "this is true or false", "KX > 1"),
        ("block where KX > 1)", "cannot be understood", ")"),
        ("block where (KX > 1", "cannot be understood", "(KX"),
        ("block where KX.real > 1", "KX is not a pointer", "KX.real"),
        ("contact where KB1.KXP > 1", "a block has no field KXP", "KXP"),
        ("corner where KL.KXX > 1", "a corner or contact has no field KXX", "KXX"),
        ("zone where KZG(2).KZ.KX > 1", "a gridpoint has no field KZ", "KZ.KX"),
        ("block where KB.(KX) > 1", "cannot be understood", "(KX)"),
        ("block where KX > 'é' or KX > [1]", "not allowed", "'é'"),
        ("block where 'é' > KX", "not allowed", "'é'"),
        ("block where KX in (1, 2)", "no such comparison", "KX in"),
        ("block where KX ** 2 > 1", "not allowed", "KX **"),
        ("block where KX > True", "not allowed", "True"),
        ("block where KX > 1j", "not allowed", "1j"),
        ("block where (lambda: KX)() > 1", "not allowed", "(lambda: KX)"),
        ("block where open('x') > 1", "no field open('x')", "open"),
        ("block where abs(KX, KY) > 1", "not allowed", "abs"),
        ("block where KX > (y := 3)", "not allowed", "y :="),
        ("zone where KZG > 1", "there is no KZG, but KZG(1) to KZG(3)", "KZG"),
        ("zone where KZG(4) > 1", "there is no KZG(4), but KZG(1) to KZG(3)", "KZG"),
        ("block where \t\nKXDD > 1", "did you mean KXD?", "KXDD"),
    ],
)
def test_what_is_wrong_is_shown(condition: str, says: str, below: str) -> None:
    with pytest.raises(ValueError, match=re.escape(says)) as raised:
        find(Atlas(SCENES["i32r64"].array.h), condition)
    _, line, caret = str(raised.value).rsplit("\n", 2)
    assert line[caret.index("^") :].startswith(below)
    assert len(line) == len(condition) + 4


@pytest.mark.parametrize(
    "condition",
    [
        "",
        "   ",
        "block where ",
        "block where " + "(" * 300 + "KX > 1" + ")" * 300,
        "block where " + "(" * 220 + "KX > 1" + ")" * 220,
        "block where KX > \0",
        "block where KX > \udc80",
        "block where " + "9" * 480 + "x > 1",
        "block where " + "KX" * 5000,
    ],
)
def test_what_is_no_condition_at_all(condition: str) -> None:
    with pytest.raises(ValueError, match=r"give a kind|longer than|cannot be understood|after where"):
        find(Atlas(SCENES["i32r64"].array.h), condition)


def test_long_but_sound() -> None:
    atlas = Atlas(SCENES["i32r64"].array.h)
    for condition in ("-" * 400 + "1 > 0", "not " * 100 + "KX < 1e99", "+".join("1" * 230) + " > 0"):
        assert len(find(atlas, f"block where {condition}").rows) == 7
    assert find(atlas, f"block where KX > {'9' * 450}").rows == []
    assert find(atlas, "block where KX / 0 == 1 or address > 99999999999999999999").rows == []


def brute(m: Model, value: float, tolerance: float) -> set[tuple[int, str]]:
    """Address and field of all numbers in groups within the tolerance, by tables."""
    atlas, found = Atlas(m.array.h), set()
    slack = abs(value) * tolerance
    for group in GROUPS:
        for row in m.table(group.name):
            words = iter(atlas.words(atlas.span(int(row["address"]))))
            for field in group.fields:
                for one in np.atleast_1d(row[field.name]).tolist():
                    word = next(words)
                    near = abs(one - value) <= slack if field.real else one == round(value)
                    near &= field.real or abs(round(value) - value) <= slack
                    near |= field.real and one == m.array.h.ra.dtype.type(value)
                    found |= {(word.first, word.name)} if near else set()
    return found


@pytest.mark.parametrize("build", ALL_SCHEMES)
@pytest.mark.parametrize(
    ("value", "tolerance"),
    [(0.0, 1e-6), (1.0, 0), (2.5, 1e-6), (4.6, 0.1), (1000.0, 1e-3), (-1e-9, 1), (0.05, 1e-6)],
)
def test_numbers_by_value(build: str, value: float, tolerance: float) -> None:
    m = every_kind(build)
    found = find_value(Atlas(m.array.h), value, tolerance, limit=100000)
    in_groups = {(row[0], row[2]) for row in found.rows if row[1] != "common block"}
    assert in_groups == brute(m, value, tolerance)
    assert found.head[0].startswith(f"{counted(len(found.rows), 'number')} with the value ")
    in_common = {row[2] for row in found.rows if row[1] == "common block"}
    assert ("NBLK" in in_common) == (value == 7)
    assert ("DTOL" in in_common) == (value == 0.05)


def test_numbers_that_are_none() -> None:
    m = every_kind()
    h = m.array.h
    block = int(m.table("block")["address"][2])
    word = next(word for word in Atlas(h).shapes["block"] if word.name == "KXD")
    h.ra[(block + word.first - 1) // 2] = math.nan
    assert [row[:3] for row in find_value(Atlas(h), math.nan).rows] == [
        (block + word.first, f"block@{block}", "KXD")
    ]


def test_limits() -> None:
    atlas = Atlas(SCENES["i32r64"].array.h)
    for few in (1, 3, 10):
        assert len(find_value(atlas, 0.0, limit=few).rows) == few
        assert len(find_pointers(atlas, 0, limit=few).rows) == few
    every = find_value(atlas, 0.0, limit=10**6).rows
    assert find_value(atlas, 0.0, limit=200).rows == every[:200]
    for bad in (0, -1):
        with pytest.raises(ValueError, match="give the number of rows"):
            find(atlas, "block", bad)
    for tolerance in (-1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="tolerance"):
            find_value(atlas, 1.0, tolerance)


def test_pointers_by_where_they_lead() -> None:
    m = SCENES["i32r64"]
    atlas = Atlas(m.array.h)
    block = int(m.table("block")["address"][0])
    for address in (block, block + 1, 0, 123456789, -1):
        wanted = set()
        for group in GROUPS:
            for row in m.table(group.name):
                for word in atlas.words(atlas.span(int(row["address"]))):
                    if word.field.target and atlas.value(word) == address:
                        wanted.add((word.first, word.name))
        listing = find_pointers(atlas, address, limit=10**6)
        assert {(row[0], row[2]) for row in listing.rows if row[1] != "common block"} == wanted
        assert listing.head[0].startswith(f"{counted(len(listing.rows), 'pointer')} to {address}, ")
    assert NOTHING not in find_pointers(atlas, block).head[0]
