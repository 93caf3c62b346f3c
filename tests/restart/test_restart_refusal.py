"""RESTART refuses every file that SAVE did not write as it is, as error 29, and says why."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from handmade import two_blocks
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from udec_ia import Model, __version__
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import puti, putr
from udec_ia.heap.array import MainArray
from udec_ia.heap.words import ALL_SCHEMES, scheme
from udec_ia.inspect.walk import groups
from udec_ia.layout import offsets as g
from udec_ia.layout.table import COMMON_TYPES, TABLE, parse
from udec_ia.restart import info, load, save
from udec_ia.restart.layout import text
from udec_ia.restart.seal import SIZE, seal

SCHEMES = tuple(ALL_SCHEMES)
SETTINGS = settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow], derandomize=True
)
ARRAYS = {name: two_blocks(name) for name in SCHEMES}
Edit = Callable[[h5py.File], None]


@pytest.fixture
def good(tmp_path: Path) -> Path:
    return save(ARRAYS["i32r64"], tmp_path / "two.h5", ["START"])


@pytest.fixture(scope="module")
def images(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The bytes of a good file of each scheme."""
    folder = tmp_path_factory.mktemp("good")
    return {name: save(array, folder / f"{name}.h5").read_bytes() for name, array in ARRAYS.items()}


def refusal(path: Path, read: Callable[[Path], Any] = load) -> str:
    """What `load` says about the file at `path`, without its name."""
    with pytest.raises(UdecError) as caught:
        read(path)
    error = caught.value
    assert error.number == 29
    assert error.detail.startswith(f"{path} ")
    assert error.advice
    return error.detail.removeprefix(f"{path} ")


def edit(path: Path, change: Edit) -> None:
    """Change the HDF5 part and seal it again, as a program that means to deceive would."""
    with h5py.File(path, "r+") as file:
        change(file)
    image = path.read_bytes()[SIZE:]
    path.write_bytes(seal(memoryview(image)) + image)


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


def test_the_other_table_names_the_version_to_use(good: Path) -> None:
    edit(good, new_table(TABLE.read_text().replace("KBRO ", ONE_MORE)))
    with pytest.raises(UdecError) as caught:
        load(good)
    assert caught.value.advice == f"read it with the version that wrote it, udec_ia {__version__}"
    assert "layout    not that of this program: word 33 is in two groups" in info(good)


def test_a_code_may_have_another_number(good: Path) -> None:
    """A table without names of codes, as they were before, is no other."""
    plain = "\n".join(line for line in TABLE.read_text().splitlines() if not line.startswith("CODE"))
    edit(good, new_table(plain + "\n"))
    assert load(good).deck == ["START"]
    edit(good, new_table(TABLE.read_text().replace("CODE   VIRTUAL        4", "CODE   VIRTUAL        5")))
    assert load(good).said == ["read with another field table: 1 code is under another number (VIRTUAL)"]


@pytest.mark.parametrize("name", SCHEMES)
def test_a_word_changed_behind_a_good_seal(name: str, tmp_path: Path) -> None:
    path = save(ARRAYS[name], tmp_path / "two.h5")

    def change(file: h5py.File) -> None:
        file["heap/IA"][5] += 1

    edit(path, change)
    assert refusal(path) == "is damaged: the checksum of /heap/IA is wrong"


def commons(array: MainArray, **values: int) -> Edit:
    """Set integers of the common block and its checksum."""

    def change(file: h5py.File) -> None:
        ci = array.h.ci.copy()
        for name, value in values.items():
            ci[getattr(g, name)] = value
            file[f"common/{name}"][()] = value
        digest = hashlib.sha256(ci.tobytes() + array.h.cr.tobytes() + array.h.cd.tobytes()).hexdigest()
        file["common"].attrs["sha256"] = text(digest)

    return change


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("mfree", [-(2**63), -1, 0, 2**15, 2**31, 2**63 - 1])
def test_mfree_out_of_range(name: str, mfree: int, tmp_path: Path) -> None:
    path = save(ARRAYS[name], tmp_path / "two.h5")
    edit(path, commons(ARRAYS[name], MFREE=mfree))
    assert f"MFREE {mfree} and MTOP" in refusal(path)


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("mtop", [-1, 0, 10, 2**63 - 1])
def test_mtop_out_of_range(name: str, mtop: int, tmp_path: Path) -> None:
    path = save(ARRAYS[name], tmp_path / "two.h5")
    edit(path, commons(ARRAYS[name], MTOP=mtop))
    what = refusal(path)
    assert f"and MTOP {mtop} are impossible in {name}" in what or "more than the memory available" in what


def test_sizes_that_only_exist_on_paper(tmp_path: Path) -> None:
    """A dataset of 8 TB takes no room in a file until it is written; it must not take memory either."""
    words = 2**40
    array = ARRAYS["i64r64"]
    path = save(array, tmp_path / "two.h5")

    def change(file: h5py.File) -> None:
        commons(array, MFREE=words + 1, MTOP=words)(file)
        kept = dict(file["heap/IA"].attrs)
        del file["heap/IA"]
        file.create_dataset("heap/IA", (words,), "<i8", chunks=(65536,), fletcher32=True).attrs.update(kept)

    edit(path, change)
    assert refusal(path) == "is damaged: /heap/IA is declared larger than the file"


