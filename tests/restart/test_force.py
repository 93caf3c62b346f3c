"""SAVE and RESTART by force: unsound states are kept, marked, looked at and mended, and never run."""

from __future__ import annotations

import io
import json
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.checker import check, unchecked_parts
from udec_ia.cli import main
from udec_ia.deck.command_monitor import Monitor, run_deck
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.lines_and_calls import parse
from udec_ia.errors import UdecError
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import Unsound
from udec_ia.restart import info, look_into, read_stored_state

PRINTED = ["blocks", "contacts", "corners", "domains", "list", "dlist", "gridpoints", "zones", "boundaries"]


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sound state with groups of every kind, in the midst of a run with histories."""
    m = every_kind()
    m.out = tmp_path_factory.mktemp("saved")
    m.cycle(20)
    return m.save()


@pytest.fixture
def model(saved: Path, tmp_path: Path) -> Model:
    return Model.restore(saved, out=tmp_path)


def parsed(text: str) -> dict[str, object]:
    (statement,) = statements([text], "deck")
    return parse(statement).named


@pytest.mark.parametrize(
    ("text", "path", "force"),
    [
        ("SAVE", None, False),
        ("SAVE FORCE", None, True),
        ("RESTART force ; at last", None, True),
        ("SAVE a b.h5 Force", "a b.h5", True),
        ("SAVE a b.h5", "a b.h5", False),
        ("SAVE = x.h5   FORCE", "x.h5", True),
        ("SAVE FORCE.h5", "FORCE.h5", False),
        ("SAVE 'FORCE'", "FORCE", False),
        ('SAVE "my force" FORCE # twice', "my force", True),
        ('SAVE "a b" ! no', "a b", False),
        ("SAVE brute force FORCE", "brute force", True),
        ("SAVE x.h5 FORC", "x.h5 FORC", False),
        ("SAVE FORCE x.h5", "FORCE x.h5", False),
    ],
)
def test_the_word_stands_last(text: str, path: str | None, force: bool) -> None:
    named = ({"path": path} if path else {}) | ({"force": True} if force else {})
    assert parsed(text) == named


@pytest.mark.parametrize("text", ["SAVE 'x.h5' HARD", "SAVE 'x.h5'FORCED", "SAVE 'x.h5' FORCE y"])
def test_nothing_else_stands_behind_a_name(text: str) -> None:
    with pytest.raises(UdecError, match="put the whole name in quotes"):
        parsed(text)


def break_a_link(model: Model) -> tuple[int, int]:
    """Damage the link of a corner; its word and what it was."""
    at = int(model.table("corner")["address"][3]) + g.KL[model.array.scheme.ratio >> 1]
    was = int(model.h.ia[at - 1])
    model.h.ia[at - 1] = 7
    return at, was


def test_a_damaged_state_is_saved_looked_at_mended_and_goes_on(
    model: Model, saved: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    at, was = break_a_link(model)
    out = model.out
    with pytest.raises(UdecError, match="error 20"):
        model.save(out / "plain.h5")
    assert not (out / "plain.h5").exists()
    path = model.save(out / "bad.h5", force=True)
    found = [str(one) for one in Model.check_file(path)]
    assert found
    assert f"unsound   saved by force: {found[0]}" in info(path)
    with pytest.raises(UdecError) as caught:
        Model.restore(path)
    assert caught.value.number == 29
    assert caught.value.detail.startswith(f"{path} was saved by force, being unsound: {found[0]}")
    assert "FORCE" in caught.value.advice
    assert main(["check", str(path)]) == 1
    output = capsys.readouterr().out.splitlines()
    assert output[0] == f"{path}: {len(found)} violations"
    assert output[1].startswith("saved by force, being unsound: invariant")
    assert "not checked: what depends on broken links" in output
    assert len(output) == len(found) + 4
    forced = Model.restore(path, force=True, out=out / "forced")
    assert [str(one) for one in forced.check()] == found
    assert forced.dump(at, at)
    for refused in (lambda: forced.cycle(1), lambda: forced.split(0, 0, 1, 1), lambda: forced.solve(1e-3)):
        with pytest.raises(UdecError, match="error 20"):
            refused()
    again = forced.save(out / "again.h5", force=True)
    assert look_into(again).h.ia.tobytes() == look_into(path).h.ia.tobytes()
    forced.h.ia[at - 1] = was
    good = Model.restore(saved, out=out / "good")
    good.h.ia[at - 1] = was  # so that both find the time-step anew
    for m in (forced, good):
        m.cycle(10)
    assert [part.tobytes() for part in forced.array.h] == [part.tobytes() for part in good.array.h]
    assert [s.numbers.tobytes() for s in forced.histories()] == [
        s.numbers.tobytes() for s in good.histories()
    ]


def test_in_a_deck(model: Model) -> None:
    out = io.StringIO()
    break_a_link(model)
    monitor = Monitor(model, out)

    def obey(text: str) -> str:
        out.truncate(0)
        out.seek(0)
        for statement in statements([text], "deck"):
            monitor.execute(statement)
        return out.getvalue()

    with pytest.raises(UdecError, match="error 20"):
        obey("SAVE bad.h5")
    assert " SAVE: the state is unsound, and the file is marked so: invariant" in obey("SAVE bad.h5 FORCE")
    with pytest.raises(UdecError, match="error 29"):
        obey("RESTART bad.h5")
    told = obey("RESTART bad.h5 FORCE")
    assert " RESTART: saved by force, being unsound: invariant" in told
    assert " RESTART: taken by force: CYCLE and other commands that follow links are refused while" in told
    with pytest.raises(UdecError, match="error 20"):
        obey("CYCLE 1")


def test_a_run_that_comes_upon_damage_leaves_a_file_that_tells(model: Model) -> None:
    break_a_link(model)
    out = io.StringIO()
    with pytest.raises(UdecError) as caught:
        run_deck(model, "GRAVITY 0 -10\nCYCLE 1\n", out)
    rescue = model.out / "rescue.h5"
    assert f"the damaged state is saved in {rescue}" in str(caught.value)
    assert "the saved state is for inspection only: invariant" in out.getvalue()
    assert read_stored_state(rescue).mark
    run_deck(Model.restore(rescue, force=True, out=model.out), "SAVE first.h5 FORCE\n", out)
    with pytest.raises(UdecError) as caught:  # whatever the error is, there is a file
        run_deck(Model.restore(rescue, force=True, out=model.out), "FIX 0 1\n", out)
    assert caught.value.number == 7
    assert caught.value.saved == str(rescue)


def test_a_sound_state_is_not_marked(model: Model) -> None:
    path = model.save(model.out / "sound.h5", force=True)
    assert read_stored_state(path).mark == []
    assert Model.restore(path).check() == []


def test_histories_that_cannot_be_followed_are_left_out(model: Model) -> None:
    which = model.array.scheme.ratio >> 1
    history = int(model.h.ci[g.IHPNT]) - 1
    was = int(model.h.ia[history + g.KH[which]])
    assert len(model.histories()) == 4
    model.h.ia[history + g.KH[which]] = history + 1  # a circle
    path = model.save(model.out / "bad.h5", force=True)
    forced = Model.restore(path, force=True, out=model.out)
    assert forced.histories() == []
    forced.h.ia[history + g.KH[which]] = was
    later = Model.restore(forced.save(model.out / "mended.h5"), out=model.out)
    later.cycle(10)
    assert [len(one.numbers) > 0 for one in later.histories()] == [True] * 4


def test_whatever_is_damaged_can_be_looked_at(saved: Path, tmp_path: Path) -> None:
    """Random words, in IA() and in the common block: no command that only looks crashes, hangs or runs on."""
    rng = np.random.default_rng(8)
    for trial in range(5):
        m = Model.restore(saved, out=tmp_path)
        last = int(m.h.ci[g.MFREE]) - 1
        for _ in range(int(rng.integers(1, 6))):
            value = int(rng.choice([0, -1, 1, last, 2**31 - 1, -(2**31), int(rng.integers(last))]))
            if rng.random() < 0.2:
                place = int(rng.choice([i for i in range(g.NCOMI) if i not in (g.MFREE, g.MTOP)]))
                m.array.h.ci[place] = value
            else:
                m.array.h.ia[int(rng.integers(last))] = value
        m.session.written = True
        path = m.save(tmp_path / "bad.h5", force=True)
        forced = Model.restore(path, force=True, out=tmp_path)
        found = forced.check()
        assert [str(one) for one in found] == [str(one) for one in Model.check_file(path)]
        assert bool(found) == bool(read_stored_state(path).mark), trial
        for what in PRINTED:
            with suppress(Unsound):
                forced.print(what)
        forced.print("histories")
        forced.dump(1, last)
        for group in read_table().groups:
            with suppress(Unsound):
                forced.table(group.name)
        for command in (
            lambda m=forced: m.cycle(1),
            lambda m=forced: m.plot(0),
            lambda m=forced: m.balance(),
        ):
            with suppress(UdecError):
                command()
        forced.rset(1.0, 1, 9)
        forced.damping(0.5, 8.0)
        forced.save(tmp_path / "again.h5", force=True)
        assert forced.stop()


def test_what_is_not_checked_is_reported(
    model: Model, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert unchecked_parts(model.array) == []
    model.array.h.ci[g.JPHASE] = g.AT_CONTACTS
    model.array.h.ci[g.NSPOIL], model.array.h.ci[g.MCSPOI] = 15, 12
    path = model.save(tmp_path / "half.h5")
    expected = [
        "not checked: contacts against outlines, as the state stopped in the middle of a cycle, "
        "before the contact pass (JPHASE 2)",
        "not checked: which domain is the outer one, as error 15 in cycle 12, contact overlap too great, has "
        "ended a run of this state",
    ]
    assert unchecked_parts(model.array) == expected
    assert main(["check", str(path)]) == 0
    assert capsys.readouterr().out.splitlines() == [f"{path}: sound", *expected]
    assert [f"check     {one}" in info(path) for one in expected] == [True, True]
    told: list[str] = []
    model.inform = told.append
    assert model.check() == check(model.array) == []
    assert told == expected


def test_json_and_python_of_check(model: Model, capsys: pytest.CaptureFixture[str]) -> None:
    break_a_link(model)
    path = model.save(model.out / "bad.h5", force=True)
    found = check(look_into(path))
    assert main(["check", "--json", str(path)]) == 1
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert rows == [{"invariant": one.invariant, "what is wrong": one.message} for one in found]
    assert main(["check", str(path)]) == 1
    printed = capsys.readouterr().out
    assert main(["check", "--python", str(path)]) == 0
    exec(capsys.readouterr().out, {})
    assert capsys.readouterr().out == printed
    assert table(look_into(path), "block")["address"].any()


def test_the_list_of_relaxations_is_followed_only_when_it_is_sound(model: Model, tmp_path: Path) -> None:
    """A command that gives them back would follow it first of all."""
    model.h.ci[g.IRXPNT] = 10**8
    model.save(tmp_path / "bent.h5", force=True)
    model.restart(tmp_path / "bent.h5", force=True)
    for change in (lambda: model.delete(2, 3, 0, 1), lambda: model.fix(-9, 9, -9, 9)):
        with pytest.raises(UdecError, match="IRXPNT"):
            change()
    model.rset(1.0, int(table(model.array, "block")["address"][0]), 7)
    model.h.ci[g.IRXPNT] = 0
    assert model.session.is_sound()
