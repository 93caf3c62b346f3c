"""RESET: what a run adds up begins anew."""

from __future__ import annotations

from udec_ia.heap.accessors import Memory, getr, iget, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.function_command import put_beginning
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.reader.group_tables import addresses


def reset_displacements(array: MainArray) -> None:
    """Displacements of all blocks and grid-points := 0 in a scene with DISPLACEMENTS."""
    h = array.h
    if not h.ci[g.LDISP]:
        return
    blocks, points = (addresses(array, kind) for kind in ("displacement", "pointdisplacement"))
    for groups, fields in ((blocks, (g.KBDX, g.KBDY, g.KBDT)), (points, (g.KGDX, g.KGDY))):
        for field in fields:
            putr(h, groups, field, 0.0)


def reset_slip(h: Memory) -> None:
    """Shear displacements of all contacts := 0. Forces stay, and the dilation of joints."""
    contacts = list_of(h, "contact")
    putr(h, contacts, g.KCS, 0.0)
    joints = joints_at(h, contacts)
    putr(h, joints[joints != 0], g.KCJUSL, 0.0)


def reset_time(h: Memory) -> None:
    """Time of the model := 0. Functions begin again; sines go on, as their beginnings move too."""
    time = float(h.cd[g.TIME])
    for isg in list_of(h, "signal").tolist():
        if iget(h, isg, g.KTP) == 0:
            put_beginning(h, isg, float(getr(h, isg, g.KTBEG)) + float(getr(h, isg, g.KTREST)) - time)
    h.cd[g.TIME] = 0.0
