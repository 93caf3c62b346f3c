"""What the checker goes through: compiled, interpreted, and as slow obvious implementations have it."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Point, Polygon
from support import random_deformable_scenes as soft_scenes
from support import random_scenes as scenes

from udec_ia import Model
from udec_ia.checker import check
from udec_ia.checker.block_outlines import outlines
from udec_ia.checker.checked_state import State
from udec_ia.checker.memory_words import gaps
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall, interpreted
from udec_ia.heap import untrusted_lists
from udec_ia.kernels.audit import domain_faces
from udec_ia.kernels.audit.outline_arrays import in_polygon, in_rounded
from udec_ia.layout import offsets as g

RATIO, STEP, SIZE = 2, 1, 4
WORDS = np.int32


def both(kernel: Any, *args: Any) -> tuple[Any, list[Any]]:
    """What a kernel returns, and its arguments afterwards; the same from both of its forms."""
    forms = []
    for python in (True, False):
        given_args = [one.copy() if isinstance(one, np.ndarray) else one for one in args]
        if python:
            with interpreted():
                result = kernel(*given_args)
        else:
            result = kernel(*given_args)
        forms.append((result, given_args))
    (one, first), (two, second) = forms
    assert one == two
    for a, b in zip(first, second, strict=True):
        assert not isinstance(a, np.ndarray) or (a == b).all()
    return one, second


@given(st.lists(st.integers(-3, 44), min_size=44, max_size=44), st.lists(st.integers(-2, 46), max_size=4))
def test_lists_are_followed_as_far_as_they_can_be(links: list[int], firsts: list[int]) -> None:
    """Whatever the words say, and circles until there is no more room."""
    words, last, room = np.array(links, WORDS), len(links) - SIZE + 1, 23
    expected, lengths = list[int](), list[int]()
    for iad in firsts:
        before = len(expected)
        while iad and len(expected) < room:
            there = 1 <= iad <= last and iad % RATIO == 1
            expected.append(iad if there else 0)
            iad = links[iad + STEP] if there else 0
        lengths.append(len(expected) - before)
    n, after = both(
        untrusted_lists.chains,
        words,
        np.array(firsts, np.int64),
        STEP,
        last,
        RATIO,
        np.zeros(room, np.int64),
        np.zeros(len(firsts), np.int64),
    )
    assert after[-2][:n].tolist() == expected
    assert after[-1].tolist() == lengths


@given(st.permutations(range(9)), st.sets(st.integers(0, 8)))
def test_cycles_of_a_permutation(order: list[int], nowhere: set[int]) -> None:
    """What leads nowhere, the last place, is in no cycle; nor is what leads there."""
    following = np.array([9 if k in nowhere else to for k, to in enumerate(order)] + [9])
    _, (_, smallest) = both(domain_faces.label_cycles, following, np.zeros(10, np.int64))
    for start in range(9):
        walk, k = [start], int(following[start])
        while k not in walk and k != 9:
            walk.append(k)
            k = int(following[k])
        assert smallest[start] == (min(walk) if k == start else -1)


@given(st.lists(st.tuples(st.integers(-1, 11), st.integers(-1, 11)), max_size=14))
def test_pieces_hang_together(joined: list[tuple[int, int]]) -> None:
    expected = list(range(12))
    for _ in range(12):
        for a, b in joined:
            if a >= 0 and b >= 0:
                expected[a] = expected[b] = min(expected[a], expected[b])
    pairs = np.array(joined, np.int32).reshape(-1, 2)
    _, after = both(domain_faces.label_pieces, pairs[:, 0].copy(), pairs[:, 1].copy(), np.zeros(12, np.int32))
    assert after[-1].tolist() == expected


@given(st.lists(st.tuples(st.integers(0, 3), st.integers(1, 5)), max_size=12), st.integers(0, 3))
def test_gaps_between_groups(laid: list[tuple[int, int]], rest: int) -> None:
    """Of groups of two sizes, which may overlap."""
    free = 1 + RATIO * (sum(gap + of // 2 + 2 for gap, of in laid) + rest)
    groups, place = list[tuple[int, int]](), 0
    for gap, of in laid:
        place += gap
        iad = place * RATIO + 1
        groups.append((iad, SIZE if of % 2 else 2 * of))
        place += of // 2 + 1
    before, end, expected = 0, 1, []
    for iad, size in [*groups, (free, 0)]:
        if iad != end:
            expected.append([before, end, iad])
        before, end = iad, iad + size
    starts, sizes = np.array(groups, np.int64).reshape(-1, 2).T
    assert gaps(starts, sizes, free).tolist() == expected


@settings(max_examples=30)
@given(st.integers(3, 9), st.floats(0.5, 3.0), st.integers(0, 999))
def test_what_lies_in_an_outline(corners: int, stretch: float, seed: int) -> None:
    """Of a star-shaped block, by shapely, at places that are not near its edges."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, corners))[::-1]
    turns = -np.diff(np.append(angles, angles[0] - 2 * np.pi))
    if turns.min() < 0.2 or turns.max() > 3:  # too sharp a corner; or the origin is outside
        return
    ring = rng.uniform(2, 4, corners)[:, None] * np.column_stack((stretch * np.cos(angles), np.sin(angles)))
    model = Model()
    model.block(*ring.ravel())
    model.round(0.05)
    with np.errstate(all="ignore"):
        o = outlines(State(model.array))
    assert o is not None
    polygon = Polygon(ring)
    for x, y in rng.uniform(-5, 5, (40, 2)) * (stretch, 1):
        if polygon.exterior.distance(Point(x, y)) > 0.06:  # more than a tip is long
            inside = bool(polygon.contains(Point(x, y)))
            for kernel in (in_polygon, in_rounded):
                assert both(kernel, o, 0, float(x), float(y))[0] == inside


