"""udec_ia: a two-dimensional distinct element program whose whole state is one array of words."""

from udec_ia.errors import UdecError
from udec_ia.model import Model

__all__ = ["Model", "UdecError"]
__version__ = "0.1.0"
