"""udec_ia: a two-dimensional distinct element program whose whole state is one array of words.

What takes time to load is loaded when it is asked for: Model and sweep need a second, in which the command
line can be interrupted.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from udec_ia.errors import UdecError
from udec_ia.version import __version__

if TYPE_CHECKING:
    from udec_ia.model import Model
    from udec_ia.remark import UdecWarning
    from udec_ia.studies.sweep import sweep

__all__ = ["Model", "UdecError", "UdecWarning", "__version__", "sweep"]

MODULES = {"Model": "model", "UdecWarning": "remark", "sweep": "studies.sweep"}


def __getattr__(name: str) -> Any:
    """Load one of MODULES when it is asked for."""
    if name not in MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{MODULES[name]}"), name)
