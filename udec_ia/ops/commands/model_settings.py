"""The commands that set numbers: PROPERTY, GRAVITY, DAMPING, FRACTION, SCALE, FIX, FREE, RSET."""

from __future__ import annotations

import math

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, iget, integers, puti, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.mass_distribution import greatest_block
from udec_ia.kernels.body.motion import set_corner_velocities
from udec_ia.kernels.body.sdef import put_strain_rate
from udec_ia.kernels.constitutive.joint_materials import BY_BLOCKS
from udec_ia.kernels.constitutive.joint_properties import materials_of
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import DampingMode, read_table
from udec_ia.ops.commands.boundary_command import given_velocities
from udec_ia.ops.commands.function_command import BeforeGroups, check_followed, set_numbers
from udec_ia.ops.common.block_ranges import blocks_in
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.common.number_limits import (
    check_mass_range,
    finite,
    material_number,
    not_negative,
    positive,
    whole,
)
from udec_ia.reader.group_ranges import Range
from udec_ia.reader.list_walks import chain

DEFAULT_FRACTION = 0.1
PROPERTIES = {  # argument of PROPERTY: array of the common block
    one.argument: getattr(g, one.array) for one in read_table().properties if one.keyword
}
RANGES = {field.name: field.allowed for field in read_table().common}
# numbers for the user's laws, which may be negative
FREE = [one.argument for one in read_table().properties if not RANGES[one.array]]


# what masses and the time-step follow from: it must not change in a run
SETS_STEP = ("bulk", "density", "kn", "ks", "g")


def set_property(
    array: MainArray,
    material: int,
    function: int | None = None,
    before_groups: BeforeGroups = lambda: None,
    **values: float | None,
) -> None:
    """PROPERTY: set properties of a material; those not given stay.

    Parameters
    ----------
    array
        Main array.
    material
        Number of the material, 1 to 50.
    function
        Number of a FUNCTION whose factor multiplies the values, from now on. Without it, the values are
        constant again.
    before_groups
        Called before groups of IA() change.
    values
        Properties by their names, as in Model.property.

    Raises
    ------
    UdecError
        4 for the material, 28 for a negative value, 26 for a FUNCTION that is not defined, 10 for one with a
        density or a stiffness. Nothing is changed then.
    """
    i = material_number(material) - 1
    given = {name: value for name, value in values.items() if value is not None}
    finite(array, **{name: value for name, value in given.items() if name in FREE})
    not_negative(array, **{name: value for name, value in given.items() if name not in FREE})
    if function is not None:
        advice = "masses and the time-step follow from density and stiffness: give it on another line"
        check_followed(array, function, given, set(PROPERTIES) - set(SETS_STEP), advice)
    for name in ("kn", "ks"):
        if given.get(name) == 0 and _is_kept_by_insitu(array.h, material):
            advice = "give a stiffness above 0: the force of its contacts is kept by INSITU"
            raise UdecError(28, f"{name.upper()} of material {material}", advice, parameter=name)
    cr = array.h.cr
    bulk, shear = (float(given.get(name, cr[PROPERTIES[name] + i])) for name in ("bulk", "g"))
    lame = {"K + 4G/3": bulk + 4 * shear / 3, "K - 2G/3": bulk - 2 * shear / 3}  # constants of plane strain
    finite(array, **lame)
    if "density" in given:
        check_mass_range(array, given["density"], float(greatest_block(array.h)))
    set_numbers(
        array, {PROPERTIES[name] + i: value for name, value in given.items()}, function, before_groups
    )
    array.h.cr[g.ALAM1 + i], array.h.cr[g.ALAM2 + i] = lame.values()


def _is_kept_by_insitu(h: Memory, material: int) -> bool:
    """True if INSITU has given a contact of that material an initial force."""
    contacts = list_of(h, "contact")
    joints = joints_at(h, contacts)
    by_blocks = integers(h, joints[joints != 0], g.KCJMAT) == BY_BLOCKS
    return bool((by_blocks & (materials_of(h, contacts[joints != 0]) == material)).any())


def set_gravity(
    array: MainArray,
    gx: float,
    gy: float,
    function: int | None = None,
    before_groups: BeforeGroups = lambda: None,
) -> None:
    """GRAVITY: accelerations in the x and y directions, m/s2.

    function: number of a FUNCTION whose factor multiplies both, from now on; without it they are constant.
    before_groups: called before groups of IA() change. Error 26 for a FUNCTION that is not defined.
    """
    finite(array, gx=gx, gy=gy)
    set_numbers(array, {g.GRAVX: gx, g.GRAVY: gy}, function, before_groups)


def set_damping(array: MainArray, fcrit: float, freq: float, only: str | None = None) -> None:
    """DAMPING: Rayleigh damping with the fraction `fcrit` of critical at the centre frequency `freq` (Hz).

    ALPHA = fcrit 2 pi freq, BETA = fcrit/(2 pi freq). "mass" or "stiffness" drops the other half without
    rescaling: damping at the centre frequency is then fcrit/2. "internal" sets the damping of the internal
    degrees of freedom of simply-deformable blocks instead. Mass damping ends a mode of set_damping_mode.
    """
    not_negative(array, fcrit=fcrit)
    if fcrit == 0 == freq:
        raise UdecError(28, "freq is 0", "DAMPING 0 1 switches damping off", parameter="freq")
    positive(array, freq=freq)
    if only not in (None, "mass", "stiffness", "internal"):
        raise UdecError(10, f"{only}", "mass, stiffness or internal", parameter="only")
    omega = 2 * math.pi * freq
    alpha, beta = fcrit * omega, fcrit / omega
    finite(array, alpha=alpha, beta=beta)
    cr, mode = array.h.cr, mode_of(array.h)
    if only == "internal":
        cr[g.ALPB] = alpha
        return
    if only != "stiffness":
        _end_damping_mode(array.h)
        cr[g.ALPHA] = alpha
    elif not (mode and "alpha" in mode.effects):
        cr[g.ALPHA] = 0
    cr[g.BETA] = 0 if only == "mass" else beta


