"""Tools on the whole heap: print, search, compare, convert and patch it."""
