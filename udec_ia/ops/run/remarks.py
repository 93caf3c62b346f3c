"""What is no error and yet hardly meant: said once, before the run, with the cure.

A remark is made of what can be known without running: a number that looks like one of another unit, a
material that lacks a modulus, a wait for rest that nothing brings about.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import Any

import numpy as np

from udec_ia.counting import counted
from udec_ia.heap.accessors import HEAD, Memory, getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import JOINT_ARRAYS, joints_of_materials
from udec_ia.kernels.drive.timestep import addresses
from udec_ia.kernels.geometry.tolerances import edges
from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table
from udec_ia.ops.common.number_limits import NMAT, last_digit

TANGENTS = ("friction", "residual_friction", "block_friction", "dilation", "block_dilation")
OURS = {field.name for field in read_table().common if field.ours and field.allowed}
OF_LAWS = {  # properties that constitutive number 1 does not look at, by their places in the common block
    one.keyword.upper(): getattr(g, one.array) for one in read_table().properties if one.array in OURS
}
OF_JOINTS = {  # properties of joints, by their places in the common block
    one.keyword.upper(): getattr(g, one.array) for one in read_table().properties if one.array in JOINT_ARRAYS
}
SLIVER = 40  # the mean edge over the shortest, from which on it is said
SLENDER = 100  # length over mean width of a block, from which on it is a sliver
Groups = Callable[[MainArray, str], Any]  # finds the addresses of all groups of a kind
RESOLVED = 0.005  # of what a block puts on a contact: force of a last digit from which on it is said
TINY = 1e-4  # fraction of the critical time-step that is hardly meant
STEEP = 5  # tangent of 79 degrees; no joint is as rough, and 90 and more are no degrees


def on_properties(array: MainArray, material: int, values: dict[str, float | None]) -> Iterator[str]:
    """PROPERTY: nothing to set; a density that comes too late; an angle where a tangent is wanted."""
    if all(value is None for value in values.values()):
        yield f"PROPERTY MATERIAL={material} names no property, and none was set"
    h = array.h
    if values.get("density") is not None and h.ci[g.MCTOT]:
        blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
        made = (integers(h, blocks, g.KMAT) == material) & (getr(h, blocks, g.KBM) > 0)
        if made.any():
            yield (
                f"masses were made before the first cycle: {counted(made.sum(), 'block')} of material "
                f"{material} will keep mass and weight; a new density counts after a new START"
            )
    for name in TANGENTS:
        value = values.get(name)
        if value is not None and STEEP < value < 90:
            angle, tangent = math.degrees(math.atan(value)), math.tan(math.radians(value))
            yield (
                f"{name.replace('_', ' ')} {value:g} of material {material} is a tangent, of {angle:.3g} "
                f"degrees: if an angle of {value:g} degrees is meant, give {tangent:.3g}"
            )


def on_fraction(f: float) -> Iterator[str]:
    """FRACTION: a step in which nothing happens."""
    if f < TINY:
        yield (
            f"FRACTION {f:g}: it takes {1 / f:.2g} cycles until blocks do what they can do in one critical "
            "time-step; 0.1 is usual"
        )


def on_tension(stress: Sequence[float], gradients: Sequence[float]) -> Iterator[str]:
    """INSITU: tension in all of the range. stress: 11, 12, 22, Pa; gradients: their growth per metre."""
    s11, _, s22 = stress
    if max(s11, s22) > 0 and not any(gradients):
        largest = max(s11, s22)
        yield f"INSITU: {largest:g} is tension, which joints do not bear; compression is negative"


def on_moduli(array: MainArray, own_laws: Collection[int]) -> Iterator[str]:
    """CYCLE: one of two moduli in the material of a deformable block that is linearly elastic.

    own_laws: constitutive numbers that stand for block laws of the user's, which may want other properties.
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
                yield (
                    f"material {m} of deformable blocks has {given} and no {lacking}: nothing in them "
                    f"resists a change of {change}; PROPERTY MATERIAL={m} {lacking}=..."
                )


