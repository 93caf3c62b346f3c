"""A page that shows a heap beside the blocks that it holds, for any browser: `udec view`, Model.view.

Python writes the array as JSON (view_states.py) and the field table (view_tables.py), and puts both into one
file with the style and the scripts of web/ (view_page.py). The page itself turns words into numbers, groups
and pictures, with nothing from elsewhere.
"""

from udec_ia.view.view_page import Page

__all__ = ["Page"]
