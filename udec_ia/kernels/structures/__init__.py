"""Structures: bolts, cables and beams. A model without them runs none of this code."""
