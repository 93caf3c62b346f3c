"""FLUID, PPRESSURE and FLOW: water in domains, its pressures, and its flow while blocks do not move.

The first FLUID gives every domain its water and every contact its pipe (kernels/water). Apertures are those
of joint materials, so all contacts get joints as well.
"""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, iget, puti, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import poll
from udec_ia.kernels.body.boundary_conditions import set_signals
from udec_ia.kernels.links.longer_groups import water_at
from udec_ia.kernels.map.domain_water import water_of
from udec_ia.kernels.water.water_flow import find_flow_step, flow_for_time
from udec_ia.kernels.water.water_pressure import renew_present_volumes
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.joint_property_command import add_joints, update_all_joints
from udec_ia.ops.common.array_growth import lengthen_groups
from udec_ia.ops.common.block_ranges import check_range, why_nothing
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.number_limits import AfterChangesError, finite, positive, whole
from udec_ia.printable_text import counted
from udec_ia.reader.group_ranges import Range, holds
from udec_ia.reader.group_tables import table
from udec_ia.reader.water_rows import water_account

WATER = {"kw": (g.WKW, 2e9), "density": (g.WDENS, 1e3), "viscosity": (g.WVISC, 1e-3)}
MODES = {"coupled": g.COUPLED, "undrained": g.UNDRAINED, "drained": g.DRAINED}
NO_FLUID = "first give the command FLUID"
FOLLOWED = 100  # steps of FLOW TIME at least, where a condition follows a FUNCTION
PIECE = 1000  # steps between two looks for an interrupt
BALANCED = 1e-9  # part of the flow through a domain that may be missing in a steady state
MANY_STEPS = 100_000_000  # of FLOW TIME
STATES = {"held": g.HELD, "free": g.FLOWS}
LONG_STEPS = "lower KW, or MAPERTURE of wide joints; RAPERTURE raises V of tight ones beside them"


def fluid(array: MainArray, mode: str | None = None, every: int | None = None, **given: float | None) -> None:
    """FLUID: what the water is like, and what changes its pressures in cycles.

    given: of WATER. Errors 1, 10 and 28, and nothing is changed.
    """
    values = {name: float(value) for name, value in given.items() if value is not None}
    positive(array, **values)
    if mode is not None and mode.lower() not in MODES:
        raise UdecError(10, mode, " or ".join(MODES).upper(), parameter="mode")
    if every is not None and whole(every=every) < 1:
        raise UdecError(28, f"every {every} cycles", "give 1 or more", parameter="every")
    add_water(array)
    h = array.h
    before = water_account(h)["there"]
    for name, value in values.items():
        h.cr[WATER[name][0]] = value
    h.cd[g.WATPUT] += water_account(h)["there"] - before  # at the same pressures
    if mode is not None:
        h.ci[g.LFLOW] = MODES[mode.lower()]
    if every is not None:
        h.ci[g.NFEVRY] = every
    update_water(array)


def add_water(array: MainArray) -> None:
    """Give each domain its water and each contact its pipe. Error 1, and nothing is changed."""
    if array.h.ci[g.LWATER]:
        return
    add_joints(array)
    lengthen_groups(array, "LWATER")
    h = array.h
    for k, value in WATER.values():
        h.cr[k] = value
    h.ci[g.NFEVRY] = 1
    update_all_joints(array)


def update_water(array: MainArray) -> None:
    """Volumes and pipes of the present state, after a command; pressures stay. Forces are summed again."""
    if array.h.ci[g.LWATER] and array.h.ci[g.NDOM]:
        renew_present_volumes(array.h)
        find_flow_step(array.h)
        check_finite(array)
        renew_forces(array)
        check_forces(array)


def check_finite(array: MainArray) -> None:
    """Error 28 if a volume or a flow is beyond the range of the reals."""
    for kind, fields in (("water", ("KVVOL", "KVLEN")), ("pipe", ("KPA", "KPK"))):
        rows = table(array, kind)
        if not all(np.isfinite(rows[name]).all() for name in fields):
            advice = "look at APERTURE of joint materials, and at KW and VISCOSITY of FLUID"
            raise AfterChangesError(28, "a volume or a flow is beyond the range of the reals", advice)


def check_forces(array: MainArray) -> None:
    """Error 28 if pressures give blocks forces beyond the range of the reals."""
    blocks = table(array, "block")
    if not all(np.isfinite(blocks[name]).all() for name in ("KBFX", "KBFY", "KBFT")):
        raise AfterChangesError(
            28, "a pressure whose force is beyond the range of the reals", "give a smaller one"
        )


