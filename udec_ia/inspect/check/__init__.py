"""The checker: what must hold in a sound heap, one file for each kind of claim."""

from udec_ia.inspect.check.groups import Violation
from udec_ia.inspect.check.invariants import check, check_links, check_shapes
from udec_ia.inspect.check.unjudged import unjudged

__all__ = ["Violation", "check", "check_links", "check_shapes", "unjudged"]
