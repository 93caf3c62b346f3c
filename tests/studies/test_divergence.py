"""Two runs side by side: a difference that is planted is found in its cycle and pass."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.errors import UdecError
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import table
from udec_ia.studies.divergence import Divergence, find_divergence, of_deck

DECK = """\
START
PROPERTY MAT=1 DENSITY=2000 KN=1.E8 KS=1.E8 FRICTION=0.5
BLOCK 0,0 0,3 4,3 4,0
SPLIT -1,1 5,1
SPLIT 2,0 2,4
FIX 0,4 0,1.2
GRAVITY 3 -10
CYCLE 30
{command}
CYCLE 200
"""
PLAIN = DECK.format(command="")


def decks(tmp_path: Path, command: str, share: float = 0.0) -> Divergence | int:
    """Where the deck with a command after 30 cycles parts from that without."""
    runs = [of_deck(Model(out=tmp_path), text) for text in (PLAIN, DECK.format(command=command))]
    return find_divergence(runs[0], runs[1], share)


def first_cycle_by_hand(tmp_path: Path, command: str) -> int:
    """The first cycle after which any bit of a contact or a block is another, one by one."""
    models = [Model(out=tmp_path), Model(out=tmp_path)]
    for model, line in zip(models, ("", command), strict=True):
        model.run(DECK.format(command=line).replace("CYCLE 200\n", ""))
    for cycle in range(31, 231):
        for model in models:
            model.cycle(1)
        for kind in ("block", "contact"):
            one, two = (table(model.array, kind) for model in models)
            if any(one[name].tobytes() != two[name].tobytes() for name in one.dtype.names):
                return cycle
    return 0


def test_nothing_differs(tmp_path: Path) -> None:
    assert decks(tmp_path, "* nothing") == 230


def test_what_a_command_does_at_once(tmp_path: Path) -> None:
    """It is no cycle's doing."""
    model = Model(out=tmp_path)
    model.run(PLAIN.partition("CYCLE")[0])
    blocks = model.table("block")
    free = f"block@{blocks['address'][blocks['KBFIX'] == 0][0]}"
    found = decks(tmp_path, f"PATCH {free}.KXD = 0.5", 1e-9)
    assert isinstance(found, Divergence)
    assert (found.cycle, found.in_pass) == (30, "")
    assert (found.off.group, found.off.field, found.off.second) == (free, "KXD", 0.5)


def test_another_gravity(tmp_path: Path) -> None:
    """The motion of the next cycle feels it."""
    found = decks(tmp_path, "GRAVITY 3 -11")
    assert isinstance(found, Divergence)
    assert (found.cycle, found.in_pass) == (31, "move_blocks")


@pytest.mark.parametrize("friction", [0.3, 0.29, 0.2])
def test_another_friction(friction: float, tmp_path: Path) -> None:
    """Nothing differs until a contact slips: then a force does, and what follows from it."""
    command = f"PROPERTY MAT=1 FRICTION={friction}"
    expected = first_cycle_by_hand(tmp_path, command)
    found = decks(tmp_path, command)
    assert isinstance(found, Divergence)
    assert 30 < expected == found.cycle
    assert found.in_pass == "ford_all"
    forces = [table(state, "contact")["KCFS"] for state in found.states]
    assert not np.array_equal(*forces)