def need_water(array: MainArray) -> None:
    """Error 26 unless there was a FLUID."""
    if not array.h.ci[g.LWATER]:
        raise UdecError(26, "there is no fluid", NO_FLUID)


def pressure_field(
    array: MainArray, p: float | None, level: float | None, pxgrad: float, pygrad: float
) -> tuple[float, float, float]:
    """Pressure at the origin and its increases with x and y. Errors 10, 26 and 28.

    level: y of the surface of water at rest at x = 0, under the present gravity, to which it is normal.
    """
    finite(array, p=p or 0.0, level=level or 0.0, pxgrad=pxgrad, pygrad=pygrad)
    if level is None:
        if p is None and not (pxgrad or pygrad):
            raise UdecError(26, "no pressure and no level", "give one of them")
        return float(p or 0.0), float(pxgrad), float(pygrad)
    if p is not None or pxgrad or pygrad:
        raise UdecError(10, "a pressure and a level", "give one of them", parameter="level")
    gx, gy, density = (float(array.h.cr[k]) for k in (g.GRAVX, g.GRAVY, g.WDENS))
    if not gy:
        advice = "first give the command GRAVITY; without a vertical part, give p and PXGRAD"
        raise UdecError(26, "a level without vertical gravity", advice, parameter="level")
    return -density * gy * level, density * gx, density * gy


def ppressure(
    array: MainArray,
    where: Range,
    p: float | None = None,
    level: float | None = None,
    pxgrad: float = 0.0,
    pygrad: float = 0.0,
    state: str | None = None,
    flow: float | None = None,
) -> int:
    """PPRESSURE: pressure of the domains in the range; without water where it is below 0. Their number.

    state: "held" holds it from now on, "free" ends that. flow: in m2/s, given to each of the domains from
    now on. Both need no pressure, and the present one stays then. Errors 10, 24, 26 and 28.
    """
    need_water(array)
    check_range(array, where)
    finite(array, flow=flow or 0.0)
    if state is not None and state.lower() not in STATES:
        raise UdecError(10, state, "HELD or FREE", parameter="state")
    code = STATES[state.lower()] if state is not None else None
    is_pressed = p is not None or level is not None or bool(pxgrad or pygrad)
    needs = is_pressed or (code is None and flow is None)
    field = pressure_field(array, p, level, pxgrad, pygrad) if needs else None
    h = array.h
    domains = table(array, "domain")["address"].tolist()
    domains = [idm for idm in domains if idm != h.ci[g.IODPNT]]
    places = {idm: _place(array, idm) for idm in domains}
    x, y = np.array(list(places.values()), np.float64).reshape(-1, 2).T
    inside = np.array(domains, np.int64)[holds(array, where, x, y)].tolist()
    if not inside:
        what = ((f"domain@{idm}", (place,)) for idm, place in places.items())
        raise UdecError(24, why_nothing(where, "domain", what), "PRINT WATER shows them", parameter="x1")
    for idm in inside:
        if flow is not None:
            putr(h, water_at(h, idm), g.KVGIVN, flow)
        if code is not None:
            _set_state(array, idm, code)
        if field is not None:
            _set_pressure(array, idm, field, places[idm])
    renew_forces(array)
    check_forces(array)
    return len(inside)


def _place(array: MainArray, idm: int) -> tuple[float, float]:
    """Point of domain `idm` to which its pressure belongs."""
    ix = water_at(array.h, idm)
    return float(getr(array.h, ix, g.KVX)), float(getr(array.h, ix, g.KVY))


def _set_state(array: MainArray, idm: int, code: int) -> None:
    """Hold the pressure of domain `idm` as it is from now on, at rest under gravity, or no longer."""
    h, ix = array.h, water_at(array.h, idm)
    before, was = water_of(h, idm), iget(h, ix, g.KVCODE)
    puti(h, ix, g.KVCODE, code)
    if code == g.FLOWS:
        putr(h, idm, g.KPP, max(getr(h, idm, g.KPP), 0.0))
    if code == g.FLOWS or was != g.HELD:
        for k, gravity in ((g.KVGX, g.GRAVX), (g.KVGY, g.GRAVY)):
            putr(h, ix, k, float(h.cr[g.WDENS]) * float(h.cr[gravity]) if code == g.HELD else 0.0)
    h.cd[g.WATPUT] += water_of(h, idm) - before


