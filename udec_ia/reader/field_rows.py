"""Fields of groups, one a line: words, name, value, unit and what the value means. Many groups at a time.

A value that the field table does not allow, and a pointer to something else than it says, are marked.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import repeat
from typing import Any

import numpy as np

from udec_ia.layout.code_names import spelled
from udec_ia.layout.field_table import Code, Field
from udec_ia.reader.field_reading import allowed, in_words
from udec_ia.reader.word_map import TABLE, Atlas, Span, Word, leads_to

COLUMNS = ("address", "words", "field", "value", "unit", "meaning")
Row = tuple[Any, ...]
HEADS = {(head.group, head.value): f"{head.name}: {head.text}" for head in TABLE.heads}
COMMON = "common block"  # what its variables stand under
RADICES = (8, 10, 16)
NOT_ALLOWED = "not allowed"  # begins the meaning of a value that the table does not allow


def group_rows(atlas: Atlas, kind: str, at: Any, radix: int = 10) -> list[tuple[Row, ...]]:
    """For each group of a kind at the addresses `at` (n,) its rows of COLUMNS, field by field."""
    fields = []
    for word in atlas.shapes[kind]:
        values = atlas.gather(word, at)
        words = [digits(atlas.h.ia[at + offset], radix) for offset in range(word.first - 1, word.last)]
        columns = [
            (at + word.first).tolist(),
            map(" ".join, zip(*words, strict=True)),
            repeat(word.name),
            values.tolist(),
            repeat(word.field.unit.strip("-")),
            _meanings(atlas, kind, word.field, values),
        ]
        fields.append(zip(*columns, strict=False))
    return list(zip(*fields, strict=True))


def span_rows(atlas: Atlas, span: Span, radix: int = 10) -> list[Row]:
    """The rows of one group, and of words of it that no field has, if there is something in them."""
    rows = list(group_rows(atlas, span.kind, np.array([span.first]), radix)[0])
    for offset in _gaps(atlas, span.kind):
        word = atlas.h.ia[span.first + offset - 1 : span.first + offset]
        if word.any():
            rows.append((span.first + offset, digits(word, radix)[0], "", "", "", "no field, but not 0"))
    return sorted(row for row in rows if row[0] <= span.last)


def padded(atlas: Atlas, kind: str, at: Any) -> Any:
    """True for each group of a kind at the addresses (n,) with something in words that no field has."""
    found = np.zeros(len(at), bool)
    for offset in _gaps(atlas, kind):
        found |= atlas.h.ia[at + offset - 1] != 0
    return found


def _gaps(atlas: Atlas, kind: str) -> list[int]:
    """The words of a group of a kind, counted from 0, that no field has: they fill up to whole reals."""
    taken = {offset for word in atlas.shapes[kind] for offset in range(word.first, word.last + 1)}
    return [offset for offset in range(atlas.layout[kind].size) if offset not in taken]


def digits(words: Any, radix: int) -> list[str]:
    """Words in a radix: decimal with a sign, else all digits of the word as it is."""
    if radix == 10:
        return list(map(str, words.tolist()))
    bits = words.itemsize * 8
    form = f"{{:0{bits // 4}x}}" if radix == 16 else f"{{:0{-(-bits // 3)}o}}"
    return list(map(form.format, words.view(f"u{words.itemsize}").tolist()))


def word_width(words: Any, radix: int) -> int:
    """How many characters a word of that type has in a radix, if it has all digits."""
    lowest = np.array([np.iinfo(words.dtype).min], words.dtype)
    return len(digits(lowest, radix)[0])


def meaning(atlas: Atlas, span: Span, word: Word) -> str:
    """What the value of one field of a group says."""
    (meanings,) = _meanings(atlas, span.kind, word.field, atlas.gather(word, np.zeros(1, np.int64)))
    return meanings


def _meanings(atlas: Atlas, kind: str, field: Field, values: Any) -> Iterable[str]:
    """What the values (n,) of a field say: groups that they lead to, names of codes, or the table's text."""
    if field.role == "head":
        return [HEADS.get((kind, value), "no head code of its kind") for value in values.tolist()]
    if field.target:
        return leads_to(atlas, field.target, values, required=not allowed(field, np.zeros(1)).all())
    return data_meanings(field, values)


def data_meanings(field: Field, values: Any) -> Iterable[str]:
    """The same for a field that is no pointer."""
    good, meanings = np.isfinite(values) & allowed(field, values), TABLE.codes_of(field.name)
    if good.all() and not meanings:
        return repeat(field.text, len(values))
    wrong = f"{NOT_ALLOWED}, {in_words(field) if field.allowed else 'finite'}: {field.text}"
    return [
        _coded(meanings, value, field.text) if is_good else wrong
        for value, is_good in zip(values.tolist(), good.tolist(), strict=True)
    ]


def _coded(codes: tuple[Code, ...], value: int, text: str) -> str:
    """The name of a code, or those of the flags that add up to it; else the `text` of the field."""
    return ", ".join(f"{code.name}: {code.text}" for code in spelled(codes, value)) or text
