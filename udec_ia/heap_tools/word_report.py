"""What one word is: the field, its value, the group that it is part of, and where in the rock that lies."""

from __future__ import annotations

from udec_ia.reader.atlas import JUNK, KINDS, Atlas, Word
from udec_ia.reader.field_rows import COLUMNS, meaning, span_rows
from udec_ia.reader.group_names import called
from udec_ia.reader.group_place import places
from udec_ia.reader.listing import Listing
from udec_ia.reader.places import address_of


def what(atlas: Atlas, place: int | str) -> Listing:
    """What the word at a place is, and the whole group that it is part of.

    place: an address, or text such as block@88.KXD. IndexError outside IA(), ValueError for no such place.
    """
    address = address_of(atlas, place)
    span, word = atlas.word_at(address)
    size, place = span.last - span.first + 1, address - span.first + 1
    said = [f"{address} is word {place} of {size} of {called(atlas, span)}"]
    if span.kind == JUNK:
        return Listing([f"{said[0]}, free to be used again"])
    if span.kind not in KINDS:
        return Listing([f"{address} is word {place} of {size} that are {span.kind}"])
    if word is None:
        said.append("no field: it fills the group up to a whole number of reals")
    else:
        told = meaning(atlas, span, word)
        more = f", {told}" if told != word.field.text else ""
        said.append(f"{word.name}, {word.field.text}: {_value(atlas, word)}{more}")
    return Listing(said + places(atlas, span), COLUMNS, span_rows(atlas, span))


def _value(atlas: Atlas, word: Word) -> str:
    unit = word.field.unit.strip("-")
    return f"{atlas.value(word)}{' ' if unit else ''}{unit}"
