"""Cuts of blocks along lines that turn, end inside and close."""
