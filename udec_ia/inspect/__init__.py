"""Looking at the heap from Python: walking its lists, tables of its groups, and the checker."""
