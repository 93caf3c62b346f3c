"""Cracks: blocks that break under load (BREAKAGE; report 1.1, 2.7, section 5)."""
