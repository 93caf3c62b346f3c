"""The table of data groups and the offsets that follow from it (Appendix III-2, IV-2).

Importing the package makes sure that `offsets.generated` follows from the table as it stands: a
changed table changes the very next run.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from offsets.table import (
    RATIOS,
    TABLE,
    Field,
    Group,
    HeadCode,
    Layout,
    Table,
    TableError,
    lay_out,
    read_table,
)

__all__ = [
    "RATIOS",
    "TABLE",
    "Field",
    "Group",
    "HeadCode",
    "Layout",
    "Table",
    "TableError",
    "lay_out",
    "read_table",
]


def _keep_current() -> None:
    digest = hashlib.sha256(TABLE.read_bytes()).hexdigest()
    generated = Path(__file__).with_name("generated.py")
    if not generated.exists() or f'"{digest}"' not in generated.read_text():
        from offsets.generate import write

        write()


_keep_current()
