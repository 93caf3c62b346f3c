"""Warnings about suspicious input are given once, before the run: their keys and numbers."""

from __future__ import annotations

import copy
import logging
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from support.random_scenes import play

from udec_ia import Model
from udec_ia.remark import Remark

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.dat"))


class KeyedRemarks(list[str]):
    """Warnings of a model, in order."""

    @property
    def keys(self) -> list[str]:
        """Their keys."""
        return [one.key if isinstance(one, Remark) else "" for one in self]


def collect_remarks(m: Model) -> KeyedRemarks:
    """The warnings that `m` is going to give."""
    output = KeyedRemarks()
    m.tell = output.append
    return output


def soft(out: Path, laws: str | None = None, **moduli: float) -> Model:
    m = Model(out=out, constitutive=laws)
    m.property(1, density=2000, kn=1e8, ks=1e8, **moduli)
    m.block(0, 0, 0, 2, 1, 2, 1, 0)
    m.split(-1, 1, 2, 1)
    m.change(0, 1, 1, 2, "sdef")
    return m


@pytest.mark.parametrize(
    ("name", "given", "meant"),
    [("friction", 35, 0.7), ("block_dilation", 10, 0.176), ("residual_friction", 6, 0.105)],
)
def test_degrees_for_a_tangent(name: str, given: float, meant: float, tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    output = collect_remarks(m)
    for _ in range(2):
        m.property(3, **{name: given})
    (text,) = output
    assert output.keys == ["degrees-for-tangent"]
    assert f"{name.replace('_', ' ')} {given} of material 3" in text
    assert f"{meant:g}" in text
    m.property(3, friction=3, residual_friction=1000, cohesion=35)
    assert len(output) == 1


def test_a_density_that_comes_too_late(tmp_path: Path) -> None:
    m = soft(tmp_path, bulk=1e9, g=1e9)
    output = collect_remarks(m)
    m.property(1, density=3000)
    assert output == []
    m.cycle(1)
    masses = m.table("block")["KBM"].tolist()
    m.property(2, density=3000)
    m.property(1, kn=2e8)
    assert output == []
    m.property(1, density=4000)
    (text,) = output
    assert output.keys == ["density-too-late"]
    assert "2 blocks of material 1" in text
    m.cycle(1)
    assert m.table("block")["KBM"].tolist() == masses


@pytest.mark.parametrize(("moduli", "lacking"), [({"g": 1e9}, "BULK"), ({"bulk": 1e9}, "G")])
def test_a_modulus_alone(moduli: dict[str, float], lacking: str, tmp_path: Path) -> None:
    m = soft(tmp_path, **moduli)
    output = collect_remarks(m)
    for _ in range(2):
        m.cycle(1)
    (text,) = output
    assert output.keys == ["missing-modulus"]
    assert f"PROPERTY MATERIAL=1 {lacking}=..." in text
    m.start()
    m = soft(tmp_path, bulk=1e9, g=1e9)
    output = collect_remarks(m)
    m.cycle(1)
    assert output == []


def test_a_modulus_alone_is_nothing_to_rigid_blocks(tmp_path: Path) -> None:
    m = soft(tmp_path, g=1e9)
    output = collect_remarks(m)
    m.change(0, 1, 1, 2, "rigid")
    m.cycle(1)
    assert output == []


def test_properties_that_no_law_in_use_looks_at(tmp_path: Path) -> None:
    """Of materials that are used, once; not where a block or a contact follows a law of the user's."""
    m = soft(tmp_path, bulk=1e9, g=1e9)
    output = collect_remarks(m)
    m.property(1, dilation=0.2, block_cohesion=1e5)
    m.property(2, dilation=0.2)
    for _ in range(2):
        m.cycle(1)
    (text,) = output
    assert output.keys == ["unused-property"]
    assert "DILATION and BCOHESION of material 1" in text
    m = soft(tmp_path, "joint-dilation", bulk=1e9, g=1e9)
    output = collect_remarks(m)
    m.property(1, dilation=0.2)
    m.change(0, 1, 1, 2, "rigid", constitutive=2)
    m.cycle(1)
    assert output == []


def test_rest_without_damping(tmp_path: Path) -> None:
    """Said by SOLVE, once, and not if anything damps."""
    m = soft(tmp_path, bulk=1e9, g=1e9)
    output = collect_remarks(m)
    m.cycle(1)
    assert output == []
    for _ in range(2):
        m.solve(0.1, limit=1)
    assert output.keys == ["no-damping"]
    for damping in ("mass", "stiffness", "internal"):
        m.start()
        m = soft(tmp_path, bulk=1e9, g=1e9)
        m.damping(0.001, 10, damping)
        output = collect_remarks(m)
        m.solve(0.1, limit=1)
        assert output == []


def wall(build: str, out: Path, shift: float = 0.0) -> Model:
    """20 x 10 squares of 1 m on a fixed base, whose rests differ by more than a tenth in 32-bit reals."""
    m = Model(build, out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.6)
    m.round(0.05)
    m.gravity(0, -10)
    m.block(shift, -1, shift, 10, shift + 20, 10, shift + 20, -1)
    for y in range(10):
        m.split(shift - 1, y, shift + 21, y)
    for x in range(1, 20):
        m.split(shift + x, -2, shift + x, 11)
    m.fix(shift, shift + 20, -1, 0)
    return m


@pytest.mark.parametrize(
    ("build", "shift", "due"), [("i32r32", 0.0, True), ("i32r64", 0.0, False), ("i32r64", 1e10, True)]
)
def test_what_the_reals_resolve_is_said_before_the_run(
    build: str, shift: float, due: bool, tmp_path: Path
) -> None:
    """The last digit of a coordinate times KN, against half the weight of a block, 10 kN/m."""
    m = wall(build, tmp_path, shift)
    output = collect_remarks(m)
    m.cycle(0)
    m.cycle(0)
    assert output.keys == ["coarse-reals"] * due
    force = 1e8 * (shift + 20.0 if shift else 20.0) * float(np.finfo(m.h.cr.dtype).eps)
    share = force / 1e4
    assert (share > 0.005) == due
    # the farthest corner is looked for by a bound, 0.2 m too far; per cent have one digit
    if due:
        found = float(output[0].partition("% of the")[0].split()[-1]) / 100
        assert found == pytest.approx(share, rel=0.04)


def test_a_deck_says_it_before_the_run(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    printed = m.run(
        "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=35\n"
        "BLOCK 0,0 0,2 1,2 1,0\nSPLIT -1,1 2,1\nSOLVE 0.1 LIMIT 1\n"
    )
    assert printed is not None
    assert "\n PROPERTY: friction 35 of material 1 is a tangent" in printed
    assert printed.index(" SOLVE: there is no damping") < printed.index(" SOLVE: time-step")


def test_the_log_has_the_key_of_a_warning(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING, "udec_ia"):
        Model(out=tmp_path).property(3, friction=35)
    (record,) = caplog.records
    assert record.key == "degrees-for-tangent"  # type: ignore[attr-defined]


def test_a_remark_is_a_text_that_keeps_its_key() -> None:
    one = Remark("step-above-bound", "a text")
    for copied in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one)):
        assert (copied, copied.key) == ("a text", "step-above-bound")


