"""What the commands do to the heap, a file for each or for a few of a kind."""
