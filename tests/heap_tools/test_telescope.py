"""udec telescope: pointers of a group, some levels deep, against the words and the tables."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.every_group_kind import GROUPS, every_kind

from udec_ia.cli import main
from udec_ia.heap_tools.pointer_graph import LINES, telescope
from udec_ia.reader.word_map import Atlas

FIELDS = {group.name: group.fields for group in GROUPS}
Pointer = tuple[str, int]  # name of a field and where it leads


@pytest.fixture(scope="module", params=["i32r64", "i16r32"])
def scene(request: pytest.FixtureRequest) -> tuple[Atlas, dict[int, list[Pointer]]]:
    """A heap with groups of every kind, and the pointers of each group that are not 0, from its table."""
    m = every_kind(request.param)
    found = {
        int(row["address"]): [
            (f"{field.name}({k + 1})" if field.count > 1 else field.name, int(value))
            for field in FIELDS[group.name]
            if field.target
            for k, value in enumerate(np.atleast_1d(row[field.name]))
            if value
        ]
        for group in GROUPS
        for row in m.table(group.name)
    }
    return Atlas(m.array.h), found


def rows_of(atlas: Atlas, place: int | str, levels: int) -> list[Any]:
    return list(telescope(atlas, place, levels).rows)


def test_one_level_is_every_pointer(scene: tuple[Atlas, dict[int, list[Pointer]]]) -> None:
    atlas, pointers = scene
    for group, expected in pointers.items():
        rows = rows_of(atlas, group, 1)
        assert [(name, int(atlas.h.ia[address - 1])) for _, address, name, _ in rows] == expected
        for (_, _, _, text), (_, to) in zip(rows, expected, strict=True):
            assert re.match(rf"\w+@{to}\b", text)


@pytest.mark.parametrize("levels", [2, 3, 5])
def test_deeper_levels(scene: tuple[Atlas, dict[int, list[Pointer]]], levels: int) -> None:
    """Below a pointer stand those of its group, once; what is marked as above or back has been met."""
    atlas, pointers = scene
    for start in [*pointers][:: max(len(pointers) // 12, 1)]:
        rows = rows_of(atlas, start, levels)
        listing = telescope(atlas, start, levels)
        if len(rows) == LINES:
            assert f"the first {LINES} lines" in listing.head[-1]
        path, listed = [start], {start}
        for (level, address, name, text), after in zip(rows, [*rows[1:], None], strict=False):
            to = int(atlas.h.ia[address - 1])
            del path[level:]
            assert (name.strip(), to) in pointers[path[-1]]
            assert len(name) - len(name.lstrip()) == 2 * (level - 1)
            assert text.endswith(" (back)") == (to in path)
            assert text.endswith(" (above)") == (to in listed and to not in path)
            opened = level < levels and to not in listed and to not in path and pointers.get(to)
            if after is not None:
                assert (after[0] == level + 1) == bool(opened)
            if level < levels:
                listed.add(to)
            path.append(to)


def test_one_pointer(scene: tuple[Atlas, dict[int, list[Pointer]]]) -> None:
    atlas, pointers = scene
    block = int(atlas.groups["block"][0])
    rows = rows_of(atlas, f"block@{block}.KP", 2)
    corner = dict(pointers[block])["KP"]
    assert [name.strip() for _, _, name, _ in rows] == ["KP", *(name for name, _ in pointers[corner])]
    assert rows_of(atlas, rows[0][1], 2) == rows
    assert rows_of(atlas, f"block@{block}.KP.KNB", 1)[0][3].startswith(f"block@{block}")


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    m = every_kind()
    file, block = str(m.save(tmp_path / "all.h5")), int(m.table("block")["address"][0])
    assert main(["telescope", file, f"block@{block}"]) == 0
    default = capsys.readouterr().out
    assert main(["telescope", file, str(block), "-n", "2"]) == 0
    assert capsys.readouterr().out == default
    assert default == telescope(Atlas(m.array.h), block).as_text()
    top = str(len(m.h.ia))
    for wrong in ([f"block@{block}", "-n", "0"], [f"block@{block}.KX"], ["FRAC"], [top], ["0"]):
        assert main(["telescope", file, *wrong]) == 2
        assert capsys.readouterr().err.startswith("udec telescope: ")


def test_a_damaged_heap() -> None:
    """Whatever the words say, it ends, within its lines."""
    array, rng = every_kind().array, np.random.default_rng(6)
    used = Atlas(array.h).free - 1
    for _ in range(3):
        array.h.ia[rng.integers(used, size=30)] = rng.integers(-5, used, size=30)
        damaged = Atlas(array.h)
        for kind, at in damaged.groups.items():
            for iad in at[:2].tolist():
                if damaged.span(iad).kind == kind:
                    assert len(rows_of(damaged, iad, 6)) <= LINES
