"""STAGE, DELETE ... FUNCTION and PLOT ... SINCE: excavation in stages."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import numpy as np
import pytest
import shapely
from support.random_cuts import polygons

from udec_ia import Model, UdecError
from udec_ia.checker import check
from udec_ia.heap_tools import renumber_groups
from udec_ia.layout import offsets as g
from udec_ia.output.drawn_outlines import joint_results
from udec_ia.output.joint_drawing import slip_since
from udec_ia.output.readable_units import readable
from udec_ia.reader.group_tables import table

ROCK = """START
PROPERTY MAT=1 DENSITY=2500 BULK=5E9 G=3E9 KN=1E10 KS=1E10 F=0.7
BLOCK 0 0 0 20 30 20 30 0
JSET ANGLE 60 SPACING 5
JSET ANGLE -25 SPACING 6
TUNNEL 15 9 3 12
ROUND 0.006
"""


def at_rest(kind: str, with_joints: bool) -> Model:
    """Jointed rock under stress and gravity, with a tunnel that is not excavated yet."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(ROCK)
    m.tidy(0.2)
    if with_joints:
        m.jproperty(1, kn=5e9, ks=2e9, friction=0.7, between=(1, 1))
    if kind != "rigid":
        m.change("ALL", type=kind)
    if kind == "fdef":
        m.generate("ALL", edge=3.0)
    m.fix("NOT CIRCLE 15 9 6")
    m.gravity(0, -9.81)
    m.insitu("ALL", s11=-3e6, s22=-1.5e6, s12=2e5)
    m.damping(local=0.8)
    m.solve(1e-9)
    return m


@pytest.mark.parametrize("with_joints", [False, True])
@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_the_forces_of_excavated_blocks_hold_the_rock(kind: str, with_joints: bool) -> None:
    m = at_rest(kind, with_joints)
    blocks = {row["address"]: (row["KX"], row["KY"]) for row in table(m.array, "block")}
    forces = table(m.array, "contact")["KCFN"].max()
    m.function(1, 0, 1)
    deleted = m.delete("CIRCLE 15 9 3", function=1)
    assert deleted > 1
    assert len(table(m.array, "bound")) > 6
    m.cycle(50)
    for row in table(m.array, "block"):
        moved = np.hypot(row["KX"] - blocks[row["address"]][0], row["KY"] - blocks[row["address"]][1])
        # A simply-deformable block has the load at the ends of its edge, and not where the force was.
        assert moved < (1e-9 if kind != "sdef" else 1e-6)
    assert table(m.array, "contact")["KCFN"].max() == pytest.approx(forces, rel=1e-2)
    assert list(check(m.array)) == []
    m.function(1, 0, 0)
    m.solve(1e-6)
    free = at_rest(kind, with_joints)
    free.delete("CIRCLE 15 9 3")
    free.solve(1e-6)
    one, two = (table(one.array, "block") for one in (m, free))
    far = np.hypot(one["KX"] - two["KX"], one["KY"] - two["KY"]).max()
    most = max(np.hypot(x - blocks[at][0], y - blocks[at][1]) for at, x, y in two[["address", "KX", "KY"]])
    assert most > 1e-5
    assert far < 0.1 * most


def test_half_the_relaxation_is_half_the_elastic_displacement() -> None:
    found = []
    for left in (0.5, 0.0):
        m = at_rest("rigid", False)
        before = {row["address"]: row["KX"] for row in table(m.array, "block")}
        m.property(material=1, friction=100.0)
        m.function(1, 0, left)
        m.delete("CIRCLE 15 9 3", function=1)
        m.solve(1e-8)
        found.append([row["KX"] - before[row["address"]] for row in table(m.array, "block")])
    half, whole = np.array(found)
    assert np.abs(whole).max() > 1e-5
    assert half == pytest.approx(whole / 2, abs=0.05 * np.abs(whole).max())


def test_a_function_that_does_not_exist_deletes_nothing() -> None:
    m = at_rest("rigid", False)
    many = len(table(m.array, "block"))
    with pytest.raises(UdecError) as error:
        m.delete("CIRCLE 15 9 3", function=4)
    assert error.value.number == 26
    assert len(table(m.array, "block")) == many


