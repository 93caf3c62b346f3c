"""What contacts bear, how far they have come to their strength, and how far they have slipped."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.kernels.constitutive.joint_properties import joints_of, strengths
from udec_ia.kernels.drive.timestep import addresses
from udec_ia.layout import offsets as g
from udec_ia.ops.run.chatter import place_of

ROUNDED = 1e-3  # of the largest elastic shear: less than that is no slip


def closed(h: Memory, springs: bool = False) -> tuple[Any, Any, Any]:
    """Contacts that bear a force: addresses, normal and shear forces.

    springs: only those of constitutive number 1, whose strength is known: a law of the user's has its own.
    """
    contacts = addresses(h, int(h.ci[g.ICPNT]), g.KC)
    contacts = contacts[np.asarray(getr(h, contacts, g.KCFN)) > 0]
    if springs:
        contacts = contacts[integers(h, contacts, g.KCC) == 1]
    fn, fs = (np.asarray(getr(h, contacts, k), np.float64) for k in (g.KCFN, g.KCFS))
    return contacts, fn, fs


def borne(h: Memory) -> Any:
    """Addresses of blocks that a contact bears, or that bear on one; some of them twice."""
    contacts = closed(h)[0]
    return np.concatenate([integers(h, contacts, k) for k in (g.KB1, g.KB2)])


def own_laws(h: Memory) -> bool:
    """True if a contact that bears a force follows a law of the user's."""
    return bool((integers(h, closed(h)[0], g.KCC) != 1).any())


def overlap(h: Memory) -> float:
    """Mean overlap of the contacts that bear a force; 0 if none does."""
    contacts, fn, _ = closed(h)
    return float(np.mean(fn / joints_of(h, contacts).kn)) if len(fn) else 0.0


def at_strength(h: Memory) -> Any:
    """Contacts of springs and friction whose shear force is their strength, the most loaded one first."""
    contacts, fn, fs = closed(h, springs=True)
    slipping = np.abs(fs) >= 0.999 * strengths(h, contacts)
    order = np.argsort(-fn[slipping], kind="stable")
    return contacts[slipping][order]


def slipped_farthest(h: Memory) -> str:
    """The contact that has slipped farthest since it closed: what its spring does not hold of its shear.

    Nothing if none has slipped by more than what its spring has rounded.
    """
    contacts, _, fs = closed(h, springs=True)
    if not len(contacts):
        return ""
    ks = joints_of(h, contacts).ks
    held = np.divide(fs, ks, out=np.zeros_like(fs), where=ks > 0)
    slip = np.abs(np.asarray(getr(h, contacts, g.KCS), np.float64) - held)
    k = int(slip.argmax())
    if slip[k] < ROUNDED * np.abs(held).max():
        return ""
    return f", {place_of(h, int(contacts[k]))} by {slip[k]:.2g} m in all"
