"""Water as tables: a row for each domain, and one for each contact through which water can flow."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.kernels.links.longer_groups import pipes_at, waters_at
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import groups

STATES = ("flows", "held", "excavated", "new")  # by KVCODE
DOMAINS = {  # columns: unit and type
    "domain": ("", "i8"),
    "x": ("m", "f8"),
    "y": ("m", "f8"),
    "pressure": ("Pa", "f8"),
    "saturation": ("", "f8"),
    "volume": ("m2", "f8"),
    "inflow": ("m2/s", "f8"),
    "state": ("", "i8"),
}
PIPES = {
    "contact": ("", "i8"),
    "x": ("m", "f8"),
    "y": ("m", "f8"),
    "one": ("", "i8"),
    "two": ("", "i8"),
    "flow": ("m2/s", "f8"),
    "aperture": ("m", "f8"),
    "length": ("m", "f8"),
}
KINDS = ("pressure", "flow", "impermeable")  # by KOKIND, from 1 on; a dry edge is a seepage face
SOURCES = {
    "water from": ("", "U16"),
    "p": ("Pa", "f8"),
    "PXGRAD": ("Pa/m", "f8"),
    "PYGRAD": ("Pa/m", "f8"),
    "ends": ("", "i8"),
    "inflow": ("m2/s", "f8"),
}


def _rows(columns: dict[str, tuple[str, str]], values: tuple[Any, ...]) -> NDArray[np.void]:
    """A structured array with these columns."""
    rows = np.zeros(len(values[0]), [(name, kind) for name, (_, kind) in columns.items()])
    for name, column in zip(columns, values, strict=True):
        rows[name] = column
    return rows


def domain_water(h: Memory) -> NDArray[np.void]:
    """All domains but the outer one, as a structured array (n,) with the columns DOMAINS, in list order.

    x, y: the point to which the pressure belongs. pressure: 0 where a held one is below 0. state: number in
    STATES.
    """
    at: Any = np.array([idm for idm in groups(h, "domain") if idm != h.ci[g.IODPNT]], np.int64)
    ix = waters_at(h, at)
    parts = (getr(h, ix, k) for k in (g.KVSAT, g.KVVOL, g.KVQ))
    place = getr(h, ix, g.KVX), getr(h, ix, g.KVY)
    pressure = np.maximum(getr(h, at, g.KPP), 0.0)
    return _rows(DOMAINS, (at, *place, pressure, *parts, integers(h, ix, g.KVCODE)))


def contact_flows(h: Memory) -> NDArray[np.void]:
    """All contacts but virtual ones, as a structured array (n,) with the columns PIPES, in list order.

    flow: from domain `one` to domain `two`.
    """
    at = np.array(list(groups(h, "contact")), np.int64)
    at = at[integers(h, at, g.KCCOD) != g.VIRTUAL]
    ix = pipes_at(h, at)
    domains = integers(h, at, g.KD1), integers(h, at, g.KD2)
    length = getr(h, ix, g.KPL1) + getr(h, ix, g.KPL2)
    place = getr(h, at, g.KXC), getr(h, at, g.KYC)
    flow = np.asarray(getr(h, ix, g.KPQ)) + 0.0  # no -0
    return _rows(PIPES, (at, *place, *domains, flow, getr(h, ix, g.KPA), length))


def water_on_sides(h: Memory, contacts: Any, name: str) -> Any:
    """`pressure` or `saturation` of the domains on side KD1 and KD2 of the contacts (n,): (n, 2).

    The outer domain has what the other side has.
    """
    rows = domain_water(h)
    order = np.argsort(rows["domain"])
    sides = np.stack([integers(h, contacts, k) for k in (g.KD1, g.KD2)], axis=1)
    outer = sides == h.ci[g.IODPNT]
    sides = np.where(outer, sides[:, ::-1], sides)
    found = np.searchsorted(rows["domain"], sides, sorter=order)
    known = sides != h.ci[g.IODPNT]
    values = rows[name][order[np.minimum(found, len(rows) - 1)]] if len(rows) else np.zeros(sides.shape)
    return np.where(known, values, 0.0)


def water_balance(h: Memory) -> Any:
    """Flow into the joints from all that gives or takes water, as a structured array with columns SOURCES.

    A row for each condition outside, and for each of the others that there are: edges without a condition
    (seepage faces), held and excavated domains, and flows that PPRESSURE gives to the others (wells). ends:
    contacts, or domains.
    """
    outer = int(h.ci[g.IODPNT])
    pipes, rows = contact_flows(h), domain_water(h)
    ix = pipes_at(h, pipes["contact"])
    at_outside = (pipes["one"] == outer) != (pipes["two"] == outer)
    into = np.where(pipes["one"] == outer, pipes["flow"], -pipes["flow"])
    condition = integers(h, ix, g.KPOUT)
    found = []
    free = at_outside & (condition == 0)
    for iou in groups(h, "outside"):
        if (kind := int(integers(h, iou, g.KOKIND))) == g.DRY:
            free |= at_outside & (condition == iou)
            continue
        here = at_outside & (condition == iou)
        numbers = (float(getr(h, iou, k)) for k in (g.KOP, g.KOGX, g.KOGY))
        found.append((KINDS[kind - 1], *numbers, int(here.sum()), into[here].sum()))
    through = _flow_into(rows["domain"], pipes)
    wells = np.asarray(getr(h, waters_at(h, rows["domain"]), g.KVGIVN)) != 0
    others = [("seepage faces", free, into)]
    for name, code in (("held", g.HELD), ("excavated", g.EXCAVATED)):
        others.append((f"{name} domains", rows["state"] == code, -through))
    others.append(("wells in domains", wells & (rows["state"] == g.FLOWS), rows["inflow"] - through))
    found += [
        (name, 0.0, 0.0, 0.0, int(here.sum()), flow[here].sum()) for name, here, flow in others if here.any()
    ]
    return _rows(SOURCES, tuple(zip(*found, strict=True)) or ((),) * len(SOURCES))


def _flow_into(domains: Any, pipes: Any) -> Any:
    """Flow by all pipes into each of the domains (n,)."""
    order = np.argsort(domains)
    total = np.zeros(len(domains))
    for side, sign in (("one", -1), ("two", 1)):
        row = np.searchsorted(domains, pipes[side], sorter=order)
        row = order[np.minimum(row, len(domains) - 1)] if len(domains) else row
        known = domains[row] == pipes[side] if len(domains) else np.zeros(len(pipes), bool)
        np.add.at(total, row[known], sign * pipes["flow"][known])
    return total


def water_account(h: Memory) -> dict[str, float]:
    """Water in all domains (m2), what has come in from outside, by commands, and with changes of domains."""
    rows = domain_water(h)
    total = rows["volume"] * (rows["saturation"] + np.maximum(rows["pressure"], 0) / float(h.cr[g.WKW]))
    return {
        "there": float(total.sum()),
        "from outside": float(h.cd[g.WATIN]),
        "by commands": float(h.cd[g.WATPUT]),
        "by changes of domains": float(h.cd[g.WATMAP]),
    }


def water_energy(h: Memory) -> dict[str, float]:
    """Energy of the water (J/m): compression now, and what has come and gone since ENERGY ON."""
    rows = domain_water(h)
    compression = rows["volume"] * rows["pressure"] ** 2 / (2 * float(h.cr[g.WKW]))
    return {
        "compression": float(compression[rows["state"] == g.FLOWS].sum()),
        "from outside": float(h.cd[g.WPUMPW]),
        "from gravity": float(h.cd[g.WHEADW]),
        "lost to viscosity": float(h.cd[g.WVISCW]),
        "work on blocks": float(h.cd[g.WATERW]),
    }
