"""Groups that are longer in scenes with joint materials (LJOINT), water (LWATER) or DISPLACEMENTS (LDISP).

With joint materials or numbered joints, directly behind each contact lies its joint, and behind each corner
the edge that ends there. With water, behind each joint lies its pipe, and behind each domain its water. With
DISPLACEMENTS, behind each block and each grid-point lies its displacement. No pointer leads to them. Other
scenes have none of them, so that they do not pay for them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, Offset, iget, int64, integers, size_of
from udec_ia.heap.find_lose import begin, copy_words, lose_behind, lose_with, take
from udec_ia.layout import offsets as g


@inlined
def contact_words(h: Memory) -> int:
    """Words of a contact with what lies behind it."""
    joint = size_of(h, g.NVJT) if h.ci[g.LJOINT] != 0 else 0
    pipe = size_of(h, g.NVPI) if h.ci[g.LWATER] != 0 else 0
    return int64(size_of(h, g.NVCN) + joint + pipe)


@inlined
def _words(h: Memory, nv: Offset, behind: Offset, flag: int) -> int:
    """Words of a group of the size `nv` with that of the size `behind`, in scenes with a flag."""
    return int64(size_of(h, nv) + (size_of(h, behind) if h.ci[flag] != 0 else 0))


@inlined
def domain_words(h: Memory) -> int:
    """Words of a domain with its water."""
    return _words(h, g.NVDO, g.NVWA, g.LWATER)


@inlined
def corner_words(h: Memory) -> int:
    """Words of a corner with its edge."""
    return _words(h, g.NVCR, g.NVED, g.LJOINT)


@inlined
def block_words(h: Memory) -> int:
    """Words of a block with its displacement."""
    return _words(h, g.NVBL, g.NVDS, g.LDISP)


@inlined
def gridpoint_words(h: Memory) -> int:
    """Words of a grid-point with its displacement."""
    return _words(h, g.NVGP, g.NVPD, g.LDISP)


@inlined
def joint_behind(h: Memory, ic: int) -> int:
    """The joint behind contact `ic` in a scene with joint materials, whether it has one or not."""
    return int64(ic + size_of(h, g.NVCN))


@inlined
def joint_at(h: Memory, ic: int) -> int:
    """The joint behind contact `ic` if it has a joint material, else 0."""
    if h.ci[g.LJOINT] == 0:
        return int64(0)
    ix = joint_behind(h, ic)
    return ix if iget(h, ix, g.KCJMAT) != 0 else int64(0)


@inlined
def pipe_at(h: Memory, ic: int) -> int:
    """The pipe of contact `ic` in a scene with water."""
    return int64(ic + size_of(h, g.NVCN) + size_of(h, g.NVJT))


@inlined
def water_at(h: Memory, idm: int) -> int:
    """The water of domain `idm` in a scene with water."""
    return int64(idm + size_of(h, g.NVDO))


@inlined
def contact_of(h: Memory, ix: int) -> int:
    """The contact before joint `ix`."""
    return int64(ix - size_of(h, g.NVCN))


def joints_at(h: Memory, contacts: Any) -> Any:
    """The joints behind `contacts` (n,), 0 where there is no joint material; not for kernels."""
    if h.ci[g.LJOINT] == 0:
        return np.zeros(len(contacts), np.int64)
    found = contacts + size_of(h, g.NVCN)
    return np.where(integers(h, found, g.KCJMAT) != 0, found, 0)


def pipes_at(h: Memory, contacts: Any) -> Any:
    """The pipes of the contacts at the addresses `contacts`, as an array; not for kernels."""
    return contacts + size_of(h, g.NVCN) + size_of(h, g.NVJT)


def waters_at(h: Memory, domains: Any) -> Any:
    """The water of the domains at the addresses `domains`, as an array; not for kernels."""
    return domains + size_of(h, g.NVDO)


@inlined
def edge_at(h: Memory, ip: int) -> int:
    """The edge that ends at corner `ip`, 0 in a scene without joints."""
    return int64(ip + size_of(h, g.NVCR)) if h.ci[g.LJOINT] != 0 else int64(0)


def edges_at(h: Memory, corners: Any) -> Any:
    """The edges that end at the corners at the addresses `corners`, as an array; not for kernels."""
    return corners + size_of(h, g.NVCR) if h.ci[g.LJOINT] != 0 else np.zeros(len(corners), np.int64)


@kernel
def find_contact(h: Memory) -> int:
    """Address of a new contact, its words and those of its joint and pipe zero; 0 as `find`."""
    ic = take(h, contact_words(h))
    if ic != 0:
        begin(h, ic, g.NVCN)
        if h.ci[g.LJOINT] != 0:
            begin(h, joint_behind(h, ic), g.NVJT)
        if h.ci[g.LWATER] != 0:
            begin(h, pipe_at(h, ic), g.NVPI)
    return ic


@kernel
def lose_contact(h: Memory, ic: int) -> None:
    """Give contact `ic` back, and its joint and pipe."""
    if h.ci[g.LWATER] != 0:
        lose_behind(h, pipe_at(h, ic), g.NVPI)
    if h.ci[g.LJOINT] != 0:
        lose_behind(h, joint_behind(h, ic), g.NVJT)
    lose_with(h, ic, g.NVCN, contact_words(h))


@inlined
def displacement_at(h: Memory, ib: int) -> int:
    """The displacement of block `ib` in a scene with DISPLACEMENTS."""
    return int64(ib + size_of(h, g.NVBL))


@inlined
def point_displacement_at(h: Memory, ig: int) -> int:
    """The displacement of grid-point `ig` in a scene with DISPLACEMENTS."""
    return int64(ig + size_of(h, g.NVGP))


@inlined
def point_of(h: Memory, iu: int) -> int:
    """The grid-point before displacement `iu`."""
    return int64(iu - size_of(h, g.NVGP))


def displacements_at(h: Memory, blocks: Any) -> Any:
    """The displacements of the blocks at the addresses `blocks`, as an array; not for kernels."""
    return blocks + size_of(h, g.NVBL)


def point_displacements_at(h: Memory, points: Any) -> Any:
    """The displacements of the grid-points at the addresses `points`, as an array; not for kernels."""
    return points + size_of(h, g.NVGP)


@kernel
def _find_both(h: Memory, nv: Offset, behind: Offset, flag: int) -> int:
    """Address of a new group of the size `nv`, with that of the size `behind` in scenes with a flag.

    Their words are zero. 0 and error 1 as of `find`.
    """
    iad = take(h, _words(h, nv, behind, flag))
    if iad != 0:
        begin(h, iad, nv)
        if h.ci[flag] != 0:
            begin(h, iad + size_of(h, nv), behind)
    return iad


@kernel
def _lose_both(h: Memory, iad: int, nv: Offset, behind: Offset, flag: int) -> None:
    """Give back a group and what `_find_both` has put behind it."""
    if h.ci[flag] != 0:
        lose_behind(h, iad + size_of(h, nv), behind)
    lose_with(h, iad, nv, _words(h, nv, behind, flag))


@kernel
def find_corner(h: Memory) -> int:
    """Address of a new corner with its edge; 0 and error 1 as of `find`."""
    return _find_both(h, g.NVCR, g.NVED, g.LJOINT)


@kernel
def lose_corner(h: Memory, ip: int) -> None:
    """Give corner `ip` back, and its edge."""
    _lose_both(h, ip, g.NVCR, g.NVED, g.LJOINT)


@kernel
def find_domain(h: Memory) -> int:
    """Address of a new domain with its water; 0 and error 1 as of `find`."""
    return _find_both(h, g.NVDO, g.NVWA, g.LWATER)


@kernel
def lose_domain(h: Memory, idm: int) -> None:
    """Give domain `idm` back, and its water."""
    _lose_both(h, idm, g.NVDO, g.NVWA, g.LWATER)


@kernel
def find_block(h: Memory) -> int:
    """Address of a new block with its displacement; 0 and error 1 as of `find`."""
    return _find_both(h, g.NVBL, g.NVDS, g.LDISP)


@kernel
def lose_block(h: Memory, ib: int) -> None:
    """Give block `ib` back, and its displacement."""
    _lose_both(h, ib, g.NVBL, g.NVDS, g.LDISP)


@kernel
def find_gridpoint(h: Memory) -> int:
    """Address of a new grid-point with its displacement; 0 and error 1 as of `find`."""
    return _find_both(h, g.NVGP, g.NVPD, g.LDISP)


@kernel
def lose_gridpoint(h: Memory, ig: int) -> None:
    """Give grid-point `ig` back, and its displacement."""
    _lose_both(h, ig, g.NVGP, g.NVPD, g.LDISP)


@kernel
def find_gridpoint_copy(h: Memory, ig: int) -> int:
    """Address of a new grid-point with the words of `ig`, and its displacement; there must be room for it."""
    jg = find_gridpoint(h)
    copy_words(h, ig, jg, int64(size_of(h, g.NVGP)))
    if h.ci[g.LDISP] != 0:
        copy_words(h, point_displacement_at(h, ig), point_displacement_at(h, jg), int64(size_of(h, g.NVPD)))
    return jg
