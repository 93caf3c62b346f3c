"""Some cases of the fuzzer (tools/robustness.py fuzz), in processes of their own, and what it has found."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.mechanics_scenes import box, model

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.layout import offsets
from udec_ia.layout.field_table import Field, read_table
from udec_ia.restart import save

TOOL = Path(__file__).parents[2] / "tools" / "robustness.py"


@pytest.mark.parametrize(("decks", "files"), [(8, 0), (0, 20)])
def test_fuzz(decks: int, files: int) -> None:
    """Every case ends in a result or in a numbered error."""
    arguments = ["--decks", str(decks), "--files", str(files), "--seed", "1"]
    done = subprocess.run(
        [sys.executable, str(TOOL), "fuzz", *arguments],
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_case_is_always_the_same() -> None:
    show = [sys.executable, str(TOOL), "fuzz", "--show", "decks", "7"]
    one, two = (
        subprocess.run(show, capture_output=True, text=True, timeout=300, check=True) for _ in range(2)
    )
    assert one.stdout == two.stdout != ""


@pytest.fixture(scope="module")
def wall() -> MainArray:
    """Six blocks, four of them on a fixed base, after some cycles."""
    m = model(*box(0, 6, 0, 4), d=0.1, friction=0.5)
    for y in (1, 2):
        m.split(-1, y, 7, y)
    for x in (2, 4):
        m.split(x, 1, x, 4)
    m.fix(0, 6, 0, 1)
    m.cycle(30)
    return m.array


UNUSABLE = {29}  # error of RESTART: the file is refused
# of CYCLE and SPLIT: memory, stiffness, density, damping, overlaps, lines and numbers that will not do; and
# 20 of the proof before SPLIT, which finds a number that has spread into the groups
IN_A_RUN = {1, 11, 12, 13, 15, 16, 20, 27, 28, 36}
MAD = {False: (-1, 2**40), True: (-1.0, np.nan)}


@pytest.mark.parametrize("field", read_table().common, ids=lambda field: field.name)
def test_a_mad_number_in_the_common_block(field: Field, wall: MainArray, tmp_path: Path) -> None:
    """A file that holds it is refused, or the run goes on to its end or to a numbered error.

    An array that cannot grow asks for the most of these numbers.
    """
    path = tmp_path / "mad.h5"
    refused, ended = set(), set()
    for value in MAD[field.real]:
        array = wall.copy()
        array.fixed = True
        variable(array.h, field)[0] = value
        save(array, path, [])
        errors = refused
        try:
            m = Model.restore(path)
            errors = ended
            assert m.cycle(3) == 3
            m.split(-1, 3, 7, 3.1)
        except UdecError as error:
            errors.add(error.number)
    assert refused <= UNUSABLE
    assert ended <= IN_A_RUN


def test_a_run_is_resumed_in_a_pass_of_the_cycle_only(wall: MainArray, tmp_path: Path) -> None:
    """In any other, CYCLE would count cycles and do nothing."""
    array = wall.copy()
    array.h.ci[offsets.JPHASE] = 7
    path = save(array, tmp_path / "mad.h5", [])
    with pytest.raises(UdecError, match="JPHASE is 7, not 0 to 4"):
        Model.restore(path)
