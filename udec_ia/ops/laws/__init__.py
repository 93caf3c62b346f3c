"""Laws of the user's: read, compiled, attached (Appendix IV-4)."""
