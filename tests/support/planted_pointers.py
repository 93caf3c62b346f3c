"""Wrong pointers, planted one by one in a small model, and what a cycle says of each. A program of its own,

    UDEC_CHECKED=1 python tests/support/planted_pointers.py 1

for the build of the kernels is chosen when they are loaded. The first lines are the bits of the model before
and after some cycles, and whether the kinds of groups that the build has noted are those that a census finds.
The others say what became of each wrong address in each pointer, or in every so many.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from hashlib import sha256
from tempfile import TemporaryDirectory

import numpy as np

from udec_ia import Model
from udec_ia.checked_build.access_checks import find_kinds, shadow
from udec_ia.compiling.build_choice import CHECKED
from udec_ia.compiling.interpreted_kernels import interpreted
from udec_ia.errors import WrongAddress
from udec_ia.heap.group_census import census
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import layouts, read_table

TABLE = read_table()


def scene(out: str) -> Model:
    """Blocks of every type that press on each other, one that slides, conditions, a FUNCTION, a history."""
    m = Model(out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5, bulk=1e7, g=4e6)
    m.block(0, 0, 0, 3, 3, 3, 3, 0)
    m.split(-1, 1, 4, 1)
    m.split(-1, 2, 4, 2)
    m.split(1.5, 0.5, 1.5, 4)
    m.round(0.1)
    m.change(0, 1.5, 1, 2, type="sdef")
    m.change(1.5, 3, 1, 2, type="fdef")
    corners = (1.5, 1), (1.5, 2), (3, 2), (3, 1)
    m.generate(1.5, 3, 1, 2, mode="manual", gridpoints=corners, zones=[(1, 2, 3), (1, 3, 4)])
    m.fix(0, 3, 0, 1)
    m.gravity(0, -10)
    m.function(1, 0, 1, 1, 2)
    m.boundary(1.4, 3.1, 1.8, 2.2, xforce=10.0, function=1)
    m.history(1, "KX", at=(0.5, 2.5))
    m.cycle(20)
    m.delete(0, 1.5, 2, 3)
    m.cycle(5)
    return m


def words(m: Model) -> bytes:
    """The words in use."""
    h = m.array.h
    return bytes(h.ia[: h.ci[g.MFREE] - 1].tobytes())


def bits(m: Model) -> str:
    """A hash of the words in use and of the common block."""
    return sha256(b"".join([words(m), *(part.tobytes() for part in m.array.h[2:])])).hexdigest()


def same_kinds(m: Model) -> bool:
    """True if what FIND and LOSE have noted is what pointers lead to."""
    find_kinds(m.array.h)
    noted = shadow(m.array.h.ia).kinds
    return all(
        (np.flatnonzero(noted == number) + 1).tolist() == at.tolist()
        for number, at in enumerate(census(m.array.h).values(), 1)
    )


def pointers(m: Model) -> Iterator[tuple[str, str, int]]:
    """(field, kinds that it may point to, address of the word) in two groups of each kind."""
    layout = layouts(m.array.scheme.ratio)
    for kind, at in census(m.array.h).items():
        for field in TABLE.group(kind).fields:
            for iad in {*at[[0, -1]].tolist()} if field.target and len(at) else ():
                yield f"{kind}@{iad}.{field.name}", str(field.target), iad + layout[kind].offset[field.name]


def wrong(m: Model, target: str) -> Iterator[tuple[str, int]]:
    """Addresses where there is no group of the kind `target`."""
    at = census(m.array.h)
    right = {"item": {"corner", "contact"}, "soft": {"sdef", "fdef"}, "any": set(at)}.get(target, {target})
    yield "in a block", int(at["block"][0]) + 2
    yield "outside", int(m.array.h.ci[g.MFREE]) + 7
    yield "negative", -9
    yield "junk", int(m.array.h.ci[g.JUNK])
    for kind in ("block", "corner", "contact", "zone"):
        if kind not in right:
            yield f"a {kind}", int(at[kind][-1])


def describe_result(m: Model) -> str:
    """What two cycles say, and whether an error in the first leaves the words as they were."""
    before, cycles = words(m), int(m.array.h.ci[g.MCTOT])
    try:
        m.cycle(2)
    except Exception as error:  # outside of kernels Python says that an address is none
        kept = words(m) == before or m.array.h.ci[g.MCTOT] > cycles
        who, left = (
            "" if isinstance(error, WrongAddress) else "before: ",
            "" if kept else "; it has changed words",
        )
        return who + str(error).splitlines()[0] + left
    return "nothing"


def main() -> None:
    """Plant every wrong pointer in the same state."""
    with TemporaryDirectory() as folder:
        with interpreted():  # in the compiled build, only what a cycle needs is to be compiled
            model = scene(folder)
        plant(model, int(sys.argv[1]))


def plant(m: Model, every: int) -> None:
    """Say what becomes of every so many wrong pointers in `m`."""
    before = m.array.copy()
    planted = [(name, word, *one) for name, target, word in pointers(m) for one in wrong(m, target)]
    print(bits(m))
    m.cycle(5)
    print(bits(m))
    print(m.check() == [] and (same_kinds(m) or not CHECKED))
    for name, word, what, iad in planted[::every] if CHECKED else []:
        m.session.return_to(before.copy(), [])
        m.array.h.ia[word - 1] = iad
        print(f"{name} {what}: {describe_result(m)}")


if __name__ == "__main__":
    np.seterr(all="ignore")
    sys.exit(main())