def set_damping_mode(array: MainArray, mode: DampingMode, f: float = 1.0) -> None:
    """DAMPING LOCAL f and the other modes of the table, which replace mass damping.

    f: fraction of the unbalanced force, or of critical damping (kernels.drive.damped_forces), up to 1.
    The modes act on strain rates of simply-deformable blocks, too. Stiffness damping stays as it is.
    """
    not_negative(array, **{mode.argument: f})
    if f > 1:
        advice = f"{mode.name} takes 0 to 1"
        raise UdecError(28, f"{f:g} is more than there is", advice, parameter=mode.argument)
    h = array.h
    _end_damping_mode(h)
    h.cr[g.ALPHA] = h.cr[g.ALPB] = 0
    h.ci[g.LREST], h.cr[g.RESTF] = mode.code, f


def _end_damping_mode(h: Memory) -> None:
    mode = mode_of(h)
    if mode and "alpha" in mode.effects:
        h.cr[g.ALPHA] = h.cr[g.ALPB] = 0  # calculated by the mode
    h.ci[g.LREST], h.cr[g.RESTF], h.cd[g.EMOVES] = g.UNDAMPED, 0, 0


def set_fraction(array: MainArray, f: float, safe: bool = False, scaled: bool = False) -> None:
    """FRACTION: use a fraction of the estimate of the critical time-step, or of the safe bound.

    scaled: inertial masses are scaled (running.mass_scaling), and the fraction is of the bound with these.
    Error 26 with an account of the energy: the motion of scaled masses has no true energy.
    """
    positive(array, f=f)
    if (safe or scaled) and f > 1:
        advice = f"f in FRACTION f {'SCALED' if scaled else 'SAFE'} must not exceed 1"
        raise UdecError(28, f"{f:g} of the safe bound is not safe", advice, parameter="f")
    if scaled and array.h.ci[g.LENER]:
        advice = "ENERGY OFF, or FRACTION without SCALED"
        raise UdecError(26, "no account of the energy can be kept with scaled masses", advice)
    array.h.cr[g.FRAC] = f
    array.h.ci[g.LSAFE] = int(safe or scaled)
    array.h.ci[g.LSCALE] = int(scaled)


def set_scale(array: MainArray, s: float) -> None:
    """SCALE: plot scale; 0 lets the plot fill its frame."""
    not_negative(array, s=s)
    array.h.cr[g.PSCALE] = s


def set_fixity(array: MainArray, where: Range, fixed: bool) -> int:
    """FIX and FREE: fix or free the blocks in the range, with velocities of 0. Returns their number."""
    h = array.h
    blocks = blocks_in(array, where)
    given = {} if fixed else given_velocities(h)
    for ib in blocks:
        puti(h, ib, g.KBFIX, g.FIXED if fixed else given.get(ib, 0))
        if fixed:
            _stop(h, ib)
    if not fixed and h.ci[g.MCTOT] > 0 and any(iget(h, ib, HEAD) == g.MFDEF for ib in blocks):
        renew_forces(array)  # a fixed block has none at its grid-points
    return len(blocks)


def _stop(h: Memory, ib: int) -> None:
    """Set all velocities and strain rates of block `ib`, its corners and grid-points to 0."""
    for k in (g.KXD, g.KYD, g.KTD):
        putr(h, ib, k, 0.0)
    set_corner_velocities(h, ib)
    ie = iget(h, ib, g.KBEX)
    if iget(h, ib, HEAD) == g.MSDEF:
        put_strain_rate(h, ie, *[h.cr.dtype.type(0)] * 3)
    elif iget(h, ib, HEAD) == g.MFDEF:
        for ig in chain(h, iget(h, ie, g.KFG), g.KG):
            putr(h, ig, g.KXDG, 0.0)
            putr(h, ig, g.KYDG, 0.0)


def rset(array: MainArray, v: float, ia: int, ioff: int) -> None:
    """RSET: put the real value `v` at offset `ioff` (counted from 1) of the group at address `ia`.

    Error 30 if the real would lie outside the groups in use, or if `ia` cannot be the address of a group.
    """
    finite(array, v=v)
    ia, ioff = whole(ia=ia), whole(ioff=ioff)
    h, ratio = array.h, array.scheme.ratio
    last = int(h.ci[g.MFREE]) - 1
    if ia < 1 or (ia - 1) % ratio:
        advice = f"addresses are 1 plus a multiple of {ratio}"
        raise UdecError(30, f"{ia} is not the address of a group", advice, parameter="ia")
    if ioff < 1:
        advice = "offsets count from 1: offset 1 is the first real of a group (HELP RSET)"
        raise UdecError(30, f"offset {ioff}", advice, parameter="ioff")
    if ia + ioff * ratio - 1 > last:
        place = f"offset {ioff} from address {ia}"
        raise UdecError(30, place, f"the last word in use is {last}", parameter="ia" if ia > last else "ioff")
    h.ra[(ia - 1) // ratio + ioff - 1] = v
