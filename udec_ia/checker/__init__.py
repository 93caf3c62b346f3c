"""The checker: what must hold in a sound heap, one file for each kind of claim."""

from udec_ia.checker.checked_state import Violation
from udec_ia.checker.invariants import check, check_links, check_shapes, in_short, unchecked_parts

__all__ = ["Violation", "check", "check_links", "check_shapes", "in_short", "unchecked_parts"]
