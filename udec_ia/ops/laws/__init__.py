"""The user's constitutive laws: reading, compiling, and binding to a model (Appendix IV-4)."""
