"""Where every number of a data group stands: what the rest of the program knows of the field table.

`table` reads the table and lays the groups out; `groups.table` and `offsets` are written by
`python -m offsets` from the table at the top of the checkout, and never by a run.
"""
