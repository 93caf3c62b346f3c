"""Write what follows from groups.table, or with --check exit 1 if a generated file is not current."""

from __future__ import annotations

import sys

from offsets.generate import stale, write

if "--check" not in sys.argv[1:]:
    write()
else:
    for name in stale():
        print(f"offsets/{name} is not current: run python -m offsets")
    sys.exit(1 if stale() else 0)
