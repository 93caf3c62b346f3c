"""Two heaps beside each other: which group is which, and what differs, by meaning or word by word."""

from udec_ia.inspect.compare.compare import Compared, compare
from udec_ia.inspect.compare.match import Matching
from udec_ia.inspect.compare.raw import raw
from udec_ia.inspect.compare.tell import diff

__all__ = ["Compared", "Matching", "compare", "diff", "raw"]
