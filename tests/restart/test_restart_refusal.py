"""RESTART refuses every file that SAVE did not write as it is, as error 29, and says why."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from support.resealed_files import ARRAYS, SCHEMES, Edit, edit, refusal

from udec_ia import Model, __version__
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.layout.field_table import COMMON_TYPES, TABLE, parse
from udec_ia.restart import info, load, save
from udec_ia.restart.file_seal import SIZE, seal
from udec_ia.restart.file_tables import text


@pytest.fixture
def good(tmp_path: Path) -> Path:
    return save(ARRAYS["i32r64"], tmp_path / "two.h5", ["START"])


def test_what_is_not_a_restart_file(tmp_path: Path) -> None:
    assert refusal(tmp_path / "none.h5") == "does not exist"
    assert refusal(tmp_path / "no\0name") == "does not exist"
    assert refusal(tmp_path) == "is not a file"
    path = tmp_path / "file.h5"
    for content, what in (
        (b"", "is empty"),
        (b"START\nBLOCK 0 0 0 1 1 1\n", "is not a restart file of udec_ia"),
        (b"udec_ia rest", "is cut short: only 12 bytes are there"),
        (b"udec_ia restart file\n" + b"?" * 1000, "is damaged: its first lines cannot be read"),
    ):
        path.write_bytes(content)
        assert refusal(path) == what
    for userblock in (0, 512):
        with h5py.File(path, "w", userblock_size=userblock) as file:
            file["x"] = 1
        assert "is not a restart file" in refusal(path) or "but not a restart file" in refusal(path)


def test_a_refusal_names_what_was_meant(tmp_path: Path) -> None:
    """The message that a user sees, whole."""
    path = tmp_path / "deck.dat"
    path.write_text("START\n")
    with pytest.raises(UdecError) as caught:
        load(path)
    assert str(caught.value) == (
        f"error 29: file cannot be used: {path} is not a restart file of udec_ia\n"
        "RESTART reads files written by SAVE: give the name of such a file"
    )


def test_nothing_is_refused_without_reason(tmp_path: Path) -> None:
    assert load(save(MainArray(scheme("i16r32")), tmp_path / "empty.h5"))[1] == []


def test_a_foreign_file_behind_a_good_seal(good: Path) -> None:
    def clear(file: h5py.File) -> None:
        file.attrs["format"] = text("another program's")

    edit(good, clear)
    assert refusal(good) == "is an HDF5 file, but not a restart file of udec_ia"


def test_other_versions(good: Path) -> None:
    image = good.read_bytes()[SIZE:]
    good.write_bytes(seal(memoryview(image), (2, 7)) + image)
    assert refusal(good) == "has format 2.7, and this program reads format 1"
    assert refusal(good, info) == "has format 2.7, and this program reads format 1"
    good.write_bytes(seal(memoryview(image), (1, 8)) + image)
    assert refusal(good) == "is damaged: its first lines and the rest name different format versions"


def test_a_later_minor_version_is_read(good: Path) -> None:
    def later(file: h5py.File) -> None:
        file.attrs["format_version"] = np.array([1, 9], "<i4")
        file["later"] = 1.0

    edit(good, later)
    image = good.read_bytes()[SIZE:]
    good.write_bytes(seal(memoryview(image), (1, 9)) + image)
    assert load(good)[1] == ["START"]
    assert "1.9" in info(good)


@pytest.mark.parametrize("size", [1, 20, 21, 100, 511, 512, 513, 4096, -1])
def test_cut_short(good: Path, size: int) -> None:
    data = good.read_bytes()
    good.write_bytes(data[:size])
    assert refusal(good).startswith("is cut short: ")


def test_longer_than_it_was(good: Path) -> None:
    good.write_bytes(good.read_bytes() + b"\0")
    assert "and should have" in refusal(good)


def test_a_heap_that_rset_has_damaged_does_not_take_the_place_of_a_good_file(tmp_path: Path) -> None:
    model = Model(out=tmp_path)
    model.block(0, 0, 0, 10, 10, 10, 10, 0)
    model.split(-1, 5, 11, 5)
    good = model.save().read_bytes()
    model.rset(1.5, 1, 2)
    with pytest.raises(UdecError) as caught:
        model.save()
    assert caught.value.number == 20
    assert (tmp_path / "restart.h5").read_bytes() == good
    assert [path.name for path in tmp_path.iterdir()] == ["restart.h5"]
    model.restart()
    model.rset(2.5, 1, 8)  # KXD of the first block, a number
    assert model.save().read_bytes() != good


# ---- parts that contradict each other


def put(name: str, value: Any) -> Edit:
    """Put another dataset in the place of `name`, its attributes kept."""

    def change(file: h5py.File) -> None:
        kept = dict(file[name].attrs)
        del file[name]
        file[name] = value
        file[name].attrs.update(kept)

    return change


def attr(place: str, name: str, value: Any) -> Edit:
    def change(file: h5py.File) -> None:
        file[place].attrs[name] = value

    return change


def without(name: str) -> Edit:
    def change(file: h5py.File) -> None:
        del file[name]

    return change


def without_attr(place: str, name: str) -> Edit:
    def change(file: h5py.File) -> None:
        del file[place].attrs[name]

    return change


def new_table(table: str) -> Edit:
    def change(file: h5py.File) -> None:
        put("layout/table", text(table))(file)
        attr("layout", "sha256", text(hashlib.sha256(table.encode()).hexdigest()))(file)

    return change


def dangling(file: h5py.File) -> None:
    del file["deck"]
    file["deck"] = h5py.SoftLink("/nowhere")


def folder(file: h5py.File) -> None:
    del file["common/JUNK"]
    file.create_group("common/JUNK")


ONE_MORE = "KNEW  real  -   data   m     ours | a field of tomorrow\nKBRO "
CASES: dict[str, tuple[Edit, str]] = {
    "complete 0": (attr("/", "complete", np.int8(0)), "is not complete"),
    "no complete": (without_attr("/", "complete"), "is not complete"),
    "no format": (without_attr("/", "format"), "is damaged: / has no format"),
    "table changed": (put("layout/table", text("# nothing\n")), "the checksum of its field table is wrong"),
    "field more": (
        new_table(TABLE.read_text().replace("KBRO ", ONE_MORE)),
        "was written with another field table: word 33 is in two groups",
    ),
    "field less": (
        new_table(TABLE.read_text().replace("KBRO ", "#")),
        "was written with another field table: words 31 to 32 are in no group",
    ),
    "type": (
        new_table(TABLE.read_text().replace("KMAT   int ", "KMAT   real")),
        "was written with another field table: word 33 is in two groups",
    ),
    "gibberish": (new_table("GROUP\n"), "field table: it cannot be read here: groups.table:1"),
    "widths": (attr("heap/IA", "int_bits", np.int32(24)), "words of 24 and 64 bits, 2 to a real"),
    "common kind": (
        new_table(TABLE.read_text().replace("NBLK    int ", "NBLK    real")),
        "/common/NBLK holds integers of 8 bytes, not little-endian float64",
    ),
    "ratio": (attr("heap/IA", "ratio", np.int32(4)), "words of 32 and 64 bits, 4 to a real"),
    "no widths": (without_attr("heap/IA", "real_bits"), "/heap/IA has no real_bits"),
    "no heap": (without("heap/IA"), "/heap/IA is not there"),
    "no common": (without("common/AKN"), "/common/AKN is not there"),
    "common type": (
        put("common/JUNK", np.int32(0)),
        "/common/JUNK holds integers of 4 bytes, not little-endian int64",
    ),
    "common shape": (put("common/AKN", np.zeros(49)), "/common/AKN has the shape (49,) instead of (50,)"),
    "common value": (put("common/NBLK", np.int64(3)), "the checksum of /common is wrong"),
    "common folder": (folder, "/common/JUNK is no dataset"),
    "big-endian": (
        put("common/GRAVX", np.array(0.0, ">f8")),
        "/common/GRAVX holds reals of 8 bytes, not little-endian float64",
    ),
    "deck type": (put("deck", 1.0), "/deck is not a text of fixed length"),
    "deck link": (dangling, "/deck is a link that leads elsewhere"),
    "deck text": (put("deck", np.array(b"\xff\xfe\n", "S3")), "cannot be understood"),
}


@pytest.mark.parametrize("case", CASES)
def test_parts_that_contradict_each_other(good: Path, case: str) -> None:
    change, what = CASES[case]
    edit(good, change)
    assert what in refusal(good)


@pytest.mark.parametrize("name", SCHEMES)
def test_a_word_changed_behind_a_good_seal(name: str, tmp_path: Path) -> None:
    path = save(ARRAYS[name], tmp_path / "two.h5")

    def change(file: h5py.File) -> None:
        file["heap/IA"][5] += 1

    edit(path, change)
    assert refusal(path) == "is damaged: the checksum of /heap/IA is wrong"


def loop(file: h5py.File) -> None:
    del file["recorded"]
    file["recorded"] = file["/"]


@pytest.mark.parametrize("change", [without("recorded"), without("recorded/1"), loop])
def test_a_history_without_what_it_has_recorded(change: Edit, tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.history(1, "KX", at=(0.5, 0.5))
    path = m.save(tmp_path / "a.h5")
    load(path)
    edit(path, change)
    assert "/recorded/1 is not there, though there is such a history" in refusal(path)


# ---- field tables


def test_a_table_with_other_words_means_the_same(good: Path) -> None:
    """Comments, texts, units and pages may change: the words of IA() stand where they stood."""
    table = TABLE.read_text().replace("m/s2  38 |", "m/s**2  39 | the").replace("# type ", "# Type ")
    assert table != TABLE.read_text()
    edit(good, new_table(table + "\n# more\n"))
    assert load(good).deck == ["START"]
    assert "layout    that of this program\n" in info(good)


def of_table(table: str, **values: Any) -> Edit:
    """As a program with the common block of another `table` would write it; `values` are what ours lacks."""

    def change(file: h5py.File) -> None:
        new_table(table)(file)
        for name, value in values.items():
            file[f"common/{name}"] = value
        parts: dict[str, list[bytes]] = {kind: [] for kind in COMMON_TYPES}
        for field in parse(table).common:
            parts[field.type].append(file[f"common/{field.name}"][()].tobytes())
        digest = hashlib.sha256(b"".join(part for kind in parts.values() for part in kind)).hexdigest()
        file["common"].attrs["sha256"] = text(digest)

    return change


HEAD = next(line for line in TABLE.read_text().splitlines(True) if line.startswith("NCYC "))
LATER = TABLE.read_text().replace(HEAD, "LNEW  int  -  data  -  ours | of tomorrow\n" + HEAD)
EARLIER = "".join(line for line in TABLE.read_text().splitlines(True) if not line.startswith("EPOT"))


def test_the_common_block_is_read_by_names(good: Path) -> None:
    """A variable more, a variable less, and another order: each goes to its own place."""
    ours = load(good).array
    edit(good, of_table(LATER, LNEW=np.int64(0)))
    assert parts(load(good).array) == parts(ours)
    edit(good, of_table(EARLIER))
    assert parts(load(good).array) == parts(ours)
    lines = TABLE.read_text().splitlines(True)
    start = next(i for i, line in enumerate(lines) if line.startswith("COMMON")) + 1
    edit(good, of_table("".join(lines[:start] + lines[: start - 1 : -1])))
    assert parts(load(good).array) == parts(ours)
    assert "2 blocks, 2 contacts" in info(good)


def parts(array: MainArray) -> list[bytes]:
    return [view.tobytes() for view in array.h]


def test_what_this_version_cannot_tell_is_no_small_thing(good: Path) -> None:
    """A variable that has gone may be left out only if it is 0."""
    edit(good, of_table(LATER, LNEW=np.int64(7)))
    assert "another field table: LNEW is 7, and that field is not known here" in refusal(good)


def test_the_other_table_names_the_version_to_use(good: Path) -> None:
    edit(good, new_table(TABLE.read_text().replace("KBRO ", ONE_MORE)))
    with pytest.raises(UdecError) as caught:
        load(good)
    assert caught.value.advice == f"read it with the version that wrote it, udec_ia {__version__}"
    assert "layout    not that of this program: word 33 is in two groups" in info(good)


def test_a_code_may_have_another_number(good: Path) -> None:
    """A table without names of codes, as they were before, is no other."""
    lines = (
        TABLE.read_text().replace("int*50   codes", "int*50   0..3").replace("codes ", "0..2  ").splitlines()
    )
    plain = "\n".join(line for line in lines if not line.startswith("CODE"))
    edit(good, new_table(plain + "\n"))
    assert load(good).deck == ["START"]
    edit(good, new_table(TABLE.read_text().replace("CODE   VIRTUAL        4", "CODE   VIRTUAL        5")))
    assert load(good).notes == ["read with another field table: codes under another number: 1 (VIRTUAL)"]
