"""Energy of a model, and the work of a cycle (ENERGY)."""