def _set_pressure(
    array: MainArray, idm: int, field: tuple[float, float, float], place: tuple[float, float]
) -> None:
    h, ix = array.h, water_at(array.h, idm)
    if iget(h, ix, g.KVCODE) == g.EXCAVATED:
        puti(h, ix, g.KVCODE, g.HELD)  # it is filled from now on
    before, held = water_of(h, idm), iget(h, ix, g.KVCODE) == g.HELD
    p = field[0] + field[1] * place[0] + field[2] * place[1]
    putr(h, idm, g.KPP, p if held else max(p, 0.0))
    putr(h, ix, g.KVSAT, 1.0 if p >= 0 else 0.0)
    putr(h, ix, g.KVGX, field[1] if held else 0.0)
    putr(h, ix, g.KVGY, field[2] if held else 0.0)
    h.cd[g.WATPUT] += water_of(h, idm) - before


class Flowed(NamedTuple):
    """How FLOW has ended. steps: of flow, or rounds; time: in s, None for STEADY; rest: of flow_to_steady."""

    steps: int
    time: float | None = None
    rest: float = 0.0

    def __str__(self) -> str:
        if self.time is not None:
            return f"water has flowed for {self.time:.6g} s in {counted(self.steps, 'step')}"
        state = "steady" if self.rest <= BALANCED else "not steady"
        balance = f"each domain balances to {self.rest:.2g} of the flow through it"
        return f"{state} after {counted(self.steps, 'round')}: {balance}"


def flow(
    array: MainArray, steady: bool = False, time: float | None = None, steps: int | None = None
) -> Flowed:
    """FLOW: water flows and blocks do not move: to a steady state, for a time (s), or for stable steps.

    time and steps: in that many steps, or as many more as are stable. Errors 10, 26 and 28.
    """
    need_water(array)
    in_time = time is not None or steps is not None
    if steady == in_time:
        detail = "STEADY beside TIME or STEPS" if steady else "FLOW how long?"
        raise UdecError(10, detail, "give STEADY, or TIME t, STEPS n or both")
    if time is not None:
        positive(array, time=time)
    if steps is not None and whole(steps=steps) < 1:
        raise UdecError(28, f"{steps} steps", "give 1 or more", parameter="steps")
    set_signals(array.h)
    renew_present_volumes(array.h)
    done = _flow_to_steady(array) if steady else _flow_in_steps(array, time, steps)
    renew_forces(array)
    return done


def _flow_to_steady(array: MainArray) -> Flowed:
    from udec_ia.ops.commands.steady_flow import flow_to_steady, trapped_supply  # scipy loads slowly

    supply, idm = trapped_supply(array)
    if idm:
        x, y = _place(array, idm)
        detail = f"{supply:g} m2/s more flow into joints at ({x:g}, {y:g}) than can leave: never steady"
        advice = "give an edge there a PPRESSURE or FREE it, or end the well with PPRESSURE ... FLOW=0"
        raise AfterChangesError(28, detail, advice, parameter="steady")
    done, rest = flow_to_steady(array, BALANCED)
    return Flowed(done, rest=rest)


def _flow_in_steps(array: MainArray, time: float | None, steps: int | None) -> Flowed:
    """Flow in stable steps. Signals change with each step, if a condition outside follows one."""
    h = array.h
    follows = bool((table(array, "outside")["KOS"] != 0).any())
    find_flow_step(h)
    asked = int(steps or (FOLLOWED if follows and time is not None else 1))
    if time is None:
        time = float(h.cr[g.FDEL]) * asked
    begin, left, taken = float(h.cd[g.TIME]), time, 0
    while left > 0 or not taken:
        poll()
        step = float(h.cr[g.FDEL])
        many = max(asked - taken, ceil(min(left / step, 1e300)) if step else 1, 1)
        if taken + many > MANY_STEPS:
            detail = f"{time:g} s are {taken + many:.3g} steps of flow"
            advice = f"the greatest stable step is {step:.4g} s: {LONG_STEPS}; FLOW STEADY has no steps"
            raise AfterChangesError(28, detail, advice, parameter="time")
        piece = 1 if follows else min(PIECE, many)
        flow_for_time(h, left * piece / many, piece)
        taken, left = taken + piece, left * (many - piece) / many
        h.cd[g.TIME] = begin + (time - left)
        set_signals(h)
        find_flow_step(h)
    return Flowed(taken, time)
