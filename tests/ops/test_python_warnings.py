"""Warnings are Python warnings and log records: at the line of the user, seen once, and errors on request."""

from __future__ import annotations

import pickle
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from udec_ia import Model, UdecWarning

SCRIPT = """from udec_ia import Model
m = Model()
m.property(1, friction=35)
"""


def falling(out: Path) -> Model:
    """A block that leaves the scene as soon as it moves, and takes a bolt with it."""
    m = Model(out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.gravity(0, -10)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.block(0, 2, 0, 3, 1, 3, 1, 2)
    m.block(3, 0, 3, 1, 4, 1, 4, 0)
    m.fix(0, 5, 0, 1)
    m.history(1, "KY", at=(0.5, 2.5))
    m.delete("OUTSIDE -1 5 -1 2.4999")
    return m


def test_a_warning_names_the_line_of_the_user_and_its_key() -> None:
    with pytest.warns(UdecWarning, match="35 of material 1 is a tangent") as seen:
        Model().property(1, friction=35)
    (one,) = seen
    assert one.filename == __file__
    assert isinstance(one.message, UdecWarning)
    assert one.message.key == "degrees-for-tangent"
    assert pickle.loads(pickle.dumps(one.message)).key == "degrees-for-tangent"


@pytest.mark.parametrize(("before", "times"), [("", 1), ("import logging; logging.basicConfig()\n", 2)])
def test_how_often_it_is_seen(before: str, times: int, tmp_path: Path) -> None:
    """Once by default; the log has it too where the user has configured one."""
    (tmp_path / "user.py").write_text(before + SCRIPT)
    command = [sys.executable, "user.py"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("35 of material 1 is a tangent") == times
    assert "user.py:" in done.stderr
    assert "UdecWarning" in done.stderr


def test_a_deck_prints_its_warnings_and_gives_none(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "is a tangent" in (Model(out=tmp_path).run("START\nPROP MAT=1 FRICTION=35\n") or "")


def test_as_an_error_it_undoes_its_command(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.property(1, friction=0.5)
    lines = m.deck()
    with warnings.catch_warnings():
        warnings.simplefilter("error", UdecWarning)
        with pytest.raises(UdecWarning):
            m.property(1, friction=35)
    assert m.deck() == lines
    assert "0.5" in m.deck()


def test_as_an_error_at_the_end_of_a_run_it_leaves_the_cycles(tmp_path: Path) -> None:
    """The recorded block is deleted: the cycles are final, and the deck has them."""
    m = falling(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error", UdecWarning)
        with pytest.raises(UdecWarning, match="deleted"):
            m.cycle(30)
    assert len(m.table("block")) == 2
    assert "CYCLE 30" in m.deck()
    assert m.check() == []
    same = Model(out=tmp_path / "same")
    same.run(m.deck())
    assert same.table("block")["address"].tolist() == m.table("block")["address"].tolist()
