"""udec_ia: a two-dimensional distinct element program whose whole state is one array of words.

Model is loaded when it is asked for: it needs a second, in which the command line can be interrupted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from udec_ia.errors import UdecError
from udec_ia.version import __version__

if TYPE_CHECKING:
    from udec_ia.model import Model

__all__ = ["Model", "UdecError", "__version__"]


def __getattr__(name: str) -> Any:
    """Load Model when it is asked for."""
    if name == "Model":
        from udec_ia.model import Model

        return Model
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
