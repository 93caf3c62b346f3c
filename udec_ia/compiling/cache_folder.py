"""The folder of the machine code, which is found without numba.

numba's own cache looks at the kernel's own file only, and would run old machine code after a change of an
offset or of a function that the kernel calls. So the folder is named by a hash of the field table and of
every source file that kernels can depend on.
"""

from __future__ import annotations

import hashlib
import os
from functools import cache
from importlib.metadata import version
from itertools import chain
from pathlib import Path

from udec_ia.compiling.build_choice import CHECKED, plain_wanted
from udec_ia.layout import offsets as g

PACKAGE = Path(__file__).parent.parent
FOLDERS = "layout", "compiling", "checked_build", "heap", "kernels"  # whose files kernels can depend on


def cache_home() -> Path:
    """The folder of the machine code of all versions."""
    if os.environ.get("UDEC_CACHE"):
        return Path(os.environ["UDEC_CACHE"])
    from platformdirs import user_cache_dir

    return Path(user_cache_dir("udec_ia", appauthor=False))


@cache
def source_digest() -> str:
    """Hash of the field table and of the sources that compiled kernels can depend on, 16 digits."""
    digest = hashlib.sha256(g.DIGEST.encode())
    sources = (sorted((PACKAGE / folder).rglob("*.py")) for folder in FOLDERS)
    for path in [PACKAGE / "errors.py", *chain.from_iterable(sources)]:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def cache_folder() -> Path:
    """The folder of what is compiled from these sources, by this numba, in this build."""
    build = ("-plain" if plain_wanted() else "") + ("-checked" if CHECKED else "")
    return cache_home() / f"{source_digest()}-numba{version('numba')}{build}"


def warm_mark(scheme: str) -> Path:
    """The file that exists when what runs of rigid blocks need has been compiled for a word scheme."""
    return cache_folder() / f"{scheme}.warm"
