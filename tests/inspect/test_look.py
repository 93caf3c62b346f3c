"""The workshop's looks into a heap: against plain walks, in sound heaps and in damaged ones."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from kinds import GROUPS, every_kind
from naive.census import census as naive_census

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.heap.accessors import iget
from udec_ia.heap.memory import JNEXT, JSIZE, JSIZES
from udec_ia.heap.words import ALL_SCHEMES
from udec_ia.inspect.look import Atlas, junk, walk, what, who
from udec_ia.inspect.look.atlas import JUNK, KINDS, NOTHING, UNUSED
from udec_ia.inspect.walk import boundary, groups, loop, members
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts

BUILDS = ["i16r32", "i32r64", "i64r64"]


@pytest.fixture(params=BUILDS)
def scene(request: pytest.FixtureRequest) -> Model:
    """Groups of every kind, and some junk."""
    return every_kind(request.param)


def junk_groups(m: Model) -> dict[int, int]:
    """Size of each junk group by address, along the chains."""
    h, found = m.array.h, {}
    chain = int(h.ci[g.JUNK])
    while chain:
        iad = chain
        while iad:
            found[iad] = iget(h, iad, JSIZE)
            iad = iget(h, iad, JNEXT)
        chain = iget(h, chain, JSIZES)
    return found


def test_every_word_is_in_one_span(scene: Model) -> None:
    atlas = Atlas(scene.array.h)
    sizes = layouts(scene.array.scheme.ratio)
    expected = {iad: (kind, sizes[kind].size) for kind, at in naive_census(scene.array).items() for iad in at}
    expected |= {iad: (JUNK, size) for iad, size in junk_groups(scene).items()}
    assert any(kind == JUNK for kind, _ in expected.values())
    at = 1
    for span in atlas.spans():
        assert span.first == at
        at = span.last + 1
        if span.kind == UNUSED:
            assert span.first == scene.h.ci[g.MFREE]
        else:
            assert expected.pop(span.first) == (span.kind, span.last - span.first + 1)
    assert expected == {}
    assert at == len(scene.array.h.ia) + 1


def test_every_field_of_every_group(scene: Model) -> None:
    """By each of its words, with the value that the tables give."""
    atlas = Atlas(scene.array.h)
    for group in GROUPS:
        for row in scene.table(group.name):
            for field in group.fields:
                for element, value in enumerate(np.atleast_1d(row[field.name]).tolist()):
                    span = atlas.span(int(row["address"]))
                    word = atlas.word(span, field, element)
                    assert atlas.value(word) == value
                    for address in (word.first, word.last):
                        assert atlas.word_at(address) == (span, word)


def test_owners(scene: Model) -> None:
    h, atlas = scene.array.h, Atlas(scene.array.h)
    for block in groups(h, "block"):
        assert atlas.owners(atlas.span(block)) == [block]
        for kind in ("zone", "gridpoint"):
            assert all(atlas.owners(atlas.span(iad)) == [block] for iad in members(h, block, kind))
    corners = scene.table("corner")
    assert [atlas.owners(atlas.span(int(iad))) for iad in corners["address"]] == [[b] for b in corners["KNB"]]
    assert not any(atlas.owners(atlas.span(int(iad))) for iad in scene.table("domain")["address"])


def test_who_points_to_a_group(scene: Model) -> None:
    """Every pointer of every group, brute force."""
    h, atlas = scene.array.h, Atlas(scene.array.h)
    pointers: dict[int, set[tuple[int, str]]] = {}
    for group in GROUPS:
        for row in scene.table(group.name):
            span = atlas.span(int(row["address"]))
            for word in atlas.words(span):
                if word.field.target and (value := int(atlas.value(word))):
                    pointers.setdefault(value, set()).add((word.first, word.name))
    heads = {int(h.ci[index]) for index in (g.IBPNT, g.ICPNT, g.IDPNT, g.IODPNT, g.IBNPNT, g.ISGPNT, g.IHPNT)}
    for address in [iad for at in atlas.groups.values() for iad in at.tolist()]:
        rows = who(atlas, address).rows
        assert {(row[0], row[2]) for row in rows if row[1] != "common block"} == pointers.get(address, set())
        assert any(row[1] == "common block" for row in rows) == (address in heads)


def test_walks(scene: Model) -> None:
    h, atlas = scene.array.h, Atlas(scene.array.h)

    def addresses(along: str, start: int | None = None) -> list[int]:
        return [row[1] for row in walk(atlas, along, start).rows]

    for kind in ("block", "contact", "domain", "history"):
        assert addresses(kind) == [*groups(h, kind)]
    for block in groups(h, "block"):
        assert addresses("block", block) == [*boundary(h, block)]
        points = [*members(h, block, "gridpoint")]
        if points:
            assert addresses("KG", points[0]) == points
    for domain in groups(h, "domain"):
        assert addresses("domain", domain) == [item for item, _ in loop(h, domain)]
    with pytest.raises(ValueError, match="no list KXD: there are block, contact"):
        walk(atlas, "KXD", 1)
    with pytest.raises(ValueError, match="is corner@"):
        walk(atlas, "block", int(scene.table("corner")["address"][0]))


def test_junk_counts_all_words(scene: Model) -> None:
    listing = junk(Atlas(scene.array.h))
    used = int(scene.h.ci[g.MFREE]) - 1
    assert sum(row[3] for row in listing.rows) == used
    given = sum(junk_groups(scene).values())
    assert f"junk: {given} words" in listing.said[1]
    assert f"{used - given} are" in listing.said[0]


def test_a_wrong_pointer_is_told(scene: Model) -> None:
    contact = scene.table("contact")[0]
    word = int(contact["address"]) + g.KB1[0]
    corner = int(scene.table("corner")["address"][3])
    scene.array.h.ia[word - 1] = corner
    (row,) = (row for row in what(Atlas(scene.array.h), word).rows if row[2] == "KB1")
    assert row[5].startswith(f"corner@{corner} of block@")
    assert row[5].endswith(", no block")


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_a_damaged_heap_can_be_looked_at(build: str) -> None:
    """Whatever the words say: every look ends, in time, and says something."""
    sound, rng = every_kind(build), np.random.default_rng(7)
    used = int(sound.h.ci[g.MFREE]) - 1
    start = time.process_time()
    for _ in range(60):
        array = sound.array.copy()
        for _ in range(int(rng.integers(1, 40))):
            at = int(rng.integers(used))
            array.h.ia[at] = rng.choice([0, 1, -1, int(rng.integers(used)), 32767])
        atlas = Atlas(array.h)
        assert sum(span.last - span.first + 1 for span in atlas.spans()) == len(array.h.ia)
        assert {span.kind for span in atlas.spans()} <= {*KINDS, JUNK, NOTHING, UNUSED}
        address = int(rng.integers(1, used))
        listings = [what(atlas, address), who(atlas, address), junk(atlas), walk(atlas, "block")]
        listings += [
            walk(atlas, kind, int(iad)) for kind in ("block", "domain") for iad in atlas.groups[kind][:3]
        ]
        assert all(listing.as_text() and json.loads(listing.as_json()) for listing in listings)
    assert time.process_time() - start < 60


def test_the_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """They print what the functions give, as text, as JSON, and as a program that prints the same."""
    m = every_kind()
    file = str(m.save(tmp_path / "state.h5"))
    atlas = Atlas(m.array.h)
    block = int(m.table("block")["address"][1])
    calls = {
        ("what", "40"): what(atlas, 40),
        ("who", str(block)): who(atlas, block),
        ("walk", "block", str(block)): walk(atlas, "block", block),
        ("walk", "contact"): walk(atlas, "contact"),
        ("junk",): junk(atlas),
    }
    for (name, *rest), listing in calls.items():
        assert main([name, file, *rest]) == 0
        assert capsys.readouterr().out == listing.as_text()
        assert main([name, file, *rest, "--json"]) == 0
        assert json.loads(capsys.readouterr().out) == json.loads(listing.as_json())
        assert main([name, file, *rest, "--python"]) == 0
        program = capsys.readouterr().out
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        assert done.stdout.rstrip("\n") == listing.as_text().rstrip("\n")


def test_what_cannot_be_looked_at(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = str(every_kind().save(tmp_path / "state.h5"))
    for given, says in (
        (["what", file, "0"], "IA() has the addresses 1 to"),
        (["who", file, "99999999"], "IA() has the addresses 1 to"),
        (["walk", file, "nothing"], "no list nothing"),
    ):
        assert main(given) == 2
        assert says in capsys.readouterr().err
    assert main(["junk", str(tmp_path / "none.h5")]) == 1
    assert "error 29" in capsys.readouterr().err
