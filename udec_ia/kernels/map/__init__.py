"""The map of blocks, contacts and domains: contacts come and go, and domains with them (report 2.1, 2.5)."""
