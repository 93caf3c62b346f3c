"""What was asked for and has no effect in a state, and why.

Some of it CYCLE remarks before it runs (advice/input_warnings.py); here is all of it that a state shows.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from udec_ia.advice.input_warnings import check_laws, check_loads
from udec_ia.counting import counted
from udec_ia.heap.accessors import iget
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.facilities import FACILITIES
from udec_ia.heap_tools.facility_scene import Scene
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.model_settings import PROPERTIES
from udec_ia.ops.common.block_ranges import chain
from udec_ia.ops.common.number_limits import NMAT
from udec_ia.reader.listing import Listing

Found = Iterator[tuple[str, str]]
NEED_MOTION = ("DAMPING MASS", "DAMPING STIFFNESS", "DAMPING to rest", "FRACTION SCALED", "ENERGY")
LOADS = ("KUFX", "KUFY", "KUCXX", "KUCXY", "KUCYY")
MODULI = ("bulk", "g")


def idle(array: MainArray) -> Listing:
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
    adapts = mode and mode.sets_alpha
    if s.h.cr[g.ALPB] and not s.count("sdef") and not adapts:
        yield "DAMPING INTERNAL", "no block is simply-deformable"
    if s.h.cr[g.BETA] and s.moves and not (s.touching.any() or s.count("zone")):
        yield "DAMPING STIFFNESS", "there is no contact and no zone"
    if mode and mode.fraction and not adapts and not s.h.cr[g.RESTF]:
        yield "DAMPING to rest", "its fraction is 0"


def _fixed(s: Scene) -> Found:
    """What is calculated of blocks that are fixed."""
    fixed = s.column("block", "KBFIX") == g.FIXED
    if strained := int((fixed & (s.column("block", "HEAD") != g.MRIG)).sum()):
        yield "SDEF, FDEF", f"not strained, being fixed: {counted(strained, 'deformable block')}"
    ends = [s.of_blocks(s.column("contact", k), "KBFIX") == g.FIXED for k in ("KB1", "KB2")]
    if between := int((s.touching & ends[0] & ends[1]).sum()):
        yield "FIX", f"calculated between fixed blocks, where nothing moves: {counted(between, 'contact')}"


def _conditions(s: Scene) -> Found:
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


def _pressures(s: Scene) -> Found:
    """Pore pressures, which have words and no code."""
    if many := int((s.column("domain", "KPP") != 0).sum()):
        yield "pore pressure", f"set in {counted(many, 'domain')}, and no routine looks at it"


RULES = (_motion, _damping, _fixed, _conditions, _histories, _materials, _pressures)
