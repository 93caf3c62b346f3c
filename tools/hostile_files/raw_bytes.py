"""Bytes of the HDF5 part that are others: in its tree, its headers, anywhere."""

from __future__ import annotations

import struct
from collections.abc import Callable

from hostile_files.storage import Rng, one


def tree(rng: Rng, body: bytearray) -> None:
    """The tree that finds the pieces of the heap: it leads to itself."""
    at = body.find(b"TREE\x01")
    body[at + 5] = int(rng.integers(1, 256))
    if rng.random() < 0.7:
        child = at + 24 + 8 + 16  # behind signature, type, level, number, two neighbours, and the first key
        body[child : child + 8] = struct.pack("<Q", at)
        body[at + 6 : at + 8] = struct.pack("<H", int(rng.integers(1, 65)))


def superblock(rng: Rng, body: bytearray) -> None:
    """The first bytes of the HDF5 part."""
    for _ in range(int(rng.integers(1, 4))):
        body[int(rng.integers(48))] = int(rng.integers(256))


def anything(rng: Rng, body: bytearray) -> None:
    """Any bytes, moved or changed."""
    for _ in range(int(rng.integers(1, 6))):
        at, length = int(rng.integers(len(body))), int(rng.integers(1, 16))
        if rng.random() < 0.5:
            body[at : at + length] = rng.bytes(len(body[at : at + length]))
        else:
            body[at] ^= 1 << int(rng.integers(8))


def headers(rng: Rng, body: bytearray) -> None:
    """Bytes of what describes an object: behind the signature of a header, a heap of names or a tree."""
    marks = [b"OHDR", b"OCHK", b"FRHP", b"FHDB", b"BTHD", b"BTLF", b"TREE"]
    places = [at for mark in marks for at in _all(body, mark)]
    for _ in range(int(rng.integers(1, 4))):
        at = one(rng, places) + int(rng.integers(4, 200))
        if at < len(body):
            body[at] = int(rng.integers(256))


def _all(body: bytearray, mark: bytes) -> list[int]:
    found, at = [], body.find(mark)
    while at >= 0:
        found.append(at)
        at = body.find(mark, at + 1)
    return found


EDITS: list[Callable[[Rng, bytearray], None]] = [tree, superblock, anything, headers]
