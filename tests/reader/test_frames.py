"""Data frames: every value is that of the heap; units and words of all columns."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from support.every_group_kind import GROUPS, every_kind

from udec_ia import Model
from udec_ia.heap.accessors import getr, iget
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table

pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Model:
    """A model with groups of every kind, and histories of different periods."""
    m = every_kind()
    m.out = tmp_path_factory.mktemp("out")
    m.history(4, "MCTOT")
    m.cycle(20)
    return m


@pytest.mark.parametrize("kind", [group.name for group in GROUPS])
def test_every_value_is_that_of_the_heap(recorded: Model, kind: str) -> None:
    frame, h = recorded.frame(kind), recorded.array.h
    assert frame.index.name == "address"
    assert len(frame) > 0
    for field in read_table().group(kind).fields:
        offset = (0, 0, 0) if field.name == "HEAD" else getattr(g, field.name)
        for i in range(field.count):
            name = field.name if field.count == 1 else f"{field.name}_{i + 1}"
            at = frame.index.tolist()
            found = [getr(h, one, offset) if field.real else iget(h, one, offset, i) for one in at]
            np.testing.assert_array_equal(frame[name].to_numpy(), found)
            assert frame.attrs["units"][name] == field.unit.replace("-", "")
            assert field.text.startswith(frame.attrs["names"][name].partition(" (K")[0])
    assert len({*frame.rename(columns=frame.attrs["names"]).columns}) == len(frame.columns)


def test_histories(recorded: Model) -> None:
    frame = recorded.frame("histories")
    assert [*frame.columns] == ["cycle", *(one.title for one in recorded.histories())]
    assert frame["cycle"].tolist() == [0, 4, 8, 10, 12, 16, 20]
    for one in recorded.histories():
        column = frame[one.title].dropna()
        assert column.to_numpy().tolist() == one.numbers[:, 2].tolist()
        assert column.index.tolist() == one.numbers[:, 1].tolist()
        assert frame.attrs["units"][one.title] == one.unit
    assert len(Model().frame("histories")) == 0


def test_a_frame_is_a_copy(recorded: Model) -> None:
    before = recorded.table("block")["KX"].tolist()
    frame = recorded.frame("block")
    frame["KX"] = 0.0
    assert recorded.table("block")["KX"].tolist() == before


def test_without_pandas(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    for kind in ("block", "histories"):
        with pytest.raises(ModuleNotFoundError, match=r"pip install udec-ia\[pandas\]"):
            Model(out=tmp_path).frame(kind)


def test_an_unknown_kind() -> None:
    with pytest.raises(ValueError, match="brick"):
        Model().frame("brick")
