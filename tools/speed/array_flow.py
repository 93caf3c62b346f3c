"""Steps of flow in the program against the same arithmetic in a structure of arrays."""

from __future__ import annotations

from time import process_time
from typing import Any

import numpy as np
from numba import njit

from udec_ia import Model
from udec_ia.kernels.water.water_flow import flow_for_time
from udec_ia.layout import offsets as g
from udec_ia.reader.water_rows import contact_flows, domain_water

TURNS, STEPS = 30, 60  # pieces that are timed by turns; steps of flow in each, as in a cycle of the slab


def wet_slab(model: Model) -> None:
    """Fill the joints of a slab of blocks, which stands on its base."""
    model.jproperty(1, kn=1e10, ks=1e10, friction=0.5, aperture=1e-3, between=(1, 1))
    model.fluid()
    model.ppressure(-1e9, 1e9, -1e9, 1e9, 1e5, pxgrad=1.0)


@njit
def flow_in_arrays(
    p: Any, s: Any, v: Any, head: Any, excess: Any, one: Any, two: Any, k: Any, kw: float, dt: float, n: int
) -> None:
    """`n` steps of flow between the domains of the arrays; -1 is the outside, from which nothing comes."""
    into = np.empty(len(p))
    for _ in range(n):
        into[:] = 0.0
        for i in range(len(k)):
            a, b = one[i], two[i]
            pa = p[a] - head[a] if a >= 0 else 0.0
            pb = p[b] - head[b] if b >= 0 else 0.0
            q = k[i] * (pa - pb)
            sat = (s[a] if a >= 0 else 0.0) if q > 0 else (s[b] if b >= 0 else 0.0)
            q *= sat * sat * (3.0 - 2.0 * sat)
            if a >= 0:
                into[a] -= q
            if b >= 0:
                into[b] += q
        for i in range(len(p)):
            excess[i] += into[i] * dt
            p[i] = max(excess[i], 0.0) * kw / v[i]
            s[i] = min(1.0 + excess[i] / v[i], 1.0)


def compare(model: Model) -> tuple[float, float]:
    """Seconds of STEPS steps in the program, with copies to arrays and back, and in arrays: medians."""
    h = model.h
    domains, pipes = domain_water(h), contact_flows(h)
    row = {int(idm): i for i, idm in enumerate(domains["domain"])}
    inner = pipes["one"] != pipes["two"]
    one, two = (np.array([row.get(int(d), -1) for d in pipes[name][inner]]) for name in ("one", "two"))
    k, kw = model.table("pipe")["KPK"][inner], float(h.cr[g.WKW])
    p, s, v = (domains[name].copy() for name in ("pressure", "saturation", "volume"))
    excess = v * (p / kw + s - 1.0)
    dt, times = float(h.cr[g.FDEL]), []
    for _ in range(TURNS):
        clock = [process_time()]
        flow_for_time(h, dt * STEPS * 0.999, STEPS)
        clock.append(process_time())
        flow_in_arrays(p, s, v, np.zeros(len(p)), excess, one, two, k, kw, dt, STEPS)
        clock.append(process_time())
        times.append(np.diff(clock))
    ours, arrays = np.median(times[2:], axis=0)
    return float(ours), float(arrays)
