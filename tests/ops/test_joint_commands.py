"""Commands on joints in a run: stresses and memory stay, and messages say what happens."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from udec_ia.heap.accessors import puti
from udec_ia.layout import offsets as g
from udec_ia.model import Model

TWO = """START
PROP MAT=1 DENS=2500 KN=1E8 KS=1E8 FRICTION=0.6
PROP MAT=2 DENS=2500 KN=1E8 KS=1E8 FRICTION=0.6
{joint}
BLOCK 0,0 0,2 4,2 4,0
SPLIT -1,1 5,1
ROUND 0.02
FIX 0 4 0 1
DAMPING LOCAL=0.8
GRAVITY 0 -10
"""
BETWEEN = "JPROPERTY JMATERIAL=1 KN=5E9 KS=2E9 FRICTION=0.4 BETWEEN 1 2\nJPROPERTY JMATERIAL=2 KN=1E9 KS=1E9"


def played(deck: str, **words: Path) -> Model:
    m = Model(**words)
    m.tell = m.inform = lambda _: None
    m.run(deck)
    return m


def test_a_history_ends_with_its_joint(tmp_path: Path) -> None:
    deck = TWO.format(joint=BETWEEN) + "CHANGE 0 4 1 2 MATERIAL=2\nHISTORY 1 KCJSN AT 0,1\nCYCLE 2\n"
    m = played(deck, out=tmp_path)
    m.run("CHANGE 0 4 1 2 MATERIAL=1\nCYCLE 2\n")
    value = m.histories()[0].numbers[:, 2]
    assert np.isfinite(value[:-2]).all()
    assert np.isnan(value[-2:]).all()


def test_a_new_stiffness_keeps_the_forces_of_insitu() -> None:
    m = played(TWO.format(joint="") + "INSITU -1 5 -1 3 0 0 -1E4 YGRAD 0 0 0\n")
    before = m.table("contact")["KCFN"]
    m.run("PROP MAT=1 KN=2E8\nCYCLE 1\n")
    assert m.table("contact")["KCFN"] == pytest.approx(before, rel=0.2)  # it begins to fall
    assert m.table("joint")["KCJSN"] == pytest.approx(before, rel=0.2)


def test_insitu_needs_a_stiffness_above_0() -> None:
    m = played(TWO.format(joint="") + "INSITU -1 5 -1 3 0 0 -1E4\n")
    with pytest.raises(Exception, match="28") as caught:
        m.property(1, ks=0)
    assert caught.value.number == 28  # type: ignore[attr-defined]


def test_another_unit_gives_a_single_contact_its_length() -> None:
    """A column that leans on one edge: its last contact is on no joint, so its length is 2 D."""
    m = played("""START
PROP MAT=1 DENS=2000
JPROPERTY JMATERIAL=1 KN=1E8 KS=5E7 FRICTION=0.8 CONTACT BETWEEN 1 1
BLOCK 0,0 0,4 1,4 1,0
SPLIT -1,1 2,1
ROUND 0.03
FIX 0 1 0 1
GRAVITY 4 -10
""")
    for _ in range(2000):
        m.cycle(1)
        if len(m.table("joint")) == 1:
            break
    assert m.table("joint")["KCJL"].tolist() == [1.0]
    m.run("JPROPERTY JMATERIAL=1 LENGTH\n")
    assert m.table("joint")["KCJL"] == pytest.approx([2 * 0.03], rel=1e-6)


def test_a_cut_keeps_the_memory_of_a_model() -> None:
    yielding = (
        "JPROPERTY JMATERIAL=1 YIELDING KN=2E9 KS=1E9 FRICTION=0.3 IFRICTION=1 ROUGHNESS=1E-3 BETWEEN 1 1"
    )
    m = played(
        TWO.format(joint=yielding) + "CYCLE 500\nBOUNDARY 0 4 1 2 XVEL=0.02 ROTATION=0\nCYCLE TIME 0.2\n"
    )
    before = m.table("joint")
    m.run("SPLIT 1.7,0.9 1.7,5\n")
    after = m.table("joint")
    sheared = after[after["KCJSN"] > 0]
    assert len(sheared) == 4
    assert sheared["KCJV1"] == pytest.approx(np.full(4, before["KCJV1"].mean()), rel=0.01)
    assert (np.sign(sheared["KCJV2"]) == np.sign(before["KCJV2"][0])).all()


@pytest.mark.parametrize(
    ("words", "key"),
    [
        ({"kn": 1e9, "friction": 35}, "degrees-for-tangent"),
        ({"kn": 1e9, "friction": 0.6, "jrc": 8}, "unused-property"),
        ({"model": "barton", "jrc": 8, "jcs": 1e8, "sigmac": 1e8, "dilation": 0.1}, "unused-property"),
        ({"kn": 1e9, "friction": 0.6, "tension": 1e4, "dilation": 0.1}, None),
    ],
)
def test_suspicious_properties_are_reported(words: dict[str, Any], key: str | None) -> None:
    keys: list[str] = []
    m = Model()
    m.tell = lambda one: keys.append(one.key)
    m.jproperty(1, ks=1e9, **words)
    assert keys == ([key] if key else [])


def test_residual_strength_can_be_withdrawn() -> None:
    m = played("START\nJPROPERTY JMATERIAL=1 KN=1E9 KS=1E9 FRICTION=0.6 RFRICTION=0.3\n")
    assert m.h.cr[g.JMRMU] == 0.3
    m.jproperty(1, residual_friction=-1)
    assert m.h.cr[g.JMRMU] == -1


def test_joints_are_printed_as_far_as_the_heap_is_sound() -> None:
    m = played(TWO.format(joint=BETWEEN) + "CHANGE 0 4 1 2 MATERIAL=2\nCYCLE 1\n")
    assert "BETWEEN" in m.print("joints")
    ic = int(m.h.ci[g.ICPNT])
    for field, word in ((g.KB1, 7), (g.KCP1, 7), (g.KC, ic)):
        broken = played(TWO.format(joint=BETWEEN) + "CHANGE 0 4 1 2 MATERIAL=2\nCYCLE 1\n")
        puti(broken.h, ic, field, word)
        assert "Joint materials: 2" in broken.print("joints")
