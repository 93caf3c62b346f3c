"""Linked lists of the map: steps along them, changes, and the order of groups on a walk."""
