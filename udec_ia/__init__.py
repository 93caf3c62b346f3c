"""udec_ia: a two-dimensional distinct element program whose whole state is one array of words.

Model and sweep are loaded when they are asked for: they need a second, in which the command line can be
interrupted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from udec_ia.errors import UdecError
from udec_ia.remark import UdecWarning
from udec_ia.version import __version__

if TYPE_CHECKING:
    from udec_ia.model import Model
    from udec_ia.studies.sweep import sweep

__all__ = ["Model", "UdecError", "UdecWarning", "__version__", "sweep"]


def __getattr__(name: str) -> Any:
    """Load Model, or sweep, when it is asked for."""
    if name == "Model":
        from udec_ia.model import Model

        return Model
    if name == "sweep":
        from udec_ia.studies.sweep import sweep

        return sweep
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
