"""What a contact reads and writes as its force is calculated: itself, the sums of its blocks, and totals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support import random_deformable_scenes as soft_scenes
from support import random_scenes as scenes
from support.interpreted_kernels import both_ways

from udec_ia import Model
from udec_ia.compiling.interpreted_kernels import interpreted, observe
from udec_ia.heap.accessors import int64, size_of
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.kernels.contact.ford import ford
from udec_ia.kernels.energy.work_account import add_contact_work
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.laws.registered_laws import LawBook

pytestmark = both_ways

SUMS = {  # what blocks feel
    "block": ("KBFX", "KBFY", "KBFT"),
    "gridpoint": ("KGFX", "KGFY"),
    "sdef": ("KSA11", "KSA12", "KSA21", "KSA22"),
}
NEVER_READ = {"contact", "domain"}  # but for the contact's own words
SEEDS = range(4)
EVERYWHERE = (-1e9, 1e9, -1e9, 1e9)
TOTALS = {("ci", g.NERR), ("ci", g.IERAD), ("cd", g.WFRIC)}
ACCOUNT = {("cd", g.WSHAPE), ("cd", g.WSTIF)}


class Touched:
    """The groups of a model by their words, and what has been done to which."""

    def __init__(self, model: Model) -> None:
        h = self.h = model.h
        self.ratio = h.ra.itemsize // h.ia.itemsize
        self.at = np.full(len(h.ia) + 1, -1)
        self.groups: list[tuple[str, int]] = []
        for group in read_table().groups:
            size = size_of(h, getattr(g, group.size_name))
            for iad in model.table(group.name)["address"].tolist():
                self.at[iad : iad + size] = len(self.groups)
                self.groups.append((group.name, iad))
        self.begin()

    def begin(self) -> None:
        """Nothing has been done yet."""
        self.read: set[tuple[str, int]] = set()
        self.written: set[tuple[str, int]] = set()
        self.common: set[tuple[str, int]] = set()

    def tell(self, name: str, where: Any, value: Any, written: bool) -> None:
        """Note the group; a sum of forces is not noted."""
        if name.startswith("c"):
            if written:
                self.common.add((name, int(where)))
            return
        word = int(where) + 1 if name == "ia" else int(where) * self.ratio + 1
        kind, iad = self.groups[self.at[word]]
        sums = [getattr(g, field)[self.ratio >> 1] for field in SUMS.get(kind, ())]
        start = (iad - 1) // self.ratio - 1
        if name == "ra" and int(where) - start in sums:
            return
        (self.written if written else self.read).add((kind, iad))


@pytest.mark.parametrize("module", [scenes, soft_scenes], ids=["rigid", "soft"])
@pytest.mark.parametrize("build", ALL_SCHEMES)
@pytest.mark.parametrize("kept", [False, True], ids=["", "account"])
@pytest.mark.parametrize("own", [False, True], ids=["springs", "law"])
def test_a_force_needs_no_other_contact(own: bool, kept: bool, build: str, module: Any) -> None:
    """Nor a domain; one that has to wait leaves no more than where it is.

    own: with a user's law. kept: with an account of the energy.
    """
    found, written = [], set()
    for seed in SEEDS:
        model = module.play(seed, Model(build), cycles=(2, 8)).model
        model.array.h.cr[g.BETA] = 1e-3
        touched, laws = Touched(model), None
        if own:
            model.change(*EVERYWHERE, constitutive=2)
            with interpreted():
                laws = LawBook("joint-dilation").pack(model.array)
        contacts = model.table("contact")
        for ic in contacts["address"][contacts["KCCOD"] != g.VIRTUAL].tolist():
            touched.begin()
            with interpreted():
                account = add_contact_work if kept else 0
                waits, _ = ford(observe(model.h, touched.tell), int64(ic), True, laws, account, False)
            assert waits in (0, -ic if own else ic)
            found.append(waits != 0)
            assert touched.written <= {("contact", ic)}
            assert {one for one in touched.read if one[0] in NEVER_READ} <= {("contact", ic)}
            assert touched.common <= (set() if waits else TOTALS | (ACCOUNT if kept else set()))
            written |= touched.common
    assert not all(found)
    assert bool(written & ACCOUNT) == kept
