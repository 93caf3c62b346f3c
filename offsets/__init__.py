"""The table of data groups (Appendix III-2, IV-2) and the generator of all that follows from it.

`python -m offsets` writes udec_ia/layout, which the program imports, and the tables of offsets beside the
table, for people.
"""