def listed(array: MainArray, kind: str) -> Any:
    """Addresses of the blocks, contacts or conditions ("bound") of a sound heap, as in their list."""
    head, link = {"block": (g.IBPNT, g.KB), "contact": (g.ICPNT, g.KC), "bound": (g.IBNPNT, g.KU)}[kind]
    return addresses(array.h, int(array.h.ci[head]), link)


def on_laws(array: MainArray, groups: Groups = listed) -> Iterator[str]:
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
        integers(h, groups, material)[integers(h, groups, number) > 1]
        for groups, material, number in ((blocks, g.KMAT, g.KCONS), (contacts, g.KCM, g.KCC))
    ]
    for m in np.setdiff1d(integers(h, blocks, g.KMAT), np.concatenate(followers)):
        if m in given:
            yield (
                f"{' and '.join(given[m])} of material {m}: constitutive number 1 does not look at that; "
                "CHANGE x1 x2 y1 y2 CONSTITUTIVE=2, and give a law of that number (--constitutive)"
            )


def on_joints(array: MainArray) -> Iterator[str]:
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
            yield (
                f"materials {one} and {two} meet and differ in {' and '.join(differ)}: a contact between "
                "them takes the joint properties of one of its blocks, whichever the map names first; "
                "give both materials the same joint properties, or see KCM in PRINT CONTACTS"
            )


def on_loads(array: MainArray, groups: Groups = listed) -> Iterator[str]:
    """CYCLE: loads, all of which act on blocks that are fixed."""
    h = array.h
    bounds = groups(array, "bound")
    if not len(bounds):
        return
    loaded = np.any([getr(h, bounds, k) for k in (g.KUFX, g.KUFY)], axis=0)
    blocks = np.unique(integers(h, bounds[loaded], g.KUB))
    if len(blocks) and (integers(h, blocks, g.KBFIX) == g.FIXED).all():
        named = f"block@{blocks[0]}" + (f" and {len(blocks) - 1} more" if len(blocks) > 1 else "")
        yield f"BOUNDARY loads fixed blocks only ({named}), and no load moves these: FREE them or others"


def on_rounding(array: MainArray) -> Iterator[str]:
    """CYCLE, before the first one: a sliver that makes the default rounding length very small.

    All tolerances follow from that length: impacts that other blocks bear are then error 15.
    """
    h = array.h
    if h.ci[g.LROUND] or h.ci[g.MCTOT] or not h.ci[g.IBPNT]:
        return
    mean, shortest, ip = (float(one) for one in edges(h))
    if shortest < mean / SLIVER:
        x, y = float(getr(h, int(ip), g.KXP)), float(getr(h, int(ip), g.KYP))
        yield (
            f"the edge of {shortest:.3g} m that ends at ({x:g}, {y:g}), "
            f"where the mean edge has {mean:.3g} m, makes "
            f"the rounding length {h.cr[g.DTOL]:.3g} m and allows overlaps up to half of that: "
            "cut elsewhere, or DELETE the sliver"
        )


def on_slivers(array: MainArray) -> Iterator[str]:
    """CYCLE, before the first one: blocks much longer than they are wide on the average."""
    h = array.h
    if h.ci[g.MCTOT]:
        return
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    mass, reach = (np.asarray(getr(h, blocks, k), float) for k in (g.KBM, g.KBRO))
    area = mass / h.cr[g.DENS + integers(h, blocks, g.KMAT) - 1]
    with np.errstate(divide="ignore"):
        slender = 4 * reach * reach / area
    many, k = int((slender > SLENDER).sum()), int(slender.argmax())
    if many:
        x, y = (float(getr(h, int(blocks[k]), at)) for at in (g.KX, g.KY))
        yield (
            f"{many} of {len(blocks)} blocks are slivers, more than {SLENDER} times as long as wide; "
            f"block@{blocks[k]} at ({x:.4g}, {y:.4g}), {2 * reach[k]:.3g} m long, is "
            f"{area[k] / (2 * reach[k]):.2g} m wide: the time-step is as short as their masses are small; "
            "cut elsewhere, or DELETE them"
        )


