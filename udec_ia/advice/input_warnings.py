"""Warnings about suspicious input, given once before the run, each with a remedy.

Examples: an angle where a tangent is expected, a material that lacks a modulus, a SOLVE without damping.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any

import numpy as np

from udec_ia.advice.damping_report import what_damps
from udec_ia.heap.accessors import HEAD, getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import JOINT_ARRAYS, joints_of_materials, materials_of
from udec_ia.kernels.energy.stored_energy import changes_place
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.joint_model_numbers import KEYWORDS, MODELS, is_used
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.common.number_limits import NMAT, last_digit
from udec_ia.printable_text import counted
from udec_ia.remark import Remark

TANGENTS = ("friction", "residual_friction", "block_friction", "dilation", "block_dilation")
OURS = {field.name for field in read_table().common if field.ours and field.allowed}
PLACES = {one.keyword.upper(): (one.array, getattr(g, one.array)) for one in read_table().properties}
# Places in the common block of properties that constitutive number 1 ignores, and of joint properties.
OF_LAWS = {word: k for word, (name, k) in PLACES.items() if name in OURS}
OF_JOINTS = {word: k for word, (name, k) in PLACES.items() if name in JOINT_ARRAYS}
Groups = Callable[[Any, str], Any]  # returns the addresses of all groups of a kind in a Memory
RESOLVED = 0.005  # least force of a last digit over the mean contact force that is reported
SAME_SPIN = 1e-3  # change of the angular momentum that is not reported
GREATER = 1.05  # least ratio of moments of inertia that is reported
WIDE = 0.01  # aperture in m, above which flow is turbulent at any gradient that matters
STEEP = 5  # tangent of 79 degrees, steeper than any joint; 90 and more are not degrees


def check_properties(array: MainArray, material: int, values: dict[str, float | None]) -> Iterator[Remark]:
    """PROPERTY: a density that comes too late; an angle where a tangent is expected."""
    h = array.h
    if values.get("density") is not None and h.ci[g.MCTOT]:
        blocks = list_of(h, "block")
        made = (integers(h, blocks, g.KMAT) == material) & (getr(h, blocks, g.KBM) > 0)
        if made.any():
            yield _density_too_late(int(made.sum()), material)
    yield from _check_tangents(values, f"material {material}")


def check_joint_properties(array: MainArray, jmaterial: int, values: Mapping[str, Any]) -> Iterator[Remark]:
    """JPROPERTY: an angle where a tangent is expected; properties that the joint model does not use."""
    yield from _check_tangents(values, f"joint material {jmaterial}")
    law = int(array.h.ci[g.JMLAW + jmaterial - 1])
    unused = [name for name in values if values[name] is not None and not is_used(law, name)]
    if unused:
        model = next(name for name, code in MODELS.items() if code == law).upper()
        names = ", ".join(KEYWORDS[name] for name in unused)
        yield Remark("unused-property", f"{model} does not use {names}")
    yield from _check_apertures(array, jmaterial)


def _check_apertures(array: MainArray, jmaterial: int) -> Iterator[Remark]:
    """Apertures of a joint material in another order than residual, without stress, greatest; or too wide."""
    free, residual, greatest = (float(array.h.cr[k + jmaterial - 1]) for k in (g.JMHAP, g.JMRAP, g.JMMAP))
    if residual > free > 0 or residual > greatest > 0 or free > greatest > 0:
        text = f"RAPERTURE {residual:g}, APERTURE {free:g} and MAPERTURE {greatest:g} m are not in this order"
        yield Remark("apertures", f"joint material {jmaterial}: {text}")
    if max(free, residual) > WIDE:
        text = f"an aperture of {max(free, residual):g} m is more than that of a joint; the unit is m"
        yield Remark("apertures", f"joint material {jmaterial}: {text}")


def _check_tangents(values: Mapping[str, Any], owner: str) -> Iterator[Remark]:
    """Tangents that look like angles in degrees. owner: the material."""
    for name in TANGENTS:
        value = values.get(name)
        if value is not None and STEEP < value < 90:
            angle, tangent = math.degrees(math.atan(value)), math.tan(math.radians(value))
            yield Remark(
                "degrees-for-tangent",
                f"{name.replace('_', ' ')} {value:g} of {owner} is a tangent, of {angle:.3g} "
                f"degrees: for an angle of {value:g} degrees give {tangent:.3g}",
            )


def check_new_material(array: MainArray, many: int, material: int) -> Iterator[Remark]:
    """CHANGE: a material whose density comes too late for `many` blocks."""
    if array.h.ci[g.MCTOT]:
        yield _density_too_late(many, material)


def _density_too_late(many: int, material: int) -> Remark:
    text = f"{counted(many, 'block')} of material {material} will keep mass and weight, which are calculated "
    return Remark("density-too-late", text + "before the first cycle; a new density counts after a new START")


def describe_inertia(ratios: Mapping[int, float]) -> Iterator[Remark]:
    """GENERATE: moments of inertia of masses at grid-points over those of the bodies, by block."""
    greater = sum(ratio > GREATER for ratio in ratios.values())
    if greater:
        ib = max(ratios, key=lambda one: ratios[one])
        others = f", and make that of {counted(greater - 1, 'other block')} greater" if greater > 1 else ""
        yield Remark(
            "inertia-of-zones",
            f"masses at grid-points make the moment of inertia of block@{ib} {ratios[ib]:.2f} times that of "
            f"the body{others}: they turn more slowly; smaller zones have less of this",
        )


def check_spins(array: MainArray, before: Mapping[int, float]) -> Iterator[Remark]:
    """GENERATE: the angular momentum of blocks that turn. before: it was, by block (N.s)."""
    h, growth = array.h, {}
    for ib, spin in before.items():
        if changes_place(h, ib, abs(getr(h, ib, g.KTD)) * getr(h, ib, g.KBRO)):
            growth[ib] = abs(angular_momentum(array, ib) - spin)
    changed = [ib for ib, more in growth.items() if more > SAME_SPIN * abs(angular_momentum(array, ib))]
    if changed:
        ib, more = max(changed, key=lambda one: growth[one]), len(changed) - 1
        now = angular_momentum(array, ib)
        others = f", and those of {counted(more, 'other block')} have grown, too" if more else ""
        yield Remark(
            "angular-momentum-changed",
            f"block@{ib} has its velocities as before, and with its greater moment of inertia the angular "
            f"momentum {now:.4g} N.s, after {before[ib]:.4g}{others}",
        )


def angular_momentum(array: MainArray, ib: int) -> float:
    """Angular momentum of block `ib` about its centroid, in N.s."""
    return float(getr(array.h, ib, g.KTD)) * float(getr(array.h, ib, g.KBI))


def check_input(array: MainArray, own_laws: Collection[int]) -> Iterator[Remark]:
    """CYCLE: suspicious input in the whole model, except damping and time-step.

    own_laws: constitutive numbers of the user's block laws, which may need other properties.
    """
    yield from check_moduli(array, own_laws)
    yield from check_laws(array)
    yield from check_joints(array)
    yield from check_loads(array)
    yield from check_resolution(array)


def check_moduli(array: MainArray, own_laws: Collection[int]) -> Iterator[Remark]:
    """CYCLE: a linearly elastic deformable block whose material lacks one of its two moduli."""
    h = array.h
    if not h.ci[g.NSOFT]:
        return
    blocks = list_of(h, "block")
    soft = (integers(h, blocks, HEAD) != g.MRIG) & ~np.isin(integers(h, blocks, g.KCONS), [*own_laws])
    for m in np.unique(integers(h, blocks[soft], g.KMAT)):
        bulk, shear = h.cr[g.BULK + m - 1], h.cr[g.SHEAR + m - 1]
        if (bulk > 0) != (shear > 0):
            lacking, change = ("G", "shape") if bulk > 0 else ("BULK", "volume")
            yield Remark(
                "missing-modulus",
                f"material {m} of deformable blocks has no {lacking}: nothing resists a change of {change}; "
                f"PROPERTY MATERIAL={m} {lacking}=...",
            )


def check_laws(array: MainArray, groups: Groups = list_of) -> Iterator[Remark]:
    """CYCLE: properties of materials in use that constitutive number 1, the only law in use, ignores."""
    h = array.h
    given: dict[int, list[str]] = {}
    for word, k in OF_LAWS.items():
        for m in np.flatnonzero(h.cr[k : k + NMAT]) + 1:
            given.setdefault(int(m), []).append(word)
    if not given:
        return
    blocks, contacts = groups(h, "block"), groups(h, "contact")
    followers = [
        integers(h, blocks, g.KMAT)[integers(h, blocks, g.KCONS) > 1],
        materials_of(h, contacts)[integers(h, contacts, g.KCC) > 1],
    ]
    for m in np.setdiff1d(integers(h, blocks, g.KMAT), np.concatenate(followers)):
        if m in given:
            yield Remark(
                "unused-property",
                f"{' and '.join(given[m])} of material {m}: constitutive number 1 ignores that; "
                "CHANGE x1 x2 y1 y2 CONSTITUTIVE=2, and give a law of that number (--constitutive)",
            )


def check_joints(array: MainArray) -> Iterator[Remark]:
    """CYCLE: contacts between materials with different joint properties."""
    h = array.h
    used = np.unique(integers(h, list_of(h, "block"), g.KMAT))
    if all(len(np.unique(h.cr[k + used - 1])) < 2 for k in OF_JOINTS.values() if len(used) > 1):
        return
    contacts = list_of(h, "contact")
    by_block = (integers(h, contacts, g.KCCOD) != g.VIRTUAL) & (joints_at(h, contacts) == 0)
    contacts = contacts[by_block]
    pairs = np.sort([integers(h, integers(h, contacts, k), g.KMAT) for k in (g.KB1, g.KB2)], axis=0)
    for one, two in np.unique(pairs, axis=1).T.tolist():
        differ = [word for word, k in OF_JOINTS.items() if h.cr[k + one - 1] != h.cr[k + two - 1]]
        if differ:
            yield Remark(
                "joints-of-two-materials",
                f"materials {one} and {two} meet and differ in {' and '.join(differ)}: a contact takes the "
                "material of its first block (KCM in PRINT CONTACTS); "
                f"give both the same joint properties, or JPROPERTY JMATERIAL=1 ... BETWEEN {one} {two}",
            )


def check_initial_joints(exceeded: list[tuple[float, float]]) -> Iterator[Remark]:
    """INSITU: places at which joints cannot carry the initial stress."""
    if exceeded:
        places = ", ".join(f"({x:g}, {y:g})" for x, y in exceeded[:5])
        more = f" and {len(exceeded) - 5} more" if len(exceeded) > 5 else ""
        yield Remark(
            "initial-stress-exceeds-joints",
            f"the initial stress exceeds the strength of {counted(len(exceeded), 'contact')}, where joints "
            f"will slip or open: {places}{more}",
        )


def check_loads(array: MainArray, groups: Groups = list_of) -> Iterator[Remark]:
    """CYCLE: loads that act on fixed blocks only."""
    h = array.h
    bounds = groups(h, "bound")
    if not len(bounds):
        return
    loaded = np.any([getr(h, bounds, k) for k in (g.KUFX, g.KUFY)], axis=0)
    blocks = np.unique(integers(h, bounds[loaded], g.KUB))
    if len(blocks) and (integers(h, blocks, g.KBFIX) == g.FIXED).all():
        named = f"block@{blocks[0]}" + (f" and {len(blocks) - 1} more" if len(blocks) > 1 else "")
        text = f"BOUNDARY loads fixed blocks only ({named}), which no load moves: FREE them"
        yield Remark("loads-on-fixed-blocks", text)


def check_resolution(array: MainArray) -> Iterator[Remark]:
    """CYCLE: a last digit of coordinates whose force in the stiffest joint is large for the mean contact.

    The mean contact force is half the weight and loads of a free block.
    """
    h = array.h
    blocks, conditions = list_of(h, "block"), list_of(h, "bound")
    x, y, reach, mass = (np.asarray(getr(h, blocks, k), float) for k in (g.KX, g.KY, g.KBRO, g.KBM))
    free = integers(h, blocks, g.KBFIX) != g.FIXED
    weight = mass[free].sum() * math.hypot(float(h.cr[g.GRAVX]), float(h.cr[g.GRAVY]))
    loads = np.hypot(*(np.asarray(getr(h, conditions, k), float) for k in (g.KUFX, g.KUFY))).sum()
    usual = float(weight + loads) / 2 / max(int(free.sum()), 1)
    joints = joints_of_materials(h, np.unique(integers(h, blocks, g.KMAT)))
    stiffness = float(max(joints.kn.max(), joints.ks.max()))
    digit = last_digit(array, float((np.maximum(np.abs(x), np.abs(y)) + reach).max()))
    force = stiffness * digit
    if force > RESOLVED * usual > 0:
        yield Remark(
            "coarse-reals",
            f"the last digit of coordinates, {digit:.2g} m with {array.scheme.real_bits}-bit reals, is a "
            f"force of {force:.3g} N/m in joints of {stiffness:.3g} N/m2, {force / usual:.1%} of the "
            f"{usual:.3g} N/m that a block puts on a contact: forces have at least this error, and SOLVE "
            "reaches no smaller ratio; take reals of 64 bits, a smaller KN, or an origin within the model",
        )


def check_damping(array: MainArray) -> Iterator[Remark]:
    """SOLVE: no damping."""
    if not (array.h.cr[g.ALPB] or what_damps(array.h)):
        yield Remark(
            "no-damping",
            "there is no damping, and nothing but friction brings blocks to rest: "
            "DAMPING 0.5 f MASS, with f near the frequency (Hz) at which they would swing",
        )
