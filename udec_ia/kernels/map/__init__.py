"""Changes of the map of blocks, contacts and domains (report 2.1, 2.5)."""
