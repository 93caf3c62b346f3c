"""New states out of old ones: in other words, at other addresses, or with other numbers."""

from udec_ia.inspect.change.convert import Converted, convert
from udec_ia.inspect.change.patch import Patched, patch
from udec_ia.inspect.change.renumber import renumber

__all__ = ["Converted", "Patched", "convert", "patch", "renumber"]
