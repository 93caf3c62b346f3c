"""Cycles: the passes in their order, when a run ends, what its time-step may be."""
