"""A page that shows a heap beside the blocks that it holds, for any browser: `udec view`, Model.view.

Python writes the array and the field table as JSON (view_data.py), and puts both into one
file with the style and the scripts of web/ (view_page.py). The page itself turns words into numbers, groups
and pictures, with nothing from elsewhere.
"""

from udec_ia.view.view_page import Page

__all__ = ["Page"]
