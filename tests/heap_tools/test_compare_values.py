"""What `udec diff` says: patched values, damaged files, tolerances, words by address, exit status."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.relocate import relocate
from support.every_group_kind import every_kind
from test_look_damage import spoiled

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.heap.accessors import getr, iget, puti, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES, scheme
from udec_ia.heap_tools.comparison_report import diff, raw
from udec_ia.heap_tools.rewrite_heap import rewrite
from udec_ia.heap_tools.state_comparison import compare, real_differences, tolerance
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import table
from udec_ia.reader.word_map import Atlas
from udec_ia.restart import save

PATCHES = 60
DAMAGED = 7  # in each word scheme


@pytest.fixture(name="state", scope="module")
def a_state(tmp_path_factory: pytest.TempPathFactory) -> MainArray:
    """Groups of every kind, after some cycles."""
    m = every_kind()
    m.out = tmp_path_factory.mktemp("state")
    m.cycle(5)
    array: MainArray = m.array
    return array


def test_one_patched_real_is_one_difference(state: MainArray) -> None:
    """Any real of any group, whatever it is for, at other addresses too."""
    rng, atlas = np.random.default_rng(3), Atlas(state.h)
    moved = relocate(state, rng)
    shapes = [
        (kind, k) for kind in atlas.shapes for k in range(len(atlas.shapes[kind])) if len(atlas.groups[kind])
    ]
    shapes = [(kind, k) for kind, k in shapes if atlas.shapes[kind][k].field.real]
    other = Atlas(moved.h)
    for _ in range(PATCHES):
        kind, k = shapes[rng.integers(len(shapes))]
        word, row = atlas.shapes[kind][k], int(rng.integers(len(atlas.groups[kind])))
        index = (int(other.groups[kind][row]) + word.first - 1) // 2
        before = float(moved.h.ra[index])
        moved.h.ra[index] = before + 1000.0
        found = compare(state.h, moved.h)
        moved.h.ra[index] = before
        (one,) = found.fields
        assert (one.kind, one.name, int(one.two[0])) == (kind, word.name, int(other.groups[kind][row]))
        assert one.values[1][0] - one.values[0][0] == pytest.approx(1000.0)
        assert found.differ
        assert not any(len(a) + len(b) for a, b in found.alone.values())


def test_one_patched_integer_is_one_difference(state: MainArray) -> None:
    """Pointers too, to another group of the kind: other links hold all but the end of a list."""
    rng, atlas = np.random.default_rng(5), Atlas(state.h)
    several = 0
    for _ in range(2 * PATCHES):
        kind = rng.choice(
            [
                kind
                for kind, at in atlas.groups.items()
                if len(at) and not all(one.field.real for one in atlas.shapes[kind])
            ]
        )
        word = rng.choice([k for k, one in enumerate(atlas.shapes[kind]) if not one.field.real])
        one = atlas.shapes[kind][word]
        at = int(rng.choice(atlas.groups[kind])) + one.first - 1
        patched = state.copy()
        patched.h.ia[at] = (
            int(rng.choice(atlas.groups[one.field.target]))
            if len(atlas.groups.get(one.field.target, ()))
            else 0
        )
        if patched.h.ia[at] == state.h.ia[at] or one.field.role in ("head", "first"):
            continue
        found = compare(state.h, patched.h)
        assert (kind, one.name) in {(field.kind, field.name) for field in found.fields}
        several += len(found.fields) > 1 or len(found.fields[0].one) > 1
    assert several <= PATCHES // 10


def test_a_deleted_block_goes_with_what_is_its(tmp_path: Path) -> None:
    m = every_kind()
    m.out = tmp_path
    m.cycle(2)
    before, rows = m.array.copy(), table(m.array, "block")
    m.delete(2.9, 4, 0, 1)
    (gone,) = {*rows["address"].tolist()} - {*table(m.array, "block")["address"].tolist()}
    alone = compare(before.h, m.array.h).alone
    corners, contacts = table(before, "corner"), table(before, "contact")
    touching = (contacts["KB1"] == gone) | (contacts["KB2"] == gone)
    assert alone["block"][0].tolist() == [gone]
    assert {*alone["corner"][0].tolist()} == {*corners["address"][corners["KNB"] == gone].tolist()}
    assert {*contacts["address"][touching].tolist()} <= {*alone["contact"][0].tolist()}
    assert len(alone["zone"][0]) == 4
    text = diff(before, m.array).as_text()
    assert f"deleted: 1 block, {len(alone['corner'][0])} corners" in text
    assert f"block@{gone}" in text


def test_last_digits() -> None:
    """Counted one by one, through 0, and in the narrower of two widths."""
    for kind in (np.float32, np.float64):
        for start in (1.0, 0.0, -2.0, 1e-30, 3.0):
            value = kind(start - 1e-44 if kind is np.float32 and start == 0 else start)
            on = value
            for _ in range(7):
                on = np.nextafter(on, kind(math.inf))
            apart = real_differences(np.array([value, 1]), np.array([on, 1], kind).astype(kind))
            assert (apart.rows.tolist(), apart.ulps.tolist()) == ([0], [7.0])
    wide, narrow = (
        np.array([1 + 1e-12, 1 + 2**-22, math.nan, -0.0]),
        np.array([1, 1, math.nan, 0], np.float32),
    )
    apart = real_differences(wide, narrow)
    assert (apart.rows.tolist(), apart.ulps.tolist(), apart.absolute.tolist()) == ([1], [2.0], [2**-22])
    assert real_differences(np.array([math.nan]), np.array([1.0])).rows.tolist() == [0]


def test_what_is_asked_for_and_what_does_not_count(state: MainArray) -> None:
    other = state.copy()
    ic, ib = int(other.h.ci[g.ICPNT]), int(other.h.ci[g.IBPNT])
    putr(other.h, ic, g.KCFN, getr(other.h, ic, g.KCFN) + 5)
    putr(other.h, ib, g.KX, getr(other.h, ib, g.KX) + 1e-7)
    other.h.cr[g.FRAC] *= 1.5

    def fields(*only: str, allowed: tuple[str, ...] = ()) -> list[str]:
        return [one.name for one in compare(state.h, other.h, only, tolerance(allowed)).fields]

    assert fields() == ["KX", "KCFN", "FRAC"]
    assert fields("contact") == ["KCFN"]
    assert fields("block.kx", "common.FRAC") == ["KX", "FRAC"]
    assert fields(allowed=("m=1e-6",)) == ["KCFN", "FRAC"]
    assert fields(allowed=("m=1e-8", "N/m=5.5")) == ["KX", "FRAC"]
    assert fields(allowed=("relative=0.4",)) == ([] if abs(getr(other.h, ic, g.KCFN)) > 20 else ["KCFN"])
    assert "FRAC" not in fields(allowed=("ulp=1e16",))
    for wrong in ("contact.KXX", "brick", "block.KCFN"):
        with pytest.raises(ValueError, match=r"KXX|brick|KCFN"):
            fields(wrong)
    for wrong in ("m", "m=", "m=-1", "lb=1", "m=nan"):
        with pytest.raises(ValueError, match="such as m=1e-6"):
            fields(allowed=(wrong,))


@pytest.mark.parametrize(
    ("only", "output"),
    [
        ((), "{all} groups of both and the common block"),
        (("block.KXD", "common.FRAC"), "{block} groups of both and the common block"),
        (("block.KXD", "domain"), "{some} groups of both"),
        (("common",), "the common block"),
    ],
)
def test_the_summary_says_what_was_compared(only: tuple[str, ...], output: str, state: MainArray) -> None:
    many = {kind: len(at) for kind, at in Atlas(state.h).groups.items()}
    counts = {**many, "all": sum(many.values()), "some": many["block"] + many["domain"]}
    (line, *_) = diff(state, state.copy(), only).as_text().splitlines()
    assert line == f"the first and the second: no number differs in {output.format(**counts)}"


def test_codes_are_told_by_name(state: MainArray) -> None:
    other = state.copy()
    ic = next(int(row["address"]) for row in table(state, "contact") if row["KCCOD"] == g.CORNER_EDGE)
    puti(other.h, ic, g.KCCOD, g.VIRTUAL)
    told = diff(state, other).as_text()
    assert "re-coded: 1 contact\n" in told
    assert told.splitlines()[-1].split() == [f"contact@{ic}", "KCCOD", "CORNER_EDGE", "VIRTUAL"]


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_whatever_the_words_say(build: str) -> None:
    """Damaged against sound, damaged in another way, and damaged in other words."""
    sound, rng = every_kind(build).array, np.random.default_rng(17)
    other = rewrite(sound, scheme("i32r64")).array
    for _ in range(DAMAGED):
        array = spoiled(sound, rng)
        for one, two in ((sound, array), (array, spoiled(sound, rng)), (array, other), (array, array)):
            found = diff(one, two, limit=int(rng.integers(40)))
            assert json.loads(found.as_json())["summary"]["head"]
            assert found.as_text()
        assert found.status == 0
        assert raw(sound, array).as_text()


def test_what_was_left_out_is_said(state: MainArray) -> None:
    other = state.copy()
    puti(other.h, int(other.h.ci[g.IBPNT]), g.KP, 0)
    other.h.ci[g.ISGPNT] = 0
    for row in table(state, "bound")["address"].tolist():
        puti(other.h, row, g.KUS, 0)
    assert "of the second that nothing leads to" in diff(state, other).as_text()


def test_words_by_address(state: MainArray) -> None:
    other = state.copy()
    ib = int(other.h.ci[g.IBPNT])
    puti(other.h, ib, g.KMAT, 2)
    other.h.ci[g.NCYC] = 77
    (common, word) = raw(state, other).rows
    assert common == ("", "common block: NCYC", int(state.h.ci[g.NCYC]), 77)
    assert word == (ib + g.KMAT[1], f"block@{ib}.KMAT", 1, iget(other.h, ib, g.KMAT))
    assert raw(state, state.copy()).status == 0
    with pytest.raises(ValueError, match=r"i32r64.*i64r64"):
        raw(state, rewrite(state, scheme("i64r64")).array)


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its status: 0 nothing differs, 1 something does, 2 trouble. And --python does the same."""
    m = Model(out=tmp_path)
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    save(m.array, tmp_path / "a.h5")
    m.fix(0, 1, 0, 1)
    save(m.array, tmp_path / "b.h5")
    (tmp_path / "c.h5").write_text("no restart file")
    a, b, c = (str(tmp_path / name) for name in ("a.h5", "b.h5", "c.h5"))
    assert main(["diff", a, a]) == 0
    assert main(["diff", a, b]) == 1
    printed = capsys.readouterr().out
    assert [line for line in printed.splitlines() if "KBFIX" in line][-1].split() == [
        "block@1",
        "KBFIX",
        "0",
        "FIXED",
    ]
    assert main(["diff", a, b, "--python", "--limit", "3"]) == 0
    exec(compile_(capsys.readouterr().out), {})
    script = capsys.readouterr().out
    assert main(["diff", a, b, "--limit", "3"]) == 1  # as find and walk call it
    assert capsys.readouterr().out == script
    assert main(["diff", a, b, "--json"]) == 1
    assert {*json.loads(capsys.readouterr().out)} == {"summary", "alone", "differences"}
    assert main(["diff", a, c]) == main(["diff", a, str(tmp_path)]) == 2
    assert (
        main(["diff", a, b, "--only", "block.KBFIX", "--raw"]) == main(["diff", a, b, "--limit", "-1"]) == 2
    )
    assert capsys.readouterr().err.count("udec diff: ") == 4


def compile_(script: str) -> Any:
    """A script, by a name that says where it comes from."""
    return compile(script, "udec diff --python", "exec")
