"""A state told by another field table, or in words of other widths: all that it says goes by names.

A group goes by the name of its kind, a field by its own, a code by what it is called; a group of another size
gets another address, and every pointer that the table knows follows it. What the new table has and the old
one has not is 0. What it has not can be left out only where it is 0; all else that finds no place is a fault,
told with the first group that has it.

The words that are translated may be anybody's: a group is believed to be one when pointers lead there, none
lies in another, and each pointer leads to a group of its kind (places.py). Whether the state makes sense is
for the checker to say.
"""

from udec_ia.inspect.translate.fields import Translation, translate
from udec_ia.inspect.translate.state import TranslationError, Words, words_of

__all__ = ["Translation", "TranslationError", "Words", "translate", "words_of"]