@pytest.mark.parametrize("deck", EXAMPLES, ids=lambda deck: deck.stem)
def test_the_examples_are_not_remarked_on(deck: Path, tmp_path: Path) -> None:
    """Up to the first cycle of each of their CYCLEs; the steps are safe as well."""
    m = Model(out=tmp_path)
    output = collect_remarks(m)
    m.run(re.sub(r"(CYCLE|SOLVE) .*", "CYCLE 1", re.sub(r"(?m)^PLOT.*\n", "", deck.read_text())))
    assert not set(output.keys) & {"degrees-for-tangent", "missing-modulus", "no-damping", "step-above-bound"}


def test_random_scenes_are_not_remarked_on(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    for seed in range(3):
        play(seed, Model(out=tmp_path), cycles=(1, 2))
    keys = {record.key for record in caplog.records if record.name == "udec_ia"}  # type: ignore[attr-defined]
    assert not keys & {"degrees-for-tangent", "missing-modulus", "no-damping"}


def test_loads_on_fixed_blocks_only(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.gravity(0, -10)
    m.damping(0.5, 5, "mass")
    m.block(0, 0, 0, 2, 1, 2, 1, 0)
    m.split(-1, 1, 2, 1)
    m.fix(0, 1, 0, 1)
    output = collect_remarks(m)
    m.boundary(0, 1, 0, 1, xforce=10.0)
    m.cycle(1)
    m.cycle(1)
    assert output.keys == ["loads-on-fixed-blocks"]
    m.boundary(0, 1, 1, 2, xforce=10.0)
    m.fix(0, 1, 1, 2)
    m.free(0, 1, 0, 2)
    m.cycle(1)
    assert len(output) == 1


def test_words_are_arguments_by_name(tmp_path: Path) -> None:
    """Not truth values of whatever argument stands in that place."""
    m = Model(out=tmp_path)
    with pytest.raises(TypeError):
        m.plot(0, "velocities")  # type: ignore[misc]
    with pytest.raises(TypeError):
        m.fraction(0.5, "safe")  # type: ignore[misc]
    with pytest.raises(TypeError, match=r"property\(\) got an unexpected keyword argument 'desnity'"):
        m.property(1, desnity=2000)  # type: ignore[call-arg]


def test_what_damps_is_said_when_a_deck_begins_to_run(tmp_path: Path) -> None:
    """Once, and again when it has changed; not beside the remark of SOLVE."""
    begin = "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8\nBLOCK 0,0 0,2 1,2 1,0\nSPLIT -1,1 2,1\n"
    printed = Model(out=tmp_path).run(f"{begin}CYCLE 1\nCYCLE 1\nDAMP 0.5 5 MASS\nCYCLE 1\nCYCLE 1\n")
    assert printed is not None
    assert printed.count("damping: none; only friction takes energy") == 1
    alpha = 0.5 * 2 * np.pi * 5  # mass damping has half of what both would be
    assert printed.count("damping: MASS damping reduces every velocity at the rate ALPHA = ") == 1
    assert f"ALPHA = {alpha:.3g} 1/s, critical at {alpha / (4 * np.pi):.3g} Hz" in printed
    printed = Model(out=tmp_path).run(f"{begin}SOLVE 0.1 LIMIT 1\n")
    assert printed is not None
    assert "there is no damping" in printed
    assert "damping: none" not in printed


def test_materials_that_meet_with_other_joint_properties(tmp_path: Path) -> None:
    """Which of them a contact takes depends on the map: one remark, and none where it does not matter."""
    m = Model(out=tmp_path)
    for material, density in ((1, 2000), (2, 2500), (3, 3000)):
        m.property(material, density=density, kn=1e8, ks=1e8, friction=0.5)
    m.block(0, 0, 0, 2, 4, 2, 4, 0)
    m.split(-1, 1, 5, 1)
    m.split(2, 1, 2, 3)
    m.change(0, 4, 0, 1, material=2)
    m.fix(0, 4, 0, 1)
    output = collect_remarks(m)
    m.cycle(1)
    m.property(3, friction=0.1)  # of no block
    m.cycle(1)
    assert "joints-of-two-materials" not in output.keys
    m.property(2, friction=0.1, kn=2e8)
    m.cycle(1)
    m.cycle(1)
    assert output.keys.count("joints-of-two-materials") == 1
    assert "materials 1 and 2 meet and differ in KN and FRICTION" in output[-1]
