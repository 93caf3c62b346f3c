"""What a model holds and what a cycle gives and takes (ENERGY)."""