@pytest.mark.parametrize("name", SCHEMES)
def test_pointers_that_lead_astray(name: str, tmp_path: Path) -> None:
    array = ARRAYS[name].copy()
    second = list(groups(array.h, "block"))[1]
    array.h.ci[g.IBPNT] = array.h.ci[g.MFREE] + 1000
    assert refusal(save(array, tmp_path / "two.h5")).startswith("holds an unsound heap: ")
    array.h.ci[g.IBPNT] = second
    assert refusal(save(array, tmp_path / "two.h5")).startswith("holds an unsound heap: ")


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("material", [-1, 0, 51, 32767])
def test_materials_that_do_not_exist(name: str, material: int, tmp_path: Path) -> None:
    array = ARRAYS[name].copy()
    (first, _) = groups(array.h, "block")
    puti(array.h, first, g.KMAT, material)
    what = refusal(save(array, tmp_path / "two.h5"))
    assert what == f"holds an unsound heap: KMAT of block@{first} is {material}, not 1 to 50"


def test_a_run_that_blew_up_can_be_looked_at(tmp_path: Path) -> None:
    array = ARRAYS["i32r64"].copy()
    for block in groups(array.h, "block"):
        putr(array.h, block, g.KXD, np.nan)
    restored, _, *_ = load(save(array, tmp_path / "two.h5"))
    assert np.isnan(restored.h.ra).sum() == 2


FLIPS = st.lists(st.tuples(st.floats(0, 1, exclude_max=True), st.integers(1, 255)), max_size=4)
FRONT_FLIPS = st.lists(st.tuples(st.integers(0, SIZE - 1), st.integers(1, 255)), max_size=2)

FREE_TO_CHANGE = [index for index in range(g.NCOMI) if index != g.MTOP]  # the array itself has MTOP words


@SETTINGS
@given(
    name=st.sampled_from(SCHEMES),
    flips=FLIPS,
    front=FRONT_FLIPS,
    cut=st.one_of(st.none(), st.floats(0, 1)),
    garbage=st.tuples(st.floats(0, 1), st.binary(max_size=16)),
)
def test_mutated_files(
    tmp_path_factory: pytest.TempPathFactory,
    images: dict[str, bytes],
    name: str,
    flips: list[tuple[float, int]],
    front: list[tuple[int, int]],
    cut: float | None,
    garbage: tuple[float, bytes],
) -> None:
    image = images[name]
    data = bytearray(image)
    for place, mask in [(int(share * len(image)), mask) for share, mask in flips] + front:
        data[place] ^= mask
    at = int(garbage[0] * len(data))
    data[at:at] = garbage[1]
    if cut is not None:
        del data[int(cut * len(data)) :]
    path = tmp_path_factory.getbasetemp() / "mutated.h5"
    path.write_bytes(data)
    if bytes(data) == image:
        assert load(path)[1] == []
    else:
        refusal(path)
        refusal(path, info)


@SETTINGS
@given(
    content=st.binary(max_size=2000),
    front=st.sampled_from([b"", b"udec_ia restart file\n", b"\x89HDF\r\n\x1a\n"]),
)
def test_garbage(tmp_path_factory: pytest.TempPathFactory, content: bytes, front: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "garbage.h5"
    path.write_bytes(front + content)
    refusal(path)


@SETTINGS
@given(
    name=st.sampled_from(SCHEMES),
    words=st.lists(
        st.tuples(st.floats(0, 1, exclude_max=True), st.integers(-(2**15), 2**15 - 1)), max_size=5
    ),
    integers=st.lists(st.tuples(st.sampled_from(FREE_TO_CHANGE), st.integers(-(2**40), 2**40)), max_size=1),
)
def test_mad_heaps_in_good_files(
    tmp_path_factory: pytest.TempPathFactory,
    name: str,
    words: list[tuple[float, int]],
    integers: list[tuple[int, int]],
) -> None:
    """Any words in the heap, well saved: they come back as they are, or are refused; nothing hangs."""
    array = ARRAYS[name].copy()
    used = int(array.h.ci[g.MFREE]) - 1
    for share, word in words:
        array.h.ia[int(share * used)] = word
    for index, value in integers:
        array.h.ci[index] = value
    path = tmp_path_factory.getbasetemp() / "mad.h5"
    save(array, path)
    with suppress(UdecError):
        restored, deck, *_ = load(path)
        assert [view.tobytes() for view in restored.h] == [view.tobytes() for view in array.h]
        assert (restored.scheme, restored.fixed, deck) == (array.scheme, array.fixed, [])


def test_a_refusal_names_what_was_meant(tmp_path: Path) -> None:
    """The message that a user sees, whole."""
    path = tmp_path / "deck.dat"
    path.write_text("START\n")
    with pytest.raises(UdecError) as caught:
        load(path)
    assert str(caught.value) == (
        f"error 29: restart file cannot be used: {path} is not a restart file of udec_ia\n"
        "RESTART reads files written by SAVE: give the name of such a file"
    )


def test_nothing_is_refused_without_reason(tmp_path: Path) -> None:
    assert load(save(MainArray(scheme("i16r32")), tmp_path / "empty.h5"))[1] == []


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
