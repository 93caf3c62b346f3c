"""Appendix II-2 with all three block types: as printed, and settled, robbed of its middle and falling."""

from __future__ import annotations

from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.layout import offsets as g

EXAMPLES = Path(__file__).parents[2] / "examples"
BUILDS = ["i32r64", "i32r32"]


def commands(name: str) -> list[str]:
    """The statements of a deck, but for its comments, pictures and end."""
    text = (EXAMPLES / name).read_text().replace("\n+", " ")
    return [line for line in text.split("\n") if line and line.split()[0] not in ("*", "PLOT", "STOP", "END")]


def obey(m: Model, line: str) -> None:
    """Obey a command; CYCLE in pieces of 100. The heap is sound after each."""
    name, *numbers = line.split()
    if name == "CYCLE":
        for _ in range(int(numbers[0]) // 100):
            m.cycle(100)
            assert m.check() == []
    else:
        m.run(line)
        assert m.check() == [] or not m.table("block").size


@pytest.mark.parametrize("build", BUILDS)
def test_as_printed(build: str, tmp_path: Path) -> None:
    m = Model(build, out=tmp_path)
    m.run(EXAMPLES / "collapse-small.dat")
    blocks = m.table("block")
    assert len(blocks) == 25
    assert int(m.h.ci[g.MCTOT]) == 100
    assert len(m.table("zone")) == 16
    assert len(m.table("sdef")) == 12
    assert m.check() == []


@pytest.mark.parametrize("build", BUILDS)
def test_collapse(build: str, tmp_path: Path) -> None:
    """Sound after every command and every 100 cycles; what hung over the opening lies on the floor."""
    m = Model(build, out=tmp_path)
    for line in commands("collapse.dat"):
        obey(m, line)
        if line.startswith("DELETE"):
            left = len(m.table("block"))
    assert int(m.h.ci[g.MCTOT]) == 22_000
    blocks = m.table("block")
    assert len(blocks) == left
    fallen = blocks[(blocks["KX"] > 20) & (blocks["KX"] < 40) & (blocks["KY"] > 10)]
    assert fallen["KY"].min() < 16
