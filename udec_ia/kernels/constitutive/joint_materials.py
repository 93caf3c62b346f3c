"""Joint materials: which one a contact has, and the state of its joint (report 2.4).

The word joint has three meanings here. A joint is where two blocks face each other. Its number, 1 to 200, is
that of SPLIT ... JOINT, which several cuts can share. The group `joint` behind each contact has the stresses
and the length of that contact's part of the joint; `ix` is its address.

A contact has the joint material of the first of these rules that gives one, whichever block comes first:

    1  CHANGE ... JMATERIAL was given for the contact
    2  SPLIT ... JOINT made the edges that face each other at the contact, and the joint has a material
    3  JPROPERTY gives one for the pair of materials of its blocks
    4  otherwise none: stiffness and strength are those of the contact's first block (report 4.3); INSITU
       gives it joint material -1, which has the same and keeps an initial force

A contact with a joint material uses the joint behind it, with its stresses and its lengths. The rules are
applied to all contacts by `update_joints` (contact/joint_lengths.py) after each change of the map.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, iget, int64, puti, real, size_of
from udec_ia.heap.find_lose import clear_group, unwatch
from udec_ia.kernels.geometry.block_shape import zcs
from udec_ia.kernels.geometry.contact_geometry import meet
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.kernels.links.longer_groups import edge_at, joint_at
from udec_ia.layout import offsets as g

JOINTS = 200  # greatest number of a joint
NOISE = 1e-8  # times D: slip and opening by rounding
MATERIALS = 50  # greatest number of a joint material
NONE, BY_BLOCKS = 0, -1  # joint materials: none; the properties of the material of its blocks, per contact
ALONG = 0.8660254  # cosine of 30 degrees: the normals of a contact and of its edges are as near
ALIKE = 1e-3  # difference of sums of cosines that does not count


@kernel
def _joint_of_edge(h: Memory, ip: int, nx: float, ny: float) -> tuple[int, float]:
    """Joint that made the edge which ends at corner `ip`, and the cosine of its outward normal with (nx, ny).

    0 and 0 if no joint made it, or if the cosine is below ALONG.
    """
    joint = iget(h, edge_at(h, ip), g.KEJ)
    if joint == 0:
        return int64(0), real(h, 0.0)
    _, c, s = zcs(h, ip)
    cosine = c * ny - s * nx
    return (joint, cosine) if cosine >= real(h, ALONG) else (int64(0), real(h, 0.0))


@kernel
def _joints_at(
    h: Memory, ip: int, on_arc: bool, nx: float, ny: float
) -> tuple[tuple[int, float], tuple[int, float]]:
    """Joints that made the edge of corner `ip`, and the edge after it if a contact is on its arc."""
    joint = _joint_of_edge(h, ip, nx, ny)
    if not on_arc:
        return joint, (int64(0), real(h, 0.0))
    return joint, _joint_of_edge(h, next_corner(h, iget(h, ip, g.KNB), ip), nx, ny)


@kernel
def joint_numbers(h: Memory, ic: int) -> tuple[int, int]:
    """Number of the joint that contact `ic` lies on, and of another one that crosses it there; 0 for none.

    Of several it is that whose edges face each other best: on both sides rather than on one, by the sum of
    the cosines; the lesser number of equals.
    """
    code, ip, iq = iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2)
    nx, ny, _, _, _, _ = meet(h, code, ip, iq)
    one = _joints_at(h, ip, code != g.EDGE_CORNER, nx, ny)
    two = _joints_at(h, iq, code != g.CORNER_EDGE, -nx, -ny)
    best, fit, other = int64(0), real(h, 0.0), int64(0)
    for number in (one[0][0], one[1][0], two[0][0], two[1][0]):
        sides = [real(h, 0.0), real(h, 0.0)]
        for k, side in enumerate((one, two)):
            for joint, cosine in side:
                if joint == number:
                    sides[k] = max(sides[k], cosine)
        found = sides[0] + sides[1]
        if number == 0 or number == best:
            continue
        if found > fit + real(h, ALIKE) or (found > fit - real(h, ALIKE) and number < best):
            best, fit, other = number, found, best
        elif min(sides) > 0:
            other = number
    return best, other


@kernel
def material_of_pair(h: Memory, one: int, two: int) -> int:
    """Joint material between block materials `one` and `two`, the least number; NONE if there is none."""
    for m in range(MATERIALS):
        a, b = h.ci[g.JMB1 + m], h.ci[g.JMB2 + m]
        if h.ci[g.JMLAW + m] != 0 and ((a == one and b == two) or (a == two and b == one)):
            return int64(m + 1)
    return int64(NONE)


@kernel
def joint_material(h: Memory, ic: int) -> int:
    """Joint material of contact `ic` by the rules above; NONE if it has none."""
    ix = joint_at(h, ic)
    given = iget(h, ix, g.KCJMAT) if ix != 0 else int64(NONE)
    if given > 0 and has_flag(h, ix, g.JOINT_GIVEN):
        return given
    joint, _ = joint_numbers(h, ic)
    if joint != 0 and h.ci[g.JLINE + joint - 1] != 0:
        return int64(h.ci[g.JLINE + joint - 1])
    m = material_of_pair(h, iget(h, iget(h, ic, g.KB1), g.KMAT), iget(h, iget(h, ic, g.KB2), g.KMAT))
    return given if m == NONE and given == BY_BLOCKS else m


@inlined
def is_per_contact(h: Memory, ix: int) -> bool:
    """True if the stresses of joint `ix` are forces, and its length is 1."""
    m = iget(h, ix, g.KCJMAT)
    return m < 0 or h.ci[g.JMUNIT + m - 1] == g.PER_CONTACT


@inlined
def has_ends(h: Memory, ix: int) -> bool:
    """True if joint `ix` has the report's form (contact/edge_to_edge.py)."""
    m = iget(h, ix, g.KCJMAT)
    return m > 0 and h.ci[g.JMUNIT + m - 1] == g.PER_LENGTH_AT_ENDS


