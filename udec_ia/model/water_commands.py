"""Methods of Model for water: FLUID, PPRESSURE, FLOW, and tables of domains and pipes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from udec_ia.advice.water_report import check_apertures, check_steady
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import water_command
from udec_ia.reader.group_ranges import range_of
from udec_ia.reader.water_rows import contact_flows, domain_water


def fluid(
    session: Session,
    *,
    kw: float | None = None,
    density: float | None = None,
    viscosity: float | None = None,
    mode: str | None = None,
    every: int | None = None,
) -> None:
    """FLUID: there is water in the domains from now on; what is not given stays.

    Parameters
    ----------
    kw, density, viscosity
        Bulk modulus in Pa (2e9 at first), density in kg/m3 (1000), viscosity in Pa.s (0.001).
    mode
        What changes pressures in cycles: "coupled" (the default: deformation and flow), "undrained"
        (deformation alone) or "drained" (nothing).
    every
        Cycles from one pass of flow to the next, 1 at first.

    Raises
    ------
    UdecError
        1, 10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.fluid(kw=2e9, density=1000, mode="undrained")
    """
    session.ensure_ready()
    water_command.fluid(session.array, mode, every, kw=kw, density=density, viscosity=viscosity)


def ppressure(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    p: float | None = None,
    *,
    level: float | None = None,
    pxgrad: float = 0.0,
    pygrad: float = 0.0,
    state: str | None = None,
    flow: float | None = None,
) -> int:
    """PPRESSURE: pressure of the water in the domains of a range.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of the middles of domains.
    p, pxgrad, pygrad
        Pressure in Pa at the origin, and its increase per metre in x and y. Domains in which it is below 0
        have no water.
    level
        Instead: height in m of the surface of water at rest at x = 0, under the present gravity.
    state
        "held": the pressure is held from now on; "free" ends that. Without p the present one stays.
    flow
        Flow in m2/s that each domain gets from now on, as from a well; less than 0 leaves. It needs no p.

    Returns
    -------
    int
        The number of domains.

    Raises
    ------
    UdecError
        10, 24, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.jproperty(1, kn=1e10, ks=1e10, friction=0.6, aperture=1e-4, between=(1, 1))
    >>> m.fluid()
    >>> m.ppressure("ALL", level=3.0)  # water at rest, under 3 m
    1
    """
    session.ensure_ready()
    where = range_of(x1, x2, y1, y2)
    return water_command.ppressure(session.array, where, p, level, pxgrad, pygrad, state, flow)


def flow(
    session: Session, *, steady: bool = False, time: float | None = None, steps: int | None = None
) -> water_command.Flowed:
    """FLOW: water flows while blocks do not move.

    Parameters
    ----------
    steady
        To the steady state: nothing is stored.
    time, steps
        For a time in s, or for a number of stable steps; both: for the time, in that many steps or in as many
        as are stable. The time of the model grows.

    Returns
    -------
    Flowed
        `steps` (of flow, or rounds), `time` (s; None if steady) and `rest`, the greatest part of the flow
        through a domain that is not in balance in the steady state.

    Raises
    ------
    UdecError
        10, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.jproperty(1, kn=1e10, ks=1e10, friction=0.6, aperture=1e-4, between=(1, 1))
    >>> m.fluid()
    >>> m.flow(time=0.01).time
    0.01
    """
    session.ensure_ready()
    done = water_command.flow(session.array, steady, time, steps)
    remarks = check_steady(done.steps, done.rest) if steady else ()
    session.report_remarks([*check_apertures(session.array), *remarks])
    return done


def water(session: Session) -> NDArray[np.void]:
    """The water in all domains but the outer one.

    Returns
    -------
    numpy.ndarray
        Structured array with `domain` (address), `x`, `y` (m, the place of the pressure), `pressure` (Pa),
        `saturation`, `volume` (m2), `inflow` (m2/s) and `state` (0 flows, 1 held, 2 excavated).

    Raises
    ------
    UdecError
        26 without FLUID.

    Examples
    --------
    >>> m.fluid()
    >>> m.water()["pressure"].tolist()  # Pa
    [0.0]
    """
    session.ensure_ready()
    water_command.need_water(session.array)
    return domain_water(session.array.h)


def pipes(session: Session) -> NDArray[np.void]:
    """Flow at all contacts but virtual ones.

    Returns
    -------
    numpy.ndarray
        Structured array with `contact` (address), `x`, `y` (m), `one`, `two` (addresses of domains), `flow`
        from one to two (m2/s), `aperture` and `length` (m).

    Raises
    ------
    UdecError
        26 without FLUID.

    Examples
    --------
    >>> m.jproperty(1, kn=1e10, ks=1e10, friction=0.6, aperture=1e-4, between=(1, 1))
    >>> m.fluid()
    >>> len(m.pipes()) == len(m.table("contact"))
    True
    """
    session.ensure_ready()
    water_command.need_water(session.array)
    return contact_flows(session.array.h)