def test_stages_are_restart_files_in_one_archive(tmp_path: Path) -> None:
    m = at_rest("rigid", False)
    m.out, m.name = tmp_path, "rock"
    first = m.stage("before")
    words = m.array.h.ia.copy()
    m.delete("CIRCLE 15 9 3")
    m.solve(1e-5)
    m.stage("open")
    m.cycle(10)
    m.stage("open")
    archive = tmp_path / "rock-stages.zip"
    assert first == archive / "before"
    with zipfile.ZipFile(archive) as file:
        assert file.namelist()[1:] == ["before", "open"]
    back = Model.restore(first)
    assert (back.array.h.ia[: len(words)] == words[: len(back.array.h.ia)]).all()
    assert Model.restore(archive / "open").array.h.ci[4] == m.array.h.ci[4]
    remarks: list[str] = []
    m.inform = remarks.append
    files = m.plot(0, since="before")
    assert {path.suffix for path in files} == {".png", ".svg"}
    assert "largest displacement" in (tmp_path / "rock-plot-1.svg").read_text()
    then = Model.restore(first).table("block")
    _, old, new = np.intersect1d(then["address"], m.table("block")["address"], return_indices=True)
    moved = np.hypot(*(m.table("block")[name][new] - then[name][old] for name in ("KX", "KY"))).max()
    assert remarks[-1].startswith(f"largest displacement since before: {moved:.4g} m")
    m.plot(0, joints="slip", since="before")
    assert "slip since before (" in (tmp_path / "rock-plot-2.svg").read_text()
    slips, before = {}, Model.restore(first)
    for state in (before, m):
        rows = state.table("contact")
        slips[state] = dict(zip(rows["address"].tolist(), rows["KCS"].tolist(), strict=True))
    since = slip_since(joint_results(m.h), joint_results(before.h)).rows
    for address, slip in zip(since["contact"].tolist(), since["slip"].tolist(), strict=True):
        assert slip == slips[m][address] - slips[before].get(address, 0.0)
    assert np.abs(since["slip"]).max() > 0
    m.plot(0, since=f"{archive}/open")
    other = at_rest("rigid", False)
    other.out, other.name = tmp_path, "rock"
    other.stage("new")
    with zipfile.ZipFile(archive) as file:  # those of the run before have gone
        assert file.namelist()[1:] == ["new"]
    with pytest.raises(UdecError) as error:
        m.plot(0, since="never")
    assert error.value.number == 29


