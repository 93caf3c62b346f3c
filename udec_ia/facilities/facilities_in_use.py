"""Which facilities of the program a state uses, what words each takes, and which of them have no effect.

A facility is what a scene may do without: zones, a damping, an account of the energy. A cycle runs what is in
use and nothing else. Groups are found as in a damaged heap (heap/group_census.py): nothing follows a link.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from udec_ia.advice.input_warnings import check_laws, check_loads
from udec_ia.heap.accessors import iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.damping_modes import MODES, mode_of
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.model_settings import PROPERTIES
from udec_ia.ops.common.number_limits import NMAT
from udec_ia.printable_text import counted
from udec_ia.reader.list_walks import chain
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import Atlas

LISTS = {"block": ("KB", g.IBPNT), "contact": ("KC", g.ICPNT), "bound": ("KU", g.IBNPNT)}
LISTS |= {"signal": ("KT", g.ISGPNT), "history": ("KH", g.IHPNT)}


class Scene:
    """The groups of `array` and what stands in them."""

    def __init__(self, array: MainArray) -> None:
        self.array = array
        self.h = array.h
        self.atlas = Atlas(array.h)

    def count(self, kind: str) -> int:
        """How many groups of a kind there are."""
        return len(self.atlas.groups[kind])

    def found(self, _: MainArray, kind: str) -> Any:
        """Addresses of all groups of a kind, as checks of the input take them, without a call of a kernel."""
        return self.atlas.groups[kind]

    def words(self, *kinds: str) -> int:
        """Words of IA() that groups of some kinds take."""
        return sum(self.count(kind) * self.atlas.layout[kind].size for kind in kinds)

    @property
    def in_use(self) -> int:
        """Words of IA() that are in use: below MFREE, and not on the junk list."""
        given = sum(size for chain in self.atlas.chains for _, size in chain)
        return self.atlas.free - 1 - given

    def column(self, kind: str, field: str) -> Any:
        """What a field holds in all groups of a kind, by rising address."""
        word = next(one for one in self.atlas.shapes[kind] if one.field.name == field)
        return self.atlas.gather(word, self.atlas.groups[kind])

    def of_blocks(self, addresses: Any, field: str) -> Any:
        """The same in the blocks at some addresses, as far as there are blocks; 0 elsewhere."""
        blocks, values = self.atlas.groups["block"], self.column("block", field)
        at = np.minimum(np.searchsorted(blocks, addresses), max(len(blocks) - 1, 0))
        return np.where(blocks[at] == addresses, values[at], 0) if len(blocks) else np.zeros_like(addresses)

    @cached_property
    def moves(self) -> bool:
        """True if a block is not fixed."""
        return bool((self.column("block", "KBFIX") != g.FIXED).any())

    @cached_property
    def touching(self) -> Any:
        """True for each contact that is not virtual."""
        return self.column("contact", "KCCOD") != g.VIRTUAL

    @cached_property
    def lists_end(self) -> bool:
        """True if a walk along any of the main lists comes to its end: no two links lead to one group."""
        for kind, (link, head) in LISTS.items():
            after, first = self.column(kind, link), int(self.h.ci[head])
            leads = np.append(after[after != 0], first) if first else after[after != 0]
            if len(np.unique(leads)) < len(leads) or not np.isin(leads, self.atlas.groups[kind]).all():
                return False
        return True


REMEMBER = [one.code for one in MODES if one.keeps_forces]
COLUMNS = ("facility", "words", "bytes", "percent", "in this scene")


class Facility(NamedTuple):
    """name: as decks call it. here: how much of it a scene uses, "" for nothing. words: that it takes."""

    name: str
    here: Callable[[Scene], str]
    words: Callable[[Scene], int] = lambda scene: 0


def facilities(array: MainArray) -> Listing:
    """The facilities that the state in `array` uses, and the words of IA() that each takes."""
    scene, size = Scene(array), array.scheme.int_bits // 8
    rows = []
    for one in FACILITIES:
        if here := one.here(scene):
            words = one.words(scene)
            share = round(100 * words / max(scene.in_use, 1), 1)
            rows.append((one.name, words, words * size, share, here))
    return Listing([], COLUMNS, rows)


def _many(n: int, what: str) -> str:
    return counted(n, what, ",") if n else ""


def _together(*parts: str) -> str:
    return ", ".join(part for part in parts if part)


# ---- what a scene uses


def _map(s: Scene) -> str:
    virtual = int(s.h.ci[g.NVIRT])
    contacts = _many(s.count("contact"), "contact") + (f" ({virtual:,} virtual)" if virtual else "")
    return _together(_many(s.count("block"), "block"), contacts, _many(s.count("domain"), "domain"))


def _domain_pass(s: Scene) -> str:
    if not s.moves:
        return ""
    reach = float(s.h.cr[g.ETOL])
    return f"looks for contacts where blocks have moved by {reach:.3g} m" if reach > 0 else "has not run yet"


def _short_edges(s: Scene) -> str:
    return "contacts look at their neighbours in every cycle" if s.h.ci[g.LSHORT] else ""


def _sdef(s: Scene) -> str:
    return _many(s.count("sdef"), "block")


def _fdef(s: Scene) -> str:
    zones = _many(s.count("zone"), "zone"), _many(s.count("gridpoint"), "grid-point")
    return _together(_many(s.count("fdef"), "block"), *zones)


def _mixed(s: Scene) -> str:
    return _many(int((s.column("fdef", "KFMIX") != 0).sum()), "block")


def _conditions(s: Scene) -> str:
    functions = int((s.column("signal", "KTP") != 0).sum())
    parts = [
        (s.count("bound"), "condition"),
        (s.count("signal") - functions, "sine"),
        (functions, "FUNCTION"),
    ]
    return _together(*(_many(*one) for one in parts))


def _joint_laws(s: Scene) -> str:
    return _many(int((s.touching & (s.column("contact", "KCC") > 1)).sum()), "contact")


def _block_laws(s: Scene) -> str:
    own = (s.column("block", "HEAD") != g.MRIG) & (s.column("block", "KCONS") > 1)
    return _many(int(own.sum()), "block")


def _coefficient(k: int, name: str, unit: str) -> Callable[[Scene], str]:
    """The value of a damping coefficient that the user has given."""
    return lambda s: f"{name} {s.h.cr[k]:.4g} {unit}" if s.h.cr[k] and not _adapts(s) else ""


def _adapts(s: Scene) -> bool:
    mode = mode_of(s.h)
    return bool(mode and mode.sets_alpha)


def _relaxation(s: Scene) -> str:
    mode = mode_of(s.h)
    if mode is None:
        return ""
    return f"{mode.name} {s.h.cr[g.RESTF]:g}" if mode.fraction else mode.name


def _remembered(s: Scene) -> int:
    return 0 if s.h.ci[g.LSCALE] else s.words("relax")


def _scaled(s: Scene) -> str:
    return "of inertial masses, not of the weight" if s.h.ci[g.LSCALE] else ""


def _scaling(s: Scene) -> int:
    return 0 if not s.h.ci[g.LSCALE] or s.h.ci[g.LREST] in REMEMBER else s.words("relax")


def _shared(s: Scene) -> str:
    """Relaxations that two facilities need."""
    both = s.h.ci[g.LSCALE] and s.h.ci[g.LREST] in REMEMBER
    return _many(s.count("relax"), "relaxation") if both else ""


def _watched(s: Scene) -> str:
    return "also of the time-step; a run that gains energy ends" if s.moves else ""


def _others(s: Scene) -> str:
    return _together(*(_many(s.count(kind), kind) for kind in OTHERS))


MAP = ("block", "corner", "contact", "domain", "jointext")
LISTED = (*MAP, "sdef", "fdef", "zone", "gridpoint", "bound", "signal", "tabpoint", "history", "relax")
OTHERS = [group.name for group in read_table().groups if group.name not in LISTED]
FACILITIES = (
    Facility("blocks and contacts", _map, lambda s: s.words(*MAP)),
    Facility("domain pass", _domain_pass),
    Facility("short edges", _short_edges),
    Facility("SDEF", _sdef, lambda s: s.words("sdef")),
    Facility("FDEF", _fdef, lambda s: s.words("fdef", "zone", "gridpoint")),
    Facility("MIXED", _mixed),
    Facility("BOUNDARY", _conditions, lambda s: s.words("bound", "signal", "tabpoint")),
    Facility("joint law", _joint_laws),
    Facility("block law", _block_laws),
    Facility("DAMPING MASS", _coefficient(g.ALPHA, "ALPHA", "1/s")),
    Facility("DAMPING STIFFNESS", _coefficient(g.BETA, "BETA", "s")),
    Facility("DAMPING INTERNAL", _coefficient(g.ALPB, "ALPB", "1/s")),
    Facility("DAMPING to rest", _relaxation, _remembered),
    Facility("FRACTION SCALED", _scaled, _scaling),
    Facility("to rest and SCALED", _shared, lambda s: s.words("relax")),
    Facility("ENERGY", lambda s: "an account is kept" if s.h.ci[g.LENER] else ""),
    Facility("HISTORY", lambda s: _many(s.count("history"), "number"), lambda s: s.words("history")),
    Facility("watch of the energy", _watched),
    Facility("other groups", _others, lambda s: s.words(*OTHERS)),
)


Found = Iterator[tuple[str, str]]
NEED_MOTION = ("DAMPING MASS", "DAMPING STIFFNESS", "DAMPING to rest", "FRACTION SCALED", "ENERGY")
LOADS = ("KUFX", "KUFY", "KUCXX", "KUCXY", "KUCYY")
MODULI = ("bulk", "g")


def facilities_without_effect(array: MainArray) -> Listing:
    """What was asked for and has no effect in the state in `array`, and why."""
    scene = Scene(array)
    if not scene.lists_end:
        return Listing(["what has no effect is not judged: lists of the heap are damaged, see udec check"])
    rows = [row for rule in RULES for row in rule(scene)]
    said = "asked for, and without effect here:" if rows else "all that was asked for has an effect"
    return Listing([said], ("what", "why"), rows)


def _motion(s: Scene) -> Found:
    """What acts on motion, where nothing moves."""
    if s.moves or not s.count("block"):
        return
    used = [one.name for one in FACILITIES if one.name in NEED_MOTION and one.here(s)]
    if s.h.cr[g.GRAVX] or s.h.cr[g.GRAVY]:
        used.append("GRAVITY")
    yield from ((name, "every block is fixed") for name in used)


def _damping(s: Scene) -> Found:
    """Damping of what is not there."""
    mode = mode_of(s.h)
    if s.h.cr[g.ALPB] and not s.count("sdef") and not _adapts(s):
        yield "DAMPING INTERNAL", "no block is simply-deformable"
    if s.h.cr[g.BETA] and s.moves and not (s.touching.any() or s.count("zone")):
        yield "DAMPING STIFFNESS", "there is no contact and no zone"
    if mode and mode.fraction and not _adapts(s) and not s.h.cr[g.RESTF]:
        yield "DAMPING to rest", "its fraction is 0"


def _fixed(s: Scene) -> Found:
    """What is calculated of blocks that are fixed."""
    fixed = s.column("block", "KBFIX") == g.FIXED
    if strained := int((fixed & (s.column("block", "HEAD") != g.MRIG)).sum()):
        yield "SDEF, FDEF", f"not strained, being fixed: {counted(strained, 'deformable block')}"
    ends = [s.of_blocks(s.column("contact", k), "KBFIX") == g.FIXED for k in ("KB1", "KB2")]
    if between := int((s.touching & ends[0] & ends[1]).sum()):
        yield "FIX", f"calculated between fixed blocks, where nothing moves: {counted(between, 'contact')}"


def _idle_conditions(s: Scene) -> Found:
    """Conditions that load nothing, and functions that nothing follows."""
    yield from (("BOUNDARY", text) for text in check_loads(s.array, s.found))
    empty = np.all([s.column("bound", k) == 0 for k in LOADS], axis=0) & (s.column("bound", "KUFIX") == 0)
    if many := int(empty.sum()):
        yield "BOUNDARY", f"without a load or a velocity: {counted(many, 'condition')}"
    signals, used = s.atlas.groups["signal"], s.column("bound", "KUS")
    for number in s.column("signal", "KTNUM")[~np.isin(signals, used)].tolist():
        yield f"FUNCTION {number}", "no condition follows it"


def _histories(s: Scene) -> Found:
    """Histories that record nothing."""
    cycles = int(s.h.ci[g.MCTOT])
    for number, ih in enumerate(chain(s.h, int(s.h.ci[g.IHPNT]), g.KH), 1):
        every, kind = iget(s.h, ih, g.KHN), iget(s.h, ih, g.KHK)
        if kind > 0 and iget(s.h, ih, g.KHG) == 0:
            yield f"HISTORY {number}", "its group is no longer there, so only NaN is recorded"
        elif every > cycles > 0:
            yield (
                f"HISTORY {number}",
                f"records every {every} cycles; the run has only {counted(cycles, 'cycle')}",
            )


def _materials(s: Scene) -> Found:
    """Materials and properties that nothing looks at."""
    given = {name: np.flatnonzero(s.h.cr[k : k + NMAT]) + 1 for name, k in PROPERTIES.items()}
    of_blocks = s.column("block", "KMAT")
    used = np.union1d(of_blocks, s.column("contact", "KCM")[s.touching])
    for m in np.setdiff1d(np.concatenate([*given.values()]), used).astype(int).tolist():
        yield f"PROPERTY MATERIAL={m}", "no block and no contact has this material"
    soft = of_blocks[s.column("block", "HEAD") != g.MRIG]
    stiff = np.setdiff1d(np.concatenate([given[name] for name in MODULI]), soft)
    for m in np.intersect1d(stiff, used).astype(int).tolist():
        yield f"PROPERTY MATERIAL={m}", "BULK and G have no effect: no block of this material is deformable"
    yield from (("PROPERTY", text) for text in check_laws(s.array, s.found))


RULES = (_motion, _damping, _fixed, _idle_conditions, _histories, _materials)
