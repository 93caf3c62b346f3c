"""The contact pass: forces from relative displacements (FORD; report 2.6)."""
