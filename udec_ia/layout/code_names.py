"""Names of the codes that an integer stands for: the code with its number, or the flags that add up to it."""

from __future__ import annotations

from collections.abc import Iterable

from udec_ia.layout.field_table import Code


def spelled(codes: Iterable[Code], value: int) -> list[Code]:
    """The codes of `value`, of all `codes` of a field: one code, or flags; none for 0 or what is neither."""
    known = list(codes)
    found = [code for code in known if code.value == value]
    if found:
        return found
    flags = [code for code in known if code.flag and code.value & value]
    return flags if sum(code.value for code in flags) == value else []