@pytest.mark.parametrize(
    ("along", "closes"),
    [
        ((11, 15, 19, 11), True),
        ((11, 11), True),
        ((11, 15, 19, 15), False),  # a circle beside the first corner
        ((11, 15, 15), False),
        ((11, 15, 18), False),  # between reals
        ((11, 15, 35), False),  # no corner there
        ((11, 15, 0), False),
        ((11, 15, 999), False),
        ((0,), False),
    ],
)
def test_lists_around_blocks_close_or_are_left(along: tuple[int, ...], closes: bool) -> None:
    """Corners of four words, whose second leads to the next; a block at 1 leads to the first of them."""
    words = np.zeros(40, WORDS)
    words[1 + STEP] = along[0]
    for iad, to in pairwise(along):
        words[iad - 1], words[iad + STEP] = g.MCOR, to
    limits, steps = (36, 36, RATIO), (STEP, STEP, 2, 3, 2, 3)
    room = np.zeros(18, np.int32), np.zeros(18, np.int64), np.zeros(1, bool)
    n, after = both(untrusted_lists.closed_lists, words, np.array([1]), limits, steps, *room)
    assert after[-1].tolist() == [closes]
    assert after[-2][:n].tolist() == (list(along[:-1]) if closes else [])


@pytest.mark.parametrize("module", [scenes, soft_scenes], ids=["rigid", "soft"])
@pytest.mark.parametrize("build", ["i32r64", "i16r32"])
def test_the_checker_says_the_same_in_both_forms(
    build: str, module: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of states in which a few words or reals are wrong, whatever these are."""
    monkeypatch.setattr(InterpretWhenSmall, "always_compiled", True)
    array = module.play(3, Model(build), cycles=(2, 8)).model.array
    random, h, kept = np.random.default_rng(2), array.h, array.h.ia.copy()
    top, told = int(h.ci[g.MFREE]) - 1, 0
    for trial in range(60):
        h.ia[:] = kept
        words, many = (h.ra, top // array.scheme.ratio) if trial % 3 else (h.ia, top)
        at = random.integers(0, many, random.integers(1, 5))
        some = [0, -1, top] if words is h.ia else [0, -1, np.nan, np.inf, 1e-3]
        words[at] = words[random.integers(0, many, len(at))] if trial % 2 else random.choice(some, len(at))
        found = [str(violation) for violation in check(array)]
        with interpreted():
            assert found == [str(violation) for violation in check(array)]
        told += bool(found)
    assert told > 30
