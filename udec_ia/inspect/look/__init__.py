"""Looking into a heap, sound or damaged: what each word is, what leads to it, and how full the memory is."""

from udec_ia.inspect.look.atlas import Atlas
from udec_ia.inspect.look.fields import what
from udec_ia.inspect.look.listing import Listing
from udec_ia.inspect.look.ways import junk, walk, who

__all__ = ["Atlas", "Listing", "junk", "walk", "what", "who"]