def digit_force(array: MainArray) -> tuple[float, float]:
    """Force (N/m) of a last digit of a coordinate in the stiffest joint, and that digit (m)."""
    h = array.h
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    x, y, reach = (np.asarray(getr(h, blocks, k), float) for k in (g.KX, g.KY, g.KBRO))
    joints = joints_of_materials(h, np.unique(integers(h, blocks, g.KMAT)))
    stiffness = float(max(joints.kn.max(), joints.ks.max()))
    digit = last_digit(array, float((np.maximum(np.abs(x), np.abs(y)) + reach).max()))
    return stiffness * digit, digit


def usual_force(h: Memory) -> float:
    """What free blocks put on a contact in N/m: half of their weight and of what loads them, in the mean."""
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    free = integers(h, blocks, g.KBFIX) != g.FIXED
    mass = np.asarray(getr(h, blocks, g.KBM), float)[free].sum()
    weight = mass * math.hypot(float(h.cr[g.GRAVX]), float(h.cr[g.GRAVY]))
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    loads = np.hypot(*(np.asarray(getr(h, bounds, k), float) for k in (g.KUFX, g.KUFY))).sum()
    return float(weight + loads) / 2 / max(int(free.sum()), 1)


def sinks_too_far(h: Memory) -> str:
    """What is said if blocks overlap by more than is allowed before their contacts bear them; "" if not."""
    materials = np.unique(integers(h, addresses(h, int(h.ci[g.IBPNT]), g.KB), g.KMAT))
    stiffest, usual = float(joints_of_materials(h, materials).kn.max()), usual_force(h)
    if not usual > stiffest * float(h.cr[g.DTOL2]) > 0:
        return ""
    return (
        f"a block of mean weight and load puts {usual:.3g} N/m on a contact, and KN of {stiffest:.3g} N/m2 "
        f"bears it at an overlap of {usual / stiffest:.2g} m; more than {h.cr[g.DTOL2]:.2g} m is error 15: "
        "take a greater KN or a greater ROUND"
    )


def on_softness(array: MainArray) -> Iterator[str]:
    """CYCLE, before the first one: joints too soft to bear a block within the overlap that ROUND allows."""
    said = "" if array.h.ci[g.MCTOT] else sinks_too_far(array.h)
    if said:
        yield said


def on_resolution(array: MainArray) -> Iterator[str]:
    """CYCLE: a last digit of a coordinate that is a force worth speaking of, where the stiffest contact is.

    It is compared with what free blocks put on a contact.
    """
    usual, (force, digit) = usual_force(array.h), digit_force(array)
    if force > RESOLVED * usual > 0:
        yield (
            f"the last digit of coordinates, {digit:.2g} m with {array.scheme.real_bits}-bit reals, is a "
            f"force of {force:.3g} N/m in joints of {force / digit:.3g} N/m2, {force / usual:.1%} of the "
            f"{usual:.3g} N/m that a block puts on a contact: forces are off by so much, by several times "
            "as much after many cycles, and SOLVE reaches no smaller ratio; take reals of 64 bits, a smaller "
            "KN, or an origin within the model"
        )


def on_rest(array: MainArray) -> Iterator[str]:
    """SOLVE: nothing that brings a model to rest."""
    h = array.h
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    viscous = any(np.any(getr(h, bounds, k)) for k in (g.KUCXX, g.KUCYY)) if len(bounds) else False
    if not (h.cr[g.ALPHA] or h.cr[g.BETA] or h.cr[g.ALPB] or h.ci[g.LREST] or viscous):
        yield (
            "there is no damping, and nothing but friction brings blocks to rest: "
            "DAMPING 0.5 f MASS, with f near the frequency (Hz) at which they would swing"
        )