@inlined
def is_lumped(h: Memory, ix: int) -> bool:
    """True if each end of joint `ix` carries its own stress on half of it: the report's form.

    So do YIELDING and BARTON: their stress is not linear between the ends.
    """
    m = iget(h, ix, g.KCJMAT)
    if m <= 0:
        return False
    law = h.ci[g.JMLAW + m - 1]
    return has_ends(h, ix) or law == g.CONTINUOUSLY_YIELDING or law == g.BARTON_BANDIS


@inlined
def rounding_noise(h: Memory) -> float:
    """Slip and opening (m) up to which they are rounding and do not weaken a joint."""
    return h.cr[g.DTOL] * real(h, NOISE)


@kernel
def lose_joint(h: Memory, ic: int) -> None:
    """Contact `ic` has no joint material any more."""
    ix = joint_at(h, ic)
    if ix != 0:
        unwatch(h, ix)
        clear_group(h, ix, g.NVJT)


@kernel
def begin_joint(h: Memory, ic: int, mat: int, is_whole: bool) -> int:
    """Give contact `ic`, which has none, joint material `mat`. Returns its joint.

    is_whole: the joint has its tensile strength; else it counts as open at first. Lengths are not known yet.
    """
    ix = int64(ic + size_of(h, g.NVCN))
    puti(h, ix, g.KCJMAT, mat)
    puti(h, ix, g.KCJFLAG, g.JOINT_STALE if is_whole else g.JOINT_STALE | g.JOINT_BROKEN | g.JOINT_OPENS)
    return ix


@inlined
def has_flag(h: Memory, ix: int, flag: int) -> bool:
    """True if joint `ix` has `flag`, of JOINT_SLIPS ... OPENS_BESIDE2, or one of several."""
    return iget(h, ix, g.KCJFLAG) & flag != 0


@inlined
def set_flag(h: Memory, ix: int, flag: int) -> None:
    """Set `flag` of joint `ix`."""
    puti(h, ix, g.KCJFLAG, iget(h, ix, g.KCJFLAG) | flag)


@inlined
def clear_flag(h: Memory, ix: int, flag: int) -> None:
    """Clear `flag` of joint `ix`."""
    puti(h, ix, g.KCJFLAG, iget(h, ix, g.KCJFLAG) & ~flag)
