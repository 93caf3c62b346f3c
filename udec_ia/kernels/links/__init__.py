"""The lists of the map: stepping along them, changing them, the order in which they are walked."""
