"""The data of the page as JSON: the words of each state and what they belong to, and the field table.

The words and all other long data go as bytes: little-endian, deflated, in base64. What the page has no room
for is left out from the end, and the page reports that.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from udec_ia.checker import check
from udec_ia.heap.group_census import CHOICES
from udec_ia.heap.junk_list import JNEXT
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, Layout, layouts
from udec_ia.printable_text import MESSAGE, printable
from udec_ia.reader.field_reading import in_words
from udec_ia.reader.field_rows import NOT_ALLOWED
from udec_ia.reader.word_map import JUNK, KINDS, NAMES, NOTHING, TABLE, UNUSED, Atlas, Span

FAULTS = 1000  # violations that the page lists
LINES = 2000  # lines of the deck that it shows, the last ones
NAMING = {group.name for group in TABLE.groups if any(field.role == "host" for field in group.fields)}


def state(array: MainArray, name: str, lines: Sequence[str], limit: int) -> dict[str, Any]:
    """The state of `array`, called `name` and made by the deck `lines`, as JSON.

    limit: words that the page has room for.
    """
    h, atlas, faults = array.h, Atlas(array.h), check(array)
    spans = list(_shown(atlas, limit))
    shown = sum(span.last - span.first + 1 for span in spans if span.kind != UNUSED)
    first = {span.first for span in spans}
    return {
        "name": printable(name),
        "scheme": array.scheme.name,
        "ints": array.scheme.int_bits,
        "reals": array.scheme.real_bits,
        "used": atlas.free - 1,
        "top": len(h.ia),
        "shown": shown,
        "words": packed(h.ia[:shown]),
        "sizes": packed(np.array([span.last - span.first + 1 for span in spans], "f8")),
        "kinds": packed(np.array([NAMES.index(span.kind) for span in spans], "u1")),
        "owners": packed(np.array([_owner(atlas, span) for span in spans], "f8")),
        "chains": [[[iad, size] for iad, size in chain if iad in first] for chain in atlas.chains],
        "common": [packed(h.ci), packed(h.cr), packed(h.cd)],
        "faults": [[one.invariant, one.message] for one in faults[:FAULTS]],
        "faultsLeft": len(faults[FAULTS:]),
        "deck": [printable(line, MESSAGE) for line in lines[-LINES:]],
        "deckLeft": len(lines[:-LINES]),
    }


def packed(numbers: Any) -> str:
    """An array as text: base64 of its deflated little-endian bytes."""
    little = np.ascontiguousarray(numbers, numbers.dtype.newbyteorder("<"))
    return base64.b64encode(zlib.compress(little.tobytes())).decode("ascii")


def _shown(atlas: Atlas, limit: int) -> Iterator[Span]:
    """The spans, from the first one on, that the page has room for; words that are not used take none."""
    for span in atlas.spans():
        if span.kind == UNUSED or span.last <= limit:
            yield span
        elif span.kind not in atlas.groups:
            yield span._replace(last=limit)
            return
        else:
            return


def _owner(atlas: Atlas, span: Span) -> int:
    """The block of a group that does not name it, such as a zone; 0 for all others."""
    if span.kind in NAMING or span.kind == "block" or span.kind not in atlas.groups:
        return 0
    return next(iter(atlas.owners(span)), 0)


def tables(ratios: set[int]) -> dict[str, Any]:
    """The data that all states share, for word schemes of these ratios, as JSON.

    spans: names of what a span can be, kinds of groups before the rest. layouts: by ratio and kind the size
    of a group and the first word of each field, counted from 0.
    """
    return {
        "spans": NAMES,
        "junk": JUNK,
        "nothing": NOTHING,
        "unused": UNUSED,
        "junkNext": JNEXT[0],
        "kinds": {
            group.name: {
                "text": group.text,
                "behind": group.behind,
                "fields": [_field(field, k) for k, field in enumerate(group.fields)],
            }
            for group in TABLE.groups
        },
        "common": [_field(field, getattr(g, field.name)) for field in TABLE.common],
        "heads": [[head.group, head.value, f"{head.name}: {head.text}"] for head in TABLE.heads],
        "codes": [
            [name, code.value, f"{code.name}: {code.text}", code.flag]
            for code in TABLE.codes
            for name in code.fields
        ],
        "choices": CHOICES | {"any": KINDS},
        "notAllowed": NOT_ALLOWED,
        "layouts": {
            ratio: {kind: _layout(kind, layouts(ratio)[kind], ratio) for kind in KINDS} for ratio in ratios
        },
    }


def _field(field: Field, place: int) -> dict[str, Any]:
    """place: its number in its group, or among the integers, reals or doubles of the common block."""
    return {
        "place": place,
        "name": field.name,
        "type": field.type,
        "count": field.count,
        "target": field.target,
        "role": field.role,
        "unit": field.unit.strip("-"),
        "text": field.text,
        "allowed": field.allowed,
        "range": in_words(field) if field.allowed else "finite",
    }


def _layout(kind: str, layout: Layout, ratio: int) -> dict[str, Any]:
    offsets = [(field, layout.offset[field.name]) for field in TABLE.group(kind).fields]
    words = [(offset - 1) * ratio if field.real else offset for field, offset in offsets]
    return {"size": layout.size, "words": words}
