"""Restart files that were changed and sealed again, and the messages that refuse them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import pytest

from support.handmade_map import two_blocks
from udec_ia.errors import UdecError
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.restart import load
from udec_ia.restart.file_seal import SIZE, seal

SCHEMES = tuple(ALL_SCHEMES)
ARRAYS = {name: two_blocks(name) for name in SCHEMES}
Edit = Callable[[h5py.File], None]


def edit(path: Path, change: Edit) -> None:
    """Change the HDF5 part and seal it again, as a program that means to deceive would."""
    with h5py.File(path, "r+") as file:
        change(file)
    image = path.read_bytes()[SIZE:]
    path.write_bytes(seal(memoryview(image)) + image)


def refusal(path: Path, read: Callable[[Path], Any] = load) -> str:
    """What `load` says about the file at `path`, without its name."""
    with pytest.raises(UdecError) as caught:
        read(path)
    error = caught.value
    assert error.number == 29
    assert error.detail.startswith(f"{path} ")
    assert error.advice
    return error.detail.removeprefix(f"{path} ")