def test_names_and_files_that_stages_refuse(tmp_path: Path) -> None:
    m = at_rest("rigid", False)
    m.out, m.name = tmp_path, "rock"
    for name in ("a/b", "", "..", "a b", "udec_ia-stages" * 6):
        with pytest.raises(UdecError) as error:
            m.stage(name)
        assert error.value.number == 10
    archive = tmp_path / "rock-stages.zip"
    for content in (b"not an archive", b"PK\x03\x04" + bytes(60)):
        archive.write_bytes(content)
        with pytest.raises(UdecError) as error:
            m.stage("one")
        assert error.value.number == 31
        assert archive.read_bytes() == content
        with pytest.raises(UdecError) as error:
            Model.restore(archive / "one")
        assert error.value.number == 29
    archive.unlink()
    m.stage("one")
    whole = archive.read_bytes()
    for cut in range(0, len(whole), max(len(whole) // 40, 1)):
        archive.write_bytes(whole[:cut])
        with pytest.raises(UdecError) as error:
            Model.restore(archive / "one")
        assert error.value.number == 29
    damaged = bytearray(whole)
    damaged[len(whole) // 2] ^= 0xFF
    archive.write_bytes(bytes(damaged))
    with pytest.raises(UdecError) as error:
        Model.restore(archive / "one")
    assert error.value.number == 29


def test_a_stage_before_the_first_cycle_of_a_large_model(tmp_path: Path) -> None:
    """The first CYCLE puts its groups in another order; displacements since the stage are those of blocks."""
    m = Model(name="large", out=tmp_path)
    m.property(1, density=2500, kn=1e9, ks=1e9)
    m.block(0, 0, 0, 30, 30, 30, 30, 0)
    remarks: list[str] = []
    m.tell = m.inform = remarks.append
    m.jset(90, spacing=1)
    m.jset(0, spacing=1)
    m.round(0.01)
    m.fix(0, 30, 0, 1)
    m.gravity(0, -10)
    m.stage("first")
    m.reset("displacements")
    m.plot(0)
    m.cycle(20)
    files = m.plot(1, displacements=True)
    fall = 0.5 * 10 * float(m.h.cd[g.TIME]) ** 2
    assert files
    m.plot(0, since="first")
    found = re.search(r"largest displacement since first: (\S+) m", remarks[-1])
    assert found
    assert 0 < float(found[1]) < 2 * fall
    text = (tmp_path / "large-plot-1.svg").read_text()
    largest = re.search(r"largest displacement: (\S+) mm", text)
    assert largest
    assert 0 < float(largest[1]) < 2 * fall * 1e3


def test_a_relaxed_tunnel_beside_a_sliver_is_filled() -> None:
    """The sharp corner of a sliver is 5 mm from its neighbours: the fill keeps to that corner."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(
        """START
        GRAVITY 0 -9.81
        PROPERTY MAT=1 DENSITY=2500 BULK=5E9 G=3E9 KN=5E9 KS=2E9 F=0.6
        JPROPERTY JMATERIAL=1 KN=1E10 KS=5E9 F=0.5 BETWEEN 1 1
        BLOCK 0,0 0,20 20,20 20,0
        JSET ANGLE 60 SPACING 5 ORIGIN 1 0 JMATERIAL=1
        JSET ANGLE -20 SPACING 4 ORIGIN 0 1 JMATERIAL=1
        TUNNEL 10 9 3 16 GLUED
        FIX OUTSIDE
        INSITU ALL -1E6 0 -2E6
        SOLVE 1E-6 STATIC
        FUNCTION 1 0 1
        DELETE CIRCLE 10 9 3 FUNCTION=1
        DAMPING LOCAL 0.8
        CYCLE 500
        FUNCTION 1 0 0
        CYCLE 500
        """
    )
    before = polygons(m)
    m.fill(10, 9)
    (new,) = (one for one in polygons(m) if all(one != other for other in before))
    assert new.area == pytest.approx(16 * 9 / 2 * np.sin(np.pi / 8), rel=0.01)
    longest = 2 * 3 * np.sin(np.pi / 16)  # of its edges, beside which points within FTOL were left out
    assert shapely.area([new & other for other in before]).max() < float(m.h.cr[g.FTOL]) * longest
    assert list(map(str, check(m.array))) == []


def test_a_filled_block_has_no_displacement_since_a_stage_before_it(tmp_path: Path) -> None:
    """It may have the address of a block that was excavated elsewhere."""
    m = at_rest("rigid", False)
    m.out, m.name = tmp_path, "rock"
    remarks: list[str] = []
    m.inform = remarks.append
    m.stage("before")
    known = {int(one) for one in m.table("block")["address"]}
    m.delete("CIRCLE 15 9 3")
    new = m.fill(15, 9)
    assert new in known
    m.plot(0, since="before")
    found = re.match(r"largest displacement since before: (\S+) m", remarks[-1])
    assert found
    assert float(found[1]) < 1e-3


def test_since_after_a_cycle_that_was_undone(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """CYCLE arranges the groups before its first cycle; if it ends with an error they are where they were."""
    monkeypatch.setattr(renumber_groups, "MANY_BLOCKS", 2)
    m = Model(out=tmp_path)
    m.property(1, density=2000)
    m.block(0, 0, 0, 4, 4, 4, 4, 0)
    for k in range(1, 4):
        m.split(-1, k, 5, k)
    m.stage("first")
    with pytest.raises(UdecError, match="error 11"):
        m.cycle(1)
    m.property(1, kn=1e8, ks=1e8)
    m.gravity(0, -10)
    places = m.table("block")["KY"]
    m.cycle(100)
    fall = places[:, None] - m.table("block")["KY"]
    fall = fall[np.abs(fall) < 0.5]  # each block has fallen by less than half of its height
    (scale,) = m.figure(color="movement", since="first").child_axes
    assert len(fall) == 4
    assert scale.get_ylim()[1] == pytest.approx(fall.max() / readable("m", fall.max()).size, rel=1e-6)
