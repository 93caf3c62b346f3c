"""SPLIT: cutting blocks along a line (report 2.7)."""
