"""What groups are called, corner@412 of block@88, and what a pointer leads to. Many at a time.

A group goes by its kind and address and the block that it belongs to; a junk group by its place in the junk
list; other words by the stretch that they are in. A pointer that leads to something else than the field table
says is told with what is there.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.reader.atlas import JUNK, KINDS, NAMES, Atlas, Span, choices

ASTRAY = ", no "  # begins what a value should be and is not
NOTHING_THERE = "nothing"  # what 0 leads to


def names(atlas: Atlas, addresses: Any) -> list[str]:
    """What is at the addresses (n,), all within IA(): a group, or a word of one."""
    first, last, kind = atlas.bounds
    at = np.searchsorted(first, addresses, "right") - 1
    found = _of_spans(atlas, first[at], last[at], kind[at])
    for k in np.flatnonzero(first[at] != addresses).tolist():
        found[k] = f"word {addresses[k] - first[at[k]] + 1} of {found[k]}"
    return found


def called(atlas: Atlas, span: Span) -> str:
    """A span by name."""
    return names(atlas, np.array([span.first]))[0]


def _of_spans(atlas: Atlas, first: Any, last: Any, kind: Any) -> list[str]:
    found = np.empty(len(first), object)
    for number in np.unique(kind).tolist():
        here = np.flatnonzero(kind == number)
        found[here] = _of_kind(atlas, NAMES[number], first[here], last[here])
    named: list[str] = found.tolist()
    return named


def _of_kind(atlas: Atlas, kind: str, first: Any, last: Any) -> list[str]:
    at = first.tolist()
    if kind == JUNK:
        return [f"{JUNK}@{iad}, {atlas.junk_places[iad]}" for iad in at]
    if kind not in KINDS:
        return [f"{kind} {iad} to {end}" for iad, end in zip(at, last.tolist(), strict=True)]
    hosts = [
        _hosts(atlas, atlas.gather(word, first)) for word in atlas.shapes[kind] if word.field.role == "host"
    ]
    if hosts:
        owners = [" and ".join(several) for several in zip(*hosts, strict=True)]
        return [f"{kind}@{iad} of {owner}" for iad, owner in zip(at, owners, strict=True)]
    held = atlas.held
    return [f"{kind}@{iad} of block@{held[iad]}" if iad in held else f"{kind}@{iad}" for iad in at]


def _hosts(atlas: Atlas, hosts: Any) -> list[str]:
    sound = atlas.holding("block", hosts).tolist()
    return [
        f"block@{ib}" if is_block else "no block" for ib, is_block in zip(hosts.tolist(), sound, strict=True)
    ]


def leads_to(atlas: Atlas, target: str, values: Any, required: bool = False) -> list[str]:
    """What pointers to `target` with the values (n,) lead to, or that it is not what the table says.

    required: 0 is no value for such a pointer.
    """
    wanted = ASTRAY + ("group" if target == "any" else " or ".join(choices(target)))
    found = np.full(len(values), NOTHING_THERE + (wanted if required else ""), object)
    sound = atlas.holding(target, values)
    found[sound] = _of_spans(atlas, values[sound], values[sound], atlas.starts[values[sound]] - 1)
    found[~sound & (values != 0)] = "outside IA()" + wanted
    astray = np.flatnonzero(~sound & (values >= 1) & (values <= len(atlas.h.ia)))
    found[astray] = [name + wanted for name in names(atlas, values[astray])]
    led: list[str] = found.tolist()
    return led
