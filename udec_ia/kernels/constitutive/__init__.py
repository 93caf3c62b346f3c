"""Constitutive laws: joint properties, the laws of joints and of blocks, and calls of the user's laws."""
