"""Warnings about suspicious input, given once before the run, each with a remedy.

They need no run: a number that looks like one in another unit, a material that lacks a modulus, a SOLVE that
nothing brings to rest.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import Any

import numpy as np

from udec_ia.advice.damping_report import what_damps
from udec_ia.heap.accessors import HEAD, Memory, getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import JOINT_ARRAYS, joints_of_materials, materials_of
from udec_ia.kernels.geometry.tolerances import edges
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.generate_zones import inertia_ratio
from udec_ia.ops.common.number_limits import NMAT, last_digit
from udec_ia.printable_text import counted
from udec_ia.remark_key import Remark

TANGENTS = ("friction", "residual_friction", "block_friction", "dilation", "block_dilation")
OURS = {field.name for field in read_table().common if field.ours and field.allowed}
OF_LAWS = {  # properties that constitutive number 1 does not look at, by their places in the common block
    one.keyword.upper(): getattr(g, one.array) for one in read_table().properties if one.array in OURS
}
OF_JOINTS = {  # properties of joints, by their places in the common block
    one.keyword.upper(): getattr(g, one.array) for one in read_table().properties if one.array in JOINT_ARRAYS
}
SLIVER = 40  # mean edge over the shortest, from which on to warn
Groups = Callable[[MainArray, str], Any]  # finds the addresses of all groups of a kind
RESOLVED = 0.005  # of the mean force on a contact: force of a last digit from which on to warn
GREATER = 1.005  # moment of inertia of zones over that of the body from which on to report it
STEEP = 5  # tangent of 79 degrees; no joint is as rough, and 90 and more are no degrees


def check_properties(array: MainArray, material: int, values: dict[str, float | None]) -> Iterator[Remark]:
    """PROPERTY: nothing to set; a density that comes too late; an angle where a tangent is wanted."""
    if all(value is None for value in values.values()):
        yield Remark("no-property", f"PROPERTY MATERIAL={material} names no property, and none was set")
    h = array.h
    if values.get("density") is not None and h.ci[g.MCTOT]:
        blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
        made = (integers(h, blocks, g.KMAT) == material) & (getr(h, blocks, g.KBM) > 0)
        if made.any():
            yield Remark(
                "density-too-late",
                f"masses were made before the first cycle: {counted(made.sum(), 'block')} of material "
                f"{material} will keep mass and weight; a new density counts after a new START",
            )
    for name in TANGENTS:
        value = values.get(name)
        if value is not None and STEEP < value < 90:
            angle, tangent = math.degrees(math.atan(value)), math.tan(math.radians(value))
            yield Remark(
                "degrees-for-tangent",
                f"{name.replace('_', ' ')} {value:g} of material {material} is a tangent, of {angle:.3g} "
                f"degrees: if an angle of {value:g} degrees is meant, give {tangent:.3g}",
            )


def check_new_material(array: MainArray, many: int, material: int) -> Iterator[Remark]:
    """CHANGE: a material whose density comes too late."""
    if array.h.ci[g.MCTOT]:
        yield Remark(
            "density-too-late",
            f"masses were made before the first cycle: {counted(many, 'block')} of material {material} now "
            "will keep mass and weight; a new density counts after a new START",
        )


def describe_inertia(array: MainArray, ib: int) -> Iterator[Remark]:
    """GENERATE: how much more slowly block `ib` turns with its mass at grid-points."""
    ratio = inertia_ratio(array.h, ib)
    if ratio > GREATER:
        yield Remark(
            "inertia-of-zones",
            f"masses at grid-points make the moment of inertia of block@{ib} {ratio:.2f} times that of the "
            "body: it turns more slowly; smaller zones have less of this",
        )


def check_spin(array: MainArray, ib: int, before: float) -> Iterator[Remark]:
    """GENERATE: another angular velocity of block `ib` than `before` (rad/s)."""
    now = float(getr(array.h, ib, g.KTD))
    if now != before:
        yield Remark(
            "spin-changed",
            f"block@{ib} spins at {now:.4g} rad/s, and had {before:.4g}: its moment of inertia has grown, "
            "and its angular momentum stays",
        )


def check_tension(stress: Sequence[float], gradients: Sequence[float]) -> Iterator[Remark]:
    """INSITU: tension in all of the range. stress: 11, 12, 22, Pa; gradients: their growth per metre."""
    s11, _, s22 = stress
    if max(s11, s22) > 0 and not any(gradients):
        largest = max(s11, s22)
        text = f"INSITU: {largest:g} is tension, which joints do not bear; compression is negative"
        yield Remark("initial-tension", text)


def check_input(array: MainArray, own_laws: Collection[int]) -> Iterator[Remark]:
    """CYCLE: all that is suspicious in the model, but for its damping and time-step.

    own_laws: constitutive numbers of the user's block laws, which may want other properties.
    """
    yield from check_moduli(array, own_laws)
    yield from check_laws(array)
    yield from check_joints(array)
    yield from check_loads(array)
    yield from check_edges(array)
    yield from check_softness(array)
    yield from check_resolution(array)


def check_moduli(array: MainArray, own_laws: Collection[int]) -> Iterator[Remark]:
    """CYCLE: one of two moduli in the material of a deformable block that is linearly elastic.

    own_laws: see check_input.
    """
    h = array.h
    if not h.ci[g.NSOFT]:
        return
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    soft = (integers(h, blocks, HEAD) != g.MRIG) & ~np.isin(integers(h, blocks, g.KCONS), [*own_laws])
    for m in np.unique(integers(h, blocks[soft], g.KMAT)):
        bulk, shear = h.cr[g.BULK + m - 1], h.cr[g.SHEAR + m - 1]
        for given, lacking, what, without in (("BULK", "G", bulk, shear), ("G", "BULK", shear, bulk)):
            if what > 0 and not without > 0:
                change = "shape" if lacking == "G" else "volume"
                yield Remark(
                    "missing-modulus",
                    f"material {m} of deformable blocks has {given} and no {lacking}: nothing in them "
                    f"resists a change of {change}; PROPERTY MATERIAL={m} {lacking}=...",
                )


def listed(array: MainArray, kind: str) -> Any:
    """Addresses of the blocks, contacts or conditions ("bound") of a sound heap, as in their list."""
    head, link = {"block": (g.IBPNT, g.KB), "contact": (g.ICPNT, g.KC), "bound": (g.IBNPNT, g.KU)}[kind]
    return addresses(array.h, int(array.h.ci[head]), link)


def check_laws(array: MainArray, groups: Groups = listed) -> Iterator[Remark]:
    """CYCLE: properties of materials in use that only other laws than constitutive number 1 look at."""
    h = array.h
    given: dict[int, list[str]] = {}
    for word, k in OF_LAWS.items():
        for m in np.flatnonzero(h.cr[k : k + NMAT]) + 1:
            given.setdefault(int(m), []).append(word)
    if not given:
        return
    blocks, contacts = groups(array, "block"), groups(array, "contact")
    followers = [
        integers(h, blocks, g.KMAT)[integers(h, blocks, g.KCONS) > 1],
        materials_of(h, contacts)[integers(h, contacts, g.KCC) > 1],
    ]
    for m in np.setdiff1d(integers(h, blocks, g.KMAT), np.concatenate(followers)):
        if m in given:
            yield Remark(
                "unused-property",
                f"{' and '.join(given[m])} of material {m}: constitutive number 1 does not look at that; "
                "CHANGE x1 x2 y1 y2 CONSTITUTIVE=2, and give a law of that number (--constitutive)",
            )


def check_joints(array: MainArray) -> Iterator[Remark]:
    """CYCLE: contacts between materials with other joint properties, where the map decides which hold."""
    h = array.h
    used = np.unique(integers(h, listed(array, "block"), g.KMAT))
    if all(len(np.unique(h.cr[k + used - 1])) < 2 for k in OF_JOINTS.values() if len(used) > 1):
        return
    contacts = listed(array, "contact")
    contacts = contacts[integers(h, contacts, g.KCCOD) != g.VIRTUAL]
    pairs = np.sort([integers(h, integers(h, contacts, k), g.KMAT) for k in (g.KB1, g.KB2)], axis=0)
    for one, two in np.unique(pairs, axis=1).T.tolist():
        differ = [word for word, k in OF_JOINTS.items() if h.cr[k + one - 1] != h.cr[k + two - 1]]
        if differ:
            yield Remark(
                "joints-of-two-materials",
                f"materials {one} and {two} meet and differ in {' and '.join(differ)}: a contact between "
                "them takes the joint properties of one of its blocks, whichever the map names first; "
                "give both materials the same joint properties, or see KCM in PRINT CONTACTS",
            )


def check_loads(array: MainArray, groups: Groups = listed) -> Iterator[Remark]:
    """CYCLE: loads, all of which act on blocks that are fixed."""
    h = array.h
    bounds = groups(array, "bound")
    if not len(bounds):
        return
    loaded = np.any([getr(h, bounds, k) for k in (g.KUFX, g.KUFY)], axis=0)
    blocks = np.unique(integers(h, bounds[loaded], g.KUB))
    if len(blocks) and (integers(h, blocks, g.KBFIX) == g.FIXED).all():
        named = f"block@{blocks[0]}" + (f" and {len(blocks) - 1} more" if len(blocks) > 1 else "")
        text = f"BOUNDARY loads fixed blocks only ({named}), and no load moves these: FREE them or others"
        yield Remark("loads-on-fixed-blocks", text)


def check_edges(array: MainArray) -> Iterator[Remark]:
    """CYCLE, before the first one: a sliver that makes the default rounding length very small.

    All tolerances follow from that length: impacts that other blocks bear are then error 15.
    """
    h = array.h
    if h.ci[g.LROUND] or h.ci[g.MCTOT] or not h.ci[g.IBPNT]:
        return
    mean, shortest, ip = (float(one) for one in edges(h))
    if shortest < mean / SLIVER:
        x, y = float(getr(h, int(ip), g.KXP)), float(getr(h, int(ip), g.KYP))
        yield Remark(
            "short-edge",
            f"the edge of {shortest:.3g} m that ends at ({x:g}, {y:g}), "
            f"where the mean edge has {mean:.3g} m, makes "
            f"the rounding length {h.cr[g.DTOL]:.3g} m and allows overlaps up to half of that: "
            "cut elsewhere, or DELETE the sliver",
        )


def check_softness(array: MainArray) -> Iterator[Remark]:
    """CYCLE, before the first one: joints too soft to bear a block within the overlap that ROUND allows."""
    h = array.h
    materials = np.unique(integers(h, listed(array, "block"), g.KMAT))
    stiffest, usual = float(joints_of_materials(h, materials).kn.max()), _mean_contact_force(h)
    if h.ci[g.MCTOT] == 0 and usual > stiffest * float(h.cr[g.DTOL2]) > 0:
        yield Remark(
            "soft-joints",
            f"a block of mean weight and load puts {usual:.3g} N/m on a contact, and KN of {stiffest:.3g} "
            f"N/m2 bears it at an overlap of {usual / stiffest:.2g} m; more than {h.cr[g.DTOL2]:.2g} m is "
            "error 15: take a greater KN or a greater ROUND",
        )


def check_resolution(array: MainArray) -> Iterator[Remark]:
    """CYCLE: a last digit of a coordinate whose force in the stiffest joint counts.

    It is compared with the mean force of free blocks on a contact.
    """
    usual, (force, digit) = _mean_contact_force(array.h), _digit_force(array)
    if force > RESOLVED * usual > 0:
        yield Remark(
            "coarse-reals",
            f"the last digit of coordinates, {digit:.2g} m with {array.scheme.real_bits}-bit reals, is a "
            f"force of {force:.3g} N/m in joints of {force / digit:.3g} N/m2, {force / usual:.1%} of the "
            f"{usual:.3g} N/m that a block puts on a contact: forces are off by so much, by several times "
            "as much after many cycles, and SOLVE reaches no smaller ratio; take reals of 64 bits, a smaller "
            "KN, or an origin within the model",
        )


def check_damping(array: MainArray) -> Iterator[Remark]:
    """SOLVE: nothing that brings a model to rest."""
    if not (array.h.cr[g.ALPB] or what_damps(array.h)):
        yield Remark(
            "no-damping",
            "there is no damping, and nothing but friction brings blocks to rest: "
            "DAMPING 0.5 f MASS, with f near the frequency (Hz) at which they would swing",
        )


def _mean_contact_force(h: Memory) -> float:
    """Mean force of free blocks on a contact in N/m: half of their weight and of their loads."""
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    free = integers(h, blocks, g.KBFIX) != g.FIXED
    mass = np.asarray(getr(h, blocks, g.KBM), float)[free].sum()
    weight = mass * math.hypot(float(h.cr[g.GRAVX]), float(h.cr[g.GRAVY]))
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    loads = np.hypot(*(np.asarray(getr(h, bounds, k), float) for k in (g.KUFX, g.KUFY))).sum()
    return float(weight + loads) / 2 / max(int(free.sum()), 1)


def _digit_force(array: MainArray) -> tuple[float, float]:
    """Force (N/m) of a last digit of a coordinate in the stiffest joint, and that digit (m)."""
    h = array.h
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    x, y, reach = (np.asarray(getr(h, blocks, k), float) for k in (g.KX, g.KY, g.KBRO))
    joints = joints_of_materials(h, np.unique(integers(h, blocks, g.KMAT)))
    stiffness = float(max(joints.kn.max(), joints.ks.max()))
    digit = last_digit(array, float((np.maximum(np.abs(x), np.abs(y)) + reach).max()))
    return stiffness * digit, digit
