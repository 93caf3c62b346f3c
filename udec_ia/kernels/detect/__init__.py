"""Contact detection: fictitious displacements, search in a domain, blocks that penetrate within a step."""
