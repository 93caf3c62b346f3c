"""Restart files with any bytes changed, or any words in the heap: read as they are or refused as error 29."""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support.resealed_files import ARRAYS, SCHEMES, refusal

from udec_ia.errors import UdecError
from udec_ia.layout import offsets as g
from udec_ia.restart import info, load, save
from udec_ia.restart.file_seal import SIZE

SETTINGS = settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow], derandomize=True
)
FLIPS = st.lists(st.tuples(st.floats(0, 1, exclude_max=True), st.integers(1, 255)), max_size=4)
FRONT_FLIPS = st.lists(st.tuples(st.integers(0, SIZE - 1), st.integers(1, 255)), max_size=2)
FREE_TO_CHANGE = [index for index in range(g.NCOMI) if index != g.MTOP]  # the array itself has MTOP words


@pytest.fixture(scope="module")
def images(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The bytes of a good file of each scheme."""
    folder = tmp_path_factory.mktemp("good")
    return {name: save(array, folder / f"{name}.h5").read_bytes() for name, array in ARRAYS.items()}


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
