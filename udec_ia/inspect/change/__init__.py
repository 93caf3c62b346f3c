"""New states out of old ones: in other words, at other addresses, or with other numbers."""

from udec_ia.inspect.change.convert import Converted, convert, prove
from udec_ia.inspect.change.patch import Patched, patch
from udec_ia.inspect.change.renumber import renumber
from udec_ia.inspect.change.rewrite import rewrite

__all__ = ["Converted", "Patched", "convert", "patch", "prove", "renumber", "rewrite"]
