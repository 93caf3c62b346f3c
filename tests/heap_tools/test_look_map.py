"""udec map and udec graph: against counts and walks by hand; and what their pictures show."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_hex
from naive.names import names as naive_names
from PIL import Image
from support.every_group_kind import GROUPS, every_kind
from support.mechanics_scenes import box, model

from udec_ia import Model
from udec_ia.heap.accessors import puti, putr
from udec_ia.heap_tools.memory_use import ACROSS, DOWN, FINE, cover, heap_map, stretch
from udec_ia.heap_tools.pointer_graph import NODES, dot, graph, neighbourhood
from udec_ia.layout import offsets as g
from udec_ia.output import heap_picture
from udec_ia.output.drawn_outlines import outlines
from udec_ia.output.heap_picture import outlines_left
from udec_ia.reader.kind_colours import COLOURS, LETTERS
from udec_ia.reader.word_map import NAMES, UNUSED, Atlas

BUILDS = ["i16r32", "i32r64"]


@pytest.fixture(scope="module", params=BUILDS)
def scene(request: pytest.FixtureRequest) -> Model:
    """Groups of every kind, and some junk."""
    return every_kind(request.param)


# ---- the map


def test_a_stretch_belongs_to_the_largest_share(scene: Model) -> None:
    atlas = Atlas(scene.array.h)
    kinds = [
        span.kind for span in atlas.spans() if span.kind != UNUSED for _ in range(span.first, span.last + 1)
    ]
    for step in (1, 2, 7, 50, 10**6):
        found = [NAMES[number] for number in cover(atlas, step)]
        parts = [Counter(kinds[k : k + step]) for k in range(0, len(kinds), step)]
        assert len(found) == len(parts)
        assert all(part[kind] == max(part.values()) for kind, part in zip(found, parts, strict=True))


def test_stretches_are_round_and_as_small_as_can_be(scene: Model) -> None:
    atlas = Atlas(scene.array.h)
    steps = [k * 10**n for n in range(8) for k in (1, 2, 5)]
    for places in (1, 3, 10, 100, 1000, 10**5):
        assert stretch(atlas, places) == next(step for step in steps if step * places >= atlas.free - 1)


def pictured(m: Model) -> tuple[int, str, set[int]]:
    """Words of a character, the map in one line, and the characters in which groups begin."""
    atlas, listing = Atlas(m.array.h), heap_map(Atlas(m.array.h))
    assert max(map(len, listing.as_text().splitlines())) <= 80
    assert len(listing.rows) <= DOWN
    step = stretch(atlas, ACROSS * DOWN)
    letters = "".join(row[1] for row in listing.rows)
    assert [row[0] for row in listing.rows] == [k * step + 1 for k in range(0, len(letters), ACROSS)]
    return step, letters, {(span.first - 1) // step for span in atlas.spans() if span.kind != UNUSED}


def test_the_map_fits_and_has_every_large_kind(scene: Model) -> None:
    step, letters, _ = pictured(scene)
    assert step > FINE
    assert letters.islower() or "-" in letters
    key = " ".join(heap_map(Atlas(scene.array.h)).head[1:])
    kinds = ("block", "corner", "contact", "joint", "junk", "zone")
    assert all(f"{LETTERS[kind]} {kind}" in key for kind in kinds)


@pytest.mark.parametrize("build", BUILDS)
@pytest.mark.parametrize("kn", [None, 1e9])
def test_a_fine_map_shows_where_groups_begin(build: str, kn: float | None) -> None:
    """Also groups that lie behind others, in scenes with joint materials."""
    m = model(*box(0, 2, 0, 1), d=0.05, build=build)
    if kn:
        m.jproperty(1, kn=kn, ks=kn)
    m.split(1, -1, 1, 2)
    m.split(-1, 0.5, 3, 0.5)
    m.delete(1, 2, 0.5, 1)
    step, letters, begins = pictured(m)
    assert step <= FINE
    assert {k for k, letter in enumerate(letters) if letter.isupper() or letter == "-"} >= begins
    assert not any(letter.isupper() for k, letter in enumerate(letters) if k not in begins)
    assert all((LETTERS[kind].upper() in letters) == bool(kn) for kind in ("joint", "edge"))


def test_kinds_can_be_told_apart() -> None:
    assert len({*LETTERS.values()}) == len(LETTERS) == len(NAMES)
    assert len({*COLOURS.values()}) == len(COLOURS) == len(NAMES)


def test_an_empty_heap_has_a_map(tmp_path: Path) -> None:
    model = Model()
    assert heap_map(Atlas(model.array.h)).rows == []
    heap_picture.draw(model.array, tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 0


def test_the_picture_has_the_colours_of_the_words(scene: Model, tmp_path: Path) -> None:
    """In the middle of each cell, and of each block."""
    figure = heap_picture.figure(scene.array, "x")
    rock, page = figure.axes
    (image,) = page.get_images()
    cells = image.get_array()
    words = [span.kind for span in Atlas(scene.array.h).spans() for _ in range(span.first, span.last + 1)]
    used = int(scene.h.ci[g.MFREE]) - 1
    assert [NAMES[number] for number in cells.ravel()[:used]] == words[:used]
    assert [to_hex(image.cmap(image.norm(NAMES.index(kind)))) for kind in NAMES] == [
        COLOURS[kind] for kind in NAMES
    ]
    heap_picture.draw(scene.array, tmp_path / "map.png", "x")
    pixels = np.asarray(Image.open(tmp_path / "map.png").convert("RGB"))
    dots = {kind: len(scene.table(kind)) for kind in ("corner", "contact", "gridpoint")}
    shown = {
        to_hex(line.get_color()): len(line.get_xdata()) for line in rock.lines if line.get_marker() == "o"
    }
    assert shown == {COLOURS[kind]: many for kind, many in dots.items()}
    for kind in ("corner", "contact", "domain", "bound", "junk"):
        colour = [int(COLOURS[kind][k : k + 2], 16) for k in (1, 3, 5)]
        assert (pixels == colour).all(axis=-1).sum() > 100, kind


def test_what_is_left_of_the_blocks_is_drawn() -> None:
    m = every_kind()
    h, blocks = m.array.h, m.table("block")["address"]
    whole, none = outlines_left(Atlas(h))
    every = outlines(h)
    assert none == 0
    order = np.argsort(every.address)
    assert np.array_equal(whole.address, every.address[order])
    assert np.array_equal(whole.centroid, every.centroid[order])
    assert len(whole.corner) == len(every.corner)
    puti(h, int(blocks[1]), g.KP, 3)
    left, gone = outlines_left(Atlas(h))
    assert gone == 1
    assert {*left.address.tolist()} == {*blocks.tolist()} - {int(blocks[1])}


# ---- the graph


def edges_by_hand(m: Model) -> set[tuple[int, str, int]]:
    """Every pointer of every group, by the tables."""
    found = set()
    for group in GROUPS:
        for row in m.table(group.name):
            for field in group.fields:
                for k, to in enumerate(np.atleast_1d(row[field.name]).tolist()):
                    if field.target and to:
                        found.add(
                            (int(row["address"]), field.name + (f"({k + 1})" if field.count > 1 else ""), to)
                        )
    return found


def near_by_hand(edges: set[tuple[int, str, int]], start: int, depth: int) -> dict[int, int]:
    found, wave = {start: 0}, {start}
    for away in range(1, depth + 1):
        ahead = {b for a, _, b in edges if a in wave} | {a for a, _, b in edges if b in wave}
        wave = ahead - {*found}
        found |= dict.fromkeys(wave, away)
    return found


def test_what_is_near_and_what_lies_between(scene: Model) -> None:
    atlas, edges, called = Atlas(scene.array.h), edges_by_hand(scene), naive_names(scene)
    for group in GROUPS:
        start = int(scene.table(group.name)["address"][-1])
        for depth in (1, 2):
            wanted = near_by_hand(edges, start, depth)
            found = neighbourhood(atlas, start, depth, limit=10**6)
            groups = {iad: node.depth for iad, node in found.nodes.items() if node.kind in NAMES}
            assert groups == wanted
            assert all(found.nodes[iad].name == called[iad] for iad in groups)
            between = {(a, name, b) for a, name, b in edges if a in wanted and b in wanted}
            assert {edge[:3] for edge in found.edges if edge.source} == between
            assert all(edge.sound for edge in found.edges)
            assert found.left_out == 0


def test_a_graph_is_bounded_and_says_so(scene: Model) -> None:
    atlas, edges = Atlas(scene.array.h), edges_by_hand(scene)
    block = int(scene.table("block")["address"][1])
    found = neighbourhood(atlas, block, 9)
    groups = [node for node in found.nodes.values() if node.kind in NAMES]
    assert len(groups) == NODES
    furthest = max(node.depth for node in groups)
    all_as_near = near_by_hand(edges, block, furthest)
    assert found.left_out == len(all_as_near) - NODES
    listing = graph(atlas, block, 9)
    assert listing.head[1].startswith(
        f"left out: {found.left_out} more groups at a distance of {furthest} pointers, "
    )
    assert listing.head[1] in dot(found)
    assert len(listing.rows) == len(found.edges)


def test_pointers_astray_are_shown() -> None:
    m = every_kind()
    block = int(m.table("block")["address"][0])
    puti(m.array.h, block, g.KB, 99999)
    puti(m.array.h, block, g.KBB, int(m.table("domain")["address"][0]))
    atlas = Atlas(m.array.h)
    rows = {row[1]: row[2] for row in graph(atlas, block).rows if row[0] == f"block@{block}"}
    assert rows["KB"] == "outside IA(), no block"
    assert rows["KBB"].endswith(", no block")
    text = dot(neighbourhood(atlas, block))
    assert f'"{block}" -> "99999" [label="KB", color=' in text


def test_dot_is_dot(scene: Model) -> None:
    found = neighbourhood(Atlas(scene.array.h), int(scene.table("contact")["address"][0]), 2)
    lines = dot(found).splitlines()
    assert (lines[0], lines[-1]) == ("digraph heap {", "}")
    nodes = {int(line.split('"')[1]) for line in lines if re.match(r'  "\d+" \[label="', line)}
    assert nodes == {*found.nodes}
    arrows = [re.match(r'  "(\d+)" -> "(\d+)" \[label="([^"]+)"\];$', line) for line in lines]
    assert Counter((int(one[1]), one[3], int(one[2])) for one in arrows if one) == Counter(
        edge[:3] for edge in found.edges
    )


# ---- files


def test_pictures_are_files_of_their_type(scene: Model, tmp_path: Path) -> None:
    for name, begins in (("a.png", b"\x89PNG"), ("a.svg", b"<?xml"), ("A.PNG", b"\x89PNG")):
        listing = heap_picture.draw(scene.array, tmp_path / name)
        assert f"wrote {tmp_path / name}" in listing.head
        assert (tmp_path / name).read_bytes().startswith(begins)
    with pytest.raises(ValueError, match=r"a.dot: the name of a picture ends in .png or .svg"):
        heap_picture.draw(scene.array, tmp_path / "a.dot")


@pytest.mark.parametrize("centre", [1e9, 1e15, -1e25])
def test_arcs_far_away_can_be_drawn(scene: Model, tmp_path: Path, centre: float) -> None:
    """A damaged state may have the centre of an arc anywhere."""
    array = scene.array.copy()
    for ip in scene.table("corner")["address"].tolist():
        putr(array.h, ip, g.KXCP, centre)
    heap_picture.draw(array, tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 1000
