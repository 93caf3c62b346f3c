"""The checker's tests by brute force; they share no routine with the program that they check."""
