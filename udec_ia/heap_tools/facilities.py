"""The table of facilities: how one sees that a state uses it, and what words it takes.

How to do without each is told in without.py. What two facilities need together has a line of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from udec_ia.counting import counted
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.facility_scene import Scene
from udec_ia.kernels.drive.damping_modes import MODES, mode_of
from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table
from udec_ia.reader.listing import Listing

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
    """Says the value of a damping coefficient that the user has given."""
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
TOLD = (*MAP, "sdef", "fdef", "zone", "gridpoint", "bound", "signal", "tabpoint", "history", "relax")
OTHERS = [group.name for group in read_table().groups if group.name not in TOLD]  # that no line speaks of
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
