"""SPLIT: blocks are cut by a line (report 2.7)."""
