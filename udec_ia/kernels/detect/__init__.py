"""Which contacts there must be: fictitious displacements, the search in a domain, what goes by unseen."""
