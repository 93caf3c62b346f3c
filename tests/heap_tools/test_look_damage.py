"""Every look at heaps damaged at random: it ends, in time, and says something, or that it cannot."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.every_group_kind import every_kind

from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.heap_tools.heap_dump import common, dump
from udec_ia.heap_tools.heap_lookup import walk, what, who
from udec_ia.heap_tools.heap_search import find, find_pointers, find_value
from udec_ia.heap_tools.memory_use import heap_map, junk
from udec_ia.heap_tools.pointer_graph import graph
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.output import heap_picture
from udec_ia.output.word_dump import raw
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import JUNK, KINDS, NOTHING, UNUSED, Atlas
from udec_ia.restart import look_into, save

HEADS = [getattr(g, field.name) for field in read_table().common if field.target] + [g.JUNK]
TOOL = Path(__file__).parents[2] / "tools" / "damaged_files.py"
TRIALS = 30  # in each word scheme
LOOKS = 6  # at each of them, chosen at random
SECONDS = 3.0  # of processor time, for these
SAID = re.compile(r"only groups have pointers")  # where nothing can be seen


def spoiled(sound: MainArray, rng: np.random.Generator) -> MainArray:
    """A copy with some words changed: pointers, lists, reals, heads of lists, and at times MFREE."""
    array = sound.copy()
    h, used = array.h, int(sound.h.ci[g.MFREE]) - 1
    for _ in range(int(rng.integers(1, 40))):
        at, other = int(rng.integers(used)), int(rng.integers(1, used))
        h.ia[at] = rng.choice([0, 1, -1, other, h.ia[other], 32767])
    for _ in range(int(rng.integers(0, 4))):
        h.ra[int(rng.integers(used // 4))] = rng.choice([np.nan, np.inf, -1e30, 1e-30, 1e12])
    if rng.random() < 0.3:
        h.ci[rng.choice(HEADS)] = rng.choice([0, -1, 1, int(rng.integers(used)), 10**9])
    if rng.random() < 0.2:
        h.ci[g.MFREE] = rng.choice([-7, 0, 1, used // 2, 8192, 10**12])
    if rng.random() < 0.1:
        h.cr[g.DTOL] = rng.choice([np.nan, np.inf, -1.0, 1e30])
    return array


def looks(atlas: Atlas, rng: np.random.Generator) -> Iterator[Callable[[], Listing]]:
    """All looks, at places chosen at random."""
    address = int(rng.integers(1, 2000))
    yield lambda: dump(atlas, radix=int(rng.choice([8, 10, 16])))
    yield lambda: dump(atlas, address, address + 100)
    yield lambda: raw(atlas)
    yield from (lambda look=look: look(atlas) for look in (common, junk, heap_map))
    yield from (lambda look=look: look(atlas, address) for look in (what, who, find_pointers))
    for kind in ("block", "contact", "domain", "history", "bound", "signal"):
        yield lambda kind=kind: walk(atlas, kind, field="KXD")
    for kind in ("block", "domain"):
        for iad in atlas.groups[kind][:4].tolist():
            yield lambda kind=kind, iad=iad: walk(atlas, kind, iad, "KXP", 5)
    for link in ("KR", "KG", "KZ", "KBB"):
        yield lambda link=link: walk(atlas, link, address)
    for kind in KINDS:
        yield lambda kind=kind: find(atlas, f"{kind} where address / 2 > 20")
    yield lambda: find(atlas, "contact where KCFN / KCN > 1 and not KCCOD == VIRTUAL or KD1 == KD2")
    yield lambda: find_value(atlas, float(rng.choice([0.0, 1.0, -1.0, np.nan, np.inf, 1e300])), limit=50)
    for iad in (address, *(int(rng.choice(at)) for at in atlas.groups.values() if len(at))):
        yield lambda iad=iad: graph(atlas, iad, int(rng.integers(1, 4)))


def seen(look: Callable[[], Listing]) -> bool:
    """True if there is something to see; False if a sentence says why not."""
    try:
        listing = look()
    except (ValueError, IndexError) as error:
        if SAID.search(str(error)):
            return False
        raise
    assert listing.as_text()
    assert json.loads(listing.as_json())
    return True


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_whatever_the_words_say(build: str) -> None:
    sound, rng = every_kind(build).array, np.random.default_rng(11)
    for trial in range(TRIALS):
        start = time.process_time()
        array = spoiled(sound, rng)
        atlas = Atlas(array.h)
        assert sum(span.last - span.first + 1 for span in atlas.spans()) == len(array.h.ia)
        assert {span.kind for span in atlas.spans()} <= {*KINDS, JUNK, NOTHING, UNUSED}
        some = list(looks(atlas, rng))
        for k in rng.permutation(len(some))[:LOOKS].tolist():
            seen(some[k])
        assert time.process_time() - start < SECONDS, trial


@pytest.mark.parametrize("build", ["i16r32", "i32r64"])
@pytest.mark.filterwarnings("error")
def test_whatever_the_words_draw(build: str, tmp_path: Path) -> None:
    sound, rng = every_kind(build).array, np.random.default_rng(5)
    for _ in range(4):
        array = spoiled(sound, rng)
        seen(lambda array=array: heap_picture.draw(array, tmp_path / "map.png", "$x_"))


def test_a_damaged_file_can_be_looked_into(tmp_path: Path) -> None:
    array = every_kind().array
    array.h.ia[:200] = 0
    save(array, tmp_path / "bad.h5")
    atlas = Atlas(look_into(tmp_path / "bad.h5").h)
    assert "not linked" in junk(atlas).as_text()
    assert dump(atlas, 1, 200).as_text().splitlines()[-1].endswith("the same to 200")


def every_word(array: MainArray) -> Any:
    return array.h.ia.copy(), array.h.ci.copy(), array.h.cr.copy(), array.h.cd.copy()


def test_a_look_changes_nothing(tmp_path: Path) -> None:
    array = every_kind().array
    before, atlas, rng = every_word(array), Atlas(array.h), np.random.default_rng(1)
    for look in [*looks(atlas, rng)][::2]:
        seen(look)
    heap_picture.draw(array, tmp_path / "map.png")
    assert all(np.array_equal(one, two) for one, two in zip(before, every_word(array), strict=True))


def test_commands_given_damaged_files() -> None:
    """A part of the tool's: each command ends with a result or a message, the file stays as it is."""
    some = ["info", "check", "dump", "walk", "find", "diff", "convert", "renumber", "patch"]
    arguments = [sys.executable, str(TOOL), "commands", "--files", "2", "--seed", "3", "--only", *some]
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "18 commands, 0 failures" in done.stdout
