"""The field table as the page needs it: kinds with their fields, codes, and where each field stands."""

from __future__ import annotations

from typing import Any

from udec_ia.heap.census import CHOICES
from udec_ia.heap.junk_list import JNEXT
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Field, Layout, layouts, read_table
from udec_ia.reader.atlas import JUNK, KINDS, NAMES, NOTHING, UNUSED
from udec_ia.reader.field_reading import in_words
from udec_ia.reader.field_rows import NOT_ALLOWED

TABLE = read_table()


def tables(ratios: set[int]) -> dict[str, Any]:
    """All that does not change from state to state, for word schemes of these ratios, as JSON.

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
    """place: its number in its group, or where it stands among the integers, reals or doubles there."""
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
