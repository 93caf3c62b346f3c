"""What is counted is what the lists hold; in a damaged heap, what a walk from pointer to pointer finds."""

from __future__ import annotations

import re
from collections import Counter
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from naive import census as naive
from support import random_deformable_scenes as soft_scenes
from support import random_scenes as scenes

from udec_ia import Model
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.heap.accessors import puti
from udec_ia.heap.group_census import census
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import Unsound

BUILDS = list(ALL_SCHEMES)


def played(build: str, module: Any, seed: int) -> Model:
    m: Model = module.play(seed, Model(build), cycles=(2, 8)).model
    m.history(2, "KX", at=(0, 0))
    return m


def listed(found: dict[str, Any]) -> dict[str, list[int]]:
    return {kind: addresses.tolist() for kind, addresses in found.items()}


@pytest.mark.parametrize("module", [scenes, soft_scenes], ids=["rigid", "soft"])
@pytest.mark.parametrize("build", BUILDS)
def test_it_finds_what_the_lists_hold(build: str, module: Any) -> None:
    for seed in range(3):
        m = played(build, module, seed)
        found = listed(census(m.array.h))
        assert found == {kind: sorted(m.table(kind)["address"].tolist()) for kind in found}
        assert found == naive.census(m.array)


@pytest.mark.parametrize("build", BUILDS)
def test_in_a_damaged_heap_it_finds_what_a_walk_finds(build: str) -> None:
    """Where words lead to two kinds of group at one address, the order of the walk may decide."""
    rng = np.random.default_rng(5)
    compared = 0
    sound = [played(build, soft_scenes, seed).array for seed in range(3)]
    for trial in range(60):
        array = sound[trial % 3].copy()
        h, last = array.h, int(array.h.ci[g.MFREE]) - 1
        where = rng.integers(0, last, rng.integers(1, 9))
        h.ia[where] = rng.choice(
            [0, -1, 1, last, last + 5, np.iinfo(h.ia.dtype).max, int(rng.integers(last))]
        )
        found = listed(census(h))
        counts = Counter(iad for addresses in found.values() for iad in addresses)
        assert max(counts.values(), default=1) == 1
        if Counter({kind: len(one) for kind, one in found.items()}) == Counter(
            {kind: len(one) for kind, one in naive.census(array).items()}
        ):
            assert found == naive.census(array)
            compared += 1
    assert compared > 40


def test_an_array_without_heads_holds_nothing() -> None:
    m = Model()
    m.start()
    assert not any(len(addresses) for addresses in census(m.array.h).values())
    m.array.h.ci[g.MFREE] = -7
    assert not any(len(addresses) for addresses in census(m.array.h).values())


@pytest.mark.parametrize(("skipped", "printed"), [(1, " is"), (3, " and 2 more are")])
@pytest.mark.parametrize("build", BUILDS)
def test_groups_that_a_list_has_lost_are_told(build: str, skipped: int, printed: str) -> None:
    """Of a list that passes over some groups; a table would lack them."""
    m = played(build, scenes, 0)
    contacts = m.table("contact")["address"].tolist()
    lost = contacts[4 : 4 + skipped]
    puti(m.array.h, contacts[3], g.KC, contacts[4 + skipped])
    told = f"contact@{min(lost)}{printed} in no list, but pointers lead there"
    assert told in [violation.message for violation in m.check()]
    with pytest.raises(Unsound, match=re.escape(told)):
        m.table("contact")
    assert len(m.table("block")) == m.array.h.ci[g.NBLK]


@pytest.mark.parametrize("build", ["i16r32", "i32r64", "i64r64"])
def test_compiled_code_keeps_to_its_arrays(build: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the words are: it would end the process if it did not. A table is refused or whole."""
    monkeypatch.setattr(InterpretWhenSmall, "always_compiled", True)
    sound = [played(build, module, seed) for seed in (0, 3) for module in (scenes, soft_scenes)]
    random = np.random.default_rng(11)
    for trial in range(400):
        model = sound[trial % len(sound)]
        kept, top = model.array.h.ia.copy(), int(model.array.h.ci[g.MFREE]) - 1
        many = int(random.integers(1, random.choice([4, 40, 300])))
        limits = np.iinfo(kept.dtype)
        some = np.array([0, 1, -1, top, top + 1, limits.max, limits.min], kept.dtype)
        words = np.where(
            random.random(many) < 0.5, random.choice(kept[:top], many), random.choice(some, many)
        )
        model.array.h.ia[random.integers(0, top, many)] = words
        model.check()
        for kind in ("contact", "corner", "zone"):
            with suppress(Unsound):
                assert len(model.table(kind)) >= len(census(model.array.h)[kind])
        model.array.h.ia[:] = kept
