"""A script as users write them: mypy and pyright accept it in their strict modes, and it runs.

mypy reads it with the package (pyproject.toml). Of pyright: pyright tests/support/typed_script.py
"""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from udec_ia import Model, UdecError, UdecWarning, sweep
from udec_ia.export import export

DECK = """START
DEFAULT F=0.5
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=$F
BLOCK 0,0 0,2 2,2 2,0
SPLIT -1,1 3,1
STOP
"""


def build(folder: Path) -> Model:
    """Two blocks, one on the other."""
    m = Model(build="i32r64", out=folder)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.jproperty(1, kn=1e9, ks=1e9, friction=0.5, between=(1, 1))
    m.gravity(0, -10)
    address: int = m.block(0, 0, 0, 2, 2, 2, 2, 0)
    assert address > 0
    new: int = m.split(-1, 1, 3, 1)
    fixed: int = m.fix(0, 2, 0, 1)
    assert (new, fixed) == (1, 1)
    m.boundary("ALL", xforce=1.0)
    m.damping(local=0.8)
    m.polyline(0.5, 3, 0.5, 0.5, jmaterial=1)
    return m


def forces(m: Model) -> NDArray[np.float64]:
    """Normal forces of all contacts, N/m."""
    contacts = m.table("contact")
    assert contacts.dtype.names is not None
    found: NDArray[np.float64] = contacts["KCFN"].astype(np.float64)
    return found


def main(folder: Path) -> float:
    """All of it; the greatest force."""
    with warnings.catch_warnings(), build(folder) as m:
        warnings.simplefilter("ignore", UdecWarning)
        series = m.history(10, "KY", at=(1.0, 1.5))[0]
        done: int = m.cycle(20)
        solution = m.solve(1e-3, static=True)
        if not solution:
            print(solution.ratio, [one.key for one in solution.remarks])
        times: NDArray[np.float64] = series.numbers[:, 1]
        assert done == 20
        assert len(times) > 0
        path: Path = m.save()
        files: list[Path] = [*m.plot(contacts=True), *export(folder / "state.csv", [m.array])]
        violations = m.check()
        assert not violations
        text: str = m.print("blocks") + m.deck() + m.stop()
        assert all(file.exists() for file in files)
        assert text
    try:
        again = Model.restore(path, out=folder)
    except UdecError as error:
        print(error.number, error.advice)
        raise
    greatest = float(forces(again).max(initial=0.0))
    printed = again.run(DECK, values={"F": 0.4})
    assert printed is not None
    found = sweep(DECK, {"F": [0.4, 0.5]}, quantities=["n = count block"], out=folder / "sweep", jobs=0)
    assert found.table.column("n") == [2.0, 2.0]
    return greatest
