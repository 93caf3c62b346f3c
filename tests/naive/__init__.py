"""Slow, obvious oracles. They share no code with the program and take plain lists and numbers."""
