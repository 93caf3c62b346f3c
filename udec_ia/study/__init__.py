"""Studies of decks: many runs of one deck, each a folder and a line of a table.

runs.py has what one run is and what comes of it, obeying.py how it is run, many.py how many of them are.
"""
