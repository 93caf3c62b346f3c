"""Write what follows from groups.table, or with --check exit 1 if a generated file is not current."""

from __future__ import annotations

import sys

from offsets.generate import stale, write
from udec_ia.layout.field_table import TableError

try:
    if "--check" not in sys.argv[1:]:
        write()
    elif names := stale():
        print("\n".join(f"{name} is not current: run python -m offsets" for name in names))
        sys.exit(1)
except TableError as error:
    sys.exit(str(error))
