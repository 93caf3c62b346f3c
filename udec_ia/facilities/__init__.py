"""Facilities of the program that a state uses, which of them have no effect, and what each costs a cycle."""
