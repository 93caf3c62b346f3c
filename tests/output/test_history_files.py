"""Files of histories are extended after every CYCLE, and are whole at every moment, whatever happens."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest
from support.mechanics_scenes import G

from udec_ia import Model, UdecError
from udec_ia.output import history_files

CSV, HDF5 = "udec-history.csv", "udec-history.h5"


def check_files(m: Model) -> None:
    """Both files have the numbers that the model has recorded, and no other file is there."""
    lines = (m.out / CSV).read_text().splitlines()
    assert len(lines) == 1 + len({cycle for one in m.histories() for cycle in one.numbers[:, 0]})
    with h5py.File(m.out / HDF5) as file:
        for series in m.histories():
            group = file[str(series.number)]
            written = np.column_stack([group[column] for column in ("cycle", "time", "value")])
            assert np.array_equal(written, series.numbers)
    assert sorted(path.name for path in m.out.iterdir()) == [CSV, HDF5]


def test_a_file_is_extended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the new numbers become text."""
    m, made = falling(tmp_path), list[int]()
    lines = history_files._lines

    def count(numbers: list[np.ndarray]) -> bytes:
        made.append(len(numbers[0]))
        return lines(numbers)

    monkeypatch.setattr(history_files, "_lines", count)
    for n in (4, 0, 3, 5):
        m.cycle(n)
        check_files(m)
    assert made == [5, 3, 5]


def test_what_is_interrupted_is_not_in_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    m = falling(tmp_path)
    m.cycle(4)
    before = (tmp_path / CSV).read_bytes(), (tmp_path / HDF5).read_bytes()

    def fail(_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr("os.chown", fail, raising=False)
        patched.setattr("udec_ia.file_replacement._keep_rights", lambda *_: fail(None))
        with pytest.raises(KeyboardInterrupt):
            m.cycle(3)
    assert ((tmp_path / CSV).read_bytes(), (tmp_path / HDF5).read_bytes()) == before
    m.cycle(2)
    check_files(m)


@pytest.mark.parametrize("name", [CSV, HDF5])
@pytest.mark.parametrize("what", ["goes", "changes"])
def test_what_somebody_else_has_changed_is_written_anew(tmp_path: Path, name: str, what: str) -> None:
    m, file = falling(tmp_path), tmp_path / name
    m.cycle(4)
    if what == "goes":
        file.unlink()
    else:
        file.write_bytes(file.read_bytes()[:6] + b" and something else")
    for _ in range(2):
        m.cycle(3)
        check_files(m)


def test_numbers_that_were_taken_back_are_not_in_the_files(tmp_path: Path) -> None:
    """A run that continues from an earlier state of it."""
    m = falling(tmp_path)
    m.cycle(4)
    former = m.array.copy()
    m.cycle(6)
    m.session.return_to(former, [])
    m.cycle(8)
    check_files(m)


def test_a_file_of_another_kind_that_comes_between_stays(tmp_path: Path) -> None:
    m = falling(tmp_path)
    m.cycle(4)
    (tmp_path / CSV).write_text("notes\n")
    with pytest.raises(UdecError) as caught:
        m.cycle(2)
    assert caught.value.number == 31
    assert (tmp_path / CSV).read_text() == "notes\n"
    assert len(list(tmp_path.iterdir())) == 2


def test_a_mode_is_kept(tmp_path: Path) -> None:
    m = falling(tmp_path)
    m.cycle(4)
    (tmp_path / CSV).chmod(0o600)
    m.cycle(2)
    assert (tmp_path / CSV).stat().st_mode & 0o777 == 0o600


def falling(out: Path) -> Model:
    m = Model(out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.gravity(0, -G)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1)
    m.fix(0, 2, 0, 1)
    m.history(1, "KY", at=(1, 1.5))
    m.history(3, "unbalanced")
    return m


def test_many_short_cycles_leave_the_files_of_one_long_one(tmp_path: Path) -> None:
    """Also while somebody holds them open; a history that is added on the way makes a new column."""
    one, many = falling(tmp_path / "one"), falling(tmp_path / "many")
    one.cycle(26)
    recorded = 1
    for n in range(12):
        many.cycle(2)
        many.cycle(0)
        recorded += 2
        with h5py.File(tmp_path / "many" / "udec-history.h5") as file:
            assert len(file["1/value"]) == recorded
            if n in (4, 9):
                many.cycle(1)
                recorded += 1
    for m in (one, many):
        m.history(5, "TIME")
        m.cycle(10)
        m.stop()
    texts = [(tmp_path / name / "udec-history.csv").read_text() for name in ("one", "many")]
    assert texts[0] == texts[1]
    for m, name in ((one, "one"), (many, "many")):
        with h5py.File(tmp_path / name / "udec-history.h5") as file:
            for series in m.histories():
                group = file[str(series.number)]
                written = np.column_stack([group[column] for column in ("cycle", "time", "value")])
                assert np.array_equal(written, series.numbers)
        assert sorted(path.name for path in (tmp_path / name).iterdir()) == [
            "udec-history.csv",
            "udec-history.h5",
        ]
