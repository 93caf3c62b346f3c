"""Sizes, pointers and materials that cannot be, in restart files that are sealed well: error 29."""

from __future__ import annotations

import hashlib
from pathlib import Path

import h5py
import numpy as np
import pytest
from support.resealed_files import ARRAYS, SCHEMES, Edit, edit, refusal

from udec_ia.errors import TOO_FAR
from udec_ia.heap.accessors import iget, puti, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import groups
from udec_ia.restart import load, save
from udec_ia.restart.file_tables import text


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
    (free,) = (block for block in groups(array.h, "block") if not iget(array.h, block, g.KBFIX))
    putr(array.h, free, g.KXD, np.nan)
    assert refusal(save(array, tmp_path / "two.h5")).startswith("holds an unsound heap: ")
    array.h.ci[g.NSPOIL] = TOO_FAR  # as CYCLE marks a run that ends so
    restored, _, *_ = load(save(array, tmp_path / "two.h5"))
    assert np.isnan(restored.h.ra).sum() == 1
