"""Runs that go on from a restart file: their names and folders, and what was drawn before."""

from __future__ import annotations

from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.file_replacement import last_number


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """A restart file with a history, in a folder with two pictures of its run."""
    m = Model(out=tmp_path, name="run")
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.gravity(0, -10)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1)
    m.fix(0, 2, 0, 1)
    m.history(1, "unbalanced")
    m.cycle(3)
    m.plot()
    m.plot()
    m.plot(history=True)
    m.stop()
    return m.save()


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_restored_models_have_a_folder_and_a_name(saved: Path) -> None:
    """Two of them go on side by side."""
    one, two = (Model.restore(saved, out=saved.parent, name=name) for name in ("one", "two"))
    one.cycle(2)
    two.cycle(5)
    rows = [
        (saved.parent / f"{m.name}-history.csv").read_text().splitlines()[-1].split(",")[0]
        for m in (one, two)
    ]
    assert rows == ["5", "8"]
    assert Model.restore(saved, mtop=20_000).array.fixed


def test_pictures_of_a_run_that_goes_on_leave_those_before_alone(saved: Path) -> None:
    before = contents(saved.parent)
    m = Model.restore(saved, out=saved.parent, name="run")
    m.cycle(1)
    m.plot()
    m.plot(history=True)
    m.stop()
    after = contents(saved.parent)
    kept = [name for name in before if name.endswith((".png", ".svg"))]
    assert len(kept) == 6
    assert all(before[name] == after[name] for name in kept)
    new = sorted(after.keys() - before.keys())
    assert new == ["run-history-2.png", "run-history-2.svg", "run-plot-3.png", "run-plot-3.svg"]


def test_a_run_from_the_start_draws_its_pictures_anew(saved: Path) -> None:
    m = Model(out=saved.parent, name="run")
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.plot()
    m.stop()
    assert sorted(path.name for path in saved.parent.glob("run-plot-*.png")) == [
        "run-plot-1.png",
        "run-plot-2.png",
    ]


def test_the_last_number_of_a_file(tmp_path: Path) -> None:
    for name in ("a-1.png", "a-12.svg", "a-13", "a-x-14.png", "b-15.png", "a-7.txt"):
        (tmp_path / name).touch()
    assert last_number(tmp_path, "a") == 12
    assert last_number(tmp_path / "none", "a") == 0
