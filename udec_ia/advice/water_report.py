"""Remarks on water: apertures, steps of flow in a cycle, flow that is not steady, held pressures."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, isfinite
from typing import Any

import numpy as np

from udec_ia.heap.accessors import getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import joints_at, pipes_at, waters_at
from udec_ia.kernels.water.water_pressure import THIN
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.water_command import BALANCED
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.printable_text import counted
from udec_ia.reader.water_rows import contact_flows, domain_water
from udec_ia.remark import Remark

ROUNDING = 1e-9  # part of the flow by the greatest pressure that rounding may leave


def check_apertures(array: MainArray) -> Iterator[Remark]:
    """CYCLE and FLOW: contacts to which no joint material gives an aperture."""
    h = array.h
    if not h.ci[g.LWATER]:
        return
    contacts = list_of(h, "contact")
    contacts = contacts[integers(h, contacts, g.KCCOD) != g.VIRTUAL]
    joints = joints_at(h, contacts)
    mat = np.where(joints > 0, integers(h, np.maximum(joints, 1), g.KCJMAT), 0)
    lacks = (mat < 1) | ~(h.cr[g.JMHAP + np.maximum(mat, 1) - 1] > 0)
    lacking = contacts[lacks]
    if len(lacking):
        ic = int(lacking[0])
        advice = f"JPROPERTY JMATERIAL={mat[lacks][0] or '1 ... BETWEEN i j'} APERTURE=..."
        yield Remark(
            "no-aperture",
            f"no joint material gives {counted(len(lacking), 'contact')} an aperture, the first at "
            f"({getr(h, ic, g.KXC):g}, {getr(h, ic, g.KYC):g}): it is {THIN * h.cr[g.DTOL]:.3g} m there; "
            f"{advice}",
        )


def check_steady(rounds: int, part: float) -> Iterator[Remark]:
    """FLOW STEADY: a flow that is not steady after so many rounds; part: that a domain lacks."""
    if part > BALANCED:
        why = f"after {rounds} rounds a domain still gains or loses {part:.2g} of the flow through it"
        if not isfinite(part):
            why = "the reals cannot hold these flows"
        yield Remark("flow-not-steady", f"{why}: pressures are as before; use FLOW TIME")


def check_balance(array: MainArray, ratio: float) -> Iterator[Remark]:
    """SOLVE: flow that still changes pressures when the blocks are at rest.

    ratio: of SOLVE; the part of the greatest flow that a domain may gain or lose.
    """
    h = array.h
    if not h.ci[g.LWATER] or h.ci[g.LFLOW] != g.COUPLED:
        return
    rows, pipes = domain_water(h), contact_flows(h)
    rows = rows[rows["state"] == g.FLOWS]
    if not len(rows) or not len(pipes):
        return
    given = np.asarray(getr(h, waters_at(h, rows["domain"]), g.KVGIVN))
    greatest = float(max(np.abs(pipes["flow"]).max(), np.abs(given).max()))
    conductance = float(np.asarray(getr(h, pipes_at(h, pipes["contact"]), g.KPK)).max())
    worst = int(np.abs(rows["inflow"]).argmax())
    gains = abs(float(rows["inflow"][worst]))
    if greatest > 0 and gains > max(ratio * greatest, ROUNDING * conductance * float(rows["pressure"].max())):
        x, y = rows["x"][worst], rows["y"][worst]
        yield Remark(
            "water-flows",
            f"water is not at rest: the domain at ({x:.4g}, {y:.4g}) gains or loses {gains:.2g} m2/s, "
            f"{gains / greatest:.2g} of the greatest flow, so pressures and forces go on changing. FLOW "
            "STEADY and FLUID DRAINED before SOLVE lead to the final state",
        )


def held_pressures(array: MainArray) -> Any:
    """The domains with a held pressure or a flow that is given, as rows of domain_water."""
    if not array.h.ci[g.LWATER]:
        return np.zeros(0, [("domain", "i8"), ("state", "i8")])
    rows = domain_water(array.h)
    wells = np.asarray(getr(array.h, waters_at(array.h, rows["domain"]), g.KVGIVN)) != 0
    return rows[(rows["state"] == g.HELD) | wells]


def check_held(array: MainArray, before: Any) -> Iterator[Remark]:
    """CYCLE and DELETE: held pressures and wells that have ended, as their domains joined others.

    before: those at first.
    """
    gone = before[~np.isin(before["domain"], held_pressures(array)["domain"])] if len(before) else before
    if len(gone):
        what = "pressure that was held" if gone["state"][0] == g.HELD else "flow that was given"
        yield Remark(
            "held-pressure-ended",
            f"the {what} at ({gone['x'][0]:.4g}, {gone['y'][0]:.4g}) has ended, as its domain has joined "
            "another one or the outside: at the outside give BOUNDARY ... PPRESSURE or FLOW",
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
