"""Makes the restart files that are kept in tests/restart/kept: small states with groups of every kind.

    python tests/restart/make_kept_files.py --out tests/restart/kept

One file of each word scheme, of the format of now, packed by gzip: VERSION-SCHEME.h5.gz. What is there is
left alone: it is to be readable for good, and the test that reads it knows its numbers. With the next
format, or the next layout of the field table, one more of each is made and stays with them.
"""

from __future__ import annotations

import argparse
import gzip
import platform
import tempfile
from pathlib import Path

from udec_ia import Model
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.restart import save
from udec_ia.restart.file_seal import VERSION

DECK = """\
START
* six blocks on a base, two of each type, in a draught of boundary conditions
PROPERTY MAT=1 DENSITY=1000 KN=1.E8 KS=1.E8 FRICTION=0.3 BULK=1.E8 G=5.E7
GRAVITY 0 -10
FRACTION 0.1
ROUND 0.05
BLOCK 0,-1 0,1 6,1 6,-1
SPLIT -1,0 7,0
SPLIT 2,-0.5 2,2
SPLIT 5,-0.5 5,2
SPLIT 1,-0.5 1,2
SPLIT 4,-0.5 4,2
SPLIT 3,-0.5 3,2
FIX 0 6 -1 0
CHANGE 1 3 0 1 SDEF
CHANGE 3 5 0 1 FDEF
GENERATE 4 5 0 1 MANUAL GRIDPOINTS (4,0) (4,1) (5,1) (5,0) (4.5,0.5)
+ ZONES 1,2,3 1,3,4 1,4,5 1,5,2
GENERATE 3 4 0 1 MANUAL GRIDPOINTS (3,0) (3,1) (4,1) (4,0) (3.5,0.5)
+ ZONES 1,2,3 1,3,4 1,4,5 1,5,2
FUNCTION 3  0 0  0.001 1  0.002 -1
BOUNDARY 2 6 0.9 1.1 STRESS 0 0 -1.E5 FUNCTION 3
BOUNDARY 0 1 0 1 XVEL 0.01 SINE 20 1
BOUNDARY 4.9 6.1 -0.1 1.1 VISCOUS
ENERGY ON
HISTORY 2 KYD AT 0.5,0.5 5.5,0.5
HISTORY 2 KXDG AT 4,1
HISTORY 2 TIME
HISTORY 2 KINETIC
CYCLE 10
DELETE 5 6 0 1
CYCLE 10
"""
LAWS = {"cl2": ("law.py", "0" * 64)}  # as if a law of the user's had been given


def make(build: str, folder: Path) -> Path | None:
    """The file of one word scheme; None if it is there."""
    target = folder / f"{VERSION[0]}.{VERSION[1]}-{build}.h5.gz"
    if target.exists():
        return None
    with tempfile.TemporaryDirectory() as name:
        model = Model(build, out=name)
        model.run(DECK)
        path = save(model.array, Path(name, "run.h5"), model.session.log.lines, LAWS, model.histories())
        target.write_bytes(gzip.compress(path.read_bytes(), 9, mtime=0))
    return target


def main() -> None:
    """Make the files that are not there."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--out", type=Path, default=Path("tests/restart/kept"))
    folder = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    platform.node = lambda: "kept"
    for build in ALL_SCHEMES:
        made = make(build, folder)
        print(f"{build}: {f'{made.stat().st_size} bytes' if made else 'is there, and stays'}")


if __name__ == "__main__":
    main()
