"""Output: PRINT, DUMP, PLOT, animations and progress. Nothing here writes to IA()."""
