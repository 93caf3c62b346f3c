"""Volumes of domains, and lengths and apertures of pipes, follow from outlines and contacts: invariant 10.

They are found anew in a copy. So is the water: what is there has come in from outside, by commands, or with
changes of domains.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.heap.accessors import getr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import pipes_at, waters_at
from udec_ia.kernels.water.water_pressure import renew_present_volumes
from udec_ia.layout import offsets as g
from udec_ia.reader.water_rows import domain_water, water_account

RENEW = InterpretWhenSmall(renew_present_volumes, 2e3)  # contacts
FIELDS = {"water": ("KVVOL", "KVLEN", "KVX", "KVY"), "pipe": ("KPA", "KPK", "KPL1", "KPL2")}
DIGITS = 64.0  # last digits of the size of the model by which a length may be off
ALIKE = 1e-5, 1e-9  # part by which numbers of 32 and of 64 bits may be off
LOST = 1e-6  # part of the water that rounding may lose; with 64-bit reals
EMPTY = 1e-3  # part of the volumes that counts as water in that, however little there is


def check_water(state: State, array: MainArray) -> None:
    """Invariant 10, if all others hold."""
    if not array.h.ci[g.LWATER] or state.found:
        return
    fresh, h = array.copy(), array.h
    with np.errstate(all="ignore"):
        RENEW(int(h.ci[g.NCON]), fresh.h)
    corners: Any = state.address["corner"]
    size = float(max(np.abs(getr(h, corners, k)).max(initial=0.0) for k in (g.KXP, g.KYP)))
    digit = DIGITS * size * float(np.finfo(h.cr.dtype).eps)
    alike = ALIKE[h.cr.dtype.itemsize == 8]
    real = state.address["contact"][state.column("contact", "KCCOD") != g.VIRTUAL]
    inner = state.address["domain"][state.address["domain"] != h.ci[g.IODPNT]]
    inner = inner[state.read(inner, "KDLOOP") != 0]
    at: dict[str, Any] = {
        "water": waters_at(h, inner),
        "pipe": pipes_at(h, real),
    }
    for kind, names in FIELDS.items():
        for name in names:
            k = getattr(g, name)
            stored, found = (np.asarray(getr(one.h, at[kind], k), np.float64) for one in (array, fresh))
            slack = alike * np.abs(found) + digit * (1.0 + (size if name == "KVVOL" else 0.0))
            if name == "KPK":  # it has the third power of the aperture
                aperture = getr(fresh.h, at[kind], g.KPA)
                slack = np.abs(found) * (alike + 4 * digit / np.maximum(aperture, 1e-300))
            for k in np.flatnonzero(~(np.abs(stored - found) <= slack)).tolist():
                state.report(
                    10, f"{name} of {kind}@{at[kind][k]} is {stored[k]}, but by its walls {found[k]}"
                )
    if h.cr.dtype.itemsize == 8:
        _check_amount(state, array)


def _check_amount(state: State, array: MainArray) -> None:
    """The water in domains is what has come in."""
    there, *parts = water_account(array.h).values()
    slack = LOST * (there + sum(map(abs, parts)) + EMPTY * float(domain_water(array.h)["volume"].sum()))
    if not abs(there - sum(parts)) <= slack:
        text = f"there are {there} m2 of water, but {sum(parts)} have come in (WATIN, WATPUT, WATMAP)"
        state.report(10, text)
