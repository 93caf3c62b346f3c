"""New states out of old ones: in other words, or at other addresses."""

from udec_ia.inspect.change.convert import Converted, convert
from udec_ia.inspect.change.prove import prove
from udec_ia.inspect.change.renumber import renumber

__all__ = ["Converted", "convert", "prove", "renumber"]
