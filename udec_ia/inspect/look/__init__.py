"""Looking into a heap, sound or damaged: what each word is, what leads to it, and how full the memory is."""

from udec_ia.inspect.look.atlas import Atlas
from udec_ia.inspect.look.cover import heap_map
from udec_ia.inspect.look.dump import common, dump
from udec_ia.inspect.look.find import find, find_pointers, find_value
from udec_ia.inspect.look.fullness import junk
from udec_ia.inspect.look.graph import graph
from udec_ia.inspect.look.listing import Listing
from udec_ia.inspect.look.pointers import who
from udec_ia.inspect.look.walk import walk
from udec_ia.inspect.look.what import what

__all__ = [
    "Atlas",
    "Listing",
    "common",
    "dump",
    "find",
    "find_pointers",
    "find_value",
    "graph",
    "heap_map",
    "junk",
    "walk",
    "what",
    "who",
]