def test_what_commands_have_set_is_compared_before_any_cycle(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Properties that no cycle has used yet, and gravity; then the search goes on as without."""
    one, two = tmp_path / "one.dat", tmp_path / "two.dat"
    one.write_text(PLAIN)
    moduli = {"BULK(1)": 4e8, "SHEAR(1)": 3e8, "ALAM1(1)": 8e8, "ALAM2(1)": 2e8}  # K + 4/3 G and K - 2/3 G
    keep = ["--keep", str(tmp_path / "a.h5"), str(tmp_path / "b.h5"), "--json"]
    for old, new, names, cycle in (
        ("FRICTION=0.5", "FRICTION=0.5 BULK=4E8 G=3E8", [*moduli], 0),
        ("GRAVITY 3", "GRAVITY 4", ["GRAVX"], 1),
        ("FRICTION=0.5", "FRICTION=0.500000001", [], 0),
    ):
        two.write_text(PLAIN.replace(old, new))
        status = main(["diverge", str(one), str(two), *keep])
        found = json.loads(capsys.readouterr().out)
        assert status == bool(names)
        rows = [row for row in found["rows"] if row["group"] == "common block"]
        assert [row["field"] for row in rows] == names
        assert all(row["second"] == pytest.approx(moduli.get(row["field"], 4)) for row in rows)
        assert any(f"in cycle {cycle} " in line for line in found["head"]) == bool(cycle)
        assert len(found["rows"]) == len(rows) + bool(cycle)


def test_states_that_go_on(tmp_path: Path) -> None:
    """From the middle of a run: the one that has slipped from the start of that on."""
    models = [Model(out=tmp_path), Model(out=tmp_path)]
    for model in models:
        model.run(PLAIN.replace("CYCLE 200\n", ""))
    models[1].property(1, friction=0.2)
    found = find_divergence(of_deck(models[0], "CYCLE 200"), of_deck(models[1], "CYCLE 200"), 0.0)
    assert isinstance(found, Divergence)
    expected = first_cycle_by_hand(tmp_path, "PROPERTY MAT=1 FRICTION=0.2")
    assert (found.cycle, found.in_pass) == (expected, "ford_all")


def test_decks_that_cannot_be_in_step(tmp_path: Path) -> None:
    texts = PLAIN, PLAIN.replace("CYCLE 30", "CYCLE 31")
    one, two = (of_deck(Model(out=tmp_path), text) for text in texts)
    with pytest.raises(UdecError, match="30 cycles"):
        find_divergence(one, two, None)
    texts = PLAIN, PLAIN.replace("CYCLE 200", "SOLVE 0 LIMIT 131")
    one, two = (of_deck(Model(out=tmp_path), text) for text in texts)
    with pytest.raises(UdecError, match=r"SOLVEs that end after as many cycles"):
        find_divergence(one, two, None)


RESTING = PLAIN.replace("GRAVITY 3", "DAMPING 0.5 5 MASS\nGRAVITY 0").replace("CYCLE 200", "SOLVE {ratio}")


@pytest.mark.parametrize("ratio", [0.5, 0.01])
def test_solves_end_as_they_do_alone(ratio: float, tmp_path: Path) -> None:
    text = RESTING.format(ratio=ratio)
    alone = Model(out=tmp_path)
    alone.run(text)
    cycles = int(alone.h.ci[g.MCTOT])
    assert 30 < cycles < 3000
    one, two = (of_deck(Model(out=tmp_path), text) for _ in range(2))
    assert find_divergence(one, two, 0.0) == cycles
    assert np.array_equal(
        one.model.h.ia[: one.model.h.ci[g.MFREE] - 1], alone.h.ia[: alone.h.ci[g.MFREE] - 1]
    )


def test_a_deck_that_goes_on_from_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is beside the deck, or where one stands; a deck that has written one goes on from its own."""
    (tmp_path / "decks").mkdir()
    model = Model(out=tmp_path / "decks")
    model.run(PLAIN.replace("CYCLE 200", "SAVE state.h5"))
    model.run("GRAVITY 0 -1\nSAVE\nSAVE other.h5")
    (tmp_path / "decks" / "other.h5").rename(tmp_path / "other.h5")
    monkeypatch.chdir(tmp_path)
    for restart, cycles in (
        ("state.h5", 3),
        ("other.h5", 3),
        ("", 3),
        ("state.h5\nSAVE\nCYCLE 2\nRESTART", 5),
    ):
        for name, friction in (("one", 0.5), ("two", 0.49)):
            text = f"RESTART {restart}\nPROPERTY MAT=1 FRICTION={friction}\nCYCLE 3\n"
            (tmp_path / "decks" / f"{name}.dat").write_text(text)
        assert main(["diverge", "decks/one.dat", "decks/two.dat", "--tolerance", "1"]) == 0
        assert capsys.readouterr().out == f"no difference in {cycles} cycles\n"
    assert sorted(path.name for path in (tmp_path / "decks").iterdir()) == [
        "one.dat",
        "restart.h5",
        "state.h5",
        "two.dat",
    ]
    (tmp_path / "decks" / "one.dat").write_text("RESTART nowhere.h5\n")
    assert main(["diverge", "decks/one.dat", "decks/two.dat"]) == 2
    assert "nowhere.h5" in capsys.readouterr().err


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one, two = tmp_path / "one.dat", tmp_path / "two.dat"
    one.write_text(PLAIN)
    two.write_text(DECK.format(command="GRAVITY 3 -11"))
    kept = [str(tmp_path / name) for name in ("a.h5", "b.h5")]
    assert main(["diverge", str(one), str(two), "--tolerance", "0", "--keep", *kept, "--json"]) == 1
    printed = json.loads(capsys.readouterr().out)
    assert "in cycle 31 of one.dat:10: CYCLE 200, after the pass move_blocks" in printed["head"][0]
    assert main(["diff", *kept, "--only", "block.KYD"]) == 1
    assert main(["diverge", *kept, "--cycles", "3", "--tolerance", "1"]) == 0
    assert capsys.readouterr().out.endswith("no difference in 3 cycles\n")
    assert main(["diverge", str(one), "--builds", "i32r64,i64r64"]) == 0
    for wrong in ([str(one)], [str(one), "--builds", "i8"], [*kept, "--cycles", "-1"], [str(one), "no.dat"]):
        assert main(["diverge", *wrong]) == 2
    assert capsys.readouterr().err.endswith("udec diverge: no.dat: No such file or directory\n")
    assert main(["diverge", str(one), str(two), "--python"]) == 0
    assert "of_deck" in capsys.readouterr().out
