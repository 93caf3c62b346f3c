"""Files that were written long ago are read: those in kept/ stay as they are (make_kept_files.py made them).

What is in them stands here in numbers, so that no change of the reader can pass for another state.
"""

from __future__ import annotations

import gzip
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

import pytest

from udec_ia import Model
from udec_ia.layout import offsets as g
from udec_ia.restart import info

KEPT = Path(__file__).parent / "kept"


class State(NamedTuple):
    """What a file holds. force: the greatest KCFN; recorded: the last KYD, KXDG and KINETIC."""

    digest: str
    time: float
    friction: float
    put: float
    force: float
    recorded: tuple[float, float, float]


LONG = (  # of the reals of 64 bits
    0.001618028690003011,
    0.013217623279574299,
    -0.01560575714557988,
    1736.9106580261696,
    (-0.01481232600433973, 0.021732923428376485, 10.524701226741364),
)
SHORT = (
    0.0016180287639144808,
    0.01334217891512779,
    -0.015614321118814889,
    1736.73046875,
    (-0.014823727309703827, 0.021864673122763634, 10.526549909266251),
)
FILES = {
    "1.1-i32r64": State("1c6839d24614733db2cbe862e2f87ceeb7ac15d4879a7963ceb384a7856fdc39", *LONG),
    "1.2-i16r32": State("7fc787eadd23e87d2ecc9222dd0c052fc2dc9a21ba10d64df03c530a8486b7bf", *SHORT),
    "1.2-i32r32": State("64fa04b95ff5f5f414f26e8855c59bcf78b6cf79e860aef87608cc341083cf3f", *SHORT),
    "1.2-i16r64": State("99562a977832b1b166bb5e70d5c66452577b0a730184719ace70aef4226a8c9c", *LONG),
    "1.2-i32r64": State("a8b61931e1fbdcebd70bbeb813014e09353f73d3fa2fafce2a917966d86888b7", *LONG),
    "1.2-i64r64": State("04e99f3bdf9b1ceb6f79c56adac89fb692ce815f226dacd86b099c2410961f53", *LONG),
}
CONTACTS = [3, 2, 3, 2, 3, 2, 1, 1, 3, 2, 1, 1, 2, 3, 2, 1, 1, 1]  # KCCOD, in the order of the list
GROUPS = {
    "block": 6,
    "corner": 24,
    "sdef": 2,
    "fdef": 2,
    "zone": 8,
    "gridpoint": 10,
    "signal": 2,
    "tabpoint": 3,
}


def test_the_files_are_those_that_were_made() -> None:
    """One that is missing, or made anew, would prove nothing."""
    found = {path.name.removesuffix(".h5.gz"): path for path in KEPT.iterdir()}
    assert {name: sha256(path.read_bytes()).hexdigest() for name, path in found.items()} == {
        name: state.digest for name, state in FILES.items()
    }


@pytest.mark.parametrize("name", FILES)
def test_a_kept_file_is_read_and_goes_on(name: str, tmp_path: Path) -> None:
    state, path = FILES[name], tmp_path / "kept.h5"
    path.write_bytes(gzip.decompress((KEPT / f"{name}.h5.gz").read_bytes()))
    m = Model.restore(path, out=tmp_path)
    assert m.check() == []
    h = m.array.h
    assert m.array.scheme.name == name.partition("-")[2]
    counts = [int(h.ci[place]) for place in (g.NBLK, g.NCON, g.NDOM, g.MCTOT, g.NVIRT, g.LENER)]
    assert counts == [6, 18, 14, 20, 0, 1]
    assert (float(h.cd[g.TIME]), float(h.cd[g.WFRIC]), float(h.cd[g.EPUT])) == state[1:4]
    assert float(m.table("contact")["KCFN"].max()) == state.force
    assert m.table("contact")["KCCOD"].tolist() == CONTACTS
    assert {kind: len(m.table(kind)) for kind in GROUPS} == GROUPS
    if m.array.scheme.ratio > 1:  # else blocks are longer now: the heap was laid out anew, without junk
        assert h.ci[g.JUNK] != 0
    series = m.histories()
    assert [one.name for one in series] == ["KYD", "KYD", "KXDG", "TIME", "KINETIC"]
    assert [one.lost for one in series] == [False, True, False, False, False]
    assert tuple(float(series[k].numbers[-1, 2]) for k in (0, 2, 4)) == state.recorded
    assert [len(one.numbers) for one in series] == [11] * 5
    assert m.session.log.lines[0] == "START"
    assert "20 cycles" in info(path)
    assert "law       cl2 of law.py" in info(path)
    m.cycle(10)
    assert m.check() == []
    assert [len(one.numbers) for one in series] == [16] * 5
    assert Model.restore(m.save(tmp_path / "new.h5"), out=tmp_path).h.ci[g.MCTOT] == 30
