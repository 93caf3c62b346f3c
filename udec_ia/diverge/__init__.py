"""Two runs side by side: the first cycle, pass and number in which they differ."""

from udec_ia.diverge.judge import SHARE, Judge
from udec_ia.diverge.runs import Run, of_deck, of_state
from udec_ia.diverge.search import Divergence, diverge

__all__ = ["SHARE", "Divergence", "Judge", "Run", "diverge", "of_deck", "of_state"]
