"""Remarks on water: contacts without an aperture, steps of flow in a cycle, a flow that is not steady."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil

import numpy as np

from udec_ia.heap.accessors import getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.kernels.water.water_pressure import THIN
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.water_command import BALANCED
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.printable_text import counted
from udec_ia.remark import Remark


def check_water(array: MainArray) -> Iterator[Remark]:
    """CYCLE and FLOW: contacts to which no joint material gives an aperture."""
    h = array.h
    if not h.ci[g.LWATER]:
        return
    contacts = list_of(h, "contact")
    contacts = contacts[integers(h, contacts, g.KCCOD) != g.VIRTUAL]
    joints = joints_at(h, contacts)
    mat = np.where(joints > 0, integers(h, np.maximum(joints, 1), g.KCJMAT), 0)
    lacking = contacts[(mat < 1) | ~(h.cr[g.JMHAP + np.maximum(mat, 1) - 1] > 0)]
    if len(lacking):
        ic = int(lacking[0])
        yield Remark(
            "no-aperture",
            f"no joint material gives {counted(len(lacking), 'contact')} an aperture, the first at "
            f"({getr(h, ic, g.KXC):g}, {getr(h, ic, g.KYC):g}): it is {THIN * h.cr[g.DTOL]:.3g} m there; "
            "JPROPERTY JMATERIAL=1 APERTURE=... BETWEEN i j",
        )


def check_steady(sweeps: int, part: float) -> Iterator[Remark]:
    """FLOW STEADY: a flow that is not steady after so many sweeps; part: that a domain lacks."""
    if part > BALANCED:
        yield Remark(
            "flow-not-steady",
            f"after {sweeps} sweeps a domain still gains or loses {part:.2g} of the greatest flow: repeat "
            "FLOW STEADY",
        )


def describe_flow(array: MainArray) -> str:
    """One line: the steps of flow in a cycle."""
    h = array.h
    step, every = float(h.cr[g.FDEL]), int(h.ci[g.NFEVRY])
    if h.ci[g.LFLOW] != g.COUPLED or step == 0:
        return "no water flows in a cycle"
    each = float(h.cr[g.TDEL]) * every
    when = "a cycle" if every == 1 else f"every {every} cycles"
    steps = counted(ceil(each / step), "step")
    return f"flow is stable in steps of {step:.4g} s: {steps} in {when} ({each:.4g} s)"
