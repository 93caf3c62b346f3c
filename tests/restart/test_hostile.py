"""Hostile restart files: what is in them is judged before it is read (tools/damaged_files.py hostile)."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from damage.content_edits import new_table
from damage.hostile_files import base
from damage.storage_edits import packed_names

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.layout.field_table import TABLE
from udec_ia.printable_text import printable
from udec_ia.restart import info
from udec_ia.restart.file_seal import SIZE, seal
from udec_ia.restart.file_tables import text

TOOL = Path(__file__).parents[2] / "tools" / "damaged_files.py"


@pytest.fixture(scope="module")
def image(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A good file with histories."""
    return base(tmp_path_factory.mktemp("base"))


def forged(image: bytes, path: Path, change: Callable[[h5py.File], object]) -> Path:
    buffer = io.BytesIO(image)
    with h5py.File(buffer, "r+") as file:
        change(file)
    body = buffer.getvalue()[SIZE:]
    path.write_bytes(seal(memoryview(body)) + body)
    return path


def refusal(path: Path) -> str:
    with pytest.raises(UdecError) as caught:
        Model.restore(path)
    assert caught.value.number == 29
    return caught.value.detail.removeprefix(f"{path} ")


def test_a_good_file_is_read(image: bytes, tmp_path: Path) -> None:
    path = forged(image, tmp_path / "good.h5", lambda file: None)
    assert len(Model.restore(path).histories()[0].numbers) == 4


def replaced(file: h5py.File, place: str, shape: tuple[int, ...], kind: str, **how: object) -> None:
    kept = dict(file[place].attrs)
    del file[place]
    file.create_dataset(place, shape, kind, **how).attrs.update(kept)


STORED = "is not stored as SAVE stores it"
VALUE = "recorded/1/value"
CASES: dict[str, tuple[Callable[[h5py.File], object], str]] = {
    "bomb": (lambda f: replaced(f, VALUE, (2**27,), "<f8", compression="gzip"), STORED),
    "paper": (lambda f: replaced(f, VALUE, (2**27,), "<f8"), STORED),
    "outside": (lambda f: replaced(f, VALUE, (4,), "<f8", external=[("secret", 0, 32)]), STORED),
    "outside, deck": (lambda f: replaced(f, "deck", (), "S10", external=[("secret", 0, 10)]), STORED),
    "any length": (
        lambda f: replaced(f, "deck", (), h5py.string_dtype()),
        "/deck is not a text of fixed length",
    ),
    "rank": (lambda f: replaced(f, VALUE, (1,) * 32, "<f8"), "instead of one row"),
    "names": (lambda f: packed_names(np.random.default_rng(3), f, Path()), "/recorded is no group"),
    "attribute": (
        lambda f: f["recorded/1"].attrs.create("group", text("x" * 5000)),
        "/recorded/1, group is a text of 5000 bytes",
    ),
    "formula": (
        lambda f: f["recorded/1"].attrs.create("place", text("$\\frac$")),
        "does not say of what it is the history",
    ),
    "back in time": (
        lambda f: f["recorded/1/cycle"].write_direct(np.array([3, 2, 1, 0])),
        "does not hold numbers as a history does",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_what_is_refused_before_it_is_read(
    case: str, image: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("secret").write_bytes(bytes(64))
    change, what = CASES[case]
    assert what in refusal(forged(image, tmp_path / "bad.h5", change))


def test_one_dataset_under_many_names(image: bytes, tmp_path: Path) -> None:
    """Each is no larger than the file; together they are."""

    def change(file: h5py.File) -> None:
        for name, kind in (("cycle", "<i8"), ("time", "<f8"), ("value", "<f8")):
            del file[f"recorded/2/{name}"]
            file[f"recorded/2/{name}"] = np.arange(10000).astype(kind)
        for number in (3, 4, 5):
            del file[f"recorded/{number}"]
            file[f"recorded/{number}"] = file["recorded/2"]

    assert "is declared larger than the file" in refusal(forged(image, tmp_path / "bad.h5", change))


NASTY = "\x1b]0;mine\x07\u202egnp.exe\r\n"


def test_what_others_wrote_is_printed_plainly(image: bytes, tmp_path: Path) -> None:
    def change(file: h5py.File) -> None:
        file["laws/cl2"].attrs["file"] = text(NASTY)
        file["provenance"].attrs["numpy"] = text(b"\xff\xfe" + b"x" * 3000)
        del file["volatile/host"]
        file["volatile/host"] = text(NASTY)

    path = forged(image, tmp_path / "nasty.h5", change)
    printed = info(path)
    assert all(line.isprintable() and len(line) < 2000 for line in printed.splitlines())
    assert r"law       cl2 of \x1b]0;mine\x07\u202egnp.exe\r\n, sha256" in printed
    assert r" on \x1b]0;mine\x07" in printed
    assert r"numpy \xff\xfexxx" in printed
    law = tmp_path / "law.py"
    law.write_text("def cl2(s11, s12, s22, de11, de12, de22, m):\n    return 0.0, 0.0, 0.0\n")
    model, told = Model(constitutive=law), []
    model.tell = told.append
    model.restart(path)
    assert [one.isprintable() for one in told] == [True]


def test_errors_are_printed_plainly(image: bytes, tmp_path: Path) -> None:
    """Whether the name of the file or what is in it would fool a terminal."""
    table = TABLE.read_bytes().replace(b"KBRO ", b"K\x1b[2J" + b"x" * 5000 + b" ")
    bad = forged(image, tmp_path / "bad.h5", lambda file: new_table(file, table))
    for path in (bad, tmp_path / f"{NASTY}.h5"):
        with pytest.raises(UdecError) as caught:
            Model.restore(path)
        assert all(line.isprintable() and len(line) < 1000 for line in str(caught.value).splitlines())


@pytest.mark.parametrize(
    ("given", "shown"),
    [
        ("plain, \u00e9 too", "plain, \u00e9 too"),
        ("a\x1b[2Jb", r"a\x1b[2Jb"),
        ("\u202e\u200b", r"\u202e\u200b"),
        ("\udcff\n", r"\udcff\n"),
        ("x" * 101, "x" * 100 + "..."),
    ],
)
def test_printable(given: str, shown: str) -> None:
    assert printable(given) == shown


def test_hostile_files() -> None:
    """A part of the tool's, each read with little memory and time by a process of its own."""
    arguments = [sys.executable, str(TOOL), "hostile", "--files", "25", "--seed", "2"]
    root = str(TOOL.parent.parent)
    done = subprocess.run(
        arguments, env={**os.environ, "PYTHONPATH": root}, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "25 files, 0 failures" in done.stdout
