"""The page's scripts that need no browser, run by Node.js: values, names, pointers, shapes, the search.

They are compared with the tables in Python, the answers of the restart-file tools, and naive outlines.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.contacts import rounded_polygon
from shapely.geometry import Point, Polygon
from support.every_group_kind import GROUPS, every_kind
from support.replayable_steps import blocks, outline

from udec_ia import Model
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.heap_tools.heap_lookup import who
from udec_ia.layout import offsets as g
from udec_ia.output.drawn_outlines import domain_polygons
from udec_ia.reader.field_rows import NOT_ALLOWED, meaning
from udec_ia.reader.word_map import IS_NO, JUNK, KINDS, Atlas, called
from udec_ia.view.view_data import state, tables
from udec_ia.view.view_page import LIMIT, script

NODE = shutil.which("node") or ""
FREE = (
    *("numbers.js", "heap.js", "words.js", "changes.js", "conditions.js", "find.js", "shapes.js", "rows.js"),
    *("eye.js", "drawing.js", "scale.js"),
)
OPENING = """
const given = JSON.parse(require("fs").readFileSync(0, "utf8"));
async function opened() { return Promise.all(given.states.map((one) => Heap.open(given.table, one))); }
opened().then((heaps) => process.stdout.write(JSON.stringify(look(heaps, given.also) ?? null)));
"""
pytestmark = pytest.mark.skipif(not NODE, reason="there is no node (Node.js): the page's scripts are not run")


def run(code: str, arrays: Iterable[MainArray] = (), also: Any = None) -> Any:
    """What `code`, the body of a function of the heaps of `arrays` and of `also`, returns in Node.js."""
    arrays = list(arrays)
    states = [state(array, "test", [], LIMIT) for array in arrays]
    data = {"table": tables({one.scheme.ratio for one in arrays}), "states": states, "also": also}
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "program.cjs"
        program.write_text(f"{script(FREE)}\nfunction look(heaps, also) {{{code}}}\n{OPENING}")
        done = subprocess.run(
            [NODE, str(program)], input=json.dumps(data), capture_output=True, text=True, timeout=60
        )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@cache
def kinds(build: str = "i32r64") -> Model:
    """Groups of every kind; not to be changed."""
    return every_kind(build)


def damaged(array: MainArray, rng: np.random.Generator) -> MainArray:
    """A copy with some words changed, pointers above all."""
    array, used = array.copy(), int(array.h.ci[g.MFREE]) - 1
    for _ in range(int(rng.integers(1, 60))):
        array.h.ia[int(rng.integers(used))] = rng.choice([0, 1, -1, int(rng.integers(used)), 32767])
    return array


# ---- values

VALUES = """
const heap = heaps[0];
const shown = (word) => [word.name, word.first, exact(heap.value(word), heap.state.reals)];
const group = (address) => [address, heap.words(heap.spanOf(address)).map(shown)];
return Object.fromEntries(Object.keys(heap.table.kinds).map((kind) => [kind, heap.groups[kind].map(group)]));
"""


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_values_are_those_of_the_tables(build: str) -> None:
    """Every field of every group: what is shown is the value, to the last digit."""
    m = kinds(build)
    real = m.array.scheme.real_type.type
    found = run(VALUES, [m.array])
    for group in GROUPS:
        rows = {int(row["address"]): row for row in m.table(group.name)}
        assert [address for address, _ in found[group.name]] == sorted(rows)
        for address, words in found[group.name]:
            values = [
                (field, value) for field in group.fields for value in np.atleast_1d(rows[address][field.name])
            ]
            for (_, _, text), (field, value) in zip(words, values, strict=True):
                assert (real(text) if field.real else int(text)) == value
                assert (len(text) < 16 or not field.real) if real is np.float32 else True


def test_integers_of_64_bits_are_exact() -> None:
    m = every_kind("i64r64")
    numbers = [2**62 + 1, -(2**63), 2**53 + 1]
    m.array.h.ia[:3] = numbers
    assert run("return [1, 2, 3].map((k) => exact(heaps[0].ints[k - 1]))", [m.array]) == [*map(str, numbers)]


def test_reals_are_shown_exactly() -> None:
    """Numbers of all sizes, random ones by their bits: the text gives the same again, and is the shortest."""
    code = """
    const number = (bytes) => new Float64Array(Uint8Array.from(bytes).buffer)[0];
    return also.map((part, k) => part.map((bytes) => exact(number(bytes), k ? 64 : 32)));
    """
    rng, few = np.random.default_rng(1), [0.0, -0.0, 1.0, -1.0, 0.1, 1e8, 1e22, np.inf, -np.inf, np.nan]
    narrow = np.concatenate([np.float32(few), rng.integers(0, 2**32, 2000, np.uint32).view(np.float32)])
    wide = np.concatenate([few, rng.integers(0, 2**64, 2000, np.uint64).view(np.float64)])
    sent = [[[*np.float64(number).tobytes()] for number in part] for part in (narrow, wide)]
    for text, numbers in zip(run(code, also=sent), (narrow, wide), strict=True):
        back = np.array(text).astype(numbers.dtype)
        assert np.array_equal(back, numbers, equal_nan=True)
        known = ~np.isnan(numbers)
        assert np.array_equal(np.signbit(back[known]), np.signbit(numbers[known]))
        for shown, number in zip(text, numbers, strict=True):
            if np.isfinite(number) and number != int(number):
                assert digits(shown) <= digits(str(number))


def digits(text: str) -> int:
    """How many digits of a number count."""
    return len(text.lower().partition("e")[0].replace(".", "").lstrip("-0").rstrip("0"))


# ---- names, meanings and pointers: what `udec what` and `udec who` say

LOOKS = """
return heaps.map((heap) => Array.from(heap.kinds, (_, span) => ({
  first: heap.first[span],
  kind: heap.kind(span),
  called: called(heap, span),
  words: heap.isGroup(span) ? heap.words(span).map((word) => meaning(heap, word, heap.kind(span))) : [],
  who: heap.isGroup(span) ? whoPoints(heap, span).map((one) => [one.first, one.name]) : [],
})));
"""


def compare(array: MainArray, spans: Any, every: int) -> None:
    """What the scripts say of each span against the tools; of each `every`th, who points there."""
    atlas = Atlas(array.h)
    expected = [*atlas.spans()]
    assert [(one["first"], one["kind"]) for one in spans] == [(span.first, span.kind) for span in expected]
    for k, (one, span) in enumerate(zip(spans, expected, strict=True)):
        if span.kind in (*KINDS, JUNK):
            assert one["called"] == called(atlas, span)
        if span.kind not in KINDS:
            continue
        for printed, word in zip(one["words"], atlas.words(span), strict=True):
            text = meaning(atlas, span, word)
            assert printed["text"] == text
            broken = IS_NO in text or text.startswith(NOT_ALLOWED) or text == "no head code of its kind"
            assert printed["sound"] is not broken
        if k % every == 0:
            rows = who(atlas, span.first).rows
            assert one["who"] == [[0 if row[1] == "common block" else row[0], row[2]] for row in rows]


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_the_page_says_what_the_restart_file_tools_say(build: str) -> None:
    m = kinds(build)
    (spans,) = run(LOOKS, [m.array])
    compare(m.array, spans, 7)


@pytest.mark.parametrize("build", ["i16r64", "i64r64"])
def test_and_of_a_damaged_heap_too(build: str) -> None:
    """Whatever the words say, all looks come to an end."""
    m, rng = kinds(build), np.random.default_rng(3)
    arrays = [damaged(m.array, rng) for _ in range(3)]
    for array, spans in zip(
        arrays, run(f"heaps.forEach((heap) => new Shapes(heap)); {LOOKS}", arrays), strict=True
    ):
        compare(array, spans, 40)


def test_what_belongs_to_a_block() -> None:
    m = kinds()
    found = run(
        "const [heap] = heaps;"
        "return heap.groups.block.map((at) => belongings(heap, heap.spanOf(at)).map((k) => heap.first[k]))",
        [m.array],
    )
    atlas = Atlas(m.array.h)
    spans = [span for span in atlas.spans() if span.kind in KINDS and span.kind != "block"]
    for block, mine in zip(sorted(m.table("block")["address"].tolist()), found, strict=True):
        assert sorted(mine) == [span.first for span in spans if block in atlas.owners(span)]


def test_changes() -> None:
    m = every_kind()
    before = m.array.copy()
    m.array.h.ia[[10, 99]] += 1
    code = """
    const [before, heap] = heaps;
    const range = Array.from({ length: heap.state.shown }, (_, k) => k + 1);
    const word = heap.words(heap.spanOf(1)).find((one) => one.first <= 11 && one.last >= 11);
    return [range.filter((at) => changed(heap, before, at, at)), former(heap, before, heap.spanOf(1), word),
      comparable(heap, before) === before, comparable(heap, null)];
    """
    assert run(code, [before, m.array]) == [[11, 100], m.table("block")["KYD"][-1], True, None]
    assert run("return comparable(heaps[0], heaps[1])", [m.array, kinds("i32r32").array]) is None


# ---- the search


def test_the_search() -> None:
    m = kinds()
    block = int(m.table("block")["address"][1])
    code = """
    return also.map((query) => {
      const found = find(heaps[0], query);
      return { ...found, list: found.list && [found.list.kind, found.list.words.map((word) => word.name)] };
    });
    """
    queries = [
        "412",
        f" block@{block} ",
        f"corner@{block}",
        "kxd",
        "KZG",
        "kzg(2)",
        "Contact",
        "dtol",
        "akn(1)",
    ]
    queries += ["0", "99999999", "nothing", "block@x", "", "HEAD", "__proto__", "constructor"]
    found = dict(zip(queries, run(code, [m.array], queries), strict=True))
    assert found["412"] == {"go": 412, "note": ""}
    assert found[f" block@{block} "]["go"] == block
    assert found[f"corner@{block}"] == {
        "go": block,
        "note": f"no corner begins at {block}: it is block@{block}",
    }
    assert found["kxd"]["list"] == ["block", ["KXD"]]
    assert found["KZG"]["list"] == ["zone", ["KZG(1)", "KZG(2)", "KZG(3)"]]
    assert found["kzg(2)"]["list"] == ["zone", ["KZG(2)"]]
    assert found["Contact"]["list"] == ["contact", []]
    assert (found["dtol"]["common"], found["akn(1)"]["common"]) == ("DTOL", "AKN(1)")
    for query in queries[9:]:
        assert {*found[query]} == {"note"}, query


@pytest.mark.parametrize("build", ["i32r64", "i64r64"])
def test_lists_in_order(build: str) -> None:
    m = every_kind(build)
    first = int(m.table("block")["address"][0])
    m.array.h.ra[(first - 1) // m.array.scheme.ratio + g.KYD[m.array.scheme.ratio.bit_length() - 1] - 1] = (
        np.nan
    )
    code = """
    return also.map(([query, column, falling]) => rows(heaps[0], find(heaps[0], query).list, column, falling)
      .map(({ address, values }) => [address, ...values.map(String)]));
    """
    fields = [("KY", "block"), ("KYD", "block"), ("KR", "corner"), ("KCFN", "contact")]
    orders = [(name, kind, falling) for name, kind in fields for falling in (False, True)]
    *lists, last = run(
        code, [m.array], [*((name, 1, falling) for name, _, falling in orders), ("KY", 0, True)]
    )
    for (name, kind, falling), found in zip(orders, lists, strict=True):
        table = m.table(kind)
        numbers = [float(text) for _, text in found]
        good = [number for number in numbers if number == number]
        assert good == sorted(table[name][~np.isnan(table[name].astype(float))].tolist(), reverse=falling)
        assert all(number != number for number in numbers[len(good) :])
        assert {at for at, _ in found} == {*table["address"].tolist()}
    assert [at for at, _ in last] == sorted(m.table("block")["address"].tolist(), reverse=True)


# ---- shapes


@pytest.fixture(scope="module")
def rubble() -> Model:
    """Slanting cuts, a hole, a block that hangs on a virtual contact, all set in motion."""
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.4)
    m.block(0, 0, 0, 6, 8, 6, 8, 0)
    for cut in ((-1, 2, 9, 1.5), (-1, 4, 9, 4.2), (2, -1, 2.5, 7), (5, -1, 5.6, 7), (0, 2.5, 2.2, 3.5)):
        m.split(*cut)
    m.round(0.1)
    m.fix(0, 8, 0, 1.6)
    m.delete(3, 5, 2, 4)
    m.gravity(0, -10)
    m.cycle(300)
    return m


def test_outlines(rubble: Model) -> None:
    code = """
    const shapes = new Shapes(heaps[0]);
    const host = heaps[0].reader("corner", "KNB");
    return [shapes.of("block").map((one) => [one.address, outline(one), one.whole]),
      shapes.of("domain").map((one) => one.whole), shapes.bounds,
      shapes.of("corner").map((one) => [host(one.address), one.x, one.y, one.px, one.py])];
    """
    found, whole, bounds, corners = run(code, [rubble.array])
    assert {address for address, _, _ in found} == {*blocks(rubble)}
    assert whole == [True] * len(rubble.table("domain"))
    d = float(rubble.h.cr[g.DTOL])
    for address, points, closed in found:
        expected = rounded_polygon(outline(rubble, address), d)
        chords = 0.006 * d  # between an arc and its eighths
        assert closed
        assert Polygon(points).hausdorff_distance(expected) < chords
    rocks = {ib: rounded_polygon(outline(rubble, ib), d) for ib in blocks(rubble)}
    for block, x, y, px, py in corners:  # in the middle of the arc, as near to the corner as may be
        assert rocks[block].exterior.distance(Point(x, y)) < 1e-4 * d
        assert np.hypot(x - px, y - py) == pytest.approx(rocks[block].distance(Point(px, py)), rel=1e-3)
    xs, ys = (rubble.table("corner")[name] for name in ("KXP", "KYP"))
    assert bounds == [xs.min(), ys.min(), xs.max(), ys.max()]


def test_what_lies_at_a_place(rubble: Model) -> None:
    """Blocks against naive polygons, domains against those that PLOT draws."""
    rng, d = np.random.default_rng(1), float(rubble.h.cr[g.DTOL])
    rocks = {ib: rounded_polygon(outline(rubble, ib), d) for ib in blocks(rubble)}
    spaces = {
        one.address: (Polygon(one.polygon).buffer(0), one.outer) for one in domain_polygons(rubble.array.h)
    }
    places = [tuple(place) for place in rng.uniform((-1, -1), (9, 7), (400, 2)).tolist()]
    places = [
        place
        for place in places
        if min(rock.exterior.distance(Point(place)) for rock in rocks.values()) > 0.02
    ]
    code = """
    const shapes = new Shapes(heaps[0]);
    return also.map(([x, y]) => shapes.lyingAt(x, y, 0).map((one) => one.address));
    """
    inside = set()
    for place, there in zip(places, run(code, [rubble.array], places), strict=True):
        expected = [ib for ib, rock in rocks.items() if rock.contains(Point(place))]
        if not expected:
            expected = [at for at, (space, outer) in spaces.items() if space.contains(Point(place)) != outer]
        assert there == expected
        inside |= {*expected}
    assert len(inside & rocks.keys()) == len(rocks)
    assert len(inside - rocks.keys()) > 1


def test_points_come_before_areas() -> None:
    m = kinds()
    code = """
    const shapes = new Shapes(heaps[0]);
    return also.map((kind) => shapes.of(kind).map((one) => {
      const points = one.points ?? [[one.x, one.y]];
      const [x, y] = [0, 1].map((k) => points.reduce((sum, point) => sum + point[k], 0) / points.length);
      return shapes.lyingAt(x, y, 1e-6).map((there) => there.kind);
    }));
    """
    points, zones = run(code, [m.array], ["contact", "zone"])
    assert all(there[0] == "contact" for there in points)
    assert all(there == ["block", "zone"] for there in zones)


def test_what_stands_for_a_group_without_a_place() -> None:
    m = kinds()
    code = """
    const shapes = new Shapes(heaps[0]);
    return Array.from(heaps[0].kinds, (_, span) => [heaps[0].kind(span), heaps[0].first[span],
      shapes.standFor(span).map((one) => `${one.kind}@${one.address}`)]);
    """
    found = run(code, [m.array])
    bounds = {int(row["address"]): row for row in m.table("bound")}
    watched = {int(row["address"]): int(row["KHG"]) for row in m.table("history")}
    for kind, address, stands in found:
        if kind == "bound":
            row = bounds[address]
            names = {"KUG": "gridpoint", "KUP": "corner"}
            points = {f"{name}@{row[field]}" for field, name in names.items() if row[field]}
            ends = {f"corner@{row['KUQ']}"} if row["KUQ"] else set()
            assert {*stands} == (points | ends or {f"block@{row['KUB']}"})
        elif kind in ("sdef", "fdef"):
            assert [one.partition("@")[0] for one in stands] == ["block"]
        elif kind == "history":
            assert len(stands) == (watched[address] != 0)
        elif kind in ("summand", "member", "breakable"):
            assert [one.partition("@")[0] for one in stands] == ["block"]
        elif kind in ("bolt", "node"):  # the blocks at its ends
            assert {one.partition("@")[0] for one in stands} <= {"block", "zone"}
        elif kind in ("block", "corner", "contact", "domain", "zone", "gridpoint"):
            assert stands == [f"{kind}@{address}"]
        else:
            assert stands == []


def test_nothing_and_one_block() -> None:
    m = Model()
    code = """
    const shapes = new Shapes(heaps[0]);
    return [shapes.bounds, ...[0.5, 5].map((x) => shapes.lyingAt(x, x, 0.1).map((one) => one.kind))];
    """
    assert run(code, [m.array]) == [[0, 0, 1, 1], [], []]
    m.block(0, 0, 0, 2, 1, 2, 1, 0)
    assert run(code, [m.array]) == [[0, 0, 1, 2], ["block"], ["domain"]]


# ---- rows of the heap map


def test_every_word_has_its_place_in_the_rows() -> None:
    m = kinds()
    code = """
    const heap = heaps[0];
    return WIDTHS.map((perRow) => {
      const rows = new Rows(heap, perRow, 50, 400);
      const words = Array.from({ length: Math.min(rows.last, heap.state.top) }, (_, k) => k + 1);
      const lost = words.filter((at) => {
        const [{ x, y, width }, ...more] = rows.pieces(at, at);
        return more.length || rows.addressAt(x + width / 2, y + 1) !== at;
      });
      const cells = Array.from(heap.kinds, (_, k) => rows.pieces(heap.first[k], heap.first[k + 1] - 1));
      const wide = cells.flat().reduce((sum, piece) => sum + piece.width, 0) / (400 / perRow);
      const aside = [49, 451].map((x) => rows.addressAt(x, 1));
      return [lost.length, Math.round(wide), words.length, rows.last >= heap.state.shown, ...aside];
    });
    """
    for lost, wide, words, all_used, left, right in run(code, [m.array]):
        assert (lost, wide, all_used, left, right) == (0, words, True, 0, 0)
    fits = """
    return [30, 400, 5000].map((high) => {
      const rows = new Rows(heaps[0], fitting(heaps[0], 50, 400, high), 50, 400);
      return [rows.perRow, rows.count * rows.high];
    });
    """
    (many, low), (_, middle), (wide, high) = run(fits, [m.array])
    used = -(-(int(m.h.ci[g.MFREE]) - 1) // 500)  # rows, with two more of unused words
    assert (many, low) == (500, (used + 2) * 6)  # they are not made smaller than can be read
    assert middle <= 400
    assert (wide, high <= 5000) == (30, True)
