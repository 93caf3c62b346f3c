"""Which facilities of the program a state uses, what words each takes, and which of them have no effect.

A facility is what a scene may do without: zones, a damping, an account of the energy. A cycle runs what is in
use and nothing else. Groups are found as in a damaged heap (heap/group_census.py).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from udec_ia.advice.input_warnings import check_laws, check_loads
from udec_ia.heap.accessors import iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import materials_of
from udec_ia.kernels.drive.damping_modes import MODES, mode_of
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.function_command import USERS
from udec_ia.ops.commands.model_settings import PROPERTIES
from udec_ia.ops.common.number_limits import NMAT
from udec_ia.printable_text import counted
from udec_ia.reader.list_walks import Unsound, groups
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import Atlas

REMEMBER = [one.code for one in MODES if "before" in one.effects]


class Scene:
    """The groups of `array` and the values of their fields."""

    def __init__(self, array: MainArray) -> None:
        self.array = array
        self.h = array.h
        self.atlas = Atlas(array.h)
        self.mode = mode_of(array.h)

    def count(self, kind: str) -> int:
        """How many groups of a kind there are."""
        return len(self.atlas.groups[kind])

    def found(self, _: MainArray, kind: str) -> Any:
        """Addresses of all groups of a kind, as checks of the input take them, without a call of a kernel."""
        return self.atlas.groups[kind]

    @property
    def in_use(self) -> int:
        """Words of IA() that are in use: below MFREE, and not on the junk list."""
        return self.atlas.free - 1 - sum(size for chain in self.atlas.chains for _, size in chain)

    def column(self, kind: str, field: str) -> Any:
        """The values of a field of all groups of a kind, by rising address."""
        word = next(one for one in self.atlas.shapes[kind] if one.field.name == field)
        return self.atlas.gather(word, self.atlas.groups[kind])

    @cached_property
    def fixed(self) -> Any:
        """True for each block that is fixed."""
        return self.column("block", "KBFIX") == g.FIXED

    @property
    def moves(self) -> bool:
        """True if a block is not fixed."""
        return not self.fixed.all()

    @cached_property
    def deformable(self) -> Any:
        """True for each block that is deformable."""
        return self.column("block", "HEAD") != g.MRIG

    @cached_property
    def touching(self) -> Any:
        """True for each contact that is not virtual."""
        return self.column("contact", "KCCOD") != g.VIRTUAL

    @property
    def coefficients(self) -> bool:
        """True if the damping coefficients are those of the user, and no mode sets them."""
        return not (self.mode and "alpha" in self.mode.effects)

    @property
    def owner_of_relaxations(self) -> str:
        """The facility that relaxations are needed for."""
        if self.h.ci[g.LSCALE]:
            return "to rest with SCALED" if self.h.ci[g.LREST] in REMEMBER else "FRACTION SCALED"
        return "DAMPING to rest"


class Facility(NamedTuple):
    """name: as in decks. kinds: of groups that only this facility has.

    use: how much of it a scene uses, as text or as a number of blocks or contacts, "" and 0 for nothing; None
    if it is used where there are groups of these kinds.
    """

    name: str
    kinds: tuple[str, ...] = ()
    use: Callable[[Scene], Any] | None = None

    def use_in(self, scene: Scene) -> str:
        """How much of it a scene uses, "" for nothing."""
        if self.use:
            return str(self.use(scene) or "")
        return ", ".join(counted(n, f"{kind} group", ",") for kind in self.kinds if (n := scene.count(kind)))

    def words(self, scene: Scene) -> int:
        """Words of IA() that it takes."""
        kinds = (*self.kinds, "relax") if self.name == scene.owner_of_relaxations else self.kinds
        return sum(scene.count(kind) * scene.atlas.layout[kind].size for kind in kinds)


def _domain_pass(s: Scene) -> str:
    reach = float(s.h.cr[g.ETOL])
    text = f"looks for contacts where blocks have moved by {reach:.3g} m" if reach > 0 else "has not run yet"
    return text if s.moves else ""


def _coefficient(k: int, unit: str) -> Callable[[Scene], str]:
    """The value of a damping coefficient that the user has given."""
    return lambda s: f"{s.h.cr[k]:.4g} {unit}" if s.h.cr[k] and s.coefficients else ""


def _relaxation(s: Scene) -> str:
    fraction = f" {s.h.cr[g.RESTF]:g}" if s.mode and s.mode.fraction else ""
    return s.mode.name + fraction if s.mode else ""


def _both(s: Scene) -> str:
    both = s.count("relax") and s.owner_of_relaxations == "to rest with SCALED"
    return "both need relaxations" if both else ""


MAP = ("block", "corner", "contact", "domain", "jointext")
LISTED = (
    *MAP,
    "joint",
    "edge",
    "sdef",
    "fdef",
    "zone",
    "gridpoint",
    "bound",
    "signal",
    "tabpoint",
    "history",
    "relax",
    "follower",
    "summand",
    "water",
    "pipe",
    "outside",
    "crack",
    "member",
    "bolt",
    "node",
    "element",
    "breakable",
    "fracture",
    "displacement",
    "pointdisplacement",
)
FACILITIES = (
    Facility("blocks and contacts", MAP),
    Facility("domain pass", use=_domain_pass),
    Facility("short edges", use=lambda s: "contacts look at their neighbours" if s.h.ci[g.LSHORT] else ""),
    Facility("SDEF", ("sdef",)),
    Facility("FDEF", ("fdef", "zone", "gridpoint")),
    Facility("MIXED", use=lambda s: np.count_nonzero(s.column("fdef", "KFMIX"))),
    Facility("BOUNDARY", ("bound",)),
    Facility("FUNCTION", ("signal", "tabpoint", "follower")),
    Facility("joint materials", ("joint", "edge"), lambda s: np.count_nonzero(s.column("joint", "KCJMAT"))),
    Facility("FLUID", ("water", "pipe", "outside")),
    Facility("cracks kept for later cuts", ("crack",)),
    Facility("GROUP", ("member",)),
    Facility("structures", ("bolt", "node", "element")),
    Facility("BREAKAGE", ("breakable",)),
    Facility("DISPLACEMENTS", ("displacement", "pointdisplacement")),
    Facility("cracks made in runs", ("fracture",)),
    Facility("joint law", use=lambda s: np.count_nonzero(s.touching & (s.column("contact", "KCC") > 1))),
    Facility("block law", use=lambda s: np.count_nonzero(s.deformable & (s.column("block", "KCONS") > 1))),
    Facility("DAMPING MASS", use=_coefficient(g.ALPHA, "1/s")),
    Facility("DAMPING STIFFNESS", use=_coefficient(g.BETA, "s")),
    Facility("DAMPING INTERNAL", use=_coefficient(g.ALPB, "1/s")),
    Facility("DAMPING to rest", use=_relaxation),
    Facility("FRACTION SCALED", use=lambda s: "inertial masses" if s.h.ci[g.LSCALE] else ""),
    Facility("to rest with SCALED", use=_both),
    Facility("ENERGY", use=lambda s: "an account is kept" if s.h.ci[g.LENER] else ""),
    Facility("HISTORY", ("history", "summand")),
    Facility("energy monitor", use=lambda s: "a run that gains energy ends" if s.moves else ""),
    Facility("other groups", tuple(one.name for one in read_table().groups if one.name not in LISTED)),
)


def facilities(array: MainArray) -> Listing:
    """The facilities that the state in `array` uses, and the words of IA() that each takes."""
    scene, size = Scene(array), array.scheme.int_bits // 8
    rows = []
    for one in FACILITIES:
        if use := one.use_in(scene):
            words = one.words(scene)
            share = round(100 * words / max(scene.in_use, 1), 1)
            rows.append((one.name, words, words * size, share, use))
    return Listing([], ("facility", "words", "bytes", "percent", "in this scene"), rows)


Found = Iterator[tuple[str, str]]
NEED_MOTION = ("DAMPING MASS", "DAMPING STIFFNESS", "DAMPING to rest", "FRACTION SCALED", "ENERGY")
MODULI = ("bulk", "g")


def facilities_without_effect(array: MainArray) -> Listing:
    """What was requested and has no effect in the state in `array`, and why."""
    scene = Scene(array)
    try:
        rows = [row for rule in RULES for row in rule(scene)]
    except (Unsound, IndexError):
        return Listing(["what has no effect is not judged: lists of the heap are damaged, see udec check"])
    text = "requested, and without effect here:" if rows else "all that was requested has an effect"
    return Listing([text], ("what", "why"), rows)


def _motion(s: Scene) -> Found:
    """What acts on motion, where nothing moves."""
    if not s.moves and s.count("block"):
        used = [one.name for one in FACILITIES if one.name in NEED_MOTION and one.use_in(s)]
        gravity = ["GRAVITY"] if s.h.cr[g.GRAVX] or s.h.cr[g.GRAVY] else []
        yield from ((name, "every block is fixed") for name in used + gravity)


def _damping(s: Scene) -> Found:
    """Damping without anything that it acts on."""
    if s.h.cr[g.ALPB] and not s.count("sdef") and s.coefficients:
        yield "DAMPING INTERNAL", "no block is simply-deformable"
    if s.h.cr[g.BETA] and s.moves and not (s.touching.any() or s.count("zone")):
        yield "DAMPING STIFFNESS", "there is no contact and no zone"
    if s.mode and s.mode.fraction and s.coefficients and not s.h.cr[g.RESTF]:
        yield "DAMPING to rest", "its fraction is 0"


def _fixed(s: Scene) -> Found:
    """What is calculated of blocks that are fixed."""
    if strained := int(np.count_nonzero(s.fixed & s.deformable)):
        yield "SDEF, FDEF", f"not strained, being fixed: {counted(strained, 'deformable block')}"
    fixed = s.atlas.groups["block"][s.fixed]
    ends = [np.isin(s.column("contact", name), fixed) for name in ("KB1", "KB2")]
    if between := int(np.count_nonzero(s.touching & ends[0] & ends[1])):
        yield "FIX", f"calculated between fixed blocks, where nothing moves: {counted(between, 'contact')}"


def _idle_conditions(s: Scene) -> Found:
    """Loads on fixed blocks, and functions that nothing follows."""
    yield from (("BOUNDARY", text) for text in check_loads(s.array, s.found))
    used = np.concatenate([s.column(kind, field) for kind, field in USERS])
    idle = ~np.isin(s.atlas.groups["signal"], used)
    for number in s.column("signal", "KTNUM")[idle].tolist():
        yield f"FUNCTION {number}", "nothing follows it"


def _histories(s: Scene) -> Found:
    """Histories that record nothing."""
    cycles = int(s.h.ci[g.MCTOT])
    for number, ih in enumerate(groups(s.h, "history"), 1):
        every = iget(s.h, ih, g.KHN)
        if iget(s.h, ih, g.KHK) > 0 and iget(s.h, ih, g.KHG) == 0:
            yield f"HISTORY {number}", "its group is no longer there, so only NaN is recorded"
        elif every > cycles > 0:
            text = f"records every {every} cycles; the run has only {counted(cycles, 'cycle')}"
            yield f"HISTORY {number}", text


def _materials(s: Scene) -> Found:
    """Materials and properties that nothing looks at."""
    given = {name: np.flatnonzero(s.h.cr[k : k + NMAT]) + 1 for name, k in PROPERTIES.items()}
    of_blocks = s.column("block", "KMAT")
    used = np.union1d(of_blocks, materials_of(s.h, s.atlas.groups["contact"])[s.touching])
    for m in np.setdiff1d(np.concatenate([*given.values()]), used).astype(int).tolist():
        yield f"PROPERTY MATERIAL={m}", "no block and no contact has this material"
    stiff = np.setdiff1d(np.concatenate([given[name] for name in MODULI]), of_blocks[s.deformable])
    for m in np.intersect1d(stiff, used).astype(int).tolist():
        yield f"PROPERTY MATERIAL={m}", "BULK and G have no effect: no block of this material is deformable"
    yield from (("PROPERTY", text) for text in check_laws(s.array, s.found))


RULES = (_motion, _damping, _fixed, _idle_conditions, _histories, _materials)
